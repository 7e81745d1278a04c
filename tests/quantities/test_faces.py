"""A number has one name and one unit on every face: table, Python, datasets, files, commands."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from pindrive import Contact, Drive, Profile, Release, simulate, simulate_batch
from pindrive.device import Coil, ControlBlock, Criteria, Electromagnet, PinArray
from pindrive.device.reading import Reading
from pindrive.files.keys import NUMERIC_KEYS, variable
from pindrive.motion.batch import _ARGUMENTS
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.results import ENDING, ENERGY, TRANSIENT
from pindrive.quantities.table import QUANTITIES
from pindrive.study.outputs import OUTPUTS, known_output

SOURCE = Path(__file__).resolve().parents[2] / "src" / "pindrive"
DRIVE = Drive(
    mass=0.01,
    stiffness=100.0,
    damping=0.4,
    plate=Contact(0.02),
    finger=Contact(0.005, stiffness=1000.0),
)
BRAKE = Profile([0.0, 0.1], [0.06, 0.0])


def parameters(made: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    """Return the numeric arguments, by their names in Python."""
    of_python = "self plate finger coil places spots curve drive release steps progress"
    parts = of_python.split()
    found = inspect.signature(made).parameters
    return {name: p for name, p in found.items() if name not in parts}


@pytest.mark.parametrize(
    "made",
    [
        *(Drive, Release, simulate, ControlBlock, Electromagnet),
        *(Electromagnet.from_times, Coil, PinArray, PinArray.grid, Criteria),
    ],
)
def test_arguments_in_python_are_names_of_the_table(made: Callable[..., Any]) -> None:
    names = parameters(made)
    assert names
    assert {*names} <= {*QUANTITIES}


@pytest.mark.parametrize(
    "made",
    [
        *(ControlBlock, Electromagnet, Electromagnet.from_times, Coil, PinArray.grid, Criteria),
        *(Reading, Release),
    ],
)
def test_defaults_in_python_are_those_of_the_table(made: Callable[..., Any]) -> None:
    for name, parameter in parameters(made).items():
        if parameter.default is not inspect.Parameter.empty:
            quantity = QUANTITIES[name]
            absent = quantity.absent
            expected = quantity.choices[int(absent or 0)] if quantity.choices else absent
            assert parameter.default == expected, name


def literal_defaults(text: str) -> list[str]:
    """The defaults of fields and arguments that are numbers, but for whole ones: counts."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ClassDef) and node.name not in AT_REST:
            fields = [field for field in node.body if isinstance(field, ast.AnnAssign)]
            found += [field.value for field in fields if field.value]
        elif isinstance(node, ast.FunctionDef):
            found += [value for value in (*node.args.defaults, *node.args.kw_defaults) if value]
    numbers = [
        part
        for value in found
        for part in ast.walk(value)
        if (isinstance(part, ast.Constant) and isinstance(part.value, float))
        or (isinstance(part, ast.Name) and part.id.isupper())
    ]
    return [ast.unparse(part) for part in numbers]


AT_REST = ("CoilState", "PinState", "Scene", "Bounds", "InputPiece", "InputTerm")
"""Classes whose zeros are no device's: a state at rest, a corner of the page, no bound or term."""


def test_no_default_is_written_outside_of_the_table() -> None:
    written = {}
    for package in ("motion", "device", "evaluation", "files"):
        for path in (SOURCE / package).glob("*.py"):
            if found := literal_defaults(path.read_text("utf-8")):
                written[path.name] = found
    # Strokes without a pause, a pin in the array's middle, functions without a phase or a delay.
    counts = {"hand.py": 2, "pin_array.py": 2, "function.py": 3}
    assert written == {file: ["0.0"] * count for file, count in counts.items()}
    assert literal_defaults("class A:\n    x: float = 2e-3 * 2") == ["0.002"]
    assert literal_defaults("def f(x=1.5, *, y=PART): pass") == ["1.5", "PART"]


def test_a_contact_is_its_part_of_the_table() -> None:
    for field in fields(Contact):
        for side in ("plate", "finger"):
            key = f"{side}.{field.name}"
            assert key in QUANTITIES or key in ("plate.stiffness", "plate.damping")  # a rigid plate


def test_batch_arguments_have_the_names_of_device_files() -> None:
    in_files = {variable(key) for key in NUMERIC_KEYS if key.partition(".")[0] != "scan"}
    assert {*_ARGUMENTS} <= in_files
    for name, quantity in _ARGUMENTS.items():
        assert quantity.name.replace(".", "_") == name


def test_numbers_have_one_name_and_one_unit_in_every_dataset() -> None:
    motion = simulate(DRIVE, Release(BRAKE, 1.5e-3))
    batch = simulate_batch(DRIVE, Release(0.06, 1.5e-3), energy=True)
    data = motion.to_dataset()
    derived = motion.sensitivity(["mass"]).to_dataset()
    for quantity in (*TRANSIENT, *ENDING, *ENERGY):
        name = quantity.name.replace(".", "_")
        assert quantity.name in motion.numbers()
        for dataset in (data, batch):
            attributes = dataset[name].attrs
            assert attributes.get("units", "") == quantity.unit
            assert attributes["long_name"] == quantity.meaning
        if name in derived:
            assert derived[name].attrs["units"] == quantity.unit
        assert name in OUTPUTS
        for given in (quantity.name, name):
            assert known_output(given, "outputs") == name
    for name, argument in _ARGUMENTS.items():
        if name in batch.coords:
            assert batch[name].attrs.get("units", "") == argument.unit
    assert {*data.dims} == {"time", "event"}


def test_the_rows_of_what_changes_are_in_the_table() -> None:
    rows: list[Quantity] = [q for q in QUANTITIES.values() if q.rows_of]
    assert rows
    for quantity in rows:
        assert all(column in QUANTITIES for column in COLUMNS[quantity.rows_of])

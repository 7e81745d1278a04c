"""Keys of device files: spelling, defaults, and a template with all keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, Union, cast

from pindrive.motion.friction import COEFFICIENT_OF, PRESSED_BY
from pindrive.quantities.device import READER
from pindrive.quantities.drive import COLUMNS, DRIVE_QUANTITIES
from pindrive.quantities.functions import FUNCTIONS, FUNCTIONS_OF
from pindrive.quantities.names import Names
from pindrive.quantities.quantity import Quantity, Rows
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.table import DEVICE_INPUTS, FUNCTION_PARAMETERS, QUANTITIES, check
from pindrive.quantities.units import UnitError, to_si

if TYPE_CHECKING:
    from pindrive.motion.function import Function

Tables = Mapping[str, Any]
"""The tables of a device file as TOML has them: text with units."""
Given = Union[float, Rows, "Function"]
"""Value of a key, SI."""
Value = Union[float, Rows, "Function", None]
"""Value of a key, SI; None for a missing key without a default."""

DRIVE: Final[dict[str, Quantity]] = {quantity.key: quantity for quantity in DRIVE_QUANTITIES}
"""The keys of a device file that describe the drive and its motion, in their order."""
WHOLE: Final[dict[str, Quantity]] = {quantity.key: quantity for quantity in DEVICE_INPUTS}
"""The keys that describe the whole device around it, in their order."""
FILE_KEYS: Final[dict[str, Quantity]] = DRIVE | WHOLE
"""The keys in the tables of a device file that hold a quantity."""
PARAMETERS: Final[dict[str, Quantity]] = {q.key: q for q in FUNCTION_PARAMETERS}
"""Parameters of inputs that are functions of time: "motion.mouse_velocity.amplitude"."""
NUMERIC_KEYS: Final[dict[str, Quantity]] = FILE_KEYS | PARAMETERS
"""The keys that hold a quantity, a parameter of a function among them."""

STUDY_KEYS: Final = (
    *("base", "set", "page", "outputs", "zip", "chunk"),
    *("axes", "sample", "tolerances", "specification"),
)
"""Top-level keys of a study file beside the tables of a device and the name."""
KEYS: Final = ("device.name", "device.description", *FILE_KEYS)
AROUND: Final = ("magnet", "control", "array", "scan", "hand", "criteria")
ALONE: Final = ("device", "drive", "plate", "finger", "motion")
TABLES: Final = (*ALONE, *AROUND)
SUFFIX: Final = ".csv"
OVER_TIME: Final = ("profile", "steps")
"""Interpolation of rows over time: linear, or constant until the next row."""


def _spellings(key: str) -> tuple[str, ...]:
    return (NUMERIC_KEYS[key].variable,) if key in NUMERIC_KEYS else ()


_LISTED: Final = "docs/reference/device-file.md"
NAMES: Final = Names("key", {key: _spellings(key) for key in (*KEYS, *PARAMETERS)}, listed=_LISTED)
"""The keys as a user may write them: plate.kinetic, plate_kinetic, mass."""
_WITH_TABLES: Final = Names("key", {n: _spellings(n) for n in (*TABLES, *KEYS)}, listed=_LISTED)


def names_in_file(key: str) -> Names:
    """Return the valid names at the place of an unknown key, with tables at the top."""
    return NAMES if "." in key else _WITH_TABLES


def unknown_in_file(key: str) -> str:
    """Return the message for an unknown key of a device file."""
    if key == "plate.stiffness":
        return f"{key} cannot be given, the plate is rigid; skin gives way by finger.stiffness"
    if key == "plate.damping":
        return f"{key} cannot be given, the plate is rigid; skin is damped by finger.damping"
    return names_in_file(key).unknown(key)


def number(
    value: object, quantity: Quantity, example: str, label: str, place: str, *, si: bool = False
) -> float:
    """A value in SI: text with a unit, or a bare number where the quantity has no unit.

    With `si`, of what Python gave, a bare number is SI whatever the unit.
    """
    if quantity.choices:
        return choice(value, quantity, label, place, si=si)
    bare = isinstance(value, (int, float)) and not isinstance(value, bool)
    if bare and si:
        return check(quantity.name, float(cast(float, value)), where=place, label=label)
    text = value if isinstance(value, str) else repr(value) if bare else ""
    try:
        found = to_si(text, quantity.unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(value), place)) from None
    return check(quantity.name, found, where=place, label=label, given=quoted(value))


def choice(value: object, quantity: Quantity, label: str, place: str, *, si: bool = False) -> float:
    """Number of a choice from its name, or with `si` the number itself."""
    names = quantity.choices
    if si and value in range(len(names)):
        return float(cast(float, value))
    if value not in names:
        raise ValueError(refusal(label, f"one of {', '.join(names)}", quoted(value), place))
    return float(names.index(value))


def is_file(key: str, value: object) -> bool:
    """Return True if a value of a device file names a CSV and its key may change over time."""
    over_time = key in NUMERIC_KEYS and NUMERIC_KEYS[key].rows_of in OVER_TIME
    return over_time and isinstance(value, str) and value.strip().lower().endswith(SUFFIX)


def written(key: str, value: Given) -> Any:
    """Return a value in SI as a device file has it, to the last bit."""
    if isinstance(value, tuple):
        across = QUANTITIES[COLUMNS[NUMERIC_KEYS[key].rows_of][0]]
        return [[f"{x!r} {across.unit}", written(key, y)] for x, y in value]
    if not isinstance(value, (float, int)):
        return written_function(key, value)
    if NUMERIC_KEYS[key].choices:
        return NUMERIC_KEYS[key].choices[int(value)]
    unit = NUMERIC_KEYS[key].unit
    return value if unit == "1" else f"{value!r} {unit}"


def written_function(key: str, function: Function) -> dict[str, Any]:
    """Return a function as a device file has it: its parameters or, without any, its pieces."""
    if function.parameters:
        return {name: written(f"{key}.{name}", x) for name, x in function.parameters.items()}
    pieces = [
        {"begin": f"{begin!r} s", "polynomial": [*polynomial], "terms": [[*term] for term in terms]}
        for begin, polynomial, terms in function.pieces
    ]
    return {"pieces": pieces}


def has_part(key: str, scans: bool) -> bool:
    """Return True if a key of the device file affects scans, or otherwise releases."""
    return not key.startswith("motion.") if scans else key in DRIVE or key in PARAMETERS


def variable(key: str) -> str:
    """Return the name of a key of the device file in Python and in a NetCDF file."""
    return NUMERIC_KEYS[key].variable


def friction_parts(key: str) -> tuple[str, ...]:
    """The keys from which a friction force follows where a coefficient gives it; of others none."""
    if key not in COEFFICIENT_OF:
        return ()
    own, pressing = COEFFICIENT_OF[key], PRESSED_BY[key.partition(".")[0]]
    return (own, *DRIVE[own].follows, *(QUANTITIES[name].key for name in pressing))


# ---- a device file that is written ---------------------------------------------------------------


def usual_rows(quantity: Quantity) -> str:
    """Its usual rows: [["0 ms", "60 mm/s"], ["40 ms", "0 mm/s"]]."""
    across = QUANTITIES[COLUMNS[quantity.rows_of][0]]
    rows = (f"[{_quoted(across, t)}, {_quoted(quantity, y)}]" for t, y in quantity.rows)
    return f"[{', '.join(rows)}]"


def usual_function(quantity: Quantity, kind: str) -> str:
    """A function of an input with usual values: { mean = "60 mm/s", amplitude = "20 mm/s", … }."""
    parameters = (PARAMETERS[f"{quantity.key}.{p.name}"] for p in FUNCTIONS[kind])
    shown = (f"{p.name.rpartition('.')[2]} = {_quoted(p, p.example or 0.0)}" for p in parameters)
    return f"{{ {', '.join(shown)} }}"


def _usual_functions(quantity: Quantity) -> list[str]:
    """The lines of an input as each function that it may be."""
    kinds = FUNCTIONS_OF.get(quantity.name, ())
    return [f"{quantity.name} = {usual_function(quantity, kind)}" for kind in kinds]


def line(quantity: Quantity) -> str:
    """A line of a device file: mass = "10 g"."""
    value = quantity.example if quantity.default is None else quantity.default
    written = usual_rows(quantity) if value is None else _quoted(quantity, value)
    return f"{quantity.key.partition('.')[2]} = {written}"


def _quoted(quantity: Quantity, value: float) -> str:
    written = quantity.written(value)
    return written if quantity.unit == "1" and not quantity.choices else f'"{written}"'


def template(whole: bool = False) -> str:
    """A commented device file with usual values, as `pindrive init` writes it.

    Args:
        whole: True for the tables of the whole device, as `pindrive init --device` writes them.
    """
    lines = [
        "# A tactile device, for pindrive."
        if whole
        else "# A pin drive of a tactile mouse, for pindrive.",
        "# Every value is written with its unit; the bounds below are in SI units.",
        "",
        "[device]",
        'name = "my tactile device"' if whole else 'name = "my pin drive"',
        '# description = "what is special about it"',
    ]
    table = "device"
    for key, usual_one in (FILE_KEYS if whole else DRIVE).items():
        quantity = replace(usual_one, **READER.get(key, {})) if whole else usual_one
        if key.partition(".")[0] != table:
            table = key.partition(".")[0]
            lines += ["", f"[{table}]"]
        unit = "" if quantity.unit == "1" else quantity.unit
        bounds = quantity.bounds.words(unit)
        lines.append(f"# {quantity.symbol}: {quantity.meaning}")
        follows = f"keeps its ratio to {' over '.join(quantity.follows)} where it is not set itself"
        said = (bounds, quantity.unless_given, quantity.remark, follows if quantity.follows else "")
        lines += [f"#   {text}" for text in wrap("; ".join(filter(None, said)), 94)]
        lines += [f"#   {text}" for text in wrap(quantity.source, 94)]
        lines.append(("# " if quantity.default is None else "") + line(quantity))
        if quantity.rows and quantity.may_be_constant:
            lines.append(f"# {key.partition('.')[2]} = {usual_rows(quantity)}")
        lines += [f"# {line}" for line in _usual_functions(quantity)]
    return "\n".join(lines) + "\n"

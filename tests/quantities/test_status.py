"""One code says how far a motion was followed, from the core to a file; nothing parses words."""

from __future__ import annotations

import ast
import json
import pickle
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from command import run
from pindrive import Contact, Drive, Motion, Release, Status, _core, simulate, simulate_batch
from pindrive.quantities.status import End, SimulationError, outcome_attributes

SOURCES = sorted(Path(__file__).parents[2].joinpath("src", "pindrive").rglob("*.py"))

WEAK = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=Contact(1e-9))
"""Undamped, with so little friction that no ending comes within the largest number of events."""


def test_the_codes_are_those_of_the_core() -> None:
    of_the_core = {code.name: code.value for code in Status if code < Status.incomplete}
    assert of_the_core == _core.statuses


def test_each_code_has_words_of_its_own() -> None:
    words = [code.explanation for code in Status]
    assert len({*words}) == len(Status)
    assert Status.bad_plate_static.explanation == (
        "plate.static is out of its range: largest friction force of the plate without sliding"
    )
    assert all("\n" not in text and text for text in words)


@pytest.mark.parametrize(("name", "kind"), [("status", Status), ("ending", End)])
def test_flag_has_the_meaning_of_its_values(name: str, kind: type[Status | End]) -> None:
    flags = outcome_attributes(name)
    names = flags["flag_meanings"].split()
    values = flags["flag_values"].tolist()
    assert dict(zip(names, values, strict=True)) == {code.name: code.value for code in kind}
    assert flags["flag_values"].dtype == np.int8


@pytest.mark.usefixtures("in_empty_folder")
def test_a_motion_that_is_given_up_has_its_code_on_every_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Motion, "events", ())  # a million take long to list
    release = Release(0.0, 1.5e-3)
    motion = simulate(WEAK, release)
    assert motion.status is Status.too_many_events
    batch = simulate_batch(WEAK, release, threads=1)
    data = motion.to_dataset([0.0])
    for found in (batch, data):
        assert found.status == Status.too_many_events
        assert found.status.attrs["flag_meanings"] == batch.status.attrs["flag_meanings"]
        assert found.ending == End.moving
    data[["status"]].to_netcdf("motion.nc", engine="h5netcdf")
    with xr.open_dataset("motion.nc") as read:
        assert read.status == Status.too_many_events
        assert "too_many_events" in read.status.attrs["flag_meanings"].split()
    Path("weak.toml").write_text(
        '[drive]\nmass = "10 g"\nstiffness = "100 N/m"\ndamping = "0 N*s/m"\n'
        '[plate]\nkinetic = "0 N"\n[finger]\nkinetic = "1 nN"\n'
        '[motion]\nmouse_velocity = "0 m/s"\ndisplacement = "1.5 mm"\n',
        encoding="utf-8",
    )
    study = 'base = "weak.toml"\noutputs = ["swing"]\n[axes]\ndisplacement = ["1.5 mm"]\n'
    Path("study.toml").write_text(study, encoding="utf-8")
    assert run("sweep", "study.toml", "-o", "study.nc").exit_code == 0
    with xr.open_dataset("study.nc") as read:
        assert read.status.values.tolist() == [Status.too_many_events]
        assert read.status.attrs["flag_meanings"] == batch.status.attrs["flag_meanings"]


def test_an_error_keeps_its_code_between_processes() -> None:
    error = SimulationError("pin 3", Status.standstill)
    again = pickle.loads(pickle.dumps(error))
    assert again.status is Status.standstill
    assert str(again) == str(error) == f"pin 3: the simulation {Status.standstill.explanation}"


def test_no_code_parses_a_message_of_an_error() -> None:
    """Code uses the type and the attributes of an error, never its message."""
    times = []
    for path in SOURCES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            reported = (
                node.comparators
                if isinstance(node, ast.Compare) and isinstance(node.ops[0], (ast.In, ast.NotIn))
                else [node.func.value]
                if isinstance(node, ast.Call)
                and isinstance(node.func, ast.Attribute)
                and node.func.attr in ("startswith", "endswith", "find", "index", "removeprefix")
                else []
            )
            if any(
                ast.unparse(text) in ("str(error)", "message", "error.args[0]") for text in reported
            ):
                times.append(path.name)
    assert times == ["device.py"]  # of tomllib's text


def test_json_names_the_code(tmp_path: Path) -> None:
    from command import EXAMPLE

    target = tmp_path / "motion.json"
    assert run("simulate", EXAMPLE, "-o", target).exit_code == 0
    assert json.loads(target.read_text(encoding="utf-8"))["status"] == "ok"


def test_a_status_is_written_as_its_name() -> None:
    assert str(Status.ok) == "ok"
    assert int(Status.ok) == 0

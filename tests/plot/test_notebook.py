"""Results in a notebook: one line, a table with units, a picture, and nothing else."""

from __future__ import annotations

import re
from importlib import import_module
from inspect import isfunction, signature
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from command import EXAMPLE
from notebook_reading import Parts, check_faces
from pindrive.evaluation import speeds_over_page
from pindrive.quantities.quantity import significant
from pindrive.study.runner import sweep
from recordings import RELEASE, START, recorded


@pytest.fixture(scope="module")
def motion() -> pd.Motion:
    finger = pd.Contact("5 mN", "7.5 mN", stiffness="1000 N/m")
    drive = pd.Drive(
        mass="10 g", stiffness=100.0, damping=0.4, plate=pd.Contact(0.02), finger=finger
    )
    return pd.simulate(drive, pd.Release("100 mm/s", "1.5 mm"))


@pytest.fixture(scope="module")
def results(motion: pd.Motion, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    device, file = pd.load_device(EXAMPLE), tmp_path_factory.mktemp("sweep") / "masses.nc"
    study = pd.Study(device, tolerances={"mass": {"uniform": ["9 g", "11 g"]}}, name="<b>&")
    reader = pd.load_device(READER, ["array.columns=2", "array.rows=1"])
    scan = pd.scan(reader, pd.Page(grating=[0.008]))
    return {
        "motion": motion,
        "sensitivity": motion.sensitivity(["mass", "plate_kinetic", "mouse_velocity"]),
        "scan": scan,
        "evaluation": scan.evaluate(),
        "robustness": pd.robustness(study, count=50),
        "local sensitivity": pd.local_sensitivity(study),
        "sobol": pd.sobol(study, rows=128),
        "fit": pd.fit(recorded(rate=1e3), START, RELEASE, free=["damping"], profiles=False),
        "friction curve": pd.fit_friction(SPEEDS, 0.02 + 0.1 * SPEEDS),
        "page speeds": speeds_over_page(reader.device, reader.reading, pd.Page(text=".")),
        "system motion": pd.load_system(SYSTEM).system.simulate("0.3 s"),
        "bifurcation": pd.bifurcation(pd.Study(device, axes={"mass": ["9 g", "10 g"]})),
        "sweep": sweep(pd.Study(device, axes={"mass": ["9 g", "10 g", "11 g"]}), file),
    }


ROOT = Path(__file__).parents[2]
MADE = re.compile(r"^class (\w+)\(NotebookHtml", re.M)
SPEEDS = np.linspace(0.0, 0.2, 30)
READER = EXAMPLE.parent / "tactile-reader.toml"
SYSTEM = EXAMPLE.parent / "two-pins-system.toml"
RESULTS = (
    *("motion", "sensitivity", "scan", "evaluation", "robustness", "local sensitivity", "sobol"),
    *("fit", "friction curve", "sweep", "page speeds", "bifurcation", "system motion"),
)


PUBLIC = [
    "pindrive",
    *(f"pindrive.{part.name}" for part in iter_modules(pd.__path__) if part.ispkg),
]
NO_RESULTS = {
    "Contact",
    "Function",
    *(
        "DeviceFile",
        "Study",
        *("System", "SystemFile", "Body", "Spring", "ContactPair"),
        "DesignProblem",
        "FitProblem",
        "Recording",
        "HandPath",
    ),  # they are given to what computes
    "SavedReading",  # device, page and hand that are given to scan
    *("xr.Dataset", "Array", "NDArray[np.bool_]", "tuple[Array, Array]", "float", "str"),
}


@pytest.mark.parametrize("name", RESULTS)
def test_every_result_has_the_same_faces(name: str, results: dict[str, Any]) -> None:
    assert check_faces(results[name]) == {"fit": 2, "friction curve": 1 + 4}.get(name, 0)


def test_no_result_is_left_out(results: dict[str, Any]) -> None:
    """Three results are tested with their makers."""
    found = {name for p in (ROOT / "src").rglob("*.py") for name in MADE.findall(p.read_text())}
    seen = {type(result).__name__ for result in results.values()}
    assert found == seen | {"Design", "ModelComparison", "SpeedLimits"}
    public = (
        getattr(package, name) for package in map(import_module, PUBLIC) for name in dir(package)
    )
    returned = {
        signature(function).return_annotation for function in public if isfunction(function)
    }
    assert returned - {"None"} <= found | NO_RESULTS


def test_stopped_sweep_is_reported_and_not_drawn(tmp_path: Path) -> None:
    text = f'base = "{EXAMPLE.as_posix()}"\nchunk = 1\n[axes]\nmass = ["9 g", "10 g", "11 g"]\n'
    (tmp_path / "study.toml").write_text(text)
    study = pd.load_study(tmp_path / "study.toml")
    done = sweep(study, tmp_path / "masses.nc", stop_after=2)
    assert repr(done) == "<Sweep masses.nc.partial of 2 points, incomplete>"
    with pytest.raises(ValueError, match=r"masses\.nc\.partial: is not finished; `pindrive sweep"):
        done.plot()
    done = sweep(study, tmp_path / "masses.nc", resume=True)
    assert repr(done) == "<Sweep masses.nc of 3 points, ok>"
    with done.to_dataset() as data:
        assert data.mass.values.tolist() == [0.009, 0.01, 0.011]


def test_the_table_has_the_numbers_in_the_units_that_a_person_reads(motion: pd.Motion) -> None:
    rows = {row[0]: row[1:] for row in Parts(motion._repr_html_()).rows}
    settling = motion.transient.settling_time
    assert rows["transient_settling_time"][:2] == [significant(1e3 * settling), "ms"]
    assert rows["ending_position"][:2] == [significant(1e3 * motion.ending.position), "mm"]
    assert rows["status"][0] == "ok"
    assert rows["ending"][0] == "decaying"
    assert rows["transient_finger_reversals"][0] == str(motion.transient.finger.reversals)
    assert rows["transient_rest_time"][0] == "infinite"
    assert rows["transient_settled"][0] == "yes"
    assert "ending_amplitude" not in rows  # it has none
    x = motion.to_dataset().position.values
    ends = f"{significant(1e3 * x.min())} to {significant(1e3 * x.max())}"
    assert rows["position"][:2] == [f"{ends} (time {len(x)})", "mm"]


def test_the_parameters_of_a_fit_are_a_table_with_their_units(results: dict[str, Any]) -> None:
    heads, row = Parts(results["fit"]._repr_html_()).rows[:2]
    assert heads[0] == "parameter" and heads[-1] == "unit"
    found = dict(zip(heads, row, strict=True))
    (estimate,) = results["fit"].estimates
    assert (found["parameter"], found["unit"]) == ("damping", "N*s/m")
    assert found["value"] == significant(estimate.value)
    assert [found["lower"], found["upper"]] == [significant(end) for end in estimate.interval]


def test_the_picture_comes_first_and_only_numbers_are_unfolded(
    motion: pd.Motion, results: dict[str, Any]
) -> None:
    text = motion._repr_html_()
    folded = re.findall(r"<details( open)?><summary>(\w+)</summary>(.*?)</details>", text)
    assert [(bool(open_), title) for open_, title, _ in folded] == [
        (True, "numbers"),
        (False, "energy"),
        (False, "arrays"),
    ]
    assert text.index("<img") < text.index("<details")
    names = {title: {row[0] for row in Parts(table).rows} for _, title, table in folded}
    assert "transient_settling_time" in names["numbers"] and "position" in names["arrays"]
    assert all(name.startswith("energy_") for name in names["energy"] - {"number"})
    assert "<summary>numbers" not in results["scan"]._repr_html_()  # each has a dimension
    rows = {row[0]: row[1] for row in Parts(results["scan"]._repr_html_()).rows}
    assert " to " not in rows["hand_y"], "the smallest is the largest"


def test_the_derivatives_of_a_motion_as_data_and_as_a_figure(motion: pd.Motion) -> None:
    found = motion.sensitivity(["mass", "plate_kinetic", "mouse_velocity"])
    times = np.linspace(0.0, 0.05, 6)
    data = found.to_dataset(times)
    assert np.array_equal(data.position, found.position(times), equal_nan=True)
    assert data.parameter_unit.values.tolist() == ["kg", "N", "m/s"]
    slopes = found.numbers["transient.swing"]
    assert data.transient_swing.sel(parameter="mass") == slopes["mass"]
    assert data.transient_swing.attrs["units"] == "m"
    axes = found.plot().axes[0]
    curves = {line.get_label(): line for line in axes.lines}
    curve = curves["mass"]
    t = np.asarray(curve.get_xdata())
    assert t[-1] == pytest.approx(1e3 * motion.duration)
    moved = 1e3 * motion.drive.mass * found.position(1e-3 * t)[0]
    np.testing.assert_allclose(np.asarray(curve.get_ydata()), moved, rtol=1e-9, equal_nan=True)
    assert axes.get_xlabel() == "time (ms)" and "(mm)" in axes.get_ylabel()

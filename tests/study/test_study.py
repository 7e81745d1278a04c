"""Studies from Python: equal to studies from files, and rejected arguments."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_array_equal, assert_equal

import pindrive as pd
from pindrive.device import Reading
from pindrive.files.device import DeviceFile
from pindrive.study import Robustness

EXAMPLES = Path(__file__).parents[2] / "examples"
MOUSE = EXAMPLES / "tactile-mouse.toml"
READER = EXAMPLES / "tactile-reader.toml"
FILE = """
base = "{base}"
outputs = ["settling_time", "swing"]
zip = [["drive.mass", "drive.stiffness"]]
[axes]
mass = ["10 g", "12 g"]
drive.stiffness = ["100 N/m", "120 N/m"]
mouse_velocity = {{ lin = ["50 mm/s", "100 mm/s"], count = 3 }}
plate.kinetic = {{ normal = ["20 mN", "2 mN"], within = ["10 mN", "30 mN"] }}
finger.kinetic = {{ lognormal = ["5 mN", 1.2] }}
finger.static = {{ times = 1.5, of = "finger.kinetic" }}
[sample]
count = 7
method = "sobol"
[tolerances]
mass = "5 %"
drive.stiffness = {{ uniform = ["90 N/m", "110 N/m"] }}
[specification]
settling_time = "<= 110 ms"
"""
AXES: dict[str, Any] = {
    "mass": np.array([0.010, 0.012]),
    "drive.stiffness": ["100 N/m", 120.0],
    "mouse_velocity": {"lin": [0.05, "100 mm/s"], "count": np.int64(3)},
    "plate": {"kinetic": {"normal": (0.02, 0.002), "within": [0.01, 0.03]}},
    "finger.kinetic": {"lognormal": [0.005, 1.2]},
    "finger.static": {"times": 1.5, "of": "finger.kinetic"},
}


@pytest.fixture
def mouse() -> DeviceFile:
    return pd.load_device(MOUSE)


def python(mouse: DeviceFile) -> pd.Study:
    return pd.Study(
        mouse,
        AXES,
        ["settling_time", "swing"],
        sample={"count": 7, "method": "sobol"},
        tolerances={"mass": "5 %", "drive.stiffness": {"uniform": [90.0, 110.0]}},
        specification={"settling_time": "<= 110 ms"},
        zip=[("drive.mass", "drive.stiffness")],
    )


def test_python_and_a_file_make_one_study(mouse: DeviceFile, tmp_path: Path) -> None:
    file = tmp_path / "study.toml"
    file.write_text(FILE.format(base=MOUSE.as_posix()), encoding="utf-8")
    written, made = pd.load_study(file), python(mouse)
    assert made.identity() == written.identity()
    assert (made.constraints, made.tolerances) == (written.constraints, written.tolerances)
    one, other = written.run(), made.run()
    assert set(one.variables) == set(other.variables)
    for name, variable in one.variables.items():
        assert_array_equal(variable, other[name])
        assert_equal(dict(variable.attrs), dict(other[name].attrs))
    assert dict(one.sizes) == {"mass": 2, "mouse_velocity": 3, "sample": 7}
    assert np.isfinite(one.transient_settling_time).all()
    assert json.loads(other.attrs["study"])["outputs"] == ["settling_time", "swing"]


def test_each_point_equals_its_release(mouse: DeviceFile) -> None:
    data = pd.Study(mouse, {"mass": [0.008, 0.012]}, ["settling_time"]).run()
    for i, mass in enumerate((0.008, 0.012)):
        from pindrive.motion.simulate import motion_of

        motion = motion_of(pd.load_device(MOUSE, {"mass": mass}))
        settling_time = motion.transient.settling_time
        assert float(data.transient_settling_time[i]) == pytest.approx(settling_time, rel=1e-12)


def test_a_file_of_points_is_kept_and_gone_on_with(mouse: DeviceFile, tmp_path: Path) -> None:
    study, target = python(mouse), tmp_path / "study.nc"
    reported: list[tuple[int, int]] = []
    with study.run(target, progress=lambda done, total: reported.append((done, total))) as data:
        assert reported[-1] == (42, 42)
        again = study.run()
        assert_array_equal(data.transient_swing, again.transient_swing)
    with pytest.raises(ValueError, match=r"study\.nc"):
        study.run(target)
    study.run(target, resume=True).close()


def test_a_study_travels_to_workers(mouse: DeviceFile) -> None:
    study = python(mouse)
    assert pickle.loads(pickle.dumps(study)).identity() == study.identity()


def test_a_study_of_scans_is_the_scans(tmp_path: Path) -> None:
    reader = pd.load_device(READER, ["array.columns=1", "array.rows=2"])
    page = pd.Page(grating=[0.003])
    data = pd.Study(reader, {"hand_speed": [0.04]}, ["shown_part", "lag_on"], page=page).run()
    slow = pd.load_device(READER, ["array.columns=1", "array.rows=2", "hand_speed=40 mm/s"])
    reported = pd.scan(slow, page).evaluate()
    assert float(data.lines_shown_part[0]) == len(reported.shown) / len(reported.lines) == 1.0
    assert float(data.median_lag_on[0]) == reported.spread("line.lag_on")[1]


def test_results_are_data_in_the_order_of_their_labels(mouse: DeviceFile) -> None:
    study = python(mouse)
    found = pd.sobol(study, tolerances=True, numbers=["settling_time", "swing"], rows=128)
    data = found.to_dataset()
    assert [*data.key.values] == ["drive.mass", "drive.stiffness"]
    for number in ("transient_settling_time", "transient_swing"):
        indices = found.over[number]
        row = data.sel(number=number)
        assert_array_equal(row.first_order, indices.first.value)
        assert_array_equal(row.total, indices.total.value)
        assert_array_equal(row.total_low, indices.total.low)
        assert (row.total_low < row.total_high).all()
        assert float(row.spread) == indices.spread
    near = pd.local_sensitivity(study, tolerances=True)
    elasticity = near.to_dataset().elasticity
    for key in near.keys:
        reported = float(elasticity.sel(number="transient_swing", key=key))
        assert reported == near.table["transient_swing"][key]
    assert near.plot().axes[0].get_xticks().tolist() == [0.0, 1.0]


def test_robustness_as_data(mouse: DeviceFile) -> None:
    study = pd.Study(
        mouse,
        tolerances={"mass": "10 %"},
        specification={"settling_time": ["<= 0.118 s", ">= 0.1 s"]},
    )
    found: Robustness = pd.robustness(study, count=400)
    data = found.to_dataset()
    times = data.transient_settling_time
    met = (times <= 0.118).mean(), (times >= 0.1).mean()
    assert 0.0 < met[0] < 1.0
    assert_array_equal(data.met, met)
    assert data.attrs["yield"] == float(((times <= 0.118) & (times >= 0.1)).mean())
    assert_array_equal(data.feasible, (times <= 0.118) & (times >= 0.1))
    ratio = mouse.drive.damping_ratio
    again = pd.simulate_batch(
        mouse.drive, mouse.release, mass=data.mass.values, damping_ratio=ratio
    )
    assert_array_equal(again.transient_settling_time, times)
    assert (data.met_low <= data.met).all()
    assert (data.met <= data.met_high).all()
    assert f"{data.attrs['yield']:.3%}".replace("%", " %") in repr(found)


def test_impossible_draws_have_a_status(mouse: DeviceFile) -> None:
    study = pd.Study(
        mouse,
        tolerances={
            "plate.kinetic": {"uniform": [0.02, 0.03]},
            "plate.static": {"uniform": [0.02, 0.03]},
        },
    )
    found = pd.robustness(study, count=300)
    assert found.status is pd.Status.incomplete
    assert "incomplete" in repr(found)
    assert 0 < found.refused < 300


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"axes": {"mass": [0.01, -0.01]}},
            "Study: axes.drive.mass[1] must be finite and greater than 0 kg, got -0.01 kg",
        ),
        ({"axes": {"mass": ["1 s"]}}, "Study: axes.drive.mass[0] must be in kg or a unit alike"),
        ({"axes": {"kinetic": [1.0]}}, "Study: axes: kinetic may be plate.kinetic, finger.kin"),
        ({"axes": {"mass": [0.01]}, "outputs": ["swin"]}, "Study: outputs: unknown number swin; "),
        ({"axes": [1.0]}, "axes must be a mapping"),
        ({"axes": {"hand_speed": [0.1]}}, "Study: axes: scan.hand_speed acts in a scan"),
        (
            {"axes": {"hand_speed": [0.1]}, "page": pd.Page(image="no.png")},
            "Study: page.image: no.png cannot be read",
        ),
        ({"page": pd.Page()}, "give exactly one of page.text, page.image and page.grating"),
    ],
)
def test_refusals(mouse: DeviceFile, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        pd.Study(mouse, **arguments)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


def test_a_study_of_a_drive_and_its_release_equals_that_of_their_file(mouse: DeviceFile) -> None:
    axes = {"plate.kinetic": [0.02, 0.03], "mouse_velocity": [0.05, 0.1]}
    of_objects = pd.Study(mouse.drive, axes, release=mouse.release).run()
    of_file = pd.Study(mouse, axes).run()
    xr.testing.assert_equal(of_objects.drop_vars("damping"), of_file.drop_vars("damping_ratio"))


def test_a_device_that_is_none_is_refused(mouse: DeviceFile) -> None:
    required = "device must be a DeviceFile, or a Drive with its release"
    with pytest.raises(ValueError, match=required):
        pd.Study(mouse.drive, {"mass": [0.01]})
    with pytest.raises(ValueError, match=required):
        pd.Study(mouse, {"mass": [0.01]}, release=mouse.release)
    with pytest.raises(ValueError, match="device must be a Device or a DeviceFile"):
        pd.scan(mouse.drive, "A")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="has no axes"):
        pd.Study(mouse, tolerances={"mass": "5 %"}).run()


# ---- scans ---------------------------------------------------------------------------------------


def test_scan_uses_the_hand_of_the_device_file() -> None:
    """Hand speed, criteria and angle come from the file; a `Reading` replaces the hand."""
    small = ["array.columns=1", "array.rows=1", "hand_speed=40 mm/s", "felt=0.1 mm"]
    reader = pd.load_device(READER, small)
    done = pd.scan(reader, "I")
    assert done.path.peak_speed == pytest.approx(0.04, rel=1e-3)
    assert done.evaluate().criteria.felt == 1e-4
    assert done.status == done.evaluate().status == pd.Status.ok
    other = pd.scan(reader, "I", Reading(hand_speed=0.08))
    assert other.path.peak_speed == pytest.approx(0.08, rel=1e-3)
    same = pd.scan(reader, done.scene, done.path)
    assert same.pins[0].events == done.pins[0].events
    assert isinstance(done.to_dataset(), xr.Dataset)


def test_a_device_file_without_a_magnet_has_the_usual_one(mouse: DeviceFile) -> None:
    assert mouse.whole is None
    assert pd.scan(mouse, pd.Page(grating=[0.004])).evaluate().lines


def test_an_evaluation_is_data() -> None:
    reader = pd.load_device(READER, ["array.columns=1", "array.rows=2"])
    reported = pd.scan(reader, "Hi").evaluate()
    data = reported.to_dataset()
    assert data.sizes["line"] == len(reported.lines) > 2
    for i, line in enumerate(reported.lines):
        assert int(data.pin[i]) == line.pin
        assert str(data.fate[i].item()) == line.fate
        assert float(data.end_time[i]) == line.end.time
        for name, value in line.numbers.items():
            assert_array_equal(data[name.replace(".", "_")][i], value)
    assert int(data.lines_shown) == len(reported.shown)
    assert data.line_smear.attrs["units"] == "m"


def test_overrides_may_be_a_mapping() -> None:
    device = pd.load_device(MOUSE, {"mass": 0.012, "plate.kinetic": "30 mN"})
    same = pd.load_device(MOUSE, ["mass=12 g", "plate.kinetic=30 mN"])
    assert device.values() == same.values()
    with pytest.raises(ValueError) as refused:
        pd.load_device(MOUSE, {"mass": -1.0})
    assert str(refused.value).startswith('overrides["mass"]: drive.mass must be finite and')
    with pytest.raises(ValueError, match=r'overrides must be a list, like \["mass=12 g"\]'):
        pd.load_device(MOUSE, "mass=12 g")

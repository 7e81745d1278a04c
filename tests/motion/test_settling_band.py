"""The settling band: given in device files, studies, Python or on the command line, used by all."""

from __future__ import annotations

import json
import pickle
from math import inf, isnan, log
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from command import EXAMPLE, GOOD, refused, run
from pindrive import Contact, Drive, Release, Status, simulate, simulate_batch
from pindrive.files.device import load_device
from pindrive.motion.simulate import motion_of
from pindrive.study.robustness import robustness
from pindrive.study.sensitivity import sobol
from pindrive.study.spec import load_study

pytestmark = pytest.mark.usefixtures("in_empty_folder")

BANDS = (0.001, 0.02, 0.05, 0.3)
PIN: dict[str, Any] = {"mass": 0.01, "stiffness": 100.0, "damping": 0.32}


def free(band: float, damping: float = 0.4) -> float:
    """The settling time of a pin without friction that is let go at rest, by its closed form.

    Of x = e^(αt) (cos ωt - α/ω sin ωt) x_0 the last time at which |x| is the band times x_0.
    """
    alpha = -damping / 0.02
    omega = np.sqrt(1e4 - alpha**2)
    t = np.linspace(0.0, 1.2 * log(10.0 / band) / -alpha, 2_000_001)
    wave = np.exp(alpha * t) * (np.cos(omega * t) - alpha / omega * np.sin(omega * t))
    return float(t[np.flatnonzero(np.abs(wave) > band)[-1]])


# ---- Python --------------------------------------------------------------------------------------


@pytest.mark.parametrize("band", [1e-6, *BANDS, 1.0])
def test_the_settling_time_is_that_of_the_closed_form(band: float) -> None:
    """However narrow the band: it is followed until it has settled."""
    drive = Drive(**PIN | {"damping": 0.4}, plate=Contact(0.0), finger=Contact(0.0))
    start = Release(0.0, 1e-3, velocity=0.0)
    motion = simulate(drive, start, settling_band=band)
    expected = free(band) if band < 1.0 else 0.0
    assert motion.transient.settling_time == pytest.approx(expected, abs=1e-6)
    assert motion.settling_band == band
    assert motion.duration > motion.transient.settling_time
    assert simulate(drive, start, settling_band=band, duration=1e-3).duration == 1e-3
    again = pickle.loads(pickle.dumps(motion))
    assert again.transient.settling_time == motion.transient.settling_time
    assert again.settling_band == band


def test_many_points_have_the_band_of_each() -> None:
    bands = np.array([1e-5, *BANDS, 1.0])
    for finger in (0.005, 0.0):
        drive = Drive(**PIN, plate=Contact(0.02), finger=Contact(finger))
        found = simulate_batch(drive, Release(0.06, 2e-3), settling_band=bands)
        motions = [simulate(drive, Release(0.06, 2e-3), settling_band=band) for band in bands]
        expected = [motion.transient.settling_time for motion in motions]
        assert found.transient_settling_time.values.tolist() == pytest.approx(expected, rel=1e-12)
        assert expected == sorted(expected, reverse=True) and expected[0] > expected[-1]
        durations = [motion.duration for motion in motions]
        assert found.duration.values.tolist() == pytest.approx(durations, rel=1e-13)
        assert found.settling_band.attrs["symbol"] == "ε"
    bad = simulate_batch(drive, Release(0.06), settling_band=[0.0, 0.5, 1.5, np.nan])
    assert [Status(code).name for code in bad.status.values] == [
        "bad_settling_band", "ok", "bad_settling_band", "bad_settling_band",
    ]  # fmt: skip


@pytest.mark.parametrize("band", [0, -0.05, 1.01, 5, inf, float("nan"), "5"])
def test_a_band_that_is_none_is_refused(band: float) -> None:
    drive = Drive(**PIN, plate=Contact(0.0), finger=Contact(0.0))
    with pytest.raises(ValueError, match=r"^settling_band must be "):
        simulate(drive, Release(0.1), settling_band=band)


def test_derivatives_are_of_the_time_for_this_band() -> None:
    drive = Drive(**PIN, plate=Contact(0.02), finger=Contact(0.005))
    for band in (0.02, 0.05):
        motion = simulate(drive, Release(0.06, 2e-3), settling_band=band)
        slope = motion.sensitivity(["displacement"]).numbers["transient.settling_time"]
        near = [
            simulate(drive, Release(0.06, x), duration=motion.duration, settling_band=band)
            for x in (2e-3 - 1e-9, 2e-3 + 1e-9)
        ]
        times = [motion.transient.settling_time for motion in near]
        assert slope["displacement"] == pytest.approx((times[1] - times[0]) / 2e-9, rel=1e-5)


# ---- simulate ------------------------------------------------------------------------------------


def banded(text: str = GOOD, band: str = '"2 %"') -> Path:
    """A device file with a band."""
    path = Path("banded.toml")
    path.write_text(text.replace("[motion]", f"[motion]\nsettling_band = {band}"), "utf-8")
    return path


@pytest.mark.parametrize("how", ["file", "command line"])
def test_simulate_reports_uses_and_writes_it(how: str) -> None:
    Path("device.toml").write_text(GOOD)
    arguments: tuple[str | Path, ...] = (
        (banded(),) if how == "file" else ("device.toml", "--set", "settling_band=2 %")
    )
    done = run("simulate", *arguments, "-o", "a.json", "-o", "a.nc", "--plot", "a.svg")
    assert done.exit_code == 0, done.output
    motion = motion_of(load_device("device.toml"))
    time = motion.settling_time(0.02)
    assert time > motion.settling_time(0.05)
    (row,) = (line for line in done.stdout.splitlines() if " t_s " in line)
    assert f"{1e3 * time:.1f}" in row
    assert "from then on within 2 % of the way to the resting place" in row
    written = json.loads(Path("a.json").read_text())
    assert written["numbers"]["transient.settling_time"] == time
    assert written["inputs"]["settling_band"] == written["config"]["motion.settling_band"] == 0.02
    assert written["units"]["settling_band"] == "1"
    with xr.open_dataset("a.nc", decode_timedelta=False) as data:
        assert data.transient_settling_time == time
        assert data.attrs["settling_band"] == 0.02
    assert "± 2 % of" in Path("a.svg").read_text("utf-8")
    assert "within 5 % of the way to" in run("simulate", "device.toml").stdout


def test_check_and_init_show_it() -> None:
    assert run("init", "new.toml").exit_code == 0
    assert "\nsettling_band = 0.05\n" in Path("new.toml").read_text("utf-8")
    (row,) = (x for x in run("check", banded()).stdout.splitlines() if "settling_band" in x)
    assert row.split()[:3] == ["motion.settling_band", "ε", "0.02000"]


@pytest.mark.parametrize(
    ("band", "said"),
    [
        ('"200 %"', 'finite and greater than 0 and at most 1, got "200 %"'),
        ("0", "finite and greater than 0 and at most 1, got 0"),
        ("5", "finite and greater than 0 and at most 1, got 5"),
        ('"2 mm"', 'a plain number or a percentage, like "0.05", got "2 mm"'),
    ],
)
def test_a_bad_band_in_a_file(band: str, said: str) -> None:
    file = banded(band=band)
    assert refused("simulate", file) == f"banded.toml: motion.settling_band must be {said}"


# ---- studies -------------------------------------------------------------------------------------

AXES = '[axes]\nmouse_velocity = ["40 mm/s", "60 mm/s", "90 mm/s"]\n'


@pytest.mark.parametrize("how", ["device", "study", "set in study", "command line", "axis"])
def test_a_sweep_uses_it(how: str) -> None:
    banded(EXAMPLE.read_text("utf-8"))
    base = 'base = "banded.toml"' if how == "device" else f'base = "{EXAMPLE.as_posix()}"'
    text = f"{base}\n{AXES}"
    if how == "study":
        text = banded(EXAMPLE.read_text("utf-8")).read_text("utf-8") + AXES
    if how == "set in study":
        text = f'{base}\n[set]\nsettling_band = "2 %"\n{AXES}'
    if how == "axis":
        text += 'settling_band = ["2 %"]\n'
    Path("study.toml").write_text(text, "utf-8")
    more = ("--set", "settling_band=2 %") if how == "command line" else ()
    done = run("sweep", "study.toml", *more)
    assert done.exit_code == 0, done.output
    with xr.open_dataset("study.nc", decode_timedelta=False) as data:
        assert float(data.settling_band.values.ravel()[0]) == 0.02
        assert data.settling_band.attrs["long_name"].startswith("half-width of the settling band")
        for speed, time in zip(
            data.mouse_velocity.values, data.transient_settling_time.values.ravel(), strict=True
        ):
            motion = motion_of(load_device(EXAMPLE, [f"mouse_velocity={float(speed)!r} m/s"]))
            assert time == pytest.approx(motion.settling_time(0.02), rel=1e-12)
            assert time > motion.settling_time(0.05)
    assert run("map", "study.nc", "--plot", "map.svg").exit_code == 0
    assert "ε" in Path("map.svg").read_text("utf-8")


def test_map_states_an_unusual_band() -> None:
    Path("study.toml").write_text(f'base = "{EXAMPLE.as_posix()}"\n{AXES}')
    run("sweep", "study.toml")
    run("map", "study.nc", "--plot", "map.svg")
    assert "ε" not in Path("map.svg").read_text("utf-8")


def test_sensitivity_and_robustness_use_it() -> None:
    Path("study.toml").write_text(
        f'base = "{EXAMPLE.as_posix()}"\n[tolerances]\ndisplacement = "20 %"\n'
        '[specification]\nsettling_time = "<= 140 ms"\n'
    )
    usual, narrow = (load_study("study.toml", given) for given in ((), ("settling_band=1 %",)))
    numbers = ("transient_settling_time",)
    one, other = (sobol(plan, numbers=numbers, rows=128, near=True) for plan in (usual, narrow))
    assert one.near and other.near
    motion = motion_of(load_device(EXAMPLE))
    assert other.near.values["transient_settling_time"] == motion.settling_time(0.01)
    assert one.near.values["transient_settling_time"] == motion.settling_time(0.05)
    spreads = [found.over["transient_settling_time"].spread for found in (one, other)]
    assert spreads[0] != spreads[1]
    first, second = (robustness(plan, count=200) for plan in (usual, narrow))
    a, b = (found.values["transient_settling_time"] for found in (first, second))
    assert (b >= a).all() and (b > a).any()
    worst = second.worst[0].motion
    assert worst is not None and worst.settling_band == 0.01
    said = run("robustness", "study.toml", "--draws", "200", "--set", "settling_band=1 %").stdout
    (command,) = (line for line in said.splitlines() if line.startswith("Worst settling_time"))
    assert "--set motion.settling_band='1 %'" in command, "as the motion is found again"


def test_a_swept_band_and_slow_devices() -> None:
    """Several bands at once; a friction curve uses the general core."""
    curve = 'curve = [["0 m/s", "20 mN"], ["0.1 m/s", "15 mN"]]'
    Path("curved.toml").write_text(GOOD.replace('kinetic = "20 mN"', curve))
    for device in (EXAMPLE.as_posix(), "curved.toml"):
        Path("study.toml").write_text(f'base = "{device}"\n[axes]\nsettling_band = [0.01, 0.2]\n')
        assert run("sweep", "study.toml", "--force").exit_code == 0
        motion = motion_of(load_device(device))
        with xr.open_dataset("study.nc", decode_timedelta=False) as data:
            expected = [motion.settling_time(band) for band in (0.01, 0.2)]
            found = data.transient_settling_time.values.tolist()
            assert found == pytest.approx(expected, rel=1e-12)


def test_scans_have_no_part_in_it() -> None:
    Path("study.toml").write_text(
        f'base = "{EXAMPLE.as_posix()}"\n[axes]\nsettling_band = [0.1]\n[page]\n'
        'grating = ["4 mm"]\n'
    )
    assert "motion.settling_band has no part in a scan" in refused("sweep", "study.toml")
    assert not isnan(load_device(EXAMPLE).settling_band)

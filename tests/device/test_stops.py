"""Devices with end stops: scans with their events, gaps and continuations; what is said, refused.

The motions themselves are evaluated in tests/core/test_stops.py.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from command import GOOD, refused, run
from figure_reading import collisions, data, events, legend_of, lines, panel, points
from pindrive import Contact, Drive, Release, simulate
from pindrive.device import Device, Electromagnet, HandPath, PinArray, Scan, Scene, scan
from pindrive.plot.motion import plot_motion
from pindrive.quantities.status import Status
from tactile_mouse import SKIN, drive

RIGID = drive(SKIN, travel=5.8e-4)
ELASTIC = replace(RIGID, stop_stiffness=1e4, stop_damping=3.0)
SCENE = Scene.from_grating([0.004, 0.007], count=2, margin=0.03, height=0.004)
PATH = HandPath([0.0, 0.8], [0.06, 0.06], [0.0, 0.0], (0.017, SCENE.lines[0]))


def scanned(drive: Drive) -> Scan:
    array = PinArray([(0.0, 0.0), (0.0031, 0.0)], [(0.0, 0.0), (0.0031, 0.0)])
    magnet = Electromagnet.from_times(hold_force=3.0)
    return scan(Device(drive=drive, magnet=magnet, array=array), SCENE, PATH, threads=1)


@pytest.fixture(scope="module")
def rigid() -> Scan:
    return scanned(RIGID)


@pytest.fixture(scope="module")
def elastic() -> Scan:
    return scanned(ELASTIC)


# ---- scans ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["rigid", "elastic"])
def test_a_scan_follows_end_stops(name: str, request: pytest.FixtureRequest) -> None:
    done: Scan = request.getfixturevalue(name)
    assert done.status == Status.ok
    t = np.linspace(PATH.begin, PATH.end, 20_001)
    for pin in done.pins:
        met = [e.kind for e in pin.events if e.contact == "stop"]
        assert len(met) >= 4 and met == (["stop", "leave"] * len(met))[: len(met)]
        struck = [e for e in pin.events if e.kind == "stop"]
        assert np.abs([e.position for e in struck]) == pytest.approx(5.8e-4, rel=1e-12)
        assert pin.motion.certificate().worst < 1e-11
        beyond = float(np.abs(pin.position(t)).max()) - 5.8e-4
        assert beyond == 0.0 if name == "rigid" else 0.0 < beyond < 3e-4
    behind, ahead = done.pins
    (gap,) = done.gaps
    apart = 0.0031 - 0.0015 + behind.position(t) - ahead.position(t)
    assert 0.0 <= apart.min() - gap.size < 1e-6
    at = float(behind.position(gap.time)) - float(ahead.position(gap.time))
    assert gap.size == pytest.approx(0.0016 + at, abs=1e-15)


def test_a_scan_goes_on_from_a_stop(rigid: Scan) -> None:
    """A scan is cut within some roundings of an impact."""
    first = rigid.pins[0]
    held = [e.time for e in first.events if e.contact == "stop"][:4]
    cuts = [e + k * np.spacing(e) for e in held for k in (-3, 0, 2)]
    alone = replace(rigid.device, array=PinArray())
    for cut in [*cuts, 0.5 * (held[0] + held[1])]:
        before = scan(alone, SCENE, PATH.between(0.0, cut), threads=1)
        (state,) = before.state
        assert abs(state.position) <= 5.8e-4
        after = scan(alone, SCENE, PATH.between(cut, 0.8), threads=1, start=[state])
        t = np.linspace(cut, 0.8, 101)
        assert after.pins[0].position(t) == pytest.approx(first.position(t), abs=1e-13)


def test_a_rigid_stop_bounds_how_far_a_pin_goes(rigid: Scan, elastic: Scan) -> None:
    far = replace(rigid.device, drive=replace(RIGID, travel=0.5))
    reach = far.excursion(0.06)
    assert reach == elastic.device.excursion(0.06) > 5.8e-4 == rigid.device.excursion(0.06)


# ---- the picture of a motion ---------------------------------------------------------------------


@pytest.mark.parametrize("stiffness", [None, 1e4])
def test_the_picture_shows_the_stops(stiffness: float | None) -> None:
    drive = replace(RIGID, finger=Contact(0.02, 0.03), stop_stiffness=stiffness)
    motion = simulate(drive, Release(0.06, 0.0, velocity=0.4))
    figure = plot_motion(motion)
    key = legend_of(panel(figure, "key"))
    kinds = {e.kind for e in motion.events if e.contact == "stop"}
    assert ("strikes an end stop" in key) and ("leaves an end stop" in key) == ("leave" in kinds)
    sides = sorted({np.sign(e.position) for e in motion.events if e.contact == "stop"})
    for axes, along in (("x", 1), ("portrait", 0)):
        drawn = [points(line)[along][0] for line in lines(panel(figure, axes), "end stop")]
        assert drawn == pytest.approx([0.58 * side for side in sides])
    assert "end stop" in key and "resting on the finger" not in key
    times = [1e3 * e.time for e in motion.events if e.kind == "stop"]
    assert events(panel(figure, "v"), "stop", "stop")[0] == pytest.approx(times)
    t, v = data(panel(figure, "v"), "curve")
    struck = v[np.abs(t - times[0]) < 1e-9]
    limits = [1e3 * motion.velocity(times[0] / 1e3, side) for side in ("left", "right")]
    assert struck == pytest.approx(limits), "it jumps at a rigid stop, and does not slope"
    assert (struck[1] == 0.0) == (stiffness is None)
    assert r"$x_\mathrm{s}$ = 0.58 mm" in figure.get_suptitle()
    assert (r"$k_\mathrm{s}$" in figure.get_suptitle()) == (stiffness is not None)
    assert collisions(figure) == []


def test_the_picture_of_stops_far_away_does_not_show_them() -> None:
    motion = simulate(replace(RIGID, travel=0.5), Release(0.06, 2e-3))
    figure = plot_motion(motion)
    assert not lines(panel(figure, "x"), "end stop")
    assert "end stop" not in legend_of(panel(figure, "key"))


# ---- what is said and refused --------------------------------------------------------------------


def with_stops(text: str, more: str = "") -> None:
    Path("device.toml").write_text(
        GOOD.replace("[drive]", f"[drive]\n{text}") + 'displacement = "2 mm"\n' + more
    )


@pytest.mark.usefixtures("in_empty_folder")
def test_check_compares_stops_and_slot() -> None:
    with_stops('travel = "2 mm"', '\n[array]\nslot_length = "4.2 mm"\n')
    checked = run("check", "device.toml")
    assert checked.exit_code == 0
    assert (
        "warning: end stops outside the slot: drive.travel is 2.000 mm either way, and in a slot "
        "(array.slot_length) of 4.200 mm a pin 1.500 mm wide (array.pin_diameter) has 1.350 mm"
    ) in checked.stderr.splitlines()
    assert "The end stops are 2.000 mm either way, and a pin " in " ".join(checked.stdout.split())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            'travel = "0 mm"',
            'drive.travel must be finite and greater than 0 m, got "0 mm"',
        ),
        (
            'travel = "-1 mm"',
            'drive.travel must be finite and greater than 0 m, got "-1 mm"',
        ),
        (
            'travel = "1.9 mm"',
            "motion.displacement must be at most travel, 0.0019 m, either way, got 0.002 m",
        ),
        (
            'stop_stiffness = "10 kN/m"',
            "drive.stop_stiffness must be left out without travel, as there are no end stops, got "
            "10000.0 N/m",
        ),
    ],
)
@pytest.mark.usefixtures("in_empty_folder")
def test_stops_inside_the_rest_position_are_refused(text: str, message: str) -> None:
    with_stops(text)
    assert refused("check", "device.toml") == f"device.toml: {message}"

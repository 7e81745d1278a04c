"""A motion as Python sees it: shapes, limits at events, and what it refuses."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pindrive import Contact, Drive, Motion, Profile, Release, load_device, simulate

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

DRIVE = Drive(
    mass=0.010, stiffness=100.0, damping=0.32, plate=Contact(0.022, 0.0265), finger=Contact(0.005)
)


@pytest.fixture(scope="module")
def motion() -> Motion:
    return simulate(DRIVE, Release(0.06, 2e-3))


def test_a_time_gives_a_float_and_times_an_array_of_their_shape(motion: Motion) -> None:
    for of in (motion.position, motion.velocity, motion.acceleration):
        assert type(of(0.01)) is float
        assert type(of(np.float64(0.01))) is float
        for shape in ((0,), (1,), (3,), (2, 3), (2, 0, 3)):
            assert of(np.full(shape, 0.01)).shape == shape
        grid = np.linspace(0.0, 0.2, 12).reshape(3, 4)
        assert np.array_equal(of(grid.T), of(grid).T), "an array that is not in C order"
        assert of([0.01, 0.02]).tolist() == [of(0.01), of(0.02)]


@pytest.mark.parametrize(
    ("changes", "others"),
    [
        ({}, set()),
        ({"finger": Contact(0.02, 0.03, stiffness=300.0)}, {"stretch", "stretch_rate"}),
        ({"travel": 2e-3}, {"stop_force"}),
        ({"travel": 1e-3, "stop_stiffness": 2e3}, {"stop_force"}),
        ({"plate": Contact(curve=((0.0, 0.03), (0.1, 0.02)))}, set()),
    ],
)
def test_all_columns_at_once_are_each_by_itself(changes: dict[str, Any], others: set[str]) -> None:
    """Bit for bit, at times in any order; under a load that changes some segments are series."""
    load = Profile([0.0, 0.05], [1.0, 0.3])
    motion = simulate(replace(DRIVE, **changes), Release(0.06, 2e-3, plate_load=load))
    ends = [segment.end for segment in motion.segments]
    ordered = np.union1d(np.linspace(0.0, motion.duration, 97), np.minimum(ends, motion.duration))
    for t in (ordered, np.random.default_rng(5).permutation(ordered), ordered[:1], ordered[:0]):
        found = motion.columns(t)
        expected = {
            "position": motion.position(t),
            "velocity": motion.velocity(t),
            "acceleration": motion.acceleration(t),
            "plate_force": motion.force("plate", t),
            "finger_force": motion.force("finger", t),
            "housing_force": motion.housing_force(t),
            "stop_force": motion.force("stop", t),
            "stretch": motion.stretch(t),
            "stretch_rate": motion.stretch_rate(t),
        }
        assert found.keys() == {*expected} - {"stop_force", "stretch", "stretch_rate"} | others
        for name, column in found.items():
            assert np.array_equal(column, expected[name]), name
        one_by_one = [[motion.position(float(time)), motion.velocity(float(time))] for time in t]
        both = np.reshape(one_by_one, (-1, 2)).T
        assert np.array_equal(np.stack([found["position"], found["velocity"]]), both)


def test_the_limits_at_an_event_are_those_from_its_sides(motion: Motion) -> None:
    """Friction jumps, and the acceleration with it; just beside the event they are the limits."""
    assert {event.kind for event in motion.events} == {"reverse", "stick", "slip"}
    beside = 1e-9
    for event in motion.events:
        jump = 0.0
        for contact in ("plate", "finger"):
            left, right = (motion.force(contact, event.time, side) for side in ("left", "right"))
            assert motion.force(contact, event.time - beside) == pytest.approx(left, abs=1e-7)
            assert motion.force(contact, event.time + beside) == pytest.approx(right, abs=1e-7)
            jump += right - left
        left, right = (motion.acceleration(event.time, side) for side in ("left", "right"))
        assert motion.acceleration(event.time - beside) == pytest.approx(left, abs=1e-5)
        assert motion.acceleration(event.time + beside) == pytest.approx(right, abs=1e-5)
        assert DRIVE.mass * (right - left) == pytest.approx(jump, abs=1e-15)


def released(duration: float | None = None, **changes: Any) -> Motion:
    return simulate(DRIVE, Release(**({"mouse_velocity": 0.06} | changes)), duration=duration)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mouse_velocity": math.nan}, "mouse_velocity must be finite, got nan m/s"),
        ({"mouse_velocity": b"1"}, "mouse_velocity must be a number in m/s, got b'1'"),
        ({"displacement": math.inf}, "displacement must be finite, got inf m"),
        ({"velocity": -math.inf}, "velocity must be finite, got -inf m/s"),
        ({"plate_load": -1.0}, "plate_load must be finite and at least 0, got -1.0"),
        ({"duration": 0.0}, "duration must be finite and greater than 0 s, got 0.0 s"),
        ({"duration": math.inf}, "duration must be finite and greater than 0 s, got inf s"),
    ],
)
def test_a_bad_release_is_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        released(**changes)
    assert str(refused.value) == message


@pytest.mark.parametrize("time", [-1e-9, math.nan, math.inf, [0.0, -1.0], "soon"])
def test_a_bad_time_is_refused(motion: Motion, time: Any) -> None:
    for of in (motion.position, motion.columns):
        with pytest.raises(ValueError, match="t must be"):
            of(time)


def test_a_time_beyond_what_is_known_is_refused() -> None:
    cut = simulate(DRIVE, Release(0.06, 2e-3), duration=0.05)
    assert cut.ending.kind == "moving"
    with pytest.raises(ValueError, match=r"t must be from 0 s to 0\.05 s, got 0\.06 s"):
        cut.position([0.01, 0.06])


def test_a_bad_name_is_refused(motion: Motion) -> None:
    nowhere: Any = "up"
    with pytest.raises(ValueError, match="side must be"):
        motion.velocity(0.0, nowhere)
    with pytest.raises(ValueError, match="contact must be"):
        motion.force(nowhere, 0.0)


def test_plate_load_multiplies_the_friction_of_the_plate() -> None:
    doubled = Drive(
        mass=0.010,
        stiffness=100.0,
        damping=0.32,
        plate=Contact(0.044, 0.053),
        finger=Contact(0.005),
    )
    pressed = simulate(DRIVE, Release(0.06, 2e-3, plate_load=2.0))
    assert pressed.events == simulate(doubled, Release(0.06, 2e-3)).events
    assert pressed.events != simulate(DRIVE, Release(0.06, 2e-3)).events


def test_device_file_is_simulated_with_all_its_values() -> None:
    device = load_device(EXAMPLES / "tactile-mouse.toml", ["motion.settling_band=0.1"])
    motion = simulate(device)
    assert motion.release == device.release
    assert motion.settling_band == 0.1
    assert simulate(device, duration=0.01).duration == 0.01
    assert simulate(device, device.release.replace(displacement=1e-3)).position(0.0) == 1e-3
    with pytest.raises(ValueError, match="release must be a Release, got None"):
        simulate(device.drive)

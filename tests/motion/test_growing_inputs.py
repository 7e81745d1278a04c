"""Endings under inputs that grow for ever."""

from __future__ import annotations

from itertools import product
from math import inf, isnan

import numpy as np
import pytest

from pindrive import Contact, Drive, Function, Motion, Profile, Release, simulate
from pindrive.motion.function import InputPiece, InputTerm

NONE = Contact(kinetic=0.0)
BASES = {
    "mouse_velocity": 0.05,
    "plate_load": 1.0,
    "force": 0.0,
    "across_velocity": 0.02,
    "finger_load": 1.0,
}
SLOPE = 0.2
DAMPINGS = (0.0, 0.5, 20.0, 50.0)
"""Undamped, underdamped, critically damped and overdamped, N s/m, beside 1 kg and 100 N/m."""
LATE = 40.0
"""S."""


def body(**changes: object) -> Drive:
    given = {"mass": 1.0, "stiffness": 100.0, "damping": 0.0, "plate": NONE, "finger": NONE}
    return Drive(**given | changes)  # type: ignore[arg-type]


def ramp(slope: float, base: float = 0.0) -> Function:
    return Function([InputPiece(0.0, (base, slope))])


def released(name: str, given: Function | Profile) -> Release:
    base = Release(BASES["mouse_velocity"], displacement=0.02, velocity=BASES["mouse_velocity"])
    return base.replace(**{name: given})


@pytest.mark.parametrize("name", BASES)
@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_ending_under_growing_input_is_right_at_later_times(name: str, friction: float) -> None:
    base = BASES[name]
    shapes = {
        "linear": Function([InputPiece(0.0, (base, SLOPE))]),
        "quadratic": Function([InputPiece(0.0, (base, 0.0, SLOPE))]),
        "cubic": Function([InputPiece(0.0, (base, SLOPE, SLOPE, SLOPE))]),
        "ramp and sinusoid": Function(
            [InputPiece(0.0, (base, SLOPE), (InputTerm(sine=0.05, frequency=7.0),))]
        ),
    }
    for (shape, given), damping, duration in product(shapes.items(), DAMPINGS, (1.0, 10.0)):
        drive = body(
            damping=damping, plate=Contact(kinetic=0.5 * friction), finger=Contact(friction)
        )
        motion = simulate(drive, released(name, given), duration=duration)
        assert repr(motion)
        assert motion.status.name == "ok", (shape, damping)
        assert motion.to_dataset().sizes["time"] > 1000
        if motion.ending.kind == "moving":
            assert isnan(motion.ending.position)
            continue
        later = simulate(drive, released(name, given), duration=LATE)
        times = np.linspace(0.0, LATE, 401)
        np.testing.assert_allclose(
            motion.position(times), later.position(times), rtol=1e-9, atol=1e-12
        )
        assert motion.ending.end == later.ending.end
        check_claim(later, shape, name, friction)


def check_claim(motion: Motion, shape: str, name: str, friction: float) -> None:
    """Compare what an ending says with the last seconds of the motion."""
    times = np.linspace(LATE - 5.0, LATE, 501)
    x, end = motion.position(times), motion.ending
    if end.kind == "resting":
        assert np.all(x == end.position)
        return
    if friction and name != "mouse_velocity":  # under which the inertial force is constant
        assert end.kind == "drifting"
    if end.kind == "drifting":
        assert shape == "linear"
        line = end.position + end.drift_velocity * times
        assert np.ptp(x - line) <= (0.05 if motion.drive.damping == 0.0 else 1e-4)
        if motion.drive.damping > 0.0:
            np.testing.assert_allclose(x, line, atol=1e-5)
    elif end.kind == "decaying":
        np.testing.assert_allclose(x, end.position, atol=1e-5)
    else:
        assert end.cycle == "free"
        assert np.ptp(x) == pytest.approx(2.0 * end.amplitude, rel=1e-2)


@pytest.mark.parametrize(("damping", "position"), [(0.0, 4.448894637), (5.0, 4.250000001)])
def test_block_pulled_by_growing_force_drifts(damping: float, position: float) -> None:
    drive = body(stiffness=2.0, damping=damping, finger=Contact(1.0))
    motion = simulate(drive, Release(0.0, velocity=0.0, force=ramp(0.2)), duration=50.0)
    assert motion.position(50.0) == pytest.approx(position, abs=1e-9)
    assert motion.ending.kind == "drifting"
    assert motion.ending.drift_velocity == pytest.approx(0.1, rel=1e-15)
    assert motion.ending.lag == pytest.approx((1.0 + damping * 0.1) / 2.0, rel=1e-14)
    assert motion.transient.settled == (damping > 0.0)
    assert "drifting" in repr(motion)


@pytest.mark.parametrize(
    "slope", [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 150.0, 180.0, 200.0]
)
def test_settling_time_of_drift_is_that_about_its_line(slope: float) -> None:
    drive = body(mass=0.01, damping=0.4, finger=Contact(3.0))
    motion = simulate(drive, Release(0.0, velocity=0.0, force=ramp(slope)), duration=10.0)
    end, settled = motion.ending, motion.transient.settling_time
    width = motion.settling_band * abs(end.position)

    def away(t: float) -> float:
        return abs(motion.position(t) - end.position - end.drift_velocity * t)

    assert away(settled) == pytest.approx(width, rel=1e-6)
    assert away(settled - 1e-6) > width
    times = np.linspace(settled, 10.0, 20_001)[1:]
    line = end.position + end.drift_velocity * times
    assert np.all(np.abs(motion.position(times) - line) <= width)


def test_ramp_in_rows_has_positions_of_ramp_as_function() -> None:
    drive = body(damping=0.5, finger=Contact(3.0))
    rows = Profile([0.0, 10.0], [0.0, 50.0])
    drifting = simulate(drive, Release(0.0, velocity=0.0, force=ramp(5.0)), duration=10.0)
    moving = simulate(drive, Release(0.0, velocity=0.0, force=rows), duration=10.0)
    times = np.linspace(0.0, 10.0, 1001)
    np.testing.assert_allclose(drifting.position(times), moving.position(times), atol=1e-14)
    assert moving.ending.kind == "moving"


def test_pin_carried_for_ever_by_growing_load_drifts_with_the_plate() -> None:
    drive = body(damping=2.0, plate=Contact(10.0))
    motion = simulate(drive, Release(0.05, plate_load=ramp(1.0, 1.0)), duration=5.0)
    assert motion.ending.kind == "drifting"
    assert motion.ending.drift_velocity == 0.05
    assert isnan(motion.ending.lag)
    assert motion.position(1000.0) == pytest.approx(50.0, rel=1e-14)


def test_sliding_friction_that_grows_carries_a_slower_drift() -> None:
    drive = body(damping=2.0, plate=Contact(1.0))
    release = Release(0.5, velocity=0.0, plate_load=ramp(0.2, 1.0))
    motion = simulate(drive, release, duration=20.0)
    assert motion.ending.kind == "drifting"
    assert motion.ending.drift_velocity == pytest.approx(0.002, rel=1e-14)
    assert isnan(motion.ending.lag)


def test_contacts_have_no_power_of_a_period_beside_an_accelerating_plate() -> None:
    release = released("mouse_velocity", ramp(SLOPE, 0.05))
    resting = simulate(
        body(damping=0.5, plate=Contact(0.5), finger=Contact(1.0)), release, duration=9.0
    )
    free = simulate(body(plate=Contact(0.5)), release, duration=9.0)
    assert (resting.ending.kind, free.ending.cycle) == ("resting", "free")
    assert isnan(resting.ending.plate.power)
    assert isnan(free.ending.plate.distance_slid)


def test_growing_inputs_without_duration_are_rejected() -> None:
    with pytest.raises(ValueError, match="duration must be given under functions that neither end"):
        simulate(body(), Release(0.0, velocity=0.0, force=ramp(1.0)))


def test_motion_that_drifts_is_known_at_all_times() -> None:
    drive = body(damping=0.5, finger=Contact(3.0))
    motion = simulate(drive, Release(0.0, velocity=0.0, force=ramp(5.0)), duration=2.0)
    assert motion.core.known_until == inf
    assert motion.certificate().worst < 1e-12
    assert motion.numbers()["ending.drift_velocity"] == pytest.approx(0.05)

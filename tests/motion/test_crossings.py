"""Extrema, crossings of a level and the events of repeated cycles, against oracles and laws."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from drives import Case, cases
from oracle import explicit_modes
from pindrive import Contact, Drive, Motion, Profile, Release, simulate
from pindrive.motion.results import QuantityName
from pindrive.quantities import budgets

QUANTITIES: tuple[QuantityName, ...] = ("position", "velocity", "acceleration")
DAMPED = {
    "mass": 0.010,
    "stiffness": 100.0,
    "damping": 0.08,
    "plate_kinetic": 0.020,
    "plate_static": 0.026,
    "finger_kinetic": 0.004,
    "finger_static": 0.005,
    "mouse_velocity": 0.07,
    "displacement": 2e-3,
    "velocity": 0.07,
}
CYCLE = Drive(
    mass=0.010, stiffness=100.0, damping=0.4, plate=Contact(0.1, 0.3), finger=Contact(0.0)
)
"""Sticks and slips for ever."""


def damped(duration: float) -> tuple[explicit_modes.Run, Motion]:
    run = explicit_modes.solve(DAMPED, duration)
    drive = Drive(
        mass=DAMPED["mass"],
        stiffness=DAMPED["stiffness"],
        damping=DAMPED["damping"],
        plate=Contact(DAMPED["plate_kinetic"], DAMPED["plate_static"]),
        finger=Contact(DAMPED["finger_kinetic"], DAMPED["finger_static"]),
    )
    motion = simulate(drive, Release(0.07, 2e-3), duration=duration)
    return run, motion


def roots(
    f: Callable[[float], float], duration: float, level: float = 0.0
) -> list[tuple[float, int]]:
    """Crossings of a level between fine samples, by Brent's method, and their directions."""
    grid = np.linspace(0.0, duration, 3001).tolist()
    values = [f(t) - level for t in grid]
    return [
        (brentq(lambda t: f(t) - level, low, high, xtol=1e-14), 1 if b > 0.0 else -1)
        for low, high, a, b in zip(grid, grid[1:], values, values[1:], strict=False)
        if a * b < 0.0
    ]


@pytest.mark.parametrize("index", range(3))
def test_crossings_are_those_of_an_integration(index: int) -> None:
    """SciPy's integration in modes of its own, sampled finely, its roots by Brent's method."""
    duration = 0.15
    run, motion = damped(duration)
    scale = max(abs(run.at(t)[index]) for t in np.linspace(0.0, duration, 500))
    for part in (-0.2, 0.013, 0.2, 0.45):
        level = part * scale
        expected = roots(lambda t: run.at(t)[index], duration, level)
        found = motion.crossings(QUANTITIES[index], level)
        assert found.direction.tolist() == [direction for _, direction in expected]
        assert found.time == pytest.approx([time for time, _ in expected], abs=3e-9)
        assert expected or part < 0.0


def test_extrema_of_the_position_are_those_of_an_integration() -> None:
    duration = 0.15
    run, motion = damped(duration)
    turns = [time for time, _ in roots(lambda t: run.at(t)[1], duration)]
    time, value = motion.extrema("position")
    assert time[[0, -1]].tolist() == [0.0, duration]
    assert time[1:-1] == pytest.approx(turns, abs=1e-8)
    assert value == pytest.approx([run.at(t)[0] for t in time], abs=1e-11)


def test_a_free_oscillation_in_closed_form() -> None:
    """X = A cos ωt: extrema at multiples of half a period, crossings of A/2 at ±60 degrees."""
    drive, omega = (
        Drive(mass=0.010, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=Contact(0.0)),
        100.0,
    )
    motion = simulate(drive, Release(1.0, 1e-3, 0.0), duration=0.1)
    time, value = motion.extrema("position")
    assert time[:-1] == pytest.approx(np.arange(4) * pi / omega, abs=1e-16)
    assert value[:-1] == pytest.approx([1e-3, -1e-3, 1e-3, -1e-3], rel=1e-15)
    crossings = motion.crossings("position", 0.5e-3)
    phases = np.array([1.0, 5.0, 7.0]) * pi / 3.0
    assert crossings.time == pytest.approx(phases / omega, rel=1e-14)
    assert crossings.direction.tolist() == [-1, 1, -1]
    assert not motion.crossings("position", 1e-3).time.size, "touched is not crossed"
    fastest = motion.extrema("velocity")
    assert fastest.time[1:-1] == pytest.approx((np.arange(3) + 0.5) * pi / omega, rel=1e-14)


def test_both_sides_of_a_jump_of_the_acceleration_are_extrema() -> None:
    motion = simulate(CYCLE, Release(0.05))
    time, value = motion.extrema("acceleration")
    jumps = np.flatnonzero(np.diff(time) == 0.0)
    assert jumps.size > 3
    once = motion.segments[-1].end  # a cycle goes on from here, its times to rounding
    for i in jumps[time[jumps] < once]:
        left, right = (motion.acceleration(time[i], side) for side in ("left", "right"))
        assert value[i : i + 2] == pytest.approx([left, right], rel=1e-9, abs=1e-9)


def test_pin_that_rests_before_a_turn_turns_at_its_rest() -> None:
    """A pin held by the finger until the mouse pulls it on: the rest is one extremum."""
    drive = Drive(
        mass=0.010, stiffness=100.0, damping=2.0, finger=Contact(0.05), plate=Contact(0.3)
    )
    velocity = Profile([0.0, 0.05, 0.2, 0.3], [0.0, 0.0, 0.0, 0.04])
    motion = simulate(
        drive,
        Release(velocity, 2e-3, 0.0, plate_load=Profile([0.0, 0.19, 0.2], [0.0, 0.0, 1.0])),
        duration=0.3,
    )
    rest = next(e for e in motion.events if e.kind == "stick")
    time, value = motion.extrema("position")
    assert rest.time in time.tolist()
    assert value[time.tolist().index(rest.time)] == rest.position
    assert len(time) == 3


def test_events_of_a_cycle_come_again() -> None:
    motion = simulate(CYCLE, Release(0.05))
    assert motion.ending.cycle == "stick-slip"
    period = motion.ending.period
    assert motion.events_between(0.0, motion.events[-1].time) == motion.events
    far = 1000.0
    found = motion.events_between(far, far + 3.5 * period)
    assert 3 <= sum(e.kind == "slip" for e in found) <= 4
    assert all(far <= event.time <= far + 3.5 * period for event in found)
    for event in found:
        assert event.position == pytest.approx(motion.position(event.time))
    steps = [b.time - a.time for a, b in zip(found, found[2:], strict=False)]
    assert steps == pytest.approx([period] * len(steps), rel=1e-9)


@given(cases())
def test_samples_lie_between_neighbouring_extrema(case: Case) -> None:
    motion = case.run()
    t = np.linspace(0.0, motion.duration, 97)
    for which in QUANTITIES:
        time, value = motion.extrema(which)
        assert (np.diff(time) >= 0.0).all()
        i = np.clip(np.searchsorted(time, t, "left"), 1, len(time) - 1)
        samples = getattr(motion, which)(t, "left")
        low, high = np.minimum(value[i - 1], value[i]), np.maximum(value[i - 1], value[i])
        slack = 1e-9 * np.abs(value).max()
        beside = np.minimum(np.abs(time[i] - t), np.abs(t - time[i - 1])) > 1e-9 * motion.duration
        assert ((low - slack <= samples) & (samples <= high + slack))[beside].all()


@given(cases(), st.sampled_from(QUANTITIES), st.floats(-0.9, 0.9))
def test_crossings_alternate(case: Case, which: QuantityName, part: float) -> None:
    motion = case.run()
    level = part * float(np.abs(motion.extrema(which).value).max())
    time, direction = motion.crossings(which, level)
    assert (direction[1:] == -direction[:-1]).all()
    assert (np.diff(time) >= 0.0).all()
    assert ((time >= 0.0) & (time <= motion.duration)).all()


def test_invalid_values_are_refused() -> None:
    motion = simulate(CYCLE, Release(0.05))
    with pytest.raises(ValueError, match=r"which must be 'position' or .*, got 'force'"):
        motion.extrema("force")  # type: ignore[arg-type]
    for level in (nan, inf):
        with pytest.raises(ValueError, match="level must be finite, got"):
            motion.crossings("position", level)
    with pytest.raises(ValueError, match=r"begin must be at most end \(1\.0 s\), got 2\.0 s"):
        motion.events_between(2.0, 1.0)
    with pytest.raises(ValueError, match="end must be finite and at least 0 s, got inf s"):
        motion.events_between(0.0, inf)


def test_more_than_the_budget_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budgets, "MOMENTS", budgets.Budget("the moments", 10, "for this test"))
    motion = simulate(CYCLE, Release(0.05))
    with pytest.raises(ValueError, match="the moments must be at most 10, got 11"):
        motion.events_between(0.0, 1e9)

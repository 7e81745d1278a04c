"""End stops: an integration with events, closed forms, laws, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, replace
from math import exp, inf, pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pindrive import (
    Contact,
    Drive,
    Motion,
    Profile,
    Release,
    simulate,
    simulate_batch,
)

FREE = Drive(
    mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=Contact(0.0), travel=1e-3
)
ELASTIC = replace(FREE, damping=0.2, stop_stiffness=1e4, stop_damping=3.0)
RUBBED = replace(ELASTIC, plate=Contact(0.03, 0.05), finger=Contact(0.02, 0.03))


def reported(motion: Motion) -> list[tuple[str, str]]:
    return [(event.contact, event.kind) for event in motion.events]


def laws(motion: Motion) -> None:
    assert motion.certificate().worst < 1e-11
    assert motion.events_between(0.0, motion.duration) == motion.events
    ledger = motion.energy
    assert abs(ledger.residual) < 1e-12 * max(map(abs, astuple(ledger)))
    assert min(ledger.stop_dissipated, ledger.plate_dissipated, ledger.finger_dissipated) >= 0.0


def test_a_rigid_stop_takes_the_velocity_and_a_free_pin_sets_out_again() -> None:
    """From rest at x = 0 with 0.3 m/s: the spring alone would turn it at 3 mm."""
    motion = simulate(FREE, Release(0.0, 0.0, velocity=0.3), duration=0.1)
    w, v = 100.0, 0.3
    time = np.arcsin(1e-3 * w / v) / w
    assert reported(motion)[0] == ("stop", "stop")
    first = motion.events[0]
    assert first.time == pytest.approx(time, rel=1e-14)
    assert (first.position, first.velocity) == (1e-3, 0.0)
    struck = float(motion.velocity(first.time, side="left"))
    assert struck == pytest.approx(sqrt(v * v - 1e-6 * w * w), rel=1e-13)
    assert motion.energy.stop_dissipated == pytest.approx(0.5 * 0.01 * struck**2, rel=1e-13)
    t = np.linspace(0.0, pi / w, 50)
    assert motion.position(first.time + t) == pytest.approx(1e-3 * np.cos(w * t), abs=1e-17)
    laws(motion)
    assert motion.transient.peak_displacement == 1e-3
    assert motion.transient.peak_time == first.time


def test_a_pin_is_held_until_what_presses_it_changes_sides() -> None:
    """A force presses it to the stop and falls below the spring's at 60 ms."""
    push = Profile([0.0, 0.02, 0.1], [0.3, 0.3, -0.1])
    drive = replace(FREE, damping=0.5)
    motion = simulate(drive, Release(0.0, 0.0, velocity=0.0, force=push), duration=0.15)
    assert reported(motion)[:2] == [("stop", "stop"), ("stop", "leave")]
    leaves = motion.events[1].time
    assert float(push(leaves)) == pytest.approx(0.1, rel=1e-12), "the spring's force"
    t = np.linspace(motion.events[0].time, leaves, 40)
    assert np.array_equal(motion.position(t), np.full(40, 1e-3))
    assert motion.force("stop", t[:-1]) == pytest.approx(0.1 - push(t[:-1]), abs=1e-15)
    assert [s.mode for s in motion.segments][1] == "resting"
    laws(motion)


@pytest.mark.parametrize("damping", [0.0, 3.0, 40.0])
def test_an_elastic_stop_against_an_integration_with_events(damping: float) -> None:
    drive = replace(ELASTIC, stop_damping=damping)
    motion = simulate(drive, Release(0.0, 0.0, velocity=0.4), duration=0.08)

    def push(x: float, v: float) -> float:
        depth, side = abs(x) - 1e-3, np.sign(x)
        return float(side * max(0.0, 1e4 * depth + damping * side * v)) if depth > 0.0 else 0.0

    def right(_: float, y: np.ndarray) -> list[float]:
        return [y[1], (-100.0 * y[0] - 0.2 * y[1] - push(y[0], y[1])) / 0.01]

    t, y = [0.0], np.array([[0.0], [0.4]])
    for end in [e.time for e in motion.events] + [0.08]:  # it is told where the equation bends
        done = solve_ivp(
            right,
            (t[-1], end),
            y[:, -1],
            "DOP853",
            np.linspace(t[-1], end, 20),
            rtol=1e-12,
            atol=1e-15,
        )
        t, y = [*t, *done.t[1:]], np.hstack([y, done.y[:, 1:]])
    assert np.abs(motion.position(np.array(t)) - y[0]).max() < 1e-11
    assert np.abs(motion.velocity(np.array(t), side="left") - y[1]).max() < 1e-8
    assert set(reported(motion)) == {("stop", "stop"), ("stop", "leave")}
    of_stop = motion.force("stop", np.array(t))
    assert (of_stop[np.array(t) > 0] * y[0, np.array(t) > 0] <= 1e-12).all(), "it never pulls"
    laws(motion)


@pytest.mark.parametrize("stiffness", [None, 1e4])
def test_the_plate_carries_a_pin_to_the_stop_and_slides_on(stiffness: float | None) -> None:
    drive = replace(
        RUBBED,
        plate=Contact(0.5, 0.6),
        stop_stiffness=stiffness,
        stop_damping=3.0 if stiffness else None,
    )
    motion = simulate(drive, Release(0.06, 0.0))
    assert motion.ending.kind == "resting"
    assert motion.ending.position == pytest.approx(1e-3, rel=1e-12 if stiffness is None else 0.05)
    assert ("stop", "stop") in reported(motion) and motion.segments[0].mode == "carried"
    assert motion.events[0].time == pytest.approx(1e-3 / 0.06, rel=1e-12)
    laws(motion)


@pytest.mark.parametrize("oblique", [0.0, 0.03])
def test_every_mode_meets_a_stop(oblique: float) -> None:
    """A curve under a changing load, skin, an oblique hand."""
    curve = Contact(curve=[(0.0, 0.3), (0.05, 0.2), (0.3, 0.25)], static=0.4)
    load = Profile([0.0, 0.03, 0.05, 0.08], [1.0, 2.0, 0.1, 1.0])
    for finger in (Contact(0.02, 0.03), Contact(0.02, 0.03, stiffness=800.0)):
        for stiffness in (None, 1e4):
            drive = replace(
                RUBBED,
                plate=curve,
                finger=finger,
                stop_stiffness=stiffness,
                stop_damping=3.0 if stiffness else None,
            )
            hand = Profile([0.0, 0.04, 0.06, 0.1], [0.08, 0.08, -0.08, -0.08])
            motion = simulate(
                drive, Release(hand, 0.0, plate_load=load, across_velocity=oblique), duration=0.12
            )
            kinds = reported(motion)
            assert kinds.count(("stop", "stop")) >= 2, "on both sides"
            laws(motion)


@pytest.mark.parametrize("name", ["travel", "stop_stiffness", "stop_damping", "mass"])
def test_derivatives(name: str) -> None:
    t = np.array([0.004, 0.02, 0.05])
    for drive in (RUBBED, replace(RUBBED, stop_stiffness=None, stop_damping=None)):
        if getattr(drive, name) is None:
            continue
        value, step = getattr(drive, name), 1e-6 * getattr(drive, name)

        def run(by: float, of: Drive = drive, at: float = value) -> Any:
            changed: Any = {name: at + by}
            return simulate(replace(of, **changed), Release(0.06, 0.0, velocity=0.5), duration=0.06)

        slope = run(0.0).sensitivity([name]).position(t)[0]
        near = (run(step).position(t) - run(-step).position(t)) / (2 * step)
        scale = np.abs(near).max()
        assert np.asarray(slope).ravel() == pytest.approx(near, rel=1e-5, abs=1e-6 * scale)


def test_stops_that_are_not_met_change_nothing() -> None:
    far = replace(RUBBED, travel=1.0)
    none = replace(RUBBED, travel=None, stop_stiffness=None, stop_damping=None)
    t = np.linspace(0.0, 0.2, 101)
    one, other = (simulate(d, Release(0.06, 2e-3), duration=0.2).position(t) for d in (far, none))
    assert np.abs(one - other).max() < 1e-17


@pytest.mark.parametrize("stops", [FREE, ELASTIC])
def test_a_batch_is_the_motions_of_its_points(stops: Drive) -> None:
    """With and without stop contact; a start beyond a rigid stop is left out."""
    made = replace(stops, plate=Contact(0.03, 0.05), finger=Contact(0.02))
    x = np.array([-9e-4, 2e-4, 8e-4, 1e-3, 1.2e-3])
    found = simulate_batch(made, Release(0.06), displacement=x, duration=0.2, energy=True)
    assert float(found.travel) == 1e-3 and found.travel.attrs["units"] == "m"
    met = 0
    for i, start in enumerate(x):
        if made.stop_stiffness is None and start > 1e-3:
            assert found.status[i] > 15 and np.isnan(found.transient_peak_displacement[i])
            continue
        motion = simulate(made, Release(0.06, float(start)), duration=0.2)
        met += any(event.contact == "stop" for event in motion.events)
        for name, value in motion.numbers().items():
            of_batch = float(found[name.replace(".", "_")][i])
            assert of_batch == value or np.isnan([of_batch, value]).all(), (name, start)
    assert met > 0


def test_no_number_of_a_motion_is_beyond_a_rigid_stop() -> None:
    """Its closed form is, by rounding, as the pin strikes it."""
    random = np.random.default_rng(3)
    struck = 0
    for _ in range(100):
        most = float(random.uniform(1e-4, 1e-3))
        made = replace(FREE, travel=most, damping=float(random.uniform(0.0, 0.5)))
        start = Release(0.0, 0.0, velocity=float(random.uniform(0.1, 0.5)))
        motion = simulate(made, start, duration=0.1)
        struck += len(motion.events)
        times = [e.time for e in motion.events]
        sides = [motion.core.position(np.array(times), right) for right in (False, True)]
        found = [*np.concatenate(sides), *motion.core.extrema(0, 0.1, 1000)[1]]
        numbers = motion.transient
        found += [numbers.peak_displacement, numbers.trough_displacement]
        assert np.nanmax(np.abs(found)) <= most
    assert struck >= 100


def drive(**given: Any) -> Drive:
    return replace(FREE, **given)


BAD: dict[str, Callable[[], object]] = {
    "travel must be finite and greater than 0 m, got 0.0": lambda: drive(travel=0.0),
    "travel must be finite and greater than 0 m, got .-1 mm.": lambda: drive(travel="-1 mm"),
    "stop_stiffness must be left out without travel, as there are no end stops, got 5.0 N/m": (
        lambda: drive(travel=None, stop_stiffness=5.0)
    ),
    "stop_damping must be left out for rigid end stops; give stop_stiffness too, got 1.0 N": (
        lambda: drive(stop_damping=1.0)
    ),
    r"displacement must be at most travel, 0\.001 m, either way, got -0\.002 m": (
        lambda: simulate(FREE, Release(0.0, -2e-3))
    ),
}


@pytest.mark.parametrize("said", BAD)
def test_invalid_values_are_refused(said: str) -> None:
    with pytest.raises(ValueError, match=said) as error:
        BAD[said]()
    assert "\n" not in str(error.value)


def test_restitution_of_a_damped_stop() -> None:
    """Alone, without the spring's part: it leaves when its force is zero, not where it began."""
    alone = replace(ELASTIC, stiffness=1e-4, damping=0.0)
    motion = simulate(alone, Release(0.0, 0.0, velocity=0.4), duration=0.02)
    w, zeta = sqrt(1e4 / 0.01), 3.0 / (2 * sqrt(1e4 * 0.01))
    root = sqrt(1 - zeta**2)
    leaves = (2 * np.arctan2(root, zeta) if zeta < 1 else inf) / (w * root)
    (meets, left) = motion.events[:2]
    assert left.time - meets.time == pytest.approx(leaves, rel=1e-6)
    assert left.velocity == pytest.approx(-0.4 * exp(-zeta * w * leaves), rel=1e-6)
    assert left.position > 1e-3

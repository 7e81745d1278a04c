"""Floquet multipliers of steady motions, against formulas and against nearby motions."""

from __future__ import annotations

from math import exp, pi, sqrt

import numpy as np
import pytest

import pindrive as pd
from pindrive.motion.stability import release_at

NONE = pd.Contact(0.0)
LINEAR = pd.Drive(mass=0.01, stiffness=100.0, damping=0.2, plate=NONE, finger=NONE)


def test_a_linear_pin_decays_by_its_damping() -> None:
    """Under a sinusoid: exp(λ T) of both roots λ of its equation."""
    driven = pd.simulate(LINEAR, pd.Release(pd.harmonic(0.0, 0.05, 20.0), velocity=0.0))
    assert driven.ending.cycle == "driven"
    alpha, omega = 10.0, sqrt(1e4 - 100.0)
    period = 0.05
    expected = [exp(-alpha * period) * np.exp(sign * 1j * omega * period) for sign in (1.0, -1.0)]
    found = driven.multipliers()
    assert sorted(found, key=lambda m: m.imag) == pytest.approx(
        sorted(expected, key=lambda m: m.imag), abs=1e-10
    )


def test_an_undamped_pin_keeps_its_deviation() -> None:
    drive = LINEAR.replace(damping=0.0)
    (found,) = pd.simulate(drive, pd.Release(0.0, 1e-3, 0.0)).multipliers()
    assert found == pytest.approx(1.0, abs=1e-9)


def test_stick_ends_a_deviation() -> None:
    """A body on a belt that sticks once in a round forgets how it came there."""
    drive = pd.Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.0,
        plate=pd.Contact(0.02, 0.04),
        finger=NONE,
    )
    motion = pd.simulate(drive, pd.Release(0.05))
    assert motion.ending.cycle == "stick-slip"
    (found,) = motion.multipliers()
    assert abs(found) < 1e-9


def random_cycles(count: int) -> list[pd.Motion]:
    """Steady motions on belts with falling friction, and under sinusoids."""
    rng = np.random.default_rng(47)
    found: list[pd.Motion] = []
    while len(found) < count:
        belt, friction = rng.random() < 0.4, rng.uniform(0.01, 0.05)
        falls = pd.Contact(
            friction,
            law="stribeck",
            breakaway=friction * rng.uniform(1.2, 2.0),
            stribeck_velocity=rng.uniform(0.02, 0.1),
            exponent=float(rng.integers(1, 3)),
        )
        drive = pd.Drive(
            mass=rng.uniform(0.005, 0.02),
            stiffness=rng.uniform(50.0, 200.0),
            damping=rng.uniform(0.0, 0.05 if belt else 0.3),
            plate=falls if belt or rng.random() < 0.5 else pd.Contact(friction),
            finger=NONE,
        )
        speed = rng.uniform(0.01, 0.06) if belt else rng.uniform(0.02, 0.2)
        hand: float | pd.Function = speed
        if not belt:
            hand = pd.harmonic(speed, rng.uniform(0.1, 2.0) * speed, rng.uniform(5.0, 40.0))
        motion = pd.simulate(drive, pd.Release(hand, rng.uniform(-1e-3, 1e-3)), duration=20.0)
        if motion.ending.kind == "steady" and motion.ending.amplitude > 1e-6:
            found.append(motion)
    return found


def test_multipliers_of_random_cycles_are_those_of_nearby_motions() -> None:
    """Against the change of the state after a period by differences, 1e-5 of the largest."""
    compared, driven = 0, 0
    for motion in random_cycles(100):
        try:
            found = motion.multipliers()
        except ValueError:
            continue  # it grazes an event, or a contact holds it
        period = motion.ending.period
        begin = motion.ending.steady_since
        # The multipliers do not depend on where in the cycle it is begun.
        times = begin + period * np.linspace(0.05, 0.95, 40)
        free = [
            t
            for t in times
            if all(
                "stick" not in s.mode and "carried" not in s.mode and "rest" not in s.mode
                for s in motion.segments
                if s.begin <= t <= s.end
            )
        ]
        if not free:
            continue
        release = release_at(motion, float(free[len(free) // 2]))
        sizes = motion.ending.amplitude, motion.ending.amplitude * 2 * pi / period
        columns = []
        for i, size in enumerate(sizes):
            ends = []
            for step in (1e-6, -1e-6):
                moved = {"displacement": release.displacement, "velocity": release.initial_velocity}
                moved[("displacement", "velocity")[i]] += step * size
                one = pd.simulate(motion.drive, release.replace(**moved), duration=period)
                ends.append((one.position(period) / sizes[0], one.velocity(period) / sizes[1]))
            columns.append((np.array(ends[0]) - np.array(ends[1])) / 2e-6)
        expected = sorted(np.linalg.eigvals(np.array(columns).T).tolist(), key=abs, reverse=True)
        if motion.ending.cycle != "driven":
            expected.remove(min(expected, key=lambda m: abs(m - 1.0)))
        largest = max(1.0, abs(expected[0]))
        for multiplier, other in zip(found, expected, strict=True):
            assert abs(abs(multiplier) - abs(other)) < 1e-5 * largest
        compared += 1
        driven += motion.ending.cycle == "driven"
    assert compared > 60 and driven > 20 and compared - driven > 15


@pytest.mark.parametrize(
    ("release", "message"),
    [
        (pd.Release(0.0, 1e-3, 0.0), "motion must be steady, to have multipliers, got decaying"),
        (
            pd.Release(0.06, 0.0, plate_load=50.0),
            "motion must be steady, to have multipliers, got",
        ),
    ],
)
def test_other_motions_have_none(release: pd.Release, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        pd.simulate(LINEAR, release).multipliers()


def test_the_fundamental_of_a_linear_pin_is_that_of_the_formula() -> None:
    """Under a force: A = F/(k - mω² + ibω), and its phase."""
    for frequency in (3.0, 15.0, 15.9, 40.0):
        omega = 2.0 * pi * frequency
        force = pd.harmonic(0.2, 0.1, frequency, 0.7)
        motion = pd.simulate(LINEAR, pd.Release(0.0, force=force, velocity=0.0))
        expected = 0.1 * np.exp(0.7j) / (100.0 - 0.01 * omega**2 + 0.2j * omega)
        assert motion.fundamental() == pytest.approx(expected, rel=1e-9)
        assert motion.ending.position == pytest.approx(2e-3, rel=1e-9)


def test_a_motion_that_rests_has_no_fundamental() -> None:
    drive = LINEAR.replace(finger=pd.Contact(0.01))
    with pytest.raises(ValueError, match="motion must be steady, to have a fundamental"):
        pd.simulate(drive, pd.Release(0.0, 1e-3, 0.0)).fundamental()

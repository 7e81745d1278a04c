"""Public reports of people who simulate dry friction, with the right values."""

from __future__ import annotations

from math import exp, sqrt

import numpy as np
import pytest

from pindrive import Contact, Drive, Function, InputPiece, Release, Stribeck, simulate

NONE = Contact(kinetic=0.0)
WEIGHT = 98.1
"""Weight of the block of Mathematica.SE 141707, N."""

pytestmark = pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")


def pulled_block() -> Drive:
    friction = Contact(0.2 * WEIGHT, 0.3 * WEIGHT)
    return Drive(mass=10.0, stiffness=4000.0, damping=0.0, plate=friction, finger=NONE)


def test_block_pulled_through_a_spring_has_the_period_of_stick_slip() -> None:
    """Mathematica.SE 141707: the foot of the spring moves at 10 mm/s.

    The slip phase turns by 2π − 2 arctan(ω (S − F)/(k v)), the stick phase lasts 2 (S − F)/(k v).
    """
    motion = simulate(pulled_block(), Release(0.01))
    omega, excess = 20.0, 0.1 * WEIGHT / 4000.0
    slip = 2.0 * (np.pi - np.arctan(omega * excess / 0.01)) / omega
    assert slip + 2.0 * excess / 0.01 == pytest.approx(0.66769137107918, rel=1e-13)
    assert motion.ending.cycle == "stick-slip"
    assert motion.ending.period == pytest.approx(0.66769137107918, rel=1e-13)


def test_block_pulled_by_the_force_of_the_spring_moves_alike() -> None:
    """In the frame of the ground the block has the force k v t, and the elongation v t − x."""
    drive = Drive(
        mass=10.0,
        stiffness=4000.0,
        damping=0.0,
        plate=NONE,
        finger=Contact(0.2 * WEIGHT, 0.3 * WEIGHT),
    )
    pull = Function([InputPiece(0.0, (0.0, 40.0))])
    ground = simulate(drive, Release(0.0, velocity=0.0, force=pull), duration=4.0)
    moving = simulate(pulled_block(), Release(0.01), duration=4.0)
    times = np.linspace(0.0, 4.0, 801)
    assert "moving" in repr(ground)
    np.testing.assert_allclose(
        0.01 * times - ground.position(times), moving.position(times), atol=1e-12
    )


def test_block_of_400_kg_comes_to_rest_after_five_half_cycles() -> None:
    """MATLAB Answers 1690310, with a spring of 140 kN/m."""
    weight = 400.0 * 9.81
    drive = Drive(
        mass=400.0,
        stiffness=140e3,
        damping=0.0,
        plate=NONE,
        finger=Contact(0.1 * weight, 0.11 * weight),
    )
    motion = simulate(drive, Release(0.0, displacement=0.03, velocity=0.0))
    half = 0.1 * weight / 140e3
    assert motion.ending.kind == "resting"
    assert abs(motion.ending.position) == pytest.approx(0.03 - 10.0 * half, rel=1e-12)
    assert abs(motion.ending.position) == pytest.approx(1.97143e-3, abs=5e-9)
    assert motion.transient.rest_time == pytest.approx(5.0 * np.pi * sqrt(400.0 / 140e3), rel=1e-12)


def test_body_on_a_belt_at_30_mm_per_second() -> None:
    law = Stribeck(kinetic=4.0, breakaway=6.0, stribeck_velocity=0.05)
    drive = Drive(mass=0.5, stiffness=800.0, damping=2.0, plate=law, finger=NONE)
    ending = simulate(drive, Release(0.03)).ending
    assert ending.cycle == "stick-slip"
    assert ending.period == pytest.approx(0.254356, abs=5e-7)
    assert ending.amplitude == pytest.approx(2.462e-3, abs=5e-7)
    # Sliding loses stability where the damper rises as friction falls.
    critical = 0.05 * np.log(20.0)
    for speed, stable in ((critical - 1e-3, False), (critical + 1e-3, True)):
        friction = 4.0 + 2.0 * exp(-speed / 0.05)
        release = Release(speed, displacement=friction / 800.0 + 1e-7, velocity=0.0)
        assert (simulate(drive, release).ending.kind == "decaying") == stable

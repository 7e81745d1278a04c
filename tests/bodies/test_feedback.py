"""Feedback and contacts that others press: against formulas, and written otherwise."""

from __future__ import annotations

from math import exp, inf
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

import pindrive as pd


def test_a_continuous_feedback_is_a_spring_with_a_damper() -> None:
    """Proportional and derivative gains on the own distance are stiffness and damping."""
    found = []
    for led in (False, True):
        system = pd.System()
        system.body("a", 0.5, position=0.01)
        system.body("b", 0.2)
        system.spring("b", "a", stiffness=80, damping=0.2)
        system.contact("b", kinetic=0.05, static=0.08)
        stroke = pd.minimum_jerk("20 mm", "0.5 s")
        if led:
            system.feedback("a", proportional=120, derivative=3, reference=stroke)
        else:
            system.spring("a", stroke, stiffness=120, damping=3)
        found.append(system.simulate(1.0))
    t = np.linspace(0.0, 1.0, 101)
    for body in ("a", "b"):
        spring, feedback = (motion[body].position(t) for motion in found)
        assert np.abs(spring - feedback).max() < 1e-15
    assert len(found[0].events) == len(found[1].events) > 0
    force = found[1].feedback("a", "ground").force(t)
    assert force == pytest.approx(found[0].spring("a-ground").force(t), abs=1e-12)
    assert found[1].energy.inputs > 0.0
    assert abs(found[1].energy.residual) < 1e-15


def test_an_integral_gain_follows_the_matrix_exponential() -> None:
    """PID on another body than the one it pushes, across two springs: a linear system."""
    system = pd.System()
    system.body("a", 0.5)
    system.body("b", 0.2)
    system.spring("b", "a", stiffness=80, damping=0.2)
    gains: dict[str, Any] = {"proportional": 20.0, "derivative": 2.0, "integral": 15.0}
    system.feedback("a", measured="b", reference=0.01, **gains)
    motion = system.simulate(2.0)
    p, d, i = gains.values()
    matrix = np.zeros((6, 6))  # a, b, a', b', integral, 1
    matrix[0, 2] = matrix[1, 3] = 1.0
    matrix[2] = np.array([-80.0, 80.0 - p, -0.2, 0.2 - d, i, p * 0.01]) / 0.5
    matrix[3] = np.array([80.0, -80.0, 0.2, -0.2, 0.0, 0.0]) / 0.2
    matrix[4] = [0.0, -1.0, 0.0, 0.0, 0.0, 0.01]
    for t in (0.3, 1.0, 2.0):
        expected = expm(matrix * t)[:2, 5]
        at = [motion[body].position(t) for body in ("a", "b")]
        assert at == pytest.approx(expected, rel=1e-12)
        assert motion.feedback("a-ground").error(t) == pytest.approx(0.01 - expected[1], rel=1e-12)


def test_a_sampled_feedback_follows_its_difference_equation() -> None:
    """A damped mass under a force that is held between samples, with the sum of the errors."""
    mass, damping, period = 0.5, 2.0, 0.02
    gains: dict[str, Any] = {"proportional": 30.0, "derivative": 0.5, "integral": 40.0}
    system = pd.System()
    system.body("a", mass, position=2e-3)
    system.spring("a", damping=damping)
    system.feedback("a", reference=0.01, period=period, **gains)
    motion = system.simulate(1.0)
    x, v, summed = 2e-3, 0.0, 0.0
    decay = exp(-damping / mass * period)
    for k in range(50):
        at = motion["a"].position(k * period), motion["a"].velocity(k * period)
        assert at == pytest.approx((x, v), rel=1e-12, abs=1e-15)
        error = 0.01 - x
        summed += period * error
        force = gains["proportional"] * error - gains["derivative"] * v
        force += gains["integral"] * summed
        assert motion.feedback("a-ground").force(k * period) == pytest.approx(force, rel=1e-11)
        steady = force / damping
        x += steady * period + (v - steady) * mass / damping * (1.0 - decay)
        v = steady + (v - steady) * decay
    assert abs(motion.energy.residual) < 1e-15
    assert motion.certificate().worst < 1e-12


def test_an_integral_gain_and_static_friction_hunt() -> None:
    """The classic: the controller overshoots, sticks, and is torn loose again and again."""
    system = pd.System()
    system.body("slide", 1.0)
    system.contact("slide", kinetic=1.0, static=1.5)
    system.feedback("slide", proportional=100, derivative=12, integral=400, reference=0.01)
    motion = system.simulate(20.0)
    slips = [e for e in motion.events if e.kind == "slip"]
    assert len(slips) > 5
    assert {e.after for e in slips} == {-1, 1}
    assert all(abs(motion["slide"].position(e.time) - 0.01) > 1e-5 for e in slips)
    assert motion.certificate().worst < 1e-12


def test_a_slow_sample_lets_a_drive_sway() -> None:
    """A mass that a continuous gain holds for ever is driven off by a slow sample."""
    largest = []
    for period in (0.0, 0.1):
        system = pd.System()
        system.body("a", 1.0, position=1e-3)
        system.feedback("a", proportional=100, derivative=5, period=period)
        motion = system.simulate(3.0)
        largest.append(np.abs(motion["a"].position(np.linspace(2.0, 3.0, 101))).max())
    assert largest[0] < 1e-5 < 1e-3 < largest[1]


def test_a_held_drive_rests_though_it_is_sampled() -> None:
    system = pd.System()
    system.body("a", 1.0, position="2 mm")
    system.contact("a", kinetic=1.0)
    system.feedback("a", proportional=100, period="10 ms")
    motion = system.simulate()
    assert motion.rests
    assert motion["a"].position(motion.duration) == 2e-3
    assert motion.feedback("a-ground").force(motion.duration) == pytest.approx(-0.2)


def test_a_contact_that_another_presses_has_its_load_too() -> None:
    """The load of the finger, by a share, adds to that of the plate."""
    found = []
    touch = pd.harmonic(1.0, 0.5, "3 Hz")
    for pressed in (False, True):
        system = pd.System()
        system.body("pin", 0.01, velocity=0.3)
        system.body("hand", 0.5)
        system.spring("pin", "hand", stiffness=50)
        skin: dict[str, Any] = {"stiffness": 300, "damping": 0.1}
        system.contact("pin", "hand", kinetic=0.05, load=touch, name="finger", **skin)
        share: dict[str, Any] = {"pressed_by": "finger", "share": 2}
        load: dict[str, Any] = (
            {"load": 0.5, **share} if pressed else {"load": pd.harmonic(2.5, 1.0, "3 Hz")}
        )
        system.contact("pin", kinetic=0.02, static=0.03, name="plate", **load)
        found.append(system.simulate(1.0))
    t = np.linspace(0.0, 1.0, 101)
    one, other = (motion["pin"].position(t) for motion in found)
    assert np.abs(one - other).max() < 1e-14
    assert len(found[0].events) == len(found[1].events) > 2
    assert found[1].certificate().worst < 1e-12


def test_a_contact_that_a_stop_presses_has_friction_in_proportion() -> None:
    """A mass runs into a spring whose force clamps it: out it loses a part (1 − µ)/(1 + µ)."""
    share = 0.3
    system = pd.System()
    system.body("a", 1.0, velocity=0.2)
    end = system.stop("a", upper=0.005, stiffness=2000)
    system.contact("a", kinetic=1.0, load=0.0, pressed_by=end, share=share)
    motion = system.simulate(0.5)
    ratio = (1.0 - share) / (1.0 + share)
    assert motion["a"].velocity(0.5) == pytest.approx(-0.2 * ratio**0.5, rel=1e-13)
    meets, leaves = motion.stop("a-ground").events
    deepest = max(motion["a"].position(np.linspace(meets.time, leaves.time, 2001))) - 0.005
    assert deepest == pytest.approx(0.2 / (2000 * (1.0 + share)) ** 0.5, rel=1e-6)
    assert motion.certificate().worst < 1e-13


def test_derivatives_by_gains_and_shares_are_those_of_differences() -> None:
    system = pd.System()
    for body, mass in (("a", 1.0), ("b", 0.5)):
        system.body(body, mass)
    system.spring("a", "b", stiffness=100)
    touch = pd.harmonic(1, 0.5, "3 Hz")
    system.contact("a", "b", kinetic=0.1, stiffness=300, load=touch, name="skin")
    system.contact("a", kinetic=0.1, load=0.5, pressed_by="skin", share=2, name="plate")
    stroke = pd.minimum_jerk("20 mm", "0.5 s")
    gains: dict[str, Any] = {"proportional": 30, "derivative": 2, "integral": 5}
    system.feedback("a", measured="b", reference=stroke, name="drive", **gains)
    system.feedback("b", proportional=10, derivative=0.5, period="20 ms", name="slow")
    keys = (
        *("plate.share", "drive.proportional", "drive.derivative", "drive.integral"),
        *("drive.reference.distance", "slow.proportional", "slow.derivative"),
    )
    t = [0.5, 1.0]
    found = system.simulate(1.0).sensitivity(keys)
    assert found.gaps == {}
    for key, row in zip(found.parameters, found.position("b", t), strict=True):
        value = system.inputs()[key]
        step = 1e-5 * value
        near = [
            system.with_values({key: value + way}).simulate(1.0)["b"].position(t)
            for way in (step, -step)
        ]
        assert row == pytest.approx((near[0] - near[1]) / (2 * step), rel=1e-4, abs=1e-9), key
    with pytest.raises(ValueError, match="one with a derivative, not a period"):
        system.simulate(1.0).sensitivity(["slow.period"])


def test_what_is_refused() -> None:
    system = pd.System()
    system.body("a", 1.0)
    with pytest.raises(ValueError, match=r"feedback\.a-ground must be with a gain"):
        system.feedback("a")
    with pytest.raises(ValueError, match="without a step"):
        system.feedback("a", derivative=1, reference=pd.Profile([1, 1], [0, 0.1]))
    with pytest.raises(ValueError, match=r"feedback\.a-ground\.period"):
        system.feedback("a", proportional=1, period=-1)
    with pytest.raises(ValueError, match=r"unknown|no body"):
        system.feedback("a", measured="c", proportional=1)
    rigid = system.stop("a", upper=0.1, name="rigid")
    both = system.stop("a", upper=0.1, lower=-0.1, stiffness=10, name="both")
    one = system.stop("a", upper=0.1, stiffness=10, name="one")
    with pytest.raises(ValueError, match="a rigid one"):
        system.contact("a", kinetic=1, pressed_by=rigid)
    with pytest.raises(ValueError, match="one with two"):
        system.contact("a", kinetic=1, pressed_by=both)
    first = system.contact("a", kinetic=1, pressed_by=one, name="first")
    with pytest.raises(ValueError, match="a contact that no other one presses"):
        system.contact("a", kinetic=1, pressed_by=first)
    with pytest.raises(ValueError, match=r"share must be given beside pressed_by"):
        system.contact("a", kinetic=1, share=2)
    with pytest.raises(ValueError, match="skin with a damping"):
        system.contact("a", kinetic=1, stiffness=100, pressed_by=one)
    assert first.pressed_by == "stop.one"
    assert first.share == 1.0
    assert system.contacts["first"].stiffness == inf


def test_results_have_the_feedback() -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.feedback("a", proportional=10, reference=0.01)
    assert repr(system) == "<System of 1 body, 0 springs, 0 contacts and 1 feedback>"
    motion = system.simulate(1.0)
    data = motion.to_dataset([0.0, 0.5])
    assert data.feedback_force.values[0] == pytest.approx(
        np.asarray(motion.feedback("a-ground").force([0.0, 0.5]))
    )
    assert data.feedback_force.attrs["units"] == "N"
    assert repr(motion.feedback("a", "ground")) == "<FeedbackMotion 'a-ground'>"

"""Friction that follows a touch over time by a power, against an ordinary integrator."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from oracle import explicit_piecewise
from tactile_mouse import DAMPED, RIGID, SKIN, drive

DURATION = 0.06
EXPONENTS = (0.1, 0.5, 2 / 3, 1.2, 2.0)


def drawn(seed: int) -> tuple[pd.Drive, pd.Release]:
    """A pin under a touch of a few rows, on a finger that is rigid or has damped skin."""
    draw = np.random.default_rng(seed)

    def near(value: float) -> float:
        return float(value * np.exp(draw.uniform(-0.7, 0.7)))

    damped = bool(draw.random() < 0.5)
    kinetic = near(0.02 if damped else 0.01)
    skin: dict[str, Any] = {"stiffness": near(300.0), "damping": near(0.3)} if damped else {}
    finger = pd.Contact(kinetic, kinetic * float(draw.choice([1.0, 1.5])), **skin)
    given = drive(finger, load_exponent=float(draw.choice(EXPONENTS)))
    times = np.cumsum([0.0, *draw.uniform(0.005, 0.02, 3)])
    touch = pd.Profile(times.tolist(), np.exp(draw.uniform(-1.5, 1.0, 4)).tolist())
    v, stretch = (0.0, 0.0) if damped else (near(0.05), None)
    return given, pd.Release(0.06, near(1e-3), v, skin_stretch=stretch, finger_load=touch)


def inputs(given: pd.Drive, release: pd.Release) -> dict[str, Any]:
    def contact(surface: pd.Contact) -> dict[str, Any]:
        return {
            "curve": [(0.0, surface.kinetic)],
            "static": surface.static_friction,
            "stiffness": None if surface.rigid else surface.stiffness,
            "damping": surface.damping or 0.0,
        }

    touch = release.finger_load
    assert isinstance(touch, pd.Profile)
    return {
        **{name: getattr(given, name) for name in ("mass", "stiffness", "damping")},
        "plate": contact(given.plate),
        "finger": contact(given.finger),
        "mouse_velocity": [[0.0, release.mouse_velocity]],
        "load": [[0.0, 1.0]],
        "touch": touch.rows,
        "touch_power": given.load_exponent,
        "displacement": release.displacement,
        "velocity": release.velocity,
        "skin_stretch": release.skin_stretch,
    }


@pytest.mark.parametrize("seed", range(60))
def test_random_drives_against_an_integrator(seed: int) -> None:
    given, release = drawn(seed)
    motion = pd.simulate(given, release, duration=DURATION)
    assert motion.certificate().worst < 1e-11
    t = np.linspace(0.0, 0.999 * DURATION, 200)
    run = explicit_piecewise.solve(inputs(given, release), DURATION, t.tolist())
    x, v, *_ = np.array(run.rows).T
    assert np.abs(motion.position(t) - x).max() < 1e-9 * np.abs(x).max()
    assert np.abs(motion.velocity(t) - v).max() < 1e-8 * np.abs(v).max()
    mine = [(e.contact, e.kind) for e in motion.events if e.time < t[-1]]
    assert mine == [(contact, kind) for time, contact, kind, _, _ in run.events if time < t[-1]]


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_a_touch_that_comes_to_zero_and_returns(exponent: float) -> None:
    """A finger that lifts and presses again, while the pin slides: one friction, no events."""
    touch = pd.Profile([0.0, 0.01, 0.012, 0.03], [1.0, 0.0, 0.0, 2.0])
    given = pd.Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.1,
        plate=pd.Contact(0.0),
        finger=pd.Contact(0.01),
        load_exponent=exponent,
    )
    release = pd.Release(0.0, 0.0, 0.5, finger_load=touch)
    motion = pd.simulate(given, release, duration=0.012)
    assert not motion.events
    assert motion.certificate().worst < 1e-11
    run = explicit_piecewise.solve(inputs(given, release), 0.012, [0.012])
    assert float(motion.position(0.012)) == pytest.approx(run.rows[0][0], rel=1e-9)
    assert float(motion.force("finger", 0.011)) == 0.0
    later = pd.simulate(given, release, duration=0.02)
    t = np.array([0.013, 0.016, 0.019])
    pressed = 0.01 * np.asarray(touch(t)) ** exponent
    assert np.abs(later.force("finger", t)) == pytest.approx(pressed, rel=1e-8)
    assert later.certificate().worst < 1e-11


def test_an_exponent_of_1_is_coulomb_friction_to_the_bit() -> None:
    given, release = drawn(2)
    usual = replace(given, load_exponent=1.0)
    as_ever = pd.Drive(
        **{
            name: getattr(given, name)
            for name in ("mass", "stiffness", "damping", "plate", "finger")
        }
    )
    t = np.linspace(0.0, DURATION, 100)
    one, other = (pd.simulate(d, release, duration=DURATION) for d in (usual, as_ever))
    np.testing.assert_array_equal(one.position(t), other.position(t))
    near = replace(given, load_exponent=1.0 + 1e-9)
    beside = pd.simulate(near, release, duration=DURATION).position(t)
    assert np.abs(beside - one.position(t)).max() < 1e-8 * np.abs(beside).max()


@pytest.mark.parametrize("finger", [RIGID, DAMPED], ids=["rigid", "damped"])
@pytest.mark.parametrize("exponent", [0.7, 1.0, 1.3])
def test_the_derivative_by_the_exponent(finger: pd.Contact, exponent: float) -> None:
    touch = pd.Profile([0.0, 0.02, 0.04], [1.0, 0.4, 1.6])
    release = pd.Release(0.06, 2e-3, finger_load=touch)
    base = drive(finger, load_exponent=exponent)
    motion = pd.simulate(base, release, duration=0.05)
    sensitivity = motion.sensitivity(["load_exponent"])
    t = np.linspace(0.0, 0.05, 40)
    h = 1e-6
    around = [
        pd.simulate(replace(base, load_exponent=exponent + d), release, duration=0.05).position(t)
        for d in (h, -h)
    ]
    differences = (around[0] - around[1]) / (2 * h)
    assert sensitivity.gaps == {}
    (exact,) = sensitivity.position(t)
    scale = np.abs(differences).max()
    assert scale > 1e-6
    np.testing.assert_allclose(exact, differences, atol=2e-6 * scale)


def test_a_fit_finds_the_exponent_under_a_touch_that_changes() -> None:
    touch = pd.Profile([0.0, 0.02, 0.04], [1.0, 0.4, 1.6])
    release = pd.Release(0.06, 2e-3, finger_load=touch)
    true = drive(RIGID, load_exponent=0.7)
    t = np.linspace(0.0, 0.05, 200)
    recording = pd.Recording(t, position=pd.simulate(true, release, duration=0.05).position(t))
    found = pd.fit(recording, replace(true, load_exponent=1.0), release, free=["load_exponent"])
    assert found.estimates[0].value == pytest.approx(0.7, rel=1e-6)
    assert found.drive.load_exponent == pytest.approx(0.7, rel=1e-6)
    with pytest.raises(ValueError, match="free must be left out where the release has no finger"):
        pd.fit(recording, true, pd.Release(0.06, 2e-3), free=["load_exponent"])


@pytest.mark.parametrize(
    ("finger", "touch", "said"),
    [
        (
            SKIN,
            pd.Profile([0.0, 0.1], [1.0, 2.0]),
            "finger_load must be constant at a load_exponent of 0.5 beside a finger stiffness "
            "without damping, or a curve, got a Profile",
        ),
        (
            RIGID,
            pd.harmonic(1.0, 0.5, 10.0),
            "finger_load must be a number or a Profile at a load_exponent of 0.5, got a Function",
        ),
    ],
)
def test_what_is_not_followed_is_refused(finger: pd.Contact, touch: Any, said: str) -> None:
    given = drive(finger, load_exponent=0.5)
    with pytest.raises(ValueError, match="^" + re.escape(said) + "$"):
        pd.simulate(given, pd.Release(0.06, 2e-3, finger_load=touch))
    for constant in (2.0, pd.Profile([0.0, 0.1], [2.0, 2.0])):
        motion = pd.simulate(given, pd.Release(0.06, 2e-3, finger_load=constant), duration=0.05)
        assert motion.certificate().worst < 1e-11
        sliding = np.abs(motion.force("finger", np.linspace(0.0, 0.05, 50))).max()
        assert sliding <= finger.static_friction * 2.0**0.5 * (1 + 1e-14)

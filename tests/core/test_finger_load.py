"""A finger that presses and lifts: a load on its friction, against thirty digits and by laws."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core import test_external_force as forced
from pindrive import Contact, Drive, Profile, Release, simulate, simulate_batch

DRIVE = replace(forced.RIGID, finger=Contact(0.02, 0.03))
LIFTS = [[0.0, 0.3], [0.012, 2.5], [0.03, 2.5], [0.03, 0.0], [0.045, 0.0], [0.06, 1.2]]
LIFT = Profile(*zip(*LIFTS, strict=True))
CURVE = Contact(curve=[(0.0, 0.03), (0.05, 0.015), (0.3, 0.025)], static=0.05)
CASES = {
    "Coulomb": forced.case(DRIVE, finger_load=LIFTS, force=[[0.0, 0.0]]),
    "curved plate": forced.case(replace(DRIVE, plate=CURVE), finger_load=LIFTS),
    "curved plate, its load changes too": forced.case(
        replace(DRIVE, plate=CURVE), finger_load=LIFTS, load=[[0.0, 1.0], [0.03, 3.0], [0.05, 0.5]]
    ),
    "curved finger": forced.case(replace(DRIVE, finger=CURVE), finger_load=LIFTS),
    "both curved, both loads change": forced.case(
        replace(DRIVE, finger=CURVE, plate=CURVE),
        finger_load=LIFTS,
        load=[[0.0, 1.0], [0.03, 3.0], [0.05, 0.5]],
    ),
    "curved finger, held, then released": forced.case(
        replace(DRIVE, finger=CURVE),
        finger_load=[[0.0, 6.0], [0.02, 6.0], [0.05, 0.0]],
        velocity=0.0,
        force=[[0.0, 0.0]],
    ),
    "held, then released": forced.case(
        DRIVE, finger_load=[[0.0, 6.0], [0.02, 6.0], [0.05, 0.0]], velocity=0.0, force=[[0.0, 0.0]]
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_a_finger_load_against_thirty_digits(name: str) -> None:
    motion, events = forced.against_thirty_digits(CASES[name], 19)
    assert events >= 2
    assert motion.certificate().worst < 1e-11
    assert abs(motion.energy.residual) < 1e-12 * motion.energy.spring_start


@pytest.mark.parametrize("finger", [Contact(0.02, 0.03), Contact(0.02, 0.03, stiffness=800.0)])
def test_a_constant_load_scales_the_friction(finger: Contact) -> None:
    scaled = Contact(0.02 * 1.5, 0.03 * 1.5, stiffness=finger.stiffness)
    one = simulate(replace(DRIVE, finger=finger), Release(0.06, 0.002, finger_load=1.5))
    other = simulate(replace(DRIVE, finger=scaled), Release(0.06, 0.002))
    assert [(e.kind, e.contact) for e in one.events] == [(e.kind, e.contact) for e in other.events]
    t = np.linspace(0.0, 0.2, 201)
    assert np.abs(one.position(t) - other.position(t)).max() < 1e-15
    assert one.transient.finger.dissipated == pytest.approx(other.transient.finger.dissipated)
    assert one.certificate().worst < 1e-12


SKIN = {
    "Coulomb": Contact(0.02, 0.03, stiffness=800.0),
    "curve": replace(CURVE, stiffness=300.0),
}


@pytest.mark.parametrize("name", SKIN)
def test_skin_under_a_load_that_changes_obeys_the_laws(name: str) -> None:
    drive = replace(DRIVE, finger=SKIN[name])
    motion = simulate(drive, Release(0.06, 0.002, finger_load=LIFT), duration=0.1)
    assert motion.certificate().worst < 1e-11
    assert abs(motion.energy.residual) < 1e-12 * motion.energy.spring_start
    lifted = np.linspace(0.0301, 0.0449, 50)
    assert np.all(motion.stretch(lifted) == 0.0) and np.all(motion.force("finger", lifted) == 0.0)
    slips = [e.time for e in motion.events if (e.contact, e.kind) == ("finger", "slip")]
    assert 0.03 in slips  # it lifts, and the skin has no stretch then


def test_skin_slips_under_a_pin_at_rest_as_it_is_let_go() -> None:
    """A plate holds the pin; the skin keeps its stretch until the limit has fallen to it."""
    drive = replace(DRIVE, plate=Contact(0.5), finger=Contact(0.02, stiffness=800.0))
    falls = Profile([0.0, 0.1], [1.0, 0.0])
    release = Release(0.0, 1e-3, skin_stretch=1e-5, finger_load=falls)
    motion = simulate(drive, release, duration=0.1)
    t = np.linspace(0.0, 0.1, 101)
    assert np.array_equal(motion.position(t), np.full(101, 1e-3))
    exact = -np.minimum(0.008, 0.02 * np.clip(1 - t / 0.1, 0.0, 1.0))
    assert np.abs(motion.force("finger", t) - exact).max() < 1e-17
    (slip,) = [e for e in motion.events if e.contact == "finger"]
    assert slip.kind == "slip" and slip.time == pytest.approx(0.06, abs=1e-16)
    assert motion.transient.finger.dissipated == pytest.approx(0.008**2 / 1600, rel=1e-12)


def test_stiff_skin_under_a_load_that_changes_tends_to_the_rigid_finger() -> None:
    t = np.linspace(0.0, 0.1, 201)
    rigid = Contact(curve=[(0.0, 0.02), (0.3, 0.05)])
    release = Release(0.06, 0.002, finger_load=LIFT)
    limit = simulate(replace(DRIVE, finger=rigid), release, duration=0.1).position(t)
    off = []
    for stiffness in (1e3, 1e4, 1e5):
        drive = replace(DRIVE, finger=replace(rigid, stiffness=stiffness))
        off.append(np.abs(simulate(drive, release, duration=0.1).position(t) - limit).max())
    assert off[1] < 0.5 * off[0] and off[2] < 0.5 * off[1]


def test_with_a_coefficient_the_friction_follows_the_touch_force() -> None:
    """μ times the touch force, which the load multiplies."""
    finger = Contact(coefficient=0.5, static_coefficient=0.75)
    drive = replace(forced.RIGID, finger=finger, touch_force=0.04)
    motion = simulate(drive, Release(0.06, 0.002, finger_load=LIFT), duration=0.1)
    t = np.linspace(0.0, 0.1, 301)
    slides = np.abs(motion.velocity(t)) > 1e-9
    slides &= np.abs(t[:, None] - np.array(LIFT.times)).min(1) > 1e-9
    expected = -np.sign(motion.velocity(t)) * 0.5 * 0.04 * LIFT(t)
    assert np.abs(motion.force("finger", t) - expected)[slides].max() < 1e-16
    assert slides.sum() > 100


def test_a_lifted_finger_is_no_finger() -> None:
    t = np.linspace(0.0, 0.2, 101)
    lifted = simulate(DRIVE, Release(0.06, 0.002, finger_load=0.0)).position(t)
    alone = simulate(replace(DRIVE, finger=Contact(0.0)), Release(0.06, 0.002)).position(t)
    assert np.array_equal(lifted, alone)


@pytest.mark.parametrize("finger", [CURVE, *SKIN.values()])
def test_rows_of_a_constant_load_are_the_load(finger: Contact) -> None:
    drive = replace(DRIVE, finger=finger)
    rows = Profile([0.0, 0.01, 0.05], [1.5, 1.5, 1.5])
    one, other = (simulate(drive, Release(0.06, 0.002, finger_load=f)) for f in (rows, 1.5))
    t = np.linspace(0.0, 0.2, 201)
    assert np.abs(one.position(t) - other.position(t)).max() < 1e-16
    assert [e.kind for e in one.events] == [e.kind for e in other.events]


@pytest.mark.parametrize("name", ["finger_load", "finger_load[1].value", "finger_load[5].time"])
def test_the_derivative_along_a_finger_load(name: str) -> None:
    row, column = (int(name[12]), name[15:]) if "[" in name else (-1, "value")
    step, t = 1e-7, np.array([0.015, 0.03, 0.055, 0.08])

    def run(by: float) -> Any:
        times = [u + by * (i == row and column == "time") for i, u in enumerate(LIFT.times)]
        values = [
            y + by * (row < 0 or (i == row and column == "value"))
            for i, y in enumerate(LIFT.values)
        ]
        lift = Profile(times, values) if by else LIFT
        return simulate(DRIVE, Release(0.06, 0.002, finger_load=lift), duration=0.1)

    slope = run(0.0).sensitivity([name]).position(t)[0]
    # A load of 0 has no smaller neighbour.
    near = (run(2 * step).position(t) - run(0.0).position(t)) / (2 * step)
    assert np.asarray(slope).ravel() == pytest.approx(near, rel=1e-4, abs=1e-9)


BAD: dict[str, Callable[[], object]] = {
    "finger_load must be finite and at least 0, got -1": lambda: Release(0.06, finger_load=-1.0),
    r"finger_load values\[1\] must be finite and at least 0, got -0.5": lambda: Release(
        0.06, finger_load=Profile([0.0, 0.1], [1.0, -0.5])
    ),
    "touch_force must be finite and at least 0 N, got .-10 mN.": lambda: Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.4,
        plate=Contact(0.02),
        finger=Contact(coefficient=0.5),
        touch_force="-10 mN",
    ),
    "finger_load must be 1; `simulate` follows another, got a Profile": (
        lambda: simulate_batch(DRIVE, Release(0.06, finger_load=LIFT), mass=[0.01])
    ),
}


@pytest.mark.parametrize("said", BAD)
def test_invalid_values_are_refused(said: str) -> None:
    with pytest.raises(ValueError, match=said) as error:
        BAD[said]()
    assert "\n" not in str(error.value)

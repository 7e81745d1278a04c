"""A friction curve on a compliant finger: the slider of its skin is a state of its own."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from oracle import mp_slider, random_cases
from pindrive import Contact, Drive, Motion, Release, simulate

DRIVE = Drive(
    mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005)
)  # fmt: skip
CURVES = {
    "rising": [(0.0, 0.006), (0.05, 0.02)],
    "Stribeck": [(0.0, 0.03), (0.02, 0.012), (0.1, 0.022)],
    "two rises": [(0.0, 0.004), (0.02, 0.012), (0.04, 0.009), (0.08, 0.03)],
}
STATIC = {"rising": 0.012, "Stribeck": 0.03, "two rises": 0.006}


def finger(name: str, stiffness: float) -> Contact:
    return Contact(curve=CURVES[name], static=STATIC[name], stiffness=stiffness)


def laws(motion: Motion) -> None:
    assert motion.certificate().worst < 1e-11
    ledger = motion.energy
    assert abs(ledger.residual) < 1e-12 * ledger.spring_start
    assert ledger.finger_dissipated > 0.0


@pytest.mark.parametrize("name", CURVES)
def test_a_curve_on_skin_against_forty_digits(name: str) -> None:
    """The plate moves away faster than the pin ever goes, so that its friction stays constant."""
    drive = replace(DRIVE, finger=finger(name, 60.0))
    motion = simulate(drive, Release(-1.0, 2e-3, velocity=0.0), duration=0.06)
    inputs: dict[str, Any] = {
        "mass": 0.01, "stiffness": 100.0, "damping": 0.4, "displacement": 2e-3, "velocity": 0.0,
        "skin_stretch": 0.0, "mouse_velocity": [[0.0, -1.0]], "load": [[0.0, 1.0]],
        "plate": {"curve": [[0.0, 0.02]], "static": 0.02, "stiffness": None},
        "finger": {"curve": CURVES[name], "static": STATIC[name], "stiffness": 60.0},
    }  # fmt: skip
    case = {"inputs": inputs, "duration": 0.06, "family": "curve on skin"}
    path = mp_slider.solve(inputs, 0.06)
    assert len(path.events) >= 3
    assert random_cases.deviation(case, path) < random_cases.CLOSE
    laws(motion)


def test_skin_under_a_rising_curve_tends_to_the_rigid_finger() -> None:
    rigid = Contact(curve=CURVES["rising"])
    t = np.linspace(0.0, 0.1, 201)
    release = Release(0.1, 1.5e-3)
    limit = simulate(replace(DRIVE, finger=rigid), release, duration=0.1).position(t)
    off = []
    for stiffness in (1e2, 1e3, 1e4):
        skin = Contact(curve=CURVES["rising"], stiffness=stiffness)
        motion = simulate(replace(DRIVE, finger=skin), release, duration=0.1)
        laws(motion)
        off.append(float(np.abs(motion.position(t) - limit).max()))
    assert all(other < 0.5 * one for one, other in pairwise(off))


def test_a_flat_curve_is_constant_friction() -> None:
    """Rows on one line make one branch, which is a closed form."""
    t = np.linspace(0.0, 0.1, 101)
    release = Release(0.1, 1.5e-3)
    flat = Contact(curve=[(0.0, 0.005), (0.05, 0.005), (0.1, 0.005)], stiffness=500.0)
    one = simulate(replace(DRIVE, finger=flat), release, duration=0.1)
    other = simulate(replace(DRIVE, finger=Contact(0.005, stiffness=500.0)), release, duration=0.1)
    assert [e.kind for e in one.events] == [e.kind for e in other.events]
    assert np.abs(one.position(t) - other.position(t)).max() < 1e-17


@pytest.mark.parametrize("name", CURVES)
def test_a_motion_on_curved_skin_ends(name: str) -> None:
    """Also where the pin creeps back without turning, and is at rest once that is rounding."""
    for damping in (0.4, 5.0):
        drive = replace(DRIVE, damping=damping, finger=finger(name, 300.0))
        motion = simulate(drive, Release(0.1, 1.5e-3))
        assert motion.ending.kind in ("resting", "decaying")
        laws(motion)


def test_a_viscous_slider_is_a_maxwell_element() -> None:
    """Without static friction: spring and damper in series, to the end."""
    drive = replace(DRIVE, finger=Contact(curve=[(0.0, 0.0), (0.1, 0.05)], stiffness=40.0))
    motion = simulate(drive, Release(0.0, 1.5e-3, plate_load=0.0), duration=0.05)
    matrix = np.array([[0.0, 1.0, 0.0], [-1e4, -40.0, -1e2], [0.0, 40.0, -40.0 / 0.5]])
    rates, vectors = np.linalg.eig(matrix)
    t = np.linspace(0.0, 0.05, 11)
    parts = np.linalg.solve(vectors, np.array([1.5e-3, 0.0, 0.0]))
    exact = (vectors @ (parts[:, None] * np.exp(np.outer(rates, t)))).real
    assert np.abs(motion.position(t) - exact[0]).max() < 1e-15
    assert np.abs(motion.force("finger", t) + exact[2]).max() < 1e-14
    laws(motion)

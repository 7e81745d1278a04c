"""A hand that also moves across the axis: the plate's friction opposes the whole sliding velocity.

Against SciPy's DOP853 with the same modes, by laws, and in the limits of small angles.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from math import cos, radians, sin
from typing import Any

import numpy as np
import pytest

from core import test_oracle_piecewise as piecewise
from core.test_external_force import CURVE, case
from oracle import explicit_piecewise
from oracle.answers import told_events
from pindrive import Contact, Drive, Motion, Profile, Release, simulate

DRIVE = Drive(
    mass=0.01,
    stiffness=100.0,
    damping=0.4,
    plate=Contact(0.4),
    finger=Contact(0.02, 0.03, stiffness=500.0),
)
RIGID = replace(DRIVE, finger=Contact(0.02, 0.03))
TIMES = [0.0, 0.05, 0.1, 0.2, 0.25]
COURSE = [0.0, 1.0, 1.0, -1.0, 0.0]


def hand(angle: float, speed: float = 0.06) -> tuple[Profile, Profile]:
    """Along the axis and across it: out, back and to rest."""
    return tuple(  # type: ignore[return-value]
        Profile(TIMES, [speed * part * c for c in COURSE]) for part in (cos(angle), sin(angle))
    )


def moved(drive: Drive, angle: float) -> Motion:
    along, across = hand(angle)
    return simulate(drive, Release(along, velocity=0.0, across_velocity=across), duration=0.3)


def laws(motion: Motion) -> None:
    assert motion.status.name == "ok"
    assert motion.certificate().worst < 1e-11
    ledger = motion.energy
    assert abs(ledger.residual) < 1e-12 * max(map(abs, astuple(ledger)))
    assert min(ledger.plate_dissipated, ledger.finger_dissipated) >= 0.0


ACROSS = [[0.0, 0.02], [0.03, 0.005], [0.06, 0.03]]
CASES = {
    "rigid": case(RIGID, across=ACROSS),
    "skin": case(DRIVE, across=ACROSS, load=[[0.0, 1.0], [0.05, 0.2]]),
    "curve": case(
        replace(DRIVE, plate=CURVE), across=ACROSS, load=[[0.0, 8.0], [0.03, 3.0], [0.05, 0.5]]
    ),
    "no finger": case(replace(DRIVE, finger=Contact(0.0)), across=ACROSS),
}


@pytest.mark.parametrize("name", CASES)
def test_oblique_motions_are_those_of_explicit_modes(name: str) -> None:
    of = CASES[name]
    times = np.linspace(0.0, of["duration"], 32)[1:-1]
    run = explicit_piecewise.solve(of["inputs"], of["duration"], times.tolist())
    rows = dict(zip(piecewise.STATES, np.array(run.rows).T, strict=True))
    answer: Any = {**of, "events": run.events, "times": times.tolist(), "family": "", **rows}
    piecewise.NUMBERS[id(answer)] = 0
    motion = piecewise.release(of)
    reported = [e for e in told_events(motion) if e[1] != "plate"]
    found = piecewise.deviations(
        answer,
        reported,
        {
            "x": motion.position(times),
            "v": motion.velocity(times),
            "finger_force": motion.force("finger", times),
        },
        explicit_piecewise.PHASE_TOLERANCE / piecewise.natural_frequency(of),
        explicit_piecewise.STATE_TOLERANCE,
    )
    assert not found, "\n".join(found)
    laws(motion)


@pytest.mark.parametrize("degrees", [60.0, 10.0, 1.0, 1e-3, 1e-6])
@pytest.mark.parametrize("drive", [DRIVE, RIGID], ids=["skin", "rigid"])
def test_a_hand_at_any_angle_obeys_the_laws(drive: Drive, degrees: float) -> None:
    """It sets out from rest, turns back and comes to rest, each time with both velocities at 0."""
    motion = moved(drive, radians(degrees))
    laws(motion)
    other = moved(drive, -radians(degrees))
    t = np.linspace(0.0, 0.3, 61)
    assert np.abs(motion.position(t) - other.position(t)).max() < 1e-15
    away = np.abs(motion.position(t) - moved(drive, 0.0).position(t)).max()
    assert away < 0.002 * max(degrees, 1e-4) ** 0.5, "it joins the aligned case"


def test_the_prototypes_figures() -> None:
    """Full pull at 60 mm/s for 100 ms: 5.9 mm along the axis as if aligned, less at 10 and 20°."""
    drive = Drive(mass=0.01, stiffness=50.0, damping=0.4, plate=Contact(0.5), finger=Contact(0.02))
    far = []
    for degrees in (0.0, 10.0, 20.0):
        release = Release(
            0.06 * cos(radians(degrees)), velocity=0.0, across_velocity=0.06 * sin(radians(degrees))
        )
        far.append(float(simulate(drive, release, duration=0.1).position(0.1)))
    assert far[0] > far[1] > far[2] > 0.5 * far[0]


def test_cut_in_two_it_is_the_same() -> None:
    motion = moved(DRIVE, radians(5.0))
    cut, last = 0.12, 0.25
    along, across = (
        Profile([0.0, *(t - cut for t in TIMES if t > cut)], [p(cut), *p.values[3:]])
        for p in hand(radians(5.0))
    )
    start = Release(
        along,
        float(motion.position(cut)),
        velocity=float(motion.velocity(cut)),
        skin_stretch=float(motion.stretch(cut)),
        across_velocity=across,
    )
    second = simulate(DRIVE, start, duration=last - cut)
    t = np.linspace(cut, last, 40)
    assert np.abs(second.position(t - cut) - motion.position(t)).max() < 1e-13


@pytest.mark.parametrize("name", ["across_velocity", "mouse_velocity", "plate_kinetic", "mass"])
def test_derivatives(name: str) -> None:
    base = {"across_velocity": 0.01, "mouse_velocity": 0.06, "plate_kinetic": 0.4, "mass": 0.01}

    def run(**values: float) -> Motion:
        drive = replace(RIGID, mass=values["mass"], plate=Contact(values["plate_kinetic"]))
        release = Release(
            values["mouse_velocity"], 0.001, 0.02, across_velocity=values["across_velocity"]
        )
        return simulate(drive, release, duration=0.06)

    t, step = np.array([0.002, 0.02, 0.05]), 1e-6 * base[name]
    found = run(**base).sensitivity([name]).position(t)[0]
    ends = [run(**{**base, name: base[name] + by}).position(t) for by in (step, -step)]
    assert found == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-5, abs=1e-9)


def test_invalid_values_are_refused() -> None:
    with pytest.raises(ValueError, match=r"across_velocity must be without a step"):
        Release(0.06, across_velocity=Profile([0.0, 0.1, 0.1], [0.0, 0.0, 0.1]))

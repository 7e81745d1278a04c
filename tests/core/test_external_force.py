"""A piecewise-linear external force, against oracles and by laws; and loads that jump, as by PWM.

A constant force moves the spring's rest by F/k, and does nothing else.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest

from core import test_oracle_piecewise as piecewise
from oracle import mp_piecewise
from oracle.answers import STATE_TOLERANCE, TIME_TOLERANCE, Case, told_events
from pindrive import Contact, Drive, Motion, Profile, Release, simulate, simulate_batch

DRIVE = Drive(
    mass=0.01,
    stiffness=100.0,
    damping=0.4,
    plate=Contact(0.03, 0.05),
    finger=Contact(0.02, 0.03, stiffness=800.0),
)
RIGID = replace(DRIVE, finger=Contact(0.02, 0.03))
PUSHES = [[0.0, 0.0], [0.01, 0.15], [0.02, 0.15], [0.02, -0.1], [0.05, 0.05], [0.07, 0.0]]
PUSH = Profile(*zip(*PUSHES, strict=True))


@pytest.mark.parametrize("force", [0.04, -0.2])
@pytest.mark.parametrize("drive", [DRIVE, RIGID], ids=["skin", "rigid"])
def test_a_constant_force_moves_the_rest(drive: Drive, force: float) -> None:
    hand = Profile([0.0, 0.05, 0.1], [0.06, 0.06, 0.0])
    shift = force / drive.stiffness
    one = simulate(drive, Release(hand, 0.002 + shift, force=force), duration=0.2)
    other = simulate(drive, Release(hand, 0.002), duration=0.2)
    t = np.linspace(0.0, 0.2, 201)
    assert np.abs(one.position(t) - shift - other.position(t)).max() < 1e-15
    assert [(e.contact, e.kind) for e in one.events] == [(e.contact, e.kind) for e in other.events]
    assert one.events[0].time == pytest.approx(other.events[0].time, rel=1e-12)
    assert one.status.name == "ok" and one.events


def case(drive: Drive, **more: Any) -> Case:
    """A release that is pushed, as the oracles take it."""
    contacts = {
        name: {
            "curve": [list(row) for row in side.curve or [(0.0, side.kinetic)]],
            "static": side.static_friction,
            "stiffness": None if side.rigid else side.stiffness,
        }
        for name, side in (("plate", drive.plate), ("finger", drive.finger))
    }
    inputs = {
        "mass": drive.mass,
        "stiffness": drive.stiffness,
        "damping": drive.damping,
        **contacts,
        "mouse_velocity": [[0.0, 0.06], [0.06, 0.06], [0.08, 0.0]],
        "load": [[0.0, 1.0]],
        "force": PUSHES,
        "displacement": 0.001,
        "velocity": None,
        "skin_stretch": None,
    }
    return {"inputs": inputs | more, "duration": 0.1}


CURVE = Contact(curve=[(0.0, 0.03), (0.05, 0.015), (0.3, 0.025)], static=0.05)
PWM = [[0.001 * (i // 2) + 0.01, 4.0 if (i + 1) // 2 % 2 else 0.5] for i in range(60)]
CASES = {
    "rigid": case(RIGID),
    "skin": case(DRIVE),
    "curve, load that changes": case(
        replace(DRIVE, plate=CURVE), load=[[0.0, 1.0], [0.03, 3.0], [0.05, 0.5]]
    ),
    "load that jumps": case(RIGID, load=PWM),
}


def against_thirty_digits(of: Case, times: int) -> tuple[Motion, int]:
    """Return the motion of a case, checked at given times and its events, and the event count."""
    motion = piecewise.release(of)
    at = np.linspace(0.0, of["duration"], times + 2)[1:-1]
    path = mp_piecewise.solve(of["inputs"], of["duration"])
    events = [
        (float(e.time), e.contact, e.kind, float(e.position), float(e.velocity))
        for e in path.events
    ]
    rows = np.array([[float(y) for y in path.state(t)] for t in at]).T
    states = dict(zip(("x", "v", "a", "finger_force"), rows, strict=False))
    reported = {
        "x": motion.position(at),
        "v": motion.velocity(at),
        "a": motion.acceleration(at),
        "finger_force": motion.force("finger", at),
    }
    piecewise.NUMBERS[id(of)] = 0
    true: Case = {**of, "events": events, "times": at.tolist(), **states}
    found = piecewise.deviations(
        true, told_events(motion), reported, TIME_TOLERANCE, STATE_TOLERANCE
    )
    assert not found, "\n".join(found)
    return motion, len(events)


@pytest.mark.parametrize("name", CASES)
def test_a_force_against_thirty_digits(name: str) -> None:
    motion, events = against_thirty_digits(CASES[name], 39)
    assert events >= 5
    laws(motion)


def laws(motion: Motion) -> None:
    assert motion.certificate().worst < 1e-11
    ledger = motion.energy
    assert abs(ledger.residual) < 1e-12 * max(map(abs, astuple(ledger)))
    assert ledger.force_work != 0.0
    assert min(ledger.plate_dissipated, ledger.finger_dissipated) >= 0.0


def test_a_force_is_mirrored_and_cut() -> None:
    hand = Profile([0.0, 0.04, 0.08], [0.06, 0.06, -0.02])
    back = Profile(hand.times, [-v for v in hand.values])
    pull = Profile(PUSH.times, [-f for f in PUSH.values])
    one = simulate(RIGID, Release(hand, 0.001, force=PUSH), duration=0.1)
    other = simulate(RIGID, Release(back, -0.001, force=pull), duration=0.1)
    t = np.linspace(0.0, 0.1, 101)
    assert np.array_equal(one.position(t), -other.position(t))
    rest = [(u - 0.03, f) for u, f in PUSHES if u > 0.03]
    force = Profile(*zip((0.0, float(PUSH(0.03))), *rest, strict=True))
    slower = Profile([0.0, 0.01, 0.05], [0.06, 0.06, -0.02])
    start = Release(slower, one.position(0.03), velocity=float(one.velocity(0.03)), force=force)
    second = simulate(RIGID, start, duration=0.07)
    assert np.abs(second.position(t[30:] - 0.03 + 0.0) - one.position(t[30:])).max() < 1e-14


@pytest.mark.parametrize("name", ["force", "force[1].value", "force[4].time"])
def test_the_derivative_along_a_force(name: str) -> None:
    def run(push: Profile) -> Motion:
        return simulate(DRIVE, Release(0.06, 0.001, force=push), duration=0.06)

    row, column = (int(name[6]), name[9:]) if "[" in name else (-1, "value")
    step, t = 1e-7, np.array([0.015, 0.03, 0.055])

    def pushed(by: float) -> Profile:
        return Profile(
            [u + by * (i == row and column == "time") for i, u in enumerate(PUSH.times)],
            [
                f + by * (row < 0 or (i == row and column == "value"))
                for i, f in enumerate(PUSH.values)
            ],
        )

    slope = run(PUSH).sensitivity([name]).position(t)[0]
    near = (run(pushed(step)).position(t) - run(pushed(-step)).position(t)) / (2 * step)
    assert np.asarray(slope).ravel() == pytest.approx(near, rel=1e-5, abs=1e-9)


def test_invalid_values_are_refused() -> None:
    with pytest.raises(ValueError, match="force must be finite"):
        Release(0.06, force=float("nan"))
    with pytest.raises(
        ValueError, match=r"force must be 0 N; `simulate` follows another, got 0\.1 N"
    ):
        simulate_batch(RIGID, Release(0.06, force="100 mN"), mass=[0.01])

"""Damped skin against an integrator that shares no code, its laws and its limits."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from oracle.damped_skin import Piece, Pin, straight, wave
from pindrive import Contact, Drive, Profile, Release, harmonic, simulate

LASTS = 0.25
AMPLITUDE, FREQUENCY = 0.03, 20.0
UNDECIDED = (45, 192)
"""Drives of which the integrator ends: a force at its limit to all digits, by round numbers."""


def drawn(rng: np.random.Generator) -> tuple[Drive, Release, Pin, float, float]:
    """A drive of round numbers and its inputs, for pindrive and for the integrator."""
    mass, stiffness = (float(rng.choice(of)) for of in ([0.005, 0.01, 0.02], [50, 100, 200]))
    damping = round(2.0 * float(rng.choice([0, 0.05, 0.1, 0.3, 1])) * (mass * stiffness) ** 0.5, 3)
    plate = float(rng.choice([0.0, 0.01, 0.02, 0.05])) * np.array([1.0, rng.choice([1.0, 1.5])])
    finger = float(rng.choice([0.005, 0.01, 0.03])) * np.array([1.0, rng.choice([1, 1, 1.5, 2])])
    skin = float(rng.choice([100, 300, 1000]))
    damper = float(rng.choice([0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0]))
    v, x = float(rng.choice([0.0, 0.02, 0.06, 0.1])), float(rng.choice([0.0, 0.5e-3, 1e-3, 2e-3]))
    last = LASTS - 0.05
    hand, along = {
        "constant": (v, [(0.0, v, 0.0)]),
        "rows": (
            Profile([0.0, 0.05, LASTS], [v, v + 0.04, v - 0.02]),
            [(0.0, v, 0.8), (0.05, v + 0.04, -0.06 / last)],
        ),
        "sinusoid": (harmonic(amplitude=AMPLITUDE, frequency=FREQUENCY, mean=v), [(0.0, v, 0.0)]),
    }[str(kind := rng.choice(["constant", "rows", "sinusoid"]))]
    load, pressed = {
        "constant": (1.0, [(0.0, 1.0, 0.0)]),
        "rows": (
            Profile([0.0, 0.1, LASTS], [1.0, 0.2, 1.5]),
            [(0.0, 1.0, -8.0), (0.1, 0.2, 1.3 / (LASTS - 0.1))],
        ),
        "jumps": (
            Profile([0.0, 0.04, 0.04, 0.12, 0.12], [1.0, 1.0, 0.4, 0.4, 1.2]),
            [(0.0, 1.0, 0.0), (0.04, 0.4, 0.0), (0.12, 1.2, 0.0)],
        ),
    }[str(rng.choice(["constant", "rows", "jumps"]))]
    pieces: list[Piece] = []
    for t in sorted({row[0] for row in (*along, *pressed)}):
        since, velocity, faster = [row for row in along if row[0] <= t][-1]
        of_touch, touch, more = [row for row in pressed if row[0] <= t][-1]
        touch += more * (t - of_touch)
        if kind == "sinusoid":
            pieces.append(wave(t, velocity, AMPLITUDE, 2.0 * pi * FREQUENCY, touch, more))
        else:
            pieces.append(straight(t, velocity + faster * (t - since), faster, touch, more))
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping=damping,
        plate=Contact(*plate),
        finger=Contact(*finger, stiffness=skin, damping=damper),
    )
    release = Release(hand, x, velocity=v, skin_stretch=0.0, finger_load=load)
    pin = Pin(mass, stiffness, damping, tuple(plate), tuple(finger), skin, damper, pieces)
    return drive, release, pin, x, v


@pytest.mark.parametrize("number", sorted({*range(302)} - {*UNDECIDED}))
def test_an_integrator_finds_the_same_motion(number: int) -> None:
    drive, release, pin, x, v = drawn(np.random.default_rng([1, number]))
    motion, times = simulate(drive, release, duration=LASTS), np.linspace(0.0, LASTS, 40)
    expected, _ = pin.follow(x, v, 0.0, times)
    found = np.array([motion.position(times), motion.velocity(times), motion.stretch(times)])
    size = np.maximum(np.abs(expected).max(axis=0), [1e-6, 1e-4, 1e-6])
    assert (np.abs(found.T - expected) / size).max() < 1e-9
    assert motion.certificate().worst < 1e-11

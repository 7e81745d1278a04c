"""Random systems of several bodies, half of the systems in round numbers."""

from __future__ import annotations

from math import floor, log10

import numpy as np

import pindrive as pd


def random_system(seed: int) -> pd.System:
    """Return a system of 1 to 6 bodies whose rigid contacts close no loop."""
    random = np.random.default_rng(seed)
    rounded = bool(seed % 2)

    def near(value: float) -> float:
        x = value * float(np.exp(random.uniform(-1.0, 1.0)))
        digit = 10.0 ** floor(log10(x))
        return round(x / digit) * digit if rounded else x

    def one_of(count: int) -> bool:
        return bool(random.integers(count) == 0)

    system = pd.System()
    count = int(random.integers(1, 7))
    for i in range(count):
        name = f"body {i}"
        start = near(2e-3) * (1 if one_of(2) else -1) if one_of(2) else 0.0
        system.body(name, near(0.005), position=start)
        if one_of(3):
            system.force(name, pd.harmonic(0.0, near(0.1), near(8.0), near(1.0)))
    for i in range(count):
        other = "ground" if i == 0 else f"body {random.integers(i)}"
        damping = near(0.3) if one_of(2) else 0.0
        system.spring(f"body {i}", other, stiffness=near(200.0), damping=damping)
    contacts = 0
    for i in range(count):
        if one_of(3) or contacts == 5:
            continue
        contacts += 1
        other = "ground" if i == 0 or one_of(2) else f"body {random.integers(i)}"
        kinetic = near(0.03)
        static = kinetic if one_of(2) else 1.5 * kinetic
        skin = one_of(2)
        load = pd.harmonic(2.0, 1.0, near(5.0)) if one_of(4) else 1.0
        presses = [c for c in system.contacts.values() if c.pressed_by is None]
        system.contact(
            f"body {i}",
            other,
            kinetic=kinetic,
            static=static,
            stiffness=near(400.0) if skin else np.inf,
            damping=near(0.3) if skin else 0.0,
            load=load,
            velocity=pd.harmonic(0.0, near(0.03), near(4.0)) if one_of(4) else 0.0,
            pressed_by=presses[0] if presses and i % 3 == 2 else None,
        )
    if one_of(2):
        body, measured = (f"body {random.integers(count)}" for _ in range(2))
        system.feedback(
            body,
            measured=measured,
            proportional=near(20.0),
            derivative=near(0.1),
            integral=near(100.0) if one_of(2) else 0.0,
            reference=pd.harmonic(0.0, near(2e-3), near(3.0)) if one_of(2) else near(2e-3),
            period=near(0.01) if one_of(2) else 0.0,
        )
    return system

"""The drives that the benchmarks release, and the truth about them in thirty digits."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive import Contact, Drive, Release

ROOT = Path(__file__).resolve().parents[2]
Floats = NDArray[np.float64]

DURATION = 0.3  # s
ORDER = (
    "mass",
    "stiffness",
    "damping",
    "plate_kinetic",
    "finger_kinetic",
    "mouse_velocity",
    "displacement",
)


DRIVE = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=Contact(0.0))
RELEASE = Release(0.1)
"""Values that all releases vary."""


def drawn(count: int, seed: int) -> dict[str, Floats]:
    """Drives and releases, even over the ranges of a tactile mouse; SI."""
    uniform = np.random.default_rng(seed).uniform
    mass, stiffness = uniform(2e-3, 20e-3, count), uniform(20.0, 400.0, count)
    return {
        "mass": mass,
        "stiffness": stiffness,
        "damping": 2.0 * uniform(0.01, 0.5, count) * np.sqrt(mass * stiffness),
        "plate_kinetic": uniform(5e-3, 100e-3, count),
        "finger_kinetic": uniform(1e-3, 50e-3, count),
        "mouse_velocity": uniform(20e-3, 300e-3, count),
        "displacement": uniform(0.5e-3, 3e-3, count),
    }


def columns(points: dict[str, Floats]) -> Floats:
    """One column a drive, its rows in the order of `ORDER`."""
    return np.array([points[name] for name in ORDER])


@cache
def exact(*drive: float) -> Any:
    """The path of one drive, by the oracle of the tests, which shares no code with the core."""
    if str(ROOT / "tests") not in sys.path:
        sys.path.append(str(ROOT / "tests"))
    from oracle import mp_oracle

    m, k, b, plate, finger, level, x = drive
    pin = mp_oracle.Pin(m, k, b, plate, plate, finger, finger, level, x)
    return mp_oracle.solve(pin, DURATION)


def exact_positions(drives: Floats, times: Floats) -> NDArray[np.object_]:
    """In thirty digits, one row a drive."""
    paths = [exact(*drive) for drive in drives.T.tolist()]
    return np.array([[path.state(t)[0] for t in times.tolist()] for path in paths], dtype=object)

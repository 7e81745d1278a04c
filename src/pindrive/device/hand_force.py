"""Force of all pins on the housing and the finger, which the hand feels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.quantities.value import concise

if TYPE_CHECKING:
    from pindrive.device.scanning import Scan
    from pindrive.motion.motion import Motion

LARGEST: Final = 0.77
"""Largest published force on a mouse, N, on a pad of high friction (Cabeças 2010,
10.2174/1875934301003010001)."""
EACH: Final = 2.5e-4
"""Time between two looks for the largest force, s."""
STEP: Final = 2e-3
"""Longest interval of the quadrature, s."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)

Array = NDArray[np.float64]


@concise
@dataclass(frozen=True, kw_only=True)
class HandForce:
    """Force of all pins on the hand over a scan, positive against the way of the drive axis.

    Attributes:
        largest: Largest size, N, at the ends of all modes and each 0.25 ms.
        time: Time of the largest on the clock of the path, s.
        mean: Mean over the scan, N.
        work: Work of the hand against it, J.
    """

    largest: float
    time: float
    mean: float
    work: float


def force_on_hand(scan: Scan, t: Array) -> Array:
    """Return the sum over the pins at times on the clock of the path, s, in the shape of t."""
    forces = [pin.motion.housing_force(pin.since(t)) for pin in scan.pins]
    return np.asarray(np.sum(forces, axis=0))


def hand_force(scan: Scan) -> HandForce:
    """Return the largest force, its mean and its work."""
    begin, end = scan.path.begin, scan.path.end
    changes = [_changes(pin.motion, end - begin) for pin in scan.pins]
    looks = np.unique(np.concatenate([np.arange(0.0, end - begin, EACH), *changes]))
    sides = [
        np.sum([pin.motion.housing_force(looks, side) for pin in scan.pins], axis=0)
        for side in ("left", "right")
    ]
    sizes = np.maximum(*np.abs(sides))
    largest = int(np.argmax(sizes))
    impulse, work = 0.0, 0.0
    for pin, edges in zip(scan.pins, changes, strict=True):
        motion = pin.motion
        parts = np.unique(np.concatenate([np.arange(0.0, end - begin, STEP), edges]))
        half = 0.5 * np.diff(parts)
        times = (parts[:-1] + half)[:, None] + half[:, None] * NODES
        force = motion.housing_force(times)
        weights = half[:, None] * WEIGHTS
        impulse += float(np.sum(weights * force))
        work += float(np.sum(weights * force * motion.plate_velocity(times)))
    return HandForce(
        largest=float(sizes[largest]),
        time=begin + float(looks[largest]),
        mean=impulse / (end - begin),
        work=work,
    )


def _changes(motion: Motion, lasts: float) -> Array:
    """Return the ends of the modes of a motion over a time, s, and its begin and end."""
    ends = np.asarray(motion.core.segments()["end"])
    return np.concatenate([[0.0], ends[ends < lasts], [lasts]])

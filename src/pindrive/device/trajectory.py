"""Vibration of pins and skin over a duration; places where functions change their sign."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.motion.drive import Drive
from pindrive.quantities import budgets

PIECES: Final = 64
"""Number of parts into which all brackets together are cut at once, at least two each: a call of
the function costs as much as some hundred of its values."""


def check_vibration(drive: Drive, duration: float, pins: int = 1) -> None:
    """Reject more turning points of all pins over a duration (s) than the budget.

    Raises:
        ValueError: Too many: the skin makes them vibrate too fast.
    """
    skin = 0.0 if drive.finger.rigid else drive.finger.stiffness
    frequency = sqrt((drive.stiffness + skin) / drive.mass) / (2.0 * pi)
    of = f"{pins} pins over {duration:g} s, which vibrate at {frequency:g} Hz"
    words = f"{of} on spring and skin; a finger without finger.stiffness is rigid"
    budgets.TURNS.check(pins * (2.0 * duration * frequency + 1.0), words if skin else of)


def roots(
    f: Callable[[Any], NDArray[np.float64]],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    sign: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The first places at which f no longer has its sign, shape (n,), by cutting brackets.

    SciPy's brentq takes fewer steps, but loading scipy.optimize takes longer than a usual scan.

    Args:
        f: Function of positions of shape (n, k), such as times.
        low: Lower ends of the brackets, shape (n,); f changes its sign once in each.
        high: Upper ends of the brackets, shape (n,).
        sign: Sign of f at the lower ends, 1 or -1, shape (n,).
    """
    pieces = max(2, PIECES // max(1, low.size))
    grid, row = np.arange(pieces + 1) / pieces, np.arange(low.size)
    while (high > low).any():
        t = low[:, None] + (high - low)[:, None] * grid
        t[:, -1] = high
        first = np.argmax(sign[:, None] * f(t[:, 1:]) <= 0.0, axis=1) + 1
        before, after = t[row, first - 1], t[row, first]
        if not ((low < before) | (after < high)).any():
            break
        low, high = before, after
    return high

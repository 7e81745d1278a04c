"""A compiled Moreau-Jean stepper: the set-valued time stepping at its best.

The midpoint rule for spring and damper; friction implicit and solved exactly in a few comparisons,
without iteration or regularisation; the coefficients of a step computed once for a drive; all of it
compiled by numba. A drive is seven numbers in the order of `releases.ORDER`.
"""

from __future__ import annotations

import numba
import numpy as np

from benchmarks.racing.releases import Floats


@numba.njit(inline="always")
def friction_step(free: float, weight: float, plate: float, finger: float, level: float) -> float:
    """The w with  weight w + plate Sgn(w - level) + finger Sgn(w) ∋ free,  level >= 0."""
    if free < -plate - finger:
        return (free + plate + finger) / weight
    if free <= finger - plate:
        return 0.0
    if free < weight * level + finger - plate:
        return (free + plate - finger) / weight
    if free <= weight * level + finger + plate:
        return level
    return (free - plate - finger) / weight


@numba.njit(inline="always")
def coefficients(m: float, k: float, b: float, h: float) -> tuple[float, float, float]:
    """Matrices of the step  weight w + impulses = of_v v + of_x x,  by the midpoint rule."""
    return m + h * b / 2 + h * h * k / 4, m - h * b / 2 - h * h * k / 4, -h * k


@numba.njit
def last_states(drives: Floats, h: float, steps: int, out: Floats) -> None:
    """Position and velocity of every drive after a number of steps."""
    for i in range(drives.shape[1]):
        m, k, b, plate, finger, level, x = drives[:, i]
        weight, of_v, of_x = coefficients(m, k, b, h)
        v = level
        for _ in range(steps):
            w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
            x += h / 2 * (v + w)
            v = w
        out[i, 0] = x
        out[i, 1] = v


@numba.njit
def trajectory(drive: Floats, h: float, every: int, out: Floats) -> None:
    """Position of one drive at the start and at even steps."""
    m, k, b, plate, finger, level, x = drive
    weight, of_v, of_x = coefficients(m, k, b, h)
    v = level
    out[0] = x
    for n in range(1, len(out)):
        for _ in range(every):
            w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
            x += h / 2 * (v + w)
            v = w
        out[n] = x


@numba.njit
def numbers(drives: Floats, h: float, steps: int, out: Floats) -> None:
    """Peak, trough, return velocity and settling time; use of each contact."""
    path = np.empty(steps + 1)
    for i in range(drives.shape[1]):
        m, k, b, plate, finger, level, x = drives[:, i]
        weight, of_v, of_x = coefficients(m, k, b, h)
        v = level
        out[i] = 0.0
        out[i, 0] = out[i, 2] = path[0] = x
        for n in range(steps):
            w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
            middle = (v + w) / 2
            x += h * middle
            path[n + 1] = x
            if x > out[i, 0]:
                out[i, 0], out[i, 1] = x, n * h
            if x < out[i, 2]:
                out[i, 2], out[i, 3] = x, n * h
            if w < out[i, 4]:
                out[i, 4], out[i, 5] = w, n * h
            if w == 0.0:
                out[i, 6] += h
            if w == level:
                out[i, 7] += h
            out[i, 8] += h * abs(middle)
            out[i, 9] += h * abs(middle - level)
            if v * w < 0.0 or (w == 0.0 and v != 0.0):
                out[i, 10] += 1.0
            if (v - level) * (w - level) < 0.0 or (w == level and v != level):
                out[i, 11] += 1.0
            v = w
        band = 0.05 * abs(path[0] - x)
        n = steps
        while n > 0 and abs(path[n] - x) <= band:
            n -= 1
        out[i, 12] = n * h
        out[i, 13], out[i, 14] = finger * out[i, 8], plate * out[i, 9]

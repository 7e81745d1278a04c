"""Lines and power series in forty digits, and the earliest zero of a series that starts positive.

A series in s stands for a step, 0 <= s <= 1, as a list of its coefficients.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from mpmath import mp, mpf

from oracle.mp_oracle import DIGITS, DOUBT, horner

TINY = mpf("1e-28")  # relative size below which a forty-digit number is zero
NARROW = mpf(2) ** -16  # of a step: where a zero cannot be told from a touch

mp.dps = DIGITS

Poly = list[mpf]


def plus(*polys: Poly) -> Poly:
    size = max(map(len, polys))
    return [sum((p[n] for p in polys if n < len(p)), mpf(0)) for n in range(size)]


def times(factor: mpf, poly: Poly) -> Poly:
    return [factor * c for c in poly]


def by_line(line: Poly, poly: Poly) -> Poly:
    """The product of a line and a series."""
    return plus(times(line[0], poly), [mpf(0), *times(line[1], poly)])


def derivative(poly: Poly) -> Poly:
    return [n * c for n, c in enumerate(poly)][1:] or [mpf(0)]


class Profile:
    """Piecewise linear, constant outside its rows; knots are exact."""

    def __init__(self, rows: Sequence[Sequence[float]]) -> None:
        self.rows = [(mpf(t), mpf(y)) for t, y in rows]

    def __call__(self, t: mpf) -> mpf:
        if t < self.rows[0][0]:
            return self.rows[0][1]
        for (t0, y0), (t1, y1) in pairwise(self.rows):
            if t < t1:
                return y0 + (y1 - y0) * (t - t0) / (t1 - t0)
        return self.rows[-1][1]

    def slope(self, t: mpf) -> mpf:
        """Just after t."""
        for (t0, y0), (t1, y1) in pairwise(self.rows):
            if t0 <= t < t1:
                return (y1 - y0) / (t1 - t0)
        return mpf(0)


@dataclass(frozen=True)
class Guard:
    """A series that is positive until `kind` happens.

    A "level" or a "limit" is reached, or a new band is entered, "down" or "up".
    """

    contact: str
    kind: str
    poly: Poly
    scale: mpf

    @property
    def order(self) -> int:
        """Order of its zero at s = 0."""
        return next(n for n, c in enumerate(self.poly) if abs(c) > TINY * self.scale)

    @property
    def rest(self) -> Poly:
        """The guard without its zero at s = 0; its first coefficient tells the sign just after."""
        return self.poly[self.order :]

    @property
    def idle(self) -> bool:
        """True if it is zero at all times."""
        return all(abs(c) <= TINY * self.scale for c in self.poly)


def earliest_zero(guard: Guard, unit: mpf, doubt: Callable[[str, mpf], None]) -> mpf:
    """The earliest s in [0, 1] where the guard turns negative; 1 if there is none.

    A zero at s = 0 counts only if the guard is negative just after it. `unit` is the part of a time
    constant that s = 1 stands for; `doubt` is told why and where the answer is ill-conditioned.
    """
    order, g = guard.order, guard.rest
    if abs(g[0]) < DOUBT * guard.scale * unit**order / 10:
        doubt("guard almost zero at the start", mpf(0))
    if g[0] < 0:
        return mpf(0)
    if g[0] > sum(map(abs, g[1:])):
        return mpf(1)
    slope = derivative(g)
    bend = sum(map(abs, derivative(slope)), mpf(0))
    todo = [(mpf(0), mpf(1))]
    while todo:
        low, high = todo.pop()
        middle, half = (low + high) / 2, (high - low) / 2
        value, rate = horner(g, middle), horner(slope, middle)
        if value > half * (abs(rate) + half * bend / 2):
            continue
        if abs(rate) > half * bend:  # monotone here
            if horner(g, high) < 0:
                s = root(g, slope, low, high)
                if horner(slope, s) ** 2 < 2 * bend * DOUBT * guard.scale:
                    doubt("guard met barely", s)
                return s
        elif half < NARROW:
            doubt("guard grazed", middle)
        else:
            todo += [(middle, high), (low, middle)]
    return mpf(1)


def root(g: Poly, slope: Poly, low: mpf, high: mpf) -> mpf:
    """Return the downward zero of g in [low, high]: bisection, then Newton's iteration."""
    for _ in range(36):
        middle = (low + high) / 2
        low, high = (middle, high) if horner(g, middle) > 0 else (low, middle)
    s = (low + high) / 2
    for _ in range(3):
        s -= horner(g, s) / horner(slope, s)
    return s

"""Motions on a compliant finger with a friction curve, in forty digits.

The pin slides on the plate, with constant friction; the slider of the finger's skin grips, or
slides at the speed at which its curve carries what the skin asks. Each mode is followed by the
Taylor series of its own linear equations, and its end is found by bisection.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from mpmath import mp, mpf

mp.dps = 40
ORDER = 40
TINY = mpf("1e-36")
State = tuple[mpf, mpf, mpf]  # position, velocity, force on the skin


@dataclass
class Slider:
    """A pin that slides past the plate on one side, and its skin."""

    mass: mpf
    stiffness: mpf
    damping: mpf
    plate: mpf  # force of the plate on the pin, while it slides on this side
    skin: mpf
    static: mpf
    rows: Sequence[tuple[mpf, mpf]]
    events: list[tuple[mpf, str]] = field(default_factory=list)

    def friction(self, speed: mpf) -> mpf:
        """The curve, whose last slope goes on."""
        at = max(i for i, (u, _) in enumerate(self.rows) if u <= speed)
        i = min(at, len(self.rows) - 2)
        (u, f), (w, g) = self.rows[i], self.rows[i + 1]
        return f + (g - f) / (w - u) * (speed - u)

    def piece(self, speed: mpf) -> tuple[mpf, mpf]:
        """Friction continued to no speed, and its slope, on the piece of a speed."""
        i = min(max(j for j, (u, _) in enumerate(self.rows) if u <= speed), len(self.rows) - 2)
        (u, f), (w, g) = self.rows[i], self.rows[i + 1]
        slope = (g - f) / (w - u)
        return f - slope * u, slope

    def terms(self, state: State, side: int, piece: tuple[mpf, mpf]) -> list[State]:
        """The Taylor terms of the mode: gripped (side 0), or sliding to a side on a piece."""
        base, slope = piece
        terms = [state]
        for n in range(ORDER):
            x, v, q = terms[-1]
            constant = self.plate if n == 0 else mpf(0)
            a = (constant - self.stiffness * x - self.damping * v - q) / self.mass
            speed = mpf(0)
            if side:  # q = side (base + slope |u|)
                speed = (q - (side * base if n == 0 else 0)) / slope
            terms.append((v / (n + 1), a / (n + 1), self.skin * (v - speed) / (n + 1)))
        return terms

    def speed(self, state: State, side: int, piece: tuple[mpf, mpf]) -> mpf:
        base, slope = piece
        return (side * state[2] - base) / slope


def value(terms: Sequence[State], time: mpf) -> State:
    x = v = q = mpf(0)
    for a, b, c in reversed(terms):
        x, v, q = x * time + a, v * time + b, q * time + c
    return x, v, q


def landing(of: Slider, asked: mpf, speeds: Sequence[mpf], up: bool) -> mpf | None:
    """The next speed at which a rising piece carries what is asked, going up or down."""
    found = []
    for i, (u, f) in enumerate(of.rows[:-1]):
        w, g = of.rows[i + 1]
        last = i == len(of.rows) - 2
        if g <= f:
            continue
        at = u + (asked - f) * (w - u) / (g - f)
        if at >= u and (last or at <= w):
            found.append(at)
    now = speeds[0]
    if up:
        return min((s for s in found if s >= now), default=None)
    return max((s for s in found if s <= now), default=None)


def solve(inputs: dict[str, Any], times: Sequence[float]) -> tuple[list[State], Slider]:
    """States at times, which increase, and the events at the finger."""
    rows = [(mpf(u), mpf(f)) for u, f in inputs["rows"]]
    numbers = {n: mpf(inputs[n]) for n in ("mass", "stiffness", "damping", "plate", "skin")}
    of = Slider(**numbers, static=mpf(inputs["static"]), rows=rows)
    state: State = (mpf(inputs["displacement"]), mpf(inputs["velocity"]), mpf(0))
    side, piece = 0, (mpf(0), mpf(1))
    now, found = mpf(0), []
    rate = of.skin / min(abs(g - f) / (w - u) for (u, f), (w, g) in pairwise(rows))
    step = 1 / (rate + (of.stiffness + of.skin) ** mpf("0.5") / of.mass ** mpf("0.5"))
    for time in map(mpf, times):
        while now < time:
            terms = of.terms(state, side, piece)
            end = min(step, time - now)
            guards = _guards(of, side, piece)
            met = None
            for name, guard in guards.items():
                if guard(value(terms, end)) < 0 < guard(value(terms, end / 1024)):
                    early, late = end / 1024, end
                    while late - early > TINY * end:
                        middle = (early + late) / 2
                        if guard(value(terms, middle)) < 0:
                            late = middle
                        else:
                            early = middle
                    if met is None or early < met[0]:
                        met = (early, name)
            after = met[0] if met else end
            state = value(terms, after)
            now += after
            if not met:
                continue
            asked = abs(state[2])
            if side == 0:
                side = int(met[1])
                at = landing(of, of.static, [mpf(0)], up=True)
                assert at is not None
                of.events.append((now, "slip"))
                piece = of.piece(at + TINY)
                continue
            low, high = _ends(of, piece)
            if met[1] == "high":
                assert high is not None
                at = landing(of, asked, [high + TINY], up=True)
                assert at is not None
                piece = of.piece(at + TINY)
            else:
                at = landing(of, asked, [low - TINY], up=False) if low > 0 else None
                if at is None:
                    side = 0
                    of.events.append((now, "stick"))
                else:
                    piece = of.piece(at - TINY)
        found.append(state)
    return found, of


def _guards(of: Slider, side: int, piece: tuple[mpf, mpf]) -> dict[str, Callable[[State], mpf]]:
    """What stays positive in a mode."""
    if side == 0:
        return {"1": lambda s: of.static - s[2], "-1": lambda s: of.static + s[2]}
    low, high = _ends(of, piece)
    guards: dict[str, Callable[[State], mpf]] = {"low": lambda s: of.speed(s, side, piece) - low}
    if high is not None:
        guards["high"] = lambda s: high - of.speed(s, side, piece)
    return guards


def _ends(of: Slider, piece: tuple[mpf, mpf]) -> tuple[mpf, mpf | None]:
    for i, (u, _) in enumerate(of.rows[:-1]):
        if of.piece(u) == piece:
            return u, of.rows[i + 1][0] if i < len(of.rows) - 2 else None
    raise AssertionError

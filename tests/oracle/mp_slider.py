"""Motions on a compliant finger with a friction curve, in forty digits.

The slider of the finger's skin grips, or slides at the speed at which its curve carries what the
skin asks; the plate has Coulomb friction, whose load and velocity are piecewise linear. Each mode
is followed by the Taylor series of its own linear equations, and its end is the earliest zero of
its guards.

Inputs are a mapping of SI values as in `mp_piecewise`, with `finger_load`, a factor on the finger's
friction, over time. It is zero at rows only, and only where the finger has Coulomb friction: a
curve of two rows with one force. The finger's curve has no plateau but beyond its last row but one,
and does not fall there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from mpmath import inf, mpf, sign, sqrt

from oracle.mp_modes import DoubtError
from oracle.mp_oracle import DOUBT, Event, horner
from oracle.mp_series import TINY, Guard, Poly, Profile, earliest_zero, plus, times

ORDER = 40
MOST_STEPS = 2000


@dataclass(frozen=True)
class Branch:
    """Friction base + slope |u| from one speed to another."""

    low: mpf
    high: mpf
    base: mpf
    slope: mpf

    def at(self, speed: mpf) -> mpf:
        return self.base + self.slope * speed


@dataclass(frozen=True)
class Piece:
    """Position, velocity and the skin's force: polynomials in (t - begin) / width."""

    begin: mpf
    width: mpf
    terms: tuple[Poly, Poly, Poly]


@dataclass
class Path:
    pieces: list[Piece] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def state(self, time: float | mpf) -> tuple[mpf, mpf, mpf]:
        """Position, velocity, and force of the finger on the pin."""
        piece = next(p for p in reversed(self.pieces) if p.begin <= time)
        s = (time - piece.begin) / piece.width
        x, v, q = (horner(poly, s) for poly in piece.terms)
        return x, v, -q


def branches(curve: list[list[float]]) -> list[Branch]:
    """Return the branches of a curve, whose last slope continues."""
    found = []
    for (u, f), (w, g) in pairwise([(mpf(u), mpf(f)) for u, f in curve]):
        slope = (g - f) / (w - u)
        found.append(Branch(u, w, f - slope * u, slope))
    last = found[-1]
    found[-1] = Branch(last.low, inf, last.base, last.slope)
    return found


class _Skin:
    def __init__(self, inputs: Mapping[str, Any], duration: float) -> None:
        self.m, self.k, self.b = (mpf(inputs[n]) for n in ("mass", "stiffness", "damping"))
        self.skin, self.static = (mpf(inputs["finger"][n]) for n in ("stiffness", "static"))
        self.curve = branches(inputs["finger"]["curve"])
        self.kinetic = mpf(inputs["plate"]["curve"][0][1])
        self.limit = mpf(inputs["plate"]["static"])
        self.mouse, self.load = Profile(inputs["mouse_velocity"]), Profile(inputs["load"])
        self.touch = Profile(inputs.get("finger_load", [[0.0, 1.0]]))
        profiles = (self.mouse, self.load, self.touch)
        knots = {t for p in profiles for t, _ in p.rows} | {mpf(duration)}
        self.knots = sorted(t for t in knots if 0 < t <= duration)
        self.t, self.x, self.v = mpf(0), mpf(inputs["displacement"]), mpf(inputs["velocity"])
        self.q = self.skin * mpf(inputs["skin_stretch"])
        self.plate = int(sign(self.v - self.mouse(self.t)))
        self.side, self.branch = 0, self.curve[0]
        self.frequency = sqrt((self.k + self.skin) / self.m)
        moves = [abs(v) for _, v in self.mouse.rows]
        self.speed = max(*moves, abs(self.v), sqrt(self.k / self.m) * abs(self.x))
        self.force = max(self.static, self.limit)
        self.presses, self.gone = self.touch.slope(self.t), False
        self.path = Path()

    # -- a step --------------------------------------------------------------------------------

    def series(self, h: mpf) -> tuple[Poly, Poly, Poly, Poly]:
        """Position, velocity, the skin's force, and the speed of the slider, over a step."""
        v_p, load = self.over(self.mouse, h), self.over(self.load, h)
        touch = self.over(self.touch, h)
        inertia = self.m * self.mouse.slope(self.t)
        x, v, q = [self.x], [self.v], [self.q]
        speed: Poly = []
        for n in range(ORDER):
            push = inertia if n == 0 else mpf(0)
            if n < 2:
                push -= self.plate * self.kinetic * load[n]
            forces = push - self.k * x[n] - self.b * v[n] - q[n]
            base = self.side * self.branch.base
            if self.lifted:
                slides = v[n]
            elif self.side == 0:
                slides = mpf(0)
            elif self.branch.slope == 0:
                slides = v[n] - (base * touch[1] / (h * self.skin) if n == 0 else 0)
            else:  # q = λ (base + slope u), order by order
                carried = (q[n] - (base * touch[n] if n < 2 else 0)) / self.branch.slope
                slides = (carried - (touch[1] * self.side * speed[n - 1] if n else 0)) / touch[0]
            speed.append(self.side * slides)
            x.append(h * v[n] / (n + 1))
            rate = h * forces / (self.m * (n + 1))
            v.append(rate if self.plate else v_p[n + 1] if n == 0 else mpf(0))
            q.append(h * self.skin * (v[n] - slides) / (n + 1))
        return x, v, q, speed

    def over(self, profile: Profile, h: mpf) -> Poly:
        return [profile(self.t), profile.slope(self.t) * h]

    def guards(self, series: tuple[Poly, Poly, Poly, Poly], h: mpf) -> list[Guard]:
        x, v, q, speed = series
        found = []
        if self.plate:
            u = plus(v, times(mpf(-1), self.over(self.mouse, h)))
            found.append(Guard("plate", "level", times(mpf(self.plate), u), self.speed))
        else:
            most = times(self.limit, self.over(self.load, h))
            needed = plus(times(self.k, x), times(self.b, v), q)
            found += [
                Guard("plate", f"{-way:+d}", plus(most, times(mpf(-way), needed)), self.force)
                for way in (1, -1)
            ]
        if self.lifted:
            pass
        elif self.side:
            low, high = self.branch.low, self.branch.high
            found.append(Guard("finger", "low", plus(speed, [-low]), self.speed))
            if high < inf:
                above = plus([high], times(mpf(-1), speed))
                found.append(Guard("finger", "high", above, self.speed))
        else:
            holds = times(self.static, self.over(self.touch, h))
            found += [
                Guard("finger", f"{way:+d}", plus(holds, times(mpf(-way), q)), self.force)
                for way in (1, -1)
            ]
        return [guard for guard in found if not guard.idle]

    def solve(self) -> Path:
        rates = [self.skin / b.slope for b in self.curve if b.slope]
        least = min([y for _, y in self.touch.rows if y > 0], default=mpf(1))
        longest = 1 / (max([mpf(0), *map(abs, rates)]) / least + self.frequency + self.b / self.m)
        self.touches(mpf(0))
        for _ in range(MOST_STEPS):
            if self.t == self.knots[-1]:
                return self.path
            knot = next(t for t in self.knots if t > self.t)
            h = min(longest, knot - self.t)
            series = self.series(h)
            met = sorted(
                ((earliest_zero(guard, h / longest, doubt), guard)
                 for guard in self.guards(series, h)),
                key=lambda one: one[0],
            )  # fmt: skip
            s, guard = met[0]
            if len(met) > 1 and s < 1 and met[1][0] - s < DOUBT:
                raise DoubtError("two at once")
            if s > 0:
                x, v, q, _ = series
                self.path.pieces.append(Piece(self.t, h, (x, v, q)))
                self.x, self.v, self.q = (horner(p, s) for p in (x, v, q))
            self.t = knot if s == 1 and h == knot - self.t else self.t + s * h
            if s < 1 and guard.contact == "plate":
                self.at_plate(guard.kind)
            elif s < 1:
                self.at_finger(guard.kind)
            elif self.t == knot and self.t < self.knots[-1]:
                self.touches(self.presses)
            self.presses = self.touch.slope(self.t)
        raise DoubtError("too many steps")

    # -- what follows --------------------------------------------------------------------------

    def event(self, contact: str, kind: str) -> None:
        self.path.events.append(Event(self.t, contact, kind, self.x, self.v))

    def at_plate(self, kind: str) -> None:
        if kind != "level":
            self.plate = int(kind)
            self.event("plate", "slip")
            return
        self.v = self.mouse(self.t)
        needed = self.k * self.x + self.b * self.v + self.q
        if not apart(abs(needed), self.limit * self.load(self.t)):
            raise DoubtError("at its limit")
        if abs(needed) < self.limit * self.load(self.t):
            self.plate = 0
            self.event("plate", "stick")
        else:
            self.plate = -int(sign(needed))
            self.event("plate", "reverse")

    @property
    def lifted(self) -> bool:
        return bool(self.touch(self.t) == 0 and self.touch.slope(self.t) == 0)

    def follows(self, force: mpf) -> mpf:
        """Speed at which the stretch of a friction grows with the load."""
        return force * self.touch.slope(self.t) / self.skin

    def touches(self, before: mpf) -> None:
        """The load jumps or changes its rate, from `before`."""
        load, was = self.touch(self.t), self.side
        if self.t > 0 and before == self.touch.slope(self.t) and len(self.touch.rows) == 1:
            return
        if load == 0:
            if len(self.curve) > 1 or self.branch.slope:
                raise DoubtError("a curve without load")
            drops = bool(abs(self.q) > DOUBT * self.force)
            fast = abs(self.v) > self.follows(self.branch.base)
            self.q, self.side = mpf(0), int(sign(self.v)) if fast and not self.lifted else 0
            gone, self.gone = self.gone, self.lifted
            if self.t == 0 or (gone and self.side):
                return
            if drops or (self.lifted and not gone and was == 0):
                self.event("finger", "slip")
            elif not self.lifted and (gone or self.side != was):
                kinds = {0: "slip", -self.side: "reverse"}
                self.event("finger", "stick" if self.side == 0 else kinds[was])
            return
        if self.gone:
            self.gone = False
            self.event("finger", "stick")
            return
        requested, drops = abs(self.q) / load, False
        if self.side == 0:
            if not apart(requested, self.static):
                raise DoubtError("at its limit")
            if requested > self.static:
                self.side = int(sign(self.q))
                drops = self.faster(0)
        else:
            number = self.curve.index(self.branch)
            low, high = (self.branch.at(u) if u < inf else inf for u in self.ends())
            if self.branch.slope == 0:
                low = high = self.branch.base
                if same(requested, low):
                    if self.side * self.v - self.follows(low) < self.branch.low:
                        self.slower(number)
                    requested = low
            if requested > high and not same(requested, high):
                drops = self.faster(number if self.branch.slope == 0 else number + 1)
            elif requested < low and not same(requested, low):
                self.slower(number)
        if drops or self.side != was:
            self.event("finger", "slip" if drops or self.side else "stick")

    def ends(self) -> tuple[mpf, mpf]:
        return self.branch.low, self.branch.high

    def at_finger(self, kind: str) -> None:
        """A skin that becomes shorter at once slips, also where it grips again at that instant."""
        was, drops = self.side, False
        if was == 0:
            self.side = int(kind)
            self.q = self.side * self.static * self.touch(self.t)
            drops = self.faster(0)
        else:
            end = self.branch.low if kind == "low" else self.branch.high
            self.q = self.side * self.branch.at(end) * self.touch(self.t)
            number = self.curve.index(self.branch)
            if kind == "high":
                drops = self.faster(number + 1)
            else:
                self.slower(number)
        if drops or self.side != was:
            self.event("finger", "slip" if drops or self.side else "stick")

    def faster(self, first: int) -> bool:
        """To the first speed from a branch on that carries what the skin asks.

        Without one the skin becomes shorter at once, until the last plateau carries it; whether it
        did.
        """
        requested = abs(self.q) / self.touch(self.t)
        for branch in self.curve[first:]:
            begin = branch.at(branch.low)
            if (
                branch.slope > 0
                and reaches(requested, begin)
                and below(requested, branch.at(branch.high))
            ):
                self.branch = branch
                return False
            if branch.slope == 0:
                if not reaches(requested, begin):
                    raise DoubtError("below its plateau")
                speed = self.side * self.v - self.follows(branch.base)
                if not apart(speed, branch.low):
                    raise DoubtError("as fast as a row")
                self.q = self.side * branch.base * self.touch(self.t)
                if speed > branch.low:
                    self.branch = branch
                else:
                    self.slower(len(self.curve) - 1)
                return not same(requested, begin)
        raise DoubtError("no speed carries it")

    def slower(self, number: int) -> None:
        """To the first speed below a branch that carries what the skin asks; else it grips."""
        requested = abs(self.q) / self.touch(self.t)
        for branch in reversed(self.curve[:number]):
            if branch.slope > 0 and reaches(requested, branch.at(branch.low)):
                self.branch = branch
                return
        self.side = 0


def apart(one: mpf, other: mpf) -> bool:
    return bool(abs(one - other) > DOUBT * max(abs(one), abs(other)))


def same(one: mpf, other: mpf) -> bool:
    """Return True if two numbers from two methods are equal; a doubtful case raises."""
    if abs(one - other) <= TINY * max(abs(one), abs(other)):
        return True
    if not apart(one, other):
        raise DoubtError("at the end of a branch")
    return False


def reaches(requested: mpf, force: mpf) -> bool:
    return same(requested, force) or bool(requested > force)


def below(requested: mpf, force: mpf) -> bool:
    return force == inf or (not same(requested, force) and bool(requested < force))


def doubt(reason: str, _: mpf) -> None:
    raise DoubtError(reason)


def solve(inputs: Mapping[str, Any], duration: float) -> Path:
    """The motion from release to `duration` (s)."""
    return _Skin(inputs, duration).solve()

"""Motions under a hand that moves across the axis too, in forty digits, through w = 0.

The plate's friction opposes the whole sliding velocity (u, w), and the finger is rigid or
absent. Where u and w are not both zero the equation of motion is integrated by its Taylor
series. Where both come to zero at once, the pin creeps: with u = |w| q there is one power
series of q on either side of that instant, and the motion before it is joined to it where the
two agree to 28 digits, at that instant at the latest.

Inputs are a mapping of SI values as in `mp_piecewise`, with rows of `across`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from mpmath import exp, fdot, log, mpf, sqrt

from oracle.mp_modes import DoubtError
from oracle.mp_oracle import Event, horner
from oracle.mp_series import Guard, Poly, Profile, earliest_zero

ORDER = 40
REST = mpf("1e-40")  # of the scale: the last terms of a step
JOINED = mpf("1e-28")  # of the speed: where creep and the motion before it agree
MOST_STEPS = 300


@dataclass(frozen=True)
class Piece:
    """x = sum of terms[n] (time - base)^n from begin to end."""

    base: mpf
    begin: mpf
    end: mpf
    terms: Poly

    def state(self, time: mpf) -> tuple[mpf, mpf]:
        rates = [n * c for n, c in enumerate(self.terms)][1:]
        return horner(self.terms, time - self.base), horner(rates, time - self.base)


@dataclass
class Path:
    pieces: list[Piece] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    met: int = 0  # how often u and w came to zero at once

    def state(self, time: float) -> tuple[mpf, mpf]:
        at = mpf(time)
        return next(p for p in self.pieces if at <= p.end).state(at)


class _Oblique:
    def __init__(self, inputs: Mapping[str, Any], duration: float) -> None:
        self.m, self.k, self.b = (mpf(inputs[n]) for n in ("mass", "stiffness", "damping"))
        self.force_of_plate = mpf(inputs["plate"]["curve"][0][1])
        self.kinetic = mpf(inputs["finger"]["curve"][0][1])
        self.static = mpf(inputs["finger"]["static"])
        self.mouse, self.across, self.load, self.push = (
            Profile(inputs[n]) for n in ("mouse_velocity", "across", "load", "force")
        )
        profiles = (self.mouse, self.across, self.load, self.push)
        knots = {t for profile in profiles for t, _ in profile.rows} | {mpf(duration)}
        for (t0, w0), (t1, w1) in pairwise(self.across.rows):
            if w0 * w1 < 0:
                knots.add(t0 + (t1 - t0) * w0 / (w0 - w1))
        self.knots = sorted(t for t in knots if 0 < t <= duration)
        self.t, self.x, self.v = mpf(0), mpf(inputs["displacement"]), mpf(inputs["velocity"])
        self.finger = 0 if self.static == 0 else 1 if self.v > 0 else -1
        self.rests = False
        self.frequency = sqrt(self.k / self.m)
        rows = [abs(v) for profile in (self.mouse, self.across) for _, v in profile.rows]
        self.speed = max(*rows, abs(self.v), self.frequency * abs(self.x))
        self.path = Path()

    # -- series --------------------------------------------------------------------------------

    def lines(self, way: int) -> list[Poly]:
        """Velocities of the plate along and across, load and force, from here on or back."""
        return [
            [p(self.t), way * p.slope(self.t)]
            for p in (self.mouse, self.across, self.load, self.push)
        ]

    def series(self) -> tuple[Poly, Poly, Poly]:
        """Position, velocity and what the finger carries, in the time from here on."""
        v_p, w, load, push = ([*line, *[mpf(0)] * ORDER] for line in self.lines(1))
        squared = [w[0] ** 2, 2 * w[0] * w[1], w[1] ** 2, *[mpf(0)] * ORDER]
        x, v = [self.x], [self.v]
        u: Poly = []
        r: Poly = []
        d: Poly = []
        carried: Poly = []
        for n in range(ORDER):
            u.append(v[n] - v_p[n])
            square = squared[n] + fdot(u, u[::-1]) - (fdot(r[1:], r[:0:-1]) if n > 1 else 0)
            r.append(sqrt(square) if n == 0 else square / (2 * r[0]))
            d.append((u[n] - (fdot(r[1:], d[::-1]) if n > 0 else 0)) / r[0])
            plate = self.force_of_plate * (load[0] * d[n] + (load[1] * d[n - 1] if n > 0 else 0))
            forces = push[n] - self.b * v[n] - self.k * x[n] - plate
            if n == 0:
                forces += self.m * v_p[1] - (0 if self.rests else self.finger * self.kinetic)
            carried.append(forces)
            x.append(v[n] / (n + 1))
            v.append(mpf(0) if self.rests else forces / (self.m * (n + 1)))
        return x, v, carried

    def creep(self, x: mpf, way: int) -> tuple[Poly, Poly, Poly]:
        """Position, velocity and q from (way 1) or to (-1) the instant u = w = 0, in |time|."""
        v_p, w, load, push = ([*line, *[mpf(0)] * ORDER] for line in self.lines(way))
        rate, kinetic = abs(w[1]), self.finger * self.kinetic
        xs = [x]
        v: Poly = []
        q: Poly = []
        s: Poly = []
        d: Poly = []
        for n in range(ORDER):
            v.append(v_p[n] + (rate * q[n - 1] if n > 0 else 0))
            rest = push[n] - self.b * v[n] - self.k * xs[n] - (kinetic if n == 0 else 0)
            rest -= self.force_of_plate * load[1] * d[n - 1] if n > 0 else 0
            inertia, strength = way * self.m * rate * (n + 1), load[0] * self.force_of_plate
            if n == 0:
                q.append(self.balance(inertia, strength, rest))
                s.append(sqrt(1 + q[0] ** 2))
                d.append(q[0] / s[0])
            else:
                half = fdot(q[1:], q[:0:-1]) - fdot(s[1:], s[:0:-1]) if n > 1 else mpf(0)
                known_s = half / (2 * s[0])
                known_d = -(fdot(s[1:], d[:0:-1]) + known_s * d[0]) / s[0]
                slope = inertia + strength / s[0] ** 3
                if abs(slope) < mpf("1e-3") * abs(inertia):
                    raise DoubtError("creep in resonance")
                q.append((rest - strength * known_d) / slope)
                s.append(known_s + d[0] * q[n])
                d.append(known_d + q[n] / s[0] ** 3)
            xs.append(way * v[n] / (n + 1))
        return xs, v, q

    def balance(self, inertia: mpf, strength: mpf, rest: mpf) -> mpf:
        """Solve inertia q + strength q / sqrt(1 + q^2) = rest, by bisection and Newton."""
        if inertia < 0 and abs(rest) >= strength * mpf("0.98"):
            raise DoubtError("friction nearly all used")
        low, high = (
            (-(abs(rest) / inertia) - 1, abs(rest) / inertia + 1) if inertia > 0 else (-5, 5)
        )
        low, high = mpf(low), mpf(high)
        for _ in range(60):
            q = (low + high) / 2
            low, high = (
                (q, high) if inertia * q + strength * q / sqrt(1 + q * q) < rest else (low, q)
            )
        for _ in range(4):
            s = sqrt(1 + q * q)
            q -= (inertia * q + strength * q / s - rest) / (inertia + strength / s**3)
        return q

    # -- steps ---------------------------------------------------------------------------------

    def reach(self, series: Poly, size: mpf) -> mpf:
        """Return the range of a series."""
        last = (series[n] for n in range(ORDER - 4, ORDER))
        far = (abs(c) / size for c in last)
        return min(
            (exp(log(REST / c) / n) for n, c in enumerate(far, ORDER - 4) if c != 0),
            default=mpf("inf"),
        )

    def take(self, base: mpf, end: mpf, terms: Poly) -> None:
        piece = Piece(base, self.t, end, terms)
        self.path.pieces.append(piece)
        self.x, self.v = piece.state(end)
        self.t = end

    def doubt(self, reason: str, _: mpf) -> None:
        raise DoubtError(reason)

    def guards(self, v: Poly, carried: Poly, h: mpf) -> list[Guard]:
        def over(poly: Poly) -> Poly:
            return [c * h**n for n, c in enumerate(poly)]

        if self.finger == 0:
            return []
        if not self.rests:
            return [Guard("finger", "level", over([self.finger * c for c in v]), self.speed)]
        force = self.k * self.speed / self.frequency
        more = [[self.static - side * carried[0], *(-side * c for c in carried[1:])]
                for side in (1, -1)]  # fmt: skip
        return [Guard("finger", f"{side:+d}", over(p), force)
                for side, p in zip((1, -1), more, strict=True)]  # fmt: skip

    def joins(self, knot: mpf) -> bool:
        """Goes to the instant where u and w are zero, if the pin creeps there from here on."""
        w, v_p = self.across(self.t), self.mouse(self.t)
        if self.rests or self.across(knot) != 0 or abs(self.v - v_p) > 20 * abs(w):
            return False
        here, self.t, left = self.t, knot, knot - self.t
        # The inputs just before the knot, told from the line that ends there.
        lines = self.lines
        ahead = {
            p: (p(here), p.slope(here)) for p in (self.mouse, self.across, self.load, self.push)
        }
        self.lines = lambda way: [  # type: ignore[method-assign]
            [at + rate * left, -rate] for at, rate in ahead.values()
        ]
        try:
            x = self.x
            for _ in range(60):
                xs, v, q = self.creep(x, -1)
                if self.reach(q, max(map(abs, q[:3]))) < left:
                    break
                off = self.x - horner(xs, left)
                if abs(horner(v, left) - self.v) > mpf("1e-3") * self.speed:
                    break
                x += off
                if abs(off) <= REST * self.speed / self.frequency:
                    if abs(horner(v, left) - self.v) > JOINED * self.speed:
                        break
                    self.t = here
                    if self.finger != 0 and any(
                        self.finger * horner(v, left * i / 16) <= 0 for i in range(17)
                    ):
                        raise DoubtError("turns while it creeps")
                    self.take(knot, knot, [c * (-1) ** n for n, c in enumerate(xs)])
                    self.v = v[0]
                    self.path.met += 1
                    return True
        except DoubtError as doubt:
            if doubt.args[0] == "turns while it creeps":
                raise
        finally:
            self.lines = lines  # type: ignore[method-assign]
        self.t = here
        return False

    def solve(self) -> Path:
        sets_out = False
        for _ in range(MOST_STEPS):
            if self.t == self.knots[-1]:
                return self.path
            knot = next(t for t in self.knots if t > self.t)
            if not sets_out and self.joins(knot):
                sets_out = True
                continue
            if sets_out:
                x, v, q = self.creep(self.x, 1)
                far, carried = self.reach(q, max(map(abs, q[:3]))), [mpf(0)] * ORDER
            else:
                x, v, carried = self.series()
                far = min(
                    self.reach(v, self.speed),
                    self.reach(carried, self.k * self.speed / self.frequency),
                )
            sets_out = False
            h = min(far, knot - self.t)
            met, kind = mpf(1), ""
            for guard in self.guards(v, carried, h):
                zero = earliest_zero(guard, h * self.frequency, self.doubt)
                if zero < met:
                    met, kind = zero, guard.kind
            end = knot if met == 1 and h == knot - self.t else self.t + met * h
            self.take(self.t, end, x)
            if met < 1:
                self.event(kind)
            elif end == knot and self.across(knot) == 0 and not self.rests:
                off = self.v - self.mouse(knot)
                sets_out = abs(off) <= JOINED * self.speed  # it has crept all the way
                self.path.met += sets_out
        raise DoubtError("too many steps")

    def event(self, kind: str) -> None:
        self.v = mpf(0)
        if kind != "level":
            self.finger, self.rests, reported = int(kind), False, "slip"
        else:
            self.rests = True
            needed = self.series()[2][0]
            if abs(abs(needed) - self.static) < mpf("1e-6") * self.static:
                raise DoubtError("at its limit")
            self.rests = abs(needed) < self.static
            reported = "stick" if self.rests else "reverse"
            if not self.rests:
                self.finger = 1 if needed > 0 else -1
        self.path.events.append(Event(self.t, "finger", reported, self.x, self.v))


def solve(inputs: Mapping[str, Any], duration: float) -> Path:
    """The motion from release to `duration` (s)."""
    return _Oblique(inputs, duration).solve()

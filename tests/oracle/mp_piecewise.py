"""Thirty-digit oracle for piecewise-linear drives: curves, skin, a load and a mouse that move.

As in `mp_oracle` the equation of motion is integrated by its Taylor series. Every guard (a sliding
velocity, a distance to a breakpoint of a curve, a margin below a friction limit) is then a power
series too, positive while its mode lasts. Its earliest zero is found by halving the step until a
bound on the second derivative excludes a zero or proves the series monotone. What follows at a stop
is not read off the event: each mode that the velocities allow is tried, and it is possible if the
leading coefficients of its guards are positive.

Inputs are a mapping of SI values: mass, stiffness, damping, displacement, velocity (None: that of
the plate), skin_stretch (None: as the start asks), mouse_velocity and load as rows (time, value),
plate and finger as mappings with curve (rows of speed and force), static, and stiffness (None:
rigid; of skin under a load that changes the curve has one row, and the load is above zero); and,
unless there is none, force, rows of an external force, and finger_load, rows of a factor on the
friction of the finger.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from mpmath import isinf, mpf, sign, sqrt

from oracle.mp_oracle import DOUBT, Event, horner
from oracle.mp_series import (
    TINY,
    Guard,
    Poly,
    Profile,
    by_line,
    derivative,
    earliest_zero,
    plus,
    times,
)

TERMS = 60  # of the Taylor series: (2 * 1.62)^60 / 60! < 1e-51
REACH = 2  # shortest time constants per step
CONTACTS = ("plate", "finger")

Sides = dict[str, int]  # sign of sliding; 0 stuck (of skin: grips); contacts that there are


@dataclass(frozen=True)
class Friction:
    """Kinetic force forces[i] + slopes[i] (|u| - speeds[i]) in band i, from speeds[i] on."""

    speeds: list[mpf]
    forces: list[mpf]
    slopes: list[mpf]
    static: mpf
    stiffness: mpf  # of the skin; infinite: rigid

    @staticmethod
    def read(contact: Mapping[str, Any]) -> Friction | None:
        rows = [(mpf(speed), mpf(force)) for speed, force in contact["curve"]]
        static = mpf(contact["static"])
        if static == 0 and all(force == 0 for _, force in rows):
            return None
        slopes = [(g - f) / (v - u) for (u, f), (v, g) in pairwise(rows)]
        slopes.append(slopes[-1] if slopes else mpf(0))
        (u, f), last = rows[-1], slopes[-1]
        if last < 0 and f > 0:  # friction ends at 0, it does not turn to push
            rows.append((u - f / last, mpf(0)))
            slopes.append(mpf(0))
        elif f == 0 and last < 0:
            slopes[-1] = mpf(0)
        stiffness = mpf(contact["stiffness"] or "inf")
        return Friction([u for u, _ in rows], [f for _, f in rows], slopes, static, stiffness)

    def band(self, speed: mpf) -> int:
        return max(i for i, begin in enumerate(self.speeds) if begin <= speed)

    def at_zero(self, band: int) -> mpf:
        """The band's line continued to u = 0."""
        return self.forces[band] - self.slopes[band] * self.speeds[band]


@dataclass(frozen=True)
class Piece:
    """x(begin + s width) = sum of terms[n] s^n  for 0 <= s <= 1."""

    begin: mpf
    width: mpf
    terms: Poly
    mode: str  # "slip", "carried" or "resting"
    finger: Callable[[mpf], mpf]  # force of the finger on the pin at s
    skin: mpf  # its stiffness; infinite: rigid or absent

    def state(self, time: mpf) -> tuple[mpf, mpf, mpf, mpf, mpf]:
        """Position, velocity, acceleration, force of the finger, stretch of its skin."""
        s, v = (time - self.begin) / self.width, derivative(self.terms)
        force = self.finger(s)
        return (
            horner(self.terms, s),
            horner(v, s) / self.width,
            horner(derivative(v), s) / self.width**2,
            force,
            -force / self.skin,
        )


@dataclass
class Path:
    """The motion: pieces end to end, the events between them, and the ill-conditioned places."""

    pieces: list[Piece] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    doubts: list[tuple[mpf, str]] = field(default_factory=list)  # time and reason
    end: mpf = field(default_factory=mpf)  # s

    def piece_at(self, time: float | mpf) -> Piece:
        low, high = 0, len(self.pieces)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.pieces[middle].begin <= time else (low, middle)
        return self.pieces[low]

    def state(self, time: float | mpf) -> tuple[mpf, mpf, mpf, mpf, mpf]:
        return self.piece_at(time).state(mpf(time))

    def mode(self, time: float | mpf) -> str:
        return self.piece_at(time).mode


class _Simulation:
    def __init__(self, inputs: Mapping[str, Any], duration: mpf, most_events: int | None) -> None:
        self.duration, self.most_events = duration, most_events
        self.m, self.k, self.b = (mpf(inputs[n]) for n in ("mass", "stiffness", "damping"))
        self.mouse, self.load = Profile(inputs["mouse_velocity"]), Profile(inputs["load"])
        self.push = Profile(inputs.get("force", [[0.0, 0.0]]))
        self.touch = Profile(inputs.get("finger_load", [[0.0, 1.0]]))
        self.law = {c: law for c in CONTACTS if (law := Friction.read(inputs[c]))}
        self.rigid = [c for c, law in self.law.items() if isinf(law.stiffness)]
        over_time = (self.mouse, self.load, self.push, self.touch)
        knots = {t for profile in over_time for t, _ in profile.rows}
        self.knots = sorted(t for t in knots | {duration} if 0 < t <= duration)
        self.t, self.x = mpf(0), mpf(inputs["displacement"])
        given = inputs["velocity"]
        self.v = self.mouse(self.t) if given is None else mpf(given)
        self.path = Path()
        self.frequency = sqrt(self.k / self.m)
        self.speed = max(
            *(abs(v) for _, v in self.mouse.rows), abs(self.v), self.frequency * abs(self.x)
        )
        self.force = self.speed * sqrt(self.k * self.m)
        self.last_stop = mpf(-1)
        self.start(inputs["skin_stretch"])

    def start(self, skin_stretch: float | None) -> None:
        gaps = {"plate": self.v - self.mouse(self.t), "finger": self.v}
        self.side: Sides = {c: int(sign(gaps[c])) for c in self.law}
        self.band = {c: law.band(abs(gaps[c])) for c, law in self.law.items()}
        self.stretch = mpf(skin_stretch or 0)  # of gripping skin
        self.force_before = mpf(0)  # on skin that slips, before a row
        if "finger" in self.law and "finger" not in self.rigid and skin_stretch is not None:
            self.side["finger"] = 0
        level = [c for c in self.rigid if self.side[c] == 0]
        self.settle(level, {c: 1 for c in CONTACTS})

    def run(self) -> Path:
        stops_here = 0
        while not self.finished():
            began = self.t
            self.advance()
            stops_here = stops_here + 1 if self.t == began else 0
            assert stops_here < 6, "events without end"
        self.path.end = self.t
        return self.path

    def finished(self) -> bool:
        enough = self.most_events is not None and len(self.path.events) >= self.most_events
        return enough or self.t >= self.duration

    # -- one step ------------------------------------------------------------------------------

    def advance(self) -> None:
        """To the first guard's zero, to the next knot, or one step on."""
        knot = next(t for t in self.knots if t > self.t)
        h = min(self.step(), knot - self.t)
        x = self.series(h)
        guards = [g for g in self.guards(x, h) if not g.idle]
        touched = self.touched(h)
        unit = h * self.frequency / REACH

        def doubt(reason: str, s: mpf) -> None:
            self.doubt(reason, s * h)

        s = min((earliest_zero(g, unit, doubt) for g in guards), default=mpf(1))
        reached = [g for g in guards if horner(g.rest, s) < TINY * g.scale]
        if 1 - s < TINY:
            s = mpf(1)
        end = knot if s == 1 and h == knot - self.t else self.t + s * h
        if s > 0:
            self.record(x, h)
            if "finger" in self.law:
                self.force_before = horner(touched, s) * self.law["finger"].forces[0]
            velocity = derivative(x)
            if self.side.get("finger") == 0 and "finger" not in self.rigid:
                self.stretch += horner(x, s) - self.x
            self.x, self.v, self.t = horner(x, s), horner(velocity, s) / h, end
        if reached or end == knot:
            if 0 < (self.t - self.last_stop) * self.frequency < DOUBT:
                self.doubt("stops nearly coincide")
            self.last_stop = self.t
            self.change(reached)

    def step(self) -> mpf:
        if any(self.side[c] == 0 for c in self.rigid):
            return self.duration  # the series ends with its square
        stiffness, damping, growing = self.k, self.b, mpf(0)
        for contact, law in self.law.items():
            if self.side[contact]:
                slope = law.slopes[self.band[contact]]
                load = self.load if contact == "plate" else self.touch
                damping += load(self.t) * slope
                growing += load.slope(self.t) * slope
            elif contact not in self.rigid:
                stiffness += law.stiffness
        # Of the largest rate on the way: h (rate + grows h) = REACH.
        rate, grows = max(sqrt(stiffness / self.m), abs(damping) / self.m), abs(growing) / self.m
        return 2 * REACH / (rate + sqrt(rate * rate + 4 * REACH * grows))

    def lines(self, h: mpf) -> tuple[Poly, Poly]:
        """Mouse velocity and load over the step."""
        return (
            [self.mouse(self.t), self.mouse.slope(self.t) * h],
            [self.load(self.t), self.load.slope(self.t) * h],
        )

    def touched(self, h: mpf) -> Poly:
        """The load of the finger over the step."""
        return [self.touch(self.t), self.touch.slope(self.t) * h]

    def pushed(self, h: mpf) -> Poly:
        """Return the forces on the pin beside friction: inertia, and the external force."""
        inertia = self.m * self.mouse.slope(self.t)
        return [inertia + self.push(self.t), self.push.slope(self.t) * h]

    def series(self, h: mpf) -> Poly:
        """Taylor series of x through the present state in the present mode."""
        mouse, load = self.lines(h)
        if self.side.get("plate") == 0:
            return [self.x, mouse[0] * h, mouse[1] * h / 2]
        if self.side.get("finger") == 0 and "finger" in self.rigid:
            return [self.x]
        push = self.pushed(h)
        damping, stiffness, growing = self.b, self.k, mpf(0)
        if plate := self.law.get("plate"):
            band = self.band["plate"]
            slope = plate.slopes[band]
            damping += load[0] * slope
            growing = load[1] * slope
            push = plus(push, times(slope, by_line(load, mouse)))
            push = plus(push, times(-self.side["plate"] * plate.at_zero(band), load))
        if finger := self.law.get("finger"):
            if self.side["finger"] == 0:
                stiffness += finger.stiffness
                push = plus(push, [finger.stiffness * (self.x - self.stretch)])
            else:
                slope = finger.slopes[self.band["finger"]]
                damping += self.touch(self.t) * slope
                growing += self.touch.slope(self.t) * slope * h
                force = -self.side["finger"] * finger.at_zero(self.band["finger"])
                push = plus(push, times(force, self.touched(h)))
        drag, spring, unit = damping * h / self.m, stiffness * h * h / self.m, h * h / self.m
        ramp = growing * h / self.m
        x = [self.x, self.v * h]
        for n in range(TERMS - 2):
            force = push[n] * unit if n < len(push) else mpf(0)
            drags = drag * (n + 1) * x[n + 1] + ramp * n * x[n]
            x.append((force - drags - spring * x[n]) / ((n + 2) * (n + 1)))
        return x

    def friction(self, x: Poly, h: mpf) -> dict[str, Poly]:
        """Force of each contact on the pin; of rigid contacts stuck together, "both" is the sum."""
        mouse, load = self.lines(h)
        v = times(1 / h, derivative(x))
        u = {"plate": plus(v, times(mpf(-1), mouse)), "finger": v}
        found: dict[str, Poly] = {}
        for contact, law in self.law.items():
            side, band = self.side[contact], self.band[contact]
            if side:
                line = plus([-side * law.at_zero(band)], times(-law.slopes[band], u[contact]))
                found[contact] = by_line(load if contact == "plate" else self.touched(h), line)
            elif contact not in self.rigid:
                found[contact] = times(-law.stiffness, plus([self.stretch - self.x], x))
        held = [c for c in self.law if c not in found]
        if held:
            inertia = plus(times(self.m / h, derivative(v)), times(mpf(-1), self.pushed(h)))
            demand = plus(inertia, times(self.b, v), times(self.k, x))
            rest = [times(mpf(-1), force) for force in found.values()]
            found[held[0] if len(held) == 1 else "both"] = plus(demand, *rest)
        return found

    def limits(self, h: mpf) -> dict[str, Poly]:
        found = {c: [law.static] for c, law in self.law.items()}
        if "plate" in found:
            found["plate"] = times(found["plate"][0], self.lines(h)[1])
        if "finger" in found:
            found["finger"] = times(found["finger"][0], self.touched(h))
        return found | {"both": plus(*found.values(), [mpf(0)])}

    def guards(self, x: Poly, h: mpf) -> list[Guard]:
        mouse, _ = self.lines(h)
        v = times(1 / h, derivative(x))
        u = {"plate": plus(v, times(mpf(-1), mouse)), "finger": v}
        found = []
        for contact, law in self.law.items():
            side, band = self.side[contact], self.band[contact]
            if side:
                speed = plus(times(mpf(side), u[contact]), [-self.stretching(contact)])
                kind = "down" if band else "level"
                above = plus(speed, [-law.speeds[band]])
                found.append(Guard(contact, kind, above, self.speed))
                if band + 1 < len(law.speeds):
                    below = plus([law.speeds[band + 1]], times(mpf(-1), speed))
                    found.append(Guard(contact, "up", below, self.speed))
        limits = self.limits(h)
        for contact, force in self.friction(x, h).items():
            if contact == "both" or self.side[contact] == 0:
                for way in (1, -1):
                    margin = plus(limits[contact], times(mpf(way), force))
                    found.append(Guard(contact, "limit", margin, self.force))
        return found

    # -- what follows at a stop ----------------------------------------------------------------

    def change(self, reached: list[Guard]) -> None:
        was = dict(self.side)
        level = [c for c in self.rigid if self.side[c] == 0]
        for guard in reached:
            contact, law = guard.contact, self.law.get(guard.contact)
            if guard.kind in ("up", "down"):
                self.band[contact] += 1 if guard.kind == "up" else -1
            elif contact in self.rigid:
                level = [c for c in self.rigid if c in level or c == contact]
            elif law and guard.kind == "level":  # the skin grips again
                self.v = self.side[contact] * self.stretching(contact)
                self.grip(self.touch(self.t) * law.forces[0])
            elif law:  # the skin slips
                self.side[contact] = int(sign(self.stretch))
                self.band[contact] = law.band(abs(self.v))
                self.go_on(self.touch(self.t) * law.forces[0])
        if "finger" in self.law and "finger" not in self.rigid and self.t in self.knots:
            self.take_load()
        if "plate" in level:
            self.v = self.mouse(self.t)
        if "finger" in level:
            self.v = mpf(0)
        self.settle(level, was)
        self.note(was)

    def stretching(self, contact: str) -> mpf:
        """Return the stretch rate of slipping skin under its load."""
        law = self.law[contact]
        return (
            self.touch.slope(self.t) * law.forces[0] / law.stiffness if contact == "finger" else 0
        )

    def grip(self, force: mpf) -> None:
        """Skin that has slipped holds, with a force."""
        self.stretch = self.side["finger"] * force / self.law["finger"].stiffness
        self.side["finger"] = 0

    def go_on(self, force: mpf) -> None:
        """Skin slips on, unless its slider would turn: then it holds."""
        if self.side["finger"] * self.v < self.stretching("finger"):
            self.grip(force)

    def take_load(self) -> None:
        """Apply a load step to the skin; the stretch stays unless the load is too small."""
        law, load = self.law["finger"], self.touch(self.t)
        if self.side["finger"] == 0:
            if law.stiffness * abs(self.stretch) > load * law.static:
                self.side["finger"] = int(sign(self.stretch))
                self.go_on(load * law.forces[0])
        elif self.force_before < load * law.forces[0]:
            self.grip(self.force_before)
        else:
            self.go_on(load * law.forces[0])

    def settle(self, level: list[str], was: Sides) -> None:
        """Choose the sides of the contacts at the pin's velocity: the first that are possible."""
        self.band |= dict.fromkeys(level, 0)
        for choice in self.choices(level, was):
            self.side |= choice
            if self.possible():
                return
        assert not level, "no mode is possible"

    def choices(self, level: list[str], was: Sides) -> list[dict[str, int]]:
        """In the order of preference; sticking, where possible, comes before sliding."""
        if len(level) == 1:
            return [{level[0]: side} for side in (0, 1, -1)]
        if not level:
            return []
        w = int(sign(self.mouse.slope(self.t)))
        if w == 0:
            return [{"plate": side, "finger": side} for side in (0, 1, -1)]
        stuck = [{"plate": 0, "finger": w}, {"plate": -w, "finger": 0}]
        if was["finger"] == 0 and was["plate"] != 0:
            stuck.reverse()
        return stuck + [{"plate": p, "finger": f} for p, f in ((1, 1), (-1, -1), (-w, w))]

    def possible(self) -> bool:
        h = self.step()
        guards = self.guards(self.series(h), h)
        watched = [g for g in guards if g.contact in (*self.rigid, "both") and not g.idle]
        return all(g.rest[0] > 0 for g in watched if g.kind in ("level", "limit"))

    # -- records -------------------------------------------------------------------------------

    def record(self, x: Poly, h: mpf) -> None:
        skin = self.law["finger"].stiffness if "finger" in self.law else mpf("inf")
        forces = self.friction(x, h)
        if "both" in forces:  # shared in proportion to static friction
            total, limits = forces["both"], self.limits(h)

            def finger(s: mpf) -> mpf:
                return horner(total, s) * horner(limits["finger"], s) / horner(limits["both"], s)
        else:
            force = forces.get("finger", [mpf(0)])

            def finger(s: mpf) -> mpf:
                return horner(force, s)

        rests = not any(x[1:]) and any(self.side[c] == 0 for c in self.rigid)
        mode = "resting" if rests else "carried" if self.side.get("plate") == 0 else "slip"
        self.path.pieces.append(Piece(self.t, h, x, mode, finger, skin))

    def note(self, was: Sides) -> None:
        """Return one event for every contact that changed; for both, if they changed alike."""
        kinds = {}
        for contact in self.law:
            before, after = was[contact], self.side[contact]
            if before != after:
                kinds[contact] = "stick" if after == 0 else "slip" if before == 0 else "reverse"
        if len(kinds) == 2 and len(set(kinds.values())) == 1:
            kinds = {"both": kinds["plate"]}
        for contact, kind in kinds.items():
            self.path.events.append(Event(self.t, contact, kind, self.x, self.v))

    def doubt(self, reason: str, later: mpf = 0) -> None:
        self.path.doubts.append((self.t + later, reason))


def solve(inputs: Mapping[str, Any], duration: float, most_events: int | None = None) -> Path:
    """The motion from release to `duration` (s), or to its event number `most_events`."""
    return _Simulation(inputs, mpf(duration), most_events).run()

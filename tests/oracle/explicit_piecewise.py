"""Second oracle for piecewise-linear drives: explicit modes under an ordinary integrator.

Written as a table of what each event leads to, so that nothing is shared with `mp_piecewise` but
the form of the inputs. The integrator is an argument: SciPy's DOP853 here, SUNDIALS in
`sundials_modes`. Good to the tolerances named below.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import copysign, exp, hypot, inf, sqrt
from typing import Any

import numpy as np

from oracle.watched_dop853 import RTOL, Function, Integrator, State, Watch, dop853

PHASE_TOLERANCE = 3e-9  # of event times, in radians of the natural frequency
STATE_TOLERANCE = 3e-9  # of the scales of x, v and a


@dataclass
class Run:
    """Events as (time, contact, kind, position, velocity); rows of x, v, a, force, stretch."""

    events: list[tuple[float, str, str, float, float]]
    rows: list[tuple[float, ...]]
    mode: str


def before(t: float, times: Any, values: Any) -> float:
    """Return the left limit of rows at time t, before a step there."""
    i = int(np.searchsorted(times, t))
    at_row = i < len(times) and times[i] == t
    return float(values[i] if at_row else np.interp(t, times, values))


class Law:
    """Kinetic friction as lines between speeds; the last goes on, but not below zero."""

    def __init__(self, contact: Mapping[str, Any]) -> None:
        rows = [(float(u), float(f)) for u, f in contact["curve"]]
        self.static, self.stiffness = float(contact["static"]), contact["stiffness"] or inf
        self.damping = float(contact.get("damping", 0.0))
        self.absent = self.static == 0 and not any(f for _, f in rows)
        if len(rows) == 1:
            rows.append((1.0, rows[0][1]))
            self.kinks = [0.0]
        else:
            self.kinks = [u for u, _ in rows[:-1]]
        (u0, f0), (u1, f1) = rows[-2:]
        if f1 < f0:  # to zero, and along it
            u1 = u0 + f0 * (u1 - u0) / (f0 - f1)
            rows[-1:] = [(u1, 0.0), (u1 + 1.0, 0.0)]
            self.kinks.append(u1)
        self.lines = [(u, f, (g - f) / (v - u)) for (u, f), (v, g) in pairwise(rows)]

    def piece(self, speed: float) -> int:
        return int(np.searchsorted(self.kinks, speed, side="right")) - 1

    def __call__(self, piece: int, speed: float) -> float:
        u, f, slope = self.lines[piece]
        return f + slope * (speed - u)


class ExplicitModes:
    def __init__(
        self, inputs: Mapping[str, Any], samples: Sequence[float], tool: Integrator
    ) -> None:
        self.m, self.k, self.b = inputs["mass"], inputs["stiffness"], inputs["damping"]
        self.plate, self.finger = Law(inputs["plate"]), Law(inputs["finger"])
        self.soft = not self.finger.absent and self.finger.stiffness < inf
        self.mouse, self.load = (np.array(inputs[n], float).T for n in ("mouse_velocity", "load"))
        # begin, value and rate of the line, terms (amplitude, decay)
        self.pulls = inputs.get("load_pieces")
        if self.pulls:
            values = [value + sum(a for a, _ in terms) for _, value, _, terms in self.pulls]
            self.load = np.array([[begin for begin, *_ in self.pulls], values])
        self.push = np.array(inputs.get("force", [[0.0, 0.0]]), float).T
        self.touch = np.array(inputs.get("touch", [[0.0, 1.0]]), float).T  # no steps
        self.power = float(inputs.get("touch_power", 1.0))
        self.across = np.array(inputs.get("across", [[0.0, 0.0]]), float).T
        self.oblique = bool(self.across[1].any())  # then it never is 0
        self.samples, self.tool = list(samples), tool
        self.t = 0.0
        self.enter_knot()
        v = self.vp if inputs["velocity"] is None else inputs["velocity"]
        self.x, self.v, self.s = inputs["displacement"], v, inputs["skin_stretch"] or 0.0
        self.w0 = sqrt(self.k / self.m)
        self.speed = max(np.abs(self.mouse[1]).max(), abs(v), self.w0 * abs(self.x))
        self.run = Run([], [], "")
        # the sign of sliding; 0 stuck or gripping
        self.p = 0.0 if self.plate.absent else float(np.sign(v - self.vp))
        self.f = 0.0 if self.finger.absent else float(np.sign(v))
        self.on_plate = self.on_finger = False  # stuck to, rigidly
        self.grips = self.soft and (inputs["skin_stretch"] is not None or v == 0)
        self.pieces = {
            "plate": self.plate.piece(abs(v - self.vp)),
            "finger": self.finger.piece(abs(v)),
        }
        self.left: set[str] = set()
        at_plate = not self.plate.absent and v == self.vp and not self.oblique
        if self.oblique:
            self.p, self.pieces["plate"] = 1.0, self.plate.piece(self.sliding(0.0, v))
        at_finger = not self.finger.absent and not self.soft and v == 0
        self.decide(at_plate, at_finger)

    def enter_knot(self) -> None:
        """The lines of mouse velocity and load from the knot t on."""
        rows = (self.mouse, self.load, self.push, self.across, self.touch)
        later = [u for given in rows for u in given[0] if u > self.t]
        self.t0, self.t1 = self.t, min(later, default=inf)
        self.vp, self.lam = np.interp(self.t, *self.mouse), np.interp(self.t, *self.load)
        if self.pulls:
            i = int(np.searchsorted(self.load[0], self.t, "right")) - 1
            self.pull = self.pulls[max(i, 0)]
            self.lam = self.load_at(self.t)
        self.pushed = np.interp(self.t, *self.push)
        width = self.t1 - self.t0
        moving = width < inf
        self.w = (np.interp(self.t1, *self.mouse) - self.vp) / width if moving else 0.0
        self.harder = (before(self.t1, *self.push) - self.pushed) / width if moving else 0.0
        self.rise = (before(self.t1, *self.load) - self.lam) / width if moving else 0.0

    def mouse_at(self, t: float) -> float:
        return float(self.vp + self.w * (t - self.t0))

    def load_at(self, t: float) -> float:
        if self.pulls:
            begin, value, rate, terms = self.pull
            fading = sum(a * exp(-d * (t - begin)) for a, d in terms)
            return float(value + rate * (t - begin) + fading)
        return float(self.lam + self.rise * (t - self.t0))

    def touch_at(self, t: float) -> float:
        return float(np.interp(t, *self.touch) ** self.power)

    # -- forces on the pin ---------------------------------------------------------------------

    def sliding(self, t: float, v: float) -> float:
        """The speed of sliding on the plate."""
        u = v - self.mouse_at(t)
        return float(hypot(u, np.interp(t, *self.across)) if self.oblique else self.p * u)

    def sliding_plate(self, t: float, v: float) -> float:
        if self.plate.absent:
            return 0.0
        if self.oblique:
            speed = self.sliding(t, v)
            friction = self.load_at(t) * self.plate(self.pieces["plate"], speed)
            return -friction * (v - self.mouse_at(t)) / speed
        return (
            -self.p
            * self.load_at(t)
            * self.plate(self.pieces["plate"], self.p * (v - self.mouse_at(t)))
        )

    def finger_force(self, t: float, v: float, s: float) -> float:
        """Return the force of the finger in slip or stick."""
        if self.finger.absent:
            return 0.0
        if self.grips:
            return float(-self.tension(v, s))
        return float(-self.f) * self.touch_at(t) * self.finger(self.pieces["finger"], self.f * v)

    def tension(self, v: float, s: float) -> float:
        """The tension of skin that grips."""
        return float(self.finger.stiffness * s + self.finger.damping * v)

    def stretching(self, t: float, v: float, s: float) -> float:
        """The rate of the stretch: of damped skin that slips, under Coulomb friction."""
        if self.grips or not self.finger.damping:
            return v if self.grips else 0.0
        pull = self.f * self.touch_at(t) * self.finger(0, 0.0) - self.finger.stiffness * s
        return float(pull / self.finger.damping)

    def free(self, t: float, x: float, v: float) -> float:
        """All but friction."""
        pushed = self.pushed + self.harder * (t - self.t0)
        return float(self.m * self.w + pushed - self.b * v - self.k * x)

    def plate_needed(self, t: float, y: State) -> float:
        v = self.mouse_at(t)
        return float(self.m * self.w - self.free(t, y[0], v) - self.finger_force(t, v, y[2]))

    def finger_needed(self, t: float, y: State) -> float:
        return float(-self.free(t, y[0], 0.0) - self.sliding_plate(t, 0.0))

    def acceleration(self, t: float, y: State) -> float:
        if self.on_finger:
            return 0.0
        if self.on_plate:
            return float(self.w)
        x, v, s = y
        return float(
            (self.free(t, x, v) + self.sliding_plate(t, v) + self.finger_force(t, v, s)) / self.m
        )

    def rhs(self, t: float, y: State) -> list[float]:
        v = 0.0 if self.on_finger else self.mouse_at(t) if self.on_plate else y[1]
        return [v, self.acceleration(t, y), self.stretching(t, v, y[2])]

    # -- what ends a mode ----------------------------------------------------------------------

    def watches(self) -> list[Watch]:
        force = self.speed * sqrt(self.m * self.k)
        found = []
        if self.on_plate and self.on_finger:
            found += self.limit("both", lambda t, y: self.k * y[0], self.both_static)
        elif self.on_plate:
            found += self.limit("plate", self.plate_needed, self.plate_static)
        elif self.on_finger:
            found += self.limit("finger", self.finger_needed, self.finger_static)
        if self.grips:
            found += self.limit(
                "finger", lambda t, y: self.tension(self.moving(t, y), y[2]), self.finger_static
            )
        for watch in found:
            watch.scale = force
        if self.p and not self.on_plate:
            found += self.band("plate", self.plate, lambda t, y: self.sliding(t, y[1]))
            if self.oblique:
                found = [w for w in found if (w.contact, w.kind) != ("plate", "level")]
        if self.f and not self.on_finger and not self.grips:
            found += self.band("finger", self.finger, self.rubbing)
        for watch in found:
            watch.left = f"{watch.contact} {watch.kind}" in self.left
        return found

    def moving(self, t: float, y: State) -> float:
        """The velocity of the pin."""
        return self.mouse_at(t) if self.on_plate else float(y[1])

    def rubbing(self, t: float, y: State) -> float:
        """The speed of sliding at the finger."""
        v = self.moving(t, y)
        slips = v - self.stretching(t, v, y[2]) if self.finger.damping else v
        return float(self.f * slips)

    def plate_static(self, t: float) -> float:
        return self.plate.static * self.load_at(t)

    def finger_static(self, t: float) -> float:
        return self.finger.static * self.touch_at(t)

    def both_static(self, t: float) -> float:
        return self.plate_static(t) + self.finger_static(t)

    def limit(self, contact: str, force: Function, most: Callable[[float], float]) -> list[Watch]:
        return [
            Watch(contact, "limit", lambda t, y: most(t) - force(t, y), 0.0),
            Watch(contact, "limit", lambda t, y: most(t) + force(t, y), 0.0),
        ]

    def band(self, contact: str, law: Law, speed: Function) -> list[Watch]:
        i = self.pieces[contact]
        begin = law.kinks[i]
        found = [
            Watch(contact, "down" if i else "level", lambda t, y: speed(t, y) - begin, self.speed)
        ]
        if i + 1 < len(law.kinks):
            end = law.kinks[i + 1]
            found.append(Watch(contact, "up", lambda t, y: end - speed(t, y), self.speed))
        return found

    # -- the course of events ------------------------------------------------------------------

    def solve(self, duration: float) -> Run:
        while self.t < duration:
            stuck = self.on_plate or self.on_finger
            end = min(self.t1, duration)
            stiffness = self.k + (self.finger.stiffness if self.grips else 0.0)
            slope = sum(
                abs(law.lines[self.pieces[n]][2])
                for n, law in (("plate", self.plate), ("finger", self.finger))
            )
            resists = self.b + self.finger.damping + slope * max(1.0, self.load[1].max())
            rate = max(sqrt(stiffness / self.m), resists / self.m)
            longest = (end - self.t) / 40 if stuck else 0.2 / rate
            atol = RTOL * self.speed * np.array([1 / self.w0, 1.0, 1 / self.w0])
            y = np.array([self.x, self.v, self.s])
            wanted = [u for u in self.samples if self.t <= u < end or u == end == duration]
            stop, y, watch, states = self.tool(
                self.rhs, self.watches(), self.t, y, end, longest, atol, wanted
            )
            self.run.rows += [self.row(u, z) for u, z in zip(wanted, states, strict=False)]
            if (
                watch is None
                and end == duration
                and duration in wanted
                and len(states) < len(wanted)
            ):
                self.run.rows.append(self.row(end, y))
            self.t, (self.x, self.v, self.s) = stop, y
            if self.on_plate:
                self.v = self.mouse_at(stop)
            self.run.mode = self.mode()
            self.left = set()
            if watch is not None and stuck and end - stop < 1e-11 / self.w0 and end < duration:
                self.t, watch = end, None  # the mouse comes to v = 0 at its knot
            if watch is not None:
                self.react(watch)
            elif self.t < duration:
                self.pass_knot()
        return self.run

    def mode(self) -> str:
        at_rest = self.on_plate and self.w == 0 and self.vp == 0
        return "resting" if self.on_finger or at_rest else "carried" if self.on_plate else "slip"

    def row(self, t: float, y: State) -> tuple[float, ...]:
        if self.on_plate and self.on_finger:
            force = self.k * y[0] * self.finger_static(t) / self.both_static(t)
        else:
            force = self.finger_needed(t, y) if self.on_finger else self.finger_force(t, y[1], y[2])
        stretch = y[2] if self.finger.damping else -force / self.finger.stiffness
        return (y[0], y[1], self.acceleration(t, y), force, stretch)

    def react(self, watch: Watch) -> None:
        name = watch.contact
        if watch.kind in ("up", "down"):
            self.pieces[name] += 1 if watch.kind == "up" else -1
            self.left = {f"{name} {'down' if watch.kind == 'up' else 'up'}"}
            if watch.kind == "up" and self.pieces[name] == 0:
                self.left = {f"{name} level"}
        elif watch.kind == "limit":
            if name == "finger" and self.soft:
                self.skin_slips()
            else:
                self.break_loose(name)
        elif self.finger.damping and name == "finger":
            self.grips = True
            self.note("finger", "stick")
            self.left = {"finger limit"} if self.finger.static == self.finger(0, 0.0) else set()
        elif (
            self.soft
            and not self.finger.damping
            and (name == "finger" or (self.f and not self.grips and self.stopped()))
        ):
            shared = not self.plate.absent and not self.on_plate and self.stopped()
            self.skin_grips()
            if shared:
                self.arrive_plate(also=True)
        elif self.on_plate or self.on_finger:
            self.share()
        elif self.stopped() and not (self.soft or self.plate.absent or self.finger.absent):
            self.arrive_both()
        elif name == "plate":
            self.arrive_plate()
        else:
            self.v = 0.0
            self.arrive("finger", self.finger_needed(self.t, self.y), self.finger_static(self.t))

    @property
    def y(self) -> State:
        return np.array([self.x, self.v, self.s])

    def stopped(self) -> bool:
        return bool(self.vp == 0 and self.w == 0) and not self.oblique

    def note(self, contact: str, kind: str) -> None:
        self.run.events.append((self.t, contact, kind, self.x, self.v))

    def skin_grips(self) -> None:
        self.v, self.s, self.grips = 0.0, self.f * self.finger(0, 0.0) / self.finger.stiffness, True
        self.note("finger", "stick")
        self.left = {"finger limit"} if self.finger.static == self.finger(0, 0.0) else set()

    def skin_slips(self) -> None:
        pull = self.tension(self.moving(self.t, self.y), self.s)
        self.f, self.grips = copysign(1.0, pull), False
        self.pieces["finger"] = self.finger.piece(abs(self.v))
        self.note("finger", "slip")

    def break_loose(self, name: str) -> None:
        if name in ("plate", "both"):
            needed = self.plate_needed(self.t, self.y) if name == "plate" else self.k * self.x
            self.p, self.on_plate, self.pieces["plate"] = -copysign(1.0, needed), False, 0
            self.left.add("plate level")
        if name in ("finger", "both"):
            needed = self.finger_needed(self.t, self.y) if name == "finger" else self.k * self.x
            self.f, self.on_finger, self.pieces["finger"] = -copysign(1.0, needed), False, 0
            self.left.add("finger level")
        self.note(name, "slip")
        if name == "plate":
            self.move_full_skin(self.p)

    def move_full_skin(self, way: float) -> None:
        """The pin leaves v = 0 this way while its skin is stretched to the limit."""
        full = self.finger.static * (1 - 1e-12)
        if self.finger.damping:
            return
        if self.grips and self.v == 0 and self.finger.stiffness * abs(self.s) > full:
            if self.s * way > 0:
                self.skin_slips()
                self.left.add("finger level")
            else:
                self.left.add("finger limit")

    def arrive_plate(self, also: bool = False) -> None:
        self.v = self.mouse_at(self.t)
        self.arrive("plate", self.plate_needed(self.t, self.y), self.plate_static(self.t), also)

    def arrive(self, name: str, needed: float, most: float, also: bool = False) -> None:
        sticks = abs(needed) <= most
        if name == "plate":
            self.on_plate, self.p, self.pieces[name] = sticks, -self.p, 0
        else:
            self.on_finger, self.f, self.pieces[name] = sticks, -self.f, 0
        if not sticks:
            self.left.add(f"{name} level")
        kind = "stick" if sticks else "reverse"
        if also:  # the skin grips at the same moment
            grip = self.run.events.pop()
            if kind == "stick":
                self.note("both", kind)
                return
            self.note(name, kind)
            self.run.events.append(grip)
            return
        self.note(name, kind)

    def arrive_both(self) -> None:
        """The mouse stands still: the capacities add."""
        self.v = 0.0
        sticks = abs(self.k * self.x) <= self.both_static(self.t)
        self.on_plate = self.on_finger = sticks
        self.p, self.f = -self.p, -self.f
        self.pieces = {"plate": 0, "finger": 0}
        self.left = set() if sticks else {"plate level", "finger level"}
        self.note("both", "stick" if sticks else "reverse")

    def pass_knot(self) -> None:
        was_rest, load = self.stopped(), self.load_at(self.t)
        self.enter_knot()
        less = self.lam < load * (1 - 1e-12)  # a step down
        if self.oblique or self.soft or self.plate.absent or self.finger.absent or self.vp != 0:
            needed = abs(self.plate_needed(self.t, self.y)) if self.on_plate and less else 0.0
            if needed > self.plate_static(self.t):
                self.break_loose("plate")
            if self.on_finger and abs(self.finger_needed(self.t, self.y)) > self.finger_static(
                self.t
            ):
                self.break_loose("finger")
            slips = self.f and not self.grips and not self.finger.damping
            if self.soft and slips and self.on_plate and self.vp == 0:
                self.skin_grips()
            if self.on_plate:
                self.move_full_skin(self.w)
        elif self.on_plate or self.on_finger:
            self.v = 0.0
            if less or not (was_rest and self.stopped()):
                self.share()

    # -- both rigid contacts at v = 0 while the mouse is there too -------------------------------

    def share(self) -> None:
        """Decide on accelerations, as the mouse's velocity passes 0, stops at it, or leaves it."""
        self.v = 0.0
        before = (0 if self.on_plate else self.p, 0 if self.on_finger else self.f)
        self.decide(True, True)
        after = (0 if self.on_plate else self.p, 0 if self.on_finger else self.f)
        kinds = [
            "" if a == b else "stick" if b == 0 else "slip" if a == 0 else "reverse"
            for a, b in zip(before, after, strict=True)
        ]
        if kinds[0] == kinds[1] != "":
            self.note("both", kinds[0])
        else:
            for name, kind in zip(("plate", "finger"), kinds, strict=True):
                if kind:
                    self.note(name, kind)

    def decide(self, at_plate: bool, at_finger: bool) -> None:
        """Modes of the contacts that are at the pin's velocity."""
        was_plate, was_finger = self.on_plate, self.on_finger
        self.on_plate = self.on_finger = False
        if at_plate and at_finger:
            self.pieces = {"plate": 0, "finger": 0}
            self.left = {"plate level", "finger level"}
            force = self.m * self.w - self.k * self.x
            fp, ff = self.plate(0, 0.0) * self.lam_now, self.finger(0, 0.0)
            ff *= self.touch_at(self.t)
            if self.w == 0:
                self.on_plate = self.on_finger = abs(force) <= self.both_static(self.t)
                if not self.on_plate:
                    self.p = self.f = copysign(1.0, force)
                return
            way = copysign(1.0, self.w)
            plate = abs(self.m * self.w - force + way * ff) <= self.plate_static(self.t)
            finger = abs(-force - way * fp) <= self.finger_static(self.t)
            if plate and not (finger and was_finger and not was_plate):
                self.on_plate, self.f = True, way
            elif finger:
                self.on_finger, self.p = True, -way
            else:
                signs = [(1.0, 1.0), (-1.0, -1.0), (-way, way)]
                for p, f in signs:
                    a = (force - p * fp - f * ff) / self.m
                    if a * f > 0 and (a - self.w) * p > 0:
                        self.p, self.f = p, f
        elif at_plate:
            needed = self.plate_needed(self.t, self.y)
            self.on_plate = abs(needed) <= self.plate_static(self.t)
            self.p, self.left = -copysign(1.0, needed), {"plate level"}
        elif at_finger:
            needed = self.finger_needed(self.t, self.y)
            self.on_finger = abs(needed) <= self.finger_static(self.t)
            self.f, self.left = -copysign(1.0, needed), {"finger level"}

    @property
    def lam_now(self) -> float:
        return self.load_at(self.t)


def solve(
    inputs: Mapping[str, Any],
    duration: float,
    samples: Sequence[float] = (),
    tool: Integrator = dop853,
) -> Run:
    """The motion from release to `duration` (s), with the state at the sample times."""
    return ExplicitModes(inputs, samples, tool).solve(duration)

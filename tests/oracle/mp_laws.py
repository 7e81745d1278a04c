"""Thirty-digit oracle: a released pin under friction laws with a name, rigid contacts, in mpmath.

Between events the equation of motion is integrated by extrapolation of the explicit midpoint rule
(Gragg 1965), which evaluates laws and inputs themselves: no series, no closed form. Inputs are
rows, linear between them, or pieces of polynomials, exponentials and sinusoids. A guard is tested
at the ends of each step, a part of the natural period, and its zero is found by bisection and
secants of steps from the same start.

The same modes are followed by another integrator, in floating point, where `solve` is given one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from mpmath import mp, mpf

DIGITS = 30
ROWS = 14  # of the extrapolation: order 28
PARTS = 80  # steps in a natural period and in one of the fastest input; 40 missed a stick
KNOWN = mpf("1e-22")  # relative change at which a zero is known

State = tuple[mpf, mpf]
Change = tuple[mpf, str, int, int]
"""Time, contact, and its mode before and after."""


@dataclass(frozen=True)
class Law:
    """Kinetic friction over the sliding speed, and static friction."""

    name: str
    kinetic: mpf
    breakaway: mpf
    velocity: mpf
    exponent: int
    viscous: mpf
    static: mpf
    context: Any  # of mpmath: functions of its numbers

    def at(self, speed: mpf) -> mpf:
        """The friction at a sliding speed."""
        if self.name == "coulomb":
            return self.kinetic + self.viscous * speed
        s = max(speed / self.velocity, -1)  # beyond its guard a step may try any
        gaussian = self.name == "stribeck"
        part = self.context.exp(-(s**self.exponent)) if gaussian else 1 / (1 + s * s)
        return self.kinetic + (self.breakaway - self.kinetic) * part + self.viscous * speed


def line(rows: list[list[float]], t: mpf) -> tuple[mpf, mpf]:
    """Value and rate of an input just after a time."""
    later = [i for i, (at, _) in enumerate(rows) if at > t]
    if not later or later[0] == 0:
        return type(t)(rows[0 if later else -1][1]), type(t)(0)
    (t0, y0), (t1, y1) = (tuple(map(type(t), row)) for row in rows[later[0] - 1 : later[0] + 1])
    rate = (y1 - y0) / (t1 - t0)
    return y0 + rate * (t - t0), rate


def piece(context: Any, pieces: list[Any], t: mpf) -> Callable[[mpf], tuple[mpf, mpf]]:
    """Value and rate of a function of pieces from a time on, as a function of time."""
    begin, polynomial, terms = [each for each in pieces if each[0] <= t][-1]
    powers = [(n, context.mpf(p)) for n, p in enumerate(polynomial)]
    waves = [tuple(map(context.mpf, term)) for term in terms]

    def at(time: mpf) -> tuple[mpf, mpf]:
        tau = time - context.mpf(begin)
        value = sum((p * tau**n for n, p in powers), 0 * tau)
        rate = sum((n * p * tau ** (n - 1) for n, p in powers if n), 0 * tau)
        for a, b, decay, frequency in waves:
            part = context.exp(-decay * tau)
            c, s = context.cos(frequency * tau), context.sin(frequency * tau)
            wave, turned = part * (a * c + b * s), part * frequency * (b * c - a * s)
            value += wave
            rate += turned - decay * wave
        return value, rate

    return at


def straight(rows: list[list[float]], t: mpf) -> Callable[[mpf], tuple[mpf, mpf]]:
    """Value and rate of rows from a time on, as a function of time."""
    value, rate = line(rows, t)
    return lambda time: (value + rate * (time - t), rate)


def frequencies(case: dict[str, Any]) -> list[float]:
    """Angular frequencies of the inputs, 0 among them."""
    pieces = [g["pieces"] for g in case["inputs"].values() if isinstance(g, dict)]
    return [0.0, *(term[3] for each in pieces for _, _, terms in each for term in terms)]


def begins(given: Any) -> list[float]:
    """Times at which an input changes its form."""
    return [each[0] for each in (given["pieces"] if isinstance(given, dict) else given)]


class Pin:
    """A pin between two breakpoints, in one mode: -1 or 1 slips, 0 sticks, None slips obliquely."""

    def __init__(self, case: dict[str, Any], context: Any = mp) -> None:
        self.case, self.context = case, context
        number = context.mpf
        self.mass, self.stiffness, self.damping = (
            number(case[name]) for name in ("mass", "stiffness", "damping")
        )
        self.laws = {
            contact: Law(
                **{k: v if k in ("name", "exponent") else number(v) for k, v in law.items()},
                context=context,
            )
            for contact, law in case["laws"].items()
        }
        frequency = context.sqrt(self.stiffness / self.mass)
        self.fastest = max(frequency, *map(number, frequencies(case)))
        self.plate: int | None = 0
        self.finger = 0
        self.begin(number(0))

    def begin(self, t: mpf) -> None:
        """Read the inputs from a time on."""
        self.given = {
            name: piece(self.context, given["pieces"], t)
            if isinstance(given, dict)
            else straight(given, t)
            for name, given in self.case["inputs"].items()
        }

    def at(self, name: str, t: mpf) -> mpf:
        return self.given[name](t)[0]

    def drags(self, t: mpf) -> mpf:
        """Acceleration of the plate."""
        return self.given["mouse_velocity"](t)[1]

    def plate_force(self, t: mpf, v: mpf) -> mpf:
        u, w = v - self.at("mouse_velocity", t), self.at("across_velocity", t)
        law, load = self.laws["plate"], self.at("plate_load", t)
        if self.plate is None:
            speed = self.context.sqrt(u * u + w * w)
            return -load * law.at(speed) * u / speed
        return -load * self.plate * law.at(self.plate * u)

    def finger_force(self, t: mpf, v: mpf) -> mpf:
        return -self.at("finger_load", t) * self.finger * self.laws["finger"].at(self.finger * v)

    def other_forces(self, t: mpf, x: mpf, v: mpf) -> mpf:
        inertia = self.mass * self.drags(t)
        return inertia + self.at("force", t) - self.damping * v - self.stiffness * x

    def acceleration(self, t: mpf, x: mpf, v: mpf) -> mpf:
        if self.plate == 0:
            return self.drags(t)
        if self.finger == 0:
            return self.context.mpf(0)
        forces = self.plate_force(t, v) + self.finger_force(t, v) + self.other_forces(t, x, v)
        return forces / self.mass

    def needed(self, t: mpf, x: mpf, v: mpf) -> mpf:
        """Force of the contact that holds the pin."""
        at_plate = self.plate == 0
        moves = self.mass * self.drags(t) if at_plate else 0
        other = self.finger_force(t, v) if at_plate else self.plate_force(t, v)
        return moves - other - self.other_forces(t, x, v)

    def limit(self, t: mpf) -> mpf:
        contact = "plate" if self.plate == 0 else "finger"
        return self.laws[contact].static * self.at(f"{contact}_load", t)

    def guards(self, t: mpf, state: State) -> dict[str, mpf]:
        """What stays positive in the mode."""
        x, v = state
        u, found = v - self.at("mouse_velocity", t), {}
        if self.plate:
            found["plate"] = self.plate * u
        if self.finger:
            found["finger"] = self.finger * v
        if 0 in (self.plate, self.finger):
            force, most = self.needed(t, x, v), self.limit(t)
            found |= {"pulls": most - force, "pushes": most + force}
        return found

    def step(self, t: mpf, state: State, h: mpf, halvings: int = 5) -> State:
        """The state after a time, by halves where the extrapolation does not converge."""
        if h == 0:
            return state
        table: list[list[State]] = []
        for j in range(ROWS):
            count = 2 * (j + 1)
            sub = h / count
            (x0, v0), (x, v) = state, state
            x1, v1 = x + sub * v, v + sub * self.acceleration(t, x, v)
            for i in range(1, count):
                a = self.acceleration(t + i * sub, x1, v1)
                x0, v0, x1, v1 = x1, v1, x0 + 2 * sub * v1, v0 + 2 * sub * a
            row = [(x1, v1)]
            for k in range(1, j + 1):
                ratio = mpf(j + 1) ** 2 / mpf(j + 1 - k) ** 2 - 1
                (fine, coarse) = row[k - 1], table[j - 1][k - 1]
                row.append(
                    (
                        fine[0] + (fine[0] - coarse[0]) / ratio,
                        fine[1] + (fine[1] - coarse[1]) / ratio,
                    )
                )
            table.append(row)
            if j > 4 and all(
                abs(a - b) <= mpf("1e-25") * (abs(a) + mpf("1e-6"))
                for a, b in zip(row[j], row[j - 1], strict=True)
            ):
                return row[-1]
        if halvings == 0:
            return table[-1][-1]
        half = self.step(t, state, h / 2, halvings - 1)
        return self.step(t + h / 2, half, h / 2, halvings - 1)

    def select(self, t: mpf, state: State, still: list[str], spent: bool = False) -> State:
        """The mode at an instant, from the contacts that do not slide, of which the first holds.

        Where pin and plate are at rest at once, the contact that does not hold slips as the plate
        accelerates. `spent`: the contacts slip now.
        """
        x, v = state
        if self.given["across_velocity"](t) != (0, 0):
            self.plate = None
            still = [contact for contact in still if contact != "plate"]
        if "plate" in still:
            v = self.at("mouse_velocity", t)
        if "finger" in still:
            v = self.context.mpf(0)
        drags = (self.drags(t) > 0) - (self.drags(t) < 0)
        slips = {}
        for contact in still:
            if contact == "plate":
                self.plate = 0
                self.finger = (v > 0) - (v < 0) or drags or self.finger
            else:
                self.finger = 0
                u = v - self.at("mouse_velocity", t)
                if self.plate is not None:
                    self.plate = (u > 0) - (u < 0) or -drags
            force = self.needed(t, x, v)
            if not spent and abs(force) <= self.limit(t):
                return x, v
            # It slips against the force that would hold it.
            slips[contact] = -1 if force > 0 else 1
        self.plate, self.finger = slips.get("plate", self.plate), slips.get("finger", self.finger)
        return x, v


def extrapolated(pin: Pin, t: mpf, state: State, end: mpf) -> tuple[mpf, State, str | None]:
    """One step towards a time, up to the zero of a guard: the time, the state and the guard."""
    h = min(2 * mp.pi / pin.fastest / PARTS, end - t)
    after = pin.step(t, state, h)
    broken = [name for name, value in pin.guards(t + h, after).items() if value < 0]
    if not broken:
        return t + h, after, None
    h, name = min(_zero(pin, t, state, h, name) for name in broken)
    return t + h, pin.step(t, state, h), name


def solve(
    case: dict[str, Any],
    stop: Callable[[int], bool] = lambda _: False,
    context: Any = mp,
    follow: Callable[[Pin, mpf, State, mpf], tuple[mpf, State, str | None]] = extrapolated,
) -> dict[str, Any]:
    """Follow a case; return its events (time, contact, kind) and the states at its times."""
    mp.dps = DIGITS
    number = context.mpf
    pin = Pin(case, context)
    x, v = number(case["displacement"]), number(case["velocity"])
    breaks = {number(t) for given in case["inputs"].values() for t in begins(given) if t > 0}
    times, asked = [number(t) for t in case["times"]], []
    t, end = number(0), times[-1]
    u = v - pin.at("mouse_velocity", t)
    pin.plate, pin.finger = (u > 0) - (u < 0), (v > 0) - (v < 0)
    still = [name for name, at in (("plate", u), ("finger", v)) if at == 0]
    x, v = pin.select(t, (x, v), still)
    changes: list[Change] = []
    while t < end and not stop(len(changes)):
        bound = min(each for each in (*breaks, *times) if each > t)
        t, (x, v), broken = follow(pin, t, (x, v), bound)
        before = {"plate": pin.plate, "finger": pin.finger}
        held = [contact for contact, mode in before.items() if mode == 0]
        if broken:
            slides = broken in before
            still = [*held, broken] if slides else held
            x, v = pin.select(t, (x, v), still, spent=not slides)
        elif t in breaks:
            pin.begin(t)
            x, v = pin.select(t, (x, v), held)
        for contact, mode in before.items():
            now = getattr(pin, contact)
            if mode != now and mode is not None and now is not None:
                changes.append((t, contact, mode, now))
        if t in times:
            asked.append((x, v))
    return {"events": events_of(changes), "states": asked}


def events_of(changes: list[Change]) -> list[tuple[mpf, str, str]]:
    """Events of each instant, the plate first; two changes of a contact at an instant are one."""
    instants: list[tuple[mpf, dict[str, tuple[int, int]]]] = []
    for t, contact, mode, now in changes:
        if not instants or t - instants[-1][0] > KNOWN * t:
            instants.append((t, {}))
        of_instant = instants[-1][1]
        of_instant[contact] = (of_instant.get(contact, (mode, now))[0], now)
    return [
        (t, contact, "stick" if now == 0 else "slip" if mode == 0 else "reverse")
        for t, of_instant in instants
        for contact, (mode, now) in sorted(of_instant.items(), reverse=True)
        if mode != now
    ]


def _zero(pin: Pin, t: mpf, state: State, h: mpf, name: str) -> tuple[mpf, str]:
    """The time to the zero of a guard within a step, by the Illinois rule."""

    def value(tau: mpf) -> mpf:
        return pin.guards(t + tau, pin.step(t, state, tau))[name]

    low, high, at_low, at_high = mpf(0), h, value(mpf(0)), value(h)
    if at_low <= 0:  # it begins at its zero, and has left it within the step
        low = h * mpf("1e-9")
        at_low = value(low)
        if at_low <= 0:
            return mpf(0), name
    last = 0  # side on which the zero was kept last
    for _ in range(200):
        tau = high - at_high * (high - low) / (at_high - at_low)
        here = value(tau)
        if here < 0:
            high, at_high = tau, here
            at_low /= 2 if last < 0 else 1
            last = -1
        else:
            low, at_low = tau, here
            at_high /= 2 if last > 0 else 1
            last = 1
        if here == 0 or high - low <= KNOWN * h:
            return tau, name
    raise ArithmeticError(f"no zero of {name} after {t}")

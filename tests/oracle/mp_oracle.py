"""Thirty-digit oracle: a released pin with rigid Coulomb contacts, in mpmath.

Between events the equation of motion  m x'' + b x' + k x = friction  is integrated by its Taylor
series (the recurrence of the equation itself, no closed form), in steps of one shortest time
constant. A velocity level is found by evaluating the series at many points of every step, the
turning points of the velocity included, and by bisection. Inputs are taken as the exact binary
doubles they are.

The answer says how well conditioned it is: `Path.doubts` lists every place where a relative change
of `DOUBT` could change which event comes next.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from mpmath import mp, mpf, sign, sqrt

DIGITS = 40  # working precision, decimal; answers are good to thirty digits or better
TERMS = 46  # of the Taylor series: 1.62^46 / 46! < 1e-47 per step of one time constant
POINTS = 8  # of every step at which the levels are tested
HALVINGS = 110  # of a bracket: 2^-110 / POINTS < 1e-33 of a step
DOUBT = mpf("1e-9")  # relative margin below which an event counts as ill-conditioned
EXACT = mpf("1e-30")  # relative size below which a thirty-digit number is zero

mp.dps = DIGITS


@dataclass(frozen=True)
class Pin:
    """One released pin, SI units; `velocity` None: released at the plate's velocity."""

    mass: float
    stiffness: float
    damping: float
    plate_kinetic: float
    plate_static: float
    finger_kinetic: float
    finger_static: float
    mouse_velocity: float
    displacement: float
    velocity: float | None = None


@dataclass(frozen=True)
class Level:
    """A surface velocity and the friction of everything that moves with it."""

    name: str  # "plate", "finger" or "both"
    velocity: mpf
    kinetic: mpf
    static: mpf


@dataclass(frozen=True)
class Event:
    """Event at a level: "stick", "slip" or "reverse"; time, position and velocity in SI."""

    time: mpf
    contact: str
    kind: str
    position: mpf
    velocity: mpf


@dataclass(frozen=True)
class Piece:
    """x(begin + s width) = sum of terms[n] s^n  for 0 <= s <= 1."""

    begin: mpf
    width: mpf
    terms: list[mpf]
    mode: str  # "slip", "carried" or "resting"

    def position(self, s: mpf) -> mpf:
        return horner(self.terms, s)

    def velocity(self, s: mpf) -> mpf:
        return horner([n * c for n, c in enumerate(self.terms)][1:], s) / self.width

    def acceleration(self, s: mpf) -> mpf:
        second = [n * (n - 1) * c for n, c in enumerate(self.terms)][2:]
        return horner(second, s) / self.width**2


@dataclass
class Path:
    """The motion: pieces end to end, the events between them, and the ill-conditioned places."""

    pieces: list[Piece] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    doubts: list[tuple[mpf, str]] = field(default_factory=list)  # time and reason
    end: mpf | None = None  # s

    def piece_at(self, time: mpf) -> Piece:
        low, high = 0, len(self.pieces)
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.pieces[middle].begin <= time else (low, middle)
        return self.pieces[low]

    def state(self, time: float | mpf) -> tuple[mpf, mpf, mpf]:
        """Position, velocity and acceleration at `time`."""
        time = mpf(time)
        piece = self.piece_at(time)
        s = (time - piece.begin) / piece.width
        return piece.position(s), piece.velocity(s), piece.acceleration(s)

    def mode(self, time: float | mpf) -> str:
        return self.piece_at(mpf(time)).mode


def horner(terms: list[mpf], s: mpf) -> mpf:
    total = mpf(0)
    for term in reversed(terms):
        total = total * s + term
    return total


def bisect(low: mpf, high: mpf, is_low: Callable[[mpf], bool]) -> mpf:
    """The place in [low, high] where `is_low` turns from true to false."""
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if is_low(middle) else (low, middle)
    return (low + high) / 2


class _Simulation:
    def __init__(self, pin: Pin, duration: mpf, most_events: int | None) -> None:
        self.duration, self.most_events = duration, most_events
        self.m, self.k, self.b = mpf(pin.mass), mpf(pin.stiffness), mpf(pin.damping)
        self.levels = levels(pin)
        self.x = mpf(pin.displacement)
        self.v = mpf(pin.mouse_velocity if pin.velocity is None else pin.velocity)
        self.t = mpf(0)
        self.path = Path()
        self.frequency = sqrt(self.k / self.m)
        self.speed_scale = max(
            abs(mpf(pin.mouse_velocity)), abs(self.v), self.frequency * abs(self.x)
        )
        self.signs = [sign(self.v - level.velocity) for level in self.levels]
        self.last_level: int | None = None  # at which the last event was

    def run(self) -> Path:
        stuck = next((i for i, s in enumerate(self.signs) if s == 0), None)
        if stuck is not None and not self.holds(stuck):
            self.signs[stuck] = -sign(self.needed(stuck))
            self.slide(left=stuck, tangential=False)
        elif stuck is None:
            self.slide(left=None, tangential=False)
        while not self.finished():
            held = self.signs.index(0) if 0 in self.signs else None
            if held is None:  # a level was crossed in the last event
                self.slide(left=self.last_level, tangential=False)
            elif self.levels[held].velocity == 0:
                self.rest()
            else:
                self.carry(held)
        self.path.end = self.t
        return self.path

    def finished(self) -> bool:
        enough = self.most_events is not None and len(self.path.events) >= self.most_events
        return enough or self.t >= self.duration

    # -- forces --------------------------------------------------------------------------------

    def friction(self) -> mpf:
        """Friction force of the contacts that slide."""
        pairs = zip(self.levels, self.signs, strict=True)
        return -sum((level.kinetic * s for level, s in pairs), mpf(0))

    def needed(self, i: int) -> mpf:
        """Force that contact i must give for the pin to keep the velocity of its surface."""
        v = self.levels[i].velocity
        others = [level for j, level in enumerate(self.levels) if j != i]
        return self.k * self.x + self.b * v + sum(o.kinetic * sign(v - o.velocity) for o in others)

    def holds(self, i: int) -> bool:
        """The set-valued law at a level: it sticks if and only if |force needed| <= static."""
        force, limit = abs(self.needed(i)), self.levels[i].static
        if abs(force - limit) <= DOUBT * limit:
            self.doubt("stick decision")
        return bool(force <= limit)

    # -- modes ---------------------------------------------------------------------------------

    def rest(self) -> None:
        """At rest on a surface at rest: nothing changes any more."""
        width = self.duration - self.t
        self.path.pieces.append(Piece(self.t, width, [self.x], "resting"))
        self.t = self.duration

    def carry(self, i: int) -> None:
        """Stuck to a moving surface until the force needed reaches the static friction."""
        level = self.levels[i]
        way = sign(level.velocity)  # the force needed grows this way, at the rate k v
        limit_x = self.x + (way * level.static - self.needed(i)) / self.k
        width = min((limit_x - self.x) / level.velocity, self.duration - self.t)
        terms = [self.x, level.velocity * width]
        self.path.pieces.append(Piece(self.t, width, terms, "carried"))
        self.t += width
        if self.t >= self.duration:
            return
        self.x, self.signs[i] = limit_x, -way
        self.note(i, "slip")
        if not self.finished():
            # static = kinetic: the friction does not jump, so neither does the acceleration (0)
            self.slide(left=i, tangential=level.static == level.kinetic)

    def slide(self, left: int | None, tangential: bool) -> None:
        """All contacts slide until a level is reached; `left` is the level the pin starts at."""
        watched = list(range(len(self.levels)))
        if tangential and self.b == 0 and len(self.levels) == 1:
            # Energy about the new centre is conserved and equals v_level^2 m / 2: |v| <= |v_level|.
            watched = []
        step = 1 / max(self.frequency, self.b / self.m)
        while not self.finished():
            piece = self.series(step, tangential)
            reached = self.first_level(piece, watched, left)
            s = mpf(1) if reached is None else reached[0]
            if self.t + s * step >= self.duration:
                self.path.pieces.append(piece)
                self.t = self.duration
                return
            self.path.pieces.append(piece)
            self.t, self.x, self.v = self.t + s * step, piece.position(s), piece.velocity(s)
            if reached is not None:
                self.arrive(reached[1], piece, s)
                return
            left, tangential = None, False

    def arrive(self, i: int, piece: Piece, s: mpf) -> None:
        """The pin's velocity reaches that of surface i: stick or cross."""
        a = piece.acceleration(s)
        jerk = -(self.b * a + self.k * self.v) / self.m
        if a * a < 2 * abs(jerk) * DOUBT * self.speed_scale:
            self.doubt("level hit barely")
        self.v = self.levels[i].velocity
        if self.holds(i):
            self.signs[i] = mpf(0)
            self.note(i, "stick")
        else:
            self.signs[i] = -self.signs[i]
            self.note(i, "reverse")

    # -- one step ------------------------------------------------------------------------------

    def series(self, h: mpf, tangential: bool) -> Piece:
        """Taylor series of the solution through the present state, scaled to the step h."""
        drag, spring = self.b * h / self.m, self.k * h * h / self.m
        a = (self.friction() - self.b * self.v - self.k * self.x) / self.m
        c = [self.x, self.v * h, mpf(0) if tangential else a * h * h / 2]
        for n in range(1, TERMS - 2):
            c.append(-(drag * (n + 1) * c[n + 1] + spring * c[n]) / ((n + 2) * (n + 1)))
        return Piece(self.t, h, c, "slip")

    def first_level(
        self, piece: Piece, watched: list[int], left: int | None
    ) -> tuple[mpf, int] | None:
        """Earliest (s, level index) in the step, or None. The sign at `left` is the sign chosen."""
        c, h = piece.terms, piece.width
        rise_terms = [mpf(0)] + [n * c[n] for n in range(2, TERMS)]  # h (v(s) - v(0))
        slope_terms = [n * (n - 1) * c[n] for n in range(2, TERMS)]  # h^2 a(s)
        gaps = [self.v - level.velocity for level in self.levels]
        if left is not None:
            gaps[left] = mpf(0)  # exactly: at the level, so the bracket below has its true sign

        def rise(s: mpf) -> mpf:
            return horner(rise_terms, s) / h

        def slope(s: mpf) -> mpf:
            return horner(slope_terms, s)

        def agrees(up: bool, s: mpf) -> bool:
            return bool((slope(s) >= 0) == up)

        def keeps(i: int, s: mpf) -> bool:
            return bool((gaps[i] + rise(s)) * self.signs[i] > 0)

        # Just after the start the first non-zero derivative gives the sign.
        start_slope = next((term for term in slope_terms if term != 0), mpf(0))
        before, up = mpf(0), start_slope >= 0
        for n in range(1, POINTS + 1):
            after = mpf(n) / POINTS
            still_up = slope(after) >= 0
            stops = [after]
            if still_up != up:
                turn = bisect(before, after, partial(agrees, up))
                self.check_turn(rise(turn), gaps, watched, piece.begin + turn * h)
                stops = [turn, after]
            for stop in stops:  # velocity is monotone from one stop to the next: one level at most
                r = rise(stop)
                hits = [i for i in watched if sign(gaps[i] + r) not in (0, self.signs[i])]
                if hits:
                    return min((bisect(before, stop, partial(keeps, i)), i) for i in hits)
                before = stop
            up = still_up
        return None

    def check_turn(self, rise: mpf, gaps: list[mpf], watched: list[int], time: mpf) -> None:
        """A turning point of the velocity close to a level is a graze: known, or in doubt."""
        for i, gap in enumerate(gaps):
            distance = abs(gap + rise)
            if i in watched and distance < DOUBT * self.speed_scale:
                self.path.doubts.append((time, "level grazed"))
            elif i not in watched:
                # the level left tangentially: its height is reached again, never exceeded
                turned_back = abs(distance - 2 * abs(self.levels[i].velocity))
                assert min(distance, turned_back) < EXACT * self.speed_scale

    # -- records -------------------------------------------------------------------------------

    def note(self, i: int, kind: str) -> None:
        self.last_level = i
        self.v = self.levels[i].velocity
        self.path.events.append(Event(self.t, self.levels[i].name, kind, self.x, self.v))

    def doubt(self, reason: str) -> None:
        self.path.doubts.append((self.t, reason))


def levels(pin: Pin) -> list[Level]:
    """The surfaces that can hold the pin; equal surface velocities add their capacities."""
    contacts = [
        Level("plate", mpf(pin.mouse_velocity), mpf(pin.plate_kinetic), mpf(pin.plate_static)),
        Level("finger", mpf(0), mpf(pin.finger_kinetic), mpf(pin.finger_static)),
    ]
    present = [c for c in contacts if c.static > 0]
    if len(present) == 2 and present[0].velocity == present[1].velocity:
        plate, finger = present
        kinetic, static = plate.kinetic + finger.kinetic, plate.static + finger.static
        return [Level("both", plate.velocity, kinetic, static)]
    return present


def solve(pin: Pin, duration: float, most_events: int | None = None) -> Path:
    """The motion from release to `duration` (s), or to its event number `most_events`."""
    return _Simulation(pin, mpf(duration), most_events).run()

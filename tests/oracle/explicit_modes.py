"""Second oracle: a released pin as explicit modes, with SciPy's DOP853 and its event location.

The friction law is written out as a table of modes and of what ends each, so that nothing is shared
with `mp_oracle`, neither code nor method. Good to the tolerances named below, and fast enough to be
used live.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import copysign

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

RTOL = 1e-12
PHASE_TOLERANCE = 2e-9  # of event times, in radians of the natural frequency
STATE_TOLERANCE = 2e-9  # of the scales of x, v and a
GRAZE = (
    4e-5  # acceleration, relative to frequency * speed, below which an undamped pin only touches
)

State = NDArray[np.float64]
Acceleration = Callable[[float, State], float]


@dataclass
class Stretch:
    """The state between two moments and its mode."""

    begin: float
    mode: str
    state: Callable[[float], tuple[float, float, float]]  # t -> x, v, a


@dataclass
class Run:
    """Stretches of the motion; events as (time, contact, kind, position, velocity)."""

    stretches: list[Stretch]
    events: list[tuple[float, str, str, float, float]]

    def at(self, time: float) -> tuple[float, float, float]:
        begins = [s.begin for s in self.stretches]
        return self.stretches[int(np.searchsorted(begins, time, side="right")) - 1].state(time)


def _turning_point(acceleration: Acceleration, direction: float) -> Acceleration:
    """As an event of solve_ivp: stop where the acceleration changes sign in this direction."""

    def event(t: float, y: State) -> float:
        return acceleration(t, y)

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = direction  # type: ignore[attr-defined]
    return event


def _gap(t: float, solution: Callable[[float], State], level: float) -> float:
    return float(solution(t)[1] - level)


def _along(
    solution: Callable[[float], State], acceleration: Acceleration
) -> Callable[[float], tuple[float, float, float]]:
    def state(t: float) -> tuple[float, float, float]:
        y = solution(t)
        return float(y[0]), float(y[1]), acceleration(t, y)

    return state


class ExplicitModes:
    """One pin; `case` maps the names of the inputs (mass ... velocity) to SI values."""

    def __init__(self, case: Mapping[str, float], duration: float) -> None:
        self.m, self.k, self.b = case["mass"], case["stiffness"], case["damping"]
        self.vp, self.duration = case["mouse_velocity"], duration
        self.plate = (case["plate_kinetic"], case["plate_static"])
        self.finger = (case["finger_kinetic"], case["finger_static"])
        self.x, self.v = case["displacement"], case["velocity"]
        self.w = float(np.sqrt(self.k / self.m))
        self.speed = max(abs(self.vp), abs(self.v), self.w * abs(self.x))
        self.t = 0.0
        self.run = Run([], [])
        self.has_plate, self.has_finger = self.plate[1] > 0, self.finger[1] > 0

    # The four ways in which velocity can equal that of something: nothing, plate, finger, both.
    def place(self) -> str:
        on_plate = self.has_plate and self.v == self.vp
        on_finger = self.has_finger and self.v == 0.0
        if on_plate and on_finger:
            return "both"
        return "plate" if on_plate else "finger" if on_finger else ""

    def excess(self, place: str) -> float:
        """Spring and damper force that friction at `place` would have to balance, N."""
        if place == "plate" and self.vp != 0:  # the finger slides and drags back
            return self.k * self.x + self.b * self.vp + copysign(self.finger[0], self.vp)
        if place == "finger" and self.vp != 0:  # the plate slides and drags along
            return self.k * self.x - copysign(self.plate[0], self.vp)
        return self.k * self.x

    def capacity(self, place: str) -> float:
        shares = {"plate": [self.plate], "finger": [self.finger], "both": [self.plate, self.finger]}
        return sum(static for _, static in shares[place])

    def solve(self) -> Run:
        place = self.place()
        if place and abs(self.excess(place)) <= self.capacity(place):
            mode = "carried" if self.v != 0 else "resting"
            sides = {"plate": 0.0, "finger": 0.0}
        else:
            mode = "slip"
            away = -np.sign(self.excess(place)) if place else 0.0
            sides = {
                "plate": np.sign(self.v - self.vp) or away,
                "finger": np.sign(self.v) or away,
            }
        tangential = False
        while self.t < self.duration:
            if mode == "resting":
                self.rest()
            elif mode == "carried":
                sides = self.carried()
                mode, tangential = "slip", self.plate[0] == self.plate[1]
            else:
                mode = self.slip(sides, tangential)
                tangential = False
        return self.run

    def rest(self) -> None:
        x = self.x
        self.run.stretches.append(Stretch(self.t, "resting", lambda t: (x, 0.0, 0.0)))
        self.t = self.duration

    def carried(self) -> dict[str, float]:
        """X' = v_p until the plate's static friction is used up; returns the sliding directions."""
        t0, x0, vp = self.t, self.x, self.vp
        self.run.stretches.append(Stretch(t0, "carried", lambda t: (x0 + vp * (t - t0), vp, 0.0)))
        way = float(np.sign(vp))
        lost_at = (way * (self.plate[1] - self.finger[0]) - self.b * vp) / self.k
        self.t, self.x = t0 + (lost_at - x0) / vp, lost_at
        if self.t < self.duration:
            self.run.events.append((self.t, "plate", "slip", self.x, self.v))
        return {"plate": -way, "finger": way}

    def slip(self, sides: dict[str, float], tangential: bool) -> str:
        """Slide until a level ends it; changes `sides` in place, returns the next mode.

        The solver stops at each turning point of the velocity. Between two stops the velocity is
        monotone, so that its ends alone tell whether it passed a level.
        """
        friction = -self.plate[0] * sides["plate"] - self.finger[0] * sides["finger"]
        m, k, b = self.m, self.k, self.b

        def acceleration(_t: float, y: State) -> float:
            return float((friction - b * y[1] - k * y[0]) / m)

        levels = [("plate", self.vp)] * self.has_plate + [("finger", 0.0)] * self.has_finger
        y = np.array([self.x, self.v])
        bend = np.sign(self.v) if tangential else -np.sign(acceleration(0.0, y))
        left: float | None = self.v  # a level left here is not reached before the first stop
        while True:
            out = solve_ivp(
                lambda t, y: (y[1], acceleration(t, y)),
                (self.t, self.duration),
                y,
                method="DOP853",
                rtol=RTOL,
                atol=[RTOL * self.speed / self.w, RTOL * self.speed],
                max_step=0.2 / self.w,
                dense_output=True,
                events=_turning_point(acceleration, bend),
            )
            begin, self.t, y = self.t, float(out.t[-1]), out.y[:, -1]
            self.run.stretches.append(Stretch(begin, "slip", _along(out.sol, acceleration)))
            reached = [
                (brentq(_gap, begin, self.t, (out.sol, u), xtol=1e-16), name, u)
                for name, u in levels
                if u != left and (y[1] - u) * sides[name] < 0 < (out.y[1, 0] - u) * sides[name]
            ]
            for time, _, level in sorted(reached):
                x, _, a = self.run.stretches[-1].state(time)
                touches = b == 0 and abs(a) < GRAZE * self.w * self.speed
                if not touches:
                    self.t, self.x, self.v = time, x, level
                    return self.decide(sides)
            if out.status == 0:
                return "slip"
            bend, left = -bend, None

    def decide(self, sides: dict[str, float]) -> str:
        place = self.place()
        sticks = abs(self.excess(place)) <= self.capacity(place)
        self.run.events.append((self.t, place, "stick" if sticks else "reverse", self.x, self.v))
        for name in ("plate", "finger") if place == "both" else (place,):
            sides[name] *= -1
        if not sticks:
            return "slip"
        return "carried" if self.v != 0 else "resting"


def solve(case: Mapping[str, float], duration: float) -> Run:
    """The motion from release to `duration` (s)."""
    return ExplicitModes(case, duration).solve()

"""The pin as explicit modes, for integrators that need smooth problems.

Each slide is a smooth problem that ends where the velocity reaches that of a contact; what follows
is decided by the force needed there. Stuck stretches are straight lines and cost nothing. This is
the careful way to use a general solver, not the naive one.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import copysign, inf, pi, sqrt
from typing import Protocol

import numpy as np

from benchmarks.racing.race import FailureError
from benchmarks.racing.releases import Floats

MOST_SLIDES = 1000


@dataclass(frozen=True)
class Pin:
    """A drive; pairs are (plate, finger). SI."""

    mass: float
    stiffness: float
    damping: float
    kinetic: tuple[float, float]
    static: tuple[float, float]
    levels: tuple[float, float]  # the contacts' velocities
    displacement: float

    @classmethod
    def of(cls, drive: Floats) -> Pin:
        """From the seven numbers of `releases.ORDER`."""
        m, k, b, plate, finger, level, x = drive.tolist()
        return cls(m, k, b, (plate, finger), (plate, finger), (level, 0.0), x)

    def longest_step(self, part: int) -> float:
        """This part of the undamped period, s.

        Into a longer step a short slide fits whole, and the solver then sees only the event that
        the slide began with, for ever. Thirty are safe, twelve nearly so and faster.
        """
        return 2.0 * pi / part * sqrt(self.mass / self.stiffness)


class Contacts:
    """Sliding direction on plate and finger, 1 or -1; 0 in stick."""

    def __init__(self, pin: Pin) -> None:
        self.pin = pin
        self.sides = [0.0, copysign(1.0, pin.levels[0])]
        self.settle(0, pin.displacement)

    @property
    def stuck(self) -> int | None:
        return self.sides.index(0.0) if 0.0 in self.sides else None

    @property
    def friction(self) -> float:
        return -sum(f * s for f, s in zip(self.pin.kinetic, self.sides, strict=True))

    def need(self, at: int, x: float) -> float:
        """The force that contact `at` must carry to hold the pin, N."""
        other = 1 - at
        pin = self.pin
        drag = pin.kinetic[other] * self.sides[other]
        return pin.stiffness * x + pin.damping * pin.levels[at] + drag

    def settle(self, at: int, x: float) -> None:
        """The velocity has reached that of contact `at`: stick there, or slide on or back."""
        need = self.need(at, x)
        self.sides[at] = 0.0 if abs(need) <= self.pin.static[at] else -copysign(1.0, need)

    def hold(self, at: int, x: float) -> float:
        """Duration for which contact `at` holds the pin from x on, s."""
        speed = self.pin.levels[at]
        if speed == 0.0:
            return inf
        rest = copysign(self.pin.static[at], speed) - self.need(at, x)
        return rest / (self.pin.stiffness * speed)

    def let_go(self, at: int) -> None:
        """The plate has drawn the pin as far as it can."""
        self.sides[at] = -copysign(1.0, self.pin.levels[at])


@dataclass(frozen=True)
class Slide:
    """A smooth stretch of the motion, and what ends it."""

    pin: Pin
    begin: float  # s
    end: float  # s, if nothing ends it before
    x: float
    v: float
    friction: float  # N
    sides: tuple[float, float]
    requested: Floats  # times at which positions are wanted, s

    def acceleration(self, x: float, v: float) -> float:
        pin = self.pin
        return (self.friction - pin.damping * v - pin.stiffness * x) / pin.mass


@dataclass(frozen=True)
class Slid:
    """Result of a slide; `reached` is the contact whose velocity ended it."""

    end: float
    x: float
    reached: int | None
    positions: Floats  # at the times asked up to its end


class Slider(Protocol):
    """An integrator of slides."""

    def __call__(self, slide: Slide) -> Slid: ...


@dataclass
class Followed:
    """Positions at the times asked, and since when and where the pin rests, if it does."""

    positions: Floats
    rest: tuple[float, float] | None = field(default=None)


def follow(pin: Pin, integrate: Slider, times: Floats, duration: float) -> Followed:
    """The motion from its release, slide by slide."""
    contacts = Contacts(pin)
    t, x, v = 0.0, pin.displacement, pin.levels[0]
    followed = Followed(np.empty(len(times)))
    positions, done = followed.positions, 0
    for _ in range(MOST_SLIDES):
        stuck = contacts.stuck
        if stuck is not None:
            held = contacts.hold(stuck, x)
            until = int(np.searchsorted(times, t + held, side="right"))
            positions[done:until] = x + v * (times[done:until] - t)
            if v == 0.0:
                followed.rest = (t, x)
            if t + held >= duration:
                return followed
            t, x, done = t + held, x + held * v, until
            contacts.let_go(stuck)
        slide = Slide(
            pin,
            t,
            duration,
            x,
            v,
            contacts.friction,
            (contacts.sides[0], contacts.sides[1]),
            times[done:],
        )
        slid = integrate(slide)
        positions[done : done + len(slid.positions)] = slid.positions
        done += len(slid.positions)
        if slid.reached is None:
            return followed
        t, x, v = slid.end, slid.x, pin.levels[slid.reached]
        contacts.settle(slid.reached, x)
    raise FailureError("chattering")

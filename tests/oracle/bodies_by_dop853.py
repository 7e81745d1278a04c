"""Several bodies by SciPy's DOP853: modes spelled out, events located, the next mode by trial.

Shares nothing with the solver: the accelerations of bodies that stick together come from one dense
system of equations, and the next mode is the first of all combinations that contradicts no law.
Skins need damping, and rigid contacts may not close a loop.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from pindrive.bodies import System

Array = NDArray[np.float64]
Mode = tuple[int, ...]


class Bodies:
    """A system whose inputs are functions of time in Python."""

    def __init__(self, system: System) -> None:
        names = [*system.bodies]
        self._last: Any = (None, None)
        self.mass = np.array([body.mass for body in system.bodies.values()])
        self.contacts = [*system.contacts.values()]
        self.skins = [j for j, c in enumerate(self.contacts) if np.isfinite(c.stiffness)]
        self.forces = [body.force for body in system.bodies.values()]
        self.springs = [*system.springs.values()]
        self.feedbacks = [*system.feedbacks.values()]
        self.acts = [self._way(names, f.between) for f in self.feedbacks]
        self.seen = [self._way(names, f.measured) for f in self.feedbacks]
        self.held = np.zeros(len(self.feedbacks))
        self.sums = np.zeros(len(self.feedbacks))
        self.start = np.array(
            [
                *(body.position for body in system.bodies.values()),
                *(body.velocity for body in system.bodies.values()),
                *(self.contacts[j].stretch for j in self.skins),
                *(0.0 for _ in self.feedbacks),
            ]
        )
        self.ways = [self._way(names, c.between) for c in self.contacts]
        self.pulls = [self._way(names, s.between) for s in self.springs]

    @staticmethod
    def _way(names: list[str], between: tuple[str, str]) -> Array:
        """Column that takes the bodies to the distance of the first from the second."""
        way = np.zeros(len(names))
        for name, sign in zip(between, (1.0, -1.0), strict=True):
            if name != "ground":
                way[names.index(name)] += sign
        return way

    def forces_of(self, t: float, y: Array, mode: Mode) -> tuple[Array, Array, Array, Array]:
        """Accelerations, friction, rates of the stretches and sliding speeds in a mode."""
        asked = (t, y.tobytes(), mode)
        if self._last[0] != asked:
            self._last = (asked, self._forces(t, y, mode))
        found: tuple[Array, Array, Array, Array] = self._last[1]
        return found

    def _forces(self, t: float, y: Array, mode: Mode) -> tuple[Array, Array, Array, Array]:
        n = len(self.mass)
        x, v = y[:n], y[n : 2 * n]
        stretch = dict(zip(self.skins, y[2 * n :], strict=False))
        total = np.array([_at(force, t) for force in self.forces])
        for spring, way in zip(self.springs, self.pulls, strict=True):
            longer = way @ x - _at(spring.length, t)
            faster = way @ v - _rate(spring.length, t)
            total -= way * (spring.stiffness * longer + spring.damping * faster)
        for i, (feedback, way) in enumerate(zip(self.feedbacks, self.acts, strict=True)):
            if feedback.period:
                total += way * self.held[i]
                continue
            error, rate = self.error(i, t, y)
            summed = y[2 * n + len(self.skins) + i]
            total += way * (
                feedback.proportional * error
                + feedback.derivative * rate
                + feedback.integral * summed
            )
        friction, rates, sliding = (np.zeros(len(self.contacts)) for _ in range(3))
        stuck = []
        for j, (contact, way) in enumerate(zip(self.contacts, self.ways, strict=True)):
            speed = way @ v - _at(contact.velocity, t)
            kinetic = mode[j] * contact.kinetic * self.load(j, t)
            sliding[j] = speed
            if j in stretch and mode[j] == 0:
                rates[j], sliding[j] = speed, 0.0
                friction[j] = -(contact.stiffness * stretch[j] + contact.damping * speed)
            elif j in stretch:
                rates[j] = (kinetic - contact.stiffness * stretch[j]) / contact.damping
                sliding[j], friction[j] = speed - rates[j], -kinetic
            elif mode[j] == 0:
                stuck.append(j)
                continue
            else:
                friction[j] = -kinetic
            total += way * friction[j]
        if stuck:
            ways = np.array([self.ways[j] for j in stuck])
            needed = np.array([_rate(self.contacts[j].velocity, t) for j in stuck])
            delassus = (ways / self.mass) @ ways.T
            held = np.linalg.solve(delassus, needed - ways @ (total / self.mass))
            friction[stuck] = held
            total = total + ways.T @ held
        return total / self.mass, friction, rates, sliding

    def load(self, j: int, t: float) -> float:
        """Load of contact j, with that of the contact that presses it."""
        contact = self.contacts[j]
        load = _at(contact.load, t)
        if contact.pressed_by:
            name = contact.pressed_by.removeprefix("contact.")
            by = next(c for c in self.contacts if c.name == name)
            load += (contact.share or 0.0) * _at(by.load, t)
        return load

    def error(self, i: int, t: float, y: Array) -> tuple[float, float]:
        """Error of feedback i, and its rate."""
        n, reference = len(self.mass), self.feedbacks[i].reference
        error = _at(reference, t) - self.seen[i] @ y[:n]
        return float(error), float(_rate(reference, t) - self.seen[i] @ y[n : 2 * n])

    def sample(self, i: int, t: float, y: Array) -> None:
        """Take a sample of feedback i."""
        feedback = self.feedbacks[i]
        error, rate = self.error(i, t, y)
        self.sums[i] += feedback.period * error
        self.held[i] = feedback.proportional * error + feedback.derivative * rate
        self.held[i] += feedback.integral * self.sums[i]
        self._last = (None, None)

    def derivative(self, t: float, y: Array, mode: Mode) -> Array:
        """Rate of the state in a mode."""
        n = len(self.mass)
        acceleration, _, rates, _ = self.forces_of(t, y, mode)
        errors = [self.error(i, t, y)[0] for i in range(len(self.feedbacks))]
        return np.concatenate([y[n : 2 * n], acceleration, rates[self.skins], errors])

    def guard(self, j: int, t: float, y: Array, mode: Mode) -> float:
        """Positive while contact j may keep its mode."""
        _, friction, _, sliding = self.forces_of(t, y, mode)
        if mode[j]:
            return float(mode[j] * sliding[j])
        contact = self.contacts[j]
        return float(contact.static * self.load(j, t) - abs(friction[j]))

    def slide_rate(self, j: int, t: float, y: Array, mode: Mode) -> float:
        """Rate of the sliding speed of contact j that slips."""
        acceleration, _, rates, _ = self.forces_of(t, y, mode)
        contact = self.contacts[j]
        found = self.ways[j] @ acceleration - _rate(contact.velocity, t)
        if j in self.skins:
            load = mode[j] * contact.kinetic * _rate(contact.load, t)
            found -= (load - contact.stiffness * rates[j]) / contact.damping
        return float(found)

    def agrees(self, t: float, y: Array, mode: Mode, speed: float, force: float) -> bool:
        """True if no contact contradicts a mode, within small speeds (m/s) and forces (N)."""
        for j in range(len(self.contacts)):
            guard = self.guard(j, t, y, mode)
            if mode[j] == 0:
                rigid = j not in self.skins
                apart = self.forces_of(t, y, mode)[3][j]
                if guard < -force or (rigid and abs(apart) > speed):
                    return False
            elif guard < -speed or (
                guard < speed and mode[j] * self.slide_rate(j, t, y, mode) < 0.0
            ):
                return False
        return True


def follow(system: System, duration: float, breaks: list[float]) -> tuple[Array, int]:
    """Follow a system; return positions at the end and the number of changes of modes.

    Args:
        system: System of bodies; inputs are numbers or functions.
        duration: s.
        breaks: Times at which an input changes its course, s.
    """
    bodies = Bodies(system)
    count, n = len(bodies.contacts), len(bodies.mass)
    t, y, changes = 0.0, bodies.start.copy(), 0
    speeds = np.abs(y[n : 2 * n]).max(initial=0.0) + 1e-3
    forces = max((c.static for c in bodies.contacts), default=1.0)
    samples = {(0.0, i) for i, f in enumerate(bodies.feedbacks) if f.period}
    for i, feedback in enumerate(bodies.feedbacks):
        if feedback.period:
            samples |= {
                (k * feedback.period, i) for k in range(int(duration / feedback.period) + 1)
            }
            bodies.sample(i, 0.0, y)
    mode = _next(bodies, t, y, None, 1e-9 * speeds, 1e-9 * forces)
    breaks = [*breaks, *(time for time, _ in samples)]
    stops = [*sorted({b for b in breaks if 0.0 < b < duration}), duration]
    while t < duration:
        until = next(stop for stop in stops if stop > t)
        solved = solve_ivp(
            bodies.derivative,
            (t, until),
            y,
            method="DOP853",
            rtol=1e-12,
            atol=1e-14,
            args=(mode,),
            events=[_event(bodies, j, mode, 1e-11 * speeds, 1e-11 * forces) for j in range(count)],
            max_step=2e-4,
        )
        met = solved.status == 1
        t, y = float(solved.t[-1]), solved.y[:, -1].copy()
        speeds = max(speeds, np.abs(y[n : 2 * n]).max())
        if not met:
            t = until
        for time, i in samples:
            if time == t > 0.0:
                bodies.sample(i, t, y)
        active = {j for j in range(count) if len(solved.t_events[j])}
        old = mode
        mode = _next(bodies, t, y, (mode, active), 1e-8 * speeds, 1e-8 * forces)
        changes += sum(a != b for a, b in zip(old, mode, strict=True))
    return y[:n], changes


def _event(bodies: Bodies, j: int, mode: Mode, speed: float, force: float) -> Callable[..., float]:
    margin = speed if mode[j] else force

    def event(t: float, y: Array, _mode: Mode) -> float:
        return bodies.guard(j, t, y, mode) + margin

    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    return event


def _next(bodies: Bodies, t: float, y: Array, before: Any, speed: float, force: float) -> Mode:
    """Return the mode that contradicts no law.

    Contacts whose guards ended change where that agrees; then the more sticks the better, and the
    nearer to the mode before.
    """
    count = len(bodies.contacts)
    old, active = before or ((0,) * count, set())
    slides = [old[j] != 0 and bodies.guard(j, t, y, old) > speed for j in range(count)]
    tried = sorted(
        product(*((old[j],) if slides[j] else (0, 1, -1) for j in range(count))),
        key=lambda m: (
            sum(m[j] == old[j] for j in active),
            sum(map(abs, m)),
            sum(a != b for a, b in zip(m, old, strict=True)),
        ),
    )
    for mode in tried:
        if bodies.agrees(t, y, mode, speed, force):
            return mode
    raise ArithmeticError(f"no mode at {t} s")


def _at(given: Any, t: float) -> float:
    return given if isinstance(given, float) else float(given(t))


def _rate(given: Any, t: float) -> float:
    if isinstance(given, float):
        return 0.0
    h = 1e-6
    return float((given(t + h) - given(max(t - h, 0.0))) / (h + min(h, t)))

"""A pin under damped skin, by matrix exponentials from event to event.

It shares no code with pindrive: the state is position, velocity and stretch beside the inputs,
which are linear systems of their own; each mode is one matrix, each guard one row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

Array = NDArray[np.float64]
Mode = tuple[int, int]
"""Direction of slip on plate and finger; 0: it sticks."""

PART: Final = 0.02
"""Steps over the time scales of pin and skin."""
SEGMENTS: Final = 3000
"""Most segments of a motion."""
LEAST: Final = 1e-15
"""Force (N) or speed (m/s) below which a guard has not fallen: of a pin at rest it is rounding."""
DERIVATIVES: Final = 5
"""Derivatives of a guard that decide whether a mode begins."""


class Segment(NamedTuple):
    """One mode from an event or a change of the inputs to the next."""

    piece: int
    mode: Mode
    lasts: float
    fired: Sequence[int]
    """Guards that end it."""


class Piece(NamedTuple):
    """Inputs over one stretch of time: w' = matrix w, and each input is a row times w."""

    begin: float
    matrix: Array
    start: Array
    plate_velocity: Array
    touch: Array


def straight(begin: float, velocity: float, faster: float, touch: float, more: float) -> Piece:
    """Inputs linear in time."""
    matrix = np.array([[0.0, 0.0], [1.0, 0.0]])
    rows = np.array([velocity, faster]), np.array([touch, more])
    return Piece(begin, matrix, np.array([1.0, 0.0]), *rows)


def wave(
    begin: float, velocity: float, amplitude: float, omega: float, touch: float, more: float
) -> Piece:
    """A plate that moves by a sinusoid over the whole time, and a touch linear from `begin` on."""
    matrix = np.zeros((4, 4))
    matrix[1, 0], matrix[2, 3], matrix[3, 2] = 1.0, omega, -omega
    start = np.array([1.0, 0.0, np.sin(omega * begin), np.cos(omega * begin)])
    rows = np.array([velocity, 0.0, amplitude, 0.0]), np.array([touch, more, 0.0, 0.0])
    return Piece(begin, matrix, start, *rows)


@dataclass(frozen=True)
class Pin:
    """A pin with kinetic and static friction at the plate and at a damped finger, SI."""

    mass: float
    stiffness: float
    damping: float
    plate: tuple[float, float]
    finger: tuple[float, float]
    skin_stiffness: float
    skin_damping: float
    pieces: Sequence[Piece]
    kind: type = float
    """Kind of the numbers: object for those of mpmath."""

    def system(self, piece: Piece, mode: Mode) -> tuple[Array, Array, Array]:
        """The matrix of a mode, the rows of its guards, and the row of the plate's velocity."""
        size = 3 + len(piece.start)
        zeros: Array = np.zeros((size + 3, size), self.kind)
        unit: Array = np.eye(size, dtype=self.kind)
        x, v, s, *_ = unit
        a, (plate_velocity, touch, one) = zeros[:size], zeros[size:]
        plate_velocity[3:], touch[3:], one[3] = piece.plate_velocity, piece.touch, 1.0
        a[3:, 3:] = piece.matrix
        on_plate, on_finger = mode
        if on_finger:
            pull = on_finger * self.finger[0] * touch
            a[2] = (pull - self.skin_stiffness * s) / self.skin_damping
            finger = [on_finger * (v - a[2])]
        else:
            pull = self.skin_stiffness * s + self.skin_damping * v
            a[2] = v
            finger = [self.finger[1] * touch - pull, self.finger[1] * touch + pull]
        holds = self.damping * v + self.stiffness * x + pull
        a[0], a[1] = v, plate_velocity @ a
        if on_plate:
            a[1] = a[1] - (on_plate * self.plate[0] * one + holds) / self.mass
            plate = [on_plate * (v - plate_velocity)]
        else:
            plate = [self.plate[1] * one - holds, self.plate[1] * one + holds]
        return a, np.array(plate + finger), plate_velocity

    def begins(self, piece: Piece, z: Array, mode: Mode) -> bool:
        """True if the first derivative that is not zero of each guard is positive."""
        a, guards, plate_velocity = self.system(piece, mode)
        gap = z[1] - plate_velocity @ z
        speed = abs(z[1]) + abs(plate_velocity @ z) + 1e-6
        force = (
            *(self.plate[1], self.finger[1], self.stiffness * abs(z[0])),
            *(self.skin_damping * abs(z[1]), 1e-9),
        )
        if mode[0] == 0 and abs(gap) > 1e-10 * speed:
            return False
        scale = min(np.sqrt(self.mass / self.stiffness), self.skin_damping / self.skin_stiffness)
        limits = [sum(force)] * (2 if mode[0] == 0 else 0) + [speed] * (mode[0] != 0)
        slides = speed + sum(force) / self.skin_damping
        limits += [sum(force)] * (2 if mode[1] == 0 else 0) + [slides] * (mode[1] != 0)
        for guard, limit in zip(guards, limits, strict=True):
            y = z.copy()
            y[1] -= gap if mode[0] == 0 else 0.0
            for order in range(DERIVATIVES):
                value, terms = guard @ y, np.abs(guard) @ np.abs(y)
                least = limit * scale**-order * (1.0 if order == 0 else 1e-3)
                if abs(value) > 1e-9 * max(least, 1e-6 * terms):
                    if value < 0.0:
                        return False
                    break
                y = a @ y
        return True

    def next_mode(self, piece: Piece, z: Array, mode: Mode, fired: Sequence[int]) -> Mode:
        """The mode after guards fired: sticking first; others change only where they must."""
        of_plate = 2 if mode[0] == 0 else 1
        plate = (0, 1, -1) if any(i < of_plate for i in fired) else mode[:1]
        finger = (0, 1, -1) if any(i >= of_plate for i in fired) else mode[1:]
        tried = [(p, f) for p in plate for f in finger]
        tried += [(p, f) for p in (0, 1, -1) for f in (0, 1, -1)]
        return next(each for each in tried if self.begins(piece, z, each))

    def follow(
        self, x: float, v: float, stretch: float, times: Array
    ) -> tuple[Array, list[Segment]]:
        """Position, velocity and stretch at times, shape (times, 3), and the segments."""
        y, mode = np.array([x, v, stretch]), (0, 0)
        segments: list[Segment] = []
        rows: list[Array] = []
        ends = [*(piece.begin for piece in self.pieces[1:]), times[-1]]
        for j, (piece, end) in enumerate(zip(self.pieces, ends, strict=True)):
            z, t = np.concatenate([y, piece.start]), piece.begin
            a, guards, _ = self.system(piece, mode)
            below = guards @ z < -1e-9 * (np.abs(guards) @ np.abs(z))
            fired: Sequence[int] = range(4) if t == 0.0 else [*np.flatnonzero(below)]
            if fired:
                mode = self.next_mode(piece, z, mode, fired)
            while t < end:
                a, guards, plate_velocity = self.system(piece, mode)
                if mode[0] == 0:
                    z[1] = plate_velocity @ z
                lasts, fired, visited = self._segment(a, guards, z, end - t)
                for at, state in visited:
                    while len(rows) < len(times) and times[len(rows)] <= t + at[1] + 1e-15:
                        rows.append((expm(a * (times[len(rows)] - t - at[0])) @ state)[:3])
                z, t = expm(a * (lasts - visited[-1][0][0])) @ visited[-1][1], t + lasts
                segments.append(Segment(j, mode, lasts, fired))
                if fired:
                    if mode[0] == 0:
                        z[1] = plate_velocity @ z
                    mode = self.next_mode(piece, z, mode, fired)
                    if len(segments) > SEGMENTS:
                        raise ArithmeticError("too many events")
            y = z[:3]
        return np.array(rows), segments

    def _segment(self, a: Array, guards: Array, z: Array, most: float) -> Any:
        """The length of a segment, the guards that end it, and (from, to), state of each step."""
        slow = PART * np.sqrt(self.mass / self.stiffness)
        step = min(2.0 * PART * self.skin_damping / self.skin_stiffness, slow)
        moved: dict[float, Array] = {}
        visited: list[tuple[tuple[float, float], Array]] = []
        at, count = 0.0, 0
        while True:
            h = min(step, most - at)
            if h not in moved:
                moved[h] = expm(a * h)
            after = moved[h] @ z
            found = [
                (at + _root(a, guard, z, h, first=at == 0.0), i)
                for i, guard in enumerate(guards)
                if guard @ after < -1e-12 * (np.abs(guard) @ np.abs(after)) - LEAST
            ]
            if found:
                first = min(root for root, _ in found)
                visited.append(((at, first), z))
                return first, [i for root, i in found if root - first <= 1e-15], visited
            visited.append(((at, at + h), z))
            if at + h >= most:
                return most, [], visited
            at, z, count = at + h, after, count + 1
            if count % 16 == 0:
                step = min(2.0 * step, slow)


def _root(a: Array, guard: Array, z: Array, h: float, *, first: bool) -> float:
    """The zero of a guard that is negative after h."""
    left = 0.0
    if not guard @ z > 1e-12 * (np.abs(guard) @ np.abs(z)):
        if not first:
            return 0.0
        parts = (1e-6, 1e-4, 1e-2, 0.1, 0.3)
        left = next((h * p for p in parts if guard @ (expm(a * h * p) @ z) > 0.0), -1.0)
        if left < 0.0:
            return 1e-6 * h
    return float(brentq(lambda t: guard @ (expm(a * t) @ z), left, h, xtol=1e-18, rtol=1e-15))

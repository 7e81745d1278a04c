"""Feasibility of a device: fits, masses, and clearances of the pins.

The smallest gaps of neighbouring pins along the drive axis have a proven bound.

The gap of two pins is their clearance at rest less how far one runs into the other,
x(ahead) - x(behind): x is counted against the drive axis. Between the events of both pins and the
rows of their inputs each x is, as a rule, one closed form, whose acceleration y obeys

    m y'' + c y' + κ y = 0,    so that    |y|, as long as that lasts, <= sqrt(y² + (y'/ω)²) now

with ω² = κ/m (times exp(|c| t/m) where friction that falls with speed makes c negative). Where c
changes within a piece, as that of a friction curve under a changing load, the piece is a step of a
power series, and |y| stays below the largest of the Bernstein coefficients of its acceleration
(docs/theory.md, section 15). With |y| of both together below A, a gap is nowhere in a time h more
than A h²/8 below both its ends. Times in which it might become smaller than what was found so far
are cut into pieces until there are none: no smaller gap is missed by more than `CLOSE`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import hypot, inf, nan, pi
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.device import Device
from pindrive.device.pin_array import Neighbours
from pindrive.motion.motion import Motion
from pindrive.motion.profile import Profile
from pindrive.quantities.table import QUANTITIES

IRON: Final = 7870.0
COPPER: Final = 8960.0
"""Densities at 20 °C, kg/m³ (CRC Handbook of Chemistry and Physics)."""
SLACK: Final = 1e-9
"""So much too large, a part of itself, is rounding."""


def nearest_pins(places: Sequence[tuple[float, float]]) -> tuple[int, int, float] | None:
    """Two pins of which none stand closer, and how far apart they are, m; None of a single one."""
    inside = sorted(range(len(places)), key=lambda i: places[i])
    best: tuple[int, int, float] | None = None
    for at, i in enumerate(inside):
        for j in inside[at + 1 :]:
            if best and places[j][0] - places[i][0] >= best[2]:
                break
            apart = hypot(places[j][0] - places[i][0], places[j][1] - places[i][1])
            if best is None or apart < best[2]:
                best = min(i, j), max(i, j), apart
    return best


def doubts(device: Device) -> Iterator[str]:
    """Return the reasons for which a device cannot be built, a line each; none without sizes."""
    array, magnet = device.array, device.magnet
    nearest = nearest_pins(array.places)
    if nearest and magnet.outer_diameter is not None:
        one, other, apart = nearest
        if magnet.outer_diameter > apart * (1.0 + SLACK):
            wide = QUANTITIES["outer_diameter"].text(magnet.outer_diameter)
            yield (
                f"magnets cannot stand side by side: magnet.outer_diameter is {wide}, and pins "
                f"{one} and {other} are {QUANTITIES['pitch'].text(apart)} apart"
            )
    if array.slot_length is not None:
        ends = [(p, _apart(array.places, p.behind, p.ahead)) for p in array.neighbours]
        pair, step = min(ends, key=lambda end: end[1], default=(None, 0.0))
        if pair and array.slot_length > step * (1.0 + SLACK):
            yield (
                f"slots overlap: array.slot_length is "
                f"{QUANTITIES['slot_length'].text(array.slot_length)}, and pins {pair.behind} and "
                f"{pair.ahead} are {QUANTITIES['pitch'].text(step)} apart along the drive axis"
            )
    travel, room, slot = device.drive.travel, array.travel, array.slot_length
    if travel and room is not None and slot and travel > room * (1.0 + SLACK):
        wide = QUANTITIES["pin_diameter"].text(array.pin_diameter)
        yield (
            f"end stops outside the slot: drive.travel is {QUANTITIES['travel'].text(travel)} "
            f"either way, and in a slot (array.slot_length) of "
            f"{QUANTITIES['slot_length'].text(slot)} a pin {wide} wide (array.pin_diameter) has "
            f"{QUANTITIES['travel'].text(room)}"
        )
    solid = heaviest(magnet.outer_diameter, magnet.height)
    if solid is not None and device.drive.mass > solid * (1.0 + SLACK):
        mass = QUANTITIES["mass"]
        yield (
            f"a magnet cannot be so heavy: drive.mass is {mass.text(device.drive.mass)}, and a "
            f"cylinder as wide and high as magnet.outer_diameter and magnet.height say weighs "
            f"{mass.text(solid)} in solid copper"
        )


def heaviest(diameter: float | None, height: float | None) -> float | None:
    """Return the mass of a solid copper cylinder with these sizes (m), kg; None if incomplete."""
    if diameter is None or height is None:
        return None
    return COPPER * pi / 4.0 * diameter**2 * height


def _apart(places: Sequence[tuple[float, float]], behind: int, ahead: int) -> float:
    """Return the distance of one pin ahead of another along the drive axis, m."""
    return places[ahead][0] - places[behind][0]


# ---- how close neighbouring pins come ------------------------------------------------------------


CLOSE: Final = 1e-12
"""The smallest gap is found to within that, m."""
CUTS: Final = 8
"""Number of parts into which a piece is cut at once."""


@dataclass(frozen=True, slots=True)
class Gap:
    """The smallest gap between two neighbouring pins in a scan."""

    behind: int
    ahead: int
    """Their numbers, as the array has them."""
    size: float
    """m; negative where they would have to pass through each other."""
    time: float
    """Earliest time of the smallest gap, s, on the path's clock."""


def smallest_gaps(
    neighbours: Sequence[Neighbours], motions: Sequence[Motion], begin: float
) -> tuple[Gap, ...]:
    """The smallest gap of each pair of neighbours.

    Args:
        neighbours: Neighbours of each pin in the array.
        motions: Motion of each pin, by its number, over one duration.
        begin: Begin of the motions on the clock of the path, s.
    """
    pieces = {i: _Pieces(motions[i]) for pair in neighbours for i in (pair.behind, pair.ahead)}
    found = []
    for pair in neighbours:
        approach, time = _closest(pieces[pair.behind], pieces[pair.ahead])
        found.append(Gap(pair.behind, pair.ahead, pair.clearance + approach, begin + time))
    return tuple(found)


def _closest(behind: _Pieces, ahead: _Pieces) -> tuple[float, float]:
    """The smallest x(behind) - x(ahead), m, and when."""
    knots = np.union1d(behind.knots, ahead.knots)
    low, high = knots[:-1], knots[1:]
    apart = behind.position(knots) - ahead.position(knots)
    first, last = apart[:-1], apart[1:]
    i = int(np.argmin(apart))
    smallest, time = float(apart[i]), float(knots[i])
    while low.size:
        lasts = high - low
        swing = behind.largest_acceleration(low, lasts) + ahead.largest_acceleration(low, lasts)
        least = np.minimum(first, last) - 0.125 * swing * lasts**2
        open_ = (
            (least < smallest - CLOSE) & (low < 0.5 * (low + high)) & (0.5 * (low + high) < high)
        )
        low, high = low[open_], high[open_]
        if not low.size:
            break
        t = low[:, np.newaxis] + (high - low)[:, np.newaxis] * np.arange(CUTS + 1) / CUTS
        t[:, -1] = high
        apart = behind.position(t) - ahead.position(t)
        if apart.min() < smallest:
            i = int(np.argmin(apart))
            smallest, time = float(apart.flat[i]), float(t.flat[i])
        low, high = t[:, :-1].ravel(), t[:, 1:].ravel()
        first, last = apart[:, :-1].ravel(), apart[:, 1:].ravel()
    return smallest, time


class _Pieces:
    """Pieces of a motion, each with a closed form or a step of a series."""

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self.position = motion.position

    @cached_property
    def knots(self) -> NDArray[np.float64]:
        """Begin of each piece, and end of the last, s."""
        duration = self.motion.duration
        ends = np.array([segment.end for segment in self.motion.segments])
        if ends[-1] < duration:  # the segments of a cycle cover one period
            period = self.motion.ending.period
            round_ = ends[ends > ends[-1] - period]
            shifts = period * np.arange(1.0, np.ceil((duration - ends[-1]) / period) + 1.0)
            ends = np.concatenate([ends, np.add.outer(shifts, round_).ravel()])
        return np.unique(np.concatenate([[0.0], ends[ends < duration], [duration]]))

    @cached_property
    def _segments(self) -> NDArray[np.int64]:
        """The segment of which each piece is a part, or a later round."""
        segments, period = self.motion.segments, self.motion.ending.period
        middle, known = 0.5 * (self.knots[:-1] + self.knots[1:]), segments[-1].end
        if known < inf:
            later = known - period + np.mod(middle - known, period)
            middle = np.where(middle < known, middle, later)
        return np.searchsorted([segment.begin for segment in segments], middle, "right") - 1

    @cached_property
    def _bounds(self) -> NDArray[np.float64]:
        """Bounds of |x''| of each piece, m/s²; NaN for a closed form."""
        return self.motion.acceleration_bounds[self._segments]

    @cached_property
    def _closed_forms(self) -> NDArray[np.float64]:
        """Coefficients of each piece in closed form: c/m, κ/m, slope g of its force over m.

        Shape (4, pieces), the last 0 where the pin is stuck; all NaN of a step of a series.
        """
        motion, drive = self.motion, self.motion.drive
        closed = np.flatnonzero(np.isnan(self._bounds))
        begin, end = self.knots[closed], self.knots[closed + 1]
        middle = 0.5 * (begin + end)
        modes = [motion.segments[i] for i in self._segments[closed]]
        finger = np.array([mode.finger == 0 for mode in modes], np.bool_)
        stuck = np.array([mode.plate == 0 for mode in modes], np.bool_)
        rigid = drive.finger.rigid
        if rigid:
            stuck |= finger
        stiffness = drive.stiffness + np.where(finger & (not rigid), drive.finger.stiffness, 0.0)
        velocity = motion.velocity(middle)
        damping = drive.damping + _slope(drive.finger.curve, np.abs(velocity))
        if drive.stop_stiffness is not None:  # elastic end stops, where they push
            pushed = motion.force("stop", middle) != 0.0
            stiffness = stiffness + np.where(pushed, drive.stop_stiffness, 0.0)
            damping = damping + np.where(pushed, drive.stop_damping or 0.0, 0.0)
        if drive.plate.curved:  # under a load that stays: else there is a bound
            load = motion.release.plate_load
            factor = load(middle) if isinstance(load, Profile) else load
            speed = np.abs(velocity - motion.plate_velocity(middle))
            damping = damping + factor * _slope(drive.plate.curve, speed)
        c, k = damping / drive.mass, stiffness / drive.mass
        changes = [
            of(end, "left") - of(begin)
            for of in (motion.acceleration, motion.velocity, motion.position)
        ]
        slope = (changes[0] + c * changes[1] + k * changes[2]) / (end - begin)
        found = np.full((4, len(self._bounds)), nan)
        found[:, closed] = c, k, slope, ~stuck
        return found

    def largest_acceleration(
        self, t: NDArray[np.float64], lasts: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """A bound on |x''| from `t` on for as long as `lasts`, s, within a piece, m/s²."""
        i = np.searchsorted(self.knots, t, "right") - 1
        found = self._bounds[i]
        closed = np.isnan(found)
        t, lasts, i = t[closed], lasts[closed], i[closed]
        c, k, g, swings = self._closed_forms[:, i]
        now = self.motion.acceleration(t)
        jerk = g - c * now - k * self.motion.velocity(t)
        growth = np.exp(np.maximum(-c, 0.0) * lasts)
        found[closed] = np.where(swings, np.hypot(now, jerk / np.sqrt(k)) * growth, np.abs(now))
        return found


def _slope(
    curve: Sequence[tuple[float, float]] | None, speed: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the slope of friction over sliding speed (m/s), N·s/m; constant beyond the last point.

    A bound that has fallen to zero stays zero.
    """
    if curve is None or len(curve) < 2:
        return np.zeros_like(speed)
    speeds, forces = np.array(curve).T
    i = np.clip(np.searchsorted(speeds, speed, "right") - 1, 0, len(speeds) - 2)
    slope = (np.diff(forces) / np.diff(speeds))[i]
    return np.where(forces[i] + slope * (speed - speeds[i]) < 0.0, 0.0, slope)

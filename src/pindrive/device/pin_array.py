"""Positions of the pins in the mouse, and of their sensing spots."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise

Places = tuple[tuple[float, float], ...]
Place = tuple[float | str, float | str]
Row = list[tuple[float, int]]


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Pair of pins that would meet along the drive axis if one moved far enough."""

    behind: int
    """The number of the one with the smaller place along the drive axis."""
    ahead: int
    """Index of the pin ahead."""
    clearance: float
    """Clearance of the pins at rest, along the drive axis, m; negative if they overlap."""


@concise
@dataclass(frozen=True, slots=True, init=False)
class PinArray:
    """Any number of pins in a mouse.

    Args:
        places: (x, y) of each pin, m: along the drive axis and across it, from the point of the
            mouse whose path is given. One pin at (0, 0) unless given.
        spots: (x, y) of the spot each of them shows, m, in the same frame; where it stands unless
            given.
        axis: Direction of the drive axis on the page, rad, from its x towards its y.
        pin_diameter: Diameter of each pin, m, greater than 0.
        slot_length: Length of the slot in which each pin moves along the drive axis, m, at least
            the diameter of the pin; None: unknown.

    Raises:
        ValueError: There are no pins, two pins at one place, or more or fewer spots than pins, or a
            number is not finite.
    """

    places: Places
    spots: Places
    axis: float
    pin_diameter: float
    slot_length: float | None

    def __init__(
        self,
        places: Iterable[Place] = ((0.0, 0.0),),
        spots: Iterable[Place] | None = None,
        axis: float | str = default("axis"),
        pin_diameter: float | str = default("pin_diameter"),
        slot_length: float | str | None = default("slot_length"),
    ) -> None:
        """Validate, and keep tuples of plain floats."""
        places = _pairs(places, "places")
        if not places:
            raise ValueError(refusal("places", "at least one place", "none"))
        shows = places if spots is None else _pairs(spots, "spots")
        if len(shows) != len(places):
            raise ValueError(refusal("spots", f"as many as pins, {len(places)}", str(len(shows))))
        object.__setattr__(self, "places", places)
        object.__setattr__(self, "spots", shows)
        object.__setattr__(self, "axis", check("axis", axis))
        object.__setattr__(self, "pin_diameter", check("pin_diameter", pin_diameter))
        slot = None if slot_length is None else check("slot_length", slot_length)
        object.__setattr__(self, "slot_length", slot)
        refuse({"array.places": places}, whole=True)
        if slot is not None:
            size = {"array.pin_diameter": self.pin_diameter, "array.slot_length": slot}
            refuse(size, whole=True)

    @classmethod
    def grid(
        cls,
        columns: float = default("columns"),
        rows: float = default("rows"),
        pitch: float | str = default("pitch"),
        *,
        spot_scale: float | str = default("spot_scale"),
        axis: float | str = default("axis"),
        pin_diameter: float | str = default("pin_diameter"),
        slot_length: float | str | None = default("slot_length"),
    ) -> PinArray:
        """Pins in columns along the drive axis and rows across it, about the middle, row by row.

        Args:
            columns: Number of pins side by side.
            rows: Number of rows.
            pitch: Distance between pins, m.
            spot_scale: Factor from the distances of the pins to those of their spots.
            axis: Direction of the drive axis, as for the class.
            pin_diameter: Diameter of each pin, as for the class.
            slot_length: Length of each slot, as for the class.

        Raises:
            ValueError: A value is invalid, as for the class, or a count is no whole number.
        """
        counts = check("columns", columns), check("rows", rows)
        refuse(dict(zip(("array.columns", "array.rows"), counts, strict=True)), whole=True)
        across, down = map(int, counts)
        step = check("pitch", pitch)
        places = [
            ((i - 0.5 * (across - 1)) * step, (j - 0.5 * (down - 1)) * step)
            for j in range(down)
            for i in range(across)
        ]
        return cls(places, _scaled(places, spot_scale), axis, pin_diameter, slot_length)

    @classmethod
    def at(
        cls,
        places: Iterable[Place],
        *,
        spot_scale: float | str = default("spot_scale"),
        axis: float | str = default("axis"),
        pin_diameter: float | str = default("pin_diameter"),
        slot_length: float | str | None = default("slot_length"),
    ) -> PinArray:
        """Pins at given places (m), their spots likewise, `spot_scale` times as far apart."""
        places = _pairs(places, "places")
        return cls(places, _scaled(places, spot_scale), axis, pin_diameter, slot_length)

    def __len__(self) -> int:
        """Return the number of pins."""
        return len(self.places)

    @property
    def direction(self) -> tuple[float, float]:
        """The drive axis on the page, a unit vector."""
        return _core.direction(self.axis)

    @property
    def travel(self) -> float | None:
        """Largest displacement of a pin in its slot, either way, m; None without a slot."""
        return None if self.slot_length is None else 0.5 * (self.slot_length - self.pin_diameter)

    @property
    def neighbours(self) -> tuple[Neighbours, ...]:
        """Pins that are next to each other along the drive axis, closer across it than a diameter.

        For each pin and each row of pins across the axis, the nearest pin ahead. Pins that stand
        exactly abreast never pass each other: see `abreast`.
        """
        return self.neighbours_of(self.pin_diameter)

    def neighbours_of(self, diameter: float) -> tuple[Neighbours, ...]:
        """Return the pairs of parts of a width (m) that move with the pins, such as magnets."""
        found = []
        for row, ahead, across in self._rows_apart(-diameter, diameter):
            touching = sqrt(diameter**2 - across**2)
            for x, number in row:
                i = bisect_right(ahead, (x, len(self)))
                if i < len(ahead):
                    found.append(Neighbours(number, ahead[i][1], ahead[i][0] - x - touching))
        return tuple(sorted(found, key=lambda pair: (pair.behind, pair.ahead)))

    @property
    def abreast(self) -> tuple[tuple[int, int], ...]:
        """The numbers of pins that stand abreast, across the drive axis, and always overlap."""
        found = []
        for row, other, _ in self._rows_apart(0.0, self.pin_diameter):
            at = dict(other)
            found += [(number, at[x]) for x, number in row if x in at]
        return tuple(found)

    def _rows_apart(self, least: float, most: float) -> Iterator[tuple[Row, Row, float]]:
        """Pairs of rows more than `least` and less than `most` apart, and how much, m.

        Rows across the drive axis; each is the places of its pins along it, with their numbers, in
        order.
        """
        rows: defaultdict[float, Row] = defaultdict(list)
        for number, (x, y) in enumerate(self.places):
            rows[y].append((x, number))
        places = sorted(rows)
        ordered = [sorted(rows[y]) for y in places]
        for y, row in zip(places, ordered, strict=True):
            first = bisect_right(places, y + least)
            last = bisect_left(places, y + most)
            for i in range(first, last):
                yield row, ordered[i], places[i] - y

    def on_page(self, places: Places) -> NDArray[np.float64]:
        """Places in the mouse as offsets on the page, m, shape (n, 2)."""
        (ax, ay), (along, across) = self.direction, np.array(places).T
        return np.stack([ax * along - ay * across, ay * along + ax * across], axis=1)


def _pairs(places: Iterable[Place], label: str) -> Places:
    try:
        pairs = [(x, y) for x, y in places]
    except (TypeError, ValueError):
        raise ValueError(refusal(label, "pairs (x, y)", repr(places))) from None
    return tuple(
        (
            check("places", x, label=f"{label}[{i}] x"),
            check("places", y, label=f"{label}[{i}] y"),
        )
        for i, (x, y) in enumerate(pairs)
    )


def _scaled(places: Iterable[tuple[float, float]], scale: float | str) -> Places:
    factor = check("spot_scale", scale)
    return tuple((factor * x, factor * y) for x, y in places)

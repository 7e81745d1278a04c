"""Devices built within the tolerances of designs, and the yield of the designs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import floor
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.study.axes import AxisReader, sweepable, written_axes
from pindrive.study.distributions import (
    Distribution,
    Linked,
    Sample,
    base_value,
    implied_links,
    with_links,
)
from pindrive.study.outputs import Share

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]
FIRST: Final = 128
"""Devices of each design from which its yield is estimated."""
TOGETHER: Final = 1 << 17
"""Devices that are simulated together, at all conditions."""


@dataclass(kw_only=True)
class Built:
    """Devices built within the tolerances, with common random draws for all designs.

    A tolerance in per cent is one of the design's own value. Every device is simulated at all
    conditions of the space.

    Attributes:
        space: Designs with their constraints and conditions.
        tolerances: Tolerance of each key, as written in a problem file.
        links: Keys that follow others as the tolerances say.
        parts: Place of each draw in the tolerances, from 0 to 1, shape (draws, keys).
        failures: Number of times that each draw has violated a constraint so far, shape (draws,).
    """

    space: DesignSpace
    tolerances: Mapping[str, Any]
    parts: Array
    links: Mapping[str, Linked] = field(default_factory=dict)
    failures: NDArray[np.int64] = field(init=False)

    def __post_init__(self) -> None:
        """Begin without failures."""
        self.failures = np.zeros(len(self.parts), np.int64)

    @classmethod
    def drawn(
        cls, space: DesignSpace, tolerances: Mapping[str, Any], draws: int, seed: int
    ) -> Built:
        """Return devices at random, of the tolerances of a problem file."""
        study = space.study
        specs = {
            sweepable(given, f"{study.source.place}: tolerances", space.scans): spec
            for given, spec in written_axes(tolerances)
        }
        written = {key: study.tolerance_links[key] for key in specs if key not in study.tolerances}
        return cls(
            space=space,
            tolerances={key: specs[key] for key in study.tolerances},
            parts=Sample(tuple(study.tolerances), draws, seed).parts(np.arange(draws)).T,
            links=written,
        )

    # ---- numbers ---------------------------------------------------------------------------------

    def numbers(self, points: Array, draws: NDArray[np.int64] | None = None) -> dict[str, Array]:
        """Return the numbers of the devices of designs.

        Args:
            points: Designs, shape (n, variables).
            draws: Draws, shape (d,); None: all.

        Returns:
            By name, SI, shape (n, d, cases); NaN for a device that cannot exist.
        """
        chosen = np.arange(len(self.parts)) if draws is None else draws
        shape = len(points), len(chosen), len(self.space.cases)
        found = self.space.simulated(self._columns(points, chosen, shape), int(np.prod(shape)))
        numbers = {name: column.reshape(shape) for name, column in found.items()}
        return numbers | self.space.priced(points, shape)

    def excess(self, points: Array, draws: NDArray[np.int64] | None = None) -> Array:
        """Return the excess over each constraint at worst, SI, shape (constraints, n, d).

        It is infinite for a device that cannot exist, or that lacks the number of a constraint.
        """
        chosen = np.arange(len(self.parts)) if draws is None else draws
        each = max(1, TOGETHER // (len(chosen) * len(self.space.cases)))
        found = []
        for begin in range(0, len(points), each):
            numbers = self.numbers(points[begin : begin + each], chosen)
            found.append(self.space.excess(numbers).max(axis=3))
        return np.concatenate(found, axis=1)

    def _columns(
        self, points: Array, draws: NDArray[np.int64], shape: tuple[int, int, int]
    ) -> dict[str, Array]:
        """Return the keys of every device at every condition, SI, arrays of shape (n * d * c,)."""
        space, device = self.space, self.space.study.device
        own = self._own(points)
        columns = {key: x[:, None, None] for key, x in own.items() if key not in self._followers}
        for key, place in zip(self.tolerances, self.parts[draws].T, strict=True):
            base = own.get(key, np.full(len(points), base_value(self._example, key)))
            within = [self._within(key, float(value), place) for value in base]
            columns[key] = np.array(within)[:, :, None]
        for condition, part in zip(space.conditions, space.cases.T, strict=True):
            for key, values in condition.columns(part).items():
                columns[key] = values[None, None, :]
        columns = with_links(device, columns, self._followers, self._ratios(own))
        return {key: np.broadcast_to(x, shape).ravel() for key, x in columns.items()}

    def _own(self, points: Array) -> dict[str, Array]:
        """Return the values of designs, linked keys included, arrays of shape (n,)."""
        found: dict[str, Array] = {}
        for variable, part in zip(self.space.variables, points.T, strict=True):
            found |= variable.columns(part)
        found = with_links(self.space.study.device, found, self.space.links)
        return {key: np.broadcast_to(x, (len(points),)) for key, x in found.items()}

    def _within(self, key: str, value: float, place: Array) -> Array:
        """Return values of a key at places in its tolerance about a value; NaN if impossible."""
        study, spec = self.space.study, self.tolerances[key]
        reader = AxisReader(study.source, "tolerances", key, value, scans=self.space.scans)
        try:
            axis = reader.read(spec)
        except ValueError:
            return np.full(len(place), np.nan)
        assert isinstance(axis, Distribution)
        return axis.ppf(place)

    @cached_property
    def _example(self) -> Any:
        """Device file of one design, with the keys of all others."""
        middle = np.full((1, len(self.space.variables)), 0.5)
        return self.space.study.device_at({k: float(x[0]) for k, x in self._own(middle).items()})

    @cached_property
    def _followers(self) -> dict[str, Linked]:
        """Keys that keep their ratio to what a tolerance or a condition changes."""
        conditions = (key for condition in self.space.conditions for key in condition.axes)
        varied = {*self.tolerances, *self.links, *conditions}
        return {**implied_links(self._example, varied, self.space.scans), **self.links}

    def _ratios(self, own: Mapping[str, Array]) -> dict[str, Array]:
        """Return the ratio that each follower keeps, that of its design, shape (n, 1, 1)."""

        def value(key: str) -> Array:
            return own[key] if key in own else np.asarray(base_value(self._example, key))

        found = {key: np.asarray(link.times) for key, link in self.links.items()}
        for key, link in self._followers.items():
            if key in found:
                continue
            leader = value(link.of) / value(link.over) if link.over else value(link.of)
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = np.where(leader == 0.0, link.times, value(key) / leader)
            found[key] = ratio[..., None, None]
        return found

    # ---- yield -----------------------------------------------------------------------------------

    def share(self, point: Array) -> Share:
        """Return the yield of a design with its exact interval."""
        return share_of(self.excess(point[None])[:, 0])

    def shortfall(self, points: Array, least: float) -> Array:
        """Return how much the yield of each design lacks, shape (n,); 0 where it is reached.

        The first draws give an estimate. Then those come that have failed most often so far, and a
        design is dropped as soon as more of its devices have failed than may: it lacks what was
        estimated. So a yield that is reached is counted from all draws, and others take few.
        """
        count = len(self.parts)
        first = min(FIRST, count)
        allowed = floor((1.0 - least) * count + 1e-9)
        failed, lacks = np.zeros(len(points), np.int64), np.zeros(len(points))
        order = np.concatenate([np.arange(first), first + np.argsort(-self.failures[first:])])
        left, begin = np.arange(len(points)), 0
        while begin < count and len(left):
            draws = order[begin : max(first, 4 * begin)]
            fails = (self.excess(points[left], draws) > 0.0).any(axis=0)
            self.failures[draws] += fails.sum(axis=0)
            failed[left] += fails.sum(axis=1)
            if not begin:
                lacks = np.maximum(least - 1.0 + failed / len(draws), 1.0 / count)
            begin += len(draws)
            left = left[failed[left] <= allowed]
        lacks[left] = 0.0
        return lacks

    def with_yield(self, points: Array, violation: Array, least: float) -> Array:
        """Return violations of designs, what a yield lacks among them.

        A design that violates a constraint itself counts as worse than any yield.

        Args:
            points: Designs, shape (n, variables).
            violation: Violations of the designs as they are, shape (n,).
            least: The yield that is demanded.
        """
        meets = violation <= 0.0
        found = np.where(meets, 0.0, 1.0 + violation)
        found[meets] = self.shortfall(points[meets], least)
        return found


def share_of(excess: Array) -> Share:
    """Return the yield with its exact interval from the excess (constraints, draws)."""
    met = (excess <= 0.0).all(axis=0)
    return Share.of_designs(int(met.sum()), met.size)


def reserves(excess: Array, own: Array, part: float) -> Array:
    """Return the tightening of each limit that lets a fraction of the devices meet it.

    A device without the number of a constraint counts as the worst that has it.

    Args:
        excess: Excess of devices, shape (constraints, draws).
        own: Excess of the design itself, shape (constraints,).
        part: Part of the draws, from 0 to 1.
    """
    exists = np.isfinite(excess)
    worst = np.where(exists, excess, own[:, None]).max(axis=1, keepdims=True)
    scattered = np.quantile(np.where(exists, excess, worst), part, axis=1, method="higher")
    with np.errstate(invalid="ignore"):
        room = scattered - own
    return np.where(np.isfinite(room), np.maximum(room, 0.0), 0.0)

"""The values of swept keys: steps, lists, distributions, samples, and keys that follow others.

All values SI. None holds an array as long as the study: values are made where they are requested.
Samples are numbers between 0 and 1, random or Sobol'. Draws come in blocks of fixed length, each
with its own seed or part of the sequence, so that any chunk, on any machine, in any order, draws
what the study says stands there.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import inf, log
from typing import Any, Final, Literal
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

import pindrive
from pindrive.files.keys import DRIVE, friction_parts
from pindrive.lazy import qmc, special
from pindrive.motion.friction import COEFFICIENT_OF, friction_force
from pindrive.quantities.table import QUANTITIES

Indices = NDArray[np.int64]
Columns = dict[str, NDArray[np.float64]]


@dataclass(frozen=True, slots=True)
class Even:
    """Values from `low` to `high` in `count` even steps, or even ratios where `log`."""

    low: float
    high: float
    count: int
    log: bool = False

    def at(self, index: Indices) -> NDArray[np.float64]:
        """The values at these places, counted from 0; the ends are met exactly."""
        part = index / (self.count - 1)
        low, high = (log(self.low), log(self.high)) if self.log else (self.low, self.high)
        between = low * (1.0 - part) + high * part
        values = np.exp(between) if self.log else between
        values = np.where(index == 0, self.low, values)
        return np.where(index == self.count - 1, self.high, values)

    @property
    def span(self) -> tuple[float, float]:
        """The smallest and the largest value."""
        return min(self.low, self.high), max(self.low, self.high)


@dataclass(frozen=True, slots=True)
class Listed:
    """The values that were written down."""

    values: tuple[float, ...]

    @property
    def count(self) -> int:
        """Number of values."""
        return len(self.values)

    def at(self, index: Indices) -> NDArray[np.float64]:
        """The values at these places, counted from 0."""
        return np.asarray(self.values)[index]

    @property
    def span(self) -> tuple[float, float]:
        """The smallest and the largest value."""
        return min(self.values), max(self.values)


Grid = Even | Listed

Kind = Literal["uniform", "loguniform", "normal", "lognormal"]
KINDS: Final[dict[Kind, tuple[str, str]]] = {
    "uniform": ("lowest", "highest"),
    "loguniform": ("lowest", "highest"),
    "normal": ("mean", "standard deviation"),
    "lognormal": ("median", "factor of one standard deviation"),
}
"""Meaning of the two numbers of a distribution."""
_FAR: Final = 0.00135
"""The part of a normal distribution beyond three standard deviations, on one side."""


@dataclass(frozen=True, slots=True)
class Distribution:
    """Distribution of a value; values outside `lower` and `upper` are cut off and never drawn."""

    kind: Kind
    first: float
    second: float
    lower: float = -inf
    upper: float = inf

    def ppf(self, part: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values below which these parts (between 0 and 1) of all draws lie."""
        first, second = self.first, self.second
        if self.kind == "uniform":
            return np.clip(first + (second - first) * part, *self.span)
        if self.kind == "loguniform":
            low, high = log(first), log(second)
            return np.clip(np.exp(low + (high - low) * part), *self.span)
        below, above = self._part_below(self.lower), self._part_below(self.upper)
        deviations = special.ndtri(below + (above - below) * part)
        normal = self.kind == "normal"
        values = first + second * deviations if normal else first * np.exp(log(second) * deviations)
        found: NDArray[np.float64] = np.clip(values, self.lower, self.upper)
        return found

    @property
    def span(self) -> tuple[float, float]:
        """The smallest and the largest value; where there is none, three deviations off."""
        if self.kind in ("uniform", "loguniform"):
            return self.first, self.second
        low, high = (float(self.ppf(np.array(part))) for part in (_FAR, 1.0 - _FAR))
        return (self.lower if self._cut(self.lower) else low), (
            self.upper if self._cut(self.upper) else high
        )

    def _cut(self, limit: float) -> bool:
        """Return True if a limit cuts off more than the far ends."""
        return _FAR < self._part_below(limit) < 1.0 - _FAR

    def _part_below(self, value: float) -> float:
        """The part of all draws below `value`, before anything is cut off."""
        if self.kind == "normal":
            return float(special.ndtr((value - self.first) / self.second))
        if value <= 0.0:
            return 0.0
        return (
            float(special.ndtr(log(value / self.first) / log(self.second))) if value < inf else 1.0
        )


@dataclass(frozen=True, slots=True)
class Linked:
    """Link of a key: a factor times the value of another key, or of a ratio of two keys."""

    of: str
    times: float
    over: str = ""

    def words(self, key: str, name: Callable[[str], str] = str) -> str:
        """Return the link of `key` in words, such as "plate.static = 1.5 × plate.kinetic"."""
        over = f" / {name(self.over)}" if self.over else ""
        return f"{name(key)} = {self.times:g} × {name(self.of)}{over}"


Axis = Even | Listed | Distribution | Linked


def as_distribution(axis: Grid | Distribution) -> Distribution:
    """The range of an axis as something to draw from: even in the logarithm where the axis is."""
    if isinstance(axis, Distribution):
        return axis
    low, high = axis.span
    return Distribution(
        "loguniform" if isinstance(axis, Even) and axis.log else "uniform", low, high
    )


BLOCK: Final = 1 << 15
"""Draws that are made together."""
MOST_SOBOL: Final = 1 << 30
"""Points of a Sobol' sequence with 30 bits."""

Method = Literal["random", "sobol"]


@dataclass(frozen=True, slots=True)
class Sample:
    """One sampled dimension: `count` draws of all of `keys` together."""

    keys: tuple[str, ...]
    count: int
    seed: int = 1
    method: Method = "random"

    def parts(self, index: NDArray[np.int64]) -> NDArray[np.float64]:
        """Numbers above 0 and below 1 at these places, shape (keys, n)."""
        found = np.empty((len(self.keys), len(index)))
        number, place = np.divmod(index, BLOCK)
        draw = _sobol if self.method == "sobol" else _random
        for block in np.unique(number):
            here = number == block
            found[:, here] = draw(self.keys, self.seed, int(block))[:, place[here]]
        return found


@lru_cache(maxsize=8)
def _random(keys: tuple[str, ...], seed: int, block: int) -> NDArray[np.float64]:
    """Each key has its own stream, which other keys do not change."""
    streams = (np.random.SeedSequence(seed, spawn_key=(crc32(key.encode()), block)) for key in keys)
    drawn = [np.random.Generator(np.random.PCG64(stream)).random(BLOCK) for stream in streams]
    return np.maximum(drawn, 2.0**-54)  # never 0, where a distribution may have no value


@lru_cache(maxsize=8)
def _sobol(keys: tuple[str, ...], seed: int, block: int) -> NDArray[np.float64]:
    sequence = qmc.Sobol(len(keys), scramble=True, rng=np.random.default_rng(seed))
    if block:
        sequence.fast_forward(block * BLOCK)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a block continues where the one before ended
        drawn = sequence.random(BLOCK)
    return np.ascontiguousarray(drawn.T) + 2.0**-31


LEFT_OUT: Final = {
    "plate.static": "plate.kinetic",
    "finger.static": "finger.kinetic",
    "plate.static_coefficient": "plate.coefficient",
    "finger.static_coefficient": "finger.coefficient",
    "motion.velocity": "motion.mouse_velocity",
}
"""Keys that are another one's value where a device file leaves them out."""


def base_value(device: pindrive.DeviceFile, key: str) -> Any:
    """Return the value of the device for a key, SI; the default for a missing key."""
    value = device.values()[key]
    if value is not None or key not in LEFT_OUT:
        return value
    return device.values()[LEFT_OUT[key]]


def implied_links(
    device: pindrive.DeviceFile, varied: Collection[str], scans: bool
) -> dict[str, Linked]:
    """The keys that a device gives and that keep their ratio to varied ones (`Quantity.follows`).

    A curve is no single value: it keeps its ratio where a motion is put together. A ratio to zero
    does not exist; such a key stays as it is.

    Args:
        device: Device with the ratios.
        varied: Keys that have values of their own.
        scans: True for a study of scans, in which the keys of [motion] have no part.
    """
    moving = {*varied}
    found = {}
    for key, quantity in DRIVE.items():
        if key in device.derived:
            parts = friction_parts(key)
            if moving.intersection((*parts, *(LEFT_OUT[p] for p in parts if p in LEFT_OUT))):
                moving.add(key)
            continue
        if key in moving or not moving.intersection(quantity.follows):
            continue
        value, leaders = device.values()[key], [base_value(device, k) for k in quantity.follows]
        if value is None and key in LEFT_OUT:
            moving.add(key)  # an omitted key has the leader's value anyway
        if (scans and key.startswith("motion.")) or not isinstance(value, float):
            continue
        if all(isinstance(leader, float) and leader for leader in leaders):
            first, *over = leaders
            times = value / (first / over[0] if over else first)
            found[key] = Linked(quantity.follows[0], times, "".join(quantity.follows[1:]))
            moving.add(key)
    return found


def with_links(
    device: pindrive.DeviceFile,
    columns: Columns,
    links: Mapping[str, Linked],
    ratios: Columns | None = None,
) -> Columns:
    """Return the columns with the columns of linked keys.

    The links have no circle (see `circle`). `ratios` replace the factors of links.
    """

    def value(key: str) -> NDArray[np.float64]:
        if key in columns:
            return columns[key]
        if key in links:
            link = links[key]
            leader = value(link.of) / value(link.over) if link.over else value(link.of)
            times = ratios[key] if ratios else np.asarray(link.times)
            return times * leader
        if key in COEFFICIENT_OF and key in device.derived:
            return np.asarray(friction_force(key, lambda name: value(QUANTITIES[name].key)))
        if key in LEFT_OUT and device.values()[key] is None:
            return value(LEFT_OUT[key])
        return np.asarray(base_value(device, key))

    return columns | {key: value(key) for key in links}


def exponents(key: str, links: Mapping[str, Linked]) -> dict[str, float]:
    """To which power of `key` every key changes that follows it, itself included."""

    def power(name: str) -> float:
        if name == key:
            return 1.0
        if name in links:
            link = links[name]
            return power(link.of) - (power(link.over) if link.over else 0.0)
        return power(LEFT_OUT[name]) if name in LEFT_OUT else 0.0

    found = {name: power(name) for name in links}
    return {key: 1.0} | {name: n for name, n in found.items() if n}


def circle(links: Mapping[str, Linked]) -> tuple[str, ...]:
    """Keys of which each follows the next and the last the first; none where there is no circle."""
    for start in links:
        way = [start]
        while way[-1] in links:
            of = links[way[-1]].of
            if of == start:
                return tuple(way)
            if of in way:
                break
            way.append(of)
    return ()

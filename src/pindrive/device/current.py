"""The current in a coil over time: exponentials between switchings, by commands or by pulses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, exp, expm1, floor
from typing import TYPE_CHECKING, overload

import numpy as np

from pindrive.quantities import budgets

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from pindrive.device.heating import Heat


@dataclass(frozen=True, slots=True)
class CoilState:
    """All there is to know of a coil: its last switching."""

    since: float = 0.0
    """When that was, s."""
    on: bool = False
    """Whether it is on since then."""
    current: float = 0.0
    """The current then, a part of the full one."""
    pull: float | None = None
    """The pull then, as its rows have it, N; None: exactly that of the current."""
    warming: float = 0.0
    """Of the coil above 20 °C then, K."""
    level: float = 1.0
    """The voltage across it while it is on since then, a part of the full one."""
    commanded: float = 0.0
    """When it was commanded on, s, if it is."""


Circuit = Callable[[bool, float], tuple[float, float]]
"""Of a coil that is on or off, with its resistance over that at 20 °C: the current to which it
tends at full voltage, a part of the full one, and its time constant, s."""


@dataclass(frozen=True, slots=True)
class Current:
    """A current over time, a part of the full one, exactly: an exponential after each switching."""

    begins: NDArray[np.float64]
    """When each piece begins, s, shape (n,), n >= 1."""
    starts: NDArray[np.float64]
    """The current then."""
    on: NDArray[np.bool_]
    """Whether it is switched on from then on, or off."""
    levels: NDArray[np.float64]
    """The voltage across it while it is on, a part of the full one."""
    targets: NDArray[np.float64]
    """The current to which it tends."""
    constants: NDArray[np.float64]
    """Its time constant, s."""
    warmings: NDArray[np.float64]
    """The warming of the coil then, K; 0 where its temperature is not simulated."""
    heat: Heat | None

    @classmethod
    def of(
        cls,
        begins: NDArray[np.float64],
        on: NDArray[np.bool_],
        before: CoilState,
        circuit: Circuit,
        heat: Heat | None = None,
        levels: NDArray[np.float64] | None = None,
    ) -> Current:
        """The current of a coil that is switched at `begins`, the first of them the last before.

        `levels` are the voltages across it while it is on, parts of the full one: 1 unless given.
        """
        levels = np.ones(len(on)) if levels is None else levels
        lasts = [*np.diff(begins).tolist(), 0.0]
        current, warming = float(before.current), before.warming
        pieces = []
        for rises, level, each in zip(on.tolist(), levels.tolist(), lasts, strict=True):
            target, constant = circuit(rises, 1.0 if heat is None else heat.resistance(warming))
            target *= level
            pieces.append((current, target, constant, warming))
            if heat is not None:
                warming = heat.after(warming, current, target, constant, each)
            current = current_after(current, target, each / constant)
        starts, targets, constants, warmings = np.array(pieces).T
        return cls(begins, starts, on, levels, targets, constants, warmings, heat)

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The current at time t (s), any shape; before its begin what it begins with."""
        times = np.asarray(t, np.float64)
        i = self._piece(times)
        left = np.exp(-np.maximum(times - self.begins[i], 0.0) / self.constants[i])
        target = self.targets[i]
        value = np.where(
            target == 1.0,  # to the bit 1 where it is reached
            1.0 - (1.0 - self.starts[i]) * left,
            target + (self.starts[i] - target) * left,
        )
        return float(value) if value.ndim == 0 else value

    def warming(self, t: ArrayLike) -> NDArray[np.float64]:
        """The warming of the coil at times t (s, shape (n,)), K; it is simulated."""
        assert self.heat is not None
        times = np.asarray(t, np.float64)
        i = self._piece(times)
        since = np.maximum(times - self.begins[i], 0.0)
        columns = (self.warmings[i], self.starts[i], self.targets[i], self.constants[i], since)
        return np.array([self.heat.after(*row) for row in zip(*columns, strict=True)])

    def _piece(self, times: NDArray[np.float64]) -> NDArray[np.int64]:
        return np.maximum(np.searchsorted(self.begins, times, "right") - 1, 0)


@dataclass(frozen=True, slots=True)
class Pulses:
    """Pulse-width modulation: while it is on, a coil is on for a part of each period.

    The periods begin at the multiples of 1/frequency on the path's clock, for all coils.
    """

    frequency: float
    """Hz."""
    duty: float
    """The part, above 0 and below 1."""

    def switchings(
        self, commands: Commands, begin: float, end: float
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """When a coil is switched from `begin` until before `end` (s), and whether on.

        Raises:
            ValueError: there would be too many.
        """
        spans = np.array(commands.spans(begin, end)).reshape(-1, 2)
        count = float(np.diff(spans).sum()) * self.frequency * 2.0
        budgets.SWITCHINGS.check(count, f"one coil, pulses at {self.frequency:g} Hz")
        edges: list[NDArray[np.float64]] = [np.zeros((0, 2))]
        for first, last in spans.tolist():
            k = np.arange(floor(first * self.frequency), ceil(last * self.frequency) + 1)
            rises = np.maximum(k / self.frequency, first)
            falls = np.minimum((k + self.duty) / self.frequency, last)
            edges.append(np.stack([rises, falls], axis=1)[falls > rises])
        times = np.concatenate(edges).ravel()
        on = np.arange(times.size) % 2 == 0
        return times[times < end], on[times < end]

    def steady(self, rise_constant: float, fall_constant: float) -> tuple[float, float]:
        """The least and the largest current in the end, parts of the full one."""
        rises = exp(-self.duty / (self.frequency * rise_constant))
        falls = exp(-(1.0 - self.duty) / (self.frequency * fall_constant))
        most = (1.0 - rises) / (1.0 - rises * falls)
        return most * falls, most

    def mean_square(self, rise_constant: float, fall_constant: float) -> float:
        """The mean of the square of the current in the end, of the full one's square."""
        low, high = self.steady(rise_constant, fall_constant)
        on, off = self.duty / self.frequency, (1.0 - self.duty) / self.frequency
        gap = 1.0 - low  # c = 1 - gap exp(-t/τ) while it is on
        part, square = (
            -constant * expm1(-on / constant) for constant in (rise_constant, 0.5 * rise_constant)
        )
        falls = -0.5 * fall_constant * expm1(-2.0 * off / fall_constant)
        return (on - 2.0 * gap * part + gap**2 * square + high**2 * falls) * self.frequency


@dataclass(frozen=True, slots=True)
class VoltageSteps:
    """A voltage over the time since a coil was switched on; each holds until the next."""

    times: tuple[float, ...]
    """s, increasing, the first 0."""
    levels: tuple[float, ...]
    """Parts of the full voltage, from 0 to 1."""

    def switchings(
        self, commands: Commands, before: CoilState, begin: float, end: float
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float64]]:
        """When a coil is switched until before `end` (s), whether on, and to which level."""
        spans = commanded_spans(commands, before, begin, end)
        rows: list[tuple[float, bool, float]] = []
        for first, last in spans:
            rows += [
                (first + t, True, level)
                for t, level in zip(self.times, self.levels, strict=True)
                if first + t < last
            ]
            rows.append((last, False, 1.0))
            budgets.SWITCHINGS.check(len(rows), "one coil")
        rows = [row for row in rows if row[0] < end]
        times, on, levels = zip(*rows, strict=True) if rows else ((), (), ())
        return np.array(times, np.float64), np.array(on, np.bool_), np.array(levels, np.float64)


def commanded_spans(
    commands: Commands, before: CoilState, begin: float, end: float
) -> list[tuple[float, float]]:
    """From when to when (s) a coil is commanded on; of one that was on before, since then."""
    spans = commands.spans(begin, end)
    if spans and spans[0][0] == begin and commands.at_first:
        spans[0] = before.commanded, spans[0][1]
    return spans


def current_after(start: float, target: float, constants: float) -> float:
    """A current that tends to `target`, so many time constants later."""
    left = exp(-constants)
    return 1.0 - (1.0 - start) * left if target == 1.0 else target + (start - target) * left


@dataclass(frozen=True, slots=True)
class Commands:
    """On and off of one coil over time."""

    times: NDArray[np.float64]
    """When it is switched, s, shape (n,), increasing."""
    at_first: bool = False
    """Whether it is on before the first."""

    def on(self, t: ArrayLike) -> NDArray[np.bool_]:
        """Whether it is on at time t (s), any shape; at a switching, as switched."""
        count = np.searchsorted(self.times, np.asarray(t, np.float64), "right")
        on: NDArray[np.bool_] = (count % 2 == 1) ^ self.at_first
        return on

    def spans(self, begin: float, end: float) -> list[tuple[float, float]]:
        """From when to when (s) it is on between two times."""
        inside = self.times[(self.times > begin) & (self.times < end)].tolist()
        edges = [begin, *inside] if self.on(begin) else inside
        return list(zip(edges[::2], [*edges[1::2], end], strict=False))

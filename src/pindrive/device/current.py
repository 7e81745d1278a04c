"""The flux linkage and current of a coil over time: exponentials between switchings.

Both are parts of what they are at full current with the closed gap, so that they are the same
number while the gap is closed. The flux linkage is continuous; the current jumps as the gap closes.
The core follows the coil (include/pindrive/device/coil.hpp).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log, log1p
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.device.closing import Closing
from pindrive.device.heating import Heat
from pindrive.quantities import budgets

Numbers = tuple[list[float], list[tuple[float, float]]]
"""An electromagnet as the core has it: numbers, and rows (time, level) of its voltage."""


@dataclass(frozen=True, slots=True)
class CoilState:
    """All there is to know of a coil: its last change of voltage, gap or resistance."""

    since: float = 0.0
    """Time of that change, s."""
    on: bool = False
    """True if on since then."""
    flux: float = 0.0
    """The flux linkage then, a part of that of the full current."""
    warming: float = 0.0
    """Temperature of the coil above 20 °C at that time, K."""
    level: float = 1.0
    """The voltage across it while it is on since then, a part of the full one."""
    commanded: float = 0.0
    """Time of the command to switch on, s, if commanded."""

    def numbers(self, command: bool) -> tuple[float, float, float, float, float, bool, bool]:
        """Return the state as the core has it, with the command in force."""
        flux, warming, level, commanded = self.flux, self.warming, self.level, self.commanded
        return self.since, flux, warming, level, commanded, self.on, command

    @classmethod
    def of(cls, numbers: tuple[Any, ...]) -> CoilState:
        """Return a state of the core."""
        since, flux, warming, level, commanded, on, _ = numbers
        return cls(since, on, flux, warming, level, commanded)


@dataclass(frozen=True, slots=True)
class Current:
    """A current over time, a part of the full one, exactly.

    A piece begins at each switching, where the gap closes or opens, and where the resistance of a
    warming coil has changed by half a thousandth; in each the flux linkage is an exponential.
    """

    begins: NDArray[np.float64]
    """Begin of each piece, s, shape (n,), n >= 1."""
    starts: NDArray[np.float64]
    """The flux linkage then, a part of that of the full current."""
    on: NDArray[np.bool_]
    """True for pieces with the coil switched on."""
    levels: NDArray[np.float64]
    """The voltage across it while it is on, a part of the full one."""
    targets: NDArray[np.float64]
    """The flux linkage to which it tends."""
    constants: NDArray[np.float64]
    """Its time constant, s."""
    inductances: NDArray[np.float64]
    """The inductance over that with the closed gap."""
    warmings: NDArray[np.float64]
    """The warming of the coil then, K; 0 where its temperature is not simulated."""
    resistances: NDArray[np.float64]
    """The resistance of the winding in each piece over that at 20 °C."""
    heat: Heat | None
    pulls: list[Any]
    """Pieces of the pull, as `pindrive.Function` has them: begin, polynomial, terms; N."""
    state: CoilState
    """State at the last change."""

    @classmethod
    def of(cls, course: tuple[Any, ...], heat: Heat | None) -> Current:
        """Return the current of a course of the core."""
        pieces, pulls, end = course
        on = pieces.pop("on").view(np.bool_)
        whole = [(begin, (*constant, *4 * (0.0,)), terms) for begin, constant, terms in pulls]
        return cls(**pieces, on=on, heat=heat, pulls=whole, state=CoilState.of(end))

    @classmethod
    def under(
        cls,
        magnet: Numbers,
        state: tuple[float, float, float, float, float, bool, bool],
        switchings: NDArray[np.float64],
        begin: float,
        end: float,
        heat: Heat | None = None,
    ) -> Current:
        """Return the current of a coil whose command changes at `switchings`, from a state on.

        Args:
            magnet: The electromagnet.
            state: State of the coil, with the command in force.
            switchings: Times, s, shape (n,), increasing.
            begin: Begin of the pull, s.
            end: Last time, s; later switchings are ignored.
            heat: Heating of the coil, if its temperature is simulated.

        Raises:
            ValueError: The number of pieces exceeds its budget.
        """
        most = int(budgets.SWITCHINGS.most) + 1
        found = cls.of(_core.coil_course(magnet, state, switchings, begin, end, most), heat)
        budgets.SWITCHINGS.check(len(found.begins) - 1, "one coil")
        return found

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The current at time t (s), any shape; before its begin what it begins with."""
        value = self._flux(t) / self.inductances[self._piece(np.asarray(t, np.float64))]
        return float(value) if value.ndim == 0 else value

    @overload
    def flux(self, t: float) -> float: ...
    @overload
    def flux(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def flux(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The flux linkage at time t (s), any shape, a part of that of the full current."""
        value = self._flux(t)
        return float(value) if value.ndim == 0 else value

    def _flux(self, t: ArrayLike) -> NDArray[np.float64]:
        times = np.asarray(t, np.float64)
        i = self._piece(times)
        left = np.exp(-np.maximum(times - self.begins[i], 0.0) / self.constants[i])
        target = self.targets[i]
        return np.where(
            target == 1.0,  # exactly 1 where it is reached
            1.0 - (1.0 - self.starts[i]) * left,
            target + (self.starts[i] - target) * left,
        )

    def pull(self, t: ArrayLike) -> NDArray[np.float64]:
        """The pull at times t (s, any shape), N; before its begin what it begins with."""
        times = np.asarray(t, np.float64)
        return _core.function_at(self.pulls, times.ravel()).reshape(times.shape)

    def warming(self, t: ArrayLike) -> NDArray[np.float64]:
        """The warming of the coil at times t (s, shape (n,)), K; it is simulated."""
        assert self.heat is not None
        times = np.asarray(t, np.float64)
        i = self._piece(times)
        starts, targets = (part[i] / self.inductances[i] for part in (self.starts, self.targets))
        return self.heat.after(
            np.maximum(times - self.begins[i], 0.0),
            warming=self.warmings[i],
            start=starts,
            target=targets,
            constant=self.constants[i],
            resistance=self.resistances[i],
        )

    def mean_square(self, end: float) -> float:
        """The mean of the current's square from its begin to `end` (s), a part."""
        begins = self.begins[self.begins < end]
        lasts, among = np.diff(np.append(begins, end)), slice(len(begins))
        constants, inductances = self.constants[among], self.inductances[among]
        target = self.targets[among] / inductances
        swing = self.starts[among] / inductances - target  # c = target + swing exp(-t/τ)
        once = -constants * np.expm1(-lasts / constants)
        twice = -0.5 * constants * np.expm1(-2.0 * lasts / constants)
        parts = target**2 * lasts + 2.0 * target * swing * once + swing**2 * twice
        return float(parts.sum() / (end - begins[0]))

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

    def steady(
        self, rise_constant: float, fall_constant: float, closing: Closing
    ) -> tuple[float, float]:
        """The least and the largest flux linkage in the end, from none at first, parts.

        The flux linkage a period later is a growing function of it, so that from none it comes to
        the least value that returns. The gap stays open there, or closes and opens in each period,
        or stays closed, looked for in this order. At closing and opening that function is convex,
        so that Newton's iteration from below comes to its least value without a step beyond.
        """
        on, off = self.duty / self.frequency, (1.0 - self.duty) / self.frequency
        edge, q = closing.flux, closing.inductance

        def swing(part: float) -> tuple[float, float]:
            rises = exp(-self.duty / (self.frequency * rise_constant * part))
            falls = exp(-(1.0 - self.duty) / (self.frequency * fall_constant * part))
            most = part * ((1.0 - rises) / (1.0 - rises * falls))
            return most * falls, most

        low, high = swing(q)
        if high <= edge:
            return low, high
        while low < edge:
            opened = q * rise_constant * log1p((edge - low) / (q - edge))
            high = 1.0 - (1.0 - edge) * exp(-(on - opened) / rise_constant)
            closed = fall_constant * log(high / edge)
            if closed >= off:
                break
            exponent = (on - opened) / rise_constant + opened / (q * rise_constant)
            exponent += closed / fall_constant + (off - closed) / (q * fall_constant)
            slope = exp(-exponent) * (1.0 - edge) / (q - edge)
            short = edge * exp(-(off - closed) / (q * fall_constant)) - low
            if slope >= 1.0 and short > 0.0:
                break
            following = low + short / (1.0 - slope)
            if short <= 0.0 or following <= low:
                return low, high
            low = following
        return swing(1.0)


@dataclass(frozen=True, slots=True)
class VoltageSteps:
    """A voltage over the time since a coil was switched on; each holds until the next."""

    times: tuple[float, ...]
    """s, increasing, the first 0."""
    levels: tuple[float, ...]
    """Parts of the full voltage, from 0 to 1."""

    @classmethod
    def of(cls, rows: Sequence[tuple[float, float]], full: float) -> VoltageSteps:
        """Rows (time since it was switched on in s, V) as parts of a full voltage (V)."""
        times, volts_ = zip(*rows, strict=True)
        return cls(times, tuple(volts / full for volts in volts_))


@dataclass(frozen=True, slots=True)
class Commands:
    """On and off of one coil over time."""

    times: NDArray[np.float64]
    """Times of the switchings, s, shape (n,), increasing."""
    at_first: bool = False
    """True if on before the first switching."""

    def on(self, t: ArrayLike) -> NDArray[np.bool_]:
        """Return True if on at time t (s), any shape; at a switching, the state after."""
        count = np.searchsorted(self.times, np.asarray(t, np.float64), "right")
        on: NDArray[np.bool_] = (count % 2 == 1) ^ self.at_first
        return on

    def spans(self, begin: float, end: float) -> list[tuple[float, float]]:
        """From when to when (s) it is on between two times."""
        inside = self.times[(self.times > begin) & (self.times < end)].tolist()
        edges = [begin, *inside] if self.on(begin) else inside
        return list(zip(edges[::2], [*edges[1::2], end], strict=False))

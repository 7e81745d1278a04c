"""Control block and coil of a scan in Python: the reference of include/pindrive/device.

Commands from samples, the flux of the coil piece by piece with the resistance of the begin of each,
and the pull as rows, as the package had them before its device layer was written in C++.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import ceil, exp, expm1, floor, inf, log, log1p, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive.device import CoilState, Commands, ControlBlock, Electromagnet
from pindrive.device.closing import Closing
from pindrive.device.controller import Decision
from pindrive.device.current import Pulses, VoltageSteps
from pindrive.device.heating import Heat

AT_ONCE = 0.01
COPPER_RISE = 3.93e-3
Circuit = Callable[[bool, float], tuple[float, float]]


def heat_resistance(warming: float) -> float:
    """The resistance at a warming (K) over that at 20 °C."""
    return 1.0 + COPPER_RISE * warming


def heat_after(
    heat: Heat, warming: float, start: float, target: float, constant: float, lasts: float
) -> float:
    """The warming a time later, K."""
    cooling = 1.0 / (heat.thermal_resistance * heat.heat_capacity)
    swing, found = start - target, warming * exp(-cooling * lasts)
    heating = heat.power * heat_resistance(warming) / heat.heat_capacity
    for share, rate in (
        (target**2, 0.0),
        (2.0 * target * swing, 1.0 / constant),
        (swing**2, 2.0 / constant),
    ):
        apart = abs(cooling - rate) * lasts
        mean = -expm1(-apart) / apart if apart else 1.0
        found += heating * share * lasts * exp(-min(rate, cooling) * lasts) * mean
    return found


def closing_piece(
    closing: Closing, start: float, target: float, constant: float
) -> tuple[float, float, float, float]:
    """Return the continuation of the flux linkage from `start` at constant voltage."""
    # Just where it closes or opens, the flux's way tells.
    closed = start > closing.flux or (start == closing.flux and target > closing.flux)
    inductance = 1.0 if closed else closing.inductance
    target, constant, lasts = target * inductance, constant * inductance, inf
    if start > closing.flux > target if closed else start < closing.flux < target:
        lasts = constant * log1p((start - closing.flux) / (closing.flux - target))
    return target, constant, inductance, lasts


def decide(
    control: ControlBlock,
    luminance: NDArray[np.float64],
    sample_times: NDArray[np.float64],
    end: float,
    before: Decision | None = None,
) -> tuple[Commands, Decision]:
    """The commands that one spot's luminance leads to."""
    before = before or Decision()
    dark = luminance < control.threshold - 0.5 * control.hysteresis
    light = luminance > control.threshold + 0.5 * control.hysteresis
    decided = np.flatnonzero(dark | light)
    on = np.concatenate([[before.on], dark[decided]])
    changes = decided[on[1:] != on[:-1]]
    due = np.concatenate([before.pending, sample_times[changes] + control.latency])
    times = due[due < end]
    switched = before.switched ^ (len(times) % 2 == 1)
    after = Decision(bool(on[-1]), switched, tuple(due[due >= end].tolist()))
    return Commands(times, before.switched), after


def pulse_switchings(
    pulses: Pulses, commands: Commands, before: CoilState, begin: float, end: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the switchings of a coil in [begin, end) (s), with their directions."""
    spans = np.array(commands.spans(begin, end)).reshape(-1, 2)
    edges: list[NDArray[np.float64]] = [np.zeros((0, 2))]
    for first, last in spans.tolist():
        k = np.arange(floor(first * pulses.frequency), ceil(last * pulses.frequency) + 1)
        rises = np.maximum(k / pulses.frequency, first)
        falls = np.minimum((k + pulses.duty) / pulses.frequency, last)
        edges.append(np.stack([rises, falls], axis=1)[falls > rises])
    times = np.concatenate(edges).ravel()
    on = np.arange(times.size) % 2 == 0
    times, on = times[times < end], on[times < end]
    if not before.on:
        return times, on
    if times[:1] == begin:  # a pulse that continues is no switching
        return times[1:], on[1:]
    return np.concatenate([[begin], times]), np.concatenate([[False], on])  # the piece ends there


def step_switchings(
    steps: VoltageSteps, commands: Commands, before: CoilState, begin: float, end: float
) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float64]]:
    """Return the switchings of a coil before `end` (s), with direction and level."""
    spans = commanded_spans(commands, before, begin, end)
    rows: list[tuple[float, bool, float]] = []
    if before.on and not commands.on(begin):  # switched off right there
        rows.append((begin, False, 1.0))
    for first, last in spans:
        rows += [
            (first + t, True, level)
            for t, level in zip(steps.times, steps.levels, strict=True)
            if first + t < last
        ]
        rows.append((last, False, 1.0))
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
    """Return a flux linkage that tends to `target`, a number of time constants later."""
    left = exp(-constants)
    return 1.0 - (1.0 - start) * left if target == 1.0 else target + (start - target) * left


@dataclass(frozen=True, slots=True)
class Course:
    """A flux linkage over time, piece by piece, as `pindrive.device.current.Current`."""

    begins: NDArray[np.float64]
    starts: NDArray[np.float64]
    on: NDArray[np.bool_]
    levels: NDArray[np.float64]
    targets: NDArray[np.float64]
    constants: NDArray[np.float64]
    inductances: NDArray[np.float64]
    warmings: NDArray[np.float64]
    heat: Heat | None

    @classmethod
    def of(
        cls,
        begins: NDArray[np.float64],
        on: NDArray[np.bool_],
        before: CoilState,
        circuit: Circuit,
        *,
        closing: Closing,
        heat: Heat | None = None,
        levels: NDArray[np.float64] | None = None,
    ) -> Course:
        """Return the current of a coil that is switched at `begins`, the first before the scan.

        `levels` are the voltages across it while it is on, parts of the full one: 1 unless given.
        """
        levels = np.ones(len(on)) if levels is None else levels
        ends = [*begins[1:].tolist(), inf]
        flux, warming = float(before.flux), before.warming
        pieces = []
        for begin, end, rises, level in zip(
            begins.tolist(), ends, on.tolist(), levels.tolist(), strict=True
        ):
            while begin < end:
                target, constant = circuit(rises, 1.0 if heat is None else heat_resistance(warming))
                target, constant, inductance, lasts = closing_piece(
                    closing, flux, target * level, constant
                )
                pieces.append((begin, flux, rises, level, target, constant, inductance, warming))
                crosses = begin + lasts < end
                each = lasts if crosses else end - begin
                if each == inf:
                    break
                if heat is not None:
                    start, final = flux / inductance, target / inductance
                    warming = heat_after(heat, warming, start, final, constant, each)
                flux = closing.flux if crosses else current_after(flux, target, each / constant)
                begin = begin + lasts if crosses else end
        columns = [np.array(each) for each in zip(*pieces, strict=True)]
        begins, starts, on, levels, targets, constants, inductances, warmings = columns
        return cls(begins, starts, on, levels, targets, constants, inductances, warmings, heat)


class ReferenceMagnet:
    """The current and the rows of the pull of an electromagnet."""

    def __init__(self, magnet: Electromagnet) -> None:
        self.magnet = magnet

    def __getattr__(self, name: str) -> Any:
        return getattr(self.magnet, name)

    def current(
        self, commands: Commands, before: CoilState, begin: float = 0.0, end: float = 0.0
    ) -> Course:
        """The current under commands that come after the coil's last switching.

        Args:
            commands: Commands of the control block.
            before: The last switching.
            begin: Time from which the commands hold, s; with pulses or a voltage.
            end: Until when, s; with pulses or a voltage.
        """
        levels = None
        if self.steps is not None:
            times, switched, levels = step_switchings(self.steps, commands, before, begin, end)
        elif self.pulses is not None:
            times, switched = pulse_switchings(self.pulses, commands, before, begin, end)
        else:
            times = commands.times
            switched = commands.on(times)
        new = times > before.since
        levels = None if levels is None else np.concatenate([[before.level], levels[new]])
        begins = np.concatenate([[before.since], times[new]])
        on = np.concatenate([[before.on], switched[new]])
        heat = None if self.coil is None else self.coil.heat
        return Course.of(
            begins, on, before, self._circuit, closing=self.closing, heat=heat, levels=levels
        )

    def _circuit(self, on: bool, resistance: float) -> tuple[float, float]:
        """To which part of the full flux linkage it tends, its gap closed, and how fast (s).

        `resistance` is that of the winding over the one at 20 °C.
        """
        if on:
            return 1.0 / resistance, self.rise_constant / resistance
        if resistance == 1.0:
            return 0.0, self.fall_constant
        assert self.coil  # another has no temperature
        own = self.coil.resistance
        outer = self.coil.release_resistance
        return 0.0, self.fall_constant * (own + outer) / (resistance * own + outer)

    def pull_rows(
        self, current: Course, end: float, first: float | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The pull as rows (time in s, N) from the current's begin to `end`, or a row beyond.

        Linear between them it is nowhere further from the exact one than `deviation` of the hold
        force. No row depends on what comes after it, so that a course that is cut keeps the same
        rows: a switching finds the pull on its line, and a moment later it is exact again.

        Args:
            current: The current.
            end: s, after its begin.
            first: The pull at its begin, N; None: the exact one.

        Raises:
            ValueError: The number of rows exceeds its budget.
        """
        rows, pieces = 0, max(1, int(np.searchsorted(current.begins, end)))
        times: list[NDArray[np.float64]] = []
        pulls: list[NDArray[np.float64]] = []
        stops = [*current.begins[1:pieces].tolist(), end]
        pull = self.pull(float(current.starts[0])) if first is None else first
        for begin, stop, start, target, constant in zip(
            current.begins[:pieces].tolist(),
            stops,
            current.starts[:pieces].tolist(),
            current.targets[:pieces].tolist(),
            current.constants[:pieces].tolist(),
            strict=True,
        ):
            parts, currents = self._rows_after(start, target)
            after = constant * parts
            t = begin + after
            p = np.concatenate([[pull], self.pull(currents)])
            count = int(np.searchsorted(t, stop))
            pull = float(np.interp(stop, t, p))
            last = count + 1 if stop == end else count
            rows += last
            times.append(t[:last])
            pulls.append(p[:last])
        return np.concatenate(times), np.concatenate(pulls)

    def _rows_after(
        self, start: float, target: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the times after a switching, in time constants, and the currents then.

        At the switching, whose current is left out; a moment later; as the current passes its
        levels; and when it has reached its end within the deviation, where it stays.
        """
        if start == target:
            return np.zeros(1), np.zeros(0)
        if target not in (0.0, 1.0):
            return self._rows_between(start, target)
        rises, final = target == 1.0, target
        levels = self._rising if rises else self._falling
        moment = AT_ONCE * self.saturation * self._tolerance
        soon = current_after(start, target, moment)
        due = levels[(levels > soon) if rises else (levels < soon)]
        apart = np.log((1.0 - start) / (1.0 - due)) if rises else np.log(start / due)
        due, apart = due[apart > 2.0 * moment], apart[apart > 2.0 * moment]
        after = np.concatenate([[0.0, moment], apart])
        return np.append(after, after[-1] + 1.0), np.concatenate([[soon], due, [final]])

    def _rows_between(
        self, start: float, target: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the times and currents of a partial switching.

        With c = A + C E, E = exp(−t/τ), the curvature of c² is 4C²E² + 2AC E, at its largest at
        first. A row is due where the iron comes to saturation, or out of it.
        """
        sigma, tolerance = self.saturation, self._tolerance
        swing = start - target
        kink = log(swing / (sigma - target)) if (start > sigma) != (target > sigma) else inf
        due, x = [AT_ONCE * sigma * tolerance], AT_ONCE * sigma * tolerance
        while True:
            left = exp(-x)
            c = target + swing * left
            if x < kink and c >= sigma:  # saturated until then, or forever
                if kink == inf:
                    break
                x = kink
            elif x >= kink and target >= sigma:
                break
            else:
                size = 4.0 * (swing * left) ** 2 + 2.0 * abs(target * swing) * left
                if abs(2.0 * target * swing * left) + (swing * left) ** 2 <= tolerance * sigma**2:
                    break
                step = x + sigma * sqrt(8.0 * tolerance / size)
                x = kink if x < kink <= step else step
            due.append(x)
        after = np.array(due)
        currents = target + swing * np.exp(-after)
        return np.concatenate([[0.0], after, [after[-1] + 1.0]]), np.append(currents, target)

    @property
    def _tolerance(self) -> float:
        """The deviation as a part of the pull that comes and goes, less what a moment takes."""
        part: float = self.deviation * self.hold_force / (self.hold_force - self.residual)
        return (1.0 - 5.0 * AT_ONCE) * part

    @cached_property
    def _rising(self) -> NDArray[np.float64]:
        """Currents at which rows are due as it rises from 0.

        With E = 1 − c = exp(−t/τ) the pull's curvature is 2E (2E − 1) / (σ τ)², whose size at any
        later time is at most that at E or, before E = 1/4, that there, 1/4.
        """

        def curvature(c: float) -> float:
            e = 1.0 - c
            return max(abs(2.0 * e * (2.0 * e - 1.0)), 0.25 if e > 0.25 else 0.0)

        sigma, tolerance = self.saturation, self._tolerance
        levels, c = [0.0], 0.0
        while True:
            if sigma == 1.0 and 1.0 - c * c <= tolerance:
                return np.array(levels)
            c = 1.0 - (1.0 - c) * exp(-sigma * sqrt(8.0 * tolerance / curvature(c)))
            levels.append(min(c, sigma) if sigma < 1.0 else c)
            if sigma < 1.0 and c >= sigma:
                return np.array(levels)

    @cached_property
    def _falling(self) -> NDArray[np.float64]:
        """Currents at which rows are due as it falls from 1, with a curvature of 4c² / (σ τ)²."""
        sigma, tolerance = self.saturation, self._tolerance
        levels = [1.0, sigma] if sigma < 1.0 else [1.0]
        while (levels[-1] / sigma) ** 2 > tolerance:
            c = levels[-1]
            levels.append(c * exp(-sigma * sqrt(2.0 * tolerance) / c))
        return np.array(levels)

"""Control block and coil of a scan in Python: the reference of include/pindrive/device.

Commands from samples, and the flux of the coil piece by piece with the resistance of the begin of
each, as the package had them before its device layer was written in C++.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, exp, expm1, floor, inf, log1p
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive.device import CoilState, Commands, ControlBlock, Electromagnet
from pindrive.device.closing import Closing
from pindrive.device.controller import Decision
from pindrive.device.current import Pulses, VoltageSteps
from pindrive.device.heating import Heat

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
    """The current of an electromagnet."""

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

    def pull_of(self, course: Course, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """The pull at times (s) from the begin of the course on, N."""
        i = np.maximum(np.searchsorted(course.begins, t, "right") - 1, 0)
        after = (t - course.begins[i]) / course.constants[i]
        flux = [
            current_after(*each)
            for each in zip(course.starts[i], course.targets[i], after, strict=True)
        ]
        share = np.minimum((np.array(flux) / self.saturation) ** 2, 1.0)
        pull: NDArray[np.float64] = self.residual + (self.hold_force - self.residual) * share
        return pull

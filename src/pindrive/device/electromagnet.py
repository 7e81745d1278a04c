"""The electromagnet: how it is made; commands to current, current to pull, pull as a load.

The current c, a part of the full one, rises and falls exponentially with L/R. The pull is
P_r + (P_h − P_r) min((c/σ)², 1): it grows with the square of the current until the iron saturates,
and a residual pull stays. In time it is smooth piece by piece, so that rows whose distance h obeys
h²/8 max|P''| <= deviation make a piecewise-linear pull that is never further from it.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from math import exp, log, pi, sqrt
from typing import TYPE_CHECKING, Final, overload

import numpy as np

from pindrive.quantities import budgets
from pindrive.quantities.table import QUANTITIES, check, checked, default, refusal

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from pindrive.device.controller import Commands
    from pindrive.quantities.table import Number, OptionalNumber

MAGNETIC_CONSTANT: Final = 1.25663706127e-6
"""N/A², CODATA 2022."""
COPPER: Final = 1 / 58e6
"""Resistivity of annealed copper at 20 °C, ohm m (IEC 60028)."""


AT_ONCE: Final = 0.01
"""How soon after a switching the pull is exact: when it can have changed by no more than twice this
part of its deviation."""


@checked
class Coil:
    """An electromagnet with two poles on a steel plate, by how it is made.

    Its iron carries any flux without effort up to the saturation field, and no flux leaks: the two
    gaps in series hold the whole magnetomotive force, 2 g B / μ0 = N I.

    Args:
        turns: N, at least 1.
        pole_area: A of one pole, m², greater than 0.
        gap: g under each pole, m, greater than 0.
        wire_diameter: d of the copper, m, greater than 0.
        turn_length: mean length of a turn, m, greater than 0.
        supply_voltage: U while it is on, V, greater than 0.
        release_resistance: what the current dies away through beside its own, ohm, at least 0.
        saturation_field: B_s, T, greater than 0.
        thermal_resistance: R_th, K/W, greater than 0.
        temperature_rise: ΔT allowed, K, greater than 0.

    Raises:
        ValueError: a value is no number or out of its range.

    The formulas are those of magnetic circuits, as in Fitzgerald, Kingsley and Umans, "Electric
    Machinery", chapters 1 and 3.
    """

    turns: Number
    pole_area: Number
    gap: Number
    wire_diameter: Number
    turn_length: Number
    supply_voltage: Number
    release_resistance: Number = default("release_resistance")
    saturation_field: Number = default("saturation_field")
    thermal_resistance: Number = default("thermal_resistance")
    temperature_rise: Number = default("temperature_rise")

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        for name in ("resistance", "inductance", "current", "field", "power"):
            check(f"coil.{name}", getattr(self, name))  # each in range, yet not their quotient

    @property
    def resistance(self) -> float:
        """R = ρ N l / (π d²/4), ohm, at 20 °C."""
        return COPPER * self.turns * self.turn_length / (pi / 4.0 * self.wire_diameter**2)

    @property
    def inductance(self) -> float:
        """L = N B A / I = μ0 N² A / 2g, H, clamped to the plate."""
        return MAGNETIC_CONSTANT * self.turns**2 * self.pole_area / (2.0 * self.gap)

    @property
    def current(self) -> float:
        """Full current I = U / R, A."""
        return self.supply_voltage / self.resistance

    @property
    def field(self) -> float:
        """B = μ0 N I / 2g at full current if the iron did not saturate, T."""
        return MAGNETIC_CONSTANT * self.turns * self.current / (2.0 * self.gap)

    @property
    def saturation(self) -> float:
        """The part of the full current at which the iron saturates, at most 1."""
        return min(1.0, self.saturation_field / self.field)

    @property
    def pull(self) -> float:
        """Two poles' B² A / 2μ0 at full current or saturation, N."""
        return min(self.field, self.saturation_field) ** 2 * self.pole_area / MAGNETIC_CONSTANT

    @property
    def power(self) -> float:
        """U I while it is on, W."""
        return self.supply_voltage * self.current

    @property
    def duty(self) -> float:
        """The part of the time it may be on before it warms by more than is allowed, at most 1."""
        return min(1.0, self.temperature_rise / (self.thermal_resistance * self.power))


COIL: Final = tuple(field.name for field in fields(Coil))
COIL_NEEDS: Final = tuple(name for name in COIL if default(name) is None)
"""What a coil must say."""
DIRECT: Final = ("hold_force", "rise_time", "fall_time", "saturation")
"""What is said instead of a coil."""


def check_one_way(given: set[str], table: str = "") -> None:
    """Refuse a magnet given both by what it does and by how it is made, or by half a coil."""
    made = [name for name in COIL if name in given]
    if not made:
        return
    direct = [name for name in DIRECT if name in given]
    label = f"{table}.{(direct or made)[0]}".removeprefix(".")
    if direct:
        required = f"left out where {made[0]} describes the coil"
        raise ValueError(refusal(label, required, f"both, {direct[0]} and {made[0]}"))
    missing = [name for name in COIL_NEEDS if name not in given]
    if missing:
        needed = ", ".join(f"{name} ({QUANTITIES[name].meaning})" for name in missing)
        given_alone = f"{', '.join(made)} alone"
        raise ValueError(refusal(label, f"given with {needed}", given_alone))


@checked
class Electromagnet:
    """What an electromagnet does to the plate.

    Every number may also be text with a unit, such as "5 ms"; a bare number is SI.

    Args:
        hold_force: P_h, pull at full current, N, greater than 0.
        rise_constant: time constant of the rising current, s, greater than 0.
        fall_constant: of the falling current, s, greater than 0.
        saturation: σ, the part of the full current at which the pull stops growing, in (0, 1].
        residual: P_r, pull that remains without current, N, at least 0 and less than `hold_force`.
        deviation: of the piecewise-linear pull, a part of `hold_force`, in (0, 0.1].
        outer_diameter: of the magnet, a cylinder, m, greater than 0; None: not known.
        height: of it, m, greater than 0; None: not known.
        coil: what it is made from, where known.

    Raises:
        ValueError: a value is no number or out of its range.
    """

    hold_force: Number = default("hold_force")
    rise_constant: Number = default("rise_constant")
    fall_constant: Number = default("fall_constant")
    saturation: Number = default("saturation")
    residual: Number = default("residual")
    deviation: Number = default("deviation")
    outer_diameter: OptionalNumber = default("outer_diameter")
    height: OptionalNumber = default("height")
    coil: Coil | None = None

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        check_residual(self.residual, self.hold_force)
        check_poles(self.coil, self.outer_diameter)

    @classmethod
    def from_times(
        cls,
        *,
        hold_force: float | str = default("hold_force"),
        rise_time: float | str = default("rise_time"),
        fall_time: float | str = default("fall_time"),
        saturation: float | str = default("saturation"),
        residual: float | str = default("residual"),
        deviation: float | str = default("deviation"),
        outer_diameter: float | str | None = default("outer_diameter"),
        height: float | str | None = default("height"),
    ) -> Electromagnet:
        """An electromagnet by how fast its pull comes and goes; the rest as for the class.

        Args:
            hold_force: N.
            rise_time: from switching on until 90 % of the pull beyond the residual, s.
            fall_time: from switching off until 10 % of it, s.
            saturation: a part of the full current.
            residual: N.
            deviation: a part of `hold_force`.
            outer_diameter: m.
            height: m.

        Raises:
            ValueError: as for the class.
        """
        rise, fall = check("rise_time", rise_time), check("fall_time", fall_time)
        sigma = check("saturation", saturation)
        return cls(
            hold_force=hold_force,
            rise_constant=-rise / log(1.0 - sigma * sqrt(0.9)),
            fall_constant=-fall / log(sigma * sqrt(0.1)),
            saturation=sigma,
            residual=residual,
            deviation=deviation,
            outer_diameter=outer_diameter,
            height=height,
        )

    @classmethod
    def from_coil(
        cls,
        coil: Coil,
        *,
        residual: float | str = default("residual"),
        deviation: float | str = default("deviation"),
        outer_diameter: float | str | None = default("outer_diameter"),
        height: float | str | None = default("height"),
    ) -> Electromagnet:
        """An electromagnet by how it is made; the rest as for the class.

        Raises:
            ValueError: as for the class.
        """
        return cls(
            hold_force=coil.pull,
            rise_constant=coil.inductance / coil.resistance,
            fall_constant=coil.inductance / (coil.resistance + coil.release_resistance),
            saturation=coil.saturation,
            residual=residual,
            deviation=deviation,
            outer_diameter=outer_diameter,
            height=height,
            coil=coil,
        )

    @property
    def rise_time(self) -> float:
        """From switching on until 90 % of the pull beyond the residual, s."""
        return -self.rise_constant * log(1.0 - self.saturation * sqrt(0.9))

    @property
    def fall_time(self) -> float:
        """From switching off until 10 % of it, s."""
        return -self.fall_constant * log(self.saturation * sqrt(0.1))

    @overload
    def pull(self, current: float) -> float: ...
    @overload
    def pull(self, current: ArrayLike) -> NDArray[np.float64]: ...
    def pull(self, current: ArrayLike) -> float | NDArray[np.float64]:
        """The pull (N) at a current, a part of the full one in [0, 1], of any shape."""
        share = np.minimum((np.asarray(current, np.float64) / self.saturation) ** 2, 1.0)
        pull = self.residual + (self.hold_force - self.residual) * share
        return float(pull) if pull.ndim == 0 else pull

    def current(self, commands: Commands, before: CoilState) -> Current:
        """The current under commands that come after the coil's last switching."""
        times = commands.times[commands.times > before.since]
        begins = np.concatenate([[before.since], times])
        on = np.concatenate([[before.on], commands.on(times)])
        return Current.of(self, begins, on, before.current)

    def pull_rows(
        self, current: Current, end: float, first: float | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The pull as rows (time in s, N) from the current's begin to `end`, or a row beyond.

        Linear between them it is nowhere further from the exact one than `deviation` of the hold
        force. No row depends on what comes after it, so that a course that is cut keeps the same
        rows: a switching finds the pull on its line, and a moment later it is exact again.

        Args:
            current: the current.
            end: s, after its begin.
            first: the pull at its begin, N; None: the exact one.

        Raises:
            ValueError: there would be too many rows.
        """
        rows = 0
        times: list[NDArray[np.float64]] = []
        pulls: list[NDArray[np.float64]] = []
        stops = [*current.begins[1:].tolist(), end]
        pull = self.pull(float(current.starts[0])) if first is None else first
        for begin, stop, start, rises in zip(
            current.begins.tolist(),
            stops,
            current.starts.tolist(),
            current.on.tolist(),
            strict=True,
        ):
            after, currents = self._rows_after(start, rises)
            t = begin + after
            p = np.concatenate([[pull], self.pull(currents)])
            count = int(np.searchsorted(t, stop))
            pull = float(np.interp(stop, t, p))
            last = count + 1 if stop == end else count
            rows += last
            budgets.INPUT_ROWS.check(rows, f"{len(stops)} switchings of one coil")
            times.append(t[:last])
            pulls.append(p[:last])
        return np.concatenate(times), np.concatenate(pulls)

    def _rows_after(
        self, start: float, rises: bool
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """When rows are due after a switching at the current `start`, s, and the currents then.

        At the switching, whose current is left out; a moment later; as the current passes its
        levels; and when it has reached its end within the deviation, where it stays.
        """
        constant, levels, final = (
            (self.rise_constant, self._rising, 1.0)
            if rises
            else (self.fall_constant, self._falling, 0.0)
        )
        if start == final:
            return np.zeros(1), np.zeros(0)
        moment = AT_ONCE * self.saturation * self._tolerance
        soon = _after(start, rises, moment)
        due = levels[(levels > soon) if rises else (levels < soon)]
        apart = np.log((1.0 - start) / (1.0 - due)) if rises else np.log(start / due)
        due, apart = due[apart > 2.0 * moment], apart[apart > 2.0 * moment]
        after = np.concatenate([[0.0, moment], apart])
        return constant * np.append(after, after[-1] + 1.0), np.concatenate([[soon], due, [final]])

    @property
    def _tolerance(self) -> float:
        """The deviation as a part of the pull that comes and goes, less what a moment takes."""
        part = self.deviation * self.hold_force / (self.hold_force - self.residual)
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


@dataclass(frozen=True, slots=True)
class Current:
    """A current over time, a part of the full one, exactly: an exponential after each switching."""

    begins: NDArray[np.float64]
    """When each piece begins, s, shape (n,), n >= 1."""
    starts: NDArray[np.float64]
    """The current then."""
    on: NDArray[np.bool_]
    """Whether it rises towards 1 from then on, or falls towards 0."""
    constants: NDArray[np.float64]
    """Its time constant, s."""

    @classmethod
    def of(
        cls,
        magnet: Electromagnet,
        begins: NDArray[np.float64],
        on: NDArray[np.bool_],
        start: float,
    ) -> Current:
        """The current of a magnet that is switched at `begins`, from the current `start` on."""
        constants = np.where(on, magnet.rise_constant, magnet.fall_constant)
        starts = [float(start)]
        for lasts, rises, constant in zip(
            np.diff(begins).tolist(), on.tolist(), constants.tolist(), strict=False
        ):
            starts.append(_after(starts[-1], rises, lasts / constant))
        return cls(begins, np.array(starts), on, constants)

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """The current at time t (s), any shape; before its begin what it begins with."""
        times = np.asarray(t, np.float64)
        i = np.maximum(np.searchsorted(self.begins, times, "right") - 1, 0)
        left = np.exp(-np.maximum(times - self.begins[i], 0.0) / self.constants[i])
        start = self.starts[i]
        value = np.where(self.on[i], 1.0 - (1.0 - start) * left, start * left)
        return float(value) if value.ndim == 0 else value


def _after(start: float, rises: bool, constants: float) -> float:
    """A current so many time constants later."""
    left = exp(-constants)
    return 1.0 - (1.0 - start) * left if rises else start * left


def check_residual(residual: float, hold_force: float) -> None:
    """Refuse a residual pull (N) that is not less than the hold force (N)."""
    if residual >= hold_force:
        required = f"less than the hold force, {hold_force!r} N"
        raise ValueError(refusal("residual", required, f"{residual!r} N"))


def check_poles(coil: Coil | None, outer_diameter: float | None) -> None:
    """Refuse two poles whose area is more than the face of the magnet (m) has."""
    if coil is None or outer_diameter is None:
        return
    face = pi / 4.0 * outer_diameter**2
    if 2.0 * coil.pole_area > face:
        required = f"at most half of the magnet's face, {0.5 * face:.4g} m^2, as it has two poles"
        raise ValueError(refusal("pole_area", required, f"{coil.pole_area!r} m^2"))

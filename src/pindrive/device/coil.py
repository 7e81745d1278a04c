"""Coil of an electromagnet, and derived currents, times, fields and power."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Final

from pindrive import _core
from pindrive.device.heating import Heat
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.electromagnet import COIL as ROWS
from pindrive.quantities.electromagnet import MADE, MAGNET
from pindrive.quantities.part import Number, OptionalNumber, Part, checked_by

TABLE: Final = Part(MAGNET + ROWS + MADE)
"""Table of the device file with the keys of a magnet."""
default: Final = TABLE.default


class Winding:
    """Heating of a coil, however it is described."""

    __slots__ = ()

    thermal_resistance: float
    heat_capacity: float | None
    temperature_rise: float

    @property
    def power(self) -> float:
        """Heat while it is on, W."""
        raise NotImplementedError

    @property
    def heat(self) -> Heat | None:
        """Heating and cooling of the coil; None without a heat capacity."""
        if self.heat_capacity is None:
            return None
        return Heat(self.power, self.thermal_resistance, self.heat_capacity)

    @property
    def duty(self) -> float:
        """The part of the time it may be on before it warms by more than is allowed, at most 1."""
        return min(1.0, self.temperature_rise / (self.thermal_resistance * self.power))


@checked_by(TABLE)
class Coil(Winding):
    """An electromagnet with two poles on a steel plate, by how it is made.

    The iron has no reluctance up to the saturation field, and no flux leaks: the two gaps in series
    hold the whole magnetomotive force, 2 g B / μ0 = N I.

    Args:
        turns: N, at least 1.
        pole_area: A of one pole, m², greater than 0.
        gap: G under each pole, closed, m, greater than 0.
        wire_diameter: D of the copper, m, greater than 0.
        turn_length: Mean length of a turn, m, greater than 0.
        supply_voltage: U while it is on, V, greater than 0.
        release_resistance: Resistance of the decaying current beside that of the coil, ohm, at
            least 0.
        saturation_field: B_s, T, greater than 0.
        thermal_resistance: R_th, K/W, greater than 0.
        heat_capacity: C_th, J/K, greater than 0; None: its temperature is not simulated.
        temperature_rise: ΔT allowed, K, greater than 0.
        lift: Additional width of each gap while it is open, m, at least 0; None: the gap stays
            closed.
        closing_force: The pull beyond which the gap is closed, N, greater than 0, with `lift`.

    Raises:
        ValueError: A value is not a number or out of its range, or one of the last two without the
            other.

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
    heat_capacity: OptionalNumber = default("heat_capacity")
    temperature_rise: Number = default("temperature_rise")
    lift: OptionalNumber = default("lift")
    closing_force: OptionalNumber = default("closing_force")

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        refuse(values_of(self) | {"magnet.residual": None}, whole=True)

    @property
    def resistance(self) -> float:
        """R = ρ N l / (π d²/4), ohm, at 20 °C."""
        return self._number("resistance")

    @property
    def inductance(self) -> float:
        """L = N B A / I = μ0 N² A / 2g, H, with the closed gap."""
        return self._number("inductance")

    @property
    def current(self) -> float:
        """Full current I = U / R, A."""
        return self._number("current")

    @property
    def field(self) -> float:
        """B = μ0 N I / 2g at full current if the iron did not saturate, T."""
        return self._number("field")

    @property
    def saturation(self) -> float:
        """The part of the full current at which the iron saturates, at most 1."""
        return self._number("saturation")

    @property
    def pull(self) -> float:
        """Two poles' B² A / 2μ0 at full current or saturation, N."""
        return self._number("pull")

    @property
    def power(self) -> float:
        """U I while it is on, W."""
        return self._number("power")

    def _number(self, name: str) -> float:
        """Return a number of the core (include/pindrive/device/magnet_construction.hpp)."""
        return _core.coil_numbers(values_of(self))[name]


@checked_by(TABLE)
class DataSheet(Winding):
    """An electromagnet by its data sheet: its winding, and its pull at a current.

    Args:
        hold_force: Pull at `hold_current`, N, greater than 0.
        resistance: R of the winding at 20 °C, ohm, greater than 0.
        inductance: L on the plate, H, greater than 0.
        supply_voltage: U while it is on, V, greater than 0.
        hold_current: Current at which the pull is `hold_force`, A, greater than 0; None: the full
            current U / R. The pull grows with the square of the current.
        saturation: The part of the full current above which the pull is constant, in (0, 1].
        release_resistance: Resistance of the decaying current beside R, ohm, at least 0.
        thermal_resistance: R_th, K/W, greater than 0.
        heat_capacity: C_th, J/K, greater than 0; None: its temperature is not simulated.
        temperature_rise: ΔT allowed, K, greater than 0.

    Raises:
        ValueError: A value is not a number or out of its range.
    """

    hold_force: Number
    resistance: Number
    inductance: Number
    supply_voltage: Number
    hold_current: OptionalNumber = default("hold_current")
    saturation: Number = default("saturation")
    release_resistance: Number = default("release_resistance")
    thermal_resistance: Number = default("thermal_resistance")
    heat_capacity: OptionalNumber = default("heat_capacity")
    temperature_rise: Number = default("temperature_rise")

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        refuse(values_of(self) | {"magnet.residual": None}, whole=True)

    @property
    def current(self) -> float:
        """Full current I = U / R, A."""
        return self.supply_voltage / self.resistance

    @property
    def power(self) -> float:
        """U I while it is on, W."""
        return self.supply_voltage * self.current


COIL: Final = tuple(field.name for field in fields(Coil))
SHEET: Final = tuple(field.name for field in fields(DataSheet))
BY_SHEET: Final = ("hold_current", "resistance", "inductance")
"""Keys of a data sheet alone."""
COIL_NEEDS: Final = tuple(field.name for field in fields(Coil) if field.default is MISSING)
"""Mandatory keys of a coil."""


def values_of(coil: Coil | DataSheet) -> dict[str, float]:
    """The given values of a coil by the keys of a device file."""
    names = COIL if isinstance(coil, Coil) else SHEET
    values = {f"magnet.{name}": getattr(coil, name) for name in names}
    return {key: value for key, value in values.items() if value is not None}

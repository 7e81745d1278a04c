"""The electromagnet: how it is made; commands to current, current to pull, pull as a load.

The flux linkage c, a part of that of the full current, rises and falls exponentially with L/R; it
is the current too unless the gap opens (`closing`). The pull is
P_r + (P_h − P_r) min((c/σ)², 1): it grows with the square of the flux until the iron saturates,
and a residual pull stays. Over time it is a constant and two exponentials, piece by piece. The core
follows the coil (include/pindrive/device/electromagnet.hpp).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import inf, log, sqrt
from typing import Final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.device.closing import Closing
from pindrive.device.coil import TABLE, Coil, DataSheet, default, values_of
from pindrive.device.current import (
    CoilState,
    Commands,
    Current,
    Numbers,
    Pulses,
    VoltageSteps,
)
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.part import Number, OptionalNumber, checked_by
from pindrive.quantities.refusal import refusal

DIRECT: Final = ("hold_force", "rise_time", "fall_time", "saturation")
"""Source of the pull without a coil."""
TIMES: Final = ("rise_time", "fall_time")
"""Those that a data sheet gives by its winding."""
_PLACES: Final = {
    "hold_force": 0,
    "residual": 1,
    "saturation": 2,
    "rise_constant": 3,
    "fall_constant": 4,
    "pwm_frequency": 7,
    "pwm_duty": 8,
}
"""Places of the parameters among the numbers of the core."""
_CLOSED: Final = (0.0, 1.0)
"""Flux linkage at which the gap closes, and inductance with the open gap: it stays closed."""
_COLD: Final = 5 * (0.0,)
"""Resistances, power, thermal resistance and heat capacity: the temperature is not simulated."""
_WITH_COIL: Final = ("residual", "pwm_frequency", "pwm_duty")
"""Parameters beside those of a coil."""


@checked_by(TABLE)
class Electromagnet:
    """Electromagnet and its pull on the plate.

    Every number may also be text with a unit, such as "5 ms"; a bare number is SI.

    Args:
        hold_force: P_h, pull at full current, N, greater than 0.
        rise_constant: Time constant of the rising current, s, greater than 0.
        fall_constant: Time constant of the falling current, s, greater than 0.
        saturation: σ, the part of the full current at which the pull stops growing, in (0, 1].
        residual: P_r, pull that remains without current, N, at least 0 and less than `hold_force`.
        pwm_frequency: Frequency of the pulses while the magnet is on, Hz, from 1 to 20000, given
            with `pwm_duty`; None: continuous current.
        pwm_duty: The part of each period for which it is on then, above 0 and at most 1.
        outer_diameter: Diameter of the cylindrical magnet, m, greater than 0; None: unknown.
        height: Height of the magnet, m, greater than 0; None: unknown.
        spring_height: Height above the plate at which the spring pulls on it, m, at least 0; None:
            half of its height.
        pin_height: Height at which the finger rubs on the pin, m, at least 0; None: its height.
        coil: Construction of the magnet or its data sheet, if known.
        steps: The coil's voltage since it was switched on; None: full. Not with pulses.

    Raises:
        ValueError: A value is not a number or out of its range.
    """

    hold_force: Number = default("hold_force")
    rise_constant: Number = default("rise_constant")
    fall_constant: Number = default("fall_constant")
    saturation: Number = default("saturation")
    residual: Number = default("residual")
    pwm_frequency: OptionalNumber = default("pwm_frequency")
    pwm_duty: OptionalNumber = default("pwm_duty")
    outer_diameter: OptionalNumber = default("outer_diameter")
    height: OptionalNumber = default("height")
    spring_height: OptionalNumber = default("spring_height")
    pin_height: OptionalNumber = default("pin_height")
    coil: Coil | DataSheet | None = None
    steps: VoltageSteps | None = None

    def __post_init__(self) -> None:
        """Validate what follows from them."""
        names = ("residual", "pwm_frequency", "pwm_duty", "outer_diameter")
        values = {f"magnet.{name}": getattr(self, name) for name in names}
        known = {key: value for key, value in values.items() if value is not None}
        made = {"magnet.hold_force": self.hold_force} if self.coil is None else values_of(self.coil)
        steps = {} if self.steps is None else {"magnet.voltage": None}
        refuse(known | made | steps, whole=True)

    @classmethod
    def from_times(
        cls,
        *,
        hold_force: float | str = default("hold_force"),
        rise_time: float | str = default("rise_time"),
        fall_time: float | str = default("fall_time"),
        saturation: float | str = default("saturation"),
        residual: float | str = default("residual"),
        pwm_frequency: float | str | None = default("pwm_frequency"),
        pwm_duty: float | str | None = default("pwm_duty"),
        outer_diameter: float | str | None = default("outer_diameter"),
        height: float | str | None = default("height"),
        spring_height: float | str | None = default("spring_height"),
        pin_height: float | str | None = default("pin_height"),
    ) -> Electromagnet:
        """An electromagnet by how fast its pull comes and goes; the rest as for the class.

        Args:
            hold_force: N.
            rise_time: Time from switching on to 90 % of the pull beyond the residual pull, s.
            fall_time: Time from switching off to 10 % of the pull beyond the residual pull, s.
            saturation: A part of the full current.
            residual: N.
            pwm_frequency: Hz.
            pwm_duty: A part of each period.
            outer_diameter: m.
            height: m.
            spring_height: m.
            pin_height: m.

        Raises:
            ValueError: A value is invalid, as for the class.
        """
        rise, fall = TABLE.check("rise_time", rise_time), TABLE.check("fall_time", fall_time)
        sigma = TABLE.check("saturation", saturation)
        return cls(
            hold_force=hold_force,
            rise_constant=-rise / log(1.0 - sigma * sqrt(0.9)),
            fall_constant=-fall / log(sigma * sqrt(0.1)),
            saturation=sigma,
            residual=residual,
            pwm_frequency=pwm_frequency,
            pwm_duty=pwm_duty,
            outer_diameter=outer_diameter,
            height=height,
            spring_height=spring_height,
            pin_height=pin_height,
        )

    @classmethod
    def from_coil(
        cls,
        coil: Coil | DataSheet,
        *,
        residual: float | str = default("residual"),
        pwm_frequency: float | str | None = default("pwm_frequency"),
        pwm_duty: float | str | None = default("pwm_duty"),
        outer_diameter: float | str | None = default("outer_diameter"),
        height: float | str | None = default("height"),
        spring_height: float | str | None = default("spring_height"),
        pin_height: float | str | None = default("pin_height"),
        voltage: Sequence[tuple[float, float]] | None = None,
    ) -> Electromagnet:
        """An electromagnet by how it is made or by its data sheet; the rest as for the class.

        Args:
            coil: Construction of the coil, or its data sheet.
            residual: N.
            pwm_frequency: Hz.
            pwm_duty: A part of each period.
            outer_diameter: m.
            height: m.
            spring_height: m.
            pin_height: m.
            voltage: Rows (time since it was switched on in s, V), from 0 s on, at most the supply
                voltage; each holds until the next.

        Raises:
            ValueError: A value is invalid, as for the class.
        """
        if voltage is not None:
            refuse(values_of(coil) | {"magnet.voltage": tuple(voltage)}, whole=True)
        (hold_force, _, saturation, rise, fall, *_), _ = _core.magnet_numbers(values_of(coil), "")
        return cls(
            hold_force=hold_force,
            rise_constant=rise,
            fall_constant=fall,
            saturation=saturation,
            residual=residual,
            pwm_frequency=pwm_frequency,
            pwm_duty=pwm_duty,
            outer_diameter=outer_diameter,
            height=height,
            spring_height=spring_height,
            pin_height=pin_height,
            coil=coil,
            steps=None if voltage is None else VoltageSteps.of(voltage, coil.supply_voltage),
        )

    @cached_property
    def closing(self) -> Closing:
        """Closing and opening of the gap under its poles; without a lift it stays closed."""
        flux, inductance = self.core_numbers[0][5:7]
        return Closing(flux, inductance)

    @property
    def rise_time(self) -> float:
        """From switching on until 90 % of the pull beyond the residual, s."""
        return self._rises(self.saturation * sqrt(0.9))

    @property
    def fall_time(self) -> float:
        """Time from switching off until 10 % of the pull, s."""
        return self._falls(self.saturation * sqrt(0.1))

    @property
    def closing_time(self) -> float:
        """From switching on at full voltage until its gap closes, s; 0: it is closed before."""
        return self._rises(self.closing.flux)

    @property
    def opening_time(self) -> float:
        """From switching off at full current until its gap opens, s; inf: it does not."""
        return self._falls(self.closing.flux) if self.closing.flux > 0.0 else inf

    def _rises(self, flux: float) -> float:
        """From switching on without flux until that linkage, s."""
        edge, q = self.closing.flux, self.closing.inductance
        closed = self.rise_constant * log((1.0 - max(flux, edge)) / (1.0 - edge))
        return 0.0 - closed - q * self.rise_constant * log(1.0 - min(flux, edge) / q)

    def _falls(self, flux: float) -> float:
        """From switching off at full current until that linkage, s."""
        closed = max(flux, self.closing.flux)
        opened = self.closing.inductance * log(flux / closed)
        return -self.fall_constant * log(closed) - self.fall_constant * opened

    @overload
    def pull(self, flux: float) -> float: ...
    @overload
    def pull(self, flux: ArrayLike) -> NDArray[np.float64]: ...
    def pull(self, flux: ArrayLike) -> float | NDArray[np.float64]:
        """The pull (N) at a flux linkage, a part of that of the full current, of any shape."""
        share = np.minimum((np.asarray(flux, np.float64) / self.saturation) ** 2, 1.0)
        pull = self.residual + (self.hold_force - self.residual) * share
        return float(pull) if pull.ndim == 0 else pull

    @property
    def pulses(self) -> Pulses | None:
        """Pulses while the magnet is on; None: constant voltage."""
        if self.pwm_frequency is None or self.pwm_duty is None or self.pwm_duty == 1.0:
            return None
        return Pulses(self.pwm_frequency, self.pwm_duty)

    @property
    def sustained_flux(self) -> float:
        """The flux linkage that it keeps while it is on: with pulses the least of each period."""
        if self.steps is not None:
            switchings = np.zeros(1)
            off = CoilState().numbers(False)
            return float(Current.under(self._cold, off, switchings, 0.0, inf).targets[-1])
        return 1.0 if self.pulses is None else self._swing(self.pulses)[0]

    @property
    def sustained_pull(self) -> float:
        """The pull then, N."""
        return self.pull(self.sustained_flux)

    @property
    def heating(self) -> float:
        """Heat while it is on over that of the full current: with pulses the mean of its square."""
        if self.steps is not None:
            return self.steps.levels[-1] ** 2
        if self.pulses is None:
            return 1.0
        fall, period = self.pulses.duty / self.pulses.frequency, 1.0 / self.pulses.frequency
        low = CoilState(0.0, True, self._swing(self.pulses)[0]).numbers(True)
        numbers, _ = self._cold
        steady = [*numbers[:7], 0.0, 1.0, *numbers[9:]]  # no pulses: one of them alone
        over = Current.under((steady, []), low, np.array([fall]), 0.0, period)
        return over.mean_square(period)

    def _swing(self, pulses: Pulses) -> tuple[float, float]:
        """The least and the largest flux linkage of a period in the end."""
        return pulses.steady(self.rise_constant, self.fall_constant, self.closing)

    @property
    def core_numbers(self) -> Numbers:
        """The electromagnet as the core has it, in the order of `MagnetParameters`."""
        steps = [] if self.steps is None else zip(self.steps.times, self.steps.levels, strict=True)
        if self.coil is not None:
            numbers, _ = _core.magnet_numbers(self._values, "")
            return numbers, [*steps]
        pulls = (self.hold_force, self.residual, self.saturation)
        constants = (self.rise_constant, self.fall_constant)
        pulses = (0.0, 1.0) if self.pulses is None else (self.pulses.frequency, self.pulses.duty)
        return [*pulls, *constants, *_CLOSED, *pulses, *_COLD], [*steps]

    @property
    def _values(self) -> dict[str, float]:
        """The given values by the keys of a device file, without the size of the magnet."""
        names = tuple(_PLACES) if self.coil is None else _WITH_COIL
        own = {f"magnet.{name}": getattr(self, name) for name in names}
        given = {key: value for key, value in own.items() if value is not None}
        return given if self.coil is None else values_of(self.coil) | given

    def core_derivative(self, key: str) -> tuple[Numbers, float]:
        """Derivative of `core_numbers` by a key of a device file, and the size of its value.

        Raises:
            ValueError: The electromagnet was not given this key.
        """
        values = self._values
        time = key.removeprefix("magnet.").replace("_time", "_constant")
        if self.coil is None and time != key.removeprefix("magnet."):
            if time not in _PLACES:
                raise ValueError(refusal("parameter", f"one of {', '.join(values)}", repr(key)))
            constant, given = getattr(self, time), getattr(self, key.removeprefix("magnet."))
            slopes = [0.0] * len(self.core_numbers[0])
            slopes[_PLACES[time]] = constant / given
            return (slopes, []), given
        if key not in values:
            raise ValueError(refusal("parameter", f"one of {', '.join(values)}", repr(key)))
        numbers, levels = self.core_numbers
        size = abs(values[key]) or self.hold_force
        if self.coil is None:
            place = _PLACES[key.removeprefix("magnet.")]
            slopes = [float(i == place) for i in range(len(numbers))]
            if key == "magnet.saturation":  # at the same times, as in a device file
                rising, falling = self.saturation * sqrt(0.9), self.saturation * sqrt(0.1)
                rises = rising / ((1.0 - rising) * log(1.0 - rising))
                slopes[_PLACES["rise_constant"]] = self.rise_constant * rises / self.saturation
                slopes[_PLACES["fall_constant"]] = -self.fall_constant / (
                    self.saturation * log(falling)
                )
            return (slopes, []), size
        _, slopes = _core.magnet_numbers(values, key)
        # The levels are parts of the supply voltage.
        rate = -1.0 / self.coil.supply_voltage if key == "magnet.supply_voltage" else 0.0
        return (slopes, [(time, rate * level) for time, level in levels]), size

    @property
    def _cold(self) -> Numbers:
        """The electromagnet without its temperature."""
        numbers, steps = self.core_numbers
        return [*numbers[:-1], 0.0], steps

    def current(
        self,
        commands: Commands,
        before: CoilState,
        begin: float | None = None,
        end: float = inf,
    ) -> Current:
        """The current and the pull under commands after the coil's last change, exactly.

        Args:
            commands: Commands of the control block.
            before: The last change.
            begin: Time from which the commands hold, s; None: the time of the last change.
            end: Until when, s; later commands are ignored. Finite with pulses or a temperature.

        Raises:
            ValueError: There are more switchings than the budgets allow.
        """
        if end == inf and (self.pulses or (self.coil and self.coil.heat)):
            raise ValueError(refusal("end", "finite for pulses or a coil that warms", "inf s"))
        begin = before.since if begin is None else begin
        state = before.numbers(commands.at_first)
        heat = None if self.coil is None else self.coil.heat
        return Current.under(self.core_numbers, state, commands.times, begin, end, heat)

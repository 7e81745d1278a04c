"""Heating of a coil: one lump of copper and iron, heated by its current and cooled by air.

The resistance grows with the temperature. It is constant in a piece of the current, which ends
where it has changed by half a thousandth (include/pindrive/device/electromagnet.hpp), so that the
temperature is a closed form in each. With the current c = A + C exp(-t/τ), a part of the full one,

    C_th y' = P r c² - y / R_th,    r = 1 + α y,

where y is the warming above 20 °C and P the power at full current and 20 °C.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Heat:
    """Heating and cooling of a coil."""

    power: float
    """At full current and 20 °C, W."""
    thermal_resistance: float
    """K/W."""
    heat_capacity: float
    """J/K."""

    def after(
        self,
        lasts: NDArray[np.float64],
        *,
        warming: NDArray[np.float64],
        start: NDArray[np.float64],
        target: NDArray[np.float64],
        constant: NDArray[np.float64],
        resistance: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """The warming a time later, K; arrays of one shape.

        Args:
            lasts: Duration, s.
            warming: Initial warming, K.
            start: The current at first, a part of the full one.
            target: Limit of the current.
            constant: Time constant of the current, s.
            resistance: Resistance of the winding over that at 20 °C.
        """
        cooling = 1.0 / (self.thermal_resistance * self.heat_capacity)
        swing, found = start - target, warming * np.exp(-cooling * lasts)
        heating = self.power * resistance / self.heat_capacity
        for share, rate in (
            (target**2, 0.0),
            (2.0 * target * swing, 1.0 / constant),
            (swing**2, 2.0 / constant),
        ):
            apart = np.abs(cooling - rate) * lasts
            mean = np.divide(-np.expm1(-apart), apart, out=np.ones_like(apart), where=apart > 0.0)
            found += heating * share * lasts * np.exp(-np.minimum(rate, cooling) * lasts) * mean
        return np.asarray(found)

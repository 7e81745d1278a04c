"""Heating of a coil: one lump of copper and iron, heated by its current and cooled by air.

The resistance grows with the temperature. Electrical times are so much shorter than thermal ones
that the resistance is taken from one switching to the next as it was at the first of both; the
temperature is then a closed form. With the current c = A + C exp(-t/τ), a part of the full one,

    C_th y' = P r c² - y / R_th,    r = 1 + α y(0),

where y is the warming above 20 °C and P the power at full current and 20 °C.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, expm1
from typing import Final

COPPER_RISE: Final = 3.93e-3
"""Part by which the resistance of annealed copper grows for each kelvin from 20 °C (IEC 60028)."""


@dataclass(frozen=True, slots=True)
class Heat:
    """Heating and cooling of a coil."""

    power: float
    """At full current and 20 °C, W."""
    thermal_resistance: float
    """K/W."""
    heat_capacity: float
    """J/K."""

    @staticmethod
    def resistance(warming: float) -> float:
        """The resistance at a warming (K) over that at 20 °C."""
        return 1.0 + COPPER_RISE * warming

    def after(
        self, warming: float, start: float, target: float, constant: float, lasts: float
    ) -> float:
        """The warming a time later, K.

        Args:
            warming: Initial warming, K.
            start: The current at first, a part of the full one.
            target: Limit of the warming, K.
            constant: Time constant of the warming, s.
            lasts: Duration, s.
        """
        cooling = 1.0 / (self.thermal_resistance * self.heat_capacity)
        swing, found = start - target, warming * exp(-cooling * lasts)
        heating = self.power * self.resistance(warming) / self.heat_capacity
        for share, rate in (
            (target**2, 0.0),
            (2.0 * target * swing, 1.0 / constant),
            (swing**2, 2.0 / constant),
        ):
            apart = abs(cooling - rate) * lasts
            mean = -expm1(-apart) / apart if apart else 1.0
            found += heating * share * lasts * exp(-min(rate, cooling) * lasts) * mean
        return found

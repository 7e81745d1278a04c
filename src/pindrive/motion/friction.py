"""The coefficient of friction that a plate's friction force amounts to, held against handbooks.

Friction is given as a force: where the weight changes and the force does not, the coefficient does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from pindrive.motion.drive import Contact

GRAVITY: Final = 9.80665
"""Standard gravity, m/s²."""
KINETIC: Final = (0.15, 0.30)
"""Steel on steel, handbook tables."""
STATIC: Final = (0.15, 0.78)
"""The same at rest: up to 0.78 where both are clean."""
_SLACK: Final = 1e-9
"""So much beyond a limit is rounding."""


@dataclass(frozen=True, slots=True)
class Coefficients:
    """Friction of a plate over the force that presses on it."""

    kinetic: float
    static: float
    pressing: float
    """That force, N."""
    weighs: bool
    """Whether it is the weight, of no other being given."""

    @classmethod
    def of(cls, plate: Contact, mass: float, pressing: float | None = None) -> Coefficients:
        """Those of a plate.

        Args:
            plate: its friction with the magnet off.
            mass: what stands on it, kg.
            pressing: the force that presses, N; None: the weight.
        """
        force = mass * GRAVITY if pressing is None else pressing
        return cls(plate.kinetic / force, plate.static_friction / force, force, pressing is None)

    @property
    def words(self) -> str:
        """Both, and over which force."""
        over = QUANTITIES["pressing"].text(self.pressing)
        return (
            f"friction coefficient {self.kinetic:.3f}, static {self.static:.3f}: its friction over "
            f"{over} of {'weight' if self.weighs else 'pressing force'}"
        )

    @property
    def doubt(self) -> str | None:
        """What handbooks say to them; None where they agree, or there is no friction."""
        if not self.static:
            return None
        for name, value, range_ in (
            ("kinetic", self.kinetic, KINETIC),
            ("static", self.static, STATIC),
        ):
            if not within(value, range_):
                low, high = range_
                return (
                    f"the plate's {name} friction coefficient is {value:.3g}, outside the "
                    f"{low:.2f} to {high:.2f} of steel on steel in handbooks: plate.{name} over "
                    f"{QUANTITIES['pressing'].text(self.pressing)} of "
                    f"{'weight' if self.weighs else 'magnet.pressing'}"
                )
        return None


def within(value: float, range_: tuple[float, float]) -> bool:
    """Whether a value lies in a range, up to rounding."""
    return range_[0] * (1.0 - _SLACK) <= value <= range_[1] * (1.0 + _SLACK)

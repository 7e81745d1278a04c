"""The coefficient of friction that a plate's friction amounts to, held against handbooks.

If friction is a force, its coefficient changes with the weight.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from pindrive.motion.drive import Drive
from pindrive.quantities.table import QUANTITIES

KINETIC: Final = (0.15, 0.30)
"""Steel on steel, handbook tables."""
STATIC: Final = (0.15, 0.78)
"""Static friction coefficients of handbooks: up to 0.78 for clean surfaces."""
_SLACK: Final = 1e-9
"""So much beyond a limit is rounding."""


@dataclass(frozen=True, slots=True)
class Coefficients:
    """Friction of a plate over the force that presses on it."""

    kinetic: float
    static: float
    normal_force: float
    """That force, N."""
    pressing: str
    """What presses: "weight", "weight, preload and touch"."""
    given: bool
    """True if the friction was given by coefficients, not by forces."""

    @classmethod
    def of(cls, drive: Drive) -> Coefficients:
        """Return the coefficients of the plate of a drive, with the magnet off."""
        plate, force = drive.plate, drive.normal_force
        given = plate.coefficient is not None
        kinetic, static = plate.kinetic / force, plate.static_friction / force
        touched = drive.plate_touch > 0.0
        parts = ["preload"] * (drive.preload > 0.0) + ["touch"] * touched
        pressing = " and ".join(filter(None, [", ".join(["weight", *parts[:-1]]), *parts[-1:]]))
        return cls(kinetic, static, force, pressing, given)

    @property
    def words(self) -> str:
        """Both, and over which force."""
        over = QUANTITIES["normal_force"].text(self.normal_force)
        return (
            f"friction coefficient {self.kinetic:.3f}, static {self.static:.3f}: its friction over "
            f"{over} of {self.pressing}"
        )

    @property
    def doubt(self) -> str | None:
        """Return the contradiction to handbooks; None without one, or without friction."""
        if not self.static:
            return None
        for name, value, range_ in (
            ("kinetic", self.kinetic, KINETIC),
            ("static", self.static, STATIC),
        ):
            if not within(value, range_):
                low, high = range_
                over = QUANTITIES["normal_force"].text(self.normal_force)
                how = "as it is given" if self.given else f"plate.{name} over {over}"
                of = "" if self.given else f" of {self.pressing}"
                shown = next(s for n in range(3, 18) if float(s := f"{value:.{n}g}") not in range_)
                return (
                    f"the plate's {name} friction coefficient is {shown}, outside the "
                    f"{low:.2f} to {high:.2f} of steel on steel in handbooks: {how}{of}"
                )
        return None


def within(value: float, range_: tuple[float, float]) -> bool:
    """Return True if a value lies in a range within rounding."""
    return range_[0] * (1.0 - _SLACK) <= value <= range_[1] * (1.0 + _SLACK)

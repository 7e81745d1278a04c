"""Mechanics of the hand: its mass, the arm that leads it, and the friction of the mouse."""

from __future__ import annotations

from dataclasses import dataclass

from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise


@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class Hand:
    """A hand that gives way to its pins, led along its path by a spring and a damper.

    With the intended path x_d and the force H of the pins, M (x'' - x_d'') + B (x' - x_d') +
    K (x - x_d) = -H. The arm overcomes the kinetic friction of the mouse while it means to slide.

    Args:
        mass: M, hand, arm and mouse without its pins, kg, above 0.
        stiffness: K, N/m, at least 0.
        damping: B, N*s/m, at least 0; with `stiffness` 0 above 0.
        kinetic: Kinetic friction of the mouse on the page, N.
        static: Static friction of the mouse, N, at least `kinetic`; None: the same.

    Raises:
        ValueError: A value is not a number or out of its range, or nothing leads the hand.
    """

    mass: float
    stiffness: float = default("hand.stiffness")
    damping: float = default("hand.damping")
    kinetic: float = default("hand.kinetic")
    static: float | None = None

    def __post_init__(self) -> None:
        """Validate, and keep plain floats."""
        for name in ("mass", "stiffness", "damping", "kinetic", "static"):
            value = getattr(self, name)
            if name != "static" or value is not None:
                checked = check(f"hand.{name}", value)
                object.__setattr__(self, name, checked)
        if self.stiffness == self.damping == 0.0:
            required = "greater than 0 N/m, or hand.damping greater than 0 N*s/m"
            raise ValueError(refusal("hand.stiffness", f"{required}, to lead the hand", "0.0 N/m"))
        if self.static is not None and self.static < self.kinetic:
            required = f"at least hand.kinetic ({self.kinetic!r} N)"
            raise ValueError(refusal("hand.static", required, f"{self.static!r} N"))

    @property
    def core(self) -> list[float]:
        """The numbers as the core has them."""
        static = self.kinetic if self.static is None else self.static
        return [self.mass, self.stiffness, self.damping, self.kinetic, static]

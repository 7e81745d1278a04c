"""Friction as a coefficient: what presses on a contact, and the forces that follow.

At the plate weight, preload and pull press, at the finger the touch. The core knows forces alone:
they are made here, and the pull is a factor on them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

GRAVITY: Final = 9.80665
"""Standard gravity, m/s²."""
PRESSED_BY: Final[dict[str, dict[str, float]]] = {
    "plate": {"mass": GRAVITY, "preload": 1.0},
    "finger": {"touch_force": 1.0},
}
"""Quantities of the normal force on each contact while the magnet is off, with their factors."""
COEFFICIENTS: Final = {
    "kinetic": "coefficient",
    "static": "static_coefficient",
    "curve": "coefficient_curve",
    "breakaway": "breakaway_coefficient",
    "viscous": "viscous_coefficient",
}
"""The coefficient by which each friction force of a contact may be given instead."""
LAW: Final = ("law", "stribeck_velocity", "exponent")
"""Parts of a friction law beside forces or coefficients."""
SKIN: Final = ("stiffness", "damping")
"""Parts of a contact beside its friction."""
FALLING: Final = ("stribeck", "hess-soom")
"""Laws by which friction falls from `breakaway` to `kinetic` as the sliding speed grows."""
COEFFICIENT_OF: Final = {
    f"{contact}.{force}": f"{contact}.{coefficient}"
    for contact in PRESSED_BY
    for force, coefficient in COEFFICIENTS.items()
}
"""Friction coefficients by the names of the forces in the table of quantities."""


def normal_force(contact: str, value: Callable[[str], Any]) -> Any:
    """Return the normal force on a contact while the magnet is off, N.

    Args:
        contact: "plate" or "finger".
        value: The value of a quantity by its name, SI: a number or an array.
    """
    parts = [factor * value(name) for name, factor in PRESSED_BY[contact].items()]
    return sum(parts[1:], parts[0])


def friction_force(name: str, value: Callable[[str], Any]) -> Any:
    """The friction force called "plate.kinetic" or alike that a coefficient amounts to, N.

    Args:
        name: Name of a force, except for a curve.
        value: The value of a quantity by its name, SI: a number or an array.
    """
    return value(COEFFICIENT_OF[name]) * normal_force(name.partition(".")[0], value)

"""Friction as a coefficient: what presses on a contact, and the forces that follow.

At the plate weight, preload, pull and a share of the touch press, at the finger the touch. The core
knows forces alone: they are made here, and the pull is a factor on them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import log
from typing import Any, Final

GRAVITY: Final = 9.80665
"""Standard gravity, m/s²."""
PRESSED_BY: Final[dict[str, tuple[str, ...]]] = {
    "plate": ("mass", "preload", "touch_share", "touch_force"),
    "finger": ("touch_force", "load_exponent", "reference_touch"),
}
"""Quantities of the normal force on each contact while the magnet is off."""
PRESSING: Final = tuple(
    dict.fromkeys(name for parts in PRESSED_BY.values() for name in parts if name != "mass")
)
"""Quantities that are there for their normal force alone."""
OPTIONAL: Final = {"plate": ("touch_force",), "finger": ("reference_touch",)}
"""Quantities of the normal force that may be left out."""
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

Value = Callable[[str], Any]
"""The value of a quantity by its name, SI: a number or an array; None where it is left out."""


def normal_force(contact: str, value: Value) -> Any:
    """Return the normal force by which a coefficient is multiplied while the magnet is off, N.

    At the finger N₀ (N/N₀)ⁿ: the touch force N itself at an exponent n of 1.

    Args:
        contact: "plate" or "finger".
        value: The value of each quantity in `PRESSED_BY`.
    """
    touch = value("touch_force")
    if contact == "plate":
        own = GRAVITY * value("mass") + value("preload")
        return own if touch is None else own + value("touch_share") * touch
    exponent, reference = value("load_exponent"), value("reference_touch")
    if reference is None:
        return touch
    coulomb = exponent == 1.0  # exactly, also at each point of a batch
    return coulomb * touch + (1.0 - coulomb) * reference * (touch / reference) ** exponent


def normal_force_by(contact: str, name: str, value: Value) -> float:
    """The derivative of the normal force on a contact by a quantity of `PRESSED_BY`."""
    touch = value("touch_force") or 0.0
    if contact == "plate":
        share = value("touch_share")
        of_plate = {"mass": GRAVITY, "preload": 1.0, "touch_share": touch, "touch_force": share}
        return float(of_plate[name])
    exponent, reference = value("load_exponent"), value("reference_touch") or touch
    force = normal_force(contact, value)
    by: Mapping[str, float] = {
        "touch_force": exponent * force / touch if touch else float(exponent == 1.0),
        "load_exponent": force * log(touch / reference) if touch else 0.0,
        "reference_touch": (1.0 - exponent) * force / reference if touch else 0.0,
    }
    return float(by[name])


def friction_force(name: str, value: Value) -> Any:
    """The friction force called "plate.kinetic" or alike that a coefficient amounts to, N.

    Args:
        name: Name of a force, except for a curve.
        value: The value of a quantity by its name, SI: a number or an array.
    """
    return value(COEFFICIENT_OF[name]) * normal_force(name.partition(".")[0], value)

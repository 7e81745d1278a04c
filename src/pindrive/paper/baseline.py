"""The drive that stands in for the paper's, which gives no value but three damping factors."""

from __future__ import annotations

from math import sqrt
from typing import Final

from pindrive.quantities.table import QUANTITIES

VALUES: Final = {
    name: QUANTITIES[name].default or 0.0
    for name in (
        "mass",
        "stiffness",
        "damping_ratio",
        "plate.kinetic",
        "finger.kinetic",
        "mouse_velocity",
        "displacement",
    )
}
"""SI, from the table of quantities: what `pindrive init` writes, with its sources."""

MASS, STIFFNESS = VALUES["mass"], VALUES["stiffness"]
CRITICAL: Final = 2 * sqrt(MASS * STIFFNESS)
"""Damping at which it stops oscillating, N·s/m."""

DRIVE: Final = {
    "mass": MASS,
    "stiffness": STIFFNESS,
    "damping": VALUES["damping_ratio"] * CRITICAL,
    "plate_kinetic": VALUES["plate.kinetic"],
    "finger_kinetic": VALUES["finger.kinetic"],
    "mouse_velocity": VALUES["mouse_velocity"],
    "displacement": VALUES["displacement"],
}
"""The same as arguments of `simulate_batch`; static = kinetic friction, as in (1)."""

SOURCES: Final = tuple(
    (
        f"${_symbol}$",
        QUANTITIES[name].written(value),
        QUANTITIES[name].meaning,
        QUANTITIES[name].source,
    )
    for (name, value), _symbol in zip(
        VALUES.items(), ("m", "k", r"\zeta", "F_p", "F_f", "v_p", "x_0"), strict=True
    )
)
"""Symbol (TeX), value, meaning and source of each assumed parameter."""


def stated(*leave_out: str) -> str:
    """The assumed parameters in a line, but those left out."""
    return ", ".join(
        f"{QUANTITIES[name].symbol} = {QUANTITIES[name].written(value)}"
        for name, value in VALUES.items()
        if name not in leave_out
    )

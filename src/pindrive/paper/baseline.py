"""The drive that stands in for the paper's, which gives no value but three damping factors."""

from __future__ import annotations

from math import sqrt
from typing import Final

from pindrive.motion.drive import Contact, Drive
from pindrive.motion.friction import GRAVITY
from pindrive.motion.release import Release
from pindrive.quantities.table import QUANTITIES

FACTORS: Final = (0.04, 0.16, 0.32)
"""The damping factors of Figure 4."""
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

DRIVE: Final = Drive(
    mass=MASS,
    stiffness=STIFFNESS,
    damping_ratio=VALUES["damping_ratio"],
    plate=Contact(VALUES["plate.kinetic"]),
    finger=Contact(VALUES["finger.kinetic"]),
)
"""Static = kinetic friction, as in (1)."""
FINGER_COEFFICIENT: Final = 0.5
"""Friction coefficient of the finger; it determines the touch force of the assumed friction force.
"""
TOUCH_FORCE: Final = VALUES["finger.kinetic"] / FINGER_COEFFICIENT
"""N: the paper's system load."""
PRESSED: Final = Drive(
    mass=MASS,
    stiffness=STIFFNESS,
    damping=DRIVE.damping,
    plate=Contact(coefficient=VALUES["plate.kinetic"] / (MASS * GRAVITY + TOUCH_FORCE)),
    finger=Contact(coefficient=FINGER_COEFFICIENT),
    touch_force=TOUCH_FORCE,
)
"""The drive with friction that follows what presses: the finger loads both contacts."""
HOLD: Final = 12.0
"""The magnet's pull while it holds, as a factor on the plate's friction."""
RELEASE: Final = Release(VALUES["mouse_velocity"], VALUES["displacement"])

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
    """Return the assumed parameters in a line, without the left out ones."""
    return ", ".join(
        f"{QUANTITIES[name].symbol} = {QUANTITIES[name].written(value)}"
        for name, value in VALUES.items()
        if name not in leave_out
    )


def value(argument: str) -> float:
    """The assumed value (SI) of an argument of `simulate_batch`, or of the fall time."""
    by_argument = {name.replace(".", "_"): assumed for name, assumed in VALUES.items()}
    derived = {"damping": DRIVE.damping, "touch_force": TOUCH_FORCE, "fall_time": 0.0}
    return (by_argument | derived)[argument]

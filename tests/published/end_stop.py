"""Impact on an elastic stop."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion

from .case import PUBLISHED, Case, follow, load, printed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("aster-sdnd101")


TRAVEL = 0.1
"""Position of the stop, m: its spring is at rest there, to which a force moves it."""


@cache
def _impact() -> Motion:
    """From the instant of the impact: the mass meets the stop and leaves it by itself."""
    given = GIVEN["parameters"]
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=0.0),
        travel=TRAVEL,
        stop_stiffness=given["stop_stiffness"],
    )
    push = TRAVEL * given["stiffness"]
    start = TRAVEL - given["gap"]
    return follow(drive, displacement=start, velocity=given["velocity"], duration=0.04, force=push)


@cache
def aster() -> Case:
    """Impact of code_aster."""
    motion = _impact()
    (leave,) = motion.events
    leaves = leave.time
    largest = -motion.force("stop", motion.transient.peak_time)
    derived = GIVEN["derived"]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, leaves, 501)
        axes.plot(1e3 * t, -1e-3 * motion.force("stop", t, "left"), label="pindrive")
        peak, contact = float(derived["largest_force"]), float(derived["contact_time"])
        axes.plot([500.0 * contact], [1e-3 * peak], label="closed form, largest force", **PUBLISHED)
        axes.plot(
            [1e3 * contact],
            [0.0],
            label="closed form, end of contact",
            **{**PUBLISHED, "marker": "s"},
        )
        axes.set(xlabel="Time from the impact (ms)", ylabel="Force of the stop (kN)")

    return Case(
        key="aster-sdnd101",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about="100 kg on a spring of 10 kN/m strike an elastic stop of 1 MN/m at 1 m/s.",
        numbers=[
            printed("contact time, s", derived["contact_time"], leaves),
            printed("largest force of the stop, N", derived["largest_force"], largest),
        ],
        draw=draw,
    )

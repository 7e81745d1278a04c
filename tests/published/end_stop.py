"""Impact on an elastic stop."""

from __future__ import annotations

from functools import cache
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from pindrive import Contact, Drive, Motion

from .case import PUBLISHED, Case, follow, load, printed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("aster-sdnd101")


@cache
def _contact() -> Motion:
    """The phase in contact: spring and stop in parallel, from the instant of the impact."""
    given = GIVEN["parameters"]
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"] + given["stop_stiffness"],
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=0.0),
    )
    return follow(drive, velocity=given["velocity"], duration=0.04)


@cache
def aster() -> Case:
    """Impact of code_aster, as far as it goes without a stop."""
    given, motion = GIVEN["parameters"], _contact()
    w = sqrt((given["stiffness"] + given["stop_stiffness"]) / given["mass"])
    leaves = brentq(motion.position, 0.6 * pi / w, 1.4 * pi / w, xtol=1e-16)
    turn = brentq(motion.velocity, 0.1 * pi / w, 0.9 * pi / w, xtol=1e-16)
    largest = given["stop_stiffness"] * motion.position(turn)
    derived = GIVEN["derived"]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, leaves, 501)
        force = given["stop_stiffness"] * motion.position(t)
        axes.plot(1e3 * t, 1e-3 * force, label="pindrive, in contact")
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
        missing=GIVEN["missing"],
    )

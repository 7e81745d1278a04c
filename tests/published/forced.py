"""Harmonic force and Coulomb friction."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import atan2, cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion, harmonic

from .case import Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("den-hartog")
LABEL = {"fc": "white", "ec": "none", "pad": 0.5}


def parts(r: float, f: float) -> tuple[float, float]:
    """V and f U: the response of the spring and that of friction, over P/k."""
    return 1.0 / (1.0 - r * r), f * sin(pi / r) / (r * (1.0 + cos(pi / r)))


def closed_form(r: float, f: float) -> float:
    """Den Hartog's amplitude x_max k/P of the motion without stops."""
    elastic, friction = parts(r, f)
    return sqrt(elastic**2 - friction**2)


def closed_lag(r: float, f: float) -> float:
    """Phase by which that motion lags behind the force, rad."""
    elastic, friction = parts(r, f)
    return atan2(abs(friction / elastic), closed_form(r, f) / elastic)


@cache
def response(r: float, f: float) -> Motion:
    """From rest, under the force P cos ωt, until the motion repeats."""
    given = GIVEN["parameters"]
    force, w = given["force"], r * sqrt(given["stiffness"] / given["mass"])
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=f * force),
    )
    return follow(drive, force=harmonic(0.0, force, w / (2.0 * pi), phase=pi / 2.0))


def amplitude(r: float, f: float) -> float:
    """The amplitude x_max k/P that pindrive finds."""
    given = GIVEN["parameters"]
    return response(r, f).ending.amplitude * float(given["stiffness"] / given["force"])


def lag(r: float, f: float) -> float:
    """The phase, rad, of the last turning point that pindrive finds behind the force."""
    given = GIVEN["parameters"]
    motion = response(r, f)
    turn = motion.events[-1].time
    w = r * sqrt(given["stiffness"] / given["mass"])
    return (w * turn + (0.0 if motion.position(turn) > 0.0 else pi)) % (2.0 * pi)


PAIRS = list(zip(GIVEN["published"]["r"], GIVEN["published"]["f"], strict=True))
"""Ratios of frequency and of friction at which values are compared."""


def draw_over_frequency(
    axes: Axes, formula: Callable[[float, float], float], found: list[float], unit: float
) -> None:
    """Draw a closed form over the ratio of frequencies, and the values found."""
    for f, line in ((0.2, "-"), (0.3, "--"), (0.5, "-."), (0.6, ":")):
        for sides in (np.linspace(0.57, 0.93, 200), np.linspace(1.07, 2.2, 200)):
            values = [formula(float(r), f) / unit for r in sides]
            label = f"closed form, f = {f:g}" if sides[0] < 1.0 else None
            axes.plot(sides, values, line, color="0.35", lw=0.8, label=label)
    axes.plot([r for r, _ in PAIRS], [y / unit for y in found], "o", label="pindrive")
    for (ratio, f), value in zip(PAIRS, found, strict=True):
        axes.annotate(
            f"f = {f:g}", (ratio, value / unit), (6, 5), textcoords="offset points", bbox=LABEL
        )
    axes.set(xlabel="Frequency ratio r")


ABOUT = (
    "A mass on a spring under Coulomb friction F and a harmonic force P cos ωt, in the "
    "steady motion without stops; r = ω/ω₀, f = F/P."
)


@cache
def den_hartog() -> Case:
    """Den Hartog's amplitude of the motion without stops."""
    numbers = [
        Number(
            what=f"amplitude x_max k/P at r = {r:g}, f = {f:g}",
            published=f"{closed_form(r, f):.9f}",
            computed=amplitude(r, f),
            allowed=1e-9 * closed_form(r, f),
            because="1e-9 of the amplitude",
        )
        for r, f in PAIRS
    ]

    def draw(axes: Axes) -> None:
        draw_over_frequency(axes, closed_form, [number.computed for number in numbers], 1.0)
        axes.set(ylabel="Amplitude x_max k/P", ylim=(0.0, 5.0))

    return Case(
        key="den-hartog",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about=ABOUT,
        numbers=numbers,
        draw=draw,
    )


@cache
def den_hartog_lag() -> Case:
    """Den Hartog's phase of the motion without stops."""
    numbers = [
        Number(
            what=f"lag behind the force at r = {r:g}, f = {f:g}, rad",
            published=f"{closed_lag(r, f):.9f}",
            computed=lag(r, f),
            allowed=1e-9,
            because="1e-9 rad",
        )
        for r, f in PAIRS
    ]

    def draw(axes: Axes) -> None:
        draw_over_frequency(axes, closed_lag, [number.computed for number in numbers], pi / 180.0)
        axes.set(ylabel="Lag behind the force, °", ylim=(0.0, 180.0))

    return Case(
        key="den-hartog-lag",
        title=GIVEN["lag_title"],
        source=GIVEN["source"],
        about=ABOUT + " The lag is that of its turning points behind the extrema of the force.",
        numbers=numbers,
        draw=draw,
    )

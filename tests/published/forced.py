"""Harmonic force and Coulomb friction."""

from __future__ import annotations

from functools import cache
from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion, harmonic

from .case import Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("den-hartog")
LABEL = {"fc": "white", "ec": "none", "pad": 0.5}


def closed_form(r: float, f: float) -> float:
    """Den Hartog's amplitude x_max k/P of the motion without stops."""
    friction = f * sin(pi / r) / (r * (1.0 + cos(pi / r)))
    return sqrt((1.0 / (1.0 - r * r)) ** 2 - friction**2)


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


@cache
def den_hartog() -> Case:
    """Den Hartog's motion without stops."""
    pairs = list(zip(GIVEN["published"]["r"], GIVEN["published"]["f"], strict=True))
    numbers = [
        Number(
            what=f"amplitude x_max k/P at r = {r:g}, f = {f:g}",
            published=f"{closed_form(r, f):.9f}",
            computed=amplitude(r, f),
            allowed=1e-9 * closed_form(r, f),
            because="1e-9 of the amplitude",
        )
        for r, f in pairs
    ]

    def draw(axes: Axes) -> None:
        for f, line in ((0.2, "-"), (0.3, "--"), (0.5, "-."), (0.6, ":")):
            for sides in (np.linspace(0.57, 0.93, 200), np.linspace(1.07, 2.2, 200)):
                values = [closed_form(float(r), f) for r in sides]
                label = f"closed form, f = {f:g}" if sides[0] < 1.0 else None
                axes.plot(sides, values, line, color="0.35", lw=0.8, label=label)
        r, y = [r for r, _ in pairs], [number.computed for number in numbers]
        axes.plot(r, y, "o", label="pindrive")
        for (ratio, f), value in zip(pairs, y, strict=True):
            axes.annotate(
                f"f = {f:g}", (ratio, value), (6, 5), textcoords="offset points", bbox=LABEL
            )
        axes.set(xlabel="Frequency ratio r", ylabel="Amplitude x_max k/P", ylim=(0.0, 5.0))

    return Case(
        key="den-hartog",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about="A mass on a spring under Coulomb friction F and a harmonic force P cos ωt, in the "
        "steady motion without stops; r = ω/ω₀, f = F/P.",
        numbers=numbers,
        draw=draw,
    )

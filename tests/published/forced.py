"""Harmonic force and Coulomb friction."""

from __future__ import annotations

from functools import cache
from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion, Profile

from .case import Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("den-hartog")
LABEL = {"fc": "white", "ec": "none", "pad": 0.5}


def closed_form(r: float, f: float) -> float:
    """Den Hartog's amplitude x_max k/P of the motion without stops."""
    friction = f * sin(pi / r) / (r * (1.0 + cos(pi / r)))
    return sqrt((1.0 / (1.0 - r * r)) ** 2 - friction**2)


def forced(
    mass: float, stiffness: float, friction: float, force: float, w: float, rows: int, periods: int
) -> Motion:
    """From rest, under the force P cos wt: the inertia of a mouse that moves at P/(m w) sin wt."""
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=friction),
    )
    count = np.arange(periods * rows + 1)
    t = 2.0 * pi / w * count / rows
    v = force / (mass * w) * np.sin(2.0 * pi * (count % rows) / rows)
    return follow(drive, mouse_velocity=Profile(t.tolist(), v.tolist()), duration=float(t[-1]))


def amplitude(motion: Motion, period: float) -> float:
    """The largest deflection at a turn of the last period, m."""
    end = max(event.time for event in motion.events)
    return max(abs(event.position) for event in motion.events if event.time > end - period)


@cache
def den_hartog_amplitude(r: float, f: float, rows: int) -> float:
    """The amplitude x_max k/P that pindrive finds."""
    given = GIVEN["parameters"]
    force = given["force"]
    motion = forced(given["mass"], given["stiffness"], f * force, force, r, rows, given["periods"])
    return amplitude(motion, 2.0 * pi / r) * float(given["stiffness"] / force)


@cache
def den_hartog() -> Case:
    """Den Hartog's motion without stops."""
    rows = GIVEN["parameters"]["rows_a_period"]
    pairs = list(zip(GIVEN["published"]["r"], GIVEN["published"]["f"], strict=True))
    numbers = [
        Number(
            what=f"amplitude x_max k/P at r = {r:g}, f = {f:g}",
            published=f"{closed_form(r, f):.9f}",
            computed=den_hartog_amplitude(r, f, rows),
            allowed=3.0 * (pi / rows) ** 2 / 3.0 * closed_form(r, f),
            because="three times the relative error (π/n)²/3 of a sine given by n rows a period",
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
        "steady motion without stops; r = ω/ω₀, f = F/P. The force is the inertia of a mouse that "
        f"moves at P/(mω) sin ωt, given as {rows} rows a period, from rest over "
        f"{GIVEN['parameters']['periods']} periods.",
        numbers=numbers,
        draw=draw,
        remarks="A velocity that is linear between the rows has a fundamental smaller by (π/n)²/3; "
        "twice as many rows make the differences four times as small.",
    )

"""A mass that slides on a shaken plane."""

from __future__ import annotations

from functools import cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion, Profile

from .case import DIGITS, PUBLISHED, Case, Number, follow, half_unit, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("aster-sdnd104")
ROWS = {15.0: 8000, 1.5: 8000, 1.01: 20_000, 0.99: 1000}
"""Breakpoints of a period at each amplitude: near 1 only a short part slides."""


def _motion(amplitude: float, stiffness: float) -> Motion:
    given = GIVEN["parameters"]
    drive = Drive(
        mass=given["mass"],
        stiffness=stiffness,
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=given["friction"]),
    )
    rows = ROWS.get(amplitude, 1000)
    t = np.arange(given["to"] * rows + 1) / rows
    v = amplitude / (2.0 * pi) * (np.cos(2.0 * pi * t) - 1.0)
    return follow(drive, mouse_velocity=Profile(t.tolist(), v.tolist()), duration=given["to"])


@cache
def power(amplitude: float, stiffness: float) -> float:
    """Normal force times mean sliding speed, W: the way between turns over the time."""
    given = GIVEN["parameters"]
    motion = _motion(amplitude, stiffness)
    begin, end = given["from"], given["to"]
    turns = [event.time for event in motion.events if begin < event.time < end]
    way = np.abs(np.diff(motion.position(np.array([begin, *turns, end])))).sum()
    return float(given["normal_force"] * way / (end - begin))


@cache
def aster() -> Case:
    """Wear power of code_aster."""
    amplitudes = GIVEN["published"]["amplitude"]
    published = GIVEN["published"]["power"]
    given = GIVEN["parameters"]
    stiffness, own = given["stiffness"], given["stiffness_in_the_source"]
    numbers = [
        Number(
            what=f"wear power at {amplitude:g} m/s², W",
            published=text,
            computed=power(amplitude, stiffness),
            allowed=half_unit(text) if amplitude > 1.0 else 0.0,
            because=DIGITS if amplitude > 1.0 else "friction holds the mass, it must not slide",
        )
        for amplitude, text in zip(amplitudes, published, strict=True)
    ]

    def draw(axes: Axes) -> None:
        a = np.geomspace(1.01, 20.0, 30)
        axes.loglog(a, [power(float(x), stiffness) for x in a], label="pindrive")
        shown = [(a, float(n.published)) for a, n in zip(amplitudes, numbers, strict=True)]
        axes.loglog(*zip(*shown[:-1], strict=True), label="published", **PUBLISHED)
        axes.set(xlabel="Amplitude of the acceleration (m/s²)", ylabel="Wear power (W)")
        axes.annotate("0.99 m/s²: exactly 0", (0.6, 0.1), xycoords="axes fraction")

    return Case(
        key="aster-sdnd104",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about="A mass of 1 kg under a normal force of 10 N lies, with friction coefficient 0.1, "
        "on a "
        "plane that is shaken by an acceleration A sin(2πt). In the plane's frame this is a drive "
        "at rest with the finger's friction and the mouse velocity A/(2π) (cos 2πt - 1) as rows.",
        numbers=numbers,
        draw=draw,
        remarks="The analytical solution has no spring. A drive must have one: "
        f"{stiffness:g} N/m is taken. With the {own:g} N/m that the source needs for its own "
        f"computation the power at 15 m/s² is {power(15.0, own):.5f} W.",
    )

"""Free vibration that Coulomb friction brings to rest."""

from __future__ import annotations

from functools import cache
from math import cos, pi, radians
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion

from .case import PUBLISHED, Case, Number, follow, load, printed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ASTER = load("aster-sdnd100")
RAO = load("rao")


@cache
def _aster() -> Motion:
    given = ASTER["parameters"]
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=given["friction"]),
    )
    return follow(drive, displacement=given["displacement"], velocity=given["velocity"])


@cache
def aster() -> Case:
    """Decay to rest of code_aster."""
    motion, published = _aster(), ASTER["published"]
    component = cos(radians(ASTER["parameters"]["angle_deg"]))
    first, second = published["sdnd100a"]["DY"], published["sdnd100c"]["DX"]
    numbers = [
        printed(
            f"DY at n = {n}, t = nπ/100 s, m", text, component * motion.position(n * pi / 100.0)
        )
        for n, text in enumerate(first, start=1)
    ]
    numbers += [
        printed(
            f"DX of sdnd100c at {t:.4f} s, m",
            text,
            component * motion.position(t),
            deviates=i in ASTER["deviating"]["sdnd100c DX"],
        )
        for i, (t, text) in enumerate(zip(published["sdnd100c"]["times"], second, strict=True))
    ]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, 0.15, 1501)
        axes.plot(1e3 * t, 1e3 * component * motion.position(t), label="pindrive")
        times = [10.0 * n * pi for n in range(1, 5)]
        axes.plot(
            times, [1e3 * float(text) for text in first], label="published, sdnd100a", **PUBLISHED
        )
        later = [1e3 * t for t in published["sdnd100c"]["times"]]
        axes.plot(
            later,
            [1e3 * float(text) for text in second],
            "x",
            color="black",
            label="published, sdnd100c",
        )
        axes.set(xlabel="Time (ms)", ylabel="Displacement component (mm)")

    return Case(
        key="aster-sdnd100",
        title=ASTER["title"],
        source=ASTER["source"],
        about="A mass of 1 kg on a spring of 10 kN/m slides under 1 N of friction, released at "
        "rest "
        "at 0.85 mm. The friction is the finger's, there is no plate.",
        numbers=numbers,
        draw=draw,
        remarks="The second and third values of sdnd100c contradict those of sdnd100a, which are "
        "the same motion at the same turning points; the differences are recorded. The source "
        "computes with a penalty contact, whose own result at the third turn is -1.7665e-4 m.",
    )


@cache
def _rao(coefficient: float) -> Motion:
    given = RAO["free"]
    stiffness = (2.0 * pi * given["cycles"] / given["time"]) ** 2  # of a mass of 1 kg
    drive = Drive(
        mass=1.0,
        stiffness=stiffness,
        damping=0.0,
        plate=Contact(kinetic=0.0),
        finger=Contact(kinetic=coefficient * given["gravity"]),
    )
    return follow(drive, displacement=given["displacement"], velocity=0.0)


@cache
def rao() -> Case:
    """Decay over five cycles of a textbook."""
    given = RAO["free"]
    coefficient = float(given["friction_coefficient"])
    motion = _rao(coefficient)
    reached = motion.position(given["time"])
    other = _rao(coefficient - 5e-5).position(given["time"])

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, given["time"], 1501)
        axes.plot(t, 1e3 * motion.position(t), label="pindrive")
        ends = [1e3 * given["displacement"], 1e3 * float(given["position"])]
        axes.plot([0.0, given["time"]], ends, label="published", **PUBLISHED)
        axes.set(xlabel="Time (s)", ylabel="Displacement (mm)")

    return Case(
        key="rao-decay",
        title="Friction coefficient from measured positions",
        source=RAO["source"],
        about="A block on a spring is released 10 cm from rest; after five cycles in 2 s it is 1 "
        "cm "
        "from there. The book finds a friction coefficient of 0.1132; a drive with that friction "
        "is followed for the 2 s.",
        numbers=[
            Number(
                what="position after 2 s, m",
                published=given["position"],
                computed=reached,
                allowed=abs(other - reached),
                because="half a unit of the last printed digit of the coefficient",
            )
        ],
        draw=draw,
    )

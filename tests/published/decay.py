"""Free vibration that Coulomb friction brings to rest."""

from __future__ import annotations

from functools import cache
from math import cos, pi, radians
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Contact, Drive, Motion

from .case import PUBLISHED, Case, follow, load, printed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ASTER = load("aster-sdnd100")


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

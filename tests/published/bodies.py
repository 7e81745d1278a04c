"""Several bodies: masses that rub or strike each other, and a drive train with three clutches."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from pindrive import Function, Profile, System, SystemMotion, harmonic

from .case import PUBLISHED, Case, Number, load, printed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RUBBED = load("aster-sdnd106")
STRUCK = load("aster-sdnd102")
CLUTCHES = load("msl-coupled-clutches")
SOLVER = (
    "1e-4 rad/s for a velocity, which is ten times the tolerance of the source's solver (1e-6 of "
    "the first velocity), and 1e-5 s for a time"
)


@cache
def _rubbed() -> SystemMotion:
    given = RUBBED["parameters"]
    system = System()
    for name in ("first", "second"):
        system.body(name, given["mass"])
    system.spring("first", "second", stiffness=given["stiffness"])
    system.contact("first", kinetic=given["kinetic"], static=given["static"])
    force = given["force"]
    system.force("second", Profile([0.0, given["until"], given["until"]], [force, force, 0.0]))
    return system.simulate(0.35)


@cache
def rubbed() -> Case:
    """Two masses of code_aster."""
    motion = _rubbed()
    values = RUBBED["published"]
    numbers = [
        printed(
            f"position of the {body} mass at {time} s, m",
            published,
            motion[body].position(float(time)),
            deviates=time == "0.15",
        )
        for body in ("first", "second")
        for time, published in values[body]
    ]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, motion.duration, 701)
        for body in ("first", "second"):
            axes.plot(t, motion[body].position(t), label=f"pindrive, {body} mass")
        points = [(float(t), float(x)) for body in values for t, x in values[body]]
        axes.plot(*zip(*points, strict=True), label="published", **PUBLISHED)
        axes.set(xlabel="Time (s)", ylabel="Position (m)")

    return Case(
        key="aster-sdnd106",
        title=RUBBED["title"],
        source=RUBBED["source"],
        about=(
            "Two masses of 5 kg on a spring of 10 kN/m. 3 kN pull the second one for 0.2 s; the "
            "first one rubs on the ground with 2 kN, and sticks up to 3 kN. It slips at 0.0351 s "
            "and sticks at 0.3149 s."
        ),
        numbers=numbers,
        draw=draw,
        remarks=(
            "At 0.15 s the closed form of the motion, with the slip from (π/2)/√2000 s on, gives "
            "1.353338 and 1.807532 m, as pindrive does: the source printed other digits."
        ),
    )


@cache
def _struck() -> SystemMotion:
    given = STRUCK["parameters"]
    mass, stiffness, frequency = (given[key] for key in ("mass", "stiffness", "frequency"))
    damping = 2.0 * given["damping_ratio"] * sqrt(stiffness * mass)
    omega = 2.0 * pi * frequency
    system = System()
    for name, side in (("one", 1.0), ("other", -1.0)):
        system.body(name, mass, velocity=-side / omega)  # at rest on its support
        support = harmonic(0.0, -side / omega**2, frequency)
        system.spring(name, support, stiffness=stiffness, damping=damping)
    system.stop("one", "other", upper=given["gap"], stiffness=given["stop_stiffness"])
    return system.simulate(1.0)


@cache
def struck() -> Case:
    """Two oscillators of code_aster."""
    motion = _struck()
    values = STRUCK["published"]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, 1.0, 2001)
        axes.plot(t, 1e3 * motion["one"].position(t), label="pindrive")
        points = [(float(t), 1e3 * float(x)) for t, x in values]
        axes.plot(*zip(*points, strict=True), label="published", **PUBLISHED)
        axes.set(xlabel="Time (s)", ylabel="Displacement (mm)", ylim=(-0.7, 1.0))

    return Case(
        key="aster-sdnd102",
        title=STRUCK["title"],
        source=STRUCK["source"],
        about=(
            "Two masses of 25 kg on springs of 10 Hz with 7 % of critical damping, whose supports "
            "are shaken by accelerations of 1 m/s² at 10 Hz against each other. Across a gap of "
            "1 mm the masses strike each other elastically, with 28.8 MN/m."
        ),
        numbers=[
            Number(
                what=f"displacement of the first mass at {time} s, m",
                published=published,
                computed=motion["one"].position(float(time)),
                allowed=STRUCK["allowed"],
                because="3e-5 m, which the source allows",
            )
            for time, published in values
        ],
        draw=draw,
    )


@cache
def _clutches() -> SystemMotion:
    given = CLUTCHES["parameters"]
    system = System()
    for i in range(4):
        system.body(f"J{i + 1}", given["inertia"], velocity=0.0 if i else given["velocity"])
    system.force("J1", harmonic(0.0, given["torque"], given["frequency"]))
    loads: list[Profile | Function] = [harmonic(0.0, 1.0, given["modulated"], pi / 2)]
    loads += [Profile([time, time], [0.0, 1.0]) for time in given["invoked"]]
    for i, pressed in enumerate(loads, start=1):
        system.contact(
            f"J{i + 1}",
            f"J{i}",
            kinetic=given["kinetic"],
            static=given["static"],
            load=pressed,
            name=f"clutch {i}",
        )
    return system.simulate(1.2)


@cache
def clutches() -> Case:
    """Drive train of the Modelica Standard Library."""
    motion = _clutches()
    values = CLUTCHES["published"]
    numbers = []
    for i, published in values["changes"]:
        times = [event.time for event in motion.contact(f"clutch {i}").events]
        nearest = min(times, key=lambda time: abs(time - float(published)))
        numbers.append(
            Number(
                what=f"a change of clutch {i}, s",
                published=published,
                computed=nearest,
                allowed=1e-5,
                because=SOLVER,
            )
        )
    for time, *speeds in values["speeds"]:
        at = [motion[f"J{i}"].velocity(float(time)) for i in (1, 2, 3, 4)]
        found = [at[0], *(ahead - behind for behind, ahead in pairwise(at))]
        words = ["velocity of J1", *(f"slip of clutch {i}" for i in (1, 2, 3))]
        numbers += [
            Number(
                what=f"{what} at {time} s, rad/s",
                published=published,
                computed=computed,
                allowed=1e-4,
                because=SOLVER,
            )
            for what, published, computed in zip(words, speeds, found, strict=True)
            if abs(float(published)) > 1e-6
        ]

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, 1.2, 1201)
        for i in (1, 2, 3, 4):
            axes.plot(t, motion[f"J{i}"].velocity(t), label=f"pindrive, J{i}")
        points = [(float(row[0]), float(row[1])) for row in values["speeds"]]
        axes.plot(*zip(*points, strict=True), label="published, J1", **PUBLISHED)
        axes.set(xlabel="Time (s)", ylabel="Angular velocity (rad/s)")

    return Case(
        key="msl-coupled-clutches",
        title=CLUTCHES["title"],
        source=CLUTCHES["source"],
        about=(
            "Four inertias of 1 kg m² in a row with a clutch between each two; rotations stand for "
            "positions. The first one turns at 10 rad/s under a torque of 10 N m at 5 Hz. Clutch 1 "
            "is pressed with cos(0.4 π t), the others from 0.4 s and 0.9 s on; pressed, each slips "
            "with 10 N m and holds 11 N m."
        ),
        numbers=numbers,
        draw=draw,
        remarks=(
            "While clutch 1 slips, until 0.79 s, the velocity of J1 is 10 + (1 - cos 10πt)/π - "
            "25/π sin 0.4πt rad/s; pindrive has it to 1e-14, the source to 1e-6 of its first value."
        ),
    )

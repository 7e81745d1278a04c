"""Stick-slip on a belt."""

from __future__ import annotations

from functools import cache
from math import atan, pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import solve_ivp

from pindrive import Contact, Drive, Motion

from .case import PUBLISHED, Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GIVEN = load("stick-slip")
FASTEST = 2.0
"""Last row of the friction curve, m/s; the cycle stays below 1 m/s of sliding speed."""


def closed_form() -> tuple[float, float]:
    """Period (s) and amplitude (m) of the cycle with constant kinetic friction."""
    given = GIVEN["parameters"]
    k, v = given["stiffness"], given["velocity"]
    w = sqrt(k / given["mass"])
    gap = given["static"] - given["kinetic"]
    slip = 2.0 / w * (pi - atan(gap / (v * sqrt(k * given["mass"]))))
    return 2.0 * gap / (k * v) + slip, sqrt((v / w) ** 2 + (gap / k) ** 2)


@cache
def _coulomb() -> Motion:
    given = GIVEN["parameters"]
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=0.0,
        plate=Contact(kinetic=given["kinetic"], static=given["static"]),
        finger=Contact(kinetic=0.0),
    )
    return follow(drive, mouse_velocity=given["velocity"])


def falling(u: Any) -> Any:
    """Leine's friction force over sliding speed, N."""
    return 1.0 / (1.0 + 3.0 * u)


@cache
def period(rows: int) -> float:
    """Return the period of the cycle with a falling curve of that number of points, s."""
    given = GIVEN["curve"]["parameters"]
    speeds = np.linspace(0.0, FASTEST, rows)
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=0.0,
        plate=Contact(curve=list(zip(speeds, falling(speeds), strict=True))),
        finger=Contact(kinetic=0.0),
    )
    return follow(drive, mouse_velocity=given["velocity"]).ending.period


@cache
def integrated() -> float:
    """Return the period with the curve itself, integrated from breakaway to the belt's speed.

    The start is a little after the belt's velocity is left, with the first terms of the series.
    """
    given = GIVEN["curve"]["parameters"]
    v, h = given["velocity"], 1e-4
    # x''' = -x' - F'(0) x'' with x'' = 0 at the start: x' falls by -(v/2) h^2 - (v/2) h^3
    rate = -3.0 * falling(0.0) ** 2
    x = 1.0 + v * h - v * h**3 / 6.0 + rate * v * h**4 / 24.0
    dx = v - v * h**2 / 2.0 + rate * v * h**3 / 6.0

    def right(t: float, y: Any) -> list[float]:
        return [y[1], -y[0] + falling(v - y[1])]

    def reaches(t: float, y: Any) -> float:
        return float(y[1] - v)

    setattr(reaches, "terminal", True)  # noqa: B010 - SciPy's way; a function has no such field
    setattr(reaches, "direction", 1.0)  # noqa: B010
    slip = solve_ivp(
        right, (h, 50.0), [x, dx], method="DOP853", rtol=1e-13, atol=1e-14, events=reaches
    )
    return float(slip.t[-1] + (1.0 - slip.y[0][-1]) / v)


@cache
def stick_slip() -> Case:
    """A cycle with a closed form, and one with a friction curve."""
    motion = _coulomb()
    curve = GIVEN["curve"]
    numbers = [
        Number(
            what=what,
            published=f"{exact!r}",
            computed=computed,
            allowed=4e-16 * exact,
            because="two units of rounding",
        )
        for what, exact, computed in zip(
            ("period, s", "amplitude, m"),
            closed_form(),
            (motion.ending.period, motion.ending.amplitude),
            strict=True,
        )
    ]
    rows = curve["rows"][-1]
    step = FASTEST / (rows - 1)
    numbers.append(
        Number(
            what=f"period with F(u) = 1/(1 + 3|u|), {rows} rows, s (no published value: SciPy)",
            published=f"{integrated():.8f}",
            computed=period(rows),
            allowed=18.0 * step**2 / 8.0 * 12.0,
            because="friction is too large by up to F'' h²/8 between rows h apart",
        )
    )

    def draw(axes: Axes) -> None:
        exact, amplitude = closed_form()
        t = np.linspace(0.0, 3.0 * exact, 1501)
        axes.plot(1e3 * t, 1e3 * motion.position(t), label="pindrive")
        middle = GIVEN["parameters"]["kinetic"] / GIVEN["parameters"]["stiffness"]
        for level in (middle - amplitude, middle + amplitude):
            label = "published amplitude" if level > middle else None
            axes.axhline(1e3 * level, color="0.35", ls="--", lw=0.8, label=label)
        slips = GIVEN["parameters"]["static"] / GIVEN["parameters"]["stiffness"]
        first = slips / GIVEN["parameters"]["velocity"]
        at = [1e3 * (first + n * exact) for n in range(3)]
        axes.plot(at, [1e3 * slips] * 3, label="slips, at published periods", **PUBLISHED)
        axes.set(xlabel="Time (ms)", ylabel="Displacement (mm)", ylim=(-1.1, 2.0))

    periods = ", ".join(f"{rows} rows {period(rows):.6f} s" for rows in curve["rows"])
    return Case(
        key="stick-slip",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about="A mass of 10 g on a spring of 100 N/m lies on a belt at 0.1 m/s, with static "
        "friction "
        "50 mN and kinetic friction 20 mN: the plate of a drive without damping.",
        numbers=numbers,
        draw=draw,
        remarks=f"The last row is a case of {curve['source']}: m = k = 1, belt at 0.2 m/s, "
        f"friction "
        f"falling with speed. Its period over the rows of the curve: {periods}.",
        missing=curve["missing"],
    )

"""A friction curve, and a stop in between: a reference result of the Modelica Standard Library."""

from __future__ import annotations

import csv
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from pindrive import Contact, Drive, Motion

from .case import DATA, PUBLISHED, Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

GIVEN = load("msl-friction-stop2")
TOLERANCE = "five times the tolerance of the source's solver, 1e-6"


def friction(u: Any) -> Any:
    """Friction force over sliding speed, N."""
    return 3.0 + u + 5.0 * np.exp(-2.0 * u)


@cache
def motions(rows: int) -> tuple[Motion, Motion]:
    """The motion up to the stop, and the one from there; x is measured from the spring's rest."""
    given = GIVEN["parameters"]
    speeds = np.linspace(0.0, given["fastest"], rows)
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=given["damping"],
        plate=Contact(kinetic=0.0),
        finger=Contact(curve=list(zip(speeds, friction(speeds), strict=True))),
    )
    start = given["position"] - given["rest"]
    return (
        follow(drive, displacement=start, velocity=given["velocity"], duration=0.1),
        follow(drive, displacement=given["stop"] - given["rest"], velocity=0.0),
    )


def reference() -> NDArray[np.float64]:
    """Rows of time (s), position (m) and velocity (m/s), once for each time at the stop."""
    with (DATA / "msl-friction-stop2.csv").open(newline="") as file:
        rows = [[float(row[name]) for name in ("time", "s", "v")] for row in csv.DictReader(file)]
    return np.array(rows)


@cache
def msl() -> Case:
    """Mass, friction curve and stop."""
    given = GIVEN["parameters"]
    before, after = motions(given["rows"])
    stop, rest = GIVEN["published"]["stop_time"], given["rest"]
    allowed = 5.0 * GIVEN["solver_tolerance"]
    table = reference()
    early, late = table[table[:, 0] < stop], table[table[:, 0] > stop]
    arrival = brentq(lambda t: before.position(t) + rest - given["stop"], 0.05, 0.07, xtol=1e-15)
    off = [
        before.position(early[:, 0]) + rest - early[:, 1],
        after.position(late[:, 0] - stop) + rest - late[:, 1],
    ]
    worst = float(np.abs(np.concatenate(off)).max())

    def number(what: str, published: float, computed: float) -> Number:
        return Number(
            what=what,
            published=f"{published:.8f}",
            computed=computed,
            allowed=allowed,
            because=TOLERANCE,
        )

    turns = [event for event in after.events if event.kind in ("cross", "stick")]
    turns = [event for event in turns if event.velocity == 0.0]
    numbers = [number("arrival at the stop, s", stop, arrival)]
    for i, ((t, s), event) in enumerate(
        zip(GIVEN["published"]["turning"], turns, strict=True), start=1
    ):
        what = f"turn {i}" if event.kind == "cross" else f"turn {i}, sticks"
        numbers += [
            number(f"{what}, s", t, stop + event.time),
            number(f"{what}, m", s, rest + event.position),
        ]
    numbers.append(number(f"largest difference at {len(early) + len(late)} times, m", 0.0, worst))

    def draw(axes: Axes) -> None:
        t = np.linspace(0.0, stop, 301)
        (line,) = axes.plot(t, before.position(t) + rest, label="pindrive")
        t = np.linspace(0.0, 1.25 - stop, 1501)
        axes.plot(stop + t, after.position(t) + rest, color=line.get_color())
        axes.plot(table[::6, 0], table[::6, 1], ".", color="0.35", label="reference result")
        at = np.array(GIVEN["published"]["turning"])
        axes.plot(at[:, 0], at[:, 1], label="its turning points", **PUBLISHED)
        axes.axhline(given["stop"], color="0.35", ls="--", lw=0.8, label="stop")
        axes.set(xlabel="Time (s)", ylabel="Position s (m)")

    return Case(
        key="msl-friction-stop2",
        title=GIVEN["title"],
        source=GIVEN["source"],
        about="1 kg on a spring of 500 N/m slides with friction 3 + |u| + 5 exp(-2|u|) N, starts "
        "at "
        "-5 m/s, strikes a stop, where it loses its velocity, swings out and sticks. The curve is "
        f"given by {given['rows']} even rows from 0 to {given['fastest']:g} m/s.",
        numbers=numbers,
        draw=draw,
        remarks="More rows do not bring the difference down: what is left is the error of the "
        "reference. A test compares both parts with an integration at a tolerance of 1e-12.",
        missing=GIVEN["missing"],
    )

"""A friction curve, and a stop in between: a reference result of the Modelica Standard Library."""

from __future__ import annotations

import csv
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from pindrive import Contact, Drive, Motion

from .case import DATA, PUBLISHED, Case, Number, follow, load

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.motion.results import Event

GIVEN = load("msl-friction-stop2")
TOLERANCE = "five times the tolerance of the source's solver, 1e-6"


def friction(u: Any) -> Any:
    """Friction force over sliding speed, N."""
    return 3.0 + u + 5.0 * np.exp(-2.0 * u)


TRAVEL = 0.3
"""Distance of the stop from the rest of the spring alone, m: a force moves the rest."""


def moved() -> float:
    """From there to where the source measures its positions from, m."""
    given = GIVEN["parameters"]
    return float(given["stop"]) + TRAVEL


@cache
def motion_of(rows: int) -> Motion:
    """Return the whole motion; its positions are `moved` less than in the source."""
    given = GIVEN["parameters"]
    speeds = np.linspace(0.0, given["fastest"], rows)
    drive = Drive(
        mass=given["mass"],
        stiffness=given["stiffness"],
        damping=given["damping"],
        plate=Contact(kinetic=0.0),
        finger=Contact(curve=list(zip(speeds, friction(speeds), strict=True))),
        travel=TRAVEL,
    )
    return follow(
        drive,
        displacement=given["position"] - moved(),
        velocity=given["velocity"],
        duration=1.25,
        force=given["stiffness"] * (given["rest"] - moved()),
    )


def reference() -> NDArray[np.float64]:
    """Rows of time (s), position (m) and velocity (m/s), once for each time at the stop."""
    with (DATA / "msl-friction-stop2.csv").open(newline="") as file:
        rows = [[float(row[name]) for name in ("time", "s", "v")] for row in csv.DictReader(file)]
    return np.array(rows)


def turns_of(motion: Motion) -> list[Event]:
    """Return the turns and sticks of the mass after its impact on the stop."""
    ends = [event for event in motion.events if event.contact == "finger" and event.velocity == 0.0]
    struck = next(event.time for event in motion.events if event.contact == "stop")
    return [e for e in ends if e.time > struck and e.kind in ("reverse", "stick")]


@cache
def msl() -> Case:
    """Mass, friction curve and stop."""
    given = GIVEN["parameters"]
    motion = motion_of(given["rows"])
    stop = GIVEN["published"]["stop_time"]
    allowed = 5.0 * GIVEN["solver_tolerance"]
    table = reference()
    arrival = next(event.time for event in motion.events if event.contact == "stop")
    compared = table[table[:, 0] != stop]
    worst = float(np.abs(motion.position(compared[:, 0]) + moved() - compared[:, 1]).max())

    def number(what: str, published: float, computed: float) -> Number:
        return Number(
            what=what,
            published=f"{published:.8f}",
            computed=computed,
            allowed=allowed,
            because=TOLERANCE,
        )

    turns = turns_of(motion)
    numbers = [number("arrival at the stop, s", stop, arrival)]
    for i, ((t, s), event) in enumerate(
        zip(GIVEN["published"]["turning"], turns, strict=True), start=1
    ):
        what = f"turn {i}" if event.kind == "reverse" else f"turn {i}, sticks"
        numbers += [
            number(f"{what}, s", t, event.time),
            number(f"{what}, m", s, moved() + event.position),
        ]
    numbers.append(number(f"largest difference at {len(compared)} times, m", 0.0, worst))

    def draw(axes: Axes) -> None:
        t = np.union1d(np.linspace(0.0, 1.25, 2001), [arrival])
        axes.plot(t, motion.position(t) + moved(), label="pindrive")
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
        "reference. A test compares the motion with an integration at a tolerance of 1e-12.",
    )

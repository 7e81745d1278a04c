"""What a motion costs: against its duration, its number of events, and the stiffness of the skin.

Only the number of events should count. Each motion is timed by `simulate`, a call from Python; by
`simulate` and all its numbers; and by `simulate_batch` on many copies of it, which is what the core
alone takes for the same numbers. Times are processor time, measured by turns, so that whatever else
the machine does falls on all alike.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from pindrive import Contact, Drive, Motion, simulate, simulate_batch
from pindrive.plots import PALETTE

DURATIONS = tuple(10.0**n for n in range(7))
REVERSALS = (1, 3, 10, 30, 100, 300, 1000)
RATIOS = tuple(10.0**n for n in range(7))
WAYS = ("simulate", "and its numbers", "the core alone")


@dataclass(frozen=True)
class Release:
    """A motion to be timed; SI."""

    drive: Drive
    mouse_velocity: float
    displacement: float
    duration: float | None = None

    def run(self) -> Motion:
        return simulate(
            self.drive,
            mouse_velocity=self.mouse_velocity,
            displacement=self.displacement,
            duration=self.duration,
        )

    def with_numbers(self) -> object:
        motion = self.run()
        return motion.transient, motion.ending

    def batch(self, copies: int) -> object:
        """All numbers of so many copies, on one thread."""
        drive = self.drive
        return simulate_batch(
            mass=np.full(copies, drive.mass),
            stiffness=drive.stiffness,
            damping=drive.damping,
            plate_kinetic=drive.plate.kinetic,
            finger_kinetic=drive.finger.kinetic,
            finger_stiffness=drive.finger.stiffness,
            mouse_velocity=self.mouse_velocity,
            displacement=self.displacement,
            duration=self.duration,
            threads=1,
        )


def mouse(duration: float | None = None, skin: float = np.inf) -> Release:
    """The example: released by the plate, it swings some five times and rests after 0.134 s."""
    drive = Drive(
        mass=0.010,
        stiffness=100.0,
        damping=0.40,
        plate=Contact(0.020),
        finger=Contact(0.005, stiffness=skin),
    )
    return Release(drive, 0.10, 1.5e-3, duration)


def undamped(reversals: int) -> Release:
    """Friction as small as needs so many reversals to end the swing."""
    finger = Contact(100.0 * 1.5e-3 / (2 * reversals + 0.5))
    drive = Drive(mass=0.010, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=finger)
    return Release(drive, 0.0, 1.5e-3)


# ---- measuring -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cost:
    """Median processor time of one motion in each of the `WAYS`, s, and its events."""

    events: int
    times: tuple[float, float, float]


def spent(call: Callable[[], object]) -> float:
    begin = process_time()
    call()
    return process_time() - begin


def enough(call: Callable[[int], object], least: float) -> int:
    """How many times to run it so that it takes this long, s."""
    count = 1
    while spent(lambda: call(count)) < least:
        count *= 2
    return count


def repeatedly(call: Callable[[], object]) -> Callable[[int], object]:
    def run(count: int) -> None:
        for _ in range(count):
            call()

    return run


def measure(releases: Sequence[Release], rounds: int, least: float) -> list[Cost]:
    """Each release in each way, by turns; `least` is how long one timing takes, s."""
    racers = [
        (release, way, enough(way, least))
        for release in releases
        for way in (repeatedly(release.run), repeatedly(release.with_numbers), release.batch)
    ]
    times: list[list[float]] = [[] for _ in racers]
    for _ in range(rounds):
        for taken, (_, way, count) in zip(times, racers, strict=True):
            taken.append(spent(lambda way=way, count=count: way(count)) / count)  # type: ignore[misc]
    medians = [median(taken) for taken in times]
    return [
        Cost(len(release.run().events), (medians[3 * i], medians[3 * i + 1], medians[3 * i + 2]))
        for i, release in enumerate(releases)
    ]


# ---- telling -------------------------------------------------------------------------------------


def table(
    title: str, first: str, given: Sequence[float], costs: Sequence[Cost], *, each: bool
) -> Table:
    """Medians in µs and, below each other, how often the first row's; `each`: for an event."""
    shown = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    shown.add_column(first, justify="right")
    shown.add_column("events", justify="right")
    for way in WAYS:
        shown.add_column(f"{way}\nµs", justify="right")
        shown.add_column("µs an event" if each else "ratio", justify="right", style="dim")
    for value, cost in zip(given, costs, strict=True):
        cells = []
        for time, reference in zip(cost.times, costs[0].times, strict=True):
            beside = 1e6 * time / cost.events if each else time / reference
            cells += [f"{1e6 * time:.4g}", f"{beside:.3f}" if each else f"{beside:.2f}"]
        shown.add_row(f"{value:g}", str(cost.events), *cells)
    return shown


def slope(costs: Sequence[Cost], way: int) -> tuple[float, float]:
    """The straight line through time over events: fixed part and part of one event, s."""
    events = np.array([cost.events for cost in costs], dtype=float)
    times = np.array([cost.times[way] for cost in costs])
    each, fixed = np.polyfit(events, times, 1, w=1.0 / times)
    return float(fixed), float(each)


def draw(durations: list[Cost], reversals: list[Cost], skins: list[Cost], path: Path) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.1, 2.5), layout="constrained")
    left, middle, right = figure.subplots(1, 3, sharey=True)
    panels = (
        (left, DURATIONS, durations, "duration, s", "at rest after 0.134 s"),
        (middle, [c.events for c in reversals], reversals, "events", "friction ends the swing"),
        (
            right,
            RATIOS,
            skins,
            "stiffness ratio $k_{\\rm skin}/k$",
            "skin that stretches and slips",
        ),
    )
    looks = (
        ("simulate", "o", PALETTE["curve"]),
        ("simulate, with all numbers", "s", PALETTE["resting"]),
        ("the core alone, with all numbers", "^", PALETTE["slip"]),
    )
    for axes, given, costs, name, title in panels:
        for way, (label, marker, colour) in enumerate(looks):
            microseconds = [1e6 * cost.times[way] for cost in costs]
            axes.loglog(
                given,
                microseconds,
                marker,
                ls="-",
                lw=1.0,
                ms=3.5,
                color=colour,
                label=label,
                clip_on=False,
            )
        axes.set_xlabel(name, fontsize=8)
        axes.set_title(title, fontsize=8, loc="left")
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(labelsize=7.5)
        axes.grid(visible=True, which="major", lw=0.4, color="0.9")
    left.set_ylabel("time of a motion, µs", fontsize=8)
    middle.legend(fontsize=7, frameon=False, loc="upper left")
    figure.savefig(path, dpi=200)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, help="timings of which the median counts")
    parser.add_argument("--least", type=float, default=0.02, help="of one timing, s")
    parser.add_argument("--figure", type=Path, help="draw the three curves into this file")
    given = parser.parse_args()

    from benchmarks.simulate import machine

    releases = (
        *(mouse(duration=duration) for duration in DURATIONS),
        *(undamped(reversals) for reversals in REVERSALS),
        *(mouse(skin=100.0 * ratio) for ratio in RATIOS),
    )
    costs = measure(releases, given.rounds, given.least)
    long, many = len(DURATIONS), len(DURATIONS) + len(REVERSALS)
    durations, reversals, skins = costs[:long], costs[long:many], costs[many:]

    console = Console(width=100, highlight=False)
    console.print(f"{machine()}\nmedians of {given.rounds} timings in processor time, one thread\n")
    console.print(
        table("A motion that rests after 0.134 s", "duration, s", DURATIONS, durations, each=False)
    )
    console.print(table("Undamped, small friction", "reversals", REVERSALS, reversals, each=True))
    for way, name in enumerate(WAYS):
        fixed, each = slope(reversals, way)
        console.print(f"  {name}: {1e6 * fixed:.2f} µs and {1e6 * each:.3f} µs an event")
    console.print()
    console.print(table("Compliant finger", "k_skin / k", RATIOS, skins, each=True))
    if given.figure:
        draw(durations, reversals, skins, given.figure)
        console.print(f"The figure is {given.figure}")


if __name__ == "__main__":
    main()

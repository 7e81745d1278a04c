"""Cost of a motion: against its duration, its number of events, and the stiffness of the skin.

Only the number of events should count. Each motion is timed by `simulate`, a call from Python; by
`simulate` and all its numbers; and by `simulate_batch` on many copies of it, which is what the core
alone takes, numbers included. Times are processor time, measured by turns, so that whatever else
the machine does falls on all alike.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from pindrive import Contact, Drive, Motion, Profile, Release, simulate, simulate_batch
from pindrive.plot.style import PALETTE

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

DURATIONS = tuple(10.0**n for n in range(7))
REVERSALS = (1, 3, 10, 30, 100, 300, 1000)
RATIOS = tuple(10.0**n for n in range(7))
WAYS = ("simulate", "with numbers", "core alone")


@dataclass(frozen=True)
class Case:
    """A motion to be timed; SI."""

    drive: Drive
    release: Release
    duration: float | None = None

    def run(self) -> Motion:
        return simulate(self.drive, self.release, duration=self.duration)

    def with_numbers(self) -> object:
        motion = self.run()
        return motion.transient, motion.ending

    def batch(self, copies: int) -> object:
        """All numbers of a number of copies, on one thread; the load of a batch is constant."""
        mass = np.full(copies, self.drive.mass)
        return simulate_batch(
            self.drive, self.release, mass=mass, duration=self.duration, threads=1
        )


def mouse(duration: float | None = None, skin: float = np.inf) -> Case:
    """The example: released by the plate, it swings some five times and rests after 0.134 s."""
    drive = Drive(
        mass=0.010,
        stiffness=100.0,
        damping=0.40,
        plate=Contact(0.020),
        finger=Contact(0.005, stiffness=skin),
    )
    return Case(drive, Release(0.10, 1.5e-3), duration)


def undamped(reversals: int) -> Case:
    """Friction that needs a number of reversals to end the swing."""
    finger = Contact(100.0 * 1.5e-3 / (2 * reversals + 0.5))
    drive = Drive(mass=0.010, stiffness=100.0, damping=0.0, plate=Contact(0.0), finger=finger)
    return Case(drive, Release(0.0, 1.5e-3))


def ringing(skin: float) -> Case:
    """Undamped skin that rings as it holds the pin, while a magnet pulls the plate on ever more.

    Each time the ringing meets the friction, the skin slips a little: events as many as periods.
    """
    finger = Contact(0.005, stiffness=skin)
    drive = Drive(mass=0.010, stiffness=100.0, damping=0.0, plate=Contact(0.010), finger=finger)
    pull = Profile([0.0, 0.5], [0.0, 0.2])
    release = Release(0.10, -0.025e-3, velocity=0.0, plate_load=pull)
    return Case(drive, release, 0.6)


# ---- measuring -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cost:
    """Median processor time of a motion in each of the `WAYS`, s, and its events."""

    events: int
    times: tuple[float, ...]


def spent(call: Callable[[], object]) -> float:
    begin = process_time()
    call()
    return process_time() - begin


@dataclass
class Racer:
    """Release in one way, repeated until a timing takes long enough."""

    call: Callable[[int], object]
    count: int
    times: list[float]

    @classmethod
    def warm(cls, call: Callable[[int], object], least: float) -> Racer:
        call(1)
        count = 1
        while spent(partial(call, count)) < least:
            count *= 2
        return cls(call, count, [])

    def run(self) -> None:
        self.times.append(spent(partial(self.call, self.count)) / self.count)


def repeat(call: Callable[[], object], count: int) -> None:
    for _ in range(count):
        call()


def measure(cases: Sequence[Case], rounds: int, least: float) -> list[Cost]:
    """Each release in each way, by turns; `least` is how long one timing takes, s."""
    racers = []
    for case in cases:
        runs: list[Callable[[int], object]]
        runs = [partial(repeat, case.run), partial(repeat, case.with_numbers)]
        if not isinstance(case.release.plate_load, Profile):
            runs.append(case.batch)
        racers.append([Racer.warm(run, least) for run in runs])
    for _ in range(rounds):
        for racer in chain.from_iterable(racers):
            racer.run()
    return [
        Cost(len(case.run().events), tuple(median(racer.times) for racer in runs))
        for case, runs in zip(cases, racers, strict=True)
    ]


# ---- telling -------------------------------------------------------------------------------------


def table(
    title: str, first: str, given: Sequence[float], costs: Sequence[Cost], *, each: bool
) -> Table:
    """Medians in µs; beside each its part of one event (`each`), or how often the first row's."""
    shown = Table(title=title, title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    shown.add_column(first, justify="right")
    shown.add_column("events", justify="right")
    for way, _ in zip(WAYS, costs[0].times, strict=False):
        shown.add_column(f"{way}\nµs", justify="right")
        shown.add_column("\nµs an event" if each else "\nratio", justify="right", style="dim")
    for value, cost in zip(given, costs, strict=True):
        cells = []
        for time, reference in zip(cost.times, costs[0].times, strict=True):
            beside = 1e6 * time / cost.events if each else time / reference
            cells += [f"{1e6 * time:.1f}", f"{beside:.2f}"]
        shown.add_row(f"{value:,.0f}".replace(",", " "), f"{cost.events}", *cells)
    return shown


def line(costs: Sequence[Cost], way: int) -> tuple[float, float]:
    """The straight line through time over events: fixed part and part of one event, s."""
    events = np.array([cost.events for cost in costs], dtype=float)
    times = np.array([cost.times[way] for cost in costs])
    each, fixed = np.polyfit(events, times, 1, w=1.0 / times)
    return float(fixed), float(each)


def draw(durations: list[Cost], reversals: list[Cost], skins: list[Cost], path: Path) -> None:
    """The first three tables as curves."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter

    counts = [cost.events for cost in reversals]
    panels = (
        ("at rest after 0.134 s: 5 events", "duration (s)", DURATIONS, durations),
        ("swings to and fro", "number of events", counts, reversals),
        (
            f"compliant finger: {skins[0].events} events",
            r"stiffness ratio $k_\mathrm{skin}/k$",
            RATIOS,
            skins,
        ),
    )
    styles = (
        ("simulate", "o", PALETTE["curve"]),
        ("simulate, with all numbers", "s", PALETTE["resting"]),
        ("core alone, with all numbers", "^", PALETTE["slip"]),
    )
    figure = Figure(figsize=(7.1, 2.5), layout="constrained")
    every = figure.subplots(1, 3, sharey=True)
    for axes, (title, name, given, costs) in zip(every, panels, strict=True):
        for way, (label, marker, colour) in enumerate(styles):
            times = [1e6 * cost.times[way] for cost in costs]
            axes.loglog(given, times, marker, ls="-", lw=1.0, ms=3.5, c=colour, label=label)
        axes.set_title(title, fontsize=8, loc="left")
        axes.set_xlabel(name, fontsize=8)
        axes.tick_params(labelsize=7.5)
        axes.tick_params(which="minor", length=0)
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(lw=0.4, c="0.9")
    # Time in proportion to the events, beside the curve that comes to it.
    each = 1e6 * reversals[-1].times[0] / counts[-1] / 2
    every[1].loglog(counts[3:], [each * n for n in counts[3:]], "--", lw=0.8, c="0.45")
    every[1].annotate(
        "in proportion",
        (counts[4], each * counts[4]),
        (4, -10),
        fontsize=7,
        textcoords="offset points",
        color="0.45",
    )
    every[0].set_ylabel("processor time of a motion (µs)", fontsize=8)
    every[0].yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    every[0].legend(fontsize=7, frameon=False, loc="upper left")
    figure.savefig(path, dpi=200, pil_kwargs={"optimize": True})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9, help="timings of which the median counts")
    parser.add_argument("--least", type=float, default=0.02, help="of one timing, s")
    parser.add_argument("--figure", type=Path, help="draw the three curves into this file")
    given = parser.parse_args()

    from benchmarks.simulate import machine

    stiff = [100.0 * ratio for ratio in RATIOS]
    series = (
        [mouse(duration=duration) for duration in DURATIONS],
        [undamped(reversals) for reversals in REVERSALS],
        [mouse(skin=skin) for skin in stiff],
        [ringing(skin) for skin in stiff[1:]],
    )
    costs = iter(measure([*chain.from_iterable(series)], given.rounds, given.least))
    durations, reversals, skins, rings = ([*islice(costs, len(part))] for part in series)

    console = Console(width=110, highlight=False)
    console.print(f"{machine()}\nmedians of {given.rounds} timings, processor time, one thread\n")
    title = "At rest after 0.134 s, and simulated for much longer"
    console.print(table(title, "duration, s", DURATIONS, durations, each=False))
    title = "Undamped: the smaller the friction, the more often it reverses"
    console.print(table(title, "reversals", REVERSALS, reversals, each=True))
    for way, name in enumerate(WAYS):
        fixed, each = line(reversals, way)
        console.print(f"  {name}: {1e6 * fixed:.1f} µs and {1e6 * each:.2f} µs an event")
    title = "\nA finger whose skin stretches and slips"
    console.print(table(title, "k_skin / k", RATIOS, skins, each=True))
    title = "Skin that rings undamped and slips a little in each period"
    console.print(table(title, "k_skin / k", RATIOS[1:], rings, each=True))
    if given.figure:
        draw(durations, reversals, skins, given.figure)
        console.print(f"The figure is {given.figure}")


if __name__ == "__main__":
    main()

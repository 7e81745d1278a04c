"""Throughput of pindrive beside a compiled Moreau-Jean stepper, on one thread, in one run.

Both are timed twice: keeping nothing but the last state, and with numbers: all that
`simulate_batch` gives, and what the stepper (racing/moreau_jean.py) can measure of them on the way.
Its error is the largest |x - x_exact| over its steps, as a part of the release displacement.

A table follows of the kernel in packs of every width that the processor has, with the share of
drives that it left to the general core; then the time of a study of 10 million points that keeps
three numbers, on two threads. Where build/cpp/core is built, that core is timed alone.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numba
import numpy as np

from pindrive import Contact, Drive, Motion, Release, simulate, simulate_batch
from pindrive._core import kernel_widths
from pindrive._core import simulate_batch as by_core
from pindrive.motion import batch

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.racing.moreau_jean import last_states, numbers, trajectory  # noqa: E402
from benchmarks.racing.releases import (  # noqa: E402
    DRIVE,
    DURATION,
    RELEASE,
    Floats,
    columns,
    drawn,
    exact_positions,
)

# ---- truth ---------------------------------------------------------------------------------------


def alone(drive: Floats) -> Motion:
    m, k, b, plate, finger, level, x = (float(value) for value in drive)
    return simulate(
        Drive(mass=m, stiffness=k, damping=b, plate=Contact(plate), finger=Contact(finger)),
        Release(level, x),
        duration=DURATION,
    )


def stepper_errors(drives: Floats, h: float, steps: int) -> Floats:
    """Largest |x - x_exact| of each drive, a part of x(0)."""
    times = h * np.arange(steps + 1)
    errors, path = np.empty(drives.shape[1]), np.empty(steps + 1)
    for i, drive in enumerate(drives.T):
        trajectory(drive, h, 1, path)
        errors[i] = np.abs(path - alone(drive).position(times)).max() / drive[-1]
    return errors


def exact_errors(drives: Floats, count: int = 31) -> Floats:
    """Error of pindrive against thirty digits, at a number of times."""
    times = np.linspace(0.0, DURATION, count)
    ours = np.array([alone(drive).position(times) for drive in drives.T])
    off = np.abs(ours - exact_positions(drives, times)).astype(np.float64)
    return np.asarray(off.max(axis=1) / drives[-1])


# ---- the race ------------------------------------------------------------------------------------


def seconds(call: Callable[[], object]) -> float:
    """Processor time, to which other programs do not add; one thread alone works."""
    begin = process_time()
    call()
    return process_time() - begin


def core_alone(program: Path, count: int) -> Callable[[], float]:
    """Seconds that the core takes to the last states, as its own benchmark prints them."""

    def run() -> float:
        reported = subprocess.run([program, str(count)], capture_output=True, text=True, check=True)
        return float(reported.stdout.split()[0]) * 1e-6 * count

    return run


STATE = ("final_position", "final_velocity")


def width_table(points: dict[str, Any], rounds: int) -> None:
    """A drive's time by the kernel of each width, to the last state and with all numbers."""
    count = len(points["mass"])
    same = {"plate_static": "plate_kinetic", "finger_static": "finger_kinetic"}
    given = {name: points[of] for name, of in same.items()} | {"velocity": points["mouse_velocity"]}
    given |= points | {"finger_stiffness": np.inf, "duration": DURATION}
    given |= {"settling_band": 0.05, "plate_load": 1.0}
    arrays = [np.broadcast_to(np.asarray(given[k], np.float64), count) for k in batch._ARGUMENTS]
    state = [batch._NUMBERS[name] for name in STATE]
    numbers = [*batch._USUAL.values()]
    print(f"\n{'packs of':>10}{'last state':>16}{'all numbers':>16}{'general core':>16}")
    for width in kernel_widths():

        def took(names: list[str], events: bool, width: int = width) -> float:
            def once() -> float:
                return seconds(lambda: by_core(arrays, batch._BOUNDS, 1, names, events, width))

            return median(once() for _ in range(rounds)) / count

        share = by_core(arrays, batch._BOUNDS, 1, numbers, True, width)["general"] / count
        times = (1e9 * took(state, False), 1e9 * took(numbers, True))
        print(f"{width:10}{times[0]:13.1f} ns{times[1]:13.1f} ns{100.0 * share:14.4f} %")


KEPT = ("transient_peak_displacement", "transient_settling_time", "ending_position")


def time_study(drives: int, speeds: int, threads: int) -> None:
    """A study of random drives at several speeds of the hand that keeps three numbers."""
    points: dict[str, Any] = {k: values[:, None] for k, values in drawn(drives, 2).items()}
    points |= {"mouse_velocity": np.linspace(0.02, 0.3, speeds)}
    begin, worked = perf_counter(), process_time()
    data = simulate_batch(
        DRIVE, RELEASE, outputs=KEPT, threads=threads, duration=DURATION, **points
    )
    wall, worked = perf_counter() - begin, process_time() - worked
    print(
        f"\n{data.status.size} points of {drives} drives, three numbers, {threads} threads: "
        f"{wall:.2f} s, {worked:.2f} s of processor time"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1 << 18, help="drives")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--step", type=float, default=1e-4, help="of the stepper, s")
    parser.add_argument("--rounds", type=int, default=15, help="timings of which the median counts")
    parser.add_argument("--study", type=int, default=10_000_000, help="points of the study")
    parser.add_argument("--core", type=Path, default=ROOT / "build" / "cpp" / "core")
    given = parser.parse_args()

    from benchmarks.simulate import machine

    points = drawn(given.count, given.seed)
    drives = columns(points)
    steps = round(DURATION / given.step)
    fewer = drives[:, : max(1, given.count // 80)]  # the stepper is slow
    states, table = np.empty((fewer.shape[1], 2)), np.empty((fewer.shape[1], 15))
    arguments: dict[str, Any] = {**points, "duration": DURATION, "threads": 1}
    last_states(fewer[:, :1], given.step, steps, states)
    numbers(fewer[:, :1], given.step, steps, table)

    def of_stepper(call: Callable[..., None], out: Floats) -> float:
        return seconds(lambda: call(fewer, given.step, steps, out)) / float(fewer.shape[1])

    racers: dict[str, Callable[[], float]] = {
        "stepper, last state alone": lambda: of_stepper(last_states, states),
        "stepper, with its numbers": lambda: of_stepper(numbers, table),
        "simulate_batch, all numbers": lambda: (
            seconds(lambda: simulate_batch(DRIVE, RELEASE, **arguments)) / given.count
        ),
        "simulate_batch, last state": lambda: (
            seconds(lambda: simulate_batch(DRIVE, RELEASE, outputs=STATE, **arguments))
            / given.count
        ),
    }
    if given.core.exists():
        core = core_alone(given.core, given.count)
        racers["core, last state alone"] = lambda: core() / given.count
    times: dict[str, list[float]] = {name: [] for name in racers}
    for _ in range(given.rounds):
        for name, race in racers.items():
            times[name].append(race())
    took = {name: median(values) for name, values in times.items()}

    print(f"{machine()}, numba {numba.__version__}")
    print(f"{given.count} drives, seed {given.seed}, {DURATION} s, one thread, step {given.step} s")
    print(f"\n{'':30}{'a drive':>12}{'a second':>12}")
    for name, time in took.items():
        print(f"{name:30}{1e6 * time:9.2f} µs{1.0 / time:12.3g}")
    ours = took["simulate_batch, all numbers"]
    like = took["stepper, with its numbers"] / ours
    bare = took["stepper, last state alone"] / ours
    least = took["stepper, last state alone"] / took["simulate_batch, last state"]
    print(f"\nlast state alone by both: {least:.1f} times")
    print(f"all numbers by both: {like:.1f} times; by simulate_batch alone: {bare:.1f} times")
    if "core, last state alone" in took:
        general = took["stepper, last state alone"] / took["core, last state alone"]
        print(f"last state alone, by the general core: {general:.1f} times")
    width_table(points, given.rounds)
    time_study(given.study // 100, 100, threads=2)
    coarse, fine = stepper_errors(drives[:, :500], given.step, steps), exact_errors(drives[:, :20])
    print(f"\nstepper's error: median {np.median(coarse):.1e}, largest {coarse.max():.1e} of 500")
    print(f"pindrive's error against thirty digits: largest {fine.max():.1e} of 20")


if __name__ == "__main__":
    main()

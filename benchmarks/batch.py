"""Throughput of `simulate_batch` beside a compiled Moreau-Jean stepper, on one thread, in one run.

The stepper is the set-valued one at its best: the midpoint rule for spring and damper, friction
implicit and solved exactly in a few comparisons (no iteration, no regularisation), the coefficients
of a step computed once for a drive, compiled by numba. It is timed twice: keeping nothing but the
last state, and measuring on the way what a stepper can of the numbers that `simulate_batch` gives.
Its error is the largest |x - x_exact| over its steps, as a part of the release displacement.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from pindrive import Contact, Drive, Motion, simulate, simulate_batch

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

DURATION = 0.3  # s
ORDER = (
    "mass",
    "stiffness",
    "damping",
    "plate_kinetic",
    "finger_kinetic",
    "mouse_velocity",
    "displacement",
)
Floats = NDArray[np.float64]


def drawn(count: int, seed: int) -> dict[str, Floats]:
    """Drives and releases, even over the ranges of a tactile mouse; SI."""
    uniform = np.random.default_rng(seed).uniform
    mass, stiffness = uniform(2e-3, 20e-3, count), uniform(20.0, 400.0, count)
    return {
        "mass": mass,
        "stiffness": stiffness,
        "damping": 2.0 * uniform(0.01, 0.5, count) * np.sqrt(mass * stiffness),
        "plate_kinetic": uniform(5e-3, 100e-3, count),
        "finger_kinetic": uniform(1e-3, 50e-3, count),
        "mouse_velocity": uniform(20e-3, 300e-3, count),
        "displacement": uniform(0.5e-3, 3e-3, count),
    }


# ---- the stepper ---------------------------------------------------------------------------------


@numba.njit(inline="always")
def friction_step(free: float, weight: float, plate: float, finger: float, level: float) -> float:
    """The w with  weight w + plate Sgn(w - level) + finger Sgn(w) ∋ free,  level >= 0."""
    if free < -plate - finger:
        return (free + plate + finger) / weight
    if free <= finger - plate:
        return 0.0
    if free < weight * level + finger - plate:
        return (free + plate - finger) / weight
    if free <= weight * level + finger + plate:
        return level
    return (free - plate - finger) / weight


@numba.njit(inline="always")
def coefficients(m: float, k: float, b: float, h: float) -> tuple[float, float, float]:
    """Of the step  weight w + impulses = of_v v + of_x x,  by the midpoint rule."""
    return m + h * b / 2 + h * h * k / 4, m - h * b / 2 - h * h * k / 4, -h * k


@numba.njit
def last_states(drives: Floats, h: float, steps: int, out: Floats) -> None:
    """Position and velocity of every drive after so many steps."""
    for i in range(drives.shape[1]):
        m, k, b, plate, finger, level, x = drives[:, i]
        weight, of_v, of_x = coefficients(m, k, b, h)
        v = level
        for _ in range(steps):
            w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
            x += h / 2 * (v + w)
            v = w
        out[i, 0] = x
        out[i, 1] = v


@numba.njit
def trajectory(drive: Floats, h: float, steps: int, out: Floats) -> None:
    """The position of one drive at every step."""
    m, k, b, plate, finger, level, x = drive
    weight, of_v, of_x = coefficients(m, k, b, h)
    v = level
    out[0] = x
    for n in range(steps):
        w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
        x += h / 2 * (v + w)
        v = w
        out[n + 1] = x


@numba.njit
def numbers(drives: Floats, h: float, steps: int, out: Floats) -> None:
    """Peak, trough, return velocity and settling time; use of each contact."""
    path = np.empty(steps + 1)
    for i in range(drives.shape[1]):
        m, k, b, plate, finger, level, x = drives[:, i]
        weight, of_v, of_x = coefficients(m, k, b, h)
        v = level
        out[i] = 0.0
        out[i, 0] = out[i, 2] = path[0] = x
        for n in range(steps):
            w = friction_step(of_v * v + of_x * x, weight, h * plate, h * finger, level)
            middle = (v + w) / 2
            x += h * middle
            path[n + 1] = x
            if x > out[i, 0]:
                out[i, 0], out[i, 1] = x, n * h
            if x < out[i, 2]:
                out[i, 2], out[i, 3] = x, n * h
            if w < out[i, 4]:
                out[i, 4], out[i, 5] = w, n * h
            if w == 0.0:
                out[i, 6] += h
            if w == level:
                out[i, 7] += h
            out[i, 8] += h * abs(middle)
            out[i, 9] += h * abs(middle - level)
            if v * w < 0.0 or (w == 0.0 and v != 0.0):
                out[i, 10] += 1.0
            if (v - level) * (w - level) < 0.0 or (w == level and v != level):
                out[i, 11] += 1.0
            v = w
        band = 0.05 * abs(path[0] - x)
        n = steps
        while n > 0 and abs(path[n] - x) <= band:
            n -= 1
        out[i, 12] = n * h
        out[i, 13], out[i, 14] = finger * out[i, 8], plate * out[i, 9]


# ---- truth ---------------------------------------------------------------------------------------


def alone(drive: Floats) -> Motion:
    m, k, b, plate, finger, level, x = (float(value) for value in drive)
    return simulate(
        Drive(mass=m, stiffness=k, damping=b, plate=Contact(plate), finger=Contact(finger)),
        mouse_velocity=level,
        displacement=x,
        duration=DURATION,
    )


def stepper_errors(drives: Floats, h: float, steps: int) -> Floats:
    """Largest |x - x_exact| of each drive, a part of x(0)."""
    times = h * np.arange(steps + 1)
    errors, path = np.empty(drives.shape[1]), np.empty(steps + 1)
    for i, drive in enumerate(drives.T):
        trajectory(drive, h, steps, path)
        errors[i] = np.abs(path - alone(drive).position(times)).max() / drive[-1]
    return errors


def exact_errors(drives: Floats, count: int = 31) -> Floats:
    """The same of pindrive against thirty digits, at so many times."""
    from oracle import mp_oracle

    times = np.linspace(0.0, DURATION, count)
    errors = np.empty(drives.shape[1])
    for i, drive in enumerate(drives.T):
        m, k, b, plate, finger, level, x = (float(value) for value in drive)
        pin = mp_oracle.Pin(m, k, b, plate, plate, finger, finger, level, x)
        path = mp_oracle.solve(pin, DURATION)
        true = [path.state(float(time))[0] for time in times]
        ours = alone(drive).position(times)
        errors[i] = max(abs(float(a - b)) for a, b in zip(ours.tolist(), true, strict=True)) / x
    return errors


# ---- the race ------------------------------------------------------------------------------------


def seconds(call: Callable[[], object]) -> float:
    begin = perf_counter()
    call()
    return perf_counter() - begin


def core_alone(program: Path, count: int) -> Callable[[], float]:
    """Seconds that the core takes without the numbers, as its own benchmark prints them."""

    def run() -> float:
        told = subprocess.run([program, str(count)], capture_output=True, text=True, check=True)
        return float(told.stdout.split()[0]) * 1e-6 * count

    return run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=200_000, help="drives")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--step", type=float, default=1e-4, help="of the stepper, s")
    parser.add_argument("--rounds", type=int, default=5, help="timings of which the median counts")
    parser.add_argument("--core", type=Path, default=ROOT / "build" / "cpp" / "core")
    given = parser.parse_args()

    from benchmarks.simulate import machine

    points = drawn(given.count, given.seed)
    drives = np.array([points[name] for name in ORDER])
    steps = round(DURATION / given.step)
    fewer = drives[:, : max(1, given.count // 20)]  # the stepper is slow
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
            seconds(lambda: simulate_batch(**arguments)) / given.count
        ),
    }
    if given.core.exists():
        core = core_alone(given.core, given.count)
        racers["core, segments alone"] = lambda: core() / given.count
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
    print(f"\nall numbers by both: {like:.1f} times; by simulate_batch alone: {bare:.1f} times")
    if "core, segments alone" in took:
        least = took["stepper, last state alone"] / took["core, segments alone"]
        print(f"numbers by neither: {least:.1f} times")
    coarse, fine = stepper_errors(drives[:, :500], given.step, steps), exact_errors(drives[:, :20])
    print(f"stepper's error: median {np.median(coarse):.1e}, largest {coarse.max():.1e} of 500")
    print(f"pindrive's error against thirty digits: largest {fine.max():.1e} of 20")


if __name__ == "__main__":
    main()

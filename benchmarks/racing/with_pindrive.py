"""Pindrive: one drive at a time, and many at once with all their numbers."""

from __future__ import annotations

from collections.abc import Iterator
from time import process_time
from typing import Any

import numpy as np

from benchmarks.racing.race import TIMES, Lap, Racer, one_by_one
from benchmarks.racing.releases import DRIVE, DURATION, ORDER, RELEASE, Floats, drawn, exact
from pindrive import Contact, Drive, Release, simulate, simulate_batch

MANY = 20_000  # other drives of the same distribution, for the time of a batch


def racers(_everything: bool) -> Iterator[Racer]:
    """Single and batch; there is nothing to set."""
    yield Racer("pindrive", "simulate", "", one_by_one(single))
    yield Racer("pindrive", "simulate_batch", "", batch)


def single(drive: Floats) -> Floats:
    """Positions of one drive."""
    m, k, b, plate, finger, level, x = drive.tolist()
    pin = Drive(mass=m, stiffness=k, damping=b, plate=Contact(plate), finger=Contact(finger))
    motion = simulate(pin, Release(level, x), duration=DURATION)
    return np.asarray(motion.position(TIMES))


def batch(drives: Floats) -> Lap:
    """All numbers on one thread; its error is that of its largest and smallest position."""
    points: dict[str, Any] = drawn(MANY, seed=2)
    begin = process_time()
    simulate_batch(DRIVE, RELEASE, **points, duration=DURATION, threads=1)
    seconds = (process_time() - begin) / MANY
    given: dict[str, Any] = dict(zip(ORDER, drives, strict=True))
    numbers = simulate_batch(DRIVE, RELEASE, **given, duration=DURATION, threads=1)
    errors = np.zeros(drives.shape[1])
    for i, drive in enumerate(drives.T.tolist()):
        path = exact(*drive)
        for name in ("peak", "trough"):
            time = float(numbers[f"transient_{name}_time"][i])
            reported = float(numbers[f"transient_{name}_displacement"][i])
            if np.isfinite(time):
                off = abs(float(path.state(time)[0] - reported)) / drive[-1]
                errors[i] = max(errors[i], off)
    return Lap(np.empty(0), {}, seconds, errors)

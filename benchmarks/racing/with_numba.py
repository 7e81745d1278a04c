"""The compiled Moreau-Jean stepper at three steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from benchmarks.racing.moreau_jean import trajectory
from benchmarks.racing.race import TIMES, Racer, one_by_one
from benchmarks.racing.releases import Floats

STEPS = (1e-3, 1e-4, 1e-5)  # s


def racers(_everything: bool) -> Iterator[Racer]:
    """One way, three steps."""
    for step in STEPS:
        yield Racer("numba", "Moreau–Jean", f"step {step:g} s", one_by_one(stepping(step)))


def stepping(step: float) -> Callable[[Floats], Floats]:
    """Positions of one drive at a step that divides 4 ms."""
    every = round(TIMES[1] / step)

    def solve(drive: Floats) -> Floats:
        positions = np.empty(len(TIMES))
        trajectory(drive, step, every, positions)
        return positions

    return solve

"""Tasks of every peer, and their timing.

From the seven numbers of a drive to the position at 76 times: that is one transient, and its time
is the processor time of all of it. What can be made once for all drives (a compiled model, a
jitted function) is made before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import median
from time import process_time

import numpy as np

from benchmarks.racing.releases import DURATION, Floats

TIMES = np.linspace(0.0, DURATION, 76)  # every 4 ms: whole numbers of all steps used
WRONG_END = 0.05  # of the release displacement: the band that counts as settled
CAP = 2.0  # s of processor time for one drive


class FailureError(Exception):
    """Reason of a peer without an answer, in a word or two."""


class Watch:
    """Ends a drive that takes too long; `tick` is called with every evaluation or step."""

    def __init__(self) -> None:
        self.ticks = 0
        self.end = process_time() + CAP

    def tick(self) -> None:
        self.ticks += 1
        if self.ticks % 256 == 0 and process_time() > self.end:
            raise FailureError("too slow")


@dataclass(frozen=True)
class Lap:
    """All drives once; positions in one row a drive, NaN where it failed, and why."""

    positions: Floats
    failures: dict[int, str]
    seconds: float  # of processor time, a drive that did not fail
    errors: Floats | None = None  # of a peer that gives other numbers than positions


@dataclass(frozen=True)
class Racer:
    """A peer in one way of using it, at one setting."""

    peer: str
    way: str
    setting: str
    lap: Callable[[Floats], Lap]


@dataclass
class Result:
    """Result of a racer."""

    racer: Racer
    laps: list[float] = field(default_factory=list)
    errors: Floats = field(default_factory=lambda: np.empty(0))  # of each drive, NaN: failed
    failures: dict[int, str] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        return median(self.laps)


def one_by_one(solve: Callable[[Floats], Floats]) -> Callable[[Floats], Lap]:
    """A lap of a peer that follows one drive at a time."""

    def lap(drives: Floats) -> Lap:
        positions = np.full((drives.shape[1], len(TIMES)), np.nan)
        failures, spent = {}, 0.0
        for i, drive in enumerate(np.ascontiguousarray(drives.T)):
            begin = process_time()
            try:
                positions[i] = solve(drive)
            except FailureError as failure:
                failures[i] = str(failure)
            else:
                spent += process_time() - begin
        return Lap(positions, failures, spent / max(1, len(positions) - len(failures)))

    return lap


def race(
    racers: Sequence[Racer],
    drives: Floats,
    truth: Floats,
    most: int,
    budget: float,
    note: Callable[[str], None],
) -> list[Result]:
    """Laps by turns, so that whatever else the machine does falls on all alike.

    Args:
        racers: who takes part.
        drives: one column a drive.
        truth: exact positions, one row a drive.
        most: laps of each racer.
        budget: s of processor time after which a racer runs no more laps; it runs at least one.
        note: told who runs.
    """
    results = [Result(racer) for racer in racers]
    spent = [0.0] * len(racers)
    for turn in range(most):
        for i, result in enumerate(results):
            racer = result.racer
            if turn and spent[i] * (turn + 1) / turn > budget:
                continue
            note(f"lap {turn + 1}: {racer.peer}, {racer.way}, {racer.setting}")
            if turn == 0:
                racer.lap(drives[:, :1])  # imports and compiles
            lap = racer.lap(drives)
            spent[i] += lap.seconds * drives.shape[1]
            result.laps.append(lap.seconds)
            if turn == 0:
                judge(result, lap, truth, drives[-1])
    return results


def judge(result: Result, lap: Lap, truth: Floats, displacements: Floats) -> None:
    """Errors as parts of the release displacement; an end far from the true one is a failure."""
    if lap.errors is not None:
        result.errors = lap.errors
        return
    off = np.abs(lap.positions - truth) / displacements[:, None]
    result.errors = off.max(axis=1)
    result.failures = {
        **{int(i): "wrong end" for i in np.flatnonzero(off[:, -1] > WRONG_END)},
        **lap.failures,
    }

"""Studies as a person reads them in a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pindrive.quantity import significant
from pindrive.study.evaluate import flags
from pindrive.study.sweeping import human_bytes

if TYPE_CHECKING:
    from pindrive.study.plan import Plan
    from pindrive.study.sweeping import Result

_SLICE = 1 << 24
"""Points of which the status is read at a time."""


def sweep_report(plan: Plan, done: Result) -> list[str]:
    """What a sweep came to, in lines."""
    points, size = count(done.points), human_bytes(done.path.stat().st_size)
    if not done.complete:
        lines = [f"Stopped at {points} of {count(plan.size)} points; --resume goes on"]
    elif done.worked_out:
        speed = count(round(done.worked_out / done.seconds))
        resumed = (
            "" if done.worked_out == done.points else f", {count(done.worked_out)} of them now"
        )
        lines = [
            f"Wrote {done.path}: {points} points{resumed}, {size}, "
            f"in {significant(done.seconds, 3)} s ({speed} a second)"
        ]
    else:
        lines = [f"{done.path} is complete: {points} points, {size}"]
    if done.points and done.settled >= 0:
        lines.append(f"settled: {percent(done.settled, done.points)}")
    if done.refused and done.complete:
        found = ", ".join(f"{percent(n, done.points)} {name}" for name, n in _reasons(done))
        lines.append(f"without numbers: {found} (see the variable status)")
    return lines


def _reasons(done: Result) -> list[tuple[str, int]]:
    """Why points have no numbers, and how many of them, most first."""
    import h5py

    found = np.zeros(256, np.int64)
    with h5py.File(done.path, "r") as file:
        status = file["status"]
        rows = max(1, _SLICE // max(1, status.size // status.shape[0]))
        for first in range(0, status.shape[0], rows):
            found += np.bincount(status[first : first + rows].ravel(), minlength=256)
    meanings = flags("status")
    named = [(meanings[i], int(found[i])) for i in np.flatnonzero(found) if i]
    return sorted(named, key=lambda pair: -pair[1])


def count(number: int) -> str:
    """A count with its thousands apart: "10 000 000"."""
    return f"{number:,}".replace(",", " ")


def percent(part: int, whole: int) -> str:
    """A part of a whole: "98.5 %"; never 100 % nor 0 % by rounding."""
    if part in (0, whole):
        return "all" if part else "none"
    shown = f"{100.0 * part / whole:.3g} %"
    return f"all but {count(whole - part)}" if shown == "100 %" else shown

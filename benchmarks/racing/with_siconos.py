"""Siconos, where a Python has it: its time stepping with a relay on each contact's velocity.

Siconos is no package of PyPI, and Debian's belongs to Debian's Python: it runs there, as a program
of its own that measures itself. The first-order system is that of Siconos' own friction oscillator;
its Lagrangian one, by Moreau-Jean, gives the same. Of the relay solvers all give the same, too.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.racing.race import TIMES, Lap, Racer
from benchmarks.racing.releases import Floats

STEPS = (1e-3, 2e-4, 4e-5)  # s
WORKER = Path(__file__).with_name("siconos_worker.py")


def python(given: str | None) -> str | None:
    """A Python that has Siconos: the one given, this one, or the system's."""
    for program in [given] if given else [sys.executable, "/usr/bin/python3"]:
        try:
            reported = subprocess.run([program, "-c", "import siconos.kernel"], capture_output=True)
        except OSError:
            continue
        if reported.returncode == 0:
            return program
    return None


def racers(program: str, everything: bool) -> Iterator[Racer]:
    """One way, or all that were tried."""
    paths = [("first order", "LEMKE")]
    if everything:
        paths += [("first order", name) for name in ("PGS", "ENUM", "AVI_CAOFERRIS")]
        paths += [("lagrangian", "LEMKE")]
    for way, solver in paths:
        name = f"{way}, {solver}" if everything else "time stepping"
        for step in STEPS:
            lap: Callable[[Floats], Lap] = partial(run, program, way, solver, step)
            yield Racer("Siconos", name, f"step {step:g} s", lap)


def run(program: str, way: str, solver: str, step: float, drives: Floats) -> Lap:
    """Lap in the Python that has Siconos."""
    every, count = round(TIMES[1] / step), len(TIMES)
    with TemporaryDirectory() as folder:
        given, answer = Path(folder, "in.npz"), Path(folder, "out.npz")
        np.savez(given, drives=drives, step=step, every=every, count=count, way=way, solver=solver)
        subprocess.run([program, WORKER, given, answer], check=True, stdout=subprocess.DEVNULL)
        with np.load(answer) as reported:
            return Lap(reported["positions"], {}, float(reported["seconds"]) / drives.shape[1])

"""Coverage of the intervals of `fit` on random recordings: `run.py bench fitting`.

    python3 run.py bench fitting [COUNT [SEED]]

Each recording is 0.2 s of a random drive at 10 kHz, of position, velocity or both, with noise of 1
or 5 % of its largest value, known or not. Four to six parameters are free, and the search starts at
a drive that is off by up to a factor of two in each.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from math import isfinite, pi

import numpy as np
from numpy.typing import NDArray

from pindrive import Contact, Drive, Release, simulate
from pindrive.fitting import Fit, Identifiability, Recording, fit

Array = NDArray[np.float64]
COUNT, SEED = 500, 1501
SPAN, RATE = 0.2, 10e3
ALWAYS = ("stiffness", "damping", "displacement")
SOMETIMES = (
    *("plate.kinetic", "finger.kinetic", "finger.static", "velocity"),
    *("time_offset", "position_offset"),
)


@dataclass(frozen=True)
class Case:
    """A recording, what made it, and where the fit starts."""

    recording: Recording
    truth: dict[str, float]
    drive: Drive
    release: Release


def draw(rng: np.random.Generator) -> Case:
    """A random recording of a random drive."""

    def decades(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    mass, frequency = decades(1e-3, 0.1), decades(6.0, 60.0)
    omega = 2.0 * pi * frequency
    stiffness, x0 = mass * omega**2, decades(0.5e-3, 5e-3)
    damping = 2.0 * decades(0.02, 0.4) * mass * omega
    plate, finger = (stiffness * x0 * decades(0.02, 0.2) for _ in range(2))
    v = omega * x0 * decades(0.1, 0.8)
    rest = rng.random() < 0.3
    static = finger * rng.uniform(1.0, 1.8)
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping=damping,
        plate=Contact(plate),
        finger=Contact(finger, static),
    )
    motion = simulate(drive, Release(v, x0, 0.0 if rest else None), duration=SPAN)
    names = ["position", "velocity"]
    channels = [names, names[:1], names[1:]][rng.integers(3)]
    extra = [n for n in SOMETIMES if n != "position_offset" or "position" in channels]
    if not rest:
        extra.remove("velocity")
    free = [*ALWAYS, *rng.choice(extra, rng.integers(1, 4), replace=False).tolist()]
    truth = {
        "stiffness": stiffness,
        "damping": damping,
        "displacement": x0,
        "plate.kinetic": plate,
        "finger.kinetic": finger,
        "finger.static": static,
        "velocity": motion.release.initial_velocity,
        "time_offset": rng.uniform(0.001, 0.01) if "time_offset" in free else 0.0,
        "position_offset": 0.1 * x0 * rng.normal() if "position_offset" in free else 0.0,
    }
    t = np.arange(round(SPAN * RATE)) / RATE
    own = t - truth["time_offset"]
    late = np.maximum(own, 0.0)
    x = motion.position(late) + truth["velocity"] * np.minimum(own, 0.0)
    values = {"position": x + truth["position_offset"], "velocity": motion.velocity(late)}
    part = float(rng.choice([0.01, 0.05]))
    noise = {name: part * float(np.abs(values[name]).max()) for name in channels}
    recorded = {name: values[name] + noise[name] * rng.normal(size=len(t)) for name in channels}
    known = noise if rng.random() < 0.5 else None
    recording = Recording(
        t, position=recorded.get("position"), velocity=recorded.get("velocity"), noise=known
    )

    def off(name: str) -> float:
        return truth[name] * (decades(0.5, 2.0) if name in free else 1.0)

    start_finger = off("finger.kinetic")
    if "finger.static" not in free:  # it keeps its ratio to kinetic friction
        truth["finger.static"] *= start_finger / truth["finger.kinetic"]
    start = Drive(
        mass=mass,
        stiffness=off("stiffness"),
        damping=off("damping"),
        plate=Contact(off("plate.kinetic")),
        finger=Contact(start_finger, max(off("finger.static"), start_finger)),
    )
    start_release = Release(v, off("displacement"), off("velocity") if rest else None)
    return Case(recording, {name: truth[name] for name in free}, start, start_release)


@dataclass(frozen=True)
class Outcome:
    """Result of the fit of a case."""

    held: tuple[tuple[str, str, bool], ...]
    """Name of each parameter, kind of its interval, and True if the interval holds the truth."""
    converged: bool
    lost: bool
    """True if the truth fits better than the result."""
    seconds: float


def outcome(seed: int, count: int, i: int) -> Outcome:
    """Draw the i-th of the cases of a seed, and fit it."""
    case = draw(np.random.default_rng(seed).spawn(count)[i])
    begin = time.perf_counter()
    found = fit(case.recording, case.drive, case.release, free=[*case.truth], seed=seed)
    seconds = time.perf_counter() - begin
    rows = []
    for estimate in found.estimates:
        low, high = estimate.interval
        kind = "closed" if isfinite(low) and isfinite(high) else "open"
        if estimate.identifiability is Identifiability.structurally_not:
            kind = "structural"
        rows.append((estimate.name, kind, bool(low <= case.truth[estimate.name] <= high)))
    return Outcome(tuple(rows), found.converged, _lost(found, case), seconds)


def main(count: int, seed: int) -> None:
    """Fit all cases, and print the coverage of the intervals."""
    with ProcessPoolExecutor() as pool:
        done = list(pool.map(partial(outcome, seed, count), range(count)))
    tally = Counter((kind, held) for each in done for _, kind, held in each.held)
    print(f"{count} recordings, seed {seed}")
    held, closed = tally["closed", True], tally["closed", True] + tally["closed", False]
    print(f"closed intervals: {held} of {closed} hold the truth, {100 * held / closed:.2f} %")
    open_held = tally["open", True]
    print(f"open intervals: {open_held} of {open_held + tally['open', False]} hold it")
    print(f"called structurally not identifiable: {tally['structural', True]}")
    print(f"not converged, and said so: {sum(not each.converged for each in done)}")
    lost = [i for i, each in enumerate(done) if each.lost]
    print(f"converged where the truth fits better: {len(lost)} {lost[:10]}")
    for name in (*ALWAYS, *SOMETIMES):
        own = [row[2] for each in done for row in each.held if row[:2] == (name, "closed")]
        if own:
            print(f"  {name:16} {sum(own):4d} of {len(own):4d}  {100 * np.mean(own):.1f} %")
    times = [each.seconds for each in done]
    print(f"time of a fit: median {np.median(times):.2f} s, longest {max(times):.2f} s")


def _lost(found: Fit, case: Case) -> bool:
    """True if the truth fits better than the result."""
    truth = np.array([case.truth[e.name] for e in found.estimates])

    def cost(theta: Array) -> float:
        off = found.model.predict(theta) - found.model.data
        return sum(
            float(np.sum(off[block.place] ** 2)) / left.noise**2
            for block, left in zip(found.model.blocks, found.residuals, strict=True)
        )

    return cost(truth) < cost(found.theta) - 1e-3


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:3]]
    main(*given, *(COUNT, SEED)[len(given) :])

"""Random motions without a closed form, beside forty digits: KIND COUNT SEED.

    cd tests && ../.venv/bin/python -m oracle.random_cases load 200 1

KIND is `load`, a friction curve at the plate under a load that changes; `skin`, a friction curve on
a compliant finger; `skin_load`, a compliant finger under a load that changes; or `oblique`, a hand
that wobbles across the axis. A draw whose answer is ill-conditioned is discarded. The seeds that
are off are named, if any are.
"""

from __future__ import annotations

import math
import multiprocessing
import random
import sys
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from core import test_oracle_piecewise as piecewise
from oracle import make_piecewise, mp_oblique, mp_piecewise, mp_slider, oblique_draws, slider_draws
from oracle.answers import Told, told_events
from oracle.mp_modes import DoubtError

CLOSE = 1e-11  # of the scales of position, velocity and force, and of a radian of the frequency

Case = dict[str, Any]
Path = mp_oblique.Path | mp_piecewise.Path | mp_slider.Path


def under_load(seed: int) -> tuple[Case, Path]:
    case, _ = make_piecewise.make((seed, 0), series=True)
    return case, mp_piecewise.solve(case["inputs"], case["duration"])


def drawn(
    draw: Callable[[random.Random], Case], solve: Callable[[Any, float], Path], seed: int
) -> tuple[Case, Path]:
    """The first well-conditioned draw of a seed, and its answer."""
    rng = random.Random(seed)
    while True:
        case = draw(rng)
        try:
            return case, solve(case["inputs"], case["duration"])
        except DoubtError:
            continue


KINDS: dict[str, Callable[[int], tuple[Case, Path]]] = {
    "load": under_load,
    "skin": partial(drawn, slider_draws.draw, mp_slider.solve),
    "skin_load": partial(drawn, slider_draws.draw_load, mp_slider.solve),
    "oblique": partial(drawn, oblique_draws.draw, mp_oblique.solve),
}


def events(case: Case, reported: list[Told]) -> list[list[Told]]:
    """Return the events that both report: none of an oblique plate or of an unloaded contact."""
    if "across" in case["inputs"]:
        reported = [event for event in reported if event[1] != "plate"]
    reported = piecewise.carried(case, reported)
    return piecewise.instants([event for event in reported if event[0] < case["duration"]])


def deviation(case: Case, path: Path) -> float:
    """Return the deviation of the core relative to the scales; infinity: other events."""
    motion = piecewise.release(case)
    reported = events(case, told_events(motion))
    answer: list[Told] = [
        (float(e.time), e.contact, e.kind, float(e.position), float(e.velocity))
        for e in path.events
    ]
    true = events(case, answer)
    if len(reported) != len(true) or not all(map(piecewise.alike, reported, true)):
        return math.inf
    times = np.linspace(0.0, case["duration"], 41)
    states = np.array([path.state(float(t)) for t in times], float).T
    x, v = states[:2]
    frequency = piecewise.natural_frequency(case)
    moves = max(abs(v) for _, v in case["inputs"]["mouse_velocity"])
    speed = max(np.abs(v).max(), moves, frequency * np.abs(x).max())
    off = [
        np.abs(motion.position(times) - x).max() * frequency / speed,
        np.abs(motion.velocity(times) - v).max() / speed,
        *(frequency * abs(a[0][0] - b[0][0]) for a, b in zip(reported, true, strict=True)),
    ]
    if isinstance(path, mp_slider.Path):
        force = states[2]
        late = np.abs(motion.force("finger", times) - force).max()
        off.append(late / max(np.abs(force).max(), case["inputs"]["stiffness"] * np.abs(x).max()))
    return float(max(off))


def judged(kind: str, seed: int) -> tuple[float, int]:
    """Deviation and events."""
    case, path = KINDS[kind](seed)
    return deviation(case, path), len(path.events)


def main(kind: str, count: int, seed: int) -> int:
    seeds = range(seed, seed + count)
    with multiprocessing.Pool(2) as pool:
        found = pool.map(partial(judged, kind), seeds, chunksize=4)
    worst, events = (list(column) for column in zip(*found, strict=True))
    print(f"{count} motions of {kind}, {sum(events)} events: within {max(worst):.1e}")
    bad = [one for one, off in zip(seeds, worst, strict=True) if not off <= CLOSE]
    if bad:
        print(f"off by more than {CLOSE:g}: seeds {bad}")
    return 1 if bad else 0


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in KINDS:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))

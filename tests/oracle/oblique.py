"""Random oblique motions of the core beside forty digits: COUNT SEED.

    cd tests && ../.venv/bin/python -m oracle.oblique 200 1

The hand wobbles across: w is piecewise linear through zero, slow or fast, while the pin slips,
creeps, turns, or rests on the finger. A draw whose answer is ill-conditioned is discarded.
"""

from __future__ import annotations

import math
import multiprocessing
import random
import sys
from typing import Any

import numpy as np
from mpmath import mpf

from core import test_oracle_piecewise as piecewise
from oracle.mp_modes import DoubtError
from oracle.mp_oblique import Path, solve

CLOSE = 1e-11  # of the scales of position and velocity, and of a radian of the natural frequency


def short(value: float) -> float:
    return float(f"{value:.4g}")


def draw(rng: random.Random) -> dict[str, Any]:
    mass, omega = short(10 ** rng.uniform(-3, -1.5)), 10 ** rng.uniform(1.5, 2.7)
    speed = short(10 ** rng.uniform(-2, -0.5))
    stiffness = short(mass * omega**2)
    duration = short(rng.uniform(0.8, 2.5) * math.pi / omega)
    size = stiffness * speed / omega
    plate = short(size * 10 ** rng.uniform(-0.5, 0.7))
    layers = plate / mass * duration / 250  # a thinner layer takes the oracle too many steps
    aslant = max(layers, speed * math.tan(math.radians(10 ** rng.uniform(0, 1.5))))
    times = [0.0, *sorted(short(duration * rng.uniform(0.1, 0.9)) for _ in range(2)), duration]
    side = rng.choice([-1, 1])
    across = [short(side * (-1) ** i * aslant * rng.uniform(0.3, 1)) for i in range(4)]
    mouse = [short(speed * rng.uniform(0.6, 1.2)) for _ in range(3)]
    finger = short(size * rng.uniform(0.05, 0.4)) if rng.random() < 0.6 else 0.0
    return {
        "duration": duration,
        "family": "oblique",
        "inputs": {
            "mass": mass,
            "stiffness": stiffness,
            "damping": short(2 * mass * omega * rng.choice([0.0, 10 ** rng.uniform(-2, 0)])),
            "displacement": short(rng.uniform(-0.5, 0.5) * speed / omega),
            "velocity": short(speed * rng.uniform(-0.5, 1.2)),
            "skin_stretch": None,
            "mouse_velocity": [[0.0, mouse[0]], [short(duration / 3), mouse[1]],
                               [duration, mouse[2]]],
            "across": [list(row) for row in zip(times, across, strict=True)],
            "load": [[0.0, 1.0], [duration, short(rng.uniform(0.5, 1.5))]],
            "force": [[0.0, 0.0], [duration, short(size * rng.uniform(-0.3, 0.3))]],
            "plate": {"curve": [[0.0, plate]], "static": plate, "stiffness": None},
            "finger": {"curve": [[0.0, finger]], "static": short(finger * rng.choice([1.0, 1.5])),
                       "stiffness": None},
        },
    }  # fmt: skip


def answered(seed: int) -> tuple[dict[str, Any], Path]:
    """The first well-conditioned draw of a seed, and its answer."""
    rng = random.Random(seed)
    while True:
        case = draw(rng)
        try:
            return case, solve(case["inputs"], case["duration"])
        except DoubtError:
            continue


def deviation(case: dict[str, Any], path: Path) -> float:
    """How far the core is from the answer, as a part of the scales; infinity: other events."""
    motion = piecewise.release(case)
    told = [e for e in motion.events if e.contact == "finger"]
    if [e.kind for e in told] != [e.kind for e in path.events]:
        return math.inf
    times = np.linspace(0.0, case["duration"], 41)
    true = np.array([path.state(mpf(t)) for t in times], float).T
    frequency = piecewise.natural_frequency(case)
    moves = max(abs(v) for _, v in case["inputs"]["mouse_velocity"])
    speed = max(np.abs(true[1]).max(), moves, frequency * np.abs(true[0]).max())
    worst = max(
        np.abs(motion.position(times) - true[0]).max() * frequency / speed,
        np.abs(motion.velocity(times) - true[1]).max() / speed,
    )
    late = [float(abs(e.time - t.time)) for e, t in zip(told, path.events, strict=True)]
    return float(max([worst, *(frequency * by for by in late)]))


def judged(seed: int) -> tuple[float, int, int]:
    """Deviation, events, and instants at which u and w are zero at once."""
    case, path = answered(seed)
    return deviation(case, path), len(path.events), path.met


def main(count: int, seed: int) -> int:
    with multiprocessing.Pool(2) as pool:
        found = pool.map(judged, range(seed, seed + count), chunksize=4)
    worst, events, met = (list(column) for column in zip(*found, strict=True))
    bad = [seed + i for i, off in enumerate(worst) if not off <= CLOSE]
    print(
        f"{count} oblique motions, {sum(events)} events, {sum(met)} times through u = w = 0: "
        f"within {max(worst):.1e}" + (f"; seeds {bad}" if bad else "")
    )
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2])))

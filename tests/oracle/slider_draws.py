"""Random motions on a compliant finger with a friction curve."""

from __future__ import annotations

import math
import random
from typing import Any

from oracle.make_cases import short


def curve(rng: random.Random, force: float, speed: float) -> list[list[float]]:
    """Rows that rise and fall, then rise for ever or stay on a plateau."""
    u, f = 0.0, force
    rows = [[u, short(f)]]
    for _ in range(rng.randint(1, 3)):
        u += speed * 10 ** rng.uniform(-1.3, 0)
        f *= rng.choice([rng.uniform(0.4, 0.9), rng.uniform(1.1, 2.0)])
        rows.append([short(u), short(f)])
    if len(rows) > 2 and rng.random() < 0.4:
        rows.append([short(2 * u), short(f)])
    elif rows[-1][1] < rows[-2][1]:
        rows.append([short(u + speed * rng.uniform(0.2, 1)), short(f * rng.uniform(1.2, 2.5))])
    return rows


def draw_load(rng: random.Random) -> dict[str, Any]:
    """Draw a drive under a varying touch force, or Coulomb friction with a varying load."""
    case = draw(rng)
    pin, duration = case["inputs"], case["duration"]
    loads = [short(rng.uniform(0.3, 1.8)) for _ in range(4)]
    finger = pin["finger"]
    if rng.random() < 0.4:
        force = finger["curve"][0][1]
        finger["curve"] = [[0.0, force], [1.0, force]]
        loads[rng.randint(1, 3)] = 0.0
    times = [0.0, *sorted(short(duration * rng.uniform(0.05, 0.9)) for _ in range(3))]
    if rng.random() < 0.5:
        times[2] = times[1]
    pin["finger_load"] = [list(row) for row in zip(times, loads, strict=True)]
    pin["skin_stretch"] *= loads[0]
    return case


def draw(rng: random.Random) -> dict[str, Any]:
    mass, omega = short(10 ** rng.uniform(-3, -1.5)), 10 ** rng.uniform(1.5, 2.7)
    speed = short(10 ** rng.uniform(-2, -0.5))
    stiffness = short(mass * omega**2)
    size = stiffness * speed / omega
    duration = short(rng.uniform(0.7, 2.0) * 2 * math.pi / omega)
    times = [0.0, *sorted(short(duration * rng.uniform(0.1, 0.9)) for _ in range(2))]
    mouse = [short(speed * rng.uniform(-1.5, 1.5)) for _ in times]
    load = [short(rng.uniform(0.2, 2.0)) for _ in times]
    plate = short(size * 10 ** rng.uniform(-1, 0.6))
    rows = curve(rng, size * 10 ** rng.uniform(-1, 0), speed)
    static = short(rows[0][1] * rng.choice([1.0, rng.uniform(1.05, 2.0)]))
    skin = short(stiffness * 10 ** rng.uniform(-0.5, 1.0))
    return {
        "duration": duration,
        "family": "curve on skin",
        "inputs": {
            "mass": mass,
            "stiffness": stiffness,
            "damping": short(2 * mass * omega * rng.choice([0.0, 10 ** rng.uniform(-2, 0)])),
            "displacement": short(rng.uniform(-1.5, 1.5) * speed / omega),
            "velocity": short(speed * rng.uniform(-1, 1)),
            "skin_stretch": short(static / skin * rng.uniform(-0.9, 0.9)),
            "mouse_velocity": [list(row) for row in zip(times, mouse, strict=True)],
            "load": [list(row) for row in zip(times, load, strict=True)],
            "plate": {"curve": [[0.0, plate]], "static": short(plate * rng.choice([1.0, 1.4])),
                      "stiffness": None},
            "finger": {"curve": rows, "static": static, "stiffness": skin},
        },
    }  # fmt: skip

"""Random motions under a hand that wobbles across the axis.

w is piecewise linear through zero, slow or fast, while the pin slips, creeps, turns, or rests on
the finger.
"""

from __future__ import annotations

import math
import random
from typing import Any

from oracle.make_cases import short


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

"""The modes of `mp_laws` under CVODE of SUNDIALS, in floating point."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import Any

import numpy as np
from mpmath import fp

from oracle import mp_laws
from oracle.mp_laws import Pin
from oracle.sundials_modes import cvode
from oracle.watched_dop853 import State, Watch

TOLERANCE = 1e-10  # of event times and states, of their scales
PARTS = 20  # steps in the shortest period
LEFT = 1e-9  # of its scale: a guard no larger has just been left


def follow(
    pin: Pin, t: float, state: tuple[float, float], end: float
) -> tuple[float, tuple[float, float], str | None]:
    """As `mp_laws.extrapolated`, up to the end."""
    speed = max(abs(state[1]), pin.fastest * abs(state[0]), abs(pin.at("mouse_velocity", t)))
    scales = dict.fromkeys(("plate", "finger"), speed)

    def value(name: str, u: float, z: State) -> float:
        return float(pin.guards(u, (z[0], z[1]))[name])

    watches = []
    for name, start in pin.guards(t, state).items():
        scale = scales.get(name, pin.stiffness * speed / pin.fastest)
        watches.append(Watch(name, "", partial(value, name), scale, abs(start) <= LEFT * scale))
    reached, y, which, _ = cvode(
        lambda u, z: np.array([z[1], pin.acceleration(u, z[0], z[1])]),
        watches,
        t,
        np.array(state),
        end,
        2 * pi / pin.fastest / PARTS,
        1e-13 * np.array([speed / pin.fastest, speed]),
        [],
    )
    return reached, (float(y[0]), float(y[1])), which.contact if which else None


def solve(case: dict[str, Any]) -> dict[str, Any]:
    """Events and states of a case of `make_laws`."""
    return mp_laws.solve(case, context=fp, follow=follow)

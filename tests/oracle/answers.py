"""Comparison of the events and states of a motion with the stored answer of an oracle."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive import Motion

TIME_TOLERANCE = 1e-10  # s, of event times
STATE_TOLERANCE = 1e-10  # of the scales of the quantities

Case = dict[str, Any]
Told = tuple[float, str, str, float, float]  # time, contact, kind, position, velocity


def told_events(motion: Motion) -> list[Told]:
    """All events up to the duration: of a stick-slip cycle the core tells one round."""
    events: list[Told] = [
        (e.time, e.contact, e.kind, e.position, e.velocity) for e in motion.events
    ]
    if motion.ending.cycle != "stick-slip":
        return events
    period, last = motion.ending.period, events[-1][0]
    one_round = [event for event in events if event[0] > last - period * (1 - 1e-9)]
    rounds = int(max(0.0, motion.duration - last) / period) + 1
    events += [(e[0] + n * period, *e[1:]) for n in range(1, rounds + 1) for e in one_round]
    return [event for event in events if event[0] < motion.duration]


def event_deviations(
    name: str,
    pairs: Iterable[tuple[Told, Told]],
    scales: Mapping[str, float],
    time_tolerance: float,
    state_tolerance: float,
) -> list[str]:
    """Return the deviations of pairs of events, by the scales of x and v."""
    found = []
    for event, true in pairs:
        for what, column, allowed in (
            ("time", 0, time_tolerance),
            ("position", 3, state_tolerance * scales["x"]),
            ("velocity", 4, state_tolerance * scales["v"]),
        ):
            off = abs(float(event[column]) - float(true[column]))
            if not off <= allowed:
                found.append(f"{name}: {true[1]} {true[2]} at {true[0]} s, {what} off {off}")
    return found


def state_deviations(
    name: str,
    case: Case,
    states: Mapping[str, NDArray[np.float64]],
    scales: Mapping[str, float],
    tolerance: float,
) -> list[str]:
    """Return the deviations of quantities at the times of the case, by the names of the case."""
    found = []
    for what, values in states.items():
        offs = np.abs(values - case[what]) / scales[what]
        worst = int(np.argmax(offs))
        if not offs[worst] <= tolerance:
            time = case["times"][worst]
            found.append(f"{name}: {what} at {time} s off {offs[worst]} of its scale")
    return found

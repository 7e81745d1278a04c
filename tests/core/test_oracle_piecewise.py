"""The core on piecewise-linear drives, against three oracles that share no code with it.

`oracle/piecewise_cases.json.gz` holds random cases in named families, answered with thirty digits
by `oracle/mp_piecewise.py`. `oracle/explicit_piecewise.py` integrates the same physics live, with
SciPy, and through `oracle/sundials_modes.py` with SUNDIALS.
"""

from __future__ import annotations

from itertools import pairwise
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle import explicit_piecewise, make_piecewise, mp_piecewise, sundials_modes
from oracle.answers import (
    STATE_TOLERANCE,
    TIME_TOLERANCE,
    Case,
    Told,
    event_deviations,
    state_deviations,
    told_events,
)
from pindrive import Contact, Drive, Motion, Profile, Release, simulate

SAME_INSTANT = 1e-12  # s
STATES = ("x", "v", "a", "finger_force", "stretch")


DATA = make_piecewise.load(Path(__file__).parents[1] / "oracle" / "piecewise_cases.json.gz")
CASES: list[Case] = DATA["cases"]
NUMBERS = {id(case): number for number, case in enumerate(CASES)}


def name(case: Case) -> str:
    return f"case {NUMBERS.get(id(case), 'of another file')} ({case.get('family', 'no family')})"


def natural_frequency(case: Case) -> float:
    return float((case["inputs"]["stiffness"] / case["inputs"]["mass"]) ** 0.5)


def scales(case: Case) -> dict[str, float]:
    """Return the scales: of x the largest of the oracle; of v and a with mouse and frequency."""
    pin, frequency = case["inputs"], natural_frequency(case)
    length = max(map(abs, case["x"]))
    moves = (abs(velocity) for _, velocity in pin["mouse_velocity"])
    speed = max(frequency * length, *moves, abs(pin["velocity"] or 0.0))
    force = max(pin["stiffness"] * length, *map(abs, case["finger_force"]))
    return {
        "x": length,
        "v": speed,
        "a": frequency * speed,
        "finger_force": force,
        "stretch": length,
    }


def profile(rows: list[list[float]]) -> float | Profile:
    """A plain number where nothing changes, so that both ways of asking are used."""
    times, values = zip(*rows, strict=True)
    return float(values[0]) if len(rows) == 1 else Profile(times, values)


def contact(rows: Case) -> Contact:
    curve = [(speed, force) for speed, force in rows["curve"]]
    return Contact(
        curve[0][1],
        rows["static"],
        curve if len(curve) > 1 else None,
        rows["stiffness"] or inf,
    )


def release(case: Case) -> Motion:
    pin = case["inputs"]
    return simulate(
        Drive(
            mass=pin["mass"],
            stiffness=pin["stiffness"],
            damping=pin["damping"],
            plate=contact(pin["plate"]),
            finger=contact(pin["finger"]),
        ),
        Release(
            profile(pin["mouse_velocity"]),
            pin["displacement"],
            velocity=pin["velocity"],
            plate_load=profile(pin["load"]),
            skin_stretch=pin["skin_stretch"],
            force=profile(pin.get("force", [[0.0, 0.0]])),
            across_velocity=profile(pin.get("across", [[0.0, 0.0]])),
            finger_load=profile(pin.get("finger_load", [[0.0, 1.0]])),
        ),
        duration=case["duration"],
    )


def instants(events: list[Told]) -> list[list[Told]]:
    """Events grouped by the instant at which they happen."""
    groups: list[list[Told]] = []
    for event in events:
        if groups and event[0] - groups[-1][0][0] < SAME_INSTANT:
            groups[-1].append(event)
        else:
            groups.append([event])
    return groups


def carried(case: Case, events: list[Told]) -> list[Told]:
    """Return the events without events of an absent contact."""
    loads = {"plate": case["inputs"]["load"], "finger": case["inputs"].get("finger_load")}
    absent = {name for name, rows in loads.items() if rows and not any(value for _, value in rows)}
    left = {"both": next(iter({"plate", "finger"} - absent))} if absent else {}
    of: list[Told] = [(e[0], left.get(e[1], e[1]), *e[2:]) for e in events]
    return [event for event in of if event[1] not in absent]


def alike(reported: list[Told], true: list[Told]) -> bool:
    """Return True if each contact changes alike at one instant."""

    def kinds(events: list[Told]) -> set[tuple[str, str]]:
        each = {"both": ("plate", "finger")}
        return {
            (c, kind) for _, contact, kind, _, _ in events for c in each.get(contact, (contact,))
        }

    return kinds(reported) == kinds(true)


def deviations(
    case: Case,
    events: list[Told],
    states: dict[str, NDArray[np.float64]],
    time_tolerance: float,
    state_tolerance: float,
) -> list[str]:
    """Return the deviations from the stored answer; `states` are at its times."""
    reported, stored = (instants(carried(case, these)) for these in (events, case["events"]))
    if len(reported) != len(stored) or not all(map(alike, reported, stored)):
        lists = ([f"{e[1]} {e[2]}" for e in es] for es in (events, case["events"]))
        return ["{}: events {}, the oracle has {}; {}".format(name(case), *lists, case["inputs"])]
    scale = scales(case)
    pairs = ((ours[0], theirs[0]) for ours, theirs in zip(reported, stored, strict=True))
    found = event_deviations(name(case), pairs, scale, time_tolerance, state_tolerance)
    return found + state_deviations(name(case), case, states, scale, state_tolerance)


def of_family(family: str) -> list[Case]:
    return [case for case in CASES if case["family"] == family]


@pytest.mark.parametrize("family", DATA["families"])
def test_core_gives_the_oracle_answers(family: str) -> None:
    found = []
    for case in of_family(family):
        motion, times = release(case), np.array(case["times"])
        states = {
            "x": motion.position(times),
            "v": motion.velocity(times),
            "a": motion.acceleration(times),
            "finger_force": motion.force("finger", times),
        }
        if "stretch" in case:
            states["stretch"] = motion.stretch(times)
        found += deviations(case, told_events(motion), states, TIME_TOLERANCE, STATE_TOLERANCE)
        if not motion.ending.cycle and motion.segments[-1].mode != case["mode"]:
            found.append(f"{name(case)}: ends in {motion.segments[-1].mode}, not {case['mode']}")
    assert not found, "\n".join(found)


def check_live(case: Case, oracle: Any, tolerances: Any) -> None:
    run = oracle.solve(case["inputs"], case["duration"], case["times"])
    rows = dict(zip(STATES, np.array(run.rows).T, strict=True))
    assert not deviations(
        case,
        run.events,
        {what: rows[what] for what in STATES if what in case},
        tolerances.PHASE_TOLERANCE / natural_frequency(case),
        tolerances.STATE_TOLERANCE,
    )
    assert run.mode == case["mode"]


def cheapest_with_events(family: str) -> Case:
    """Return the case with the softest skin among cases with many events."""
    cases = sorted(of_family(family), key=lambda case: -len(case["events"]))
    half = cases[: (len(cases) + 1) // 2]
    return min(half, key=lambda case: case["inputs"]["finger"]["stiffness"] or 0.0)


@pytest.mark.parametrize("family", DATA["families"])
def test_explicit_modes_give_the_oracle_answers(family: str) -> None:
    check_live(cheapest_with_events(family), explicit_piecewise, explicit_piecewise)


def stepped(rows: list[list[float]]) -> list[list[float]]:
    """Return the rows with each value held until the next row."""
    found = [rows[0]]
    for (_, held), (time, value) in pairwise(rows):
        found += [[time, held], [time, value]]
    return found


STEPPED = [case for case in CASES if len(case["inputs"]["load"]) > 2][::3]


@pytest.mark.parametrize("case", STEPPED, ids=lambda case: name(case))
def test_a_load_in_steps_is_that_of_explicit_modes(case: Case) -> None:
    """Magnet switched on and off: the cases with loads held from row to row."""
    inputs = {**case["inputs"], "load": stepped(case["inputs"]["load"])}
    run = explicit_piecewise.solve(inputs, case["duration"], case["times"])
    answer = {**case, "inputs": inputs, "events": run.events}
    answer |= dict(zip(STATES, np.array(run.rows).T, strict=True))
    motion, times = release(answer), np.array(case["times"])
    assert not deviations(
        answer,
        told_events(motion),
        {"x": motion.position(times), "v": motion.velocity(times)},
        explicit_piecewise.PHASE_TOLERANCE / natural_frequency(case),
        explicit_piecewise.STATE_TOLERANCE,
    )
    assert motion.certificate().worst < 1e-9


@pytest.mark.parametrize("family", DATA["families"])
def test_sundials_gives_the_oracle_answers(family: str) -> None:
    check_live(cheapest_with_events(family), sundials_modes, sundials_modes)


@pytest.mark.parametrize("number", range(0, 60, 10))
def test_stored_answers_are_those_of_the_script(number: int) -> None:
    """Some cheap answers, computed again from their inputs, are equal."""

    def cost(case: Case) -> float:
        pin = case["inputs"]
        stiffness = pin["stiffness"] + (pin["finger"]["stiffness"] or 0.0)
        rate = max((stiffness / pin["mass"]) ** 0.5, pin["damping"] / pin["mass"])
        return float(case["duration"] * rate)

    case = sorted((c for c in CASES if len(c["events"]) > 2), key=cost)[number]
    path = mp_piecewise.solve(case["inputs"], case["duration"])
    events = [
        [float(e.time), e.contact, e.kind, float(e.position), float(e.velocity)]
        for e in path.events
    ]
    assert events == case["events"]
    assert [float(path.state(time)[0]) for time in case["times"]] == case["x"]
    assert path.mode(case["duration"]) == case["mode"]


def test_stored_draws_are_those_of_the_script() -> None:
    """The inputs are drawn anew from count and seed."""
    seed = int(DATA["made_by"].split()[-1])
    case, _ = make_piecewise.make((1, seed))
    assert case == CASES[1]


def test_enough_cases_of_every_kind() -> None:
    assert len(CASES) >= 220
    assert set(DATA["families"]) == set(make_piecewise.FAMILIES)
    assert min(DATA["families"].values()) >= 8
    kinds = {(e[1], e[2]) for case in CASES for e in case["events"]}
    assert kinds >= {
        (contact, kind)
        for contact in ("plate", "finger", "both")
        for kind in ("stick", "slip", "reverse")
    }
    assert {case["mode"] for case in CASES} == {"slip", "carried", "resting"}

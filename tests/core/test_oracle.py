"""The core against two oracles that share no code with it, nor with each other.

`oracle/cases.json.gz` holds random cases in named families, answered with thirty digits by
`oracle/mp_oracle.py`. `oracle/explicit_modes.py` integrates the same physics live with SciPy.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle import explicit_modes, make_cases, mp_oracle
from oracle.answers import (
    STATE_TOLERANCE,
    TIME_TOLERANCE,
    Case,
    Told,
    event_deviations,
    state_deviations,
    told_events,
)
from pindrive import Contact, Drive, Motion, Release, simulate

DATA = make_cases.load(Path(__file__).parents[1] / "oracle" / "cases.json.gz")
CASES: list[Case] = DATA["cases"]
NUMBERS = {id(case): number for number, case in enumerate(CASES)}


def start_velocity(case: Case) -> float:
    velocity = case["inputs"]["velocity"]
    return float(case["inputs"]["mouse_velocity"] if velocity is None else velocity)


def scales(case: Case) -> dict[str, float]:
    """Return the scales of x, v and a.

    Of x, the release displacement, or where that is 0 the largest |x| of the oracle; of v, the
    largest of frequency * that, mouse velocity and start velocity; of a, frequency * that again.
    """
    pin = case["inputs"]
    frequency = (pin["stiffness"] / pin["mass"]) ** 0.5
    length = abs(pin["displacement"]) or max(map(abs, case["x"]))
    speed = max(frequency * length, abs(pin["mouse_velocity"]), abs(start_velocity(case)))
    return {"x": length, "v": speed, "a": frequency * speed}


def release(case: Case) -> Motion:
    pin = case["inputs"]
    drive = Drive(
        mass=pin["mass"],
        stiffness=pin["stiffness"],
        damping=pin["damping"],
        plate=Contact(pin["plate_kinetic"], pin["plate_static"]),
        finger=Contact(pin["finger_kinetic"], pin["finger_static"]),
    )
    return simulate(
        drive,
        Release(pin["mouse_velocity"], pin["displacement"], velocity=pin["velocity"]),
        duration=case["duration"],
    )


def deviations(
    case: Case,
    events: Sequence[Told],
    states: Mapping[str, NDArray[np.float64]],
    time_tolerance: float,
    state_tolerance: float,
) -> list[str]:
    """Return the deviations from the stored answer; `states` are at its times."""
    name = f"case {NUMBERS[id(case)]} ({case['family']})"
    reported, stored = ([f"{e[1]} {e[2]}" for e in es] for es in (events, case["events"]))
    if reported != stored:
        return [f"{name}: events {reported}, the oracle has {stored}; inputs {case['inputs']}"]
    scale, pairs = scales(case), zip(events, case["events"], strict=True)
    found = event_deviations(name, pairs, scale, time_tolerance, state_tolerance)
    return found + state_deviations(name, case, states, scale, state_tolerance)


def of_family(family: str) -> list[Case]:
    return [case for case in CASES if case["family"] == family]


@pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")
@pytest.mark.parametrize("family", DATA["families"])
def test_core_gives_the_oracle_answers(family: str) -> None:
    found = []
    for case in of_family(family):
        motion = release(case)
        times = np.array(case["times"])
        states = {
            "x": motion.position(times),
            "v": motion.velocity(times),
            "a": motion.acceleration(times),
        }
        found += deviations(case, told_events(motion), states, TIME_TOLERANCE, STATE_TOLERANCE)
        if not motion.ending.cycle and motion.segments[-1].mode != case["mode"]:
            found.append(f"case {NUMBERS[id(case)]} ({family}): ends in {motion.segments[-1].mode}")
    assert not found, "\n".join(found)


@pytest.mark.parametrize("family", DATA["families"])
def test_explicit_modes_give_the_oracle_answers(family: str) -> None:
    """The oracles judge each other, on two cases of each family."""
    for case in sorted(of_family(family), key=lambda case: -len(case["events"]))[:2]:
        pin = case["inputs"] | {"velocity": start_velocity(case)}
        run = explicit_modes.solve(pin, case["duration"])
        frequency = (pin["stiffness"] / pin["mass"]) ** 0.5
        states = np.array([run.at(time) for time in case["times"]]).T
        assert not deviations(
            case,
            run.events,
            dict(zip(("x", "v", "a"), states, strict=True)),
            explicit_modes.PHASE_TOLERANCE / frequency,
            explicit_modes.STATE_TOLERANCE,
        )


@pytest.mark.parametrize("number", range(0, 100, 17))
def test_stored_answers_are_those_of_the_script(number: int) -> None:
    """Some cheap answers, computed again from their inputs, are equal."""

    def cost(case: Case) -> float:
        pin = case["inputs"]
        rate = max((pin["stiffness"] / pin["mass"]) ** 0.5, pin["damping"] / pin["mass"])
        return float(case["duration"] * rate)

    case = sorted((c for c in CASES if len(c["events"]) > 2), key=cost)[number]
    path = mp_oracle.solve(make_cases.pin_of(case), case["duration"])
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
    case, _ = make_cases.make((1, seed))
    assert case == CASES[1]


def test_enough_cases_of_every_kind() -> None:
    assert len(CASES) >= 260
    assert set(DATA["families"]) == set(make_cases.FAMILIES)
    assert min(DATA["families"].values()) >= 10
    kinds = {(e[1], e[2]) for case in CASES for e in case["events"]}
    assert kinds >= {
        ("plate", "stick"), ("plate", "slip"), ("plate", "reverse"),
        ("finger", "stick"), ("finger", "reverse"),
        ("both", "stick"), ("both", "reverse"),
    }  # fmt: skip


def test_trap_crosses_instead_of_sticking() -> None:
    """The pin reaches the plate's velocity with more spring force than friction can hold.

    Undamped, with x_d = F/k, the sliding pin moves about x_d or -x_d, so that it meets the plate's
    velocity again at the mirror image of the last meeting. From 10.25 x_d that gives -8.25, 6.25,
    -4.25, 2.25 and -0.25 x_d. Only the last lies within friction's hold, |x| <= x_d; the plate
    carries the pin from there to x_d.
    """
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.01), finger=Contact(0.0))
    x_d, mouse_velocity = 0.01 / 100.0, 0.1
    motion = simulate(drive, Release(mouse_velocity, 10.25 * x_d), duration=1.0)
    assert [e.kind for e in motion.events] == ["reverse"] * 4 + ["stick", "slip"]
    assert {e.contact for e in motion.events} == {"plate"}
    positions = np.array([e.position for e in motion.events]) / x_d
    np.testing.assert_allclose(positions, [-8.25, 6.25, -4.25, 2.25, -0.25, 1.0], atol=1e-9)
    assert all(e.velocity == mouse_velocity for e in motion.events)

"""Motions of pindrive for the cases of `make_laws`, and their comparison with the answers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

import pindrive as pd
from pindrive import InputPiece, InputTerm


def contact(law: dict[str, Any]) -> pd.Contact:
    """The contact of a law."""
    common = {name: law[name] for name in ("kinetic", "static", "viscous")}
    if law["name"] == "coulomb":
        return pd.Contact(**common)
    common |= {"breakaway": law["breakaway"], "stribeck_velocity": law["velocity"]}
    if law["name"] == "hess-soom":
        return pd.HessSoom(**common)
    return pd.Stribeck(**common, exponent=law["exponent"])


def input_of(given: Any) -> float | pd.Profile | pd.Function:
    """An input of a case: a number, rows or pieces."""
    if isinstance(given, dict):
        return pd.Function(
            [
                InputPiece(begin, tuple(polynomial), tuple(InputTerm(*term) for term in terms))
                for begin, polynomial, terms in given["pieces"]
            ]
        )
    value: float = given[0][1]
    return value if len(given) == 1 else pd.Profile(*zip(*given, strict=True))


def motion_of(case: dict[str, Any]) -> pd.Motion:
    """The motion of a case, to its last time."""
    drive = pd.Drive(
        **{name: case[name] for name in ("mass", "stiffness", "damping")},
        plate=contact(case["laws"]["plate"]),
        finger=contact(case["laws"]["finger"]),
    )
    inputs: dict[str, Any] = {name: input_of(given) for name, given in case["inputs"].items()}
    release = pd.Release(**inputs, displacement=case["displacement"], velocity=case["velocity"])
    return pd.simulate(drive, release, duration=case["times"][-1])


def compare(case: dict[str, Any], part: float = 1e-11) -> None:
    """Assert the events and the states of a case, within a part of their scales."""
    motion = motion_of(case)
    found = [
        (event.time, event.contact, event.kind)
        for event in motion.events
        if event.contact in ("plate", "finger")
    ]
    expected = [tuple(event) for event in case["events"]]
    assert [event[1:] for event in found] == [event[1:] for event in expected]
    for (time, *_), (right, *_) in zip(found, expected, strict=True):
        assert time == pytest.approx(right, rel=part, abs=part * case["times"][-1])
    length = max(abs(x) for x, _ in [*case["states"], (case["displacement"], 0.0)])
    frequency = (case["stiffness"] / case["mass"]) ** 0.5
    speed = max(frequency * length, *(abs(v) for _, v in case["states"]))
    for t, (x, v) in zip(case["times"], case["states"], strict=True):
        assert float(motion.position(t, side="left")) == pytest.approx(x, abs=part * length)
        assert float(motion.velocity(t, side="left")) == pytest.approx(v, abs=part * speed)
    assert motion.certificate().worst < 1e-10


def compare_all(cases: Sequence[dict[str, Any]], first: int) -> None:
    """Compare cases, which are numbered from `first` on; a failure names its number."""
    for number, case in enumerate(cases, first):
        try:
            compare(case)
        except AssertionError as error:
            error.add_note(f"case {number}")
            raise

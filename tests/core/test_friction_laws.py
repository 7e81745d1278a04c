"""Motions under named friction laws, beside thirty digits of an oracle that shares no code."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pindrive as pd
from oracle import law_motion, make_laws, sundials_laws

CASES = make_laws.load(Path(__file__).parents[1] / "oracle" / "law_cases.json.gz")


@pytest.mark.parametrize("first", range(0, len(CASES), 100))
def test_thirty_digits(first: int) -> None:
    law_motion.compare_all(CASES[first : first + 100], first)


@pytest.mark.parametrize("case", CASES[:50], ids=range(50))
def test_sundials(case: dict[str, Any]) -> None:
    """An integrator with steps, which knows neither series nor closed forms."""
    law_motion.compare(case | sundials_laws.solve(case), sundials_laws.TOLERANCE)


BELT = {"kinetic": 1.0, "breakaway": 2.0, "stribeck_velocity": 0.05}


@pytest.mark.parametrize(
    ("speed", "period"),
    [(0.1, 0.7098600595197073421534994), (0.3, 0.6341324307950881753054119)],
)
def test_stick_slip_on_a_belt_has_the_period_of_thirty_digits(speed: float, period: float) -> None:
    """Periods of `mp_laws`, from slip to slip."""
    body = pd.Drive(
        mass=1.0,
        stiffness=100.0,
        damping=0.5,
        plate=pd.Stribeck(**BELT),
        finger=pd.Contact(kinetic=0.0),
    )
    ending = pd.simulate(body, pd.Release(mouse_velocity=speed)).ending
    assert ending.cycle == "stick-slip"
    assert ending.period == pytest.approx(period, rel=1e-12)


@pytest.mark.parametrize("across", [0.0, 0.02])
@pytest.mark.parametrize(
    "plate",
    [
        pd.Stribeck(kinetic=0.022, breakaway=0.0265, stribeck_velocity=0.03),
        pd.Contact(0.022, 0.0265),
    ],
)
def test_a_pin_rests_from_its_last_event(plate: pd.Contact, across: float) -> None:
    drive = pd.Drive(
        mass=0.010,
        stiffness=100.0,
        damping_ratio=0.16,
        plate=plate,
        finger=pd.Contact(0.005, 0.0075),
    )
    motion = pd.simulate(drive, pd.Release(0.06, 2e-3, across_velocity=across))
    assert motion.ending.kind == "resting"
    last = motion.events[-1]
    assert (last.contact, last.kind) == ("finger", "stick")
    assert motion.transient.rest_time == last.time


def test_laws_of_large_stribeck_velocity_are_coulomb() -> None:
    release = pd.Release(0.06, 2e-3)

    def of(plate: pd.Contact) -> pd.Motion:
        finger = pd.Contact(0.005, 0.0075)
        return pd.simulate(
            pd.Drive(mass=0.010, stiffness=100.0, damping=0.3, plate=plate, finger=finger), release
        )

    coulomb = of(pd.Contact(0.026))
    for law in (pd.Stribeck, pd.HessSoom):
        motion = of(law(kinetic=0.020, breakaway=0.026, stribeck_velocity=1e6))
        assert [e.kind for e in motion.events] == [e.kind for e in coulomb.events]
        times = [e.time for e in motion.events]
        assert times == pytest.approx([e.time for e in coulomb.events], rel=1e-6)


def test_viscous_friction_of_a_table_and_of_coulomb_is_a_slope() -> None:
    """A viscous part of Coulomb friction is a table of two points."""

    def of(plate: pd.Contact) -> pd.Motion:
        drive = pd.Drive(
            mass=0.010, stiffness=100.0, damping=0.3, plate=plate, finger=pd.Contact(kinetic=0.0)
        )
        return pd.simulate(drive, pd.Release(0.06, 2e-3))

    sloped = of(pd.Contact(curve=[(0.0, 0.02), (1.0, 0.12)]))
    for plate in (
        pd.Contact(0.02, viscous=0.1),
        pd.Contact(curve=[(0.0, 0.02), (1.0, 0.02)], viscous=0.1),
    ):
        motion = of(plate)
        assert [e.time for e in motion.events] == pytest.approx([e.time for e in sloped.events])

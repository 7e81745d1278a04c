"""Endings of systems: against a single pin and formulas; and what may not be claimed."""

from __future__ import annotations

from math import pi, sqrt

import pytest

import pindrive as pd
from pindrive.bodies.ending import forcing


def pin(**contact: object) -> pd.System:
    """A mass on a spring with a damper, rubbing on the ground."""
    system = pd.System()
    system.body("a", 1.0)
    system.spring("a", stiffness=100, damping=0.5)
    system.contact("a", kinetic=1.0, static=2.0, **contact)  # type: ignore[arg-type]
    return system


def test_a_belt_drives_a_mass_as_it_drives_a_single_pin() -> None:
    """Period of stick-slip, found by another solver; a support that moves makes it a drift."""
    drive = pd.Drive(
        mass=1.0, stiffness=100.0, damping=0.5, plate=pd.Contact(1.0, 2.0), finger=pd.Contact(0.0)
    )
    single = pd.simulate(drive, pd.Release(0.05, displacement=0.0))
    assert single.ending.kind == "steady"
    on_belt = pin(velocity=0.05).simulate()
    assert on_belt.ending.kind == "periodic"
    assert on_belt.ending.period == pytest.approx(single.ending.period, rel=1e-10)
    assert repr(on_belt).endswith("500 events, periodic, ok>")
    pulled = pd.System()
    pulled.body("a", 1.0)
    pulled.spring("a", pd.Profile([0.0], ["50 mm/s"]), stiffness=100, damping=0.5)
    pulled.contact("a", kinetic=1.0, static=2.0)
    ending = pulled.simulate().ending
    assert (ending.kind, ending.rounds) == ("drifting", 1)
    assert ending.period == pytest.approx(on_belt.ending.period, rel=1e-10)
    assert ending.velocities["a"] == pytest.approx(0.05, rel=1e-12)


def test_a_force_brings_a_response_of_its_period() -> None:
    system = pin()
    system.force("a", pd.harmonic(0, 4.0, "2 Hz"))
    motion = system.simulate()
    ending = motion.ending
    assert (ending.kind, ending.rounds) == ("periodic", 1)
    assert ending.period == pytest.approx(0.5, rel=1e-15)
    assert ending.residual < 1e-10
    numbers = motion.numbers()
    assert numbers["ending.period"] == ending.period
    assert numbers["body.a.drift"] == 0.0


@pytest.mark.parametrize(("frequency", "rounds"), [(5.7, 2), (4.1, 3), (5.2, 4), (4.5, 0)])
def test_an_impact_oscillator_has_subharmonics_and_chaos(frequency: float, rounds: int) -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.spring("a", stiffness=100, damping=0.4)
    system.contact("a", kinetic=0.02)
    system.force("a", pd.harmonic(0, 1.0, frequency))
    system.stop("a", upper=0.0, restitution=0.8)
    ending = system.simulate(200.0).ending
    assert ending.rounds == rounds
    assert ending.kind == ("periodic" if rounds else "unknown")
    if rounds:
        assert ending.period == pytest.approx(rounds / frequency, rel=1e-12)


def test_two_forces_and_a_sampled_feedback_have_a_common_period() -> None:
    system = pin()
    assert forcing(system) == (0.0, 0.0)
    system.force("a", pd.harmonic(0, 1.0, "2 Hz") + pd.harmonic(0, 1.0, "3 Hz"))
    assert forcing(system)[0] == 0.0
    assert forcing(system)[1] == pytest.approx(1.0, rel=1e-12)
    system.feedback("a", proportional=1.0, period="0.3 s")
    assert forcing(system)[1] == pytest.approx(3.0, rel=1e-12)
    system.force("a", pd.harmonic(0, 1.0, 2.0) + pd.harmonic(0, 1.0, 2.0 * sqrt(2.0)))
    assert str(forcing(system)[1]) == "nan"
    system.force("a", pd.Profile([0.0, 1.0], ["0 N", "1 N"]))
    assert forcing(system)[0] == 1.0
    assert forcing(system)[1] == pytest.approx(0.3, rel=1e-15)


def test_a_damped_mass_settles_and_a_free_one_goes_on() -> None:
    system = pd.System()
    system.body("a", 1.0, position=0.1)
    system.spring("a", stiffness=100, damping=1.0)
    ending = system.simulate().ending
    assert (ending.kind, ending.velocities) == ("settled", {"a": 0.0})
    free = pd.System()
    free.body("a", 1.0, velocity="1 m/s")
    free.body("b", 1.0, velocity="1 m/s")
    ending = free.simulate(3.0).ending
    assert (ending.kind, ending.velocities["b"]) == ("drifting", 1.0)


def test_what_is_not_known_is_not_claimed() -> None:
    """An oscillation for ever without an event, a fall, and an integral that grows in stick."""
    swings = pd.System()
    swings.body("a", 1.0, position=0.1)
    swings.spring("a", stiffness=100)
    assert swings.simulate(2.0 * pi).ending.kind == "unknown"
    with pytest.raises(ValueError, match="the motion neither rests nor repeats"):
        swings.simulate()
    falls = pd.System()
    falls.body("a", 1.0)
    falls.force("a", 1.0)
    assert falls.simulate(1.0).ending.kind == "unknown"
    for period in (0.0, 0.01):
        waits = pd.System()
        waits.body("a", 1.0)
        waits.contact("a", kinetic=1.0, static=1.5)
        waits.feedback("a", proportional=1.0, integral=0.1, reference=0.01, period=period)
        assert waits.simulate(100.0).events == ()
        assert waits.simulate(100.0).ending.kind == "unknown"
    unfinished = pin(velocity=0.05)
    assert unfinished.simulate(1.0).ending.kind == "unknown"


def test_hunting_repeats() -> None:
    """Integral gain and static friction: a cycle that is found without a duration."""
    system = pd.System()
    system.body("slide", 1.0)
    system.contact("slide", kinetic=1.0, static=1.5)
    system.feedback("slide", proportional=100, derivative=12, integral=400, reference=0.01)
    ending = system.simulate().ending
    assert (ending.kind, ending.rounds) == ("periodic", 1)
    longer = system.simulate(200.0)
    slips = [e.time for e in longer.events if e.kind == "slip" and e.after == 1]
    assert slips[-1] - slips[-2] == pytest.approx(ending.period, rel=1e-10)

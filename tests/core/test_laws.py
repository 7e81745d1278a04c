"""Laws that every motion obeys, whatever the drive: no oracle is needed to judge them."""

from __future__ import annotations

from math import inf, isfinite
from sys import float_info

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drives import Case, cases
from pindrive import Contact, Drive, Motion, Release, Status

Run = tuple[list[tuple[float, str, str]], np.ndarray, np.ndarray]


def states(motion: Motion) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    t = np.linspace(0.0, motion.duration, 101)
    return t, motion.position(t), motion.velocity(t)


@given(cases())
def test_energy_ledger_closes(case: Case) -> None:
    motion = case.run()
    ledger = motion.energy
    terms = [
        ledger.kinetic_start,
        ledger.kinetic_end,
        ledger.spring_start,
        ledger.spring_end,
        ledger.plate_work,
        ledger.damper_dissipated,
        ledger.plate_dissipated,
        ledger.finger_dissipated,
    ]
    energy_in = ledger.kinetic_start + ledger.spring_start + max(ledger.plate_work, 0.0)
    assert abs(ledger.residual) <= 1e-12 * max(map(abs, terms))
    for dissipated in terms[5:]:
        assert dissipated >= -1e-15 * energy_in


@given(cases())
def test_certificate_is_clean(case: Case) -> None:
    motion = case.run()
    certificate = motion.certificate()
    # A velocity is rounded to eps of the largest, v. Over the duration T that is a way of eps v T,
    # held against v/omega_0 or more; four times that, as a velocity is a sum of terms.
    rounding = 4.0 * float_info.epsilon * case.drive.natural_frequency * motion.duration
    assert certificate.worst <= 1e-12 + rounding, certificate


@given(cases())
def test_friction_stays_within_its_bounds(case: Case) -> None:
    motion = case.run()
    t = motion.sample_times(400)
    for name, contact, surface in (
        ("plate", case.drive.plate, case.mouse_velocity),
        ("finger", case.drive.finger, 0.0),
    ):
        force = motion.force("plate" if name == "plate" else "finger", t)
        assert np.abs(force).max() <= contact.static_friction * (1 + 1e-12)
        # The power of friction on the sliding is never positive.
        power = force * (motion.velocity(t) - surface)
        speed = np.abs(motion.velocity(t)).max() + abs(surface)
        assert power.max() <= 1e-14 * contact.static_friction * speed


@pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")
@given(cases(), st.integers(-3, 3), st.integers(-3, 3), st.integers(-3, 3))
def test_other_units_give_the_same_motion(case: Case, i: int, j: int, k: int) -> None:
    """Powers of two rescale every number exactly, so the answers agree to the last bit."""
    time, length, mass = 4.0**i, 2.0**j, 2.0**k
    one, other = case.run(), case.rescaled(time, length, mass).run()
    assert [(e.time * time, e.contact, e.kind) for e in one.events] == [
        (e.time, e.contact, e.kind) for e in other.events
    ]
    t, x, v = states(one)
    assert np.array_equal(other.position(t * time), x * length)
    assert np.array_equal(other.velocity(t * time), v * length / time)
    assert other.transient.settling_time == pytest.approx(
        one.transient.settling_time * time, rel=0, abs=0, nan_ok=True
    )


@given(cases())
def test_mirrored_release_gives_the_mirrored_motion(case: Case) -> None:
    one, other = case.run(), case.mirrored().run()
    assert [(e.time, e.contact, e.kind) for e in one.events] == [
        (e.time, e.contact, e.kind) for e in other.events
    ]
    t, x, v = states(one)
    assert np.array_equal(other.position(t), -x)
    assert np.array_equal(other.velocity(t), -v)
    assert other.numbers()["transient.swing"] == pytest.approx(
        one.numbers()["transient.swing"], rel=0, abs=0, nan_ok=True
    )


@given(cases(), st.floats(0.02, 0.98))
def test_a_run_cut_in_two_equals_the_run_in_one(case: Case, part: float) -> None:
    whole = case.run()
    cut = part * whole.duration
    release = Release(case.mouse_velocity, whole.position(cut), whole.velocity(cut))
    second = Case(case.drive, release).run(whole.duration - cut)
    t = np.linspace(0.0, 1.0, 101) * (whole.duration - cut)
    scale = np.abs(whole.position(whole.sample_times(200))).max() + 1e-9
    assert np.abs(second.position(t) - whole.position(cut + t)).max() <= 1e-10 * scale
    # Once the motion has faded into rounding, its last events hang on the rounding of the cut.
    fastest = np.abs(whole.velocity(whole.sample_times(200))).max()
    slips = any(s.mode == "slip" and s.begin <= cut < s.end for s in whole.segments)
    faded = slips and abs(whole.velocity(cut)) < 1e-6 * fastest
    if whole.ending.cycle is None and not faded:
        later = [(e.contact, e.kind) for e in whole.events if e.time > cut]
        assert [(e.contact, e.kind) for e in second.events] == later


@given(cases(), st.floats(0.01, 0.99))
def test_a_shorter_duration_changes_nothing_before_it(case: Case, part: float) -> None:
    whole = case.run()
    duration = part * whole.duration
    short = case.run(duration)
    t = np.linspace(0.0, duration, 51)
    assert np.array_equal(short.position(t, "left"), whole.position(t, "left"))


@given(cases())
def test_left_and_right_limits_agree_in_position_and_velocity(case: Case) -> None:
    motion = case.run()
    times = np.array([e.time for e in motion.events])
    scale = np.abs(motion.position(motion.sample_times(200))).max()
    jump = motion.position(times, "left") - motion.position(times, "right")
    assert np.abs(jump).max(initial=0.0) <= 1e-13 * scale
    for event in motion.events:
        assert motion.position(event.time) == event.position
        assert motion.velocity(event.time) == event.velocity


@given(cases())
def test_every_motion_without_a_duration_has_an_ending(case: Case) -> None:
    motion = case.run()
    assert motion.status == Status.ok
    assert motion.ending.kind != "moving"
    assert motion.transient.settled or motion.release.displacement == motion.ending.position
    assert motion.duration < inf
    ends = motion.ending.steady_since, motion.transient.rest_time, motion.transient.last_event_time
    assert all(time <= motion.duration for time in ends if isfinite(time))
    assert isfinite(motion.ending.steady_since) == (motion.ending.kind == "steady")
    assert isfinite(motion.transient.rest_time) == (motion.ending.kind == "resting")


def test_a_stick_slip_cycle_repeats_for_ever() -> None:
    drive = Drive(
        mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.02, 0.03), finger=Contact(0.0)
    )
    motion = Case(drive, Release(0.1, 1.5e-3)).run()
    assert motion.ending.cycle == "stick-slip"
    t = motion.ending.steady_since + np.linspace(0.0, 1.0, 57)
    for periods in (1, 7, 1000):
        later = motion.position(t + periods * motion.ending.period)
        assert np.abs(later - motion.position(t)).max() < 1e-14 * periods
    assert abs(motion.energy.residual) < 1e-12 * motion.energy.plate_work
    # A cycle that is simulated anew, event by event, is the cycle that was recognised.
    long = Case(drive, Release(0.1, 1.5e-3)).run(20.0)
    half = long.position(10.0), long.velocity(10.0)
    again = Case(drive, Release(0.1, *half)).run()
    assert again.ending.period == pytest.approx(motion.ending.period, rel=1e-13)
    assert again.ending.amplitude == pytest.approx(motion.ending.amplitude, rel=1e-13)


def test_the_undamped_steady_state_grazes_and_does_not_loop() -> None:
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.02), finger=Contact(0.0))
    motion = Case(drive, Release(0.1, 1.5e-3)).run(1000.0)
    assert motion.ending.cycle == "grazing"
    assert len(motion.events) == 5
    assert motion.ending.amplitude == pytest.approx(0.1 / drive.natural_frequency, rel=1e-14)

"""Numbers of a motion compared with dense samples."""

from __future__ import annotations

from math import isfinite, isnan, pi
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given, settings

from drives import Case, cases
from pindrive import Contact, Drive, Motion, Profile, Release, harmonic, simulate

SAMPLES = 20_001


def turning_points(t: np.ndarray, v: np.ndarray) -> list[int]:
    """Samples at which the velocity has just changed its sign, or become zero."""
    direction = np.sign(v)
    return [i for i in range(1, len(t)) if direction[i] != direction[i - 1] != 0]


@given(cases())
@settings(max_examples=60)
def test_numbers_against_samples(case: Case) -> None:
    motion = case.run()
    # Near critical damping a turning point may lie so late that samples up to there see nothing
    # else: a hundred in each natural period see all.
    longest = SAMPLES / 100 * 2 * pi / case.drive.natural_frequency
    if motion.duration > longest:
        motion = case.run(longest)
    t = np.linspace(0.0, motion.duration, SAMPLES)
    x, v = motion.position(t), motion.velocity(t)
    step = t[1]
    size = np.abs(x).max() + step * np.abs(v).max()
    # Between two samples the position changes by this at most.
    near = 2 * step * np.abs(v).max() + 1e-13 * size
    transient = motion.transient
    turns = turning_points(t, v)
    outward = np.sign(
        motion.release.displacement or motion.release.initial_velocity or case.mouse_velocity
    )

    def visible(time: float) -> bool:
        """Return True if samples resolve the sign of the velocity before rounding hides it."""
        return bool(abs(motion.velocity(max(time - step, 0.0))) > 1e-12 * np.abs(v).max())

    if transient.peak_time > 0 and visible(transient.peak_time):
        assert (
            transient.peak_displacement * outward >= motion.release.displacement * outward - 1e-15
        )
        assert transient.peak_time == pytest.approx(t[turns[0]], abs=2 * step)
        assert transient.peak_displacement == pytest.approx(x[turns[0]], abs=near)
    if isfinite(transient.trough_time):
        after = [i for i in turns if t[i] > transient.peak_time + 1.5 * step]
        # A velocity this far below its largest is rounding between two samples.
        seen = bool(after) and abs(v[after[0] - 1]) > 1e-12 * np.abs(v).max()
        if seen and transient.trough_time > transient.peak_time + 3 * step:
            assert transient.trough_time == pytest.approx(t[after[0]], abs=2 * step)
            assert transient.trough_displacement == pytest.approx(x[after[0]], abs=near)
            between = (t >= transient.peak_time) & (t <= transient.trough_time)
            fastest = (-outward * v[between]).max()
            slack = 2 * step * np.abs(motion.acceleration(t)).max()
            assert -outward * transient.return_velocity == pytest.approx(fastest, abs=slack)

    if motion.ending.kind in ("resting", "decaying") and transient.settled:
        band = 0.05 * abs(motion.release.displacement - motion.ending.position)
        outside = np.flatnonzero(np.abs(x - motion.ending.position) > band + 1e-12 * size)
        settled = transient.settling_time
        assert not len(outside) or t[outside[-1]] <= settled + 1e-12
        if settled > 0:
            distance = abs(motion.position(settled) - motion.ending.position)
            assert distance == pytest.approx(band, rel=1e-9, abs=1e-12 * size)

    # Sums are those of the transient, peaks those of the motion.
    end = transient.end_time
    within = np.linspace(0.0, end, SAMPLES)
    speeds, step = motion.velocity(within), within[1]
    names: tuple[Literal["plate", "finger"], ...] = ("plate", "finger")
    for name, surface in zip(names, (case.mouse_velocity, 0.0), strict=True):
        use, sliding = getattr(transient, name), getattr(motion.drive, name)
        if sliding.frictionless:
            assert use.distance_slid == use.dissipated == use.reversals == 0
            continue
        slid = np.trapezoid(np.abs(speeds - surface), within)
        slack = step * np.abs(v).max() * (3 + use.reversals) + 1e-9 * size
        assert use.distance_slid == pytest.approx(slid, abs=slack, rel=1e-4)
        assert use.dissipated == pytest.approx(use.distance_slid * sliding.kinetic, rel=1e-12)
        # A sliding contact's force is constant, a stuck one's runs from end to end.
        ends = np.union1d(motion.sample_times(2), t)
        forces = [np.abs(motion.force(name, ends, side)).max() for side in ("left", "right")]
        assert use.peak_force == pytest.approx(max(forces), rel=1e-12)
        if motion.ending.cycle != "stick-slip":
            stops = [e for e in motion.events if e.kind != "slip" and e.contact in (name, "both")]
            assert use.reversals == len([e for e in stops if e.time <= end])
            stuck = [s for s in motion.segments if getattr(s, name) == 0]
            lasted = [min(s.end, end) - s.begin for s in stuck]
            assert use.time_stuck == pytest.approx(sum(d for d in lasted if d > 0), rel=1e-12)


def example(**changes: float) -> Motion:
    values: dict[str, Any] = {"mouse_velocity": 0.1, "displacement": 1.5e-3, **changes}
    duration = values.pop("duration", None)
    drive = Drive(
        mass=0.01, stiffness=100.0, damping=0.2, plate=Contact(0.02), finger=Contact(0.005)
    )
    return simulate(drive, Release(**values), duration=duration)


def test_not_settled_in_the_duration_is_nan_and_flagged() -> None:
    settled = example()
    cut = example(duration=0.5 * settled.transient.settling_time)
    assert settled.transient.settled
    assert not cut.transient.settled
    assert isnan(cut.transient.settling_time)
    assert cut.ending.kind == "moving"
    assert isnan(cut.ending.position)


def test_wider_band_settles_no_later() -> None:
    motion = example()
    times = [motion.settling_time(band) for band in (0.01, 0.02, 0.05, 0.1, 0.5, 1.0)]
    assert times == sorted(times, reverse=True)
    assert times[2] == motion.transient.settling_time
    assert times[-1] < times[0]
    with pytest.raises(ValueError, match="band must be"):
        motion.settling_time(0.0)
    with pytest.raises(ValueError, match=r"band must be .* at most 1, got 5"):
        motion.settling_time(5)


def test_steady_motion_settles_where_it_begins() -> None:
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.02), finger=Contact(0.0))
    motion = Case(drive, Release(0.1, 1.5e-3)).run()
    assert motion.transient.settling_time == motion.ending.steady_since > 0


@pytest.mark.parametrize(
    ("cycle", "plate"),
    [("free", Contact(0.0)), ("grazing", Contact(0.02)), ("stick-slip", Contact(0.02, 0.03))],
)
def test_steady_motion_against_samples(cycle: str, plate: Contact) -> None:
    """Amplitude and centre belong to one period; no shorter period repeats the motion."""
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.0, plate=plate, finger=Contact(0.0))
    motion = Case(drive, Release(0.1, 1.5e-3)).run()
    ending = motion.ending
    assert ending.cycle == cycle
    t = ending.steady_since + np.linspace(0.0, ending.period, SAMPLES)
    x = motion.position(t)
    assert ending.position == pytest.approx((x.max() + x.min()) / 2, abs=1e-10)
    assert ending.amplitude == pytest.approx((x.max() - x.min()) / 2, abs=1e-10)
    assert motion.position(t + ending.period) == pytest.approx(x, abs=1e-15)
    for part in (2, 3):
        off = np.abs(motion.position(t + ending.period / part) - x)
        assert off.max() > ending.amplitude / 10


def drive_of(mass: float, stiffness: float, damping: float, *contacts: Contact) -> Drive:
    plate, finger = contacts
    return Drive(mass=mass, stiffness=stiffness, damping=damping, plate=plate, finger=finger)


SELF_EXCITED = {
    "points of 10 N, 7 N, 8 N": (
        drive_of(1.0, 1000.0, 0.0, Contact(curve=[(0, 10), (0.1, 7), (1, 8)]), Contact(0.0)),
        Release(0.1, 0.0, velocity=0.0),
    ),
    "points of 5 N, 3 N, 2 N": (
        drive_of(1.0, 100.0, 0.0, Contact(curve=[(0, 5), (0.1, 3), (1, 2)]), Contact(0.0)),
        Release(0.1, 0.0, velocity=0.0),
    ),
    "on skin": (
        drive_of(
            0.02,
            250.0,
            0.02,
            Contact(static=0.024, curve=[(0, 0.020), (0.05, 0.014), (0.1, 0.012)]),
            Contact(0.005, stiffness=300.0),
        ),
        Release(0.1, 1e-3),
    ),
}


@pytest.mark.parametrize("name", SELF_EXCITED)
def test_steady_since_is_the_first_time_from_which_samples_repeat(name: str) -> None:
    motion = simulate(*SELF_EXCITED[name])
    since, period = motion.ending.steady_since, motion.ending.period
    assert motion.ending.kind == "steady"
    assert len(motion.segments) < 1000
    t = since + np.linspace(0.0, 3.0 * period, SAMPLES)
    size = motion.ending.amplitude
    assert motion.position(t + period) == pytest.approx(motion.position(t), abs=3e-8 * size)
    before = np.linspace(max(since - 0.3 * period, 0.0), since, 101)
    whole = np.ceil((t[-1] - since) / period) * period
    off = np.abs(motion.position(before + whole) - motion.position(before))
    assert off.max() > 1e-9 * size
    assert motion.transient.settling_time == since


def test_chaotic_motion_is_irregular_and_ends() -> None:
    drive = drive_of(
        0.5,
        50.0,
        0.01,
        Contact(curve=[(0, 0.02), (0.05, 0.01)]),
        Contact(static=0.05, stiffness=100.0, curve=[(0, 0.02), (0.02, 0.01)]),
    )
    release = Release(0.01, 5e-4, velocity=0.0)
    motion = simulate(drive, release)
    assert motion.ending.kind == "irregular"
    assert motion.ending.cycle is None
    assert len(motion.events) <= 3 * 15360
    assert 0.0 < motion.ending.least_amplitude < motion.ending.amplitude
    assert isnan(motion.ending.steady_since)
    assert not motion.transient.settled
    longer = simulate(drive, release, duration=1.5 * motion.duration)
    assert longer.ending.kind == "irregular"
    assert longer.segments[-1].end == longer.duration


@pytest.mark.parametrize("turns", [0.5, 0.61803])
def test_response_that_never_repeats_is_irregular(turns: float) -> None:
    """Stick-slip on a belt under a vibrating load."""
    drive = drive_of(0.01, 100.0, 0.1, Contact(kinetic=0.02, static=0.15), Contact(0.0))
    vibrating = harmonic(1.0, 0.5, turns * 100.0 / (2.0 * pi))
    motion = simulate(drive, Release(0.05, plate_load=vibrating))
    assert motion.ending.kind == "irregular"
    assert len(motion.segments) < 100_000
    assert 0.0 < motion.ending.least_amplitude < motion.ending.amplitude
    assert motion.certificate().worst < 1e-9


@pytest.mark.parametrize("finger", [Contact(0.005), Contact(0.0), Contact(0.005, stiffness=500.0)])
def test_constant_transverse_velocity_ends(finger: Contact) -> None:
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=finger)
    release = Release(0.1, 1.5e-3, across_velocity=0.05)
    motion, later = (simulate(drive, release, duration=duration) for duration in (None, 1e6))
    for each in (motion, later):
        assert each.ending.kind == ("resting" if finger.kinetic and finger.rigid else "decaying")
        assert len(each.segments) < 1000
    assert later.position(1e6) == pytest.approx(motion.ending.position, rel=1e-9)
    assert later.transient.settling_time == pytest.approx(motion.transient.settling_time, rel=1e-9)
    pull = 0.02 * 0.1 / np.hypot(0.1, 0.05) / 100.0
    if finger.frictionless:
        assert motion.ending.position == pytest.approx(pull, rel=1e-9)


def test_overdamped_pin_approaches_its_trough_for_ever() -> None:
    drive = Drive(
        mass=0.01, stiffness=100.0, damping_ratio=2.0, plate=Contact(0.02), finger=Contact(0.0)
    )
    transient = Case(drive, Release(0.1, 1.5e-3)).run().transient
    assert transient.trough_time == np.inf
    assert transient.trough_displacement == pytest.approx(0.02 / 100.0, rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_a_long_vibration_in_the_skin_against_samples(seed: int) -> None:
    """Some hundred periods in one mode, until a jolt of the mouse ends it."""
    random = np.random.default_rng(seed)
    drive = Drive(
        mass=0.01,
        stiffness=100.0,
        damping=10.0 ** random.uniform(-3.0, -1.5),
        plate=Contact(0.0),
        finger=Contact(0.15, stiffness=10.0 ** random.uniform(2.0, 4.0)),
    )
    jolt = 4.0 + random.uniform(0.0, 0.1)
    drift = random.uniform(-2e-4, 2e-4)
    v = Profile([0.0, 0.5, jolt, jolt + 0.01], [0.05, 0.05, 0.05 + drift, 0.0])
    motion = simulate(drive, Release(v, 2e-3, velocity=0.05))
    assert motion.ending.kind == "decaying"

    t = np.linspace(0.0, motion.duration, 400_001)
    x, step = motion.position(t), motion.duration / 400_000
    size = np.abs(x).max()
    transient = motion.transient
    # What is sampled, and how much more it may be between two samples.
    peak_stretch, between = np.abs(motion.stretch(t)).max(), step * np.abs(motion.velocity(t)).max()
    peak_rate, hastens = np.abs(motion.stretch_rate(t)).max(), np.abs(motion.acceleration(t)).max()
    assert 0.0 <= transient.peak_stretch - peak_stretch <= between
    assert 0.0 <= transient.peak_stretch_rate - peak_rate <= step * hastens
    assert transient.finger.peak_force == pytest.approx(
        drive.finger.stiffness * transient.peak_stretch, rel=1e-12
    )
    for band in (0.02, 0.05, 0.2, 0.6):
        width = band * abs(motion.release.displacement - motion.ending.position)
        outside = np.flatnonzero(np.abs(x - motion.ending.position) > width + 1e-9 * size)
        settled = motion.settling_time(band)
        assert t[outside[-1]] <= settled
        distance = abs(motion.position(settled) - motion.ending.position)
        assert distance == pytest.approx(width, rel=1e-7)


def test_numbers_of_the_transient_do_not_depend_on_the_duration() -> None:
    drive = Drive(
        mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005)
    )
    undamped = Drive(
        mass=0.01, stiffness=100.0, damping=0.0, plate=Contact(0.02, 0.03), finger=Contact(0.0)
    )
    for each in (drive, undamped):
        short, long = (simulate(each, Release(0.1, 1.5e-3), duration=d) for d in (0.5, 5.0))
        assert short.transient.plate == long.transient.plate
        assert short.transient.finger == long.transient.finger
        assert short.ending.plate.power == long.ending.plate.power


def test_steady_motion_is_reported_per_period_and_as_power() -> None:
    resting = simulate(
        Drive(mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005)),
        Release(0.1, 1.5e-3),
    )
    assert resting.transient.end_time == resting.transient.rest_time
    assert resting.ending.plate.power == pytest.approx(0.02 * 0.1, rel=1e-12)
    assert resting.ending.finger.power == 0.0
    assert isnan(resting.ending.plate.dissipated)
    slip = simulate(
        Drive(mass=1.0, stiffness=100.0, damping=0.0, plate=Contact(1.0, 2.0), finger=Contact(0.0)),
        Release(0.1, 0.0),
    )
    period, each = slip.ending.period, slip.ending.plate
    assert slip.transient.end_time == slip.ending.steady_since
    assert each.power == pytest.approx(each.dissipated / period, rel=1e-15)
    assert each.dissipated == pytest.approx(each.distance_slid, rel=1e-12)  # at 1 N
    assert each.time_stuck == pytest.approx(2.0 * 0.01 / 0.1, rel=1e-12)
    assert each.reversals == 1


def test_friction_across_the_axis_is_dissipated_too() -> None:
    drive = Drive(
        mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005)
    )
    hand = 0.1
    angle = np.deg2rad(80.0)
    release = Release(
        hand * np.cos(angle), 1.5e-3, across_velocity=hand * np.sin(angle), velocity=0.0
    )
    motion = simulate(drive, release, duration=0.02)
    slid = motion.transient.plate
    assert slid.dissipated == pytest.approx(0.02 * slid.distance_slid, rel=1e-9)
    assert abs(motion.energy.residual) < 1e-12 * motion.energy.plate_dissipated

"""Formulas of docs/theory.md compared with independent computations."""

from __future__ import annotations

from math import atan2, cos, exp, pi, sin, sqrt

import numpy as np
import pytest
from mpmath import mp, mpf, workdps

from pindrive import Contact, Drive, Profile, Release, simulate

MASS, STIFFNESS, SPEED = 0.010, 100.0, 0.10
OMEGA0 = sqrt(STIFFNESS / MASS)
ABSENT = Contact(kinetic=0.0)


def drive(plate: Contact = ABSENT, finger: Contact = ABSENT, damping: float = 0.0) -> Drive:
    return Drive(mass=MASS, stiffness=STIFFNESS, damping=damping, plate=plate, finger=finger)


def free_motion(of: Drive, x0: float, v0: float, t: float) -> tuple[mpf, mpf]:
    """Position and velocity without friction, from the characteristic roots, to 50 digits."""
    alpha, pull = -mpf(of.damping) / (2 * mpf(of.mass)), mpf(of.stiffness) / mpf(of.mass)
    tau, root = mpf(t), mp.sqrt(alpha**2 - pull)
    decay = mp.exp(alpha * tau)
    gain = mp.re(decay * (mp.sinh(root * tau) / root if root else tau))
    stay = mp.re(decay * mp.cosh(root * tau)) - alpha * gain
    return x0 * stay + v0 * gain, v0 * stay + (2 * alpha * v0 - pull * x0) * gain


@pytest.mark.parametrize(
    "ratio", [0.0, 0.04, 0.7, 1 - 1e-9, 1 - 1e-15, 1.0, 1 + 1e-15, 1 + 1e-9, 1.5, 30.0, 1e4]
)
def test_closed_form_in_every_damping_regime(ratio: float) -> None:
    of = Drive(mass=MASS, stiffness=STIFFNESS, damping_ratio=ratio, plate=ABSENT, finger=ABSENT)
    times = [float(t) for t in np.logspace(-9, np.log10(2.0), 60)]
    for x0, v0 in ((1.5e-3, 0.1), (1.5e-3, -0.15), (0.0, 0.1), (1e-3, 0.0)):
        motion = simulate(of, Release(SPEED, x0, velocity=v0), duration=2.0)
        length = max(x0, abs(v0) / OMEGA0)
        for t in times:
            with workdps(50):
                x, v = free_motion(of, x0, v0, t)
                off = abs(motion.position(t) - x) / length
                too_fast = abs(motion.velocity(t) - v) / (length * OMEGA0)
            # A few roundings, and that of the phase ω t.
            assert off <= 2e-15 + 2e-16 * OMEGA0 * t
            assert too_fast <= 4e-15 + 4e-16 * OMEGA0 * t


def test_growth_in_a_falling_region_and_where_it_ends() -> None:
    """Friction that falls faster than the damper grows: negative damping, until the next row."""
    rest, fall, row = 0.30, -0.80, 0.25  # N, N s/m, m/s
    plate = Contact(kinetic=rest, curve=[(0.0, rest), (row, rest + fall * row), (1.0, 0.1)])
    of = drive(plate, damping=0.3)
    # From near the place where sliding at v = 0 is in balance.
    x0 = (rest - SPEED * -fall) / STIFFNESS + 1e-5
    motion = simulate(of, Release(SPEED, x0, velocity=0.0))
    end = motion.segments[0].end
    assert end * OMEGA0 > 4 * pi
    with workdps(30):
        m, k, c = mpf(MASS), mpf(STIFFNESS), mpf(of.damping) + mpf(fall)
        pull = mpf(rest) + mpf(fall) * mpf(SPEED)
        solution = mp.odefun(
            lambda _, y: [y[1], (pull - c * y[1] - k * y[0]) / m], 0, [mpf(x0), mpf(0)]
        )
        fastest = max(abs(solution(mpf(t))[1]) for t in np.linspace(0.0, end, 40))
        assert fastest <= max(SPEED, row - SPEED)
        leaves = min(abs(solution(mpf(end))[1] - level) for level in (SPEED, SPEED - row))
        assert leaves < 1e-13 * SPEED
        for part in (0.01, 0.3, 0.7, 0.99):
            x, v = solution(mpf(part * end))
            assert motion.position(part * end) == pytest.approx(float(x), rel=2e-14)
            assert motion.velocity(part * end) == pytest.approx(float(v), abs=1e-13 * SPEED)


@pytest.mark.parametrize("damping", [0.08, 0.32, 0.64])
def test_the_papers_extrema_with_the_missing_cosine(damping: float) -> None:
    """Equations (7), (8), (13) to (17), (19) and (20) of the paper, corrected as theory.md says."""
    x0, x_d = 1.5e-3, 2e-4
    of = drive(Contact(kinetic=STIFFNESS * x_d), damping=damping)
    alpha = -damping / (2 * MASS)
    omega = sqrt(OMEGA0**2 - alpha**2)
    wide = sqrt((x0 - x_d) ** 2 + ((SPEED - (x0 - x_d) * alpha) / omega) ** 2)
    phase = atan2(SPEED - alpha * (x0 - x_d), omega * (x0 - x_d))
    lag = atan2(-alpha, omega)
    t_a, t_b = (phase - lag) / omega, (pi / 2 + phase - 2 * lag) / omega
    found = simulate(of, Release(SPEED, x0)).transient
    assert found.peak_time == pytest.approx(t_a, rel=1e-14)
    assert found.peak_displacement == pytest.approx(x_d + exp(alpha * t_a) * wide * cos(lag))
    assert found.trough_time == pytest.approx(t_a + pi / omega, rel=1e-14)
    swing = wide * cos(lag) * exp(alpha * t_a) * (1 + exp(alpha * pi / omega))
    assert found.swing == pytest.approx(swing, rel=1e-14)
    assert found.return_velocity_time == pytest.approx(t_b, rel=1e-13)
    fastest = -exp(alpha * t_b) * OMEGA0 * wide * cos(lag)
    assert found.return_velocity == pytest.approx(fastest, rel=1e-14)
    assert fastest == pytest.approx(
        -exp(alpha * t_b) * OMEGA0 * wide * sin(omega * t_b - phase + lag), rel=1e-13
    )


def test_undamped_reversals_follow_the_recursion_and_end_grazing() -> None:
    """Positions at the plate's velocity: x -> 2 x_d - x, -> -2 x_d - x, until |x| <= x_d."""
    x, x_d = 1.73e-3, 2e-4
    motion = simulate(drive(Contact(kinetic=STIFFNESS * x_d)), Release(SPEED, x))
    expected, side = [], 1
    while abs(x) > x_d:
        x = 2 * side * x_d - x
        expected.append(x)
        side = -side
    *crossings, stick, slip = motion.events
    assert [e.kind for e in crossings] == ["reverse"] * (len(expected) - 1)
    assert (stick.kind, slip.kind) == ("stick", "slip")
    assert [e.position for e in (*crossings, stick)] == pytest.approx(expected, rel=1e-13)
    assert slip.position == pytest.approx(x_d, rel=1e-15)
    assert slip.time - stick.time == pytest.approx((x_d - expected[-1]) / SPEED, rel=1e-13)
    assert motion.ending.cycle == "grazing"
    assert motion.ending.steady_since == slip.time
    assert motion.ending.position == pytest.approx(x_d, rel=1e-15)
    assert motion.ending.amplitude == pytest.approx(SPEED / OMEGA0, rel=1e-15)
    # It touches v_p once a period, and never passes it.
    t = slip.time + 2 * pi / OMEGA0 * np.arange(1, 6)
    assert np.abs(motion.velocity(t) / SPEED - 1).max() < 1e-13


def test_finger_friction_takes_two_x_f_from_each_swing() -> None:
    x_f, x = 1.1e-4, 1.5e-3
    motion = simulate(
        drive(finger=Contact(kinetic=STIFFNESS * x_f)), Release(SPEED, x, velocity=0.0)
    )
    turns = []
    while abs(x) > x_f:
        x = -np.sign(x) * (abs(x) - 2 * x_f)
        turns.append(x)
    assert [e.position for e in motion.events] == pytest.approx(turns, rel=1e-12)
    assert motion.transient.rest_time == pytest.approx(len(turns) * pi / OMEGA0, rel=1e-14)


def test_stick_slip_repeats_one_release() -> None:
    """Static above kinetic friction: every release has k x + b v_p = static, so it is one cycle."""
    plate = Contact(kinetic=0.02, static=0.05)
    motion = simulate(drive(plate, damping=0.1), Release(0.02, 1.5e-3))
    assert motion.ending.cycle == "stick-slip"
    released = [e for e in motion.events if e.kind == "slip"]
    for event in released:
        assert STIFFNESS * event.position + 0.1 * 0.02 == pytest.approx(0.05, rel=1e-14)
    period, since = motion.ending.period, motion.ending.steady_since
    assert released[1].time - released[0].time == pytest.approx(period, rel=1e-14)
    t = since + np.linspace(0.0, period, 50)
    assert motion.position(t) == pytest.approx(motion.position(t + 3 * period), rel=1e-11)
    # A little earlier it is not yet periodic.
    earlier = since - 0.02 * period
    assert abs(motion.position(earlier) - motion.position(earlier + period)) > 1e-7


@pytest.mark.parametrize("w", [-3.0, 2.0])
def test_two_surfaces_that_part_decide_on_accelerations(w: float) -> None:
    """The force law m a in f - F_p Sgn(a - w) - F_f Sgn(a) has one solution: the middle of five."""
    plate, finger = 0.03, 0.012
    found = set()
    for force in np.linspace(-0.09, 0.09, 61):
        motion = simulate(
            drive(Contact(kinetic=plate), Contact(kinetic=finger)),
            Release(Profile([0.0, 1.0], [0.0, w]), (MASS * w - float(force)) / STIFFNESS),
            duration=1e-4,
        )
        between = np.sign(w) * (plate - finger)
        behind, ahead = force + plate + finger, force - plate - finger
        candidates = sorted([behind / MASS, ahead / MASS, (force + between) / MASS, 0.0, w])
        assert motion.acceleration(0.0) == pytest.approx(candidates[2], abs=1e-12)
        found.add((motion.segments[0].plate, motion.segments[0].finger))
    assert len(found) == 5


def test_energy_at_the_skin() -> None:
    """Each slip of the skin loses what its force falls by: (F_s^2 - F_k^2) / 2 k_s."""
    kinetic, static, stiffness = 0.02, 0.03, 400.0
    motion = simulate(
        drive(finger=Contact(kinetic, static, stiffness=stiffness)), Release(0.0, 1.5e-3)
    )
    slips = sum(e.kind == "slip" for e in motion.events)
    assert slips >= 3
    use = motion.transient.finger
    drop = (static**2 - kinetic**2) / (2 * stiffness)
    assert use.dissipated == pytest.approx(kinetic * use.distance_slid + slips * drop, rel=1e-13)
    assert abs(motion.energy.residual) < 1e-15 * motion.energy.spring_start * 10


def test_a_near_graze_is_as_uncertain_as_its_square_root() -> None:
    """Undamped, from rest with velocity amplitude v_p (1 + d): sin(omega0 t) = 1 / (1 + d)."""
    x_d = 2e-4
    for above in (1e-2, 1e-6, 1e-10):
        wide = SPEED * (1 + above) / OMEGA0
        motion = simulate(
            drive(Contact(kinetic=STIFFNESS * x_d)), Release(SPEED, x_d - wide, velocity=0.0)
        )
        with workdps(40):
            exact = mp.asin(mpf(SPEED) / (OMEGA0 * (mpf(wide))))
            uncertain = 4e-16 / sqrt(above)
            assert abs(OMEGA0 * motion.events[0].time - exact) < 1e-15 + uncertain
    still = simulate(
        drive(Contact(kinetic=STIFFNESS * x_d)),
        Release(SPEED, x_d - SPEED * (1 - 1e-12) / OMEGA0, velocity=0.0),
    )
    assert still.events == ()
    assert still.ending.cycle == "free"

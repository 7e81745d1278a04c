"""Stiff skin against the rigid finger that it tends to: how fast, and where it does not.

The orders and formulas are derived in docs/theory.md, appendix C.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import inf, sqrt, tan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drives import decades
from pindrive import Contact, Drive, Motion, Profile, Release, simulate

MASS, STIFFNESS = 0.010, 100.0
STIFFER = STIFFNESS * 10.0 ** np.arange(3, 10)
STIFFEST = 1e10 * STIFFNESS


@dataclass(frozen=True)
class Case:
    """A release whose skin may be of any stiffness; SI."""

    kinetic: float = 0.005
    static: float | None = None
    plate: Contact = field(default_factory=lambda: Contact(0.02))
    damping: float = 0.4
    mouse_velocity: float | Profile = 0.1
    displacement: float = 1.5e-3
    velocity: float | None = None
    plate_load: float | Profile = 1.0
    duration: float | None = None

    def run(self, skin: float = inf) -> Motion:
        finger = Contact(self.kinetic, self.static, stiffness=skin)
        drive = Drive(
            mass=MASS, stiffness=STIFFNESS, damping=self.damping, plate=self.plate, finger=finger
        )
        return simulate(
            drive,
            Release(
                self.mouse_velocity,
                self.displacement,
                velocity=self.velocity,
                plate_load=self.plate_load,
            ),
            duration=self.duration,
        )


TO_AND_FRO = Profile([0.0, 0.05, 0.1, 0.2], [0.1, 0.1, -0.1, 0.05])
CASES = {
    "crosses, then rests": Case(),
    "slides through thirteen times, undamped": Case(damping=0.0),
    "slides for ever, the mouse brakes": Case(mouse_velocity=TO_AND_FRO, duration=0.3),
    "rests, and the braking mouse shakes it loose": Case(
        mouse_velocity=Profile([0.0, 0.2, 0.21, 0.3], [0.1, 0.1, -0.1, -0.1]), duration=0.5
    ),
    "carried by a plate that holds more than it drags": Case(
        plate=Contact(0.02, 0.05), mouse_velocity=0.03, duration=0.5
    ),
    "a magnet that lets go": Case(plate_load=Profile([0.0, 0.1], [2.0, 0.0]), duration=0.4),
    "a finger that holds more than it drags": Case(kinetic=0.02, static=0.03),
}
ONE_STOP = Case(
    kinetic=0.05,
    plate=Contact(0.0),
    damping=0.0,
    displacement=0.0,
    velocity=0.05,
    duration=0.2,
)


def order(errors: list[float]) -> float:
    """The p of errors that fall like 1 / stiffness^p, over the stiffest three decades."""
    return -float(np.polyfit(np.log(STIFFER[-4:]), np.log(errors[-4:]), 1)[0])


def farthest(case: Case) -> tuple[list[float], list[float]]:
    """The largest deviations from the rigid finger, for stiffer and stiffer skin: m, m/s."""
    rigid = case.run()
    t = rigid.sample_times(4001)
    x, v = rigid.position(t), rigid.velocity(t)
    soft = [case.run(skin) for skin in STIFFER]
    return (
        [float(np.abs(motion.position(t) - x).max()) for motion in soft],
        [float(np.abs(motion.velocity(t) - v).max()) for motion in soft],
    )


# ---- how fast ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_position_and_velocity_tend_to_the_rigid_fingers_as_one_over_the_root(name: str) -> None:
    for errors in farthest(CASES[name]):
        assert all(later < earlier for earlier, later in pairwise(errors))
        assert order(errors) == pytest.approx(0.5, abs=0.02)


def test_without_a_reversal_the_position_tends_as_one_over_the_stiffness() -> None:
    """The pin stops once and is held: no time is won at a crossing, only the ringing is left."""
    x, v = farthest(ONE_STOP)
    assert order(x) == pytest.approx(1.0, abs=0.01)
    assert order(v) == pytest.approx(0.5, abs=0.01)


PLACES = ("transient.trough_displacement", "transient.swing", "transient.return_velocity")
TIMES = ("transient.trough_time", "transient.return_velocity_time", "transient.settling_time")


@pytest.mark.parametrize("case", [Case(), Case(kinetic=0.02, static=0.03)])
def test_numbers_tend_places_faster_than_times(case: Case) -> None:
    """Between constant inputs the path hardly changes, only the times."""
    rigid = case.run().numbers()
    soft = [case.run(skin).numbers() for skin in STIFFER]
    for names, expected in (((*PLACES, "ending.position"), 1.0), (TIMES, 0.5)):
        for name in names:
            errors = [abs(numbers[name] - rigid[name]) for numbers in soft]
            assert order(errors) == pytest.approx(expected, abs=0.05), name
    assert soft[0]["transient.peak_displacement"] == rigid["transient.peak_displacement"]


@pytest.mark.parametrize("damping", [0.0, 0.4])
def test_each_reversal_comes_sooner_by_tan_phi_less_phi(damping: float) -> None:
    """In units of the ringing, sqrt(m / k_skin), with cos phi = acceleration after / before."""
    case = Case(damping=damping)
    rigid, soft = case.run(), case.run(STIFFEST)
    unit = sqrt(MASS / STIFFEST)
    reversals = [e.time for e in rigid.events if e.contact == "finger" and e.kind == "reverse"]
    regrips = [e.time for e in soft.events if e.contact == "finger" and e.kind == "stick"]
    assert len(reversals) >= 4
    sooner = 0.0
    for rigid_time, soft_time in zip(reversals, regrips, strict=False):
        assert (rigid_time - soft_time) / unit == pytest.approx(sooner, abs=1e-3)
        before, after = (rigid.acceleration(rigid_time, side) for side in ("left", "right"))
        phi = float(np.arccos(after / before))
        sooner += tan(phi) - phi
    assert sooner > 0.1


def variation(motion: Motion) -> float:
    """Total variation of the finger's friction, N; within a mode it is monotone.

    A rigid finger carries a constant while it is slid along, and a straight line while it holds.
    """
    inside = [s for s in motion.segments if s.begin < motion.duration]
    begins = [motion.force("finger", s.begin) for s in inside]
    ends = [motion.force("finger", min(s.end, motion.duration), "left") for s in inside]
    walk = np.ravel(np.column_stack([begins, ends]))
    return float(np.abs(np.diff(walk)).sum())


@st.composite
def profiles(draw: st.DrawFn, low: float, high: float) -> float | Profile:
    count = draw(st.integers(1, 5))
    micro = st.integers(round(low * 1e6), round(high * 1e6))
    values = [1e-6 * n for n in draw(st.lists(micro, min_size=count, max_size=count))]
    steps = draw(st.lists(decades(0.01, 0.1), min_size=count, max_size=count))
    return Profile(np.cumsum(steps).tolist(), values) if count > 1 else values[0]


@st.composite
def monotone(draw: st.DrawFn) -> Case:
    """Forces that never fall with speed, damper included, nor from static to kinetic."""
    damping = draw(st.one_of(st.just(0.0), decades(1e-3, 3.0)))
    force = draw(st.one_of(st.just(0.0), decades(1e-3, 0.1)))
    curve = None
    if draw(st.booleans()):
        speed = draw(decades(0.01, 0.2))
        falls = -min(damping * speed, force)
        curve = [(0.0, force), (speed, force + draw(st.floats(falls, 0.05)))]
    return Case(
        kinetic=draw(decades(1e-3, 0.1)),
        plate=Contact(force, curve=curve),
        damping=damping,
        mouse_velocity=draw(profiles(-0.2, 0.2)),
        displacement=draw(st.floats(-3e-3, 3e-3)),
        velocity=draw(st.one_of(st.none(), st.floats(-0.2, 0.2))),
        plate_load=1.0 if curve else draw(profiles(0.0, 2.0)),
        duration=draw(decades(0.05, 0.6)),
    )


@given(monotone(), st.floats(0.0, 8.0))
def test_no_drive_strays_farther_than_the_bound(case: Case, stiffer: float) -> None:
    """(m dv^2 + k dx^2) / 2 <= ((R(0) - R_rigid(0))^2 / 2 + 2 F V) / k_skin, V the variation."""
    skin = STIFFNESS * 10.0**stiffer
    rigid, soft = case.run(), case.run(skin)
    t = rigid.sample_times(500)
    dx, dv = soft.position(t) - rigid.position(t), soft.velocity(t) - rigid.velocity(t)
    strays = (MASS * dv**2 + STIFFNESS * dx**2) / 2
    start = soft.force("finger", 0.0) - rigid.force("finger", 0.0)
    bound = (start**2 / 2 + 2 * case.kinetic * variation(rigid)) / skin
    x, v = (np.abs(f(t)).max() for f in (rigid.position, rigid.velocity))
    rounding = 1e-24 * (MASS * v**2 + STIFFNESS * x**2)
    assert strays.max() <= bound + rounding


# ---- where it does not ---------------------------------------------------------------------------


@pytest.mark.parametrize("skin", STIFFER)
def test_a_held_pin_rings_however_stiff_the_skin(skin: float) -> None:
    """By F - |N| in force, as much as on softer skin: the force has no limit, only its mean has."""
    rigid, soft = ONE_STOP.run(), ONE_STOP.run(skin)
    needed = rigid.force("finger", rigid.transient.rest_time)
    swing = ONE_STOP.kinetic - abs(needed)
    assert soft.ending.cycle == "free"
    t = soft.ending.steady_since + soft.ending.period * np.linspace(0.0, 1.0, 65)
    force = soft.force("finger", t)
    slack = 10 * swing * STIFFNESS / skin
    assert (force.max() + force.min()) / 2 == pytest.approx(needed, abs=slack)
    assert np.ptp(force) / 2 == pytest.approx(swing, abs=slack)
    assert soft.ending.amplitude * skin == pytest.approx(swing, abs=slack)


@pytest.mark.parametrize("skin", STIFFER[::3])
def test_the_damper_alone_stills_the_ringing(skin: float) -> None:
    """Like exp(-b t / 2m), whatever the stiffness: the pin decays where the rigid finger rests."""
    soft = replace(ONE_STOP, damping=0.4).run(skin)
    assert soft.ending.kind == "decaying"
    rate = 0.4 / (2 * MASS)
    period = 2 * np.pi / sqrt((STIFFNESS + skin) / MASS - rate**2)
    count = int(0.03 / period)
    a_period = np.linspace(0.0, period, 65)
    swings = [
        np.ptp(soft.force("finger", soft.transient.last_event_time + begin + a_period))
        for begin in (0.0, count * period)
    ]
    assert swings[1] / swings[0] == pytest.approx(np.exp(-rate * count * period), rel=1e-6)


def held_up_to(kinetic: float, static: float) -> float:
    """The need up to which a stiff skin holds a pin that arrives sliding, N."""
    return max(kinetic, (static - kinetic) / 2)


def test_the_first_swing_breaks_a_grip_that_a_rigid_finger_keeps() -> None:
    """A need between kinetic and static friction: a rigid finger holds the pin.

    Skin is swung beyond its static friction first, and then drags too little, however stiff it is.
    """
    case = Case(kinetic=0.005, static=0.012)
    rigid = case.run()
    needed = abs(rigid.force("finger", rigid.transient.rest_time))
    assert held_up_to(0.005, 0.012) < needed < 0.012
    soft = [case.run(skin) for skin in (*STIFFER, STIFFEST)]
    apart = [abs(motion.ending.position - rigid.ending.position) for motion in soft]
    assert min(apart) > 6e-5
    assert apart[-1] == pytest.approx(apart[-2], rel=1e-6)


@given(
    decades(2e-3, 0.03),
    decades(1.0, 8.0),
    st.one_of(st.just(0.0), decades(0.01, 2.0)),
    st.floats(-3e-3, 3e-3),
)
def test_stiff_skin_approaches_a_rigid_finger_that_stops_less(
    kinetic: float, ratio: float, damping: float, displacement: float
) -> None:
    """Static friction counts as max(F, (S - F) / 2) for a pin that arrives and is held for good."""
    held = held_up_to(kinetic, ratio * kinetic)
    case = Case(kinetic, ratio * kinetic, damping=damping, displacement=displacement)
    limit = replace(case, static=held).run()
    arrivals = [e.time for e in limit.events if e.contact == "finger"]
    for time in arrivals:
        # The need, from the acceleration just before, of a pin that was dragged by -+ F.
        before = MASS * limit.acceleration(time, "left")
        needed = abs(before) - kinetic
        if abs(needed - held) < 1e-3 * held:
            return  # too near to call
    soft = case.run(STIFFEST)
    assert soft.ending.position == pytest.approx(limit.ending.position, abs=1e-10)
    t = np.linspace(0.0, max([*arrivals, 0.01]), 500)
    assert np.abs(soft.position(t) - limit.position(t)).max() < 1e-7

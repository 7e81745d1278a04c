"""Motions without an ending in sight: growth, slow approaches, and the words for them."""

from __future__ import annotations

from math import exp, isnan, pi

import numpy as np
import pytest

from pindrive import Contact, Drive, Motion, Release, Status, Stribeck, harmonic, simulate
from pindrive.cli.tables import ending

NONE = Contact(kinetic=0.0)
LAW = Stribeck(kinetic=4.0, breakaway=6.0, stribeck_velocity=0.05)

pytestmark = pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")


def body(**changes: object) -> Drive:
    given = {"mass": 1.0, "stiffness": 100.0, "damping": 0.0, "plate": NONE, "finger": NONE}
    return Drive(**given | changes)  # type: ignore[arg-type]


def resonance(force: float, **changes: object) -> Motion:
    push = harmonic(0.0, force, 10.0 / (2.0 * pi))
    return simulate(body(**changes), Release(0.0, velocity=0.0, force=push))


def test_resonance_above_the_threshold_of_den_hartog_grows() -> None:
    """Above 4F/π the range grows by 2π/k (F0 - 4F/π) in each period (energy balance)."""
    motion = resonance(1.4, finger=Contact(1.0))
    assert motion.status.name == "ok"
    assert motion.ending.kind == "growing"
    assert motion.ending.period == pytest.approx(0.2 * pi, rel=1e-12)
    assert motion.ending.growth > 1.0
    amplitude = max(abs(motion.position(motion.duration - np.linspace(0.0, 0.7, 1001))))
    each = pi / 100.0 * (1.4 - 4.0 / pi)
    assert motion.ending.growth == pytest.approx(1.0 + each / amplitude, rel=1e-4)
    assert motion.segment_count < 100_000
    assert "growing" in repr(motion)
    assert ending(motion).startswith("Grows by a factor of 1.00")


def test_resonance_below_the_threshold_ends() -> None:
    motion = resonance(1.2, finger=Contact(1.0))
    assert motion.ending.kind == "steady"


@pytest.mark.parametrize("ratio", [1e-3, 3e-4, 1e-4])
def test_response_of_a_weak_damper_is_followed_to_its_end(ratio: float) -> None:
    motion = resonance(1.4, damping=20.0 * ratio)
    assert motion.ending.cycle == "driven"
    assert motion.ending.amplitude == pytest.approx(1.4 / (20.0 * ratio * 10.0), rel=1e-7)


def test_response_of_a_very_weak_damper_approaches_its_limit_by_its_factor() -> None:
    motion = resonance(1.4, damping=20.0 * 1e-5)
    assert motion.ending.kind == "approaching"
    assert motion.ending.growth == pytest.approx(exp(-2.0 * pi * 1e-5), abs=1e-9)
    assert isnan(motion.ending.position)
    assert isnan(motion.transient.settling_time)


def test_body_that_is_all_but_free_approaches_its_rest_slowly() -> None:
    drive = body(stiffness=1e-9, finger=Contact(1.0))
    motion = simulate(drive, Release(0.0, velocity=0.0, force=harmonic(0.0, 2.0, 1.0)))
    assert motion.ending.kind == "approaching"
    assert 1.0 - 1e-9 < motion.ending.growth < 1.0
    assert motion.segment_count < 400_000


def test_algebraic_approach_is_not_called_steady() -> None:
    """Csernák, Stépán and Shaw 2007: at half the natural frequency the multiplier tends to 1."""
    drive = body(stiffness=1.0, finger=Contact(0.1))
    push = harmonic(0.0, 1.0, 0.25 / pi, pi / 2.0)
    motion = simulate(drive, Release(0.0, velocity=0.0, force=push))
    assert motion.ending.kind == "approaching"
    assert 0.999 < motion.ending.growth < 1.0
    assert isnan(motion.ending.position)
    t = motion.duration - np.linspace(0.0, 4.0 * pi, 20_001)
    middle = (motion.position(t).max() + motion.position(t).min()) / 2.0
    assert middle == pytest.approx(-0.7 / 3.0, abs=1e-4)


@pytest.mark.parametrize("speed", [0.1498, 0.149795])
def test_belt_beside_its_hopf_speed_says_how_slowly_it_moves(speed: float) -> None:
    drive = body(mass=0.5, stiffness=800.0, damping=2.0, plate=LAW)
    friction = 4.0 + 2.0 * exp(-speed / 0.05)
    release = Release(speed, displacement=friction / 800.0 + 1e-4, velocity=0.0)
    motion = simulate(drive, release)
    assert motion.status.name == "ok"
    assert motion.ending.kind in ("approaching", "growing", "decaying", "steady")
    assert motion.segment_count < 100_000


def test_motion_to_a_duration_says_that_it_grows() -> None:
    push = harmonic(0.0, 1.4, 10.0 / (2.0 * pi))
    release = Release(0.0, velocity=0.0, force=push)
    motion = simulate(body(finger=Contact(1.0)), release, duration=4000.0)
    assert motion.duration == motion.core.known_until == 4000.0
    assert motion.ending.kind == "growing"


def test_statuses_say_what_to_do() -> None:
    assert "give a duration" in Status.too_many_periods.explanation
    assert "give a shorter duration" in Status.too_many_events.explanation


def test_long_simulation_reports_its_time() -> None:
    push = harmonic(0.0, 1.4, 10.0 / (2.0 * pi))
    release = Release(0.0, velocity=0.0, force=push)
    times: list[float] = []
    motion = simulate(
        body(finger=Contact(1.0)), release, duration=2e5, progress=lambda time: times.append(time)
    )

    def fail(_: float) -> None:
        raise ZeroDivisionError

    assert motion.status == Status.too_many_events
    assert times == sorted(times)
    assert 0.0 < times[0] < times[-1] < motion.core.until
    with pytest.raises(ZeroDivisionError):
        simulate(body(finger=Contact(1.0)), release, duration=2e5, progress=fail)

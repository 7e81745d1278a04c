"""The benchmark beside peers: its models of the peers are right, and its failures are counted."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.racing.modes import Pin, Slid, Slide, follow
from benchmarks.racing.race import (
    TIMES,
    FailureError,
    Lap,
    Racer,
    Result,
    judge,
    one_by_one,
    race,
)
from benchmarks.racing.releases import DURATION, Floats, columns, drawn
from benchmarks.racing.with_pindrive import single
from benchmarks.racing.with_scipy import in_modes, smoothed

DRIVES = columns(drawn(6, seed=5))


def worst(lap: Lap, truth: Floats) -> float:
    assert not lap.failures
    return float((np.abs(lap.positions - truth).max(axis=1) / DRIVES[-1]).max())


@pytest.fixture(scope="module")
def truth() -> Floats:
    return one_by_one(single)(DRIVES).positions


def test_explicit_modes_come_to_the_exact_motion(truth: Floats) -> None:
    assert worst(one_by_one(in_modes("DOP853", 1e-12, 30))(DRIVES), truth) < 1e-10
    assert worst(one_by_one(in_modes("LSODA", 1e-9, 12))(DRIVES), truth) < 1e-6


def test_smoothed_friction_converges_with_its_width(truth: Floats) -> None:
    errors = [worst(one_by_one(smoothed("LSODA", w))(DRIVES), truth) for w in (1e-3, 1e-5)]
    assert errors[1] < 0.1 * errors[0] < 0.01


def test_moreau_jean_converges_with_its_step(truth: Floats) -> None:
    pytest.importorskip("numba")
    from benchmarks.racing.with_numba import stepping

    errors = [worst(one_by_one(stepping(h))(DRIVES), truth) for h in (1e-3, 1e-5)]
    assert errors[1] < 0.1 * errors[0] < 0.01


def test_mujoco_converges_with_its_step(truth: Floats) -> None:
    pytest.importorskip("mujoco")
    from benchmarks.racing.with_mujoco import Stepping, Way

    for way in (Way(), Way(on_plate=True)):
        errors = [worst(one_by_one(Stepping(way, h))(DRIVES), truth) for h in (1e-3, 1e-4)]
        assert errors[1] < 0.2 * errors[0] < 0.03


def test_an_end_far_from_the_true_one_is_a_failure(truth: Floats) -> None:
    positions = truth.copy()
    positions[2, -1] += 0.06 * DRIVES[-1, 2]
    positions[3, -1] += 0.04 * DRIVES[-1, 3]
    result = Result(Racer("", "", "", one_by_one(single)))
    judge(result, Lap(positions, {4: "too slow"}, 1.0), truth, DRIVES[-1])
    assert result.failures == {2: "wrong end", 4: "too slow"}
    np.testing.assert_allclose(result.errors[2:4], (0.06, 0.04))


def test_failing_drive_is_reported_and_stops_nothing(truth: Floats) -> None:
    def solve(drive: Floats) -> Floats:
        if drive[0] == DRIVES[0, 1]:
            raise FailureError("did not finish")
        return single(drive)

    (result,) = race(
        [Racer("a", "b", "c", one_by_one(solve))], DRIVES, truth, 2, 1.0, lambda _: None
    )
    assert result.failures == {1: "did not finish"}
    assert np.isnan(result.errors[1]) and np.nanmax(result.errors) == 0.0
    assert len(result.laps) == 2


def test_an_integrator_that_comes_back_for_ever_is_stopped() -> None:
    pin = Pin.of(np.array([0.01, 100.0, 0.4, 0.02, 0.005, 0.1, 1.5e-3]))

    def still(slide: Slide) -> Slid:
        return Slid(slide.begin, slide.x, 0, np.empty(0))

    with pytest.raises(FailureError, match="chattering"):
        follow(pin, still, TIMES, DURATION)

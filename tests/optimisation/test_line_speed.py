"""The hand speed that a design allows: that of `largest_speeds`, in far fewer trials."""

from __future__ import annotations

from math import inf, isnan, nan

import numpy as np
import pytest

import pindrive as pd
from pindrive.evaluation.resolution import TRIED, SpeedLimit, Trial, largest_speeds
from pindrive.optimisation import Effort, line_speed, read_wish
from pindrive.optimisation.line_speed import speeds
from pindrive.study.design import Plan
from wishes import EXAMPLES

WISH = EXAMPLES / "tactile-reader-wish.toml"


@pytest.fixture(scope="module")
def plan() -> Plan:
    return read_wish(WISH, ["control.sample_rate=250 Hz"]).plan


@pytest.fixture(scope="module")
def limit(plan: Plan) -> SpeedLimit:
    file = plan.device
    (found,) = largest_speeds(file.device, [3e-3], criteria=file.criteria)
    return found


def test_the_speed_is_that_of_the_whole_grid(plan: Plan, limit: SpeedLimit) -> None:
    ((speed, trials),) = speeds(plan, [({}, nan)])
    assert speed == pytest.approx(limit.speed, rel=1e-2)
    assert trials <= TRIED + 10


def test_one_trial_tells_a_device_that_beats_no_speed(plan: Plan, limit: SpeedLimit) -> None:
    assert speeds(plan, [({}, 1.1 * limit.speed)]) == [(0.0, 1)]
    ((speed, _),) = speeds(plan, [({}, 0.9 * limit.speed)])
    assert speed == pytest.approx(limit.speed, rel=1e-2)


def test_a_device_that_cannot_exist_has_no_speed(plan: Plan) -> None:
    ((speed, trials),) = speeds(plan, [({"plate.kinetic": 0.02, "plate.static": 0.01}, nan)])
    assert isnan(speed) and trials == 0


def stiffer_is_faster(device: pd.Device, *_: object, **__: object) -> float:
    """The speed up to which the lines are distinct, in place of the scan: best at 600 N/m."""
    off = np.log(device.drive.stiffness / 600.0)
    return float(0.3 * np.exp(-(off**2) - (device.drive.damping_ratio - 0.4) ** 2))


def test_a_search_takes_a_twentieth_of_the_trials_of_a_grid(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a known speed in place of the scans: its largest value is found."""

    def trial(device: pd.Device, pitch: float, width: float, speed: float, _: object) -> Trial:
        assert (pitch, width) == (3e-3, 1.5e-3)
        return Trial(speed, 1.0 if speed <= stiffer_is_faster(device) else 0.0, inf, ())

    monkeypatch.setattr(line_speed, "two_lines", trial)
    monkeypatch.setattr("pindrive.evaluation.resolution.two_lines", trial)
    monkeypatch.setattr("pindrive.evaluation.resolution.settles", lambda *_: False)
    found = pd.optimise(None, WISH, effort=Effort(16, 12, 24, 8, 0, 1), threads=1)
    (reached,) = found.goals
    assert reached.value >= 0.98 * 0.3
    assert found.feasible and not found.maps
    levels = 6
    climb = 25
    assert found.count.scans * 20 <= levels**4 * climb
    grid = [
        0.3 * np.exp(-(np.log(k / 600.0) ** 2) - (z - 0.4) ** 2)
        for k in np.geomspace(100.0, 1000.0, levels)
        for z in np.linspace(0.1, 1.0, levels)
    ]
    assert reached.value >= max(grid)


def test_a_gap_below_a_speed_ends_the_interval(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines that are distinct again at a faster hand are so by chance, and do not count."""

    def trial(device: pd.Device, pitch: float, width: float, speed: float, _: object) -> Trial:
        ok = 0.01 < speed <= 0.2 or 0.3 < speed < 0.5
        return Trial(speed, 1.0 if ok else 0.0, inf, ())

    monkeypatch.setattr(line_speed, "two_lines", trial)
    ((whole, _), (beaten, _), (slower, _)) = speeds(plan, [({}, nan), ({}, 0.4), ({}, 0.1)])
    assert whole == pytest.approx(0.2, rel=1e-2) and whole <= 0.2
    assert beaten == 0.0
    assert slower == whole

"""The hand speed that a design allows: that of `largest_speeds`, in far fewer trials."""

from __future__ import annotations

from dataclasses import replace
from math import inf, isnan

import numpy as np
import pytest

import pindrive as pd
from design_problems import EXAMPLES
from pindrive.evaluation.resolution import TRIED, SpeedLimit, Trial, largest_speeds
from pindrive.optimisation import Effort, line_speed, read_problem
from pindrive.optimisation.goals import SpeedRequest
from pindrive.optimisation.line_speed import speeds
from pindrive.study.study import Study

PROBLEM = EXAMPLES / "tactile-reader-problem.toml"


@pytest.fixture(scope="module")
def plan() -> Study:
    return read_problem(PROBLEM, ["control.sample_rate=250 Hz"]).study


@pytest.fixture(scope="module")
def limit(plan: Study) -> SpeedLimit:
    file = plan.device
    (found,) = largest_speeds(file.device, [3e-3], criteria=file.criteria)
    return found


def test_a_confirmed_speed_is_that_of_the_whole_grid(plan: Study, limit: SpeedLimit) -> None:
    ((speed, trials),) = speeds(plan, [SpeedRequest({}, confirmed=True)])
    assert speed == limit.speed
    assert trials <= TRIED + 10


def test_a_bracket_takes_few_trials(plan: Study, limit: SpeedLimit) -> None:
    """To a hundredth, or of a device that is slower than another to a twentieth."""
    guesses = [
        SpeedRequest({}),
        SpeedRequest({}, near=1.1 * limit.speed),
        SpeedRequest({}, near=0.9 * limit.speed),
        SpeedRequest({}, near=1.02 * limit.speed, beat=2.0 * limit.speed),
    ]
    most = (11, 7, 7, 3)
    for (speed, trials), requested, budget in zip(
        speeds(plan, guesses), guesses, most, strict=True
    ):
        assert trials <= budget
        precision = 0.06 if requested.beat > 0.0 else 0.012
        assert (1.0 - precision) * limit.speed <= speed <= 1.012 * limit.speed


def test_a_device_that_cannot_exist_has_no_speed(plan: Study) -> None:
    at = {"plate.kinetic": 0.02, "plate.static": 0.01}
    ((speed, trials),) = speeds(plan, [SpeedRequest(at)])
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
        return Trial(speed, 1.0, inf, speed <= stiffer_is_faster(device))

    monkeypatch.setattr(line_speed, "two_lines", trial)
    problem = read_problem(PROBLEM)
    found = pd.optimise(
        None, replace(problem, constraints=()), effort=Effort(16, 12, 24, 8, 0, 1, 3), threads=1
    )
    (reached,) = found.goals
    assert reached.value >= 0.98 * 0.3
    assert found.feasible and not found.maps
    levels, climb = 4, 25
    assert found.count.scans * 20 <= levels**4 * climb
    grid = [
        0.3 * np.exp(-(np.log(k / 600.0) ** 2) - (z - 0.4) ** 2)
        for k in np.geomspace(100.0, 1000.0, levels)
        for z in np.linspace(0.1, 1.0, levels)
    ]
    assert reached.value >= max(grid)


def test_a_gap_below_a_speed_ends_the_interval(
    plan: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lines that are distinct again at a faster hand are so by chance, and do not count."""

    def trial(device: pd.Device, pitch: float, width: float, speed: float, _: object) -> Trial:
        ok = 0.01 < speed <= 0.2 or 0.3 < speed < 0.5
        return Trial(speed, 1.0, inf, ok)

    monkeypatch.setattr(line_speed, "two_lines", trial)
    ((whole, _), (taken, _), (slower, _)) = speeds(
        plan, [SpeedRequest({}, 0.4, confirmed=True), SpeedRequest({}, 0.4), SpeedRequest({}, 0.1)]
    )
    assert whole == pytest.approx(0.2, rel=1e-3) and whole <= 0.2
    assert taken == pytest.approx(0.5, rel=1e-2)
    assert slower == pytest.approx(0.2, rel=1e-2) and slower <= 0.2


def test_a_design_whose_speed_is_not_confirmed_counts_by_its_first_interval(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Above 600 N/m the lines are distinct at slow hands and at fast ones, not between."""

    def trial(device: pd.Device, pitch: float, width: float, speed: float, _: object) -> Trial:
        k = device.drive.stiffness
        ok = speed <= 4e-4 * k and (k < 600.0 or not 0.05 < speed < 0.2)
        return Trial(speed, 1.0, inf, ok)

    monkeypatch.setattr(line_speed, "two_lines", trial)
    problem = {
        "page": {"grating": ["3 mm"]},
        "axes": {"drive.stiffness": {"uniform": [100.0, 1000.0]}},
        "goals": {"maximise": "distinct_speed"},
    }
    device = pd.load_device(EXAMPLES / "tactile-reader.toml")
    found = pd.optimise(device, problem, effort=Effort(16, 12, 24, 8, 0, 1, 3), threads=1)
    assert 0.95 * 0.24 <= found.goals[0].value <= 0.24
    assert found.values["drive.stiffness"] < 600.0

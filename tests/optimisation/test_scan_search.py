"""The search over scans, with numbers that are known in place of the scans."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import pindrive as pd
from design_problems import EXAMPLES
from pindrive.optimisation import Design, Effort
from pindrive.optimisation.design_space import DesignSpace
from pindrive.optimisation.kriging import Kriging
from pindrive.quantities.status import Status

Array = NDArray[np.float64]
READER = EXAMPLES / "tactile-reader.toml"
RANGES = {
    "drive.stiffness": (100.0, 1000.0),
    "drive.damping_ratio": (0.1, 1.0),
    "magnet.hold_force": (0.5, 2.0),
}
MIDDLE = np.array([0.8, 0.3, 0.4])
WAY = np.array([2.0, 2.0, 1.0]) / 3.0
FAR = 0.35
"""From the best place of all to the plane within which the stroke is large enough."""
LIMIT = float(WAY @ MIDDLE) + FAR
PROBLEM: dict[str, Any] = {
    "page": {"grating": ["3 mm"]},
    "axes": {key: {"uniform": [*ends]} for key, ends in RANGES.items()},
    "specification": {"worst_stroke": f">= {LIMIT} m", "worst_lag_on": "<= 5 m"},
    "goals": {"minimise": "worst_smear"},
}


def unit(columns: dict[str, Array]) -> Array:
    return np.array([(columns[key] - low) / (high - low) for key, (low, high) in RANGES.items()]).T


def smear(points: Array) -> Array:
    return np.asarray(0.2 + ((points - MIDDLE) ** 2).sum(axis=1))


@pytest.fixture(scope="module")
def seen() -> list[Array]:
    return []


@pytest.fixture(scope="module")
def found(seen: list[Array]) -> Design:
    """Least distance from a place beyond a plane: its foot on that plane."""

    def evaluated(
        _: DesignSpace, columns: dict[str, Array], size: int, outputs: tuple[str, ...]
    ) -> dict[str, Any]:
        points = unit(columns)
        seen.extend(points)
        status = np.full(size, int(Status.ok))
        status[points[:, 0] < 0.05] = int(Status.refused)
        return {
            "worst_smear": smear(points),
            "worst_stroke": points @ WAY,
            "worst_lag_on": points[:, 0],
            "status": status,
        }

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(DesignSpace, "_evaluated", evaluated)
        device = pd.load_device(READER)
        return pd.optimise(device, PROBLEM, effort=Effort(16, 12, 24, 8, 0, 1, 3))


def test_the_best_device_is_found_in_a_twentieth_of_the_scans_of_a_grid(
    found: Design, seen: list[Array]
) -> None:
    best = 0.2 + FAR**2
    assert found.feasible
    assert best <= found.goals[0].value <= 1.01 * best
    assert found.count.scans == len(seen)
    for levels in (8, 16):
        each = np.meshgrid(*[np.linspace(0.0, 1.0, levels)] * 3)
        grid = np.stack([x.ravel() for x in each], axis=1)
        meets = (grid @ WAY >= LIMIT) & (grid[:, 0] >= 0.05)
        assert found.goals[0].value <= smear(grid[meets]).min()
    assert found.count.scans * 20 <= levels**3


def test_no_device_is_scanned_twice(found: Design, seen: list[Array]) -> None:
    assert len(np.unique(np.array(seen), axis=0)) == len(seen)


def test_the_limit_that_binds_is_named_with_what_gives_the_gain(found: Design) -> None:
    stroke, lag = found.constraints
    wanted = sqrt((1.0 - found.gain) * found.goals[0].value - 0.2)
    assert stroke.binds and stroke.relaxed < LIMIT
    assert stroke.relaxed == pytest.approx(float(WAY @ MIDDLE) + wanted, abs=0.01)
    assert not lag.binds


def test_kriging_interpolates_with_its_error() -> None:
    rng = np.random.default_rng(3)
    points = rng.random((40, 2))

    def truth(at: Array) -> Array:
        return np.asarray(np.exp(2.0 * np.sin(3.0 * at[:, 0]) + at[:, 1]))

    model = Kriging(points, truth(points))
    assert model(points)[0] == pytest.approx(truth(points), rel=2e-2)
    others = rng.random((400, 2))
    low, high = model(others, 2.0)
    assert (low < high).all()
    assert ((low <= truth(others)) & (truth(others) <= high)).mean() > 0.9
    assert model(others)[0] == pytest.approx(truth(others), rel=0.2)
    far, near = (np.ptp(model(at, 1.0)) for at in (np.array([[1.0, 1.0]]), points[:1] + 1e-6))
    assert far > near


def test_kriging_separates_noise_from_a_trend() -> None:
    rng = np.random.default_rng(4)
    points = rng.random((60, 1))
    noisy = points[:, 0] + 0.05 * rng.normal(size=60)
    model = Kriging(points, noisy)
    at = np.linspace(0.05, 0.95, 19)[:, None]
    assert model(at)[0] == pytest.approx(at[:, 0], abs=0.06)

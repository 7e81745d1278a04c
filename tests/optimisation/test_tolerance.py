"""Devices built within tolerances: equal to single ones, counted in full, tightened limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import optimize

import pindrive as pd
from design_problems import EXAMPLES, MOUSE
from pindrive.optimisation import Effort
from pindrive.optimisation.design_space import DesignSpace, first_cases
from pindrive.optimisation.effort import Count
from pindrive.optimisation.line_speed import speeds
from pindrive.optimisation.problem import problem_of
from pindrive.optimisation.tolerance import Built, reserves
from pindrive.quantities.status import Status

Array = NDArray[np.float64]


def space_of(device: Any, tables: dict[str, Any]) -> tuple[DesignSpace, Any]:
    problem = problem_of(device, tables)
    space = DesignSpace(
        study=problem.study,
        variables=problem.variables,
        conditions=problem.conditions,
        cases=first_cases(problem.conditions),
        links=problem.study.links,
        constraints=problem.constraints,
        goals=(),
        line_speeds=speeds,
        count=Count(),
    )
    return space, problem


def test_a_built_device_is_the_design_with_its_values_off() -> None:
    """Followers keep the ratio that the design has, under conditions too."""
    tables = {
        "axes": {
            "drive.stiffness": {"uniform": ["50 N/m", "200 N/m"]},
            "plate.kinetic": {"uniform": ["10 mN", "20 mN"]},
            "plate.static": {"uniform": ["30 mN", "40 mN"]},
            "finger.static": {"times": 1.3, "of": "finger.kinetic"},
        },
        "conditions": {"finger.kinetic": {"uniform": ["3 mN", "9 mN"]}},
        "tolerances": {
            "stiffness": "4 N/m",
            "plate.kinetic": {"normal": "5 %"},
            "mass": {"uniform": ["9 g", "11 g"]},
        },
        "specification": {"settling_time": "<= 60 ms", "peak_displacement": ">= 2.1 mm"},
        "goals": {"minimise": "swing"},
    }
    device = pd.load_device(MOUSE)
    space, problem = space_of(device, tables)
    built = Built.drawn(space, problem.tables["tolerances"], 4, 7)
    points = np.random.default_rng(1).random((3, 3))
    numbers = built.numbers(points)
    stiffness, plate = 50.0 + 150.0 * points[:, 0], 0.01 + 0.01 * points[:, 1]
    static = 0.03 + 0.01 * points[:, 2]
    places = dict(zip(built.tolerances, built.parts.T, strict=True))
    for i in range(3):
        for draw in range(4):
            normal = pd.Study(device, tolerances={"plate.kinetic": {"normal": [plate[i], "5 %"]}})
            at = {
                "drive.stiffness": stiffness[i] - 4.0 + 8.0 * places["drive.stiffness"][draw],
                "drive.mass": 0.009 + 0.002 * places["drive.mass"][draw],
                "plate.kinetic": float(
                    normal.tolerances["plate.kinetic"].ppf(places["plate.kinetic"][draw])
                ),
            }
            at["plate.static"] = static[i] / plate[i] * at["plate.kinetic"]
            for case, touch in enumerate((0.003, 0.006, 0.009)):
                own = at | {"finger.kinetic": touch, "finger.static": 1.3 * touch}
                file = problem.study.device_at(own)
                motion = pd.simulate(file.drive, file.release)
                assert numbers["transient_settling_time"][i, draw, case] == pytest.approx(
                    motion.transient.settling_time, rel=1e-9
                )
                assert numbers["transient_peak_displacement"][i, draw, case] == pytest.approx(
                    motion.transient.peak_displacement, rel=1e-9
                )


def test_a_yield_that_is_reached_is_counted_from_all_draws() -> None:
    """A yield that is not reached takes few devices."""
    tables = {
        "axes": {"drive.damping_ratio": {"uniform": [0.05, 0.5]}},
        "specification": {"settling_time": "<= 58 ms"},
        "tolerances": {"drive.stiffness": "5 %", "finger.kinetic": "20 %"},
        "goals": {"minimise": "swing"},
    }
    space, problem = space_of(pd.load_device(MOUSE), tables)
    points = np.linspace(0.0, 1.0, 81)[:, None]
    whole = Built.drawn(space, problem.tables["tolerances"], 1000, 3)
    shares = (whole.excess(points) <= 0.0).all(axis=0).mean(axis=1)
    assert (shares >= 0.9).any() and (shares < 0.9).any()
    before = space.count.motions
    lacks = Built.drawn(space, problem.tables["tolerances"], 1000, 3).shortfall(points, 0.9)
    taken = space.count.motions - before
    assert (lacks == 0.0).tolist() == (shares >= 0.9).tolist()
    assert (lacks[shares < 0.9] > 0.0).all()
    few = Built.drawn(space, problem.tables["tolerances"], 50, 3)
    shares_of_few = (few.excess(points) <= 0.0).all(axis=0).mean(axis=1)
    assert (few.shortfall(points, 0.9) == 0.0).tolist() == (shares_of_few >= 0.9).tolist()
    assert taken <= 1000 * (shares >= 0.9).sum() + 512 * (shares < 0.9).sum()


def test_devices_without_a_number_count_as_the_worst() -> None:
    excess = np.array([[0.1, 0.3, 0.2, np.inf, np.inf], [0.0, 0.0, 0.0, 0.0, 0.0]])
    assert reserves(excess, np.array([0.05, -1.0]), 0.7) == pytest.approx([0.25, 1.0])
    none = np.full((1, 3), np.inf)
    assert reserves(none, np.array([0.05]), 0.9) == pytest.approx([0.0])


def test_tighter_limits_give_the_yield_of_scans_and_no_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The stroke jumps down where it is small: limits as tight as the scatter are too tight."""
    low, high = np.array([100.0, 0.1]), np.array([1000.0, 1.0])

    def evaluated(
        _: DesignSpace, columns: dict[str, Array], size: int, outputs: tuple[str, ...]
    ) -> dict[str, Any]:
        stiffness = (columns["drive.stiffness"] - low[0]) / (high[0] - low[0])
        ratio = (columns["drive.damping_ratio"] - low[1]) / (high[1] - low[1])
        return {
            "worst_smear": 0.1 + stiffness**2 + ratio**2,
            "worst_stroke": np.where(stiffness + ratio < 1.3, 0.5, stiffness + ratio),
            "status": np.full(size, int(Status.ok)),
        }

    monkeypatch.setattr(DesignSpace, "_evaluated", evaluated)
    problem = {
        "page": {"grating": ["3 mm"]},
        "axes": {
            "drive.stiffness": {"uniform": ["100 N/m", "1000 N/m"]},
            "drive.damping_ratio": {"uniform": [0.1, 1.0]},
        },
        "tolerances": {"drive.stiffness": "10 %"},
        "specification": {"worst_stroke": ">= 1 m", "yield": ">= 90 %"},
        "goals": {"minimise": "worst_smear"},
    }
    found = pd.optimise(
        pd.load_device(EXAMPLES / "tactile-reader.toml"),
        problem,
        effort=Effort(16, 12, 24, 8, 0, 400, 3),
    )

    def lacking(parts: Array) -> float:
        """Stroke beyond the jump of a device 8 % below, which one in ten are."""
        stiffness = low[0] + (high[0] - low[0]) * parts[0]
        return float((0.92 * stiffness - low[0]) / (high[0] - low[0]) + parts[1] - 1.3)

    best = optimize.minimize(
        lambda parts: 0.1 + float(parts @ parts),
        [0.6, 0.6],
        constraints={"type": "ineq", "fun": lacking},
    )
    assert found.feasible and found.built is not None
    assert found.built.met >= 0.9 * found.built.of
    assert 0.99 * best.fun <= found.goals[0].value <= 1.08 * best.fun  # 1.19 without relaxation

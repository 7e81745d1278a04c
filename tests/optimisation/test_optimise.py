"""Designs against brute force: grids, dense conditions, and Monte Carlo of their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import pindrive as pd
from design_problems import EXAMPLES, MOUSE, PAPER, SMALL
from notebook_reading import check_faces
from pindrive.optimisation import Design, Effort, optimise
from pindrive.optimisation.search import non_dominated
from pindrive.quantities.status import Status

Array = NDArray[np.float64]
SPEEDS = np.linspace(0.05, 0.15, 201)
HAS_12 = 1.5
"""Static over kinetic friction of the finger in the device file."""


def released(speeds: Array, **varied: Any) -> Any:
    """Numbers of designs (n,) at speeds (c,), by `simulate_batch` alone; shape (n, c)."""
    device = pd.load_device(MOUSE)
    given: dict[str, Any] = {name: np.asarray(x)[..., None] for name, x in varied.items()}
    mass = given.get("mass", np.array(device.drive.mass))
    if "damping_ratio" in given:
        ratio = given.pop("damping_ratio")
        given["damping"] = 2.0 * ratio * np.sqrt(mass * given["stiffness"])
    given["finger_static"] = HAS_12 * given["finger_kinetic"]
    outputs = ["settling_time", "peak_displacement", "trough_displacement"]
    return pd.simulate_batch(
        device.drive,
        device.release,
        mouse_velocity=speeds,
        outputs=[f"transient_{name}" for name in outputs],
        **given,
    )


def worst(speeds: Array, **varied: Any) -> tuple[Array, NDArray[np.bool_]]:
    """The longest settling time of each design, and whether it meets the paper's constraints."""
    found = released(speeds, **varied)
    time = found.transient_settling_time.values
    met = (found.transient_peak_displacement.values >= 2.1e-3).all(axis=-1)
    met &= (found.transient_trough_displacement.values >= -1.5e-3).all(axis=-1)
    longest = np.where(np.isnan(time), np.inf, time).max(axis=-1)
    return longest, met & np.isfinite(longest)


def drive_values(found: Design) -> dict[str, Any]:
    names = {"finger.kinetic": "finger_kinetic", "drive.mass": "mass"}
    keys = ("drive.stiffness", "drive.damping_ratio", "drive.damping", *names)
    return {
        names.get(key, key.partition(".")[2]): found.values[key]
        for key in keys
        if key in found.values
    }


# ---- the paper's problem ---------------------------------------------------------------------


def test_the_papers_problem_beats_a_grid_and_holds_between_its_conditions(paper: Design) -> None:
    assert paper.feasible and paper.status is Status.ok
    longest, met = worst(SPEEDS, **{name: [x] for name, x in drive_values(paper).items()})
    assert met.all()
    assert paper.goals[0].value == pytest.approx(longest[0], rel=2e-3)
    each = np.meshgrid(
        np.geomspace(30.0, 600.0, 24), np.linspace(0.02, 0.6, 24), np.linspace(2e-3, 30e-3, 24)
    )
    names = ("stiffness", "damping_ratio", "finger_kinetic")
    grid = dict(zip(names, (x.ravel() for x in each), strict=True))
    longest, met = worst(np.linspace(0.05, 0.15, 5), **grid)
    assert met.any()
    assert paper.goals[0].value <= longest[met].min()


def test_worst_conditions_are_reported(paper: Design) -> None:
    found = released(SPEEDS, **drive_values(paper))
    peak = found.transient_peak_displacement.values.ravel()
    (case,) = paper.constraints[0].case.values()
    assert paper.constraints[0].value == pytest.approx(peak.min(), rel=1e-3)
    assert case == pytest.approx(SPEEDS[peak.argmin()], abs=1e-3)


def test_a_condition_inside_its_range_is_found() -> None:
    """At some hand speed between the ends the swing grazes the band, and the pin settles last."""
    axes = {"drive.damping_ratio": {"uniform": [0.1, 0.3]}}
    problem = {"axes": axes, "conditions": PAPER["conditions"], "goals": PAPER["goals"]}
    found = pd.optimise(pd.load_device(MOUSE), problem, effort=SMALL)
    values = {"stiffness": [100.0], "finger_kinetic": [5e-3]}
    dense = np.linspace(0.05, 0.15, 4001)
    longest, _ = worst(dense, damping_ratio=[found.values["drive.damping_ratio"]], **values)
    assert found.goals[0].value >= longest[0] * (1.0 - 2e-3)


def test_the_yield_is_that_of_another_monte_carlo(paper: Design) -> None:
    rng = np.random.default_rng(77)
    count = 4000
    scatter = {"stiffness": 0.05, "damping_ratio": 0.1, "finger_kinetic": 0.2}
    own = drive_values(paper)
    drawn = {n: own[n] * rng.uniform(1.0 - d, 1.0 + d, count) for n, d in scatter.items()}
    drawn["damping_ratio"] = np.asarray(drawn["damping_ratio"])
    _, met = worst(np.array([0.05, 0.1, 0.15]), **drawn)
    assert paper.built is not None and paper.built.of == SMALL.draws
    spread = np.sqrt(0.25 * (1.0 / count + 1.0 / SMALL.draws))
    assert paper.built.met / paper.built.of == pytest.approx(met.mean(), abs=4.0 * spread)
    assert paper.built.low < paper.built.met / paper.built.of < paper.built.high


def test_a_relaxed_limit_gives_the_gain_and_a_stricter_one_does_not(paper: Design) -> None:
    """The reported limit, written into the design problem, improves the goal by the gain."""
    first = paper.constraints[0]
    assert first.binds and first.relaxed < first.constraint.limit
    assert not paper.constraints[1].binds
    for times, gained in ((1.0, True), (0.2, False)):
        limit = first.constraint.limit - times * (first.constraint.limit - first.relaxed)
        problem = {**PAPER, "specification": {"peak_displacement": f">= {1e3 * limit:.9g} mm"}}
        problem["specification"]["trough_displacement"] = ">= -1.5 mm"
        found = pd.optimise(pd.load_device(MOUSE), problem, effort=SMALL)
        wanted = (1.0 - 0.98 * paper.gain) * paper.goals[0].value
        assert (found.goals[0].value <= wanted) == gained


def test_one_seed_gives_one_design(paper: Design) -> None:
    again = pd.optimise(pd.load_device(MOUSE), PAPER, effort=SMALL, threads=1)
    assert again.values == paper.values and again.built == paper.built
    other = pd.optimise(pd.load_device(MOUSE), PAPER, effort=SMALL, seed=2)
    assert other.values != paper.values
    assert other.goals[0].value == pytest.approx(paper.goals[0].value, rel=0.01)


def test_device_file_of_a_design_has_its_numbers(paper: Design) -> None:
    drive = paper.device.drive
    assert drive.stiffness == paper.values["drive.stiffness"]
    assert drive.finger.static_friction == pytest.approx(1.5 * drive.finger.kinetic, rel=1e-12)
    (speed,) = paper.goals[0].case.values()
    motion = pd.simulate(drive, replace(paper.device.release, mouse_velocity=speed))
    assert motion.transient.settling_time == pytest.approx(paper.goals[0].value, rel=1e-9)
    assert paper.motion is not None
    assert paper.motion.transient.settling_time == pytest.approx(paper.goals[0].value, rel=1e-9)


def test_maps_hold_what_each_place_is_worth(paper: Design) -> None:
    assert [m.keys for m in paper.maps] == [
        ("drive.stiffness", "drive.damping_ratio"),
        ("drive.stiffness", "finger.kinetic"),
        ("drive.damping_ratio", "finger.kinetic"),
    ]
    drawn = paper.maps[1]
    x, y = np.meshgrid(*drawn.along)
    ratio = np.full(x.size, paper.values["drive.damping_ratio"])
    given = {"stiffness": x.ravel(), "finger_kinetic": y.ravel(), "damping_ratio": ratio}
    longest, met = worst(np.array([0.05, 0.1, 0.15]), **given)
    assert drawn.met.shape == (11, 11)
    assert (drawn.met.ravel() == met).mean() > 0.97  # the search had more conditions
    both = drawn.met.ravel() & met
    assert both.any()
    assert drawn.goal.ravel()[both] == pytest.approx(longest[both], rel=0.05)
    assert drawn.share == drawn.met.mean()
    chosen = paper.values["drive.stiffness"], paper.values["finger.kinetic"]
    assert drawn.design == pytest.approx(chosen, rel=1e-14)


# ---- no design -----------------------------------------------------------------------------------


def test_infeasible_problem_is_reported_with_the_closest_design() -> None:
    problem = {**PAPER, "specification": {"peak_displacement": ">= 3 mm"}, "tolerances": {}}
    found = pd.optimise(pd.load_device(MOUSE), problem, effort=SMALL)
    assert not found.feasible and found.status is Status.incomplete
    excess = found.constraints[0].excess
    assert f"violates peak_displacement ≥ 3 mm by {1e3 * excess:.4f}"[:50] in found.closest
    names = ("stiffness", "damping_ratio", "finger_kinetic")
    corners = zip(*product([30.0, 600.0], [0.02, 0.6], [2e-3, 30e-3]), strict=True)
    grid = dict(zip(names, map(np.array, corners), strict=True))
    peak = released(np.linspace(0.05, 0.15, 5), **grid).transient_peak_displacement.values
    assert 3e-3 - excess >= peak.min(axis=-1).max() - 1e-6
    assert repr(found).startswith("<No design: the closest violates peak_displacement")


# ---- catalogues, two goals, yield ----------------------------------------------------------------

SPRINGS = [60.0, 80.0, 100.0, 125.0, 160.0, 200.0, 250.0, 315.0, 400.0, 500.0, 630.0]
SPRING_PRICES = [1.10, 1.05, 0.95, 0.95, 0.90, 0.90, 0.85, 0.95, 1.05, 1.20, 1.45]
DAMPERS = {0.05: 0.6, 0.1: 0.6, 0.2: 0.8, 0.3: 1.0, 0.45: 1.3, 0.7: 1.9}


def test_a_front_of_catalogue_parts_is_no_worse_than_a_grid() -> None:
    """Without the yield, which a grid cannot constraint."""
    problem = _catalogue_problem()
    found = pd.optimise(pd.load_device(MOUSE, {"drive.damping": 0.3}), problem, effort=SMALL)
    assert found.feasible and found.front is not None
    assert non_dominated(found.front.goals).all()
    spring, damper, mass, finger = (
        x.ravel()
        for x in np.meshgrid(
            np.arange(11), np.arange(6), np.linspace(5e-3, 20e-3, 10), np.linspace(3e-3, 20e-3, 10)
        )
    )
    longest, met = worst(
        np.array([0.05, 0.1, 0.15]),
        stiffness=np.array(SPRINGS)[spring],
        damping=np.array([*DAMPERS])[damper],
        mass=mass,
        finger_kinetic=finger,
    )
    price = np.array(SPRING_PRICES)[spring] + np.array([*DAMPERS.values()])[damper]
    for time, cost in zip(longest[met], price[met], strict=True):
        affordable = found.front.goals[:, 1] <= cost + 1e-9
        assert affordable.any()
        assert found.front.goals[affordable, 0].min() <= 1.01 * time


def test_a_demanded_yield_is_counted() -> None:
    """The settling time jumps: devices just before a jump need no margin to their limit."""
    problem = {
        "axes": {
            "drive.damping_ratio": {"uniform": [0.05, 0.5]},
            "motion.displacement": {"uniform": ["1 mm", "8 mm"]},
        },
        "specification": {"settling_time": "<= 58 ms", "yield": ">= 99 %"},
        "tolerances": {
            "drive.stiffness": "5 %",
            "drive.damping_ratio": "10 %",
            "finger.kinetic": "20 %",
        },
        "goals": {"maximise": "peak_displacement"},
    }
    device = pd.load_device(MOUSE)
    drive = device.drive
    outputs = ["transient_settling_time", "transient_peak_displacement"]

    def built(ratio: Array, displacement: Array, draws: Array) -> tuple[Array, Array]:
        """Yields and peaks, for draws (3, n) from -1 to 1."""
        stiffness = drive.stiffness * (1.0 + 0.05 * draws[0])
        finger = drive.finger.kinetic * (1.0 + 0.2 * draws[2])
        ratio = ratio * (1.0 + 0.1 * draws[1])
        numbers = pd.simulate_batch(
            drive,
            device.release,
            stiffness=stiffness,
            damping=2.0 * ratio * np.sqrt(drive.mass * stiffness),
            finger_kinetic=finger,
            finger_static=HAS_12 * finger,
            displacement=displacement,
            outputs=outputs,
        )
        met = numbers.transient_settling_time.values <= 0.058
        return met.mean(axis=-1), numbers.transient_peak_displacement.values[..., 0]

    rng = np.random.default_rng(1)
    draws = rng.uniform(-1.0, 1.0, (3, 1500))
    best = 0.0
    displacement = np.linspace(1e-3, 8e-3, 57)[:, None]
    for ratio in np.linspace(0.05, 0.5, 46):
        share, _ = built(np.array(ratio), displacement, draws)
        _, peak = built(np.array(ratio), displacement, np.zeros((3, 1)))
        best = max(best, float(np.where(share >= 0.99, peak, 0.0).max()))
    found = pd.optimise(device, problem, effort=SMALL)
    assert found.feasible
    assert found.goals[0].value >= 0.99 * best
    chosen = found.values["drive.damping_ratio"], found.values["motion.displacement"]
    again = rng.uniform(-1.0, 1.0, (3, 100_000))
    share, _ = built(np.array([chosen[0]]), np.array([chosen[1]]), again)
    assert float(share) >= 0.988


def test_few_parts_are_all_evaluated() -> None:
    """Of 66 pairs of a spring and a damper each, whatever the seed and the effort."""
    problem = {**_catalogue_problem(), "axes": {}, "conditions": {}}
    problem["goals"] = {"minimise": "settling_time"}
    device = pd.load_device(MOUSE, {"drive.damping": 0.3, "drive.mass": 0.01})
    stiffness, damping = (x.ravel() for x in np.meshgrid(SPRINGS, [*DAMPERS]))
    numbers = pd.simulate_batch(device.drive, device.release, stiffness=stiffness, damping=damping)
    met = (numbers.transient_peak_displacement.values >= 2.1e-3) & (
        numbers.transient_trough_displacement.values >= -1.5e-3
    )
    times = np.where(met, numbers.transient_settling_time.values, np.inf)
    best = int(times.argmin())
    for seed in (1, 2):
        found = pd.optimise(device, problem, effort=Effort(64, 8, 1, 8, 3, 10), seed=seed)
        assert found.goals[0].value == pytest.approx(times[best], rel=1e-9)
        assert found.values["drive.stiffness"] == stiffness[best]
        assert found.values["drive.damping"] == damping[best]


def _catalogue_problem() -> Mapping[str, Any]:
    return {
        "axes": {
            "drive.mass": {"uniform": ["5 g", "20 g"]},
            "finger.kinetic": {"uniform": ["3 mN", "20 mN"]},
        },
        "catalogues": {
            "spring": str(EXAMPLES / "springs.csv"),
            "damper": str(EXAMPLES / "dampers.csv"),
        },
        "conditions": PAPER["conditions"],
        "specification": PAPER["specification"],
        "goals": {"minimise": ["settling_time", "price"]},
    }


def test_the_yield_that_is_demanded_is_reached(bought: Design) -> None:
    assert bought.feasible and bought.built is not None
    assert bought.built.met >= 0.95 * bought.built.of
    assert bought.constraints[0].excess < -1e-6  # margin for the tolerances
    stiffness, damping = bought.values["drive.stiffness"], bought.values["drive.damping"]
    place = SPRINGS.index(stiffness)
    assert bought.parts == {"spring": f"S-{stiffness:03.0f}", "damper": f"G-{100 * damping:02.0f}"}
    assert bought.goals[1].value == pytest.approx(SPRING_PRICES[place] + DAMPERS[damping])


def test_the_nearest_parts_are_the_design_with_one_part_changed(bought: Design) -> None:
    springs = [other for other in bought.alternatives if other.catalogue == "spring"]
    assert len(springs) == 5
    own = bought.values["drive.stiffness"]
    far = [abs(np.log(other.values["drive.stiffness"] / own)) for other in springs]
    assert far == sorted(far) and min(far) > 0.0
    other = springs[0]
    given = {**drive_values(bought), "stiffness": other.values["drive.stiffness"]}
    found = released(np.array([0.05, 0.1, 0.15]), **given)
    longest = found.transient_settling_time.values.max()
    assert other.goals[0] == pytest.approx(longest, rel=0.02)
    low = found.transient_peak_displacement.values.min()
    violated = {constraint.name: over for constraint, over in other.violations}
    assert violated.get("transient_peak_displacement", 0.0) == pytest.approx(
        max(0.0, 2.1e-3 - low), abs=2e-6
    )


def test_a_design_goes_to_a_dataset(bought: Design) -> None:
    data = bought.to_dataset()
    assert data.mass.attrs["units"] == "kg"
    assert float(data.mass) == bought.values["drive.mass"]
    assert bool(data.feasible)
    assert data.front_design_price.values.tolist() == bought.front.goals[:, 1].tolist()  # type: ignore[union-attr]
    assert data.limit_excess.values.tolist() == [d.excess for d in bought.constraints]
    assert repr(bought).startswith("<Design of tactile mouse: settling_time ")
    assert repr(bought).endswith(", ok>")
    assert check_faces(bought) > 1


def test_progress_is_reported_and_ctrl_c_ends_it() -> None:
    class Stop(Exception):
        pass

    reports: list[tuple[int, int]] = []

    def tell(done: int, total: int) -> None:
        reports.append((done, total))
        if done >= 5:
            raise Stop

    with pytest.raises(Stop):
        optimise(pd.load_device(MOUSE), PAPER, effort=SMALL, progress=tell)
    assert reports == [(i, reports[0][1]) for i in range(1, 6)]


def test_a_demand_whose_worst_condition_lies_inside_is_met_there() -> None:
    """The trough is deepest for a hand between the slowest and the fastest."""
    problem = {
        "axes": {"drive.damping_ratio": {"uniform": [0.02, 0.6]}},
        "conditions": {"mouse_velocity": {"uniform": ["1 mm/s", "200 mm/s"]}},
        "specification": {"swing": ">= 1 mm", "settling_time": "<= 90 ms"},
        "goals": {"minimise": "trough_displacement"},
    }
    found = pd.optimise(pd.load_device(MOUSE), problem, effort=SMALL)
    dense = np.linspace(1e-3, 0.2, 3001)
    longest, _ = worst(
        dense,
        stiffness=[100.0],
        finger_kinetic=[5e-3],
        damping_ratio=[found.values["drive.damping_ratio"]],
    )
    assert found.feasible == bool(longest[0] <= 0.09 * (1.0 + 1e-6))
    assert found.constraints[1].value >= longest[0] * (1.0 - 2e-3)

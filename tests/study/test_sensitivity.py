"""Sensitivity compared with closed forms, SciPy, differences and dimensional analysis."""

from __future__ import annotations

from collections.abc import Mapping
from math import isnan, pi
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats
from typer.testing import CliRunner

from pindrive.cli.app import app
from pindrive.files.device import load_device
from pindrive.files.keys import DRIVE
from pindrive.motion.simulate import motion_of
from pindrive.study.design import ranges_of
from pindrive.study.distributions import Distribution, Linked
from pindrive.study.local_sensitivity import elasticities
from pindrive.study.sensitivity import sobol, sobol_indices
from pindrive.study.spec import load_study

EXAMPLES = Path(__file__).parents[2] / "examples"
STUDY = EXAMPLES / "tactile-mouse-study.toml"
DEVICE = EXAMPLES / "tactile-mouse.toml"
CIRCLE = [Distribution("uniform", -pi, pi)] * 3


def ishigami(x: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Ishigami and Homma 1990, whose indices are known."""
    return {"y": np.sin(x[0]) + 7.0 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0])}


FIRST = (0.3139, 0.4424, 0.0)
TOTAL = (0.5576, 0.4424, 0.2437)

# ---- over ranges ---------------------------------------------------------------------------------


def test_indices_of_a_function_that_is_known() -> None:
    found = sobol_indices(ishigami, CIRCLE, 8192, seed=1)["y"]
    np.testing.assert_allclose(found.first.value, FIRST, atol=0.01)
    np.testing.assert_allclose(found.total.value, TOTAL, atol=0.01)
    assert found.kept == 1.0
    assert found.spread == pytest.approx(
        np.sqrt(49 / 8 + 0.1 * pi**4 / 5 + 0.01 * pi**8 / 18 + 0.5), rel=0.01
    )


def test_indices_are_those_of_scipy() -> None:
    """SciPy receives the values at equal points."""
    design: dict[str, NDArray[np.float64]] = {}

    def function(x: NDArray[np.float64]) -> Mapping[str, NDArray[np.float64]]:
        design["values"] = ishigami(x)["y"].reshape(5, -1)
        return ishigami(x)

    mine = sobol_indices(function, CIRCLE, 1024, seed=3)["y"]
    a, b, *mixed = design["values"]
    theirs = stats.sobol_indices(
        func={"f_A": a[None], "f_B": b[None], "f_AB": np.array(mixed)[:, None]}, n=1024
    )
    np.testing.assert_allclose(mine.first.value, theirs.first_order, rtol=0, atol=1e-12)
    np.testing.assert_allclose(mine.total.value, theirs.total_order, rtol=0, atol=1e-12)


def test_intervals_hold_the_truth() -> None:
    """At least nine of ten 95 % intervals, over seeds 0 to 39."""
    held = []
    for seed in range(40):
        found = sobol_indices(ishigami, CIRCLE, 256, seed)["y"]
        for interval, truth in ((found.first, FIRST), (found.total, TOTAL)):
            held += list((interval.low <= truth) & (truth <= interval.high))
    assert np.mean(held) > 0.9


def test_missing_numbers_are_left_out_and_reported() -> None:
    """Points with x0 < 0 have no number; the result is that of half the range."""

    def partly(x: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        y = ishigami(x)["y"]
        return {
            "partly": np.where(x[0] < 0.0, np.nan, y),
            "infinite": np.where(x[0] < 0.0, np.inf, y),
            "never": np.full_like(y, np.nan),
            "constant": np.full_like(y, 0.1 + 0.2),
        }

    def half(x: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        return ishigami(x)

    found = sobol_indices(partly, CIRCLE, 8192)
    expected = sobol_indices(half, [Distribution("uniform", 0.0, pi), *CIRCLE[1:]], 8192)["y"]
    assert found["partly"].kept == pytest.approx(0.25, abs=0.02), "at A and at B"
    np.testing.assert_allclose(found["partly"].total.value, expected.total.value, atol=0.03)
    np.testing.assert_array_equal(found["infinite"].total.value, found["partly"].total.value)
    assert found["never"].kept == 0.0 and np.isnan(found["never"].first.value).all()
    assert found["constant"].spread == 0.0 and np.isnan(found["constant"].total.value).all()


@pytest.mark.parametrize("count", [0, 100, 127, 1000, 64])
def test_a_design_has_a_power_of_two_rows(count: int) -> None:
    with pytest.raises(ValueError, match=f"a power of 2 of at least 128, got {count}"):
        sobol_indices(ishigami, CIRCLE, count)


def test_a_study_over_its_axes_or_its_tolerances() -> None:
    plan = load_study(STUDY)
    axes, tolerances = ranges_of(plan, False), ranges_of(plan, True)
    assert set(axes.scatter) == {"motion.mouse_velocity", "plate.kinetic", "drive.damping_ratio"}
    assert axes.scatter["motion.mouse_velocity"] == Distribution("uniform", 0.010, 0.300)
    assert set(tolerances.scatter) == set(plan.tolerances)
    assert {**axes.links, **tolerances.links} == {
        "plate.static": Linked("plate.kinetic", 1.2),
        "finger.static": Linked("finger.kinetic", 1.5),
    }


def test_the_peak_depends_on_speed_and_frequency_alone() -> None:
    """Before the peak the pin is carried: the paper's (14) has no finger friction of note."""
    found = sobol(load_study(STUDY), tolerances=True, rows=512, near=True)
    speed = found.keys.index("motion.mouse_velocity")
    peak = found.over["transient_peak_displacement"].total.value
    assert peak[speed] > 0.9 and np.delete(peak, speed).max() < 0.1
    assert found.points == 512 * (len(found.keys) + 2)
    assert found.refusals == ()


# ---- near the device -----------------------------------------------------------------------------

LINKS = {
    "plate.static": Linked("plate.kinetic", 26.5 / 22.0),
    "finger.static": Linked("finger.kinetic", 1.5),
}
KEYS = (
    *("drive.mass", "drive.stiffness", "drive.damping_ratio", "plate.kinetic"),
    *("finger.kinetic", "motion.mouse_velocity", "motion.displacement"),
)


def test_elasticities_are_differences() -> None:
    """Whole device files, changed by a millionth up and down, with all linked keys."""
    found = elasticities(load_study(STUDY), KEYS, LINKS)
    own = load_device(DEVICE).values()
    compared = 0
    for key in KEYS:
        changed = [key, *(name for name, link in LINKS.items() if link.of == key)]
        low, high = (
            motion_of(
                load_device(
                    DEVICE,
                    [
                        f"duration={found.duration!r} s",
                        *(f"{n}={own[n] * factor!r} {DRIVE[n].unit}" for n in changed),  # type: ignore[operator]
                    ],
                )
            ).numbers()
            for factor in (1.0 - 1e-6, 1.0 + 1e-6)
        )
        for name in low:
            mine = found.table[name.replace(".", "_")][key]
            if not isnan(mine):
                expected = (high[name] - low[name]) / (high[name] + low[name]) * 1e6
                assert mine == pytest.approx(expected, rel=1e-4, abs=1e-6), (key, name)
                compared += 1
    assert compared > 150


DIMENSIONS = {  # mass, length, time
    "transient_settling_time": (0, 0, 1),
    "transient_peak_displacement": (0, 1, 0),
    "transient_return_velocity": (0, 1, -1),
    "transient_finger_dissipated": (1, 2, -2),
    "transient_plate_peak_force": (1, 1, -2),
    "transient_rest_time": (0, 0, 1),
}
OF_KEYS = {
    "drive.mass": (1, 0, 0),
    "drive.stiffness": (1, 0, -2),
    "drive.damping_ratio": (0, 0, 0),
    "plate.kinetic": (1, 1, -2),
    "finger.kinetic": (1, 1, -2),
    "motion.mouse_velocity": (0, 1, -1),
    "motion.displacement": (0, 1, 0),
}


@pytest.mark.parametrize("number", DIMENSIONS)
def test_elasticities_keep_the_dimensions(number: str) -> None:
    """Other units of mass, length and time change a number as its dimension says (Buckingham)."""
    row = elasticities(load_study(STUDY), KEYS, LINKS).table[number]
    for unit in range(3):
        change = sum(row[key] * OF_KEYS[key][unit] for key in KEYS)
        assert change == pytest.approx(DIMENSIONS[number][unit], abs=1e-9)


def test_a_key_that_is_zero_has_no_elasticity(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(
        f'base = "{(Path(__file__).parents[1] / "minimal.toml").as_posix()}"\n'
        '[axes]\ndisplacement = ["1 mm"]\nmass = ["1 g"]\nduration = ["1 s"]\n'
    )
    keys = ("motion.displacement", "drive.mass", "motion.duration")
    found = elasticities(load_study(tmp_path / "study.toml"), keys, {})
    assert set(found.gaps) == {"motion.displacement", "motion.duration"}
    row = found.table["transient_settling_time"]
    assert isnan(row["motion.displacement"]) and not isnan(row["drive.mass"])


# ---- the command ---------------------------------------------------------------------------------


def test_the_command_prints_tables_and_draws(tmp_path: Path) -> None:
    target = tmp_path / "chart.svg"
    arguments = ["sensitivity", str(STUDY), "--tolerances", "--rows", "128", "--plot", str(target)]
    said = CliRunner().invoke(app, arguments)
    assert said.exit_code == 0, said.output
    lines = [line.split() for line in said.stdout.splitlines()]
    assert ["number", "F_p", "F_f", "m", "k", "ζ", "v_p"] in lines
    near, first, total = (line[1:] for line in lines if line[:1] == ["settling_time"])
    row = elasticities(load_study(STUDY), KEYS, LINKS).table["transient_settling_time"]
    assert near[2] == f"{row['drive.mass']:+.2f}"
    over = sobol(load_study(STUDY), tolerances=True, rows=128).over["transient_settling_time"]
    assert f"{over.first.value[1]:.2f}" in first
    assert f"{over.total.value[1]:.2f}" in total
    assert "1 024 points (Sobol' design of 128 rows)" in said.stdout
    assert "Nowhere: peak_stretch" in said.stdout
    assert "which parameter matters" in target.read_text("utf-8")


def test_a_study_that_varies_nothing_is_refused(tmp_path: Path) -> None:
    study = tmp_path / "study.toml"
    study.write_text(f'base = "{DEVICE.as_posix()}"\n')
    for command, words in (
        ("sensitivity", "nothing varies; write what in [axes] or [tolerances]"),
        ("robustness", "has no tolerances; write them in [tolerances]"),
        ("sensitivity --tolerances", "has no tolerances; write them in [tolerances]"),
    ):
        said = CliRunner().invoke(app, [*command.split(), str(study)])
        assert (said.exit_code, said.stderr) == (2, f"{study}: {words}\n")

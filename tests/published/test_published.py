"""The published cases: the numbers, the page that shows them, and what its figures draw."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, degrees, pi, radians

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from . import decay, forced, friction_curve, shaken
from .case import DATA, Case, half_unit, load
from .cases import CASES
from .figure import figure, part
from .page import BEGIN, END, PAGE, computed, picture, section, with_cases

EACH = pytest.mark.parametrize(
    "compute", CASES, ids=lambda case: f"{case.__module__}.{case.__name__}"
)
"""A test of each case, which is computed when it is first called, not when tests are collected."""


@pytest.fixture(scope="module")
def every() -> list[Case]:
    return [compute() for compute in CASES]


# ---- the numbers ---------------------------------------------------------------------------------


@EACH
def test_published_numbers_are_met_to_what_their_source_justifies(
    compute: Callable[[], Case],
) -> None:
    """Deviating numbers are recorded as such, with the reason."""
    case = compute()
    assert case.numbers
    assert [number for number in case.numbers if number.agrees is number.deviates] == []
    assert case.remarks or not any(number.deviates for number in case.numbers)


def test_every_data_file_has_its_case_and_its_source(every: list[Case]) -> None:
    sources = {path.stem: load(path.stem)["source"] for path in DATA.glob("*.json")}
    assert sources.keys() <= {case.key for case in every}
    assert all(case.source in sources.values() for case in every)
    for source in sources.values():
        assert {"title", "authors", "where", "numbers"} <= source.keys()


def test_published_case_names_what_cannot_be_expressed(every: list[Case]) -> None:
    incomplete = {case.key: case.missing for case in every if case.missing}
    assert incomplete.keys() == {"stick-slip"}


@pytest.mark.parametrize(
    ("text", "half"),
    [("15.2671", 5e-5), ("-4.596e-4", 5e-8), ("3.536e-5", 5e-9), ("0.0312600", 5e-8), ("7", 0.5)],
)
def test_half_a_unit_of_the_last_digit(text: str, half: float) -> None:
    assert half_unit(text) == pytest.approx(half, rel=1e-12)


def test_the_decay_is_exact_beyond_the_printed_digits() -> None:
    """X reverses to -x + 2 F/k, at n pi/100 s, and sticks where the spring pulls less than F."""
    motion = decay._aster()
    turns = [-6.5e-4, 4.5e-4, -2.5e-4, 5e-5]
    at = np.array([n * pi / 100.0 for n in range(1, 5)])
    assert motion.position(at) == pytest.approx(turns, rel=0.0, abs=1e-17)
    assert motion.ending.kind == "resting"
    assert motion.ending.position == pytest.approx(5e-5, rel=0.0, abs=1e-17)
    component = cos(radians(45.0))
    assert decay.aster().numbers[0].computed == pytest.approx(-6.5e-4 * component, rel=1e-12)


def test_the_spring_of_the_source_explains_what_the_digits_do_not() -> None:
    """With it the power at 15 m/s² is 2.2e-5 of itself lower, however many rows the sine has."""
    given = load("aster-sdnd104")["parameters"]
    own = shaken.power(15.0, given["stiffness_in_the_source"])
    assert own == pytest.approx(15.2671 * (1.0 - 2.2e-5), abs=2e-5)


def test_forced_vibration_repeats_with_the_force() -> None:
    motion = forced.response(0.6, 0.5)
    assert motion.ending.cycle == "driven"
    assert motion.ending.period == pytest.approx(2.0 * np.pi / 0.6, rel=1e-12)


def test_the_friction_curve_agrees_with_an_integration_of_the_curve_itself() -> None:
    """So what is left beside the reference result is the error of that."""
    given = friction_curve.GIVEN["parameters"]
    motion, rest = friction_curve.motion_of(6400), given["rest"] - friction_curve.moved()
    struck = next(event.time for event in motion.events if event.contact == "stop")

    def slid(sign: float, start: list[float], end: float) -> np.ndarray:
        def right(_: float, y: np.ndarray) -> list[float]:
            return [y[1], -given["stiffness"] * y[0] - sign * friction_curve.friction(sign * y[1])]

        done = solve_ivp(right, (0.0, end), start, method="DOP853", rtol=1e-12, atol=1e-13)
        return np.array(done.y[:, -1])

    x, v = slid(-1.0, [0.25, -5.0], 0.06)
    assert motion.position(0.06) - rest == pytest.approx(x, abs=1e-8)
    assert motion.velocity(0.06) == pytest.approx(v, abs=1e-6)
    first, second = friction_curve.turns_of(motion)[:2]
    x, v = slid(1.0, [-0.15, 0.0], first.time - struck)
    assert first.position - rest == pytest.approx(x, abs=1e-7)
    assert abs(v) < 1e-5
    x, v = slid(-1.0, [x, 0.0], second.time - first.time)
    assert second.position - rest == pytest.approx(x, abs=2e-7)


# ---- the page ------------------------------------------------------------------------------------


def test_the_committed_page_is_what_the_command_writes(every: list[Case]) -> None:
    page = PAGE.read_text("utf-8")
    assert with_cases(page, every) == page, "write it with: python3 run.py validation"


def test_the_page_shows_each_number_with_its_mark(every: list[Case]) -> None:
    for case in every:
        rows = [line for line in section(case).splitlines() if line.startswith("| ")]
        for row, number in zip(rows[1:], case.numbers, strict=True):
            cells = [cell.strip() for cell in row.replace("\\|", "¦").split("|")][1:-1]
            assert cells[2:4] == [number.published, computed(number)]
            assert float(cells[3]) - float(cells[2]) == pytest.approx(
                number.difference, rel=0.6, abs=1e-18
            )
            assert ("†" in cells[4]) is not number.agrees


def test_a_page_without_its_marks_is_refused(every: list[Case]) -> None:
    for lacking in (BEGIN, END):
        page = (BEGIN + END).replace(lacking, "")
        with pytest.raises(ValueError, match="lacks the line <!--"):
            with_cases(page, every)


# ---- the figures ---------------------------------------------------------------------------------


def published_points() -> dict[str, tuple[str, list[float]]]:
    """Return the label of the published values in each figure, and the values in its unit."""
    stop, belt = load("aster-sdnd101"), load("stick-slip")["parameters"]
    curve = load("msl-friction-stop2")["published"]["turning"]
    power = load("aster-sdnd104")["published"]["power"]
    gap, w = belt["static"] - belt["kinetic"], (belt["stiffness"] / belt["mass"]) ** 0.5
    amplitude = ((belt["velocity"] / w) ** 2 + (gap / belt["stiffness"]) ** 2) ** 0.5
    middle = belt["kinetic"] / belt["stiffness"]
    decays = load("aster-sdnd100")["published"]
    rubbed, struck = (load(f"aster-sdnd{n}")["published"] for n in (106, 102))
    speeds = load("msl-coupled-clutches")["published"]["speeds"]
    return {
        "aster-sdnd100": (
            "published, sdnd100a",
            [1e3 * float(text) for text in decays["sdnd100a"]["DY"]],
        ),
        "aster-sdnd101": (
            "closed form, largest force",
            [1e-3 * float(stop["derived"]["largest_force"])],
        ),
        "aster-sdnd102": ("published", [1e3 * float(x) for _, x in struck]),
        "aster-sdnd104": ("published", [float(text) for text in power[:-1]]),
        "aster-sdnd106": ("published", [float(x) for b in rubbed.values() for _, x in b]),
        "den-hartog": ("pindrive", [number.computed for number in forced.den_hartog().numbers]),
        "den-hartog-lag": (
            "pindrive",
            [degrees(number.computed) for number in forced.den_hartog_lag().numbers],
        ),
        "msl-coupled-clutches": ("published, J1", [float(row[1]) for row in speeds]),
        "msl-friction-stop2": ("its turning points", [s for _, s in curve]),
        "stick-slip": ("published amplitude", [1e3 * (middle + amplitude)] * 2),
    }


@EACH
def test_a_figure_draws_published_values_and_the_motion(compute: Callable[[], Case]) -> None:
    case = compute()
    assert picture(case).read_bytes()[:4] == b"\x89PNG"
    motion, _ = figure(case).axes
    lines = {line.get_label(): line for line in motion.get_lines()}
    label, expected = published_points()[case.key]
    assert np.asarray(lines[label].get_ydata(), float) == pytest.approx(expected, rel=1e-12)
    assert any(str(name).startswith("pindrive") for name in lines)
    shown = motion.get_legend()
    assert shown and label in [text.get_text() for text in shown.get_texts()]
    assert motion.get_xlabel().endswith(("(s)", "(ms)", "(m/s²)", "ratio r"))


def test_the_curves_go_through_the_published_points() -> None:
    """Figures of motions over time show an agreement, not only two curves in one frame."""
    for case, label in (
        (decay.aster(), "published, sdnd100a"),
        (friction_curve.msl(), "its turning points"),
    ):
        lines = figure(case).axes[0].get_lines()
        points = next(line for line in lines if line.get_label() == label)
        curves = [line for line in lines if line.get_linestyle() == "-"]
        t = np.concatenate([np.asarray(line.get_xdata(), float) for line in curves])
        x = np.concatenate([np.asarray(line.get_ydata(), float) for line in curves])
        found = np.interp(np.asarray(points.get_xdata(), float), t, x)
        assert found == pytest.approx(points.get_ydata(), rel=0.0, abs=1e-3 * np.ptp(x))


@EACH
def test_a_figure_shows_the_difference_of_each_row(compute: Callable[[], Case]) -> None:
    """Inside of the grey band where it agrees; at the edge, with how far off, where it does not."""
    case = compute()
    _, differences = figure(case).axes
    shown: dict[int, float] = {}
    for line in differences.get_lines()[1:]:
        x, y = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), int)
        shown |= dict(zip(y.tolist(), x.tolist(), strict=True))
    parts = {row: part(number) for row, number in enumerate(case.numbers, start=1)}
    assert shown.keys() == parts.keys()
    for row, ratio in parts.items():
        assert shown[row] == pytest.approx(ratio if abs(ratio) <= 1.0 else 1.25 * np.sign(ratio))
    beyond = [f"{ratio:+.0f}" for ratio in parts.values() if abs(ratio) > 1.0]
    assert [text.get_text() for text in differences.texts] == beyond

"""Design problems: what they say, and each mistake in a line with the fix."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from design_problems import EXAMPLES, MOUSE, PAPER
from pindrive.files.overrides import ConfigError
from pindrive.optimisation import read_problem
from pindrive.optimisation.problem import problem_of

READER = EXAMPLES / "tactile-reader.toml"


def test_design_problem_has_variables_and_conditions() -> None:
    problem = read_problem(EXAMPLES / "catalogue-problem.toml")
    names = {variable.name: variable for variable in problem.variables}
    assert {*names} == {"drive.mass", "finger.kinetic", "spring", "damper"}
    assert names["spring"].choices == 11
    assert [condition.name for condition in problem.conditions] == ["motion.mouse_velocity"]
    assert problem.least_yield == 0.95
    assert [goal.name for goal in problem.goals] == ["transient_settling_time", "design_price"]
    assert {path.name for path in problem.inputs} == {
        *("catalogue-problem.toml", "tactile-mouse.toml", "springs.csv", "dampers.csv")
    }
    assert repr(problem) == (
        "<DesignProblem minimise settling_time and minimise price "
        "over drive.mass, finger.kinetic, spring, damper>"
    )


def test_numbers_from_python_are_si() -> None:
    problem = problem_of(pd.load_device(MOUSE), PAPER)
    stiffness = next(v for v in problem.variables if v.name == "drive.stiffness")
    assert stiffness.axes["drive.stiffness"].span == (30.0, 600.0)


def changed(**tables: Any) -> dict[str, Any]:
    return {**PAPER, **tables}


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (
            changed(specification={"settling_time": ["<= 50 ms", ">= 60 ms"]}),
            "problem: specification.settling_time: nothing is both ≤ 50 ms and ≥ 60 ms; "
            "correct one of them",
        ),
        (
            changed(goals={"minimise": "swing", "maximise": ["swing"]}),
            "problem: goals: swing is named twice; leave one out",
        ),
        (
            changed(goals={}),
            'problem: goals must be one to 3 numbers, like minimise = ["settling_time"], got none',
        ),
        (
            changed(goals={"minimize": "swing"}),
            "problem: unknown key goals.minimize; there are minimise and maximise",
        ),
        (
            changed(goals={"minimise": "settling_tim"}),
            "problem: goals.minimise: unknown number settling_tim; did you mean settling_time?",
        ),
        (
            changed(conditions={"drive.stiffness": [100.0, 200.0]}),
            "problem: drive.stiffness is in [axes] and in [conditions]; leave one out",
        ),
        (
            changed(tolerances={"mouse_velocity": {"uniform": [0.05, 0.06]}}),
            "problem: motion.mouse_velocity is in [tolerances] and in [conditions]; leave one out",
        ),
        (changed(axes={}), "problem: nothing may vary; write what may in [axes] or [catalogues]"),
        (
            changed(axes={"drive.mass": {"normal": [0.01, 0.001]}}),
            "problem: axes.drive.mass: a range has two ends; write uniform or loguniform, "
            "not normal",
        ),
        (
            changed(goals={"minimise": "price"}),
            "problem: no part has a price; give a catalogue with a column price in [catalogues]",
        ),
        (
            changed(goals={"maximise": "distinct_speed"}),
            "problem: distinct_speed depends on the pitch of the lines; write it, as with "
            'grating = ["3 mm"] in [page]',
        ),
        (
            changed(specification={"yield": ">= 95 %"}),
            "problem: specification.yield: needs another constraint; the yield is the part of "
            "devices that meets all others",
        ),
        (
            changed(specification={"yield": ">= 95 %", "swing": ">= 1 mm"}, tolerances={}),
            "problem: specification.yield: needs tolerances; write them in [tolerances]",
        ),
        (
            changed(specification={"yield": "<= 95 %"}),
            'problem: specification.yield: must be one limit like ">= 95 %", got "<= 95 %"',
        ),
        (
            changed(goals={"maximise": "yield"}),
            'problem: goals: yield cannot be a goal; constrain it, yield = ">= 95 %"',
        ),
        (changed(condition={}), "problem: unknown key condition; did you mean conditions?"),
        (
            changed(conditions=[1.0]),
            'conditions must be a mapping, like {"mass": [0.01, 0.02]}, got [1.0]',
        ),
    ],
)
def test_contradictions_are_refused_in_a_line(problem: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError) as error:
        problem_of(pd.load_device(MOUSE), problem)
    assert str(error.value).splitlines()[0] == said


CATALOGUES = {
    "springs.csv": (
        "part,price\nA,1\n",
        "{file}: the header must be with part and a column for each key that a part sets, like "
        '"part, drive.stiffness [N/m], price", got "part, price"',
    ),
    "none.csv": (
        None,
        "problem: catalogues.spring: {file}: cannot be read: No such file or directory",
    ),
    "unit.csv": (
        "part,drive.stiffness\nA,100\n",
        '{file}: column drive.stiffness must be given with its unit, like "drive.stiffness [N/m]", '
        'got "drive.stiffness"',
    ),
    "key.csv": (
        "part,drive.stifness [N/m]\nA,100\n",
        '{file}: column "drive.stifness": unknown key drive.stifness; did you mean '
        "drive.stiffness?",
    ),
    "twice.csv": (
        "part,drive.stiffness [N/m]\nA,100\nA,200\n",
        '{file}: row 2: part must be a number or a name that no other part has, got "A"',
    ),
    "bound.csv": (
        "part,drive.stiffness [N/m]\nA,-100\n",
        '{file}: row 2: drive.stiffness must be finite and greater than 0 N/m, got "-100"',
    ),
    "empty.csv": (
        "part,drive.stiffness [N/m]\n",
        "{file}: the parts must be at least 1 row, got 0",
    ),
}


@pytest.mark.parametrize("name", CATALOGUES)
def test_a_catalogue_with_a_mistake_is_refused(name: str, tmp_path: Path) -> None:
    text, said = CATALOGUES[name]
    file = tmp_path / name
    if text is not None:
        file.write_text(text)
    axes = {"drive.damping_ratio": PAPER["axes"]["drive.damping_ratio"]}
    problem = {**PAPER, "axes": axes, "catalogues": {"spring": str(file)}}
    with pytest.raises(ConfigError) as error:
        problem_of(pd.load_device(MOUSE), problem)
    assert str(error.value) == said.format(file=file)


def test_a_key_of_two_catalogues_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "springs.csv"
    file.write_text("part,drive.stiffness [N/m]\nA,100\n")
    problem = {**PAPER, "catalogues": {"spring": str(file), "other": str(file)}}
    with pytest.raises(ConfigError) as error:
        problem_of(pd.load_device(MOUSE), problem)
    assert error.value.problems == (
        "problem: drive.stiffness is in the catalogues spring and other; leave one out",
        "problem: drive.stiffness is in [axes] and in the catalogue other; leave one out",
    )


def test_a_device_file_is_no_problem() -> None:
    with pytest.raises(
        ConfigError, match="is a device file; a design problem names its device, base = "
    ):
        read_problem(MOUSE)


def test_a_catalogue_sets_several_keys_of_a_part(tmp_path: Path) -> None:
    """Rows stay together, in the order of the first key."""
    file = tmp_path / "springs.csv"
    file.write_text("part;drive.stiffness [N/mm];mass [g];price\nstiff;0.2;12;3\nsoft;0.1;11;2\n")
    problem = problem_of(
        pd.load_device(MOUSE),
        {"catalogues": {"spring": str(file)}, "goals": {"minimise": "settling_time"}},
    )
    (spring,) = problem.variables
    assert spring.catalogue is not None and spring.catalogue.parts == ("soft", "stiff")
    assert spring.catalogue.prices == (2.0, 3.0)
    found = {key: values.tolist() for key, values in spring.columns(np.array([0.2, 0.9])).items()}
    assert found == {"drive.stiffness": [100.0, 200.0], "drive.mass": [0.011, 0.012]}

"""`pindrive init --problem` writes a problem file that `pindrive design` accepts."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import refused, run
from design_problems import SMALL
from pindrive.optimisation import effort, read_problem

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def test_a_design_problem_is_written_that_a_design_meets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(effort, "BATCHED", SMALL)
    result = run("init", "problem.toml", "--problem")
    assert (
        result.stdout
        == "Wrote problem.toml; try: pindrive design problem.toml --plot problem.png\n"
    )
    text = Path("problem.toml").read_text("utf-8")
    assert all(len(line) <= 100 for line in text.splitlines())
    done = run("design", "problem.toml", "--plot", "problem.png")
    assert (done.exit_code, done.stderr) == (0, ""), done.output
    assert "Design: my design" in done.stdout


def test_the_catalogue_that_stands_in_a_comment_is_right_too() -> None:
    assert run("init", "problem.toml", "--problem").exit_code == 0
    path = Path("problem.toml")
    text = path.read_text("utf-8").replace("# [catalogues]", "[catalogues]")
    text = text.replace("# spring = ", "spring = ")
    lines = [line for line in text.splitlines() if not line.startswith("drive.stiffness = {")]
    path.write_text("\n".join(lines).replace('drive.stiffness = "5 %"\n', ""), "utf-8")
    Path("springs.csv").write_text("part, drive.stiffness [N/m], price\nA,100,1\nB,200,2\n")
    assert [v.name for v in read_problem(path).variables if v.catalogue] == ["spring"]


def test_a_design_problem_for_a_whole_device() -> None:
    assert run("init", "problem.toml", "--problem", "--device").exit_code == 0
    problem = read_problem("problem.toml")
    assert problem.study.page and [goal.text() for goal in problem.goals] == [
        "maximise distinct_speed"
    ]


def test_a_design_problem_replaces_a_study_only_when_forced() -> None:
    assert (
        refused("init", "a.toml", "--study", "--problem") == "give --study or --problem, not both"
    )
    assert run("init", "study.toml", "--study").exit_code == 0
    assert refused("init", "study.toml", "--problem") == (
        "study.toml: exists and is no problem file; give another name, or --force"
    )
    assert run("init", "problem.toml", "--problem").exit_code == 0
    assert run("init", "problem.toml", "--problem", "--force").exit_code == 0

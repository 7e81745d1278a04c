"""`pindrive init --wish`: a wish that `pindrive design` takes as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import refused, run
from pindrive.optimisation import effort, read_wish
from wishes import SMALL

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def test_a_wish_is_written_that_a_design_meets(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(effort, "BATCHED", SMALL)
    result = run("init", "wish.toml", "--wish")
    assert result.stdout == "Wrote wish.toml; try: pindrive design wish.toml --plot wish.png\n"
    text = Path("wish.toml").read_text("utf-8")
    assert all(len(line) <= 100 for line in text.splitlines())
    done = run("design", "wish.toml", "--plot", "wish.png")
    assert (done.exit_code, done.stderr) == (0, ""), done.output
    assert "Design: my wish" in done.stdout


def test_the_catalogue_that_stands_in_a_comment_is_right_too() -> None:
    assert run("init", "wish.toml", "--wish").exit_code == 0
    path = Path("wish.toml")
    text = path.read_text("utf-8").replace("# [catalogues]", "[catalogues]")
    text = text.replace("# spring = ", "spring = ")
    lines = [line for line in text.splitlines() if not line.startswith("drive.stiffness = {")]
    path.write_text("\n".join(lines).replace('drive.stiffness = "5 %"\n', ""), "utf-8")
    Path("springs.csv").write_text("part, drive.stiffness [N/m], price\nA,100,1\nB,200,2\n")
    assert [v.name for v in read_wish(path).variables if v.catalogue] == ["spring"]


def test_a_wish_for_a_whole_device() -> None:
    assert run("init", "wish.toml", "--wish", "--device").exit_code == 0
    wish = read_wish("wish.toml")
    assert wish.plan.page and [goal.text() for goal in wish.goals] == ["maximise distinct_speed"]


def test_a_wish_replaces_a_study_only_when_forced() -> None:
    assert refused("init", "a.toml", "--study", "--wish") == "give --study or --wish, not both"
    assert run("init", "study.toml", "--study").exit_code == 0
    assert refused("init", "study.toml", "--wish") == (
        "study.toml: is there and is no wish file; give another name, or --force"
    )
    assert run("init", "wish.toml", "--wish").exit_code == 0
    assert run("init", "wish.toml", "--wish", "--force").exit_code == 0

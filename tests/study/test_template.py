"""`pindrive init --study`: files that every command of studies takes as they are."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from command import GOOD, refused, run
from pindrive.study.spec import load_study
from pindrive.study.template import study_template

pytestmark = pytest.mark.usefixtures("in_empty_folder")


@pytest.mark.parametrize(("options", "points"), [([], 19 * 15 * 3), (["--device"], 5 * 3 * 2)])
def test_a_study_is_written_that_can_be_swept(options: list[str], points: int) -> None:
    result = run("init", "study.toml", "--study", *options)
    assert result.stdout == "Wrote study.toml; try: pindrive sweep study.toml\n"
    plan = load_study("study.toml")
    assert plan.size == points
    assert f"Every combination of these is computed: {' x '.join(map(str, plan.shape))} " in (
        Path("study.toml").read_text("utf-8")
    )
    assert plan.tolerances and plan.constraints
    assert bool(plan.page) is bool(options)


def test_every_command_of_studies_takes_it() -> None:
    assert run("init", "study.toml", "--study").exit_code == 0
    for command in (
        ["sweep", "study.toml"],
        ["map", "study.nc", "--plot", "map.png"],
        ["sensitivity", "study.toml", "--tolerances", "--rows", "128"],
        ["robustness", "study.toml", "--draws", "200"],
    ):
        result = run(*command)
        assert (result.exit_code, result.stderr) == (0, ""), result.output


def test_a_scan_of_the_study_of_a_whole_device() -> None:
    assert run("init", "study.toml", "--study", "--device").exit_code == 0
    result = run("sweep", "study.toml", "--stop-after", "1")
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize("whole", [False, True])
def test_commented_lines_are_valid(whole: bool) -> None:
    """A distribution and [sample], and the names under `outputs`."""
    text = re.sub(
        r"^# (?=outputs|\[sample\]|method|count|seed)", "", study_template(whole=whole), flags=re.M
    )
    draw = re.search(r"^#   (drive\.mass = .*)$", text, re.M)
    assert draw
    text = text.replace("[axes]\n", f"[axes]\n{draw[1]}\n")
    tables = tomllib.loads(text)
    assert tables["sample"] == {"method": "sobol", "count": 1024, "seed": 1}
    assert all(len(line) <= 100 for line in text.splitlines())
    Path("study.toml").write_text(text, "utf-8")
    plan = load_study("study.toml")
    kept = plan.outputs[: len(tables["outputs"])]
    assert {*plan.outputs} - {*kept} <= {
        *(constraint.name for constraint in plan.constraints),
        "status",
    }
    assert all(full.endswith(name) for full, name in zip(kept, tables["outputs"], strict=True))
    assert plan.size % 1024 == 0


def test_init_replaces_a_study_only_when_forced() -> None:
    assert run("init", "study.toml", "--study").exit_code == 0
    assert refused("init", "study.toml", "--study") == (
        "study.toml: exists already; --force replaces it"
    )
    assert refused("init", "study.toml") == (
        "study.toml: exists and is no device file; give another name, or --force"
    )
    Path("device.toml").write_text(GOOD)
    assert refused("init", "device.toml", "--study") == (
        "device.toml: exists and is no study file; give another name, or --force"
    )
    assert run("init", "study.toml", "--study", "--force").exit_code == 0


@pytest.mark.parametrize("options", [[], ["--device"]])
@pytest.mark.parametrize("command", ["check", "simulate", "scan", "speed"])
def test_command_of_devices_refuses_a_study_in_one_line(command: str, options: list[str]) -> None:
    assert run("init", "study.toml", "--study", *options).exit_code == 0
    first = "[page]" if options else "[axes]"
    assert refused(command, "study.toml").startswith(
        f"study.toml: is a study file, as it has {first}"
    )

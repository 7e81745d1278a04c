"""Commands without the extra "complete", and their messages."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from command import EXAMPLE, EXAMPLES
from pindrive import lazy

ROOT = Path(__file__).resolve().parents[1]
READER = EXAMPLES / "tactile-reader.toml"
STUDY = EXAMPLES / "tactile-mouse-study.toml"
PROBLEM = EXAMPLES / "tactile-mouse-problem.toml"
RECORDING = EXAMPLES / "release-recording.csv"
ADVICE = 'is not installed; python -m pip install "pindrive[complete]" installs it'

HIDING = f"""
from importlib.machinery import PathFinder

find = PathFinder.find_spec
hidden = {sorted(lazy.COMPLETE)}
PathFinder.find_spec = lambda name, *rest: (
    None if name.partition(".")[0] in hidden else find(name, *rest)
)
"""
"""Code that hides these packages from Python."""


def python(folder: Path, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run in a folder by a Python that has none of the packages of the extra."""
    (folder / "hiding").mkdir()
    (folder / "hiding" / "sitecustomize.py").write_text(HIDING, "utf-8")
    paths = [str(folder / "hiding"), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), "PYTHONUTF8": "1"},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )


ONE_PIN = ("--set", "array.columns=1", "--set", "array.rows=1")


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("simulate", EXAMPLE, "-o", "motion.csv"), "Laws checked"),
        (("check", READER), "In its slot"),
        (("scan", READER, *ONE_PIN, "--grating", "4 mm", "-o", "pins.csv"), "4 shown"),
        (("speed", READER, "--pitch", "4 mm"), "Tried:"),
        (("fmu", EXAMPLE, "-o", "drive.fmu"), "Wrote drive.fmu"),
        (("init", "own.toml", "--device"), "Wrote own.toml"),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_commands_work_without_optional_libraries(
    tmp_path: Path, command: tuple[str | Path, ...], said: str
) -> None:
    result = python(tmp_path, "-m", "pindrive", *command)
    assert (result.returncode, result.stderr) == (0, "")
    assert said in result.stdout


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (("simulate", EXAMPLE, "--plot", "a.png"), "--plot a.png: matplotlib"),
        (("scan", READER, "--grating", "4 mm", "-o", "a.nc"), "-o a.nc: h5netcdf"),
        (("scan", READER, "--grating", "4 mm", "--animate", "a.gif"), "matplotlib"),
        (("scan", READER, "--text", "A"), "matplotlib"),
        (("speed", READER, "-o", "a.csv"), "-o a.csv: xarray"),
        (("sweep", STUDY, "-o", "a.nc"), "a.nc: h5netcdf"),
        (("sensitivity", STUDY), "scipy"),
        (("fit", EXAMPLE, RECORDING, "--free", "mass"), "scipy"),
        (("design", PROBLEM, "-o", "a.toml"), "scipy"),
        (("paper", "-o", "a"), "xarray"),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_missing_library_names_its_installation(
    tmp_path: Path, command: tuple[str | Path, ...], line: str
) -> None:
    """In one line, before anything is computed or written."""
    result = python(tmp_path, "-m", "pindrive", *command)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == f"{line} {ADVICE}\n"
    assert [path.name for path in tmp_path.iterdir()] == ["hiding"]


def test_python_equals_the_command(tmp_path: Path) -> None:
    program = f"""
import pindrive

drive = pindrive.load_device({str(EXAMPLE)!r}).drive
motion = pindrive.simulate(drive, pindrive.Release(mouse_velocity=0.1))
print(motion.ending.kind)
for show in (motion.plot, motion.to_dataset):
    try:
        show()
    except ModuleNotFoundError as error:
        print(error.name, error)
"""
    result = python(tmp_path, "-c", program)
    assert result.stderr == ""
    ending, *refusals = result.stdout.splitlines()
    assert ending == "resting"
    assert refusals == [
        f"{refusals[0].split()[0]} matplotlib {ADVICE}",
        f"xarray xarray {ADVICE}",
    ]


def test_the_extra_has_what_is_imported() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    extra = project["optional-dependencies"]["complete"]
    assert [re.split(r"[>=]", line)[0] for line in extra] == sorted(lazy.COMPLETE.values())
    paper = project["optional-dependencies"]["paper"]
    assert [re.split(r"[>=]", line)[0] for line in paper[1:]] == sorted(lazy.PAPER.values())


def test_a_library_of_the_paper_alone_names_its_extra() -> None:
    advice = lazy.missing(ModuleNotFoundError(name="latex2mathml.converter"))
    assert advice == ADVICE.replace("complete", "paper").replace("is not", "latex2mathml is not", 1)


def test_another_module_that_is_missing_is_a_fault_of_ours() -> None:
    assert lazy.missing(ModuleNotFoundError(name="pindrive.plot.absent")) == ""
    assert lazy.missing(ModuleNotFoundError()) == ""

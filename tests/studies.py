"""A study for the tests of sweeps, and how they run it: in the folder that they are in."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner, Result

from pindrive.cli.app import app
from pindrive.study.runner import sweep
from pindrive.study.spec import load_study
from pindrive.study.study import Study

HERE = Path(__file__).parent
BASE = f'base = "{(HERE / "minimal.toml").as_posix()}"\n'
SAMPLED = """
chunk = 500
[axes]
mass = { loguniform = ["2 g", "20 g"] }
damping_ratio = { uniform = [0.01, 0.5] }
plate.kinetic = { normal = ["50 mN", "20 mN"] }
mouse_velocity = ["60 mm/s", "120 mm/s"]
duration = ["0.2 s"]
[sample]
method = "sobol"
count = 2048
"""


def plan(text: str = SAMPLED, name: str = "study.toml") -> Study:
    Path(name).write_text(BASE + text)
    return load_study(name)


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["sweep", *arguments])


def files() -> set[str]:
    return {path.name for path in Path().iterdir()}


def uninterrupted() -> bytes:
    """The file that a sweep of the study writes."""
    sweep(plan(), Path("whole.nc"))
    return Path("whole.nc").read_bytes()

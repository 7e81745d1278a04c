"""The command `pindrive design`: its tables, the files that it writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import xarray as xr
from rich.console import Console

from command import GOOD, refused, run
from design_problems import SMALL
from pindrive import load_device
from pindrive.cli.design import NONE_MEETS
from pindrive.cli.design_tables import design_report
from pindrive.optimisation import effort, optimise

pytestmark = pytest.mark.usefixtures("in_empty_folder")

PROBLEM = """
name = "short"
base = "device.toml"
[axes]
drive.damping = { uniform = ["0 N*s/m", "1 N*s/m"] }
finger.kinetic = { uniform = ["2 mN", "30 mN"] }
[specification]
peak_displacement = ">= 2.2 mm"
[set]
motion.displacement = "2 mm"
[tolerances]
drive.damping = "10 %"
[goals]
minimise = "settling_time"
"""


@pytest.fixture(autouse=True)
def inputs(in_empty_folder: None, monkeypatch: pytest.MonkeyPatch) -> None:
    Path("device.toml").write_text(GOOD)
    Path("problem.toml").write_text(PROBLEM)
    monkeypatch.setattr(effort, "BATCHED", SMALL)


def test_a_design_is_printed_and_written_or_the_closest_to_it() -> None:
    files = ("design.toml", "design.nc", "design.json", "design.png")
    outputs = [word for file in files[:3] for word in ("-o", file)]
    done = run("design", "problem.toml", *outputs, "--plot", files[3])
    assert done.exit_code == 0, done.output
    for words in (
        "Design: short",
        "minimise settling_time",
        "peak_displacement ≥ 2.2 mm",
        "Binding",
    ):
        assert words in done.stdout
    assert "Yield within the tolerances: " in done.stdout
    assert done.stdout.endswith("".join(f"Wrote {file}\n" for file in files))
    text = Path("design.toml").read_text("utf-8")
    assert text.startswith("# Designed by pindrive.\n# Problem: problem.toml, short; seed 1.\n")
    device = load_device("design.toml")
    with xr.open_dataset("design.nc", engine="h5netcdf") as data:
        assert float(data.damping) == device.drive.damping
        assert float(data.transient_settling_time) > 0.0
        settling = float(data.transient_settling_time)
    numbers = json.loads(Path("design.json").read_text("utf-8"))
    assert numbers["variables"]["transient_settling_time"]["values"] == settling
    assert Path("design.png").read_bytes().startswith(b"\x89PNG")
    simulated = run("simulate", "design.toml")
    assert f"{1e3 * settling:.4g}"[:5] in simulated.stdout

    # No design is an answer too, with the closest and its own status.
    Path("problem.toml").write_text(PROBLEM.replace(">= 2.2 mm", ">= 5 mm"))
    done = run("design", "problem.toml", "-o", "design.toml", "--force")
    assert done.exit_code == NONE_MEETS == 1
    assert "No design meets this: the closest violates peak_displacement ≥ 5 mm by " in done.stdout
    text = Path("design.toml").read_text("utf-8")
    assert "# No design meets the constraints; the closest violates peak_displacement" in text
    load_device("design.toml")


def test_tables_show_values_in_their_units() -> None:
    """Every number of the report is a number of the result, in its display unit."""
    found = optimise(None, "problem.toml", effort=SMALL)
    text = Path("report.txt")
    with text.open("w", encoding="utf-8") as file:
        Console(file=file, width=120).print(design_report(found))
    lines = [line.split() for line in text.read_text("utf-8").splitlines()]
    rows = {words[0]: words for words in reversed(lines) if words}  # the first of each key
    damping = found.values["drive.damping"]
    assert float(rows["drive.damping"][1]) == pytest.approx(damping, rel=1e-3)
    assert float(rows["finger.kinetic"][1]) == pytest.approx(
        1e3 * found.values["finger.kinetic"], rel=1e-3
    )
    (required,) = found.constraints
    _, sign, limit, unit, worst, _, margin, *_ = rows["peak_displacement"]
    assert (sign, limit, unit) == ("≥", "2.2", "mm")
    assert float(worst) == pytest.approx(1e3 * required.value, rel=1e-3)
    assert float(margin) == pytest.approx(-1e3 * required.excess, rel=1e-2) and float(margin) >= 0.0
    assert float(rows["minimise"][2]) == pytest.approx(1e3 * found.goals[0].value, rel=1e-3)


def test_files_that_a_design_may_not_replace_are_refused() -> None:
    for file, said in (
        ("design.csv", "-o design.csv: must end in .toml, .nc, .json"),
        ("problem.toml", "is read by this command"),
        ("device.toml", "is read by this command"),
    ):
        assert said in refused("design", "problem.toml", "-o", file, "--force")
    Path("mine.toml").write_text(GOOD)
    assert "exists already; --force replaces it" in refused(
        "design", "problem.toml", "-o", "mine.toml"
    )


def test_error_of_a_design_problem_is_one_line() -> None:
    Path("problem.toml").write_text(PROBLEM.replace("minimise", "minimize"))
    line = refused("design", "problem.toml")
    assert line == "problem.toml: unknown key goals.minimize; there are minimise and maximise"
    assert "is a device file; a design problem names" in refused("design", "device.toml")
    Path("problem.toml").write_text(PROBLEM)
    assert "unknown key dampling" in refused("design", "problem.toml", "--set", "dampling=1")

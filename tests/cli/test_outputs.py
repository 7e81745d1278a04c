"""Files that the commands write: equal options everywhere, and the printed numbers."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
import xarray as xr

from command import EXAMPLES, run
from pindrive import load_device, load_study, robustness
from pindrive.evaluation import largest_speeds

pytestmark = pytest.mark.usefixtures("in_empty_folder")

BOTH = ("simulate", "scan", "speed", "robustness", "sensitivity", "bifurcation", "design", "fit")
WRITE = (*BOTH, "sweep", "fmu")
DRAW = (*BOTH, "map")
STUDY = EXAMPLES / "tactile-mouse-study.toml"
READER = EXAMPLES / "tactile-reader.toml"


@pytest.mark.parametrize("command", [*WRITE, "paper", "map", "init"])
def test_the_options_of_output_are_alike(command: str) -> None:
    said = run(command, "--help").stdout
    assert "--force" in said
    assert ("-o, --output" in said) == (command in (*WRITE, "paper"))
    assert ("--plot" in said) == (command in DRAW)
    for other in ("--csv", "--netcdf", "--json", "--out ", "--restart"):
        assert other not in said
    assert "[required]" not in said.partition("--output")[2].partition("--force")[0]


def rows(path: str) -> list[dict[str, str]]:
    with Path(path).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_speeds_are_written_as_python_has_them() -> None:
    files = [part for name in ("a.csv", "a.nc", "a.json") for part in ("-o", name)]
    span = ("--slowest", "30 mm/s", "--fastest", "50 mm/s")
    said = run("speed", READER, "--pitch", "8 mm", *span, *files)
    assert said.exit_code == 0, said.output
    assert said.stdout.endswith("Wrote a.csv\nWrote a.nc\nWrote a.json\n")
    device = load_device(READER)
    found = largest_speeds(
        device.device, [0.008], slowest=0.03, fastest=0.05, criteria=device.criteria
    ).to_dataset()
    table = rows("a.csv")
    assert list(table[0])[:2] == ["speed_pitch [m]", "speed_width [m]"]
    assert [float(row["speed_distinct [m/s]"]) for row in table] == list(found.speed_distinct)
    with xr.open_dataset("a.nc", engine="h5netcdf") as written:
        assert written.drop_attrs().identical(found.drop_attrs())
        assert written.attrs["title"] == "Largest speeds of a hand"
    document = json.loads(Path("a.json").read_text(encoding="utf-8"))
    distinct = document["variables"]["speed_distinct"]
    assert distinct["values"] == list(found.speed_distinct)
    assert distinct["attributes"]["units"] == "m/s"


def test_the_csv_of_draws_has_a_row_for_each() -> None:
    assert run("robustness", STUDY, "--draws", "50", "-o", "a.csv").exit_code == 0
    found = robustness(load_study(STUDY), count=50).to_dataset()
    written = [float(row["transient_swing [m]"]) for row in rows("a.csv")]
    assert written == list(found.transient_swing)


def test_a_sampled_time_is_at_most_the_end() -> None:
    """0.02 s and 0.49999999999999994 s at 1 kHz end at their last moment, not an ulp later."""
    from pindrive.files.export import even_times

    assert even_times(0.0, 0.49999999999999994, 1000.0)[-1] == 0.49999999999999994
    assert even_times(0.0, 0.02, 1000.0)[-1] == 0.02


def test_study_is_printed_without_a_picture() -> None:
    Path("small.toml").write_text(
        f'base = "{(EXAMPLES / "tactile-mouse.toml").as_posix()}"\n[axes]\nmass = ["9 g", "10 g"]\n'
    )
    assert run("sweep", "small.toml").exit_code == 0
    said = run("map", "small.nc", "--number", "swing")
    assert said.exit_code == 0, said.output
    with xr.open_dataset("small.nc", engine="h5netcdf") as data:
        least, most = (1e3 * float(swing) for swing in sorted(data.transient_swing))
    assert said.stdout == f"swing: {least:.4g} mm (mass 9 g) to {most:.4g} mm (mass 10 g)\n"
    assert not [*Path().glob("*.png")]


def test_a_unit_is_named_after_its_device() -> None:
    Path("own.toml").write_bytes((EXAMPLES / "tactile-mouse.toml").read_bytes())
    assert run("fmu", "own.toml").stdout.startswith("Wrote own.fmu, FMI 3.0")
    Path("own.fmu").write_text("mine")
    assert run("fmu", "own.toml").exit_code == 2
    assert run("fmu", "own.toml", "--force").exit_code == 0

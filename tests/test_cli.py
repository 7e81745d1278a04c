"""The command line: what it prints and writes, and that bad input leaves one line and no file."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

import pytest
import xarray as xr
from typer.testing import CliRunner, Result

import pindrive
from pindrive.cli import app

EXAMPLE = Path(__file__).parents[1] / "examples" / "tactile-mouse.toml"


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(*arguments: str | Path) -> str:
    """The one line on the standard error of a command that refuses and leaves the folder as is."""
    before = {path: path.stat().st_mtime_ns for path in Path().rglob("*")}
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert isinstance(result.exception, SystemExit), "no traceback"
    assert {path: path.stat().st_mtime_ns for path in Path().rglob("*")} == before
    (line,) = result.stderr.splitlines()
    return line


# ---- good input ----------------------------------------------------------------------------------


def test_version() -> None:
    result = run("--version")
    assert (result.exit_code, result.output) == (0, f"pindrive {pindrive.__version__}\n")


def test_init_check_simulate() -> None:
    assert run("init", "new.toml").exit_code == 0
    checked = run("check", "new.toml")
    assert checked.exit_code == 0
    assert "underdamped, natural frequency 15.92 Hz" in checked.stdout
    simulated = run("simulate", "new.toml")
    assert simulated.exit_code == 0
    assert simulated.stdout == run("simulate", EXAMPLE).stdout, "the example is what init writes"


def test_init_keeps_a_file_unless_forced() -> None:
    Path("new.toml").write_text("mine")
    assert refused("init", "new.toml") == "new.toml: exists already; --force replaces it"
    assert run("init", "new.toml", "--force").exit_code == 0
    assert run("check", "new.toml").exit_code == 0


def test_simulate_prints_phases_numbers_and_ending() -> None:
    output = run("simulate", EXAMPLE).stdout
    lines = [line.split() for line in output.splitlines()]
    phases = [line for line in lines if {"slip", "carried", "resting"} & set(line)]
    assert len(phases) >= 4
    assert phases[0][:4] == ["0", "3.022", "3.022", "slip"]
    assert ["t_a", "3.022", "ms", "time", "of", "the", "peak", "displacement"] in lines
    assert "At rest at x = " in output
    assert "largest relative residual" in output


def test_simulate_leaves_the_middle_of_many_phases_out() -> None:
    frictions = ("plate.kinetic=1e-3 mN", "plate.static=1e-3 mN", "finger.kinetic=0.2 mN")
    values = (*frictions, "finger.static=0.2 mN", "damping_ratio=0")
    output = run("simulate", EXAMPLE, *(f"--set={value}" for value in values)).stdout
    assert "more phases" in output
    assert len(output.splitlines()) < 60


def test_numbers_of_an_absent_contact_are_left_out() -> None:
    output = run("simulate", EXAMPLE, "--set=finger.kinetic=0 N", "--set=finger.static=0 N").stdout
    assert "at the plate" in output
    assert "at the finger" not in output


def test_set_replaces_values() -> None:
    damped = run("simulate", EXAMPLE, "--set", "damping_ratio=2", "--set", "mass=12 g")
    assert damped.exit_code == 0
    assert damped.stdout != run("simulate", EXAMPLE).stdout


def test_json_holds_every_number() -> None:
    assert run("simulate", EXAMPLE, "--json", "out.json").exit_code == 0
    document = json.loads(Path("out.json").read_text(encoding="utf-8"))
    assert document["pindrive"] == pindrive.__version__
    assert document["config"]["drive.mass"] == 0.010
    assert document["config"]["motion.duration"] is None
    assert document["ending"]["kind"] == "resting"
    assert document["numbers"]["transient.peak_time"] == pytest.approx(3.022e-3, abs=1e-6)
    assert document["units"]["transient.peak_time"] == "s"
    assert document["events"][0]["kind"] == "cross"
    assert document["segments"][-1]["mode"] == "resting"
    assert document["segments"][-1]["end"] is None
    assert document["certificate"]["worst"] < 1e-12


def test_csv_holds_samples_and_events() -> None:
    assert run("simulate", EXAMPLE, "--csv", "out.csv", "--samples", "50").exit_code == 0
    with Path("out.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = [float(row["time_s"]) for row in rows]
    assert list(rows[0]) == [
        "time_s",
        "position_m",
        "velocity_m_per_s",
        "acceleration_m_per_s2",
        "plate_force_N",
        "finger_force_N",
    ]
    assert times == sorted(set(times))
    assert len(times) > 50
    assert (float(rows[0]["position_m"]), float(rows[0]["velocity_m_per_s"])) == (0.002, 0.06)


def test_netcdf_has_units() -> None:
    assert run("simulate", EXAMPLE, "--netcdf", "out.nc").exit_code == 0
    with xr.open_dataset("out.nc", engine="h5netcdf", decode_timedelta=False) as dataset:
        assert dataset["position"].attrs["units"] == "m"
        assert float(dataset["position"][0]) == 0.002


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.SVG", b"<?xml"), ("a.pdf", b"%PDF")]
)
def test_plot(name: str, start: bytes) -> None:
    result = run("simulate", EXAMPLE, "--plot", name)
    assert result.exit_code == 0, result.output
    assert Path(name).read_bytes().startswith(start)
    assert result.stdout.endswith(f"Wrote {name}\n")


def test_several_files_at_once_and_nothing_else() -> None:
    assert run("simulate", EXAMPLE, "--csv", "a.csv", "--json", "a.json").exit_code == 0
    assert sorted(path.name for path in Path().iterdir()) == ["a.csv", "a.json"]


def test_a_link_stays_and_its_target_is_replaced() -> None:
    Path("old.json").write_text("old")
    Path("link.json").symlink_to("old.json")
    assert run("simulate", EXAMPLE, "--json", "link.json").exit_code == 0
    assert Path("link.json").is_symlink()
    assert json.loads(Path("old.json").read_text(encoding="utf-8"))


# ---- bad input -----------------------------------------------------------------------------------

GOOD = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping = "0.40 N*s/m"
[plate]
kinetic = "20 mN"
[finger]
kinetic = "5 mN"
[motion]
mouse_velocity = "100 mm/s"
"""


@pytest.mark.parametrize(
    ("old", "new", "place", "bound"),
    [
        ('"10 g"', '"10 N"', "drive.mass", "in kg"),
        ('"10 g"', "10", "drive.mass", "give a unit"),
        ('"10 g"', '"nan g"', "drive.mass", "greater than 0 kg"),
        ('"10 g"', '"inf g"', "drive.mass", "finite"),
        ('"10 g"', '"0 g"', "drive.mass", "greater than 0 kg"),
        ('"10 g"', '"-1 g"', "drive.mass", "greater than 0 kg"),
        ('"100 N/m"', '"0 N/m"', "drive.stiffness", "greater than 0 N/m"),
        ('"100 N/m"', '"-1 N/m"', "drive.stiffness", "greater than 0 N/m"),
        ('"0.40 N*s/m"', '"-1 N*s/m"', "drive.damping", "at least 0 N*s/m"),
        ('"20 mN"', '"-1 mN"', "plate.kinetic", "at least 0 N"),
        ('"5 mN"', '"5 mN"\nstatic = "1 mN"', "finger.static", "kinetic friction, 0.005 N"),
        ('"100 mm/s"', '"-inf m/s"', "motion.mouse_velocity", "finite"),
        ("mass", "mas", "drive.mas", "did you mean drive.mass"),
        ('"10 g"', '"10 g', "not valid TOML", "at line 3"),
    ],
)
@pytest.mark.parametrize("command", ["check", "simulate"])
def test_bad_device_file(command: str, old: str, new: str, place: str, bound: str) -> None:
    Path("bad.toml").write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    line = refused(command, "bad.toml", *(["--csv", "out.csv"] if command == "simulate" else []))
    assert line.startswith("bad.toml: ")
    assert place in line
    assert bound in line


@pytest.mark.parametrize("command", ["check", "simulate"])
def test_missing_device_file(command: str) -> None:
    assert refused(command, "no.toml") == "no.toml: cannot be read: No such file or directory"


def test_every_problem_has_its_line() -> None:
    Path("bad.toml").write_text(GOOD.replace('"10 g"', '"0 g"').replace('"5 mN"', "5"))
    result = run("simulate", "bad.toml", "--set", "spring=3")
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 3


@pytest.mark.parametrize(
    ("override", "problem"),
    [
        ("mass=-1 g", "--set mass: drive.mass must be finite and greater than 0 kg"),
        ("kinetic=1 mN", "--set kinetic: give the key in full"),
        ("mas=1 g", "--set mas: unknown key mas; did you mean drive.mass?"),
        ("mass", '--set "mass": must be key=value'),
    ],
)
def test_bad_override(override: str, problem: str) -> None:
    assert refused("simulate", EXAMPLE, "--set", override).startswith(problem)


@pytest.mark.parametrize("option", ["--plot", "--csv", "--netcdf", "--json"])
@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("no/such/folder/out.png", "No such file or directory"),
        ("folder.png", "not a regular file"),
        ("file.png/out.png", "Not a directory"),
        pytest.param(
            os.devnull,
            "not a regular file",
            marks=pytest.mark.skipif(os.name == "nt", reason="NUL is no path there"),
        ),
    ],
)
def test_unwritable_output_is_refused_before_anything_runs(
    option: str, target: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def simulate(*_: object, **__: object) -> NoReturn:
        raise AssertionError("simulated all the same")

    monkeypatch.setattr(pindrive, "simulate", simulate)
    Path("folder.png").mkdir()
    Path("file.png").write_text("")
    if option == "--plot" and target == os.devnull:
        assert refused("simulate", EXAMPLE, option, target).endswith("must end in .png, .svg, .pdf")
    else:
        line = refused(
            "simulate", EXAMPLE, "--csv" if option != "--csv" else "--json", "good", option, target
        )
        assert line == f"{target}: cannot be written: {reason}"


def test_unknown_picture_format() -> None:
    line = refused("simulate", EXAMPLE, "--plot", "a.jpg")
    assert line == "--plot a.jpg: must end in .png, .svg, .pdf"


def test_one_file_named_twice() -> None:
    line = refused("simulate", EXAMPLE, "--csv", "a", "--json", "./a")
    assert line == "a: is named twice; give each file a name of its own"
    Path("mine.toml").write_text(GOOD)
    assert refused("simulate", "mine.toml", "--csv", "mine.toml").startswith("mine.toml: is named")


def test_a_failing_disk_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def write_csv(_: object, path: Path, __: int) -> NoReturn:
        path.write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pindrive.export.write_csv", write_csv)
    Path("a.csv").write_text("old")
    line = refused("simulate", EXAMPLE, "--json", "a.json", "--csv", "a.csv")
    assert line == "a.csv: cannot be written: No space left on device"
    assert Path("a.csv").read_text() == "old"


def test_interruption_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def write_csv(_: object, path: Path, __: int) -> NoReturn:
        path.write_text("half")
        raise KeyboardInterrupt

    monkeypatch.setattr("pindrive.export.write_csv", write_csv)
    result = run("simulate", EXAMPLE, "--csv", "a.csv")
    assert result.exit_code in (1, 130)
    assert list(Path().iterdir()) == []


# ---- a quick start -------------------------------------------------------------------------------


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys; sys.argv = ['pindrive', '--help']\n"
        "from pindrive.cli import main\n"
        "try: main()\n"
        "except SystemExit as end: assert not end.code\n"
        "heavy = {'numpy', 'pydantic', 'pint', 'rich', 'xarray', 'matplotlib', 'pindrive._core'}\n"
        "sys.exit(', '.join(heavy & set(sys.modules)) or None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "simulate" in done.stdout


def test_a_narrow_encoding_is_no_failure() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "pindrive", "simulate", str(EXAMPLE)],
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert b"?J" in done.stdout

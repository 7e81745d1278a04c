"""The command line: bad input, full disks and interruptions leave one line and no file."""

import os
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

import pytest

import pindrive
from command import EXAMPLE, GOOD, refused, run
from pindrive.files.output import PICTURES
from pindrive.quantities.results import MOTION

pytestmark = pytest.mark.usefixtures("in_empty_folder")


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
    line = refused(command, "bad.toml", *(["-o", "out.csv"] if command == "simulate" else []))
    assert line.startswith("bad.toml: ")
    assert place in line
    assert bound in line


@pytest.mark.parametrize("command", ["check", "simulate"])
def test_unreadable_device_file(command: str) -> None:
    Path("empty.toml").write_text("")
    Path("bytes.toml").write_bytes(b"\xff")
    assert refused(command, "no.toml") == "no.toml: cannot be read: No such file or directory"
    assert refused(command, ".").startswith(".: cannot be read: ")
    assert refused(command, "empty.toml").startswith("empty.toml: is empty; `pindrive init FILE`")
    assert refused(command, "bytes.toml") == "bytes.toml: is not UTF-8 text, at byte 0"


def test_init_where_no_file_can_be() -> None:
    Path("folder").mkdir()
    assert refused("init", "folder") == "folder: cannot be written: not a regular file"
    line = refused("init", "no/such/new.toml")
    assert line == "no/such/new.toml: cannot be written: No such file or directory"


def test_every_problem_has_its_line() -> None:
    Path("bad.toml").write_text(GOOD.replace('"10 g"', '"0 g"').replace('"5 mN"', "5"))
    result = run("simulate", "bad.toml", "--set", "spring=3")
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 3


@pytest.mark.parametrize(
    ("override", "problem"),
    [
        ("mass=-1 g", "--set mass: drive.mass must be finite and greater than 0 kg"),
        (
            "kinetic=1 mN",
            "--set kinetic: kinetic may be plate.kinetic, finger.kinetic or hand",
        ),
        ("mas=1 g", "--set mas: unknown key mas; did you mean drive.mass"),
        ("mass", '--set "mass": must be key=value'),
        ("plate=3", "--set plate: unknown key plate; did you mean plate.kinetic, "),
        ("speed=3", "--set speed: unknown key speed; did you mean motion.velocity?"),
    ],
)
def test_bad_override(override: str, problem: str) -> None:
    assert refused("simulate", EXAMPLE, "--set", override).startswith(problem)


@pytest.mark.parametrize("suffix", [".png", ".csv", ".nc", ".json"])
@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("no/such/folder/out", "No such file or directory"),
        ("folder", "not a regular file"),
        ("file/out", "Not a directory"),
        ("device", "not a regular file"),
    ],
)
def test_unwritable_output_is_refused_before_anything_runs(
    suffix: str, target: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def simulate(*_: object, **__: object) -> NoReturn:
        raise AssertionError("simulated all the same")

    monkeypatch.setattr(pindrive, "simulate", simulate)
    Path(f"folder{suffix}").mkdir()
    Path("file").write_text("")
    Path(f"device{suffix}").symlink_to(os.devnull)
    option = "--plot" if suffix == ".png" else "-o"
    line = refused("simulate", EXAMPLE, "-o", "good.json", option, f"{target}{suffix}")
    assert line == f"{target}{suffix}: cannot be written: {reason}"


def test_unknown_picture_format() -> None:
    line = refused("simulate", EXAMPLE, "--plot", "a.jpg")
    assert line == "--plot a.jpg: must end in .png, .svg, .pdf"


def test_one_file_named_twice() -> None:
    line = refused("simulate", EXAMPLE, "-o", "a.nc", "-o", "./a.nc")
    assert line == "-o a.nc: is named twice; give each file a name of its own"
    Path("mine.toml").write_text(GOOD)
    Path("a.csv").symlink_to("mine.toml")
    line = refused("simulate", "mine.toml", "-o", "a.csv", "--force")
    assert line == "-o a.csv: is read by this command; give another name"


def test_a_suffix_that_no_output_has() -> None:
    line = refused("simulate", EXAMPLE, "-o", "a.xlsx")
    assert line == "-o a.xlsx: must end in .csv, .nc, .json"


def test_a_failing_disk_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def write_csv(_: object, path: Path, __: object) -> NoReturn:
        path.write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pindrive.files.export.write_csv", write_csv)
    older = ",".join(quantity.heading for quantity in MOTION)
    Path("a.csv").write_text(older)
    line = refused("simulate", EXAMPLE, "-o", "a.json", "-o", "a.csv")
    assert line == "a.csv: cannot be written: No space left on device"
    assert Path("a.csv").read_text() == older


@pytest.mark.skipif(os.name == "nt", reason="there is no limit on the size of files")
@pytest.mark.parametrize("name", ["a.png", "a.svg", "a.pdf", "a.csv", "a.nc", "a.json"])
def test_a_disk_that_fills_up_leaves_nothing(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    import resource

    monkeypatch.setattr(
        sys, "dont_write_bytecode", True
    )  # the limit would cut what is imported now
    sizes = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1024, sizes[1]))
    try:
        picture = Path(name).suffix in PICTURES
        line = refused("simulate", EXAMPLE, "--plot" if picture else "-o", name)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, sizes)
    assert line == f"{name}: cannot be written: File too large"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full device")
@pytest.mark.parametrize("arguments", [["--help"], ["init", "a"], ["simulate", str(EXAMPLE)]])
def test_full_standard_output_is_reported(arguments: list[str]) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "pindrive", *arguments],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr == "standard output: cannot be written: No space left on device\n"


def test_interruption_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def write_csv(_: object, path: Path, __: object) -> NoReturn:
        path.write_text("half")
        raise KeyboardInterrupt

    monkeypatch.setattr("pindrive.files.export.write_csv", write_csv)
    result = run("simulate", EXAMPLE, "-o", "a.csv")
    assert result.exit_code in (1, 130)
    assert list(Path().iterdir()) == []

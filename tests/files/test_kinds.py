"""Commands never replace an input file, or a file of another kind."""

from __future__ import annotations

import os
import shutil
from contextlib import chdir
from pathlib import Path

import pytest
import xarray as xr
from PIL import Image

from command import EXAMPLE, EXAMPLES, GOOD, refused, run
from pindrive.files.output import (
    DEVICE_FILE,
    MOTION_CSV,
    PICTURES,
    STUDY_NETCDF,
    Output,
    OutputError,
    check_outputs,
    write_files,
)
from pindrive.quantities.results import MOTION
from scan_studies import DEVICE

pytestmark = pytest.mark.usefixtures("in_empty_folder")

STUDY = (
    f'base = "{EXAMPLE.as_posix()}"\n[axes]\nmass = ["9 g", "10 g"]\n[tolerances]\nmass = "1 %"\n'
)
HAND = "time [s],x [mm],y [mm]\n" + "".join(f"{0.01 * i:g},{i:g},0\n" for i in range(40))
SCAN = ("scan", "reader.toml", "--grating", "4 mm")
SPEED = ("speed", "reader.toml", "--pitch", "4 mm", "--fastest", "50 mm/s", "--slowest", "45 mm/s")
SENSITIVITY = ("sensitivity", "study.toml", "--rows", "128")
ROBUSTNESS = ("robustness", "study.toml", "--draws", "9")
COMMANDS = {
    "simulate --plot": (("simulate", "device.toml", "--plot"), "a.png"),
    "simulate -o a.csv": (("simulate", "device.toml", "-o"), "a.csv"),
    "simulate -o a.nc": (("simulate", "device.toml", "-o"), "a.nc"),
    "simulate -o a.json": (("simulate", "device.toml", "-o"), "a.json"),
    "scan --plot": ((*SCAN, "--plot"), "a.svg"),
    "scan --animate": ((*SCAN, "--slow", "0.1", "--animate"), "a.gif"),
    "scan --lines": ((*SCAN, "--lines"), "a.csv"),
    "scan -o a.csv": ((*SCAN, "-o"), "a.csv"),
    "scan -o a.nc": ((*SCAN, "-o"), "a.nc"),
    "scan -o a.json": ((*SCAN, "-o"), "a.json"),
    "speed --plot": ((*SPEED, "--plot"), "a.pdf"),
    "speed -o a.csv": ((*SPEED, "-o"), "a.csv"),
    "speed -o a.nc": ((*SPEED, "-o"), "a.nc"),
    "speed -o a.json": ((*SPEED, "-o"), "a.json"),
    "map -o": (("map", "swept.nc", "--plot"), "a.png"),
    "sensitivity --plot": ((*SENSITIVITY, "--plot"), "a.png"),
    "sensitivity -o a.csv": ((*SENSITIVITY, "-o"), "a.csv"),
    "sensitivity -o a.nc": ((*SENSITIVITY, "-o"), "a.nc"),
    "sensitivity -o a.json": ((*SENSITIVITY, "-o"), "a.json"),
    "robustness --plot": ((*ROBUSTNESS, "--plot"), "a.svg"),
    "robustness -o a.csv": ((*ROBUSTNESS, "-o"), "a.csv"),
    "robustness -o a.nc": ((*ROBUSTNESS, "-o"), "a.nc"),
    "robustness -o a.json": ((*ROBUSTNESS, "-o"), "a.json"),
    "fmu -o": (("fmu", "device.toml", "-o"), "a.fmu"),
}
"""Commands that write a file, with the option."""


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a file of each kind that commands read."""
    folder = tmp_path_factory.mktemp("written")
    with chdir(folder):
        Path("device.toml").write_text(GOOD)
        Path("reader.toml").write_text(DEVICE)
        Path("study.toml").write_text(STUDY)
        Path("hand.csv").write_text(HAND)
        Image.new("L", (40, 40), 255).save("page.png")
        assert run("sweep", "study.toml", "-o", "swept.nc").exit_code == 0
    return folder


@pytest.fixture(autouse=True)
def inputs(in_empty_folder: None, written: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pindrive.evaluation.resolution.TRIED", 2)  # which it reaches soon
    shutil.copytree(written, ".", dirs_exist_ok=True)


def foreign(name: str) -> bytes:
    """A file of that name which no command of pindrive writes."""
    if name.endswith(".nc"):
        xr.Dataset({"a": 1.0}).to_netcdf(name, engine="h5netcdf")
    else:
        Path(name).write_text("time [s],x [mm],y [mm]\n0,1,2\n")
    return Path(name).read_bytes()


@pytest.mark.parametrize("command", COMMANDS)
def test_a_file_is_replaced_by_its_own_kind_alone(command: str) -> None:
    arguments, name = COMMANDS[command]
    before = foreign(name)
    said = refused(*arguments, name)
    assert f" {name}: exists and is no " in said
    assert said.endswith("; give another name, or --force")
    assert Path(name).read_bytes() == before
    Path(name).unlink()
    Path(name).touch()  # an empty file holds nothing
    for _ in range(2):
        done = run(*arguments, name)
        assert done.exit_code == 0, done.output
        assert Path(name).stat().st_size > 0


WRITERS = {**COMMANDS, "sweep -o": (("sweep", "study.toml", "-o"), "a.nc")}
LINKS = [
    (command, link)
    for command in WRITERS
    # Other commands write files of a suffix that no input has.
    for link in ("itself", "another way", "symbolic", "hard")
    if link in ("symbolic", "hard") or command in ("sweep -o", "fmu -o")
]


@pytest.mark.parametrize(("command", "link"), LINKS)
def test_inputs_of_a_command_are_never_written(command: str, link: str) -> None:
    arguments, name = WRITERS[command]
    source = Path(arguments[1])
    content = source.read_bytes()
    target = Path("linked").with_suffix(Path(name).suffix)
    if link == "symbolic":
        target.symlink_to(source)
    elif link == "hard":
        target.hardlink_to(source)
    else:
        target = source if link == "itself" else Path("..") / Path.cwd().name / source
    said = refused(*arguments, target)
    assert said.endswith(f"{target}: is read by this command; give another name")
    assert source.read_bytes() == content


INPUTS = {
    "--image": ("scan", "reader.toml", "--image", "page.png", "--set", "scan.pixel=0.5 mm"),
    "--path": (*SCAN, "--path", "hand.csv"),
}


@pytest.mark.parametrize(
    ("arguments", "option", "target"),
    [
        (INPUTS["--image"], "--plot", "page.png"),
        (INPUTS["--path"], "--lines", "hand.csv"),
        (INPUTS["--path"], "-o", "hand.csv"),
        (INPUTS["--path"], "-o", "./hand.csv"),
    ],
)
def test_a_page_and_a_recording_stay(arguments: tuple[str, ...], option: str, target: str) -> None:
    before = Path(target).read_bytes()
    said = refused(*arguments, option, target)
    assert said.endswith(f" {Path(target)}: is read by this command; give another name")
    assert Path(target).read_bytes() == before


def test_the_device_and_the_page_of_a_study_stay() -> None:
    """Files that the command line does not name."""
    Path("paged.toml").write_text(
        'base = "reader.toml"\n[page]\nimage = "page.png"\npath = "hand.csv"\n'
        '[axes]\ncontrol.latency = ["1 ms", "2 ms"]\n[tolerances]\ncontrol.latency = "5 %"\n'
        '[set]\nscan.pixel = "0.5 mm"\n'
    )
    for target in ("reader.toml", "page.png", "hand.csv"):
        said = refused("sweep", "paged.toml", "-o", target)
        assert said == f"{target}: is read by this command; give another name"
    for command in ("sensitivity", "robustness"):
        said = refused(command, "paged.toml", "--plot", "page.png")
        assert said == "--plot page.png: is read by this command; give another name"
    os.link("page.png", "study.nc.partial")
    said = refused("sweep", "paged.toml", "-o", "study.nc", "--force")
    assert said == "study.nc.partial: is read by this command; give another name"


# ---- results that took long ----------------------------------------------------------------------


def test_a_study_is_replaced_on_request_only() -> None:
    first = Path("swept.nc").read_bytes()
    said = refused("sweep", "study.toml", "-o", "swept.nc")
    assert said == "swept.nc: exists already; --force replaces it"
    assert "is complete" in run("sweep", "study.toml", "-o", "swept.nc", "--resume").stdout
    Path("study.toml").write_text(STUDY.replace('"9 g"', '"8 g"'))
    assert refused("sweep", "study.toml", "-o", "swept.nc").endswith("--force replaces it")
    said = refused("sweep", "study.toml", "-o", "swept.nc", "--resume")
    assert said.startswith("swept.nc: holds another study: ")
    assert Path("swept.nc").read_bytes() == first
    assert run("sweep", "study.toml", "-o", "swept.nc", "--force").exit_code == 0
    assert Path("swept.nc").read_bytes() != first


@pytest.mark.parametrize("options", [(), ("--resume",)])
@pytest.mark.parametrize("name", ["device.toml", "page.png", "motion.nc", "alien.nc"])
def test_a_sweep_replaces_nothing_but_a_study(name: str, options: tuple[str, ...]) -> None:
    run("simulate", "device.toml", "-o", "motion.nc")
    foreign("alien.nc")
    before = Path(name).read_bytes()
    said = refused("sweep", "study.toml", "-o", name, *options)
    assert said == (
        f"{name}: exists and is no NetCDF file of a study; give another name, or --force"
    )
    assert Path(name).read_bytes() == before


def test_a_study_is_not_replaced_by_a_motion_or_a_scan() -> None:
    before = Path("swept.nc").read_bytes()
    said = refused("simulate", "device.toml", "-o", "swept.nc")
    assert "is no NetCDF file of a motion; " in said
    assert "is no NetCDF file of a scan; " in refused(*SCAN, "-o", "swept.nc")
    assert Path("swept.nc").read_bytes() == before


def test_init_replaces_nothing_unless_forced() -> None:
    said = refused("init", "device.toml")
    assert said == "device.toml: exists already; --force replaces it"
    for name in ("study.toml", "page.png", "swept.nc", "hand.csv"):
        said = refused("init", name)
        assert said == f"{name}: exists and is no device file; give another name, or --force"
    for name in ("device.toml", "page.png"):
        assert run("init", name, "--force").exit_code == 0
        assert run("check", name).exit_code == 0


# ---- the mechanism -------------------------------------------------------------------------------


def test_kinds_follow_from_the_content_of_a_file() -> None:
    assert DEVICE_FILE.holds(EXAMPLE)
    assert not DEVICE_FILE.holds(EXAMPLES / "tactile-reader-study.toml")
    assert STUDY_NETCDF.holds(Path("swept.nc"))
    Path("cut.nc").write_bytes(Path("swept.nc").read_bytes()[:999])
    assert not STUDY_NETCDF.holds(Path("cut.nc"))
    Path("renamed.svg").write_bytes(Path("page.png").read_bytes())
    assert not PICTURES[".svg"].holds(Path("renamed.svg"))
    assert PICTURES[".png"].holds(Path("renamed.svg"))
    assert not MOTION_CSV.holds(Path("hand.csv"))


def test_a_report_replaces_a_report_alone(tmp_path: Path) -> None:
    folder = tmp_path / "report"
    page = b"<!DOCTYPE html>\n<title>The report</title>\n1\n"
    write_files(folder, {"page.html": page, "data/x.csv": b"a,b\n1,2\n"})
    write_files(folder, {"page.html": page + b"2\n", "data/x.csv": b"a,b\n3,4\n"})
    assert (folder / "data/x.csv").read_bytes() == b"a,b\n3,4\n"
    for name, other in (
        ("page.html", b"<!DOCTYPE html>\n<title>My page</title>\n"),
        ("data/x.csv", b"t,x\n1,2\n"),
    ):
        (folder / name).write_bytes(other)
        with pytest.raises(OutputError, match=f"{Path(name).name}: exists and is no "):
            write_files(folder, {"new.html": page, "page.html": page, "data/x.csv": b"a,b\n"})
        assert (folder / name).read_bytes() == other
        (folder / name).write_bytes(page if name == "page.html" else b"a,b\n")
        assert not (folder / "new.html").exists()


def test_paper_keeps_a_page_of_another() -> None:
    Path("out").mkdir()
    Path("out/paper.html").write_text("<!DOCTYPE html>\n<title>Mine</title>\n")
    said = refused("paper", "-o", "out")
    assert said == (
        "-o out/paper.html: exists and is no report of the paper; give another name, or --force"
    )
    Path("docs").mkdir()
    Path("docs/paper.md").write_text("# Mine\n")
    assert "is no report of the paper" in refused("paper", "--docs", "docs")


def test_a_file_that_cannot_be_read_is_not_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    def unreadable(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied")

    Path("a.csv").write_text(",".join(quantity.heading for quantity in MOTION))
    monkeypatch.setattr("pindrive.files.output._head", unreadable)
    with pytest.raises(OutputError, match=r"a\.csv: exists, and cannot be read: Permission"):
        check_outputs([Output(Path("a.csv"), MOTION_CSV, "-o")])

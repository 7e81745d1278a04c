"""Options of the study commands, their messages, and their files after Ctrl-C."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from command import EXAMPLE, EXAMPLES, GOOD, refused, run
from pindrive import Contact, Drive, Release, simulate_batch
from pindrive.quantities.quantity import counted
from pindrive.quantities.table import check
from pindrive.study.outputs import Share
from pindrive.study.sensitivity import sobol
from pindrive.study.spec import load_study

pytestmark = pytest.mark.usefixtures("in_empty_folder")

STUDY = (
    f'base = "{EXAMPLE.as_posix()}"\n[axes]\nmass = ["9 g", "10 g"]\n'
    '[tolerances]\nmass = "5 %"\nmouse_velocity = "10 %"\n[specification]\nswing = ">= 1 mm"\n'
)


@pytest.fixture(autouse=True)
def study(in_empty_folder: None) -> None:
    Path("study.toml").write_text(STUDY)


# ---- options -------------------------------------------------------------------------------------

COUNTS = {
    "sweep": {"--threads": 1, "--stop-after": 1},
    "sensitivity": {"--threads": 1, "--seed": 0},
    "robustness": {"--threads": 1, "--seed": 0, "--draws": 1},
}


@pytest.mark.parametrize(
    ("command", "option", "least"),
    [(command, option, n) for command, of in COUNTS.items() for option, n in of.items()],
)
def test_counts_are_whole_and_large_enough(command: str, option: str, least: int) -> None:
    for given in (str(least - 1), "-7", "2.5", "1e3", "many", "nan", "", "٣", "1_000"):
        assert refused(command, "study.toml", option, given) == (
            f"{option} must be a whole number of at least {least}, got {given}"
        )
    many = "9" * 30
    assert refused(command, "study.toml", option, many) == (
        f"{option} must be a whole number of at least {least} and at most {10**18}, got {many}"
    )


@pytest.mark.parametrize("given", ["0", "-128", "64", "127", "1000", "2.5", "256.0"])
def test_rows_are_a_power_of_two(given: str) -> None:
    said = refused("sensitivity", "study.toml", "--rows", given)
    assert said == f"--rows must be a power of 2 of at least 128, got {given}"
    assert "a power of 2, >= 128" in " ".join(run("sensitivity", "--help").stdout.split())


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ("sweep", "Missing argument 'STUDY'."),
        ("sweep study.toml --treads 2", "No such option: --treads (Possible options: "),
        ("sweep study.toml more.toml", "Got unexpected extra argument(s) (more.toml)"),
        ("fit device.toml pin.csv", "--free KEYS must say what is fitted, such as --free "),
        ("sweap study.toml", "No such command 'sweap'. Did you mean 'sweep'?"),
        (
            "simulate device.toml --samples 1",
            "--samples must be a whole number of at least 2, got 1",
        ),
    ],
)
def test_wrong_usage_is_one_line(arguments: str, line: str) -> None:
    assert refused(*arguments.split()).startswith(line)


# ---- which numbers -------------------------------------------------------------------------------


def test_sensitivity_of_the_requested_numbers() -> None:
    done = run(
        *("sensitivity", "study.toml", "--rows", "128", "--plot", "a.svg", "--number", "swing"),
        *("--number", "transient.settling_time", "--number", "swing"),
    )
    assert done.exit_code == 0, done.output
    firsts = [line.split()[0] for line in done.stdout.splitlines() if line.split()]
    assert firsts.count("swing") == firsts.count("settling_time") == 3, "three tables"
    assert "peak_time" not in firsts
    assert "peak time" not in Path("a.svg").read_text("utf-8")
    plan = load_study("study.toml")
    one = sobol(plan, numbers=("transient_swing",), rows=128, near=True).over
    every = sobol(plan, rows=128, near=True).over
    assert set(one) == {"transient_swing"}
    np.testing.assert_array_equal(
        one["transient_swing"].total.value, every["transient_swing"].total.value
    )
    ledger = ("--number", "energy.plate_work", "--number", "settled")
    said = run("sensitivity", "study.toml", "--rows", "128", *ledger)
    assert said.exit_code == 0
    assert "energy_plate_work" in said.stdout


def test_a_number_that_is_none() -> None:
    said = refused("sensitivity", "study.toml", "--number", "swinge")
    assert said == "--number: unknown number swinge; did you mean swing?"
    for flag in ("status", "ending", "events"):
        assert refused("sensitivity", "study.toml", "--number", flag).startswith(
            f"--number: unknown number {flag}; "
        )
    paged = EXAMPLES / "tactile-reader-study.toml"
    said = refused("sensitivity", paged, "--number", "settling_time")
    assert said.startswith("--number: unknown number settling_time; ")


# ---- the device of a study set otherwise ---------------------------------------------------------


def test_a_study_sets_values_of_its_device() -> None:
    """In [set], after the device file; on the command line, after both."""
    given = '[set]\nstiffness = "120 N/m"\nplate.kinetic = "44 mN"\ndrive.damping = "0.1 N*s/m"\n'
    Path("study.toml").write_text(
        STUDY.replace("[axes]", given.replace("stiff", "drive.stiff") + "[axes]")
    )
    plan = load_study("study.toml", ["mass=12 g", "drive.stiffness=90 N/m"])
    drive = plan.device.drive
    assert (drive.mass, drive.stiffness, drive.damping) == (0.012, 90.0, 0.1)
    assert not plan.device.by_ratio
    assert (drive.plate.kinetic, drive.plate.static) == (0.044, 0.0265 / 0.022 * 0.044)
    assert plan.source.text.endswith("# set mass = 12 g\n# set drive.stiffness = 90 N/m\n")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("set = 3", "study.toml: set must be a table, [set], got 3"),
        (
            "[set]\nmas = 1",
            "study.toml: set: unknown key mas; did you mean drive.mass",
        ),
        ("[set]\nmass = 1", "study.toml: set: drive.mass must be a number with its unit"),
        ('[set]\nmass = "-1 g"', "study.toml: set: drive.mass must be finite and greater than 0"),
        ('[set]\nkinetic = "1 N"', "study.toml: set: kinetic may be plate.kinetic, finger."),
    ],
)
def test_a_bad_value_in_set_names_its_place(text: str, said: str) -> None:
    head, _, tail = STUDY.partition("[axes]")
    Path("study.toml").write_text(f"{head}{text}\n[axes]{tail}")
    for command in ("sweep", "sensitivity", "robustness"):
        assert refused(command, "study.toml").startswith(said)
    Path("study.toml").write_text(STUDY)
    said = refused("sweep", "study.toml", "--set", "mass=1 m")
    assert said.startswith("--set mass: drive.mass must be in kg or a unit alike")


# ---- words ---------------------------------------------------------------------------------------


def test_one_of_a_thing_is_singular() -> None:
    assert counted(1, "point") == "1 point"
    assert counted(0, "point") == "0 points"
    assert (
        counted(12345, "finished chunk is", "finished chunks are") == "12 345 finished chunks are"
    )
    Path("one.toml").write_text(STUDY.replace('["9 g", "10 g"]', '["9 g"]'))
    said = run("sweep", "one.toml").stdout
    assert re.match(r"Wrote one\.nc: 1 point, ", said)
    assert run("sweep", "one.toml", "--resume").stdout.startswith("one.nc is complete: 1 point, ")
    said = run("robustness", "study.toml", "--draws", "1").stdout
    assert "1 independent random draw, seed 1." in said
    assert "Yield: of 1 design\n" in "\n".join(line.rstrip() for line in said.splitlines())


def test_a_quantity_without_a_unit_is_a_plain_number() -> None:
    with pytest.raises(ValueError, match=r"^damping_ratio must be a plain number, got None$"):
        check("damping_ratio", None)  # type: ignore[arg-type]
    drive = Drive(mass=1.0, stiffness=1.0, damping=1.0, plate=Contact(0.0), finger=Contact(0.0))
    with pytest.raises(ValueError, match=r"^settling_band must be plain numbers, got \[None\]$"):
        simulate_batch(drive, Release(0.0), settling_band=[None])  # type: ignore[arg-type]


def test_a_part_is_all_or_none_only_if_it_is() -> None:
    assert Share(999_999, 1_000_000, 0.0, 1.0).text == "> 99.999 %"
    assert Share(1, 1_000_000, 0.0, 1.0).text == "< 0.001 %"
    assert Share(5, 5, 0.0, 1.0).text == "100.000 %"
    assert Share(0, 5, 0.0, 1.0).text == "0.000 %"
    assert Share(1, 3, 0.0, 1.0).text == "33.333 %"


# ---- Ctrl-C --------------------------------------------------------------------------------------

LONG = {
    "sweep": "sweep long.toml",
    "sensitivity": "sensitivity long.toml --tolerances --rows 131072 --plot a.png",
    "robustness": "robustness long.toml --draws 10000000 --plot a.png",
    "sensitivity of scans": "sensitivity scans.toml --tolerances --rows 131072 --threads 2",
    "robustness of scans": "robustness scans.toml --draws 900000 --threads 2 --plot a.png",
}


@pytest.mark.skipif(os.name == "nt", reason="signals are others there")
@pytest.mark.parametrize("command", LONG)
def test_ctrl_c_ends_at_once_and_leaves_nothing(command: str) -> None:
    axes = '[axes]\nmass = { uniform = ["5 g", "20 g"] }\n[sample]\ncount = 200000000\n'
    Path("long.toml").write_text(STUDY.replace('[axes]\nmass = ["9 g", "10 g"]\n', axes))
    Path("device.toml").write_text(
        GOOD.replace('"5 mN"', '"20 mN"') + '[scan]\nhand_speed = "100 mm/s"\n'
    )
    Path("scans.toml").write_text(
        'base = "device.toml"\n[page]\ngrating = ["8 mm", "4 mm"]\n'
        '[tolerances]\ncontrol.latency = "20 %"\nmass = "5 %"\n[specification]\nshown = ">= 1"\n'
    )
    before = {path.name for path in Path().iterdir()}
    process = subprocess.Popen(
        [sys.executable, "-m", "pindrive", *LONG[command].split()],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        if "sweep" in command or "--plot" in LONG[command]:
            while {path.name for path in Path().iterdir()} == before:
                assert process.poll() is None, process.communicate()
                time.sleep(0.05)
        time.sleep(2.0 if command == "sensitivity of scans" else 0.3)  # it writes no file at first
        assert process.poll() is None, "it takes longer than that"
        os.killpg(process.pid, signal.SIGINT)
        said, error = process.communicate(timeout=60)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    assert process.returncode == 130
    assert said == ""
    (line,) = error.splitlines()
    assert line.startswith("stopped; ")
    left = {path.name for path in Path().iterdir()} - before
    kept = {"long.nc.partial", "long.nc.journal"} if command == "sweep" else set()
    assert left in (set(), kept)
    if left:
        assert line == "stopped; finished chunks are kept, --resume continues with them"

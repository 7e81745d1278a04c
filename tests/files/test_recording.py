"""Inputs in CSV files: equal to rows in the device file, and rejected files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_equal

from command import EXAMPLE, GOOD, refused, run
from pindrive.device import strokes
from pindrive.files.device import load_device
from pindrive.files.keys import template
from pindrive.motion.simulate import motion_of
from pindrive.study import load_study

pytestmark = pytest.mark.usefixtures("in_empty_folder")
SPEED = 'mouse_velocity = "0.10 m/s"'


def device(old: str, new: str, name: str = "device.toml") -> Path:
    text = EXAMPLE.read_text(encoding="utf-8")
    key = old.partition(" ")[0]
    lines = [new if line.startswith(f"{key} ") else line for line in text.splitlines()]
    path = Path(name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + ("" if new in lines else f"\n{new}\n"), encoding="utf-8")
    return path


def csv(name: str, text: str) -> Path:
    path = Path(name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def test_a_csv_is_the_rows_that_it_holds() -> None:
    csv(
        "in/speed.csv",
        "# recorded\ntime [ms]; mouse_velocity [mm/s]; note\n0;60;a\n\n40;60;b\n90;0;c\n",
    )
    csv("in/load.csv", "time [s], plate_load [%]\n0, 500\n0.005, 100\n0.005, 50\n")
    path = device(SPEED, 'mouse_velocity = "speed.csv"\nplate_load = "load.csv"', "in/device.toml")
    found, rows = load_device(path).release, ((0.0, 0.06), (0.04, 0.06), (0.09, 0.0))
    assert found.mouse_velocity.rows == rows  # type: ignore[union-attr]
    loads = ((0.0, 5.0), (0.005, 1.0), (0.005, 0.5))
    assert found.plate_load.rows == loads  # type: ignore[union-attr]
    written = 'mouse_velocity = [["0 s", "60 mm/s"], ["40 ms", "60 mm/s"], ["90 ms", "0 m/s"]]'
    load = 'plate_load = [["0 s", 5], ["5 ms", 1], ["5 ms", 0.5]]'
    other = device(SPEED, f"{written}\n{load}", "rows.toml")
    assert_equal(motion_of(load_device(path)).numbers(), motion_of(load_device(other)).numbers())


def test_on_the_command_line_a_path_is_relative_to_the_current_folder() -> None:
    csv("speed.csv", "time [ms], mouse_velocity [mm/s]\n0,60\n40,60\n90,0\n")
    device(SPEED, SPEED, "in/device.toml")
    given = run("simulate", "in/device.toml", "--set", "mouse_velocity=speed.csv")
    rows = '[["0 ms", "60 mm/s"], ["40 ms", "60 mm/s"], ["90 ms", "0 mm/s"]]'
    other = run("simulate", "in/device.toml", "--set", f"mouse_velocity={rows}")
    assert given.exit_code == 0
    assert given.output == other.output
    mapping = load_device("in/device.toml", {"mouse_velocity": "speed.csv"})
    assert mapping.release.mouse_velocity.rows[2] == (0.09, 0.0)  # type: ignore[union-attr]


def test_in_a_study_a_path_is_relative_to_its_file() -> None:
    csv("studies/speed.csv", "time [ms], mouse_velocity [mm/s]\n0,60\n40,60\n90,0\n")
    device(SPEED, SPEED, "device.toml")
    text = 'base = "../device.toml"\n[set]\nmouse_velocity = "speed.csv"\n[axes]\nmass = ["8 g"]\n'
    csv("studies/study.toml", text)
    study = load_study("studies/study.toml")
    (time,) = study.run().transient_settling_time
    same = load_device("device.toml", {"mouse_velocity": "studies/speed.csv", "mass": 0.008})
    assert float(time) == motion_of(same).transient.settling_time
    assert Path("studies/speed.csv").resolve() in [path.resolve() for path in study.inputs]


def test_a_recorded_hand_gives_the_speed_along_the_drive_axis() -> None:
    true = strokes([(0.0, 0.0), (0.03, 0.04)], 0.1)
    t = np.linspace(0.0, true.end, 500)
    rows = "\n".join(
        f"{a:.9f},{b:.12f},{c:.12f}" for a, b, c in zip(t, *true.position(t), strict=True)
    )
    csv("hand.csv", f"time [s], x [m], y [m]\n{rows}\n")
    plain = load_device(device(SPEED, 'mouse_velocity = "hand.csv"')).release.mouse_velocity
    assert max(plain.values) == pytest.approx(0.06, rel=1e-3)  # type: ignore[union-attr]
    turned = load_device("device.toml", {"axis": np.arctan2(4.0, 3.0)}).release.mouse_velocity
    assert max(turned.values) == pytest.approx(0.1, rel=1e-3)  # type: ignore[union-attr]


def test_smoothing_of_a_raw_recording_is_reported() -> None:
    true = strokes([(0.0, 0.0), (0.03, 0.0)], 0.0625)
    t = np.arange(0.0, true.end, 1e-3)
    counts = np.floor(true.position(t)[0] / 25.4e-6).astype(int)
    rows = "\n".join(f"{a:.6f},{b},0" for a, b in zip(t, counts, strict=True))
    csv("raw.csv", f"time [s], x [count], y [count]\n{rows}\n")
    path = device(SPEED, 'mouse_velocity = "raw.csv"')
    smooth = load_device(path).release.mouse_velocity
    assert max(smooth.values) == pytest.approx(0.0625, rel=3e-3)  # type: ignore[union-attr]
    for command in ("simulate", "check"):
        said = run(command, str(path)).output
        assert "(1000 dpi); noise of the speed " in said
        assert "Smoothing: Butterworth of 2nd order forwards and backwards, -3 dB at 20 Hz" in said
    assert "more rows" in run("check", str(path)).output
    said = run("simulate", str(path), "--set", "smoothing_cutoff=12 Hz").output
    assert "-3 dB at 12 Hz" in said
    double = load_device(path, ["mouse_resolution=500 dpi"]).release.mouse_velocity
    peaks = [max(each.values) for each in (smooth, double)]  # type: ignore[union-attr]
    assert peaks[1] == pytest.approx(2.0 * peaks[0], rel=1e-9)


def test_check_reads_every_csv_that_a_file_names_and_changes_none() -> None:
    csv("load.csv", "time [ms], plate_load\n0,5\n5,-1\n")
    csv("speed.csv", "time [ms], mouse_velocity [mm/s]\n0,60\n40,slow\n")
    path = device(SPEED, 'mouse_velocity = "speed.csv"\nplate_load = "load.csv"')
    before = {file: file.read_bytes() for file in Path().iterdir()}
    said = run("check", str(path))
    assert said.exit_code == 2
    wrong = [
        'mouse_velocity: speed.csv: row 3: mouse_velocity must be a number, got "slow"',
        'plate_load: load.csv: row 3: plate_load must be finite and at least 0, got "-1"',
    ]
    assert said.stderr.splitlines() == [f"device.toml: motion.{words}" for words in wrong]
    assert {file: file.read_bytes() for file in Path().iterdir()} == before


def test_a_finger_that_lifts_is_a_csv_rows_or_set() -> None:
    csv("lift.csv", "time [ms], finger_load [%]\n0, 100\n20, 100\n40, 0\n")
    path = device(SPEED, f'{SPEED}\nfinger_load = "lift.csv"')
    rows = ((0.0, 1.0), (0.02, 1.0), (0.04, 0.0))
    assert load_device(path).release.finger_load.rows == rows  # type: ignore[union-attr]
    written = '[["0 ms", 1], ["20 ms", 1], ["40 ms", 0]]'
    for setting in (f"finger_load={written}", "finger_load=lift.csv"):
        found = load_device(device(SPEED, SPEED, "plain.toml"), [setting]).release.finger_load
        assert found.rows == rows  # type: ignore[union-attr]
    assert (
        load_device(device(SPEED, SPEED, "plain.toml"), ["finger_load=0.5"]).release.finger_load
        == 0.5
    )
    assert load_device(path, ["finger.stiffness=1000 N/m"]).release.finger_load.rows == rows  # type: ignore[union-attr]
    assert refused("simulate", path, "--set", 'finger_load=[["0 ms", 1], ["5 ms", -1]]') == (
        "--set finger_load: motion.finger_load[1] value must be finite and at least 0, got -1"
    )


def test_check_reports_the_rows_of_a_csv() -> None:
    csv("speed.csv", "time [ms], mouse_velocity [mm/s]\n0,60\n40,-10\n90,0\n")
    said = run("check", "speed.csv").stdout
    assert said == "mouse_velocity: 3 rows over 90 ms, from -10.00 mm/s to 60.00 mm/s.\n"
    csv("speed.csv", "time [ms], mouse_velocity [mm]\n0,60\n")
    assert "column mouse_velocity must be in m/s" in run("check", "speed.csv").stderr
    csv("load.csv", "time [ms], plate_load\n0,5\n")
    said = run("check", "load.csv").stdout
    assert said == "plate_load: 1 row over 0 ms, from 5.000 to 5.000.\n"


REFUSALS = {
    "time [s], speed [m/s]\n0,1\n": (
        'the header must be like "time [s], mouse_velocity [m/s]", or "time [s], x [m], y [m]" of '
        'a recorded hand, got "time [s], speed [m/s]"'
    ),
    "time [s], mouse_velocity\n0,1\n": (
        'column mouse_velocity must be given with its unit, like "mouse_velocity [m/s]", got '
        '"mouse_velocity"'
    ),
    "time [s], mouse_velocity [mm]\n0,1\n": (
        'column mouse_velocity must be in m/s or a unit alike, like "mouse_velocity [m/s]", got '
        '"mouse_velocity [mm]"'
    ),
    "time [s], mouse_velocity [m/s]\n\n0,1\n1,x\n": (
        'row 4: mouse_velocity must be a number, got "x"'
    ),
    "time [s], mouse_velocity [m/s]\n0,1\n#\n0.5,1\n0.5,2\n": (
        "row 5: time must be greater than the one before, 0.5 s (a jump would take an infinite "
        "force), got 0.5 s"
    ),
    "time [s], mouse_velocity [m/s]\n0,1\n1,1e13\n": (
        "row 3: mouse_velocity must be finite and at least -1e12 m/s and at most 1e12 m/s, got "
        '"1e13"'
    ),
    "time [s], mouse_velocity [m/s]\n": "a CSV of mouse_velocity must be at least 1 row, got 0",
    "": 'is empty; a CSV of mouse_velocity begins with "time [s], mouse_velocity [m/s]"',
    "time [s], x [mm], y [mm]\n0,0,0\n0.1,1,0\n0.2,400,0": "row 3 must be without a jump",
}


@pytest.mark.parametrize("text", REFUSALS)
def test_refusals(text: str) -> None:
    csv("speed.csv", text)
    path = device(SPEED, 'mouse_velocity = "speed.csv"')
    said = refused("simulate", str(path))
    assert said.startswith(f"device.toml: motion.mouse_velocity: speed.csv: {REFUSALS[text]}")


def test_missing_file_is_reported_beside_other_errors() -> None:
    path = device(SPEED, 'mouse_velocity = "none.csv"\nplate_load = "two"')
    result = run("simulate", str(path))
    assert result.exit_code == 2
    assert result.stderr.splitlines()[0].startswith(
        "device.toml: motion.mouse_velocity: none.csv: cannot be read: No such file"
    )
    assert "motion.plate_load must be" in result.stderr


def test_an_input_is_not_written_over() -> None:
    text = "time [ms], mouse_velocity [mm/s]\n0,60\n"
    csv("speed.csv", text)
    path = device(SPEED, 'mouse_velocity = "speed.csv"')
    said = refused("simulate", str(path), "-o", "speed.csv")
    assert said == "-o speed.csv: is read by this command; give another name"
    assert Path("speed.csv").read_text(encoding="utf-8") == text


def test_template_mentions_a_csv() -> None:
    assert GOOD
    words = " ".join(template().replace("#", " ").split())
    assert "one value, rows over time, or a CSV of them or of a recorded hand" in words
    assert 'mouse_resolution = "1000 dpi"' in template(whole=True)

"""The command line: what it prints and writes."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import pindrive
from command import EXAMPLE, EXAMPLES, SKIN, refused, run
from pindrive.files.device import load_device

pytestmark = pytest.mark.usefixtures("in_empty_folder")


def example() -> pindrive.Motion:
    """The motion of the example file, from Python."""
    device = load_device(EXAMPLE)
    return pindrive.simulate(device.drive, device.release)


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
    example = run("simulate", EXAMPLE).stdout.replace("tactile mouse:", "my pin drive:")
    assert simulated.stdout == example, "the example is what init writes"


def test_simulate_reports_derived_values() -> None:
    def said(*arguments: str | Path) -> list[str]:
        lines = run("simulate", *arguments).stdout.splitlines()
        return [line for line in lines if line.startswith("Follow from other values: ")]

    damping = "Follow from other values: drive.damping 0.3200 N*s/m"
    assert said(EXAMPLE) == [f"{damping}."]
    kept = said(EXAMPLE, "--set", "plate.kinetic=25 mN")
    assert kept == [f"{damping}, plate.static 30.11 mN."], "the ratio of the file holds on"
    assert said(EXAMPLE, "--set", "plate.kinetic=25 mN", "--set", "plate.static=30 mN") == [
        f"{damping}."
    ]
    (coefficients,) = said(EXAMPLES / "tactile-reader.toml")
    assert coefficients.endswith(
        "plate.kinetic 15.71 mN, plate.static 18.85 mN, finger.kinetic 30.00 mN, "
        "finger.static 45.00 mN."
    )
    Path("least.toml").write_text((Path(__file__).parents[1] / "minimal.toml").read_text())
    assert said("least.toml") == [
        "Follow from other values: drive.damping_ratio 0.2000, plate.static 20.00 mN, "
        "finger.static 5.000 mN."
    ]


def test_a_drive_without_a_device_is_a_body() -> None:
    for command in ("check", "simulate"):
        for file in (EXAMPLE, SKIN):
            said = run(command, file)
            assert "electromagnet" not in said.output + said.stderr
    assert "the body" in run("check", EXAMPLE).stdout
    assert "electromagnet" in run("check", EXAMPLES / "tactile-reader.toml").stdout


def test_simulate_warns_of_what_check_warns_of() -> None:
    given = (EXAMPLE, "--set", "plate.kinetic=60 mN")
    simulated, checked = run("simulate", *given), run("check", *given)
    assert simulated.stderr == checked.stderr
    assert simulated.stderr.startswith("warning: the plate's kinetic friction coefficient is 0.612")


def test_init_keeps_a_file_unless_forced() -> None:
    Path("new.toml").write_text("[drive]\nmass = 'mine'\n")
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
    assert len(output.splitlines()) < 70


def test_phases_are_printed_in_their_units() -> None:
    """The fourth phase of the example begins where the plate's velocity is crossed."""
    rows = [line.split() for line in run("simulate", EXAMPLE).stdout.splitlines()]
    assert ["ms", "ms", "ms", "mm", "mm/s"] in rows
    (row,) = (row for row in rows if row[:2] == ["42.31", "46.10"])
    assert row == ["42.31", "46.10", "3.790", "slip", "-0.5794", "60.00", "plate", "sticks"]


def test_the_last_lines_are_whole_however_narrow_the_screen() -> None:
    frictions = ("finger.kinetic=0 N", "finger.static=0 N", "damping_ratio=0")
    output = run("simulate", EXAMPLE, *(f"--set={value}" for value in frictions)).stdout
    assert "Steady stick-slip oscillation" in output
    assert "period 62.83 ms, peak velocity 60.17 mm/s.\n" in output


def test_a_motion_that_breaks_a_law_is_not_to_be_trusted() -> None:
    """After 1e11 rad the phase of an oscillation has five digits left."""
    assert "Do not trust" not in run("simulate", EXAMPLE).stdout
    free = ("damping=0 N s/m", "plate.kinetic=0 N", "plate.static=0 N", "finger.kinetic=0 N")
    values = (*free, "finger.static=0 N", "duration=1e9 s")
    result = run("simulate", EXAMPLE, *(f"--set={value}" for value in values))
    assert "Do not trust" in result.stdout
    assert result.stderr == (
        "warning: --set duration: motion.duration is 1e9 s; any such device has 1e-6 to 1e7 s; "
        "did you mean 1e9 ms, 1e6 s?\n"
    )


def test_numbers_of_an_absent_contact_are_left_out() -> None:
    output = run("simulate", EXAMPLE, "--set=finger.kinetic=0 N", "--set=finger.static=0 N").stdout
    assert "at the plate" in output
    assert "at the finger" not in output


def test_set_replaces_values() -> None:
    damped = run("simulate", EXAMPLE, "--set", "damping_ratio=2", "--set", "mass=12 g")
    assert damped.exit_code == 0
    assert damped.stdout != run("simulate", EXAMPLE).stdout


@pytest.mark.parametrize(
    ("override", "name", "value"),
    [
        ("drive.mass=12 g", "mass", 0.012),
        ("drive.stiffness=0.2 N/mm", "stiffness", 200.0),
        ("drive.damping=0.1 N*s/m", "damping", 0.1),
        ("drive.damping_ratio=50 %", "damping", 1.0),
        ("plate.kinetic=21 mN", "plate.kinetic", 0.021),
        ("plate.static=40 mN", "plate.static", 0.040),
        ("finger.kinetic=6 mN", "finger.kinetic", 0.006),
        ("finger.static=9 mN", "finger.static", 0.009),
        ("motion.mouse_velocity=-5 cm/s", "mouse_velocity", -0.05),
        ("motion.displacement=-1 mm", "displacement", -0.001),
        ("motion.velocity=0 m/s", "velocity", 0.0),
        ("motion.duration=0.5 s", "duration", 0.5),
    ],
)
def test_every_key_that_is_set_reaches_the_simulation(
    override: str, name: str, value: float
) -> None:
    assert run("simulate", EXAMPLE, "--set", override, "-o", "out.json").exit_code == 0
    inputs = json.loads(Path("out.json").read_text(encoding="utf-8"))["inputs"]
    assert inputs[name] == value


def test_json_holds_every_number() -> None:
    assert run("simulate", EXAMPLE, "-o", "out.json").exit_code == 0
    document = json.loads(Path("out.json").read_text(encoding="utf-8"))
    assert document["pindrive"] == pindrive.__version__
    assert document["config"]["drive.mass"] == 0.010
    assert document["config"]["motion.duration"] is None
    assert document["ending"]["kind"] == "resting"
    assert document["numbers"]["transient.peak_time"] == pytest.approx(3.022e-3, abs=1e-6)
    assert document["units"]["transient.peak_time"] == "s"
    assert document["events"][0]["kind"] == "reverse"
    assert document["segments"][-1]["mode"] == "resting"
    assert document["segments"][-1]["end"] == "Infinity"
    assert document["certificate"]["worst"] < 1e-12


def test_csv_holds_even_samples_and_events_beside_it() -> None:
    said = run("simulate", EXAMPLE, "-o", "out.csv", "--samples", "51")
    assert said.exit_code == 0
    assert said.stdout.endswith("Wrote out.csv\nWrote out-events.csv\n")
    with Path("out.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = [float(row["time [s]"]) for row in rows]
    assert list(rows[0]) == [
        "time [s]",
        "position [m]",
        "velocity [m/s]",
        "acceleration [m/s^2]",
        "plate_force [N]",
        "finger_force [N]",
        "housing_force [N]",
    ]
    motion = example()
    assert times == np.linspace(0.0, motion.duration, 51).tolist()
    with Path("out-events.csv").open(newline="", encoding="utf-8") as file:
        events = list(csv.DictReader(file))
    assert [[*event.values()] for event in events] == [
        [str(e.time), e.contact, e.kind, str(e.position), str(e.velocity)] for e in motion.events
    ]
    assert list(events[0]) == ["time [s]", "contact", "kind", "position [m]", "velocity [m/s]"]
    for row in rows:
        t = float(row["time [s]"])
        assert [float(value) for value in list(row.values())[1:]] == [
            motion.position(t),
            motion.velocity(t),
            motion.acceleration(t),
            motion.force("plate", t),
            motion.force("finger", t),
            motion.housing_force(t),
        ]


def test_number_of_samples_is_as_requested() -> None:
    for suffix in (".csv", ".nc"):
        few, many = Path(f"few{suffix}"), Path(f"many{suffix}")
        run("simulate", EXAMPLE, "-o", few, "--samples", "2")
        run("simulate", EXAMPLE, "-o", many, "--samples", "2000")
        assert few.stat().st_size < many.stat().st_size


def test_netcdf_has_units() -> None:
    assert run("simulate", EXAMPLE, "-o", "out.nc").exit_code == 0
    with xr.open_dataset("out.nc", engine="h5netcdf", decode_timedelta=False) as dataset:
        units = {name: variable.attrs["units"] for name, variable in dataset.items()
                 if "time" in variable.dims}  # fmt: skip
        assert units == {
            "position": "m",
            "velocity": "m/s",
            "acceleration": "m/s^2",
            "plate_force": "N",
            "finger_force": "N",
            "housing_force": "N",
        }
        motion, t = example(), dataset["time"].values
        assert np.array_equal(dataset["position"], motion.position(t))
        assert np.array_equal(dataset["velocity"], motion.velocity(t))
        assert np.array_equal(dataset["acceleration"], motion.acceleration(t))
        assert np.array_equal(dataset["plate_force"], motion.force("plate", t))
        assert np.array_equal(dataset["finger_force"], motion.force("finger", t))
        assert dataset["event_kind"].values.tolist() == [e.kind for e in motion.events]
        assert dataset["event_time"].values.tolist() == [e.time for e in motion.events]
        assert dataset["transient_settling_time"].attrs["units"] == "s"
        assert float(dataset["transient_settling_time"]) == motion.transient.settling_time


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.SVG", b"<?xml"), ("a.pdf", b"%PDF")]
)
def test_plot(name: str, start: bytes) -> None:
    result = run("simulate", EXAMPLE, "--plot", name)
    assert result.exit_code == 0, result.output
    assert Path(name).read_bytes().startswith(start)
    assert result.stdout.endswith(f"Wrote {name}\n")


def test_several_files_at_once_and_nothing_else() -> None:
    assert run("simulate", EXAMPLE, "-o", "a.csv", "-o", "a.json").exit_code == 0
    assert sorted(path.name for path in Path().iterdir()) == [
        "a-events.csv", "a.csv", "a.json",
    ]  # fmt: skip


# ---- friction curves, skin, inputs that change ---------------------------------------------------


def skin() -> pindrive.Motion:
    """The motion of the second example, from Python."""
    drive = pindrive.Drive(
        mass=0.010,
        stiffness=100.0,
        damping_ratio=0.16,
        plate=pindrive.Contact(static=0.0265, curve=[(0, 0.022), (0.05, 0.015), (0.1, 0.015)]),
        finger=pindrive.Contact(0.020, 0.030, stiffness=1000.0),
    )
    hand = pindrive.Profile([0.0, 0.1], [0.06, 0.0])
    return pindrive.simulate(drive, pindrive.Release(hand, 2e-3))


def test_check_shows_a_line_for_each_row() -> None:
    lines = [line.split() for line in run("check", SKIN).stdout.splitlines()]
    first = next(i for i, line in enumerate(lines) if line[:1] == ["plate.curve"])
    assert lines[first][:4] == ["plate.curve", "F_p(|u|)", "22.00", "mN"]
    assert ["15.00", "mN", "at", "50", "mm/s"] in lines
    assert ["0", "mm/s", "at", "100", "ms"] in lines
    assert [line for line in lines if line[:1] == ["finger.curve"]] == []


def test_skin_has_columns_and_rows_of_its_own() -> None:
    output = run("simulate", SKIN, "-o", "out.csv", "-o", "out.nc", "--samples", "50")
    assert "largest stretch of a compliant finger's skin" in output.stdout
    assert "stretch" not in run("simulate", EXAMPLE).stdout
    motion = skin()
    with Path("out.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[-3:] == ["stretch [m]", "stretch_rate [m/s]", "plate_velocity [m/s]"]
    for row in rows:
        t = float(row["time [s]"])
        assert float(row["stretch [m]"]) == motion.stretch(t)
        assert float(row["stretch_rate [m/s]"]) == motion.stretch_rate(t)
        assert float(row["plate_velocity [m/s]"]) == motion.plate_velocity(t)
    with xr.open_dataset("out.nc", engine="h5netcdf", decode_timedelta=False) as dataset:
        assert dataset["stretch"].attrs["units"] == "m"
        assert np.array_equal(dataset["plate_velocity"], motion.plate_velocity(dataset["time"]))
        assert dataset.attrs["plate.curve.speed"].tolist() == [0.0, 0.05, 0.1]
        assert dataset.attrs["plate.curve.force"].tolist() == [0.022, 0.015, 0.015]
        assert dataset.attrs["mouse_velocity.time"].tolist() == [0.0, 0.1]
        assert dataset.attrs["mouse_velocity.value"].tolist() == [0.06, 0.0]


def test_json_holds_rows() -> None:
    changes = ("plate_load=50 %", "skin_stretch=-20 µm")
    assert run("simulate", SKIN, *(f"--set={c}" for c in changes), "-o", "a.json").exit_code == 0
    document = json.loads(Path("a.json").read_text(encoding="utf-8"))
    inputs, units = document["inputs"], document["units"]
    assert inputs["plate.curve"] == [[0.0, 0.022], [0.05, 0.015], [0.1, 0.015]]
    assert inputs["mouse_velocity"] == [[0.0, 0.06], [0.1, 0.0]]
    assert (inputs["plate_load"], inputs["finger.stiffness"]) == (0.5, 1000.0)
    assert inputs["skin_stretch"] == -2e-5
    assert (units["plate.curve"], units["mouse_velocity"]) == (["m/s", "N"], ["s", "m/s"])
    assert document["config"]["plate.curve"] == inputs["plate.curve"]


def test_rows_are_set_as_toml() -> None:
    """A magnet that lets go while the hand stops; and the example said so gives its own motion."""
    changes = (
        'mouse_velocity=[["0 ms", "60 mm/s"], ["40 ms", "0 mm/s"]]',
        'plate_load=[["0 ms", 1], ["5 ms", 0.2]]',
    )
    assert run("simulate", EXAMPLE, *(f"--set={c}" for c in changes), "-oa.json").exit_code == 0
    document = json.loads(Path("a.json").read_text(encoding="utf-8"))
    assert document["inputs"]["plate_load"] == [[0.0, 1.0], [0.005, 0.2]]
    assert document["certificate"]["worst"] < 1e-12
    constant = run("simulate", EXAMPLE, '--set=mouse_velocity=[["0 s", "60 mm/s"]]')
    assert constant.stdout == run("simulate", EXAMPLE).stdout


@pytest.mark.parametrize(
    ("override", "problem"),
    [
        ("skin_stretch=31 µm", "motion.skin_stretch must be at most static friction over"),
        ('mouse_velocity=[["0 s", "1 V"]]', "motion.mouse_velocity[0] value must be in m/s"),
    ],
)
def test_a_given_value_that_does_not_fit_is_refused(override: str, problem: str) -> None:
    key = override.partition("=")[0]
    assert refused("simulate", SKIN, "--set", override).startswith(f"--set {key}: {problem}")


def test_a_curved_plate_under_a_load_that_changes() -> None:
    """It has no closed form, and is followed as exactly."""
    load = '--set=plate_load=[["0 ms", 1], ["40 ms", 2]]'
    result = run("simulate", SKIN, load, "-oloaded.json")
    assert result.exit_code == 0
    document = json.loads(Path("loaded.json").read_text(encoding="utf-8"))
    assert document["certificate"]["worst"] < 1e-12


# ---- a quick start -------------------------------------------------------------------------------


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys; sys.argv = ['pindrive', '--help']\n"
        "from pindrive.cli.app import main\n"
        "try: main()\n"
        "except SystemExit as end: assert not end.code\n"
        "heavy = {'numpy', 'pydantic', 'pint', 'rich', 'xarray', 'matplotlib'}\n"
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

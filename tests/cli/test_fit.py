"""The command `pindrive fit`: its table, the device file that it writes, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import GOOD, refused, run
from pindrive import Contact, Drive, Release, load_device
from pindrive.fitting import Noise, load_fit
from recordings import recorded

pytestmark = pytest.mark.usefixtures("in_empty_folder")

TRUTH = Drive(
    mass=0.010, stiffness=140.0, damping=0.31, plate=Contact(0.019), finger=Contact(0.006)
)
HEAD = "time [ms], position [mm]\n"


def write(name: str = "pin.csv", head: str = HEAD, span: float = 0.15) -> None:
    given = recorded(TRUTH, Release(0.1, 2e-3), rate=2e3, span=span)
    rows = zip(1e3 * given.time, 1e3 * given.channels["position"], strict=True)
    Path(name).write_text(head + "".join(f"{t:.6g},{x:.6g}\n" for t, x in rows))


@pytest.fixture(autouse=True)
def inputs(in_empty_folder: None) -> None:
    Path("device.toml").write_text(GOOD)
    write()


def test_a_fit_prints_its_table_and_writes_a_device_file_with_its_source() -> None:
    free = "stiffness=50 N/m..300 N/m, damping, plate.kinetic"
    done = run(
        *("fit", "device.toml", "pin.csv", "--free", free, "-o", "fitted.toml"),
        *("--set", "displacement=2 mm", "--set", "mass=10 g", "--set", "finger.kinetic=6 mN"),
        *("--mouse-velocity", "100 mm/s", "--plot", "fit.png"),
    )
    assert done.exit_code == 0, done.output
    assert "Fit to pin.csv" in done.stdout and "95 % from" in done.stdout
    assert done.stdout.endswith("Wrote fitted.toml\nWrote fit.png\n")
    assert Path("fit.png").read_bytes()[:4] == b"\x89PNG"
    text = Path("fitted.toml").read_text(encoding="utf-8")
    assert text.startswith("# device.toml, fitted by pindrive to pin.csv.\n# Intervals hold 95 %")
    assert "# stiffness fitted: " in text and " interval " in text
    device = load_device("fitted.toml")
    assert device.drive.stiffness == pytest.approx(140.0, rel=0.01)
    assert device.drive.plate.kinetic == pytest.approx(0.019, rel=0.1)
    assert device.release.mouse_velocity == 0.1
    assert device.drive.mass == 0.010
    shown = next(line for line in done.stdout.splitlines() if " stiffness " in line)
    assert f"{device.drive.stiffness:.5g}"[:5] in shown


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--free", "stifness"], "free: unknown parameter stifness; did you mean stiffness or fin"),
        (["--free", "stiffness,"], "--free: must be keys apart by commas"),
        (["--free", "stiffness=5 N/m"], "--free stiffness: must be two values, like"),
        (["--free", "stiffness", "--window", "5 ms"], "--window: must be two values, like"),
        (["--free", "stiffness", "--window", "5 ms..6 ms"], "pin.csv: window must be so wide that"),
        (["--free", "stiffness", "--noise", "5 um"], '--noise must be like "position=5 um"'),
        (["--free", "stiffness", "--noise", "force=5 N"], "pin.csv: noise must be of position"),
        (["--free", "force_offset"], "free must be an offset of a recorded channel"),
        (["--free", "mass", "--plot", "a.doc"], "--plot a.doc: must end in .png"),
        (["--free", "mass", "-o", "pin.csv"], "-o pin.csv: must end in .toml"),
    ],
)
def test_bad_options_are_one_line(arguments: list[str], said: str) -> None:
    assert said in refused("fit", "device.toml", "pin.csv", *arguments)


@pytest.mark.parametrize(
    ("head", "span", "said"),
    [
        ("time, position [mm]\n", 0.15, 'column time must be given with its unit, like "time [s]"'),
        (HEAD, 0.004, "a recording must be at least"),
    ],
)
def test_bad_recordings_are_one_line(head: str, span: float, said: str) -> None:
    write("bad.csv", head, span)
    assert said in refused("fit", "device.toml", "bad.csv", "--free", "stiffness")


def test_a_fit_of_a_drive_with_coefficients_has_forces() -> None:
    text = GOOD.replace('kinetic = "5 mN"', 'coefficient = 0.5\ntouch_force = "12 mN"')
    text = text.replace('kinetic = "20 mN"', "coefficient = 0.2\nstatic_coefficient = 0.2")
    Path("device.toml").write_text(text + '\n[array]\npitch = "9 mm"\n')
    done = run(
        *("fit", "device.toml", "pin.csv", "--free", "stiffness=50 N/m..300 N/m, plate.kinetic"),
        *("-o", "fitted.toml", "--set", "displacement=2 mm", "--set", "plate.preload=1 mN"),
        *("--mouse-velocity", "100 mm/s", "--set", "damping=0.31 N*s/m"),
    )
    assert done.exit_code == 0, done.output
    drive = load_device("fitted.toml").drive
    assert drive.plate.kinetic == pytest.approx(0.019, rel=0.03)  # the recording has noise
    assert drive.plate.static_friction == drive.plate.kinetic
    assert drive.finger == Contact(0.5 * 0.012)
    assert (drive.preload, drive.plate.coefficient) == (0.001, None)


def test_a_fit_file_names_device_recordings_and_noise() -> None:
    write("other.csv")
    Path("fit.toml").write_text(
        """
base = "device.toml"
free = ["stiffness", "damping", "finger.kinetic@each"]
seed = 3
confidence = 0.9

[bounds]
stiffness = ["50 N/m", "300 N/m"]

[[recording]]
file = "pin.csv"
mouse_velocity = "100 mm/s"
window = ["1 ms", "120 ms"]
noise = "drift"

[[recording]]
file = "other.csv"
mouse_velocity = "100 mm/s"
noise.position = "20 um"
"""
    )
    changes = ("--set", "displacement=2 mm", "--set", "mass=10 g", "--set", "plate.kinetic=19 mN")
    problem = load_fit("fit.toml", [change for change in changes if change != "--set"])
    assert problem.free == ("stiffness", "damping", "finger.kinetic@each")
    assert (problem.seed, problem.confidence) == (3, 0.9)
    assert problem.recordings[0].noise == {"position": Noise(drift="linear")}
    assert problem.recordings[0].time[0] == pytest.approx(1e-3)
    assert problem.recordings[1].noise == {"position": Noise(2e-5)}
    done = run("fit", "fit.toml", *changes, "-o", "fitted.toml")
    assert done.exit_code == 0, done.output
    assert "90 % from" in done.stdout
    assert "finger.kinetic@1" in done.stdout
    assert "Noise of the position of pin.csv, given: offset" in done.stdout
    assert load_device("fitted.toml").drive.stiffness == pytest.approx(140.0, rel=0.02)
    assert "fit.toml: is a fit file, as it has recordings; `pindrive fit` takes it" in refused(
        "simulate", "fit.toml"
    )
    assert "--noise must be left out with a fit file" in refused(
        "fit", "fit.toml", "--noise", "position=white"
    )


def test_everything_wrong_with_a_fit_file_is_said_at_once() -> None:
    Path("fit.toml").write_text(
        """
base = "device.toml"
free = "stiffness"
smooth = 3

[bounds]
stiffness = "wide"

[[recording]]
file = "none.csv"

[[recording]]
noise = "slow"
"""
    )
    with pytest.raises(ValueError) as error:
        load_fit("fit.toml")
    text = str(error.value)
    for part in (
        "fit.toml: free must be a list of keys",
        "smooth",
        "fit.toml: bounds of stiffness must be two values",
        "none.csv",
        "fit.toml: file of a recording must be the path of a CSV in quotes",
    ):
        assert part in text
    assert "device.toml: names no recordings; give their files after it" in refused(
        "fit", "device.toml", "--free", "stiffness"
    )

"""Even samples and their events as CSV, of a motion and of a scan, from Python and by commands."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import pindrive as pd
from command import EXAMPLE, refused, run
from pindrive.files.output import OutputError
from pindrive.quantities.results import MOTION, SERIES

pytestmark = pytest.mark.usefixtures("in_empty_folder")

DRIVE = pd.Drive(
    mass=0.01, stiffness=100.0, damping=0.4, plate=pd.Contact(0.02), finger=pd.Contact(0.005)
)
READER = EXAMPLE.parent / "tactile-reader.toml"


def table(path: str | Path) -> list[dict[str, str]]:
    with Path(path).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("rate", [1000.0, "1 kHz", 333.0, 12345.678])
def test_a_motion_at_a_rate(rate: float | str) -> None:
    motion = pd.simulate(DRIVE, pd.Release(0.1, 1.5e-3))
    events = motion.to_csv("m.csv", rate=rate)
    assert events == Path("m-events.csv")
    assert sorted(path.name for path in Path().iterdir()) == ["m-events.csv", "m.csv"]
    rows = table("m.csv")
    hertz = 1000.0 if isinstance(rate, str) else rate
    t = np.array([float(row["time [s]"]) for row in rows])
    assert np.array_equal(t, np.arange(len(t)) / hertz)
    assert t[-1] <= motion.duration < t[-1] + 1.0 / hertz
    for name in ("position", "velocity", "acceleration"):
        (column,) = (key for key in rows[0] if key.startswith(f"{name} ["))
        assert [float(row[column]) for row in rows] == getattr(motion, name)(t).tolist()
    assert [float(r["plate_force [N]"]) for r in rows] == motion.force("plate", t).tolist()
    assert [float(r["finger_force [N]"]) for r in rows] == motion.force("finger", t).tolist()
    reported = [(float(r["time [s]"]), r["contact"], r["kind"]) for r in table(events)]
    assert reported == [(e.time, e.contact, e.kind) for e in motion.events]


def test_the_last_sample_of_a_whole_count_is_there() -> None:
    motion = pd.simulate(DRIVE, pd.Release(0.1, 1.5e-3), duration=0.3)
    motion.to_csv("m.csv", rate=10.0)
    assert [row["time [s]"] for row in table("m.csv")] == ["0.0", "0.1", "0.2", "0.3"]


def test_a_scan_at_a_rate() -> None:
    device = pd.load_device(READER, ["array.columns=2", "array.rows=1"])
    scan = pd.scan(device, pd.Page(grating=[0.004]))
    assert scan.to_csv("s.csv", rate="500 Hz") == Path("s-events.csv")
    rows = table("s.csv")
    for pin in scan.pins:
        own = [row for row in rows if row["pin"] == str(pin.number)]
        t = np.array([float(row["time [s]"]) for row in own])
        assert np.array_equal(t, scan.path.begin + np.arange(len(t)) / 500.0)
        assert t[-1] <= scan.path.end < t[-1] + 0.002 + 1e-12
        since = pin.since(t)
        motion = pin.motion
        assert [float(r["position [m]"]) for r in own] == motion.position(since).tolist()
        assert [float(r["velocity [m/s]"]) for r in own] == motion.velocity(since).tolist()
        found = [float(r["acceleration [m/s^2]"]) for r in own]
        assert found == motion.acceleration(since).tolist()
        for contact in ("plate", "finger"):
            forces = [float(r[f"{contact}_force [N]"]) for r in own]
            assert forces == motion.force(contact, since).tolist()
        hand = [float(r["hand_force [N]"]) for r in own]
        assert hand == scan.force_on_hand(t).tolist()
        events = [
            float(r["time [s]"]) for r in table("s-events.csv") if r["pin"] == str(pin.number)
        ]
        assert events == [e.time for e in pin.events]


def test_too_many_samples_are_refused_before_a_file_is_begun() -> None:
    hour = pd.simulate(DRIVE, pd.Release(0.1, 1.5e-3), duration=3600.0)
    with pytest.raises(ValueError) as reported:
        hour.to_csv("m.csv", rate="1000 kHz")
    assert str(reported.value) == (
        "the samples of the motion must be at most 10000000, got 3600000001 (3600 s at 1e+06 Hz)"
    )
    assert list(Path().iterdir()) == []
    line = refused(
        "simulate", EXAMPLE, "--set", "duration=60 min", "-o", "a.csv", "--rate", "1000 kHz"
    )
    assert "the samples of the motion must be at most 10000000, got 3600000001" in line
    assert list(Path().iterdir()) == []


def test_a_file_of_another_kind_stays() -> None:
    motion = pd.simulate(DRIVE, pd.Release(0.1, 1.5e-3))
    Path("m-events.csv").write_text("mine")
    with pytest.raises(OutputError, match=r"m-events\.csv"):
        motion.to_csv("m.csv")
    assert not Path("m.csv").exists()
    assert Path("m-events.csv").read_text() == "mine"
    with pytest.raises(ValueError, match=r"^rate must be finite and at least 1e-6 Hz"):
        motion.to_csv("n.csv", rate=0.0)


def test_commands_take_a_rate() -> None:
    said = run("simulate", EXAMPLE, "-o", "a.csv", "--rate", "2 kHz")
    assert said.stdout.endswith("Wrote a.csv\nWrote a-events.csv\n")
    device = pd.load_device(EXAMPLE)
    pd.simulate(device.drive, device.release).to_csv("b.csv", rate=2000.0)
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()
    assert Path("a-events.csv").read_bytes() == Path("b-events.csv").read_bytes()
    small = ("--set", "array.columns=1", "--set", "array.rows=1")
    said = run("scan", READER, *small, "--grating", "4 mm", "-o", "s.csv", "--rate", "200 Hz")
    assert said.stdout.endswith("Wrote s.csv\nWrote s-events.csv\n")
    scan = pd.scan(
        pd.load_device(READER, ["array.columns=1", "array.rows=1"]), pd.Page(grating=[0.004])
    )
    scan.to_csv("c.csv", rate=200.0)
    assert Path("s.csv").read_bytes() == Path("c.csv").read_bytes()
    assert refused("simulate", EXAMPLE, "--rate", "1 kHz") == "--rate goes with -o FILE.csv"
    assert refused("simulate", EXAMPLE, "-o", "x.csv", "--rate", "1 mm").startswith(
        '--rate: rate must be in Hz or a unit alike, like "1 kHz", got "1 mm"'
    )


def test_columns_are_those_of_the_table_on_every_face() -> None:
    finger = pd.Contact(0.005, stiffness=1000.0)
    stops = {"travel": 1e-3, "stop_stiffness": 1e3}
    drive = pd.Drive(
        mass=0.01, stiffness=100.0, damping=0.4, plate=pd.Contact(0.02), finger=finger, **stops
    )
    brake = pd.Profile([0.0, 0.1], [0.06, 0.0])
    motion = pd.simulate(drive, pd.Release(brake, 1.5e-3))
    data = motion.to_dataset()
    pushes = np.maximum(np.abs(data.position) - 1e-3, 0.0) * 1e3
    assert np.abs(np.abs(data.stop_force) - pushes).max() <= 1e-15 < float(pushes.max())
    over_time = {str(name) for name, column in data.variables.items() if column.dims == ("time",)}
    assert over_time == {quantity.name for quantity in MOTION}
    for name in over_time:
        assert data[name].attrs == SERIES[name].attributes
    motion.to_csv("m.csv")
    assert [*table("m.csv")[0]] == [quantity.heading for quantity in MOTION]


def test_columns_of_a_scan_are_those_of_the_table() -> None:
    """In its dataset and in its CSV, which has fewer, they have one name and one value."""
    device = pd.load_device(READER, ["array.columns=1", "array.rows=1"])
    scan = pd.scan(device, pd.Page(grating=[0.004]), touch=0.060)
    scan.to_csv("s.csv", rate=100.0)
    rows = table("s.csv")
    data = scan.to_dataset([float(row["time [s]"]) for row in rows])
    over_time = {str(name) for name, column in data.variables.items() if "time" in column.dims}
    others = {"warming", "stop_force", "hand_deviation"}  # of a coil, stops, a hand that gives way
    assert over_time == {*SERIES} - others
    for name in over_time - {"time"}:
        assert data[name].attrs == SERIES[name].attributes
    for quantity in MOTION:
        if quantity.name in data:
            column = np.array([float(row[quantity.heading]) for row in rows])
            assert np.array_equal(column, data[quantity.name].values.ravel()), quantity.name

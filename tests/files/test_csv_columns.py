"""The columns of CSV files: what is written is read again, by name and unit, to the bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pindrive as pd
from command import EXAMPLE, SKIN, run
from pindrive.fitting.recording import read_recording
from pindrive.motion.results import Event
from pindrive.motion.simulate import motion_of
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.results import EDGES, LINE, SERIES
from pindrive.quantities.units import to_si

pytestmark = pytest.mark.usefixtures("in_empty_folder")

READER = EXAMPLE.parent / "tactile-reader.toml"
DEVICE = ("array.columns=2", "array.rows=1")


def read(file: str | Path) -> CsvTable:
    return CsvTable.read(file, "a table", "time [s]")


def check_motion(motion: pd.Motion, file: str | Path) -> None:
    table = read(file)
    time = np.array(table.column("time", SERIES["time"]))
    columns = {"time": time, **motion.columns(time)}
    assert set(columns) <= set(table.names) <= set(SERIES)
    for name, values in columns.items():
        assert table.column(name, SERIES[name]) == values.tolist(), name


def check_events(events: tuple[Event, ...], table: CsvTable) -> None:
    for name in ("time", "position", "velocity"):
        assert table.column(name, SERIES[name]) == [getattr(event, name) for event in events]
    for name in ("contact", "kind"):
        assert table.text(name) == [getattr(event, name) for event in events]


@pytest.mark.parametrize("device", [EXAMPLE, SKIN])
@pytest.mark.parametrize("written_by", ["python", "command"])
def test_motions_and_their_events(device: Path, written_by: str) -> None:
    motion = motion_of(pd.load_device(device))
    if written_by == "python":
        motion.to_csv("m.csv", rate="2 kHz")
    else:
        assert run("simulate", device, "-o", "m.csv").exit_code == 0
    check_motion(motion, "m.csv")
    check_events(motion.events, read("m-events.csv"))
    recording = read_recording("m.csv")
    for name, values in recording.channels.items():
        assert values.tolist() == getattr(motion, name)(recording.time).tolist()
    assert [*recording.channels] == ["position", "velocity", "acceleration"]


@pytest.mark.parametrize("written_by", ["python", "command"])
def test_scans_their_events_and_their_lines(written_by: str) -> None:
    page = pd.Page(grating=[0.004])
    scan = pd.scan(pd.load_device(READER, [*DEVICE]), page)
    if written_by == "python":
        scan.to_csv("s.csv", rate="1 kHz")
    else:
        changes = [f"--set={change}" for change in DEVICE]
        files = ("-o", "s.csv", "--lines", "lines.csv")
        assert run("scan", READER, "--grating", "4 mm", *changes, *files).exit_code == 0
        evaluation, table = scan.evaluate(), read("lines.csv")
        columns = evaluation.columns()
        assert table.names == tuple(columns)
        assert columns.keys() <= {str(name) for name in evaluation.to_dataset().variables}
        stated = {quantity.variable: quantity for quantity in (*EDGES, *LINE)}
        for name, values in columns.items():
            if name in stated:
                assert to_si(f"1 {table.unit(name) or ''}", stated[name].unit, "1") == 1.0
                found = [float(cell or "nan") for cell in table.text(name)]
                assert np.array_equal(found, values, equal_nan=True), name
            else:
                assert table.text(name) == [str(value) for value in values]
    samples, events = read("s.csv"), read("s-events.csv")
    pin = np.array(samples.text("pin"), int)
    time = np.array(samples.column("time", SERIES["time"]))
    for own in scan.pins:
        columns = own.motion.columns(own.since(time[pin == own.number]))
        assert len(columns) >= 5
        for name, values in columns.items():
            found = np.array(samples.column(name, SERIES[name]))[pin == own.number]
            assert np.array_equal(found, values), name
    check_events(tuple(event for own in scan.pins for event in own.events), events)


def test_a_recording_of_a_bench_is_not_replaced_by_a_motion() -> None:
    rows = "".join(f"{0.001 * i},{0.001 * i**2}\n" for i in range(20))
    Path("bench.csv").write_text(f"time [s],position [m]\n{rows}")
    said = run("simulate", EXAMPLE, "-o", "bench.csv")
    assert said.exit_code == 2
    assert "bench.csv: exists and is no CSV file of a motion" in said.stderr

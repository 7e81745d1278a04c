"""The core as WebAssembly, and the page's readers of files, beside Python's."""

from __future__ import annotations

import base64
from pathlib import Path

import numpy as np
import pytest

from command import EXAMPLE, SKIN
from pindrive import load_device, simulate
from pindrive.fitting.recording import read_recording
from pindrive.motion.simulate import motion_of
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.results import SERIES
from pindrive.quantities.units import UnitError, to_si
from studio_cases import Ask, compare, doubles, questions


def test_a_thousand_random_drives_have_the_bits_of_python(node: Ask) -> None:
    cases, requested = questions(1000, 16)
    differ = []
    for found, (drive, release, duration) in zip(node(requested), cases, strict=True):
        try:
            compare(found, simulate(drive, release, duration=duration))
        except AssertionError as error:
            differ.append((drive, release, str(error)))
    print(f"{len(cases) - len(differ)} of {len(cases)} drives have the bits of Python")
    assert not differ, differ[0]


def test_text_with_units_is_the_number_that_python_reads(node: Ask) -> None:
    texts = [
        *(("22 mN", "N"), ("1.5e-3 m", "m"), ("20 %", "1"), ("60 mm/s", "m/s"), ("3.7 in", "m")),
        *(("0.1 lbf", "N"), ("0.3 N s / m", "N*s/m"), ("7 kg/s", "N*s/m"), ("9 µm", "m")),
        *(("400 dpi", "1/m"), ("30 deg", "rad"), ("0.1 min", "s"), ("1 kHz", "Hz"), ("3 gf", "N")),
        *(("5 meters", "m"), ("2 milliseconds", "s"), ("4 mm**2", "m^2"), ("8 cm²", "m^2")),
        *(("1 N·s/m", "N*s/m"), ("5 (kg*m)/s^2", "N"), ("−3 mm", "m"), ("1 mm s", "m")),
        *(("1 furlong", "m"), ("1 m/", "m"), ("", "m"), ("1..2 m", "m"), ("1e3 g", "kg")),
        *((f"{x!r} {unit}", si) for x in np.random.default_rng(5).uniform(0, 1, 60).tolist()
          for unit, si in (("mN", "N"), ("g", "kg"), ("lb", "kg"), ("dpi", "1/m"))),
    ]  # fmt: skip
    found = node([{"si": text, "unit": unit} for text, unit in texts])
    for (text, unit), one in zip(texts, found, strict=True):
        try:
            expected = to_si(text, unit, "1 g")
        except UnitError as error:
            assert one.get("problem") == str(error), text
        else:
            assert doubles(one["value"])[0] == expected, text


# ---- recordings ----------------------------------------------------------------------------------

HEAD = "time [ms], position [mm], velocity [mm/s]\n"
ROWS = "".join(f"{i}, {np.sin(i / 5):.6f}, {10 * np.cos(i / 5):.6f}\n" for i in range(20))
RECORDINGS = [
    HEAD + ROWS,
    "# a bench\n\n" + (HEAD + ROWS).replace(", ", ";"),
    "",
    "t, position [mm]\n" + ROWS,
    "time [s], place [mm]\n" + ROWS,
    "time [s], position [kg]\n" + ROWS,
    "time [s], position [mm], position [m]\n" + ROWS,
    HEAD + "1, 2, 3\n",
    HEAD + ROWS.replace("\n5, ", "\n3, "),
    HEAD + ROWS.replace("\n5, ", "\nfive, "),
    HEAD + "".join(f"{i}, 0, 0\n" for i in range(9)),
]


def test_recordings_are_read_as_python_reads_them(node: Ask, tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    answers = node([{"recording": text, "file": str(path)} for text in RECORDINGS])
    for text, found in zip(RECORDINGS, answers, strict=True):
        path.write_text(text, "utf-8")
        try:
            expected = read_recording(path)
        except ValueError as error:
            assert found.get("problem") == str(error)
        else:
            np.testing.assert_array_equal(doubles(found["times"]), expected.time)
            for name, channel in expected.channels.items():
                np.testing.assert_array_equal(doubles(found["channels"][name]), channel)


@pytest.mark.parametrize("device", [EXAMPLE, SKIN])
def test_files_of_the_page_are_read_like_those_of_python(
    node: Ask, device: Path, tmp_path: Path
) -> None:
    """Columns by name and unit, numbers to rounding, and the recording that both are."""
    motion = motion_of(load_device(device))
    text = base64.b64encode(device.read_bytes()).decode()
    (found,) = node([{"device": text, "file": device.name, "csv": True}])
    here, events_here = tmp_path / "here.csv", motion.to_csv(tmp_path / "here.csv", rate="1 kHz")
    page, events_page = tmp_path / "page.csv", tmp_path / "page-events.csv"
    page.write_text(found["samples"], "utf-8")
    events_page.write_text(found["events"], "utf-8")
    samples = CsvTable.read(page, "samples", "")
    headings = CsvTable.read(here, "samples", "").headings
    assert samples.headings == tuple(h for h in headings if h != "plate_velocity [m/s]")
    time = np.array(samples.column("time", SERIES["time"]))
    for name, values in motion.columns(time).items():
        np.testing.assert_allclose(
            samples.column(name, SERIES[name]), values, rtol=1e-9, atol=1e-12
        )
    one, other = (CsvTable.read(path, "events", "") for path in (events_page, events_here))
    assert one.headings == other.headings
    for name in ("contact", "kind"):
        assert one.text(name) == other.text(name)
    for name in ("time", "position", "velocity"):
        there = one.column(name, SERIES[name])
        np.testing.assert_allclose(there, other.column(name, SERIES[name]), rtol=1e-9, atol=1e-12)
    assert [*read_recording(page).channels] == [*read_recording(here).channels]
    (again,) = node([{"recording": here.read_text("utf-8"), "file": "here.csv"}])
    np.testing.assert_array_equal(doubles(again["times"]), read_recording(here).time)

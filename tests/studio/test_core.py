"""The core as WebAssembly, and the page's readers of files, beside Python's."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pindrive import simulate
from pindrive.fitting.recording import read_recording
from pindrive.quantities.units import UnitError, to_si
from studio_cases import Ask, compare, doubles, questions


def test_a_thousand_random_drives_have_the_bits_of_python(node: Ask) -> None:
    cases, asked = questions(1000, 16)
    differ = []
    for found, (drive, release, duration) in zip(node(asked), cases, strict=True):
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

HEAD = "t [ms], position [mm], velocity [mm/s]\n"
ROWS = "".join(f"{i}, {np.sin(i / 5):.6f}, {10 * np.cos(i / 5):.6f}\n" for i in range(20))
RECORDINGS = [
    HEAD + ROWS,
    "# a bench\n\n" + (HEAD + ROWS).replace(", ", ";"),
    "",
    "t, position [mm]\n" + ROWS,
    "t [s], place [mm]\n" + ROWS,
    "t [s], position [kg]\n" + ROWS,
    "t [s], position [mm], position [m]\n" + ROWS,
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

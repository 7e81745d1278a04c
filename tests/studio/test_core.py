"""The core as WebAssembly, and the page's readers of files, beside Python's."""

from __future__ import annotations

import base64
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pindrive import simulate
from pindrive.files.device import ConfigError, load_device
from pindrive.files.template import NUMBERS, template
from pindrive.fitting.recording import read_recording
from pindrive.quantities.units import UnitError, to_si
from studio_cases import Ask, compare, doubles, questions

EXAMPLES = [
    path
    for path in sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
    if not path.stem.endswith(("study", "wish"))
]
GOOD = Path(__file__).parents[1].joinpath("minimal.toml").read_text("utf-8")


def test_a_thousand_random_drives_move_as_in_python(node: Ask) -> None:
    cases, asked = questions(1000, 16)
    for found, (drive, release, duration) in zip(node(asked), cases, strict=True):
        compare(found, simulate(drive, release, duration=duration))


# ---- device files --------------------------------------------------------------------------------

WRONG = [
    ("", " "),
    ("10 g", "10 gg"),
    ("10 g", "0 g"),
    ("10 g", "10"),
    ("10 g", "1,5 g"),
    ("10 g", "ten grams"),
    ('"10 g"', "10 g"),
    ('"10 g"', "true"),
    ('"10 g"', "[1, 2.5, 'a']"),
    ('"10 g"', "0.01"),
    ("10 g", "1e400 g"),
    ("10 g", "nan g"),
    ("10 g", "5 N"),
    ("mass", "mas"),
    ("mass", "weight"),
    ("[plate]", "[plat]"),
    ("[plate]", "[plate"),
    ("[plate]", "[drive]"),
    ("kinetic", "Kinetic"),
    ("damping =", "damping_ratio = 0.1\ndamping ="),
    ('damping = "0.40 N*s/m"', ""),
    ('damping = "0.40 N*s/m"', 'dampin = "1 N*s/m"'),
    ('damping = "0.40 N*s/m"', "damping_ratio = -1"),
    ('damping = "0.40 N*s/m"', 'damping = "1e-13 N*s/m"'),
    ('"20 mN"', '"20 mN"\nstatic = "10 mN"'),
    ('"20 mN"', '"20 mN"\nstiffness = "10 N/m"'),
    ('"20 mN"', '"20 mN"\ncurve = []'),
    ('"20 mN"', '"20 mN"\ncurve = [["0 m/s", "21 mN"]]'),
    ('"20 mN"', '"20 mN"\ncurve = [["0 m/s", "20 mN"], ["0 m/s", "1 mN"]]'),
    ('"20 mN"', '"20 mN"\ncurve = [["0 m/s"]]'),
    ('"20 mN"', '"20 mN"\ncurve = [["1 m/s", "20 mN"]]'),
    ('"20 mN"', '"20 mN"\ncurve = [["0 m/s", "20 mN"], ["1e-13 m/s", "1 N"]]'),
    ('"5 mN"', '"5 mN"\nstiffness = "0 N/m"'),
    ('"5 mN"', '"5 mN"\nstiffness = "1 N/m"\ncurve = [["0 m/s", "5 mN"], ["1 m/s", "1 mN"]]'),
    ('"100 mm/s"', '"100 mm/s"\nskin_stretch = "1 mm"'),
    ('"100 mm/s"', '"100 mm/s"\nduration = "0 s"'),
    ('"100 mm/s"', '"100 mm/s"\nsettling_band = 2'),
    ('"100 mm/s"', '"100 mm/s"\nplate_load = [["0 s", 1], ["0 s", 2], ["0 s", 3]]'),
    ('"100 mm/s"', '[["0 s", "1 m/s"], ["0 s", "2 m/s"]]'),
    ('"100 mm/s"', '[["1 s", "1 m/s"], ["0 s", "2 m/s"]]'),
    ('"100 mm/s"', '[["1 s", "1 m/s", 3]]'),
    ('mouse_velocity = "100 mm/s"', ""),
    ("[drive]", "drive = 1\n[rest]"),
    ("[drive]", "axes = 1\n[drive]"),
    ("[drive]", "[device]\nname = 5\n[drive]"),
    ("[drive]", "[device]\ndescription = {a = 1}\n[drive]"),
    ("# The least", "The least"),
    ("[finger]", "finger]"),
    ("[finger]", "[finger] x"),
    ("[finger]", "[[finger]]"),
    ("[finger]", "a.b = 1\n[finger]"),
    ('"5 mN"', '"5 mN'),
    ('"5 mN"', "'5 mN"),
    ('"5 mN"', '"""5 mN'),
    ('"5 mN"', '"5 \\q mN"'),
    ('"5 mN"', '"5 \\u12 mN"'),
    ('"5 mN"', "[1, 2"),
    ('"5 mN"', "{a = 1, a = 2}"),
    ('"5 mN"', "{a = 1"),
    ('"5 mN"', "5 mN"),
    ('"5 mN"', ""),
    ('"5 mN"', '"5 mN"\nkinetic = "6 mN"'),
    ('"5 mN"', '"5 mN" # a\x01b'),
    ('"5 mN"', "0x5"),
    ('"5 mN"', "inf"),
    ('"5 mN"', '"5 mN"\n[scan]\nhand_speed = "1 kg"'),
    ('"5 mN"', '"5 mN"\n[array]\npitc = "1 mm"'),
]
"""A text of a file that is good, and what stands there instead."""


def spoiled() -> list[str]:
    assert all(old in GOOD for old, _ in WRONG)
    return [GOOD.replace(old, new, 1) if old else new for old, new in WRONG]


def said_by_python(text: str, path: Path) -> list[str]:
    path.write_text(text, "utf-8")
    with pytest.raises(ConfigError) as refused:
        load_device(path)
    return [line.removeprefix(f"{path}: ") for line in refused.value.problems]


def test_a_mistake_in_a_device_file_is_said_in_the_words_of_the_command(
    node: Ask, tmp_path: Path
) -> None:
    texts = spoiled()
    asked = [{"device": base64.b64encode(text.encode()).decode(), "file": "FILE"} for text in texts]
    differ = []
    for text, found in zip(texts, node(asked), strict=True):
        expected = said_by_python(text, tmp_path / "device.toml")
        said = found.get("problem", "nothing").split("\n")
        if [line.removeprefix("FILE: ") for line in said] != expected:
            differ.append((expected, said))
    assert not differ, f"{len(differ)} of {len(texts)}: {differ[:6]}"


@pytest.mark.parametrize("bad", [b"mass = \xff", "mass = 'µ'".encode("latin-1"), b"\x89HDF..."])
def test_what_is_no_text_is_said_so(node: Ask, tmp_path: Path, bad: bytes) -> None:
    path = tmp_path / "device.toml"
    path.write_bytes(bad)
    with pytest.raises(ConfigError) as refused:
        load_device(path)
    (found,) = node([{"device": base64.b64encode(bad).decode(), "file": str(path)}])
    assert found["problem"] == str(refused.value)


def read(node: Ask, texts: list[str]) -> list[Any]:
    asked = [{"device": base64.b64encode(text.encode()).decode(), "file": "FILE"} for text in texts]
    found = node(asked)
    assert [one.get("problem") for one in found] == [None] * len(texts)
    return found


def test_device_files_are_read_as_python_reads_them_and_written_so(
    node: Ask, tmp_path: Path
) -> None:
    texts = [
        template(),
        template(whole=True),
        GOOD,
        *(path.read_text("utf-8") for path in EXAMPLES),
    ]
    path = tmp_path / "device.toml"
    forces = [text for text in texts if "\ncoefficient" not in text]
    assert len(forces) >= 4  # the page does not take coefficients of friction
    (refused,) = node(
        [{"device": base64.b64encode(template(whole=True).encode()).decode(), "file": "FILE"}]
    )
    assert refused["problem"].startswith(
        "FILE: plate.coefficient: the studio takes friction as a force"
    )
    for text, found in zip(forces, read(node, forces), strict=True):
        path.write_text(text, "utf-8")
        expected = load_device(path).values()
        path.write_text(found["written"], "utf-8")
        again = load_device(path)
        given = {
            key for key in expected if key.partition(".")[2] in again.tables[key.partition(".")[0]]
        }
        for key, value in found["values"].items():
            assert np.array_equal(value, np.array(expected[key])), key
        assert given >= found["values"].keys()
        for key in given:
            assert again.values()[key] == expected[key], key


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


def test_every_key_of_the_table_is_known_to_the_page(node: Ask) -> None:
    (found,) = read(node, [template()])
    keys = {
        key
        for key in NUMBERS
        if key.partition(".")[2] in tomllib.loads(template()).get(key.partition(".")[0], {})
    }
    assert found["values"].keys() == keys

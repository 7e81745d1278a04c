"""The page's reader of device files, compared with Python's."""

from __future__ import annotations

import base64
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pindrive import Profile, simulate
from pindrive.files.device import DeviceFile, load_device
from pindrive.files.keys import DRIVE, NUMERIC_KEYS, template
from pindrive.files.overrides import ConfigError
from pindrive.quantities.drive import SUPPORTS
from studio_cases import Ask, as_input, doubles

EXAMPLES = [
    path
    for path in sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
    if not path.stem.endswith(("study", "problem", "system", "fit"))
]
GOOD = Path(__file__).parents[1].joinpath("minimal.toml").read_text("utf-8")


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
    ('"20 mN"', '"20 mN"\ncoefficient = 0.2'),
    ('kinetic = "20 mN"', 'static = "20 mN"\ncoefficient_curve = [["0 m/s", 0.2]]'),
    ('kinetic = "20 mN"', "coefficient = -0.2"),
    ('kinetic = "20 mN"', 'coefficient = "0.2 N"'),
    ('kinetic = "20 mN"', "static_coefficient = 0.2"),
    ('kinetic = "20 mN"', "coefficient = 0.2\nstatic_coefficient = 0.1"),
    ('kinetic = "20 mN"', 'coefficient = 0.2\ncoefficient_curve = [["0 m/s", 0.3]]'),
    ('kinetic = "20 mN"', 'coefficient_curve = [["1 m/s", 0.3]]'),
    ('kinetic = "20 mN"', 'coefficient_curve = [["0 m/s", 0.3], ["1e-13 m/s", 1]]'),
    ('kinetic = "20 mN"', 'coefficient_curve = [["0 m/s", 0.3], ["1e-7 m/s", 4]]'),
    ('kinetic = "20 mN"', 'coefficient = 0.2\npreload = "-1 N"'),
    ('kinetic = "5 mN"', "coefficient = 0.5"),
    ('kinetic = "5 mN"', 'coefficient = 0.5\ntouch_force = "ten"'),
    ('"5 mN"', '"5 mN"\ntouch_force = "10 mN"'),
    ('"100 mm/s"', '"100 mm/s"\nforce = [["0 s", "1 N"], ["0 s", "2 N"], ["0 s", "3 N"]]'),
    ('"100 mm/s"', '"100 mm/s"\nforce = "1 m"'),
    ('"100 mm/s"', '"100 mm/s"\nfinger_load = -1'),
    ('"100 mm/s"', '"100 mm/s"\nacross_velocity = [["0 s", "1 m/s"], ["0 s", "2 m/s"]]'),
    ('"100 mm/s"', "{}"),
    ('"100 mm/s"', '{ mean = "60 mm/s" }'),
    ('"100 mm/s"', '{ amplitude = "60 mm/s", frequency = "8 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", amplitude = "1 m/s", frequency = "0 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", amplitude = "1 m/s", frequency = "2e6 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", amplitude = "1e13 m/s", frequency = "2 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m", amplitude = "1 m/s", frequency = "2 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", amplitude = "1 m/s", frequency = 2 }'),
    ('"100 mm/s"', '{ men = "0 m/s", amplitude = "1 m/s", frequency = "2 Hz" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", zzzz = "1 m/s" }'),
    ('"100 mm/s"', '{ mean = "0 m/s", distance = "1 m" }'),
    ('"100 mm/s"', '{ distance = "20 mm", duration = "0 s" }'),
    ('"100 mm/s"', '{ start = "1 m/s", end = "0 m/s", time_constant = "1e-8 s" }'),
    ('"100 mm/s"', '[{ start = "1 m/s", end = "0 m/s", time_constant = "1 s", begin = "-1 s" }]'),
    ('"100 mm/s"', '[{ distance = "20 mm", duration = "1 s" }, { distance = "20 mm" }]'),
    ('"100 mm/s"', '{ pieces = [{ begin = "1 m", polynomial = [1] }] }'),
    ('"100 mm/s"', "{ pieces = [{ polynomial = [1] }] }"),
    ('"100 mm/s"', "{ pieces = [] }"),
    ('"100 mm/s"', '"100 mm/s"\nplate_load = { distance = "20 mm", duration = "1 s" }'),
    ('"100 mm/s"', '"100 mm/s"\nforce = { mean = "0 N" }'),
    ('"10 g"', '"10 g"\nstop_stiffness = "1 N/m"'),
    ('"10 g"', '"10 g"\nstop_damping = "0 N*s/m"'),
    ('"10 g"', '"10 g"\ntravel = "3 mm"\nstop_damping = "1 N*s/m"'),
    ('"10 g"', '"10 g"\ntravel = "0 mm"'),
    ('"10 g"', '"10 g"\ntravel = [["0 s", "1 mm"]]'),
    ("", GOOD.replace('"10 g"', '"10 g"\ntravel = "1 mm"') + 'displacement = "-2 mm"\n'),
    ('"5 mN"', '"5 mN"\n[scan]\nhand_speed = "1 kg"'),
    ('"5 mN"', '"5 mN"\n[array]\npitc = "1 mm"'),
    ('"5 mN"', '"5 mN"\nfriction = "1 N"'),
    ('"5 mN"', '"5 mN"\nqqqq = "1 N"'),
    ('"10 g"', '"10 g"\nspring = "1 N/m"'),
    ("[drive]", "masse = 3\n[drive]"),
    ("[drive]", "mouse_speed = 3\n[drive]"),
    ("[drive]", "[scna]\nx = 3\n[drive]"),
]
"""A text of a file that is good, and what stands there instead."""

WRONG_AROUND = [
    *(("magnet", line) for line in (
        'turns = 300', 'gap = "0.1 mm"\nturns = 300',
        'residual = "5 N"', "pwm_duty = 0.5", 'pwm_frequency = "1 kHz"',
        'voltage = [["0 s", "1 V"]]', "saturation = 2",
    )),
    *(("coil", line) for line in (
        'outer_diameter = "2.7 mm"', 'voltage = [["1 ms", "1 V"]]', 'voltage = [["0 s", "99 V"]]',
        'voltage = [["0 s", "1 V"], ["0 s", "2 V"]]', 'saturation_field = "1 mT"\nresidual = "1 N"',
        'voltage = [["0 s", "1 V"]]\npwm_frequency = "1 kHz"\npwm_duty = 0.5',
        'lift = "0.1 mm"', 'closing_force = "0.1 N"', 'lift = "0.1 mm"\nclosing_force = "3 N"',
        'lift = "0.1 mm"\nclosing_force = "0.1 N"\nresidual = "0.1 N"',
        'lift = "0.1 mm"\nclosing_force = "0 N"', 'lift = "-0.1 mm"\nclosing_force = "0.1 N"',
    )),
    ("control", "threshold = 0.9\nhysteresis = 0.3"),
    *(("array", line) for line in (
        "columns = 2.5", "columns = 200\nrows = 200", 'places = [["0 m", "0 m"]]\ncolumns = 2',
        'places = [["0 m", "0 m"], ["1 m", "0 m"], ["0 m", "0 m"]]',
        'slot_length = "1 mm"\npin_diameter = "2 mm"',
    )),
    *(("scan", line) for line in (
        'touch = "10 mN"', 'touch = [["0 s", "10 mN"], ["1 s", "0 N"]]', 'touch = "-10 mN"',
        'touch = [["0 s", "10 mN"], ["1 s", "-1 N"]]', 'touch = [["1 s", "10 mN"], ["0 s", "1 N"]]',
    )),
    ("plate", ""),
]  # fmt: skip
"""A table of the whole device, and what stands in it."""


def around(table: str, lines: str) -> str:
    """A whole device of which one table is wrong."""
    if table == "plate":
        return GOOD.replace('"20 mN"', '"0 N"') + '[magnet]\nresidual = "0 N"\n'
    if table == "coil":
        lines = (
            'turns = 300\npole_area = "4 mm^2"\ngap = "0.1 mm"\nwire_diameter = "0.1 mm"\n'
            f'turn_length = "15 mm"\nsupply_voltage = "5 V"\n{lines}'
        )
        table = "magnet"
    return f"{GOOD}[{table}]\n{lines}\n"


def spoiled() -> list[str]:
    assert all(old in GOOD for old, _ in WRONG)
    return [around(*wrong) for wrong in WRONG_AROUND] + [
        GOOD.replace(old, new, 1) if old else new for old, new in WRONG
    ]


def said_by_python(text: str, path: Path) -> list[str]:
    path.write_text(text, "utf-8")
    with pytest.raises(ConfigError) as refused:
        load_device(path)
    return [line.removeprefix(f"{path}: ") for line in refused.value.problems]


def forms(problems: list[str]) -> list[str]:
    """Problems without the words of the two parsers on the syntax of TOML."""
    return [re.sub(r"^(is not valid TOML: ).*?(; a value with|$)", r"\1\2", p) for p in problems]


def test_device_file_error_has_the_words_of_the_command(node: Ask, tmp_path: Path) -> None:
    texts = spoiled()
    requested = [asked_of(text) for text in texts]
    differ = []
    for text, found in zip(texts, node(requested), strict=True):
        expected = said_by_python(text, tmp_path / "device.toml")
        said = found.get("problem", "nothing").split("\n")
        if forms([line.removeprefix("FILE: ") for line in said]) != forms(expected):
            differ.append((expected, said))
    assert not differ, f"{len(differ)} of {len(texts)}: {differ[:6]}"


WAVE = '{ mean = "60 mm/s", amplitude = "10 mm/s", frequency = "8 Hz" }'
TURNED = WAVE.replace(" }", ', phase = "0.3 rad" }')
STROKE = '{ distance = "20 mm", duration = "0.4 s", begin = "0.1 s" }'
PULL = 'plate_load = { start = 5, end = 1, time_constant = "5 ms", begin = "0.03 s" }\n'
PIECES = (
    'force = { pieces = [{ begin = "0 s", polynomial = [0.01, 0.5], terms = [[1, 2, 3, 4]] }] }\n'
)
RELEASE = 'displacement = "2 mm"\nvelocity = "0 mm/s"\nduration = "0.6 s"\n'
UNDER_FUNCTIONS = [
    GOOD.replace('"100 mm/s"', f"{hand}\n{RELEASE}{others}")
    for hand, others in (
        (WAVE, ""),
        (TURNED, PULL),
        (STROKE, PIECES),
        (f"[{STROKE}, {WAVE}]", PULL),
    )
]
"""Devices whose inputs are functions of time."""


def test_functions_are_read_and_written_like_python(node: Ask, tmp_path: Path) -> None:
    """The page has the motion of Python, and writes what it has read."""
    path = tmp_path / "device.toml"
    for text, found in zip(UNDER_FUNCTIONS, read(node, UNDER_FUNCTIONS), strict=True):
        path.write_text(text, "utf-8")
        device = load_device(path)
        (motion,) = node([{"simulate": found["core"], "duration": 0.6}])
        expected = simulate(device.drive, device.release, duration=0.6)
        times = doubles(motion["times"])
        position, velocity, *_ = np.reshape(doubles(motion["values"]), (5, -1))
        # The page finds it by series, Python in closed form.
        np.testing.assert_allclose(position, expected.position(times), rtol=0.0, atol=1e-14)
        np.testing.assert_allclose(velocity, expected.velocity(times), rtol=0.0, atol=1e-11)
        path.write_text(found["written"], "utf-8")
        again = load_device(path)
        assert (again.drive, again.release) == (device.drive, device.release)
        assert ("pieces" in found["written"]) == ("pieces" in text)


@pytest.mark.parametrize("bad", [b"mass = \xff", "mass = 'µ'".encode("latin-1"), b"\x89HDF..."])
def test_values_that_are_no_text_are_reported(node: Ask, tmp_path: Path, bad: bytes) -> None:
    path = tmp_path / "device.toml"
    path.write_bytes(bad)
    with pytest.raises(ConfigError) as refused:
        load_device(path)
    (found,) = node([{"device": base64.b64encode(bad).decode(), "file": str(path)}])
    assert found["problem"] == str(refused.value)


def read(node: Ask, texts: list[str]) -> list[Any]:
    found = node([asked_of(text) for text in texts])
    assert [one.get("problem") for one in found] == [None] * len(texts)
    return found


BY_COEFFICIENTS = (
    template()
    .replace('kinetic = "22 mN"', 'coefficient = 0.2\npreload = "30 mN"\ntouch_share = 0.7', 1)
    .replace('static = "26.5 mN"', "static_coefficient = 0.3", 1)
    .replace(
        'kinetic = "5 mN"',
        'coefficient = 0.5\ntouch_force = "12 mN"\nload_exponent = 0.8\n'
        'reference_touch = "40 mN"\nstiffness = "1000 N/m"',
        1,
    )
    .replace('static = "7.5 mN"', "static_coefficient = 0.75", 1)
    + 'finger_load = 1.5\nskin_stretch = "2 um"\n'
    'force = [["0 s", "0 N"], ["10 ms", "10 mN"], ["10 ms", "0 N"]]\n'
    'across_velocity = [["0 s", "20 mm/s"], ["50 ms", "0 mm/s"]]\n'
)
CURVED = GOOD.replace(
    'kinetic = "20 mN"',
    'coefficient_curve = [["0 m/s", 0.2], ["0.1 m/s", 0.1]]\nstatic_coefficient = 0.3',
)
"""Devices that give friction by coefficients."""
STOPPED = (
    template()
    .replace("[drive]", '[drive]\ntravel = "1.8 mm"\nstop_stiffness = "20000 N/m"', 1)
    .replace("[plate]", 'stop_damping = "3 N*s/m"\n\n[plate]', 1)
)
"""A device with elastic end stops."""
OTHERS = (
    GOOD.replace('kinetic = "5 mN"', 'curve = [["0 m/s", "5 mN"], ["0.1 m/s", "4 mN"]]').replace(
        '"10 g"', '"10 g"\ntravel = "3 mm"\nstop_damping = "0 N*s/m"'
    )
    + 'plate_load = [["0 s", 2], ["5 ms", 1]]\nvelocity = "1 m/s"\nduration = "0.2 s"\n'
    + 'support = "ground"\n',
    GOOD.replace(
        'kinetic = "5 mN"',
        'coefficient_curve = [["0 m/s", 0.5], ["0.1 m/s", 0.4]]\ntouch_force = "10 mN"',
    ),
    GOOD.replace(
        '"5 mN"', '"5 mN"\nstiffness = "1 N/m"\ncurve = [["0 m/s", "5 mN"], ["1 m/s", "1 mN"]]'
    ),
)
"""Devices with rigid end stops and with the remaining keys."""
LAW = 'law = "stribeck"\nstribeck_velocity = "30 mm/s"\nexponent = 2\n'
BY_LAW = tuple(
    GOOD.replace('kinetic = "20 mN"', f"{plate}\n{LAW}").replace(
        'kinetic = "5 mN"', f"{finger}\n{LAW}"
    )
    for plate, finger in (
        (
            'kinetic = "20 mN"\nbreakaway = "25 mN"\nviscous = "0.1 N*s/m"',
            'kinetic = "5 mN"\nbreakaway = "6 mN"\nviscous = "0.02 N*s/m"',
        ),
        (
            'coefficient = 0.2\nbreakaway_coefficient = 0.3\nviscous_coefficient = "0.1 s/m"',
            'touch_force = "10 mN"\ncoefficient = 0.5\nbreakaway_coefficient = 0.6\n'
            'viscous_coefficient = "0.2 s/m"',
        ),
    )
)
"""Devices with friction by a law at both contacts, by forces and by coefficients."""


def asked_of(text: str, **more: Any) -> dict[str, Any]:
    return {"device": base64.b64encode(text.encode()).decode(), "file": "FILE", **more}


def as_core(device: DeviceFile) -> dict[str, Any]:
    """The core's numbers of a device, in the names of pindrive.h."""
    given = as_input(device.drive, device.release)
    for name, rows in given["profiles"].items():
        profile = getattr(device.release, name)
        if isinstance(profile, Profile) and not profile.changes:
            given["profiles"][name] = [(0.0, rows[0][1])]
    own = {"skin_stretch": device.release.skin_stretch, "duration": device.duration}
    own["support"] = float(SUPPORTS.index(device.release.support))
    given["release"] |= {name: value for name, value in own.items() if value is not None}
    return given


def flat(core: dict[str, Any]) -> dict[str, Any]:
    """All numbers of the core's input, rows as arrays."""
    numbers = {f"{group}.{name}": value for group in core for name, value in core[group].items()}
    return {name: np.array(value, float) for name, value in numbers.items()}


def test_device_files_are_read_and_written_like_python(node: Ask, tmp_path: Path) -> None:
    examples = [path.read_text("utf-8") for path in EXAMPLES]
    texts = [
        template(),
        template(whole=True),
        GOOD,
        BY_COEFFICIENTS,
        CURVED,
        STOPPED,
        *OTHERS,
        *BY_LAW,
        *examples,
    ]
    assert sum("\ncoefficient" in text for text in texts) >= 3
    path = tmp_path / "device.toml"
    answers = read(node, texts)
    assert set(DRIVE) == {key for found in answers for key in found["values"]}
    for text, found in zip(texts, answers, strict=True):
        path.write_text(text, "utf-8")
        device = load_device(path)
        expected = device.values()
        core, numbers = flat(found["core"]), flat(as_core(device))
        assert core.keys() == numbers.keys()
        for name, value in numbers.items():
            np.testing.assert_array_equal(core[name], value, name)
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


def numbers_given(device: DeviceFile) -> dict[str, float]:
    """The keys of the drive and its release that a file gives as one number that is not 0."""
    values = device.values()
    given = {
        key: values[key]
        for key in DRIVE
        if key.partition(".")[2] in device.tables[key.partition(".")[0]]
    }
    return {key: value for key, value in given.items() if isinstance(value, float) and value}


@pytest.mark.parametrize(
    "text",
    [template(), BY_COEFFICIENTS, CURVED, STOPPED],
    ids=["forces", "pressed", "curve", "stops"],
)
def test_followers_of_a_set_value_equal_python(node: Ask, tmp_path: Path, text: str) -> None:
    """Also its exact rate, which derivatives and fits use."""
    path = tmp_path / "device.toml"
    path.write_text(text, "utf-8")
    given = numbers_given(load_device(path))
    assert len(given) > 4
    step = 1e-5
    changed = {key: load_device(path, {key: 1.25 * value}) for key, value in given.items()}
    found = node([asked_of(text, set=[key, 1.25 * value]) for key, value in given.items()])
    rates = node([asked_of(text, direction=key) for key in given])
    for (key, value), one, rate in zip(given.items(), found, rates, strict=True):
        core, expected = flat(one["core"]), flat(as_core(changed[key]))
        assert core.keys() == expected.keys()
        for name in expected:
            np.testing.assert_allclose(
                core[name], expected[name], 1e-14, 0, err_msg=f"{key}: {name}"
            )
        ends = [flat(as_core(load_device(path, {key: value * (1 + by)}))) for by in (-step, step)]
        exact = flat(rate["core"])
        for name in ends[0]:
            slope = (ends[1][name] - ends[0][name]) / (2 * step)
            known = exact.get(name, np.zeros_like(slope))
            if slope.ndim:  # rows: the second column is what changes
                slope, known = slope[:, 1], known[:, 1]
            size = np.abs(ends[0][name]).max(initial=0.0)
            np.testing.assert_allclose(known, slope, 1e-7, 1e-9 * size, err_msg=f"{key}: {name}")


@pytest.mark.parametrize(
    "keys",
    [
        ("drive.mass", "plate.preload"),
        ("drive.mass", "plate.coefficient"),
        ("finger.touch_force", "plate.preload"),
        ("finger.touch_force", "finger.reference_touch"),
        ("finger.coefficient", "finger.touch_force"),
        ("drive.travel", "drive.stop_stiffness"),
    ],
    ids=" ".join,
)
def test_the_corners_of_a_map_are_the_devices_of_python(
    node: Ask, tmp_path: Path, keys: tuple[str, str]
) -> None:
    """Also where weight and preload press together."""
    path = tmp_path / "device.toml"
    text = STOPPED if keys[0] == "drive.travel" else BY_COEFFICIENTS
    path.write_text(text, "utf-8")
    (found,) = node([asked_of(text, map=keys)])
    for corner in found["corners"]:
        at = dict(zip(keys, (corner["x"], corner["y"]), strict=True))
        core = as_core(load_device(path, at))
        assert corner["varied"]
        for name, value in corner["varied"].items():
            expected = core["drive"].get(name, core["release"].get(name))
            assert value == pytest.approx(expected, rel=1e-13), name


def test_every_key_of_the_table_is_known_to_the_page(node: Ask) -> None:
    (found,) = read(node, [template()])
    keys = {
        key
        for key in NUMERIC_KEYS
        if key.partition(".")[2] in tomllib.loads(template()).get(key.partition(".")[0], {})
    }
    assert found["values"].keys() == keys


def corners_of_weight_and_preload(node: Ask, tmp_path: Path) -> None:
    test_the_corners_of_a_map_are_the_devices_of_python(
        node, tmp_path, ("drive.mass", "plate.preload")
    )


def what_follows_a_coefficient(node: Ask, tmp_path: Path) -> None:
    test_followers_of_a_set_value_equal_python(node, tmp_path, BY_COEFFICIENTS)


@pytest.mark.parametrize(
    ("file", "text", "instead", "test"),
    [
        (
            "friction.ts",
            "preload + share * touch;",
            "Math.max(preload, share * touch);",
            test_device_files_are_read_and_written_like_python,
        ),
        (
            "friction.ts",
            "still: still * load",
            "still",
            test_device_files_are_read_and_written_like_python,
        ),
        ("friction.ts", "[own, ...(DRIVE", "[...(DRIVE", what_follows_a_coefficient),
        ("design.ts", "of(ofStatic) + pressed", "of(ofStatic)", what_follows_a_coefficient),
        ("design.ts", "follow(true);", "", what_follows_a_coefficient),
        ("map.ts", "value - origin[name]!", "value", corners_of_weight_and_preload),
        ("mapgrid.ts", "sum ? u + v : u * v", "u * v", corners_of_weight_and_preload),
        (
            "device.ts",
            "problems.push(...this.core",
            "void (this.core",
            test_device_file_error_has_the_words_of_the_command,
        ),
        (
            "core.ts",
            "value.flat()",
            "[...value[0]!]",
            test_device_file_error_has_the_words_of_the_command,
        ),
    ],
)
def test_the_tests_see_what_goes_wrong_in_the_page(
    spoiled: Callable[[str, str, str], Ask],
    tmp_path: Path,
    file: str,
    text: str,
    instead: str,
    test: Callable[[Ask, Path], None],
) -> None:
    """A mutant of the TypeScript must fail the test that is to see it."""
    wrong = spoiled(file, text, instead)
    with pytest.raises(AssertionError):
        test(wrong, tmp_path)

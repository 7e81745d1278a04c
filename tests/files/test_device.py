"""Device files: units, overrides, and every mistake said in one line."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pindrive.files.device import load_device
from pindrive.files.keys import KEYS, NUMERIC_KEYS, template
from pindrive.files.overrides import ConfigError
from pindrive.quantities.drive import DRIVE_QUANTITIES
from pindrive.quantities.units import UnitError, to_si

EXAMPLE = Path(__file__).parents[2] / "examples" / "tactile-mouse.toml"
GOOD = Path(__file__).parents[1].joinpath("minimal.toml").read_text(encoding="utf-8")

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a device file, GOOD with one text replaced by another."""

    def write(old: str = "", new: str = "") -> Path:
        assert old in GOOD
        path = tmp_path / "device.toml"
        path.write_text(GOOD.replace(old, new) if old else new or GOOD, encoding="utf-8")
        return path

    return write


def problems(path: Path, *overrides: str) -> list[str]:
    """The problems of a file, its place taken off."""
    with pytest.raises(ConfigError) as refused:
        load_device(path, overrides)
    assert str(refused.value) == "\n".join(refused.value.problems)
    assert not any("\n" in line for line in refused.value.problems)
    return [line.replace(f"{path}: ", "FILE: ") for line in refused.value.problems]


# ---- good files ----------------------------------------------------------------------------------


def test_a_file_is_read_in_si_to_the_last_bit(write: Write) -> None:
    device = load_device(write())
    drive = device.drive
    assert (drive.mass, drive.stiffness, drive.damping) == (0.010, 100.0, 0.40)
    assert (drive.plate.kinetic, drive.plate.static, drive.finger.kinetic) == (0.020, None, 0.005)
    assert (device.release.mouse_velocity, device.release.displacement) == (0.1, 0.0)
    assert (device.release.velocity, device.duration, device.name) == (None, None, "")


def test_example_loads() -> None:
    device = load_device(EXAMPLE)
    assert device.name
    assert device.drive.damping_ratio == pytest.approx(0.16, rel=1e-15)
    assert device.drive.plate.kinetic == pytest.approx(0.225 * 0.010 * 9.81, rel=0.01)


def test_example_is_what_init_writes() -> None:
    values = load_device(EXAMPLE).values()
    for quantity in DRIVE_QUANTITIES:
        if quantity.default is not None:
            assert values[quantity.key] == quantity.default


def test_template_loads_with_the_defaults_of_the_table(write: Write) -> None:
    device = load_device(write(new=template()))
    given = {q.key: q.default for q in DRIVE_QUANTITIES if q.default is not None}
    assert device.values() | given == device.values()


COMMENTED = [
    (table, line.removeprefix("# "))
    for table, lines in (
        (part.partition("]")[0], part.splitlines()) for part in template().split("\n[")[1:]
    )
    for line in lines
    if line.startswith("# ") and f"{table}.{line[2:].partition(' = ')[0]}" in KEYS
]


def test_the_template_shows_every_key() -> None:
    text = template(whole=True).replace("\n# ", "\n")
    assert [key for key in KEYS if f"\n{key.partition('.')[2]} = " not in text] == []
    assert [line for _, line in COMMENTED if " = [" in line] == [
        'curve = [["0 mm/s", "22 mN"], ["50 mm/s", "15 mN"]]',
        'coefficient_curve = [["0 mm/s", 0.225], ["50 mm/s", 0.15]]',
        'curve = [["0 mm/s", "5 mN"], ["50 mm/s", "4 mN"]]',
        'coefficient_curve = [["0 mm/s", 0.5], ["50 mm/s", 0.4]]',
        'mouse_velocity = [["0 ms", "60 mm/s"], ["100 ms", "0 mm/s"]]',
        'plate_load = [["0 ms", 5], ["5 ms", 1]]',
        'force = [["0 ms", "10 mN"], ["20 ms", "0 mN"]]',
        'across_velocity = [["0 ms", "10 mm/s"], ["100 ms", "0 mm/s"]]',
        'finger_load = [["0 ms", 1], ["20 ms", 0]]',
    ]


@pytest.mark.parametrize(("table", "line"), COMMENTED, ids=str)
def test_every_commented_line_of_the_template_works(write: Write, table: str, line: str) -> None:
    name = line.partition(" = ")[0]
    other = {"drive.damping": "damping_ratio =", "motion.mouse_velocity": "mouse_velocity ="}
    instead = other.get(f"{table}.{name}", "!")
    lines = [text for text in template().splitlines() if not text.startswith(instead)]
    if name == "skin_stretch" or (table, name) == ("finger", "damping"):  # of skin alone
        lines = [text.replace("# stiffness", "stiffness") for text in template().splitlines()]
    if name.startswith("stop_"):  # of stops, which are elastic
        needed = tuple(f"# {n} =" for n in ("travel", "stop_stiffness") if n != name)
        lines = [text[2:] if text.startswith(needed) else text for text in lines]
    if "coefficient" in name or name in (
        "touch_force",
        "reference_touch",
    ):  # in place of the table's forces
        begin = lines.index(f"[{table}]")
        end = next(i for i in range(begin + 1, len(lines)) if lines[i].startswith("["))
        forces, needed = ("kinetic =", "static ="), ("# coefficient =", "# touch_force =")
        of_table = [text for text in lines[begin:end] if not text.startswith(forces)]
        of_table = [text[2:] if text.startswith(needed) else text for text in of_table]
        lines[begin:end] = [text for text in of_table if not text.startswith(f"{name} =")]
    law = ("law", "breakaway", "stribeck_velocity", "exponent", "breakaway_coefficient")
    if name in law:  # of friction that falls
        begin = lines.index(f"[{table}]")
        end = next(i for i in range(begin + 1, len(lines)) if lines[i].startswith("["))
        rest = "breakaway_coefficient" if "coefficient" in name else "breakaway"
        needed = tuple(f"# {n} =" for n in ("law", rest, "stribeck_velocity") if n != name)
        lines[begin:end] = [
            text[2:] if text.startswith(needed) else text for text in lines[begin:end]
        ]
    lines.insert(lines.index(f"[{table}]") + 1, line)
    device = load_device(write(new="\n".join(lines)))
    if table != "device" and " = {" not in line:  # of functions see test_functions.py
        quantity = NUMERIC_KEYS[f"{table}.{name}"]
        given = quantity.rows if " = [" in line else quantity.example
        assert device.values()[quantity.key] == given


def test_windows_text_is_read(write: Write) -> None:
    path = write()
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load_device(path).drive.mass == 0.010


@pytest.mark.parametrize("ratio", ["0.2", '"0.2"', '"20 %"', '"20%"', '"20 percent"'])
def test_damping_ratio_as_number_or_percentage(write: Write, ratio: str) -> None:
    path = write('damping = "0.40 N*s/m"', f"damping_ratio = {ratio}")
    assert load_device(path).drive.damping == pytest.approx(0.4, rel=1e-15)


def test_overrides_by_short_and_full_key(write: Write) -> None:
    device = load_device(write(), ["mass=12 g", "plate.kinetic = 30 mN", "name=other", "mass=13 g"])
    assert (device.drive.mass, device.drive.plate.kinetic) == (0.013, 0.030)
    assert device.name == "other"


def test_either_damping_replaces_the_other(write: Write) -> None:
    assert load_device(write(), ["damping_ratio=0.5"]).drive.damping_ratio == 0.5
    path = write('damping = "0.40 N*s/m"', "damping_ratio = 0.2")
    assert load_device(path, ["damping=0.1 N*s/m"]).drive.damping == 0.1


# ---- units ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("10 g", "kg", 0.01),
        ("10g", "kg", 0.01),
        ("1e-2 kg", "kg", 0.01),
        ("26.5 mN", "N", 0.0265),
        ("1 gf", "N", 0.00980665),
        ("0.4 N*s/m", "N*s/m", 0.4),
        ("0.4 N s/m", "N*s/m", 0.4),
        ("0.4 N·s/m", "N*s/m", 0.4),
        ("0.4 kg/s", "N*s/m", 0.4),
        ("0.1 N/mm", "N/m", 100.0),
        ("−1.5 mm", "m", -0.0015),
        ("5 µm", "m", 5e-6),
        ("5 μm", "m", 5e-6),
        ("5 um", "m", 5e-6),
        ("1 in", "m", 0.0254),
        ("6 cm/s", "m/s", 0.06),
        ("6 m/min", "m/s", 0.1),
        ("0.2", "1", 0.2),
        ("16 %", "1", 0.16),
        ("1e999999 kg", "kg", math.inf),
        ("inf kg", "kg", math.inf),
    ],
)
def test_units(text: str, unit: str, value: float) -> None:
    assert to_si(text, unit, "") == value


@given(st.text(max_size=20) | st.from_regex(r"[0-9. ]{1,4}[a-zA-Z*/^() 0-9.-]{0,12}"))
def test_any_text_is_a_number_or_refused(text: str) -> None:
    try:
        assert isinstance(to_si(text, "kg", "10 g"), float)
    except UnitError as error:
        assert "10 g" in str(error)


@given(st.floats(allow_nan=False))
def test_numbers_keep_every_bit(value: float) -> None:
    assert to_si(f"{value!r} m", "m", "") == value


# ---- mistakes ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            '"10 g"',
            '"10 N"',
            'FILE: drive.mass must be in kg or a unit alike, like "10 g", got "10 N"',
        ),
        (
            '"10 g"',
            '"10 parsec"',
            'FILE: drive.mass must be in kg or a unit alike ("parsec" is not a known unit), like '
            '"10 g", got "10 parsec"',
        ),
        (
            '"10 g"',
            "0.01",
            'FILE: drive.mass must be a number with its unit (give a unit, like "10 g"), got 0.01',
        ),
        (
            '"10 g"',
            '"0.01"',
            "FILE: drive.mass must be a number with its unit "
            '(give a unit, like "10 g"), got "0.01"',
        ),
        ('"10 g"', '""', 'FILE: drive.mass must be a number with its unit, like "10 g", got ""'),
        (
            '"10 g"',
            "true",
            'FILE: drive.mass must be a number with its unit, like "10 g", got true',
        ),
        ('"10 g"', '"0 g"', 'FILE: drive.mass must be finite and greater than 0 kg, got "0 g"'),
        ('"10 g"', '"-1 g"', 'FILE: drive.mass must be finite and greater than 0 kg, got "-1 g"'),
        ('"10 g"', '"nan g"', 'FILE: drive.mass must be finite and greater than 0 kg, got "nan g"'),
        ('"10 g"', '"inf g"', 'FILE: drive.mass must be finite and greater than 0 kg, got "inf g"'),
        (
            '"10 g"',
            "nan",
            'FILE: drive.mass must be a number with its unit (give a unit, like "10 g"), got nan',
        ),
        (
            '"100 N/m"',
            '"-1 N/m"',
            'FILE: drive.stiffness must be finite and greater than 0 N/m, got "-1 N/m"',
        ),
        (
            '"0.40 N*s/m"',
            '"-1 N*s/m"',
            'FILE: drive.damping must be finite and at least 0 N*s/m, got "-1 N*s/m"',
        ),
        (
            'damping = "0.40 N*s/m"',
            "damping_ratio = nan",
            "FILE: drive.damping_ratio must be finite and at least 0, got nan",
        ),
        (
            'damping = "0.40 N*s/m"',
            'damping_ratio = "2 kg"',
            "FILE: drive.damping_ratio must be a plain number or a percentage, "
            'like "0.16", got "2 kg"',
        ),
        ('"20 mN"', '"-1 N"', 'FILE: plate.kinetic must be finite and at least 0 N, got "-1 N"'),
        (
            'kinetic = "20 mN"',
            'kinetic = "20 mN"\nstatic = "10 mN"',
            "FILE: plate.static must be at least the kinetic friction, 0.02 N, got 0.01 N",
        ),
        (
            'kinetic = "5 mN"',
            "",
            'FILE: finger.kinetic is missing; write kinetic = "5 mN" in [finger]',
        ),
        ('[finger]\nkinetic = "5 mN"', "", "FILE: finger.kinetic is missing"),
        ("mass =", "mas =", "FILE: unknown key drive.mas; did you mean drive.mass"),
        (
            "[drive]",
            '[drive]\n"\\n" = 3',
            'FILE: unknown key "drive.\\n"; did you mean drive.mass?',
        ),
        ("damping =", "dampng =", "FILE: unknown key drive.dampng; did you mean drive.damping?"),
        ("[drive]", "[drive]\nwidth = 3", "FILE: unknown key drive.width; did you mean drive."),
        ("[drive]", "[driv]\n[drive]", "FILE: unknown key driv; did you mean drive?"),
        (
            "[drive]",
            "mass = 3\n[drive]",
            "FILE: unknown key mass; did you mean drive.mass",
        ),
        (
            "[motion]",
            "[motion]\nstiffness = 3",
            "FILE: unknown key motion.stiffness; did you mean drive.stiffness or ",
        ),
        (
            'damping = "0.40 N*s/m"',
            "",
            "FILE: give exactly one of drive.damping and drive.damping_ratio, got neither",
        ),
        (
            "damping =",
            "damping_ratio = 0.2\ndamping =",
            "FILE: give exactly one of drive.damping and drive.damping_ratio, got both",
        ),
        ("[drive]", "[[drive]]", "FILE: drive must be a table, [drive], got [{"),
        ("[drive]", "device = 3\n[drive]", "FILE: device must be a table, [device], got 3"),
        (
            "[drive]",
            "[device]\nname = 3\n[drive]",
            "FILE: device.name must be text in quotes, got 3",
        ),
        ('"10 g"', "10 g", "FILE: is not valid TOML: Expected newline"),
        ("[drive]", "[drive", "FILE: is not valid TOML: "),
        ("[drive]", "[drive]\n[drive]", "FILE: is not valid TOML: Cannot declare"),
        ("[drive]", "x = " + "[" * 9999, "FILE: is not valid TOML: "),
        ("[drive]", "x = " + "1" * 9999, "FILE: is not valid TOML: "),
        (
            '"10 g"\nstiffness = "100 N/m"',
            '"1e-12 kg"\nstiffness = "1e-12 N/m"',
            "FILE: drive.damping must be such that the damping ratio is 0 or at least 1e-11 and at "
            "most 1e6, got 0.4 N*s/m, which makes it 2e+11",
        ),
        (
            '"10 g"',
            '"1e-200 kg"',
            "FILE: drive.mass must be finite and at least 1e-12 kg and at most 1e12 kg, got "
            '"1e-200 kg"',
        ),
        (
            '"10 g"',
            '"10,5 g"',
            'FILE: drive.mass must be a number whose decimal sign is a point, like "10.5 g", got '
            '"10,5 g"',
        ),
    ],
)
def test_a_mistake_is_one_line(write: Write, old: str, new: str, problem: str) -> None:
    (line,) = problems(write(old, new))
    assert line.startswith(problem)


def test_line_of_bad_toml_is_reported(write: Write) -> None:
    (line,) = problems(write('"10 g"', "10 g"))
    assert "at line 3" in line
    assert line.endswith("a value with a unit stands in quotes")


def test_all_problems_are_reported_together(write: Write) -> None:
    path = write(new='[drive]\nmas = "1 g"\nstiffness = 3\n[motion]\nduration = "0 s"\n')
    lines = problems(path, "velocity=fast", "spring=1 N/m")
    assert len(lines) == 9
    text = "\n".join(lines)
    for key in ("drive.mas;", "drive.damping", "plate.kinetic", "finger.kinetic"):
        assert f"{key}" in text
    for key in ("stiffness", "duration", "mouse_velocity", "` velocity", "` spring"):
        assert key in text


@pytest.mark.parametrize(
    ("override", "problem"),
    [
        ("mass=-1 g", 'mass: drive.mass must be finite and greater than 0 kg, got "-1 g"'),
        (
            "mass=1 N",
            'mass: drive.mass must be in kg or a unit alike, like "10 g", got "1 N"',
        ),
        (
            "plate.static=1 mN",
            "plate.static: plate.static must be at least the kinetic friction, 0.02 N, got 0.001 N",
        ),
        (
            "kinetic=1 mN",
            "kinetic: kinetic may be plate.kinetic, finger.kinetic or hand.k",
        ),
        ("mas=1 g", "mas: unknown key mas; did you mean drive.mass"),
        ("plat.kinetic=1 N", "plat.kinetic: unknown key plat.kinetic; did you mean plate.k"),
        ("ma\nss=1", "ma ss: unknown key"),
        ("mass", '"mass": must be key=value'),
        ("=3", '"=3": must be key=value'),
        ("mass=", 'mass: drive.mass must be a number with its unit, like "10 g", got ""'),
    ],
)
def test_bad_override_is_reported(write: Write, override: str, problem: str) -> None:
    (line,) = problems(write(), override)
    assert line.startswith(f"`overrides` {problem}")


def test_both_dampings_overridden(write: Write) -> None:
    (line,) = problems(write(), "damping=1 N*s/m", "damping_ratio=1")
    assert line.startswith("`overrides` damping: give exactly one of")


def test_unreadable_files(tmp_path: Path) -> None:
    assert problems(tmp_path / "none.toml") == ["FILE: cannot be read: No such file or directory"]
    assert problems(tmp_path)[0].startswith("FILE: cannot be read: ")
    (tmp_path / "empty.toml").write_text(" \n")
    assert problems(tmp_path / "empty.toml")[0].startswith("FILE: is empty")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    assert problems(tmp_path / "bytes.toml") == ["FILE: is not UTF-8 text, at byte 0"]

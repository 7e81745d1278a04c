"""Device files with friction curves, skin and inputs that change: read, refused, written again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from pindrive import Profile
from pindrive.files.device import DeviceFile, load_device
from pindrive.files.overrides import ConfigError

GOOD = Path(__file__).parents[1].joinpath("minimal.toml").read_text(encoding="utf-8")
PLATE, FINGER, SPEED = '"20 mN"', '"5 mN"', '"100 mm/s"'

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a device file, GOOD with texts replaced: old, new, old, new."""

    def write(*replaced: str) -> Path:
        text = GOOD
        for old, new in zip(replaced[::2], replaced[1::2], strict=True):
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "device.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def problems(path: Path, *overrides: str) -> list[str]:
    with pytest.raises(ConfigError) as refused:
        load_device(path, overrides)
    assert not any("\n" in line for line in refused.value.problems)
    return [line.replace(f"{path}: ", "FILE: ") for line in refused.value.problems]


# ---- good files ----------------------------------------------------------------------------------


def test_curve_gives_the_kinetic_friction(write: Write) -> None:
    curve = '[["0 mm/s", "22 mN"], ["5 cm/s", "15 mN"], ["1 m/s", "0 N"]]'
    plate = load_device(write('kinetic = "20 mN"', f"curve = {curve}")).drive.plate
    assert plate.curve == ((0.0, 0.022), (0.05, 0.015), (1.0, 0.0))
    assert plate.kinetic == plate.static_friction == 0.022


def test_kinetic_friction_and_curve_may_agree(write: Write) -> None:
    curve = '\ncurve = [["0 m/s", "0.02 N"], ["1 m/s", "10 mN"]]\nstatic = "30 mN"'
    plate = load_device(write(PLATE, PLATE + curve)).drive.plate
    assert (plate.kinetic, plate.static) == (0.020, 0.030)


def test_skin(write: Write) -> None:
    device = load_device(
        write(FINGER, f'{FINGER}\nstiffness = "1 N/mm"', SPEED, f'{SPEED}\nskin_stretch = "-2 µm"')
    )
    assert device.drive.finger.stiffness == 1000.0
    assert device.release.skin_stretch == -2e-6
    assert device.drive.plate.rigid


@pytest.mark.parametrize("load_of_one", ["1", "1.0", '"100 %"', '"1"'])
def test_a_constant_load(write: Write, load_of_one: str) -> None:
    assert (
        load_device(write(SPEED, f"{SPEED}\nplate_load = {load_of_one}")).release.plate_load == 1.0
    )


def test_inputs_that_change(write: Write) -> None:
    device = load_device(
        write(
            SPEED,
            '[["0 ms", "60 mm/s"], ["40 ms", "0 mm/s"]]\n'
            'plate_load = [["0 ms", 1], ["5 ms", "20 %"]]',
        )
    )
    assert device.release.mouse_velocity == Profile((0.0, 0.04), (0.06, 0.0))
    assert device.release.plate_load == Profile((0.0, 0.005), (1.0, 0.2))
    values = device.values()
    assert values["motion.mouse_velocity"] == ((0.0, 0.06), (0.04, 0.0))
    assert values["motion.plate_load"] == ((0.0, 1.0), (0.005, 0.2))


def test_left_out_is_left_out(write: Write) -> None:
    device = load_device(write())
    assert device.release.plate_load == 1.0
    values = device.values()
    for key in ("plate.curve", "finger.curve", "finger.stiffness", "motion.skin_stretch"):
        assert values[key] is None


OVERRIDES = [
    ("finger.stiffness=800 N/m", "finger.stiffness", 800.0),
    ("plate_load=50 %", "motion.plate_load", 0.5),
    ('plate_load=[["0 ms", 1], ["5 ms", 0.2]]', "motion.plate_load", ((0.0, 1.0), (0.005, 0.2))),
    ('mouse_velocity=[["1 s", "1 m/s"]]', "motion.mouse_velocity", ((1.0, 1.0),)),
    ('plate.curve=[["0 m/s", "20 mN"]]', "plate.curve", ((0.0, 0.020),)),
]


@pytest.mark.parametrize(("override", "key", "value"), OVERRIDES)
def test_overrides(write: Write, override: str, key: str, value: object) -> None:
    assert load_device(write(), [override]).values()[key] == value


def test_file_written_from_its_values_is_equal(write: Write, tmp_path: Path) -> None:
    """To the last bit, through text with units."""
    device = load_device(
        write(), [*(override for override, _, _ in OVERRIDES[::2]), "duration=0.3 s"]
    )
    lines = ""
    for key, value in device.values().items():
        if value is not None and key != "drive.damping_ratio":
            table, _, name = key.partition(".")
            lines += f"{table}.{name} = {_toml(key, value)}\n"
    path = tmp_path / "again.toml"
    path.write_text(lines, encoding="utf-8")
    assert load_device(path).values() == device.values()
    assert load_device(path).drive == device.drive


UNITS = {"preload": "N", "mass": "kg", "damping": "N*s/m", "stiffness": "N/m", "curve": "N",
         "kinetic": "N", "static": "N", "displacement": "m", "duration": "s", "plate_load": "",
         "finger_load": "", "force": "N", "settling_band": "", "touch_share": "",
         "load_exponent": ""}  # fmt: skip


def _toml(key: str, value: object) -> str:
    unit = UNITS.get(key.partition(".")[2], "m/s")
    if isinstance(value, tuple):
        across = "m/s" if "curve" in key else "s"
        return str([[f"{a!r} {across}", f"{b!r} {unit}"] for a, b in value])
    return f"'{value!r} {unit}'"


# ---- mistakes ------------------------------------------------------------------------------------

FALLING = '\ncurve = [["0 mm/s", "20 mN"], ["50 mm/s", "15 mN"]]'
RAMP = f'{SPEED}\nplate_load = [["0 ms", 1], ["5 ms", 0.2]]'


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            SPEED,
            '[["0 ms", "60 mm/s"], ["40 ms", "50 mm/s"], ["20 ms", "0 mm/s"]]',
            "motion.mouse_velocity[2] time must be greater than the one before, 0.04 s",
        ),
        (
            SPEED,
            '[["0 ms", "60 mm/s"], ["0 ms", "0 mm/s"]]',
            "motion.mouse_velocity[1] time must be greater than the one before, 0.0 s "
            "(a jump would take an infinite force), got 0.0 s",
        ),
        (
            SPEED,
            '[["0 ms", "60 mm"]]',
            "motion.mouse_velocity[0] value must be in m/s or a unit alike, "
            'like "0 mm/s", got "60 mm"',
        ),
        (
            SPEED,
            '[["0 ms", "6 mm/s"], ["4 parsec", "0 mm/s"]]',
            "motion.mouse_velocity[1] time must be in s or a unit alike "
            '("parsec" is not a known unit), like "100 ms", got "4 parsec"',
        ),
        (
            SPEED,
            '[["0 ms", "6 mm/s"], [4, "0 mm/s"]]',
            "motion.mouse_velocity[1] time must be a number with its unit "
            '(give a unit, like "100 ms"), got 4',
        ),
        (
            SPEED,
            '[["0 ms", "inf m/s"]]',
            'motion.mouse_velocity[0] value must be finite, got "inf m/s"',
        ),
        (
            SPEED,
            '[["nan s", "1 m/s"]]',
            'motion.mouse_velocity[0] time must be finite, got "nan s"',
        ),
        (
            SPEED,
            '[["0 ms"]]',
            'motion.mouse_velocity[0] must be a time and a value, like "100 ms", "0 mm/s", got [',
        ),
        (
            SPEED,
            '["0 ms", "60 mm/s"]',
            "motion.mouse_velocity[0] must be a time and a value, ",
        ),
        (SPEED, "[]", 'motion.mouse_velocity must be rows, like [["0 ms", "60 mm/s"], ["100 ms",'),
        (
            SPEED,
            f'{SPEED}\nplate_load = [["0 ms", 1], ["5 ms", -0.2]]',
            "motion.plate_load[1] value must be finite and at least 0, got -0.2",
        ),
        (
            SPEED,
            f"{SPEED}\nplate_load = -1",
            "motion.plate_load must be finite and at least 0, got -1",
        ),
        (PLATE, f'{PLATE}\ncurve = "20 mN"', 'plate.curve must be rows, like [["0 mm/s", "22 mN"]'),
        (
            PLATE,
            PLATE + FALLING.replace("15 mN", "-1 mN"),
            'plate.curve[1] force must be finite and at least 0 N, got "-1 mN"',
        ),
        (
            PLATE,
            PLATE + FALLING.replace('"50', '"-50'),
            'plate.curve[1] speed must be finite and at least 0 m/s, got "-50 mm/s"',
        ),
        (
            PLATE,
            PLATE + FALLING.replace('"50', '"0'),
            "plate.curve[1] speed must be greater than the one before, 0.0 m/s, got 0.0 m/s",
        ),
        (
            PLATE,
            PLATE + FALLING.replace('"0 mm/s"', '"1 mm/s"'),
            "plate.curve[0] speed must be 0 m/s, got 0.001 m/s",
        ),
        (
            PLATE,
            PLATE + FALLING.replace("20 mN", "22 mN"),
            "plate.curve[0] force must be the kinetic friction, 0.02 N, got 0.022 N",
        ),
        (
            f"kinetic = {PLATE}",
            FALLING + '\nstatic = "10 mN"',
            "plate.static must be at least the kinetic friction, 0.02 N, got 0.01 N",
        ),
        (
            FINGER,
            FINGER + '\nstiffness = "0 N/m"',
            'finger.stiffness must be finite and greater than 0 N/m, got "0 N/m"',
        ),
        (
            PLATE,
            PLATE + '\nstiffness = "1 N/m"',
            "plate.stiffness cannot be given, the plate is rigid; "
            "skin gives way by finger.stiffness",
        ),
        (
            SPEED,
            SPEED + '\nskin_stretch = "1 µm"',
            "motion.skin_stretch must be left out for a rigid finger, got 1e-06 m",
        ),
        ("kinetic = " + PLATE, "curv = 3", "unknown key plate.curv; did you mean plate.curve?"),
    ],
)
def test_a_mistake_is_one_line(write: Write, old: str, new: str, problem: str) -> None:
    (line,) = problems(write(old, new))
    assert line.startswith(f"FILE: {problem}")


def test_contradictions_are_reported_together(write: Write) -> None:
    skin = FALLING.replace("20 mN", "5 mN") + '\nstiffness = "1000 N/m"'
    stretched = '\nskin_stretch = "-6 µm"'
    path = write(PLATE, PLATE + FALLING, FINGER, FINGER + skin, SPEED, RAMP + stretched)
    assert problems(path) == [
        "FILE: motion.skin_stretch must be at most static friction over stiffness, 5e-06 m, "
        "either way, got -6e-06 m",
    ]


def test_conflict_names_its_origin(write: Write) -> None:
    path = write(PLATE, PLATE + FALLING)
    load_device(path, ['plate_load=[["0 ms", 1], ["5 ms", 2]]'])  # a curve fits a load that changes
    (line,) = problems(path, 'plate.curve=[["0 m/s", "30 mN"]]')
    assert line.startswith("`overrides` plate.curve: plate.curve[0] force must be the kinetic")


@pytest.mark.parametrize(
    ("override", "problem"),
    [
        ("plate_load=[1, 2", "plate_load: motion.plate_load is not valid TOML: "),
        ('plate_load=[["0 ms", 1]]\nx = 3', "plate_load: motion.plate_load is not valid"),
        ("plate_load=[[1, 2]]", "plate_load: motion.plate_load[0] time must be a number"),
        ('mass=["1 g"]', "mass: drive.mass must be a number with its unit"),
        ("curve=3", "curve: curve may be plate.curve or finger.curve; give it in full"),
    ],
)
def test_bad_override_is_reported(write: Write, override: str, problem: str) -> None:
    (line,) = problems(write(), override)
    assert line.startswith(f"`overrides` {problem}")


def test_equal_rows_are_a_constant_load(write: Write) -> None:
    device: DeviceFile = load_device(
        write(PLATE, PLATE + FALLING), ['plate_load=[["0 ms", 1], ["5 ms", 1]]']
    )
    assert device.release.plate_load == Profile((0.0, 0.005), (1.0, 1.0))

"""Device files of whole devices, and the command that scans with them."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from command import GOOD, refused, run
from pindrive.device import Coil, ControlBlock, Electromagnet, PinArray, scan
from pindrive.device.reading import Reading
from pindrive.files.device import load_device
from pindrive.files.keys import WHOLE, template
from pindrive.files.overrides import ConfigError

pytestmark = pytest.mark.usefixtures("in_empty_folder")

COIL = """
turns = 300
pole_area = "6 mm^2"
gap = "60 um"
wire_diameter = "0.1 mm"
turn_length = "16 mm"
supply_voltage = "3 V"
thermal_resistance = "100 K/W"
"""

SHEET = """
hold_force = "1 N"
resistance = "25 ohm"
inductance = "25 mH"
supply_voltage = "5 V"
"""

Write = Callable[[str], Path]


@pytest.fixture
def write() -> Write:
    """Write the plain drive with more tables after it."""

    def write(more: str) -> Path:
        path = Path("device.toml")
        path.write_text(GOOD + more, encoding="utf-8")
        return path

    return write


# ---- files ---------------------------------------------------------------------------------------


def test_plain_drive_has_no_device_around_it_by_default(write: Write) -> None:
    assert load_device(write("")).whole is None
    whole = load_device(write(""), whole=True)
    assert whole.whole
    device = whole.device
    assert device.array == PinArray()
    assert device.control == ControlBlock()
    assert device.magnet == Electromagnet.from_times()
    assert whole.reading == Reading()


def test_every_table_is_read(write: Write) -> None:
    more = f"""
[magnet]
residual = "10 mN"
{COIL}
[control]
sample_rate = "2 kHz"
latency = "3 ms"
threshold = "40 %"
[array]
places = [["0 mm", "0 mm"], ["2 mm", "-1 mm"]]
axis = "10 deg"
[scan]
hand_speed = "80 mm/s"
line_pitch = "15 mm"
"""
    file = load_device(write(more))
    assert file.whole
    device, reading = file.device, file.reading

    assert isinstance(device.magnet.coil, Coil)
    assert device.magnet.coil.turns == 300.0
    assert device.magnet.residual == 0.010
    assert device.control == ControlBlock(sample_rate=2000.0, latency=0.003, threshold=0.4)
    assert device.array.places == ((0.0, 0.0), (0.002, -0.001))
    assert device.array.axis == radians(10.0)
    assert (reading.hand_speed, reading.line_pitch) == (0.08, 0.015)
    checked = run("check", "device.toml")
    assert checked.exit_code == 0, checked.output
    assert "magnet.turns" in checked.stdout
    assert "Its coil: 10.54 ohm, 5.655 mH, 284.7 mA, 0.8541 W; on for 23%" in checked.stdout


def test_release_has_the_speed_of_the_hand_by_default(write: Write) -> None:
    bare = GOOD.replace('mouse_velocity = "100 mm/s"', "")
    assert bare != GOOD
    path = Path("bare.toml")
    path.write_text(bare + '\n[scan]\nhand_speed = "70 mm/s"\n', encoding="utf-8")
    assert load_device(path).release.mouse_velocity == 0.07
    assert load_device(write('\n[scan]\nhand_speed = "70 mm/s"\n')).release.mouse_velocity == 0.1
    path.write_text(bare, encoding="utf-8")
    with pytest.raises(ConfigError, match=r"motion.mouse_velocity is missing"):
        load_device(path)


def test_template_of_a_whole_device_has_the_defaults(write: Write) -> None:
    Path("new.toml").write_text(template(whole=True), encoding="utf-8")
    new, plain = load_device("new.toml").whole, load_device(write(""), whole=True).whole
    assert new
    assert plain
    reported = {key for key, value in new.in_si().items() if value != plain.in_si()[key]}
    sizes = {"magnet.outer_diameter", "magnet.height", "array.slot_length"}
    sizes |= {"magnet.spring_height", "magnet.pin_height"}
    assert reported == {"array.columns", "array.rows", "array.spot_scale", *sizes}


CLOSING = {"lift": "0.05 mm", "closing_force": "20 mN"}
PULSES = 'pwm_frequency = "1 kHz"\npwm_duty = 0.4'


@pytest.mark.parametrize("key", WHOLE)
def test_every_key_takes_its_usual_value_and_no_nonsense(write: Write, key: str) -> None:
    table, _, name = key.partition(".")
    quantity = WHOLE[key]
    alone = name not in {line.partition(" ")[0] for line in COIL.splitlines()}
    coil = (
        SHEET
        if name in ("resistance", "inductance", "hold_current")
        else COIL
        if name
        in (
            *("release_resistance", "saturation_field", "thermal_resistance", "heat_capacity"),
            *("temperature_rise", "voltage", *CLOSING),
        )
        or not alone
        else PULSES
        if name in ("pwm_frequency", "pwm_duty")
        else ""
    )
    if name in CLOSING:
        coil += "".join(f'{key} = "{value}"\n' for key, value in CLOSING.items())
    coil = "\n".join(line for line in coil.splitlines() if not line.startswith(f"{name} "))
    value = f'"{quantity.usual}"' if quantity.unit != "1" else quantity.usual
    if name == "places":
        value = '[["0 mm", "1 mm"], ["1 mm", "0 mm"]]'
    if name == "voltage":
        value = '[["0 ms", "1 V"], ["5 ms", "0.5 V"]]'
    path = write(f"\n[{table}]\n{coil}\n{name} = {value}\n")
    if name == "touch":  # of a finger with a coefficient
        pressed = 'coefficient = 0.5\ntouch_force = "10 mN"'
        path.write_text(path.read_text("utf-8").replace('kinetic = "5 mN"', pressed), "utf-8")
    assert load_device(path).whole
    with pytest.raises(ConfigError) as error:
        load_device(write(f'\n[{table}]\n{coil}\n{name} = "three"\n'))
    assert any(f"device.toml: {key} must be" in line for line in error.value.problems)


MISTAKES = {
    '[magnet]\nhold_force = "-1 N"': (
        'magnet.hold_force must be finite and at least 1e-6 N and at most 10000 N, got "-1 N"'
    ),
    '[magnet]\nresidual = "4 N"': (
        "magnet.residual must be less than the hold force, 1.0 N, got 4.0 N"
    ),
    f'[magnet]\nhold_force = "1 N"\n{COIL}': (
        "magnet.hold_force must be left out where turns describes the coil, got both, hold_force "
        "and turns"
    ),
    "[magnet]\nturns = 3": "magnet.turns must be given with pole_area, gap, wire_diameter, ",
    '[magnet]\nforce = "1 N"': "unknown key magnet.force; did you mean magnet.hold_force or "
    "motion.force?",
    "[control]\nthreshold = 1.5": "control.threshold must be finite and at least 0 and at most 1",
    "[control]\nthreshold = 0.01": (
        "control.hysteresis must be at most 0.02 about a threshold of 0.01, got 0.1"
    ),
    '[control]\nsample_rate = "0 Hz"': (
        'control.sample_rate must be finite and at least 0.1 Hz and at most 1e6 Hz, got "0 Hz"'
    ),
    '[control]\nlatency = "3 mm"': 'control.latency must be in s or a unit alike, like "5 ms"',
    "[array]\ncolumns = 2.5": "array.columns must be a whole number, got 2.5",
    '[array]\nplaces = [["1 mm", "2 mm"], ["0 mm", "0 mm"], ["1 mm", "2 mm"]]': (
        "array.places must be places of their own, got pins 0 and 2 both at (0.001 m, 0.002 m)"
    ),
    '[array]\nrows = 2\nplaces = [["1 mm", "2 mm"]]': (
        "array.places must be left out where columns, rows or pitch are given, got it beside"
    ),
    "[array]\nplaces = []": "array.places must be rows, like ",
    '[array]\nplaces = [["1 mm"]]': "array.places[0] must be a x and a y, like ",
    '[scan]\nmax_angle = "91 deg"': "scan.max_angle must be finite and at least 0 rad and at most",
    '[scna]\nhand_speed = "1 m/s"': "unknown key scna; did you mean scan?",
}


@pytest.mark.parametrize("more", MISTAKES)
def test_a_mistake_is_one_line(write: Write, more: str) -> None:
    assert refused("check", write(f"\n{more}\n")).startswith(f"device.toml: {MISTAKES[more]}")


def test_mistakes_in_the_drive_and_around_it_are_found_in_one_pass(write: Write) -> None:
    path = write('\n[magnet]\nhold_force = "-1 N"\n[scan]\npause = 3\n')
    path.write_text(
        GOOD.replace('mass = "10 g"', 'mass = "10 s"', 1) + path.read_text()[len(GOOD) :]
    )
    with pytest.raises(ConfigError) as error:
        load_device(path)
    keys = [line.split()[1] for line in error.value.problems]
    assert keys == ["drive.mass", "magnet.hold_force", "scan.pause"]


def test_a_plate_must_let_a_magnet_hold(write: Write) -> None:
    path = write("")
    assert 'kinetic = "20 mN"' in GOOD
    path.write_text(GOOD.replace('kinetic = "20 mN"', 'kinetic = "0 N"', 1), encoding="utf-8")
    assert run("check", path).exit_code == 0, "a plain drive may do without"
    line = refused("scan", path, "--text", "A")
    assert line == (
        "device.toml: plate.kinetic must be greater than 0 N where a magnet holds by friction, "
        "got 0.0 N"
    )


# ---- scans ---------------------------------------------------------------------------------------


@pytest.fixture
def device() -> Path:
    assert run("init", "device.toml", "--device").exit_code == 0
    return Path("device.toml")


def test_scan_of_a_letter(device: Path) -> None:
    result = run("scan", device, "--text", "A", "-o", "a.nc")
    assert result.exit_code == 0, result.output
    (line,) = result.stderr.splitlines()
    assert line.startswith("warning: the pins push the hand with up to 1.26 N, more than 0.77 N")
    assert "The pins push the hand with up to 1.26 N (at " in result.stdout
    assert "Wrote a.nc" in result.stdout
    assert "The hand's path takes " in result.stdout
    reported = xr.load_dataset("a.nc", engine="h5netcdf")
    assert dict(reported.sizes)["pin"] == 16
    file = load_device(device)
    assert file.whole
    whole, reading = file.device, file.reading
    scene = reading.text("A", whole.array)
    done = scan(whole, scene, reading.strokes(scene, whole.array))
    xr.testing.assert_identical(reported, done.to_dataset())
    for name in ("position", "velocity", "finger_force", "luminance", "current", "pull", "hand_x"):
        assert reported[name].attrs["units"]
        assert reported[name].attrs["long_name"]
    assert set(reported.event_kind.values) == {e.kind for pin in done.pins for e in pin.events}
    for pin in done.pins:
        rows = reported.event_pin == pin.number
        assert reported.event_time[rows].values.tolist() == [e.time for e in pin.events]
        rows = reported.switching_pin == pin.number
        assert (reported.switching_time[rows] == pin.commands.times).all()
        assert reported.switching_on[rows].values.tolist() == [True, False] * (int(rows.sum()) // 2)


def test_numbers_are_exact(device: Path) -> None:
    """Against the densest samples: never below, and above by no more than they miss."""
    assert run("scan", device, "--text", "VA", "-o", "a.nc", "--set", "columns=2").exit_code == 0
    reported = xr.load_dataset("a.nc", engine="h5netcdf")
    file = load_device(device, ["columns=2"])
    assert file.whole
    whole, reading = file.device, file.reading
    scene = reading.text("VA", whole.array)
    done = scan(whole, scene, reading.strokes(scene, whole.array))
    t = np.linspace(done.path.begin, done.path.end, 100_001)
    for pin in done.pins:
        numbers = reported.isel(pin=pin.number)
        x, force = np.abs(pin.position(t)).max(), np.abs(pin.skin_force(t)).max()
        assert x <= float(numbers.pin_peak_displacement) <= x + 1e-9
        assert force <= float(numbers.pin_peak_skin_force) * (1 + 1e-12)
        assert float(numbers.pin_energised) == sum(b - a for a, b in pin.energised)
        assert int(numbers.pin_switchings) == len(pin.energised)


def test_other_scenes_and_paths(device: Path) -> None:
    Image.fromarray(np.tile(np.repeat([255, 0, 255], 100).astype(np.uint8), (200, 1))).save("p.png")
    assert run("scan", device, "--image", "p.png", "--set", "pixel=0.1 mm").exit_code == 0
    assert run("scan", device, "--grating", "4 mm, 2 mm").exit_code == 0
    assert run("scan", device, "--text", "A\\nB").exit_code == 0
    rows = [f"{0.01 * i},{10 + 0.3 * i},10" for i in range(31)]
    Path("hand.csv").write_text("\n".join(["time [s], x [mm], y [mm]", *rows]))
    result = run("scan", device, "--image", "p.png", "--set", "pixel=0.1 mm", "--path", "hand.csv")
    assert result.exit_code == 0
    assert "The hand's path takes 0.3 s, at 30.00 mm/s at the most" in result.stdout


def test_line_by_line_over_an_image() -> None:
    from pindrive.device import Scene

    page = Scene(np.ones((1000, 400)), 1e-4)
    array = PinArray.grid(4, 4, 0.0025)
    path = Reading(line_pitch=0.03).strokes(page, array)
    rows = np.unique(np.round(path.y[np.abs(path.vy) + np.abs(path.vx) == 0.0], 9))
    assert rows == pytest.approx([0.005, 0.035, 0.065, 0.095])
    assert Reading().strokes(page, array).y == pytest.approx(0.05)
    assert path.x.min() == pytest.approx(0.00375)
    assert path.x.max() == pytest.approx(0.04 - 0.00375)
    with pytest.raises(ValueError, match=r"the spots of the array must be smaller than a scene, "):
        Reading().strokes(page, PinArray.grid(20, 1, 0.0025))


REFUSALS = {
    (): "give exactly one of --text, --image and --grating, got none of them",
    ("--text", "A", "--grating", "4 mm"): (
        "give exactly one of --text, --image and --grating, got --text and --grating"
    ),
    ("--text", " "): 'text must be at least one character that is drawn, got " "',
    ("--image", "none.png"): "none.png: cannot be read: No such file or directory",
    ("--image", "device.toml"): "device.toml: cannot be read: it is not an image, or it is damaged",
    (
        "--grating",
        "4",
    ): '--grating: pitch must be a number with its unit (give a unit, like "4 mm")',
    ("--grating", "4 mm", "--font", "x.ttf"): "--font x.ttf: goes with --text alone",
    ("--text", "A", "--path", "none.csv"): "none.csv: cannot be read: No such file or directory",
    ("--text", "A", "-o", "device.toml"): ("-o device.toml: must end in .csv, .nc, .json"),
    ("--text", "A", "-o", "nowhere/a.nc"): "nowhere/a.nc: cannot be written: No such file or",
}


@pytest.mark.parametrize("arguments", REFUSALS, ids=" ".join)
def test_refusals(device: Path, arguments: tuple[str, ...]) -> None:
    assert refused("scan", device, *arguments).startswith(REFUSALS[arguments])


def test_warnings_are_printed_beside_the_report(device: Path) -> None:
    result = run("scan", device, "--text", "A", "--set", "sample_rate=200 Hz")
    assert result.exit_code == 0
    line, of_hand = result.stderr.splitlines()
    assert "the hand would give way" in of_hand
    assert line.startswith("warning: control.sample_rate = 200 Hz samples every 0.3 mm at 60 mm/s")
    assert line.endswith("600 Hz sees each")


def test_a_magnet_that_would_be_too_hot_is_warned_of(write: Write) -> None:
    path = write(f'\n[magnet]\n{COIL}\ntemperature_rise = "1 K"\n')
    result = run("scan", path, "--grating", "8 mm")
    assert result.exit_code == 0
    (line,) = result.stderr.splitlines()
    assert line == ("warning: a magnet is on for 23% of the time; 0.854 W warm it by 1 K at 1%")


def test_a_table_of_pins_cuts_no_number_off(device: Path) -> None:
    """The longest numbers, of pins that hardly move, are complete."""
    result = run("scan", device, "--grating", "4 mm", "--set", "hold_force=1 mN")
    assert result.exit_code == 0
    assert "…" not in result.stdout
    assert "A magnet does not carry its pin: it holds with 19.12 mN of friction" in result.stdout
    title = run("scan", device, "--text", r"a\nb").stdout.splitlines()[0]
    assert title.strip() == 'Pins, over text "a / b"'

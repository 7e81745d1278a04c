"""Whole devices as functional mock-up units: the command of the magnet, and every key."""

from __future__ import annotations

import sys
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from command import run
from fmu_unit import Unit, unpacked
from pindrive import (
    Function,
    InputPiece,
    Page,
    Profile,
    Release,
    Scan,
    load_device,
    scan,
    simulate,
)
from pindrive.device.current import CoilState, Commands
from pindrive.files.device import DeviceFile
from pindrive.files.fmu import ELSEWHERE, inputs_of, variables_of
from pindrive.files.keys import FILE_KEYS
from pindrive.motion.function import function_of
from pindrive.motion.release import INPUTS
from random_scans import sampled

READER = Path(__file__).resolve().parents[2] / "examples" / "tactile-reader.toml"
COIL = """
turns = 250
pole_area = "3 mm^2"
gap = "0.05 mm"
wire_diameter = "0.1 mm"
turn_length = "8.5 mm"
supply_voltage = "1 V"
release_resistance = "2 ohm"
saturation_field = "0.5 T"
"""
OPENING = 'lift = "0.05 mm"\nclosing_force = "100 mN"\n'
MAGNETS = {
    "times": 'hold_force = "1 N"\nresidual = "20 mN"\nsaturation = 0.8',
    "pulses": 'hold_force = "1 N"\npwm_frequency = "400 Hz"\npwm_duty = 0.6',
    "data sheet": 'hold_force = "1 N"\nresistance = "25 ohm"\ninductance = "25 mH"\n'
    'supply_voltage = "5 V"\nhold_current = "0.2 A"\nrelease_resistance = "10 ohm"',
    "coil": COIL + 'thermal_resistance = "400 K/W"',
    "steps": COIL + 'voltage = [["0 ms", "1 V"], ["6 ms", "0.4 V"], ["15 ms", "0.2 V"]]',
    "warm": COIL + 'heat_capacity = "0.4 mJ/K"\ntemperature_rise = "20 K"',
    "warm pulses": COIL + 'heat_capacity = "0.4 mJ/K"\npwm_frequency = "300 Hz"\npwm_duty = 0.7',
    "closing": COIL + OPENING + 'residual = "20 mN"',
    "closing steps": COIL
    + OPENING
    + 'voltage = [["0 ms", "1 V"], ["6 ms", "0.5 V"], ["15 ms", "0.2 V"]]',
    "closing warm pulses": COIL
    + OPENING
    + 'heat_capacity = "0.4 mJ/K"\npwm_frequency = "300 Hz"\npwm_duty = 0.7',
}
DEVICE = """
[device]
name = "one pin of a reader"

[drive]
mass = "1 g"
stiffness = "250 N/m"
damping_ratio = 0.5

[plate]
coefficient = 0.225
static_coefficient = 0.27
preload = "5 mN"
touch_share = 0.6

[finger]
coefficient = 0.5
static_coefficient = 0.6
touch_force = "30 mN"
load_exponent = 0.8
reference_touch = "60 mN"

[motion]
displacement = "0 mm"
velocity = "0 mm/s"

[magnet]
{magnet}

[array]
pin_diameter = "1.5 mm"
"""


@cache
def scanned(magnet: str, folder: Path) -> tuple[DeviceFile, Scan]:
    """Return a device with that magnet, and one pin of its scan over two lines."""
    path = folder / "device.toml"
    path.write_text(DEVICE.format(magnet=MAGNETS[magnet]), "utf-8")
    device = load_device(path, {"scan.hand_speed": "90 mm/s"})
    along = scan(device, Page(grating=["5 mm"]))  # the inputs of an FMU are rows
    return device, scan(device, along.scene, sampled(along.path))


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("magnet", MAGNETS)
def test_commands_lead_to_what_a_scan_has(
    magnet: str, version: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Under the scan's hand and commands, in steps of random length, with states gone back to."""
    folder = tmp_path_factory.getbasetemp() / magnet.replace(" ", "-")
    folder.mkdir(exist_ok=True)
    device, scanned_page = scanned(magnet, folder)
    (pin,) = scanned_page.pins
    hand = pin.release.mouse_velocity
    assert isinstance(hand, Profile) and len(pin.commands.times) >= 4
    crossings = pin.current.starts == device.device.magnet.closing.flux
    assert crossings.sum() >= 4 or "closing" not in magnet
    archive = folder / f"fmi{version}.fmu"
    unit = Unit(*unpacked(device, archive, version)).begin(mouse_velocity=0.0)
    assert validate_fmu(str(archive)) == []
    random = np.random.default_rng(3)
    times = np.array(hand.times)
    switchings = pin.commands.times - pin.begin
    stops = np.unique([*times, *switchings, pin.end - pin.begin])
    sample_times = np.linspace(pin.begin, pin.end, 500)
    size, fastest = (np.abs(f(sample_times)).max() for f in (pin.position, pin.velocity))
    worst, astray, on = 0.0, 0, False
    for begin, end in zip([0.0, *stops], stops, strict=False):
        if end <= begin:
            continue
        i = np.searchsorted(times, begin, "right") - 1
        if i >= 0 and i + 1 < len(times):
            rate = (hand.values[i + 1] - hand.values[i]) / (times[i + 1] - times[i])
            unit.set(mouse_velocity=hand(begin), mouse_velocity_rate=rate)
        if begin in switchings:
            on = not on
            unit.command(magnet_on=on)
        assert unit.commanded("magnet_on") == on
        unit.step(random.uniform(begin, end))
        if random.integers(10) == 0:
            pulled = unit.get("magnet_pull")
            with unit.astray(random, "position", "velocity", "magnet_pull", "magnet_current"):
                unit.command(magnet_on=not on)
                unit.step(unit.time + 0.004)
                assert unit.get("magnet_pull") != pulled
            astray += 1
        unit.step(end)
        x, v, pull, current = unit.get("position", "velocity", "magnet_pull", "magnet_current")
        load = pin.release.plate_load
        assert isinstance(load, Function)
        normal_force = device.drive.normal_force
        assert pull == pytest.approx((load(end) - 1.0) * normal_force, abs=1e-12 * size + 1e-13)
        assert current == pytest.approx(pin.current(end + pin.begin), rel=1e-12, abs=1e-15)
        if "warm" in magnet:
            (warming,) = unit.get("magnet_warming")
            (expected,) = pin.current.warming([end + pin.begin])
            assert warming == pytest.approx(expected, rel=1e-11, abs=1e-12)
        worst = max(
            worst,
            abs(x - pin.position(end + pin.begin)) / size,
            abs(v - pin.velocity(end + pin.begin)) / fastest,
        )
    print(f"{magnet}, FMI {version}: within {worst:.1e}, {astray} states gone back to")
    assert worst < 1e-12 and astray > 5


@pytest.mark.parametrize("version", [2, 3])
def test_a_touch_that_changes_presses_on_the_plate_too(version: int, tmp_path: Path) -> None:
    """Its friction follows by the exponent, and the load of the plate by its share."""
    device, usual = scanned("times", tmp_path)
    touch = Profile([0.0, 0.2, 0.35, 0.5], [0.030, 0.010, 0.050, 0.040])
    (pin,) = scan(device, usual.scene, usual.path, touch=touch).pins
    hand, load = pin.release.mouse_velocity, pin.finger_load
    assert isinstance(hand, Profile) and isinstance(load, Profile)
    unit = Unit(*unpacked(device, tmp_path / "pin.fmu", version)).begin(mouse_velocity=0.0)
    switchings = pin.commands.times - pin.begin
    stops, on = np.unique([*hand.times, *load.times, *switchings, pin.end - pin.begin]), False
    size = np.abs(pin.position(np.linspace(pin.begin, pin.end, 500))).max()
    for begin, end in pairwise(stops):
        given: dict[str, float] = {}
        for name, rows in (("mouse_velocity", hand), ("finger_load", load)):
            ahead = rows(0.5 * (begin + end)) - rows(begin)
            given |= {name: rows(begin), f"{name}_rate": 2.0 * ahead / (end - begin)}
        unit.set(**given)
        if begin in switchings:
            on = not on
            unit.command(magnet_on=on)
        unit.step(end)
        assert unit.get("position")[0] == pytest.approx(pin.position(end), abs=1e-9 * size)
    assert len(pin.events) > 8


@pytest.mark.parametrize("version", [2, 3])
def test_luminance_leads_to_what_a_scan_has(
    version: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """The unit's control block samples its input, which holds between steps of any length."""
    folder = tmp_path_factory.getbasetemp() / "times"
    folder.mkdir(exist_ok=True)
    device, scanned_page = scanned("times", folder)
    (pin,) = scanned_page.pins
    hand = pin.release.mouse_velocity
    assert isinstance(hand, Profile) and pin.begin == 0.0 and len(pin.commands.times) >= 4
    archive = folder / f"control{version}.fmu"
    unit = Unit(*unpacked(device, archive, version, control=True)).begin(mouse_velocity=0.0)
    assert validate_fmu(str(archive)) == []
    random = np.random.default_rng(4)
    times, black = np.array(hand.times), dict(zip(pin.sample_times, pin.luminance, strict=True))
    size = np.abs(pin.position(np.linspace(0.0, pin.end, 500))).max()
    worst, astray = 0.0, 0
    stops = np.unique([*times, *black, pin.end])
    for begin, end in pairwise(stops):
        i = np.searchsorted(times, begin, "right") - 1
        rate = (hand.values[i + 1] - hand.values[i]) / (times[i + 1] - times[i])
        unit.set(mouse_velocity=hand(begin), mouse_velocity_rate=rate)
        if begin in black:
            unit.set(luminance=black[begin])
        unit.step(random.uniform(begin, end))
        if random.integers(50) == 0:
            with unit.astray(random, "position", "velocity", "magnet_pull", "luminance"):
                unit.set(luminance=random.uniform(0.0, 1.0))
                unit.step(unit.time + 0.02)
            astray += 1
        unit.step(end)
        (x,) = unit.get("position")
        worst = max(worst, abs(x - pin.position(end)) / size)
    print(f"luminance, FMI {version}: within {worst:.1e}, {astray} states gone back to")
    assert worst < 1e-12 and astray > 5
    assert size > 1e-4


def test_the_next_event_is_not_beyond_a_switching(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """The pin rests; what comes next is the command that follows the next sample."""
    folder = tmp_path_factory.getbasetemp() / "times"
    folder.mkdir(exist_ok=True)
    device, _ = scanned("times", folder)
    latency = device.device.control.latency
    unit = Unit(*unpacked(device, folder / "next.fmu", 3, control=True)).begin(mouse_velocity=0.0)
    assert unit.get("next_event_time") == [sys.float_info.max]
    unit.step(0.0015)
    unit.set(luminance=0.0)
    assert unit.get("next_event_time") == [pytest.approx(0.002 + latency, rel=1e-12)]
    unit.step(0.0045)
    assert unit.get("next_event_time") == [pytest.approx(0.002 + latency, rel=1e-12)]


def test_luminance_is_checked(
    tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path_factory.getbasetemp() / "times"
    folder.mkdir(exist_ok=True)
    device, _ = scanned("times", folder)
    unit = Unit(*unpacked(device, folder / "checked.fmu", 3, control=True)).begin()
    with pytest.raises(FMICallException):
        unit.set(luminance=1.5)
    assert "luminance must be from 0 to 1, not 1.5" in capsys.readouterr().out
    alone = load_device(READER.parent / "stribeck-skin.toml")
    with pytest.raises(ValueError, match="where a unit has the control block, got a drive"):
        variables_of(alone, control=True)


def test_steps_end_early_under_a_command(tmp_path: Path) -> None:
    """At each event of a contact, and what is said of the next one is never too late."""
    device, _ = scanned("times", tmp_path)
    unit = Unit(
        *unpacked(device, tmp_path / "pin.fmu", 3), eventModeUsed=True, earlyReturnAllowed=True
    )
    unit.begin(mouse_velocity=0.05)
    unit.slave.enterStepMode()
    unit.command(magnet_on=True)
    found: list[float] = []
    while unit.time < 0.05:
        before = unit.time
        (known,) = unit.get("next_event_time")
        assert known > before
        happens, _, early, time = unit.step(0.05)
        assert early == (time < 0.05) and time >= min(known, 0.05)
        if happens:
            found.append(time)
            unit.slave.enterEventMode()
            *_, defined, following = unit.slave.updateDiscreteStates()
            assert not defined or following > time
            unit.slave.enterStepMode()
    magnet = device.device.magnet
    current = magnet.current(Commands(np.array([0.0])), CoilState(-1e-9), end=0.06)
    pull = function_of(current.pulls, "N")
    per_newton = device.device.load(1.0) - 1.0
    load = Function(
        [
            InputPiece(
                piece.begin,
                (1.0 + per_newton * piece.polynomial[0],),
                tuple(each._replace(cosine=per_newton * each.cosine) for each in piece.terms),
            )
            for piece in pull.pieces
        ]
    )
    release = Release(0.05, 0.0, 0.0, load)
    events = simulate(device.drive, release, duration=0.05).events
    assert found == pytest.approx([e.time for e in events if e.time > 0.0], rel=1e-9)


# Between them the files give every key that a motion depends on, each by another way than the rest.
FORCES = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping = "0.4 N*s/m"
travel = "5 mm"
stop_stiffness = "1 kN/m"
stop_damping = "0.1 N*s/m"

[plate]
{plate}

[finger]
{finger}

[motion]
mouse_velocity = "60 mm/s"
displacement = "1 mm"
velocity = "10 mm/s"
plate_load = 1.5
force = "1 mN"
across_velocity = "1 mm/s"
finger_load = 1.0
"""
CURVE, COEFFICIENTS_CURVE = (
    '[["0 mm/s", "20 mN"], ["50 mm/s", "15 mN"]]',
    '[["0 mm/s", 0.3], ["50 mm/s", 0.2]]',
)
LAW = 'law = "stribeck"\nbreakaway = "30 mN"\nstribeck_velocity = "30 mm/s"\nexponent = 2'
LAW_BY_COEFFICIENT = LAW.replace('breakaway = "30 mN"', "breakaway_coefficient = 0.5")
FILES = (
    FORCES.format(
        plate='kinetic = "20 mN"\nstatic = "25 mN"',
        finger='kinetic = "5 mN"\nstatic = "6 mN"\nstiffness = "300 N/m"\ndamping = "0.3 N*s/m"',
    )
    + 'skin_stretch = "0.001 mm"',
    FORCES.format(
        plate=f'static = "25 mN"\ncurve = {CURVE}', finger=f'static = "25 mN"\ncurve = {CURVE}'
    ),
    FORCES.format(
        plate=f"static_coefficient = 0.4\ncoefficient_curve = {COEFFICIENTS_CURVE}",
        finger=f'touch_force = "1 N"\ncoefficient_curve = {COEFFICIENTS_CURVE}',
    ),
    FORCES.format(
        plate='kinetic = "20 mN"\nviscous = "20 mN*s/m"\n' + LAW,
        finger='kinetic = "5 mN"\nviscous = "20 mN*s/m"\n' + LAW,
    ),
    FORCES.format(
        plate='coefficient = 0.4\nviscous_coefficient = "0.1 s/m"\n' + LAW_BY_COEFFICIENT,
        finger='touch_force = "1 N"\ncoefficient = 0.4\nviscous_coefficient = "0.1 s/m"\n'
        + LAW_BY_COEFFICIENT,
    ),
    DEVICE.format(magnet=MAGNETS["data sheet"]),
    DEVICE.format(magnet=MAGNETS["times"] + '\npwm_frequency = "1 kHz"\npwm_duty = 0.5'),
    DEVICE.format(magnet=MAGNETS["closing steps"] + '\nheat_capacity = "1 J/K"'),
)


def test_every_key_of_the_table_is_a_variable(tmp_path: Path) -> None:
    """By its own name and with the file's value in SI, or it stands in the list of reasons."""
    path, seen = tmp_path / "device.toml", set()
    for text in FILES:
        path.write_text(text, "utf-8")
        device = load_device(path)
        variables = {v.name: v for v in variables_of(device)}
        values = device.values()
        for key in FILE_KEYS:
            table, _, name = key.partition(".")
            value = values.get(key)
            if table == "motion" and name in inputs_of(device):
                assert variables[name].kind == "input" and variables[name].start == value
                assert variables[f"{name}_rate"].kind == "input"
                seen.add(key)
            elif key in variables:
                assert variables[key].kind == "parameter"
                assert variables[key].start == value or (value is None and "static" in name)
                seen.add(key)
            elif isinstance(value, tuple) and key not in device.derived:
                rows = [v.start for n, v in variables.items() if n.startswith(f"{key}.")]
                assert rows == [number for row in value for number in row]
                seen.add(key)
            else:
                assert (
                    value is None
                    or key in {*device.derived, *ELSEWHERE, "motion.plate_load"}
                    or table in ELSEWHERE
                    or (device.whole and table == "magnet" and device.whole.magnet().coil)
                    or (name in ("kinetic", "coefficient") and f"{table}.curve" in str(variables))
                    or values.get(f"{table}.coefficient_curve")
                    or values.get(f"{table}.curve")
                ), key
    assert {f"motion.{name}" for name in INPUTS} <= seen
    left_out = {key for key in FILE_KEYS if key in ELSEWHERE or key.partition(".")[0] in ELSEWHERE}
    assert seen == FILE_KEYS.keys() - left_out


@pytest.mark.parametrize("version", [2, 3])
def test_a_parameter_does_what_the_key_does(version: int, tmp_path: Path) -> None:
    """Set by an importer or in the device file, the parameter gives one motion."""
    device, _ = scanned("times", tmp_path)
    path = tmp_path / "steps.toml"
    path.write_text(DEVICE.format(magnet=MAGNETS["warm"] + "\n" + OPENING), "utf-8")
    changes: list[tuple[DeviceFile, dict[str, float]]] = [
        (
            device,
            {
                "drive.mass": 0.0012,
                "drive.damping_ratio": 0.3,
                "plate.coefficient": 0.2,
                "plate.static_coefficient": 0.25,  # the file would keep its ratio
                "plate.preload": 0.02,
                "plate.touch_share": 0.3,
                "finger.touch_force": 0.01,
                "finger.load_exponent": 0.7,
                "finger.reference_touch": 0.1,
                "motion.displacement": 0.0002,
                "magnet.hold_force": 0.7,
                "magnet.rise_time": 0.004,
                "magnet.fall_time": 0.003,
                "magnet.saturation": 0.6,
                "magnet.residual": 0.03,
            },
        ),
        (
            load_device(path),
            {
                "magnet.turns": 200.0,
                "magnet.gap": 4e-5,
                "magnet.supply_voltage": 1.4,
                "magnet.saturation_field": 0.4,
                "magnet.release_resistance": 5.0,
                "magnet.heat_capacity": 1e-3,
                "magnet.lift": 3e-5,
                "magnet.closing_force": 0.05,
            },
        ),
    ]
    for of, values in changes:
        ends: list[float] = []
        for file, start in ((of, values), (load_device(of.path, values), {})):
            archive = tmp_path / f"{of.path.stem}-{len(ends)}.fmu"
            unit = Unit(*unpacked(file, archive, version))
            started = {key.replace(".", "__"): value for key, value in start.items()}
            unit.begin(mouse_velocity=0.05, **started)
            for until in (0.011, 0.023, 0.031, 0.06):
                unit.command(magnet_on=until < 0.03)
                unit.step(until)
                ends += unit.get("position", "velocity", "plate_force", "magnet_pull")
        first, second = ends[:16], ends[16:]
        assert first == pytest.approx(second, rel=1e-11, abs=1e-15)
    unit = Unit(*unpacked(device, tmp_path / "pin.fmu", version))
    with pytest.raises(FMICallException):
        unit.begin(magnet__saturation=0.0)


@pytest.mark.parametrize("version", [2, 3])
def test_derivatives_along_what_presses(
    version: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    device, _ = scanned("times", tmp_path)
    unit = Unit(*unpacked(device, tmp_path / "pin.fmu", version))
    if version == 2:
        unit.slave.setupExperiment(startTime=0.0)
    unit.slave.enterInitializationMode()
    unit.set(mouse_velocity=0.05)
    for name, size in (
        ("drive.mass", 1e-3),
        ("plate.preload", 0.01),
        ("plate.coefficient", 0.2),
        ("magnet.residual", 0.02),
    ):
        (at,) = unit.slave.getReal([unit.numbers[name]]) if version == 2 else unit.get(name)
        key = name.replace(".", "__")
        ends: list[float] = []
        for value in (at - 1e-4 * size, at + 1e-4 * size):
            unit.set(**{key: value})
            ends += unit.get("plate_force")
        unit.set(**{key: at})
        slope = (ends[1] - ends[0]) / (2e-4 * size)
        assert slope > 0.01
        assert unit.derivative("plate_force", **{key: 1.0}) == pytest.approx(slope, rel=1e-6)
    assert unit.derivative("magnet_pull", magnet__residual=1.0) == 1.0
    with pytest.raises(FMICallException):
        unit.set(magnet_on=1.0)
    assert "magnet_on is a Boolean" in capsys.readouterr().out
    with pytest.raises(FMICallException):
        unit.command(position=True)
    assert "position is an output" in capsys.readouterr().out


@pytest.mark.parametrize("force", [0.02, 0.3])
def test_a_gap_that_never_opens_or_never_closes_is_refused(
    force: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As a device file with it is: at the residual pull, and beyond that with the open gap."""
    path = tmp_path / "device.toml"
    path.write_text(DEVICE.format(magnet=MAGNETS["closing"]), "utf-8")
    device = load_device(path)
    unit = Unit(*unpacked(device, tmp_path / "pin.fmu", 3))
    with pytest.raises(FMICallException):
        unit.begin(magnet__closing_force=force)
    said = capsys.readouterr().out.strip().removeprefix("[ERROR] magnet.")
    with pytest.raises(ValueError, match="closing_force must be") as refused:
        load_device(path, {"magnet.closing_force": force})
    assert str(refused.value).endswith(said)


def test_damaged_states_are_refused(tmp_path: Path) -> None:
    device, _ = scanned("warm pulses", tmp_path)
    unit = Unit(*unpacked(device, tmp_path / "pin.fmu", 3)).begin(mouse_velocity=0.05)
    unit.command(magnet_on=True)
    unit.step(0.0123)
    kept = bytes(unit.slave.serializeFMUState(unit.slave.getFMUState()))
    unit.slave.deserializeFMUState(kept)
    for i in range(0, len(kept), 7):
        damaged = bytearray(kept)
        damaged[i] ^= 1 << i % 8
        with pytest.raises(FMICallException):
            unit.slave.deserializeFMUState(bytes(damaged))
    with pytest.raises(FMICallException):
        unit.slave.deserializeFMUState(kept[:20])


def test_command_names_the_input_in_place_of_the_load(tmp_path: Path) -> None:
    done = run("fmu", str(READER), "-o", str(tmp_path / "pin.fmu"), "--set", "plate_load=2")
    assert "plate_load is left out; the input magnet_on takes its place" in done.stderr
    assert "parameters, 9 inputs, 13 outputs" in done.stdout

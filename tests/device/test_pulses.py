"""A magnet driven by pulses, and a coil that warms: against equations, and scans cut in two."""

from __future__ import annotations

from dataclasses import replace
from math import exp
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from command import GOOD, refused, run
from pindrive import load_device
from pindrive.device import (
    Coil,
    CoilState,
    Commands,
    ControlBlock,
    Device,
    Electromagnet,
    PinArray,
    scan,
)
from pindrive.device.closing import Closing
from pindrive.device.heating import Heat
from pindrive.device.reading import Reading
from tactile_mouse import SKIN, coil, drive

ON, OFF = 0.0103, 0.0631
CLOSED = Closing(0.0, 1.0)  # a gap that does not open
COPPER_RISE = 3.93e-3  # per kelvin, of annealed copper from 20 °C (IEC 60028)
COMMANDS = Commands(np.array([ON, OFF]))


def magnet(duty: float = 0.5, frequency: float = 500.0, rise: float = 0.001) -> Electromagnet:
    return Electromagnet(
        rise_constant=rise, fall_constant=0.004, pwm_frequency=frequency, pwm_duty=duty
    )


# ---- pulses --------------------------------------------------------------------------------------


@pytest.mark.parametrize("duty", [0.03, 0.5, 0.97])
def test_a_pulsed_current_obeys_its_differential_equation(duty: float) -> None:
    """Periods are multiples of 2 ms on the clock, whenever the command comes."""
    made = magnet(duty)
    current = made.current(COMMANDS, CoilState(), 0.0, 0.08)
    edges = {k * 0.002 + part for k in range(40) for part in (0.0, 0.002 * duty)}
    edges |= {ON, OFF, 0.08}
    value, begin = 0.0, 0.0
    for end in sorted(edge for edge in edges if 0.0 < edge <= 0.08):
        middle = 0.5 * (begin + end)
        on = ON < middle < OFF and (middle / 0.002) % 1.0 < duty
        target, constant = (1.0, 0.001) if on else (0.0, 0.004)
        value = target + (value - target) * exp(-(end - begin) / constant)
        begin = end
        assert current(end) == pytest.approx(value, abs=1e-12)


def test_in_the_end_the_current_swings_between_the_steady_values() -> None:
    made = magnet(0.3)
    assert made.pulses
    current = made.current(Commands(np.array([0.0])), CoilState(-1.0), 0.0, 0.2)
    low, high = made.pulses.steady(0.001, 0.004, CLOSED)
    assert current(0.198) == pytest.approx(low, rel=1e-12)
    assert current(0.1986) == pytest.approx(high, rel=1e-12)
    t = np.linspace(0.196, 0.198, 200_001)
    assert made.heating == pytest.approx(float(np.mean(current(t) ** 2)), rel=1e-4)
    assert made.sustained_pull == pytest.approx(low**2, rel=1e-12)
    fast = magnet(0.3, 20_000.0, rise=0.004).pulses
    assert fast and fast.steady(0.004, 0.004, CLOSED) == pytest.approx((0.3, 0.3), rel=0.02)


def test_a_full_duty_is_no_pulse() -> None:
    whole, plain = magnet(1.0), Electromagnet(rise_constant=0.001, fall_constant=0.004)
    t = np.linspace(0.0, 0.08, 999)
    assert whole.pulses is None and whole.sustained_pull == whole.hold_force
    given = COMMANDS, CoilState(), 0.0, 0.08
    np.testing.assert_array_equal(whole.current(*given)(t), plain.current(*given)(t))


@pytest.mark.parametrize(("duty", "frequency"), [(0.5, 500.0), (0.2, 5000.0)])
def test_rows_of_pulses_keep_their_bound(duty: float, frequency: float) -> None:
    made = magnet(duty, frequency)
    current = made.current(COMMANDS, CoilState(), 0.0, 0.08)
    t = np.linspace(0.0, 0.08, 4001)
    assert np.abs(current.pull(t) - made.pull(current(t))).max() <= 1e-12


DRIVE = drive(SKIN)
COIL = coil(release_resistance=20.0, heat_capacity=0.02)
PULSED = Electromagnet.from_coil(COIL, pwm_frequency=333.0, pwm_duty=0.6)


def reader(made: Electromagnet) -> Device:
    return Device(drive=DRIVE, magnet=made, control=ControlBlock(latency=0.017), array=PinArray())


@pytest.mark.parametrize("part", [0.3, 0.4137, 0.62])
@pytest.mark.parametrize("held", [False, True])
def test_a_driven_and_warm_scan_in_two_halves_is_the_scan_in_one(part: float, held: bool) -> None:
    device, reading = reader(HELD if held else PULSED), Reading()
    scene = reading.grating([0.004], device.array)
    path = reading.strokes(scene, device.array)
    cut = part * path.end
    (whole,) = scan(device, scene, path).pins
    first = scan(device, scene, path.between(0.0, cut))
    (second,) = scan(device, scene, path.between(cut, path.end), start=first.state).pins
    t = np.linspace(cut, path.end, 400)
    np.testing.assert_allclose(second.current(t), whole.current(t), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(second.position(t), whole.position(t), rtol=0.0, atol=1e-12)
    warm = whole.current.warming(t)
    np.testing.assert_allclose(second.current.warming(t), warm, rtol=1e-9, atol=1e-12)
    assert warm[-1] > 0.1


@pytest.mark.parametrize("held", [False, True])
def test_a_scan_cut_exactly_at_a_switching_off_is_the_scan_in_one(held: bool) -> None:
    """The first half ends before that instant, the second begins with it."""
    device, reading = reader(HELD if held else PULSED), Reading()
    device = replace(device, control=ControlBlock(latency=0.016))  # commanded off within a pulse
    scene = reading.grating([0.004], device.array)
    path = reading.strokes(scene, device.array)
    (whole,) = scan(device, scene, path).pins
    switched_off = whole.current.begins[~whole.current.on][1:].tolist()
    commanded_off = float(whole.commands.times[1])
    assert commanded_off in switched_off
    pulsed_off = [t for t in switched_off if t not in whole.commands.times][:3]
    assert held or len(pulsed_off) == 3
    for cut in (commanded_off, *pulsed_off):
        first = scan(device, scene, path.between(0.0, cut))
        (second,) = scan(device, scene, path.between(cut, path.end), start=first.state).pins
        t = np.linspace(cut, path.end, 400)
        np.testing.assert_allclose(second.current(t), whole.current(t), rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(second.position(t), whole.position(t), rtol=0.0, atol=1e-12)


# ---- a given voltage -----------------------------------------------------------------------------

HELD = Electromagnet.from_coil(COIL, voltage=[(0.0, 3.0), (0.004, 0.6), (0.03, 1.5)])


def test_a_given_voltage_holds_from_each_switching_on() -> None:
    coil = Coil(**{n: getattr(COIL, n) for n in Coil.__dataclass_fields__ if n != "heat_capacity"})
    made = Electromagnet.from_coil(coil, voltage=[(0.0, 3.0), (0.004, 0.6), (0.03, 1.5)])
    reported = Commands(np.array([0.010, 0.050, 0.055, 0.057]))
    current = made.current(reported, CoilState(), 0.0, 0.08)
    rise, fall = made.rise_constant, made.fall_constant
    value = 0.0
    for lasts, target, constant, end in (
        (0.004, 1.0, rise, 0.014),
        (0.026, 0.2, rise, 0.040),
        (0.010, 0.5, rise, 0.050),
        (0.005, 0.0, fall, 0.055),
        (0.002, 1.0, rise, 0.057),
        (0.010, 0.0, fall, 0.067),
    ):
        value = target + (value - target) * exp(-lasts / constant)
        assert current(end) == pytest.approx(value, rel=1e-12, abs=1e-15)
    assert made.sustained_pull == made.pull(0.5)
    dense = np.linspace(0.0, 0.08, 4001)
    error = np.abs(current.pull(dense) - made.pull(current(dense))).max()
    assert error <= 1e-12 * made.hold_force


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([(0.001, 3.0)], "voltage[0] time must be 0 s, when the coil is switched on, got 0.001 s"),
        ([(0.0, 3.0), (0.0, 1.0)], "voltage[1] time must be greater than the one before, 0.0 s"),
        ([(0.0, 3.1)], "voltage[0] must be from 0 V to the supply voltage, 3.0 V, got 3.1 V"),
    ],
)
def test_a_voltage_that_cannot_be_is_refused(rows: list[tuple[float, float]], message: str) -> None:
    with pytest.raises(ValueError) as error:
        Electromagnet.from_coil(COIL, voltage=rows)
    assert str(error.value).startswith(message)


@pytest.mark.usefixtures("in_empty_folder")
def test_a_voltage_stands_in_the_file_or_in_a_csv() -> None:
    coil = MAGNET.replace('pwm_frequency = "500 Hz"\npwm_duty = 0.6\n', "")
    rows = 'voltage = [["0 ms", "3 V"], ["4 ms", "0.6 V"]]\n'
    Path("device.toml").write_text(GOOD + coil + rows)
    written = load_device("device.toml")
    Path("drive.csv").write_text("time [ms], voltage [V]\n0, 3\n4, 0.6\n")
    Path("device.toml").write_text(GOOD + coil + 'voltage = "drive.csv"\n')
    read = load_device("device.toml")
    assert read.device.magnet == written.device.magnet
    assert read.device.magnet.steps
    assert read.device.magnet.steps.levels == pytest.approx((1.0, 0.2))
    checked = run("check", "device.toml")
    assert checked.exit_code == 0 and "U(t)" in checked.stdout, checked.output
    Path("device.toml").write_text(GOOD + MAGNET + rows)
    assert refused("check", "device.toml") == (
        "device.toml: magnet.voltage must be left out where pwm_frequency gives pulses, got both"
    )
    Path("device.toml").write_text(f"{GOOD}[magnet]\n{rows}")
    assert refused("check", "device.toml") == (
        "device.toml: magnet.voltage must be given with a coil, by turns, gap, wire_diameter and "
        "the like, got it alone"
    )


# ---- warming -------------------------------------------------------------------------------------


def test_warming_is_that_of_the_coupled_equations() -> None:
    """L di/dt = U - R(T) i and C dT/dt = R(T) i² - (T - 20 °C)/R_th, through 66 switchings."""
    coil, heat = COIL, COIL.heat
    assert heat
    made = Electromagnet.from_coil(coil, pwm_frequency=333.0, pwm_duty=0.6)
    current = made.current(Commands(np.array([0.0])), CoilState(-1.0), 0.0, 0.1)
    state, edges = [0.0, 0.0], [*current.begins[1:].tolist(), 0.1]

    def slope(_: float, y: list[float], on: bool) -> tuple[float, float]:
        resistance = coil.resistance * (1.0 + 3.93e-3 * y[1])
        drop = resistance * y[0] + (0.0 if on else coil.release_resistance * y[0])
        rate = ((coil.supply_voltage if on else 0.0) - drop) / coil.inductance
        heating = resistance * y[0] ** 2 - y[1] / coil.thermal_resistance
        return rate, heating / 0.02

    for begin, end, on in zip(edges, edges[1:], current.on[1:].tolist(), strict=False):
        out = solve_ivp(slope, (begin, end), state, args=(on,), rtol=1e-9, atol=1e-12)
        state = out.y[:, -1].tolist()
    assert state[1] > 1.0
    assert float(current.warming(np.array([0.1]))[0]) == pytest.approx(state[1], rel=1e-3)
    assert current(0.1) * coil.current == pytest.approx(state[0], rel=1e-3)
    cold = Electromagnet.from_coil(coil).current(COMMANDS, CoilState(), 0.0, 0.08)
    assert current.targets[current.on].min() < cold.targets[1] < 1.0, "resistance grows"


def test_in_the_end_it_is_as_warm_as_its_power_makes_it() -> None:
    heat = Heat(power=0.5, thermal_resistance=100.0, heat_capacity=0.01)

    def after(warming: float, start: float, target: float, constant: float, lasts: float) -> float:
        given = {"warming": warming, "start": start, "target": target, "constant": constant}
        arrays = {name: np.array([value]) for name, value in (given | {"resistance": 1.0}).items()}
        return float(heat.after(np.array([lasts]), **arrays)[0])

    assert after(0.0, 1.0, 1.0, 1e-3, 1e3) == pytest.approx(50.0, rel=1e-12)
    assert after(10.0, 0.0, 0.0, 1e-3, 1.0) == pytest.approx(10.0 * exp(-1.0), rel=1e-12)
    # A rate of the current that is also that of the cooling has no quotient.
    assert after(0.0, 1.0, 0.0, 2.0, 0.5) == pytest.approx(50.0 * 0.5 * exp(-0.5), rel=1e-12)


def test_a_coil_that_is_held_on_loses_current_as_it_warms() -> None:
    """2 V for 20 s: the coupled equations, which the pull follows to a thousandth."""
    given = {name: getattr(COIL, name) for name in Coil.__dataclass_fields__}
    coil = Coil(**given | {"supply_voltage": 2.0, "heat_capacity": 0.4, "saturation_field": 5.0})
    made = Electromagnet.from_coil(coil)
    current = made.current(Commands(np.array([0.0])), CoilState(), 0.0, 20.0)

    def slope(_: float, y: list[float]) -> tuple[float, float]:
        resistance = coil.resistance * (1.0 + COPPER_RISE * y[1])
        rate = (coil.supply_voltage - resistance * y[0]) / coil.inductance
        heating = resistance * y[0] ** 2 - y[1] / coil.thermal_resistance
        return rate, heating / 0.4

    t = np.linspace(0.1, 20.0, 200)
    out = solve_ivp(slope, (0.0, 20.0), [0.0, 0.0], t_eval=t, method="LSODA", rtol=1e-9, atol=1e-12)
    exact = made.pull(out.y[0] / coil.current)
    assert exact[-1] < 0.9 * exact[0]
    np.testing.assert_allclose(current.pull(t), exact, rtol=1e-3)
    np.testing.assert_allclose(current.warming(t), out.y[1], rtol=1e-3)


def test_a_warm_coil_pulls_less() -> None:
    warm = CoilState(0.0, False, 0.0, 60.0)
    for field in (1.6, 0.5):
        given = {name: getattr(COIL, name) for name in Coil.__dataclass_fields__}
        coil = Coil(**given | {"saturation_field": field})
        made = Electromagnet.from_coil(coil)
        current = made.current(Commands(np.array([0.001, 0.02])), warm, 0.0, 0.04)
        assert current(0.0199) == pytest.approx(1.0 / (1.0 + 3.93e-3 * 60.0), rel=0.01)
        dense = np.linspace(0.0, 0.04, 4001)
        error = np.abs(current.pull(dense) - made.pull(current(dense))).max()
        assert error <= 1e-12 * made.hold_force


# ---- device files --------------------------------------------------------------------------------

MAGNET = """
[magnet]
turns = 300
pole_area = "6 mm^2"
gap = "0.06 mm"
wire_diameter = "0.1 mm"
turn_length = "16 mm"
supply_voltage = "3 V"
heat_capacity = "0.02 J/K"
pwm_frequency = "500 Hz"
pwm_duty = 0.6
temperature_rise = "1 K"
"""


@pytest.mark.usefixtures("in_empty_folder")
def test_scan_reports_the_warming_of_its_coils() -> None:
    Path("device.toml").write_text(GOOD + MAGNET)
    done = run("scan", "device.toml", "--grating", "8 mm", "-o", "a.nc")
    assert done.exit_code == 0, done.output
    with xr.open_dataset("a.nc") as data:
        most = float(data.warming.max())
        assert data.warming.attrs["units"] == "K" and data.pwm_duty == 0.6
    (words,) = [line for line in done.stdout.splitlines() if line.startswith("A coil warms by")]
    assert float(words.split()[6]) == pytest.approx(most, rel=0.02)
    assert (
        f"a coil warms by {words.split()[6]} K in this scan, more than magnet.temp" in done.stderr
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            'pwm_frequency = "30 kHz"\npwm_duty = 0.5',
            "device.toml: magnet.pwm_frequency must be finite and at least 1 Hz and at most 20000 "
            'Hz, got "30 kHz"',
        ),
        (
            'pwm_frequency = "3 kHz"\npwm_duty = 0',
            "device.toml: magnet.pwm_duty must be finite and greater than 0 and at most 1, got 0",
        ),
        (
            'rise_time = "3 ms"\npwm_duty = 0.5',
            "device.toml: magnet.pwm_duty must be given with pwm_frequency, got it alone",
        ),
    ],
)
@pytest.mark.usefixtures("in_empty_folder")
def test_pulses_that_cannot_be_are_refused(text: str, message: str) -> None:
    Path("device.toml").write_text(f"{GOOD}\n[magnet]\n{text}\n")
    assert refused("check", "device.toml") == message


def test_too_many_pulses_are_refused_before_they_are_made() -> None:
    made = magnet(0.5, 20_000.0)
    with pytest.raises(ValueError, match="the switchings of the coils of all pins"):
        made.current(Commands(np.array([0.0])), CoilState(-1.0), 0.0, 60.0)

"""A coil whose gap closes: against its equation integrated, and against limits and balances."""

from __future__ import annotations

from functools import partial
from math import log, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import tactile_mouse
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
from pindrive.device.current import Current, Pulses
from pindrive.device.reading import Reading
from tactile_mouse import SKIN, drive

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array: TypeAlias = NDArray[np.float64]

END = 0.03
COMMANDS = Commands(np.array([0.001, 0.006, 0.0066, 0.018, 0.0184]))
VOLTAGE = [(0.0, 3.0), (0.0009, 0.9), (0.003, 2.0)]

coil = partial(tactile_mouse.coil, release_resistance=5.0)
LIFT = {"lift": 9e-5, "closing_force": 0.3}
DRIVEN = {
    "on and off": Electromagnet.from_coil(coil(**LIFT), residual=0.05),
    "saturated": Electromagnet.from_coil(coil(**LIFT, saturation_field=0.5)),
    "voltage": Electromagnet.from_coil(coil(**LIFT), residual=0.05, voltage=VOLTAGE),
    "pulses": Electromagnet.from_coil(coil(**LIFT), pwm_frequency=700.0, pwm_duty=0.4),
}


def integrated(made: Electromagnet, current: Current, t: Array) -> tuple[Array, Array]:
    """The current (A) and the pull (N) at times t, by dλ/dt = U - R i(λ, gap) in SI units."""
    one = made.coil
    assert isinstance(one, Coil) and one.lift is not None and one.closing_force is not None
    area, force = one.turns * one.pole_area, one.closing_force
    gaps = {True: one.gap, False: one.gap + one.lift}

    def inductance(closed: bool) -> float:
        return 1.25663706127e-6 * one.turns * area / (2.0 * gaps[closed])

    def pull(linkage: float) -> float:
        density = min(linkage / area, one.saturation_field)
        share = (density / min(one.field, one.saturation_field)) ** 2
        return made.residual + (made.hold_force - made.residual) * share

    def slope(_: float, y: Array, volts: float, ohms: float, closed: bool) -> list[float]:
        return [volts - ohms * float(y[0]) / inductance(closed)]

    def excess(_: float, y: Array, *__: object) -> float:
        return pull(float(y[0])) - force

    excess.terminal = True  # type: ignore[attr-defined]
    linkage, now, closed = 0.0, 0.0, False
    amperes, newtons = np.zeros_like(t), np.zeros_like(t)
    for edge in sorted({*current.begins[1:][~crossings(made, current)[1:]].tolist(), END}):
        piece = int(np.searchsorted(current.begins, 0.5 * (now + edge), "right")) - 1
        on, volts = bool(current.on[piece]), float(current.levels[piece]) * one.supply_voltage
        while now < edge:
            ohms = one.resistance + (0.0 if on else one.release_resistance)
            excess.direction = -1.0 if closed else 1.0  # type: ignore[attr-defined]
            out = solve_ivp(
                slope,
                (now, edge),
                [linkage],
                method="DOP853",
                args=(volts if on else 0.0, ohms, closed),
                events=excess,
                rtol=1e-13,
                atol=1e-18,
                dense_output=True,
            )
            inside = (t >= now) & (t <= out.t[-1])
            linkages = out.sol(t[inside])[0] if inside.any() else np.zeros(0)
            amperes[inside] = linkages / inductance(closed)
            newtons[inside] = [pull(each) for each in linkages]
            linkage, now = float(out.y[0, -1]), float(out.t[-1])
            closed ^= out.status == 1
    return amperes, newtons


def crossings(made: Electromagnet, current: Current) -> NDArray[np.bool_]:
    """Return the pieces that begin at a closing or opening of the gap, not at a switching."""
    return np.asarray(current.starts == made.closing.flux)


@pytest.mark.parametrize("name", DRIVEN)
def test_current_and_pull_are_those_of_the_equation_integrated(name: str) -> None:
    made = DRIVEN[name]
    current = made.current(COMMANDS, CoilState(), 0.0, END)
    count = int(crossings(made, current).sum())
    assert count >= 3, "it closes and opens more than once"
    t = np.linspace(0.0, END, 997)
    amperes, newtons = integrated(made, current, t)
    assert made.coil
    assert np.abs(current(t) * made.coil.current - amperes).max() <= 1e-9 * made.coil.current
    assert np.abs(made.pull(current.flux(t)) - newtons).max() <= 1e-9 * made.hold_force
    worst = np.abs(current.pull(t) - made.pull(current.flux(t))).max()
    assert worst <= 1e-12 * made.hold_force


def test_with_a_temperature_it_is_that_of_the_coupled_equations() -> None:
    """The heat is the current's, which is larger while the gap is open, and resistance follows."""
    made_of = coil(**LIFT, heat_capacity=0.02)
    made = Electromagnet.from_coil(made_of, pwm_frequency=700.0, pwm_duty=0.4)
    current = made.current(COMMANDS, CoilState(), 0.0, END)
    edges, state = [*current.begins[1:].tolist(), END], [0.0, 0.0]

    def slope(_: float, y: Array, piece: int) -> tuple[float, float]:
        amperes = y[0] / (made_of.inductance * current.inductances[piece])
        volts = made_of.supply_voltage if current.on[piece] else 0.0
        ohms = made_of.resistance * (1.0 + 3.93e-3 * y[1])
        outer = 0.0 if current.on[piece] else made_of.release_resistance
        heating = ohms * amperes**2 - y[1] / made_of.thermal_resistance
        return volts - (ohms + outer) * amperes, heating / 0.02

    begin = 0.0
    for piece, end in enumerate(edges):
        out = solve_ivp(
            slope, (begin, end), state, args=(piece,), method="DOP853", rtol=1e-13, atol=1e-18
        )
        state, begin = out.y[:, -1].tolist(), end
        full = made_of.inductance * made_of.current
        assert current.flux(end) == pytest.approx(state[0] / full, abs=2e-4)
        assert float(current.warming(np.array([end]))[0]) == pytest.approx(state[1], rel=1e-3)
    assert crossings(made, current).sum() >= 3 and state[1] > 0.1


def test_without_a_lift_nothing_changes_and_with_a_small_one_little() -> None:
    plain = Electromagnet.from_coil(coil())
    given = COMMANDS, CoilState(), 0.0, END
    t = np.linspace(0.0, END, 997)
    for lift, bound in ((0.0, 1e-14), (6e-12, 1e-6)):
        made = Electromagnet.from_coil(coil(lift=lift, closing_force=0.3))
        assert np.abs(made.current(*given)(t) - plain.current(*given)(t)).max() <= bound
        assert made.rise_time == pytest.approx(plain.rise_time, rel=bound)
        assert made.fall_time == pytest.approx(plain.fall_time, rel=bound)
    assert (plain.current(*given).inductances == 1.0).all()
    np.testing.assert_array_equal(plain.current(*given)(t), plain.current(*given).flux(t))


@pytest.mark.parametrize("force", [0.01, 0.2, 0.5])
def test_times_are_those_of_the_current(force: float) -> None:
    """Closed forms of the closing, opening, rise and fall, against the current's pieces."""
    made = Electromagnet.from_coil(coil(lift=9e-5, closing_force=force), residual=0.005)
    rises = made.current(Commands(np.array([0.0])), CoilState(-1.0))
    falls = made.current(Commands(np.array([0.0]), at_first=True), CoilState(-1.0, True, 1.0))
    assert rises.begins[-1] == pytest.approx(made.closing_time, rel=1e-12)
    assert falls.begins[-1] == pytest.approx(made.opening_time, rel=1e-12)
    span = made.hold_force - made.residual
    assert made.pull(rises.flux(made.rise_time)) == pytest.approx(0.9 * span + 0.005, rel=1e-12)
    assert made.pull(falls.flux(made.fall_time)) == pytest.approx(0.1 * span + 0.005, rel=1e-12)
    q, edge = 0.4, sqrt((force - 0.005) / span)
    assert made.closing_time == pytest.approx(-q * made.rise_constant * log(1.0 - edge / q))
    # as it closes the flux stays and the current falls by q; as it opens it grows by 1/q
    assert rises(made.closing_time + 1e-12) == pytest.approx(edge, rel=1e-6)
    assert rises(made.closing_time - 1e-12) == pytest.approx(edge / q, rel=1e-6)


def test_open_gap_stays_open_at_a_voltage_that_keeps_it_closed() -> None:
    """Hysteresis: at 1.2 V the open gap's pull is below the force, the closed gap's above."""
    low = Electromagnet.from_coil(coil(**LIFT), voltage=[(0.0, 1.2)])
    kept = Electromagnet.from_coil(coil(**LIFT), voltage=[(0.0, 3.0), (0.003, 1.2)])
    assert low.sustained_flux == pytest.approx(0.4 * 0.4)
    assert kept.sustained_flux == pytest.approx(0.4)
    assert low.sustained_pull < 0.3 < kept.sustained_pull


@pytest.mark.parametrize("frequency", [150.0, 700.0, 3000.0])
@pytest.mark.parametrize("duty", [0.08, 0.25, 0.35, 0.5, 0.8])
@pytest.mark.parametrize("force", [0.02, 0.3, 0.55])
def test_pulses_come_to_their_steady_swing(frequency: float, duty: float, force: float) -> None:
    """Compared with 400 periods in sequence: gap open, closed, and both in each period."""
    made = Electromagnet.from_coil(
        coil(lift=9e-5, closing_force=force), pwm_frequency=frequency, pwm_duty=duty
    )
    assert isinstance(made.pulses, Pulses)
    low, high = made.pulses.steady(made.rise_constant, made.fall_constant, made.closing)
    last = 400.0 / frequency
    current = made.current(Commands(np.array([0.0])), CoilState(-1.0), 0.0, last + 1.0 / frequency)
    assert current.flux(last) == pytest.approx(low, rel=1e-9)
    assert current.flux(last + duty / frequency) == pytest.approx(high, rel=1e-9)
    t = last + np.linspace(0.0, 1.0 / frequency, 20_001)
    assert made.heating == pytest.approx(float(np.mean(current(t[:-1]) ** 2)), rel=2e-3)
    assert made.sustained_pull == made.pull(low)


def test_the_energy_taken_is_warmed_stored_and_given_to_the_closing() -> None:
    """U i - R i² enters the field, of which λ²/2 (1/L_open - 1/L) enters each closing."""
    made, made_of = DRIVEN["on and off"], coil(**LIFT)
    current = made.current(Commands(np.array([0.0])), CoilState(-1.0))
    t = np.linspace(0.0, made.closing_time, 20_001)
    after = np.linspace(made.closing_time, 0.004, 20_001)
    i, full = made_of.current, made_of.inductance * made_of.current
    taken = 0.0
    for times in (t, after):
        inside = np.clip(times, times[0] + 1e-13, times[-1] - 1e-13)
        amperes = i * current(inside)
        taken += float(np.trapezoid(3.0 * amperes - made_of.resistance * amperes**2, times))
    edge = full * made.closing.flux
    closed, opened = made_of.inductance, 0.4 * made_of.inductance
    work = 0.5 * edge**2 * (1.0 / opened - 1.0 / closed)
    stored = 0.5 * (full * current.flux(0.004)) ** 2 / closed
    assert taken == pytest.approx(work + stored, rel=1e-7)


SCANNED = Electromagnet.from_coil(
    coil(**LIFT, heat_capacity=0.02), pwm_frequency=333.0, pwm_duty=0.6
)


@pytest.mark.parametrize("pulsed", [False, True])
def test_a_scan_in_two_halves_is_the_scan_in_one(pulsed: bool) -> None:
    """Cut wherever: just before the gap closes, between its opening and the next switching."""
    made = SCANNED if pulsed else DRIVEN["voltage"]
    control = ControlBlock(latency=0.017)
    device = Device(drive=drive(SKIN), magnet=made, control=control, array=PinArray())
    reading = Reading()
    scene = reading.grating([0.004], device.array)
    path = reading.strokes(scene, device.array)
    (whole,) = scan(device, scene, path).pins
    begins = whole.current.begins
    split = begins[np.flatnonzero(crossings(made, whole.current))[[0, -1]]]
    assert split[0] < split[1] < path.end
    for cut in (split[0] - 1e-5, split[0] + 1e-5, split[1] - 1e-5, split[1] + 1e-5):
        first = scan(device, scene, path.between(0.0, cut))
        (second,) = scan(device, scene, path.between(cut, path.end), start=first.state).pins
        t = np.linspace(cut, path.end, 200)
        np.testing.assert_allclose(second.current(t), whole.current(t), rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(second.position(t), whole.position(t), rtol=0.0, atol=1e-12)


# ---- device files --------------------------------------------------------------------------------

MAGNET = """
[magnet]
turns = 300
pole_area = "6 mm^2"
gap = "0.06 mm"
lift = "0.09 mm"
closing_force = "0.3 N"
wire_diameter = "0.1 mm"
turn_length = "16 mm"
supply_voltage = "3 V"
"""


@pytest.mark.usefixtures("in_empty_folder")
def test_check_reports_when_the_gap_closes_and_opens() -> None:
    Path("device.toml").write_text(GOOD + MAGNET)
    magnet = load_device("device.toml").device.magnet
    said = " ".join(run("check", "device.toml").stdout.split())
    assert (
        f"At full voltage its gap closes {1e3 * magnet.closing_time:.4g} ms after it is switched "
        f"on, and opens {1e3 * magnet.opening_time:.4g} ms after it is switched off." in said
    )
    assert "does not stay closed" not in said
    Path("device.toml").write_text(GOOD + MAGNET + 'voltage = [["0 s", "1.2 V"]]\n')
    said = " ".join(run("check", "device.toml").stdout.split())
    assert "With the voltage given, its gap does not stay closed while it is on." in said


@pytest.mark.usefixtures("in_empty_folder")
def test_a_scan_is_written_with_the_lift_and_without_what_is_not_given() -> None:
    Path("device.toml").write_text(GOOD + MAGNET)
    done = run("scan", "device.toml", "--grating", "8 mm", "-o", "a.nc")
    assert done.exit_code == 0, done.output
    with xr.open_dataset("a.nc") as data:
        assert data.lift == 9e-5 and data.closing_force == 0.3
        assert "heat_capacity" not in data.attrs
        assert float(data.current.max()) > 0.99 and float(data.pull.max()) > 3.8


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'closing_force = "0.3 N"\n',
            "",
            "device.toml: magnet.lift must be given with closing_force, got it alone",
        ),
        (
            'lift = "0.09 mm"\n',
            "",
            "device.toml: magnet.closing_force must be given with lift, got it alone",
        ),
        (
            '"0.3 N"',
            '"3 N"',
            "device.toml: magnet.closing_force must be less than the pull of full current with the "
            "open gap, 0.611",
        ),
        (
            '"0.3 N"',
            '"0.3 N"\nresidual = "0.3 N"',
            "device.toml: magnet.closing_force must be more than the residual pull, 0.3 N, got "
            "0.3 N",
        ),
        (
            '"0.09 mm"',
            '"-1 mm"',
            "device.toml: magnet.lift must be finite and at least 0 m and at most 0.1 m, got "
            '"-1 mm"',
        ),
        (
            '"0.3 N"',
            '"0 N"',
            "device.toml: magnet.closing_force must be finite and at least 1e-9 N and at most "
            '10000 N, got "0 N"',
        ),
    ],
)
@pytest.mark.usefixtures("in_empty_folder")
def test_a_closing_that_cannot_be_is_refused(old: str, new: str, message: str) -> None:
    assert old in MAGNET
    Path("device.toml").write_text(GOOD + MAGNET.replace(old, new))
    assert refused("check", "device.toml").startswith(message)

"""Whole cycles of whole devices: against SUNDIALS, and by laws that need no oracle."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from oracle.scan_cycles import distance
from pindrive import Contact
from pindrive.device import (
    ControlBlock,
    Device,
    Electromagnet,
    HandPath,
    PinArray,
    PinScan,
    PinState,
    Scan,
    Scene,
    lines,
    scan,
    strokes,
)
from random_scans import mirrored, sampled
from tactile_mouse import DAMPED, PLATE, RIGID, SKIN, drive

STRIBECK = Contact(curve=[(0.0, 0.022), (0.02, 0.012), (0.3, 0.025)], static=0.0265)


def grating(*pitches: float, count: int = 2) -> Scene:
    """Lines about x = 0, so that a mirrored path is a path of negated numbers."""
    scene = Scene.from_grating(pitches, count=count, margin=0.006)
    columns = scene.luminance.shape[1]
    return Scene(scene.luminance, scene.pixel, (-0.5 * columns * scene.pixel, 0.0), scene.lines)


def across(scene: Scene, speed: float = 0.06, margin: float = 0.003) -> HandPath:
    left, right, _, _ = scene.extent
    y = scene.lines[0]
    return strokes([(left + margin, y), (right - margin, y)], speed, pause=0.1)


def weak() -> Electromagnet:
    """The spring overcomes it on wide lines."""
    return Electromagnet.from_times(hold_force=1.2)


# ---- against SUNDIALS ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("finger", "plate", "magnet", "pitches", "speed"),
    [
        (RIGID, PLATE, weak(), (0.002, 0.012), 0.06),
        (SKIN, PLATE, weak(), (0.002, 0.012), 0.06),
        (RIGID, PLATE, Electromagnet.from_times(residual=0.05), (0.003,), 0.15),
        (SKIN, PLATE, Electromagnet.from_times(saturation=0.6), (0.0015,), 0.1),
        (SKIN, STRIBECK, weak(), (0.008,), 0.06),
        (DAMPED, PLATE, weak(), (0.002, 0.012), 0.06),
        (DAMPED, PLATE, Electromagnet.from_times(residual=0.05), (0.003,), 0.06),
        (DAMPED, STRIBECK, weak(), (0.008,), 0.06),
    ],
    ids=[
        *("rigid", "skin", "rigid, fast, residual", "skin, saturated", "skin, curved plate"),
        *("damped", "damped, residual", "damped, curved plate"),
    ],
)
def test_whole_cycles_against_sundials(
    finger: Contact,
    plate: Contact,
    magnet: Electromagnet,
    pitches: tuple[float, ...],
    speed: float,
) -> None:
    scene, device = grating(*pitches), Device(drive=drive(finger, plate), magnet=magnet)
    (pin,) = scan(device, scene, sampled(across(scene, speed))).pins
    assert len(pin.energised) == 2 * len(pitches)
    found = distance(pin)
    assert found.events
    assert found.time < 1e-8
    assert found.state < 1e-8
    assert pin.motion.certificate().worst < 1e-12


def test_a_drive_at_an_angle_to_the_hand() -> None:
    """The plate slides across while the hand moves, sticks where it stops, and carries less."""
    scene = grating(0.004)
    carried = []
    for axis in (0.0, 0.2):
        device = Device(drive=drive(), magnet=weak(), array=PinArray.grid(1, 1, 0.004, axis=axis))
        (pin,) = scan(device, scene, across(scene)).pins
        assert pin.motion.certificate().worst < 1e-11
        stops = pin.end - 0.1
        sticks = [e.time for e in pin.events if (e.contact, e.kind) == ("plate", "stick")]
        assert sticks.pop() == pytest.approx(stops, abs=1e-12)
        assert any(0.05 < time < stops for time in sticks) == (axis == 0.0)
        carried.append(np.abs(pin.position(np.linspace(0.0, pin.end, 2000))).max())
    assert carried[1] < carried[0]


def test_a_cycle_has_all_its_parts() -> None:
    """The case above does what the issue asks for: drag, slip, release, capture in mid-swing."""
    scene = grating(0.002, 0.012)
    (pin,) = scan(Device(drive=drive(), magnet=weak()), scene, across(scene)).pins
    slips = [e for e in pin.events if (e.contact, e.kind) == ("plate", "slip")]
    sticks = [e for e in pin.events if (e.contact, e.kind) == ("plate", "stick")]
    on = pin.commands.on([e.time for e in slips])
    assert on.any(), "slips while the magnet pulls"
    assert not on.all(), "and is released"
    swinging = [
        e for e in sticks if pin.commands.on(e.time) and float(pin.velocity(e.time - 3e-3)) != 0.0
    ]
    assert len(swinging) >= 2, "caught while it swings"


def exact_release(device: Device, pin: PinScan, begin: float, end: float) -> float:
    """Return the position at `end` of a pin in stick from `begin` on, under the smooth pull.

    Valid while it is first carried, then slides with the finger dragging back.
    """
    pin_drive, magnet, speed = device.drive, device.magnet, float(pin.velocity(begin))
    x0 = float(pin.position(begin))

    def load(t: float) -> float:
        return float(device.load(magnet.pull(pin.current.flux(t))))

    def spare(t: float) -> float:
        pull = pin_drive.stiffness * (x0 + speed * (t - begin)) + pin_drive.damping * speed
        return pin_drive.plate.static_friction * load(t) - pull - pin_drive.finger.kinetic

    loose = float(brentq(spare, begin, end, xtol=1e-15))

    def right(t: float, y: Any) -> tuple[float, float]:
        friction = pin_drive.plate.kinetic * load(t) - pin_drive.finger.kinetic
        force = friction - pin_drive.damping * y[1] - pin_drive.stiffness * y[0]
        return y[1], force / pin_drive.mass

    start = [x0 + speed * (loose - begin), speed]
    return float(
        solve_ivp(right, (loose, end), start, method="DOP853", rtol=1e-12, atol=1e-14).y[0, -1]
    )


def test_the_motion_is_that_under_the_smooth_pull() -> None:
    """To that of an independent integrator; the hand moves evenly."""
    scene = grating(0.008)
    left, right, _, _ = scene.extent
    y, speed = scene.lines[0], 0.06
    lasts = (right - left - 0.006) / speed
    path = HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (left + 0.003, y))
    device = Device(drive=drive(), magnet=Electromagnet.from_times(hold_force=3.0))
    (pin,) = scan(device, scene, path, start=[PinState(velocity=None)]).pins
    released = pin.energised[0][1]
    slip = next(e for e in pin.events if e.kind == "slip" and e.time > released)
    middle = slip.time + 0.002
    error = exact_release(device, pin, released, middle) - pin.position(middle)
    assert abs(error) < 2e-13


# ---- laws ----------------------------------------------------------------------------------------


def blank() -> Scene:
    return Scene(np.ones((100, 600)), 1e-4)


def test_a_pin_never_over_information_never_moves_where_the_finger_holds_it() -> None:
    """It does not where the plate's friction and the hand's jerks stay within the finger's hold."""
    held = drive(finger=Contact(0.030, 0.045))
    path = lines([0.004, 0.006], 0.01, 0.05, speed=0.06, return_speed=0.1, pause=0.1)
    acceleration = np.abs(np.diff(path.vx) / np.diff(path.times)).max()
    assert PLATE.kinetic + held.mass * acceleration < held.finger.static_friction
    done = scan(Device(drive=held), blank(), path)
    t = np.linspace(0.0, path.end, 1000)
    assert not done.pins[0].position(t).any()
    assert not done.pins[0].velocity(t).any()
    assert done.pins[0].energised == []
    assert any("no pin met information" in warning for warning in done.warnings)


def test_a_pin_that_is_off_is_dragged_no_further_than_the_plate_can() -> None:
    """A pin that the finger does not hold is dragged by the plate to a standstill."""
    device = Device(drive=drive())
    path = HandPath([0.0, 0.1, 1.0], [0.0, 0.04, 0.04], [0.0] * 3, (0.01, 0.005))
    (pin,) = scan(device, blank(), path).pins
    assert device.drag() == pytest.approx((0.022 - 0.005) / 100.0)
    assert pin.position(1.0) == pytest.approx(device.drag(), rel=0.5)
    assert pin.motion.segments[-1].finger == 0


def test_mirrored_scene_and_path_mirror_the_motion_to_the_bit() -> None:
    scene = grating(0.002, 0.0071)
    reversed_ = replace(scene, luminance=scene.luminance[:, ::-1])
    path = across(scene)
    back = mirrored(path)
    array = PinArray([(0.0, 0.0), (0.0011, 0.002)])
    turned = PinArray([(0.0, 0.0), (-0.0011, 0.002)])
    for finger in (RIGID, SKIN):
        device = Device(drive=drive(finger), magnet=weak(), array=array)
        one = scan(device, scene, path)
        other = scan(replace(device, array=turned), reversed_, back)
        t = np.linspace(0.0, path.end, 2001)
        for pin, mirror in zip(one.pins, other.pins, strict=True):
            assert (pin.commands.times == mirror.commands.times).all()
            assert (pin.position(t) == -mirror.position(t)).all()
            assert (pin.skin_force(t) == -mirror.skin_force(t)).all()
            assert [e.time for e in pin.events] == [e.time for e in mirror.events]


def same(one: Scan, other: Scan) -> bool:
    t = np.linspace(one.path.begin, one.path.end, 1001)
    return all(
        (a.position(t) == b.position(t)).all() and a.events == b.events
        for a, b in zip(one.pins, other.pins, strict=True)
    )


def test_two_runs_are_identical_to_the_bit() -> None:
    scene = grating(0.002, 0.0071)
    device = Device(drive=drive(SKIN), magnet=weak(), array=PinArray.grid(2, 2))
    one, other = (scan(device, scene, across(scene), threads=n) for n in (1, 4))
    assert same(one, other)
    assert one.to_dataset().identical(other.to_dataset())


def test_a_scan_cut_where_the_hand_dips_to_zero_is_the_scan_in_one() -> None:
    """Plate and finger are at rest under the pin there: the state says which of them holds it."""
    device = Device(drive=drive(finger=Contact(0.010, 0.024)))
    path = HandPath([0.0, 0.4, 0.8, 1.2], [0.04, 0.04, 0.0, 0.04], [0.0] * 4, (0.01, 0.005))
    cut = 0.8
    whole, first = scan(device, blank(), path), scan(device, blank(), path.between(0.0, cut))
    second = scan(device, blank(), path.between(cut, path.end), start=first.state)
    t = np.linspace(cut, path.end, 500)
    (pin,), (again,) = whole.pins, second.pins
    assert_allclose(again.position(t), pin.position(t), rtol=0.0, atol=1e-15)
    released = [replace(first.state[0], contacts=None)]
    (other,) = scan(device, blank(), path.between(cut, path.end), start=released).pins
    assert np.abs(other.position(t) - pin.position(t)).max() > 2e-5


def test_contacts_of_another_state_are_refused() -> None:
    device, path = Device(drive=drive()), across(grating(0.004))
    (state,) = scan(device, blank(), path).state
    moved = replace(state, position=state.position + 1e-4)
    with pytest.raises(ValueError, match=r"start\[0\].contacts must be None where position or"):
        scan(device, blank(), path, start=[moved])


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
@pytest.mark.parametrize("part", [0.137, 0.3, 0.311, 0.42, 0.5, 0.583, 0.7, 0.96])
def test_a_scan_in_two_halves_is_the_scan_in_one(finger: Contact, part: float) -> None:
    scene = grating(0.002, 0.0071)
    device = Device(
        drive=drive(finger),
        magnet=weak(),
        control=ControlBlock(latency=0.017),
        array=PinArray([(0.0, 0.0), (0.0011, 0.002)]),
    )
    path = across(scene)
    cut = part * path.end
    whole = scan(device, scene, path)
    first = scan(device, scene, path.between(0.0, cut))
    second = scan(device, scene, path.between(cut, path.end), start=first.state)
    for a, b, c in zip(whole.pins, first.pins, second.pins, strict=True):
        joined = np.concatenate([b.commands.times, c.commands.times])
        assert (joined == a.commands.times).all()
        t = np.linspace(0.0, cut, 500)
        assert_allclose(b.position(t), a.position(t), rtol=0.0, atol=1e-12)
        t = np.linspace(cut, path.end, 500)
        assert_allclose(c.current(t), a.current(t), rtol=0.0, atol=1e-12)
        assert_allclose(c.position(t), a.position(t), rtol=0.0, atol=1e-12)
        events = [(e.contact, e.kind) for e in (*b.events, *c.events)]
        assert events == [(e.contact, e.kind) for e in a.events]


def test_latency_moves_the_commands_alone() -> None:
    scene = grating(0.004)
    path = across(scene)
    for latency in (0.0, 0.0123):
        control = ControlBlock(latency=latency)
        (pin,) = scan(Device(drive=drive(), control=control), scene, path).pins
        seen = pin.commands.times - latency
        x = path.position(seen)[0]
        step = path.peak_speed / control.sample_rate
        borders = scene.extent[0] + 0.006 + np.array([0.0, 0.002, 0.004, 0.006])
        assert ((x - borders > -0.1 * scene.pixel) & (x - borders < step + scene.pixel)).all()


# ---- what is refused or warned of ----------------------------------------------------------------


def test_a_hand_that_leaves_the_page_reads_blank_paper() -> None:
    """Beyond the page the pins read white: equal samples, switchings and motions."""
    page = np.ones((100, 200))
    page[10:90, 80:100] = 0.0
    around = np.pad(page, 300, constant_values=1.0)
    small, wide = Scene(page, 1e-4), Scene(around, 1e-4, (-0.03, -0.03))
    device = Device(drive=drive(), array=PinArray.grid(2, 1, 0.004))
    path = strokes([(-0.01, 0.005), (0.04, 0.005), (0.009, 0.03)], 0.1)
    one, other = scan(device, small, path), scan(device, wide, path)
    for pin, like in zip(one.pins, other.pins, strict=True):
        assert 0.0 in pin.luminance
        assert_allclose(pin.luminance, like.luminance, atol=1e-12)
        assert pin.events == like.events
    assert one.evaluate().counts == other.evaluate().counts
    instants = one.pins[0].sample_times
    off = ~small.contains(*one.spot(0, instants).T)
    assert one.warnings[0] == (
        "the spot of pin 0 is beyond the page, 0 to 20 mm across and 0 to 10 mm down, for "
        f"{off.mean():.0%} of the time: it sees blank paper there"
    )
    assert not any("beyond the page" in words for words in other.warnings)


def test_a_slow_sample_rate_is_warned_of_with_its_number() -> None:
    device = Device(drive=drive(), control=ControlBlock(sample_rate=100.0))
    done = scan(device, grating(0.004), across(grating(0.004), 0.06))
    assert len(done.warnings) == 1
    assert done.warnings[0].startswith(
        "control.sample_rate = 100 Hz samples every 0.6 mm at 60 mm/s, past pixels of 0.1 mm"
    )
    assert done.warnings[0].endswith("600 Hz sees each")


def test_a_motion_askew_is_warned_of() -> None:
    device = Device(drive=drive(), array=PinArray(axis=0.5))
    done = scan(device, grating(0.004), across(grating(0.004), 0.05))
    assert len(done.warnings) == 1
    assert done.warnings[0].startswith("the hand moves up to 28.6 deg (mean 28.6 deg) off the")


def test_states_must_fit() -> None:
    with pytest.raises(ValueError, match="start must be one state for each pin, 1, got 2"):
        scan(Device(drive=drive()), blank(), across(grating(0.004)), start=[PinState()] * 2)


@pytest.mark.parametrize("threads", [0, -1, 2.5, 2.0, True, "2", np.float64(1.0)])
def test_threads_are_a_count(threads: Any) -> None:
    with pytest.raises(ValueError) as refused:
        scan(Device(drive=drive()), grating(0.004), across(grating(0.004)), threads=threads)
    assert str(refused.value) == (f"threads must be a whole number from 1 to 4096, got {threads!r}")


def test_a_count_may_be_numpys() -> None:
    scene = grating(0.004)
    one: Any = np.int64(1)
    (pin,) = scan(Device(drive=drive()), scene, across(scene), threads=one).pins
    assert pin.number == 0


@pytest.mark.parametrize("count", [0, 1.5, True])
def test_a_grating_has_a_count_of_lines(count: Any) -> None:
    with pytest.raises(ValueError, match="count must be a whole number of at least 1, got "):
        Scene.from_grating([0.004], count=count)


def test_plates_that_no_magnet_can_hold_by() -> None:
    with pytest.raises(ValueError, match=r"plate.kinetic must be greater than 0 N where a magnet"):
        Device(drive=drive(plate=Contact(0.0)))


def test_pins_that_coincide_are_refused() -> None:
    with pytest.raises(ValueError) as refused:
        PinArray([(0.0, 0.001), (0.002, 0.0), (0.0, 0.001)])
    assert str(refused.value) == (
        "places must be places of their own, got pins 0 and 2 both at (0.0 m, 0.001 m)"
    )


def test_arrays() -> None:
    array = PinArray.grid(3, 2, 0.002, spot_scale=0.5)
    assert len(array) == 6
    assert array.places[0] == (-0.002, -0.001)
    assert array.spots[5] == (0.001, 0.0005)
    assert_allclose(
        PinArray([(1.0, 0.0)], axis=np.pi / 2).on_page(((1.0, 0.0),)), [[0.0, 1.0]], atol=1e-15
    )
    for bad, message in (
        ({"columns": 1.5}, "columns must be a whole number, got 1.5"),
        ({"rows": 0}, "rows must be finite and at least 1 and at most 1000, got 0.0"),
        ({"pitch": 0.0}, "pitch must be finite and at least 1e-6 m and at most 1 m, got 0.0 m"),
    ):
        with pytest.raises(ValueError) as refused:
            PinArray.grid(**bad)
        assert str(refused.value) == message
    with pytest.raises(ValueError, match="spots must be as many as pins, 1, got 2"):
        PinArray([(0.0, 0.0)], [(0.0, 0.0), (1.0, 0.0)])
    with pytest.raises(ValueError, match="places must be at least one place, got none"):
        PinArray([])


def test_control_blocks() -> None:
    with pytest.raises(ValueError) as refused:
        ControlBlock(threshold=0.9, hysteresis=0.3)
    assert str(refused.value).startswith("hysteresis must be at most 0.2 about a threshold of 0.9")
    control = ControlBlock(sample_rate=100.0, latency=0.015, hysteresis=0.2)
    instants = control.sample_times(0.0, 0.1)
    assert_allclose(instants, np.arange(10) / 100)
    seen = np.array([1.0, 0.45, 0.39, 0.45, 0.55, 0.61, 0.5, 0.3, 0.3, 1.0])
    # A hand that passes a pixel's middle at each sample.
    scene = Scene(seen[np.newaxis], 1e-3, (-0.5e-3, 0.0))
    path = HandPath([0.0, 0.1], [0.1, 0.1], [0.0, 0.0], (0.0, 0.5e-3))
    (pin,) = scan(Device(drive=drive(), control=control), scene, path).pins
    assert_allclose(pin.luminance, seen, atol=1e-12)
    commands, after = pin.commands, pin.state.decision
    assert_allclose(commands.times, [0.035, 0.065, 0.085])
    assert (after.on, after.switched) == (False, True)
    assert after.pending == pytest.approx((0.105,))
    assert_allclose(commands.spans(0.0, 0.1), [(0.035, 0.065), (0.085, 0.1)])

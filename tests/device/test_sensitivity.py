"""Derivatives of the motion of a pin in a scan, beside differences of whole scans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest

from pindrive import Contact, Drive
from pindrive.device import (
    Coil,
    ControlBlock,
    DataSheet,
    Device,
    Electromagnet,
    PinArray,
    PinScan,
    Scene,
    scan,
    strokes,
)
from pindrive.device.coil import COIL_NEEDS
from tactile_mouse import DAMPED, RIGID, SKIN, coil, drive

STEP = 1e-6  # of the size of a parameter
FINGERS = {"rigid": RIGID, "skin": SKIN, "damped": DAMPED}
CONTROL = ControlBlock(latency=0.0023)
COIL = coil(release_resistance=2.0, saturation_field=0.5)
HOT = replace(COIL, thermal_resistance=40.0, heat_capacity=0.02)
LIFTED = replace(COIL, lift=4e-5, closing_force=0.2)
VOLTAGE = [(0.0, 2.9), (0.004, 1.5)]


def of_contact(contact: str, name: str) -> Callable[[Device, float], Device]:
    def changed(device: Device, by: float) -> Device:
        part = getattr(device.drive, contact)
        drive = replace(
            device.drive, **{contact: replace(part, **{name: getattr(part, name) + by})}
        )
        return replace(device, drive=drive)

    return changed


def of(part: str, name: str) -> Callable[[Device, float], Device]:
    def changed(device: Device, by: float) -> Device:
        before = getattr(device, part)
        return replace(device, **{part: replace(before, **{name: getattr(before, name) + by})})

    return changed


def of_saturation(device: Device, by: float) -> Device:
    """Change the saturation at constant times of the magnet, as in a device file."""
    before = device.magnet
    names = ("hold_force", "rise_time", "fall_time", "residual", "pwm_frequency", "pwm_duty")
    given = {name: getattr(before, name) for name in names}
    magnet = Electromagnet.from_times(**given, saturation=before.saturation + by)
    return replace(device, magnet=magnet)


CHANGES = {
    **{name: of("drive", name) for name in ("mass", "stiffness", "damping", "preload")},
    "plate_kinetic": of_contact("plate", "kinetic"),
    "finger_kinetic": of_contact("finger", "kinetic"),
    "finger_static": of_contact("finger", "static"),
    **{
        f"magnet.{name}": of("magnet", name)
        for name in ("hold_force", "residual", "rise_constant", "fall_constant")
    },
    "magnet.saturation": of_saturation,
    "control.latency": of("control", "latency"),
}


def of_coil(name: str, **more: Any) -> Callable[[Device, float], Device]:
    def changed(device: Device, by: float) -> Device:
        coil = device.magnet.coil
        assert coil is not None
        moved = replace(coil, **{name: getattr(coil, name) + by})
        magnet = Electromagnet.from_coil(moved, residual=device.magnet.residual, **more)
        return replace(device, magnet=magnet)

    return changed


def device(finger: str = "rigid", axis: float = 0.0, **parts: Any) -> Device:
    given: dict[str, Any] = {
        "drive": drive(FINGERS[finger], preload=0.02),
        "magnet": Electromagnet.from_times(hold_force=1.2, residual=0.02, saturation=0.8),
        "control": CONTROL,
        "array": PinArray.grid(1, 1, 0.003, axis=radians(axis)),
    }
    return Device(**(given | parts))


def scanned(given: Device) -> PinScan:
    scene = Scene.from_grating((0.004, 0.009), count=2, margin=0.006)
    left, right, _, _ = scene.extent
    way = [(left + 0.003, scene.lines[0]), (right - 0.003, scene.lines[0])]
    return scan(given, scene, strokes(way, 0.06)).pins[0]


def compare(given: Device, parameter: str, change: Callable[[Device, float], Device]) -> None:
    pin = scanned(given)
    times = np.linspace(0.0, pin.end - pin.begin, 400)[1:-1]
    slopes = pin.sensitivity([parameter])
    step = STEP * slopes.sizes[0]
    more, less = (scanned(change(given, by)).motion.position(times) for by in (step, -step))
    found, expected = slopes.position(times)[0], (more - less) / (2 * step)
    assert not slopes.gaps
    assert np.abs(found).max() > 0
    noise = 0.01 * np.abs(pin.motion.position(times)).max() / slopes.sizes[0]  # of differences
    assert np.abs(found - expected).max() < 1e-5 * max(np.abs(found).max(), noise)
    units = slopes.to_dataset().parameter_unit
    assert units.item()


@pytest.mark.parametrize("axis", [0.0, 25.0], ids=["along", "oblique"])
@pytest.mark.parametrize("finger", FINGERS)
@pytest.mark.parametrize("parameter", CHANGES)
def test_derivatives_are_those_of_whole_scans(parameter: str, finger: str, axis: float) -> None:
    """The hand and the page alone decide when a coil is switched, so a scan changes smoothly."""
    compare(device(finger, axis), parameter, CHANGES[parameter])


@pytest.mark.parametrize(
    "name", ["hold_force", "hold_current", "resistance", "inductance", "supply_voltage"]
)
def test_numbers_of_a_data_sheet(name: str) -> None:
    sheet = DataSheet(
        hold_force=1.2, resistance=25.0, inductance=0.04, supply_voltage=5.0, hold_current=0.21
    )
    given = device(magnet=Electromagnet.from_coil(sheet))
    compare(given, f"magnet.{name}", of_coil(name))


@pytest.mark.parametrize("name", ["stiffness", "damping"])
def test_the_skin(name: str) -> None:
    compare(device("damped"), f"finger.{name}", of_contact("finger", name))


@pytest.mark.parametrize("name", ["pwm_frequency", "pwm_duty"])
def test_pulses(name: str) -> None:
    pulsed = Electromagnet.from_times(hold_force=1.2, pwm_frequency=437.0, pwm_duty=0.8)
    compare(device(magnet=pulsed), f"magnet.{name}", of("magnet", name))


@pytest.mark.parametrize(
    ("coil", "name"),
    [
        *((LIFTED, name) for name in COIL_NEEDS),
        *((LIFTED, name) for name in ("release_resistance", "lift", "closing_force")),
        (COIL, "saturation_field"),
        (HOT, "thermal_resistance"),
        (HOT, "heat_capacity"),
        (HOT, "turns"),
    ],
)
def test_numbers_of_a_coil(coil: Coil, name: str) -> None:
    compare(device(magnet=Electromagnet.from_coil(coil)), f"magnet.{name}", of_coil(name))


@pytest.mark.parametrize("name", ["supply_voltage", "gap"])
def test_a_voltage_over_time_holds(name: str) -> None:
    magnet = Electromagnet.from_coil(LIFTED, voltage=VOLTAGE)
    compare(device(magnet=magnet), f"magnet.{name}", of_coil(name, voltage=VOLTAGE))


def test_the_normal_force_presses_on_coefficients_too() -> None:
    pressed = drive(plate=Contact(coefficient=0.22, static_coefficient=0.27), preload=0.02)
    for name in ("mass", "preload"):
        compare(device(drive=pressed), name, of("drive", name))


@pytest.mark.parametrize(
    ("parameter", "magnet"),
    [
        ("magnet.hold_force", Electromagnet.from_coil(COIL)),
        ("magnet.lift", Electromagnet.from_coil(COIL)),
        ("magnet.pwm_duty", Electromagnet.from_times()),
        ("magnet.weight", Electromagnet.from_times()),
    ],
    ids=["of a coil", "no lift", "no pulses", "unknown"],
)
def test_parameters_that_a_device_does_not_have(parameter: str, magnet: Electromagnet) -> None:
    with pytest.raises(ValueError, match=parameter):
        scanned(device(magnet=magnet)).sensitivity([parameter])


@pytest.mark.parametrize(
    ("key", "change"),
    [
        ("magnet.rise_time", "rise_time"),
        ("magnet.fall_time", "fall_time"),
        ("magnet.saturation", "saturation"),
    ],
)
def test_keys_of_a_magnet_hold_the_times_of_the_file(key: str, change: str) -> None:
    given = {"hold_force": 1.0, "rise_time": 0.004, "fall_time": 0.006, "saturation": 0.8}

    def changed(to: Device, step: float) -> Device:
        times = given | {change: given[change] + step}
        return replace(to, magnet=Electromagnet.from_times(**times))

    compare(device(magnet=Electromagnet.from_times(**given)), key, changed)


@pytest.mark.parametrize("name", ["mass", "stiffness", "damping_ratio"])
def test_keys_of_a_drive_include_the_damping_of_its_ratio(name: str) -> None:
    given: dict[str, Any] = {"mass": 0.01, "stiffness": 100.0, "damping_ratio": 0.2}
    more: dict[str, Any] = {"plate": Contact(0.02, 0.025), "finger": Contact(0.005)}

    def changed(to: Device, step: float) -> Device:
        return replace(to, drive=Drive(**given | {name: given[name] + step}, **more))

    compare(device(drive=Drive(**given, **more)), f"drive.{name}", changed)


def test_keys_without_a_ratio_are_names() -> None:
    pin = scanned(device())
    times = np.linspace(0.0, pin.end - pin.begin, 200)
    for key, name in (("drive.mass", "mass"), ("drive.damping", "damping")):
        found = pin.sensitivity([key, name]).position(times)
        np.testing.assert_array_equal(found[0], found[1])

"""Values of a device file set in SI equal values set in its text."""

from __future__ import annotations

from pathlib import Path

import pytest

from pindrive.files.device import DeviceFile, device_of, load_device
from pindrive.files.overrides import ConfigError
from pindrive.quantities.quantity import Rows

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
MOUSE, READER = EXAMPLES / "tactile-mouse.toml", EXAMPLES / "tactile-reader.toml"


def same(one: DeviceFile, other: DeviceFile) -> bool:
    """Return True if two device files describe one device, to the last bit."""
    names = ("drive", "release", "duration", "settling_band", "given", "whole")
    return all(getattr(one, name) == getattr(other, name) for name in names)


Values = dict[str, float | Rows]
ANY: list[Values] = [
    {"drive.mass": 0.012},
    {"drive.damping": 0.2},
    {"drive.damping_ratio": 0.01},
    {"motion.mouse_velocity": ((0.0, 0.06), (0.04, 0.0))},
]
OF_FORCES: list[Values] = [
    {"plate.kinetic": 0.03},
    {"plate.kinetic": 0.03, "plate.static": 0.05},
    {"finger.kinetic": 0.011, "finger.stiffness": 150.0},
    {"finger.kinetic": 0.011, "finger.curve": ((0.0, 0.011), (0.1, 0.013))},
]
OF_COEFFICIENTS: list[Values] = [
    {"plate.coefficient": 0.25},
    {"finger.touch_force": 0.02},
    {"scan.touch": 0.03},
]


@pytest.mark.parametrize(
    ("path", "values"),
    [
        *((MOUSE, values) for values in ANY + OF_FORCES),
        *((READER, values) for values in ANY + OF_COEFFICIENTS),
    ],
    ids=lambda given: given.stem if isinstance(given, Path) else "-".join(given),
)
def test_values_in_si_equal_values_in_the_text(path: Path, values: Values) -> None:
    scalar = {key: value for key, value in values.items() if isinstance(value, float)}
    device = load_device(path)
    found = device.with_values(values)
    if scalar == values:
        assert same(found, load_device(path, values))
    assert same(found, device_of(path, found.tables, whole=found.whole is not None))
    assert device == load_device(path)
    assert found.settings != device.settings


def test_static_friction_keeps_its_ratio_to_kinetic_friction() -> None:
    found = load_device(MOUSE).with_values({"plate.kinetic": 0.033}).drive.plate
    assert found.static == pytest.approx(0.033 * 26.5 / 22.0, rel=1e-15)


def test_a_value_beyond_another_is_refused_with_its_file() -> None:
    with pytest.raises(ConfigError, match=r"plate\.static") as refused:
        load_device(MOUSE).with_values({"plate.kinetic": 0.03, "plate.static": 0.01})
    assert len(refused.value.problems) == 1


def test_a_drive_gets_the_usual_device_around_it() -> None:
    assert load_device(MOUSE).whole is None
    found = load_device(MOUSE).with_values({"drive.mass": 0.012}, whole=True)
    assert found.whole == load_device(MOUSE, {"mass": "12 g"}, whole=True).whole


@pytest.mark.parametrize(
    "path", [MOUSE, READER, EXAMPLES / "stribeck-skin.toml"], ids=lambda p: p.stem
)
def test_a_drive_and_a_release_make_the_device_of_their_file(path: Path) -> None:
    device = load_device(path)
    found = DeviceFile.of(device.drive, device.release)
    assert (found.drive, found.release) == (device.drive, device.release)
    assert found.with_values({"drive.mass": 0.02}).drive.mass == 0.02
    ratio = found.drive.damping_ratio
    assert found.with_values({"drive.damping_ratio": ratio}).drive.damping == found.drive.damping

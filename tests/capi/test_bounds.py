"""One table of bounds: Python and C refuse alike, value by value and word by word."""

from __future__ import annotations

import re
import sys
from ctypes import byref, c_double, c_void_p
from math import inf, nan, nextafter
from pathlib import Path

import numpy as np
import pytest

from c_interface import Interface
from pindrive import _core
from pindrive.files.device import load_device
from pindrive.files.overrides import ConfigError
from pindrive.quantities.table import QUANTITIES, check

pytestmark = [
    pytest.mark.timeout(1800),
    pytest.mark.skipif(
        sys.platform == "win32", reason="where the library lies is tested on the others"
    ),
]

ALONE = {
    **{"drive.mass": 0.01, "drive.stiffness": 100.0, "plate.kinetic": 0.02},
    **{"finger.kinetic": 0.005, "magnet.residual": 0.0},
}
"""A device whose other numbers are good."""
COIL = {
    **{"magnet.turns": 250.0, "magnet.pole_area": 3e-6, "magnet.gap": 1e-4},
    **{"magnet.wire_diameter": 1e-4, "magnet.turn_length": 0.01, "magnet.supply_voltage": 5.0},
}
TABLES = ("drive", "plate", "finger", "magnet", "control")
NOT_IN_C = {
    *("plate.curve", "plate.coefficient_curve", "finger.curve", "finger.coefficient_curve"),
    *("magnet.voltage", "magnet.outer_diameter", "magnet.height", "magnet.temperature_rise"),
    *("magnet.spring_height", "magnet.pin_height"),
}
"""Rows, and what the motion does not depend on."""
NAMES = {quantity.key: name for name, quantity in QUANTITIES.items()}


def spoiled(key: str) -> list[float]:
    """Values beyond the bounds of a key, some by the last bit."""
    quantity = QUANTITIES[NAMES[key]]
    least = max(quantity.bounds.lower, quantity.limits.lower)
    most = min(quantity.bounds.upper, quantity.limits.upper)
    given = [nextafter(least, -inf), nextafter(most, inf), -1.0, 0.0, 1e300, inf, -inf, nan]
    return [
        value for value in given if value not in quantity.bounds or value not in quantity.limits
    ]


def refusal(key: str, value: float) -> str:
    with pytest.raises(ValueError, match="must be") as found:
        check(NAMES[key], value)
    return required(str(found.value))


def required(message: str) -> str:
    """The values that a message allows."""
    found = re.search(r" must be (.*), got ", message)
    assert found, message
    return found[1]


@pytest.mark.parametrize("table", TABLES)
def test_python_and_c_refuse_the_same_values_in_the_same_words(table: str, c_library: Path) -> None:
    c = Interface(c_library)
    c.library.pindrive_device_new.restype = c_void_p
    count = 0
    for key, *_ in _core.input_quantities():
        if not key.startswith(f"{table}.") or key in NOT_IN_C:
            continue
        for value in spoiled(key):
            device, scan = c_void_p(c.library.pindrive_device_new()), c_void_p()
            other = COIL if key in COIL or "field" in key or "therm" in key else {}
            for name, number in (ALONE | other | {key: value}).items():
                c("device_set", device, name.encode(), c_double(number))
            if "lift" in key or "closing" in key:
                c("device_set", device, b"magnet.lift", c_double(1e-4))
                c("device_set", device, key.encode(), c_double(value))
            numbers = map(c_double, (0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
            error = c.library.pindrive_scan_new(device, *numbers, byref(scan))
            message = c.library.pindrive_last_error().decode()
            assert error == 3, f"{key} = {value!r}: {error}, {message}"
            assert message.startswith(f"{key} must be "), f"{value!r}: {message}"
            assert required(message) == refusal(key, value)
            c.free(device=device)
            count += 1
    assert count > 15


# ---- contradictions ------------------------------------------------------------------------------

GOOD = {
    **{"drive.mass": 0.001, "drive.stiffness": 250.0, "drive.damping_ratio": 0.5},
    **{"plate.coefficient": 0.225, "plate.static_coefficient": 0.27},
    **{"finger.kinetic": 0.02, "finger.static": 0.03, "magnet.hold_force": 1.0},
    **{"control.threshold": 0.5, "control.hysteresis": 0.1},
}
SPOILED = {
    **{"plate.kinetic": 0.02, "plate.static_coefficient": 0.1, "plate.preload": 0.01},
    **{"finger.static": 0.01, "finger.coefficient": 0.5, "finger.touch_force": 0.06},
    **{"drive.stop_stiffness": 1e4, "drive.stop_damping": 4.0, "drive.travel": 2e-3},
    **{"magnet.residual": 2.0, "magnet.pwm_duty": 0.5, "magnet.pwm_frequency": 400.0},
    **{"control.hysteresis": 0.4, "control.threshold": 0.9, "drive.mass": -1.0},
    **{"magnet.hold_force": 1e5, "control.latency": nan, "magnet.saturation": 0.0},
    **{"magnet.closing_force": 0.1, "finger.stiffness": 300.0, "plate.coefficient": 0.0},
}
"""Values that do not fit to a good device, each by itself or with others."""


def in_python(numbers: dict[str, float], path: Path) -> set[str]:
    """The values that Python requires; empty of a device that it takes."""
    tables: dict[str, list[str]] = {}
    for key, value in numbers.items():
        table, _, name = key.partition(".")
        unit = QUANTITIES[NAMES[key]].unit
        text = f"{value!r}" if unit == "1" else f'"{value!r} {unit}"'
        tables.setdefault(table, []).append(f"{name} = {text}")
    tables["motion"] = ['displacement = "0 m"', 'velocity = "0 m/s"']
    path.write_text(
        "\n".join(f"[{table}]\n" + "\n".join(rows) for table, rows in tables.items()), "utf-8"
    )
    try:
        load_device(path)
    except ConfigError as error:
        said = [problem.replace('"', "") for problem in error.problems]  # it quotes the file
        return {" must be " + problem.rpartition(" must be ")[2] for problem in said}
    return set()


def test_python_and_c_refuse_the_same_devices(c_library: Path, tmp_path: Path) -> None:
    c, random = Interface(c_library), np.random.default_rng(45)
    c.library.pindrive_device_new.restype = c_void_p
    refused = 0
    for _ in range(500):
        keys = random.choice(sorted(SPOILED), random.integers(1, 4), replace=False)
        numbers = GOOD | {key: SPOILED[key] for key in keys}
        device, scan = c_void_p(c.library.pindrive_device_new()), c_void_p()
        for name, number in numbers.items():
            c("device_set", device, name.encode(), c_double(number))
        places = map(c_double, (0.0, 0.0, 0.0, 0.0, 0.0, 1.0))
        error = c.library.pindrive_scan_new(device, *places, byref(scan))
        message = c.library.pindrive_last_error().decode() if error else ""
        expected = in_python(numbers, tmp_path / "device.toml")
        assert bool(error) == bool(expected), f"{numbers}: {message or expected}"
        if error:
            found = " must be " + message.rpartition(" must be ")[2]
            assert found in expected, f"{numbers}: {message}, {expected}"
        else:
            c.free(scan=scan)
        c.free(device=device)
        refused += bool(error)
    assert 250 < refused < 500

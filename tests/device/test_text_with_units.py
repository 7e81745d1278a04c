"""The parts of a device take text with a unit wherever they take a number."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from pindrive.device import (
    Coil,
    ControlBlock,
    Criteria,
    Electromagnet,
    PinArray,
    Scene,
    lines,
    strokes,
)

# What makes a part of a device, with numbers in SI and with text.
PARTS: dict[str, tuple[Callable[..., Any], dict[str, Any], dict[str, Any]]] = {
    "control block": (
        ControlBlock,
        {"sample_rate": 500.0, "latency": 0.003, "threshold": 0.4, "hysteresis": 0.2},
        {"sample_rate": "0.5 kHz", "latency": "3 ms", "threshold": "40 %", "hysteresis": "0.2"},
    ),
    "electromagnet": (
        Electromagnet,
        {"hold_force": 1.5, "fall_constant": 0.002},
        {"hold_force": "1500 mN", "fall_constant": "2 ms"},
    ),
    "electromagnet by its times": (
        Electromagnet.from_times,
        {"hold_force": 1.5, "rise_time": 0.002, "residual": 0.01},
        {"hold_force": "1.5 N", "rise_time": "2 ms", "residual": "10 mN"},
    ),
    "coil": (
        Coil,
        {
            "turns": 500.0,
            "pole_area": 2e-5,
            "gap": 1e-4,
            "wire_diameter": 1e-4,
            "turn_length": 0.02,
            "supply_voltage": 3.0,
        },
        {
            "turns": "500",
            "pole_area": "20 mm^2",
            "gap": "100 µm",
            "wire_diameter": "0.1 mm",
            "turn_length": "2 cm",
            "supply_voltage": "3 V",
        },
    ),
    "pin array": (
        PinArray,
        {"places": [(0.0, 0.0), (0.005, 0.0)], "pin_diameter": 0.001},
        {"places": [("0 m", "0 m"), ("5 mm", "0 mm")], "pin_diameter": "1 mm"},
    ),
    "grid": (
        PinArray.grid,
        {"columns": 2, "pitch": 0.004, "spot_scale": 0.5},
        {"columns": 2, "pitch": "4 mm", "spot_scale": "50 %"},
    ),
    "criteria": (
        Criteria,
        {"felt": 2e-5, "false_line": 0.5},
        {"felt": "20 µm", "false_line": "50 %"},
    ),
}


@pytest.mark.parametrize("part", PARTS)
def test_text_makes_the_same_part(part: str) -> None:
    make, numbers, texts = PARTS[part]
    assert make(**texts) == make(**numbers)


@pytest.mark.parametrize("part", PARTS)
def test_text_of_another_kind_is_refused(part: str) -> None:
    make, _, texts = PARTS[part]
    name = next(name for name, value in texts.items() if isinstance(value, str))
    with pytest.raises(ValueError) as refused:
        make(**texts | {name: "3 kg"})
    assert str(refused.value).startswith(f"{name} must be ")
    assert str(refused.value).endswith('got "3 kg"')


def test_pages_and_hands() -> None:
    text = Scene.from_text("ab", height="8 mm", pixel="0.2 mm", margin="4 mm", line_pitch="12 mm")
    same = Scene.from_text("ab", height=0.008, pixel=2e-4, margin=0.004, line_pitch=0.012)
    assert np.array_equal(text.luminance, same.luminance) and text.pixel == same.pixel
    grating = Scene.from_grating(["4 mm", "6 mm"], height="5 mm", margin="3 mm")
    same = Scene.from_grating([0.004, 0.006], height=0.005, margin=0.003)
    assert np.array_equal(grating.luminance, same.luminance)
    path = strokes([("0 mm", "5 mm"), ("100 mm", "5 mm")], "60 mm/s", pause="0.1 s")
    same_path = strokes([(0.0, 0.005), (0.1, 0.005)], 0.06, pause=0.1)
    assert np.array_equal(path.x, same_path.x) and np.array_equal(path.times, same_path.times)
    page = lines(["5 mm"], "0 m", "10 cm", speed="60 mm/s", return_speed="0.1 m/s")
    assert page.end == lines([0.005], 0.0, 0.1, speed=0.06, return_speed=0.1).end
    with pytest.raises(ValueError, match=r'^margin must be in m or a unit alike, like "5 mm"'):
        Scene.from_text("ab", margin="3 s")

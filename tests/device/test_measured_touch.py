"""Scans with damped skin, friction that follows the touch by a power, and touch on the plate."""

from __future__ import annotations

import numpy as np
import pytest

from oracle.scan_cycles import distance
from pindrive import Contact, Drive, Profile
from pindrive.device import Device, Electromagnet, PinArray, Scan, Scene, scan, strokes
from random_scans import sampled


def drawn(seed: int) -> tuple[Scan, np.random.Generator]:
    """A scan of up to sixteen pins, near the values of the example."""
    draw = np.random.default_rng(seed)

    def near(value: float) -> float:
        return float(value * np.exp(draw.uniform(-0.7, 0.7)))

    mass, stiffness = near(0.001), near(100.0)
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping_ratio=near(0.2),
        plate=Contact(coefficient=0.225, static_coefficient=0.27),
        finger=Contact(
            coefficient=near(0.5),
            static_coefficient=1.6,
            stiffness=near(300.0),
            damping=near(0.3),
        ),
        touch_force=0.060,
        touch_share=float(draw.choice([0.0, 0.5, 1.0])),
        load_exponent=float(draw.choice([2 / 3, 1.0, 1.2])),
        reference_touch=0.1,
    )
    columns, rows = int(draw.integers(1, 5)), int(draw.integers(1, 5))
    device = Device(
        drive=drive,
        magnet=Electromagnet.from_times(hold_force=near(1.0), residual=0.005),
        array=PinArray.grid(columns, rows, 0.002),
    )
    scene = Scene.from_grating([near(0.003)], count=4, margin=0.008, pixel=2e-4)
    left, right, _, _ = scene.extent
    way = (left + 0.003, scene.lines[0]), (right - 0.003, scene.lines[0])
    path = sampled(strokes(way, near(0.06), pause=0.02))
    ends = 0.06 * draw.uniform(0.2, 2.0, 3)
    touch = Profile([0.0, 0.4 * path.end, 0.8 * path.end], ends.tolist())
    return scan(device, scene, path, touch=touch), draw


@pytest.mark.parametrize("seed", range(20))
def test_twenty_scans_against_sundials(seed: int) -> None:
    found, draw = drawn(seed)
    assert 1 <= len(found.pins) <= 16
    pin = found.pins[int(draw.integers(len(found.pins)))]
    assert pin.commands.times.size
    apart = distance(pin)
    assert apart.events
    assert apart.time < 1e-8
    assert apart.state < 1e-8
    assert pin.motion.certificate().worst < 1e-11

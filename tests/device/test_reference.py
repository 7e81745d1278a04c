"""Page, control block and coil of random devices equal the replaced ones in Python."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.coil_course import ReferenceMagnet, decide
from pindrive import Function
from pindrive.device import CoilState, Commands, HandPath, Scene, scan
from random_scans import RandomScan, random_magnet

PARTS = ("begins", "starts", "targets", "constants", "inductances")


def test_currents_and_pulls_of_random_magnets() -> None:
    rng, compared = np.random.default_rng(5), 0
    for _ in range(200):
        magnet = random_magnet(rng)
        if magnet is None:
            continue
        commands = Commands(np.sort(rng.uniform(0.0, 0.2, rng.integers(1, 12))))
        reference = ReferenceMagnet(magnet)
        expected = reference.current(commands, CoilState(), 0.0, 0.2)
        found = magnet.current(commands, CoilState(), 0.0, 0.2)
        within = expected.begins < 0.2
        for part in PARTS:
            np.testing.assert_allclose(
                getattr(found, part), getattr(expected, part)[within], rtol=1e-12, atol=1e-15
            )
        t = np.linspace(0.0, 0.2, 401)
        np.testing.assert_allclose(
            found.pull(t), reference.pull_of(expected, t), rtol=1e-11, atol=1e-13
        )
        compared += 1
    assert compared > 120


def luminance(scene: Scene, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """`Scene.at` by NumPy."""
    (rows, columns), (x0, y0) = scene.luminance.shape, scene.origin

    def between(place: NDArray[np.float64], count: int) -> tuple[NDArray[Any], ...]:
        middle = np.clip(place - 0.5, 0.0, count - 1.0)
        i = np.minimum(middle.astype(np.intp), max(count - 2, 0))
        return i, np.minimum(i + 1, count - 1), middle - i

    inside = scene.contains(x, y)
    i, i1, u = between((x - x0) / scene.pixel, columns)
    j, j1, w = between((y - y0) / scene.pixel, rows)
    above = scene.luminance[j, i] * (1.0 - u) + scene.luminance[j, i1] * u
    below = scene.luminance[j1, i] * (1.0 - u) + scene.luminance[j1, i1] * u
    return np.where(inside, above * (1.0 - w) + below * w, 1.0)


def position(path: HandPath, t: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
    """`HandPath.position` by NumPy."""
    i = np.clip(np.searchsorted(path.times, t, "right") - 1, 0, len(path.times) - 2)
    since = t - path.times[i]
    part = since / (path.times[i + 1] - path.times[i])
    return tuple(
        place[i] + since * (v[i] + 0.5 * ((v[i + 1] - v[i]) * part))
        for place, v in ((path.x, path.vx), (path.y, path.vy))
    )


@pytest.mark.parametrize("kind", ["plain", "oblique"])
def test_commands_and_loads_of_random_scans(kind: str) -> None:
    """Luminance and commands to the bit, the load to the last digits."""
    switchings = 0
    for seed in range(40):
        case = RandomScan.of(seed, oblique=kind == "oblique").linear()
        (pin,) = scan(case.device, case.scene, case.path).pins
        x, y = position(case.path, pin.sample_times)
        (dx, dy), *_ = case.device.array.on_page(case.device.array.spots)
        np.testing.assert_array_equal(pin.luminance, luminance(case.scene, x + dx, y + dy))
        control = case.device.control
        commands, decision = decide(control, pin.luminance, pin.sample_times, case.path.end)
        np.testing.assert_array_equal(pin.commands.times, commands.times)
        assert pin.state.decision == decision
        reference = ReferenceMagnet(case.device.magnet)
        current = reference.current(commands, CoilState(pin.begin), pin.begin, pin.end)
        if len(commands.times):
            t = np.linspace(pin.begin, pin.end, 401)
            load = case.device.load(reference.pull_of(current, t))
            assert isinstance(pin.load, Function)
            np.testing.assert_allclose(pin.load(t - pin.begin), load, rtol=1e-11)
        switchings += len(commands.times)
    assert switchings > 100

"""Force of all pins on the hand: balance, quadrature, energy, and every interface that has it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import pindrive as pd
from command import EXAMPLES
from pindrive.device.scanning import Scan

READER = EXAMPLES / "tactile-reader.toml"


@pytest.fixture(scope="module")
def done() -> Scan:
    device = pd.load_device(READER, whole=True)
    return pd.scan(device, pd.Page(grating=["4 mm", "6 x 3 mm"]))


def test_the_force_is_that_of_spring_damper_and_skin(done: Scan) -> None:
    drive = done.device.drive
    t = np.linspace(done.path.begin, done.path.end, 997)
    expected = np.zeros(t.shape)
    for pin in done.pins:
        since = pin.since(t)
        expected += drive.stiffness * pin.motion.position(since)
        expected += drive.damping * pin.motion.velocity(since)
        expected -= pin.motion.force("finger", since)
    np.testing.assert_allclose(done.force_on_hand(t), expected, rtol=1e-13, atol=1e-15)


def test_largest_mean_and_work_are_those_of_a_fine_sum(done: Scan) -> None:
    t = np.linspace(done.path.begin, done.path.end, 200_001)
    force = done.force_on_hand(t)
    speed = done.path.plate_velocity(done.device.array.axis)(t - done.path.begin)
    found = done.hand_force
    assert found.largest == pytest.approx(np.abs(force).max(), rel=1e-4)
    assert abs(done.force_on_hand(found.time)) == pytest.approx(found.largest, rel=1e-6)
    assert found.mean == pytest.approx(np.trapezoid(force, t) / (t[-1] - t[0]), rel=1e-5)
    assert found.work == pytest.approx(np.trapezoid(force * speed, t), rel=1e-5)


def test_the_work_of_the_hand_is_what_the_pins_dissipate(done: Scan) -> None:
    """Plate at rest, pins at rest at the end: friction and dampers take all the work."""
    taken = 0.0
    for pin in done.pins:
        ledger = pin.motion.energy
        parts = ("plate", "finger", "skin", "damper", "stop")
        taken += sum(getattr(ledger, f"{name}_dissipated") for name in parts)
        for name in ("spring", "skin", "stop"):
            taken += getattr(ledger, f"{name}_end") - getattr(ledger, f"{name}_start")
    assert done.hand_force.work == pytest.approx(taken, rel=1e-9)


def test_dataset_and_warning_tell_it(done: Scan) -> None:
    data: xr.Dataset = done.to_dataset()
    np.testing.assert_array_equal(data.hand_force, done.force_on_hand(data.time.values))
    assert data.attrs["hand_force_largest"] == done.hand_force.largest
    assert data.hand_force.attrs["units"] == "N"
    assert any("more than 0.77 N, the largest published force" in w for w in done.warnings)
    one = pd.load_device(READER, ["array.columns=1", "array.rows=1"], whole=True)
    assert not any("push the hand" in w for w in pd.scan(one, pd.Page(grating=["4 mm"])).warnings)


def test_a_release_has_it() -> None:
    finger = pd.Contact(0.005, 0.0075)
    drive = pd.Drive(mass=0.01, stiffness=100, damping=0.3, plate=pd.Contact(0.02), finger=finger)
    motion = pd.simulate(drive, pd.Release(mouse_velocity=0.06, displacement=2e-3))
    t = np.linspace(0.0, 0.1, 101)
    balance = motion.force("plate", t) - drive.mass * motion.acceleration(t)
    np.testing.assert_allclose(motion.housing_force(t), balance, rtol=0.0, atol=1e-15)
    np.testing.assert_array_equal(motion.columns(t)["housing_force"], motion.housing_force(t))

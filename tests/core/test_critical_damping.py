"""Critical damping, and damping that falling friction cancels, as a user meets them."""

from math import sqrt

import numpy as np
import pytest

from command import EXAMPLE, run
from pindrive import Contact, Drive, Release, simulate, simulate_batch


@pytest.mark.parametrize("mass", ["11 g", "12 g", "13 g", "15 g"])
def test_a_critically_damped_pin_decays(mass: str) -> None:
    result = run("simulate", EXAMPLE, "--set", "damping_ratio=1", "--set", f"mass={mass}")
    assert result.exit_code == 0
    assert "Decays towards x = 0.2700 mm" in result.output


def test_no_point_of_a_grid_through_critical_damping_stands_out() -> None:
    """Every fiftieth ratio is 1 but for the rounding of the damping that is computed from it."""
    mass = np.linspace(5e-3, 20e-3, 61)[:, None]
    ratio = np.linspace(0.98, 1.02, 101)
    drive = Drive(
        mass=0.01,
        stiffness=100.0,
        damping=2.0,
        plate=Contact(0.022, 0.0265),
        finger=Contact(0.005, 0.0075),
    )
    damping = ratio * 2 * np.sqrt(mass * 100.0)
    numbers = simulate_batch(drive, Release(0.06, 2e-3), mass=mass, damping=damping)
    time = np.sqrt(mass / 100.0)
    assert float((numbers["duration"] / time).max()) < 1000
    assert float(numbers["transient_finger_distance_slid"].max()) < 0.02
    assert float((numbers["transient_settling_time"] / time).max()) < 10


@pytest.mark.parametrize("mass", [2e-3, 7e-3, 10e-3, 40e-3])
@pytest.mark.parametrize("stiffness", [25.0, 150.0, 1000.0])
def test_cancelled_damping_has_one_ending(mass: float, stiffness: float) -> None:
    """20 mN fall to 17 mN over 30 mm/s, which is 0.1 N s/m: no damping is left."""
    plate = Contact(curve=[(0.0, 20e-3), (0.03, 17e-3)])
    drive = Drive(mass=mass, stiffness=stiffness, damping=0.1, plate=plate, finger=Contact(0.0))
    motion = simulate(drive, Release(0.02, 2e-3))
    assert (motion.ending.kind, motion.ending.cycle) == ("steady", "grazing")
    assert motion.ending.amplitude == pytest.approx(0.02 / sqrt(stiffness / mass), rel=1e-12)
    assert motion.ending.period == pytest.approx(2 * np.pi * sqrt(mass / stiffness), rel=1e-12)
    assert motion.certificate().worst < 1e-12


def test_every_derivative_goes_over_smoothly() -> None:
    """Derivatives by the damping, at critical damping and 1e-8 to either side."""

    def slopes(damping: float) -> dict[str, float]:
        drive = Drive(
            mass=0.01,
            stiffness=100.0,
            damping=damping,
            plate=Contact(kinetic=0.022, static=0.0265),
            finger=Contact(kinetic=0.005, static=0.0075),
        )
        motion = simulate(drive, Release(0.06, 2e-3), duration=0.5)
        numbers = motion.sensitivity(["damping"]).numbers
        return {name: values["damping"] for name, values in numbers.items()}

    critical, below, above = slopes(2.0), slopes(2.0 * (1 - 1e-8)), slopes(2.0 * (1 + 1e-8))
    assert np.isfinite(list(critical.values())).sum() > 20
    for name, slope in critical.items():
        near = pytest.approx(slope, rel=1e-6, abs=1e-15, nan_ok=True)
        assert below[name] == near and above[name] == near, name

"""Springs that stand on the ground, beside a plate whose speed changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import pindrive as pd
from pindrive import Contact, Drive, Function, Profile, Release, harmonic, minimum_jerk, simulate

NONE = Contact(kinetic=0.0)
BODY = Drive(mass=1.0, stiffness=100.0, damping=0.0, plate=Contact(1.0, 2.0), finger=NONE)
START = Profile([0.0, 0.05], [0.0, 0.3])
"""A belt that reaches 0.3 m/s in 50 ms."""

pytestmark = pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")


def test_body_beside_a_belt_that_starts_never_sticks_again() -> None:
    """The belt accelerates at 6 m/s², more than 2 N do with 1 kg: a free oscillation of 10 mm."""
    ground = simulate(BODY, Release(START, support="ground"))
    assert ground.ending.cycle == "free"
    assert ground.ending.amplitude == pytest.approx(0.01, rel=1e-3)
    assert not ground.events
    mouse = simulate(BODY, Release(START))
    assert mouse.ending.cycle == "stick-slip"


def test_body_on_the_ground_is_that_of_an_integrator() -> None:
    motion = simulate(BODY, Release(START, support="ground"))
    found = solve_ivp(
        lambda _, y: [y[1], 1.0 - 100.0 * y[0]], (0.0, 0.05), [0.0, 0.0], rtol=1e-12, atol=1e-14
    )
    assert motion.position(0.05) == pytest.approx(found.y[0, -1], rel=1e-10)


def test_first_slip_of_a_published_belt_oscillator() -> None:
    """Stick-slip example of PathSim 0.1 (belt speed 3 sin(2πt/50) m/s), by events of 1e-14."""
    drive = Drive(mass=20.0, stiffness=70.0, damping=10.0, plate=Contact(441.45), finger=NONE)
    release = Release(harmonic(0.0, 3.0, 0.02), velocity=0.0, support="ground")
    motion = simulate(drive, release, duration=50.0)
    first = motion.events[0]
    assert first.kind == "slip"
    assert first.time == pytest.approx(5.738357478544753, rel=1e-14)


@pytest.mark.parametrize(
    ("velocity", "inertia"),
    [
        (START, Profile([0.0, 0.05, 0.05, 1.0], [-6.0, -6.0, 0.0, 0.0])),
        (harmonic(0.1, 0.05, 2.0), harmonic(0.0, -0.1 * 2.0 * np.pi, 2.0, 0.5 * np.pi)),
    ],
)
def test_ground_is_a_mouse_with_the_opposite_inertial_force(
    velocity: Profile | Function, inertia: Profile | Function
) -> None:
    times = np.linspace(0.0, 3.0, 601)
    for force in (0.0, harmonic(0.0, 0.4, 1.3)):
        both = force + inertia if isinstance(force, Function) else inertia
        x, y = (
            simulate(BODY, Release(velocity).replace(**more), duration=3.0).position(times)
            for more in ({"force": force, "support": "ground"}, {"force": both})
        )
        np.testing.assert_allclose(x, y, atol=1e-12)


def test_ledger_of_the_ground_has_no_inertial_work() -> None:
    motion = simulate(BODY, Release(minimum_jerk(0.1, 1.0), support="ground"), duration=1.5)
    assert motion.energy.inertia_work == 0.0
    assert abs(motion.energy.residual) <= 1e-12 * motion.energy.plate_work
    assert motion.certificate().worst < 1e-10


@pytest.mark.parametrize("name", ["mass", "stiffness", "mouse_velocity.amplitude", "plate_kinetic"])
def test_derivatives_hold_on_the_ground(name: str) -> None:
    drive = BODY.replace(damping=0.4)
    velocity = harmonic(0.1, 0.05, 2.0)
    t = np.linspace(0.0, 1.5, 31)
    motion = simulate(drive, Release(velocity, velocity=0.1, support="ground"), duration=1.5)
    exact = motion.sensitivity([name]).position(t)[0]

    def at(step: float) -> np.ndarray:
        changed, given = drive, velocity
        if name == "mouse_velocity.amplitude":
            given = harmonic(0.1, 0.05 + step, 2.0)
        elif name == "plate_kinetic":
            changed = drive.replace(plate=Contact(1.0 + step, 2.0))
        else:
            changed = drive.replace(**{name: getattr(drive, name) + step})
        release = Release(given, velocity=0.1, support="ground")
        return simulate(changed, release, duration=1.5).position(t)

    step = 1e-5
    found = (at(step) - at(-step)) / (2.0 * step)
    np.testing.assert_allclose(exact, found, atol=1e-6 * np.abs(found).max() + 1e-9)


def test_support_is_a_key_of_files(tmp_path: Path) -> None:
    text = """
[drive]
mass = "1 kg"
stiffness = "100 N/m"
damping = 0
[plate]
kinetic = "1 N"
static = "2 N"
[finger]
kinetic = "0 N"
[motion]
mouse_velocity = [["0 ms", "0 mm/s"], ["50 ms", "300 mm/s"]]
support = "ground"
"""
    text = text.replace("damping = 0", 'damping = "0 N*s/m"')
    path = tmp_path / "belt.toml"
    path.write_text(text, "utf-8")
    device = pd.load_device(path)
    assert device.release.support == "ground"
    assert simulate(device).ending.cycle == "free"
    assert pd.load_device(path, ["support=mouse"]).release.support == "mouse"
    path.write_text(text.replace('"ground"', '"moon"'), "utf-8")
    with pytest.raises(ValueError, match=r"motion\.support must be one of mouse, ground"):
        pd.load_device(path)


def test_other_support_is_rejected() -> None:
    with pytest.raises(ValueError, match='support must be "mouse" or "ground", got'):
        Release(0.1, support="sky")  # type: ignore[arg-type]


def test_fmu_of_a_spring_on_the_ground_is_rejected(tmp_path: Path) -> None:
    from pindrive.files.device import DeviceFile
    from pindrive.files.fmu import write_fmu

    file = DeviceFile.of(BODY, Release(0.1, support="ground"))
    assert file.values()["motion.support"] == 1.0
    with pytest.raises(ValueError, match=r"motion\.support must be mouse in an FMU"):
        write_fmu(file, tmp_path / "belt.fmu")

"""A release: what it takes, in which units, and what it refuses."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from math import inf, nan
from typing import Any

import numpy as np
import pytest

from pindrive import Contact, Drive, Profile, Release, Status, simulate, simulate_batch

DRIVE = Drive(mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005))
STOP = Profile([0.0, 0.1], [0.06, 0.0])
CURVED = Contact(curve=[(0.0, 0.02), (0.1, 0.01)])


def test_left_out_is_at_rest_under_a_constant_load() -> None:
    release = Release(0.06)
    assert release == Release(0.06, 0.0, None, 1.0, None)
    assert (release.displacement, release.velocity, release.plate_load) == (0.0, None, 1.0)
    assert release.skin_stretch is None


def test_the_initial_velocity_is_the_plates_unless_given() -> None:
    assert Release(0.06).initial_velocity == 0.06
    assert Release(0.06, velocity=-0.1).initial_velocity == -0.1
    assert Release(Profile([-0.1, 0.1], [0.06, 0.0])).initial_velocity == 0.03


def test_replace_takes_the_arguments_of_a_release() -> None:
    release = Release("60 mm/s", force=0.01)
    changed = release.replace(displacement="1 mm")
    assert changed == Release(0.06, 0.001, force=0.01)
    with pytest.raises(ValueError, match="displacement must be"):
        release.replace(displacement="far")


def test_energy_is_a_value() -> None:
    release = Release(STOP, 2e-3, plate_load=Profile([0.0, 0.01], [5.0, 1.0]))
    assert pickle.loads(pickle.dumps(release)) == release
    assert hash(release) == hash(replace(release))
    assert replace(release, displacement=1e-3).mouse_velocity is STOP
    with pytest.raises(FrozenInstanceError):
        release.displacement = 0.0  # type: ignore[misc]


def test_text_with_a_unit_is_the_number_in_si() -> None:
    """To the last bit, wherever a number is taken."""
    assert Release("60 mm/s", "1.5 mm", "-10 cm/s", "50 %", "3 µm") == Release(
        0.06, 1.5e-3, -0.1, 0.5, 3e-6
    )
    contact = Contact("20 mN", "26.5 mN", [("0 mm/s", "20 mN"), ("50 mm/s", "15 mN")], "1 N/mm")
    assert contact == Contact(0.02, 0.0265, [(0.0, 0.02), (0.05, 0.015)], 1000.0)
    finger = Contact("5 mN")
    given: dict[str, Any] = {"plate": Contact(0.02), "finger": finger}
    drive = Drive(mass="10 g", stiffness="0.1 N/mm", damping="0.4 N*s/m", **given)
    assert drive == DRIVE
    ratio = Drive(mass="10 g", stiffness="100 N/m", damping_ratio="20 %", **given)
    assert ratio.damping_ratio == pytest.approx(0.2, rel=1e-15)
    assert Profile(["0 ms", "40 ms"], [1.0, 0.0]) == Profile([0.0, 0.04], [1.0, 0.0])
    motion = simulate(drive, Release("60 mm/s", "2 mm"), duration="300 ms", settling_band="2 %")
    assert (motion.duration, motion.settling_band) == (0.3, 0.02)
    batch = simulate_batch(drive, Release("60 mm/s"), mass=["10 g", "12 g"], duration="0.3 s")
    assert batch.mass.values.tolist() == [0.01, 0.012]
    assert batch.duration == 0.3


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Release("60"), "mouse_velocity must be a number with its unit (give a unit, like"),
        (
            lambda: Release("60 mm"),
            'mouse_velocity must be in m/s or a unit alike, like "60 mm/s", got "60 mm"',
        ),
        (lambda: Release(nan), "mouse_velocity must be finite, got nan m/s"),
        (lambda: Release(0.1, "inf m"), 'displacement must be finite, got "inf m"'),
        (
            lambda: Release(0.1, "1,5 mm"),
            "displacement must be a number whose decimal sign is a point",
        ),
        (lambda: Release(0.1, velocity=-inf), "velocity must be finite, got -inf m/s"),
        (
            lambda: Release(0.1, plate_load="-1"),
            'plate_load must be finite and at least 0, got "-1"',
        ),
        (lambda: Release(0.1, plate_load=Profile([0, 1], [1, -1])), "plate_load values[1] must be"),
        (lambda: Release(Profile([0, 0], [0, 1])), "mouse_velocity must be without a step"),
        (
            lambda: Release(0.1, skin_stretch="1 s"),
            "skin_stretch must be in m or a unit alike, like",
        ),
        (lambda: Contact("20 g"), 'kinetic must be in N or a unit alike, like "1 mN", got "20 g"'),
        (
            lambda: Drive(mass="10 mm", stiffness=1, damping=1, plate=CURVED, finger=CURVED),
            'mass must be in kg or a unit alike, like "10 g", got "10 mm"',
        ),
        (lambda: simulate(DRIVE, 0.06), "release must be a Release, got 0.06"),  # type: ignore[arg-type]
        (lambda: simulate(Release(0.1), Release(0.1)), "drive must be a Drive, got Release"),  # type: ignore[arg-type]
        (
            lambda: simulate(DRIVE, Release(0.1, skin_stretch=1e-6)),
            "skin_stretch must be left out for",
        ),
        (lambda: simulate(DRIVE, Release(0.1), duration="5 mm"), "duration must be in s or a unit"),
        (
            lambda: simulate_batch(DRIVE, Release(STOP)),
            "mouse_velocity must be constant; `simulate`",
        ),
        (
            lambda: simulate_batch(replace(DRIVE, plate=CURVED), Release(0.1)),
            "plate must be without friction that depends on speed; `simulate` follows it, got "
            "2 rows",
        ),
        (
            lambda: simulate_batch(DRIVE, Release(0.1), masss=[1.0]),
            "unknown argument masss; did you mean mass?",
        ),
        (
            lambda: simulate_batch(DRIVE, Release(0.1), mass=["10 mm"]),
            "mass must be in kg or a unit",
        ),
    ],
)
def test_error_is_one_line(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        make()
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


def test_a_batch_varies_a_base() -> None:
    """Arguments that are not varied come from drive and release, as in `simulate`."""
    drive = replace(DRIVE, finger=Contact(0.005, 0.0075, stiffness=1000.0))
    release = Release(0.06, 2e-3, velocity=0.01, plate_load=2.0)
    damping = np.array([0.1, 0.4])
    batch = simulate_batch(drive, release, damping=damping, settling_band=0.02)
    for i, b in enumerate(damping):
        alone = simulate(replace(drive, damping=b), release, settling_band=0.02)
        numbers = alone.numbers()
        assert batch.transient_settling_time[i] == numbers["transient.settling_time"]
        assert batch.transient_peak_stretch[i] == numbers["transient.peak_stretch"]
        assert batch.transient_plate_peak_force[i] == numbers["transient.plate.peak_force"]
    assert batch.plate_load == 2.0
    assert batch.plate_kinetic == 0.02
    assert batch.damping.dims == ("damping",)


def test_a_batch_varies_the_load_and_marks_one_that_is_bad() -> None:
    loads = [0.0, 1.0, 3.0, -1.0, nan]
    batch = simulate_batch(DRIVE, Release(STOP), mouse_velocity=0.06, plate_load=loads)
    bad = Status.bad_plate_load
    assert batch.status.values.tolist() == [Status.ok, Status.ok, Status.ok, bad, bad]
    for i, load in enumerate(loads[:3]):
        alone = simulate(DRIVE, Release(0.06, plate_load=load))
        dissipated = alone.transient.finger.dissipated
        assert float(batch.transient_finger_dissipated[i]) == pytest.approx(dissipated, rel=1e-12)

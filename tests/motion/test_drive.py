"""A drive as data: validated, frozen, quick to make."""

import math
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pindrive import Contact, Drive, Profile, Release

WRONG: Any = 3
PLATE, FINGER = Contact(kinetic=0.020, static=0.025), Contact(kinetic=0.005)


def drive(**changes: object) -> Drive:
    values = {"mass": 0.010, "stiffness": 100.0, "damping": 0.4, "plate": PLATE, "finger": FINGER}
    return Drive(**(values | changes))  # type: ignore[arg-type]


def test_drive_keeps_floats() -> None:
    made = drive(mass=np.float32(0.5), stiffness=2)
    assert (made.mass, made.stiffness) == (0.5, 2.0)
    assert type(made.mass) is type(made.stiffness) is float
    assert made == drive(mass=0.5, stiffness=2.0)
    assert hash(made) == hash(drive(mass=0.5, stiffness=2.0))


def test_drive_is_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        drive().mass = 1.0  # type: ignore[misc]


def test_natural_frequency_and_damping_ratio() -> None:
    assert drive().natural_frequency == pytest.approx(100.0, rel=1e-15)
    assert drive().damping_ratio == pytest.approx(0.2, rel=1e-15)


@given(
    mass=st.floats(1e-9, 1e9),
    stiffness=st.floats(1e-9, 1e9),
    damping_ratio=st.one_of(st.just(0.0), st.floats(1e-10, 100.0)),
)
def test_damping_ratio_there_and_back(mass: float, stiffness: float, damping_ratio: float) -> None:
    made = Drive(
        mass=mass, stiffness=stiffness, damping_ratio=damping_ratio, plate=PLATE, finger=FINGER
    )
    assert made.damping_ratio == pytest.approx(damping_ratio, rel=1e-14)


def test_replace_takes_the_arguments_of_a_drive() -> None:
    drive = Drive(
        mass=0.01, stiffness=100.0, damping_ratio=0.5, plate=Contact(0.02), finger=Contact(0.0)
    )
    assert drive.damping == pytest.approx(1.0, rel=1e-15)
    assert drive.replace(damping="0.3 N*s/m").damping == 0.3
    assert drive.replace(mass="20 g") == drive.replace(mass=0.02)
    assert drive.replace(mass=0.02).damping == drive.damping
    with pytest.raises(ValueError, match="given as damping or as damping_ratio, got neither"):
        Drive(mass=0.01, stiffness=100.0, plate=Contact(0.02), finger=Contact(0.0))
    with pytest.raises(ValueError, match="got both"):
        drive.replace(damping=0.1, damping_ratio=0.1)
    with pytest.raises(TypeError, match="weight"):
        drive.replace(weight=1.0)


def test_static_friction_is_kinetic_unless_given() -> None:
    assert (PLATE.static_friction, FINGER.static_friction) == (0.025, 0.005)
    assert Contact(0.02) == Contact(0.02, None, None, math.inf)


def test_frictionless_and_rigid() -> None:
    assert Contact(0).frictionless
    assert not Contact(0, 0.1).frictionless
    assert not Contact(0, curve=[(0, 0), (1, 0.1)]).frictionless
    assert Contact(0).rigid
    assert not Contact(0.1, stiffness=1000).rigid


def test_curve_is_kept_as_rows() -> None:
    curve = [[0, 0.02], [0.1, 0.01]]
    contact = Contact(0.02, curve=curve)  # type: ignore[arg-type]
    assert contact.curve == ((0.0, 0.02), (0.1, 0.01))
    assert hash(contact)


def test_curve_alone_gives_the_kinetic_friction() -> None:
    contact = Contact(curve=[(0, 0.02), (0.1, 0.01)])
    assert contact == Contact(None, None, [(0, 0.02), (0.1, 0.01)])
    assert contact == Contact(0.02, curve=[(0, 0.02), (0.1, 0.01)])
    assert (contact.kinetic, contact.static_friction) == (0.02, 0.02)
    assert replace(contact, stiffness=1000.0).curve == contact.curve


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: drive(mass=0.0), "mass must be finite and greater than 0 kg, got 0.0 kg"),
        (lambda: drive(mass=-1.0), "mass must be finite and greater than 0 kg, got -1.0 kg"),
        (lambda: drive(mass=b"10"), "mass must be a number in kg, got b'10'"),
        (
            lambda: drive(stiffness=0),
            "stiffness must be finite and greater than 0 N/m, got 0.0 N/m",
        ),
        (
            lambda: drive(damping=-0.1),
            "damping must be finite and at least 0 N*s/m, got -0.1 N*s/m",
        ),
        (lambda: drive(damping=math.nan), "damping must be finite and at least 0 N*s/m, got nan"),
        (
            lambda: drive(mass=1e-300),
            "mass must be finite and at least 1e-12 kg and at most 1e12 kg, got 1e-300 kg",
        ),
        (
            lambda: drive(mass=1e-12, stiffness=1e-12),
            "damping must be such that the damping ratio is 0 or at least 1e-11 and at most 1e6, "
            "got 0.4 N*s/m, which makes it 2e+11",
        ),
        (
            lambda: drive(damping=1e-15),
            "damping must be such that the damping ratio is 0 or at least 1e-11",
        ),
        (
            lambda: drive(plate=Contact(curve=[(0, 1), (1e-9, 1e4)])),
            "curve slope must be finite and at least -1e12 N*s/m and at most 1e12 N*s/m",
        ),
        (
            lambda: drive(plate=Contact(curve=[(0, 1), (1e-9, 100)])),
            "plate.curve slope must be at most 1e6 times critical damping, got 9.9e+10 N*s/m",
        ),
        (lambda: Contact(curve=[(0, 1), (1e-320, 2)]), "curve slope must be finite"),
        (lambda: drive(mass=[0.01, 0.02]), "mass must be one number; simulate_batch takes arrays"),
        (lambda: drive(mass=np.ones(3)), "mass must be one number; simulate_batch takes arrays"),
        (lambda: drive(plate=0.02), "plate must be a Contact, got 0.02"),
        (lambda: Contact(-0.1), "kinetic must be finite and at least 0 N, got -0.1 N"),
        (lambda: Contact(0.1, math.inf), "static must be finite and at least 0 N, got inf N"),
        (
            lambda: Contact(0.1, 0.05),
            "static must be at least the kinetic friction, 0.1 N, got 0.05 N",
        ),
        (lambda: Contact(), "kinetic must be a number in N unless a curve is given, got None"),
        (lambda: Contact(static=0.1), "kinetic must be a number in N unless a curve is given"),
        (
            lambda: Contact(static=0.1, curve=[(0, 0.2)]),
            "static must be at least the kinetic friction, 0.2 N, got 0.1 N",
        ),
        (lambda: Contact(0.1, stiffness=0.0), "stiffness must be greater than 0 N/m, got 0.0 N/m"),
        (lambda: Contact(0.1, curve=[]), "curve must be at least one row of (speed, force)"),
        (lambda: Contact(0.1, curve=WRONG), "curve must be rows of (speed, force), got 3"),
        (lambda: Contact(0.1, curve=[WRONG]), "curve must be rows of (speed, force)"),
        (lambda: Contact(0.1, curve=[(0.1, 0.1)]), "curve[0] speed must be 0 m/s, got 0.1 m/s"),
        (lambda: Contact(0.1, curve=[(0, 0.2)]), "curve[0] force must be the kinetic friction"),
        (
            lambda: Contact(0.1, curve=[(0, 0.1), (1, 0.1), (1, 0.2)]),
            "curve[2] speed must be greater than the one before, 1.0 m/s, got 1.0 m/s",
        ),
        (
            lambda: Contact(0.1, curve=[(0, 0.1), (1, -0.1)]),
            "curve[1] force must be finite and at least 0 N, got -0.1 N",
        ),
        (lambda: Profile([], []), "times must be at least one, got none"),
        (lambda: Profile([0, 1], [0]), "values must be as many as times, 2, got 1"),
        (
            lambda: Profile([0, 1, 0.5], [0, 1, 1]),
            "times[2] must be at least the one before, 1.0 s, got 0.5 s",
        ),
        (
            lambda: Profile([0, 0, 0], [0, 1, 2]),
            "times[2] must be greater than the one before, 0.0 s: two rows at one time are a step, "
            "a third is none",
        ),
        (lambda: Profile([0, 1e-300], [0, 1]), "profile slope must be finite and at least -1e12"),
        (lambda: Profile([0, math.nan], [0, 1]), "times[1] must be finite, got nan s"),
        (lambda: Profile([0, 1], [0, math.inf]), "values[1] must be finite, got inf"),
        (
            lambda: Profile([0, 1], ["60 mm/s", "5 N"]),
            'values must be numbers in SI, or text all like "60 mm/s" or all like "1" or all like '
            '"10 mN" or all like "1 mm", got "60 mm/s", "5 N"',
        ),
        (lambda: Profile([0, 1], ["60 mm/s", "1"]), "values must be numbers in SI, or text all"),
        (lambda: Profile([0, 1], ["1e13 m/s", 0]), "values[0] must be finite and at least -1e12"),
        (lambda: Profile(WRONG, WRONG), "a profile must be sequences of numbers, got 3"),
    ],
)
def test_bad_values_are_refused(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        make()
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


def test_profile_is_linear_between_rows_and_constant_outside() -> None:
    profile = Profile([0.0, 1.0, 3.0], [0.0, 2.0, -2.0])
    times = [-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0]
    values = [0.0, 0.0, 1.0, 2.0, 0.0, -2.0, -2.0]
    assert [profile(t) for t in times] == values
    assert profile(np.array(times)).tolist() == values
    assert profile(np.reshape(times[:6], (2, 3))).shape == (2, 3)
    assert Profile([5], [1])(0) == 1.0


def test_values_of_a_profile_are_text_with_a_unit_too() -> None:
    speeds = Profile(["0 ms", "40 ms"], ["60 mm/s", 0.0])
    assert speeds == Profile([0.0, 0.04], [0.06, 0.0])
    assert (speeds.unit, Profile([0], [1]).unit) == ("m/s", "")
    loads = Profile([0.0, "5 ms"], ["5", "100 %"])
    assert loads == Profile([0.0, 0.005], [5.0, 1.0])
    assert Release(speeds, plate_load=loads) == Release(
        Profile([0.0, 0.04], [0.06, 0.0]), plate_load=Profile([0.0, 0.005], [5.0, 1.0])
    )
    with pytest.raises(ValueError, match=r"^plate_load must be a Profile of plain numbers, got "):
        Release(0.06, plate_load=speeds)
    with pytest.raises(ValueError, match=r"^mouse_velocity must be a Profile of numbers in m/s"):
        Release(loads)

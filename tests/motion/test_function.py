"""Inputs that are functions of time: their values, sums and sequences, and what they refuse."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from pindrive import InputPiece, InputTerm, _core
from pindrive.quantities.functions import FUNCTIONS

DRIVE = pd.Drive(
    mass="10 g",
    stiffness=100.0,
    damping_ratio=0.2,
    plate=pd.Contact(0.020, 0.026),
    finger=pd.Contact(0.005),
)


def test_parameters_are_those_of_the_core() -> None:
    named = {kind: tuple(q.name for q in of_kind) for kind, of_kind in FUNCTIONS.items()}
    assert named == _core.function_kinds


def test_harmonic_has_the_values_of_its_formula() -> None:
    wave = pd.harmonic("60 mm/s", "10 mm/s", "8 Hz", "90 deg")
    t = np.linspace(0.0, 0.3, 7)
    assert wave(t) == pytest.approx(0.06 + 0.01 * np.cos(2 * np.pi * 8 * t), abs=1e-15)
    assert wave(0.1) == wave([0.1])[0]
    assert wave.unit == "m/s"
    assert wave.parameters == {
        "mean": 0.06,
        "amplitude": 0.01,
        "frequency": 8.0,
        "phase": math.pi / 2,
    }


def test_minimum_jerk_covers_its_distance() -> None:
    stroke = pd.minimum_jerk("100 mm", "0.4 s", "50 ms")
    t = np.linspace(0.0, 0.5, 20001)
    assert np.trapezoid(stroke(t), t) == pytest.approx(0.1, rel=1e-7)
    assert stroke(0.25) == pytest.approx(1.875 * 0.1 / 0.4)
    assert stroke([0.0, 0.05, 0.45, 0.5]) == pytest.approx([0.0] * 4, abs=1e-15)


def test_exponential_begins_and_ends_at_its_values() -> None:
    pull = pd.exponential(5.0, 1.0, "2 ms", begin="10 ms")
    assert pull([0.0, 0.01, 0.012, 1.0]) == pytest.approx([5.0, 5.0, 1.0 + 4.0 / math.e, 1.0])


def test_sum_and_sequence_have_the_values_of_their_parts() -> None:
    wave, stroke = pd.harmonic(0.0, 0.01, 7.0, 0.3), pd.minimum_jerk(0.1, 0.4, 0.05)
    rows = pd.Profile([0.0, 0.2, 0.3], [0.05, 0.06, 0.02])
    t = np.linspace(0.0, 0.6, 61)
    assert (wave + stroke + rows)(t) == pytest.approx(wave(t) + stroke(t) + rows(t), abs=1e-15)
    assert (1.0 + wave)(t) == pytest.approx(1.0 + wave(t))
    joined = stroke.then(0.15, wave)
    expected = np.where(t < 0.15, stroke(t), wave(t - 0.15))
    assert joined(t) == pytest.approx(expected, abs=1e-15)
    assert joined.then("0.4 s", rows)(0.5) == pytest.approx(rows(0.1))


def test_function_is_equal_to_its_copy() -> None:
    wave = pd.harmonic(0.0, 0.01, 7.0)
    assert pickle.loads(pickle.dumps(wave)) == wave
    assert pickle.loads(pickle.dumps(wave)).parameters == wave.parameters
    assert hash(wave) == hash(pd.harmonic(0.0, 0.01, 7.0))


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (
            lambda: pd.harmonic(1, 2, 0),
            "frequency must be finite and greater than 0 Hz",
        ),
        (
            lambda: pd.harmonic(1, 2, 2e6),
            "at most 1e6 Hz, got 2000000.0 Hz",
        ),
        (lambda: pd.harmonic(1, 2, "8 s"), "frequency must be"),
        (lambda: pd.harmonic("1 mm/s", "1 N", 3), "mean and amplitude must be"),
        (lambda: pd.harmonic(1, math.nan, 3), "amplitude must be finite, got nan"),
        (
            lambda: pd.minimum_jerk(0.1, 0.0),
            "duration must be finite and greater than 0 s",
        ),
        (
            lambda: pd.exponential(1, 2, 0),
            "time_constant must be finite and at least 1e-7 s",
        ),
        (lambda: pd.Function(()), "pieces must be at least one, got none"),
        (
            lambda: pd.Function((InputPiece(1.0), InputPiece(0.5))),
            r"pieces\[1\].begin must be greater than",
        ),
        (lambda: pd.Function((InputPiece(0.0, (1.0,) * 7),)), "at most 6 coefficients, got 7"),
        (
            lambda: pd.Function((InputPiece(terms=(InputTerm(1.0, 0.0, -1.0),)),)),
            r"pieces\[0\].terms\[0\].decay must be from 0 to 1e\+09, got -1.0",
        ),
        (lambda: pd.harmonic(0, 1, 3).then(0.0, 1.0), "time must be after the begin"),
        (
            lambda: pd.Release(pd.harmonic(0, 1, 3).then(0.1, 2.0)),
            "mouse_velocity must be without a step",
        ),
        (
            lambda: pd.simulate(DRIVE, pd.Release(1.0, plate_load=pd.harmonic(1, 1.5, 3))),
            r"plate_load must be >= 0 at all times, got -0\.(5|4999999)",
        ),
        (lambda: pd.Release(pd.harmonic("0 N", "1 N", 3)), "mouse_velocity must be a Function of"),
        (
            lambda: pd.Release(1.0, across_velocity=pd.harmonic(0, 1, 3).then(0.1, 2.0)),
            "across_velocity must be without a step",
        ),
        (
            lambda: pd.simulate(
                DRIVE,
                pd.Release(pd.harmonic(0.1, 0.01, 3), force=pd.harmonic(0, 0.1, math.sqrt(2))),
            ),
            "duration must be given under functions that neither end nor repeat",
        ),
    ],
)
def test_bad_function_is_refused(made: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        made()


def test_compliant_finger_refuses_a_function_of_its_load() -> None:
    drive = pd.Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.1,
        plate=pd.Contact(0.02),
        finger=pd.Contact(0.005, stiffness=500.0),
    )
    with pytest.raises(ValueError, match="finger_load must be a number or a Profile"):
        pd.simulate(drive, pd.Release(0.1, finger_load=pd.harmonic(1.0, 0.5, 8.0)), duration=0.1)


def test_motion_under_a_function_keeps_the_laws() -> None:
    hand = pd.harmonic(0.0, 0.03, 5.0) + pd.minimum_jerk(0.1, 0.4)
    release = pd.Release(
        hand,
        displacement=1.5e-3,
        plate_load=pd.exponential(5.0, 1.0, "2 ms", "20 ms"),
        force=pd.harmonic(0.0, 0.01, 30.0),
    )
    motion = pd.simulate(DRIVE, release, duration=0.5)
    assert motion.certificate().worst < 1e-12
    assert motion.plate_velocity([0.1])[0] == hand(0.1)
    assert motion.inputs()["force.amplitude"] == 0.01
    assert "mouse_velocity.pieces" in motion.inputs()
    assert motion.to_dataset().attrs["force.frequency"] == 30.0


def test_transient_under_a_decaying_pull_ends() -> None:
    """An exponential that has decayed is constant, so that the ending is known."""
    pull = pd.exponential(5.0, 1.0, "2 ms")
    release = pd.Release(0.06, 2e-3, plate_load=pull)
    motion = pd.simulate(DRIVE, release)
    assert motion.ending.kind == "resting"
    rows = np.linspace(0.0, 0.06, 6001)
    table = pd.Profile(rows.tolist(), pull(rows).tolist())
    sampled = pd.simulate(DRIVE, release.replace(plate_load=table))
    assert motion.transient.settling_time == pytest.approx(
        sampled.transient.settling_time, rel=1e-5
    )


@pytest.mark.parametrize("parameter", ["mean", "amplitude", "frequency", "phase"])
def test_derivative_by_a_parameter_is_that_of_differences(parameter: str) -> None:
    values = {"mean": 0.06, "amplitude": 0.02, "frequency": 9.0, "phase": 0.4}

    def end(**changed: float) -> pd.Motion:
        wave = pd.harmonic(**values | changed)
        return pd.simulate(DRIVE, pd.Release(wave, 1.5e-3), duration=0.2)

    found = end().sensitivity([f"mouse_velocity.{parameter}"])
    step = 1e-5 * values[parameter]
    more, less = (end(**{parameter: values[parameter] + h}) for h in (step, -step))
    difference = (more.position([0.19]) - less.position([0.19])) / (2 * step)
    assert found.position([0.19])[0] == pytest.approx(difference, rel=1e-5, abs=1e-9)


def test_driven_motion_repeats_with_its_input() -> None:
    motion = pd.simulate(DRIVE, pd.Release(pd.harmonic(0.0, 0.1, 12.0)))
    assert motion.ending.cycle == "driven"
    assert motion.ending.period == pytest.approx(1 / 12, rel=1e-12)
    later = motion.ending.steady_since + np.linspace(0.0, 1 / 12, 9)
    assert motion.position(later + 100 / 12) == pytest.approx(motion.position(later), abs=1e-11)


@pytest.mark.parametrize("stiffness", [None, 500.0])
def test_rows_converge_to_a_stroke_at_an_angle(stiffness: float | None) -> None:
    """The error falls with the square of the distance between two rows."""
    finger = pd.Contact(0.005) if stiffness is None else pd.Contact(0.005, stiffness=stiffness)
    drive = pd.Drive(mass=0.001, stiffness=50.0, damping=0.05, plate=pd.Contact(0.2), finger=finger)
    distances = {"mouse_velocity": 0.0132, "across_velocity": 0.0072}
    times = np.linspace(0.01, 0.1, 7)

    def positions(rows: int) -> Any:
        strokes: dict[str, Any] = {
            name: pd.minimum_jerk(distance, 0.15) for name, distance in distances.items()
        }
        if rows:
            t = np.linspace(0.0, 0.15, rows + 1)
            strokes = {name: pd.Profile(t, stroke(t)) for name, stroke in strokes.items()}
        release = pd.Release(**strokes, displacement=0.0)
        return pd.simulate(drive, release, duration=0.2).position(times)

    exact, coarse, fine = positions(0), positions(500), positions(1000)
    assert np.max(np.abs(coarse - exact)) < 1e-7
    extrapolated = fine + (fine - coarse) / 3
    assert extrapolated == pytest.approx(exact, abs=3e-3 * np.max(np.abs(coarse - exact)))


@pytest.mark.parametrize("frequency", [50.0, 200.0, 1000.0])
def test_a_pin_that_the_plate_takes_along_has_no_period(frequency: float) -> None:
    """The plate carries the pin for many periods of a load that exerts no force."""
    drive = pd.Drive(
        mass=0.02,
        stiffness=100.0,
        damping=0.05,
        plate=pd.Contact(static=0.1, kinetic=0.05),
        finger=pd.Contact(static=0.0, kinetic=0.0),
    )
    release = pd.Release(mouse_velocity=0.02, finger_load=pd.harmonic(1.0, 0.01, frequency))
    motion = pd.simulate(drive, release, duration=2.0)
    times = np.linspace(0.0, 2.0, 20001)
    assert np.abs(np.diff(motion.position(times))).max() < 1e-4 * 0.2
    assert sum(event.kind == "slip" for event in motion.events_between(0.0, 2.0)) > 15


def test_load_that_becomes_negative_after_the_end_is_allowed() -> None:
    """A slow vibration of the load, which is negative from 57.7 s on."""
    release = pd.Release(0.1, plate_load=pd.harmonic(1.0, 1.5, 0.01))
    assert pd.simulate(DRIVE, release, duration=10.0).status.name == "ok"
    with pytest.raises(ValueError, match=r"plate_load must be >= 0 until the end of the motion"):
        pd.simulate(DRIVE, release, duration=70.0)


@pytest.mark.parametrize("turns", [-3, -1, 1, 2, 101])
@pytest.mark.parametrize("name", ["mouse_velocity", "across_velocity", "force"])
@pytest.mark.parametrize("kinetic", [0.0, 0.2])
def test_phase_of_half_turns_is_a_sign(turns: int, name: str, kinetic: float) -> None:
    """Sin π is 1.2e-16 in floating point, which must not count as sliding at the start."""
    drive = pd.Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.1,
        plate=pd.Contact(kinetic, 0.5),
        finger=pd.Contact(0.1, 0.3),
    )
    amplitude = 2.0 if name == "force" else 0.1
    t = np.linspace(0.0, 1.0, 1001)
    by_phase = pd.harmonic(0.0, amplitude, 3.0, turns * math.pi)
    by_sign = pd.harmonic(0.0, amplitude * (-1) ** turns, 3.0)
    x, y = (
        pd.simulate(
            drive,
            pd.Release(0.0, velocity=0.0).replace(**{name: each}),
            duration=2.0,
        ).position(t)
        for each in (by_phase, by_sign)
    )
    assert np.abs(x - y).max() <= 1e-12 * np.abs(y).max()


FREELY: Any = pd.Function
PIECE: Any = InputPiece
"""Without the checks of types."""


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: FREELY(None), "pieces must be a list of InputPiece, got None"),
        (lambda: FREELY([3.0]), r"pieces\[0\] must be an InputPiece, got 3.0"),
        (
            lambda: FREELY([PIECE(0.0, ("a", 1.0))]),
            r"pieces\[0\].polynomial\[0\] must be a number, got 'a'",
        ),
        (lambda: FREELY([PIECE(0.0, 1.0)]), r"pieces\[0\].polynomial must be a tuple"),
        (
            lambda: FREELY([PIECE(0.0, (1.0,), ((1.0, 0.0, 0.0, 3.0),))]),
            r"pieces\[0\].terms\[0\] must be an InputTerm, got \(1.0, 0.0, 0.0, 3.0\)",
        ),
        (
            lambda: pd.minimum_jerk(0.1, 1e-300),
            "minimum_jerk must be finite at all times, got distance = 0.1, duration = 1e-300",
        ),
    ],
)
def test_what_is_no_function_is_rejected_in_a_sentence(
    make: Callable[[], object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_value_of_a_function_at_no_time_is_nan() -> None:
    for function in (pd.harmonic(0.0, 1.0, 3.0), pd.minimum_jerk(0.1, 1.0)):
        assert math.isnan(function(math.nan))
        found = function(np.array([0.1, math.nan, math.inf]))
        assert np.isfinite(found[0])
        assert np.isnan(found[1:]).all()

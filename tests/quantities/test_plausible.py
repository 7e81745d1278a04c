"""Values far from any device: computed up to the bounds, refused beyond, and warned of."""

from __future__ import annotations

from itertools import product
from math import inf, isfinite
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pindrive
from command import GOOD, run
from pindrive import (
    Contact,
    Drive,
    ImplausibleValueWarning,
    Motion,
    Profile,
    Release,
    Status,
    simulate,
    simulate_batch,
)
from pindrive.plot.style import Figure

PIN = Drive(mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005))


def parts(given: dict[str, Any]) -> tuple[Release, float | None]:
    """A release at 60 mm/s but for what is given, and the duration."""
    inputs = {"mouse_velocity": 0.06, **given}
    duration = inputs.pop("duration", None)
    return Release(**inputs), duration


SIZES = (1e-12, 1.0, 1e12)


@pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")
@pytest.mark.parametrize(("mass", "stiffness"), [*product(SIZES, SIZES)])
def test_the_corners_of_the_bounds_are_computed(mass: float, stiffness: float) -> None:
    """Nothing overflows, nothing hangs, and the law of motion holds to rounding."""
    critical = 2.0 * (mass * stiffness) ** 0.5
    for ratio, force, speed in product((0.0, 1e-11, 0.3, 1.0, 1e6), (0.0, *SIZES), (0.0, *SIZES)):
        if ratio * critical > 1e12:
            continue
        drive = Drive(
            mass=mass,
            stiffness=stiffness,
            damping=ratio * critical,
            plate=Contact(force),
            finger=Contact(0.3 * force, 0.5 * force),
        )
        # Long enough for events, and too short for a million of them.
        period = 6.3 * (mass / stiffness) ** 0.5
        duration = min(max(30.0 * period, 1e-12), 1e12)
        motion = simulate(drive, Release(speed, -speed), duration=duration)
        assert motion.status == Status.ok
        assert motion.certificate().motion_law < 1e-12
        assert motion.certificate().friction_law < 1e-12
        assert isfinite(motion.energy.residual)


def test_a_mass_that_no_double_can_move_is_refused_and_not_followed_for_ever() -> None:
    result = run(
        "simulate", Path(__file__).parents[1].joinpath("minimal.toml"), "--set", "mass=1e-200 kg"
    )
    assert result.exit_code == 2
    assert result.stderr == (
        "--set mass: drive.mass must be finite and at least 1e-12 kg and at most 1e12 kg, got "
        '"1e-200 kg"\n'
    )


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mouse_velocity": 1e13}, "mouse_velocity must be finite and at least -1e12 m/s and at"),
        ({"displacement": -1e13}, "displacement must be finite and at least -1e12 m and at most"),
        ({"duration": 1e-13}, "duration must be finite and at least 1e-12 s and at most 1e12 s"),
        ({"duration": 1e11}, "duration must be at most 1e10 s, 1e12 over the natural frequency"),
        ({"plate_load": 1e13}, "plate_load must be finite and at least 0 and at most 1e12"),
        (
            {"mouse_velocity": np.array([0.1, 0.2])},
            "mouse_velocity must be a number or a Profile of what changes over time; "
            "simulate_batch takes arrays, got an array (2,)",
        ),
        ({"mouse_velocity": [0.1] * 3}, "simulate_batch takes arrays, got 3 values"),
        ({"displacement": [1e-3]}, "displacement must be one number; simulate_batch takes arrays"),
        (
            {"plate_load": "1 m"},
            'plate_load must be a plain number or a percentage, like "1", got "1 m"',
        ),
        (
            {"mouse_velocity": Profile([0, 0.1, 0.1], [0.1, 0.1, 0.0])},
            "mouse_velocity must be without a step (a jump would take an infinite force), got one "
            "from 0.1 m/s to 0.0 m/s at 0.1 s",
        ),
    ],
)
def test_numbers_that_are_not_computed_are_refused_in_a_line(
    given: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError) as refused:
        release, duration = parts(given)
        simulate(PIN, release, duration=duration)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"mouse_velocity": 60.0},
            "mouse_velocity is 60 m/s; any such device has 0 to 5 m/s; "
            "did you mean 60 mm/s, 0.06 m/s?",
        ),
        (
            {"displacement": 2.0},
            "displacement is 2 m; any such device has 0 to 0.1 m; did you mean 2 mm, 0.002 m?",
        ),
        ({"mouse_velocity": Profile([0, 0.1], [-60.0, 0.0])}, "mouse_velocity is -60 m/s"),
        ({"plate_load": 1e6}, "plate_load is 1e6; any such device has 0 to 10000"),
        ({"duration": 1e-9}, "duration is 1e-9 s; any such device has 1e-6 to 1e7 s"),
    ],
)
def test_implausible_value_is_warned_of_at_its_place(given: dict[str, Any], words: str) -> None:
    release, duration = parts(given)
    with pytest.warns(ImplausibleValueWarning) as reported:
        simulate(PIN, release, duration=duration)
    assert len(reported) == 1
    assert str(reported[0].message).startswith(words)
    assert reported[0].filename == __file__


def test_a_drive_in_grams_is_warned_of() -> None:
    heavy = Drive(mass=10, stiffness=100.0, damping=0.4, plate=Contact(0), finger=Contact(0))
    with pytest.warns(ImplausibleValueWarning, match=r"mass is 10 kg.* did you mean 10 g, 0.01 kg"):
        simulate(heavy, Release(0.06))


def test_a_batch_warns_once_of_an_argument_and_not_of_bad_points() -> None:
    with pytest.warns(ImplausibleValueWarning) as reported:
        simulate_batch(PIN, Release(0.1), mass=[0.01, 0.0, 0.01], mouse_velocity=[60.0, 70.0, inf])
    (warning,) = reported
    assert str(warning.message).startswith("mouse_velocity is 70 m/s; ")
    assert warning.filename == __file__


@pytest.mark.usefixtures("in_empty_folder")
@pytest.mark.parametrize("command", ["check", "simulate"])
def test_a_device_file_is_warned_of_in_a_line(command: str) -> None:
    Path("device.toml").write_text(GOOD.replace('"100 mm/s"', '"60 m/s"'), encoding="utf-8")
    result = run(command, "device.toml")
    assert result.exit_code == 0
    assert result.stderr == (
        "warning: device.toml: motion.mouse_velocity is 60 m/s; any such device has 0 to 5 m/s; "
        "did you mean 60 mm/s, 0.06 m/s?\n"
    )


def test_only_public_names_are_listed() -> None:
    assert dir(pindrive) == sorted(pindrive.__all__)


def test_a_figure_shows_itself_in_a_notebook() -> None:
    """By the protocol of IPython, whatever backend matplotlib has."""
    figure = simulate(PIN, Release(0.06, 0.002)).plot()
    assert isinstance(figure, Figure)
    picture, size = figure._repr_png_()
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    assert size == {"width": 680, "height": 472}


@pytest.mark.usefixtures("in_empty_folder")
def test_a_load_may_step_in_a_device_file_and_on_the_command_line() -> None:
    rows = '[["0 ms", 5], ["5 ms", 5], ["5 ms", 1]]'
    Path("device.toml").write_text(f"{GOOD}plate_load = {rows}\n", encoding="utf-8")
    Path("plain.toml").write_text(GOOD, encoding="utf-8")
    reported = run("simulate", "device.toml")
    assert reported.exit_code == 0, reported.output
    assert "5.000" in reported.stdout
    assert run("simulate", "plain.toml", "--set", f"plate_load={rows}").stdout == reported.stdout
    steps = '[["0 ms", "60 mm/s"], ["5 ms", "60 mm/s"], ["5 ms", "0 mm/s"]]'
    refused = run("simulate", "plain.toml", "--set", f"mouse_velocity={steps}")
    assert refused.exit_code == 2
    assert refused.stderr == (
        "--set mouse_velocity: motion.mouse_velocity[2] time must be greater than the one before, "
        "0.005 s (a jump would take an infinite force), got 0.005 s\n"
    )


def test_the_derivative_along_the_time_of_a_step_is_that_of_differences() -> None:
    def stepped(time: float) -> Motion:
        load = Profile([0.0, time, time], [0.6, 0.6, 1.5])
        return simulate(PIN, Release(0.06, 0.002, plate_load=load))

    motion, h, t = stepped(0.02), 1e-7, np.linspace(0.025, 0.1, 7)
    found = motion.sensitivity(["plate_load[1].time"]).position(t)[0]
    assert np.array_equal(found, motion.sensitivity(["plate_load[2].time"]).position(t)[0])
    expected = (stepped(0.02 + h).position(t) - stepped(0.02 - h).position(t)) / (2 * h)
    assert np.abs(expected).max() > 1e-5
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_a_profile_has_its_later_value_at_a_step() -> None:
    load = Profile([0.0, 1.0, 1.0, 2.0], [5.0, 4.0, 1.0, 2.0])
    assert load.steps == (1.0,)
    assert [load(0.5), load(1.0), load(1.5)] == [4.5, 1.0, 1.5]
    assert load(np.array([0.5, 1.0, 1.5])).tolist() == [4.5, 1.0, 1.5]

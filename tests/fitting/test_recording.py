"""Recordings: contents, and rejected files with a message that names file and remedy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from pindrive import Profile, Recording, read_recording
from pindrive.fitting import Noise

ROWS = "".join(f"{i},{2 - 0.1 * i:g},60\n" for i in range(20))
HEAD = "time [ms], position [mm], mouse_velocity [mm/s]\n"


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "pin.csv"
    path.write_text(text, encoding="utf-8")
    return path


def refused(path: Path) -> str:
    with pytest.raises(ValueError) as error:
        read_recording(path)
    (line,) = str(error.value).splitlines()
    assert line.startswith(str(path))
    return line.removeprefix(f"{path}: ")


def test_columns_are_read_in_si_and_a_constant_input_is_one_number(tmp_path: Path) -> None:
    found = read_recording(written(tmp_path, f"# bench\n{HEAD}{ROWS}"), noise={"position": "5 um"})
    np.testing.assert_allclose(found.time, 1e-3 * np.arange(20), rtol=1e-15)
    np.testing.assert_allclose(found.channels["position"], 2e-3 - 1e-4 * np.arange(20), atol=1e-18)
    assert found.mouse_velocity == pytest.approx(0.06)
    assert found.noise == {"position": Noise(5e-6)}
    assert repr(found) == "<Recording pin.csv: position, 20 samples at 1000 Hz>"
    assert found.sources == (tmp_path / "pin.csv",)


def test_all_channels_and_another_order_and_separator(tmp_path: Path) -> None:
    text = "force (mN);acceleration (m/s^2);velocity (mm/s);time (us)\n"
    text += "".join(f"{i};{2 * i};{3 * i};{10 * i}\n" for i in range(1, 101))
    found = read_recording(written(tmp_path, text))
    assert found.interval == pytest.approx(1e-5)  # 100 kHz
    for channel, factor in {"force": 1e-3, "acceleration": 2.0, "velocity": 3e-3}.items():
        assert found.channels[channel][9] == pytest.approx(10 * factor)


def test_samples_of_an_input_become_the_fewest_rows_that_follow_them() -> None:
    t = np.linspace(0.0, 0.2, 2001)
    load = np.interp(t, [0.05, 0.055], [5.0, 1.0])
    found = Recording(t, position=np.cos(t), plate_load=load).plate_load
    assert isinstance(found, Profile)
    assert len(found.times) == 4
    assert np.abs(found(t) - load).max() <= 5e-3
    speed = 0.1 * (1.0 - np.cos(30.0 * t))
    smooth = Recording(t, position=np.cos(t), mouse_velocity=speed).mouse_velocity
    assert isinstance(smooth, Profile)
    assert 10 < len(smooth.times) < 200
    assert np.abs(smooth(t) - speed).max() <= 1e-3 * speed.max()


def test_a_window_keeps_the_times() -> None:
    t = np.arange(100) * 1e-3
    found = Recording(t, position=1.0 + t).window("10 ms", 0.05)
    assert found.time[0] == pytest.approx(0.01)
    assert found.time[-1] == pytest.approx(0.05)
    assert len(found.time) == len(found.channels["position"]) == 41
    with pytest.raises(ValueError, match="window must be so wide that 8 samples of"):
        found.window(0.01, 0.012)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "time [s], position\n" + ROWS,
            'column position must be given with its unit, like "position [m]"',
        ),
        (
            "time, position [mm]\n" + ROWS,
            'column time must be given with its unit, like "time [s]"',
        ),
        ("time [s], position [mN]\n" + ROWS, "column position must be in m or a unit alike, like"),
        (
            "time [s], place [mm]\n" + ROWS,
            "the header must be with time and at least one of position",
        ),
        (
            HEAD + ROWS + "3,1,60\n",
            "row 22: time must be greater than the one before, 0.019 s; sort",
        ),
        (HEAD + ROWS.replace("1.9,", "x,"), 'row 3: position must be a number, got "x"'),
        (HEAD + "0,0,60\n1,1,60\n", "a recording must be at least 8 rows, got 2"),
        (
            HEAD + "".join(f"{i},0,60\n" for i in range(20)),
            "position must be other than zero somewhere; check the sensor and the heading",
        ),
        ("", 'is empty; a recording begins with "time [s], position [m]"'),
    ],
)
def test_error_is_one_line_with_the_remedy(tmp_path: Path, text: str, said: str) -> None:
    assert said in refused(written(tmp_path, text))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({}, "a recording must be of position or velocity or acceleration or force, got none"),
        ({"position": np.ones(5)}, r"position must be one value for each time, \(20,\)"),
        ({"position": [np.inf] * 20}, r"position\[0\] must be finite"),
        ({"position": np.ones(20), "noise": {"force": 1.0}}, "noise must be of position"),
        ({"position": np.ones(20), "noise": {"position": 0.0}}, "greater than 0"),
        ({"position": np.ones(20), "mouse_velocity": [1e13] * 20}, r"mouse_velocity\[0\] must be"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        Recording(np.arange(20) * 1e-3, **arguments)  # type: ignore[arg-type]

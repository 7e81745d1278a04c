"""The hand's path: minimum jerk, line by line, recorded; and what is refused."""

from __future__ import annotations

from math import degrees, pi, radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from numpy.typing import NDArray

from pindrive.device import HandPath, lines, read_csv, strokes, through


def minimum_jerk(s: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(10 * s**3 - 15 * s**4 + 6 * s**5)


def test_a_stroke_is_minimum_jerk() -> None:
    path = strokes([(0.01, 0.02), (0.04, 0.06)], 0.1)
    lasts = 1.875 * 0.05 / 0.1
    assert path.end == pytest.approx(lasts, rel=1e-15)
    t = np.linspace(0.0, path.end, 4001)
    s = t / lasts
    vx, vy = path.velocity(t)
    assert_allclose(np.hypot(vx, vy), 0.05 / lasts * 30 * (s * (1 - s)) ** 2, atol=1e-16)
    x, y = path.position(t)
    assert_allclose(x, 0.01 + 0.03 * minimum_jerk(s), atol=1e-16)
    assert_allclose(y, 0.02 + 0.04 * minimum_jerk(s), atol=1e-16)


def test_a_bent_path_is_the_polynomial() -> None:
    """Place, velocity, peak, turns and the motion's input, also where parts are cut out."""
    bends = [(0.3, -0.7, 0.4), (0.0, 0.5, 0.2)], [(0.1, 0.1, -0.9), (0.2, 0.0, 0.0)]
    path = HandPath(
        [0.0, 0.2, 0.5],
        [0.1, -0.05, 0.02],
        [0.0, 0.03, 0.0],
        (0.0, 0.0),
        bend_x=bends[0],
        bend_y=bends[1],
    )
    t = np.linspace(0.25, 0.45, 4001)
    s = (t - 0.2) / 0.3
    vx = -0.05 + 0.07 * s + s * (1 - s) * (0.5 * s + 0.2 * s**2)
    assert_allclose(path.velocity(t)[0], vx, atol=1e-16)
    middle = 0.5 * (t[1:] + t[:-1])
    assert_allclose(np.diff(path.position(t)[0]), path.velocity(middle)[0] * np.diff(t), atol=1e-10)
    part = path.between(0.05, 0.45)
    assert_allclose(part.velocity(t), path.velocity(t), atol=1e-15)
    assert_allclose(part.position(t), path.position(t), atol=1e-15)
    every = np.linspace(0.0, 0.5, 100_001)
    assert path.peak_speed == pytest.approx(np.hypot(*path.velocity(every)).max(), rel=1e-8)
    for axis in (0.0, 0.7):
        along = path.velocity(every)[0] * np.cos(axis) + path.velocity(every)[1] * np.sin(axis)
        assert_allclose(path.plate_velocity(axis)(every), along, atol=1e-15)
        turns = every[1:][np.sign(along[1:]) != np.sign(along[:-1])]
        assert_allclose(path.turnings(axis), turns, atol=1e-5)


def test_peak_is_the_requested_speed() -> None:
    path = strokes([(0.0, 0.0), (0.1, 0.0)], 0.06)
    assert path.peak_speed == pytest.approx(0.06, rel=1e-14)


def test_place_is_the_integral_of_velocity() -> None:
    path = lines([0.0, 0.02], 0.0, 0.05, speed=0.1, return_speed=0.3, pause=0.05)
    t = np.linspace(0.0, path.end, 200_001)
    vx, _ = path.velocity(t)
    x, _ = path.position(t)
    paths = np.concatenate([[0.0], np.cumsum(0.5 * (vx[1:] + vx[:-1]) * np.diff(t))])
    assert_allclose(x, paths, atol=1e-9)


def test_line_by_line() -> None:
    path = lines([0.01, 0.03], 0.0, 0.05, speed=0.1, return_speed=0.3, pause=0.05)
    velocity = path.plate_velocity()(np.linspace(0.0, path.end, 10_001))
    assert velocity.max() == pytest.approx(0.1, rel=1e-6)
    assert velocity.min() == pytest.approx(-0.3 * 0.05 / np.hypot(0.05, 0.02), rel=1e-5)
    assert (path.x[-1], path.y[-1]) == pytest.approx((0.05, 0.03))
    largest, mean = path.angles()
    assert largest == pytest.approx(np.arctan2(0.02, 0.05))
    assert 0.0 < mean < largest


def test_angle_is_to_the_drive_axis() -> None:
    for way, axis, angle in ((30.0, 0.0, 30.0), (30.0, 30.0, 0.0), (170.0, 0.0, 10.0)):
        u = radians(way)
        path = strokes([(0.0, 0.0), (0.05 * np.cos(u), 0.05 * np.sin(u))], 0.1)
        assert degrees(path.angles(radians(axis))[0]) == pytest.approx(angle, abs=1e-9)


def test_a_part_is_the_part() -> None:
    path = lines([0.0, 0.02], 0.0, 0.05, speed=0.1, return_speed=0.3, pause=0.05)
    part = path.between(0.4, 1.7)
    t = np.linspace(0.4, 1.7, 999)
    assert (part.begin, part.end) == (0.4, 1.7)
    assert_allclose(part.position(t), path.position(t), atol=1e-15)
    assert_allclose(part.velocity(t), path.velocity(t), atol=1e-15)


@settings(max_examples=40)
@given(st.lists(st.floats(0.005, 0.02), min_size=2, max_size=30), st.integers(0, 2**32 - 1))
def test_a_record_is_followed_without_drift(lasts: list[float], seed: int) -> None:
    """Half-way between two recorded places the path is half-way between them."""
    rng = np.random.default_rng(seed)
    t = np.concatenate([[0.0], np.cumsum(lasts)])
    x, y = (np.cumsum(rng.normal(0.0, 1e-4, len(t))) for _ in range(2))
    path = through(t, x, y, acceleration=1e6)
    middles = 0.5 * (t[1:] + t[:-1])
    px, py = path.position(middles)
    assert_allclose(px, 0.5 * (x[1:] + x[:-1]), atol=1e-15)
    assert_allclose(py, 0.5 * (y[1:] + y[:-1]), atol=1e-15)
    assert np.abs(np.diff(path.vx)).max() < np.inf


def test_a_recorded_stroke_is_that_stroke() -> None:
    true = strokes([(0.0, 0.0), (0.1, 0.0)], 0.1)
    t = np.linspace(0.0, true.end, 400)
    path = through(t, *true.position(t))
    rounding = t[1] ** 2 * 5.78 * 0.1 / true.end**2 / 8  # of corners, by the peak acceleration
    assert_allclose(path.position(t), true.position(t), atol=1.1 * rounding)
    assert_allclose(path.velocity(t), true.velocity(t), atol=1e-3)


HEADINGS = {
    "time [s], x [mm], y [mm]": (1.0, 1e-3, 1e-3),
    "time (ms),x (cm),y (m)": (1e-3, 1e-2, 1.0),
    "Time [ms];pressure;Y [mm];X [in]": (1e-3, 0.0254, 1e-3),
}


@pytest.mark.parametrize("heading", HEADINGS)
def test_csv_in_its_own_units(tmp_path: Path, heading: str) -> None:
    ts, xs, ys = HEADINGS[heading]
    apart = ";" if ";" in heading else ","
    rows = [heading, "# a comment", ""]
    for i in range(50):
        t, x, y = 0.01 * i / ts, 0.05 * (1 - np.cos(pi * i / 50)) / xs, 0.001 / ys
        cells = {"time": t, "x": x, "y": y, "pressure": 3.0}
        names = [part.strip().split(" ")[0].lower() for part in heading.split(apart)]
        rows.append(apart.join(repr(float(cells[name])) for name in names))
    file = tmp_path / "hand.csv"
    file.write_text("\n".join(rows), encoding="utf-8")
    path = read_csv(file)
    assert path.end == pytest.approx(0.49)
    assert path.x[-1] == pytest.approx(0.05 * (1 - np.cos(pi * 49 / 50)), rel=1e-2)
    assert_allclose(path.y, 0.001, rtol=1e-12)


BAD = {
    "": 'is empty; a recorded path begins with "time [s], x [m], y [m]"',
    "time, x [mm], y [mm]\n0,0,0\n1,1,1": (
        'column time must be given with its unit, like "time [s]", got "time"'
    ),
    "time [s], x [kg], y [mm]\n0,0,0\n1,1,1": (
        'column x must be in m or a unit alike, like "x [m]", got "x [kg]"'
    ),
    "time [s], x [mm]\n0,0\n1,1": (
        'the header must be like "time [s], x [m], y [m]", got "time [s], x [mm]"'
    ),
    "time [s], x [mm], y [mm], x [m]\n": "column x must be given once, got it twice",
    "time [s], x [mm], y [mm]\n0,0,0": "a recorded path must be at least 2 rows, got 1",
    "time [s], x [mm], y [mm]\n0,0,0\n1,here,0": 'row 3: x must be a number, got "here"',
    "time [s], x [mm], y [mm]\n0,0,0\n1,1": 'row 3: y must be a number, got ""',
    "time [s], x [mm], y [mm]\n0,0,0\nnan,1,1": (
        'row 3: time must be finite and at least -1e6 s and at most 1e6 s, got "nan"'
    ),
    "time [s], x [mm], y [mm]\n0,0,0\n#\n0.1,1,0\n0.1,2,0": (
        "row 5: time must be greater than the one before, 0.1 s, got 0.1 s"
    ),
    "time [s], x [mm], y [mm]\n0,0,0\n0.1,1,0\n0.2,30,0": (
        "row 3 must be without a jump of the hand's speed, a change of at most 2 m/s^2, got 2.8 "
        "m/s^2 at 0.1 s, where it moves at 10 mm/s before and 290 mm/s after"
    ),
}


@pytest.mark.parametrize("text", BAD)
def test_bad_records_are_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "hand.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError) as refused:
        read_csv(file, acceleration=2.0)
    assert str(refused.value) == f"{file}: {BAD[text]}"


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"none.csv: cannot be read: No such file"):
        read_csv(tmp_path / "none.csv")
    (tmp_path / "odd.csv").write_bytes(b"time [s]\xff")
    with pytest.raises(ValueError, match=r"odd.csv: is not UTF-8 text, at byte 8"):
        read_csv(tmp_path / "odd.csv")


def test_bad_paths_are_refused() -> None:
    with pytest.raises(ValueError, match=r"times\[2\] must be greater than the one before, 1.0 s"):
        HandPath([0.0, 1.0, 1.0], [0.0] * 3, [0.0] * 3, (0.0, 0.0))
    with pytest.raises(ValueError, match="stops must be at least two places, got 1"):
        strokes([(0.0, 0.0)], 0.1)
    with pytest.raises(ValueError) as error:
        strokes([(0.0, 0.0), (0.1, 0.0), (0.1, 0.0)], 0.1)
    assert str(error.value) == (
        "the way from stops[1] to stops[2] must be finite and at least 1e-9 m and at most 2000 m, "
        "got 0.0 m"
    )
    with pytest.raises(
        ValueError,
        match=r"speeds must be finite and at least 0.0001 m/s and at most 100 m/s, got -0.1",
    ):
        strokes([(0.0, 0.0), (0.1, 0.0)], -0.1)
    with pytest.raises(ValueError, match="rows must be at least one line"):
        lines([], 0.0, 0.1, speed=0.1, return_speed=0.1)
    path = strokes([(0.0, 0.0), (0.1, 0.0)], 0.1)
    with pytest.raises(ValueError, match=r"t must be from 0.0 s to 1.875 s"):
        path.position(2.0)
    with pytest.raises(ValueError, match="begin and end must be increasing and within"):
        path.between(1.0, 0.5)

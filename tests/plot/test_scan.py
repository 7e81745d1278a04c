"""The picture of a scan: it shows the scan, and `pindrive scan` writes it."""

from __future__ import annotations

import csv
import io
from math import isnan
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from numpy.typing import NDArray
from typer.testing import CliRunner

from pindrive import Contact, Drive
from pindrive.cli.app import app
from pindrive.device import Device, HandPath, PinArray, Scene, lines, scan
from pindrive.evaluation import Judgement, judge
from pindrive.evaluation.tactile_image import paint
from pindrive.plot.pin import moment
from pindrive.plot.scan import plot_scan
from pindrive.plot.style import save

MINIMAL = Path(__file__).parents[1] / "minimal.toml"
DRIVE = Drive(
    mass=0.010,
    stiffness=100.0,
    damping=0.32,
    plate=Contact(0.022, 0.0265),
    finger=Contact(0.020, 0.030, stiffness=300.0),
)


@pytest.fixture(scope="module")
def judged() -> Judgement:
    device = Device(drive=DRIVE, array=PinArray.grid(2, 3, 0.002))
    scene = Scene.from_grating([0.003, 0.006], count=2, margin=0.008, height=0.006)
    path = lines([0.009, 0.013], 0.002, 0.036, speed=0.08, return_speed=0.15, pause=0.1)
    return judge(scan(device, scene, path))


@pytest.fixture(scope="module")
def figure(judged: Judgement) -> Figure:
    return plot_scan(judged)


def curve(figure: Figure, panel: str, gid: str) -> NDArray[np.float64]:
    axes = next(axes for axes in figure.axes if axes.get_label() == panel)
    line = next(line for line in axes.lines if line.get_gid() == gid)
    return np.asarray(line.get_data(), float)


def test_the_tactile_image_is_the_mean_deflection_of_the_pins_that_passed() -> None:
    """Two pins one behind the other, at an even speed: their mean, where both passed."""
    array = PinArray([(0.0, 0.0), (0.004, 0.0)])
    scene = Scene.from_grating([0.004], count=2, margin=0.012, height=0.004)
    left, right, _, _ = scene.extent
    speed, y = 0.06, scene.lines[0]
    lasts = (right - left - 0.010) / speed
    path = HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (left + 0.002, y))
    done = scan(Device(drive=DRIVE, array=array), scene, path)
    image = paint(done)
    assert image.extent == scene.extent
    cell = (right - left) / image.deflection.shape[1]
    row = image.deflection[int(y / cell)]
    middles = left + (np.arange(len(row)) + 0.5) * cell
    both = (middles > left + 0.0065) & (middles < right - 0.0085)
    expected = np.mean(
        [
            pin.position((middles[both] - shift - left - 0.002) / speed)
            for pin, (shift, _) in zip(done.pins, array.spots, strict=True)
        ],
        axis=0,
    )
    steepest = max(np.abs(pin.velocity(np.linspace(0, lasts, 3000))).max() for pin in done.pins)
    assert row[both] == pytest.approx(expected, abs=cell * steepest / speed)
    assert np.isnan(image.deflection[0]).all(), "no pin passed the margin"
    assert np.isnan(row[middles < left + 0.0015]).all()


def test_a_mirrored_scan_is_painted_mirrored() -> None:
    scene = Scene.from_grating([0.004, 0.005], count=1, margin=0.008, height=0.003)
    columns = scene.luminance.shape[1]
    scene = Scene(scene.luminance, scene.pixel, (-0.5 * columns * scene.pixel, 0.0), scene.lines)
    left, right, _, _ = scene.extent
    y, lasts = scene.lines[0], (right - left - 0.004) / 0.05
    mirrored = Scene(scene.luminance[:, ::-1], scene.pixel, scene.origin, scene.lines)
    there = HandPath([0.0, lasts], [0.05] * 2, [0.0] * 2, (left + 0.002, y))
    back = HandPath([0.0, lasts], [-0.05] * 2, [0.0] * 2, (right - 0.002, y))
    one = paint(scan(Device(drive=DRIVE), scene, there)).deflection
    other = paint(scan(Device(drive=DRIVE), mirrored, back)).deflection[:, ::-1]
    assert np.nanmax(np.abs(one - other)) < 0.1 * np.nanmax(np.abs(one))
    assert np.nanmean(np.abs(one - other)) < 0.01 * np.nanmax(np.abs(one))


def test_the_history_is_that_of_the_pin(judged: Judgement, figure: Figure) -> None:
    chosen = moment(judged)
    pin = judged.scan.pins[chosen.pin]
    for panel, gid, of, scale in (
        ("x", "curve", pin.position, 1e3),
        ("force", "force", pin.skin_force, 1e3),
        ("pull", "pull", lambda t: judged.scan.device.magnet.pull(pin.current(t)), 1.0),
    ):
        t, y = curve(figure, panel, gid)
        assert t[0] == 0.0
        assert t[-1] == pytest.approx(1e3 * (chosen.end - chosen.begin))
        times = np.clip(chosen.begin + 1e-3 * t, pin.begin, pin.end)
        jumps = np.array([e.time for e in pin.events])
        clear = np.abs(times[:, None] - jumps).min(axis=1) > 1e-9
        assert y[clear] == pytest.approx(scale * of(times[clear]), rel=1e-6, abs=1e-9)
    marked = np.concatenate(
        [
            np.asarray(line.get_xdata(), float)
            for axes in figure.axes
            if axes.get_label() == "x"
            for line in axes.lines
            if line.get_gid() in ("stick", "slip", "cross")
        ]
    )
    events = [e.time for e in pin.events if chosen.begin < e.time < chosen.end]
    assert sorted(marked) == pytest.approx([1e3 * (t - chosen.begin) for t in events])


def test_the_moment_holds_lines_of_the_pin(judged: Judgement) -> None:
    for number in (None, 0, 5):
        chosen = moment(judged, number)
        assert number is None or chosen.pin == number
        inside = [
            line
            for line in judged.lines
            if line.pin == chosen.pin
            and chosen.begin <= line.begin.time
            and line.end.time <= chosen.end
        ]
        assert len(inside) > 1
    with pytest.raises(ValueError, match="pin must be a whole number from 0 to 5, got 6"):
        moment(judged, 6)


def test_print_and_tactile_image_have_one_scale(figure: Figure) -> None:
    printed, felt = (
        next(axes for axes in figure.axes if axes.get_label() == name) for name in ("print", "felt")
    )
    assert printed.get_xlim() == felt.get_xlim()
    assert printed.get_ylim() == felt.get_ylim()
    figure.draw_without_rendering()
    assert printed.get_window_extent().width == pytest.approx(felt.get_window_extent().width)


def test_the_title_says_the_verdict(judged: Judgement, figure: Figure) -> None:
    title = figure.get_suptitle()
    counts = judged.counts
    assert "6 pins" in title
    assert f"{counts['judged.shown']} of {counts['judged.lines']} lines shown" in title
    assert f"lag on {1e3 * judged.spread('line.lag_on')[1]:.2g} mm" in title


def test_a_blank_page_is_drawn() -> None:
    page = Scene(np.ones((60, 500)), 1e-4)
    path = lines([0.003], 0.002, 0.045, speed=0.08, return_speed=0.1)
    figure = plot_scan(judge(scan(Device(drive=DRIVE), page, path)))
    assert "no line passed whole under a pin" in figure.get_suptitle()
    save(figure, io.BytesIO(), "png")


def test_the_command_writes_figure_and_lines(tmp_path: Path) -> None:
    plot, table = tmp_path / "a.svg", tmp_path / "lines.csv"
    command = ["scan", str(MINIMAL), "--grating", "3 mm", "--set", "array.columns=2"]
    done = CliRunner().invoke(
        app, [*command, "--plot", str(plot), "--pin", "1", "--lines", str(table)]
    )
    assert done.exit_code == 0, done.output
    assert "8 lines passed under the pins: 8 shown, 0 missed" in done.output
    assert "the most that skin could move" in done.output
    assert "skin force (mN)" in plot.read_text(encoding="utf-8")
    assert "pin 1 from" in plot.read_text(encoding="utf-8")
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 8
    assert {row["pin"] for row in rows} == {"0", "1"}
    for row in rows:
        assert row["fate"] == "shown"
        latency, lag = float(row["latency_on [s]"]), float(row["lag_on [m]"])
        assert 0.0 < lag <= latency * 0.0601
        smear = row["smear [m]"]
        assert not smear or not isnan(float(smear))
    dull = CliRunner().invoke(app, [*command, "--set", "judge.felt=9 mm"])
    assert "0 shown, 8 missed" in dull.output
    for bad, words in (
        (["--pin", "1"], "--pin must be from 0 to 1, beside --plot, got 1"),
        (["--plot", str(tmp_path / "b.png"), "--pin", "2"], "--pin must be from 0 to 1"),
        (["--plot", str(tmp_path / "b.gif")], "must end in .png, .svg, .pdf"),
    ):
        refused = CliRunner().invoke(app, [*command, *bad])
        assert refused.exit_code == 2
        assert words in refused.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.svg", "lines.csv"]

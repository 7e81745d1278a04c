"""The picture of a scan: it shows the scan, and `pindrive scan` writes it."""

from __future__ import annotations

import csv
import io
from dataclasses import replace
from itertools import product
from math import isnan
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

from figure_reading import collisions, data, events, legend_of, lines, panel, points, spans
from pindrive import Contact, Drive, Profile
from pindrive.cli.app import app
from pindrive.device import Device, HandPath, PinArray, Scene, scan
from pindrive.device import lines as lines_of
from pindrive.evaluation import Evaluation, evaluate
from pindrive.evaluation.line_crossings import printed_lines
from pindrive.evaluation.tactile_image import paint
from pindrive.plot.pin import moment
from pindrive.plot.scan import plot_reliefs, plot_scan
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
def evaluated() -> Evaluation:
    device = Device(drive=DRIVE, array=PinArray.grid(2, 3, 0.002))
    scene = Scene.from_grating([0.003, 0.006], count=2, margin=0.008, height=0.006)
    path = lines_of([0.009, 0.013], 0.002, 0.036, speed=0.08, return_speed=0.15, pause=0.1)
    return evaluate(scan(device, scene, path))


@pytest.fixture(scope="module")
def figure(evaluated: Evaluation) -> Figure:
    return plot_scan(evaluated)


def test_the_tactile_image_is_the_mean_deflection_of_the_pins_that_passed() -> None:
    """Two pins in line at an even speed: the mean where both passed."""
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


def test_the_history_is_that_of_the_pin(evaluated: Evaluation, figure: Figure) -> None:
    chosen = moment(evaluated)
    pin = evaluated.scan.pins[chosen.pin]
    for name, gid, of, scale in (
        ("x", "curve", pin.position, 1e3),
        ("force", "force", pin.skin_force, 1e3),
        ("pull", "pull", lambda t: evaluated.scan.device.magnet.pull(pin.current.flux(t)), 1.0),
        ("hand", "hand_force", evaluated.scan.force_on_hand, 1.0),
    ):
        t, y = data(panel(figure, name), gid)
        assert t[0] == 0.0
        assert t[-1] == pytest.approx(1e3 * (chosen.end - chosen.begin))
        times = np.clip(chosen.begin + 1e-3 * t, pin.begin, pin.end)
        jumps = np.array([e.time for each in evaluated.scan.pins for e in each.events])
        clear = np.abs(times[:, None] - jumps).min(axis=1) > 1e-9
        assert y[clear] == pytest.approx(scale * of(times[clear]), rel=1e-6, abs=1e-9)
    within = [e for e in pin.events if chosen.begin < e.time < chosen.end]
    for kind, contact in product(("stick", "slip", "reverse"), ("plate", "finger", "both")):
        own = [e for e in within if (e.kind, e.contact) == (kind, contact)]
        t, x = events(panel(figure, "x"), kind, contact)
        assert t == pytest.approx([1e3 * (e.time - chosen.begin) for e in own])
        assert x == pytest.approx([1e3 * e.position for e in own])
        words = {"stick": "sticks", "slip": "slips", "reverse": "reverses"}[kind]
        said = f"{words} at {'both' if contact == 'both' else f'the {contact}'}"
        assert (said in legend_of(figure)) == bool(own)
    units = {
        name: panel(figure, name).get_ylabel() for name in ("x", "pull", "force", "hand", "seen")
    }
    assert units == {
        "x": "deflection $x$ (mm)",
        "pull": "pull (N)",
        "force": "skin force (mN)",
        "hand": "hand (N)",
        "seen": "luminance",
    }
    assert panel(figure, "hand").get_xlabel() == "time (ms)"


def test_the_history_shows_what_was_under_the_spot(evaluated: Evaluation, figure: Figure) -> None:
    chosen = moment(evaluated)
    pin, axes = evaluated.scan.pins[chosen.pin], panel(figure, "seen")
    done = evaluated.scan
    lines = printed_lines(done.device, done.path, done.scene)[chosen.pin]
    under = [
        (1e3 * (begin - chosen.begin), 1e3 * (end - chosen.begin))
        for begin, end in zip(lines.begin, lines.end, strict=True)
        if end > chosen.begin and begin < chosen.end
    ]
    for name in ("seen", "pull", "x", "force"):
        assert spans(panel(figure, name), "printed") == [pytest.approx(span) for span in under]
    ms, seen = data(axes, "luminance")
    middles = np.array([0.5 * (a + b) for a, b in under])
    inside = [seen[np.argmin(np.abs(ms - middle))] for middle in middles]
    assert max(inside) < evaluated.scan.device.control.threshold < seen.max()
    on = [
        (1e3 * (a - chosen.begin), 1e3 * (b - chosen.begin))
        for a, b in pin.energised
        if b > chosen.begin and a < chosen.end
    ]
    bars = [c for c in axes.collections if c.get_gid() == "command"]
    drawn = [np.asarray(c.get_paths()[0].vertices)[:, 0] for c in bars]
    assert [(x.min(), x.max()) for x in drawn] == [pytest.approx(span) for span in on]
    assert all(a < b for (a, _), (b, _) in zip(under, on, strict=False)), "switched on after it"
    threshold = data(axes, "threshold")[1]
    assert threshold.tolist() == [evaluated.scan.device.control.threshold] * 2
    carried = spans(panel(figure, "x"), "carried")
    held = [
        chosen.begin + 1e-3 * (a + part * (b - a)) for a, b in carried for part in (0.02, 0.5, 0.98)
    ]
    plate = evaluated.scan.path.plate_velocity(evaluated.scan.device.array.axis)
    assert len(held) > 2
    for t in held:
        assert pin.velocity(t) == pytest.approx(float(plate(t - pin.begin)), rel=1e-6)


def test_the_tactile_image_is_drawn_as_it_is(evaluated: Evaluation, figure: Figure) -> None:
    """Each deflection in its place and with its sign: forward is blue."""
    axes, painting = panel(figure, "felt"), paint(evaluated.scan)
    (image,) = (i for i in axes.images if i.get_gid() == "relief")
    shown = np.ma.filled(image.get_array(), np.nan)  # type: ignore[arg-type]
    np.testing.assert_array_equal(shown, 1e3 * painting.deflection)
    left, right, top, bottom = (1e3 * edge for edge in painting.extent)
    assert list(image.get_extent()) == [left, right, bottom, top]
    assert axes.get_ylim()[0] > axes.get_ylim()[1], "down the page"
    assert np.nanmax(shown) > 0.2
    low, high = image.get_clim()
    assert low == -high and 0.0 < high <= np.nanmax(np.abs(shown))
    back, rest, forward = image.to_rgba(np.array([low, 0.0, high]))
    assert forward[2] > forward[0] and back[0] > back[2]
    assert rest[:3] == pytest.approx([1.0, 1.0, 1.0], abs=0.02)
    scale = panel(figure, "scale")
    assert scale.get_ylabel() == "deflection, forward (mm)"
    assert scale.get_ylim() == (low, high)


def test_return_strokes_are_dotted_for_print_in_grey(evaluated: Evaluation, figure: Figure) -> None:
    axes, painting = panel(figure, "felt"), paint(evaluated.scan)
    (image,) = (i for i in axes.images if i.get_gid() == "relief")
    (dots,) = (c for c in axes.collections if c.get_gid() == "back")
    left, right, top, bottom = (1e3 * edge for edge in painting.extent)
    rows, columns = painting.deflection.shape
    x, y = np.meshgrid((np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows)
    places = np.column_stack([(left + x * (right - left)).flat, (top + y * (bottom - top)).flat])
    (path,) = dots.get_paths()
    dotted = path.contains_points(places).reshape(rows, columns)
    part = 1e3 * painting.deflection / image.get_clim()[1]
    assert (part < -0.3).any() and dotted[part < -0.3].mean() > 0.9
    assert not dotted[part > 0.0].any()
    assert legend_of(figure)["deflected backwards"].get_hatch() == "...."


def test_the_way_and_the_spots_are_those_of_the_hand(evaluated: Evaluation, figure: Figure) -> None:
    scan, axes = evaluated.scan, panel(figure, "print")
    begin = 1e3 * scan.spots([scan.path.begin])[:, 0]
    np.testing.assert_allclose(np.transpose(data(axes, "spots")), begin)
    paths = [points(line) for line in lines(axes, "way")]
    returns = [points(line) for line in lines(axes, "return")]
    assert all(x[-1] > x[0] for x, _ in paths), "reading goes to the right"
    assert all(x[-1] < x[0] for x, _ in returns)
    assert len(paths) == 2 and len(returns) == 1
    assert [y[0] for _, y in paths] == pytest.approx([9.0, 13.0])
    signs = legend_of(figure)
    assert signs["way of the hand, reading"].get_linestyle() == "-"
    assert signs["and back"].get_linestyle() != "-"
    assert signs["initial sensing spot of a pin"].get_marker() == "o"
    assert "threshold of the control block" in signs and "outline of the print" in signs
    chosen = moment(evaluated)
    green = lines(panel(figure, "felt"), "moment")[0]
    track = 1e3 * scan.spots([chosen.begin, chosen.end])[chosen.pin]
    x, y = points(green)
    assert [x[0], y[0], x[-1], y[-1]] == pytest.approx(track.ravel().tolist())


def test_lines_of_text_are_apart_by_slashes_and_words_do_not_overlap() -> None:
    scene = Scene.from_text("5 $ Ü\n6 $", pixel=2e-4)
    path = lines_of([scene.lines[0]], 0.002, 0.03, speed=0.08, return_speed=0.15)
    figure = plot_scan(evaluate(scan(Device(drive=DRIVE), scene, path)))
    title = panel(figure, "print").get_title(loc="left")
    assert title == r'printed: text "5 \$ Ü / 6 \$"'
    assert collisions(figure) == []
    top, above = (panel(figure, name)._left_title.get_window_extent() for name in ("seen", "print"))  # type: ignore[attr-defined]
    (head,) = figure.texts
    between = [
        (panel(figure, "felt").xaxis.label.get_window_extent(), top),
        (head.get_window_extent(), above),
    ]
    for upper, lower in between:
        assert upper.y0 - lower.y1 > figure.dpi / 25.4, "a millimetre between words"


def test_reliefs_share_a_scale_and_name_their_speeds() -> None:
    found = []
    for speed in (0.04, 0.12):
        scene = Scene.from_grating([0.004], count=2, margin=0.008, height=0.003)
        path = lines_of([scene.lines[0]], 0.002, 0.02, speed=speed, return_speed=0.15)
        found.append(evaluate(scan(Device(drive=DRIVE), scene, path)))
    figure = plot_reliefs(found)
    limits = set()
    for i, evaluation in enumerate(found):
        axes = panel(figure, f"felt {i + 1}")
        (image,) = axes.images
        np.testing.assert_array_equal(
            np.ma.filled(image.get_array(), np.nan),  # type: ignore[arg-type]
            1e3 * paint(evaluation.scan).deflection,
        )
        limits.add(image.get_clim())
        title = axes.get_title(loc="left").splitlines()
        assert title[0] == f"hand at up to {(40, 120)[i]} mm/s"
        counts = evaluation.counts
        assert title[1].startswith(f"{counts['lines.shown']} of {counts['lines.crossed']} line")
        assert title[2] == f"lag {1e3 * evaluation.spread('line.lag_off')[1]:.2g} mm"
    assert len(limits) == 1
    assert "way of the hand, reading" in legend_of(figure)
    assert collisions(figure) == []


def test_the_moment_holds_lines_of_the_pin(evaluated: Evaluation) -> None:
    for number in (None, 0, 5):
        chosen = moment(evaluated, number)
        assert number is None or chosen.pin == number
        inside = [
            line
            for line in evaluated.lines
            if line.pin == chosen.pin
            and chosen.begin <= line.begin.time
            and line.end.time <= chosen.end
        ]
        assert len(inside) > 1
    with pytest.raises(ValueError, match="pin must be a whole number from 0 to 5, got 6"):
        moment(evaluated, 6)


def test_print_and_tactile_image_have_one_scale(figure: Figure) -> None:
    printed, felt = (
        next(axes for axes in figure.axes if axes.get_label() == name) for name in ("print", "felt")
    )
    assert printed.get_xlim() == felt.get_xlim()
    assert printed.get_ylim() == felt.get_ylim()
    figure.draw_without_rendering()
    assert printed.get_window_extent().width == pytest.approx(felt.get_window_extent().width)


def test_title_has_the_verdict(evaluated: Evaluation, figure: Figure) -> None:
    title = figure.get_suptitle()
    counts = evaluated.counts
    assert "6 pins" in title
    assert f"{counts['lines.shown']} of {counts['lines.crossed']} lines shown" in title
    assert f"lag on {1e3 * evaluated.spread('line.lag_on')[1]:.2g} mm" in title


def test_a_blank_page_is_drawn() -> None:
    page = Scene(np.ones((60, 500)), 1e-4)
    path = lines_of([0.003], 0.002, 0.045, speed=0.08, return_speed=0.1)
    figure = plot_scan(evaluate(scan(Device(drive=DRIVE), page, path)))
    assert "no line passed completely under a pin" in figure.get_suptitle()
    save(figure, io.BytesIO(), "png")


@pytest.mark.parametrize(
    ("velocity", "start", "where"),
    [
        (0.02, 0.02, "along the thick line"),
        (0.0, 0.02, "at the dot"),
        (0.0, 0.2, "beyond the page"),
    ],
)
def test_history_states_its_place(velocity: float, start: float, where: str) -> None:
    page = Scene(np.ones((60, 500)), 1e-4)
    path = HandPath([0.0, 1.0], [velocity] * 2, [0.0, 0.0], (start, 0.003))
    figure = plot_scan(evaluate(scan(Device(drive=DRIVE), page, path)))
    expected = f"pin from 0.000 s on, {where}" + ("" if where.endswith("page") else " above")
    assert panel(figure, "seen").get_title(loc="left") == expected


def test_the_command_writes_figure_and_lines(tmp_path: Path) -> None:
    plot, table = tmp_path / "a.svg", tmp_path / "lines.csv"
    command = ["scan", str(MINIMAL), "--grating", "3 mm", "--set", "array.columns=2"]
    done = CliRunner().invoke(
        app, [*command, "--plot", str(plot), "--pin", "1", "--lines", str(table)]
    )
    assert done.exit_code == 0, done.output
    assert "8 lines passed under the pins: 8 shown" in done.output
    assert "the most that skin could move" in done.output
    assert "skin force (mN)" in plot.read_text(encoding="utf-8")
    assert "pin 1 from" in plot.read_text(encoding="utf-8")
    rows = list(csv.DictReader(table.read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 8
    assert {row["pin"] for row in rows} == {"0", "1"}
    for row in rows:
        assert row["fate"] == "shown"
        latency, lag = float(row["line_latency_on [s]"]), float(row["line_lag_on [m]"])
        assert 0.0 < lag <= latency * 0.0601
        smear = row["line_smear [m]"]
        assert not smear or not isnan(float(smear))
    dull = CliRunner().invoke(app, [*command, "--set", "criteria.felt=9 mm"])
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


def test_the_history_marks_when_the_finger_is_lifted(evaluated: Evaluation) -> None:
    """In the panel of the skin's force, and in the key where it is."""
    finger = Contact(coefficient=0.5, static_coefficient=0.75, stiffness=300.0)
    device = Device(drive=replace(DRIVE, finger=finger, touch_force=0.040))
    plain = evaluate(scan(device, evaluated.scan.scene, evaluated.scan.path))
    begin = moment(plain).begin
    off, on = begin + 0.05, begin + 0.15
    touch = Profile([off, off, on, on], [0.040, 0.0, 0.0, 0.040])
    lifted = evaluate(scan(device, evaluated.scan.scene, evaluated.scan.path, touch=touch))
    assert moment(lifted).begin == begin
    drawn = plot_scan(lifted, 0)
    (span,) = spans(panel(drawn, "force"), "lifted")
    assert span == pytest.approx((50.0, 150.0), abs=1e-6)
    assert "finger lifted" in legend_of(drawn)
    assert "finger lifted" not in legend_of(plot_scan(plain, 0))

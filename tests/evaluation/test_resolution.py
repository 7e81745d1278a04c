"""Largest hand speed over two lines: scans of drawn lines, laws, and the command line."""

from __future__ import annotations

from dataclasses import replace
from math import copysign, cos, isnan
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from command import EXAMPLES
from notebook_reading import check_faces
from pindrive import Contact, Drive, load_device
from pindrive.cli.app import app
from pindrive.cli.scan_tables import beyond, speed_report
from pindrive.cli.tables import console
from pindrive.device import (
    Criteria,
    Device,
    Electromagnet,
    HandPath,
    PinArray,
    PinState,
    Scene,
    scan,
)
from pindrive.evaluation import evaluate
from pindrive.evaluation.resolution import (
    SpeedLimit,
    SpeedLimits,
    largest_speeds,
    two_lines,
)
from pindrive.plot.resolution import plot_speeds
from pindrive.quantities.table import QUANTITIES
from tactile_mouse import PLATE, RIGID, SKIN, drive

MINIMAL = Path(__file__).parents[1] / "minimal.toml"


DEVICE = Device(drive=drive())


def steady(device: Device) -> PinState:
    """State of a pin under a hand in long uniform motion: dragged, and at rest."""
    finger, along = device.drive.finger, cos(device.array.axis)
    position = copysign(device.drag(device.array.axis), along)
    if finger.rigid:
        return PinState(position=position)
    plate = device.drive.plate.kinetic * device.load(device.magnet.residual) * abs(along)
    held = plate if plate <= finger.static_friction else finger.kinetic
    return PinState(position=position, skin_stretch=copysign(held / finger.stiffness, along))


READER = EXAMPLES / "tactile-reader.toml"
TRIED = (0.01, 0.4)


@pytest.fixture(scope="module")
def limits() -> SpeedLimits:
    return largest_speeds(DEVICE, [0.004, 0.002], slowest=TRIED[0], fastest=TRIED[1])


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
@pytest.mark.parametrize(
    ("speed", "axis"), [(0.02, 0.0), (0.09, 0.0), (0.3, 0.0), (0.09, 0.35), (0.09, 2.5)]
)
def test_a_trial_is_the_worst_of_scans_of_drawn_lines_at_any_phase(
    finger: Contact, speed: float, axis: float
) -> None:
    """Sixty random phases; every number as `evaluate` finds it on a page."""
    device = Device(drive=drive(finger), array=PinArray(axis=axis))
    scene = Scene.from_grating([0.004], count=2, margin=0.15, height=0.001, pixel=5e-5)
    y, look = 0.5 * scene.extent[3], 1.0 / device.control.sample_rate
    backs, skins = [], []
    for phase in np.random.default_rng(1).uniform(0.0, 1.0, 60):
        begin = 0.15 - speed * (0.002 + look * (1.0 - phase))
        lasts = min(0.4, (scene.extent[1] - begin) / speed - 1e-9)
        path = HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (begin, y))
        first, second = evaluate(scan(device, scene, path, start=[steady(device)])).lines
        backs.append(first.returned / (first.height - device.drag(axis)))
        skins += [
            max(edge.skin for edge in (line.begin, line.end) if edge.skin == edge.skin)
            for line in (first, second)
        ]
    trial = two_lines(device, 0.004, 0.002, speed, Criteria())
    assert trial.back == pytest.approx(min(backs), rel=1e-6)
    assert trial.skin == pytest.approx(min(skins), rel=1e-6)


@pytest.mark.parametrize("axis", [0.0, 0.35, 2.5])
def test_a_steady_pin_stays(axis: float) -> None:
    page = Scene.from_grating([0.004], count=1, margin=0.03, height=0.001)
    for finger in (RIGID, SKIN, Contact(0.030, 0.045), Contact(0.030, 0.045, stiffness=400.0)):
        device = Device(drive=drive(finger), array=PinArray(axis=axis))
        path = HandPath([0.0, 0.2], [0.06] * 2, [0.0] * 2, (0.001, 0.001))
        (pin,) = scan(device, page, path, start=[steady(device)]).pins
        assert pin.position([0.0, 0.1, 0.2]) == pytest.approx(steady(device).position, abs=1e-12)
        assert abs(float(pin.velocity(0.1))) < 1e-9
        pulled = PLATE.kinetic * cos(axis)  # spring and finger hold it there, as it slid there
        slid = abs(pulled) > finger.static_friction
        rest = pulled - copysign(finger.kinetic, pulled) if slid else 0.0
        assert pin.position(0.2) == pytest.approx(rest / device.drive.stiffness, abs=1e-12)


def test_a_drive_at_an_angle_has_a_limit_of_its_own(limits: SpeedLimits) -> None:
    """The plate carries its pin less far."""
    turned = replace(DEVICE, array=PinArray(axis="30 deg"))
    (limit,) = largest_speeds(turned, [0.004], slowest=TRIED[0], fastest=TRIED[1])
    assert limit.speed != pytest.approx(limits[0].speed, rel=1e-3)


def test_the_limit_lies_between_distinct_and_not(limits: SpeedLimits) -> None:
    limit, criteria = limits[0], Criteria()
    within, past = (
        two_lines(DEVICE, 0.004, 0.002, factor * limit.speed, criteria) for factor in (1.0, 1.002)
    )
    assert within.distinct(criteria.direction)
    assert not past.distinct(criteria.direction)
    assert limit.beyond is not None
    assert limit.speed < limit.beyond.speed < 1.002 * limit.speed
    assert 0.0 < limit.settled_speed < limit.speed


def test_the_settled_limit_is_where_the_transient_of_a_line_alone_just_fits(
    limits: SpeedLimits,
) -> None:
    """On drawn pages: one line and its settling, two lines and when the second moves the pin."""
    speed = limits[0].settled_speed
    lone, two = (
        Scene.from_grating([0.004], count=count, margin=0.1, height=0.001, pixel=5e-5)
        for count in (1, 2)
    )
    spare = []
    for phase in range(4):
        begin = 0.1 - speed * (0.002 + 1e-3 * (1.0 - 0.25 * phase))
        way = [begin, 0.5 * two.extent[3]]
        alone, both = (
            evaluate(
                scan(
                    DEVICE,
                    page,
                    HandPath([0.0, 0.09 / speed], [speed] * 2, [0.0] * 2, (way[0], way[1])),
                    start=[steady(DEVICE)],
                )
            )
            for page in (lone, two)
        )
        t = np.linspace(both.lines[1].begin.command, both.lines[1].begin.response, 20001)
        taken = t[int(np.argmin(both.scan.pins[0].position(t)))]
        spare.append(taken - alone.lines[0].settled)
    assert -1e-5 < min(spare) < 1.2e-3, "as sharp as a look"


def test_wider_pitches_weaker_demands_and_faster_magnets_allow_more(
    limits: SpeedLimits,
) -> None:
    wide, narrow = limits
    assert narrow.speed < wide.speed
    slow = replace(DEVICE, magnet=Electromagnet.from_times(fall_time=0.03))
    half = Criteria(distinct=0.5)
    strict, slower = (
        largest_speeds(device, [0.004], criteria=half, slowest=0.03, fastest=0.2)[0]
        for device in (DEVICE, slow)
    )
    assert strict.speed < wide.speed
    assert slower.speed < 0.8 * strict.speed


def test_everything_scales_with_time() -> None:
    """Twice as slow a device, in all its times, takes a hand half as fast."""
    lighter = replace(drive(Contact(0.010, 0.015)), preload=0.030 * 9.80665)
    fast = Device(drive=lighter)  # pressed on the plate as hard as the heavier one
    body = Drive(
        mass=0.040, stiffness=100.0, damping=0.64, plate=PLATE, finger=Contact(0.010, 0.015)
    )
    magnet, control = fast.magnet, fast.control
    slow = Device(
        drive=body,
        magnet=replace(
            magnet,
            rise_constant=2.0 * magnet.rise_constant,
            fall_constant=2.0 * magnet.fall_constant,
        ),
        control=replace(
            control, sample_rate=0.5 * control.sample_rate, latency=2.0 * control.latency
        ),
    )
    (one,) = largest_speeds(fast, [0.003], slowest=0.04, fastest=0.2)
    (other,) = largest_speeds(slow, [0.003], slowest=0.02, fastest=0.1)
    assert other.speed == pytest.approx(0.5 * one.speed, rel=3e-3)  # MOMENT and bisection do not


def test_skin_that_hardly_gives_allows_no_speed() -> None:
    stiff = Device(drive=drive(Contact(0.005, 0.0075, stiffness=2000.0)))
    (limit,) = largest_speeds(stiff, [0.004], slowest=TRIED[0], fastest=TRIED[1])
    assert isnan(limit.speed) and isnan(limit.settled_speed) and limit.beyond is None
    assert beyond(limit, Criteria()) == "the lines are distinct at no speed tried"


def test_limit_beyond_the_range_is_reported() -> None:
    limits = largest_speeds(DEVICE, [0.008], slowest=0.04, fastest=0.05)
    assert limits[0].speed == 0.05
    shown = console()
    with shown.capture() as captured:
        shown.print(speed_report(limits, Criteria()))
    assert "> 50.00" in captured.get()


def test_islands_are_reported() -> None:
    limit = SpeedLimit(
        pitch=0.002,
        width=0.001,
        tried=(0.005, 1.0),
        distinct=((0.005, 0.05), (0.07, 0.08)),
        settled=(),
        beyond=None,
    )
    assert beyond(limit, Criteria()) == "is distinct again at 70.00-80.00 mm/s"


def test_a_pin_that_the_finger_holds_is_distinct_only_for_a_faster_hand() -> None:
    """Fine lines, slowly: friction of the finger keeps the pin from coming back half its way."""
    held, criteria = Device(drive=drive(SKIN, damping=0.64)), Criteria(distinct=0.46)
    (limit,) = largest_speeds(held, [0.001], criteria=criteria, slowest=0.005, fastest=0.05)
    low, high = limit.distinct[0]
    assert 0.006 < low < high < 0.03
    slow = two_lines(held, 0.001, 0.0005, 0.9 * low, criteria)
    assert not slow.shown
    shown = console()
    with shown.capture() as captured:
        shown.print(speed_report([limit], criteria))
    digits = QUANTITIES["hand_speed"].digits
    assert f"{digits(low)} to {digits(high)}" in captured.get()
    gids = [line.get_gid() for line in plot_speeds([limit], criteria).axes[0].lines]
    assert "slowest" in gids


def test_bad_values_are_refused() -> None:
    for given, message in (
        ({"pitches": []}, "pitches must be at least one, got none"),
        (
            {"pitches": [0.0]},
            "pitch must be finite and at least 1e-6 m and at most 10 m, got 0.0 m",
        ),
        ({"pitches": [0.002], "width": 0.002}, "width must be less than the pitch, 0.002 m, got"),
        ({"pitches": [0.002], "slowest": 2.0}, "fastest must be greater than the slowest, 2.0 m/s"),
    ):
        with pytest.raises(ValueError) as refused:
            largest_speeds(DEVICE, **given)
        assert str(refused.value).startswith(message)


def test_the_figure_shows_the_curve(limits: SpeedLimits) -> None:
    assert check_faces(limits) == 0
    data = limits.to_dataset()
    assert data.speed_distinct.values.tolist() == [limit.speed for limit in limits]
    assert data.speed_settled.units == "m/s"
    figure = limits.plot("a mouse")
    (axes,) = figure.axes
    curves = {line.get_gid(): line for line in axes.lines}
    x, y = np.asarray(curves["distinct"].get_data(), float)
    assert x == pytest.approx([2.0, 4.0])
    assert y == pytest.approx([1e3 * limits[1].speed, 1e3 * limits[0].speed])
    assert "a mouse" in figure.get_suptitle() and "25%" in figure.get_suptitle()


def test_the_command(tmp_path: Path) -> None:
    run, target = CliRunner().invoke, tmp_path / "speed.svg"
    tried = ["--slowest", "30 mm/s", "--fastest", "0.2 m/s"]
    done = run(app, ["speed", str(MINIMAL), "--pitch", "3 mm", *tried, "--plot", str(target)])
    assert done.exit_code == 0, done.output
    assert "distinct up to" in done.output and "3.000" in done.output
    assert "Two lines are distinct where the pin comes back at least 25%" in done.output
    assert "hand speed (mm/s)" in target.read_text(encoding="utf-8")
    for bad, words in (
        (
            ["--pitch", "3"],
            '--pitch: pitch must be a number with its unit (give a unit, like "2 mm"), got "3"',
        ),
        (["--width", "9 mm", "--pitch", "3 mm"], "width must be less than the pitch"),
        (["--plot", str(tmp_path / "speed.bmp")], "must end in .png, .svg, .pdf"),
        (
            ["--slowest", "fast"],
            '--slowest: slowest must be a number with its unit, like "5 mm/s", got "fast"',
        ),
    ):
        refused = run(app, ["speed", str(MINIMAL), *bad])
        assert refused.exit_code == 2
        assert words in refused.output
    assert [path.name for path in tmp_path.iterdir()] == ["speed.svg"]


@pytest.mark.parametrize("distinct", [0.1, 0.25, 0.5])
def test_scans_and_speed_have_one_rule_of_merged_lines(distinct: float) -> None:
    """A drawn page shows both lines at any phase just below the limit, and not just above."""
    criteria = Criteria(distinct=distinct)
    (limit,) = largest_speeds(
        DEVICE, [0.004], criteria=criteria, slowest=TRIED[0], fastest=TRIED[1]
    )
    page = Scene.from_grating([0.004], count=2, margin=0.15, height=0.001, pixel=5e-5)
    shown = []
    for speed in (0.998 * limit.speed, 1.003 * limit.speed):
        fates = set()
        for phase in np.arange(40) / 40:
            begin = 0.15 - speed * (0.002 + 1e-3 * (1.0 - phase))
            way = begin, 0.5 * page.extent[3]
            path = HandPath([0.0, 0.1 / speed], [speed] * 2, [0.0] * 2, way)
            found = evaluate(scan(DEVICE, page, path, start=[steady(DEVICE)]), criteria)
            fates |= {line.fate for line in found.lines}
        shown.append(fates == {"shown"})
    assert shown == [True, False]


def test_a_limit_is_compared_with_that_of_drive_and_finger_alone() -> None:
    """Whole samples set the usual limit; a fast control block leaves it to the drive."""
    device = load_device(READER, whole=True).device
    (slow,) = largest_speeds(device, [0.002])
    quick = replace(device, control=replace(device.control, sample_rate=5e4))
    (fast,) = largest_speeds(quick, [0.002])
    assert (slow.bound, fast.bound) == ("control block", "drive")
    assert slow.speed == pytest.approx(0.24996, rel=1e-3)  # whole samples: 1 mm in 4 ms
    assert slow.alone == pytest.approx(fast.speed, rel=3e-3)
    assert slow.alone > 1.05 * slow.speed


def test_the_search_goes_on_until_a_limit_is_found() -> None:
    device = load_device(READER, whole=True).device
    (grown,) = largest_speeds(device, [0.020])
    (cut,) = largest_speeds(device, [0.020], fastest=1.0)
    assert (cut.beyond, cut.speed) == (None, 1.0)
    assert grown.beyond is not None and grown.tried[1] == 4.0
    assert 2.0 < grown.speed < 4.0
    given = (grown.speed * 0.99, grown.speed * 1.01)
    trials = [two_lines(device, 0.020, 0.010, speed, Criteria()) for speed in given]
    assert [trial.distinct(Criteria().direction) for trial in trials] == [True, False]

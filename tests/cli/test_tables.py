"""The tables of motions and scans: each cell is the number of its row and column, in its unit."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, isnan, nan
from pathlib import Path
from statistics import median

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from pindrive import Contact, Motion, Release, simulate
from pindrive.cli.scan_tables import (
    evaluation_report,
    scan_report,
    speed_report,
    verdict_words,
)
from pindrive.cli.tables import device_words, ending, motion_report, path_words, regime
from pindrive.device import Criteria, Device, HandPath, PinArray, Scene, lines, scan
from pindrive.device.dataset import numbers as pin_numbers
from pindrive.evaluation import Evaluation, evaluate
from pindrive.evaluation.line_crossings import FATES
from pindrive.evaluation.resolution import SpeedLimit, Trial
from pindrive.files.device import load_device
from pindrive.motion.simulate import motion_of
from pindrive.quantities.table import QUANTITIES
from table_reading import numbers, printed, table

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def motion() -> Motion:
    return motion_of(load_device(EXAMPLES / "tactile-mouse.toml"))


@pytest.fixture(scope="module")
def evaluated() -> Evaluation:
    drive = load_device(EXAMPLES / "tactile-reader.toml", whole=True).drive
    device = Device(drive=drive, array=PinArray.grid(3, 2, 0.004))
    scene = Scene.from_grating([0.004, 0.0015], count=2, margin=0.008, height=0.008)
    path = lines([scene.lines[0]], 0.005, 0.027, speed=0.15, return_speed=0.15, pause=0.05)
    return evaluate(scan(device, scene, path))


def close(cell: str, value: float, scale: float = 1e3) -> bool:
    """Return True if a cell is a value to four digits."""
    return float(cell) == pytest.approx(scale * value, rel=1.01e-3, abs=1e-12)


def test_phases(motion: Motion) -> None:
    heads, units, *rows = table(motion_report(motion), "Phases")
    assert heads == ["from", "to", "duration", "phase", "x", "v", "ends as"]
    assert units[:3] == ["ms", "ms", "ms"] and units[4:6] == ["mm", "mm/s"]
    assert len(rows) == len(motion.segments) > 4
    for row, segment in zip(rows, motion.segments, strict=True):
        assert close(row[0], segment.begin)
        assert row[3] == segment.mode
        assert close(row[4], float(motion.position(segment.begin)))
        assert float(row[5]) == pytest.approx(
            1e3 * float(motion.velocity(segment.begin)), rel=1e-3, abs=1e-9
        )
        if isfinite(segment.end):
            assert close(row[1], segment.end)
            assert close(row[2], segment.end - segment.begin)
        else:
            assert row[2] == "forever"
        words = {"stick": "sticks", "slip": "slips", "reverse": "reverses"}
        ends = [e for e in motion.events if e.time == segment.end]
        assert row[6] == ", ".join(f"{e.contact} {words[e.kind]}" for e in ends)


def test_numbers_of_a_motion(motion: Motion) -> None:
    _, *rows = table(motion_report(motion), "Transient, from the release to 132.7 ms")
    found = {row[0]: row for row in rows if row[0]}
    compared = 0
    for name, value in motion.numbers().items():
        quantity = QUANTITIES[name]
        row = found.get(quantity.symbol)
        if row is None or quantity.symbol == "" or isnan(value) or name.startswith("energy."):
            continue
        assert row[2] == quantity.display_unit
        assert close(row[1], value, quantity.display_scale), name
        compared += 1
    assert compared > 10
    assert found["t_a"][1:3] == ["3.022", "ms"], "the peak is the first turning point"
    peak, trough = found["x_m,a"], found["x_m,c"]
    assert close(peak[1], motion.transient.peak_displacement)
    assert close(trough[1], motion.transient.trough_displacement)
    assert "on the way out" in peak[3] and "follows the peak" in trough[3]


def test_the_ending_in_words(motion: Motion) -> None:
    place, since = numbers(ending(motion))
    assert place == pytest.approx(1e3 * motion.ending.position, rel=1e-3)
    assert since == pytest.approx(1e3 * motion.transient.rest_time, rel=1e-3)
    weak = [f"finger.{name}=1e-9 N" for name in ("kinetic", "static")]
    undamped = ["damping_ratio=0", "plate.kinetic=0 N", *weak]
    drive = load_device(EXAMPLES / "tactile-mouse.toml", undamped).drive
    for duration, said in ((0.01, "10 ms"), (1.5, "1500 ms"), (32.5, "32.5 s")):
        free = simulate(drive, Release(0.06, 2e-3), duration=duration)
        assert ending(free) == f"Still moving after {said}."


def test_regimes() -> None:
    names = [regime(ratio) for ratio in (0.0, 0.5, 1.0, 2.0)]
    assert names == ["undamped", "underdamped", "critically damped", "overdamped"]


def test_pins_of_a_scan(evaluated: Evaluation) -> None:
    done = evaluated.scan
    heads, *_ = rows = table(scan_report(done), "Pins, over lines every 4, 1.5 mm")
    del heads
    body = [row for row in rows if row[0].isdigit()]
    units = next(row for row in rows if row[1] == "mm")
    names = [
        *("pin.energised", "pin.switchings", "pin.slips", "pin.captures", "pin.carried"),
        *("pin.peak_displacement", "pin.peak_skin_force", "pin.peak_stretch"),
    ]
    assert [QUANTITIES[name].display_unit for name in names] == units[2 : 2 + len(names)]
    assert len(body) == len(done.pins) == 6
    for row, pin in zip(body, done.pins, strict=True):
        assert row[0] == str(pin.number)
        assert numbers(row[1]) == pytest.approx(
            [1e3 * x for x in done.device.array.places[pin.number]]
        )
        for cell, name in zip(row[2:], names, strict=False):
            value = pin_numbers(pin)[name]
            assert close(cell, value, QUANTITIES[name].display_scale), name
        gaps = [gap.size for gap in done.gaps if pin.number in (gap.behind, gap.ahead)]
        assert close(row[-1], min(gaps))


def test_a_device_in_words(evaluated: Evaluation) -> None:
    device = evaluated.scan.device
    reach = device_words(device)[0]
    assert reach.startswith("A magnet carries its pin up to ") and reach.endswith(" mm.")
    assert numbers(reach) == pytest.approx([1e3 * device.reach], rel=1e-3)


def test_fates_of_the_lines(evaluated: Evaluation) -> None:
    heads, *rows = table(evaluation_report(evaluated), "Counts of the lines")
    assert heads == ["symbol", "count", "meaning"]
    found = {row[2]: int(row[1]) for row in rows}
    assert len(found) == len(rows) == 9
    for name, count in evaluated.counts.items():
        assert found[QUANTITIES[name].meaning] == count, name
    counts = evaluated.counts
    missed = counts["lines.unseen"] + counts["lines.merged"] + counts["lines.faint"]
    first = verdict_words(evaluated)[0]
    unsure = counts["lines.shown"] - counts["lines.sure"]
    doubts = [count for count in (counts["lines.unsettled"], unsure) if count]
    reported = [counts["lines.crossed"], counts["lines.shown"], *doubts, missed]
    assert numbers(first)[: len(reported)] == reported
    assert numbers(first)[-1] == counts["lines.false"]


def test_counts_and_spreads_are_those_of_the_lines(evaluated: Evaluation) -> None:
    shown, counts = evaluated.shown, evaluated.counts
    cues = [line.begin.cue for line in shown]
    assert counts["lines.sure"] == cues.count("sure")
    assert counts["lines.direction"] == cues.count("direction") + cues.count("sure") > 0
    assert counts["lines.unsettled"] == sum(isnan(line.settled) for line in shown)
    for fate in FATES:
        assert counts[f"lines.{fate}"] == sum(line.fate == fate for line in evaluated.lines)
    for name in evaluated.lines[0].numbers:
        known = [line.numbers[name] for line in shown if not isnan(line.numbers[name])]
        expected = (min(known), median(known), max(known)) if known else (nan, nan, nan)
        assert_array_equal(evaluated.spread(name), expected)


def test_lines_shown(evaluated: Evaluation) -> None:
    heads, *rows = table(evaluation_report(evaluated), "Lines shown to the finger")
    assert heads[1:4] == ["least", "median", "most"]
    found = {row[-1]: row for row in rows}
    for name in evaluated.lines[0].numbers:
        quantity = QUANTITIES[name]
        row = found[quantity.meaning]
        for cell, value in zip(row[1:4], evaluated.spread(name), strict=True):
            if isnan(value):
                assert cell == "-"
            elif cell.endswith("%"):
                assert float(cell[:-1]) == pytest.approx(100.0 * value, abs=0.051)
            else:
                assert close(cell, value, quantity.display_scale), name
        if quantity.display_unit:
            assert row[4] == quantity.display_unit
    least, median, most = evaluated.spread("line.lag_off")
    assert least < median < most, "a test that can tell them apart"
    lags = np.array([line.numbers["line.lag_off"] for line in evaluated.shown])
    known = lags[~np.isnan(lags)]
    assert (least, median, most) == (known.min(), np.median(known), known.max())
    assert median != known.mean()


def test_speeds() -> None:
    limits = [
        SpeedLimit(
            pitch=0.002,
            width=0.001,
            tried=(0.005, 1.0),
            distinct=((0.005, 0.2), (0.3, 0.4)),
            settled=((0.005, 0.1),),
            beyond=Trial(0.21, 0.25, 1e-4, shown=False),
            alone=0.23,
        ),
        SpeedLimit(
            pitch=0.004,
            width=0.0015,
            tried=(0.005, 1.0),
            distinct=((0.01, 1.0),),
            settled=(),
            beyond=None,
        ),
    ]
    heads, units, one, other = table(speed_report(limits, Criteria()), "Largest hand speed")
    words = ["distinct up to", "settled up to", "drive alone", "a faster hand"]
    assert heads == ["pitch", "width", *words]
    assert units[:5] == ["mm", "mm", "mm/s", "mm/s", "mm/s"]
    assert one[:5] == ["2.000", "1.000", "200.0", "100.0", "230.0"]
    assert one[5] == "lets the pin return by 25%, is distinct again at 300.0-400.0 mm/s"
    assert other[:4] == ["4.000", "1.500", "10.00 to > 1000", "-"]
    said = printed(speed_report(limits, Criteria()))
    assert "Tried: 5.000 mm/s to 1000 mm/s" in said
    assert "Whole samples of the control block bind every limit" in said
    assert [limit.bound for limit in limits] == ["control block", ""]
    assert replace(limits[0], alone=0.201).bound == "drive"


def test_a_hand_exactly_along_the_axis_is_named() -> None:
    """Static friction of the plate counts for it alone."""
    path = HandPath([0.0, 1.0], [0.05] * 2, [0.0] * 2, (0.0, 0.0))
    assert "any real hand is oblique" in path_words(path, 0.0, Contact(0.02, 0.03))
    for axis, plate in ((1e-4, Contact(0.02, 0.03)), (0.0, Contact(0.02)), (0.0, None)):
        assert "oblique" not in path_words(path, axis, plate)

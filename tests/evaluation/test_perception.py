"""Evaluation of a scan: against dense samples, against `simulate`, and by laws."""

from __future__ import annotations

from dataclasses import replace
from math import isnan, nan
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq

from pindrive import Contact, Drive, Function, Release, simulate
from pindrive.device import (
    ControlBlock,
    Criteria,
    Device,
    Electromagnet,
    HandPath,
    PinArray,
    PinScan,
    Scan,
    Scene,
    scan,
    strokes,
)
from pindrive.evaluation import Evaluation, Line, evaluate
from pindrive.evaluation.line_crossings import FATES, printed_lines
from random_scans import RandomScan, later, mirrored
from tactile_mouse import RIGID, SKIN, drive


def grating(*pitches: float, count: int = 2, margin: float = 0.012) -> Scene:
    """Lines half as wide as their pitch, about x = 0."""
    scene = Scene.from_grating(pitches, count=count, margin=margin)
    columns = scene.luminance.shape[1]
    return Scene(scene.luminance, scene.pixel, (-0.5 * columns * scene.pixel, 0.0), scene.lines)


def across(scene: Scene, speed: float = 0.06, margin: float = 0.002) -> HandPath:
    left, right, _, _ = scene.extent
    y = scene.lines[0]
    return strokes([(left + margin, y), (right - margin, y)], speed, pause=0.1)


def evenly(scene: Scene, speed: float = 0.06) -> HandPath:
    left, right, _, _ = scene.extent
    lasts = (right - left - 0.002) / speed
    return HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (left + 0.001, scene.lines[0]))


def numbers(line: Line) -> list[float]:
    return list(line.numbers.values())


# ---- what is printed -----------------------------------------------------------------------------


class Printed(NamedTuple):
    begin: float
    end: float
    whole: bool


def printed(done: Scan) -> list[list[Printed]]:
    """The lines along the way of each pin, one by one."""
    found = printed_lines(done.device, done.path, done.scene)
    columns = ((pin.begin.tolist(), pin.end.tolist(), pin.whole.tolist()) for pin in found)
    return [[Printed(*row) for row in zip(*pin, strict=True)] for pin in columns]


def test_edges_are_where_the_lines_were_drawn() -> None:
    scene = grating(0.004, 0.0021)
    path = across(scene, 0.07)
    array = PinArray([(0.0, 0.0), (0.0013, 0.002)])
    done = scan(Device(drive=drive(), array=array), scene, path)
    begin = scene.extent[0] + 0.012
    drawn = [(0.0, 0.002), (0.004, 0.006), (0.018, 0.01905), (0.0201, 0.02115)]
    for (shift, _), passed in zip(array.spots, printed(done), strict=True):
        assert all(line.whole for line in passed)
        for line, edges in zip(passed, drawn, strict=True):
            for time, edge in zip((line.begin, line.end), edges, strict=True):
                place = begin + edge - shift
                exact = brentq(lambda t, x=place: path.position(t)[0] - x, 0.0, 1.0, xtol=1e-15)
                assert time == pytest.approx(exact, abs=1e-9)


def test_a_line_on_which_the_hand_turns_or_begins_is_not_whole() -> None:
    scene = grating(0.008, count=1)
    y, (left, right, _, _) = scene.lines[0], scene.extent
    for stops, whole in (
        ([(left + 0.002, y), (0.0, y), (left + 0.002, y)], [False]),
        ([(0.0, y), (right - 0.002, y)], [False]),
        ([(left + 0.002, y), (0.0, y)], [False]),
        ([(left + 0.002, y), (right - 0.002, y), (left + 0.002, y)], [True, True]),
    ):
        done = scan(Device(drive=drive()), scene, strokes(stops, 0.06, pause=0.05))
        (passed,) = printed(done)
        assert [line.whole for line in passed] == whole
        assert len(evaluate(done).lines) == sum(whole)


def test_turnings_are_where_the_hand_stops_or_turns() -> None:
    scene = grating(0.004)
    y = scene.lines[0]
    path = HandPath([0.0, 0.1, 0.2, 0.3], [0.06, -0.02, 0.0, 0.0], [0.0] * 4, (0.0, y))
    done = scan(Device(drive=drive()), scene, path)
    assert done.path.turnings(done.device.array.axis) == pytest.approx([0.075, 0.2])


# ---- against dense samples -----------------------------------------------------------------------


def sampled(done: Scan, pin: PinScan, passed: Any, felt: float) -> list[dict[str, float]]:
    """The numbers of lines that the hand passes forwards, by their definitions, from samples."""
    step = 2e-6
    path, found = done.path, []
    spans = pin.energised
    assert len(spans) == len(passed)
    t = np.arange(pin.begin, pin.end, step)
    x, rigid = pin.position(t), done.device.drive.finger.rigid
    skin = x if rigid else pin.stretch(t)
    carried = np.zeros(len(t), bool)
    for segment in pin.motion.segments:
        if segment.plate == 0:
            carried |= (t >= segment.begin) & (t < segment.end)

    def first_climb(y: Any, begin: float, end: float) -> int | None:
        i, j = np.searchsorted(t, (begin, end))
        above = y[i:j] - np.minimum.accumulate(y[i:j]) >= felt
        return int(i + np.argmax(above)) if above.any() else None

    begins = [
        first_climb(x, on, nxt)
        for (on, _), nxt in zip(spans, [*(s[0] for s in spans[1:]), pin.end], strict=True)
    ]
    stops = [s for s in done.path.turnings(done.device.array.axis) if s > spans[-1][1]]
    for k, line in enumerate(passed):
        on, off = spans[k]
        i = begins[k]
        assert i is not None
        dip = int(np.searchsorted(t, on)) + int(np.argmin(x[np.searchsorted(t, on) : i + 1]))
        limit = stops[0] if stops else pin.end
        if k + 1 < len(spans):
            a, b = int(np.searchsorted(t, spans[k + 1][0])), begins[k + 1]
            assert b is not None
            limit = t[a + int(np.argmin(x[a : b + 1]))]
        last = min(int(np.searchsorted(t, limit)), len(t) - 1)
        peak = i + int(np.argmax(x[i : last + 1]))
        low = x[peak : last + 1].min()
        back = first_climb(-x, off, limit)
        j = int(np.searchsorted(t, off))
        released = j + int(np.argmin(carried[j:])) if carried[j] else j
        end = x[last]
        band = 0.05 * abs(x[released] - end)
        out = np.flatnonzero(np.abs(x[released:last] - end) >= band)
        settled = t[released + (out[-1] + 1 if out.size else 0)]
        settles = limit - settled >= np.pi / done.device.drive.natural_frequency
        place = end if settles else done.device.drag()
        found.append(
            {
                "line.latency_on": t[i] - line.begin,
                "line.latency_off": nan if back is None else t[back] - line.end,
                "line.stroke": x[peak] - x[dip],
                "line.skin_on": skin[dip : peak + 1].max() - skin[dip],
                "line.skin_off": skin[peak] - skin[peak : last + 1].min(),
                "line.smear_time": settled - t[released] if settles else nan,
                "line.smear": path.position(settled)[0] - path.position(t[released])[0]
                if settles
                else nan,
                "line.overshoot": max(0.0, (place - low) / (x[peak] - place)),
                "line.contrast": (x[peak] - low) / (abs(x[peak]) + abs(low)),
            }
        )
    return found


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
@pytest.mark.parametrize("speed", [0.03, 0.12])
def test_numbers_are_those_of_dense_samples(finger: Contact, speed: float) -> None:
    scene = grating(0.004, 0.012)
    done = scan(Device(drive=drive(finger)), scene, across(scene, speed))
    evaluation = evaluate(done)
    assert {line.fate for line in evaluation.lines} == {"shown"}
    expected = sampled(done, done.pins[0], printed(done)[0], evaluation.criteria.felt)
    for line, samples in zip(evaluation.lines, expected, strict=True):
        for name, value in samples.items():
            size = {"line.overshoot": 1e-4, "line.contrast": 1e-4, "line.smear": 1e-6}
            size |= {"line.stroke": 1e-6, "line.skin_on": 5e-7, "line.skin_off": 5e-7}
            tolerance = size.get(name, 2e-5 if name == "line.smear_time" else 6e-6)
            assert line.numbers[name] == pytest.approx(value, abs=tolerance, nan_ok=True), name


# ---- against simulate ----------------------------------------------------------------------------


def test_smear_is_settling_time_times_hand_speed() -> None:
    """A line without a successor: the transient that `simulate` computes from the release."""
    scene, speed = grating(0.004, count=1, margin=0.05), 0.06
    done = scan(Device(drive=drive()), scene, evenly(scene, speed))
    (pin,), (line,) = done.pins, evaluate(done).lines
    assert isinstance(pin.load, Function)
    since = Function([piece.from_time(piece.begin - line.release) for piece in pin.load.pieces])
    release = simulate(
        drive(),
        Release(
            speed,
            float(pin.position(line.release)),
            plate_load=since,
        ),
    )
    settling = release.transient.settling_time
    assert line.settled - line.release == pytest.approx(settling, rel=1e-9)
    assert line.smear == pytest.approx(settling * speed, rel=1e-9)
    assert line.overshoot == pytest.approx(
        (release.ending.position - release.transient.trough_displacement)
        / (release.transient.peak_displacement - release.ending.position),
        rel=1e-9,
    )


def test_lag_is_latency_times_an_even_speed() -> None:
    scene, speed = grating(0.004), 0.037
    for line in evaluate(scan(Device(drive=drive()), scene, evenly(scene, speed))).lines:
        for edge in (line.begin, line.end):
            assert edge.lag == pytest.approx(speed * edge.latency, rel=1e-12)
            assert edge.command < edge.response
            assert edge.latency > 0.005


def test_a_later_clock_changes_nothing() -> None:
    scene = grating(0.004, 0.009)
    path = across(scene)
    late = later(path, 16.0)
    for finger in (RIGID, SKIN):
        one, other = (evaluate(scan(Device(drive=drive(finger)), scene, p)) for p in (path, late))
        assert one.counts == other.counts
        for a, b in zip(one.lines, other.lines, strict=True):
            assert a.begin.time + 16.0 == pytest.approx(b.begin.time, abs=1e-9)
            assert numbers(a) == pytest.approx(numbers(b), rel=1e-6, abs=1e-9, nan_ok=True)


def test_mirrored_scene_and_path_are_evaluated_alike() -> None:
    scene = grating(0.002, 0.0071)
    other_way = replace(scene, luminance=scene.luminance[:, ::-1])
    path = across(scene, 0.1)
    back = mirrored(path)
    for finger in (RIGID, SKIN):
        device = Device(drive=drive(finger))
        one, other = evaluate(scan(device, scene, path)), evaluate(scan(device, other_way, back))
        assert one.counts == other.counts
        assert [e.stroke for e in one.false_lines] == pytest.approx(
            [e.stroke for e in other.false_lines]
        )
        for a, b in zip(one.lines, other.lines, strict=True):
            assert numbers(a) == pytest.approx(numbers(b), rel=1e-9, abs=1e-12, nan_ok=True)


# ---- fates ---------------------------------------------------------------------------------------


def fates(evaluation: Evaluation) -> list[str]:
    return [line.fate for line in evaluation.lines]


def test_lines_between_two_samples_are_missed() -> None:
    scene = grating(0.0008, 0.008)
    control = ControlBlock(sample_rate=40.0)
    evaluation = evaluate(scan(Device(drive=drive(), control=control), scene, evenly(scene, 0.06)))
    assert fates(evaluation)[2:] == ["shown", "shown"]
    assert "unseen" in fates(evaluation)[:2]
    unseen = next(line for line in evaluation.lines if line.fate == "unseen")
    assert isnan(unseen.begin.command) and isnan(unseen.begin.latency) and isnan(unseen.smear)


def test_gap_between_two_samples_merges_lines() -> None:
    row = np.ones(800)
    row[200:290] = row[293:400] = 0.0
    scene = Scene(np.tile(row, (20, 1)), 1e-4, lines=(0.001,))
    control = ControlBlock(sample_rate=40.0)
    evaluation = evaluate(scan(Device(drive=drive(), control=control), scene, evenly(scene, 0.06)))
    assert fates(evaluation) == ["shown", "merged"]
    first, second = evaluation.lines
    assert isnan(first.end.command) and not isnan(first.begin.response)
    assert isnan(second.begin.command) and not isnan(second.end.response)


def test_a_pin_that_is_not_let_go_merges_lines() -> None:
    scene = grating(0.002, 0.016)
    slow = Electromagnet.from_times(fall_time=0.05)
    evaluation = evaluate(scan(Device(drive=drive(), magnet=slow), scene, evenly(scene, 0.09)))
    assert fates(evaluation) == ["shown", "merged", "shown", "shown"]
    assert isnan(evaluation.lines[0].end.response)
    assert evaluation.counts["lines.merged"] == 1


def test_pins_that_no_magnet_moves_show_faint_lines_not_merged_ones() -> None:
    weak = Electromagnet.from_times(hold_force=0.001)
    scene = grating(0.004, count=4)
    evaluation = evaluate(scan(Device(drive=drive(SKIN), magnet=weak), scene, across(scene)))
    assert fates(evaluation) == ["faint"] * 4


def test_skin_that_hardly_gives_makes_lines_faint() -> None:
    stiff = Contact(0.005, 0.0075, stiffness=2000.0)
    scene = grating(0.006)
    evaluation = evaluate(scan(Device(drive=drive(stiff)), scene, across(scene)))
    assert fates(evaluation) == ["faint", "faint"]
    assert evaluation.lines[0].end.skin == pytest.approx((0.0075 + 0.005) / 2000.0, rel=1e-9)
    assert isnan(evaluation.spread("line.stroke")[1])
    felt = evaluate(evaluation.scan, Criteria(felt=5e-6, direction=6e-6))
    assert fates(felt) == ["shown", "shown"]
    assert felt.counts["lines.direction"] == sum(line.begin.skin >= 6e-6 for line in felt.lines)


def test_cues_rise_with_what_the_skin_does() -> None:
    """The displacement is the stick limit over the stiffness, in both directions."""
    scene = grating(0.012)
    for friction, cue in ((0.0044, "none"), (0.0048, "felt"), (0.012, "direction"), (0.03, "sure")):
        finger = Contact(friction, 1.5 * friction, stiffness=250.0)
        evaluation = evaluate(scan(Device(drive=drive(finger)), scene, across(scene)))
        assert [line.end.cue for line in evaluation.lines] == [cue] * 2
        assert evaluation.lines[0].end.skin == pytest.approx(2.5 * friction / 250.0, rel=1e-9)
    slow = Criteria(direction_speed=1.0)
    assert [line.end.cue for line in evaluate(evaluation.scan, slow).lines] == ["direction"] * 2


def test_rebounds_are_false_lines_unless_damped() -> None:
    scene = grating(0.006, count=1, margin=0.03)
    for damping, some in ((0.05, True), (1.8, False)):
        evaluation = evaluate(
            scan(Device(drive=drive(damping=damping)), scene, evenly(scene, 0.06))
        )
        assert fates(evaluation) == ["shown"]
        assert bool(evaluation.false_lines) == some
        for line in evaluation.false_lines:
            assert line.stroke >= 0.5 * evaluation.lines[0].stroke
            assert line.time > evaluation.lines[0].release
            assert float(evaluation.scan.pins[0].velocity(line.time)) == pytest.approx(
                0.0, abs=1e-9
            )
    ringing = evaluate(evaluation.scan, Criteria(false_line=1e-3))
    assert len(ringing.false_lines) >= len(evaluation.false_lines)


def test_a_ripple_on_a_line_is_not_its_height() -> None:
    """A pin that breaks loose at its reach ripples there; a rebound is held against the line."""
    weight = 0.001 * 9.80665
    body = Drive(
        mass=0.001,
        stiffness=150.0,
        damping_ratio=0.5,
        plate=Contact(0.225 * weight, 0.27 * weight),
        finger=Contact(0.030, 0.045, stiffness=300.0),
    )
    device = Device(drive=body, magnet=Electromagnet.from_times(hold_force=1.0))
    scene = grating(0.006, 0.012)
    evaluation = evaluate(scan(device, scene, across(scene)))
    assert fates(evaluation) == ["shown"] * 4
    assert evaluation.false_lines == ()
    swings = evaluate(evaluation.scan, Criteria(false_line=0.03)).false_lines
    assert len(swings) == 4, "one rebound each, a twentieth as high as its line"
    for line in swings:
        assert 0.03 < line.stroke / evaluation.lines[0].stroke < 0.05


def test_a_swing_that_the_skin_hardly_follows_is_no_false_line() -> None:
    """Lines are evaluated by the skin, and so are swings that look like them."""
    scene = grating(0.006, count=1, margin=0.03)
    ringing = [
        evaluate(scan(Device(drive=drive(finger, damping=0.05)), scene, evenly(scene, 0.06)))
        for finger in (RIGID, Contact(0.005, 0.0075, stiffness=2000.0))
    ]
    assert ringing[0].false_lines
    assert fates(ringing[1]) == ["faint"]
    assert ringing[1].false_lines == ()


def test_overdamped_pins_do_not_swing_over() -> None:
    scene = grating(0.006, count=1, margin=0.05)
    evaluation = evaluate(scan(Device(drive=drive(damping=4.0)), scene, evenly(scene, 0.05)))
    (line,) = evaluation.lines
    assert line.overshoot == 0.0
    assert 0.05 < line.settled - line.release < 0.5


def test_counts_add_up_over_an_array() -> None:
    scene = grating(0.001, 0.002, 0.004, count=3)
    array = PinArray.grid(2, 2, 0.002)
    evaluation = evaluate(
        scan(Device(drive=drive(SKIN), array=array), scene, across(scene, 0.15, 0.004))
    )
    counts = evaluation.counts
    assert counts["lines.crossed"] == 36 == len(evaluation.lines)
    parts = ("shown", "unseen", "merged", "faint")
    assert sum(counts[f"lines.{fate}"] for fate in parts) == 36
    assert counts["lines.sure"] <= counts["lines.direction"] <= counts["lines.shown"]
    least, median, largest = evaluation.spread("line.lag_on")
    assert 0.0 < least <= median <= largest


def test_a_blank_page_has_false_lines_only_where_the_pin_moves() -> None:
    page = Scene(np.ones((20, 800)), 1e-4, lines=(0.001,))
    held = drive(Contact(0.020, 0.030))
    for pin, path, false in (
        (held, across(page), 0),  # the finger holds it
        (drive(), evenly(page), 1),  # the plate drags it 0.27 mm as the hand starts at once
    ):
        evaluation = evaluate(scan(Device(drive=pin), page, path))
        assert evaluation.lines == ()
        assert len(evaluation.false_lines) == false
        assert all(line.stroke >= 2e-4 for line in evaluation.false_lines)


@pytest.mark.parametrize("first", range(0, 60, 12))
def test_random_devices_are_checked_by_feasibility(first: int) -> None:
    """Over decades of every number: nothing comes before its cause, every part is a part."""
    for seed in range(first, first + 12):
        drawn = RandomScan.of(seed)
        evaluation = evaluate(scan(drawn.device, drawn.scene, drawn.path))
        latency = drawn.device.control.latency
        for line in evaluation.lines:
            found = {name: value for name, value in line.numbers.items() if not isnan(value)}
            for name, value in found.items():
                assert value >= (latency if "latency" in name else 0.0) - 1e-12, (seed, name)
            assert found.get("line.contrast", 1.0) <= 1.0
            assert (line.fate == "unseen") <= isnan(line.begin.command)
            if line.fate == "shown":
                assert line.begin.command <= line.begin.response
                assert (
                    max(line.begin.skin, found.get("line.skin_off", 0.0))
                    >= evaluation.criteria.felt
                )
        assert sum(evaluation.counts[f"lines.{fate}"] for fate in FATES) == len(evaluation.lines)
        for swing in evaluation.false_lines:
            pin = evaluation.scan.pins[swing.pin]
            assert swing.stroke >= evaluation.criteria.direction
            assert not pin.commands.on(swing.time)


def test_criteria_are_checked() -> None:
    with pytest.raises(
        ValueError, match="felt must be finite and at least 1e-9 m and at most 1 m, got"
    ):
        Criteria(felt=0.0)
    with pytest.raises(
        ValueError, match="false_line must be finite and at least 1e-6 and at most 1"
    ):
        Criteria(false_line=1.5)

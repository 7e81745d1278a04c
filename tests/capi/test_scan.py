"""A device in C, under a hand that is given as it moves: the bits of `scan`, wherever it is cut."""

from __future__ import annotations

import ctypes
import sys
from ctypes import byref, c_double, c_size_t, c_void_p
from math import inf, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from c_interface import QUANTITIES, Event, Interface, doubles
from pindrive import Contact, Drive, Profile
from pindrive.device import (
    ControlBlock,
    Criteria,
    Device,
    Electromagnet,
    HandPath,
    PinArray,
    Scene,
    scan,
)
from pindrive.evaluation.line_crossings import CUES, FATES
from pindrive.evaluation.resolution import largest_speeds

pytestmark = [
    pytest.mark.timeout(1800),
    pytest.mark.skipif(
        sys.platform == "win32", reason="where the library lies is tested on the others"
    ),
]

TOUCH = 0.02
"""Touch force of the finger, N."""


class PinEvent(ctypes.Structure):
    """pindrive_pin_event."""

    _fields_ = (("pin", c_size_t), ("event", Event))


class Term(ctypes.Structure):
    """pindrive_term."""

    _fields_ = tuple((name, c_double) for name in ("cosine", "sine", "decay", "frequency"))

    @property
    def numbers(self) -> tuple[float, ...]:
        return self.cosine, self.sine, self.decay, self.frequency


class Piece(ctypes.Structure):
    """pindrive_piece."""

    _fields_ = (
        ("begin", c_double),
        ("polynomial", c_double * 6),
        ("terms", ctypes.POINTER(Term)),
        ("count", c_size_t),
    )

    @property
    def numbers(self) -> tuple[float, tuple[float, ...], tuple[tuple[float, ...], ...]]:
        """As Python has a piece of a load."""
        terms = tuple(term.numbers for term in self.terms[: self.count])
        return self.begin, tuple(self.polynomial[:2]), terms


class Reading:
    """A device with its page and its hand, in Python and in C."""

    def __init__(self, seed: int) -> None:
        random = np.random.default_rng(seed)
        skin = inf if seed % 2 else 400.0
        friction = 0.25 * random.uniform(0.8, 1.2)
        self.numbers = {
            "drive.mass": 0.010 * random.uniform(0.5, 1.5),
            "drive.stiffness": 100.0,
            "drive.damping": 0.3 * random.uniform(0, 1),
            "plate.coefficient": 0.2,
            "plate.static_coefficient": 0.25,
            "plate.preload": 0.01,
            "finger.coefficient": friction,
            "finger.static_coefficient": 1.4 * friction,
            "finger.touch_force": TOUCH,
            "plate.touch_share": (0.0, 0.5, 1.0)[seed % 3],
            "magnet.hold_force": random.uniform(0.8, 2.0),
            "magnet.rise_time": 0.002,
            "magnet.fall_time": 0.004,
            "magnet.saturation": random.uniform(0.5, 1.0),
            "magnet.residual": 0.02 * random.uniform(0, 1),
            "control.sample_rate": 1000.0,
            "control.latency": 0.003,
            "array.axis": 0.1 if seed % 3 == 2 else 0.0,
        }
        damping = 0.3 if seed % 4 == 2 else None
        if skin < inf:
            self.numbers["finger.stiffness"] = skin
        if damping:
            self.numbers["finger.damping"] = damping
        if damping or skin == inf:
            self.numbers |= {"finger.load_exponent": 0.7, "finger.reference_touch": 2 * TOUCH}
        n = self.numbers
        drive = Drive(
            mass=n["drive.mass"],
            stiffness=n["drive.stiffness"],
            damping=n["drive.damping"],
            plate=Contact(coefficient=0.2, static_coefficient=0.25),
            preload=0.01,
            finger=Contact(
                coefficient=friction,
                static_coefficient=n["finger.static_coefficient"],
                stiffness=skin,
                damping=damping,
            ),
            touch_force=TOUCH,
            touch_share=n["plate.touch_share"],
            load_exponent=n.get("finger.load_exponent", 1.0),
            reference_touch=n.get("finger.reference_touch"),
        )
        array = PinArray.grid(2, 2, 0.004, axis=n["array.axis"])
        magnet = Electromagnet.from_times(
            hold_force=n["magnet.hold_force"],
            rise_time=0.002,
            fall_time=0.004,
            saturation=n["magnet.saturation"],
            residual=n["magnet.residual"],
        )
        self.device = Device(
            drive=drive,
            magnet=magnet,
            control=ControlBlock(sample_rate=1000.0, latency=0.003),
            array=array,
        )
        self.scene = Scene.from_grating((0.004, 0.006), count=2, margin=0.006)
        count = 300
        times = 0.5 + np.cumsum(random.uniform(0.5e-3, 1.5e-3, count))
        vx = 0.1 + 0.05 * np.sin(np.arange(count) * 0.2)
        vy = 1e-3 * np.sin(np.arange(count) * 0.5) if seed % 5 == 4 else np.zeros(count)
        self.path = HandPath(times, vx, vy, (0.003, self.scene.lines[0]))
        self.loads = np.clip(1.0 + 0.5 * np.sin(2 * pi * (times - times[0]) / 0.2), 0.0, None)
        self.touch = Profile(times.tolist(), (TOUCH * self.loads).tolist())

    def scan(self) -> Any:
        return scan(self.device, self.scene, self.path, touch=self.touch)

    def loads_of_scan(self) -> list[float]:
        """Factors of the finger friction as a scan has them, to the bit."""
        return [force / TOUCH for force in self.touch.values]

    def in_c(self, c: Interface) -> tuple[c_void_p, c_void_p]:
        """The device in C, and its scan at the begin of the hand."""
        c.library.pindrive_device_new.restype = c_void_p
        device, begun = c_void_p(c.library.pindrive_device_new()), c_void_p()
        for key, value in self.numbers.items():
            c("device_set", device, key.encode(), c_double(value))
        spots = self.device.array.on_page(self.device.array.spots)
        c("device_set_pins", device, *map(doubles, spots.T.copy()), c_size_t(len(spots)))
        p, load = self.path, self.loads_of_scan()[0]
        first = (p.times[0], p.x[0], p.y[0], p.vx[0], p.vy[0], load)
        c("scan_new", device, *map(c_double, first), byref(begun))
        self.set_page(c, begun)
        return device, begun

    def set_page(self, c: Interface, begun: c_void_p) -> None:
        luminance, pixel, left, top = self.scene.raster
        shape = map(c_size_t, luminance.shape)
        c("scan_set_page", begun, doubles(luminance), *shape, *map(c_double, (pixel, left, top)))

    def rows(self) -> list[tuple[float, float, float, float]]:
        """Rows of the hand after the first."""
        p = self.path
        return list(zip(p.times, p.vx, p.vy, self.loads_of_scan(), strict=True))[1:]


def values(c: Interface, begun: c_void_p, quantity: int, pins: int) -> list[float]:
    found = np.empty(pins)
    c("scan_evaluate", begun, quantity, doubles(found))
    return found.tolist()


def copied(c: Interface, device: c_void_p, begun: c_void_p, reading: Reading) -> c_void_p:
    """The scan from its bytes; the one that wrote them is freed."""
    c.library.pindrive_scan_size.restype = c_size_t
    size = c.library.pindrive_scan_size(begun)
    kept, again = ctypes.create_string_buffer(size), c_void_p()
    c("scan_write", begun, kept, c_size_t(size))
    c("scan_read", device, kept, c_size_t(size), byref(again))
    c.free(scan=begun)
    reading.set_page(c, again)
    return again


@pytest.mark.parametrize("seed", range(6))
def test_a_live_hand_has_the_bits_of_a_scan(seed: int, c_library: Path) -> None:
    c, reading = Interface(c_library), Reading(seed)
    whole, random = reading.scan(), np.random.default_rng(seed)
    device, begun = reading.in_c(c)
    pins, begin = len(whole.pins), reading.path.begin
    events: list[list[tuple[Any, ...]]] = [[] for _ in range(pins)]
    buffer, count = (PinEvent * 16)(), c_size_t()
    until = begin
    for row in reading.rows():
        c("scan_move", begun, *map(c_double, row))
        if random.random() < 0.3:
            continue
        until = float(random.uniform(until, row[0]))
        c("scan_advance", begun, c_double(until), None, None)
        for name, scale in (("position", 1e-3), ("velocity", 0.1), ("stretch", 1e-3)):
            found = values(c, begun, QUANTITIES.index(name), pins)
            expected = [getattr(pin.motion, name)(until - begin) for pin in whole.pins]
            assert_allclose(found, expected, rtol=0.0, atol=1e-12 * scale)
        more = True
        while more:
            more = bool(c("scan_events", begun, buffer, c_size_t(16), byref(count)))
            for each in buffer[: count.value]:
                kinds = (each.event.plate, each.event.finger, each.event.stop)
                events[each.pin].append((each.event.time, *kinds))
        if random.random() < 0.1:
            begun = copied(c, device, begun, reading)
        pulls, commands = values(c, begun, 9, pins), values(c, begun, 12, pins)
        for pin in whole.pins:
            assert pulls[pin.number] == pytest.approx(pin_pull(pin, until), abs=1e-9)
            assert commands[pin.number] == pin.commands.on(until)
    for pin in whole.pins:
        core = pin.core.motion(pin.number)
        table = core.events(0.0, until - begin, 100_000)
        expected = [begin + time for time in np.asarray(table[0])]
        assert [time for time, *_ in events[pin.number]] == expected
        assert len(expected) > 4
    c.free(scan=begun, device=device)


def pin_pull(pin: Any, t: float) -> float:
    """Pull of the magnet from the factor of the plate friction, N."""
    load, since = pin.load, t - pin.begin
    factor = load if isinstance(load, float) else load(since)
    touch = pin.finger_load if isinstance(pin.finger_load, float) else pin.finger_load(since)
    touched = pin.drive.plate_touch * (touch - 1.0)
    return float((factor - 1.0) * pin.drive.normal_force - touched)


def test_where_it_is_cut_does_not_change_a_bit(c_library: Path) -> None:
    c, reading = Interface(c_library), Reading(4)
    ends = []
    for step in (inf, 1e-3, 0.37e-3):
        device, begun = reading.in_c(c)
        now, known = reading.path.begin, reading.path.begin
        for row in reading.rows():
            while now + step <= known:
                now += step
                c("scan_advance", begun, c_double(now), None, None)
            c("scan_move", begun, *map(c_double, row))
            known = row[0]
        c("scan_advance", begun, c_double(reading.path.end), None, None)
        ends.append([values(c, begun, quantity, 4) for quantity in (*range(9), 9, 10, 12, 13)])
        c.free(scan=begun, device=device)
    for other in ends[1:]:
        assert_array_equal(ends[0], other)
    assert np.ptp(ends[0][0]) > 0.0


class LineEdge(ctypes.Structure):
    """pindrive_line_edge."""

    _fields_ = (
        *((n, c_double) for n in ("time", "x", "y", "command", "response", "lag", "skin")),
        ("cue", ctypes.c_int),
    )


class Line(ctypes.Structure):
    """pindrive_line."""

    _fields_ = (
        ("pin", c_size_t),
        ("outcome", ctypes.c_int),
        ("begin", LineEdge),
        ("end", LineEdge),
        *(
            (n, c_double)
            for n in (
                *("stroke", "height", "returned", "release", "settled", "smear"),
                *("overshoot", "contrast"),
            )
        ),
    )


class SpeedLimit(ctypes.Structure):
    """pindrive_speed_limit."""

    _fields_ = (
        *((n, c_double) for n in ("distinct_from", "distinct_to", "settled_to")),
        ("bands", c_size_t),
    )


@pytest.mark.parametrize("seed", range(6))
def test_lines_are_those_of_evaluate(seed: int, c_library: Path) -> None:
    c, reading = Interface(c_library), Reading(seed)
    criteria = Criteria(felt=30e-6, direction=60e-6)
    device, unused = reading.in_c(c)
    for key, value in (("felt", 30e-6), ("direction", 60e-6)):
        c("device_set", device, f"criteria.{key}".encode(), c_double(value))
    p, load, begun = reading.path, reading.loads_of_scan()[0], c_void_p()
    first = (p.times[0], p.x[0], p.y[0], p.vx[0], p.vy[0], load)
    c("scan_new", device, *map(c_double, first), byref(begun))
    reading.set_page(c, begun)
    for row in reading.rows():
        c("scan_move", begun, *map(c_double, row))
    expected = reading.scan().evaluate(criteria)
    buffer, count = (Line * 3)(), c_size_t()
    assert c("scan_lines", begun, None, None, buffer, c_size_t(3), byref(count)) == 1
    assert count.value == len(expected.lines) + len(expected.false_lines)
    buffer = (Line * count.value)()
    assert c("scan_lines", begun, None, None, buffer, count, byref(count)) == 0
    printed, false = buffer[: len(expected.lines)], buffer[len(expected.lines) :]
    for found, swing in zip(false, expected.false_lines, strict=True):
        assert (found.pin, found.outcome) == (swing.pin, len(FATES))
        begin = found.begin
        assert (begin.time, begin.x, begin.y) == (swing.time, swing.x, swing.y)
        assert found.height == swing.stroke
        assert np.isnan([begin.lag, found.end.time, found.stroke, found.contrast]).all()
    for found, line in zip(printed, expected.lines, strict=True):
        assert (found.pin, FATES[found.outcome]) == (line.pin, line.fate)
        for edge, of in ((found.begin, line.begin), (found.end, line.end)):
            assert CUES[edge.cue] == of.cue
            for name in ("time", "x", "y", "command", "response", "lag", "skin"):
                assert_array_equal(getattr(edge, name), getattr(of, name), name)
        for name in ("stroke", "height", "returned", "release", "settled", "smear", "overshoot"):
            assert_array_equal(getattr(found, name), getattr(line, name), name)
    assert len(expected.shown) > 4
    for pin in reading.scan().pins:
        assert c("scan_load", begun, c_size_t(pin.number), None, None, c_size_t(0), byref(count))
        pieces, terms = (Piece * count.value)(), (Term * (2 * count.value))()
        assert not c("scan_load", begun, c_size_t(pin.number), pieces, terms, count, byref(count))
        assert [piece.numbers for piece in pieces] == pin.core.load(pin.number)
    c("scan_advance", begun, c_double(p.times[1]), None, None)
    lines = c.library.pindrive_scan_lines
    assert lines(begun, None, None, buffer, count, byref(count)) > 1
    assert b"not be advanced yet" in c.library.pindrive_last_error()
    c.free(scan=begun)
    c.free(scan=unused, device=device)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_speed_limit_is_that_of_largest_speeds(seed: int, c_library: Path) -> None:
    c, reading = Interface(c_library), Reading(seed)
    device, begun = reading.in_c(c)
    (expected,) = largest_speeds(reading.device, [0.003], slowest=0.02, fastest=0.5)
    found = SpeedLimit()
    numbers = map(c_double, (0.003, 0.0015, 0.02, 0.5))
    c("device_speed_limit", device, *numbers, None, None, byref(found))
    assert found.bands == len(expected.distinct)
    assert_array_equal(found.distinct_to, expected.speed)
    assert_array_equal(found.settled_to, expected.settled_speed)
    c.free(scan=begun, device=device)

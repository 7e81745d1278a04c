"""Largest speeds over two lines of a hand that gives way to the pins: scans of the whole device."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isnan
from typing import Final

import numpy as np

import pindrive
from pindrive.device.device import Criteria, Device
from pindrive.device.page import Scene
from pindrive.device.pin_scan import Progress
from pindrive.device.reading import Reading
from pindrive.device.scanning import scan
from pindrive.evaluation.page_speed import all_shown, largest, trials
from pindrive.evaluation.perception import evaluate
from pindrive.evaluation.resolution import FINE, Band, SpeedLimit, SpeedLimits, check_tried
from pindrive.quantities.table import check, default


def largest_hand_speeds(
    device: Device,
    reading: Reading,
    pitches: Sequence[float],
    *,
    touch: float | pindrive.Profile | None = None,
    slowest: float = default("speed.slowest"),
    fastest: float | None = None,
    criteria: Criteria | None = None,
    progress: Progress | None = None,
) -> SpeedLimits:
    """The largest intended speed at which two lines stay distinct, where the pins slow the hand.

    In each trial all pins of the device cross two lines, half as wide as their pitch. The lines are
    distinct if every pin shows both, each with a displacement of the skin that tells its direction,
    and none shows a false one.

    Args:
        device: Device with a hand.
        reading: Reading hand; its speed is varied.
        pitches: Distances between lines, m, greater than 0.
        touch: Touch of the finger; None: constant touch.
        slowest: Slowest hand tried, m/s, greater than 0.
        fastest: Fastest hand tried, m/s; None: 1 m/s.
        criteria: Criteria of a felt line; None: those of the literature.
        progress: Function called after each scan.

    Raises:
        ValueError: A value is out of range, or the path is not along the drive axis.
    """
    tried = check_tried(slowest, default("speed.fastest") if fastest is None else fastest)
    limits = criteria or Criteria()
    found: list[SpeedLimit] = []

    for i, given in enumerate(pitches):
        pitch = check("speed.pitch", given, label="pitch")

        def trial(speed: float, pitch: float = pitch) -> Mapping[str, int]:
            return _counts(device, reading, pitch, speed, touch, limits)

        def report(done: int, total: int, i: int = i) -> None:
            if progress:
                progress(i * total + done, len(pitches) * total)

        counts = trials(trial, tried, (_distinct,), report)
        found.append(
            SpeedLimit(
                pitch=pitch,
                width=0.5 * pitch,
                tried=tried,
                distinct=_band(tried, largest(counts, _distinct)),
                settled=(),
                beyond=None,
            )
        )
    return SpeedLimits(tuple(found), limits)


def two_lines_under_hand(
    device: Device,
    reading: Reading,
    pitch: float,
    speed: float,
    touch: float | pindrive.Profile | None,
    criteria: Criteria,
) -> bool:
    """Return True if two lines are distinct under a hand that gives way.

    Args:
        device: Device with a hand.
        reading: Reading hand.
        pitch: Distance between the lines, m.
        speed: Intended speed, m/s.
        touch: Touch of the finger; None: constant touch.
        criteria: Criteria of a felt line.
    """
    return _distinct(_counts(device, reading, pitch, speed, touch, criteria))


def _counts(
    device: Device,
    reading: Reading,
    pitch: float,
    speed: float,
    touch: float | pindrive.Profile | None,
    criteria: Criteria,
) -> Mapping[str, int]:
    """Return the counts of a scan in which all pins cross two lines."""
    scene = _two_lines(device, pitch)
    hand = replace(reading, hand_speed=speed).strokes(scene, device.array)
    done = scan(device, scene, hand, touch=touch, max_angle=reading.max_angle)
    return evaluate(done, criteria).counts


def _two_lines(device: Device, pitch: float) -> Scene:
    """Two lines with so much room beside them that every pin crosses both."""
    spots = device.array.on_page(device.array.spots)
    wide, high = np.ptp(spots, axis=0).tolist()
    room = wide + 2.0 * pitch + MARGIN
    height, pixel = high + MARGIN, pitch / FINE
    return Scene.from_grating([(pitch, 2)], height=height, pixel=pixel, margin=room)


MARGIN: Final = 12e-3
"""Room beside pins and lines, m: the hand becomes as fast as it means to, and lags at its end."""


def _distinct(counts: Mapping[str, int]) -> bool:
    """Return True if all lines are shown, each with a direction, and none is false."""
    return all_shown(counts) and counts["lines.direction"] == counts["lines.crossed"]


def _band(tried: Band, speed: float) -> tuple[Band, ...]:
    return () if isnan(speed) else ((tried[0], speed),)

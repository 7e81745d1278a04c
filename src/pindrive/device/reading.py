"""Reading of a page: its size, and the strokes or the recorded path over it."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from typing import Final

import numpy as np

from pindrive.device.gratings import LineGroup
from pindrive.device.hand import HandPath, lines
from pindrive.device.page import Scene
from pindrive.device.pin_array import PinArray
from pindrive.quantities import budgets
from pindrive.quantities.part import Number, OptionalNumber
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import checked, default

RUN_IN: Final = 0.005
"""White before and after the text of a line, beyond the array's width, m."""


@checked
class Reading:
    """Reading hand: lines, strokes and speeds.

    Args:
        hand_speed: Peak speed of a reading stroke, m/s, greater than 0.
        return_speed: Speed on the way back to the next line, m/s.
        pause: Rest after each stroke, s, at least 0.
        line_pitch: Distance between lines, m; None: twice the height of text or, of an image
            without lines, one stroke along its middle.
        text_height: Height of capital letters, m, greater than 0.
        pixel: Size of a pixel of the scene, m; None: that of the image, or 0.1 mm for text and
            lines.
        max_angle: Angle between motion and drive axis above which a warning is given, rad, from 0
            to a right angle.
        hand_acceleration: m/s²; more in a record is a jump of its speed.
        mouse_resolution: Resolution of a mouse whose recording is in counts, counts per m.
        smoothing_cutoff: Cut-off frequency of the smoothing of a raw recording, Hz.

    Raises:
        ValueError: A value is not a number or out of its range.
    """

    hand_speed: Number = default("hand_speed")
    return_speed: Number = default("return_speed")
    pause: Number = default("pause")
    line_pitch: OptionalNumber = default("line_pitch")
    text_height: Number = default("text_height")
    pixel: OptionalNumber = default("pixel")
    max_angle: Number = default("max_angle")
    hand_acceleration: Number = default("hand_acceleration")
    mouse_resolution: Number = default("mouse_resolution")
    smoothing_cutoff: Number = default("smoothing_cutoff")

    def text(self, text: str, array: PinArray, font: str | PathLike[str] | None = None) -> Scene:
        """A page of text on which the whole array finds room; errors as for `Scene.from_text`."""
        return Scene.from_text(
            text,
            height=self.text_height,
            pixel=self.pixel or default("text.pixel"),
            margin=self._margin(array),
            line_pitch=self.line_pitch,
            font=font,
        )

    def grating(self, pitches: Iterable[float | LineGroup], array: PinArray) -> Scene:
        """Groups of lines on which the array finds room; errors as for `Scene.from_grating`."""
        return Scene.from_grating(
            pitches,
            height=self.text_height,
            pixel=self.pixel or default("text.pixel"),
            margin=self._margin(array),
        )

    def image(self, file: str | PathLike[str]) -> Scene:
        """An image; errors as for `Scene.from_image`."""
        return Scene.from_image(file, self.pixel)

    def strokes(self, scene: Scene, array: PinArray) -> HandPath:
        """Line by line over a scene, as far as every spot stays on it.

        Along the scene's lines of text; of a scene without any along lines `line_pitch` apart from
        top to bottom or, where none is given, once along its middle.

        Raises:
            ValueError: The spots of the array find no room on the scene, or there are too many
                strokes or rows of the hand's speed.
        """
        left, right, top, bottom = scene.extent
        offsets = array.on_page(array.spots)
        (low_x, low_y), (high_x, high_y) = offsets.min(axis=0), offsets.max(axis=0)
        left, right, top, bottom = left - low_x, right - high_x, top - low_y, bottom - high_y
        if not (left < right and top <= bottom):
            room = f"{scene.title}, {_size(np.subtract(scene.extent[1::2], scene.extent[::2]))}"
            spots = _size(offsets.max(axis=0) - offsets.min(axis=0))
            raise ValueError(refusal("the spots of the array", f"smaller than {room}", spots))
        return lines(
            scene.lines or self._rows(float(top), float(bottom)),
            float(left),
            float(right),
            speed=self.hand_speed,
            return_speed=self.return_speed,
            pause=self.pause,
        )

    def _rows(self, top: float, bottom: float) -> list[float]:
        """Return the centred reading lines that fit between two heights."""
        middle = 0.5 * (top + bottom)
        if self.line_pitch is None:
            return [middle]
        between = (bottom - top) / self.line_pitch
        of = f"{1e3 * (bottom - top):g} mm of page, lines {1e3 * self.line_pitch:g} mm apart"
        budgets.STROKES.check(2.0 * between + 1.0, of)
        count = int(between)
        return [middle + (i - 0.5 * count) * self.line_pitch for i in range(count + 1)]

    def _margin(self, array: PinArray) -> float:
        """White around a scene, m: the array stands beside the text before and after each line."""
        offsets = array.on_page(array.spots)
        return RUN_IN + float((offsets.max(axis=0) - offsets.min(axis=0)).max())


def _size(extent: Iterable[float]) -> str:
    return " by ".join(f"{1e3 * length:g}" for length in extent) + " mm"

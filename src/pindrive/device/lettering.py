"""Text as pixels: set in a font by Pillow's FreeType, black on white."""

from __future__ import annotations

from functools import cache
from math import ceil
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.quantities import refusal
from pindrive.units import quoted

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_PIXELS: Final = 100_000_000
MEASURED: Final = 1000
"""Size at which the font's capitals are measured."""


@cache
def default_font() -> str:
    """DejaVu Sans, which comes with Matplotlib: Latin, Greek, Cyrillic and more."""
    from matplotlib import get_data_path

    return str(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf"))


def draw(
    text: str, height: float, pitch: float, margin: float, font: str | PathLike[str] | None = None
) -> tuple[NDArray[np.float64], list[float]]:
    """Text as luminance, and the middle of the capitals of each line from the top; in pixels.

    Args:
        text: one or more lines.
        height: of capital letters.
        pitch: from line to line.
        margin: white around it, at least.
        font: a file that FreeType reads; None: `default_font`.

    Raises:
        ValueError: nothing to show, a character that the font lacks, or no such font.
    """
    from PIL import Image, ImageDraw, ImageFont

    file = default_font() if font is None else fspath(font)
    lines = text.splitlines()
    if not text.strip():
        raise ValueError(refusal("text", "at least one character that is drawn", quoted(text)))
    try:
        measured = ImageFont.truetype(file, MEASURED)
    except OSError as error:
        raise ValueError(f"{file}: is no font that can be read: {error}") from None
    _check_known(text, file)
    capital = -measured.getbbox("H", anchor="ls")[1]
    _check_size(height, height)
    letters = ImageFont.truetype(file, MEASURED * height / capital)
    boxes = [letters.getbbox(line, anchor="ls") for line in lines]
    left = margin - min(box[0] for box in boxes)
    first = max(margin + height, *(-i * pitch - box[1] for i, box in enumerate(boxes)))
    last = first + (len(lines) - 1) * pitch
    width = ceil(left + max(box[2] for box in boxes) + margin) + 1
    depth = ceil(max(last + margin, *(first + i * pitch + box[3] for i, box in enumerate(boxes))))
    _check_size(width, depth)
    page = Image.new("L", (width, depth), 255)
    pen = ImageDraw.Draw(page)
    for i, line in enumerate(lines):
        pen.text((left, first + i * pitch), line, fill=0, font=letters, anchor="ls")
    middles = [first + i * pitch - 0.5 * height for i in range(len(lines))]
    values = np.asarray(page, np.float64) / 255.0
    ink = np.flatnonzero((values < 1.0).any(axis=0))
    if not ink.size:
        raise ValueError(refusal("text", "at least one character that is drawn", quoted(text)))
    border = np.ones((depth, round(margin)))
    return np.hstack([border, values[:, ink[0] : ink[-1] + 1], border]), middles


def _check_size(width: float, depth: float) -> None:
    """Refuse a page of too many pixels."""
    if not width * depth <= MOST_PIXELS:
        required = f"at most {MOST_PIXELS} pixels; take larger pixels or less text"
        raise ValueError(refusal("the page", required, f"{width:.6g} by {depth:.6g}"))


def _check_known(text: str, file: str) -> None:
    """Refuse characters that the font would show as empty boxes."""
    from matplotlib.ft2font import FT2Font

    face = FT2Font(file)
    lacking = [
        c for c in dict.fromkeys(text) if not c.isspace() and not face.get_char_index(ord(c))
    ]
    if lacking:
        shown = quoted("".join(lacking))
        raise ValueError(
            f"text: the font {Path(file).name} lacks {shown}; give another with --font"
        )

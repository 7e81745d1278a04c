"""Text as pixels: set in a font by Pillow's FreeType, black on white.

Letters of scripts that are written one after the other, from left to right, are set as they come.
Those that join, reorder or run from right to left (Arabic, Hebrew, Indic scripts), and combining
marks that no single character stands for, are shaped by Raqm, which Pillow has where FriBiDi is
installed; without it they are refused. Lines begin at the left in any script.
"""

from __future__ import annotations

from functools import cache
from math import ceil
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Final
from unicodedata import bidirectional, category, name, normalize

import numpy as np

from pindrive import budgets
from pindrive.quantities import refusal
from pindrive.units import quoted

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PIL import ImageFont

MEASURED: Final = 1000
"""Size at which the font's capitals are measured."""
SMALLEST: Final = 1.0
"""Height of capitals in pixels below which nothing can be set."""
PLAIN: Final = 0x0590
"""The first code point of Hebrew: Latin, Greek, Cyrillic and Armenian stand before it."""
PLAIN_SCRIPTS: Final = (
    *("LATIN", "GREEK", "CYRILLIC", "GEORGIAN", "CJK", "HIRAGANA", "KATAKANA", "HANGUL SYLLABLE"),
    *("FULLWIDTH", "HALFWIDTH KATAKANA", "SUPERSCRIPT", "SUBSCRIPT", "DOUBLE-STRUCK", "SCRIPT"),
    *("KELVIN", "OHM", "ANGSTROM", "TURNED"),
)
"""How the names of letters begin that stand after it and are set one after the other too."""


@cache
def default_font() -> str:
    """DejaVu Sans, which comes with Matplotlib: Latin, Greek, Cyrillic, Arabic, Hebrew and more."""
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

    Returns:
        Luminance that cannot be written to, and the middles.

    Raises:
        ValueError: nothing to show, too much of it, letters too small, a character that the font
            lacks or that takes shaping where there is none, or no such font.
    """
    from PIL import Image, ImageDraw, ImageFont

    file = default_font() if font is None else fspath(font)
    budgets.CHARACTERS.check(len(text))
    lines = normalize("NFC", text).splitlines()
    if not text.strip():
        raise ValueError(refusal("text", "at least one character that is drawn", quoted(text)))
    engine = _engine("".join(lines))
    try:
        measured = ImageFont.truetype(file, MEASURED, layout_engine=engine)
    except OSError as error:
        raise ValueError(f"{file}: is no font that can be read: {error}") from None
    _check_known("".join(lines), file)
    capital = -measured.getbbox("H", anchor="ls")[1]
    if not capital > 0:
        raise ValueError(f"{file}: its capital H has no height")
    if not height >= SMALLEST:
        required = f"at least {SMALLEST:g} pixel; take smaller pixels"
        raise ValueError(refusal("the height of the text", required, f"{height:.3g}"))
    _check_size(height, height)
    letters = ImageFont.truetype(file, MEASURED * height / capital, layout_engine=engine)
    boxes = [letters.getbbox(line, anchor="ls") for line in lines]
    left = margin - min(box[0] for box in boxes)
    first = max(margin + height, *(-i * pitch - box[1] for i, box in enumerate(boxes)))
    last = first + (len(lines) - 1) * pitch
    across = left + max(box[2] for box in boxes) + margin
    down = max(last + margin, *(first + i * pitch + box[3] for i, box in enumerate(boxes)))
    _check_size(across, down)
    width, depth = ceil(across) + 1, ceil(down)
    page = Image.new("L", (width, depth), 255)
    pen = ImageDraw.Draw(page)
    for i, line in enumerate(lines):
        pen.text((left, first + i * pitch), line, fill=0, font=letters, anchor="ls")
    middles = [first + i * pitch - 0.5 * height for i in range(len(lines))]
    drawn = np.asarray(page)
    ink = np.flatnonzero((drawn < 255).any(axis=0))
    if not ink.size:
        raise ValueError(refusal("text", "at least one character that is drawn", quoted(text)))
    drawn, border = drawn[:, ink[0] : ink[-1] + 1], round(margin)
    values = np.ones((depth, drawn.shape[1] + 2 * border))
    np.divide(drawn, 255.0, out=values[:, border : border + drawn.shape[1]])
    values.flags.writeable = False
    return values, middles


def _engine(text: str) -> ImageFont.Layout:
    """How text is laid out: letter by letter, alike on every machine, or shaped by Raqm.

    Raises:
        ValueError: it takes shaping, and this machine has none.
    """
    from PIL import ImageFont, features

    taking = next((c for c in text if _takes_shaping(c)), None)
    if taking is None:
        return ImageFont.Layout.BASIC
    if features.check("raqm") and features.check("fribidi"):
        return ImageFont.Layout.RAQM
    called = f"{quoted(taking)} (U+{ord(taking):04X} {name(taking, 'without a name')})"
    raise ValueError(
        f"text: {called} is of a script that must be shaped, for which the library FriBiDi is not "
        "installed; install it (libfribidi0, fribidi), or give a picture with --image"
    )


def _takes_shaping(character: str) -> bool:
    """Whether a character joins, moves or goes with others, or runs from right to left."""
    kind = category(character)
    if kind in ("Mn", "Mc", "Me", "Cf") or bidirectional(character) in ("R", "AL", "AN"):
        return True
    return (
        kind.startswith("L")
        and ord(character) >= PLAIN
        and not name(character, "").startswith(PLAIN_SCRIPTS)
    )


def _check_size(width: float, depth: float) -> None:
    """Refuse a page of too many pixels."""
    of = f"{width:.6g} by {depth:.6g}; take larger pixels or less text"
    budgets.PIXELS.check(width * depth, of)


def _check_known(text: str, file: str) -> None:
    """Refuse characters that the font would show as empty boxes."""
    from matplotlib.ft2font import FT2Font

    face = FT2Font(file)
    lacking = [
        c for c in dict.fromkeys(text) if not c.isspace() and not face.get_char_index(ord(c))
    ]
    if lacking:
        named = ", ".join(f"U+{ord(c):04X} {name(c, 'without a name')}" for c in lacking[:3])
        more = f" and {len(lacking) - 3} more" if len(lacking) > 3 else ""
        raise ValueError(
            f"text: the font {Path(file).name} lacks {quoted(''.join(lacking))} ({named}{more}); "
            "give another with --font"
        )

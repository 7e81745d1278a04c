"""The page: what is printed, dark on light, with a scale; images, lines, and text set in a font.

Page coordinates: x to the right, y down, in metres. The luminance is that of the image as stored
(gamma-encoded): 0 black, 1 white. Whatever an image leaves transparent is white.

Text is set by Pillow's FreeType. Letters of scripts that are written one after the other, from left
to right, are set as they come. Those that join, reorder or run from right to left (Arabic, Hebrew,
Indic scripts), and combining marks that no single character stands for, are shaped by Raqm, which
Pillow has where FriBiDi is installed; without it they are refused. Lines begin at the left in any
script.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from math import ceil
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Final
from unicodedata import bidirectional, category, name, normalize

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.device.gratings import LineGroup, line_group
from pindrive.lazy import Image, ImageDraw, ImageFont, ImageOps, features, ft2font, matplotlib
from pindrive.quantities import budgets
from pindrive.quantities.refusal import check_whole, quoted, refusal
from pindrive.quantities.table import check, default
from pindrive.quantities.value import concise, equal_by_value

LUMA: Final = (0.299, 0.587, 0.114)
"""Weights of red, green and blue (ITU-R BT.601-7)."""
STRIP: Final = 1 << 20
"""Pixels of a picture that are turned into luminance together."""
INCH: Final = 0.0254
AT_ONCE: Final = 1 << 18
"""Looks at the page that are taken together: more take memory and save no time."""
FINER: Final = 4.0
"""Samples of a scene per pixel of the path in the search for lines."""


@equal_by_value
@concise
@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A page. Made by `from_image`, `from_text`, `from_grating`, or from an array.

    Args:
        luminance: Luminance in [0, 1], shape (rows, columns), first row on top.
        pixel: Size of a pixel, m, greater than 0.
        origin: Place of its top left corner on the page, m.
        lines: Y of the middle of each line of text, m, where it has lines.
        title: Description of the scene.

    Raises:
        ValueError: The scene has no pixels, a luminance is outside of [0, 1], or a number is out of
            range.
    """

    luminance: NDArray[np.float64]
    pixel: float
    origin: tuple[float, float] = (0.0, 0.0)
    lines: tuple[float, ...] = ()
    title: str = field(default="a scene", kw_only=True)

    def __post_init__(self) -> None:
        """Validate, and keep an array that nobody writes to."""
        values = np.asarray(self.luminance, np.float64, order="C")
        if values.flags.writeable or values.base is not None:
            values = values.copy()  # the caller may write to it
        if values.ndim != 2 or values.size == 0:
            raise ValueError(refusal("luminance", "rows and columns of pixels", values.shape))
        if not (values.min() >= 0.0 and values.max() <= 1.0):
            wrong = values[~((values >= 0.0) & (values <= 1.0))][0]
            check("scene.luminance", wrong, label="luminance")
        values.flags.writeable = False
        x, y = self.origin
        object.__setattr__(self, "luminance", values)
        object.__setattr__(self, "pixel", check("pixel", self.pixel))
        object.__setattr__(self, "origin", (check("scene.origin", x), check("scene.origin", y)))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, top and bottom of the page, m."""
        (rows, columns), (x, y) = self.luminance.shape, self.origin
        return x, x + columns * self.pixel, y, y + rows * self.pixel

    @property
    def raster(self) -> tuple[NDArray[np.float64], float, float, float]:
        """Luminance, size of a pixel, left and top of the page, m, as the core takes them."""
        return self.luminance, self.pixel, *self.origin

    def contains(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Return True for places (m, any shape) on the page, including its border and rounding."""
        px, py = _places(x, y)
        return _core.on_page(self.raster, px.ravel(), py.ravel()).reshape(px.shape).view(np.bool_)

    def at(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Luminance at places (m, any shape), linear between the middles of pixels.

        In the outer half of the outermost pixels it is theirs; beyond the page it is that of blank
        paper, 1.
        """
        px, py = _places(x, y)
        return _core.luminance(self.raster, px.ravel(), py.ravel()).reshape(px.shape)

    def dark(self, threshold: float | str = default("threshold")) -> NDArray[np.bool_]:
        """Return True for pixels with information: darker than the threshold, in [0, 1]."""
        return self.luminance < check("threshold", threshold)

    # ---- where scenes come from ------------------------------------------------------------------

    @classmethod
    def from_image(cls, path: str | PathLike[str], pixel: float | str | None = None) -> Scene:
        """An image file of any kind that Pillow reads, turned as its EXIF data says.

        Args:
            path: The file; of one with several pictures the first.
            pixel: Size of a pixel, m; None: what the file says of its resolution.

        Raises:
            ValueError: The file cannot be read, or says nothing of its resolution.
        """
        file = fspath(path)
        try:
            with _opened(file) as image:
                _check_size(image.width, image.height, file)
                resolution = image.info.get("dpi")
                shown = ImageOps.exif_transpose(image)
                values = _luminance(shown, file)
                values.flags.writeable = False
        except Image.DecompressionBombError as error:
            raise ValueError(f"{file}: is too large: {error}") from None
        except OSError as error:
            reason = error.strerror or "it is not an image, or it is damaged"
            raise ValueError(f"{file}: cannot be read: {reason}") from None
        except (SyntaxError, EOFError, IndexError, OverflowError) as error:  # damaged PNG, GIF ...
            raise ValueError(f"{file}: cannot be read: {error}") from None
        if pixel is None:
            pixel = _pixel_of(resolution, file)
        return cls(values, check("pixel", pixel), title=file)

    @classmethod
    def from_text(
        cls,
        text: str,
        *,
        height: float | str = default("text_height"),
        pixel: float | str = default("text.pixel"),
        margin: float | str = default("margin"),
        line_pitch: float | str | None = None,
        font: str | PathLike[str] | None = None,
    ) -> Scene:
        """Text, black on white.

        Args:
            text: Text of one or more lines, separated by newlines.
            height: Height of capital letters, m.
            pixel: m.
            margin: White around it, m, at least; a tall accent may ask for more.
            line_pitch: Distance between lines, m; None: twice the height.
            font: A file FreeType reads; None: DejaVu Sans, which comes with Matplotlib.

        Raises:
            ValueError: The text is empty, the font lacks a character or cannot be read, or a number
                is out of range.
        """
        size, step = check("text_height", height), check("pixel", pixel)
        pitch = 2.0 * size if line_pitch is None else check("line_pitch", line_pitch)
        white = check("margin", margin)
        values, middles = draw(text, size / step, pitch / step, white / step, font)
        lines = tuple(middle * step for middle in middles)
        return cls(values, step, (0.0, 0.0), lines, title=in_words(text))

    @classmethod
    def from_grating(
        cls,
        pitches: Iterable[float | str | tuple[float, int]],
        *,
        count: int = 4,
        height: float | str = default("text_height"),
        pixel: float | str = default("text.pixel"),
        margin: float | str = default("margin"),
    ) -> Scene:
        """Groups of upright black lines, each half as wide as its pitch.

        Args:
            pitches: Distances between lines in each group, m, greater than 0; or pairs of a
                distance and a number of lines; or text as for `Page`.
            count: Lines in each group without a number of its own, at least 1.
            height: m.
            pixel: M; a border between pixels is as dark as the part of the pixel it covers.
            margin: White around the groups, m, and with the pitch between them.

        Raises:
            ValueError: No pitch is given, no line fits, or a number is out of range.
        """
        usual = check_whole(count, "count")
        groups = [
            LineGroup(group.pitch, usual) if isinstance(given, (int, float)) else group
            for given in pitches
            for group in [line_group(given, "pitch")]
        ]
        if not groups:
            raise ValueError(refusal("pitches", "at least one", "none"))
        size, white = check("pixel", pixel), check("margin", margin)
        begins, ends, x = [], [], white
        for pitch, number in groups:
            begins += [x + i * pitch for i in range(number)]
            ends += [x + (i + 0.5) * pitch for i in range(number)]
            x = ends[-1] + white
        across, down = x / size, (check("text_height", height) + 2.0 * white) / size
        _check_size(across, down)
        columns, rows = max(1, round(across)), max(1, round(down))
        covered = _covered(size * np.arange(columns + 1), begins, ends)
        row = 1.0 - np.clip(covered / size, 0.0, 1.0)
        page = np.ones((rows, columns))
        top = round(white / size)
        page[top : rows - top] = row
        page.flags.writeable = False
        return cls(page, size, lines=(0.5 * rows * size,), title=lines_in_words(groups))

    def printed(self, threshold: float | str = default("threshold")) -> tuple[float, float] | None:
        """Left and right end of what is darker than a threshold, m; None for a blank page."""
        columns = np.flatnonzero(self.dark(threshold).any(axis=0))
        if not len(columns):
            return None
        left = self.origin[0]
        return left + columns[0] * self.pixel, left + (columns[-1] + 1) * self.pixel


def lines_in_words(groups: Iterable[LineGroup]) -> str:
    """A grating for a title."""
    pitches = ", ".join(f"{1e3 * pitch:g}" for pitch, _ in groups)
    return f"lines every {pitches} mm"


def in_words(text: str) -> str:
    """A text for a title, its lines apart by slashes."""
    return f"text {quoted(' / '.join(text.splitlines()))}"


def _places(x: ArrayLike, y: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Coordinates of places as arrays of one shape."""
    px, py = np.broadcast_arrays(np.asarray(x, np.float64), np.asarray(y, np.float64))
    return np.ascontiguousarray(px), np.ascontiguousarray(py)


def _covered(
    borders: NDArray[Any], begins: Sequence[float], ends: Sequence[float]
) -> NDArray[np.float64]:
    """Return the length (m) of lines between each border and the next.

    Args:
        borders: m, shape (n + 1,), increasing.
        begins: Begins of the lines, m, increasing, none before the end of the previous line.
        ends: Ends of the lines, m.
    """
    edges = np.stack([begins, ends], axis=1)
    after = np.cumsum(edges[:, 1] - edges[:, 0])
    before = np.stack([np.append(0.0, after[:-1]), after], axis=1)
    return np.diff(np.interp(borders, edges.ravel(), before.ravel()))


def _opened(file: str) -> Image.Image:
    """An image file of which only the head is read; of its size we say ourselves what is wrong."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Image.DecompressionBombWarning)
        return Image.open(file)


def _check_size(across: float, down: float, where: str = "", less: str = "a smaller page") -> None:
    """Reject a page with too many pixels; the remedy is less of `less`."""
    of = f"{across:.6g} by {down:.6g}; take larger pixels or {less}"
    budgets.PIXELS.check(across * down, of, where=where)


def _luminance(image: Image.Image, file: str) -> NDArray[np.float64]:
    """The luminance of an image of any mode, on white."""
    if image.mode == "F" or image.mode.startswith("I"):
        values = np.asarray(image, np.float64)
        whole = 1.0 if image.mode == "F" else 65535.0
        low, high = float(values.min()), float(values.max())
        if not (low >= 0.0 and high <= whole):
            given = f"{low:g} to {high:g}"
            raise ValueError(
                refusal(f"grey of mode {image.mode}", f"in 0 to {whole:g}", given, file)
            )
        return values / whole
    if image.has_transparency_data:
        paper = Image.new("RGBA", image.size, "white")
        image = Image.alpha_composite(paper, image.convert("RGBA"))
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"), np.float64) / 255.0
    colours = np.asarray(image.convert("RGB"))
    grey = np.empty(colours.shape[:2])
    rows = max(1, STRIP // image.width)
    for top in range(0, image.height, rows):
        red, green, blue = np.moveaxis(colours[top : top + rows].astype(np.float64), 2, 0)
        strip = (LUMA[0] * red + LUMA[1] * green + LUMA[2] * blue) / 255.0
        grey[top : top + rows] = np.minimum(strip, 1.0)
    return grey


def _pixel_of(resolution: Any, file: str) -> float:
    """The size of a pixel from dots per inch, alike in both directions."""
    try:
        across, down = (float(dots) for dots in resolution)
    except (TypeError, ValueError):
        across = down = 0.0
    if not across > 1.0:
        raise ValueError(
            f'{file}: does not state its resolution; give scan.pixel, like pixel = "0.1 mm"'
        )
    if abs(across - down) > 0.01 * across:
        given = f"{across:g} by {down:g}"
        raise ValueError(refusal("dots per inch", "the same across and down", given, file))
    return INCH / across


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
"""Name prefixes of scripts whose letters are set in sequence."""


@cache
def default_font() -> str:
    """DejaVu Sans, which comes with Matplotlib: Latin, Greek, Cyrillic, Arabic, Hebrew and more."""
    found = find_spec("matplotlib")  # not imported: a page needs no more of it
    if found is None or found.origin is None:
        return str(matplotlib.get_data_path())  # says how Matplotlib is installed
    return str(Path(found.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans.ttf")


def draw(
    text: str, height: float, pitch: float, margin: float, font: str | PathLike[str] | None = None
) -> tuple[NDArray[np.float64], list[float]]:
    """Text as luminance, and the middle of the capitals of each line from the top; in pixels.

    Args:
        text: Text of one or more lines.
        height: Height of capital letters, m.
        pitch: Distance between lines, m.
        margin: White around it, at least.
        font: A file that FreeType reads; None: `default_font`.

    Returns:
        Luminance that cannot be written to, and the middles.

    Raises:
        ValueError: The text is empty or too large, its letters are too small, the font does not
            exist or lacks a character, or a script needs shaping that is not installed.
    """
    file = default_font() if font is None else fspath(font)
    budgets.CHARACTERS.check(len(text))
    lines = normalize("NFC", text).splitlines()
    if not text.strip():
        raise ValueError(refusal("text", "at least one character that is drawn", quoted(text)))
    engine = _engine("".join(lines))
    try:
        measured = ImageFont.truetype(file, MEASURED, layout_engine=engine)
    except OSError as error:
        raise ValueError(f"{file}: is not a font that can be read: {error}") from None
    drawn_text = "".join(lines)
    # DejaVu Sans has all of ASCII; the reader of other fonts takes long to import.
    if font is not None or not (drawn_text.isascii() and drawn_text.isprintable()):
        _check_known(drawn_text, file)
    capital = -measured.getbbox("H", anchor="ls")[1]
    if not capital > 0:
        raise ValueError(f"{file}: its capital H has no height")
    if not height >= SMALLEST:
        required = f"at least {SMALLEST:g} pixel; take smaller pixels"
        raise ValueError(refusal("the height of the text", required, f"{height:.3g}"))
    _check_size(height, height, less="less text")
    letters = ImageFont.truetype(file, MEASURED * height / capital, layout_engine=engine)
    boxes = [letters.getbbox(line, anchor="ls") for line in lines]
    left = margin - min(box[0] for box in boxes)
    first = max(margin + height, *(-i * pitch - box[1] for i, box in enumerate(boxes)))
    last = first + (len(lines) - 1) * pitch
    across = left + max(box[2] for box in boxes) + margin
    down = max(last + margin, *(first + i * pitch + box[3] for i, box in enumerate(boxes)))
    _check_size(across, down, less="less text")
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
    """Return the layout engine: letter by letter, equal on all machines, or Raqm.

    Raises:
        ValueError: The text needs shaping, which is not installed.
    """
    taking = next((c for c in text if _takes_shaping(c)), None)
    if taking is None:
        return ImageFont.Layout.BASIC
    if features.check("raqm") and features.check("fribidi"):
        return ImageFont.Layout.RAQM
    called = f"{quoted(taking)} (U+{ord(taking):04X} {name(taking, 'without a name')})"
    raise ValueError(
        f"text: {called} is of a script that must be shaped, for which the library FriBiDi is not "
        "installed; install it (libfribidi0, fribidi), or give a picture with `image`"
    )


def _takes_shaping(character: str) -> bool:
    """Return True for a character that joins, moves, combines, or runs from right to left."""
    kind = category(character)
    if kind in ("Mn", "Mc", "Me", "Cf") or bidirectional(character) in ("R", "AL", "AN"):
        return True
    return (
        kind.startswith("L")
        and ord(character) >= PLAIN
        and not name(character, "").startswith(PLAIN_SCRIPTS)
    )


def _check_known(text: str, file: str) -> None:
    """Refuse characters that the font would show as empty boxes."""
    face = ft2font.FT2Font(file)
    lacking = [
        c for c in dict.fromkeys(text) if not c.isspace() and not face.get_char_index(ord(c))
    ]
    if lacking:
        named = ", ".join(f"U+{ord(c):04X} {name(c, 'without a name')}" for c in lacking[:3])
        more = f" and {len(lacking) - 3} more" if len(lacking) > 3 else ""
        raise ValueError(
            f"text: the font {Path(file).name} lacks {quoted(''.join(lacking))} ({named}{more}); "
            "give another with `font`"
        )

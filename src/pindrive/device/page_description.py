"""Description of a page: content, size, and the hand's path over it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from pindrive.device.gratings import LineGroup, line_group
from pindrive.device.hand import HandPath
from pindrive.device.page import Scene, in_words, lines_in_words
from pindrive.device.pin_array import PinArray
from pindrive.device.reading import Reading
from pindrive.device.recording import read_csv
from pindrive.quantities.refusal import refusal
from pindrive.quantities.value import concise


def recorded(file: str | PathLike[str], reading: Reading, smooth: bool | None = None) -> HandPath:
    """A recorded path, with what a hand's reading says of recordings; errors as for `read_csv`."""
    return read_csv(
        file,
        acceleration=reading.hand_acceleration,
        resolution=reading.mouse_resolution,
        cutoff=reading.smoothing_cutoff,
        smooth=smooth,
    )


@concise
@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """Content of a page, `text`, `image` or `grating`, and the movement of the hand.

    Args:
        text: Text of one or more lines.
        image: A file that Pillow reads.
        grating: Groups of lines, each a pitch (m) of four lines, or text: "4 mm", "12 x 4 mm" for
            twelve lines, "4 mm over 60 mm" for as many as a length holds.
        font: A file for the text; None: DejaVu Sans.
        path: A CSV of the hand's path; None: strokes.
        smooth: True to smooth this path, False to use its places as they are; None: as its data
            require.

    Raises:
        ValueError: A pitch is not a number or out of its range.
    """

    text: str | None
    image: Path | None
    grating: tuple[LineGroup, ...] | None
    font: Path | None
    path: Path | None
    smooth: bool | None

    def __init__(
        self,
        *,
        text: str | None = None,
        image: str | PathLike[str] | None = None,
        grating: Iterable[float | str | tuple[float, int]] | None = None,
        font: str | PathLike[str] | None = None,
        path: str | PathLike[str] | None = None,
        smooth: bool | None = None,
    ) -> None:
        """Validate the pitches, and keep paths."""
        if grating is not None:
            found = [line_group(group, f"grating[{i}]") for i, group in enumerate(grating)]
            object.__setattr__(self, "grating", tuple(found))
        else:
            object.__setattr__(self, "grating", None)
        object.__setattr__(self, "text", text)
        object.__setattr__(self, "smooth", smooth)
        for name, file in (("image", image), ("font", font), ("path", path)):
            object.__setattr__(self, name, None if file is None else Path(file))

    def check(self, label: str, where: str = "") -> None:
        """Reject zero or several contents, and a font or a smoothing with nothing to act on.

        Args:
            label: Notation of a part in messages, such as "--{}".
            where: The place, said first.
        """
        parts = {"text": self.text, "image": self.image, "grating": self.grating}
        given = [label.format(name) for name, value in parts.items() if value is not None]
        place = f"{where}: " if where else ""
        if len(given) != 1:
            text, image, grating = (label.format(name) for name in parts)
            found = " and ".join(given) or "none of them"
            raise ValueError(
                f"{place}give exactly one of {text}, {image} and {grating}, got {found}"
            )
        if self.font and self.text is None:
            font, text = label.format("font"), label.format("text")
            raise ValueError(f"{place}{font} {self.font}: goes with {text} alone")
        if self.smooth is not None and self.path is None:
            smooth, path = label.format("smooth"), label.format("path")
            required = f"left out without a recorded {path}"
            raise ValueError(f"{place}{refusal(smooth, required, str(self.smooth))}")

    @property
    def files(self) -> dict[str, Path]:
        """The files it is made of, by the names of its parts."""
        parts = {"image": self.image, "font": self.font, "path": self.path}
        return {name: file for name, file in parts.items() if file is not None}

    @property
    def words(self) -> str:
        """Description of the page for a title."""
        if self.text is not None:
            shown = in_words(self.text)
        elif self.image is not None:
            shown = f"picture {self.image.name}"
        else:
            shown = lines_in_words(self.grating or ())
        return f"{shown} along {self.path.name}" if self.path else shown

    @property
    def options(self) -> str:
        """As `pindrive scan` takes it."""
        pitches = ", ".join(group.words for group in self.grating or ())
        text = None if self.text is None else self.text.replace("\n", "\\n")
        given = {"text": text, "grating": pitches or None} | self.files
        flags = {None: "", True: " --smooth", False: " --no-smooth"}
        return (
            " ".join(f'--{name} "{part}"' for name, part in given.items() if part is not None)
            + flags[self.smooth]
        )

    def scene(self, reading: Reading, array: PinArray) -> Scene:
        """Return the scene of the page in a fitting size; errors as for `Reading`."""
        if self.text is not None:
            return reading.text(self.text, array, self.font)
        if self.image is not None:
            return reading.image(self.image)
        if self.grating is None:
            raise ValueError(refusal("a page", "of text, an image or a grating", "none"))
        return reading.grating(self.grating, array)

    def hand(self, reading: Reading, scene: Scene, array: PinArray) -> HandPath:
        """Return the hand's path over the page; errors as for `Reading.strokes` and `read_csv`."""
        if self.path is None:
            return reading.strokes(scene, array)
        return recorded(self.path, reading, self.smooth)

"""What a hand reads and how it moves: text, a picture or lines; by strokes, or as was recorded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from pindrive.device.scene import in_words
from pindrive.quantities import refusal

if TYPE_CHECKING:
    from pathlib import Path

    from pindrive.device.array import PinArray
    from pindrive.device.hand import HandPath
    from pindrive.device.reading import Reading
    from pindrive.device.scene import Scene


@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """One of `text`, `image` and `grating`.

    Args:
        text: one or more lines.
        image: a file that Pillow reads.
        grating: from line to line in each of several groups, m.
        font: a file for the text; None: DejaVu Sans.
        path: a CSV of the hand's path; None: strokes.
    """

    text: str | None = None
    image: Path | None = None
    grating: tuple[float, ...] | None = None
    font: Path | None = None
    path: Path | None = None

    def check(self, label: str, where: str = "") -> None:
        """Refuse none or several of them, and a font without text.

        Args:
            label: how a part is called where it was given, like "--{}".
            where: the place, said first.
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

    @property
    def files(self) -> dict[str, Path]:
        """The files it is made of, by the names of its parts."""
        parts = {"image": self.image, "font": self.font, "path": self.path}
        return {name: file for name, file in parts.items() if file is not None}

    @property
    def words(self) -> str:
        """What it is, for a title."""
        if self.text is not None:
            shown = in_words(self.text)
        elif self.image is not None:
            shown = f"picture {self.image.name}"
        else:
            shown = f"lines every {', '.join(f'{1e3 * p:g}' for p in self.grating or ())} mm"
        return f"{shown} along {self.path.name}" if self.path else shown

    @property
    def options(self) -> str:
        """As `pindrive scan` takes it."""
        pitches = ", ".join(f"{1e3 * pitch:.12g} mm" for pitch in self.grating or ())
        text = None if self.text is None else self.text.replace("\n", "\\n")
        given = {"text": text, "grating": pitches or None} | self.files
        return " ".join(f'--{name} "{part}"' for name, part in given.items() if part is not None)

    def scene(self, reading: Reading, array: PinArray) -> Scene:
        """What is on it, in a fitting size; errors as for `Reading`'s text, image and grating."""
        if self.text is not None:
            return reading.text(self.text, array, self.font)
        if self.image is not None:
            return reading.image(self.image)
        if self.grating is None:
            raise ValueError(refusal("a page", "of text, an image or a grating", "none"))
        return reading.grating(self.grating, array)

    def hand(self, reading: Reading, scene: Scene, array: PinArray) -> HandPath:
        """How the hand moves over it; errors as for `Reading`'s strokes and record."""
        return reading.strokes(scene, array) if self.path is None else reading.record(self.path)

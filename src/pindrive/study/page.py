"""The table [page] of a study file: what is on the page, and how the hand moves over it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pindrive.device.reading import Page, Reading
from pindrive.files.schema import number
from pindrive.quantities.table import QUANTITIES, refusal
from pindrive.quantities.units import quoted

if TYPE_CHECKING:
    from pindrive.device.hand import HandPath
    from pindrive.device.page import Scene
    from pindrive.device.pin_array import PinArray

KEYS: Final = ("text", "image", "grating", "font", "path")
_KEPT: Final = 2
"""Scenes and recorded paths that are kept, of up to 320 MB each: a sweep comes back to the one
before."""


@dataclass(frozen=True, slots=True)
class StudyPage:
    """A page, and what its files held when the study was read."""

    page: Page
    checksums: tuple[tuple[str, str], ...]
    """SHA-256 of each file, by the name of its key."""

    @classmethod
    def of(cls, page: Page, place: str) -> StudyPage:
        """A page with what its files hold now.

        Args:
            page: the page.
            place: where it was written, for messages.

        Raises:
            ValueError: a file cannot be read.
        """
        files = page.files.items()
        return cls(page, tuple((k, _checksum(path, f"{place}: page.{k}")) for k, path in files))

    def identity(self) -> dict[str, Any]:
        """All that a scan takes from it."""
        parts = {"text": self.page.text, "grating": self.page.grating}
        return {name: part for name, part in parts.items() if part} | dict(self.checksums)

    def check(self) -> None:
        """Refuse files that are not there, or hold something else by now.

        Called before any part of a study is computed, perhaps on another machine.

        Raises:
            ValueError: so it is.
        """
        known = dict(self.checksums)
        for name, path in self.page.files.items():
            if _checksum(path, f"page.{name}") != known[name]:
                raise ValueError(f"page.{name}: {path} has changed since the study was read")

    def scene(self, reading: Reading, array: PinArray) -> Scene:
        """What is on the page; errors as for `Page`."""
        size = Reading(
            text_height=reading.text_height, pixel=reading.pixel, line_pitch=reading.line_pitch
        )
        return _scene(self, size, array)

    def hand(self, reading: Reading, scene: Scene, array: PinArray) -> HandPath:
        """How the hand moves over it; errors as for `Page`."""
        if self.page.path:
            hand = Reading(
                hand_acceleration=reading.hand_acceleration,
                mouse_resolution=reading.mouse_resolution,
                smoothing_cutoff=reading.smoothing_cutoff,
            )
            return _recorded(self, self.page.path, hand)
        return self.page.hand(reading, scene, array)


def read_page(table: Any, file: Path) -> Page:
    """The page that [page] describes; its files stand beside the study file.

    Raises:
        ValueError: a key is unknown or malformed, or there is not exactly one of text, image and
            grating.
    """
    if not isinstance(table, dict):
        raise ValueError(refusal("page", "a table, [page]", quoted(table), str(file)))
    for key in table:
        if key not in KEYS:
            raise ValueError(f"{file}: unknown key page.{key}; there are {', '.join(KEYS)}")
    parts: dict[str, Any] = {}
    for key, given in table.items():
        if key == "grating":
            parts[key] = _pitches(given, str(file))
        elif not isinstance(given, str):
            raise ValueError(refusal(f"page.{key}", "text in quotes", quoted(given), str(file)))
        else:
            parts[key] = given if key == "text" else file.parent / given
    page = Page(**parts)
    page.check("page.{}", str(file))
    return page


def _pitches(given: object, file: str) -> tuple[float, ...]:
    """The distances of a grating, SI."""
    if not isinstance(given, list) or not given:
        required = 'a list of distances, like ["4 mm", "2 mm"]'
        raise ValueError(refusal("page.grating", required, quoted(given), file))
    pitch = QUANTITIES["pitch"]
    return tuple(
        number(value, pitch, "4 mm", f"page.grating[{i}]", file) for i, value in enumerate(given)
    )


def _checksum(path: Path, label: str) -> str:
    try:
        return sha256(path.read_bytes()).hexdigest()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"{label}: {path} cannot be read: {reason}") from None


@lru_cache(maxsize=_KEPT)
def _scene(given: StudyPage, reading: Reading, array: PinArray) -> Scene:
    return given.page.scene(reading, array)


@lru_cache(maxsize=_KEPT)
def _recorded(given: StudyPage, path: Path, reading: Reading) -> HandPath:
    return reading.record(path)

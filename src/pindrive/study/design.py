"""Data of a study: device, axes, order of the points, and the scanned page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.gratings import LineGroup, line_group
from pindrive.device.hand import HandPath
from pindrive.device.page import Scene
from pindrive.device.page_description import Page, recorded
from pindrive.device.pin_array import PinArray
from pindrive.device.reading import Reading
from pindrive.quantities.refusal import quoted, refusal
from pindrive.study.distributions import (
    Distribution,
    Grid,
    Linked,
    Sample,
    as_distribution,
    with_links,
)

if TYPE_CHECKING:
    from pindrive.study.study import Study

Columns = dict[str, NDArray[np.float64]]

PAGE_KEYS: Final = ("text", "image", "grating", "font", "path")
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
            page: The page.
            place: Place of the page, for messages.

        Raises:
            ValueError: A file cannot be read.
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
            ValueError: A file is missing or has changed.
        """
        known = dict(self.checksums)
        for name, path in self.page.files.items():
            if _checksum(path, f"page.{name}") != known[name]:
                raise ValueError(f"page.{name}: {path} has changed since the study was read")

    def scene(self, reading: Reading, array: PinArray) -> Scene:
        """Return the scene on the page; errors as for `Page`."""
        size = Reading(
            text_height=reading.text_height, pixel=reading.pixel, line_pitch=reading.line_pitch
        )
        return _scene(self, size, array)

    def hand(self, reading: Reading, scene: Scene, array: PinArray) -> HandPath:
        """Return the path of the hand over the page; errors as for `Page`."""
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
        ValueError: A key is unknown or malformed, or there is not exactly one of text, image and
            grating.
    """
    if not isinstance(table, dict):
        raise ValueError(refusal("page", "a table, [page]", quoted(table), str(file)))
    for key in table:
        if key not in PAGE_KEYS:
            raise ValueError(f"{file}: unknown key page.{key}; there are {', '.join(PAGE_KEYS)}")
    parts: dict[str, Any] = {}
    for key, given in table.items():
        if key == "grating":
            parts[key] = _groups(given, str(file))
        elif not isinstance(given, str):
            raise ValueError(refusal(f"page.{key}", "text in quotes", quoted(given), str(file)))
        else:
            parts[key] = given if key == "text" else file.parent / given
    page = Page(**parts)
    page.check("page.{}", str(file))
    return page


def _groups(given: object, file: str) -> tuple[LineGroup, ...]:
    """The groups of lines of a grating."""
    if not isinstance(given, list) or not given:
        required = 'a list of distances, like ["4 mm", "2 mm"]'
        raise ValueError(refusal("page.grating", required, quoted(given), file))
    return tuple(
        line_group(value if isinstance(value, str) else repr(value), f"page.grating[{i}]", file)
        for i, value in enumerate(given)
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
    return recorded(path, reading)


CHUNK: Final = 1 << 16
"""Points of a chunk: half a second's work, 15 MB of numbers."""
SCANS: Final = 16
"""Scans of a chunk: from a quarter of a second's work with one pin to some seconds with sixteen."""
COUNTS: Final = ("array.columns", "array.rows")
"""Keys that are whole numbers."""


@dataclass(frozen=True, slots=True)
class Dimension:
    """Keys that change together: one grid axis, several in a zip, or all sampled ones."""

    name: str
    size: int
    axes: Mapping[str, Grid | Distribution]
    sample: Sample | None = None

    def at(self, index: NDArray[np.int64]) -> Columns:
        """The value of each key at these places."""
        if self.sample:
            parts = self.sample.parts(index)
            return {
                key: axis.ppf(part)
                for part, (key, axis) in zip(parts, self.axes.items(), strict=True)
                if isinstance(axis, Distribution)
            }
        return {
            key: axis.at(index)
            for key, axis in self.axes.items()
            if not isinstance(axis, Distribution)
        }


@dataclass(frozen=True, slots=True)
class Ranges:
    """Varied keys of a study with their ranges."""

    scatter: Mapping[str, Distribution]
    fixed: Mapping[str, float]
    """Keys of a single value."""
    links: Mapping[str, Linked]

    def columns(self, study: Study, points: NDArray[np.float64]) -> Columns:
        """Values of all keys at points (keys of `scatter`, n)."""
        given = dict(zip(self.scatter, points, strict=True))
        given |= {k: np.full(points.shape[1], v) for k, v in self.fixed.items()}
        return with_links(study.device, given, self.links)


def ranges_of(study: Study, tolerances: bool) -> Ranges:
    """The ranges of the axes, or the tolerances; these too where there are no axes.

    Raises:
        ValueError: Nothing varies, or a count does, or there are no tolerances.
    """
    if tolerances and not study.tolerances:
        raise ValueError(f"{study.path}: has no tolerances; write them in [tolerances]")
    scatter: dict[str, Distribution] = {}
    fixed: dict[str, float] = {}
    of_axes = [k for k, axis in study.axes.items() if not isinstance(axis, Linked)]
    if study.tolerances and (tolerances or not of_axes):
        return Ranges(study.tolerances, {}, study.tolerance_links)
    for key, axis in study.axes.items():
        if isinstance(axis, Linked):
            continue
        low, high = axis.span
        if low < high and key in COUNTS:
            raise ValueError(
                f"{study.path}: axes.{key} counts pins, and there is nothing between two counts to "
                "draw; give one value"
            )
        if low < high:
            scatter[key] = as_distribution(axis)
        else:
            fixed[key] = low
    if not scatter:
        raise ValueError(f"{study.path}: nothing varies; write what in [axes] or [tolerances]")
    return Ranges(scatter, fixed, study.links)

"""Readings that were saved in the browser: a device, a page and the hand that read it."""

from __future__ import annotations

import json
import tomllib
import zlib
from base64 import b64decode
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np

from pindrive.device.hand import HandPath
from pindrive.device.page import Scene
from pindrive.files.device import DeviceFile, device_of
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal
from pindrive.quantities.value import concise, equal_by_value

FORMAT: Final = "pindrive reading 1"
LINK: Final = "#read="
"""Beginning of a reading in a link."""
TIMES: Final = 5000.0
"""Part of a second in which the times of a hand are kept."""
PLACES: Final = 1e6
"""Part of a metre, and of a metre per second, in which places and velocities are kept."""


@equal_by_value
@concise
@dataclass(frozen=True, kw_only=True)
class SavedReading:
    """Device, page and hand of a reading; `scan(saved.device, saved.page, saved.hand)` repeats it.

    Attributes:
        device: The device.
        page: The page.
        hand: Path of the hand, from rest.
    """

    device: DeviceFile
    page: Scene
    hand: HandPath


def load_reading(source: str | PathLike[str]) -> SavedReading:
    """Load a reading that the view "Read" of `pindrive studio` saved.

    Args:
        source: A file, or the link with the reading.

    Returns:
        The reading: `scan` of its parts gives the motion of the pins in the browser, to the bit.

    Raises:
        ValueError: The file cannot be read, or is no reading.
        ConfigError: The device is invalid, as for `load_device`.
    """
    text = str(source)
    if LINK in text:
        return _reading(_unpacked(text.partition(LINK)[2], "the link"), Path("<link>"))
    file = Path(source)
    try:
        given = json.loads(file.read_text("utf-8"))
    except OSError as error:
        raise ValueError(f"{file}: cannot be read: {error.strerror or error}") from None
    except ValueError:
        raise ValueError(f"{file}: is no reading, which is JSON") from None
    return _reading(given, file)


def _unpacked(packed: str, name: str) -> Any:
    """Return what a link holds."""
    try:
        data = b64decode(packed.translate(str.maketrans("-_", "+/")) + "=" * (-len(packed) % 4))
        return json.loads(_inflated(data))
    except ValueError:
        raise ValueError(f"{name}: holds no reading, or is cut off") from None


def _inflated(data: bytes) -> bytes:
    """Return bytes from raw deflate, up to the budget of a page."""
    inflater = zlib.decompressobj(-zlib.MAX_WBITS)
    try:
        found = inflater.decompress(data, int(budgets.PIXELS.most))
    except zlib.error as error:
        raise ValueError(str(error)) from None
    if not inflater.eof:
        raise ValueError("is cut off, or too large")
    return found


def _reading(given: Any, file: Path) -> SavedReading:
    if not isinstance(given, dict) or given.get("format") != FORMAT:
        found = given.get("format") if isinstance(given, dict) else type(given).__name__
        raise ValueError(refusal("format", repr(FORMAT), repr(found), str(file)))
    try:
        tables = tomllib.loads(given["device"])
        page, hand = _page(given["page"]), _hand(given["hand"])
    except (KeyError, TypeError, IndexError, ValueError) as error:
        said = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise ValueError(f"{file}: is no whole reading: {said}") from None
    return SavedReading(device=device_of(file, tables, whole=True), page=page, hand=hand)


def _page(given: dict[str, Any]) -> Scene:
    grey = np.frombuffer(_inflated(b64decode(given["luminance"])), np.uint8)
    luminance = grey.reshape(given["rows"], given["columns"]) / 255.0
    return Scene(luminance, given["pixel"], title=given["title"])


def _hand(given: dict[str, Any]) -> HandPath:
    rows = np.array([[0, 0, 0], *given["rows"]], np.float64)
    x, y = (place / PLACES for place in given["start"])
    times, vx, vy = rows.T
    return HandPath(times / TIMES, vx / PLACES, vy / PLACES, (x, y), about="a hand in the browser")

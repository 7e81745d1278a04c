"""Recorded hand paths: a CSV with a header that says what is what, and in which unit."""

from __future__ import annotations

import csv
import re
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pindrive.device.hand import through
from pindrive.quantities import check, refusal
from pindrive.units import UnitError, quoted, to_si

if TYPE_CHECKING:
    from pindrive.device.hand import HandPath

COLUMNS: Final = {"t": ("hand.time", "s"), "x": ("hand.place", "m"), "y": ("hand.place", "m")}
"""What a record holds, and the SI unit of it."""
EXAMPLE: Final = "t [s], x [mm], y [mm]"

_HEADING = re.compile(r"\s*(?P<name>[^\[(]*?)\s*[\[(](?P<unit>[^\])]*)[\])]\s*")


def read_csv(path: str | PathLike[str], *, acceleration: float = 30.0) -> HandPath:
    """A recorded path from a CSV whose header is like `t [s], x [mm], y [mm]`.

    Args:
        path: the file, UTF-8; columns apart by comma, semicolon or tab, in any order, others
            ignored; empty lines and lines that begin with # are skipped.
        acceleration: as for `through`.

    Raises:
        ValueError: the file cannot be read, the header lacks a column or a unit, a cell is no
            number; or as for `through`. The message names file and row, as an editor counts them.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{file}: is not UTF-8 text, at byte {error.start}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"{file}: cannot be read: {reason}") from None
    written = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not written:
        raise ValueError(f"{file}: is empty; a recorded path begins with {quoted(EXAMPLE)}")
    head = written[0][1]
    apart = max(",;\t", key=head.count)
    scales = _scales(next(csv.reader([head], delimiter=apart)), str(file))
    numbers: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for number, line in written[1:]:
        cells = next(csv.reader([line], delimiter=apart))
        for name, (index, scale) in scales.items():
            cell = cells[index].strip() if index < len(cells) else ""
            label, place = f"row {number}: {name}", str(file)
            try:
                value = float(cell) * scale
            except ValueError:
                raise ValueError(refusal(label, "a number", quoted(cell), place)) from None
            quantity, _ = COLUMNS[name]
            given = quoted(cell)
            numbers[name].append(check(quantity, value, where=place, label=label, given=given))
    if len(written) < 3:
        raise ValueError(refusal("a recorded path", "at least 2 rows", len(written) - 1, str(file)))
    return through(
        numbers["t"],
        numbers["x"],
        numbers["y"],
        acceleration=acceleration,
        where=str(file),
        rows=[number for number, _ in written[1:]],
    )


def _scales(headings: list[str], where: str) -> dict[str, tuple[int, float]]:
    """Which column holds what, and how many SI units one of its numbers is."""
    found: dict[str, tuple[int, float]] = {}
    for index, heading in enumerate(headings):
        match = _HEADING.fullmatch(heading)
        name = (match["name"] if match else heading).strip().lower()
        if name not in COLUMNS:
            continue
        _, unit = COLUMNS[name]
        usual = next(part for part in EXAMPLE.split(", ") if part.startswith(name))
        if name in found:
            raise ValueError(refusal(f"column {name}", "given once", "it twice", where))
        if match is None:
            required = f"given with its unit, like {quoted(usual)}"
            raise ValueError(refusal(f"column {name}", required, quoted(heading.strip()), where))
        try:
            found[name] = index, to_si(f"1 {match['unit']}", unit, f"1 {unit}")
        except UnitError:
            required = f"in {unit} or a unit alike, like {quoted(usual)}"
            raise ValueError(
                refusal(f"column {name}", required, quoted(heading.strip()), where)
            ) from None
    missing = [name for name in COLUMNS if name not in found]
    if missing:
        given = quoted(", ".join(heading.strip() for heading in headings))
        raise ValueError(refusal("the header", f"like {quoted(EXAMPLE)}", given, where))
    return found

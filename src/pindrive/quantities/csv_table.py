"""CSV files whose header names columns with their units: read as SI numbers, each checked."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from functools import cached_property
from math import nan
from os import PathLike
from pathlib import Path
from typing import Final

from pindrive.quantities import budgets
from pindrive.quantities.quantity import Quantity, heading
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.units import UnitError, expected, to_si

_HEADING: Final = re.compile(r"\s*(?P<name>[^\[(]*?)\s*[\[(](?P<unit>[^\])]*)[\])]\s*")


@dataclass(frozen=True)
class CsvTable:
    """A CSV file with a header; columns apart by comma, semicolon or tab, in any order.

    Empty lines and lines that begin with # are skipped.
    """

    file: str
    headings: tuple[str, ...]
    numbers: tuple[int, ...]
    """Line number of each row, as in an editor."""
    cells: tuple[tuple[str, ...], ...]
    """Cells of each row."""

    @classmethod
    def read(cls, path: str | PathLike[str], what: str, example: str) -> CsvTable:
        """The file at `path`, UTF-8.

        Args:
            path: The file.
            what: Expected content, for messages: "a recorded path".
            example: A header.

        Raises:
            ValueError: The file cannot be read, is empty, or has too many rows.
        """
        file = Path(path)
        try:
            text = file.read_text(encoding="utf-8-sig")
        except UnicodeDecodeError as error:
            raise ValueError(f"{file}: is not UTF-8 text, at byte {error.start}") from None
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise ValueError(f"{file}: cannot be read: {reason}") from None
        lines = [
            (number, line)
            for number, line in enumerate(text.splitlines(), 1)
            if line.strip() and not line.lstrip().startswith("#")
        ]
        if not lines:
            raise ValueError(f"{file}: is empty; {what} begins with {quoted(example)}")
        budgets.INPUT_ROWS.check(len(lines) - 1, where=str(file))
        head = lines[0][1]
        apart = max(",;\t", key=head.count)
        rows = tuple(tuple(row) for row in csv.reader([line for _, line in lines], delimiter=apart))
        if len(rows) != len(lines):
            raise ValueError(f"{file}: a quoted cell continues over several lines")
        headings = tuple(heading.strip() for heading in rows[0])
        return cls(str(file), headings, tuple(number for number, _ in lines[1:]), rows[1:])

    @cached_property
    def _columns(self) -> dict[str, list[tuple[int, str | None]]]:
        """The place and the unit of each column, by its name in small letters."""
        found: dict[str, list[tuple[int, str | None]]] = {}
        for index, text in enumerate(self.headings):
            match = _HEADING.fullmatch(text)
            name = (match["name"] if match else text).strip().lower()
            found.setdefault(name, []).append((index, match["unit"].strip() if match else None))
        return found

    def __contains__(self, name: str) -> bool:
        """Return True if a column has that name."""
        return name in self._columns

    def unit(self, name: str) -> str | None:
        """The unit in the heading of a column; None where it has none."""
        return self._columns[name][0][1]

    def check_header(self, holds: bool, required: str) -> None:
        """Reject a header without a required column."""
        if not holds:
            given = quoted(", ".join(self.headings))
            raise ValueError(refusal("the header", required, given, self.file))

    @property
    def names(self) -> tuple[str, ...]:
        """The columns, in small letters and without their units."""
        return tuple(self._columns)

    def text(self, name: str) -> list[str]:
        """The cells of a column, which must be there, as they are written."""
        index, _ = self._columns[name][0]
        return [row[index].strip() if index < len(row) else "" for row in self.cells]

    def check_rows(self, what: str, least: int) -> None:
        """Refuse fewer rows than `least`."""
        if len(self.cells) < least:
            required = f"at least {least} row{'s' if least > 1 else ''}"
            raise ValueError(refusal(what, required, len(self.cells), self.file))

    def column(
        self, name: str, quantity: Quantity, scale: float | None = None, *, missing: bool = False
    ) -> list[float]:
        """The numbers of a column, SI.

        Args:
            name: Name of an existing column, in small letters.
            quantity: Quantity with unit and bounds.
            scale: SI units of one of the column's numbers; None: by its heading.
            missing: True if a cell may be empty, or "nan", which is NaN.

        Raises:
            ValueError: The column is there twice, or has no unit or another one; or a cell is no
                number or out of bounds. The message names file and row.
        """
        if len(self._columns[name]) > 1:
            raise ValueError(refusal(f"column {name}", "given once", "it twice", self.file))
        index, written = self._columns[name][0]
        factor = self._scale(name, written, quantity.unit or "1") if scale is None else scale
        found = []
        for number, row in zip(self.numbers, self.cells, strict=True):
            cell = row[index].strip() if index < len(row) else ""
            label = f"row {number}: {name}"
            if missing and cell.lower() in ("", "nan"):
                found.append(nan)
                continue
            try:
                value = float(cell) * factor
            except ValueError:
                raise ValueError(refusal(label, "a number", quoted(cell), self.file)) from None
            if required := quantity.required(value):
                raise ValueError(refusal(label, required, quoted(cell), self.file))
            found.append(value)
        return found

    def _scale(self, name: str, written: str | None, unit: str) -> float:
        like, given = quoted(heading(name, unit)), quoted(self.headings[self._columns[name][0][0]])
        if written is None and unit != "1":
            required = f"given with its unit, like {like}"
            raise ValueError(refusal(f"column {name}", required, given, self.file))
        try:
            return to_si(f"1 {written or ''}", unit, f"1 {unit}")
        except UnitError:
            required = f"{expected(unit, written or '')}, like {like}"
            raise ValueError(refusal(f"column {name}", required, given, self.file)) from None

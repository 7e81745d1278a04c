"""Catalogues: parts that can be bought, with their values and prices, as a CSV."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.files.keys import NAMES, NUMERIC_KEYS
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.table import QUANTITIES
from pindrive.study.axes import sweepable

_EXAMPLE: Final = "part, drive.stiffness [N/m], price"


@dataclass(frozen=True, slots=True)
class Catalogue:
    """Parts of one kind, of which a design takes one, in the order of their first key's values.

    Attributes:
        name: Name of the kind of parts, such as "spring".
        path: The file that it was read from.
        parts: Numbers or names of the parts, shape (n,).
        values: Values of each key of the device that a part sets, SI, shape (n,).
        prices: Price of each part, shape (n,); NaN for a file without prices.
    """

    name: str
    path: Path
    parts: tuple[str, ...]
    values: dict[str, tuple[float, ...]]
    prices: tuple[float, ...]

    @property
    def priced(self) -> bool:
        """True if the catalogue has prices."""
        return not np.isnan(self.prices[0])

    def nearest(self, chosen: int, count: int) -> list[int]:
        """Return the parts in order of the ratio of their values to a given part."""
        table = np.array([*self.values.values()])
        scale = np.maximum(np.abs(table[:, [chosen]]), 1e-300)
        with np.errstate(divide="ignore"):
            ratios = np.log(np.maximum(np.abs(table) / scale, 1e-9))
        far: NDArray[np.float64] = np.sqrt((ratios**2).sum(axis=0))
        order = [int(i) for i in np.argsort(far, kind="stable") if i != chosen]
        return order[:count]


def read_catalogue(name: str, path: Path, place: str, scans: bool) -> Catalogue:
    """The catalogue in a CSV file.

    The columns are `part`, keys of a device file with their units, in full or by their last part
    where that is unique, and `price`, a plain number, where the parts have one.

    Args:
        name: Name of the kind of parts.
        path: The file.
        place: Place of the name, for messages.
        scans: True for designs that are scanned; each key must have a part in scans.

    Raises:
        ValueError: The file cannot be read, a column is missing or unknown, or a cell is malformed.
    """
    try:
        table = CsvTable.read(path, "a catalogue", _EXAMPLE)
    except ValueError as error:
        raise ValueError(f"{place}: {error}") from None
    keys: dict[str, str] = {}
    for column in table.names:
        if column not in ("part", "price"):
            key = sweepable(column, f"{path}: column {quoted(column)}", scans)
            if key in keys:
                raise ValueError(f"{path}: {key} is given twice, as {keys[key]} and {column}")
            keys[key] = column
    required = f"with part and a column for each key that a part sets, like {quoted(_EXAMPLE)}"
    table.check_header("part" in table and bool(keys), required)
    table.check_rows("the parts", 1)
    columns = {}
    for key, column in keys.items():
        columns[key] = table.column(column, NUMERIC_KEYS[key])
    prices = (
        table.column("price", QUANTITIES["design.price"], 1.0)
        if "price" in table
        else [nan] * len(table.cells)
    )
    parts = table.text("part")
    for number, part in zip(table.numbers, parts, strict=True):
        if not part or parts.count(part) > 1:
            required = "a number or a name that no other part has"
            raise ValueError(refusal(f"row {number}: part", required, quoted(part), str(path)))
    order: Any = np.argsort(next(iter(columns.values())), kind="stable")
    return Catalogue(
        name,
        path,
        tuple(parts[i] for i in order),
        {key: tuple(column[i] for i in order) for key, column in columns.items()},
        tuple(prices[i] for i in order),
    )


def short_keys(keys: tuple[str, ...]) -> str:
    """Keys as a person writes them, apart by commas."""
    tails = [key.partition(".")[2] for key in keys]
    return ", ".join(
        tail if len(NAMES.matches(tail)) == 1 else key
        for key, tail in zip(keys, tails, strict=True)
    )

"""Values of a device file that keep their ratio to others that are set (`Quantity.follows`)."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

from pindrive.files.schema import number
from pindrive.files.template import DRIVE, NUMBERS, usual
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import Rows
from pindrive.quantities.table import QUANTITIES

Tables = Mapping[str, Any]
"""The tables of a device file as TOML has them: text with units."""


def scaled_rows(rows: Rows | None, first: float) -> Rows | None:
    """The rows of a curve in the same shape, so that its first value is `first`."""
    if rows is None or rows[0][1] == first or not rows[0][1]:
        return rows
    return tuple((place, value / rows[0][1] * first) for place, value in rows)


def keep_ratios(tables: dict[str, Any], before: Tables, placed: Container[str]) -> None:
    """Change what follows the keys that were set, and was not set itself.

    Without a ratio (one of the values is left out, zero or malformed) a value stays as it is.

    Args:
        tables: of a device file, some of their values set anew; changed.
        before: the same before.
        placed: the keys that were set, in full.
    """
    moved = {key for key in DRIVE if key in placed}
    for key, quantity in DRIVE.items():
        table, _, name = key.partition(".")
        if key in moved or not moved.intersection(quantity.follows):
            continue
        moved.add(key)
        given = before[table].get(name)
        old, new = (_quotient(each, quantity.follows) for each in (before, tables))
        if given is None or not old or new is None:
            continue
        if isinstance(given, list):
            if rows := scaled_rows(_rows(before, key), new):
                tables[table][name] = _written_rows(key, rows)
        elif (value := _value(before, key)) is not None:
            tables[table][name] = written(key, value / old * new)


def written(key: str, value: float) -> str | float:
    """A value in SI as a device file has it, to the last bit."""
    unit = NUMBERS[key].unit
    return value if unit == "1" else f"{value!r} {unit}"


def _quotient(tables: Tables, keys: tuple[str, ...]) -> float | None:
    """The value of the first key, over that of the second if there is one."""
    values = [_value(tables, key) for key in keys]
    if not all(values[1:]) or values[0] is None:
        return None
    return values[0] / values[1] if len(values) > 1 and values[1] else values[0]


def _value(tables: Tables, key: str) -> float | None:
    """The value of a key, SI, or of what holds where it is left out; None where there is none."""
    table, _, name = key.partition(".")
    given, quantity = tables[table].get(name), DRIVE[key]
    if given is None:
        curve = _rows(tables, f"{table}.curve") if name == "kinetic" else None
        if curve:
            return curve[0][1]
        return _value(tables, quantity.follows[0]) if name == "static" else None
    try:
        return number(given, quantity, usual(quantity), key, "")
    except ValueError:  # said where the file is read
        return None


def _rows(tables: Tables, key: str) -> Rows | None:
    """The rows of a curve, SI; None where there are none, or malformed ones."""
    table, _, name = key.partition(".")
    quantity, given = DRIVE[key], tables[table].get(name)
    across = QUANTITIES[COLUMNS[quantity.rows_of][0]]
    try:
        return tuple(
            (number(x, across, "", key, ""), number(y, quantity, usual(quantity), key, ""))
            for x, y in given
        )
    except (TypeError, ValueError):
        return None


def _written_rows(key: str, rows: Rows) -> list[list[Any]]:
    across = QUANTITIES[COLUMNS[DRIVE[key].rows_of][0]]
    return [[f"{x!r} {across.unit}", written(key, y)] for x, y in rows]

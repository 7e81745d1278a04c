"""Values of a device file that keep their ratio to others that are set (`Quantity.follows`)."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import Any

from pindrive.files.schema import Value, read_value
from pindrive.files.template import DRIVE, NUMBERS
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
        given = _given(before, key)
        old, new = (_quotient(each, quantity.follows) for each in (before, tables))
        if given is None or not old or new is None:
            continue
        if isinstance(given, float):
            tables[table][name] = written(key, given / old * new)
        elif rows := scaled_rows(given, new):
            tables[table][name] = _written_rows(key, rows)


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
    found = _given(tables, key)
    if found is None and name not in tables[table]:
        curve = _given(tables, f"{table}.curve") if name == "kinetic" else None
        if isinstance(curve, tuple):
            return curve[0][1]
        return _value(tables, DRIVE[key].follows[0]) if name == "static" else None
    return found if isinstance(found, float) else None


def _given(tables: Tables, key: str) -> Value:
    """What a file gives for a key, SI; None where it gives nothing, or what is malformed."""
    table, _, name = key.partition(".")
    if name not in tables[table]:
        return None
    try:
        return read_value(tables[table][name], key, "")
    except ValueError:  # said where the file is read
        return None


def _written_rows(key: str, rows: Rows) -> list[list[Any]]:
    across = QUANTITIES[COLUMNS[DRIVE[key].rows_of][0]]
    return [[f"{x!r} {across.unit}", written(key, y)] for x, y in rows]

"""Inputs over time that stand in CSV files: rows of a profile, or a recording of the hand."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from pindrive.device.hand import RECORDED, HandPath
from pindrive.device.recording import read_csv
from pindrive.files.keys import FILE_KEYS, OVER_TIME, Tables, is_file, number
from pindrive.motion.profile import Profile
from pindrive.motion.release import CONTINUOUS
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.quantity import Quantity, Rows, counted
from pindrive.quantities.refusal import quoted
from pindrive.quantities.results import SERIES
from pindrive.quantities.rows import check_slopes, check_times
from pindrive.quantities.table import QUANTITIES, default, duration

_TIME: Final = QUANTITIES["profile.time"]
SPEED: Final = "motion.mouse_velocity"
"""The input that a recording of the hand may give."""


def with_files_read(
    tables: Tables, folder: Path, place: Callable[..., str]
) -> tuple[dict[str, Any], list[str]]:
    """Return the tables with the rows, SI, of each named CSV, and the errors of the CSV files.

    Args:
        tables: Tables of a device file, as TOML has them.
        folder: Folder of that file, to which paths are relative.
        place: Place of keys.
    """
    found, problems = dict(tables), []
    for key, file in files_named(tables, folder).items():
        table, _, name = key.partition(".")
        if found[table] is tables[table]:
            found[table] = dict(tables[table])
        try:
            found[table][name] = _rows(file, key, tables)
        except ValueError as error:
            problems.append(f"{place(key)}: {key}: {error}")
            found[table][name] = ((0.0, 0.0),)  # the rest of the file is read all the same
    return found, problems


def files_named(tables: Tables, folder: Path) -> dict[str, Path]:
    """The CSV that each key names instead of a value or rows, by the key."""
    found = {}
    for key in FILE_KEYS:
        table, _, name = key.partition(".")
        value = tables.get(table, {}).get(name)
        if is_file(key, value):
            found[key] = folder / value.strip()
    return found


def recording_words(tables: Tables, folder: Path) -> str:
    """Return the description of the recording of the mouse velocity; empty without one.

    The tables have been read without a problem.
    """
    file = files_named(tables, folder).get(SPEED)
    if file is None or FILE_KEYS[SPEED].name in CsvTable.read(file, "rows", ""):
        return ""
    return _path(file, tables).about


def profile_words(file: Path) -> str:
    """Return the description of the rows of a CSV; empty for a file without an input by name.

    Raises:
        ValueError: The file cannot be read, or its rows are malformed; file and row are named.
    """
    table = CsvTable.read(file, "a CSV", profile_header(FILE_KEYS[SPEED]))
    for key, quantity in FILE_KEYS.items():
        if quantity.rows_of in OVER_TIME and quantity.name in table:
            rows = _profile(table, key)
            lasts = duration(rows[-1][0] - rows[0][0])
            low, high = (quantity.text(end([y for _, y in rows])) for end in (min, max))
            return (
                f"{quantity.name}: {counted(len(rows), 'row')} over {lasts}, from {low} to {high}."
            )
    return ""


def profile_header(quantity: Quantity) -> str:
    """The header of a CSV with the rows of a quantity: "time [s], mouse_velocity [m/s]"."""
    return f"{SERIES['time'].heading}, {quantity.heading}"


def _rows(file: Path, key: str, tables: Tables) -> Rows:
    """The rows of a CSV that stands for a key, SI."""
    name = FILE_KEYS[key].name
    table = CsvTable.read(file, f"a CSV of {name}", profile_header(FILE_KEYS[key]))
    if name not in table and key == SPEED and ("x" in table or "dx" in table):
        velocity = _path(file, tables).plate_velocity(_given(tables, "array.axis"))
        assert isinstance(velocity, Profile)  # a recorded path has no bends
        return velocity.rows
    return _profile(table, key)


def _profile(table: CsvTable, key: str) -> Rows:
    """The rows of a CSV that gives a key over time, SI."""
    quantity = FILE_KEYS[key]
    name = quantity.name
    also = f", or {quoted(RECORDED)} of a recorded hand" if key == SPEED else ""
    required = f"like {quoted(profile_header(quantity))}{also}"
    table.check_header({"time", name} <= {*table.names}, required)
    times, values = table.column("time", _TIME), table.column(name, quantity)
    table.check_rows(f"a CSV of {name}", 1)
    why = " (a jump would take an infinite force)" if name in CONTINUOUS else ""
    check_times(
        times,
        where=table.file,
        label=lambda i: f"row {table.numbers[i]}: time",
        steps=not why,
        why=why,
    )
    rows = tuple(zip(times, values, strict=True))
    check_slopes(rows, QUANTITIES["profile.rate"], where=table.file, label=name)
    return rows


def _path(file: Path, tables: Tables) -> HandPath:
    """The path of a recorded hand, with what [scan] says of recordings."""
    return read_csv(
        file,
        acceleration=_given(tables, "scan.hand_acceleration"),
        resolution=_given(tables, "scan.mouse_resolution"),
        cutoff=_given(tables, "scan.smoothing_cutoff"),
    )


def _given(tables: Tables, key: str) -> float:
    """The value of a key, SI; the usual one where it is left out or malformed."""
    table, _, name = key.partition(".")
    quantity, value = FILE_KEYS[key], tables.get(table, {}).get(name)
    try:
        if value is not None:
            return number(value, quantity, quantity.usual, key, "")
    except ValueError:  # said where the tables are read
        pass
    return float(default(quantity.name))

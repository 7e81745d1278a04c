"""The values of a device file's tables: read in SI, what they describe, what does not fit together.

The table of quantities has the keys, their units, bounds and defaults.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass
from functools import cache
from math import inf
from typing import Any, Final

from pindrive.device.coil import BY_SHEET, COIL, COIL_NEEDS, SHEET, Coil, DataSheet
from pindrive.device.electromagnet import DIRECT, TIMES, Electromagnet
from pindrive.device.hand_mechanics import Hand
from pindrive.device.pin_array import PinArray
from pindrive.files.functions import is_function, read_function
from pindrive.files.keys import (
    DRIVE,
    FILE_KEYS,
    OVER_TIME,
    WHOLE,
    Given,
    Value,
    line,
    number,
    usual_rows,
)
from pindrive.motion.drive import Contact, Drive, law_name
from pindrive.motion.friction import PRESSING, normal_force
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import INPUTS, Release, input_of
from pindrive.quantities.drive import COLUMNS, SUPPORTS
from pindrive.quantities.quantity import Quantity, Rows
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.table import QUANTITIES

_GRID: Final = ("columns", "rows", "pitch")

Place = Callable[..., str]
"""Place of keys: the command line if it contains a key, otherwise the file."""


def read_given(
    tables: Mapping[str, Mapping[str, Any]], place: Place
) -> tuple[dict[str, Given], dict[str, str]]:
    """Return the value of each key in the tables, SI, and a line for each that is malformed.

    Args:
        tables: Tables of a device file, with the rows of the CSV files that it names.
        place: Place of keys.
    """
    given: dict[str, Given] = {}
    malformed = {}
    for key in FILE_KEYS:
        table, _, name = key.partition(".")
        if name in tables[table]:
            try:
                given[key] = read_value(tables[table][name], key, place(key))
            except ValueError as error:
                malformed[key] = error.args[0]
    return given, malformed


def complete(
    given: Mapping[str, Value],
    malformed: Mapping[str, str],
    names: Container[str],
    place: Place,
    meant: Container[str | None] = (),
) -> tuple[dict[str, Value], list[str]]:
    """Return the value of every key of some tables, and a line for each malformed or missing key.

    Args:
        given: Values that the file gives, SI.
        malformed: Line for each malformed value.
        names: Names of the tables.
        place: Place of keys.
        meant: Known keys that an unknown key of the file seems to stand for: not called missing.
    """
    values: dict[str, Value] = {}
    problems = []
    for key, quantity in FILE_KEYS.items():
        if key.partition(".")[0] not in names:
            continue
        if key in malformed:
            problems.append(malformed[key])
        elif key in given:
            values[key] = given[key]
        elif not quantity.mandatory or any(
            other in given or other in malformed for other in quantity.alternative
        ):
            values[key] = quantity.absent
        elif key not in meant and not any(other in meant for other in quantity.alternative):
            table = key.partition(".")[0]
            problems.append(f"{place(key)}: {key} is missing; write {line(quantity)} in [{table}]")
    return values, problems


def read_value(value: object, key: str, place: str) -> Given:
    """Return the TOML value of a key in SI: a number, rows, or a function of time.

    Raises:
        ValueError: The value is malformed or out of the bounds of the key.
    """
    quantity = FILE_KEYS[key]
    if quantity.rows_of in OVER_TIME and is_function(value):
        function = read_function(value, key, place)
        try:
            input_of(quantity.name, function)
        except ValueError as error:
            raise ValueError(f"{place}: {key.removesuffix(quantity.name)}{error}") from None
        return function
    if quantity.rows and (isinstance(value, list | tuple) or not quantity.may_be_constant):
        return _rows(value, quantity, key, place)
    return number(value, quantity, quantity.usual, key, place)


def _rows(value: object, quantity: Quantity, key: str, place: str) -> Rows:
    """Rows in SI, each checked and in order; a mistake is said with its row, counted from 0."""
    if isinstance(value, tuple):  # read from a file of their own, and checked there
        return value
    across, along = (QUANTITIES[name] for name in COLUMNS[quantity.rows_of])
    words = [column.name.rpartition(".")[2] for column in (across, along)]
    examples = across.written(quantity.rows[-1][0]), quantity.written(quantity.rows[-1][1])
    if not isinstance(value, list) or not value:
        raise ValueError(refusal(key, f"rows, like {usual_rows(quantity)}", quoted(value), place))
    rows = []
    for i, row in enumerate(value):
        if not isinstance(row, list) or len(row) != 2:
            required = f"a {words[0]} and a {words[1]}, like {', '.join(map(quoted, examples))}"
            raise ValueError(refusal(f"{key}[{i}]", required, quoted(row), place))
        rows.append(
            (
                number(row[0], across, examples[0], f"{key}[{i}] {words[0]}", place),
                number(row[1], quantity, examples[1], f"{key}[{i}] {words[1]}", place),
            )
        )
    return tuple(rows)


# ---- the drive and its motion --------------------------------------------------------------------


def table_of(values: Mapping[str, Value], table: str) -> dict[str, Any]:
    """The values of one table, by the names of its keys."""
    return {name: values[key] for key, name in _names_of(table) if key in values}


@cache
def _names_of(table: str) -> tuple[tuple[str, str], ...]:
    """The keys of one table, with their names in it."""
    return tuple((key, key.partition(".")[2]) for key in FILE_KEYS if key.startswith(f"{table}."))


def contact_of(values: Mapping[str, Value], table: str) -> Contact:
    """The contact that [plate] or [finger] describes, with its friction forces."""
    given = {
        name: value
        for name, value in table_of(values, table).items()
        if f"{table}.{name}" in QUANTITIES  # preload and touch are the drive's
    }
    stiffness, damping = given.pop("stiffness", None), given.pop("damping", None)
    given["law"] = law_name(given.get("law"))
    contact = Contact(**given, stiffness=inf if stiffness is None else stiffness, damping=damping)
    if contact.coefficient is None:
        return contact
    pressing: dict[str, Any] = {DRIVE[k].name: value for k, value in values.items() if k in DRIVE}
    return contact.pressed_by(normal_force(table, pressing.__getitem__))


def drive_of(values: Mapping[str, Value]) -> Drive:
    """The drive that a file's tables describe.

    Raises:
        ValueError: Each value is in range, but a derived value is not.
    """
    given = table_of(values, "drive")
    given |= {name: contact_of(values, name) for name in ("plate", "finger")}
    given |= {name: values[QUANTITIES[name].key] for name in PRESSING}
    return Drive(**given)


def release_of(values: Mapping[str, Value]) -> Release:
    """The initial state and the inputs that [motion] describes."""
    given = table_of(values, "motion")
    del given["duration"], given["settling_band"]
    for name in INPUTS:
        given[name] = over_time(given[name])
    return Release(**given | {"support": SUPPORTS[int(given["support"] or 0.0)]})


def over_time(value: Value) -> float | Profile | Function | None:
    """A constant, a function, or rows (time, value) as a profile."""
    return Profile(*zip(*value, strict=True)) if isinstance(value, tuple) else value


# ---- the whole device ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Whole:
    """The values of the tables of the whole device, each in range."""

    values: Mapping[str, Value]

    def magnet(self) -> Electromagnet:
        """The electromagnet: by how it is made where the file says so, else by what it does."""
        given = table_of(self.values, "magnet")
        voltage = given.pop("voltage")
        sheet: dict[str, Any] = {name: given.get(name) for name in SHEET}
        for name in BY_SHEET:
            given.pop(name)
        coil = {name: given.pop(name) for name in COIL}
        if sheet["resistance"] is not None:
            around = {name: value for name, value in given.items() if name not in DIRECT}
            return Electromagnet.from_coil(DataSheet(**sheet), **around, voltage=voltage)
        if all(coil[name] is None for name in COIL_NEEDS):
            return Electromagnet.from_times(**given)
        around = {name: value for name, value in given.items() if name not in DIRECT}
        return Electromagnet.from_coil(Coil(**coil), **around, voltage=voltage)

    def array(self) -> PinArray:
        """The pins: at given places, or a grid."""
        given = table_of(self.values, "array")
        grid, places = {name: given.pop(name) for name in _GRID}, given.pop("places")
        return PinArray.grid(**grid, **given) if places is None else PinArray.at(places, **given)

    def hand(self) -> Hand | None:
        """The hand that gives way to its pins; None: nothing can slow it."""
        given = table_of(self.values, "hand")
        return None if given["mass"] is None else Hand(**given)

    def in_si(self) -> dict[str, Value]:
        """The value of each key, given or not; None where nothing was given and nothing holds."""
        magnet, found = self.magnet(), {key: self.values[key] for key in WHOLE}
        found |= {f"magnet.{name}": getattr(magnet.coil, name, None) for name in COIL}
        if isinstance(magnet.coil, DataSheet):  # the rest is as it was given
            found |= {f"magnet.{name}": getattr(magnet, name) for name in TIMES}
        elif magnet.coil is not None:
            found |= {f"magnet.{name}": getattr(magnet, name) for name in DIRECT}
        if found["array.places"] is not None:
            found |= dict.fromkeys((f"array.{name}" for name in _GRID), None)
        return found

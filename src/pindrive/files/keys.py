"""The keys of device files: which one is meant, and the number that is written for one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any, cast

from pindrive.files.template import DRIVE, KEYS, NUMBERS, TABLES
from pindrive.motion.friction import COEFFICIENT_OF, PRESSED_BY
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import QUANTITIES, check
from pindrive.quantities.units import UnitError, quoted, to_si

Tables = Mapping[str, Any]
"""The tables of a device file as TOML has them: text with units."""


def keys_meant(given: str) -> list[str]:
    """The keys that may be meant by one in full, or by its last part."""
    return [key for key in KEYS if given in (key, key.partition(".")[2])]


def nearest(key: str, *, tables: bool = True) -> str | None:
    """The known table or key most like `key`; a known name in the wrong table finds its table."""
    names = {known.partition(".")[2]: known for known in reversed(KEYS)}  # the drive's first
    if tables and "." not in key:
        names |= {table: table for table in TABLES}
    table, _, name = key.rpartition(".")
    here = [known for known in names if f"{table}.{known}" in KEYS]
    near = (
        get_close_matches(key, KEYS, 1, cutoff=0.8)
        or get_close_matches(name, here, 1)
        or get_close_matches(name, names, 1, cutoff=0.7)
    )
    return names.get(near[0], near[0]) if near else None


def not_known(key: str, *, tables: bool = True) -> str:
    """What to say of an unknown key; without `tables` where only a key can stand."""
    if key == "plate.stiffness":
        return f"{key} cannot be given, the plate is rigid; skin gives way by finger.stiffness"
    near = nearest(key, tables=tables) if tables or key not in TABLES else None
    said = key if re.fullmatch(r"[\w.-]{1,60}", key) else quoted(key)
    if near:
        return f"unknown key {said}; did you mean {near}?"
    table = key.partition(".")[0]
    known = [known for known in KEYS if known.startswith(f"{table}.")] or (
        TABLES if tables else KEYS
    )
    return f"unknown key {said}; there are {', '.join(known)}"


def number(
    value: object, quantity: Quantity, example: str, label: str, place: str, *, si: bool = False
) -> float:
    """A value in SI: text with a unit, or a bare number where the quantity has no unit.

    With `si`, of what Python gave, a bare number is SI whatever the unit.
    """
    bare = isinstance(value, (int, float)) and not isinstance(value, bool)
    if bare and si:
        return check(quantity.name, float(cast(float, value)), where=place, label=label)
    text = value if isinstance(value, str) else repr(value) if bare else ""
    try:
        found = to_si(text, quantity.unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(value), place)) from None
    return check(quantity.name, found, where=place, label=label, given=quoted(value))


def written(key: str, value: float) -> str | float:
    """A value in SI as a device file has it, to the last bit."""
    unit = NUMBERS[key].unit
    return value if unit == "1" else f"{value!r} {unit}"


def has_part(key: str, scans: bool) -> bool:
    """Whether a key of the device file has a part in scans, or else in releases."""
    return not key.startswith("motion.") if scans else key in DRIVE


def variable(key: str) -> str:
    """What a key of the device file is called in Python and in a NetCDF file."""
    return NUMBERS[key].name.replace(".", "_")


def friction_parts(key: str) -> tuple[str, ...]:
    """The keys from which a friction force follows where a coefficient gives it; of others none."""
    if key not in COEFFICIENT_OF:
        return ()
    own, pressing = COEFFICIENT_OF[key], PRESSED_BY[key.partition(".")[0]]
    return (own, *DRIVE[own].follows, *(QUANTITIES[name].key for name in pressing))

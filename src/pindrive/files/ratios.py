"""Values of a device that are set otherwise, and the values that keep their ratio to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from pindrive.files.functions import with_parameters
from pindrive.files.keys import DRIVE, Given, friction_parts
from pindrive.motion.friction import COEFFICIENT_OF, COEFFICIENTS, OPTIONAL, friction_force
from pindrive.motion.function import Function
from pindrive.quantities.quantity import Rows
from pindrive.quantities.table import QUANTITIES

_DAMPING: Final = ("drive.damping", "drive.damping_ratio")

GivenValues = Mapping[str, Given]
"""Value of each key that a device file gives, SI."""


def with_set(given: GivenValues, changed: GivenValues) -> dict[str, Given]:
    """Return the values of a device file with some set otherwise.

    Damping replaces the damping ratio, and vice versa. A value that follows others
    (`Quantity.follows`) and is not set itself keeps its ratio to them. Without a ratio, as one of
    the values is missing or zero, it stays as it is.

    Args:
        given: Value of each key that the file gives, SI.
        changed: Value of each key that is set, SI; of a parameter of a function, too.

    Raises:
        ValueError: A parameter is set of an input that is no function with it.
    """
    changed = with_parameters(given, changed)
    replaced = {key for key in _DAMPING if key not in changed} if changed.keys() & _DAMPING else ()
    after = {key: value for key, value in given.items() if key not in replaced} | dict(changed)
    moved = {key for key in DRIVE if key in changed}
    for key, quantity in DRIVE.items():
        if key not in after and moved.intersection(friction_parts(key)):
            moved.add(key)
        if key in moved or not moved.intersection(quantity.follows):
            continue
        moved.add(key)
        value = given.get(key)
        old, new = (_quotient(each, quantity.follows) for each in (given, after))
        if value is None or not old or new is None:
            continue
        if not isinstance(value, Function):  # no input follows another value
            after[key] = value / old * new if isinstance(value, float) else scaled_rows(value, new)
    return after


def scaled_rows(rows: Rows, first: float) -> Rows:
    """Return the points of a curve in proportion, so that the first value is `first`."""
    if rows[0][1] == first or not rows[0][1]:
        return rows
    return tuple((place, value / rows[0][1] * first) for place, value in rows)


def _quotient(given: GivenValues, keys: tuple[str, ...]) -> float | None:
    """Return the value of the first key, over that of the second if there is one."""
    values = [_value(given, key) for key in keys]
    if not all(values[1:]) or values[0] is None:
        return None
    return values[0] / values[1] if len(values) > 1 and values[1] else values[0]


def _value(given: GivenValues, key: str) -> float | None:
    """Return the value of a key, or the value that holds for a missing key; None without one."""
    if key in given:
        found = given[key]
        return found if isinstance(found, float) else None
    table, _, name = key.partition(".")
    if key in COEFFICIENT_OF and f"{table}.{COEFFICIENTS['kinetic']}" in given:
        optional = {QUANTITIES[name].key for name in OPTIONAL[table]}
        if all(_value(given, p) is not None for p in friction_parts(key) if p not in optional):
            return float(friction_force(key, lambda n: _value(given, QUANTITIES[n].key)))
    curve = given.get(f"{table}.curve") if name == "kinetic" else None
    if isinstance(curve, tuple):
        return curve[0][1]
    static = ("static", COEFFICIENTS["static"])
    return _value(given, DRIVE[key].follows[0]) if name in static else DRIVE[key].absent

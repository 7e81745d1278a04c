"""Inputs of a device file that are functions of time: tables of parameters, and their sums."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any

from pindrive.files.keys import FILE_KEYS, PARAMETERS, Value, number, usual_function
from pindrive.motion.function import Function, InputPiece, InputTerm, of_parameters
from pindrive.quantities.functions import FUNCTIONS, FUNCTIONS_OF
from pindrive.quantities.names import Names
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.units import UnitError, to_si

if TYPE_CHECKING:
    from pindrive.motion.release import Release


def is_function(value: object) -> bool:
    """Return True if a TOML value is the table of a function, or a list of such tables."""
    tables = value if isinstance(value, list) and value else [value]
    return all(isinstance(table, dict) for table in tables)


def read_function(value: Any, key: str, place: str) -> Function:
    """Return the function that a table describes, or the sum of those of a list of tables.

    Args:
        value: Table or list of tables, as TOML has them.
        key: Key of the input: "motion.mouse_velocity".
        place: Place of the key, for messages.

    Raises:
        ValueError: A parameter is unknown, missing or out of range.
    """
    quantity = FILE_KEYS[key]
    if quantity.name not in FUNCTIONS_OF:
        raise ValueError(refusal(key, "a number, rows or a CSV", quoted(value), place))
    if isinstance(value, list):
        labels = [f"{key}[{i}]" for i in range(len(value))]
        parts = [_read(table, key, at, place) for table, at in zip(value, labels, strict=True)]
        return reduce(add, parts)
    return _read(value, key, key, place)


def _read(table: Mapping[str, Any], key: str, label: str, place: str) -> Function:
    """Return the function of one table."""
    if "pieces" in table:
        return _of_pieces(table, key, label, place)
    quantity = FILE_KEYS[key]
    kinds = {kind: {p.name: p for p in FUNCTIONS[kind]} for kind in FUNCTIONS_OF[quantity.name]}
    names = Names(f"parameter of {key}", {name: () for known in kinds.values() for name in known})
    for name in table:
        if not any(name in known for known in kinds.values()):
            raise ValueError(f"{place}: {names.unknown(name)}")
    fits = [kind for kind, known in kinds.items() if table.keys() <= known.keys()]
    if not table or not fits:
        usual = " or ".join(usual_function(quantity, kind) for kind in kinds)
        raise ValueError(refusal(label, f"a function, like {usual}", quoted(table), place))
    kind = fits[0]
    numbers: dict[str, float | str] = {}
    for name, parameter in kinds[kind].items():
        own = PARAMETERS[f"{key}.{name}"]
        if name in table:
            numbers[name] = number(table[name], own, own.usual, f"{label}.{name}", place)
        elif parameter.absent is not None:
            numbers[name] = parameter.absent
        else:
            example = f"{name} = {quoted(own.usual)}"
            raise ValueError(f"{place}: {label}.{name} is missing; write {example}")
    return of_parameters(kind, numbers)


def _of_pieces(table: Mapping[str, Any], key: str, label: str, place: str) -> Function:
    """Return the function of a table { pieces = […] }, whose coefficients are SI numbers."""
    example = '{ pieces = [{ begin = "0 s", polynomial = [0.06, 1.2], terms = [] }] }'
    try:
        if table.keys() != {"pieces"}:
            raise TypeError
        pieces = [
            InputPiece(
                to_si(piece["begin"], "s", "0 s"),
                tuple(map(float, piece.get("polynomial", ()))),
                tuple(InputTerm(*map(float, term)) for term in piece.get("terms", ())),
            )
            for piece in table["pieces"]
        ]
        if any(piece.keys() - {"begin", "polynomial", "terms"} for piece in table["pieces"]):
            raise TypeError
    except (TypeError, KeyError, AttributeError, UnitError):
        raise ValueError(refusal(label, f"like {example}", quoted(table), place)) from None
    try:
        return Function(pieces, FILE_KEYS[key].unit)
    except ValueError as error:
        raise ValueError(f"{place}: {label}.{error}") from None


def plain(value: Value) -> Any:
    """Return a value as JSON has it; a function by its parameters or its pieces."""
    return value.described if isinstance(value, Function) else value


def with_parameters(values: Mapping[str, Value], changed: Mapping[str, Any]) -> dict[str, Any]:
    """Return changed values in which inputs stand for the parameters of their functions.

    Args:
        values: Values of a device file by key, SI.
        changed: Values by key, SI; parameters of functions among them.

    Raises:
        ValueError: An input is no function with the parameter, or the value is out of range.
    """
    found = {key: value for key, value in changed.items() if key not in PARAMETERS}
    for key, value in changed.items():
        if key in PARAMETERS:
            owner, _, name = key.rpartition(".")
            function = found.get(owner, values.get(owner))
            found[owner] = _with_parameter(function, key).replace(**{name: value})
    return found


def check_parameter(release: Release, key: str, place: str) -> None:
    """Refuse the key of a parameter of a function that a release does not have.

    Raises:
        ValueError: The input is no function with the parameter.
    """
    if key in PARAMETERS:
        owner = key.rpartition(".")[0]
        try:
            _with_parameter(getattr(release, FILE_KEYS[owner].name), key)
        except ValueError as error:
            raise ValueError(f"{place}: {error}") from None


def _with_parameter(value: object, key: str) -> Function:
    """Return an input that is a function with the parameter of a key; refuse another."""
    owner, _, name = key.rpartition(".")
    known = value.parameters if isinstance(value, Function) else {}
    if not isinstance(value, Function) or name not in known:
        has = f"a function of {', '.join(known)}" if known else "no function with parameters"
        raise ValueError(f"{key} cannot be set: {owner} is {has}")
    return value


def set_in_function(old: object, new: Mapping[str, Any]) -> dict[str, Any]:
    """Return the table of a function where `new` is set.

    A table with a part of the parameters of the old one changes these; another replaces it.
    """
    needed = [{p.name for p in each if p.absent is None} for each in FUNCTIONS.values()]
    whole = any(names <= new.keys() for names in needed)
    part = isinstance(old, dict) and new.keys() <= old.keys() and not whole
    return {**old, **new} if isinstance(old, dict) and part else dict(new)

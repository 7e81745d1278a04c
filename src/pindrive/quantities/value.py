"""Dataclasses as values: a short representation, and equality of all that they hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from math import isnan
from typing import Any, Final, TypeVar

T = TypeVar("T")

LONGEST: Final = 200
"""Characters of a representation."""
_NESTED: Final = 75
"""Characters of a value within another."""
_ROW: Final = 30
"""Characters of a sequence that is shown."""


def concise(cls: type[T]) -> type[T]:
    """Give a dataclass a representation of at most `LONGEST` characters.

    The text has the existing fields that differ from their defaults, with six digits; of a long
    sequence the length. The fields themselves hold everything.
    """

    def __repr__(self: T) -> str:
        return _text(self, LONGEST)

    cls.__repr__ = __repr__  # type: ignore[assignment]
    return cls


def equal_by_value(cls: type[T]) -> type[T]:
    """Make instances of a frozen dataclass equal where all that they hold is.

    Arrays are compared as a whole, and NaN, where a number does not exist, equals NaN, so that what
    was pickled or simulated once more is equal.
    """

    def __eq__(self: T, other: object) -> bool:
        return type(self) is type(other) and _frozen(self) == _frozen(other)

    def __hash__(self: T) -> int:
        return hash(_frozen(self))

    cls.__eq__ = __eq__  # type: ignore[method-assign, assignment]
    cls.__hash__ = __hash__  # type: ignore[method-assign, assignment]
    return cls


def _frozen(value: Any) -> Any:
    """Something that can be compared and hashed in place of a value."""
    if isinstance(value, float):
        return "nan" if isnan(value) else value
    if is_dataclass(value):
        return (type(value), *(_frozen(getattr(value, f.name)) for f in _compared(value)))
    if isinstance(value, tuple | list):
        return tuple(map(_frozen, value))
    if isinstance(value, Mapping):
        return tuple(sorted((str(key), _frozen(item)) for key, item in value.items()))
    if hasattr(value, "tobytes"):
        plain = value + 0.0 if value.dtype.kind == "f" else value  # -0.0 + 0.0 is 0.0
        return (plain.dtype.str, plain.shape, plain.tobytes())
    return value


def _compared(value: Any) -> Iterator[Field[Any]]:
    return (field for field in fields(value) if field.compare)


def _text(value: Any, room: int) -> str:
    """Return a value as text of limited length."""
    if is_dataclass(value) and _has_usual_text(type(value)):
        shown = (
            f"{field.name}={_text(item, _NESTED)}"
            for field in fields(value)
            if field.repr and _tells(field, item := getattr(value, field.name))
        )
        return _fitted(f"{type(value).__name__}(", [*shown], room)
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "tobytes") and value.ndim:
        return f"<{' x '.join(map(str, value.shape))} values>"
    if isinstance(value, tuple | list):
        items = [_text(item, _NESTED) for item in value[:4]]
        text = f"({', '.join(items)})"
        return text if len(value) <= 4 and len(text) <= _ROW else f"<{len(value)} values>"
    text = repr(value)
    return text if len(text) <= room else f"{text[: room - 1]}…"


def _has_usual_text(cls: Any) -> bool:
    """Return True if a dataclass has no representation of its own."""
    return bool(cls.__dataclass_params__.repr)


def _tells(field: Field[Any], value: Any) -> bool:
    """Return True if a field exists and differs from its default."""
    default = field.default if field.default_factory is MISSING else field.default_factory()
    exists = value is not None and not (isinstance(value, float) and isnan(value))
    return exists and (default is MISSING or _frozen(default) != _frozen(value))


def _fitted(begin: str, parts: list[str], room: int) -> str:
    """Return the leading parts that fit the length, in brackets."""
    text = begin
    for i, part in enumerate(parts):
        comma, last = ", " if i else "", i == len(parts) - 1
        if len(text) + len(comma) + len(part) + (1 if last else 4) > room:
            return f"{text}{comma}…)"
        text += comma + part
    return f"{text})"

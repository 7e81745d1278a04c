"""A part of the table of quantities, by name: the checks of its numbers, and its defaults.

Only the standard library is imported, so that a command starts fast.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import Field, dataclass, fields
from typing import Any, Final, Protocol, SupportsFloat, TypeVar, cast, dataclass_transform

from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.value import concise

T = TypeVar("T")


class Number(Protocol):
    """The type of a `checked` field that takes a number, SI, or text with a unit."""

    def __get__(self, instance: object, owner: object) -> float: ...
    def __set__(self, instance: object, value: float | str) -> None: ...


class OptionalNumber(Protocol):
    """Descriptor of a number that may be None."""

    def __get__(self, instance: object, owner: object) -> float | None: ...
    def __set__(self, instance: object, value: float | str | None) -> None: ...


class Part:
    """Rows of the table, by name.

    Args:
        rows: The quantities, each of another name.
    """

    def __init__(self, rows: Iterable[Quantity]) -> None:
        self.rows: Final = {quantity.name: quantity for quantity in rows}
        # Between these every value is allowed, so that few need be compared with more.
        self._inside: Final = {
            name: (max(q.bounds.lower, q.limits.lower), min(q.bounds.upper, q.limits.upper))
            for name, q in self.rows.items()
        }

    def check(
        self,
        name: str,
        value: SupportsFloat | str,
        *,
        where: str = "",
        label: str | None = None,
        given: str | None = None,
    ) -> float:
        """`value` as a float, if it is a number that the quantity called `name` may take.

        Args:
            name: A name of the table.
            value: SI value, or text with a unit: "12 g".
            where: The place it was written, said first in the message: file and key.
            label: Name of the quantity in messages; None: its own name.
            given: Notation of the value in messages; None: `value` with its SI unit.

        Raises:
            ValueError: The value is no number, text without a unit, not finite, or out of bounds.
        """
        quantity = self.rows[name]
        label = name if label is None else label
        if type(value) is float:
            lower, upper = self._inside[name]
            if lower < value < upper:
                return value
            number = value
        elif isinstance(value, (list, tuple)) or getattr(value, "shape", None):
            many = "one number; simulate_batch takes arrays"
            if quantity.rows_of == "profile":
                many = (
                    "a number or a Profile of what changes over time; simulate_batch takes arrays"
                )
            size = getattr(value, "shape", None)
            shown = (
                f"{len(cast(list[object], value))} values" if size is None else f"an array {size}"
            )
            raise ValueError(refusal(label, many, shown, where))
        elif isinstance(value, str):
            from pindrive.quantities.units import to_si  # with decimals, which few programs need

            given = quoted(value) if given is None else given
            try:
                example, unit = quantity.usual, quantity.unit or "1"
                number = to_si(value, unit, example)
            except ValueError as error:
                raise ValueError(refusal(label, str(error), given, where)) from None
        else:
            try:
                if isinstance(value, (bytes, bool)):
                    raise TypeError
                number = float(value)
            except (TypeError, ValueError, OverflowError):
                raise ValueError(refusal(label, quantity.kind, repr(value), where)) from None
        if required := quantity.required(number):
            unit = "" if quantity.unit == "1" else quantity.unit
            shown = given if given is not None else f"{number!r} {unit}".rstrip()
            raise ValueError(refusal(label, required, shown, where))
        return number

    def default(self, name: str) -> Any:
        """Return the default of the quantity called `name`, SI; None without a default."""
        return self.rows[name].absent


@dataclass_transform(frozen_default=True, kw_only_default=True)
def checked_by(part: Part) -> Callable[[type[T]], type[T]]:
    """A decorator: `checked` of the quantities of a part."""
    return lambda cls: checked_class(cls, part)


def checked_class(cls: type[T], part: Part) -> type[T]:
    """A frozen dataclass, made by keywords, whose fields of a part are checked.

    Values are kept as floats; one may be None where that is its default. Afterwards the class's
    own `__post_init__` is called. A refused field raises the error of `Part.check`.
    """
    then = getattr(cls, "__post_init__", None)
    taken: list[tuple[str, bool]] = []

    def check_fields(self: Any) -> None:
        for name, optional in taken:
            value = getattr(self, name)
            if not (optional and value is None):
                object.__setattr__(self, name, part.check(name, value))
        if then:
            then(self)

    cls.__post_init__ = check_fields  # type: ignore[attr-defined]
    made = concise(dataclass(frozen=True, kw_only=True)(cls))
    given: tuple[Field[Any], ...] = fields(made)  # type: ignore[arg-type]
    taken += [(field.name, field.default is None) for field in given if field.name in part.rows]
    return made

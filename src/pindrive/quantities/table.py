"""The table of quantities: every number that goes in or comes out, named, bounded and sourced once.

Command-line flags, device files, error messages, table headings and file attributes read it.
Only the standard library is imported, so that a command starts fast.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, fields, replace
from typing import (
    TYPE_CHECKING,
    Any,
    Final,
    SupportsFloat,
    TypeVar,
    cast,
    dataclass_transform,
)

from pindrive import lazy
from pindrive.quantities.device import ARRAY, CONTROL, DEVICE_PARTS, PIN, SCAN
from pindrive.quantities.drive import INPUTS, PARTS
from pindrive.quantities.electromagnet import COIL, MAGNET
from pindrive.quantities.quantity import Quantity, Rows
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import CRITERIA, DESIGNED, FINAL, JUDGE, OUTPUTS, RATE

DEVICE_INPUTS: Final = tuple(
    replace(row, absent=row.default) if row.absent is None else row
    for row in MAGNET + COIL + CONTROL + ARRAY + SCAN + CRITERIA
)
"""What a device file may give beyond the drive, in its order; all of it may be left out."""


DEVICE: Final[tuple[Quantity, ...]] = DEVICE_INPUTS + DEVICE_PARTS + PIN + JUDGE
"""What the whole device adds."""

QUANTITIES: Final[dict[str, Quantity]] = {
    q.name: q for q in (*INPUTS, *PARTS, *OUTPUTS, *FINAL, RATE, *DEVICE, *DESIGNED)
}

_INSIDE: Final = {
    name: (max(q.bounds.lower, q.limits.lower), min(q.bounds.upper, q.limits.upper))
    for name, q in QUANTITIES.items()
}
"""Between these every value is allowed, so that few need be compared with more."""

T = TypeVar("T")

if TYPE_CHECKING:
    from dataclasses import Field

    class Number:
        """The type of a `checked` field that takes a number, SI, or text with a unit."""

        def __get__(self, instance: object, owner: object) -> float: ...
        def __set__(self, instance: object, value: float | str) -> None: ...

    class OptionalNumber:
        """The same, of one that may be None."""

        def __get__(self, instance: object, owner: object) -> float | None: ...
        def __set__(self, instance: object, value: float | str | None) -> None: ...


def check(
    name: str,
    value: SupportsFloat | str,
    *,
    where: str = "",
    label: str | None = None,
    given: str | None = None,
) -> float:
    """`value` as a float, if it is a number that the quantity called `name` may take.

    Args:
        name: a name of the table.
        value: SI value, or text with a unit: "12 g".
        where: the place it was written, said first in the message: file and key.
        label: what the message calls the quantity; its name unless given.
        given: how the value was written, for the message; `value` with its SI unit unless given.

    Raises:
        ValueError: no number, text without the unit, not finite, or out of bounds.
    """
    quantity = QUANTITIES[name]
    label = name if label is None else label
    if type(value) is float:
        lower, upper = _INSIDE[name]
        if lower < value < upper:
            return value
        number = value
    elif isinstance(value, (list, tuple)) or getattr(value, "shape", None):
        many = "one number; simulate_batch takes arrays"
        if quantity.rows_of == "profile":
            many = "a number or a Profile of what changes over time; simulate_batch takes arrays"
        size = getattr(value, "shape", None)
        shown = f"{len(cast(list[object], value))} values" if size is None else f"an array {size}"
        raise ValueError(refusal(label, many, shown, where))
    elif isinstance(value, str):
        given = lazy.call("pindrive.quantities.units:quoted", value) if given is None else given
        try:
            example, unit = quantity.usual, quantity.unit or "1"
            number = lazy.call("pindrive.quantities.units:to_si", value, unit, example)
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


def default(name: str) -> Any:
    """What holds where the quantity called `name` is not given, SI; None where nothing does."""
    return QUANTITIES[name].absent


@dataclass_transform(frozen_default=True, kw_only_default=True)
def checked(cls: type[T]) -> type[T]:
    """A frozen dataclass, made by keywords, whose fields that are named as quantities are checked.

    They are kept as floats; one may be None where that is its default. Its own `__post_init__` is
    called then. Of a field that is refused it raises what `check` raises.
    """
    then = getattr(cls, "__post_init__", None)
    taken: list[tuple[str, bool]] = []

    def check_fields(self: Any) -> None:
        for name, optional in taken:
            value = getattr(self, name)
            if not (optional and value is None):
                object.__setattr__(self, name, check(name, value))
        if then:
            then(self)

    cls.__post_init__ = check_fields  # type: ignore[attr-defined]
    made = dataclass(frozen=True, kw_only=True)(cls)
    given: tuple[Field[Any], ...] = fields(made)  # type: ignore[arg-type]
    taken += [(field.name, field.default is None) for field in given if field.name in QUANTITIES]
    return made


class ImplausibleValueWarning(UserWarning):
    """A value is far from that of any tactile device; it may be in another unit."""


def warn_of(name: str, value: float | Rows, *, label: str = "", stacklevel: int = 1) -> None:
    """Warn if a value of the quantity called `name`, SI, or one in its rows, is implausible.

    Args:
        name: a name of the table of quantities.
        value: a number, or rows of which the second column is of that quantity.
        label: what the warning calls it; its name unless given.
        stacklevel: as for `warnings.warn`, from the caller on.
    """
    values = (value,) if isinstance(value, (float, int)) else [y for _, y in value]
    for y in values:
        words = QUANTITIES[name].doubt(y, label)
        if words:
            warnings.warn(words, ImplausibleValueWarning, stacklevel=stacklevel + 1)
            return


def short(name: str, value: float) -> str:
    """A value as a caption gives it: "26.5 mN"."""
    quantity = QUANTITIES[name]
    return f"{digits(value * quantity.display_scale)} {quantity.display_unit}".rstrip()


def duration(value: float) -> str:
    """A time (s), long ones in seconds."""
    return short("duration", value) if value < 2.0 else f"{digits(value)} s"


def digits(value: float) -> str:
    """Four digits, or all before the point where they are few more."""
    text = f"{value:.0f}" if 1e4 <= abs(value) < 1e7 else f"{value:.4g}"
    return text.replace("-", "\N{MINUS SIGN}")

"""The table of quantities: every number that goes in or comes out, named, bounded and sourced once.

Command-line flags, device files, error messages, table headings and file attributes read it.
Only the standard library and the core are imported, so that a command starts fast.
"""

from __future__ import annotations

import warnings
from typing import Final, TypeVar, dataclass_transform

from pindrive.quantities.device import ARRAY, CONTROL, DEVICE_PARTS, HAND, PIN, SCAN
from pindrive.quantities.drive import DRIVE_QUANTITIES, PARTS
from pindrive.quantities.electromagnet import COIL, MADE, MAGNET
from pindrive.quantities.functions import parameters_of
from pindrive.quantities.part import Part, checked_class
from pindrive.quantities.quantity import Quantity, Rows
from pindrive.quantities.results import CRITERIA, DESIGNED, FINAL, JUDGE, OUTPUTS, RATE

T = TypeVar("T")

DEVICE_INPUTS: Final = MAGNET + COIL + CONTROL + ARRAY + SCAN + HAND + CRITERIA
"""Optional keys of a device file beyond the drive, in order."""

FUNCTION_PARAMETERS: Final = parameters_of(DRIVE_QUANTITIES)
"""Parameters of inputs that are functions of time: "mouse_velocity.amplitude"."""


DEVICE: Final[tuple[Quantity, ...]] = DEVICE_INPUTS + MADE + DEVICE_PARTS + PIN + JUDGE
"""Additional quantities of a whole device."""

_ALL: Final = Part(
    (
        *(*DRIVE_QUANTITIES, *FUNCTION_PARAMETERS, *PARTS),
        *(*OUTPUTS, *FINAL, RATE, *DEVICE, *DESIGNED),
    )
)
QUANTITIES: Final = _ALL.rows
check: Final = _ALL.check
default: Final = _ALL.default


@dataclass_transform(frozen_default=True, kw_only_default=True)
def checked(cls: type[T]) -> type[T]:
    """A frozen dataclass, made by keywords, whose fields that are named as quantities are checked.

    Values are kept as floats; one may be None where that is its default. Afterwards the class's
    own `__post_init__` is called. A refused field raises the error of `check`.
    """
    return checked_class(cls, _ALL)


class ImplausibleValueWarning(UserWarning):
    """A value is far from that of any tactile device; it may be in another unit."""


def warn_of(name: str, value: float | Rows, *, label: str = "", stacklevel: int = 1) -> None:
    """Warn if a value of the quantity called `name`, SI, or one in its rows, is implausible.

    Args:
        name: A name of the table of quantities.
        value: A number, or rows of which the second column is of that quantity.
        label: Name of the quantity in the warning; empty: its own name.
        stacklevel: Level of the caller, as for `warnings.warn`.
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

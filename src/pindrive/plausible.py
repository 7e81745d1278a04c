"""Warnings of values that can be computed, but that no tactile device has: often a wrong unit."""

from __future__ import annotations

import warnings

from pindrive.quantities import QUANTITIES
from pindrive.quantity import Rows


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

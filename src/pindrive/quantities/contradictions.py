"""Contradictions between values, each in its range: found by the core, in one wording everywhere.

Values are given by the keys of a device file, SI: a number, rows, or None for one that is given but
not known, which contradicts nothing by its size.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from pindrive import _core
from pindrive.quantities.drive import DRIVE_QUANTITIES
from pindrive.quantities.quantity import Rows
from pindrive.quantities.refusal import Refusal, refusal

Given = Mapping[str, float | Rows | None]


class Rejection(NamedTuple):
    """A value that is rejected."""

    key: str
    """Its key in full: "plate.curve"."""
    part: str
    """What of it: "[1] speed", " slope"; empty: all."""
    required: str
    given: str
    against: list[str]
    """Keys of the values that it contradicts."""

    @property
    def words(self) -> Refusal:
        """The message, by its full key."""
        return refusal(f"{self.key}{self.part}", self.required, self.given)

    def at(self, place: Callable[..., str]) -> Refusal:
        """Return the message with the place of its keys.

        Args:
            place: Returns the place of the first of some keys that was set by itself.
        """
        given, keys = self.given, (self.key, *self.against)
        if len({place(key) for key in keys}) > 1:
            for key in keys:
                given = given.replace(key, f"{key} ({place(key)})")
        where = place(*keys)
        return refusal(f"{self.key}{self.part}", self.required, given, where)


def problems_of(values: Given, *, whole: bool = False) -> list[Rejection]:
    """Return the problems of some values.

    Args:
        values: Values by key, SI; what is left out has its usual value.
        whole: True for the rules of a device with magnet, control block and array, too.
    """
    return [Rejection(*found) for found in _core.value_problems([*values.items()], whole)]


_NAMES: Final = {quantity.key: quantity.name for quantity in DRIVE_QUANTITIES}


def refuse(values: Given, *, whole: bool = False) -> None:
    """Raise the first problem of some values, by the name of the argument in Python.

    Raises:
        ValueError: A value contradicts others.
    """
    found = problems_of(values, whole=whole)
    if found:
        key, part, required, given, _ = found[0]
        name = _NAMES.get(key, key.partition(".")[2])
        raise ValueError(refusal(f"{name}{part}", required, given))


def refuse_contact(values: Given) -> None:
    """Raise the first problem of a contact, by the names of its arguments.

    Args:
        values: Values by the names in a table of a contact.

    Raises:
        ValueError: A value contradicts others.
    """
    found = problems_of({f"plate.{name}": value for name, value in values.items()})
    if found:
        words = [text.replace("plate.", "") for text in found[0][:4]]
        raise ValueError(refusal(words[0] + words[1], *words[2:]))

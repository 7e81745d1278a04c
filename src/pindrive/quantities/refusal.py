"""The words of a value that is refused, and the check of a count."""

from __future__ import annotations

import json
from operator import index
from typing import SupportsIndex, cast


class Refusal(str):
    """The words of a refused value, which know the quantity that they refuse."""

    label: str
    """Name of the quantity in the message."""
    said: str
    """The words without the place where the value was written."""

    @classmethod
    def of(cls, label: str, said: str, where: str) -> Refusal:
        """These words, with the place said first."""
        words = cls(f"{where}: {said}" if where else said)
        words.label, words.said = label, said
        return words

    def at(self, where: str, key: str) -> Refusal:
        """Return the message for a value at a place; the key becomes the label if it ends so."""
        own = self.label.partition("[")[0]
        full = key if key.endswith(f".{own}") else own
        label, said = (full + words.removeprefix(own) for words in (self.label, self.said))
        return Refusal.of(label, said, where)


def quoted(value: object) -> str:
    """`value` as one short piece of a message, as a TOML file has it, all on one line."""
    plain = isinstance(value, (str, bool, list, dict))
    text = json.dumps(value, ensure_ascii=False, default=str) if plain else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def refusal(label: str, required: str, given: object, where: str = "") -> Refusal:
    """The one wording of a refused value: place, quantity, what it must be, what it was."""
    return Refusal.of(label, f"{label} must be {required}, got {given}", where)


def message_of(error: Exception) -> Refusal | str:
    """The first thing that an error tells, as it was made."""
    message = getattr(error, "problems", error.args)
    return message[0] if message and isinstance(message[0], str) else str(error)


def refused_by(error: Exception) -> str:
    """Return the label of the rejected quantity, or the kind of an error without a label."""
    message = message_of(error)
    return message.label if isinstance(message, Refusal) else type(error).__name__


def check_whole(
    value: object, label: str, least: int = 1, most: int | None = None, *, where: str = ""
) -> int:
    """`value` as an int, if it is a whole number from `least` up, to `most` where that is given.

    Truth values are none, nor are floats; NumPy's integers are.

    Raises:
        ValueError: The value is no whole number in the range.
    """
    upper = f"from {least} to {most}" if most is not None else f"of at least {least}"
    try:
        number = least - 1 if isinstance(value, bool) else index(cast(SupportsIndex, value))
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        raise ValueError(refusal(label, f"a whole number {upper}", repr(value), where))
    return number

"""Names that a user types: which input or number is meant, and which are near an unknown one."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from difflib import SequenceMatcher
from typing import Final

from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted

_NEAR: Final = 0.6
"""Least likeness of a name that is suggested."""
_BESIDE: Final = 0.03
"""Largest difference in likelihood between the best suggestion and another listed one."""
_MOST: Final = 3
"""Suggestions at most."""
_BY_PART: Final = 0.9
"""Likeness of a known name in the wrong table, and of the names of a table that stands alone."""
_FEW: Final = 8
"""Largest number of names that a message lists if none is similar."""
OTHER_WORDS: Final = {
    "speed": "velocity",
    "friction": "kinetic",
    "spring": "stiffness",
    "damper": "damping",
    "weight": "mass",
    "mu": "coefficient",
    "stroke": "swing",
}
"""Words that people write for the words of names."""


class Names:
    """Names of one kind, and how each may be written.

    A name is meant by each of its spellings, in which a dot and an underscore are alike, and by
    what follows a dot of a spelling where that means no other name.

    Args:
        kind: Kind of the names, for messages: "key".
        spellings: Each name with its further spellings; of two names with one spelling the first
            has it.
        listed: Place of the list of all names, for messages.
        shown: Notation of a name in messages.
    """

    def __init__(
        self,
        kind: str,
        spellings: Mapping[str, Iterable[str]],
        *,
        listed: str = "",
        shown: Callable[[str], str] = str,
    ) -> None:
        self._kind, self._listed, self._shown = kind, listed, shown
        self._names = tuple(spellings)
        self._spelled: dict[str, str] = {}
        self._ends: dict[str, dict[str, None]] = {}
        for name, others in spellings.items():
            for spelling in (name, *others):
                self._spelled.setdefault(_plain(spelling), name)
                for end in _ends(spelling):
                    self._ends.setdefault(end, {})[name] = None

    def matches(self, given: str) -> tuple[str, ...]:
        """The names that may be meant: none, one, or all that end so."""
        plain = _plain(given)
        if plain in self._spelled:
            return (self._spelled[plain],)
        return tuple(self._ends.get(plain, ()))

    def find(self, given: object, place: str) -> str:
        """The name that is meant.

        Args:
            given: Given text.
            place: Place of the text, for messages.

        Raises:
            ValueError: The text is no name, or may be several.
        """
        text = given if isinstance(given, str) else repr(given)
        found = self.matches(text)
        if len(found) == 1:
            return found[0]
        said = f"{place}: " if place else ""
        if not found:
            raise ValueError(f"{said}{self.unknown(text)}")
        raise ValueError(f"{said}{in_message(text)} may be {self._or(found)}; give it in full")

    def nearest(self, given: str) -> tuple[str, ...]:
        """The names most like an unknown one, the likeliest first; none where none is near."""
        plain = _plain(given)
        usual = "_".join(OTHER_WORDS.get(word, word) for word in plain.split("_"))
        likeness: dict[str, float] = {}
        table = given.partition(".")[0] if "." in given else ""
        for spelled, name in self._all_spellings():
            like = max(_likeness(one, spelled, table) for one in (plain, usual))
            likeness[name] = max(likeness.get(name, 0.0), like)
        by_part = (name for name in self._names if name.startswith(f"{given}."))
        for name in (*self.matches(given.rpartition(".")[2]), *by_part):
            likeness[name] = max(likeness[name], _BY_PART)
        best = max(likeness.values(), default=0.0)
        near = [name for name in likeness if likeness[name] >= max(_NEAR, best - _BESIDE)]
        return tuple(sorted(near, key=lambda name: -likeness[name])[:_MOST])

    def _all_spellings(self) -> Iterator[tuple[str, str]]:
        yield from self._spelled.items()
        for end, names in self._ends.items():
            yield from ((end, name) for name in names)

    def unknown(self, given: str) -> str:
        """Return the message for an unknown name: 'unknown key mas; did you mean drive.mass?'."""
        return f"unknown {self._kind} {in_message(given)}; {self.suggestion(given)}"

    def suggestion(self, given: str) -> str:
        """Return the advice for an unknown name: "did you mean drive.mass?"."""
        near = self.nearest(given)
        if near:
            return f"did you mean {self._or(near)}?"
        if len(self._names) <= _FEW or not self._listed:
            return f"there are {', '.join(map(self._shown, self._names))}"
        return f"none is like it; {self._listed} lists all {len(self._names)}"

    def _or(self, names: Iterable[str]) -> str:
        *first, last = map(self._shown, names)
        return f"{', '.join(first)} or {last}" if first else last


def label(variable: str) -> str:
    """A number as a table names it: "settling_time", "shown"; an ending's, a median in full."""
    head, _, tail = variable.partition("_")
    return tail if head in ("transient", "lines", "design") else variable


def number_names(variables: Mapping[str, Quantity | None]) -> Names:
    """Return the accepted spellings of variables; None marks a variable without a number.

    The number of a transient goes before that of an ending, a median before a worst value.
    """
    spellings = {
        variable: (quantity.name, variable.partition("_")[2]) if quantity else ()
        for variable, quantity in variables.items()
    }
    return Names("number", spellings, listed="docs/reference/dataset.md", shown=label)


def in_message(given: str) -> str:
    """A name as a message shows it: in quotes where it is no word."""
    return given if re.fullmatch(r"[\w.-]{1,60}", given, re.ASCII) else quoted(given)


def _plain(name: str) -> str:
    return name.strip().replace(".", "_")


def _ends(spelling: str) -> Iterator[str]:
    """Return the text after each dot of a spelling, in plain letters."""
    parts = spelling.split(".")
    yield from (_plain("_".join(parts[n:])) for n in range(1, len(parts)))


def _likeness(given: str, spelled: str, table: str) -> float:
    """From 0 to 1: how alike two names are, by letters or by a word that is not their table."""
    one, other = given.lower(), spelled.lower()
    letters = SequenceMatcher(None, one, other).ratio()
    words = {word for word in one.split("_") if len(word) > 2} - {table}
    shared = words & {*other.split("_")}
    return max(letters, 0.5 + 0.5 * letters) if shared else letters

"""Published case: source of its numbers, with the computed values."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pindrive import Drive, Function, ImplausibleValueWarning, Motion, Profile, Release, simulate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DATA: Final = Path(__file__).with_name("data")
PUBLISHED: Final[dict[str, Any]] = {
    "marker": "o",
    "ls": "",
    "mfc": "none",
    "ms": 7.0,
    "color": "#D55E00",
}
"""Style of published values in a figure."""
DIGITS: Final = "half a unit of the last printed digit"


@dataclass(frozen=True, slots=True, kw_only=True)
class Number:
    """Published number with the number computed by pindrive."""

    what: str
    """With its unit."""
    published: str
    """As the source prints it, or as its formula gives it."""
    computed: float
    allowed: float
    """Largest difference that the source justifies."""
    because: str
    """Source of `allowed`."""
    deviates: bool = False
    """True if the source itself deviates by more than allowed; its case explains the reason."""

    @property
    def difference(self) -> float:
        return self.computed - float(self.published)

    @property
    def agrees(self) -> bool:
        return abs(self.difference) <= self.allowed


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A case of the literature."""

    key: str
    """Name of its section and its figure."""
    title: str
    source: Mapping[str, str]
    about: str
    """Description of the system, and its notation as a drive."""
    numbers: Sequence[Number]
    draw: Callable[[Axes], None]
    """Draws the motion beside the published values."""
    remarks: str = ""
    missing: str = ""
    """Part of the case that pindrive cannot express, and its replacement."""


def load(name: str) -> Any:
    """Return the contents of the data file of a case."""
    return json.loads((DATA / f"{name}.json").read_text("utf-8"))


def printed(what: str, published: str, computed: float, *, deviates: bool = False) -> Number:
    """A number that is compared to all the digits that its source prints."""
    return Number(
        what=what,
        published=published,
        computed=computed,
        allowed=half_unit(published),
        because=DIGITS,
        deviates=deviates,
    )


def half_unit(text: str) -> float:
    """Half a unit of the last digit of a number as printed: "-4.596e-4" has 5e-8."""
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or 0) - decimals)


def follow(
    drive: Drive,
    *,
    mouse_velocity: float | Profile = 0.0,
    displacement: float = 0.0,
    velocity: float | None = None,
    duration: float | None = None,
    force: float | Function = 0.0,
) -> Motion:
    """The motion of a drive; the cases are larger and faster than any tactile device."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ImplausibleValueWarning)
        release = Release(mouse_velocity, displacement, velocity, force=force)
        return simulate(drive, release, duration=duration)

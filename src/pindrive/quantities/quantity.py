"""Definition of a quantity: name, unit, bounds, storage in a table, and text form of its values."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, replace
from math import degrees, floor, inf, isfinite, isnan, log10, nan
from pathlib import Path
from typing import Any, Final

from pindrive import _core

Rows = tuple[tuple[float, float], ...]
"""A piecewise-linear function by its corners, SI: (speed, force) or (time, value)."""

DISPLAY: Final[dict[str, tuple[str, float]]] = {
    "kg": ("g", 1e3),
    "m": ("mm", 1e3),
    "m/s": ("mm/s", 1e3),
    "s": ("ms", 1e3),
    "N": ("mN", 1e3),
    "J": ("µJ", 1e6),
    "m^2": ("mm^2", 1e6),
    "rad": ("deg", degrees(1.0)),
    "A": ("mA", 1e3),
    "H": ("mH", 1e3),
    "1/m": ("dpi", 0.0254),
}
"""Display unit of each SI unit, and the number of display units in one SI unit; other units are
displayed unchanged."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """An interval of allowed values, and a single one beside it.

    An open infinite end leaves infinity out.
    """

    lower: float = -inf
    upper: float = inf
    lower_closed: bool = False
    upper_closed: bool = False
    also: float | None = None

    def __contains__(self, value: float) -> bool:
        """Return True if `value` is allowed; NaN never is."""
        return (
            self.lower < value < self.upper
            or (self.lower_closed and value == self.lower)
            or (self.upper_closed and value == self.upper)
            or value == self.also
        )

    def words(self, unit: str = "") -> str:
        """The values as they read in a sentence: "finite and greater than 0 kg"."""
        also = nan if self.also is None else self.also
        ends = (self.lower, self.upper, self.lower_closed, self.upper_closed, also)
        return _core.bounds_words(ends, unit)


FINITE: Final = Bounds()
POSITIVE: Final = Bounds(lower=0.0)
NON_NEGATIVE: Final = Bounds(lower=0.0, lower_closed=True)
POSITIVE_OR_RIGID: Final = Bounds(lower=0.0, upper_closed=True)
FINITE_OR_NOT: Final = Bounds(lower_closed=True, upper_closed=True)
SHARE: Final = Bounds(lower=0.0, upper=1.0, upper_closed=True)


def between(lower: float, upper: float) -> Bounds:
    """The values from `lower` to `upper`, both included."""
    return Bounds(lower, upper, lower_closed=True, upper_closed=True)


@dataclass(frozen=True, slots=True)
class Quantity:
    """One quantity: its name, its unit, the values it may take, its meaning and its source."""

    name: str
    """Inputs: their name in Python; outputs: the path of their attribute on a `Motion`."""
    symbol: str
    unit: str
    """SI unit, "1" when dimensionless, "" for a count or a truth value."""
    meaning: str
    default: float | None = None
    """SI value in the file that `pindrive init` writes."""
    source: str = ""
    section: str = ""
    """The table of the device file that holds it; empty when the name says so or it is no input."""
    mandatory: bool = False
    """True if a device file must contain the quantity."""
    alternative: tuple[str, ...] = ()
    """Keys that may replace a mandatory quantity, which then follows from them."""
    absent: float | None = None
    """SI value that holds where a device file, or a call in Python, leaves it out; None: there is
    none, or it follows from others."""
    remark: str = ""
    """Additional remark of the device file."""
    example: float | None = None
    """SI value in a comment of that file, where the file leaves it out."""
    rows_of: str = ""
    """Key of `COLUMNS` for the points of a quantity that may vary: "curve", "profile"."""
    rows: Rows = ()
    """Such rows, SI, in a comment of that file; given alone, it must be rows."""
    follows: tuple[str, ...] = ()
    """Keys to which the value, or the values of rows, keep their ratio when the keys are varied:
    the first key, or the first over the second."""
    bounds: Bounds = FINITE
    """Bounds of all possible values; of an input those of the core."""
    limits: Bounds = FINITE_OR_NOT
    """Bounds of the computable values, far outside of any device; other values are rejected."""
    choices: tuple[str, ...] = ()
    """Names of the values 0, 1, 2 …; a device file has the name."""
    seen: Bounds | None = None
    """Plausible values of any such device, in magnitude; a value outside is accepted with a
    warning."""

    @property
    def key(self) -> str:
        """The full key in a device file: "drive.mass", "plate.kinetic"."""
        return f"{self.section}.{self.name}" if self.section else self.name

    @property
    def variable(self) -> str:
        """Its name in datasets and CSV files: "line_stroke" for "line.stroke"."""
        return self.name.replace(".", "_")

    @property
    def may_be_constant(self) -> bool:
        """True if a single value is accepted, besides points."""
        return not self.rows or self.default is not None or self.example is not None

    @property
    def kind(self) -> str:
        """Kind of a value for messages: "a number in kg", "a plain number"."""
        if self.choices:
            return f"one of {', '.join(self.choices)}"
        return f"a number in {self.unit}" if self.unit not in ("", "1") else "a plain number"

    @property
    def kinds(self) -> str:
        """Kind of several values: "numbers in kg", "plain numbers"."""
        return f"numbers in {self.unit}" if self.unit not in ("", "1") else "plain numbers"

    @property
    def display_unit(self) -> str:
        """The unit a person reads it in: "mm" for "m"; empty when dimensionless."""
        return "" if self.unit == "1" else DISPLAY.get(self.unit, (self.unit, 1.0))[0]

    @property
    def display_scale(self) -> float:
        """Number of display units in one SI unit."""
        return DISPLAY.get(self.unit, (self.unit, 1.0))[1]

    @property
    def heading(self) -> str:
        """Heading of a CSV column, SI: "position [m]", "line_stroke [m]"."""
        return heading(self.variable, self.unit)

    @property
    def usual(self) -> str:
        """Usual value as text: "10 g"; for a quantity of points, their last value."""
        unknown = self.rows[-1][1] if self.rows else 1.0 / self.display_scale
        stated = (self.default, self.example, self.absent, unknown)
        return self.written(next(value for value in stated if value is not None))

    def written(self, value: float) -> str:
        """`value` (SI) as a device file has it: "1.5 mm"; every digit that matters."""
        if self.choices:
            return self.choices[int(value)]
        return f"{value * self.display_scale:.12g} {self.display_unit}".rstrip()

    @property
    def unless_given(self) -> str:
        """Words for the value that holds where a device file leaves it out; empty: none does."""
        return "" if self.absent is None else f"{self.written(self.absent)} unless given"

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of a dataset variable: meaning, symbol, SI unit."""
        stated = {"long_name": self.meaning, "symbol": self.symbol, "units": self.unit}
        return {name: text for name, text in stated.items() if text}

    def required(self, value: float) -> str:
        """Return the requirement that a value (SI) violates: "finite and greater than 0 kg"."""
        for bounds in (self.bounds, self.limits):
            if value not in bounds:
                return bounds.words("" if self.unit == "1" else self.unit)
        return ""

    def doubt(self, value: float, label: str = "") -> str:
        """Words for a value (SI) that no such device has; empty for one that may be meant."""
        if self.seen is None or abs(value) in self.seen or not isfinite(value):
            return ""
        unit = "" if self.unit == "1" else self.unit
        words = f"{label or self.name} is {brief(value)} {unit}".rstrip()
        ends = f"{brief(self.seen.lower)} to {brief(self.seen.upper)} {unit}".rstrip()
        words += f"; any such device has {ends}"
        meant = value / self.display_scale
        if self.display_scale == 1.0 or abs(meant) not in self.seen:
            return words
        return f"{words}; did you mean {brief(value)} {self.display_unit}, {brief(meant)} {unit}?"

    def digits(self, value: float) -> str:
        """`value` (SI) in display units to four significant digits, without the unit."""
        if self.choices:
            return self.choices[int(value)]
        return significant(value * self.display_scale)

    def text(self, value: float) -> str:
        """`value` (SI) for a person to read: "1.500 mm"."""
        return f"{self.digits(value)} {self.display_unit}".rstrip()


def _bounds(ends: tuple[float, float, bool, bool, float]) -> Bounds:
    lower, upper, lower_closed, upper_closed, also = ends
    return Bounds(lower, upper, lower_closed, upper_closed, None if isnan(also) else also)


_OF_CORE: Final[dict[str, tuple[Bounds, Bounds, float | None]]] = {
    key: (_bounds(bounds), _bounds(computable), None if isnan(absent) else absent)
    for key, _, bounds, computable, absent in _core.input_quantities()
}
"""Bounds, computable bounds and value without the key, of each input of the core."""


def inputs(section: str, *rows: Quantity) -> tuple[Quantity, ...]:
    """Return inputs with their bounds and the value that holds without them.

    Args:
        section: Table of a device file; empty where the names contain it.
        rows: The inputs.
    """
    found = []
    for row in rows:
        bounds, limits, absent = _OF_CORE[f"{section}.{row.name}" if section else row.name]
        found.append(replace(row, section=section, bounds=bounds, limits=limits, absent=absent))
    return tuple(found)


# ---- tables of quantities in TOML files, a line for each ---------------------------------------

_NAMED: Final = {
    "non-negative": NON_NEGATIVE,
    "positive or infinite": POSITIVE_OR_RIGID,
    "share": SHARE,
}
_INTERVALS: Final = ("bounds", "limits", "seen")


def stored(file: str) -> dict[str, Any]:
    """Return the groups of a file of this folder."""
    return tomllib.loads(Path(__file__).with_name(file).read_text("utf-8"))


def fields_of(row: dict[str, Any], **slots: str) -> dict[str, Any]:
    """Return the fields of `Quantity` in a row; bounds are two numbers or a name.

    Args:
        row: Fields as stored; those named in "without" are None.
        **slots: Texts in the braces of other texts.
    """

    def read(field: str, value: Any) -> Any:
        if field in _INTERVALS:
            return _NAMED[value] if isinstance(value, str) else between(*value)
        if isinstance(value, list):
            return tuple(read("", each) for each in value)
        return value.format(**slots) if slots and isinstance(value, str) else value

    found = {field: read(field, value) for field, value in row.items()}
    return found | dict.fromkeys(found.pop("without", ()))


def stored_inputs(section: str, group: dict[str, dict[str, Any]]) -> tuple[Quantity, ...]:
    """Return the inputs of a group, in order; a name with a point has its section in itself."""
    return tuple(
        found
        for each in quantities(group)
        for found in inputs("" if "." in each.name else section, each)
    )


def quantities(group: dict[str, dict[str, Any]], prefix: str = "") -> tuple[Quantity, ...]:
    """Return the quantities of a group, in order, with a prefix of their names."""
    return tuple(Quantity(prefix + name, **fields_of(row)) for name, row in group.items())


# ---- numbers as text -----------------------------------------------------------------------------


def heading(name: str, unit: str) -> str:
    """The heading of a column in a CSV: "position [m]", without a unit where there is none."""
    return f"{name} [{unit}]" if unit not in ("", "1") else name


def counted(number: int, noun: str, plural: str = "") -> str:
    """A count with its noun, thousands apart: "1 point", "10 000 points"."""
    shown = f"{number:,}".replace(",", " ")
    return f"{shown} {noun if number == 1 else plural or f'{noun}s'}"


def brief(value: float) -> str:
    """`value` to six digits, as short as they come: "1e-6"."""
    return re.sub(r"e([+-])0*", lambda sign: "e" + sign[1].strip("+"), f"{value:g}")


def significant(value: float, digits: int = 4) -> str:
    """Return `value` with that number of significant digits, plain if short; "-" for NaN."""
    if isnan(value):
        return "-"
    if value == 0.0 or not isfinite(value):
        return f"{value:g}".replace("-0", "0")
    exponent = floor(log10(abs(value)))
    if not -4 <= exponent < 7:
        return f"{value:.{digits - 1}e}"
    return f"{value:.{max(0, digits - 1 - exponent)}f}"

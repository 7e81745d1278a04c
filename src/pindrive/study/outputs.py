"""The numbers that a study keeps, the limits set on them, and how many points meet these."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import inf
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import h5py, stats
from pindrive.quantities.names import Names, label, number_names
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.results import (
    BAD_WHEN_SMALL,
    DESIGNED,
    ENDING,
    ENERGY,
    HAND_PATH,
    LINE,
    LINE_COUNTS,
    TRANSIENT,
    last_part,
)
from pindrive.quantities.status import OUTCOMES, outcome_attributes
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.units import UnitError, to_si
from pindrive.quantities.value import concise, equal_by_value


def _median(quantity: Quantity) -> Quantity:
    meaning = f"median of the lines shown: {quantity.meaning}"
    return replace(quantity, name=f"median.{last_part(quantity)}", meaning=meaning)


def _worst(quantity: Quantity) -> Quantity:
    end = "least" if last_part(quantity) in BAD_WHEN_SMALL else "largest"
    meaning = f"{end} of the lines shown: {quantity.meaning}"
    return replace(quantity, name=f"worst.{last_part(quantity)}", meaning=meaning)


SCANNED: Final[tuple[Quantity, ...]] = (
    Quantity("lines.shown_part", "r_1", "1", "part of the lines that was shown"),
    *LINE_COUNTS,
    *(_median(quantity) for quantity in LINE),
    *(_worst(quantity) for quantity in LINE),
    Quantity("hand.duration", "T_h", "s", "how long the hand moves and pauses"),
    *HAND_PATH,
    Quantity("magnet.on_part", "D_on", "1", "part of that time that a magnet is on, the largest"),
    Quantity("coil.warming", "ΔT_on", "K", "by how much its coil warms, where one is described"),
)
"""Medians and worst values are of the lines that have the number: one that does not settle has no
smear, and is counted as unsettled."""
COUNTED: Final = tuple(quantity.name for quantity in LINE_COUNTS)


def variables(quantities: Iterable[Quantity]) -> dict[str, Quantity]:
    """Quantities by the names of their variables."""
    return {quantity.variable: quantity for quantity in quantities}


_OF_MOTIONS: Final = variables(TRANSIENT + ENDING + ENERGY)
_OF_SCANS: Final = variables(SCANNED)
NUMBERS: Final[dict[str, Quantity]] = _OF_MOTIONS | _OF_SCANS | variables(DESIGNED)
"""By the names of their variables."""
OUTPUTS: Final = (*_OF_MOTIONS, "status", "ending", "events")
"""Outputs of a motion."""
SCAN_OUTPUTS: Final = (*_OF_SCANS, "status")
"""Outputs of a scan."""
DESIGN_OUTPUTS: Final = tuple(variables(DESIGNED))
"""Outputs of a design."""

LEDGER: Final = tuple(variables(ENERGY))
"""The terms of the energy ledger: they take long, and are kept where a study names them."""

_SKIN: Final = ("transient_peak_stretch", "transient_peak_stretch_rate")
_COUNTS: Final = (
    *("transient_plate_reversals", "transient_finger_reversals"),
    *(name.replace(".", "_") for name in COUNTED),
)
_SETTLED: Final = "transient_settled"

MEASURED: Final = tuple(name for name in _OF_MOTIONS if name != _SETTLED)
"""Numeric outputs of a motion, without flags."""
SCAN_MEASURED: Final = tuple(_OF_SCANS)
"""Numeric outputs of a scan: all outputs."""


def is_measured(name: str) -> bool:
    """Return True for a number, False for a flag."""
    return name in NUMBERS and name != _SETTLED


def is_stepped(name: str) -> bool:
    """Return True for a count or a fraction of a count, which has no values in between."""
    return name in _COUNTS or name == "lines_shown_part"


def usual_outputs(among: Sequence[str], *, rigid: bool, coil: bool, hand: bool) -> tuple[str, ...]:
    """Return all numbers but the energy ledger; skin, coil and hand only if present."""
    missing = (*LEDGER, *(_SKIN if rigid else ()), *(() if coil else ("coil_warming",)))
    missing += () if hand else tuple(variables(HAND_PATH))
    return tuple(name for name in among if name not in missing)


def known_output(given: object, place: str, among: tuple[str, ...] = OUTPUTS) -> str:
    """The variable that a name means: settling_time, transient.settling_time.

    The last part alone of a median and a worst value is the median.

    Raises:
        ValueError: No variable has this name, or several have it.
    """
    if not isinstance(given, str):
        raise ValueError(refusal("an output", "the name of a number", quoted(given), place))
    return _names(among).find(given, place)


@cache
def _names(among: tuple[str, ...]) -> Names:
    return number_names({name: NUMBERS.get(name) for name in among})


def dtype(name: str) -> np.dtype[Any]:
    """Return the storage type of a variable: counts and flags are integers."""
    if name in ("status", "ending", _SETTLED):
        return np.dtype("<i1")
    return np.dtype("<i4" if name in _COUNTS or name == "events" else "<f8")


def encoded(name: str, values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Values as a file holds them; -1 for a count that does not exist."""
    if name in _COUNTS:
        values = np.where(np.isnan(values), -1.0, values)
    return np.ascontiguousarray(values, dtype(name))


def attributes(name: str) -> dict[str, Any]:
    """Return the attributes of a variable; xarray reads a missing count as NaN."""
    if name in OUTCOMES:
        return outcome_attributes(name)
    found = {**NUMBERS[name].attributes}
    return found | {"dtype": "bool"} if name == _SETTLED else found


def missing(name: str) -> int | None:
    """The value that stands for none."""
    return -1 if name in _COUNTS else None


def measured(name: str) -> Quantity:
    """The quantity that a variable holds, of an input or of a motion."""
    return NUMBERS[name] if name in NUMBERS else QUANTITIES[name]


_CONDITION: Final = re.compile(r"\s*(<=|>=|≤|≥)\s*(.+)")
LARGEST: Final = 1e100
"""Largest limit: its square is still finite."""
_AT_MOST: Final = ("<=", "≤")


@concise
@dataclass(frozen=True, slots=True)
class Constraint:
    """A limit on one number: at most, or at least, `limit` (SI)."""

    name: str
    at_most: bool
    limit: float

    def met(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return True for values within the limit; NaN never is."""
        return values <= self.limit if self.at_most else values >= self.limit

    def excess(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distance beyond the limit, SI: negative within, infinite for NaN."""
        beyond = values - self.limit if self.at_most else self.limit - values
        return np.where(np.isnan(values), inf, beyond)

    def text(self) -> str:
        """For display: "settling_time ≤ 60.00 ms"."""
        return f"{label(self.name)} {'≤' if self.at_most else '≥'} {self.shown()}"

    def shown(self) -> str:
        """The limit in its display unit."""
        quantity = NUMBERS[self.name]
        return f"{quantity.display_scale * self.limit:.6g} {quantity.display_unit}".rstrip()


def as_attribute(required: Sequence[Constraint]) -> str:
    """Constraints as an attribute of a study's file holds them; empty where there are none."""
    return json.dumps([[d.name, d.at_most, d.limit] for d in required]) if required else ""


def from_attribute(text: str) -> tuple[Constraint, ...]:
    """The constraints that `as_attribute` wrote."""
    return tuple(Constraint(*parts) for parts in json.loads(text or "[]"))


def constraints(
    table: Any, file: str, problems: list[str], among: tuple[str, ...] = OUTPUTS
) -> tuple[Constraint, ...]:
    """The constraints of a [specification] on outputs; what is wrong is appended to `problems`."""
    found = []
    for given, conditions in table.items():
        try:
            name = known_output(given, f"{file}: specification", among)
            if not is_measured(name):
                raise ValueError(f"{file}: specification.{given} names no number with a limit")
        except ValueError as error:
            problems.append(str(error))
            continue
        for condition in conditions if isinstance(conditions, list) else [conditions]:
            try:
                found.append(_constraint(name, condition, f"specification.{given}", file))
            except ValueError as error:
                problems.append(str(error))
    return tuple(found)


def _constraint(name: str, condition: object, where: str, file: str) -> Constraint:
    quantity = NUMBERS[name]
    example = f'"<= 60 {quantity.display_unit}"'.replace(' "', '"')
    match = _CONDITION.fullmatch(condition) if isinstance(condition, str) else None
    if not match:
        raise ValueError(
            refusal(where, f"a limit with <= or >=, like {example}", quoted(condition), file)
        )
    try:
        limit = to_si(match[2], quantity.unit or "1", f"60 {quantity.display_unit}".rstrip())
    except UnitError as error:
        raise ValueError(refusal(where, f"a limit: {error}", quoted(condition), file)) from None
    if not abs(limit) <= LARGEST:
        required = f"a finite limit, of at most {LARGEST:g} in size"
        raise ValueError(refusal(where, required, quoted(condition), file))
    return Constraint(name, match[1] in _AT_MOST, limit)


# ---- how many meet a specification ---------------------------------------------------------------


_CONFIDENCE: Final = 0.95
_SLICE: Final = 1 << 22
"""Points that are read at a time."""


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Share:
    """A part of the designs that exist, with its exact 95 % confidence interval.

    The interval is that of Clopper and Pearson 1934.
    """

    met: int
    of: int
    low: float
    high: float
    without: int = 0
    """Number of designs without the constrained number, for example never settled."""

    @property
    def text(self) -> str:
        """The part for a person: "97.482 %", never all nor none by rounding."""
        shown = f"{100.0 * self.met / self.of:.3f}"
        if shown == "100.000" and self.met < self.of:
            return "> 99.999 %"
        return "< 0.001 %" if shown == "0.000" and self.met else f"{shown} %"

    @classmethod
    def of_designs(cls, met: int, of: int, without: int = 0) -> Share:
        """Return the share among independent draws of existing designs, at least 1."""
        interval = stats.binomtest(met, of).proportion_ci(_CONFIDENCE, method="exact")
        return cls(met, of, float(interval.low), float(interval.high), without)


def points_that_meet(path: Path) -> tuple[int, int] | None:
    """Return the counts of points that meet the specification of the file, and of existing points.

    None where it holds none.
    """
    with h5py.File(path, "r") as file:
        required = from_attribute(str(file.attrs.get("specification", "")))
        if not required:
            return None
        met = of = 0
        for part in _slices(file["status"].shape):
            exist = file["status"][part] == 0
            here = exist & _all_met(file, required, part)
            met, of = met + int(here.sum()), of + int(exist.sum())
    return met, of


def _slices(shape: tuple[int, ...]) -> Iterator[slice]:
    """Parts of the first axis."""
    inner = max(1, int(np.prod(shape[1:])))
    rows = max(1, _SLICE // inner)
    for begin in range(0, shape[0], rows):
        yield slice(begin, begin + rows)


def _all_met(file: Any, required: tuple[Constraint, ...], part: slice) -> NDArray[np.bool_]:
    each = []
    for constraint in required:
        values = file[constraint.name][part].astype(np.float64)
        none = missing(constraint.name)
        each.append(
            constraint.met(values if none is None else np.where(values == none, np.nan, values))
        )
    return np.asarray(np.logical_and.reduce(each))

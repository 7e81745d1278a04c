"""How many points or designs meet a specification: counts, and a part with its interval."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.lazy import h5py, stats
from pindrive.study.outputs import from_attribute, missing

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from pindrive.study.outputs import Demand

_CONFIDENCE: Final = 0.95
_SLICE: Final = 1 << 22
"""Points that are read at a time."""


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
    """How many have no number to meet the demand with, such as one that never settles."""

    @property
    def text(self) -> str:
        """The part for a person: "97.482 %", never all nor none by rounding."""
        shown = f"{100.0 * self.met / self.of:.3f}"
        if shown == "100.000" and self.met < self.of:
            return "> 99.999 %"
        return "< 0.001 %" if shown == "0.000" and self.met else f"{shown} %"

    @classmethod
    def of_designs(cls, met: int, of: int, without: int = 0) -> Share:
        """Of so many independent draws of designs that exist, at least 1."""
        interval = stats.binomtest(met, of).proportion_ci(_CONFIDENCE, method="exact")
        return cls(met, of, float(interval.low), float(interval.high), without)


def points_that_meet(path: Path) -> tuple[int, int] | None:
    """How many points meet the specification that the file holds, and of how many that exist.

    None where it holds none.
    """
    with h5py.File(path, "r") as file:
        demanded = from_attribute(str(file.attrs.get("specification", "")))
        if not demanded:
            return None
        met = of = 0
        for part in _slices(file["status"].shape):
            exist = file["status"][part] == 0
            here = exist & _all_met(file, demanded, part)
            met, of = met + int(here.sum()), of + int(exist.sum())
    return met, of


def _slices(shape: tuple[int, ...]) -> Iterator[slice]:
    """Parts of the first axis."""
    inner = max(1, int(np.prod(shape[1:])))
    rows = max(1, _SLICE // inner)
    for begin in range(0, shape[0], rows):
        yield slice(begin, begin + rows)


def _all_met(file: Any, demanded: tuple[Demand, ...], part: slice) -> NDArray[np.bool_]:
    each = []
    for demand in demanded:
        values = file[demand.name][part].astype(np.float64)
        none = missing(demand.name)
        each.append(
            demand.met(values if none is None else np.where(values == none, np.nan, values))
        )
    return np.asarray(np.logical_and.reduce(each))

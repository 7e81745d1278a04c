"""How many points of a study's file meet its specification."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.lazy import h5py
from pindrive.study.outputs import from_attribute, missing

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from pindrive.study.outputs import Demand

_SLICE: Final = 1 << 22
"""Points that are read at a time."""


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

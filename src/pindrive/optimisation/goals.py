"""Data of a design problem: variables, conditions, constraints and goals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pindrive.optimisation.catalogue import Catalogue
from pindrive.quantities.names import label
from pindrive.quantities.value import concise
from pindrive.study.distributions import Distribution, Grid
from pindrive.study.outputs import Constraint
from pindrive.study.study import Study

Array = NDArray[np.float64]


PRICE: Final = "design_price"


YIELD: Final = "design_yield"


SPEED: Final = "design_distinct_speed"


@concise
@dataclass(frozen=True, slots=True)
class Goal:
    """A number that is to be small, or large.

    Attributes:
        name: of the number.
        maximise: whether it is to be large.
    """

    name: str
    maximise: bool

    def minimised(self, values: Array) -> Array:
        """Values (SI) so that the best is the least; infinite where there is none."""
        return np.where(np.isnan(values), np.inf, -values if self.maximise else values)

    def text(self) -> str:
        """For display: "minimise settling_time"."""
        return f"{'maximise' if self.maximise else 'minimise'} {label(self.name)}"


@concise
@dataclass(frozen=True, slots=True)
class Variable:
    """Variable or condition: one key over a range, or keys with rows of values.

    Attributes:
        name: the first of its keys, or that of its catalogue.
        axes: how each of its keys is written.
        choices: how many rows there are; 0 for a range.
        catalogue: of which the rows are the parts.
    """

    name: str
    axes: Mapping[str, Grid | Distribution]
    choices: int = 0
    catalogue: Catalogue | None = None

    def index(self, parts: Array) -> NDArray[np.int64]:
        """The rows that parts from 0 to 1 stand for."""
        return np.clip((parts * self.choices).astype(np.int64), 0, self.choices - 1)

    def columns(self, parts: Array) -> dict[str, Array]:
        """The values of its keys, SI, at parts from 0 to 1."""
        return {
            key: axis.ppf(parts) if isinstance(axis, Distribution) else axis.at(self.index(parts))
            for key, axis in self.axes.items()
        }

    def part(self, row: int) -> float:
        """The part that stands for a row."""
        return (row + 0.5) / self.choices


class Asked(NamedTuple):
    """A device whose speed is to be found.

    Attributes:
        at: the values of keys, SI.
        near: where its speed may be, m/s; NaN: anywhere.
        beat: the speed, m/s, below which its own matters little; NaN: there is none.
        confirmed: whether all speeds of the grid below its own are tried too.
    """

    at: Mapping[str, float]
    near: float = nan
    beat: float = nan
    confirmed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignProblem:
    """Design problem.

    Attributes:
        study: the device, what follows what, and the page; its axes are variables and conditions.
        tables: as they were written.
        variables: what may be chosen.
        conditions: under which each constraint must be met, and each goal counts by its worst.
        constraints: limits on numbers.
        least_yield: the part of the devices built within the tolerances that must meet them all;
            None: none is required.
        goals: one to three, the first the most important.
        catalogues: whose parts are chosen.
    """

    study: Study
    tables: Mapping[str, Any]
    variables: tuple[Variable, ...]
    conditions: tuple[Variable, ...]
    constraints: tuple[Constraint, ...]
    least_yield: float | None
    goals: tuple[Goal, ...]
    catalogues: tuple[Catalogue, ...]

    @property
    def inputs(self) -> tuple[Path, ...]:
        """The files that it was read from."""
        return (*self.study.inputs, *(catalogue.path for catalogue in self.catalogues))

    def __repr__(self) -> str:
        """Return the variables and goals in a line."""
        what = ", ".join(variable.name for variable in self.variables)
        return f"<DesignProblem {' and '.join(goal.text() for goal in self.goals)} over {what}>"

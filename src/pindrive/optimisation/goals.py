"""Data of a design problem: variables, conditions, goals, and margins of its designs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import log, nan
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pindrive.optimisation.catalogue import Catalogue
from pindrive.quantities.names import label
from pindrive.quantities.value import concise, equal_by_value
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
        name: Name of the number.
        maximise: True to maximise the number.
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
        name: The first of its keys, or that of its catalogue.
        axes: Notation of each key.
        choices: Number of rows; 0 for a range.
        catalogue: Catalogue whose parts are the rows.
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

    def place(self, value: float) -> float:
        """The part of a range that stands for a value of its key, SI."""
        (axis,) = self.axes.values()
        assert isinstance(axis, Distribution)
        if axis.kind == "loguniform":
            return log(value / axis.first) / log(axis.second / axis.first)
        return (value - axis.first) / (axis.second - axis.first)

    def part(self, row: int) -> float:
        """The part that stands for a row."""
        return (row + 0.5) / self.choices


class SpeedRequest(NamedTuple):
    """A device whose speed is to be found.

    Attributes:
        at: The values of keys, SI.
        near: Estimate of the speed, m/s; NaN: unknown.
        beat: The speed, m/s, below which its own matters little; NaN: there is none.
        confirmed: True to also evaluate all speeds of the grid below the speed.
    """

    at: Mapping[str, float]
    near: float = nan
    beat: float = nan
    confirmed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignProblem:
    """Design problem.

    Attributes:
        study: The device, what follows what, and the page; its axes are variables and conditions.
        tables: Tables as written.
        variables: Design variables.
        conditions: Conditions at which each constraint must be met; each goal counts by its worst.
        constraints: Limits on numbers.
        least_yield: The part of the devices built within the tolerances that must meet them all;
            None: none is required.
        goals: One to three goals, the most important first.
        catalogues: Catalogues of the parts.
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


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Limit:
    """End of the way of a variable from a design.

    Attributes:
        value: Value of the first key, SI: the last one at which all is well.
        number: Goal or constraint that ends the way; None: the end of the range.
        reached: The number just beyond, SI; NaN for a missing number.
        jumps: True if the number changes abruptly there.
    """

    value: float
    number: Goal | Constraint | None
    reached: float
    jumps: bool


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Margin:
    """How far a variable may move until a goal is 5 % worse or a constraint is violated.

    Attributes:
        variable: Variable with a range; all others stay as they are.
        value: Value of its first key in the design, SI.
        below: End of the way to smaller values.
        above: End of the way to larger values.
    """

    variable: Variable
    value: float
    below: Limit
    above: Limit

    @property
    def part(self) -> float:
        """The smaller of both ways, a part of the value; ends of the range do not count."""
        ways = [abs(e.value - self.value) for e in (self.below, self.above) if e.number is not None]
        return min(ways, default=np.inf) / abs(self.value) if self.value else np.inf

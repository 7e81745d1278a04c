"""Results of `optimise`: the design, its binding constraints, the front, and its neighbourhood."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import combinations
from math import isfinite, nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.files.device import DeviceFile
from pindrive.files.device_text import device_text
from pindrive.files.keys import NUMERIC_KEYS, variable
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.motion import Motion
from pindrive.motion.simulate import motion_of
from pindrive.optimisation.effort import Count
from pindrive.optimisation.goals import DesignProblem, Goal, Margin, Variable
from pindrive.quantities.names import label
from pindrive.quantities.status import Status
from pindrive.quantities.value import concise, equal_by_value
from pindrive.study.distributions import with_links
from pindrive.study.outputs import NUMBERS, Constraint, Share, attributes
from pindrive.views import NotebookHtml, figure

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

__all__ = ["Alternative", "ConstraintResult", "Design", "Front", "Map", "Reached"]

Array = NDArray[np.float64]


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Reached:
    """A goal, and how far the design reaches it.

    Attributes:
        goal: Number with its direction.
        value: Value at the worst condition, SI; NaN for a missing value.
        case: Worst condition, SI by key; empty without conditions.
    """

    goal: Goal
    value: float
    case: Mapping[str, float]


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class ConstraintResult:
    """A constraint, and how the design meets it.

    Attributes:
        constraint: Limit on a number.
        value: Value at the worst condition, SI.
        case: Worst condition, SI by key.
        relaxed: The limit, SI, at which the first goal improves by `Design.gain` while all other
            constraints remain unchanged; NaN: no such limit was found, or none was searched for.
    """

    constraint: Constraint
    value: float
    case: Mapping[str, float]
    relaxed: float = nan

    @property
    def excess(self) -> float:
        """Violation of the limit, SI; negative: the margin to the limit."""
        return float(self.constraint.excess(np.array([self.value]))[0])

    @property
    def binds(self) -> bool:
        """True if another limit would improve the goal."""
        return isfinite(self.relaxed) and self.relaxed != self.constraint.limit


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Alternative:
    """Another part of a catalogue in place of the chosen one, everything else unchanged.

    Attributes:
        catalogue: Name of the catalogue.
        part: Number of the part.
        values: Values that the part sets, SI by key.
        price: NaN where there is none.
        goals: Goals of the design with this part, SI.
        violations: The violated constraints, each with its excess, SI.
    """

    catalogue: str
    part: str
    values: Mapping[str, float]
    price: float
    goals: tuple[float, ...]
    violations: tuple[tuple[Constraint, float], ...]


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Front:
    """Designs of which none is better than another in all goals.

    Attributes:
        columns: The value of each key, SI, shape (n,).
        goals: SI, shape (n, goals).
        chosen: Index of the design.
    """

    columns: Mapping[str, Array]
    goals: Array
    chosen: int


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Map:
    """The first goal over two variables, all others as the design has them.

    Attributes:
        variables: Variables along the abscissa and the ordinate.
        along: The values of the first key of each, SI.
        goal: Shape (y, x); NaN where there is none.
        met: True if all constraints are met, shape (y, x).
        design: The values of the design.
    """

    variables: tuple[Variable, Variable]
    along: tuple[Array, Array]
    goal: Array
    met: NDArray[np.bool_]
    design: tuple[float, float]

    @property
    def keys(self) -> tuple[str, str]:
        """The first key of each variable."""
        one, other = (next(iter(v.axes)) for v in self.variables)
        return one, other

    @property
    def share(self) -> float:
        """Part of the map in which all constraints are met."""
        return float(self.met.mean())


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class SteadyDesign:
    """Design that meets all constraints wherever its variables are within a margin.

    Attributes:
        margin: Part of its value by which each variable with a range may move.
        values: Every key that may vary, SI.
        parts: The part chosen from each catalogue.
        device: Device file of the design.
        goals: Goals at the worst place within the margin, SI.
    """

    margin: float
    values: Mapping[str, float]
    parts: Mapping[str, str]
    device: DeviceFile
    goals: tuple[float, ...]


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Design(NotebookHtml):
    """Result of `optimise`.

    Attributes:
        problem: Design problem.
        device: The device file of the best design; of the closest where none meets the constraints.
        values: Every key that may vary, SI.
        parts: The part chosen from each catalogue.
        feasible: True if the design meets all constraints at all conditions.
        goals: Goals in the order of the design problem.
        constraints: Constraints in the order of the design problem.
        front: Pareto front, with two or three goals.
        maps: Maps of the feasible region around the design.
        alternatives: The nearest parts of each catalogue.
        margins: Ends of the way of each variable with a range, all others unchanged; empty of
            scans, and where no design meets the constraints.
        steady: The best design whose variables may all move by a margin; None where the design has
            that margin itself, or where none was found.
        built: The part of the designs built within the tolerances that meets all constraints; None
            where there are no tolerances.
        gain: The part by which the first goal gets better where a constraint is relaxed.
        at_ends: Variables at an end of their range.
        count: Counter of the simulations.
        seed: Seed of all draws.
        warnings: Warnings about the result.
    """

    problem: DesignProblem
    device: DeviceFile
    values: Mapping[str, float]
    parts: Mapping[str, str]
    feasible: bool
    goals: tuple[Reached, ...]
    constraints: tuple[ConstraintResult, ...]
    front: Front | None
    maps: tuple[Map, ...]
    alternatives: tuple[Alternative, ...]
    margins: tuple[Margin, ...]
    steady: SteadyDesign | None
    built: Share | None
    gain: float
    at_ends: tuple[tuple[str, str], ...]
    count: Count
    seed: int
    warnings: tuple[str, ...] = field(default=())

    def __repr__(self) -> str:
        """The goals of the design, or its violations, in a line."""
        if not self.feasible:
            return f"<No design: {self.closest}, {self.status.name}>"
        reached = ", ".join(
            f"{label(r.goal.name)} {shown(r.goal.name, r.value)}" for r in self.goals
        )
        name = self.device.name or self.device.path.name
        return f"<Design of {name}: {reached}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where no design meets the constraints, or where `warnings` says so."""
        return Status.ok if self.feasible and not self.warnings else Status.incomplete

    @property
    def closest(self) -> str:
        """Constraints violated by the closest design, with their excess; empty if feasible."""
        violated = [d for d in self.constraints if d.excess > 0.0]
        if not violated:
            least = self.problem.least_yield
            if self.feasible or not (self.built and least):
                return "" if self.feasible else "no design has the numbers of the goals"
            return f"the closest has a yield of {self.built.text}, not {100.0 * least:g} %"
        return "the closest violates " + " and ".join(
            f"{d.constraint.text()} by {shown(d.constraint.name, d.excess)}"
            if isfinite(d.excess)
            else f"{d.constraint.text()}: it has no such number"
            for d in violated
        )

    @cached_property
    def motion(self) -> Motion | None:
        """The transient at the worst condition of the first goal; None of a scan."""
        if self.problem.study.page:
            return None
        study = self.problem.study
        at = {key: np.asarray(x) for key, x in (*self.values.items(), *self.goals[0].case.items())}
        found = with_links(study.device, at, study.links)
        return motion_of(study.device_at({key: float(x) for key, x in found.items()}))

    def plot(self) -> mpl_figure.Figure:
        """The front, and the maps of the feasible region around the design, as a figure."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """Return the whole result as data.

        Returns:
            The varied keys and the goals of the design, SI; over `limit` the value, the excess and
            the relaxed limit of each constraint; over `margin`, by the first key of a variable, the
            values between which nothing changes; over `front` the keys and goals of the front; over
            the axes of each map its goal and whether the constraints are met.
        """
        data: dict[str, Any] = {
            variable(key): ((), value, NUMERIC_KEYS[key].attributes)
            for key, value in self.values.items()
        }
        for reached in self.goals:
            data[reached.goal.name] = ((), reached.value, attributes(reached.goal.name))
        data["feasible"] = ((), self.feasible, {"long_name": "whether all constraints are met"})
        if self.built:
            words = {
                "units": "1",
                "long_name": "part of the designs built that meets all constraints",
            }
            data["yield"] = ((), self.built.met / self.built.of, words)
            data["yield_low"] = ((), self.built.low, {"units": "1"})
            data["yield_high"] = ((), self.built.high, {"units": "1"})
        for name, values in (
            ("value", [d.value for d in self.constraints]),
            ("excess", [d.excess for d in self.constraints]),
            ("relaxed", [d.relaxed for d in self.constraints]),
        ):
            data[f"limit_{name}"] = ("limit", np.array(values, np.float64))
        for side in ("below", "above"):
            ends = [getattr(margin, side).value for margin in self.margins]
            data[f"margin_{side}"] = ("margin", np.array(ends, np.float64))
        if self.front:
            for key, column in self.front.columns.items():
                data[f"front_{variable(key)}"] = ("front", column, NUMERIC_KEYS[key].attributes)
            for reached, column in zip(self.goals, self.front.goals.T, strict=True):
                name = reached.goal.name
                data[f"front_{name}"] = ("front", column, attributes(name))
        for i, drawn in enumerate(self.maps):
            dims = (f"map_{i}_y", f"map_{i}_x")
            goal = self.goals[0].goal.name
            data[f"map_{i}_goal"] = (dims, drawn.goal, attributes(goal))
            data[f"map_{i}_met"] = (dims, drawn.met)
            for dim, key, along in zip(reversed(dims), drawn.keys, drawn.along, strict=True):
                data[dim] = (dim, along, {**NUMERIC_KEYS[key].attributes, "key": key})
        coords = {
            "margin": [next(iter(margin.variable.axes)) for margin in self.margins],
            "limit": [d.constraint.text() for d in self.constraints],
            "limit_unit": ("limit", [NUMBERS[d.constraint.name].unit for d in self.constraints]),
        }
        attrs = {
            "title": f"Design of {self.problem.study.name or 'a device'}",
            "status": self.status.name,
            "seed": self.seed,
            "parts": ", ".join(f"{name} {part}" for name, part in self.parts.items()),
        }
        return xr.Dataset(data, coords=coords, attrs=attrs)


def shown(name: str, value: float) -> str:
    """A number of a motion, a scan or a design for display: "12.34 ms"."""
    return NUMBERS[name].text(value)


def designed_file(found: Design, target: Path) -> str:
    """The text of a device file.

    Args:
        found: The design.
        target: File of the text; paths in the text are relative to its folder.
    """
    head = [
        "Designed by pindrive.",
        f"Problem: {found.problem.study.path.name}, {found.problem.study.name}; seed {found.seed}.",
    ]
    if not found.feasible:
        head.append(f"No design meets the constraints; {found.closest}.")
    head += [
        f"{reached.goal.text()}: {shown(reached.goal.name, reached.value)}"
        for reached in found.goals
    ]
    head += [f"part {name}: {part}" for name, part in found.parts.items()]
    head += [
        f"{required.constraint.text()}: {label(required.constraint.name)} is "
        f"{shown(required.constraint.name, required.value)} at worst"
        for required in found.constraints
    ]
    comments = {key: ["chosen by the design"] for v in found.problem.variables for key in v.axes}
    return device_text(found.device, {}, target, [*head, *found.warnings], comments)


# ---- neighbourhood of a design -------------------------------------------------------------------

MAPPED: Final = 3
"""Variables of which each pair is drawn; of scans two."""
NEAREST: Final = 5
"""Parts that are compared with the chosen one."""
_END: Final = 2e-3
"""Part of a range that is its end."""


def maps(space: DesignSpace, point: Array, resolution: int) -> tuple[Map, ...]:
    """The first goal, and where all constraints are met, over pairs of variables.

    Args:
        space: Space of the designs.
        point: The design, which is one of the places.
        resolution: Places along an axis that is a range; 0: no map.
    """
    if not resolution:
        return ()
    space = replace(space, coarse=True)
    found = []
    count = 2 if space.scans else MAPPED
    for i, j in combinations(range(min(count, len(point))), 2):
        one, other = space.variables[i], space.variables[j]
        x, y = (_parts(v, resolution, float(point[k])) for v, k in ((one, i), (other, j)))
        across, up = np.meshgrid(x, y)
        points = np.tile(point, (across.size, 1))
        points[:, i], points[:, j] = across.ravel(), up.ravel()
        goals, violation = space(points)
        first = goals[:, 0].reshape(across.shape)
        first = np.where(np.isinf(first), np.nan, first)
        along = tuple(_first(v, parts) for v, parts in ((one, x), (other, y)))
        here = tuple(float(_first(v, point[[k]])[0]) for v, k in ((one, i), (other, j)))
        found.append(
            Map(
                (one, other),
                (along[0], along[1]),
                -first if space.goals[0].maximise else first,
                (violation <= 0.0).reshape(across.shape),
                (here[0], here[1]),
            )
        )
    return tuple(found)


def _parts(variable: Variable, resolution: int, chosen: float) -> Array:
    """Return the map's values of a variable; the design replaces the nearest one."""
    if not variable.choices:
        parts = np.linspace(0.0, 1.0, resolution)
        parts[np.abs(parts - chosen).argmin()] = chosen
        return parts
    row = variable.index(np.array([chosen]))[0]
    rows = np.linspace(0, variable.choices - 1, min(variable.choices, resolution)).round()
    rows[np.abs(rows - row).argmin()] = row
    return (np.unique(rows) + 0.5) / variable.choices


def _first(variable: Variable, parts: Array) -> Array:
    """The values of its first key."""
    return next(iter(variable.columns(parts).values()))


def alternatives(space: DesignSpace, point: Array) -> tuple[Alternative, ...]:
    """The design with other parts of its catalogues, the nearest by their values first."""
    found = []
    for i, varied in enumerate(space.variables):
        catalogue = varied.catalogue
        if catalogue is None:
            continue
        chosen = int(varied.index(point[[i]])[0])
        rows = catalogue.nearest(chosen, NEAREST)
        if not rows:
            continue
        points = np.tile(point, (len(rows), 1))
        points[:, i] = [varied.part(row) for row in rows]
        numbers = space.numbers(points)
        excess = space.excess(numbers).max(axis=2)
        goals = space.minimised(numbers).max(axis=2)
        for place, row in enumerate(rows):
            violations = [
                (constraint, float(over))
                for constraint, over in zip(space.constraints, excess[:, place], strict=True)
                if over > 0.0
            ]
            found.append(
                Alternative(
                    catalogue.name,
                    catalogue.parts[row],
                    {key: values[row] for key, values in catalogue.values.items()},
                    catalogue.prices[row],
                    tuple(
                        float(-value if goal.maximise else value)
                        for goal, value in zip(space.goals, goals[:, place], strict=True)
                    ),
                    tuple(violations),
                )
            )
    return tuple(found)


def at_ends(space: DesignSpace, point: Array) -> tuple[tuple[str, str], ...]:
    """The variables that a design has at an end of their range, and which end."""
    return tuple(
        (variable.name, "lower" if part < 0.5 else "upper")
        for variable, part in zip(space.variables, point, strict=True)
        if not variable.choices and not _END < part < 1.0 - _END
    )

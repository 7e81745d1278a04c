"""Which parameter matters, near the device's values and over the study's ranges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive import lazy
from pindrive.lazy import xr
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.status import Status
from pindrive.study.design import COUNTS
from pindrive.study.distributions import Distribution, Linked, as_distribution, with_links
from pindrive.study.evaluate import evaluate
from pindrive.study.local_sensitivity import Elasticities, elasticities
from pindrive.study.outputs import LEDGER, MEASURED, SCAN_MEASURED, known_output
from pindrive.study.refusals import RefusedPoints, exist, refusals
from pindrive.study.sobol import Indices, sobol_indices

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from pindrive.device.scanning import Progress
    from pindrive.study.design import Columns, Plan

_SETTLED: Final = "transient_settled"
USUAL_ROWS: Final = 8192
USUAL_ROWS_OF_SCANS: Final = 256
"""A scan takes some ten thousand times as long as a release."""


@dataclass(frozen=True, slots=True)
class Ranges:
    """What varies in a study, and how."""

    scatter: Mapping[str, Distribution]
    fixed: Mapping[str, float]
    """Keys of a single value."""
    links: Mapping[str, Linked]

    def columns(self, plan: Plan, points: NDArray[np.float64]) -> Columns:
        """Values of all keys at points (keys of `scatter`, n)."""
        given = dict(zip(self.scatter, points, strict=True))
        given |= {k: np.full(points.shape[1], v) for k, v in self.fixed.items()}
        return with_links(plan.device, given, self.links)


def ranges_of(plan: Plan, tolerances: bool) -> Ranges:
    """The ranges of the axes, or the tolerances; these too where there are no axes.

    Raises:
        ValueError: nothing varies, or a count does, or there are no tolerances.
    """
    if tolerances and not plan.tolerances:
        raise ValueError(f"{plan.path}: has no tolerances; write them in [tolerances]")
    scatter: dict[str, Distribution] = {}
    fixed: dict[str, float] = {}
    of_axes = [k for k, axis in plan.axes.items() if not isinstance(axis, Linked)]
    if plan.tolerances and (tolerances or not of_axes):
        return Ranges(plan.tolerances, {}, plan.tolerance_links)
    for key, axis in plan.axes.items():
        if isinstance(axis, Linked):
            continue
        low, high = axis.span
        if low < high and key in COUNTS:
            raise ValueError(
                f"{plan.path}: axes.{key} counts pins, and there is nothing between two counts to "
                "draw; give one value"
            )
        if low < high:
            scatter[key] = as_distribution(axis)
        else:
            fixed[key] = low
    if not scatter:
        raise ValueError(f"{plan.path}: nothing varies; write what in [axes] or [tolerances]")
    return Ranges(scatter, fixed, plan.links)


@dataclass(frozen=True, slots=True, repr=False)
class Influence(lazy.NotebookHtml):
    """Which key matters to which number: Sobol' indices, and elasticities beside them if wanted."""

    keys: tuple[str, ...]
    ranges: Ranges
    near: Elasticities | None
    """None where they were not requested, and of scans, which have no exact derivatives."""
    over: Mapping[str, Indices]
    rows: int
    points: int
    refusals: tuple[RefusedPoints, ...]
    """Points that cannot exist, as their values contradict each other; left out."""
    name: str = ""
    """Of the study."""

    def __repr__(self) -> str:
        """Of how many numbers and keys, from how many points, in a line."""
        numbers, keys = counted(len(self.over), "number"), counted(len(self.keys), "key")
        points = counted(self.points, "point")
        return f"<Sobol' indices of {numbers} over {keys}, {points}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where points cannot exist and were left out; `refusals` says why."""
        return Status.incomplete if self.refusals else Status.ok

    def plot(self) -> Figure:
        """The indices as bars, numbers down and keys across, as a figure that a notebook shows."""
        figure: Figure = lazy.call("pindrive.plot.sensitivity:plot_influence", self, self.name)
        return figure

    def to_dataset(self) -> xr.Dataset:
        """The indices with their 95 % confidence intervals.

        Returns:
            Variables over (number, key): `first_order` and `total`, and the ends of their intervals
            as `first_order_low`, `first_order_high`, `total_low` and `total_high`; NaN where a
            number is constant or exists too rarely. Over `number`: `spread`, its standard deviation
            in SI, and `kept`, the part of the rows in which it exists.
        """
        numbers = [*self.over]
        data: dict[str, Any] = {}
        for part, order in (("first", "first_order"), ("total", "total")):
            for field, end in (("value", ""), ("low", "_low"), ("high", "_high")):
                rows = [getattr(getattr(self.over[n], part), field) for n in numbers]
                data[f"{order}{end}"] = (("number", "key"), np.array(rows), {"units": "1"})
        data["spread"] = ("number", np.array([self.over[n].spread for n in numbers]))
        data["kept"] = ("number", np.array([self.over[n].kept for n in numbers]), {"units": "1"})
        coords = {"number": numbers, "key": [*self.keys]}
        title = {"title": f"Sobol' indices of {self.name}"} if self.name else {}
        return xr.Dataset(data, coords=coords, attrs={**title, "status": self.status.name})


def askable(plan: Plan) -> tuple[str, ...]:
    """The variables whose sensitivity can be computed."""
    return SCAN_MEASURED if plan.page else (*MEASURED, _SETTLED)


def sobol(
    study: Plan,
    *,
    tolerances: bool = False,
    numbers: Sequence[str] = (),
    rows: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = lambda done, total: None,
) -> Influence:
    """Which key matters over the ranges of a study: Sobol' indices of first order and total.

    The estimators are those of Saltelli et al. 2010, 10.1016/j.cpc.2009.09.018, the intervals a
    bootstrap over the rows.

    Args:
        study: whose axes are the ranges; each key is drawn independently of the others.
        tolerances: over the study's tolerances instead of its axes.
        numbers: the numbers to analyse, as "settling_time"; all that exist unless given, of
            the energy ledger those that the study names in its outputs.
        rows: of the design, a power of 2, at least 128, of (keys + 2) points each; 8192 unless
            given, of scans 256.
        seed: of the sequence and the bootstrap.
        threads: how many work; as many as there are cores unless given.
        progress: called with the points done and the points in all.

    Returns:
        The indices; `to_dataset` and `plot` give them as data and as a figure.

    Raises:
        ValueError: nothing varies, a number is unknown, or `rows` is no power of 2 or too large.

    Examples:
        >>> import pindrive as pd
        >>> study = pd.Study(
        ...     pd.load_device("tactile-mouse.toml"),
        ...     tolerances={"mass": "5 %", "drive.stiffness": "10 %"},
        ... )
        >>> found = pd.sobol(study, numbers=["settling_time"], rows=128)
        >>> found
        <Sobol' indices of 1 number over 2 keys, 512 points, ok>
        >>> found.to_dataset().total.dims
        ('number', 'key')
    """
    plan = study
    among = askable(plan)
    numbers = [known_output(name, "numbers", among) for name in numbers]
    ranges = ranges_of(plan, tolerances)
    keys = tuple(ranges.scatter)
    usual = (name for name in askable(plan) if name not in LEDGER or name in plan.outputs)
    asked = tuple(dict.fromkeys(numbers)) or tuple(usual)
    outputs = (*asked, "status", "reason")
    if rows is None:
        rows = USUAL_ROWS_OF_SCANS if plan.page else USUAL_ROWS
    varied = len(keys)
    each = (varied + 2) * (varied + len(outputs)) + 3 * (varied + 1) * len(outputs)
    of = f"{rows} rows of {each}, for {varied} keys and {len(outputs)} results"
    budgets.DESIGN_VALUES.check(rows * each, of)
    refused: tuple[RefusedPoints, ...] = ()

    def function(points: NDArray[np.float64]) -> dict[str, Any]:
        nonlocal refused
        total = points.shape[1]
        parts = []
        for begin in range(0, total, plan.at_a_time):
            part = points[:, begin : begin + plan.at_a_time]
            columns = ranges.columns(plan, part)
            parts.append(evaluate(plan, columns, part.shape[1], outputs, threads))
            progress(min(begin + plan.at_a_time, total), total)
        found = {name: np.concatenate([part[name] for part in parts]) for name in outputs}
        refused = refusals(plan, ranges.columns(plan, points), found.pop("reason"))
        designs = exist(found.pop("status"))
        if _SETTLED in found:
            found[_SETTLED] = np.where(designs, found[_SETTLED].astype(float), np.nan)
        return found

    over = sobol_indices(function, [*ranges.scatter.values()], rows, seed)
    points = rows * (len(keys) + 2)
    return Influence(keys, ranges, None, over, rows, points, refused, plan.name)


def local_sensitivity(study: Plan, *, tolerances: bool = False) -> Elasticities:
    """By how many per cent each number changes where a key of a study grows by one per cent.

    Exact derivatives at the device's own values, by dual numbers through every event.

    Args:
        study: of releases; its axes say the keys.
        tolerances: the keys of its tolerances instead.

    Returns:
        The elasticities, NaN where one does not exist, with the reason of a key that has none.

    Raises:
        ValueError: the study is one of scans, which have no exact derivatives, or nothing varies.

    Examples:
        >>> import pindrive as pd
        >>> study = pd.Study(
        ...     pd.load_device("tactile-mouse.toml"), axes={"drive.stiffness": [90.0, 110.0]}
        ... )
        >>> near = pd.local_sensitivity(study)
        >>> round(near.table["transient_swing"]["drive.stiffness"], 3)
        0.097
    """
    if study.page:
        raise ValueError(f"{study.path}: a study of scans has no exact derivatives; sobol takes it")
    ranges = ranges_of(study, tolerances)
    return elasticities(study, tuple(ranges.scatter), ranges.links)


def influence(
    plan: Plan,
    *,
    tolerances: bool = False,
    numbers: Sequence[str] = (),
    rows: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = lambda done, total: None,
) -> Influence:
    """Sobol' indices as `sobol` finds them, with elasticities beside them where there are any."""
    found = sobol(
        plan,
        tolerances=tolerances,
        numbers=numbers,
        rows=rows,
        seed=seed,
        threads=threads,
        progress=progress,
    )
    near = None if plan.page else local_sensitivity(plan, tolerances=tolerances)
    return replace(found, near=near)

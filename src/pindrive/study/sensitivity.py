"""Which parameter matters, near the device's values and over the study's ranges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.quantities import budgets
from pindrive.study.design import COUNTS
from pindrive.study.distributions import Distribution, Linked, as_distribution, with_links
from pindrive.study.evaluate import evaluate
from pindrive.study.local_sensitivity import Elasticities, elasticities
from pindrive.study.outputs import LEDGER, MEASURED, SCAN_MEASURED
from pindrive.study.refusals import Refusal, exist, refusals
from pindrive.study.sobol import Indices, sobol_indices

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

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


@dataclass(frozen=True, slots=True)
class Influence:
    """Local and global sensitivity of every number to every key."""

    keys: tuple[str, ...]
    ranges: Ranges
    near: Elasticities | None
    """None of scans, which have no exact derivatives."""
    over: Mapping[str, Indices]
    rows: int
    points: int
    refusals: tuple[Refusal, ...]
    """Points that cannot exist, as their values contradict each other; left out."""


def askable(plan: Plan) -> tuple[str, ...]:
    """The variables whose sensitivity can be computed."""
    return SCAN_MEASURED if plan.page else (*MEASURED, _SETTLED)


def influence(
    plan: Plan,
    *,
    tolerances: bool = False,
    numbers: Sequence[str] = (),
    rows: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    tell: Progress = lambda done, total: None,
) -> Influence:
    """Elasticities at the device's values and Sobol' indices over the ranges of a study.

    Args:
        plan: the study.
        tolerances: over [tolerances] instead of [axes].
        numbers: the variables to analyse; all that exist unless given, of the energy ledger
            those that the study names in its outputs.
        rows: of the design, a power of 2, at least 128; 8192 unless given, of scans 256.
        seed: of the sequence and the bootstrap.
        threads: all cores unless given.
        tell: called with the points done and the points in all.

    Raises:
        ValueError: nothing varies, or `rows` is no power of 2 or too large.
    """
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
    refused: tuple[Refusal, ...] = ()

    def function(points: NDArray[np.float64]) -> dict[str, Any]:
        nonlocal refused
        total = points.shape[1]
        parts = []
        for begin in range(0, total, plan.at_a_time):
            part = points[:, begin : begin + plan.at_a_time]
            columns = ranges.columns(plan, part)
            parts.append(evaluate(plan, columns, part.shape[1], outputs, threads))
            tell(min(begin + plan.at_a_time, total), total)
        found = {name: np.concatenate([part[name] for part in parts]) for name in outputs}
        refused = refusals(plan, ranges.columns(plan, points), found.pop("reason"))
        designs = exist(found.pop("status"))
        if _SETTLED in found:
            found[_SETTLED] = np.where(designs, found[_SETTLED].astype(float), np.nan)
        return found

    over = sobol_indices(function, [*ranges.scatter.values()], rows, seed)
    near = None if plan.page else elasticities(plan, keys, ranges.links)
    return Influence(keys, ranges, near, over, rows, rows * (len(keys) + 2), refused)

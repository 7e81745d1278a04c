"""Which parameter matters, near the device's values and over the study's ranges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive import budgets
from pindrive.study.axis import Distribution, Linked, as_distribution
from pindrive.study.evaluate import evaluate
from pindrive.study.indices import Indices, sobol_indices
from pindrive.study.local import Elasticities, elasticities
from pindrive.study.outputs import LEDGER, MEASURED, SCAN_OUTPUTS
from pindrive.study.plan import COUNTS, with_links

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from pindrive.study.plan import Columns, Plan

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
    """The ranges of the axes, or the tolerances; the other where one is missing.

    Raises:
        ValueError: nothing varies, or a count does.
    """
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
    count: int
    points: int
    refused: int
    """Points without a motion, or a scan."""


def influence(
    plan: Plan,
    *,
    tolerances: bool = False,
    count: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    tell: Callable[[int, int], None] = lambda done, total: None,
) -> Influence:
    """Elasticities at the device's values and Sobol' indices over the ranges of a study.

    Args:
        plan: the study.
        tolerances: over [tolerances] instead of [axes].
        count: rows of the design, a power of 2; 8192 unless given, of scans 256.
        seed: of the sequence and the bootstrap.
        threads: all cores unless given.
        tell: called with the points done and the points in all.

    Raises:
        ValueError: nothing varies, or `count` is no power of 2 or too large.
    """
    ranges = ranges_of(plan, tolerances)
    keys = tuple(ranges.scatter)
    measured = (name for name in MEASURED if name not in LEDGER or name in plan.outputs)
    outputs = SCAN_OUTPUTS if plan.page else (*measured, "transient_settled", "status")
    if count is None:
        count = USUAL_ROWS_OF_SCANS if plan.page else USUAL_ROWS
    varied = len(keys)
    each = (varied + 2) * (varied + len(outputs)) + 3 * (varied + 1) * len(outputs)
    of = f"{count} rows of {each}, for {varied} keys and {len(outputs)} results"
    budgets.DESIGN_VALUES.check(count * each, of)
    refused = 0

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
        bad = found.pop("status") != 0
        refused = int(bad.sum())
        if "transient_settled" in found:
            settled = found["transient_settled"].astype(float)
            found["transient_settled"] = np.where(bad, np.nan, settled)
        return found

    over = sobol_indices(function, [*ranges.scatter.values()], count, seed)
    near = None if plan.page else elasticities(plan, keys, ranges.links)
    return Influence(keys, ranges, near, over, count, count * (len(keys) + 2), refused)

"""Points of a study that cannot exist, as their values contradict each other: which, and why."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.files.device import motion_of
from pindrive.quantities.status import Status
from pindrive.quantities.table import Refusal, told_by
from pindrive.study.design import device_at
from pindrive.study.scans import judged_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from pindrive.study.design import Columns, Plan

_LONG_NUMBER: Final = re.compile(r"\d+\.\d{6,}(e[-+]?\d+)?")


@dataclass(frozen=True, slots=True)
class RefusedPoints:
    """Points that cannot exist for one reason."""

    count: int
    reason: str
    """In the words, and with the values, of the first of them."""


def exist(status: NDArray[Any]) -> NDArray[np.bool_]:
    """Which points have a motion or a scan, by their `status`; it may have been stopped early."""
    return np.asarray(status < Status.refused)


def refusals(plan: Plan, columns: Columns, reasons: NDArray[Any]) -> tuple[RefusedPoints, ...]:
    """The points that cannot exist, by reason, most first.

    Args:
        plan: the study.
        columns: the values of the varied keys at the points, SI.
        reasons: of each point what is refused, as `evaluate` gives it; empty where it exists.
    """
    alike: dict[str, list[int]] = {}
    for i in np.flatnonzero(reasons != ""):
        alike.setdefault(str(reasons[i]), []).append(int(i))
    found = []
    for reason, points in alike.items():
        first = points[0]
        at = {key: float(np.broadcast_to(x, reasons.shape)[first]) for key, x in columns.items()}
        found.append(RefusedPoints(len(points), why(plan, at) or reason))
    return tuple(sorted(found, key=lambda refusal: -refusal.count))


def why(plan: Plan, at: Mapping[str, float]) -> str:
    """Why there is no motion or scan at a point, which the keys' values (SI) say; empty: it is."""
    try:
        if plan.page:
            judged_at(plan, at)
        else:
            motion_of(device_at(plan, at))
    except (ValueError, ArithmeticError, MemoryError) as error:
        told = told_by(error)
        said = told.said if isinstance(told, Refusal) else told
        return _LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", said)
    return ""

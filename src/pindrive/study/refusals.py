"""Points of a study that cannot exist, as their values contradict each other: which, and why."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.files.device import motion_of
from pindrive.study.design import device_at, flags
from pindrive.study.scans import judged_at

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from pindrive.study.design import Columns, Plan

_EXIST: Final = ("ok", "too_many_events", "standstill")
_LONG_NUMBER: Final = re.compile(r"\d+\.\d{6,}(e[-+]?\d+)?")
_NUMBER: Final = re.compile(r"[-+]?\d+(\.\d*)?(e[-+]?\d+)?")


@dataclass(frozen=True, slots=True)
class Refusal:
    """Points that cannot exist for one reason."""

    count: int
    reason: str
    """In the words, and with the values, of the first of them."""


def exist(status: NDArray[Any]) -> NDArray[np.bool_]:
    """Which points have a motion or a scan, by their `status`; it may have been stopped early."""
    return np.isin(status, [flags("status").index(name) for name in _EXIST])


def refusals(plan: Plan, columns: Columns, reasons: NDArray[Any]) -> tuple[Refusal, ...]:
    """The points that cannot exist, by reason, most first.

    Args:
        plan: the study.
        columns: the values of the varied keys at the points, SI.
        reasons: of each point, as `evaluate` gives them; empty where it exists.
    """
    alike: dict[str, list[int]] = {}
    for i in np.flatnonzero(reasons != ""):
        alike.setdefault(_NUMBER.sub("", str(reasons[i])), []).append(int(i))
    found = []
    for points in alike.values():
        first = points[0]
        at = {key: float(np.broadcast_to(x, reasons.shape)[first]) for key, x in columns.items()}
        found.append(Refusal(len(points), why(plan, at) or str(reasons[first])))
    return tuple(sorted(found, key=lambda refusal: -refusal.count))


def why(plan: Plan, at: Mapping[str, float]) -> str:
    """Why there is no motion or scan at a point, which the keys' values (SI) say; empty: it is."""
    try:
        if plan.page:
            judged_at(plan, at)
        else:
            motion_of(device_at(plan, at))
    except (ValueError, ArithmeticError, MemoryError) as error:
        said = str(error).splitlines()[0].removeprefix(f"{plan.device.path}: ")
        return _LONG_NUMBER.sub(lambda number: f"{float(number[0]):.6g}", said)
    return ""

"""The numbers of many scans of one device and page, each with other values of its swept keys.

A scan and its judgement are Python's own work, so that several at a time take several processes.
"""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.device.scanning import scan
from pindrive.evaluation.perception import judge
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.table import refused_by
from pindrive.study.design import device_at
from pindrive.study.outputs import SCANNED, scan_numbers, variables
from pindrive.study.workers import standing

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from pindrive.evaluation.results import Judgement
    from pindrive.study.design import Columns, Plan

Row = dict[str, Any]

_PORTION: Final = 8
"""Points that a process takes at a time, at most."""


def judged_at(plan: Plan, at: Mapping[str, float]) -> Judgement:
    """The scan at one point of a study with a page, which the keys' values (SI) say, judged.

    Raises:
        ValueError: there is none: the values do not go together, or a spot leaves the page.
    """
    if plan.page is None:
        raise ValueError(f"{plan.path}: has no page to scan; write what is on it in [page]")
    file = device_at(plan, at)
    assert file.whole
    device, reading = file.whole.device(file.drive), file.whole.reading()
    scene = plan.page.scene(reading, device.array)
    path = plan.page.hand(reading, scene, device.array)
    done = scan(device, scene, path, max_angle=reading.max_angle, threads=1)
    return judge(done, file.whole.criteria())


def evaluate_scans(
    plan: Plan, columns: Columns, count: int, outputs: Sequence[str], processes: int | None = 1
) -> dict[str, Any]:
    """The outputs at `count` points; arguments as for `evaluate`.

    Raises:
        ValueError: a file of the page has changed since the study was read.
    """
    assert plan.page
    plan.page.check()
    every = {key: np.broadcast_to(values, (count,)) for key, values in columns.items()}
    points = [{key: float(values[i]) for key, values in every.items()} for i in range(count)]
    processes = worker_count(processes)
    portion = min(_PORTION, -(-count // (2 * processes)))
    portions = [points[i : i + portion] for i in range(0, count, portion)]
    if processes == 1 or len(portions) == 1:
        done = [_rows(plan, portion) for portion in portions]
    else:
        done = standing(processes).spread(_rows, plan, portions)
    rows = [row for portion in done for row in portion]
    kinds = {"reason": object}
    return {name: np.array([row[name] for row in rows], kinds.get(name)) for name in outputs}


def _rows(plan: Plan, points: Sequence[Mapping[str, float]]) -> list[Row]:
    return [_row(plan, point) for point in points]


def _row(plan: Plan, point: Mapping[str, float]) -> Row:
    """The numbers at a point; one without a scan has a status and no numbers."""
    names = variables(SCANNED)
    try:
        found = scan_numbers(judged_at(plan, point))
    except (ValueError, ArithmeticError, MemoryError) as error:
        status = error.status if isinstance(error, SimulationError) else Status.refused
        return dict.fromkeys(names, nan) | {"status": status, "reason": refused_by(error)}
    given = {name: found[quantity.name] for name, quantity in names.items()}
    return given | {"status": Status.ok, "reason": ""}

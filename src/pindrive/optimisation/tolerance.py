"""Which part of the designs that are built within the tolerances meets all demands."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pindrive.files.device import DeviceFile
from pindrive.optimisation.goals import Variable, Wish
from pindrive.optimisation.problem import Problem
from pindrive.optimisation.scanned import Scanned
from pindrive.study.distributions import Sample, implied_links
from pindrive.study.outputs import Share
from pindrive.study.spec import plan_of

Array = NDArray[np.float64]


def excess_as_built(
    wish: Wish, problem: Problem, device: DeviceFile, point: Array, draws: int, seed: int
) -> Array:
    """How far devices that are built within the tolerances exceed each demand, at worst.

    A tolerance in per cent is one of the design's own value. Every device that is drawn is followed
    at all conditions of the problem.

    Args:
        wish: what is wanted, with tolerances.
        problem: with its conditions.
        device: the design.
        point: likewise.
        draws: devices.
        seed: of them.

    Returns:
        SI, shape (demands, draws); infinite for a device that cannot exist.
    """
    tables = {"tolerances": wish.tables["tolerances"]}
    if wish.plan.page:
        tables["page"] = wish.plan.page.page
    file = wish.plan.path
    plan = plan_of(tables, device, path=file, place=str(file), text="", si=wish.si)
    keys = [*plan.tolerances]
    varied = {*keys, *(key for condition in problem.conditions for key in condition.axes)}
    parts = Sample(tuple(keys), draws, seed).parts(np.arange(draws)).T
    drawn = replace(
        problem,
        plan=plan,
        goals=(),
        variables=tuple(Variable(key, {key: axis}) for key, axis in plan.tolerances.items()),
        links=implied_links(device, varied, problem.scans) | dict(plan.tolerance_links),
        price=float(problem.prices(point[None])[0]),
        scanned=Scanned(),
    )
    found: Array = drawn.excess(drawn.numbers(parts)).max(axis=2)
    return found


def share_of(excess: Array) -> Share:
    """The yield with its exact interval, of devices that exceed demands so (demands, draws)."""
    met = (excess <= 0.0).all(axis=0)
    return Share.of_designs(int(met.sum()), met.size)


def reserves(excess: Array, own: Array, part: float) -> Array:
    """By how much each limit must be tightened for a part of the devices to meet it.

    Args:
        excess: of devices, shape (demands, draws).
        own: of the design itself, shape (demands,).
        part: from 0 to 1.
    """
    scattered = np.quantile(excess, part, axis=1, method="higher")
    return np.maximum(np.where(np.isfinite(scattered), scattered - own, 0.0), 0.0)

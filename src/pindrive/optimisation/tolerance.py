"""Yield of designs within the tolerances."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pindrive.files.device import DeviceFile
from pindrive.optimisation.goals import DesignProblem, Variable
from pindrive.optimisation.scanned import Scanned
from pindrive.study.distributions import Sample, implied_links
from pindrive.study.outputs import Share
from pindrive.study.study import Study

if TYPE_CHECKING:
    from pindrive.optimisation.design_space import DesignSpace

Array = NDArray[np.float64]


def excess_as_built(
    problem: DesignProblem,
    space: DesignSpace,
    device: DeviceFile,
    point: Array,
    draws: int,
    seed: int,
) -> Array:
    """Return the excess of toleranced devices over each constraint, at worst.

    A tolerance in per cent is one of the design's own value. Every device that is drawn is followed
    at all conditions of the space.

    Args:
        problem: Design problem with tolerances.
        space: Space with its conditions.
        device: The design.
        point: Point of the design.
        draws: Devices.
        seed: Seed of the draws.

    Returns:
        SI, shape (constraints, draws); infinite for a device that cannot exist.
    """
    tables = {"tolerances": problem.tables["tolerances"]}
    if problem.study.page:
        tables["page"] = problem.study.page.page
    study = Study.of_tables(tables, device, problem.study.source)
    keys = [*study.tolerances]
    varied = {*keys, *(key for condition in space.conditions for key in condition.axes)}
    parts = Sample(tuple(keys), draws, seed).parts(np.arange(draws)).T
    drawn = replace(
        space,
        study=study,
        goals=(),
        variables=tuple(Variable(key, {key: axis}) for key, axis in study.tolerances.items()),
        links=implied_links(device, varied, space.scans) | dict(study.tolerance_links),
        price=float(space.prices(point[None])[0]),
        scanned=Scanned(),
    )
    found: Array = drawn.excess(drawn.numbers(parts)).max(axis=2)
    return found


def share_of(excess: Array) -> Share:
    """Return the yield with its exact interval from the excess (constraints, draws)."""
    met = (excess <= 0.0).all(axis=0)
    return Share.of_designs(int(met.sum()), met.size)


def reserves(excess: Array, own: Array, part: float) -> Array:
    """Return the tightening of each limit that lets a fraction of the devices meet it.

    Args:
        excess: Excess of devices, shape (constraints, draws).
        own: Excess of the design itself, shape (constraints,).
        part: Part of the draws, from 0 to 1.
    """
    scattered = np.quantile(excess, part, axis=1, method="higher")
    return np.maximum(np.where(np.isfinite(scattered), scattered - own, 0.0), 0.0)

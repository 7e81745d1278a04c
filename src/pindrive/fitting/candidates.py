"""Where a search starts: the best of many candidates that are spread over the bounds."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.fitting.model import Model
from pindrive.lazy import qmc
from pindrive.motion.batch import simulate_batch
from pindrive.motion.release import PLACES, ROWS, entry
from pindrive.quantities.table import ImplausibleValueWarning

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

BATCHED: Final = 16384
"""Candidates of plain releases, which `simulate_batch` follows."""
SINGLE: Final = 1024
"""Candidates of what only the general core follows."""
LOOKS: Final = 40
"""Samples of each recording at which candidates are compared."""
_OTHER: Final = ("finger.stiffness", "skin_stretch", "force", "across_velocity", "finger_load")
_PLAIN: Final = tuple(name for name in PLACES if name not in _OTHER)
"""What `simulate_batch` can vary."""


def candidates(model: Model, weights: Array, seed: int) -> Array:
    """Parameters spread over their bounds, the best first, shape (n, k).

    They are a scrambled Sobol' sequence, over the decades of what is positive and ranges over more
    than three times its least value, and the values of the drive itself. Sensor offsets, which are
    linear, are those that fit each best.

    Args:
        model: of the recordings, every so many samples of them.
        weights: one over the noise of each sample, shape (n,).
        seed: of the sequence.
    """
    batched = _plain(model)
    count = BATCHED if batched else SINGLE
    found = model.parameters
    low = np.array([p.lower for p in found])
    high = np.array([p.upper for p in found])
    unit = qmc.Sobol(len(found), scramble=True, rng=seed).random(count)
    with np.errstate(divide="ignore", invalid="ignore"):
        decades = low * (high / low) ** unit
    logarithmic = np.array([p.logarithmic for p in found])
    theta = np.where(logarithmic, decades, low + (high - low) * unit)
    theta = np.vstack([[p.start for p in found], theta])
    costs = (_batched_costs if batched else _single_costs)(model, weights, theta)
    order = np.argsort(costs, kind="stable")
    return theta[order[np.isfinite(costs[order])]]


def _plain(model: Model) -> bool:
    """Whether `simulate_batch` can follow all of it."""
    numbers = [
        model.assembly.numbers([p.start for p in model.parameters], r)
        for r in range(len(model.releases))
    ]
    channels = {block.channel for block in model.blocks}
    rigid = all(np.isinf(n[4][2]) for n in numbers)
    free = all(p.key in _PLAIN or p.key.endswith("_offset") for p in model.parameters)
    constant = all(len(n[5]) == 1 and len(n[6]) == 1 for n in numbers)
    coulomb = all(len(contact[3]) <= 1 for n in numbers for contact in n[3:5])
    left_alone = all(
        release.force == release.across_velocity == 0.0 and release.finger_load == 1.0
        for release in model.releases
    )
    measured = channels <= {"position", "velocity"}
    return measured and rigid and free and constant and coulomb and left_alone


def _batched_costs(model: Model, weights: Array, theta: Array) -> Array:
    costs = np.zeros(len(theta))
    columns = theta.T[..., None]
    for r in range(len(model.releases)):
        times = model.times(r) - model.offset(columns, r)
        late = np.maximum(times, 1e-9)
        numbers = model.assembly.numbers(columns, r)
        varied = {}
        for name in _PLAIN:
            value = entry(numbers, PLACES[name])
            varied[name.replace(".", "_")] = value[0][1] if name in ROWS else value
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ImplausibleValueWarning)
            state = simulate_batch(
                model.drive,
                model.releases[r],
                outputs=["final_position", "final_velocity"],
                **{**varied, "duration": late},
            )
        shape = np.broadcast_shapes(late.shape, (len(theta), 1))
        v = np.broadcast_to(state.final_velocity.values, shape)
        x = state.final_position.values + np.minimum(times, 0.0) * varied["velocity"]
        for block in model.blocks:
            if block.recording == r:
                computed = np.broadcast_to(x if block.channel == "position" else v, shape)
                costs += _cost(
                    model, block.place, weights, computed, f"{block.channel}_offset", r, theta
                )
    return costs


def _cost(
    model: Model, place: slice, weights: Array, computed: Array, key: str, r: int, theta: Array
) -> Array:
    """Weighted squares of a block for each candidate; a free offset of it is set to its best."""
    off = model.data[place] - computed
    i = model.place(key, r)
    if i is not None:
        p = model.parameters[i]
        theta[:, i] = np.clip(np.nan_to_num(off.mean(axis=-1)), p.lower, p.upper)
        off = off - theta[:, i, None]
    costs: Array = np.sum((off * weights[place]) ** 2, axis=-1)
    return costs


def _single_costs(model: Model, weights: Array, theta: Array) -> Array:
    costs = np.full(len(theta), np.inf)
    for row, values in enumerate(theta):
        computed = model.predict(values)
        cost = 0.0
        for block in model.blocks:
            key = f"{block.channel}_offset"
            i = model.place(key, block.recording)
            off = model.data[block.place] - computed[block.place]
            if i is not None:
                p = model.parameters[i]
                best = np.clip(values[i] + off.mean(), p.lower, p.upper)
                off, theta[row, i] = off + values[i] - best, best
            cost += float(np.sum((off * weights[block.place]) ** 2))
        costs[row] = cost if np.isfinite(cost) else np.inf
    return costs

"""The search for the best least squares of a model: from many candidates to one."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.least_squares import BETTER, Optimum, Problem
from pindrive.fitting.model import Model
from pindrive.fitting.parameters import is_of_sensor
from pindrive.lazy import qmc
from pindrive.motion.batch import simulate_batch
from pindrive.motion.core_numbers import LAW_PLACE, PLACES, ROWS, entry
from pindrive.motion.function import Function
from pindrive.quantities.table import ImplausibleValueWarning

Array = NDArray[np.float64]

BATCHED: Final = 16384
"""Candidates of plain releases, which `simulate_batch` follows."""
SINGLE: Final = 1024
"""Candidates of what only the general core follows."""
COARSE: Final = 40
"""Samples of each recording at which candidates are compared."""
_OTHER: Final = (
    *("finger.stiffness", "finger.damping", "load_exponent", "skin_stretch"),
    *("force", "across_velocity", "finger_load", "travel", "stop_stiffness", "stop_damping"),
    *(name for name, place in PLACES.items() if place[1:2] == (LAW_PLACE,)),
)
_PLAIN: Final = tuple(name for name in PLACES if name not in _OTHER)
"""Parameters that `simulate_batch` can vary."""
ROUGH: Final = 250
"""Samples of each recording with which candidates are refined."""
REFINED: Final = 16
"""Candidates that are refined on them."""
BEGINNING: Final = 0.35
"""First part of a recording with which a search begins, beside one with the whole recording."""
STEPS: Final = 10
"""Parts of the range of a parameter without a derivative."""
SCANNED: Final = 40
"""Values of one that are compared, closer together where it is small."""
OF_EACH: Final = 2
"""Candidates of each part."""
FINISHED: Final = 3
"""Number of candidates that are refined on all samples."""
FEW: Final = 25
"""The most evaluations of the refinement of a candidate."""
ROUNDS: Final = 10
"""Better optima beyond kinks that are followed."""
DRAWN: Final = 60
"""Points around an optimum."""
SIZES: Final = (0.5, 2.0, 8.0)
"""Distances of the neighbours, in standard errors."""
APART: Final = 0.02
"""Two candidates this part of their range apart in every parameter are one."""


def polished(problem: Problem, best: Optimum, covariance: Array, seed: int) -> Optimum:
    """A better optimum near one, if there is any beyond a kink or a jump of the cost.

    The cost has a kink where events change, and a jump where the pin just sticks. A trust region
    stops there; points drawn around it lie on both sides.

    Args:
        problem: Problem of all samples.
        best: Point at which a refinement ended.
        covariance: Covariance of the parameters there; infinite on the diagonal of an undetermined
            parameter.
        seed: Seed of the points.
    """
    rng = np.random.default_rng(seed)
    spread = np.sqrt(np.diag(covariance))
    determined = np.isfinite(spread) & (spread > 0.0)
    for _ in range(ROUNDS):
        factor = _root(covariance[np.ix_(determined, determined)])
        normal = rng.normal(size=(DRAWN, int(np.count_nonzero(determined))))
        near = np.tile(best.theta, (DRAWN, 1))
        size = rng.choice(SIZES, (DRAWN, 1))
        near[:, determined] += size * normal @ factor.T
        free = int(np.count_nonzero(~determined))
        near[:, ~determined] *= 2.0 ** rng.uniform(-3.0, 3.0, (DRAWN, free))
        near = np.clip(near, problem.lower, problem.upper)
        costs = np.array([problem.plain_cost(theta) for theta in near])
        # Far points cost more by their distance alone; of that their size is a measure.
        order = np.argsort(costs - size[:, 0] ** 2 * len(best.theta), kind="stable")
        ends = [problem.refined(near[i], most=FEW) for i in order[:FINISHED]]
        end = min(ends, key=lambda found: found.cost)
        if end.cost > best.cost - BETTER:
            return best
        best = problem.refined(end.theta)
    return best


def _root(covariance: Array) -> Array:
    """A factor of a covariance that may be singular."""
    values, vectors = np.linalg.eigh(covariance)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def search(model: Model, weights: Array, seed: int) -> tuple[Optimum, Array]:
    """Return the best optimum of the best of many candidates, and all candidates, shape (n, k)."""
    coarse, rough = model.thinned(COARSE), model.thinned(ROUGH)
    thin, few = _thinned(model, rough, weights), _thinned(model, coarse, weights)
    problem = Problem(rough, thin)
    tried = _candidates(coarse, few, seed)
    starts = _distinct(tried, problem)
    # A motion that sticks too early is far off afterwards, so the first part is fitted first.
    first = _candidates(coarse, few * _beginning(coarse), seed)
    early = Problem(rough, thin * _beginning(rough))
    starts += [
        _stepped(problem, early.refined(theta, most=FEW, tol=1e-3).theta, early)
        for theta in _distinct(first, problem)
    ]
    ends = sorted(
        (problem.refined(theta, most=FEW, tol=1e-4) for theta in starts),
        key=lambda end: end.cost,
    )
    again = _by_steps(problem, ends[0].theta, (tried, first))
    ends += [problem.refined(theta, most=FEW, tol=1e-4) for theta in again]
    ends.sort(key=lambda end: end.cost)
    whole = Problem(model, weights)
    best = [whole.refined(end.theta) for end in _apart(ends, problem)[:FINISHED]]
    return min(best, key=lambda end: end.cost), tried


def _by_steps(problem: Problem, theta: Array, lists: Sequence[Array]) -> list[Array]:
    """More candidates, along parameters that change the samples by steps alone.

    Static friction may only decide at which turn the pin stays. No derivative leads from one such
    step to the next, so that the best candidates of each part of its range are refined too.
    """
    found: list[Array] = []
    for i in np.flatnonzero(~problem.slopes(theta).any(axis=0)):
        for tried in lists:
            ends = np.quantile(tried[:, i], np.linspace(0.0, 1.0, STEPS + 1))
            for low, high in pairwise(ends):
                inside = (tried[:, i] >= low) & (tried[:, i] <= high)
                found += [*tried[np.flatnonzero(inside)[:OF_EACH]]]
    return found


def _stepped(problem: Problem, theta: Array, early: Problem) -> Array:
    """The best values of parameters that the first part of a recording does not tell."""
    found = theta.copy()
    for i in np.flatnonzero(~early.slopes(theta).any(axis=0)):
        tried = np.tile(found, (SCANNED, 1))
        span = problem.upper[i] - problem.lower[i]
        tried[:, i] = problem.lower[i] + span * np.linspace(0.0, 1.0, SCANNED) ** 3
        found = tried[int(np.argmin([problem.plain_cost(each) for each in tried]))]
    return found


def _beginning(model: Model) -> Array:
    """Return one for samples in the first part of their recording, zero elsewhere."""
    parts = []
    for block in model.blocks:
        end = block.times[0] + BEGINNING * (block.times[-1] - block.times[0])
        parts.append(np.where(block.times <= end, 1.0, 0.0))
    return np.concatenate(parts)


def _thinned(model: Model, other: Model, weights: Array) -> Array:
    """Return the weights of the blocks of another model with equal recordings."""
    return np.concatenate(
        [
            np.full(thin.size, weights[block.place.start])
            for block, thin in zip(model.blocks, other.blocks, strict=True)
        ]
    )


def _distinct(tried: Array, problem: Problem) -> list[Array]:
    """Return the best candidates at distinct places."""
    extent = problem.upper - problem.lower
    found: list[Array] = []
    for theta in tried[: 20 * REFINED]:
        if all(np.any(np.abs(theta - other) > APART * extent) for other in found):
            found.append(theta)
        if len(found) == REFINED:
            break
    return found


def _apart(ends: list[Optimum], problem: Problem) -> list[Optimum]:
    """Return the best distinct ends."""
    found: list[Optimum] = []
    for end in ends:
        if all(abs(end.cost - other.cost) > 1e-3 * other.cost for other in found):
            found.append(end)
    return found or [problem.refined(np.array([p.start for p in problem.model.parameters]))]


# ---- candidates ----------------------------------------------------------------------------------


def _candidates(model: Model, weights: Array, seed: int) -> Array:
    """Parameters spread over their bounds, the best first, shape (n, k).

    They are a scrambled Sobol' sequence, over the decades of what is positive and ranges over more
    than three times its least value, and the values of the drive itself. Parameters that a sensor
    adds, which are linear, are those that fit each best.

    Args:
        model: Model of every n-th sample of the recordings.
        weights: Weight of each sample, one over its noise, shape (n,).
        seed: Seed of the sequence.
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
    """Return True if `simulate_batch` can simulate all parameters."""
    numbers = [
        model.assembly.numbers([p.start for p in model.parameters], r)
        for r in range(len(model.releases))
    ]
    channels = {block.channel for block in model.blocks}
    rigid = all(np.isinf(n[4][2]) for n in numbers)
    free = all(p.key in _PLAIN or is_of_sensor(p.key) for p in model.parameters)
    unbounded = all(np.isinf(n[13][0]) for n in numbers)
    constant = all(len(n[5]) == 1 and len(n[6]) == 1 for n in numbers)
    coulomb = all(
        len(contact[3]) <= 1 and not (contact[4][0] or contact[4][4])
        for n in numbers
        for contact in n[3:5]
    )
    left_alone = all(
        release.force == release.across_velocity == 0.0 and release.finger_load == 1.0
        for release in model.releases
    ) and not any(
        isinstance(given, Function)
        for release in model.releases
        for given in (release.mouse_velocity, release.plate_load)
    )
    instant = all(
        noise.average == "instant"
        for recording in model.recordings
        for noise in recording.noise.values()
    )
    measured = channels <= {"position", "velocity"} and instant
    return measured and rigid and unbounded and free and constant and coulomb and left_alone


def _batched_costs(model: Model, weights: Array, theta: Array) -> Array:
    costs = np.zeros(len(theta))
    columns = theta.T[..., None]
    of_times: Array | None = None
    before = -1
    for i, block in enumerate(model.blocks):
        r = block.recording
        if of_times is None or before != r or not np.array_equal(of_times, block.times):
            x, v = _followed(model, r, block.times - model.offset(columns, r), columns)
            of_times, before = block.times, r
        costs += _cost(model, i, weights, x if block.channel == "position" else v, theta)
    return costs


def _followed(model: Model, r: int, times: Array, columns: Array) -> tuple[Array, Array]:
    """Return position and velocity of a recording at times, for each candidate, shape (n, m)."""
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
    shape = np.broadcast_shapes(late.shape, (columns.shape[1], 1))
    x = state.final_position.values + np.minimum(times, 0.0) * varied["velocity"]
    v = np.broadcast_to(state.final_velocity.values, shape)
    return np.broadcast_to(x, shape), v


def _cost(model: Model, i: int, weights: Array, computed: Array, theta: Array) -> Array:
    """Return the weighted squares of a block for each candidate, at its best sensor."""
    place = model.blocks[i].place
    off = model.data[place] - computed
    places, columns = model.added(i)
    if places:
        least = np.array([model.parameters[j].lower for j in places])
        most = np.array([model.parameters[j].upper for j in places])
        best = np.clip(np.nan_to_num(off) @ np.linalg.pinv(columns).T, least, most)
        theta[:, places] = best
        off = off - best @ columns.T
    costs: Array = np.sum((off * weights[place]) ** 2, axis=-1)
    return costs


def _single_costs(model: Model, weights: Array, theta: Array) -> Array:
    costs = np.full(len(theta), np.inf)
    for row in range(len(theta)):
        values = theta[row : row + 1]
        computed = model.predict(values[0])
        cost = 0.0
        for i, block in enumerate(model.blocks):
            places, columns = model.added(i)
            moved = computed[block.place] - columns @ values[0, places]
            cost += float(_cost(model, i, weights, moved[None], values)[0])
        costs[row] = cost if np.isfinite(cost) else np.inf
    return costs

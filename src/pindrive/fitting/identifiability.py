"""Identifiability of parameters: rank of the exact derivatives, and profiles."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.least_squares import RANK, Problem

Array = NDArray[np.float64]

PART: Final = 1e-5
"""A parameter has a part in a combination if it has so much of the largest part."""
TRIED: Final = 24
"""Candidates at which the rank is computed, beside the optimum."""


class Identifiability(StrEnum):
    """Degree to which recordings determine a parameter."""

    identifiable = "identifiable"
    practically_not = "practically not"
    """The profile is open: the noise, or the course of the motion, hides the parameter."""
    structurally_not = "structurally not"
    """Some change of the parameter and others leaves every sample unchanged, without any noise."""


@dataclass(frozen=True, slots=True)
class Rank:
    """The rank of the derivatives at the optimum, and what follows from it.

    Attributes:
        covariance: Covariance of the estimates, infinite on the diagonal of an undetermined
            estimate, shape (k, k).
        groups: Parameters of which the recordings tell combinations alone, by their places.
    """

    covariance: Array
    groups: tuple[tuple[int, ...], ...]


def rank(problem: Problem, theta: Array, tried: Array, coarse: Problem) -> Rank:
    """Return the rank of the derivatives at `theta` and at some of the candidates.

    A combination is hidden structurally where the derivatives have too low a rank at the optimum
    and at every candidate.

    Args:
        problem: Problem of all samples.
        theta: The optimum.
        tried: Candidates, shape (n, k).
        coarse: Problem of fewer samples, for the candidates.
    """
    slopes = problem.slopes(theta)
    lengths = np.linalg.norm(slopes, axis=0)
    known = lengths > 0.0
    covariance = np.zeros((len(theta), len(theta)))
    covariance[~known, ~known] = np.inf
    places = np.flatnonzero(known)
    if not len(places):
        return Rank(covariance, ())
    _, values, across = np.linalg.svd(slopes[:, places] / lengths[places], full_matrices=False)
    seen = values > RANK * values[0]
    inverse = (across[seen].T / values[seen] ** 2) @ across[seen]
    size = lengths[places]
    covariance[np.ix_(places, places)] = inverse / np.outer(size, size)
    hidden = across[~seen] / size / _sizes(problem, theta)[places]
    groups = [tuple(int(places[i]) for i in group) for group in _supports(hidden)]
    for group in groups:
        for i in group:
            covariance[i, :] = covariance[:, i] = 0.0
            covariance[i, i] = np.inf
    spare = [len(theta) - _rank(coarse.slopes(other)) for other in tried[:TRIED]]
    structural = min([int(np.count_nonzero(~seen)), *spare])
    return Rank(covariance, tuple(groups) if structural else ())


def untouched(coarse: Problem, tried: Array) -> list[int]:
    """The parameters that change no sample at any of many candidates, by their places.

    Static friction may decide where the pin sticks and have no derivative: a parameter without one
    is set to its bounds too.
    """
    chosen = tried[:: max(1, len(tried) // 100)]
    largest = np.max([np.abs(coarse.slopes(theta)).max(axis=0) for theta in chosen], axis=0)
    return [int(i) for i in np.flatnonzero(largest == 0.0) if not _moves(coarse, chosen, int(i))]


def _moves(coarse: Problem, chosen: Array, i: int) -> bool:
    """Return True if a parameter changes a sample between its bounds."""
    for theta in chosen:
        ends = np.tile(theta, (2, 1))
        ends[:, i] = coarse.lower[i], coarse.upper[i]
        low, high = (coarse.model.predict(end) for end in ends)
        if not np.array_equal(low, high, equal_nan=True):
            return True
    return False


def _sizes(problem: Problem, theta: Array) -> Array:
    """Return the size of each parameter."""
    sizes: Array = np.maximum(np.abs(theta), 1e-3 * (problem.upper - problem.lower))
    return sizes


def _rank(slopes: Array) -> int:
    lengths = np.linalg.norm(slopes, axis=0)
    lengths[lengths == 0.0] = 1.0
    values = np.linalg.svd(slopes / lengths, compute_uv=False)
    return int(np.count_nonzero(values > RANK * values[0]))


def _supports(hidden: Array) -> list[list[int]]:
    """Return the parameters of each hidden combination, few in each."""
    rows = np.array(hidden, copy=True)
    found = []
    for i in range(len(rows)):  # reduced by rows, so that a combination has no more than it needs
        column = int(np.abs(rows[i]).argmax())
        rows[i] /= rows[i, column]
        for j in range(len(rows)):
            if j != i:
                rows[j] -= rows[j, column] * rows[i]
    for row in rows:
        found.append([int(i) for i in np.flatnonzero(np.abs(row) > PART * np.abs(row).max())])
    return found

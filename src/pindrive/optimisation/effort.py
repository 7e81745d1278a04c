"""Size of a search, by the kind of the design problem, and counts of its simulations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Effort:
    """Size of a search.

    Attributes:
        motions: Or scans, of the screening.
        population: Members of the search.
        generations: Largest number of generations; of scans, of rounds with four devices each.
        conditions: Spread over their ranges to find the worst, a power of two.
        resolution: Resolution of a map along each axis; 0: no map.
        draws: Within the tolerances.
        patience: Generations, or rounds, without progress after which a search ends.
    """

    motions: int
    population: int
    generations: int
    conditions: int
    resolution: int
    draws: int
    patience: int = 25


BATCHED: Final = Effort(1 << 17, 128, 400, 1024, 41, 20_000)
"""Size of a search with motions of `simulate_batch`."""
SINGLE: Final = Effort(1 << 11, 24, 60, 64, 9, 500, 12)
"""Size of a search with motions that are simulated one by one."""
SCANNED: Final = Effort(16, 12, 24, 8, 5, 100, 3)
"""Size of a search with scans."""


def usual_effort(*, scans: bool, slow: bool) -> Effort:
    """Return the usual size of the search for a design problem.

    Args:
        scans: True for designs that are scanned.
        slow: True for motions that are simulated one by one.
    """
    return SCANNED if scans else SINGLE if slow else BATCHED


@dataclass
class Count:
    """Number of simulations.

    Attributes:
        motions: Releases.
        scans: Number of scans of pages and of trials of lines.
    """

    motions: int = 0
    scans: int = 0

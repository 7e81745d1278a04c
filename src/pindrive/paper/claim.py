"""A sentence of the paper and its verdict, which is computed.

A sentence is tried on random releases (or on the parameters that it speaks of). It holds if it is
true of all; it holds under a condition if it is true of all that meet the condition and not of all
others; else it does not hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from pindrive.paper import population

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from pindrive.paper.formulas import Array
    from pindrive.paper.release import Releases

    Truth = NDArray[np.bool_]

TINY = 1e-9
"""A difference below this part is none: formulas and simulator agree to far better."""


@dataclass(frozen=True)
class Claim:
    """A sentence, where it stands, and on what it is true."""

    place: str
    sentence: str
    """Word for word."""
    true: Truth
    """Of each trial: whether it is true."""
    shown_by: str
    """The exhibit that shows it."""
    finding: str
    """What was found, with its numbers."""
    condition: str = ""
    """When it holds, in words."""
    meets: Truth | None = None
    """Of each trial: whether it meets the condition."""

    @property
    def verdict(self) -> str:
        """Holds, holds when …, or does not hold."""
        if self.true.all():
            return "holds"
        if self.meets is not None and self.meets.any() and self.true[self.meets].all():
            return f"holds when {self.condition}"
        return "does not hold"


def batch(r: Releases, finger: Array | float = 0.0, *, velocity: Array | None = None) -> xr.Dataset:
    """The exact numbers of these releases, with finger friction (N), from another velocity."""
    return r.batch(finger_kinetic=finger, velocity=velocity)


def swing(found: xr.Dataset) -> Array:
    """From peak to trough; 0 where the pin comes to rest at its peak."""
    swings: Array = np.nan_to_num(found["transient_swing"].to_numpy())
    return swings


def finger_friction(count: int, most: float = 0.01) -> Array:
    """Random ones up to `most`, N."""
    return np.random.default_rng(population.SEED + 2).uniform(0.0, most, count)

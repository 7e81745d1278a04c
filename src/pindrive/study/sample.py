"""Numbers between 0 and 1 for the sampled axes: random or Sobol', the same however they are cut.

They come in blocks of fixed length, each from its own seed or its own stretch of the sequence, so
that any chunk, on any machine, in any order, draws what the study says stands there.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, Literal
from zlib import crc32

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

BLOCK: Final = 1 << 15
"""Draws that are made together."""
MOST_SOBOL: Final = 1 << 30
"""Points of a Sobol' sequence with 30 bits."""

Method = Literal["random", "sobol"]


@dataclass(frozen=True, slots=True)
class Sample:
    """One sampled dimension: `count` draws of all of `keys` together."""

    keys: tuple[str, ...]
    count: int
    seed: int = 1
    method: Method = "random"

    def parts(self, index: NDArray[np.int64]) -> NDArray[np.float64]:
        """Numbers above 0 and below 1 at these places, shape (keys, n)."""
        found = np.empty((len(self.keys), len(index)))
        number, place = np.divmod(index, BLOCK)
        draw = _sobol if self.method == "sobol" else _random
        for block in np.unique(number):
            here = number == block
            found[:, here] = draw(self.keys, self.seed, int(block))[:, place[here]]
        return found


@lru_cache(maxsize=8)
def _random(keys: tuple[str, ...], seed: int, block: int) -> NDArray[np.float64]:
    """Each key has its own stream, which other keys do not change."""
    streams = (np.random.SeedSequence(seed, spawn_key=(crc32(key.encode()), block)) for key in keys)
    drawn = [np.random.Generator(np.random.PCG64(stream)).random(BLOCK) for stream in streams]
    return np.maximum(drawn, 2.0**-54)  # never 0, where a distribution may have no value


@lru_cache(maxsize=8)
def _sobol(keys: tuple[str, ...], seed: int, block: int) -> NDArray[np.float64]:
    from scipy.stats import qmc

    sequence = qmc.Sobol(len(keys), scramble=True, rng=np.random.default_rng(seed))
    if block:
        sequence.fast_forward(block * BLOCK)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a block goes on where the one before ended
        drawn = sequence.random(BLOCK)
    return np.ascontiguousarray(drawn.T) + 2.0**-31

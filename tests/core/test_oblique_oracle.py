"""Oblique motions through w = 0, in the event loop, beside forty digits."""

from __future__ import annotations

import pytest

from oracle import oblique

# Of `python -m oracle.oblique 200 1`, cheap ones: turns, sticks and slips, and creep through w = 0.
SEEDS = {3: ["stick", "slip"], 7: [], 8: ["cross", "stick"], 10: ["cross"]}
CREEPS = {7}


@pytest.mark.parametrize("seed", SEEDS)
def test_core_gives_the_oracle_answers(seed: int) -> None:
    case, path = oblique.answered(seed)
    assert [e.kind for e in path.events] == SEEDS[seed]
    assert (path.met > 0) == (seed in CREEPS)
    assert oblique.deviation(case, path) < oblique.CLOSE

"""Random scans keep the laws of motion, go on where they were cut, and mirror."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from oracle.scan_cycles import distance
from random_scans import RandomScan, mirrors, parting, sampled

SHORT = (1, 2, 5, 9, 12, 15, 16, 17, 18, 20, 23, 29, 31, 32, 33)
"""Seeds of scans that a general integrator gets through in a second."""


@pytest.mark.parametrize(
    ("seed", "curved"), [*((s, False) for s in range(40)), (0, True), (1, True)]
)
def test_random_scans(seed: int, curved: bool) -> None:
    one = RandomScan.of(seed, curved=curved)
    pin = one.scan()
    assert pin.motion.certificate().worst < 1e-9
    assert parting(pin, one.halves()) < 1e-10
    assert mirrors(pin, one.mirrored())


@pytest.mark.parametrize(
    ("seed", "oblique"), [*((s, False) for s in SHORT), *((s, True) for s in (4, 6, 8, 9, 10, 12))]
)
def test_random_scans_against_sundials(seed: int, oblique: bool) -> None:
    found = distance(RandomScan.of(seed, oblique=oblique).linear().scan())
    assert found.events
    assert found.time < 1e-8
    assert found.state < 1e-8


@pytest.mark.parametrize("oblique", [False, True])
def test_rows_converge_to_strokes(oblique: bool) -> None:
    """Halving the distance of the rows of a hand divides its error by about four."""
    converged = 0
    for seed in range(8):
        one = RandomScan.of(seed, oblique=oblique)
        pin = one.scan()
        t = np.linspace(0.0, pin.end, 2001)
        exact, size = pin.position(t), np.abs(pin.position(t)).max()
        errors = [
            np.abs(replace(one, path=sampled(one.path, rows)).scan().position(t) - exact).max()
            for rows in (257, 513)
        ]
        # Where a sample of the page falls on the other side of an edge, a switching moves.
        if errors[0] < 1e-3 * size:
            converged += 1
            assert errors[1] < 0.3 * errors[0]
    assert converged >= 5

"""Random scans keep the laws of motion, go on where they were cut, and mirror."""

from __future__ import annotations

import pytest

from oracle.scan_cycles import distance
from random_scans import RandomScan, mirrors, parting

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
    found = distance(RandomScan.of(seed, oblique=oblique).scan())
    assert found.events
    assert found.time < 1e-8
    assert found.state < 1e-8

"""Motions under inputs that are functions, beside an independent oracle of thirty digits."""

from __future__ import annotations

from pathlib import Path

import pytest

from oracle import law_motion, make_laws

CASES = make_laws.load(Path(__file__).parents[1] / "oracle" / "function_cases.json.gz")


@pytest.mark.parametrize("number", range(len(CASES)))
def test_thirty_digits(number: int) -> None:
    law_motion.compare(CASES[number])

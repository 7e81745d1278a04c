"""Motions under inputs that are functions, beside an independent oracle of thirty digits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from oracle import law_motion, make_laws, sundials_laws

CASES = make_laws.load(Path(__file__).parents[1] / "oracle" / "function_cases.json.gz")


@pytest.mark.parametrize("first", range(0, len(CASES), 100))
def test_thirty_digits(first: int) -> None:
    law_motion.compare_all(CASES[first : first + 100], first)


@pytest.mark.parametrize("case", CASES[:50], ids=range(50))
def test_sundials(case: dict[str, Any]) -> None:
    """An integrator with steps, which knows neither series nor closed forms."""
    law_motion.compare(case | sundials_laws.solve(case), sundials_laws.TOLERANCE)

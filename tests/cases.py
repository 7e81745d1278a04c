"""Number of random cases of a test."""

from __future__ import annotations

import os

EXPLORES = bool(os.environ.get("PINDRIVE_EXPLORE"))
"""True if `python3 run.py explore` runs the tests."""


def cases(count: int) -> int:
    """Return the number of cases: all if the run explores, else a fifth."""
    return count if EXPLORES else count // 5

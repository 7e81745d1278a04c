"""How many random cases a test takes."""

from __future__ import annotations

import os

EXPLORES = bool(os.environ.get("PINDRIVE_EXPLORE"))
"""Whether `python3 run.py explore` runs the tests."""


def cases(count: int) -> int:
    """All of so many cases if the run explores, else a fifth."""
    return count if EXPLORES else count // 5

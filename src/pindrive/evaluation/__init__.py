"""What a scan showed the finger, against what is printed: by lines, by pitch, as an image."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.lazy import attach

if TYPE_CHECKING:
    from pindrive.evaluation.perception import judge
    from pindrive.evaluation.results import Criteria, Judgement, Line

__all__ = [
    "Criteria",
    "Judgement",
    "Line",
    "judge",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "Criteria": "pindrive.evaluation.results",
        "Judgement": "pindrive.evaluation.results",
        "Line": "pindrive.evaluation.results",
        "judge": "pindrive.evaluation.perception",
    },
)

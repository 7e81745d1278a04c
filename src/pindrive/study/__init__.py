"""Studies: many releases or scans of one device, each with other values of its keys.

A study file, or Python, names a device and says which of its keys change and how. `Study.run` and
`sweep` compute every point; sensitivities and yields follow from the same study.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.lazy import attach

if TYPE_CHECKING:
    from pindrive.study.local_sensitivity import Elasticities
    from pindrive.study.robustness import Robustness
    from pindrive.study.runner import Result, sweep
    from pindrive.study.sensitivity import Influence
    from pindrive.study.study import Study, load_study

__all__ = [
    "Elasticities",
    "Influence",
    "Result",
    "Robustness",
    "Study",
    "load_study",
    "sweep",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "Elasticities": "pindrive.study.local_sensitivity",
        "Influence": "pindrive.study.sensitivity",
        "Result": "pindrive.study.runner",
        "Robustness": "pindrive.study.robustness",
        "Study": "pindrive.study.study",
        "load_study": "pindrive.study.study",
        "sweep": "pindrive.study.runner",
    },
)

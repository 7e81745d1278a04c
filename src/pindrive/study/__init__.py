"""Studies: many releases or scans of one device, each with other values of its keys.

A study file names a device and says which of its keys change and how. `sweep` computes every
point into one NetCDF file; maps, sensitivities and yields follow from the same files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.lazy import attach

if TYPE_CHECKING:
    from pindrive.study.design import Plan
    from pindrive.study.runner import Result, sweep
    from pindrive.study.spec import load_study

__all__ = [
    "Plan",
    "Result",
    "load_study",
    "sweep",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "Plan": "pindrive.study.design",
        "Result": "pindrive.study.runner",
        "load_study": "pindrive.study.spec",
        "sweep": "pindrive.study.runner",
    },
)

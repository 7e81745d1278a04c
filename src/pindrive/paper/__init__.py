"""The paper "Dynamics of tactile device drive": its analysis, corrected; its results, recomputed.

Here are equations (2) to (26) as functions of a `Release`; `pindrive paper` writes the report.
"""

from pindrive.paper import formulas
from pindrive.paper.formulas import *  # noqa: F403
from pindrive.paper.release import Release

__all__ = ["Release"]
__all__ += formulas.__all__

"""The paper "Dynamics of tactile device drive": its analysis, corrected; its results, recomputed.

Here are equations (2) to (26) as functions of `Releases`; `pindrive paper` writes the report.
"""

from pindrive.paper import formulas
from pindrive.paper.formulas import *  # noqa: F403
from pindrive.paper.formulas import Releases

__all__ = ["Releases"]
__all__ += formulas.__all__

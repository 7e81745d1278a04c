# The module of each public name; `__init__.py` describes them.

from .bifurcation import Bifurcation as Bifurcation
from .local_sensitivity import Elasticities as Elasticities
from .robustness import Robustness as Robustness
from .runner import Sweep as Sweep
from .runner import sweep as sweep
from .sensitivity import SobolIndices as SobolIndices
from .study import Study as Study
from .system_study import SystemStudy as SystemStudy
from .spec import load_study as load_study

__all__: list[str]

# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.study.local_sensitivity import Elasticities as Elasticities
from pindrive.study.robustness import Robustness as Robustness
from pindrive.study.runner import Sweep as Sweep
from pindrive.study.runner import sweep as sweep
from pindrive.study.sensitivity import Influence as Influence
from pindrive.study.study import Study as Study
from pindrive.study.study import load_study as load_study

__all__: list[str]

# The module of each public name; `__init__.py` describes them.

from .results import ModelComparison as ModelComparison
from .comparison import compare_models as compare_models
from .estimation import fit as fit
from .friction_curve import FittedLaw as FittedLaw
from .friction_curve import FrictionCurve as FrictionCurve
from .friction_curve import fit_friction as fit_friction
from .identifiability import Identifiability as Identifiability
from .noise import Noise as Noise
from .problem import FitProblem as FitProblem
from .problem import load_fit as load_fit
from .recording import Recording as Recording
from .recording import read_recording as read_recording
from .results import Estimate as Estimate
from .results import Fit as Fit

__all__: list[str]

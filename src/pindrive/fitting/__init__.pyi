# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.fitting.results import ModelComparison as ModelComparison
from pindrive.fitting.comparison import compare_models as compare_models
from pindrive.fitting.estimation import fit as fit
from pindrive.fitting.friction_curve import FrictionCurve as FrictionCurve
from pindrive.fitting.friction_curve import fit_friction as fit_friction
from pindrive.fitting.identifiability import Identifiability as Identifiability
from pindrive.fitting.recording import Recording as Recording
from pindrive.fitting.recording import read_recording as read_recording
from pindrive.fitting.results import Estimate as Estimate
from pindrive.fitting.results import Fit as Fit

__all__: list[str]

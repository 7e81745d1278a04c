# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.device.device import Device as Device
from pindrive.device.hand import HandPath as HandPath
from pindrive.device.page import Scene as Scene
from pindrive.device.page_description import Page as Page
from pindrive.device.scanning import Scan as Scan
from pindrive.device.scanning import scan as scan
from pindrive.files.device import load_device as load_device
from pindrive.fitting.estimation import fit as fit
from pindrive.fitting.friction_curve import fit_friction as fit_friction
from pindrive.fitting.recording import Recording as Recording
from pindrive.fitting.recording import read_recording as read_recording
from pindrive.motion.batch import simulate_batch as simulate_batch
from pindrive.motion.drive import Contact as Contact
from pindrive.motion.drive import Drive as Drive
from pindrive.motion.profile import Profile as Profile
from pindrive.motion.motion import Motion as Motion
from pindrive.motion.release import Release as Release
from pindrive.motion.simulate import simulate as simulate
from pindrive.optimisation.designing import optimise as optimise
from pindrive.quantities.status import Status as Status
from pindrive.quantities.table import ImplausibleValueWarning as ImplausibleValueWarning
from pindrive.study.local_sensitivity import local_sensitivity as local_sensitivity
from pindrive.study.robustness import robustness as robustness
from pindrive.study.sensitivity import sobol as sobol
from pindrive.study.study import Study as Study
from pindrive.study.study import load_study as load_study

__all__: list[str]
__version__: str

# The module of each public name; `__init__.py` describes them.

from .bodies.system import System as System
from .bodies.system_motion import SystemMotion as SystemMotion
from .device.device import Device as Device
from .device.hand import HandPath as HandPath
from .device.page import Scene as Scene
from .device.page_description import Page as Page
from .device.scanning import Scan as Scan
from .device.scanning import scan as scan
from .files.device import DeviceFile as DeviceFile
from .files.device import load_device as load_device
from .files.system import SystemFile as SystemFile
from .files.system import load_system as load_system
from .fitting.estimation import fit as fit
from .fitting.friction_curve import fit_friction as fit_friction
from .fitting.recording import Recording as Recording
from .fitting.recording import read_recording as read_recording
from .motion.batch import simulate_batch as simulate_batch
from .motion.drive import Contact as Contact
from .motion.drive import HessSoom as HessSoom
from .motion.drive import Stribeck as Stribeck
from .motion.drive import Drive as Drive
from .motion.function import Function as Function
from .motion.function import InputPiece as InputPiece
from .motion.function import InputTerm as InputTerm
from .motion.function import exponential as exponential
from .motion.function import harmonic as harmonic
from .motion.function import minimum_jerk as minimum_jerk
from .motion.profile import Profile as Profile
from .motion.motion import Motion as Motion
from .motion.release import Release as Release
from .motion.simulate import simulate as simulate
from .native import get_include as get_include
from .native import get_library as get_library
from .optimisation.designing import optimise as optimise
from .quantities.status import Status as Status
from .quantities.table import ImplausibleValueWarning as ImplausibleValueWarning
from .study.bifurcation import bifurcation as bifurcation
from .study.local_sensitivity import local_sensitivity as local_sensitivity
from .study.robustness import robustness as robustness
from .study.sensitivity import sobol as sobol
from .study.study import Study as Study
from .study.spec import load_study as load_study
from .study.system_study import SystemStudy as SystemStudy

__all__: list[str]
__version__: str

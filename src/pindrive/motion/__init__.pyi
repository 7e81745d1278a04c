# The module of each public name; `__init__.py` describes them.

from .coefficients import Coefficients as Coefficients
from .drive import Contact as Contact
from .drive import HessSoom as HessSoom
from .drive import Stribeck as Stribeck
from .drive import Drive as Drive
from .function import Function as Function
from .function import InputPiece as InputPiece
from .function import InputTerm as InputTerm
from .function import exponential as exponential
from .function import harmonic as harmonic
from .function import minimum_jerk as minimum_jerk
from .profile import Profile as Profile
from .motion import Motion as Motion
from .release import Release as Release
from .results import Certificate as Certificate
from .results import Afterwards as Afterwards
from .results import ContactUse as ContactUse
from .results import Crossings as Crossings
from .results import Ending as Ending
from .results import Event as Event
from .results import Extrema as Extrema
from .results import Ledger as Ledger
from .results import Segment as Segment
from .results import Transient as Transient
from .sensitivity import Sensitivity as Sensitivity

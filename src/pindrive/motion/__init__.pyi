# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.motion.coefficients import Coefficients as Coefficients
from pindrive.motion.drive import Contact as Contact
from pindrive.motion.drive import Drive as Drive
from pindrive.motion.profile import Profile as Profile
from pindrive.motion.motion import Motion as Motion
from pindrive.motion.release import Release as Release
from pindrive.motion.results import Certificate as Certificate
from pindrive.motion.results import Afterwards as Afterwards
from pindrive.motion.results import ContactUse as ContactUse
from pindrive.motion.results import Crossings as Crossings
from pindrive.motion.results import Ending as Ending
from pindrive.motion.results import Event as Event
from pindrive.motion.results import Extrema as Extrema
from pindrive.motion.results import Ledger as Ledger
from pindrive.motion.results import Segment as Segment
from pindrive.motion.results import Transient as Transient
from pindrive.motion.sensitivity import Sensitivity as Sensitivity

# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.quantities.quantity import Bounds as Bounds
from pindrive.quantities.quantity import Quantity as Quantity
from pindrive.quantities.status import End as End
from pindrive.quantities.status import SimulationError as SimulationError
from pindrive.quantities.status import Status as Status
from pindrive.quantities.table import ImplausibleValueWarning as ImplausibleValueWarning
from pindrive.quantities.table import QUANTITIES as QUANTITIES
from pindrive.quantities.table import check as check
from pindrive.quantities.units import to_si as to_si

# The module of each public name; `__init__.py` describes them.

from .quantity import Bounds as Bounds
from .quantity import Quantity as Quantity
from .status import End as End
from .status import SimulationError as SimulationError
from .status import Status as Status
from .table import ImplausibleValueWarning as ImplausibleValueWarning
from .table import QUANTITIES as QUANTITIES
from .table import check as check
from .units import to_si as to_si

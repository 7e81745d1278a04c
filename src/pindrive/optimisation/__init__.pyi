# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.optimisation.designing import optimise as optimise
from pindrive.optimisation.effort import Effort as Effort
from pindrive.optimisation.results import Alternative as Alternative
from pindrive.optimisation.results import Demanded as Demanded
from pindrive.optimisation.results import Design as Design
from pindrive.optimisation.results import Front as Front
from pindrive.optimisation.results import Map as Map
from pindrive.optimisation.results import Reached as Reached
from pindrive.optimisation.goals import Goal as Goal
from pindrive.optimisation.goals import Wish as Wish
from pindrive.optimisation.wish import read_wish as read_wish

__all__: list[str]

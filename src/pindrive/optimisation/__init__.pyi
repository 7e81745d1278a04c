# The module of each public name; `__init__.py` describes them.

from .designing import optimise as optimise
from .effort import Effort as Effort
from .results import Alternative as Alternative
from .results import Demanded as Demanded
from .results import Design as Design
from .results import Front as Front
from .results import Map as Map
from .results import Reached as Reached
from .goals import Goal as Goal
from .goals import Wish as Wish
from .wish import read_wish as read_wish

__all__: list[str]

# The module of each public name; `__init__.py` describes them.

from .designing import optimise as optimise
from .effort import Effort as Effort
from .results import Alternative as Alternative
from .results import ConstraintResult as ConstraintResult
from .results import Design as Design
from .results import Front as Front
from .results import Map as Map
from .results import Reached as Reached
from .goals import Goal as Goal
from .goals import DesignProblem as DesignProblem
from .problem import read_problem as read_problem

__all__: list[str]

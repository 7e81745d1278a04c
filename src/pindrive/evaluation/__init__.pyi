# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.evaluation.perception import judge as judge
from pindrive.evaluation.resolution import SpeedLimit as SpeedLimit
from pindrive.evaluation.resolution import SpeedLimits as SpeedLimits
from pindrive.evaluation.resolution import largest_speeds as largest_speeds
from pindrive.device.criteria import Criteria as Criteria
from pindrive.evaluation.results import Echo as Echo
from pindrive.evaluation.results import Edge as Edge
from pindrive.evaluation.perception import Judgement as Judgement
from pindrive.evaluation.results import Line as Line

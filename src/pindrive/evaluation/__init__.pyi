# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.evaluation.perception import judge as judge
from pindrive.evaluation.resolution import SpeedLimit as SpeedLimit
from pindrive.evaluation.resolution import SpeedLimits as SpeedLimits
from pindrive.evaluation.resolution import largest_speeds as largest_speeds
from pindrive.device.device import Criteria as Criteria
from pindrive.evaluation.line_crossings import Echo as Echo
from pindrive.evaluation.line_crossings import Edge as Edge
from pindrive.evaluation.perception import Judgement as Judgement
from pindrive.evaluation.line_crossings import Line as Line

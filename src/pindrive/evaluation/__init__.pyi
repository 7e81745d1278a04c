# The module of each public name; `__init__.py` describes them.

from .hand_speed import largest_hand_speeds as largest_hand_speeds
from .page_speed import PageSpeeds as PageSpeeds
from .page_speed import speeds_over_page as speeds_over_page
from .perception import evaluate as evaluate
from .resolution import SpeedLimit as SpeedLimit
from .resolution import SpeedLimits as SpeedLimits
from .resolution import largest_speeds as largest_speeds
from .line_crossings import FalseLine as FalseLine
from .line_crossings import Edge as Edge
from .perception import Evaluation as Evaluation
from .line_crossings import Line as Line

# The module of each public name; `__init__.py` describes them.

from .page_speed import PageSpeeds as PageSpeeds
from .page_speed import speeds_over_page as speeds_over_page
from .perception import judge as judge
from .resolution import SpeedLimit as SpeedLimit
from .resolution import SpeedLimits as SpeedLimits
from .resolution import largest_speeds as largest_speeds
from .line_crossings import Echo as Echo
from .line_crossings import Edge as Edge
from .perception import Judgement as Judgement
from .line_crossings import Line as Line

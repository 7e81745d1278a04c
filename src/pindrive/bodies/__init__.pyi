# The module of each public name; `__init__.py` describes them.

from .ending import SystemEnding as SystemEnding
from .motion_parts import BodyMotion as BodyMotion
from .motion_parts import ContactMotion as ContactMotion
from .motion_parts import FeedbackMotion as FeedbackMotion
from .motion_parts import SpringMotion as SpringMotion
from .motion_parts import StopMotion as StopMotion
from .parts import Body as Body
from .parts import ContactPair as ContactPair
from .parts import Feedback as Feedback
from .parts import Spring as Spring
from .parts import Stop as Stop
from .system import System as System
from .system_motion import SystemCertificate as SystemCertificate
from .system_motion import SystemEvent as SystemEvent
from .system_motion import SystemLedger as SystemLedger
from .system_motion import SystemMotion as SystemMotion
from .system_sensitivity import SystemSensitivity as SystemSensitivity

__all__: list[str]

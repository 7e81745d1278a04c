# The module of each public name; `__init__.py` describes them.

from .system import Body as Body
from .system import ContactPair as ContactPair
from .system import Spring as Spring
from .system import Stop as Stop
from .system import System as System
from .system_motion import BodyMotion as BodyMotion
from .system_motion import ContactMotion as ContactMotion
from .system_motion import SpringMotion as SpringMotion
from .system_motion import StopMotion as StopMotion
from .system_motion import SystemCertificate as SystemCertificate
from .system_motion import SystemEvent as SystemEvent
from .system_motion import SystemLedger as SystemLedger
from .system_motion import SystemMotion as SystemMotion
from .system_sensitivity import SystemSensitivity as SystemSensitivity

__all__: list[str]

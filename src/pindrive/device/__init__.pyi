# The module of each public name; `__init__.py` describes them.

from .coil import Coil as Coil
from .coil import DataSheet as DataSheet
from .current import Commands as Commands
from .controller import ControlBlock as ControlBlock
from .controller import Decision as Decision
from .current import CoilState as CoilState
from .current import Current as Current
from .device import Criteria as Criteria
from .device import Device as Device
from .electromagnet import Electromagnet as Electromagnet
from .geometry import Gap as Gap
from .hand import HandPath as HandPath
from .hand import lines as lines
from .hand import strokes as strokes
from .page import Scene as Scene
from .pin_array import PinArray as PinArray
from .page_description import Page as Page
from .reading import Reading as Reading
from .recording import HandRecording as HandRecording
from .recording import read_csv as read_csv
from .recording import through as through
from .pin_scan import PinScan as PinScan
from .pin_scan import PinState as PinState
from .scanning import Scan as Scan
from .scanning import scan as scan

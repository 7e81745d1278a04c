# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.device.coil import Coil as Coil
from pindrive.device.current import Commands as Commands
from pindrive.device.controller import ControlBlock as ControlBlock
from pindrive.device.controller import Decision as Decision
from pindrive.device.current import CoilState as CoilState
from pindrive.device.current import Current as Current
from pindrive.device.device import Device as Device
from pindrive.device.electromagnet import Electromagnet as Electromagnet
from pindrive.device.geometry import Gap as Gap
from pindrive.device.hand import HandPath as HandPath
from pindrive.device.hand import lines as lines
from pindrive.device.hand import strokes as strokes
from pindrive.device.page import Scene as Scene
from pindrive.device.pin_array import PinArray as PinArray
from pindrive.device.page_description import Page as Page
from pindrive.device.reading import Reading as Reading
from pindrive.device.recording import Recording as Recording
from pindrive.device.recording import read_csv as read_csv
from pindrive.device.recording import through as through
from pindrive.device.scanning import PinScan as PinScan
from pindrive.device.scanning import PinState as PinState
from pindrive.device.scanning import Scan as Scan
from pindrive.device.scanning import scan as scan

# The module of each public name; `__init__.py` describes them.

from .overrides import ConfigError as ConfigError
from .device import DeviceFile as DeviceFile
from .device import load_device as load_device
from .output import OutputError as OutputError
from .reading import SavedReading as SavedReading
from .reading import load_reading as load_reading

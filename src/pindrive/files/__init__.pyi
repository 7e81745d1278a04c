# Where each public name is; `__init__.py` says what it is. One import a line: `attach` reads them.

from pindrive.files.device import ConfigError as ConfigError
from pindrive.files.device import DeviceFile as DeviceFile
from pindrive.files.device import load_device as load_device
from pindrive.files.output import OutputError as OutputError

"""Files that are read and written: device files, the kinds of files, safe replacement.

- `ConfigError`: a device file that cannot be used
- `DeviceFile`: what a device file says
- `load_device`: the device that a file describes
- `OutputError`: a file that cannot be written
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

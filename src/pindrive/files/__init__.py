"""Files that are read and written: device files, the kinds of files, safe replacement.

- `ConfigError`: a device file that cannot be used
- `DeviceFile`: what a device file says
- `load_device`: the device that a file describes
- `load_reading`: a device, a page and a hand that were saved in the browser
- `OutputError`: a file that cannot be written
- `SavedReading`: a device, a page and the hand that read it
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

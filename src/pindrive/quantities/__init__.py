"""The quantities that go in or come out: names, units, bounds, sources; and text with units.

- `Bounds`: an interval of allowed values
- `check`: a value of a quantity, in bounds, as a float in SI
- `End`: how a motion ends
- `ImplausibleValueWarning`: a value that no tactile device has
- `QUANTITIES`: the table of quantities, by name
- `Quantity`: one row of it
- `SimulationError`: a simulation that had to be given up
- `Status`: whether a motion was followed to its end
- `to_si`: text with a unit as a number in SI
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

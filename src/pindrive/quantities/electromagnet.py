"""The table of quantities, third part: the electromagnet.

Bounds are far outside of what any such magnet has, and such that nothing computed from values
within them overflows or vanishes.
"""

from __future__ import annotations

from typing import Final

from pindrive.quantities.quantity import quantities, stored, stored_inputs

_FILE: Final = stored("electromagnet.toml")

MAGNET: Final = stored_inputs("magnet", _FILE["magnet"])
COIL: Final = stored_inputs("magnet", _FILE["coil"])
"""The electromagnet by how it is made."""

MADE: Final = quantities(_FILE["made"])
"""Quantities derived from the design of the magnet; time constants replace its times."""

"""The table of quantities, second part: the whole device and how a hand moves it over a page.

Bounds are far outside of what any such device has, and such that nothing computed from values
within them overflows or vanishes. Budgets limit their joint work: budgets.
"""

from __future__ import annotations

from typing import Any, Final

from pindrive.quantities.quantity import fields_of, quantities, stored, stored_inputs

_FILE: Final = stored("device.toml")

CONTROL: Final = stored_inputs("control", _FILE["control"])
ARRAY: Final = stored_inputs("array", _FILE["array"])
SCAN: Final = stored_inputs("scan", _FILE["scan"])
HAND: Final = stored_inputs("hand", _FILE["hand"])
"""Hand that gives way to its pins."""

DEVICE_PARTS: Final = quantities(_FILE["parts"])
"""Attributes of the parts of a device in Python, and quantities derived from them."""

PIN: Final = quantities(_FILE["pin"])
"""Results of each pin of a scan."""

READER: Final[dict[str, dict[str, Any]]] = {
    key: fields_of(row) for key, row in _FILE["reader"].items()
}
"""Differing fields of `Quantity`, by the keys of a device file."""

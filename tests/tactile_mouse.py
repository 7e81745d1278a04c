"""Drive and coil of a tactile mouse, as the tests of devices and scans use them."""

from __future__ import annotations

from typing import Any

from pindrive import Contact, Drive
from pindrive.device import Coil

PLATE = Contact(0.022, 0.0265)
RIGID = Contact(0.005, 0.0075)
"""A finger that only rubs."""
SKIN = Contact(0.020, 0.030, stiffness=300.0)
"""A finger whose skin gives way."""
DAMPED = Contact(0.020, 0.030, stiffness=300.0, damping=0.3)
"""A finger whose skin gives way slowly."""


def drive(finger: Contact = RIGID, plate: Contact = PLATE, **others: Any) -> Drive:
    """Return the drive with other contacts and other values of some numbers."""
    usual = {"mass": 0.010, "stiffness": 100.0, "damping": 0.32}
    return Drive(plate=plate, finger=finger, **(usual | others))


def coil(**others: float) -> Coil:
    """Return the coil of an electromagnet with other values of some numbers, and more."""
    usual = {
        "turns": 300,
        "pole_area": 6e-6,
        "gap": 6e-5,
        "wire_diameter": 1e-4,
        "turn_length": 0.016,
        "supply_voltage": 3.0,
    }
    return Coil(**(usual | others))

"""Drive of a tactile mouse, as the tests of devices and scans use it."""

from __future__ import annotations

from typing import Any

from pindrive import Contact, Drive

PLATE = Contact(0.022, 0.0265)
RIGID = Contact(0.005, 0.0075)
"""A finger that only rubs."""
SKIN = Contact(0.020, 0.030, stiffness=300.0)
"""A finger whose skin gives way."""


def drive(finger: Contact = RIGID, plate: Contact = PLATE, **others: Any) -> Drive:
    """Return the drive with other contacts and other values of some numbers."""
    usual = {"mass": 0.010, "stiffness": 100.0, "damping": 0.32}
    return Drive(plate=plate, finger=finger, **(usual | others))

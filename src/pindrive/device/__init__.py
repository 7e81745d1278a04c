"""The whole device: a hand moves over a page, a control block reads it, pins move a finger."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.lazy import attach

if TYPE_CHECKING:
    from pindrive.device.coil import Coil
    from pindrive.device.controller import Commands, ControlBlock, Decision
    from pindrive.device.device import Device
    from pindrive.device.electromagnet import CoilState, Current, Electromagnet
    from pindrive.device.hand import HandPath, lines, strokes
    from pindrive.device.page import Scene
    from pindrive.device.pin_array import PinArray
    from pindrive.device.reading import Page, Reading
    from pindrive.device.recording import Recording, read_csv, through
    from pindrive.device.scanning import PinScan, PinState, Scan, scan

__all__ = [
    "Coil",
    "CoilState",
    "Commands",
    "ControlBlock",
    "Current",
    "Decision",
    "Device",
    "Electromagnet",
    "HandPath",
    "Page",
    "PinArray",
    "PinScan",
    "PinState",
    "Reading",
    "Recording",
    "Scan",
    "Scene",
    "lines",
    "read_csv",
    "scan",
    "strokes",
    "through",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "Coil": "pindrive.device.coil",
        "CoilState": "pindrive.device.electromagnet",
        "Commands": "pindrive.device.controller",
        "ControlBlock": "pindrive.device.controller",
        "Current": "pindrive.device.electromagnet",
        "Decision": "pindrive.device.controller",
        "Device": "pindrive.device.device",
        "Electromagnet": "pindrive.device.electromagnet",
        "HandPath": "pindrive.device.hand",
        "Page": "pindrive.device.reading",
        "PinArray": "pindrive.device.pin_array",
        "PinScan": "pindrive.device.scanning",
        "PinState": "pindrive.device.scanning",
        "Reading": "pindrive.device.reading",
        "Recording": "pindrive.device.recording",
        "Scan": "pindrive.device.scanning",
        "Scene": "pindrive.device.page",
        "lines": "pindrive.device.hand",
        "read_csv": "pindrive.device.recording",
        "scan": "pindrive.device.scanning",
        "strokes": "pindrive.device.hand",
        "through": "pindrive.device.recording",
    },
)

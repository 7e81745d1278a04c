"""The whole device: a hand moves over a page, a control block reads it, pins move a finger."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pindrive.device.array import PinArray
    from pindrive.device.coil import Coil
    from pindrive.device.control import Commands, ControlBlock, Decision
    from pindrive.device.device import Device
    from pindrive.device.hand import HandPath, lines, strokes, through
    from pindrive.device.judging import judge
    from pindrive.device.magnet import CoilState, Current, Electromagnet
    from pindrive.device.record import read_csv
    from pindrive.device.scanning import PinScan, PinState, Scan, scan
    from pindrive.device.scene import Scene
    from pindrive.device.verdict import Criteria, Judgement, Line

_HOME = {
    "Coil": "coil",
    "CoilState": "magnet",
    "Commands": "control",
    "ControlBlock": "control",
    "Criteria": "verdict",
    "Current": "magnet",
    "Decision": "control",
    "Device": "device",
    "Electromagnet": "magnet",
    "HandPath": "hand",
    "Judgement": "verdict",
    "Line": "verdict",
    "PinArray": "array",
    "PinScan": "scanning",
    "PinState": "scanning",
    "Scan": "scanning",
    "Scene": "scene",
    "judge": "judging",
    "lines": "hand",
    "read_csv": "record",
    "scan": "scanning",
    "strokes": "hand",
    "through": "hand",
}

__all__ = [
    "Coil",
    "CoilState",
    "Commands",
    "ControlBlock",
    "Criteria",
    "Current",
    "Decision",
    "Device",
    "Electromagnet",
    "HandPath",
    "Judgement",
    "Line",
    "PinArray",
    "PinScan",
    "PinState",
    "Scan",
    "Scene",
    "judge",
    "lines",
    "read_csv",
    "scan",
    "strokes",
    "through",
]


def __getattr__(name: str) -> object:
    """Import a public name at its first use, so that the command line starts fast."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names, imported or not."""
    return sorted({*globals(), *__all__})

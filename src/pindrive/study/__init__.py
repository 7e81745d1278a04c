"""Studies: many releases or scans of one device, each with other values of its keys.

A study file names a device and says which of its keys change and how. `sweep` works out every
point into one NetCDF file; maps, sensitivities and yields follow from the same files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pindrive.study.plan import Plan
    from pindrive.study.studyfile import load_study
    from pindrive.study.sweeping import Result, sweep

_HOME = {"Plan": "plan", "Result": "sweeping", "load_study": "studyfile", "sweep": "sweeping"}

__all__ = ["Plan", "Result", "load_study", "sweep"]


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

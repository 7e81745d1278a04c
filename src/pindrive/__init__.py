"""pindrive: exact simulation of a tactile device's pin drive under dry friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pindrive.batch import simulate_batch
    from pindrive.drive import Contact, Drive, Profile
    from pindrive.motion import Motion, simulate
    from pindrive.plausible import ImplausibleValueWarning

    __version__: str

__all__ = [
    "Contact",
    "Drive",
    "ImplausibleValueWarning",
    "Motion",
    "Profile",
    "__version__",
    "simulate",
    "simulate_batch",
]

_HOME = {
    "Contact": "pindrive.drive",
    "Drive": "pindrive.drive",
    "Profile": "pindrive.drive",
    "ImplausibleValueWarning": "pindrive.plausible",
    "Motion": "pindrive.motion",
    "simulate": "pindrive.motion",
    "simulate_batch": "pindrive.batch",
}


def __getattr__(name: str) -> object:
    """Import a public name at its first use, so that the command line starts fast."""
    if name == "__version__":
        from importlib.metadata import version

        value: object = version("pindrive")
    elif name in _HOME:
        from importlib import import_module

        value = getattr(import_module(_HOME[name]), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names alone."""
    return sorted(__all__)

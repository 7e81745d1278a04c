"""pindrive: exact simulation of a tactile device's pin drive under dry friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pindrive.motion.batch import simulate_batch
    from pindrive.motion.drive import Contact, Drive, Profile
    from pindrive.motion.motion import Motion
    from pindrive.motion.release import Release
    from pindrive.motion.simulate import simulate
    from pindrive.quantities.status import Status
    from pindrive.quantities.table import ImplausibleValueWarning

    __version__: str

__all__ = [
    "Contact",
    "Drive",
    "ImplausibleValueWarning",
    "Motion",
    "Profile",
    "Release",
    "Status",
    "__version__",
    "simulate",
    "simulate_batch",
]

_HOME = {
    "Contact": "pindrive.motion.drive",
    "Drive": "pindrive.motion.drive",
    "ImplausibleValueWarning": "pindrive.quantities.table",
    "Motion": "pindrive.motion.motion",
    "Profile": "pindrive.motion.drive",
    "Release": "pindrive.motion.release",
    "Status": "pindrive.quantities.status",
    "simulate": "pindrive.motion.simulate",
    "simulate_batch": "pindrive.motion.batch",
}


def __getattr__(name: str) -> object:
    """Import a public name at its first use; `import pindrive` itself loads no other module."""
    from pindrive.lazy import attach

    get, _ = attach(__name__, _HOME)
    return get(name)


def __dir__() -> list[str]:
    """The public names alone."""
    return sorted(__all__)

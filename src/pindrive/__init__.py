"""pindrive: exact simulation of a tactile device's pin drive under dry friction."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pindrive.device.device import Device
    from pindrive.device.hand import HandPath
    from pindrive.device.page import Scene
    from pindrive.device.reading import Page
    from pindrive.device.scanning import Scan, scan
    from pindrive.files.device import load_device
    from pindrive.fitting.estimation import fit
    from pindrive.fitting.friction_curve import fit_friction
    from pindrive.fitting.recording import Recording, read_recording
    from pindrive.motion.batch import simulate_batch
    from pindrive.motion.drive import Contact, Drive, Profile
    from pindrive.motion.motion import Motion
    from pindrive.motion.release import Release
    from pindrive.motion.simulate import simulate
    from pindrive.quantities.status import Status
    from pindrive.quantities.table import ImplausibleValueWarning
    from pindrive.study.robustness import robustness
    from pindrive.study.sensitivity import local_sensitivity, sobol
    from pindrive.study.study import Study, load_study

    __version__: str

__all__ = [
    "Contact",
    "Device",
    "Drive",
    "HandPath",
    "ImplausibleValueWarning",
    "Motion",
    "Page",
    "Profile",
    "Recording",
    "Release",
    "Scan",
    "Scene",
    "Status",
    "Study",
    "__version__",
    "fit",
    "fit_friction",
    "load_device",
    "load_study",
    "local_sensitivity",
    "read_recording",
    "robustness",
    "scan",
    "simulate",
    "simulate_batch",
    "sobol",
]

_HOME = {
    "Contact": "pindrive.motion.drive",
    "Device": "pindrive.device.device",
    "Drive": "pindrive.motion.drive",
    "HandPath": "pindrive.device.hand",
    "ImplausibleValueWarning": "pindrive.quantities.table",
    "Motion": "pindrive.motion.motion",
    "Page": "pindrive.device.reading",
    "Profile": "pindrive.motion.drive",
    "Recording": "pindrive.fitting.recording",
    "Release": "pindrive.motion.release",
    "Scan": "pindrive.device.scanning",
    "Scene": "pindrive.device.page",
    "Status": "pindrive.quantities.status",
    "Study": "pindrive.study.study",
    "fit": "pindrive.fitting.estimation",
    "fit_friction": "pindrive.fitting.friction_curve",
    "load_device": "pindrive.files.device",
    "load_study": "pindrive.study.study",
    "local_sensitivity": "pindrive.study.sensitivity",
    "read_recording": "pindrive.fitting.recording",
    "robustness": "pindrive.study.robustness",
    "scan": "pindrive.device.scanning",
    "simulate": "pindrive.motion.simulate",
    "simulate_batch": "pindrive.motion.batch",
    "sobol": "pindrive.study.sensitivity",
}


def __getattr__(name: str) -> object:
    """Import a public name at its first use; `import pindrive` itself loads no other module."""
    from pindrive.lazy import attach

    get, _ = attach(__name__, _HOME)
    return get(name)


def __dir__() -> list[str]:
    """The public names alone."""
    return sorted(__all__)

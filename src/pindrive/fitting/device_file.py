"""A device file with fitted values: what the old one says, and where each new value comes from."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import Any

from pindrive.files.device import DeviceFile
from pindrive.files.device_text import device_text
from pindrive.files.keys import written
from pindrive.fitting.parameters import SENSOR, key_of
from pindrive.fitting.results import Estimate, Fit
from pindrive.motion.profile import Profile
from pindrive.quantities.quantity import significant


def fitted_file(device: DeviceFile, found: Fit, target: Path) -> str:
    """The text of a device file with the values of a fit.

    Every value that was fitted says its standard error, its interval and its recordings; values
    that keep a ratio to it have changed with it. Of several recordings with their own releases, the
    release of the first is written.

    Args:
        device: The file that the fit started from.
        found: The fit.
        target: File of the text; paths in the text are relative to its folder.
    """
    values = _values(device, found)
    values["drive.damping"] = written("drive.damping", found.drive.damping)
    comments: dict[str, list[str]] = {}
    for estimate in found.estimates:
        if estimate.parameter.key not in SENSOR and estimate.parameter.recording in (None, 0):
            comments.setdefault(key_of(estimate.parameter.key), []).append(_comment(estimate))
    names = ", ".join(recording.name for recording in found.recordings)
    lines = [
        f"{device.path.name}, fitted by pindrive to {names}.",
        f"Intervals hold {100.0 * found.confidence:g} %; status: {found.status.name}.",
        *found.warnings,
    ]
    return device_text(device, values, target, lines, comments)


def _values(device: DeviceFile, found: Fit) -> dict[str, Any]:
    """Return every value that differs from the device file, as TOML."""
    drive, release = found.drive, found.releases[0]
    values: dict[str, Any] = {"drive.mass": drive.mass, "drive.stiffness": drive.stiffness}
    for name, contact in (("plate", drive.plate), ("finger", drive.finger)):
        values[f"{name}.kinetic"] = contact.kinetic
        values[f"{name}.static"] = contact.static
        values[f"{name}.curve"] = contact.curve
        law = ("breakaway", "stribeck_velocity", "viscous")
        values |= {f"{name}.{part}": getattr(contact, part) for part in law}
        if name == "finger" and not contact.rigid:
            values[f"{name}.stiffness"] = contact.stiffness
    values["motion.displacement"] = release.displacement
    values["motion.velocity"] = release.velocity
    values["motion.mouse_velocity"] = release.mouse_velocity
    values["motion.plate_load"] = release.plate_load
    values["motion.force"] = release.force
    values["motion.across_velocity"] = release.across_velocity
    values["motion.finger_load"] = release.finger_load
    values["motion.skin_stretch"] = release.skin_stretch
    before = {k: v for k, v in device.values().items() if k not in device.derived}
    changed = {}
    for key, value in values.items():
        value = value.rows if isinstance(value, Profile) else value
        if value is None or value == before.get(key):
            continue
        changed[key] = written(key, value)
    return changed


def _comment(estimate: Estimate) -> str:
    """Return the quality of an estimate in a line."""
    unit, scale = estimate.parameter.scale
    low, high = (
        "open" if not isfinite(end) else significant(end * scale, 5) for end in estimate.interval
    )
    name = estimate.parameter.key
    value = f"{name} fitted: {significant(estimate.value * scale, 5)}"
    error = ""
    if isfinite(estimate.standard_error):
        error = f" ± {significant(estimate.standard_error * scale, 2)}"
    note = f"; {estimate.identifiability} identifiable" if estimate.explanation else ""
    return f"{value}{error} {unit}, interval {low} to {high} {unit}{note}".replace("  ", " ")

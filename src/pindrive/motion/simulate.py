"""The simulation of one release: its arguments checked, its warnings, the motion that follows."""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import cast

import pindrive
from pindrive import _core
from pindrive.motion.core_numbers import CoreNumbers
from pindrive.motion.drive import Drive
from pindrive.motion.function import Function
from pindrive.motion.motion import Motion, solve
from pindrive.motion.release import INPUTS, Release, check_fits, numbers_of
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.drive import DRIVE_QUANTITIES
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import QUANTITIES, check, warn_of

Progress = Callable[[float], None]

_SEEN = {quantity.name: quantity.seen for quantity in DRIVE_QUANTITIES if quantity.seen}
_GLANCE = (
    *(end for name in ("mass", "stiffness") for end in (_SEEN[name].lower, _SEEN[name].upper)),
    *(_SEEN[name].upper for name in ("damping", "plate.static", "finger.static")),
    *(_SEEN["finger.stiffness"].lower, _SEEN["finger.stiffness"].upper),
    _SEEN["finger.damping"].upper,
    *(_SEEN[name].upper for name in ("mouse_velocity", "plate_load", "displacement", "velocity")),
    *(_SEEN["duration"].lower, _SEEN["duration"].upper),
)
"""Plausible ranges of any device, in the order of `_plausible`."""


def simulate(
    drive: Drive | pindrive.DeviceFile,
    release: Release | None = None,
    *,
    duration: float | str | None = None,
    settling_band: float | str | None = None,
    progress: Progress | None = None,
) -> Motion:
    """Follow the pin of a drive from its release, exactly.

    Args:
        drive: The drive; its finger may be compliant, its contacts may have friction curves. Or
            what `load_device` reads, which has all arguments.
        release: The initial state, and the inputs that act on the pin; None: that of the device.
        duration: s, from 1e-12 to 1e12, and to 1e12 over the natural frequency; None: that of the
            device, or long enough to see the ending.
        settling_band: Half the band about the end in which the motion counts as settled, a part of
            |x(0) - x_end|, above 0 and at most 1; None: that of the device, or 0.05.
        progress: Function called with the simulated time, s, ten times a second, once the
            simulation has taken half a second.

    Returns:
        The motion. Sustained motions are recognised and reported in its `ending`.

    Raises:
        ValueError: A value is no number or out of its range; a compliant plate; a stretch that the
            skin cannot hold.

    Warns:
        ImplausibleValueWarning: a value that no such device has, such as a velocity in mm/s.
    """
    if not isinstance(drive, Drive) and isinstance(drive, pindrive.DeviceFile):
        release = drive.release if release is None else release
        duration = drive.duration if duration is None else duration
        settling_band = drive.settling_band if settling_band is None else settling_band
        drive = drive.drive
    band = _core.settling_band if settling_band is None else settling_band
    motion = simulated(
        drive, cast(Release, release), duration=duration, settling_band=band, progress=progress
    )
    release = motion.release
    if not _plausible(motion.core_numbers):
        given = motion.inputs()
        for name in ("velocity",) * (release.velocity is None) + ("duration",) * (duration is None):
            del given[name]
        for name, value in given.items():
            if name in QUANTITIES and not isinstance(value, str):
                warn_of(name, value, stacklevel=2)
        for name in INPUTS:
            if isinstance(function := getattr(release, name), Function):
                warn_of(name, function.size, stacklevel=2)
    return motion


def simulated(
    drive: Drive,
    release: Release,
    *,
    duration: float | str | None = None,
    settling_band: float | str = _core.settling_band,
    progress: Progress | None = None,
) -> Motion:
    """Simulate without warnings: for numbers that no person has written."""
    end = None if duration is None else check("duration", duration)
    check_fits(drive, release, end)
    if end is None:
        _check_end(release)
    if end is not None:
        keys = ("drive.mass", "drive.stiffness", "motion.duration")
        refuse(dict(zip(keys, (drive.mass, drive.stiffness, end), strict=True)))
    return solve(drive, release, end, check("settling_band", settling_band), progress)


def _check_end(release: Release) -> None:
    """Refuse functions that neither end nor repeat: the motion would never be known."""
    inputs = [getattr(release, name) for name in INPUTS]
    if any(isinstance(given, Function) for given in inputs):
        _, period, constant = _core.input_period([numbers_of(given) for given in inputs])
        if not (constant or period < inf):
            required = "given under functions that neither end nor repeat"
            raise ValueError(refusal("duration", required, None))


def motion_of(device: pindrive.DeviceFile, progress: Progress | None = None) -> Motion:
    """The release that a device file describes, without the warnings, which its reading gives."""
    return simulated(
        device.drive,
        device.release,
        duration=device.duration,
        settling_band=device.settling_band,
        progress=progress,
    )


def _plausible(numbers: CoreNumbers) -> bool:
    """Return True if `warn_of` has nothing to report, quickly: a motion takes microseconds."""
    mass, stiffness, damping, plate, finger, v_plate, load, x, v, *_ = numbers
    *_, force, across, finger_load, stops, duration, _ = numbers
    m0, m1, k0, k1, b1, plate1, finger1, skin0, skin1, damper1, speed1, load1, x1, v1, t0, t1 = (
        _GLANCE
    )
    return (
        m0 <= mass <= m1
        and k0 <= stiffness <= k1
        and damping <= b1
        and plate[1] <= plate1
        and finger[1] <= finger1
        and (skin0 <= finger[2] <= skin1 or finger[2] == inf)
        and finger[5] <= damper1
        and not (plate[3] or finger[3])
        and len(v_plate) == len(load) == len(force) == len(across) == len(finger_load) == 1
        and len(v_plate[0]) == len(load[0]) == len(force[0]) == len(finger_load[0]) == 2
        and force[0][1] == across[0][1] == 0.0
        and finger_load[0][1] == 1.0
        and stops[0] == inf
        and abs(v_plate[0][1]) <= speed1
        and load[0][1] <= load1
        and abs(x) <= x1
        and abs(v) <= v1
        and (t0 <= duration <= t1 or duration == inf)
    )

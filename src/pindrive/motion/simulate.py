"""The simulation of one release: its arguments checked, its warnings, the motion that follows."""

from __future__ import annotations

from math import inf, nan

import numpy as np

from pindrive import _core
from pindrive.motion.drive import (
    Drive,
    Profile,
    check_continuous,
    check_load,
    check_skin,
    check_stretch,
)
from pindrive.motion.motion import Motion
from pindrive.motion.results import (
    CoreNumbers,
    Rows,
)
from pindrive.quantities.drive import INPUTS
from pindrive.quantities.quantity import brief
from pindrive.quantities.table import QUANTITIES, check, refusal, warn_of

_SEEN = {quantity.name: quantity.seen for quantity in INPUTS if quantity.seen}
_GLANCE = (
    *(end for name in ("mass", "stiffness") for end in (_SEEN[name].lower, _SEEN[name].upper)),
    *(_SEEN[name].upper for name in ("damping", "plate.static", "finger.static")),
    *(_SEEN["finger.stiffness"].lower, _SEEN["finger.stiffness"].upper),
    *(_SEEN[name].upper for name in ("mouse_velocity", "plate_load", "displacement", "velocity")),
    *(_SEEN["duration"].lower, _SEEN["duration"].upper),
)
"""What any device has, in the order of `_plausible`."""


def simulate(
    drive: Drive,
    *,
    mouse_velocity: float | Profile,
    displacement: float = 0.0,
    velocity: float | None = None,
    plate_load: float | Profile = 1.0,
    skin_stretch: float | None = None,
    duration: float | None = None,
    settling_band: float = _core.settling_band,
) -> Motion:
    """Follow the pin of a drive from its release, exactly.

    Args:
        drive: the drive; its finger may be compliant, its contacts may have friction curves.
        mouse_velocity: v_p, the velocity at which the plate passes under the mouse, m/s, up to 1e12
            either way; constant or a `Profile` without steps, whose acceleration acts on the pin.
        displacement: x(0), deflection from the spring's rest, m, up to 1e12 either way.
        velocity: x'(0), m/s, up to 1e12 either way; None: the plate's, as for a pin that was
            carried.
        plate_load: factor on the plate's friction, from 0 to 1e12; constant or a `Profile`.
        skin_stretch: stretch of a compliant finger that grips at the start, m; None: the stretch of
            a finger being slid along or, for a pin at rest, none.
        duration: s, from 1e-12 to 1e12, and to 1e12 over the natural frequency; None: long enough
            to see the ending.
        settling_band: half the band about the end in which the motion counts as settled, a part of
            |x(0) - x_end|, above 0 and at most 1.

    Returns:
        The motion. Sustained motions are recognised and reported in its `ending`.

    Raises:
        ValueError: a value is no number or out of its range; a compliant plate; a stretch that the
            skin cannot hold; a friction curve at a compliant finger, or at a plate whose load
            changes: neither is piecewise linear.

    Warns:
        ImplausibleValueWarning: a value that no such device has, such as a velocity in mm/s.
    """
    motion = simulated(
        drive,
        mouse_velocity=mouse_velocity,
        displacement=displacement,
        velocity=velocity,
        plate_load=plate_load,
        skin_stretch=skin_stretch,
        duration=duration,
        settling_band=settling_band,
    )
    if not _plausible(motion.core_numbers):
        given = motion.inputs()
        for name in ("velocity",) * (velocity is None) + ("duration",) * (duration is None):
            del given[name]
        for name, value in given.items():
            warn_of(name, value, stacklevel=2)
    return motion


def simulated(
    drive: Drive,
    *,
    mouse_velocity: float | Profile,
    displacement: float = 0.0,
    velocity: float | None = None,
    plate_load: float | Profile = 1.0,
    skin_stretch: float | None = None,
    duration: float | None = None,
    settling_band: float = _core.settling_band,
) -> Motion:
    """What `simulate` does, without its warnings: for numbers that no person has written."""
    if not isinstance(drive, Drive):
        raise ValueError(refusal("drive", "a Drive", repr(drive)))
    v_plate = _rows(mouse_velocity, "mouse_velocity")
    load = _rows(plate_load, "plate_load")
    x = check("displacement", displacement)
    v = _value_at_start(v_plate) if velocity is None else check("velocity", velocity)
    end = inf if duration is None else check("duration", duration)
    band = check("settling_band", settling_band)
    if duration is not None:
        check_phase(end, drive.natural_frequency)
    plate, finger = drive.plate, drive.finger
    if not plate.rigid:
        raise ValueError(refusal("plate stiffness", "infinite", f"{plate.stiffness!r} N/m"))
    check_skin(finger)
    check_load(plate, plate_load)
    stretch = nan if skin_stretch is None else check("skin_stretch", skin_stretch)
    if skin_stretch is not None:
        check_stretch(stretch, finger)
    numbers = (
        drive.mass,
        drive.stiffness,
        drive.damping,
        (plate.kinetic, plate.static_friction, plate.stiffness, plate.curve or ()),
        (finger.kinetic, finger.static_friction, finger.stiffness, finger.curve or ()),
        v_plate,
        load,
        x,
        v,
        stretch,
        end,
    )
    with_plate = velocity is None
    return Motion(numbers, drive, mouse_velocity, x, v, plate_load, skin_stretch, with_plate, band)


def _rows(given: float | Profile, name: str) -> Rows:
    """An input as rows (time, value): one row is a constant."""
    if not isinstance(given, Profile):
        return [(0.0, check(name, given))]
    bounds, limits = QUANTITIES[name].bounds, QUANTITIES[name].limits
    if name == "mouse_velocity":
        check_continuous(given, "m/s")
    if not all(end in bounds and end in limits for end in (min(given.values), max(given.values))):
        for i, y in enumerate(given.values):
            check(name, y, label=f"{name} values[{i}]")
    if not given.changes:
        return [(0.0, given.values[0])]
    return list(given.rows)


def check_phase(
    duration: float, natural_frequency: float, *, where: str = "", label: str = "duration"
) -> None:
    """Refuse a duration (s) in which the phase grows beyond what doubles tell apart."""
    bounds = QUANTITIES["phase"].limits
    if duration * natural_frequency > bounds.upper:
        longest, phase = brief(bounds.upper / natural_frequency), brief(bounds.upper)
        required = f"at most {longest} s, {phase} over the natural frequency"
        raise ValueError(refusal(label, required, f"{duration!r} s", where))


def _plausible(numbers: CoreNumbers) -> bool:
    """Whether `warn_of` has nothing to say, quickly: a motion takes microseconds."""
    mass, stiffness, damping, plate, finger, v_plate, load, x, v, _, duration = numbers
    m0, m1, k0, k1, b1, plate1, finger1, skin0, skin1, speed1, load1, x1, v1, t0, t1 = _GLANCE
    return (
        m0 <= mass <= m1
        and k0 <= stiffness <= k1
        and damping <= b1
        and plate[1] <= plate1
        and finger[1] <= finger1
        and (skin0 <= finger[2] <= skin1 or finger[2] == inf)
        and not (plate[3] or finger[3])
        and len(v_plate) == len(load) == 1
        and abs(v_plate[0][1]) <= speed1
        and load[0][1] <= load1
        and abs(x) <= x1
        and abs(v) <= v1
        and (t0 <= duration <= t1 or duration == inf)
    )


def _value_at_start(rows: Rows) -> float:
    if len(rows) == 1:
        return rows[0][1]
    times, values = zip(*rows, strict=True)
    return float(np.interp(0.0, times, values))

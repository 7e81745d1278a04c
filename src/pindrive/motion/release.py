"""A release as data: the state in which the pin starts, and the inputs that act on it. SI units."""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import inf, nan
from typing import Any, Final, Literal, overload

from pindrive import _core
from pindrive.motion.core_numbers import ContactNumbers, CoreNumbers, DriveNumbers, Input, Rows
from pindrive.motion.drive import Contact, Drive, values_of
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile, check_continuous
from pindrive.quantities.contradictions import refuse
from pindrive.quantities.drive import SUPPORTS
from pindrive.quantities.refusal import Refusal, refusal
from pindrive.quantities.table import QUANTITIES, check, default
from pindrive.quantities.value import concise

INPUTS: Final = ("mouse_velocity", "plate_load", "force", "across_velocity", "finger_load")
"""Inputs of a release over time: a number, a `Profile` or a `Function` each."""

Support = Literal["mouse", "ground"]

LOADS: Final = ("plate_load", "finger_load")
"""Inputs that may not be negative."""

CONTINUOUS: Final = ("mouse_velocity", "across_velocity")
"""Inputs that may not have steps."""


@concise
@dataclass(frozen=True, slots=True, init=False)
class Release:
    """The initial state of a pin, and the inputs that act on it from t = 0 on.

    Every number may also be text with a unit, such as "60 mm/s"; a bare number is SI.

    Args:
        mouse_velocity: v_p, the velocity at which the plate passes under the mouse, m/s, up to 1e12
            either way; constant, or a `Profile` without steps, whose acceleration acts on the pin.
        displacement: x(0), deflection from the spring's rest, m, up to 1e12 either way.
        velocity: x'(0), m/s, up to 1e12 either way; None: the plate's, as for a pin that was
            carried.
        plate_load: Factor on the plate's friction, from 0 to 1e12; constant or a `Profile`.
        skin_stretch: Stretch of a compliant finger that grips at the start, m, up to 1e12 either
            way; None: the stretch of a finger being slid along or, for a pin at rest, none.
        force: External force on the pin, N, up to 1e12 either way, positive the way of x; constant
            or a `Profile`, which may have steps.
        across_velocity: W, the velocity of the plate across the axis of the pin, m/s, up to 1e12
            either way; constant, a `Profile` or a `Function`, without steps. While it is not 0 the
            plate slips: its friction opposes the whole sliding velocity.
        finger_load: Factor λ on the touch of the finger, from 0 to 1e12: the touch force over time,
            over the `touch_force` of a drive whose finger has a coefficient. Its friction changes
            as λⁿ, with the `load_exponent` n of the drive. Constant or a `Profile`, which may have
            steps.
        support: "mouse" for a spring that is fixed in the housing of the mouse, which accelerates
            with the mouse velocity, so that m dv/dt acts on the pin; "ground" for a spring that
            stands on the ground, while only the plate, such as a belt, has that velocity.

    Raises:
        ValueError: A value is not a number or out of its range, or the mouse velocity has a step.
    """

    mouse_velocity: float | Profile | Function
    displacement: float
    velocity: float | None
    plate_load: float | Profile | Function
    skin_stretch: float | None
    force: float | Profile | Function
    across_velocity: float | Profile | Function
    finger_load: float | Profile | Function
    support: Support

    def __init__(
        self,
        mouse_velocity: float | str | Profile | Function,
        displacement: float | str = default("displacement"),
        velocity: float | str | None = None,
        plate_load: float | str | Profile | Function = default("plate_load"),
        skin_stretch: float | str | None = None,
        force: float | str | Profile | Function = default("force"),
        across_velocity: float | str | Profile | Function = default("across_velocity"),
        finger_load: float | str | Profile | Function = default("finger_load"),
        support: Support = "mouse",
    ) -> None:
        """Validate, and keep plain floats."""
        put = object.__setattr__
        put(self, "mouse_velocity", input_of("mouse_velocity", mouse_velocity))
        put(self, "displacement", check("displacement", displacement))
        put(self, "velocity", None if velocity is None else check("velocity", velocity))
        put(self, "plate_load", input_of("plate_load", plate_load))
        stretch = None if skin_stretch is None else check("skin_stretch", skin_stretch)
        put(self, "skin_stretch", stretch)
        put(self, "force", input_of("force", force))
        put(self, "across_velocity", input_of("across_velocity", across_velocity))
        put(self, "finger_load", input_of("finger_load", finger_load))
        if support not in SUPPORTS:
            required = " or ".join(f'"{name}"' for name in SUPPORTS)
            raise ValueError(refusal("support", required, repr(support)))
        put(self, "support", support)

    def replace(self, **changes: Any) -> Release:
        """A release with other values of the arguments of `Release`.

        Raises:
            ValueError: A value is invalid, as for `Release`.
            TypeError: An argument is unknown.
        """
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        return Release(**given | changes)

    @property
    def initial_velocity(self) -> float:
        """x'(0), m/s: the one that was given, or the plate's."""
        if self.velocity is not None:
            return self.velocity
        return initial(self.mouse_velocity)


def initial(given: float | Profile | Function) -> float:
    """Return an input at t = 0."""
    return given if isinstance(given, float) else given(0.0)


@overload
def input_of(name: str, given: float | str | Profile) -> float | Profile: ...
@overload
def input_of(name: str, given: float | str | Profile | Function) -> float | Profile | Function: ...
def input_of(name: str, given: float | str | Profile | Function) -> float | Profile | Function:
    """Return a constant, a profile or a function, with each value checked."""
    if not isinstance(given, (Profile, Function)):
        return check(name, given)
    quantity = QUANTITIES[name]
    bounds, limits = quantity.bounds, quantity.limits
    if given.unit and given.unit != quantity.unit:
        other = "plain numbers" if given.unit == "1" else f"values in {given.unit}"
        raise ValueError(refusal(name, f"a {type(given).__name__} of {quantity.kinds}", other))
    if isinstance(given, Function):
        _check_function(name, given)
        return given
    if name in CONTINUOUS:
        check_continuous(name, given)
    if not all(end in bounds and end in limits for end in (min(given.values), max(given.values))):
        for i, y in enumerate(given.values):
            check(name, y, label=f"{name} values[{i}]")
    return given


def _check_function(name: str, given: Function) -> None:
    """Refuse a function that jumps, where the input may not."""
    _, (jumps, before, after) = _core.function_range(given.core, 0.0)
    if name in CONTINUOUS and jumps < inf:
        required = "without a step (a jump would take an infinite force)"
        raise ValueError(
            refusal(name, required, f"one from {before!r} to {after!r} at {jumps!r} s")
        )


def negative_load(name: str, given: object, duration: float | None) -> Refusal | None:
    """Return the refusal of a load that becomes negative within a duration, s; None: for ever."""
    if not isinstance(given, Function):
        return None
    (time, least), _ = _core.function_range(given.core, inf if duration is None else duration)
    if least >= -1e-9:
        return None
    until = "at all times" if duration is None else f"until the end of the motion at {duration!r} s"
    return refusal(name, f">= 0 {until}", f"{least!r} at {time!r} s")


def check_fits(drive: Drive, release: Release, duration: float | None = None) -> None:
    """Refuse a drive and a release that the core cannot follow together.

    Args:
        drive: Drive of the pin.
        release: Initial state and inputs.
        duration: End of the motion, s. None: its ending.

    Raises:
        ValueError: A curve has another form, the plate is compliant, the skin cannot hold the
            stretch, the displacement is beyond rigid end stops, or a load becomes negative.
    """
    if not isinstance(drive, Drive):
        raise ValueError(refusal("drive", "a Drive", repr(drive)))
    if not isinstance(release, Release):
        raise ValueError(refusal("release", "a Release", repr(release)))
    if not drive.plate.rigid:
        raise ValueError(refusal("plate stiffness", "infinite", f"{drive.plate.stiffness!r} N/m"))
    finger = drive.finger
    by_rows = not finger.rigid and (finger.curved or not finger.damping)
    if isinstance(release.finger_load, Function) and by_rows:
        required = "a number or a Profile beside a finger stiffness without damping, or a curve"
        raise ValueError(refusal("finger_load", required, "a Function"))
    if drive.load_exponent != 1.0 and not isinstance(release.finger_load, float):
        _check_raised(drive, release.finger_load, by_rows)
    for name in LOADS:
        refused = negative_load(name, getattr(release, name), duration)
        if refused:
            raise ValueError(refused)
    if drive.travel is not None or release.skin_stretch is not None:
        refuse(values_of(drive) | _start_of(release))


def _start_of(release: Release) -> dict[str, Any]:
    """The values of a start that others limit, by key."""
    start = {"motion.displacement": release.displacement}
    if release.skin_stretch is not None:
        start["motion.skin_stretch"] = release.skin_stretch
        start["motion.finger_load"] = initial(release.finger_load)
    return start


def core_numbers(drive: Drive, release: Release, duration: float | None) -> CoreNumbers:
    """A drive, a release and a duration (s; None: until the ending is seen) as the core has it."""
    mass, stiffness, damping, plate, finger, stops = drive_numbers(drive)
    return (
        mass,
        stiffness,
        damping,
        plate,
        finger,
        numbers_of(release.mouse_velocity),
        numbers_of(release.plate_load),
        release.displacement,
        release.initial_velocity,
        nan if release.skin_stretch is None else release.skin_stretch,
        numbers_of(release.force),
        numbers_of(release.across_velocity),
        numbers_of(release.finger_load),
        stops,
        inf if duration is None else duration,
        float(SUPPORTS.index(release.support)),
    )


def _check_raised(drive: Drive, load: Profile | Function, by_rows: bool) -> None:
    """Refuse a touch that changes under a `load_exponent` in a way that is not followed."""
    exponent = f"at a load_exponent of {drive.load_exponent:g}"
    if isinstance(load, Function):
        raise ValueError(refusal("finger_load", f"a number or a Profile {exponent}", "a Function"))
    if by_rows and load.changes:
        skin = "beside a finger stiffness without damping, or a curve"
        raise ValueError(refusal("finger_load", f"constant {exponent} {skin}", "a Profile"))


def drive_numbers(drive: Drive) -> DriveNumbers:
    """A drive as the core has it."""
    plate, finger = drive.plate, drive.finger
    return (
        drive.mass,
        drive.stiffness,
        drive.damping,
        _contact_numbers(plate, 1.0),
        _contact_numbers(finger, drive.load_exponent),
        stop_numbers(drive),
    )


def _contact_numbers(contact: Contact, load_exponent: float) -> ContactNumbers:
    return (
        contact.kinetic,
        contact.static_friction,
        contact.stiffness,
        contact.curve or (),
        contact.law_numbers,
        contact.damping or 0.0,
        load_exponent,
    )


def stop_numbers(drive: Drive) -> tuple[float, float, float]:
    """Travel (m), stiffness (N/m) and damping (N*s/m) of the end stops as the core has them."""
    return (
        inf if drive.travel is None else drive.travel,
        inf if drive.stop_stiffness is None else drive.stop_stiffness,
        drive.stop_damping or 0.0,
    )


def numbers_of(given: float | Profile | Function) -> Input:
    """An input as rows (time, value), one row for a constant; or the pieces of a function."""
    return given.core if isinstance(given, Function) else rows_of(given)


def rows_of(given: float | Profile) -> Rows:
    """An input as rows (time, value): one row is a constant."""
    if not isinstance(given, Profile):
        return [(0.0, given)]
    return list(given.rows) if given.changes else [(0.0, given.values[0])]

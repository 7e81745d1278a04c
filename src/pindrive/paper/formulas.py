"""The paper's closed-form analysis, equations (2) to (26), corrected.

Every function takes `Releases` and gives an array of its shape. The formulas describe the pin from
its release until friction first changes sign, at t_1 (`first_reversal_time`); before they describe
it at all, three things must hold (`applies`): the drive is underdamped, and the spring and the
damper together pull harder than the plate's friction, backwards. Elsewhere the answer is NaN.

In the docstrings α = -b / 2m, d = x_0 - x_d, and "printed" is what the paper has where it slips.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.device.trajectory import roots
from pindrive.lazy import xr
from pindrive.motion.batch import batched
from pindrive.motion.drive import Contact, Drive
from pindrive.motion.release import Release
from pindrive.quantities.quantity import NON_NEGATIVE
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import QUANTITIES

Array = NDArray[np.float64]

__all__ = [
    "acceleration",
    "amplitude",
    "applies",
    "coefficients",
    "damped_frequency",
    "decay_rate",
    "first_reversal_time",
    "forward_velocity",
    "friction_offset",
    "initial_phase",
    "limit_damping_ratio",
    "limit_reversal_time",
    "natural_frequency",
    "peak_displacement",
    "peak_time",
    "periods_to_rest",
    "position",
    "return_velocity",
    "return_velocity_time",
    "reversals_to_steady",
    "steady_amplitude",
    "swing",
    "time_to_steady",
    "trough_displacement",
    "trough_time",
    "velocity",
    "velocity_phase",
]

UNIT_DRIVE: Final = Drive(
    mass=1.0, stiffness=1.0, damping=0.0, plate=Contact(0.0), finger=Contact(0.0)
)
UNIT_RELEASE: Final = Release(mouse_velocity=0.0, displacement=1.0)
"""A drive without friction and damping, and its release, in units of m, x_0 and 1/ω_0."""

_QUANTITY: Final = {"friction": "plate.kinetic"}
"""Quantity with the bounds of a field, if its name differs."""
_ARGUMENT: Final = {"friction": "plate_kinetic"}
"""Argument name of a field in `simulate_batch`, if it differs."""


@dataclass(frozen=True, init=False, eq=False)
class Releases:
    """The release that equations (2) to (26) describe: of a pin that the plate carried.

    One contact, the plate, with kinetic = static friction; the finger is frictionless. Each
    argument is a number or an array of numbers, SI; they broadcast against each other.

    Args:
        mass: m, kg, above 0.
        stiffness: K, N/m, above 0.
        damping: B, N·s/m, at least 0.
        friction: Friction force of the plate, N, at least 0: F_2 in the paper's x_d = F_2 / k.
        mouse_velocity: v_p, m/s, at least 0; for a negative one mirror the release. It is also the
            pin's velocity at the release.
        displacement: x_0, m.

    Raises:
        ValueError: A value is not a number or out of its range, or the shapes do not broadcast.
    """

    mass: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]
    friction: NDArray[np.float64]
    mouse_velocity: NDArray[np.float64]
    displacement: NDArray[np.float64]

    def __init__(
        self,
        *,
        mass: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike,
        friction: ArrayLike,
        mouse_velocity: ArrayLike,
        displacement: ArrayLike,
    ) -> None:
        given = (mass, stiffness, damping, friction, mouse_velocity, displacement)
        names = [field.name for field in fields(self)]
        checked = [_checked(name, values) for name, values in zip(names, given, strict=True)]
        try:
            arrays = np.broadcast_arrays(*checked)
        except ValueError:
            shapes = ", ".join(f"{n} {a.shape}" for n, a in zip(names, checked, strict=True))
            raise ValueError(refusal("release", "of shapes that broadcast", shapes)) from None
        for name, array in zip(names, arrays, strict=True):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of every field, and of every answer."""
        return self.mass.shape

    def take(self, index: slice | NDArray[np.bool_]) -> Releases:
        """Return some releases, by a slice or a mask of their (one-dimensional) arrays."""
        return Releases(**{field.name: getattr(self, field.name)[index] for field in fields(self)})

    def replace(self, **changes: ArrayLike) -> Releases:
        """Return the releases with other values for some fields."""
        return Releases(
            **{f.name: changes.get(f.name, getattr(self, f.name)) for f in fields(self)}
        )

    def batch(
        self, *, outputs: Sequence[str] | None = None, **others: ArrayLike | None
    ) -> xr.Dataset:
        """The exact numbers of every release, the finger frictionless.

        Args:
            outputs: Names of the outputs, as for `simulate_batch`.
            others: Values in place of, or beside, the arrays of the releases, as for
                `simulate_batch`.
        """
        given = {_ARGUMENT.get(f.name, f.name): getattr(self, f.name) for f in fields(self)}
        return batched(UNIT_DRIVE, UNIT_RELEASE, given | others, outputs=outputs)


def _checked(name: str, values: ArrayLike) -> NDArray[np.float64]:
    quantity = QUANTITIES[_QUANTITY.get(name, name)]
    bounds = NON_NEGATIVE if name == "mouse_velocity" else quantity.bounds
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(refusal(name, quantity.kinds, repr(values))) from None
    bad = [value for value in array.flat if float(value) not in bounds]
    if bad:
        shown = f"{float(bad[0])!r} {quantity.unit}"
        raise ValueError(refusal(name, bounds.words(quantity.unit), shown))
    return array


# ---- the oscillator: (2), (3) --------------------------------------------------------------------


def natural_frequency(r: Releases) -> Array:
    """ω_0 = sqrt(k / m), rad/s, of (2)."""
    return np.sqrt(r.stiffness / r.mass)


def friction_offset(r: Releases) -> Array:
    """x_d = F / k, m, of (2): where spring and friction balance while the pin slides backwards.

    F is the plate's friction. (2) calls it F_2, which in (1) is the finger's: the analysis drops
    the finger, and its friction changes sign at x' = v_p, which is the plate's condition.
    """
    return r.friction / r.stiffness


def decay_rate(r: Releases) -> Array:
    """α = -b / 2m, 1/s, of (3); never positive."""
    return -r.damping / (2 * r.mass)


def damped_frequency(r: Releases) -> Array:
    """ω = sqrt(ω_0² - α²), rad/s, (3); NaN for a drive that is not underdamped."""
    w0, a = natural_frequency(r), -decay_rate(r)
    square = (w0 - a) * (w0 + a)
    return np.sqrt(np.where(square > 0.0, square, np.nan))


def applies(r: Releases) -> NDArray[np.bool_]:
    """Return True if (4) to (26) describe the pin right after its release.

    Underdamped, and k x_0 + b v_p >= F. Below that the plate carries the pin on; below -F friction
    pulls the other way from the start.
    """
    pull = r.stiffness * r.displacement + r.damping * r.mouse_velocity
    return (pull >= r.friction) & ~np.isnan(damped_frequency(r))


# ---- the motion: (4) to (11) ---------------------------------------------------------------------


def coefficients(r: Releases) -> tuple[Array, Array]:
    """C_1 and C_2 of (4) and (5), m: C_1 = d, C_2 = (v_p - α d) / ω."""
    d = np.where(applies(r), r.displacement - friction_offset(r), np.nan)
    return d, (r.mouse_velocity - decay_rate(r) * d) / damped_frequency(r)


def amplitude(r: Releases) -> Array:
    """X_m,0 = sqrt(C_1² + C_2²), m, (7)."""
    return np.hypot(*coefficients(r))


def velocity_phase(r: Releases) -> Array:
    """φ'_0 = arctg(-α / ω), rad, (10): by how much the velocity leads.

    Printed also as arctg(b ω_0 / sqrt(4k² - b²)), which lacks an ω_0²: right is
    b ω_0 / sqrt(4k² - b² ω_0²) = b / sqrt(4mk - b²).
    """
    return np.arctan2(-decay_rate(r), damped_frequency(r))


def initial_phase(r: Releases) -> Array:
    """φ_0, rad, (8), from φ'_0 up to φ'_0 + π.

    Printed as arctg(v_p / (ω d) - α / ω), which is in the wrong quadrant where x_0 < x_d. The angle
    of (C_1, C_2) is φ_0 up to whole turns, and of these that one is needed with which (13) to
    (26) are times after the release. φ_0 - φ'_0 is the angle of (ω_0² d - α v_p, ω v_p), which has
    no turns to choose.
    """
    d, _ = coefficients(r)
    along = natural_frequency(r) ** 2 * d - decay_rate(r) * r.mouse_velocity
    return velocity_phase(r) + np.arctan2(damped_frequency(r) * r.mouse_velocity, along)


def position(t: ArrayLike, r: Releases) -> Array:
    """x(t), m, (6), at times t (s) that broadcast against the release; holds until t_1."""
    t = np.asarray(t, dtype=np.float64)
    wave: Array = np.cos(damped_frequency(r) * t - initial_phase(r))
    return _fading(r, t) * amplitude(r) * wave + friction_offset(r)


def velocity(t: ArrayLike, r: Releases) -> Array:
    """x'(t), m/s, (9); holds until t_1. Right as printed, with the right φ_0 and φ'_0."""
    t = np.asarray(t, dtype=np.float64)
    wave: Array = np.sin(damped_frequency(r) * t - initial_phase(r) + velocity_phase(r))
    return -_fading(r, t) * natural_frequency(r) * amplitude(r) * wave


def acceleration(t: ArrayLike, r: Releases) -> Array:
    """x''(t), m/s², (11); holds until t_1. Right as printed, with the right φ_0 and φ'_0."""
    t = np.asarray(t, dtype=np.float64)
    wave: Array = np.cos(damped_frequency(r) * t - initial_phase(r) + 2 * velocity_phase(r))
    return -_fading(r, t) * natural_frequency(r) ** 2 * amplitude(r) * wave


def _fading(r: Releases, t: Array) -> Array:
    """e^(αt)."""
    fading: Array = np.exp(decay_rate(r) * t)
    return fading


# ---- the first swing: (12) to (20) ---------------------------------------------------------------
#
# At an extreme of x the wave of (6) stands at cos φ'_0, not at 1: that is the factor missing in
# (14), (16), (17) and, for the velocity's extreme, in (20).


def peak_time(r: Releases) -> Array:
    """t_a = (φ_0 - φ'_0) / ω, s, (13): the first displacement maximum; always before t_1."""
    return (initial_phase(r) - velocity_phase(r)) / damped_frequency(r)


def peak_displacement(r: Releases) -> Array:
    """x_m,a = e^(α t_a) X_m,0 cos φ'_0 + x_d, m, (14); printed without cos φ'_0."""
    return _extreme(r, peak_time(r)) + friction_offset(r)


def trough_time(r: Releases) -> Array:
    """t_c = t_a + π / ω, s, (15): the minimum that follows; never after t_1."""
    return peak_time(r) + np.pi / damped_frequency(r)


def trough_displacement(r: Releases) -> Array:
    """x_m,c = -e^(α t_c) X_m,0 cos φ'_0 + x_d, m, (16); printed without cos φ'_0."""
    return -_extreme(r, trough_time(r)) + friction_offset(r)


def swing(r: Releases) -> Array:
    """x_m,a - x_m,c = X_m,0 cos φ'_0 e^(α t_a) (1 + e^(α π / ω)), m, (17).

    Printed without cos φ'_0, and with an index p that means nothing.
    """
    return _extreme(r, peak_time(r)) * (1 + _fading(r, np.pi / damped_frequency(r)))


def return_velocity_time(r: Releases) -> Array:
    """t_b = (π/2 + φ_0 - 2 φ'_0) / ω, s, (18) and (19): between t_a and t_c."""
    quarter = np.pi / 2 + initial_phase(r) - 2 * velocity_phase(r)
    return quarter / damped_frequency(r)


def return_velocity(r: Releases) -> Array:
    """v_m,b = -e^(α t_b) ω_0 X_m,0 cos φ'_0, m/s, (20): the extreme velocity on the way back.

    Printed without cos φ'_0.
    """
    return -natural_frequency(r) * _extreme(r, return_velocity_time(r))


def _extreme(r: Releases, t: Array) -> Array:
    """Return the distance of an oscillation from its middle at its extreme at t."""
    return _fading(r, t) * amplitude(r) * np.cos(velocity_phase(r))


# ---- when the plate's velocity is reached: (21) to (26) ------------------------------------------


def first_reversal_time(r: Releases) -> Array:
    """t_1, s, the root of (21) and (22): the pin comes back to the plate's velocity.

    The paper calls it analytically impossible; it is the exact root that the core isolates, in
    every case. NaN where the velocity does not come up to v_p again, or there is no friction.
    """
    late = limit_reversal_time(r) * (1 + 1e-9)
    found = r.batch(duration=np.where(late > 0.0, late, 1.0))
    times = found["transient_first_reversal_time"].to_numpy()
    return np.where(late > 0.0, times, np.nan)


def limit_reversal_time(r: Releases) -> Array:
    """(3π/2 + φ_0 - 2 φ'_0) / ω, s, (25) and (26): the velocity's extreme on the way forward.

    It is t_1 in the limit case, in which that extreme just touches v_p, and the latest that t_1 can
    be. Printed with π/2 for 3π/2: that is t_b, where the pin moves backwards.
    """
    return return_velocity_time(r) + np.pi / damped_frequency(r)


def forward_velocity(r: Releases) -> Array:
    """The extreme velocity on the way forward, m/s: (21) at the time (26).

    In the limit case it is v_p. (23) is meant to say so but
    has 2 φ'_0 where (9) and (21) have φ'_0.
    """
    return natural_frequency(r) * _extreme(r, limit_reversal_time(r))


def limit_damping_ratio(r: Releases) -> Array:
    """The damping ratio of the limit case: with more, v_p is never reached after this release.

    Where the extreme (26) of the velocity is v_p, by bisection: (26) gives t_1 there, but not
    when the case occurs. The number depends on v_p / (ω_0 d) alone. 0 where no drive with
    damping reaches v_p (x_0 <= x_d), 1 for v_p = 0. The damping of `r` does not matter.
    """
    each = r.replace(**{f.name: getattr(r, f.name).reshape(-1, 1) for f in fields(r)})

    def beyond(ratio: Array) -> Array:
        damped = each.replace(damping=2 * ratio * np.sqrt(each.mass * each.stiffness))
        return np.where(forward_velocity(damped) >= each.mouse_velocity, 1.0, -1.0)

    least, most = np.full(each.mass.size, np.finfo(float).eps), np.ones(each.mass.size)
    return roots(beyond, least, most, most).reshape(r.shape)


# ---- the steady state, and rest ------------------------------------------------------------------


def steady_amplitude(r: Releases) -> Array:
    """v_p / ω_0, m: of the oscillation that lasts, undamped, about x_d with a frictionless finger.

    The paper gives it as a bound, x_m <= v_p / ω_0. From this release it is reached: the pin comes
    to graze the plate's velocity once a period. NaN with damping or without plate friction.
    """
    lasts = (r.damping == 0.0) & (r.friction > 0.0)
    return np.where(lasts, r.mouse_velocity / natural_frequency(r), np.nan)


def reversals_to_steady(r: Releases) -> Array:
    """Return the sign changes of friction until the plate carries the undamped pin, as floats.

    It is at v_p at the places x_0 → 2 x_d - x_0 → -2 x_d - x_1 …, until |x| <= x_d. The paper's
    0.5 (x_0 / x_d + 1) "periods" are these: their whole part, but where it is whole already.
    Infinite without friction, NaN with damping.
    """
    x, xd = np.abs(r.displacement), friction_offset(r)
    with np.errstate(divide="ignore", invalid="ignore"):
        count = np.ceil(np.maximum(x / xd - 1, 0.0) / 2)
    count = np.where(x <= xd, 0.0, count)
    return np.where(r.damping == 0.0, count, np.nan)


def time_to_steady(r: Releases) -> Array:
    """Return the begin of the steady oscillation of `steady_amplitude`, s: the transitional period.

    The sum of the swings between the reversals and of the last carried stretch, up to x_d. For
    v_p = 0 the pin then rests. Infinite without friction, NaN with damping.
    """
    w0, xd, v = natural_frequency(r), friction_offset(r), r.mouse_velocity
    count = reversals_to_steady(r)
    side = np.where(r.displacement > 0.0, 1.0, -1.0)
    time = count * np.pi / w0
    most = np.max(count, where=np.isfinite(count), initial=0.0)
    for j in range(int(most)):
        # The j-th swing is about ±x_d, longer than half a period backwards, shorter forwards.
        off = np.abs(r.displacement) - (2 * j + 1) * xd
        turn = side * (-1) ** j * 2 * np.arctan2(v, w0 * off)
        time = time + np.where(j < count, turn / w0, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        last = side * (-1) ** count * (np.abs(r.displacement) - 2 * count * xd)
        carried = np.where(v > 0.0, (xd - last) / v, 0.0)
    return np.where(np.isfinite(count), time + carried, count)


def periods_to_rest(r: Releases, finger_friction: ArrayLike) -> Array:
    """Return the periods after its last break-away in which the undamped pin comes to rest.

    Each half swing takes 2 x_f from the amplitude, x_f = finger friction / k. The paper has
    v_p / (4 x_f ω_0), calling x_f x_d; the exact number is ceil(v_p / (2 x_f ω_0)) / 2 - 1/4, which
    differs by a quarter period at the most. The transitional period also has what came before, and
    the last carried stretch.

    Args:
        r: The release, with the plate's friction, which does not matter here.
        finger_friction: Kinetic = static friction of the finger, N, at least 0.

    Raises:
        ValueError: A finger friction is below 0 or no number.
    """
    xf = np.asarray(finger_friction, dtype=np.float64) / r.stiffness
    if not np.all(xf >= 0.0):
        least = f"{np.min(np.asarray(finger_friction)):g} N"
        raise ValueError(refusal("finger_friction", "at least 0 N", least))
    with np.errstate(divide="ignore", invalid="ignore"):
        halves = np.ceil(r.mouse_velocity / (2 * xf * natural_frequency(r)))
    periods = np.where(r.mouse_velocity == 0.0, 0.0, halves / 2 - 0.25)
    return np.where(r.damping == 0.0, periods, np.nan)

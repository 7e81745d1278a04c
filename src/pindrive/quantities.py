"""The table of quantities: every number that goes in or comes out, named, bounded and sourced once.

Command-line flags, device files, error messages, table headings and file attributes read it.
Only the standard library is imported, so that a command starts fast.
"""

from __future__ import annotations

from math import inf
from operator import index
from typing import Final, SupportsFloat, SupportsIndex, cast

from pindrive.quantities_device import DEVICE_INPUTS, DEVICE_PARTS, PIN
from pindrive.quantities_judge import JUDGE
from pindrive.quantities_magnet import SHARE
from pindrive.quantity import (
    FINITE,
    NON_NEGATIVE,
    POSITIVE,
    POSITIVE_OR_RIGID,
    Bounds,
    Quantity,
)

PAPER: Final = '"Dynamics of tactile device drive"'
STEEL: Final = (
    "steel on steel, friction coefficient 0.15-0.30 (handbook tables), {} of a weight of 98 mN"
)
FINGER: Final = "ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, Table 1"

# What the core is given stays within 1e±12 SI, beyond any device by far. Then rates, sqrt(k/m) and
# b/m, stay within 1e±24, forces under load below 1e24, lengths F/k below 1e36, energies k x² below
# 1e84, and what the certificate bounds, the fifth derivative of a length, below 1e156: in doubles,
# which end at 1e308, nothing overflows, nor does what matters vanish below 1e-308. A friction or a
# start that is still smaller (a velocity of 1e-17, rounded from 0) acts as 0 where its square does.
#
# A phase ω t is known to 1e-16 of itself: after 1e12 rad to four digits, beyond 1e16 to none. So a
# duration ends there, and a damping ratio, by whose inverse a motion outlasts its period, is 0 or
# above 1e-11. Beyond 1e6 the two rates of a mode, ω/(2ζ) and 2ζω, lie so far apart that a velocity
# has lost four of its digits beside the other wave's.
LARGEST: Final = 1e12
SMALLEST: Final = 1e-12
EITHER_WAY: Final = Bounds(-LARGEST, LARGEST, True, True)
FROM_ZERO: Final = Bounds(0.0, LARGEST, True, True)
ABOVE_ZERO: Final = Bounds(SMALLEST, LARGEST, True, True)
OR_INFINITE: Final = Bounds(SMALLEST, LARGEST, True, True, also=(inf,))
RATIOS: Final = Bounds(1e-11, 1e6, True, True, also=(0.0,))
PHASES: Final = Bounds(0.0, 1e12, True, True)


def _seen(lowest: float, highest: float) -> Bounds:
    return Bounds(lowest, highest, True, True)


INPUTS: Final[tuple[Quantity, ...]] = (
    Quantity(
        "mass",
        "m",
        "kg",
        "moving mass: electromagnet and pin",
        POSITIVE,
        0.010,
        "assumed: 1.2 cm3 of iron and copper, 8.4 g/cm3",
        "drive",
        seen=_seen(1e-6, 5.0),
        limits=ABOVE_ZERO,
    ),
    Quantity(
        "stiffness",
        "k",
        "N/m",
        "stiffness of the spring that holds the electromagnet",
        POSITIVE,
        100.0,
        "assumed: a natural frequency of 16 Hz with a mass of 10 g",
        "drive",
        seen=_seen(1e-5, 1e7),
        limits=ABOVE_ZERO,
    ),
    Quantity(
        "damping",
        "b",
        "N*s/m",
        "viscous damping of the drive",
        NON_NEGATIVE,
        None,
        "the damping ratio 0.16 below, with m = 10 g and k = 100 N/m",
        "drive",
        optional=True,
        example=0.32,
        remark="give this or damping_ratio",
        seen=_seen(0.0, 1e5),
        limits=FROM_ZERO,
    ),
    Quantity(
        "damping_ratio",
        "ζ",
        "1",
        "damping over critical damping, b / (2 sqrt(m k))",
        NON_NEGATIVE,
        0.16,
        f"{PAPER}, Fig. 4: 0.04, 0.16, 0.32, read as ratios; the middle one",
        "drive",
        optional=True,
        remark="give this or damping",
        seen=_seen(0.0, 1e3),
        limits=RATIOS,
    ),
    Quantity(
        "plate.kinetic",
        "F_p",
        "N",
        "friction force of the plate while sliding, magnet off",
        NON_NEGATIVE,
        0.022,
        STEEL.format("0.225 (the middle)"),
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "plate.static",
        "F_p,s",
        "N",
        "largest friction force of the plate without sliding",
        NON_NEGATIVE,
        0.0265,
        STEEL.format("0.27 (oxidised)"),
        optional=True,
        remark="the kinetic one unless given",
        follows=("plate.kinetic",),
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "plate.curve",
        "F_p(|u|)",
        "N",
        "friction force of the plate over sliding speed, linear between rows",
        NON_NEGATIVE,
        source=STEEL.format("0.225 falling to 0.15 (the lowest)"),
        optional=True,
        remark="speeds from 0 m/s up; kinetic may then be left out",
        rows_of="curve",
        rows=((0.0, 0.022), (0.05, 0.015)),
        follows=("plate.kinetic",),
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "finger.kinetic",
        "F_f",
        "N",
        "friction force of the finger while sliding",
        NON_NEGATIVE,
        0.005,
        "skin, friction coefficient 0.5 (Derler & Gerhardt, review), of 10 mN of touch, assumed",
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "finger.static",
        "F_f,s",
        "N",
        "largest friction force of the finger without sliding",
        NON_NEGATIVE,
        0.0075,
        f"1.5 times the kinetic one, as 2.1 to 1.4 in {FINGER}",
        optional=True,
        remark="the kinetic one unless given",
        follows=("finger.kinetic",),
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "finger.curve",
        "F_f(|u|)",
        "N",
        "friction force of a rigid finger over sliding speed, linear between rows",
        NON_NEGATIVE,
        source="assumed: by a fifth less at 50 mm/s",
        optional=True,
        remark="speeds from 0 m/s up; kinetic may then be left out",
        rows_of="curve",
        rows=((0.0, 0.005), (0.05, 0.004)),
        follows=("finger.kinetic",),
        seen=_seen(0.0, 1e3),
        limits=FROM_ZERO,
    ),
    Quantity(
        "finger.stiffness",
        "k_f",
        "N/m",
        "tangential stiffness of the finger's skin, which stretches before it slips",
        POSITIVE,
        None,
        FINGER,
        optional=True,
        example=1000.0,
        remark="rigid unless given",
        seen=_seen(1e-2, 1e12),
        limits=ABOVE_ZERO,
    ),
    Quantity(
        "mouse_velocity",
        "v_p",
        "m/s",
        "velocity of the plate under the mouse",
        FINITE,
        0.060,
        "hand speed 20-100 mm/s in finger studies (arXiv 2505.11162); the middle",
        "motion",
        remark="its sign is the direction; one value, or rows over time",
        rows_of="profile",
        rows=((0.0, 0.060), (0.1, 0.0)),
        seen=_seen(0.0, 5.0),
        limits=EITHER_WAY,
    ),
    Quantity(
        "plate_load",
        "λ",
        "1",
        "factor on the plate's friction, as the magnet pulls or lets go",
        NON_NEGATIVE,
        None,
        "assumed: a magnet that held the pin with four times its weight lets go in 5 ms",
        "motion",
        optional=True,
        remark="1 unless given; one value, or rows over time",
        example=1.0,
        rows_of="profile",
        rows=((0.0, 5.0), (0.005, 1.0)),
        seen=_seen(0.0, 1e4),
        limits=FROM_ZERO,
    ),
    Quantity(
        "displacement",
        "x_0",
        "m",
        "deflection of the pin from the spring's rest at release",
        FINITE,
        0.002,
        "assumed: the pin was carried along a line 2 mm wide",
        "motion",
        optional=True,
        remark="0 m unless given",
        seen=_seen(0.0, 0.1),
        limits=EITHER_WAY,
    ),
    Quantity(
        "velocity",
        "v_0",
        "m/s",
        "velocity of the pin in the mouse at release",
        FINITE,
        None,
        f"{PAPER}: the pin is released while the plate carries it",
        "motion",
        optional=True,
        example=0.060,
        remark="the plate's velocity unless given",
        seen=_seen(0.0, 50.0),
        limits=EITHER_WAY,
    ),
    Quantity(
        "skin_stretch",
        "s_0",
        "m",
        "stretch of a compliant finger's skin that grips the pin at release",
        FINITE,
        None,
        "assumed: half of what static friction holds, 7.5 mN / (1000 N/m)",
        "motion",
        optional=True,
        example=3.75e-6,
        remark="that of skin slid along, for a pin at rest none, unless given",
        follows=("finger.static", "finger.stiffness"),
        seen=_seen(0.0, 0.05),
        limits=EITHER_WAY,
    ),
    Quantity(
        "duration",
        "T",
        "s",
        "how long the motion is followed",
        POSITIVE,
        None,
        "a few periods of the slow decay",
        "motion",
        optional=True,
        example=0.3,
        remark="long enough to see how it ends unless given",
        seen=_seen(1e-6, 1e7),
        limits=ABOVE_ZERO,
    ),
    Quantity(
        "settling_band",
        "ε",
        "1",
        "half the band about the end in which the motion counts as settled, of |x(0) - x_end|",
        SHARE,
        0.05,
        "usual beside 2 % in control engineering",
        "motion",
        optional=True,
        remark="0.05 unless given",
    ),
)
"""What a device file may give, in its order."""

PARTS: Final[tuple[Quantity, ...]] = (
    Quantity(
        "kinetic", "F", "N", "friction force of a sliding contact", NON_NEGATIVE, limits=FROM_ZERO
    ),
    Quantity(
        "static",
        "F_s",
        "N",
        "largest friction force without sliding",
        NON_NEGATIVE,
        limits=FROM_ZERO,
    ),
    Quantity(
        "contact.stiffness",
        "k_c",
        "N/m",
        "tangential stiffness of a contact",
        POSITIVE_OR_RIGID,
        limits=OR_INFINITE,
    ),
    Quantity(
        "curve.speed",
        "|u|",
        "m/s",
        "sliding speed in a friction curve",
        NON_NEGATIVE,
        limits=FROM_ZERO,
    ),
    Quantity(
        "curve.force",
        "F(|u|)",
        "N",
        "kinetic friction in a friction curve",
        NON_NEGATIVE,
        limits=FROM_ZERO,
    ),
    Quantity(
        "curve.slope",
        "dF/d|u|",
        "N*s/m",
        "slope of a friction curve between rows",
        FINITE,
        limits=EITHER_WAY,
    ),
    Quantity("profile.time", "t", "s", "time of a profile's row", FINITE, limits=EITHER_WAY),
    Quantity("profile.value", "y", "1", "value of a profile's row", FINITE, limits=EITHER_WAY),
    Quantity(
        "profile.rate", "dy/dt", "1/s", "rate of a profile between rows", FINITE, limits=EITHER_WAY
    ),
    Quantity("natural_frequency", "ω_0", "rad/s", "undamped natural frequency, sqrt(k/m)"),
    Quantity(
        "phase", "ω_0 T", "rad", "natural frequency times duration", NON_NEGATIVE, limits=PHASES
    ),
)
"""What the parts of a drive are made of in Python, and what follows from them."""

COLUMNS: Final[dict[str, tuple[str, str]]] = {
    "curve": ("curve.speed", "curve.force"),
    "profile": ("profile.time", "profile.value"),
    "places": ("place.x", "place.y"),
}
"""What stands in the rows of a curve, of a profile and of places, by the names of the parts."""

_USE: Final[tuple[tuple[str, str, str, str], ...]] = (
    ("reversals", "n_{}", "", "times the sliding velocity reached zero, {}"),
    ("time_stuck", "t_{},stuck", "s", "time stuck, {}"),
    ("distance_slid", "s_{}", "m", "distance slid, {}"),
    ("dissipated", "W_{}", "J", "energy turned into heat, {}"),
    ("peak_force", "R_{},max", "N", "largest friction force on the pin, {}"),
)

TRANSIENT: Final[tuple[Quantity, ...]] = (
    Quantity(
        "transient.peak_displacement",
        "x_m,a",
        "m",
        "displacement at the first turning point on the way out",
        source=f"{PAPER}, (14)",
    ),
    Quantity(
        "transient.peak_time",
        "t_a",
        "s",
        "time of the peak displacement",
        source=f"{PAPER}, (13)",
    ),
    Quantity(
        "transient.trough_displacement",
        "x_m,c",
        "m",
        "displacement at the turning point that follows the peak",
        source=f"{PAPER}, (16)",
    ),
    Quantity(
        "transient.trough_time",
        "t_c",
        "s",
        "time of the trough",
        source=f"{PAPER}, (15)",
    ),
    Quantity(
        "transient.swing",
        "x_m,a - x_m,c",
        "m",
        "from peak to trough",
        source=f"{PAPER}, (17)",
    ),
    Quantity(
        "transient.return_velocity",
        "v_m,b",
        "m/s",
        "extreme velocity on the way back",
        source=f"{PAPER}, (20)",
    ),
    Quantity(
        "transient.return_velocity_time",
        "t_b",
        "s",
        "time of the extreme return velocity",
        source=f"{PAPER}, (19)",
    ),
    Quantity(
        "transient.first_reversal_time",
        "t_1",
        "s",
        "first time the pin stops sliding on the plate",
        source=f"{PAPER}, (21)",
    ),
    Quantity(
        "transient.settling_time",
        "t_s",
        "s",
        "from then on within the settling band about the resting place",
        source=f"{PAPER}, the time of the transitional period",
    ),
    Quantity(
        "transient.rest_time",
        "t_r",
        "s",
        "from then on at rest for good; infinite for a motion that never comes to rest",
    ),
    Quantity(
        "transient.last_event_time",
        "t_e",
        "s",
        "last change at a contact; 0 without any, infinite where they go on for ever",
    ),
    Quantity(
        "transient.peak_stretch", "s_max", "m", "largest stretch of a compliant finger's skin"
    ),
    Quantity(
        "transient.peak_stretch_rate", "s'_max", "m/s", "largest rate at which that skin stretched"
    ),
    Quantity("transient.settled", "", "", "whether the motion settled in its duration"),
    *(
        Quantity(
            f"transient.{contact}.{name}",
            symbol.format(contact[0]),
            unit,
            meaning.format(where),
        )
        for contact, where in (("plate", "at the plate"), ("finger", "at the finger"))
        for name, symbol, unit, meaning in _USE
    ),
)
"""The numbers of a transient."""

ENDING: Final[tuple[Quantity, ...]] = (
    Quantity("ending.position", "x_end", "m", "resting place, or middle of the final oscillation"),
    Quantity("ending.steady_since", "t_end", "s", "when the final oscillation began"),
    Quantity("ending.amplitude", "X_end", "m", "amplitude of the final oscillation"),
    Quantity("ending.period", "T_end", "s", "period of the final oscillation"),
)
"""How a motion ends, in numbers."""

FINAL: Final[tuple[Quantity, ...]] = (
    Quantity("final.position", "x_T", "m", "position at the end of the duration, or at rest"),
    Quantity("final.velocity", "v_T", "m/s", "velocity at the end of the duration, or at rest"),
)
"""The state at the end, which `simulate_batch` gives on request."""

ENERGY: Final[tuple[Quantity, ...]] = (
    Quantity("energy.kinetic_start", "E_k,0", "J", "kinetic energy at release"),
    Quantity("energy.kinetic_end", "E_k", "J", "kinetic energy at the end"),
    Quantity("energy.spring_start", "E_s,0", "J", "energy in the spring at release"),
    Quantity("energy.spring_end", "E_s", "J", "energy in the spring at the end"),
    Quantity("energy.skin_start", "E_f,0", "J", "energy in a compliant finger at release"),
    Quantity("energy.skin_end", "E_f", "J", "energy in a compliant finger at the end"),
    Quantity("energy.plate_work", "W_in", "J", "work that the moving plate puts in"),
    Quantity("energy.inertia_work", "W_a", "J", "work of the accelerating housing"),
    Quantity("energy.damper_dissipated", "W_b", "J", "energy turned into heat in the damper"),
    Quantity("energy.plate_dissipated", "W_p", "J", "energy turned into heat at the plate"),
    Quantity("energy.finger_dissipated", "W_f", "J", "energy turned into heat at the finger"),
    Quantity("energy.residual", "W_res", "J", "what the terms leave over: rounding alone"),
)
"""The energy ledger of a motion."""

CERTIFICATE: Final[tuple[Quantity, ...]] = (
    Quantity("certificate.motion_law", "r_a", "1", "equation of motion between events"),
    Quantity("certificate.kinematics", "r_v", "1", "velocity is the rate of position"),
    Quantity("certificate.friction_law", "r_k", "1", "kinetic friction where a contact slides"),
    Quantity("certificate.force_bound", "r_F", "1", "friction within its bounds"),
    Quantity("certificate.sliding_sign", "r_s", "1", "friction opposes sliding"),
    Quantity("certificate.sticking", "r_0", "1", "a stuck contact does not slide"),
    Quantity("certificate.continuity", "r_c", "1", "position and velocity without jumps"),
    Quantity(
        "certificate.transitions", "r_t", "1", "breaks loose or crosses only where it cannot hold"
    ),
    Quantity("certificate.energy", "r_E", "1", "the energy ledger closes"),
    Quantity("certificate.dissipation", "r_D", "1", "friction and damper never feed energy in"),
)
"""The largest residual of each law, relative to the size of its terms."""

OUTPUTS: Final[tuple[Quantity, ...]] = TRANSIENT + ENDING + ENERGY + CERTIFICATE

DEVICE: Final[tuple[Quantity, ...]] = DEVICE_INPUTS + DEVICE_PARTS + PIN + JUDGE
"""What the whole device adds."""

QUANTITIES: Final[dict[str, Quantity]] = {
    q.name: q for q in INPUTS + PARTS + OUTPUTS + FINAL + DEVICE
}


def refusal(label: str, required: str, given: object, where: str = "") -> str:
    """The one wording of a refused value: place, quantity, what it must be, what it was."""
    return f"{where}: {label} must be {required}, got {given}".removeprefix(": ")


def check(
    name: str,
    value: SupportsFloat,
    *,
    where: str = "",
    label: str | None = None,
    given: str | None = None,
) -> float:
    """`value` as a float, if it is a number that the quantity called `name` may take.

    Args:
        name: a name of the table.
        value: SI value.
        where: the place it was written, said first in the message: file and key.
        label: what the message calls the quantity; its name unless given.
        given: how the value was written, for the message; `value` with its SI unit unless given.

    Raises:
        ValueError: no number, not finite, or out of bounds.
    """
    quantity = QUANTITIES[name]
    label = name if label is None else label
    if type(value) is float:
        number = value
    elif isinstance(value, (list, tuple)) or getattr(value, "shape", None):
        many = "one number; simulate_batch takes arrays"
        if quantity.rows_of == "profile":
            many = "a number or a Profile of what changes over time; simulate_batch takes arrays"
        size = getattr(value, "shape", None)
        shown = f"{len(cast(list[object], value))} values" if size is None else f"an array {size}"
        raise ValueError(refusal(label, many, shown, where))
    else:
        try:
            if isinstance(value, (str, bytes, bool)):
                raise TypeError
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(refusal(label, quantity.kind, repr(value), where)) from None
    if required := quantity.required(number):
        unit = "" if quantity.unit == "1" else quantity.unit
        shown = given if given is not None else f"{number!r} {unit}".rstrip()
        raise ValueError(refusal(label, required, shown, where))
    return number


def check_whole(
    value: object, label: str, least: int = 1, most: int | None = None, *, where: str = ""
) -> int:
    """`value` as an int, if it is a whole number from `least` up, to `most` where that is given.

    Truth values are none, nor are floats; NumPy's integers are.

    Raises:
        ValueError: it is something else.
    """
    upper = f"from {least} to {most}" if most is not None else f"of at least {least}"
    try:
        number = least - 1 if isinstance(value, bool) else index(cast(SupportsIndex, value))
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        raise ValueError(refusal(label, f"a whole number {upper}", repr(value), where))
    return number

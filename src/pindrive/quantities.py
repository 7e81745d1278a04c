"""The table of quantities: every number that goes in or comes out, named, bounded and sourced once.

Command-line flags, device files, error messages, table headings and file attributes read it.
Only the standard library is imported, so that a command starts fast.
"""

from __future__ import annotations

from typing import Final, SupportsFloat

from pindrive.quantities_device import DEVICE_INPUTS, DEVICE_PARTS, PIN
from pindrive.quantities_judge import JUDGE
from pindrive.quantity import (
    FINITE,
    NON_NEGATIVE,
    POSITIVE,
    POSITIVE_OR_RIGID,
    Quantity,
)

PAPER: Final = '"Dynamics of tactile device drive"'
STEEL: Final = (
    "steel on steel, friction coefficient 0.15-0.30 (handbook tables), {} of a weight of 98 mN"
)
FINGER: Final = "ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, Table 1"

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
    ),
    Quantity(
        "plate.kinetic",
        "F_p",
        "N",
        "friction force of the plate while sliding, magnet off",
        NON_NEGATIVE,
        0.022,
        STEEL.format("0.225 (the middle)"),
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
    ),
    Quantity(
        "finger.kinetic",
        "F_f",
        "N",
        "friction force of the finger while sliding",
        NON_NEGATIVE,
        0.005,
        "skin, friction coefficient 0.5 (Derler & Gerhardt, review), of 10 mN of touch, assumed",
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
    ),
)
"""What a device file may give, in its order."""

PARTS: Final[tuple[Quantity, ...]] = (
    Quantity("kinetic", "F", "N", "friction force of a sliding contact", NON_NEGATIVE),
    Quantity("static", "F_s", "N", "largest friction force without sliding", NON_NEGATIVE),
    Quantity(
        "contact.stiffness", "k_c", "N/m", "tangential stiffness of a contact", POSITIVE_OR_RIGID
    ),
    Quantity("curve.speed", "|u|", "m/s", "sliding speed in a friction curve", NON_NEGATIVE),
    Quantity("curve.force", "F(|u|)", "N", "kinetic friction in a friction curve", NON_NEGATIVE),
    Quantity("profile.time", "t", "s", "time of a profile's row", FINITE),
    Quantity("profile.value", "y", "1", "value of a profile's row", FINITE),
    Quantity(
        "settling_band", "ε", "1", "band of the settling time, a part of |x(0) - x_end|", POSITIVE
    ),
    Quantity(
        "natural_frequency", "ω_0", "rad/s", "undamped natural frequency, sqrt(k/m)", POSITIVE
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
        "from then on within 5 % of the way to the resting place",
        source=f"{PAPER}, the time of the transitional period",
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
    Quantity("ending.since", "t_end", "s", "since when the motion is at rest or steady"),
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
    else:
        try:
            if isinstance(value, (str, bytes, bool)):
                raise TypeError
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            raise ValueError(
                refusal(label, f"a number in {quantity.unit}", repr(value), where)
            ) from None
    if number not in quantity.bounds:
        unit = "" if quantity.unit == "1" else quantity.unit
        shown = given if given is not None else f"{number!r} {unit}".rstrip()
        raise ValueError(refusal(label, quantity.bounds.words(unit), shown, where))
    return number

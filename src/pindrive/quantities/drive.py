"""The table of quantities, first part: the drive, its inputs, and what follows from them.

Only the standard library and the core are imported here and in the other parts, so that a command
starts fast.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Any, Final

from pindrive import _core
from pindrive.quantities.quantity import (
    FINITE,
    FINITE_OR_NOT,
    NON_NEGATIVE,
    PAPER,
    POSITIVE,
    POSITIVE_OR_RIGID,
    Bounds,
    Quantity,
    between,
    inputs,
)

STEEL: Final = (
    "steel on steel, friction coefficient 0.15-0.30 (handbook tables), {} of a weight of 98 mN"
)
FINGER: Final = "ROBOMECH J. 2017, 10.1186/s40648-017-0080-8, Table 1"
EXPONENT: Final = (
    "fingers: 1 on rough or fresh contacts, 2/3 to 1 on smooth ones after some 10 s (Dzidek et al. "
    "2014 and 2017, 10.1098/rsif.2016.0935), 0.8 from 1 to 20 N (Seo et al. 2009, "
    "10.1080/00140130802471595), also above 1 (10.3390/applmech3020038)"
)

# The parts of a drive stay within 1e±12 SI as its inputs do (include/pindrive/device/inputs.hpp).
#
# A phase ω t is known to 1e-16 of itself: after 1e12 rad to four digits, beyond 1e16 to none.
EITHER_WAY: Final = between(-1e12, 1e12)
FROM_ZERO: Final = between(0.0, 1e12)
ABOVE_ZERO: Final = between(1e-12, 1e12)
OR_INFINITE: Final = Bounds(1e-12, 1e12, True, True, also=inf)
COMPUTED: Final = {
    FINITE: EITHER_WAY,
    NON_NEGATIVE: FROM_ZERO,
    POSITIVE: ABOVE_ZERO,
    POSITIVE_OR_RIGID: OR_INFINITE,
}
"""Computable intervals of the parts of a drive."""
PHASES: Final = between(0.0, 1e12)


def _computed(rows: tuple[Quantity, ...]) -> tuple[Quantity, ...]:
    """Rows whose limits follow from their bounds unless they have their own."""
    return tuple(
        replace(row, limits=COMPUTED.get(row.bounds, row.limits))
        if row.limits is FINITE_OR_NOT
        else row
        for row in rows
    )


_DRIVE: Final = (
    Quantity(
        "mass",
        "m",
        "kg",
        "moving mass: the body held by the spring",
        0.010,
        "assumed: 1.2 cm3 of iron and copper, 8.4 g/cm3",
        seen=between(1e-6, 5.0),
        mandatory=True,
    ),
    Quantity(
        "stiffness",
        "k",
        "N/m",
        "stiffness of the spring that holds the body",
        100.0,
        "assumed: a natural frequency of 16 Hz with a mass of 10 g",
        seen=between(1e-5, 1e7),
        mandatory=True,
    ),
    Quantity(
        "damping",
        "b",
        "N*s/m",
        "viscous damping of the drive",
        source="the damping ratio 0.16 below, with m = 10 g and k = 100 N/m",
        example=0.32,
        remark="give this or damping_ratio",
        seen=between(0.0, 1e5),
    ),
    Quantity(
        "damping_ratio",
        "ζ",
        "1",
        "damping over critical damping, b / (2 sqrt(m k))",
        0.16,
        f"{PAPER}, Fig. 4: 0.04, 0.16, 0.32, read as ratios; the middle one",
        remark="give this or damping",
        seen=between(0.0, 1e3),
    ),
    Quantity(
        "travel",
        "x_s",
        "m",
        "travel of the pin from the spring's rest to its end stops, either way",
        source="assumed: a pin 1 mm thick in a slot 5 mm long",
        example=0.002,
        remark="no end stops unless given",
        seen=between(1e-6, 0.1),
    ),
    Quantity(
        "stop_stiffness",
        "k_s",
        "N/m",
        "stiffness of the end stops, which push and never pull",
        source="assumed: rubber, a hundred times as stiff as the spring",
        example=1e4,
        remark="rigid and plastic unless given: a pin that strikes loses its velocity",
        seen=between(1e-2, 1e12),
    ),
    Quantity(
        "stop_damping",
        "b_s",
        "N*s/m",
        "damping of elastic end stops",
        source="assumed: a pin returns with half its speed",
        example=4.0,
        remark="none unless given; needs stop_stiffness",
        seen=between(0.0, 1e5),
    ),
)

SUPPORTS: Final = ("mouse", "ground")
"""Bodies on which the spring of a pin may stand, in the order of their numbers."""

FRICTION_LAWS: Final = tuple(_core.friction_laws)
"""Names of the friction laws, in the order of their numbers."""

Given = tuple[Any, str]
"""A value, or rows, and the source."""


def _friction(
    contact: str,
    letter: str,
    *,
    words: tuple[str, str, str],
    kinetic: Given,
    static: Given,
    curve: Given,
    coefficient: Given,
    static_coefficient: Given,
    coefficient_curve: Given,
    breakaway: Given,
    velocity: Given,
    viscous: Given,
    breakaway_coefficient: Given,
    viscous_coefficient: Given,
) -> tuple[Quantity, ...]:
    """The friction of a contact, by forces and by coefficients.

    `words` are what is said of its force, what has a curve, and what its coefficients are of.
    """
    sliding, curved, presses = words
    forces, plain = between(0.0, 1e3), between(0.0, 10.0)

    def rows(name: str, symbol: str, unit: str, what: str, of: str, given: Given) -> Quantity:
        return Quantity(
            f"{contact}.{name}",
            f"{symbol}_{letter}(|u|)",
            unit,
            f"friction {what} of {curved} over sliding speed, linear between rows",
            source=given[1],
            remark=f"speeds from 0 m/s up; {of} may then be left out",
            rows_of=name,
            rows=given[0],
            follows=(f"{contact}.{of}",),
            seen=forces if unit == "N" else plain,
            bounds=NON_NEGATIVE,
        )

    def falling(
        name: str, symbol: str, unit: str, what: str, given: Given, seen: Bounds
    ) -> Quantity:
        of = "kinetic" if unit == "N" else "coefficient"
        return Quantity(
            f"{contact}.{name}",
            symbol,
            unit,
            f"{what} of the {contact} at rest, from which it falls to the kinetic one",
            source=given[1],
            example=given[0],
            remark="needed with the laws stribeck and hess-soom",
            follows=(f"{contact}.{of}",),
            seen=seen,
        )

    return inputs(
        "",
        Quantity(
            f"{contact}.kinetic",
            f"F_{letter}",
            "N",
            f"friction force of the {contact} while sliding{sliding}",
            *kinetic,
            seen=forces,
            mandatory=True,
            alternative=tuple(
                f"{contact}.{n}" for n in ("curve", "coefficient", "coefficient_curve")
            ),
            bounds=NON_NEGATIVE,
        ),
        Quantity(
            f"{contact}.static",
            f"F_{letter},s",
            "N",
            f"largest friction force of the {contact} without sliding",
            *static,
            remark="the kinetic one unless given",
            follows=(f"{contact}.kinetic",),
            seen=forces,
            bounds=NON_NEGATIVE,
        ),
        rows("curve", "F", "N", "force", "kinetic", curve),
        Quantity(
            f"{contact}.coefficient",
            f"μ_{letter}",
            "1",
            f"kinetic friction coefficient of the {contact}, over {presses}",
            source=coefficient[1],
            example=coefficient[0],
            remark="in place of the forces kinetic, static and curve",
            seen=plain,
            bounds=NON_NEGATIVE,
        ),
        Quantity(
            f"{contact}.static_coefficient",
            f"μ_{letter},s",
            "1",
            "friction coefficient at rest",
            source=static_coefficient[1],
            example=static_coefficient[0],
            remark="the kinetic one unless given",
            follows=(f"{contact}.coefficient",),
            seen=plain,
            bounds=NON_NEGATIVE,
        ),
        rows("coefficient_curve", "μ", "1", "coefficient", "coefficient", coefficient_curve),
        Quantity(
            f"{contact}.law",
            f"law_{letter}",
            "1",
            "law of kinetic friction over sliding speed |u|: stribeck, kinetic + (breakaway - "
            "kinetic) exp(-(|u|/stribeck_velocity)^exponent); hess-soom, kinetic + (breakaway - "
            "kinetic) / (1 + (|u|/stribeck_velocity)^2); coulomb; table, a curve",
            source="Armstrong, Dupont, Canudas de Wit 1994, Automatica 30:1083; Hess & Soom 1990, "
            "J. Tribology 112:147",
            remark="coulomb unless given, or table with a curve",
            example=1.0,
            choices=FRICTION_LAWS,
        ),
        falling("breakaway", f"F_{letter},b", "N", "friction force", breakaway, forces),
        Quantity(
            f"{contact}.stribeck_velocity",
            f"v_{letter},s",
            "m/s",
            f"Stribeck velocity of the {contact}: sliding speed over which friction falls",
            source=velocity[1],
            example=velocity[0],
            remark="needed with the laws stribeck and hess-soom",
            seen=between(1e-6, 10.0),
        ),
        Quantity(
            f"{contact}.exponent",
            f"δ_{letter}",
            "1",
            "exponent of the law stribeck: 1 or 2",
            source="Tustin 1947 (1), Armstrong-Helouvry 1991 (2)",
            remark="1 unless given",
            example=1.0,
        ),
        Quantity(
            f"{contact}.viscous",
            f"c_{letter}",
            "N*s/m",
            "viscous part of friction: force per sliding speed, under any law",
            source=viscous[1],
            example=viscous[0],
            remark="none unless given",
            seen=between(0.0, 1e4),
        ),
        falling(
            "breakaway_coefficient",
            f"μ_{letter},b",
            "1",
            "friction coefficient",
            breakaway_coefficient,
            plain,
        ),
        Quantity(
            f"{contact}.viscous_coefficient",
            f"γ_{letter}",
            "s/m",
            "viscous part of the friction coefficient, per sliding speed",
            source=viscous_coefficient[1],
            example=viscous_coefficient[0],
            remark="none unless given",
            seen=between(0.0, 1e4),
        ),
    )


_CONTACTS: Final = (
    *_friction(
        "plate",
        "p",
        words=(", at plate_load 1", "the plate", "weight, preload, touch and pull"),
        kinetic=(0.022, STEEL.format("0.225 (the middle)")),
        static=(0.0265, STEEL.format("0.27 (oxidised)")),
        curve=(((0.0, 0.022), (0.05, 0.015)), STEEL.format("0.225 falling to 0.15 (the lowest)")),
        coefficient=(0.225, "steel on steel, 0.15-0.30 (handbook tables); the middle"),
        static_coefficient=(0.27, "steel on steel, oxidised, 0.27 (handbook tables)"),
        coefficient_curve=(
            ((0.0, 0.225), (0.05, 0.15)),
            "steel on steel, 0.225 falling to 0.15 (the lowest)",
        ),
        breakaway=(0.0265, STEEL.format("0.27 (oxidised)")),
        velocity=(0.03, "assumed: half the hand's speed"),
        viscous=(0.02, "assumed: a force of 1.2 mN at 60 mm/s"),
        breakaway_coefficient=(0.27, "steel on steel, oxidised, 0.27 (handbook tables)"),
        viscous_coefficient=(0.2, "assumed: 0.012 at 60 mm/s"),
    ),
    *inputs(
        "plate",
        Quantity(
            "preload",
            "W_0",
            "N",
            "force that presses the body on the plate beside its weight and the pull",
            source="assumed: none, the weight alone presses",
            example=0.0,
            seen=between(0.0, 1e3),
        ),
        Quantity(
            "touch_share",
            "s_f",
            "1",
            "part of the touch force that presses the body on the plate",
            source="the pin is pressed on the supporting surface (the paper); less where the "
            "spring carries the touch",
            example=1.0,
        ),
    ),
    *_friction(
        "finger",
        "f",
        words=("", "a rigid finger", "touch_force"),
        kinetic=(
            0.005,
            "skin, friction coefficient 0.5 (Derler & Gerhardt, review), of 10 mN of touch, "
            "assumed",
        ),
        static=(0.0075, f"1.5 times the kinetic one, as 2.1 to 1.4 in {FINGER}"),
        curve=(((0.0, 0.005), (0.05, 0.004)), "assumed: by a fifth less at 50 mm/s"),
        coefficient=(0.5, "skin, typically 0.5 (Derler & Gerhardt, review)"),
        static_coefficient=(0.75, f"1.5 times the kinetic one, as 2.1 to 1.4 in {FINGER}"),
        coefficient_curve=(((0.0, 0.5), (0.05, 0.4)), "assumed: by a fifth less at 50 mm/s"),
        breakaway=(0.0075, f"1.5 times the kinetic one, as 2.1 to 1.4 in {FINGER}"),
        velocity=(0.03, "assumed: half the hand's speed"),
        viscous=(0.005, "assumed: a force of 0.3 mN at 60 mm/s"),
        breakaway_coefficient=(0.75, f"1.5 times the kinetic one, as 2.1 to 1.4 in {FINGER}"),
        viscous_coefficient=(0.5, "assumed: 0.03 at 60 mm/s"),
    ),
    *inputs(
        "finger",
        Quantity(
            "touch_force",
            "N_f",
            "N",
            "force with which the finger presses on the pin",
            source="assumed: a light touch",
            example=0.010,
            remark="needed where a coefficient gives the finger's friction",
            seen=between(0.0, 1e3),
        ),
        Quantity(
            "load_exponent",
            "n_f",
            "1",
            "exponent of the finger's friction over its touch force",
            source=EXPONENT,
            example=1.0,
            remark="1 is Coulomb's law; another needs reference_touch",
        ),
        Quantity(
            "reference_touch",
            "N_0",
            "N",
            "touch force at which the finger's coefficients hold",
            source="assumed: coefficients of a whole finger are measured near 1 N",
            example=1.0,
            remark="without effect at a load_exponent of 1",
            seen=between(1e-4, 1e3),
        ),
    ),
    *inputs(
        "",
        Quantity(
            "finger.stiffness",
            "k_f",
            "N/m",
            "tangential stiffness of the finger's skin, which stretches before it slips",
            source=FINGER,
            example=1000.0,
            remark="rigid unless given",
            seen=between(1e-2, 1e12),
        ),
        Quantity(
            "finger.damping",
            "b_f",
            "N*s/m",
            "tangential damping of the finger's skin, parallel to its stiffness",
            source=FINGER,
            example=1.0,
            remark="none unless given",
            seen=between(0.0, 1e3),
        ),
    ),
)

_MOTION: Final = (
    Quantity(
        "mouse_velocity",
        "v_p",
        "m/s",
        "velocity of the plate under the mouse",
        0.060,
        "hand speed 20-100 mm/s in finger studies (arXiv 2505.11162); the middle",
        remark="its sign is the direction; one value, rows over time, or a CSV of them or of a "
        "recorded hand",
        rows_of="profile",
        rows=((0.0, 0.060), (0.1, 0.0)),
        seen=between(0.0, 5.0),
        mandatory=True,
    ),
    Quantity(
        "plate_load",
        "λ",
        "1",
        "factor on the plate's friction, raised by the pull of a magnet",
        source="assumed: a magnet that held the pin with four times its weight releases it in 5 ms",
        remark="one value, rows over time, or a CSV of them",
        example=1.0,
        rows_of="profile",
        rows=((0.0, 5.0), (0.005, 1.0)),
        seen=between(0.0, 1e4),
    ),
    Quantity(
        "force",
        "F_e",
        "N",
        "external force on the pin, positive in the direction of x",
        source="assumed: a finger that pushes the pin for 20 ms",
        remark="one value, rows over time, or a CSV of them",
        example=0.010,
        rows_of="profile",
        rows=((0.0, 0.010), (0.020, 0.0)),
        seen=between(0.0, 1e3),
    ),
    Quantity(
        "across_velocity",
        "w",
        "m/s",
        "transverse velocity of the plate, which prevents stick",
        source="assumed: a hand that moves 10 degrees off the axis",
        remark="one value, rows over time, or a CSV of them",
        example=0.010,
        rows_of="profile",
        rows=((0.0, 0.010), (0.1, 0.0)),
        seen=between(0.0, 5.0),
    ),
    Quantity(
        "finger_load",
        "λ_f",
        "1",
        "factor on the finger's touch: the touch force over time, over touch_force",
        source="assumed: a finger that lifts off the pin within 20 ms",
        remark="one value, rows over time, or a CSV of them",
        example=1.0,
        rows_of="profile",
        rows=((0.0, 1.0), (0.020, 0.0)),
        seen=between(0.0, 1e4),
    ),
    Quantity(
        "displacement",
        "x_0",
        "m",
        "deflection of the pin from the spring's rest at release",
        0.002,
        "assumed: the pin was carried along a line 2 mm wide",
        seen=between(0.0, 0.1),
    ),
    Quantity(
        "velocity",
        "v_0",
        "m/s",
        "velocity of the pin in the mouse at release",
        source=f"{PAPER}: the pin is released while the plate carries it",
        example=0.060,
        remark="the plate's velocity unless given",
        seen=between(0.0, 50.0),
    ),
    Quantity(
        "skin_stretch",
        "s_0",
        "m",
        "skin stretch of a compliant finger that sticks to the pin at release",
        source="assumed: half of what static friction holds, 7.5 mN / (1000 N/m)",
        example=3.75e-6,
        remark="that of sliding skin, or zero for a pin at rest, unless given",
        follows=("finger.static", "finger.stiffness"),
        seen=between(0.0, 0.05),
    ),
    Quantity(
        "support",
        "frame",
        "1",
        "body on which the spring stands: mouse, which accelerates with mouse_velocity, or ground, "
        "beside which only the plate, such as a belt, has that velocity",
        source="a belt beside a bench",
        example=1.0,
        remark="mouse unless given",
        choices=SUPPORTS,
    ),
    Quantity(
        "duration",
        "T",
        "s",
        "duration of the simulated motion",
        source="a few periods of the slow decay",
        example=0.3,
        remark="until the ending is known unless given",
        seen=between(1e-6, 1e7),
    ),
    Quantity(
        "settling_band",
        "ε",
        "1",
        "half-width of the settling band about the end, over |x(0) - x_end|",
        0.05,
        "usual beside 2 % in control engineering",
    ),
)
DRIVE_QUANTITIES: Final = inputs("drive", *_DRIVE) + _CONTACTS + inputs("motion", *_MOTION)
"""Keys of a device file, in order."""

_PARTS: Final = (
    Quantity("kinetic", "F", "N", "friction force of a sliding contact", bounds=NON_NEGATIVE),
    Quantity(
        "static",
        "F_s",
        "N",
        "largest friction force without sliding",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "contact.stiffness",
        "k_c",
        "N/m",
        "tangential stiffness of a contact",
        bounds=POSITIVE_OR_RIGID,
    ),
    Quantity(
        "contact.damping",
        "b_c",
        "N*s/m",
        "tangential damping of a contact",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "curve.speed",
        "|u|",
        "m/s",
        "sliding speed in a friction curve",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "curve.force",
        "F(|u|)",
        "N",
        "kinetic friction in a friction curve",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "curve.coefficient",
        "μ(|u|)",
        "1",
        "friction coefficient in a friction curve",
        bounds=NON_NEGATIVE,
    ),
    Quantity("coefficient", "μ", "1", "friction force over normal force", bounds=NON_NEGATIVE),
    Quantity(
        "static_coefficient",
        "μ_s",
        "1",
        "friction coefficient of a sticking contact",
        bounds=NON_NEGATIVE,
    ),
    Quantity(
        "normal_force",
        "N",
        "N",
        "normal force of a contact: weight, preload, touch and pull, or the touch alone",
        bounds=NON_NEGATIVE,
    ),
    Quantity("profile.time", "t", "s", "time of a profile's row", bounds=FINITE),
    Quantity("profile.value", "y", "1", "value of a profile's row", bounds=FINITE),
    Quantity("profile.rate", "dy/dt", "1/s", "rate of a profile between rows", bounds=FINITE),
    Quantity("natural_frequency", "ω_0", "rad/s", "undamped natural frequency, sqrt(k/m)"),
    Quantity(
        "phase",
        "ω_0 T",
        "rad",
        "natural frequency times duration",
        limits=PHASES,
        bounds=NON_NEGATIVE,
    ),
)
PARTS: Final = _computed(_PARTS)
"""Attributes of the parts of a drive in Python, and quantities derived from them."""

COLUMNS: Final[dict[str, tuple[str, str]]] = {
    "curve": ("curve.speed", "curve.force"),
    "coefficient_curve": ("curve.speed", "curve.coefficient"),
    "profile": ("profile.time", "profile.value"),
    "steps": ("profile.time", "profile.value"),
    "places": ("place.x", "place.y"),
}
"""Columns in the points of a curve, of a profile and of places, by the names of the parts."""

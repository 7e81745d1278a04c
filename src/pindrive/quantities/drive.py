"""The table of quantities, first part: the drive, its inputs, and what follows from them.

Only the standard library and the core are imported here and in the other parts, so that a command
starts fast.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Final

from pindrive import _core
from pindrive.quantities.quantity import (
    FINITE,
    FINITE_OR_NOT,
    NON_NEGATIVE,
    POSITIVE,
    POSITIVE_OR_RIGID,
    Bounds,
    Quantity,
    between,
    fields_of,
    inputs,
    quantities,
    stored,
    stored_inputs,
)

FILE: Final = stored("drive.toml")

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


def _computed(rows: tuple[Quantity, ...]) -> tuple[Quantity, ...]:
    """Rows whose limits follow from their bounds unless they have their own."""
    return tuple(
        replace(row, limits=COMPUTED.get(row.bounds, row.limits))
        if row.limits is FINITE_OR_NOT
        else row
        for row in rows
    )


SUPPORTS: Final = ("mouse", "ground")
"""Bodies on which the spring of a pin may stand, in the order of their numbers."""

FRICTION_LAWS: Final = tuple(_core.friction_laws)
"""Names of the friction laws, in the order of their numbers."""


def _contact(contact: str) -> tuple[Quantity, ...]:
    """Friction of a contact, by forces and by coefficients, and its further inputs."""
    of = FILE[contact]
    own, law = of["friction"], {"law": {"choices": FRICTION_LAWS}}
    friction = (
        Quantity(
            f"{contact}.{name}",
            **fields_of(row | own.get(name, {}), **of["slots"]) | law.get(name, {}),
        )
        for name, row in FILE["friction"].items()
    )
    return inputs("", *friction) + stored_inputs(contact, of["inputs"])


DRIVE_QUANTITIES: Final = (
    stored_inputs("drive", FILE["drive"])
    + _contact("plate")
    + _contact("finger")
    + stored_inputs("motion", FILE["motion"])
)
"""Keys of a device file, in order."""

PARTS: Final = _computed(quantities(FILE["parts"]))
"""Attributes of the parts of a drive in Python, and quantities derived from them."""

COLUMNS: Final[dict[str, tuple[str, str]]] = {
    "curve": ("curve.speed", "curve.force"),
    "coefficient_curve": ("curve.speed", "curve.coefficient"),
    "profile": ("profile.time", "profile.value"),
    "steps": ("profile.time", "profile.value"),
    "places": ("place.x", "place.y"),
}
"""Columns in the points of a curve, of a profile and of places, by the names of the parts."""

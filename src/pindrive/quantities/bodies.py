"""The table of quantities of a system of several bodies: its inputs and its results."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Final

from pindrive.quantities.drive import ABOVE_ZERO, EITHER_WAY, FROM_ZERO, OR_INFINITE
from pindrive.quantities.functions import FUNCTIONS
from pindrive.quantities.part import Part
from pindrive.quantities.quantity import (
    FINITE,
    NON_NEGATIVE,
    POSITIVE,
    POSITIVE_OR_RIGID,
    Quantity,
    between,
)


def _free(name: str, symbol: str, unit: str, meaning: str) -> Quantity:
    """A quantity of either sign, zero unless given."""
    return Quantity(name, symbol, unit, meaning, absent=0.0, bounds=FINITE, limits=EITHER_WAY)


def _positive(name: str, symbol: str, unit: str, meaning: str) -> Quantity:
    """A quantity from zero on, zero unless given."""
    return Quantity(name, symbol, unit, meaning, absent=0.0, bounds=NON_NEGATIVE, limits=FROM_ZERO)


def _input(quantity: Quantity, absent: float | None = 0.0) -> Quantity:
    """A quantity that may change over time."""
    return replace(quantity, absent=absent, rows_of="profile")


BODY: Final = (
    Quantity(
        "mass", "m", "kg", "mass of the body", example=0.001, bounds=POSITIVE, limits=ABOVE_ZERO
    ),
    _free("position", "q", "m", "position at t = 0"),
    _free("velocity", "q'", "m/s", "velocity at t = 0"),
    _input(_free("force", "F", "N", "external force on the body")),
)
SPRING: Final = (
    _positive("stiffness", "k", "N/m", "stiffness of the spring"),
    _positive("damping", "b", "N*s/m", "damping coefficient of the damper beside the spring"),
    _input(_free("length", "l", "m", "distance between the bodies at which the spring rests")),
    _input(_free("motion", "y", "m", "prescribed motion of the other end"), absent=None),
)
CONTACT: Final = (
    replace(_positive("kinetic", "F_k", "N", "friction force in slip"), absent=None),
    replace(_positive("static", "F_s", "N", "largest friction force in stick"), absent=None),
    Quantity(
        "stiffness",
        "k_s",
        "N/m",
        "stiffness of the skin between the bodies; infinite: a rigid contact",
        absent=inf,
        example=300.0,
        bounds=POSITIVE_OR_RIGID,
        limits=OR_INFINITE,
    ),
    _positive("damping", "b_s", "N*s/m", "damping coefficient of the skin"),
    _input(_positive("load", "λ", "1", "factor of kinetic and static friction"), absent=1.0),
    _input(_free("velocity", "w", "m/s", "velocity of the surface, as of a belt")),
    _free("stretch", "s", "m", "stretch of the skin at t = 0"),
    replace(
        _positive("share", "c", "1", "load per load of the contact, or newton of the stop, beside"),
        absent=None,
    ),
)
STOP: Final = (
    replace(_free("lower", "l_1", "m", "least distance between the bodies"), absent=None),
    replace(_free("upper", "l_2", "m", "largest distance between the bodies"), absent=None),
    Quantity(
        "stiffness",
        "k_e",
        "N/m",
        "stiffness of an elastic stop; infinite: a rigid one",
        absent=inf,
        example=1e5,
        bounds=POSITIVE_OR_RIGID,
        limits=OR_INFINITE,
    ),
    _positive("damping", "b_e", "N*s/m", "damping coefficient of an elastic stop"),
    Quantity(
        "restitution",
        "e",
        "1",
        "speed after an impact on a rigid stop over that before",
        absent=0.0,
        bounds=between(0.0, 1.0),
    ),
)
FEEDBACK: Final = (
    _free("proportional", "k_P", "N/m", "gain of the error"),
    _free("derivative", "k_D", "N*s/m", "gain of the rate of the error"),
    _free("integral", "k_I", "N/(m*s)", "gain of the integral of the error"),
    _input(_free("reference", "r", "m", "intended distance between the measured bodies")),
    _positive("period", "T", "s", "time between two samples; 0: continuous"),
)
KINDS: Final = {
    "body": BODY,
    "spring": SPRING,
    "contact": CONTACT,
    "stop": STOP,
    "feedback": FEEDBACK,
}
"""Quantities of each part of a system."""
PARTS: Final = {kind: Part(rows) for kind, rows in KINDS.items()}

OF_BODY: Final = (
    Quantity("position", "q", "m", "position of the body"),
    Quantity("velocity", "q'", "m/s", "velocity of the body"),
    Quantity("acceleration", "q''", "m/s^2", "acceleration of the body"),
)
OF_CONTACT: Final = (
    Quantity("force", "R", "N", "friction force on the first body"),
    Quantity("stretch", "s", "m", "stretch of the skin"),
    Quantity("sliding_speed", "u", "m/s", "velocity of the first body over the surface, in slip"),
    Quantity("slip", "σ", "", "direction of slip: -1, 1, or 0 in stick"),
)
OF_FEEDBACK: Final = (Quantity("force", "F_c", "N", "force of the feedback on the first body"),)
OF_STOP: Final = (Quantity("force", "N_e", "N", "force of the stop on the first body"),)
OF_SPRING: Final = (
    Quantity("force", "F", "N", "force of spring and damper on the first body"),
    Quantity("elongation", "e", "m", "elongation of the spring"),
)

NUMBERS: Final = {
    "body": (
        Quantity("end", "q_end", "m", "position at the end"),
        Quantity("end_velocity", "q'_end", "m/s", "velocity at the end"),
        Quantity("least", "q_min", "m", "least position"),
        Quantity("largest", "q_max", "m", "largest position"),
        Quantity("drift", "v_end", "m/s", "mean velocity of the ending"),
    ),
    "contact": (Quantity("events", "n", "", "changes of the contact"),),
    "stop": (Quantity("events", "n", "", "times at which the stop is met or left"),),
    "ending": (
        Quantity("period", "T_end", "s", "time after which the motion repeats"),
        Quantity("rounds", "n_end", "", "periods of the inputs, or rounds, in that time"),
    ),
    "energy": tuple(
        Quantity(name, f"W_{name}", "J", meaning)
        for name, meaning in (
            ("before", "energy of motion and of springs at t = 0"),
            ("after", "energy of motion and of springs at the end"),
            ("inputs", "work of forces, feedbacks, prescribed motions and surfaces"),
            ("dampers", "loss in the dampers of springs"),
            ("contacts", "loss in contacts"),
            ("stops", "loss at stops"),
        )
    ),
}
"""Numbers of a motion, by the kind of the part."""


def number_of(key: str) -> Quantity:
    """Return the quantity of a number of a motion, such as "body.pin.end"."""
    kind, *_, name = key.split(".")
    return next(quantity for quantity in NUMBERS[kind] if quantity.name == name)


def quantity_of(key: str) -> Quantity:
    """Return the quantity of a parameter of a system, such as "body.pin.mass"."""
    kind, _, part, *parameter = key.split(".")
    given = PARTS[kind].rows[part]
    if not parameter:
        return given
    own = {q.name: q for rows in FUNCTIONS.values() for q in rows}[parameter[0]]
    return own if own.unit else replace(own, unit=given.unit)

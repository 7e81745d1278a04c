"""Parameters of the functions of time that an input may be: a sinusoid, a stroke, an exponential.

Only the standard library is imported, so that a command starts fast.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import inf
from typing import Final

from pindrive.quantities.quantity import NON_NEGATIVE, POSITIVE, Bounds, Quantity, between

OWN_UNIT: Final = ""
"""Unit of a parameter that has that of its input."""

_LIMITS: Final = between(-1e12, 1e12)
_BEGIN: Final = Quantity(
    "begin",
    "t_0",
    "s",
    "time at which it begins",
    absent=0.0,
    example=0.0,
    source="the begin of the motion",
    bounds=NON_NEGATIVE,
    limits=_LIMITS,
)

FUNCTIONS: Final[dict[str, tuple[Quantity, ...]]] = {
    "harmonic": (
        Quantity("mean", "mean", OWN_UNIT, "mean", limits=_LIMITS),
        Quantity("amplitude", "A", OWN_UNIT, "amplitude", limits=_LIMITS),
        Quantity(
            "frequency",
            "f",
            "Hz",
            "frequency",
            example=8.0,
            bounds=Bounds(lower=0.0, upper=1e6, upper_closed=True),
        ),
        Quantity(
            "phase",
            "φ",
            "rad",
            "phase at t = 0",
            absent=0.0,
            example=0.0,
            source="it begins at its mean",
            limits=_LIMITS,
        ),
    ),
    "minimum_jerk": (
        Quantity("distance", "D", "m", "distance of the stroke", example=0.02, limits=_LIMITS),
        Quantity(
            "duration",
            "T",
            "s",
            "time of the stroke",
            example=0.4,
            bounds=POSITIVE,
            limits=_LIMITS,
        ),
        _BEGIN,
    ),
    "exponential": (
        Quantity("start", "start", OWN_UNIT, "value at its begin", limits=_LIMITS),
        Quantity("end", "end", OWN_UNIT, "value that it approaches", limits=_LIMITS),
        Quantity(
            "time_constant",
            "τ",
            "s",
            "time constant",
            example=0.005,
            bounds=Bounds(lower=1e-7, upper=inf, lower_closed=True),
            limits=_LIMITS,
        ),
        _BEGIN,
    ),
}
"""The functions that are made of numbers, and their parameters in order."""

FUNCTIONS_OF: Final[dict[str, tuple[str, ...]]] = {
    "mouse_velocity": ("harmonic", "minimum_jerk", "exponential"),
    "plate_load": ("harmonic", "exponential"),
    "across_velocity": ("harmonic", "minimum_jerk", "exponential"),
    "force": ("harmonic", "exponential"),
    "finger_load": ("harmonic", "exponential"),
}
"""The functions that each input may be."""
EXAMPLES_OF: Final[dict[str, dict[str, float]]] = {
    "mouse_velocity": {"mean": 0.06, "amplitude": 0.01, "start": 0.06, "end": 0.0},
    "plate_load": {"mean": 3.0, "amplitude": 2.0, "start": 5.0, "end": 1.0},
    "across_velocity": {"mean": 0.0, "amplitude": 0.01, "start": 0.01, "end": 0.0},
    "force": {"mean": 0.0, "amplitude": 0.1, "start": 0.3, "end": 0.0},
    "finger_load": {"mean": 1.0, "amplitude": 0.5, "start": 1.0, "end": 0.5},
}
"""Usual values of the parameters that have the unit of their input, SI."""


def _of(owner: Quantity, parameter: Quantity) -> Quantity:
    """Return a parameter of an input as a quantity of its own."""
    return replace(
        parameter,
        name=f"{owner.name}.{parameter.name}",
        section=owner.section,
        unit=parameter.unit or owner.unit,
        symbol=f"{owner.symbol} {parameter.symbol}",
        meaning=f"{owner.name.replace('_', ' ')}: {parameter.meaning}",
        example=EXAMPLES_OF[owner.name].get(parameter.name, parameter.example),
    )


def parameters_of(inputs: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return the parameters of inputs as quantities of their own: "mouse_velocity.amplitude"."""
    found = {
        f"{owner.name}.{parameter.name}": _of(owner, parameter)
        for owner in inputs
        for kind in FUNCTIONS_OF.get(owner.name, ())
        for parameter in FUNCTIONS[kind]
    }
    return tuple(found.values())

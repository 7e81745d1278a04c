"""A drive and its release as the core has them: one tuple, and where each number stands in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

Rows = Sequence[tuple[float, float]]
Pieces = Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]
"""Begin, polynomial and terms (cosine, sine, decay, frequency) of each piece of a function."""
Input = Rows | Pieces


Place = tuple[int, ...]
"""Place of a number in the array of the core."""


LawNumbers = tuple[float, float, float, float, float]
"""Number of the law, breakaway, Stribeck velocity, exponent, viscous."""
ContactNumbers = tuple[float, float, float, Rows, LawNumbers, float, float]
"""Kinetic and static friction, stiffness, curve, law, damping, exponent of the load."""


DriveNumbers = tuple[
    float, float, float, ContactNumbers, ContactNumbers, tuple[float, float, float]
]
"""Mass, stiffness, damping; plate, finger; travel, stiffness and damping of the end stops."""


CoreNumbers = tuple[
    float,
    float,
    float,
    ContactNumbers,
    ContactNumbers,
    Input,
    Input,
    float,
    float,
    float,
    Input,
    Input,
    Input,
    tuple[float, float, float],
    float,
    float,
]
"""In the order of `Numbers` in _core.cpp."""


DURATION: Final = 14
"""Place of the duration."""
LAW_PLACE: Final = 4
"""Place of the law among the numbers of a contact."""
PLACES: Final[dict[str, tuple[int, ...]]] = {
    "mass": (0,),
    "stiffness": (1,),
    "damping": (2,),
    "plate.kinetic": (3, 0),
    "plate.static": (3, 1),
    "finger.kinetic": (4, 0),
    "finger.static": (4, 1),
    "finger.stiffness": (4, 2),
    "finger.damping": (4, 5),
    "load_exponent": (4, 6),
    **{
        f"{contact}.{name}": (i, LAW_PLACE, j)
        for i, contact in ((3, "plate"), (4, "finger"))
        for j, name in ((1, "breakaway"), (2, "stribeck_velocity"), (4, "viscous"))
    },
    "mouse_velocity": (5,),
    "plate_load": (6,),
    "displacement": (7,),
    "velocity": (8,),
    "skin_stretch": (9,),
    "force": (10,),
    "across_velocity": (11,),
    "finger_load": (12,),
    "travel": (13, 0),
    "stop_stiffness": (13, 1),
    "stop_damping": (13, 2),
}
"""Places of each number, or of the breakpoints of an input, in the array of the core."""


ROWS: Final[dict[str, tuple[int, ...]]] = {
    "plate_curve": (3, 3),
    "finger_curve": (4, 3),
    "mouse_velocity": (5,),
    "plate_load": (6,),
    "force": (10,),
    "across_velocity": (11,),
    "finger_load": (12,),
}
"""Places of all breakpoints of a table."""


def entry(numbers: Any, place: Place) -> Any:
    """Return the entry at a place of the core's array."""
    for i in place:
        numbers = numbers[i]
    return numbers


def replaced(numbers: Any, place: Place, value: Any) -> Any:
    """Return the numbers with another value at a place."""
    if not place:
        return value
    i, *rest = place
    return (*numbers[:i], replaced(numbers[i], tuple(rest), value), *numbers[i + 1 :])


def mapped(f: Callable[..., Any], *numbers: Any) -> Any:
    """Return the values of f at the corresponding numbers of several containers, nested alike."""
    if isinstance(numbers[0], (tuple, list)):
        return tuple(mapped(f, *parts) for parts in zip(*numbers, strict=True))
    return f(*numbers)

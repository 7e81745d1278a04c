"""Inputs of a system over time: their checks, and their form in the core."""

from __future__ import annotations

from math import inf
from typing import Any, TypeAlias, overload

from pindrive import _core
from pindrive.motion.core_numbers import Input
from pindrive.motion.function import DEGREE, Function, as_function, function_of
from pindrive.motion.profile import Profile
from pindrive.motion.release import numbers_of
from pindrive.quantities.part import Part
from pindrive.quantities.refusal import Refusal, refusal

Given: TypeAlias = float | Profile | Function


def input_of(part: Part, name: str, given: Any, label: str, *, continuous: bool = False) -> Given:
    """Return a constant, a profile or a function that a quantity of a part may be.

    Args:
        part: Table of the quantity.
        name: Name of the quantity.
        given: Number, text with a unit, `Profile` or `Function`.
        label: Name of the quantity in messages.
        continuous: True of an input that may not jump.

    Raises:
        ValueError: The values are of another unit or out of range, or the input jumps.
    """
    if not isinstance(given, (Profile, Function)):
        return part.check(name, given, label=label)
    quantity = part.rows[name]
    if given.unit and given.unit != quantity.unit:
        other = "plain numbers" if given.unit == "1" else f"values in {given.unit}"
        required = f"a {type(given).__name__} of {quantity.kinds}"
        raise ValueError(refusal(label, required, other))
    if isinstance(given, Profile):
        for i, value in enumerate(given.values):
            part.check(name, value, label=f"{label} values[{i}]")
    if continuous:
        _check_continuous(given, label)
    return given


def _check_continuous(given: Given, label: str) -> None:
    """Refuse an input that jumps."""
    required = "without a step (a jump would take an infinite force)"
    if isinstance(given, Profile) and given.steps:
        raise ValueError(refusal(label, required, f"one at {given.steps[0]!r} s"))
    if isinstance(given, Function):
        _, (time, before, after) = _core.function_range(given.core, 0.0)
        if time < inf:
            words = f"one from {before!r} to {after!r} at {time!r} s"
            raise ValueError(refusal(label, required, words))


def negative(label: str, given: Given, duration: float | None) -> Refusal | None:
    """Return the refusal of a function that becomes negative within a duration, s; None: ever."""
    if not isinstance(given, Function):
        return None
    (time, least), _ = _core.function_range(given.core, inf if duration is None else duration)
    if least >= -1e-9:
        return None
    return refusal(label, ">= 0", f"{least!r} at {time!r} s")


@overload
def integrated(motion: Profile | Function, label: str = ...) -> Profile | Function: ...
@overload
def integrated(motion: Given, label: str = ...) -> Given: ...
def integrated(motion: Given, label: str = "a motion") -> Given:
    """Return positions from velocities in m/s, as of `minimum_jerk`, from 0 on; positions as is.

    Raises:
        ValueError: A polynomial of the highest degree, whose integral has a higher one.
    """
    if isinstance(motion, float) or motion.unit != "m/s":
        return motion
    pieces = as_function(motion, "m/s").core
    for _, polynomial, _ in pieces:
        if any(polynomial[DEGREE:]):
            required = f"velocities with polynomials of degree {DEGREE - 1} at most"
            raise ValueError(refusal(label, required, f"one of degree {DEGREE}"))
    return function_of(_core.function_integral(pieces), "m")


def summed(one: Given, other: Given | None = None) -> Input:
    """Return the sum of two inputs as the core has it."""
    if other is None or (isinstance(one, float) and one == 0.0):
        return numbers_of(one if other is None else other)
    if isinstance(one, float) and isinstance(other, float):
        return numbers_of(one + other)
    return _core.sum_of_functions(as_function(one, "").core, as_function(other, "").core)

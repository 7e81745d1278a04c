"""Inputs that are functions of time: sinusoids, strokes, exponentials, their sums and sequences.

SI units. The motion under a function is as exact as under constant inputs: nothing is sampled.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf, isfinite, nan
from numbers import Real
from typing import TYPE_CHECKING, Any, Final, NamedTuple, overload

from pindrive import _core
from pindrive.motion.profile import Profile, in_si
from pindrive.quantities.functions import FUNCTIONS, OWN_UNIT
from pindrive.quantities.part import Part
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.units import to_si

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

DEGREE: Final = 5
"""Highest degree of the polynomial of a piece."""


class InputTerm(NamedTuple):
    """Term of a piece: (cosine cos Ωτ + sine sin Ωτ) e^(−δτ), with τ the time since its begin.

    Attributes:
        cosine: Amplitude of the cosine, SI.
        sine: Amplitude of the sine, SI.
        decay: δ, 1/s, from 0 to 1e9; 0: the term lasts.
        frequency: Ω, rad/s, from 0 to 1e7.
    """

    cosine: float = 0.0
    sine: float = 0.0
    decay: float = 0.0
    frequency: float = 0.0


class InputPiece(NamedTuple):
    """Part of a function from a time on: a polynomial and terms.

    Attributes:
        begin: Time at which it begins, s. It ends where the next begins.
        polynomial: Coefficients p₀, p₁, … of p₀ + p₁ τ + …, SI; at most six.
        terms: Terms to be added.
    """

    begin: float = 0.0
    polynomial: tuple[float, ...] = ()
    terms: tuple[InputTerm, ...] = ()

    @property
    def core(self) -> tuple[float, tuple[float, ...], tuple[InputTerm, ...]]:
        """The piece as the core has it."""
        missing = (0.0,) * (DEGREE + 1 - len(self.polynomial))
        return self.begin, self.polynomial + missing, self.terms

    def from_time(self, time: float) -> InputPiece:
        """The same function with its begin at a time, s."""
        return self._replace(begin=time)


@dataclass(frozen=True, slots=True, init=False, repr=False)
class Function:
    """A quantity over time in pieces, each a polynomial, exponentials and sinusoids.

    Made by `harmonic`, `minimum_jerk`, `exponential`; `f + g` is their sum, also with a number or a
    `Profile`, and `f.then(time, g)` their sequence. Before the first piece the value is that at its
    begin.

    Args:
        pieces: At least one, begins increasing.
        unit: The SI unit of its values; empty: that of the input to which it is given.

    Raises:
        ValueError: No pieces, begins that do not increase, more than six coefficients, or a number
            that is not finite or out of range.
    """

    pieces: tuple[InputPiece, ...]
    unit: str = field(compare=False, repr=False)
    kind: str = field(compare=False, repr=False)
    numbers: tuple[tuple[str, float], ...] = field(compare=False, repr=False)

    def __init__(self, pieces: tuple[InputPiece, ...] | list[InputPiece], unit: str = "") -> None:
        """Validate, and keep tuples."""
        try:
            given = tuple(pieces)
        except TypeError:
            raise ValueError(refusal("pieces", "a list of InputPiece", repr(pieces))) from None
        _check(given)
        object.__setattr__(self, "pieces", given)
        object.__setattr__(self, "unit", unit)
        object.__setattr__(self, "kind", "")
        object.__setattr__(self, "numbers", ())

    @property
    def parameters(self) -> dict[str, float]:
        """Numbers from which a `harmonic`, `minimum_jerk` or `exponential` was made, by name."""
        return dict(self.numbers)

    def replace(self, **parameters: float | str) -> Function:
        """Return the function with other values of some of its `parameters`.

        Raises:
            ValueError: A parameter is unknown, or its value out of range.
        """
        for name in parameters:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none of a sum or a sequence"
                raise ValueError(refusal("parameter", known, quoted(name)))
        changed = of_parameters(self.kind, {**self.parameters, **parameters})
        object.__setattr__(changed, "unit", changed.unit or self.unit)
        return changed

    @property
    def changes(self) -> bool:
        """True if the function takes more than one value."""
        return (
            any(any(p.polynomial[1:]) or p.terms for p in self.pieces)
            or len({p.polynomial[:1] for p in self.pieces}) > 1
        )

    @property
    def size(self) -> float:
        """Bound of the absolute value at the begins of the pieces, SI."""
        return max(
            sum(map(abs, p.polynomial[:1])) + sum(abs(t.cosine) + abs(t.sine) for t in p.terms)
            for p in self.pieces
        )

    @property
    def described(self) -> dict[str, float | str]:
        """The parameters by name or, without any, the text of the pieces."""
        if self.parameters:
            return dict(self.numbers)
        return {"pieces": "; ".join(str(piece.core) for piece in self.pieces)}

    @property
    def core(self) -> list[tuple[float, tuple[float, ...], tuple[InputTerm, ...]]]:
        """The pieces as the core has them."""
        return [piece.core for piece in self.pieces]

    def __repr__(self) -> str:
        """Return the call that makes the function; without parameters, its pieces."""
        if self.parameters:
            given = ", ".join(f"{name}={value:.6g}" for name, value in self.parameters.items())
            return f"{self.kind}({given})"
        return f"Function({', '.join(map(str, self.pieces[:2]))}{', …' * (len(self.pieces) > 2)})"

    @overload
    def __call__(self, t: float) -> float: ...
    @overload
    def __call__(self, t: ArrayLike) -> NDArray[np.float64]: ...
    def __call__(self, t: ArrayLike) -> float | NDArray[np.float64]:
        """Return the value at time t (s): a float for a float, else an array of equal shape.

        NaN at a time that is not finite.
        """
        import numpy as np

        times = np.asarray(t, dtype=np.float64)
        values = _core.function_at(self.core, np.ascontiguousarray(times.ravel()))
        values[~np.isfinite(times.ravel())] = nan
        if not isinstance(t, (float, int)):
            return values.reshape(times.shape)
        return float(values[0])

    def __add__(self, other: float | str | Profile | Function) -> Function:
        """Return the sum with a number, a profile or a function."""
        added = as_function(other, self.unit)
        if self.unit and added.unit and self.unit != added.unit:
            raise ValueError(refusal("a sum", f"of values in {self.unit}", f"one in {added.unit}"))
        summed = _core.sum_of_functions(self.core, added.core)
        return function_of(summed, self.unit or added.unit)

    __radd__ = __add__

    def then(self, time: float | str, other: float | str | Profile | Function) -> Function:
        """Return this function until a time, and from then on another, whose own time begins there.

        Args:
            time: s, or text with a unit; after the begin of this function.
            other: A number, a profile or a function.

        Raises:
            ValueError: The time is not after the begin.
        """
        since = _number("time", "s", time)
        if not since > self.pieces[0].begin:
            required = f"after the begin of the function, {self.pieces[0].begin!r} s"
            raise ValueError(refusal("time", required, f"{since!r} s"))
        following = as_function(other, self.unit)
        kept = [piece for piece in self.pieces if piece.begin < since]
        # The value of a piece that begins before time 0 is that at time 0.
        first = function_of(_core.function_from(following.core, 0.0), "").pieces[0]
        later = [
            piece.from_time(piece.begin + since) for piece in following.pieces if piece.begin > 0
        ]
        return Function([*kept, first.from_time(since), *later], self.unit or following.unit)


def harmonic(
    mean: float | str, amplitude: float | str, frequency: float | str, phase: float | str = 0.0
) -> Function:
    """Return mean + amplitude sin(2π frequency t + phase): a sine; a cosine has the phase π/2.

    Args:
        mean: SI, or text with a unit, such as "60 mm/s".
        amplitude: SI, or text with a unit.
        frequency: Hz, > 0 and at most 1e6.
        phase: rad.

    Returns:
        The function, with `parameters` of these names.

    Raises:
        ValueError: A number is out of range.
    """
    given = {"mean": mean, "amplitude": amplitude, "frequency": frequency, "phase": phase}
    return of_parameters("harmonic", given)


def minimum_jerk(
    distance: float | str, duration: float | str, begin: float | str = 0.0
) -> Function:
    """Return the velocity of a stroke of minimum jerk, zero before and after.

    With s = (t − begin)/duration it is 30 distance/duration (s² − 2 s³ + s⁴): the smoothest way
    from rest to rest, as hands move (Flash and Hogan 1985, doi:10.1523/JNEUROSCI.05-07-01688.1985).

    Args:
        distance: m, or text with a unit; its sign is the direction.
        duration: s, > 0.
        begin: s, >= 0.

    Returns:
        The function, with `parameters` of these names.

    Raises:
        ValueError: A number is out of range.
    """
    given = {"distance": distance, "duration": duration, "begin": begin}
    return of_parameters("minimum_jerk", given)


def exponential(
    start: float | str, end: float | str, time_constant: float | str, begin: float | str = 0.0
) -> Function:
    """Return end + (start − end) e^(−(t − begin)/time_constant), and `start` before its begin.

    Args:
        start: SI, or text with a unit.
        end: SI, or text with a unit.
        time_constant: s, from 1e-7 on.
        begin: s, >= 0.

    Returns:
        The function, with `parameters` of these names.

    Raises:
        ValueError: A number is out of range.
    """
    given = {"start": start, "end": end, "time_constant": time_constant, "begin": begin}
    return of_parameters("exponential", given)


def of_parameters(kind: str, given: Mapping[str, float | str]) -> Function:
    """Return a function by the name of its kind, a key of `FUNCTIONS`, and all its parameters.

    Raises:
        ValueError: A number is out of range.
    """
    part = _PARTS[kind]
    own = {name: value for name, value in given.items() if part.rows[name].unit == OWN_UNIT}
    unit, values = in_si([*own.values()], " and ".join(own)) if own else ("m/s", [])
    si = {**given, **dict(zip(own, values, strict=True))}
    numbers = {name: part.check(name, value) for name, value in si.items()}
    try:
        function = function_of(_pieces(kind, numbers), unit)
    except ValueError:  # a coefficient of its pieces is too large for a number
        words = ", ".join(f"{name} = {value!r}" for name, value in numbers.items())
        required = "finite at all times"
        raise ValueError(refusal(kind, required, words)) from None
    object.__setattr__(function, "kind", kind)
    object.__setattr__(function, "numbers", tuple(numbers.items()))
    return function


def function_of(pieces: Iterable[Any], unit: str) -> Function:
    """Return the function of pieces as the core has them: begin, polynomial, terms."""
    made = (
        InputPiece(begin, _trimmed(polynomial), tuple(InputTerm(*term) for term in terms))
        for begin, polynomial, terms in pieces
    )
    return Function(tuple(made), unit)


def _trimmed(polynomial: Sequence[float]) -> tuple[float, ...]:
    """Return coefficients without zeros at the end."""
    count = max((n for n, p in enumerate(polynomial, 1) if p), default=1)
    return tuple(polynomial[:count])


def as_function(given: float | str | Profile | Function, unit: str) -> Function:
    """Return a number, a profile or a function as a function."""
    if isinstance(given, Function):
        return given
    if not isinstance(given, Profile):
        value = _number("a value", unit, given)
        return Function((InputPiece(polynomial=(value,)),), unit)
    return function_of(_core.function_of_rows(given.rows), given.unit)


STEP: Final = 1e-30
"""Imaginary step of a complex-step derivative (Squire and Trapp, 1998): exact to rounding."""


def core_of(function: Function, parameters: Mapping[str, Any]) -> list[Any]:
    """Return the pieces, as the core has them, with some parameters set otherwise.

    A parameter may be complex, with an imaginary part of `STEP`.
    """
    return _pieces(function.kind, {**function.parameters, **parameters})


def _pieces(kind: str, numbers: Mapping[str, Any]) -> list[Any]:
    """Return the pieces of a function of a kind, as the core makes them."""
    given = [numbers[name] for name in _PARTS[kind].rows]
    along = any(isinstance(number, complex) for number in given)
    made = _core.function_pieces_along if along else _core.function_pieces
    return made(kind, [*given, 0.0][:4])


def at_begin(pieces: Sequence[Any]) -> Any:
    """Return the value at t = 0 of pieces as the core has them; to first order in `STEP`."""
    begin, polynomial, terms = next(
        (piece for piece in reversed(pieces) if piece[0].real <= 0.0), pieces[0]
    )
    after = -begin if begin.real <= 0.0 else 0.0
    value = sum(p * after**n for n, p in enumerate(polynomial))
    for cosine, sine, decay, frequency in terms:
        phase = frequency * after
        by = cmath if isinstance(phase + decay * after, complex) else math
        value += (cosine * by.cos(phase) + sine * by.sin(phase)) * by.exp(-decay * after)
    return value


def rates_of(function: Function, parameter: str) -> tuple[list[Any], float]:
    """Return the derivatives by a parameter: of the pieces as the core has them, and at t = 0.

    A step along the imaginary axis differences no numbers, so that the derivative is exact.
    """
    step = STEP * 1j
    parts = core_of(function, {parameter: function.parameters[parameter] + step})

    def rate(number: Any) -> float:
        return complex(number).imag / STEP

    pieces = [
        (rate(begin), tuple(map(rate, polynomial)), [tuple(map(rate, term)) for term in terms])
        for begin, polynomial, terms in parts
    ]
    return pieces, rate(at_begin(parts))


_PARTS: Final = {kind: Part(parameters) for kind, parameters in FUNCTIONS.items()}


def _number(name: str, unit: str, given: object) -> float:
    """Return a finite number, or the SI value of a text with a unit."""
    if isinstance(given, str) and unit:
        try:
            return to_si(given, unit, f"1 {unit}")
        except ValueError as error:
            raise ValueError(refusal(name, str(error), quoted(given))) from None
    try:
        if isinstance(given, (bytes, bool, str)):
            raise TypeError
        number = float(given)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise ValueError(refusal(name, "a number", repr(given))) from None
    if not abs(number) <= 1e12:
        raise ValueError(refusal(name, "from -1e12 to 1e12", f"{number!r} {unit}".rstrip()))
    return number


_LIMITS: Final = {"decay": (0.0, 1e9), "frequency": (0.0, 1e7)}


def _check(pieces: tuple[InputPiece, ...]) -> None:
    """Refuse pieces that the core cannot follow."""
    if not pieces:
        raise ValueError(refusal("pieces", "at least one", "none"))
    before = -inf
    for i, piece in enumerate(pieces):
        if not isinstance(piece, InputPiece):
            raise ValueError(refusal(f"pieces[{i}]", "an InputPiece", repr(piece)))
        begin, polynomial, terms = piece
        if not (_is_number(begin) and isfinite(begin) and begin > before):
            required = "finite" if before == -inf else f"greater than {before!r}: pieces overlap"
            raise ValueError(refusal(f"pieces[{i}].begin", required, repr(begin)))
        before = begin
        for name, part in (("polynomial", polynomial), ("terms", terms)):
            if not isinstance(part, (tuple, list)):
                raise ValueError(refusal(f"pieces[{i}].{name}", "a tuple", repr(part)))
        if len(polynomial) > DEGREE + 1:
            required, given = f"at most {DEGREE + 1} coefficients", len(polynomial)
            raise ValueError(refusal(f"pieces[{i}].polynomial", required, given))
        for n, p in enumerate(polynomial):
            if not (_is_number(p) and isfinite(p)):
                required = "finite" if _is_number(p) else "a number"
                raise ValueError(refusal(f"pieces[{i}].polynomial[{n}]", required, repr(p)))
        for j, term in enumerate(terms):
            if not isinstance(term, InputTerm):
                raise ValueError(refusal(f"pieces[{i}].terms[{j}]", "an InputTerm", repr(term)))
            for name, value in term._asdict().items():
                lower, upper = _LIMITS.get(name, (-1e12, 1e12))
                if not (_is_number(value) and lower <= value <= upper):
                    label = f"pieces[{i}].terms[{j}].{name}"
                    required = f"from {lower:g} to {upper:g}"
                    raise ValueError(refusal(label, required, repr(value)))


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)

"""Text with a unit to an SI number: "12 g" is 0.012 kg, to the last bit.

The registry holds the units in which a pin drive is described, no more: pint's own takes a
hundred times as long to build. Conversion is decimal, so that "22 mN" and 0.022 are one number.
"""

from __future__ import annotations

import re
from decimal import Decimal
from functools import cache
from typing import Final

from pindrive.lazy import pint
from pindrive.quantities.refusal import quoted

DEFINITIONS = """
kilo- = 1e3 = k-
centi- = 1e-2 = c-
milli- = 1e-3 = m-
micro- = 1e-6 = µ- = μ- = u-
nano- = 1e-9 = n-
meter = [length] = m = metre
inch = 0.0254 * meter = in
dots_per_inch = 1 / inch = dpi
gram = [mass] = g
pound = 453.59237 * gram = lb
second = [time] = s
minute = 60 * second = min
newton = kilogram * meter / second ** 2 = N
gram_force = 0.00980665 * newton = gf
pound_force = 4.4482216152605 * newton = lbf
percent = 0.01
radian = [] = rad
degree = 0.0174532925199432957692 * radian = deg = °
hertz = 1 / second = Hz
joule = newton * meter = J
watt = joule / second = W
ampere = [current] = A
volt = watt / ampere = V
ohm = volt / ampere = Ω = Ω
henry = ohm * second = H
tesla = volt * second / meter ** 2 = T
kelvin = [temperature] = K
"""

_PREFIXES: Final = {
    **{"": Decimal(1), "k": Decimal(1000), "c": Decimal("0.01"), "m": Decimal("0.001")},
    **dict.fromkeys(("u", "\u00b5", "\u03bc"), Decimal("1e-6")),
    "n": Decimal("1e-9"),
}
_GRAM: Final = Decimal("0.001")

_NUMBER_AND_UNIT = re.compile(
    r"\s*(?P<number>[+-]?(?:nan|inf|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?))(?P<unit>.*)",
    re.IGNORECASE | re.ASCII,  # other digits look like these but are refused
)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?![\d,])")
_PLAIN = str.maketrans({"·": "*", "⋅": "*", "×": "*", "−": "-", "²": "^2"})


class UnitError(ValueError):
    """Text that is not a number with a unit of the expected kind; says what is expected."""


def to_si(text: str, unit: str, example: str) -> float:
    """The number in `text`, a number and a unit, in the SI unit `unit`.

    Args:
        text: "12 g", "1.5e-3 m", "20 %"; a bare number only where `unit` is "1", or zero.
        unit: SI unit, "1" for dimensionless.
        example: Example of such a quantity, for the message.

    Raises:
        UnitError: The text is not a number, or has no unit, an unknown unit or a unit of another
            dimension.
    """
    plain = text.translate(_PLAIN)
    if _DECIMAL_COMMA.match(plain):
        point = text.strip().replace(",", ".", 1)
        raise UnitError(f"a number whose decimal sign is a point, like {quoted(point)}")
    match = _NUMBER_AND_UNIT.fullmatch(plain)
    if match is None:
        kind = "a number" if unit == "1" else "a number with its unit"
        raise UnitError(f'{kind}, like "{example}"')
    number, written = match["number"], match["unit"].strip().replace("%", "percent")
    if not written and unit != "1":
        if unit != "K" and float(number) == 0.0:  # zero needs no unit
            return float(number)
        raise UnitError(f'a number with its unit (give a unit, like "{example}")')
    try:
        return float(Decimal(number) * _factor(written, unit))
    except ArithmeticError:  # beyond even decimal's range; infinite or 0 as a float
        return float(number)
    except LookupError:
        raise UnitError(f'{expected(unit, written, "or a percentage")}, like "{example}"') from None


def expected(unit: str, written: str, otherwise: str = "") -> str:
    """Return the description of the required unit; it mentions if the unit `written` is unknown.

    Args:
        unit: The SI unit, "1" for dimensionless.
        written: The unit that does not fit.
        otherwise: Alternatives to a plain number.
    """
    kind = f"a plain number {otherwise}".rstrip() if unit == "1" else f"in {unit} or a unit alike"
    try:
        _registry().parse_units(written)
    except Exception:  # pint lets through whatever goes wrong in the parts of its parser
        return f"{kind} ({quoted(written)} is not a known unit)"
    return kind


@cache
def _factor(written: str, unit: str) -> Decimal:
    """Return the number of units `unit` in one `written`; LookupError for different dimensions."""
    if (usual := _usual_factor(written, unit)) is not None:
        return usual
    registry = _registry()
    try:
        source = registry.parse_units(written)
        target = registry.parse_units("" if unit == "1" else unit)
        return Decimal(registry.convert(Decimal(1), source, target))
    except Exception:  # pint lets through whatever goes wrong in the parts of its parser
        raise LookupError(written) from None


def _usual_factor(written: str, unit: str) -> Decimal | None:
    """The factor of an SI unit or of its multiple by a prefix; None for other units.

    Most files need no other unit; pint takes longer to import than they take to read.
    """
    if unit == "1":
        return {"": Decimal(1), "percent": Decimal("0.01")}.get(written)
    mass = unit.startswith("kg")
    symbol = unit[1:] if mass else unit
    prefix = written.removesuffix(symbol)
    if prefix == written or prefix not in _PREFIXES or (prefix and re.match(r"1|\w+\^", unit)):
        return None
    return _PREFIXES[prefix] * (_GRAM if mass else 1)


@cache
def _registry() -> pint.UnitRegistry[Decimal]:
    registry: pint.UnitRegistry[Decimal] = pint.UnitRegistry(None, non_int_type=Decimal)
    registry.load_definitions(DEFINITIONS.strip().splitlines())
    return registry

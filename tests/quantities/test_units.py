"""Text with a unit: each unit by its definition, to the last bit; what is none is refused."""

from __future__ import annotations

import subprocess
import sys
from decimal import Decimal
from math import inf, isnan, pi

import pytest

from pindrive.quantities import units
from pindrive.quantities.quantity import DISPLAY
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.units import UnitError, to_si

KNOWN = {
    ("12 g", "kg"): 0.012,
    ("1 lb", "kg"): 0.45359237,
    ("22 mN", "N"): 0.022,
    ("1 lbf", "N"): 4.4482216152605,
    ("3 gf", "N"): 0.02941995,
    ("5 cm", "m"): 0.05,
    ("2 in", "m"): 0.0508,
    ("1,5 mm".replace(",", "."), "m"): 0.0015,
    ("7 µm", "m"): 7e-6,
    ("7 um", "m"): 7e-6,
    ("60 mm/s", "m/s"): 0.06,
    ("2 min", "s"): 120.0,
    ("5 kHz", "Hz"): 5000.0,
    ("0.2 N/mm", "N/m"): 200.0,
    ("0.40 N*s/m", "N*s/m"): 0.4,
    ("0.40 N·s/m", "N*s/m"): 0.4,
    ("6 mm^2", "m^2"): 6e-6,
    ("6 mm²", "m^2"): 6e-6,
    ("20 %", "1"): 0.2,
    ("0.16", "1"): 0.16,
    ("−5 mm", "m"): -0.005,
    ("1e-3 m", "m"): 0.001,
    ("3 uJ", "J"): 3e-6,
    ("inf s", "s"): inf,
}


@pytest.mark.parametrize(("text", "unit"), KNOWN)
def test_a_unit_is_what_it_is_defined_as(text: str, unit: str) -> None:
    assert to_si(text, unit, "1 x") == KNOWN[text, unit]


def test_degrees_are_parts_of_a_turn() -> None:
    assert to_si("180 deg", "rad", "1 deg") == pytest.approx(pi, rel=1e-15)
    assert isnan(to_si("nan s", "s", "1 s"))


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("１２ g", "kg", 'a number with its unit, like "10 g"'),
        ("12", "kg", 'a number with its unit (give a unit, like "10 g")'),
        ("12 m", "kg", 'in kg or a unit alike, like "10 g"'),
        ("12 bananas", "kg", 'in kg or a unit alike ("bananas" is not a known unit), like "10 g"'),
        ("10 MHz", "Hz", 'in Hz or a unit alike ("MHz" is not a known unit), like "10 g"'),
        ("3 m", "kg/s", 'in kg/s or a unit alike, like "10 g"'),
        ("1,5 g", "kg", 'a number whose decimal sign is a point, like "1.5 g"'),
        ("heavy", "kg", 'a number with its unit, like "10 g"'),
        ("3 m", "1", 'a plain number or a percentage, like "10 g"'),
    ],
)
def test_values_of_another_quantity_are_refused(text: str, unit: str, words: str) -> None:
    with pytest.raises(UnitError) as refused:
        to_si(text, unit, "10 g")
    assert str(refused.value) == words


def test_displayed_values_are_read_back() -> None:
    """A displayed value in its unit is read back as the SI value."""
    for unit, (shown, scale) in DISPLAY.items():
        assert to_si(f"{scale!r} {shown}", unit, "1 x") == pytest.approx(1.0, rel=1e-14)


def test_the_usual_units_are_those_of_the_registry() -> None:
    """Factors of SI units and of their multiples, found without pint, are the registry's."""
    registry = units._registry()
    count = 0
    for unit in {quantity.unit for quantity in QUANTITIES.values()} - {""}:
        symbols = {unit, unit.removeprefix("k"), "percent", "", "dpi", "min"}
        for written in {prefix + symbol for prefix in units._PREFIXES for symbol in symbols}:
            usual = units._usual_factor(written, unit)
            if usual is None:
                continue
            target = registry.parse_units("" if unit == "1" else unit)
            expected = registry.convert(Decimal(1), registry.parse_units(written), target)
            assert usual == Decimal(expected), (written, unit)
            count += 1
    assert count > 150


def test_a_usual_unit_imports_no_pint() -> None:
    code = (
        "import sys; from pindrive.quantities.units import to_si\n"
        "assert to_si('60 mm/s', 'm/s', '') == 0.06 and to_si('1 g', 'kg', '') == 1e-3\n"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("text", ["0", "0.0", "-0", "0e3"])
def test_zero_needs_no_unit(text: str) -> None:
    assert to_si(text, "N*s/m", "0.3 N*s/m") == 0.0
    with pytest.raises(UnitError, match="a number with its unit"):
        to_si("1", "N*s/m", "0.3 N*s/m")
    with pytest.raises(UnitError, match="a number with its unit"):
        to_si(text, "K", "20 K")

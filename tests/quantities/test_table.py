"""The table of quantities: complete, consistent, and the one source of messages."""

import math
from dataclasses import fields

import pytest

from pindrive import Contact, Drive, Release, simulate
from pindrive._core import settling_band
from pindrive.quantities.drive import DRIVE_QUANTITIES, PARTS
from pindrive.quantities.quantity import Bounds, Quantity, significant
from pindrive.quantities.results import CERTIFICATE, DESIGNED, FINAL, OUTPUTS, RATE
from pindrive.quantities.table import DEVICE, FUNCTION_PARAMETERS, QUANTITIES, check


def test_names_are_unique() -> None:
    assert len(QUANTITIES) == len(
        (
            *DRIVE_QUANTITIES,
            *FUNCTION_PARAMETERS,
            *PARTS,
            *OUTPUTS,
            *FINAL,
            RATE,
            *DEVICE,
            *DESIGNED,
        )
    )


def test_every_quantity_is_described() -> None:
    """A default names its source and is within its bounds."""

    def described(quantity: Quantity) -> bool:
        values = [v for v in (quantity.default, quantity.absent) if v is not None]
        named = bool(quantity.symbol or quantity.unit == "") and bool(quantity.meaning)
        sourced = not values or bool(quantity.source)
        within = all(value in quantity.bounds for value in values)
        return named and not quantity.meaning.endswith(".") and sourced and within

    assert len(QUANTITIES) > 250
    assert [name for name, quantity in QUANTITIES.items() if not described(quantity)] == []


def test_a_device_file_can_show_every_input() -> None:
    def shown(quantity: Quantity) -> bool:
        values = [v for v in (quantity.default, quantity.example) if v is not None]
        one = len(values) == (1 if quantity.may_be_constant else 0)
        return "." in quantity.key and one and bool(quantity.rows) == bool(quantity.rows_of)

    assert len(DRIVE_QUANTITIES) > 40
    assert [q.name for q in DRIVE_QUANTITIES if not shown(q)] == []


def test_every_number_of_a_motion_is_in_the_table() -> None:
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.32, plate=Contact(0.02), finger=Contact(0))
    motion = simulate(drive, Release(0.06, 0.002))
    certificate = {f"certificate.{field.name}" for field in fields(motion.certificate())}
    assert set(motion.numbers()) | certificate == {q.name for q in OUTPUTS}
    assert certificate == {q.name for q in CERTIFICATE}
    assert set(motion.inputs()) <= set(QUANTITIES)
    ledger = motion.core.ledger(motion.duration)
    assert [*ledger] == [field.name for field in fields(motion.energy)], "read in this order"


@pytest.mark.parametrize(
    ("bounds", "inside", "outside", "words"),
    [
        (Bounds(), [0.0, -1e300], [math.inf, -math.inf, math.nan], "finite"),
        (Bounds(0.0), [1e-300], [0.0, -1.0, math.inf, math.nan], "finite and greater than 0 m"),
        (Bounds(0.0, lower_closed=True), [0.0, -0.0], [-1e-300], "finite and at least 0 m"),
        (Bounds(0.0, upper_closed=True), [math.inf], [0.0, math.nan], "greater than 0 m"),
        (
            Bounds(0.0, 1.0, True, True),
            [0.0, 1.0],
            [1.1],
            "finite and at least 0 m and at most 1 m",
        ),
    ],
)
def test_bounds(bounds: Bounds, inside: list[float], outside: list[float], words: str) -> None:
    assert all(value in bounds for value in inside)
    assert not any(value in bounds for value in outside)
    assert bounds.words("m") == words


def test_check_gives_a_float() -> None:
    number = check("mass", 1)
    assert number == 1.0
    assert type(number) is float


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("mass", -0.01, "mass must be finite and greater than 0 kg, got -0.01 kg"),
        ("mass", 0, "mass must be finite and greater than 0 kg, got 0.0 kg"),
        ("stiffness", math.nan, "stiffness must be finite and greater than 0 N/m, got nan N/m"),
        ("damping", -1.0, "damping must be finite and at least 0 N*s/m, got -1.0 N*s/m"),
        ("damping_ratio", -1.0, "damping_ratio must be finite and at least 0, got -1.0"),
        ("plate.kinetic", math.inf, "plate.kinetic must be finite and at least 0 N, got inf N"),
        ("mouse_velocity", -math.inf, "mouse_velocity must be finite, got -inf m/s"),
        ("duration", "1 m", 'duration must be in s or a unit alike, like "300 ms", got "1 m"'),
        ("duration", True, "duration must be a number in s, got True"),
        ("duration", None, "duration must be a number in s, got None"),
        ("duration", 1j, "duration must be a number in s, got 1j"),
        ("duration", 10**400, f"duration must be a number in s, got {10**400}"),
    ],
)
def test_check_names_quantity_bound_and_value(name: str, value: object, message: str) -> None:
    with pytest.raises(ValueError) as refused:
        check(name, value)  # type: ignore[arg-type]
    assert str(refused.value) == message


def test_check_reports_the_place() -> None:
    with pytest.raises(ValueError) as refused:
        check("mass", -1.0, where="a.toml", label="drive.mass", given='"-1 kg"')
    assert str(refused.value) == (
        'a.toml: drive.mass must be finite and greater than 0 kg, got "-1 kg"'
    )


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (1.5, "1.500"),
        (-12.3456, "-12.35"),
        (123456.0, "123456"),
        (0.00123456, "0.001235"),
        (1.23456e-7, "1.235e-07"),
        (1e9, "1.000e+09"),
        (math.nan, "-"),
        (math.inf, "inf"),
    ],
)
def test_significant_digits(value: float, text: str) -> None:
    assert significant(value) == text


def test_settling_band_is_printed_exactly() -> None:
    assert QUANTITIES["settling_band"].default == settling_band
    assert "settling band" in QUANTITIES["transient.settling_time"].meaning


def test_values_are_shown_in_display_units() -> None:
    assert QUANTITIES["displacement"].text(0.0015) == "1.500 mm"
    assert QUANTITIES["damping_ratio"].text(0.2) == "0.2000"
    assert QUANTITIES["plate.static"].written(0.0265) == "26.5 mN"

"""The electromagnet: its current against its equation, its pull against the flux."""

from __future__ import annotations

from math import exp, isclose

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from pindrive.device import Coil, CoilState, Commands, Electromagnet
from pindrive.quantities.contradictions import problems_of
from tactile_mouse import coil

COIL = coil(thermal_resistance=100.0)


def commands(*times: float) -> Commands:
    return Commands(np.array(times))


def test_current_obeys_its_differential_equation() -> None:
    magnet = Electromagnet(rise_constant=0.001, fall_constant=0.004)
    reported = commands(0.01, 0.013, 0.0135, 0.03)
    current = magnet.current(reported, CoilState())

    def slope(t: float, c: float, on: bool) -> float:
        return (1.0 - c) / magnet.rise_constant if on else -c / magnet.fall_constant

    value, begin = 0.0, 0.0
    for end in (*reported.times.tolist(), 0.05):
        on = bool(reported.on(0.5 * (begin + end)))
        out = solve_ivp(slope, (begin, end), [value], args=(on,), rtol=1e-11, atol=1e-13)
        value, begin = float(out.y[0, -1]), end
        assert current(end) == pytest.approx(value, abs=1e-9)


def test_rise_and_fall_times_equal_their_definition() -> None:
    for sigma in (1.0, 0.7, 0.3):
        magnet = Electromagnet.from_times(
            hold_force=2.0, rise_time=0.003, fall_time=0.005, saturation=sigma, residual=0.1
        )
        rising = magnet.current(commands(0.0), CoilState(-1.0))
        falling = magnet.current(
            Commands(np.array([0.0]), at_first=True), CoilState(-1.0, True, 1.0)
        )
        assert magnet.pull(rising(0.003)) == pytest.approx(0.1 + 0.9 * 1.9, rel=1e-12)
        assert magnet.pull(falling(0.005)) == pytest.approx(0.1 + 0.1 * 1.9, rel=1e-12)
        assert isclose(magnet.rise_time, 0.003, rel_tol=1e-12)
        assert isclose(magnet.fall_time, 0.005, rel_tol=1e-12)


def test_pull_grows_with_the_square_and_saturates() -> None:
    magnet = Electromagnet(hold_force=3.0, saturation=0.5, residual=0.2)
    assert magnet.pull(0.0) == 0.2
    assert magnet.pull(0.25) == pytest.approx(0.2 + 2.8 * 0.25)
    assert magnet.pull(0.5) == magnet.pull(0.8) == magnet.pull(1.0) == 3.0


@settings(max_examples=60)
@given(
    lasts=st.lists(st.floats(1e-5, 0.05), min_size=1, max_size=8),
    sigma=st.floats(0.05, 1.0),
    residual=st.floats(0.0, 0.9),
    start=st.floats(0.0, 1.0),
    constants=st.tuples(st.floats(1e-4, 1e-2), st.floats(1e-4, 1e-2)),
)
def test_the_pull_is_that_of_the_flux(
    lasts: list[float],
    sigma: float,
    residual: float,
    start: float,
    constants: tuple[float, float],
) -> None:
    rise, fall = constants
    magnet = Electromagnet(
        hold_force=1.0,
        rise_constant=rise,
        fall_constant=fall,
        saturation=sigma,
        residual=residual,
    )
    times = np.cumsum(lasts)
    end = float(times[-1])
    current = magnet.current(Commands(times[:-1]), CoilState(0.0, False, start), end=end)
    begins = [begin for begin, *_ in current.pulls]
    assert begins[0] == 0.0
    assert len(begins) <= 2 * len(lasts)
    t = np.linspace(0.0, end, 999)
    assert np.abs(current.pull(t) - magnet.pull(current(t))).max() < 1e-12


def test_coil_by_hand() -> None:
    """Each number worked out on paper from the formulas of a magnetic circuit with two gaps."""
    assert COIL.resistance == pytest.approx(10.53716, rel=1e-5)  # 4.8 m of 7.854e-9 m2 copper
    assert COIL.current == pytest.approx(0.284707, rel=1e-5)
    assert COIL.field == pytest.approx(0.894432, rel=1e-5)  # 85.412 A over 120 µm
    assert COIL.pull == pytest.approx(3.81976, rel=1e-5)
    assert COIL.inductance == pytest.approx(5.65487e-3, rel=1e-5)
    assert COIL.power == pytest.approx(0.854120, rel=1e-5)
    assert COIL.duty == pytest.approx(20.0 / 85.4120, rel=1e-5)
    magnet = Electromagnet.from_coil(COIL)
    assert magnet.hold_force == COIL.pull
    assert magnet.rise_constant == pytest.approx(5.65487e-3 / 10.53716, rel=1e-5)
    assert magnet.fall_constant == magnet.rise_constant


def test_pull_is_the_energy_that_the_gap_would_give() -> None:
    """F = -dW/dg of the field energy L I²/2 at constant flux, by a difference quotient."""

    def coil_of(gap: float) -> Coil:
        return coil(gap=gap)

    flux = COIL.inductance * COIL.current
    step = 1e-9
    low, high = (0.5 * flux**2 / coil_of(6e-5 + h).inductance for h in (-step, step))
    assert (high - low) / (2.0 * step) == pytest.approx(COIL.pull, rel=1e-6)


def test_a_strong_coil_saturates() -> None:
    strong = coil(supply_voltage=9.0)
    assert strong.saturation == pytest.approx(1.6 / (3 * COIL.field))
    assert strong.pull == pytest.approx(1.6**2 * 6e-6 / 1.25663706127e-6)
    slow = coil(supply_voltage=9.0, release_resistance=strong.resistance)
    magnet = Electromagnet.from_coil(slow)
    assert magnet.fall_constant == pytest.approx(0.5 * magnet.rise_constant)
    assert magnet.current(commands(0.0), CoilState(-1.0))(magnet.rise_constant) == pytest.approx(
        1 - exp(-1)
    )


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"hold_force": 0.0},
            "hold_force must be finite and at least 1e-6 N and at most 10000 N, got 0.0 N",
        ),
        (
            {"saturation": 1.5},
            "saturation must be finite and at least 0.001 and at most 1, got 1.5",
        ),
        (
            {"hold_force": 1.0, "residual": 1.0},
            "residual must be less than the hold force, 1.0 N, got 1.0 N",
        ),
    ],
)
def test_bad_magnets_are_refused(given: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        Electromagnet(**given)  # type: ignore[arg-type]
    assert str(refused.value) == message


def test_magnet_is_given_in_one_way() -> None:
    def words(*names: str) -> list[str]:
        given = {f"magnet.{name}": None for name in names}
        return [problem.words for problem in problems_of(given, whole=True)]

    assert not words("hold_force", "rise_time") + words("residual")
    assert words("hold_force", "turns") == [
        "magnet.hold_force must be left out where turns describes the coil, "
        "got both, hold_force and turns"
    ]
    assert words("turns", "gap") == [
        "magnet.turns must be given with pole_area, wire_diameter, turn_length, supply_voltage, "
        "got turns, gap alone"
    ]

"""A hand and the pins of a device as one system, beside a program that shares no code."""

from __future__ import annotations

from math import exp, log, sqrt

import numpy as np
import pytest

import pindrive as pd

SPEED, WEIGHT = 0.06, 1e-3 * 9.81
RISE, FALL = 3e-3 / -log(1 - sqrt(0.9)), 2 * 5e-3 / log(10)
"""Time constants of a coil whose force rises to 90 % in 3 ms and falls to 10 % in 5 ms, s."""


def load_of(begins: list[float], lasts: float) -> pd.Function:
    """Weight of a pin and the pull of its magnet, 1 N at full current, N."""
    load = pd.harmonic(WEIGHT, 0.0, 1.0)
    since, tau, final, jump = 0.0, 1.0, 0.0, 0.0  # current: final + jump exp(−(t − since)/tau)
    for begin in begins:
        for time, level, constant in ((begin, 1.0, RISE), (begin + lasts, 0.0, FALL)):
            current = final + jump * exp(-(time - since) / tau)
            since, tau, final, jump = time, constant, level, current - level
            pull = pd.exponential(2 * final * jump, 0.0, tau)
            pull += pd.exponential(jump * jump, 0.0, tau / 2) + final * final
            load = load.then(time, pull + WEIGHT)
    return load


def numbers_of_hand(
    pins: int, width: float, pitch: float, stagger: float, damping: float
) -> tuple[float, float]:
    """Slowest speed, mm/s, and largest lag, mm, of an arm over two lines under each pin."""
    system = pd.System()
    system.body("hand", 0.55, velocity=SPEED)
    stroke = pd.harmonic(0.0, 0.0, 1.0) + pd.Profile([0.0, 10.0], [0.0, SPEED * 10.0])
    system.spring("hand", stiffness=135, damping=6.5, length=stroke)
    for i in range(pins):
        name = f"pin {i}"
        system.body(name, 1e-3, velocity=SPEED)
        system.spring(name, "hand", stiffness=250, damping=0.5)
        begins = [(0.01 + line * pitch + i * stagger) / SPEED for line in (0, 1)]
        system.contact(name, kinetic=0.225, static=0.27, load=load_of(begins, width / SPEED))
        system.contact(
            name, "hand", kinetic="30 mN", static="45 mN", stiffness=300, damping=damping
        )
    end = (0.01 + pitch + (pins - 1) * stagger + width) / SPEED + 0.03
    hand = system.simulate(duration=end)["hand"]
    t = np.linspace(0.0, end, 20001)
    lag = np.abs(SPEED * t - np.asarray(hand.position(t)))
    return 1e3 * float(np.min(hand.velocity(t))), 1e3 * float(lag.max())


@pytest.mark.parametrize(
    ("pins", "damping", "slowest", "lag"),
    [
        (1, 0.0, 54.07, 0.407),
        (4, 0.0, 42.17, 1.582),
        (16, 0.0, 22.78, 4.484),
        (1, 0.3, 54.06, 0.409),
        (4, 0.3, 42.06, 1.591),
        (16, 0.3, 22.47, 4.529),
    ],
)
def test_staggered_lines_slow_a_hand_as_in_another_program(
    pins: int, damping: float, slowest: float, lag: float
) -> None:
    """Slowest speeds at the ends of steps, as the program has them."""
    found = numbers_of_hand(pins, 1e-3, 4e-3, 0.4e-3, damping)
    assert found[0] == pytest.approx(slowest - 0.005, abs=0.011)
    assert found[1] == pytest.approx(lag, abs=0.0006)


def test_a_bar_under_sixteen_pins_pushes_a_hand_back_as_in_another_program() -> None:
    found = numbers_of_hand(16, 8e-3, 12e-3, 0.0, 0.0)
    assert found[0] == pytest.approx(-26.12, abs=0.02)
    assert found[1] == pytest.approx(15.110, abs=0.0006)

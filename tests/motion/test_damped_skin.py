"""Damped skin against an integrator that shares no code, its laws and its limits."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from oracle.damped_skin import Piece, Pin, straight, wave
from oracle.mp_damped_skin import refined
from pindrive import Contact, Drive, Function, Profile, Release, harmonic, simulate

LASTS = 0.25
AMPLITUDE, FREQUENCY = 0.03, 20.0
LOADS = ["constant", "rows", "jumps"]
UNDECIDED = (45, 192)
"""Drives of which the integrator ends: a force at its limit to all digits, by round numbers."""


Rows = list[tuple[float, float, float]]
"""Time, value and rate of an input from then on."""


def drawn(rng: np.random.Generator) -> tuple[Drive, Release, Pin, float, float]:
    """A drive of round numbers and its inputs, for pindrive and for the integrator."""
    mass, stiffness = (float(rng.choice(of)) for of in ([0.005, 0.01, 0.02], [50, 100, 200]))
    damping = round(2.0 * float(rng.choice([0, 0.05, 0.1, 0.3, 1])) * (mass * stiffness) ** 0.5, 3)
    plate = float(rng.choice([0.0, 0.01, 0.02, 0.05])) * np.array([1.0, rng.choice([1.0, 1.5])])
    finger = float(rng.choice([0.005, 0.01, 0.03])) * np.array([1.0, rng.choice([1, 1, 1.5, 2])])
    skin = float(rng.choice([100, 300, 1000]))
    damper = float(rng.choice([0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0]))
    v, x = float(rng.choice([0.0, 0.02, 0.06, 0.1])), float(rng.choice([0.0, 0.5e-3, 1e-3, 2e-3]))
    last = LASTS - 0.05
    kind, pressing = (str(rng.choice(of)) for of in (["constant", "rows", "sinusoid"], LOADS))
    hands: dict[str, tuple[float | Profile | Function, Rows]] = {
        "constant": (v, [(0.0, v, 0.0)]),
        "rows": (
            Profile([0.0, 0.05, LASTS], [v, v + 0.04, v - 0.02]),
            [(0.0, v, 0.8), (0.05, v + 0.04, -0.06 / last)],
        ),
        "sinusoid": (harmonic(amplitude=AMPLITUDE, frequency=FREQUENCY, mean=v), [(0.0, v, 0.0)]),
    }
    hand, along = hands[kind]
    loads: dict[str, tuple[float | Profile, Rows]] = {
        "constant": (1.0, [(0.0, 1.0, 0.0)]),
        "rows": (
            Profile([0.0, 0.1, LASTS], [1.0, 0.2, 1.5]),
            [(0.0, 1.0, -8.0), (0.1, 0.2, 1.3 / (LASTS - 0.1))],
        ),
        "jumps": (
            Profile([0.0, 0.04, 0.04, 0.12, 0.12], [1.0, 1.0, 0.4, 0.4, 1.2]),
            [(0.0, 1.0, 0.0), (0.04, 0.4, 0.0), (0.12, 1.2, 0.0)],
        ),
    }
    load, pressed = loads[pressing]
    pieces: list[Piece] = []
    for t in sorted({row[0] for row in (*along, *pressed)}):
        since, velocity, faster = [row for row in along if row[0] <= t][-1]
        of_touch, touch, more = [row for row in pressed if row[0] <= t][-1]
        touch += more * (t - of_touch)
        if kind == "sinusoid":
            pieces.append(wave(t, velocity, AMPLITUDE, 2.0 * pi * FREQUENCY, touch, more))
        else:
            pieces.append(straight(t, velocity + faster * (t - since), faster, touch, more))
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping=damping,
        plate=Contact(plate[0], plate[1]),
        finger=Contact(finger[0], finger[1], stiffness=skin, damping=damper),
    )
    release = Release(hand, x, velocity=v, skin_stretch=0.0, finger_load=load)
    pin = Pin(
        mass, stiffness, damping, (plate[0], plate[1]), (finger[0], finger[1]), skin, damper, pieces
    )
    return drive, release, pin, x, v


@pytest.mark.parametrize("number", sorted({*range(302)} - {*UNDECIDED}))
def test_an_integrator_finds_the_same_motion(number: int) -> None:
    drive, release, pin, x, v = drawn(np.random.default_rng([1, number]))
    motion, times = simulate(drive, release, duration=LASTS), np.linspace(0.0, LASTS, 40)
    expected, _ = pin.follow(x, v, 0.0, times)
    found = np.array([motion.position(times), motion.velocity(times), motion.stretch(times)])
    size = np.maximum(np.abs(expected).max(axis=0), [1e-6, 1e-4, 1e-6])
    assert (np.abs(found.T - expected) / size).max() < 1e-10
    assert motion.certificate().worst < 1e-11


STRAIGHT = [
    number
    for number in range(60)
    if number not in UNDECIDED
    and all(len(piece.start) == 2 for piece in drawn(np.random.default_rng([1, number]))[2].pieces)
][:12]


@pytest.mark.parametrize("number", STRAIGHT)
def test_thirty_digits(number: int) -> None:
    """Position, velocity, stretch and the times of the events."""
    drive, release, pin, x, v = drawn(np.random.default_rng([1, number]))
    times = np.linspace(0.0, 0.999 * LASTS, 24)
    _, segments = pin.follow(x, v, 0.0, times)
    rows, events = refined(pin, (x, v, 0.0), segments, times)
    motion, expected = simulate(drive, release, duration=LASTS), np.array(rows)
    found = np.array([motion.position(times), motion.velocity(times), motion.stretch(times)]).T
    size = np.maximum(np.abs(expected).max(axis=0), [1e-6, 1e-4, 1e-6])
    assert (np.abs(found - expected) / size).max() < 3e-13
    known = np.array(sorted({event.time for event in motion.events}))
    for time in events:
        assert np.abs(known - time).min() < 1e-13, time


def finger(damping: float | None, static: float = 0.045) -> Contact:
    return Contact(0.030, static, stiffness=300.0, damping=damping)


def pin(contact: Contact) -> Drive:
    return Drive(
        mass=0.001, stiffness=250.0, damping=0.1, plate=Contact(0.0022, 0.0026), finger=contact
    )


HANDS = {
    "constant": Release(0.06, 1e-3),
    "rows": Release(Profile([0.0, 0.03, 0.05], [0.06, 0.06, -0.02]), 1e-3),
    "touch": Release(0.06, 1e-3, finger_load=Profile([0.0, 0.01, 0.03], [1.0, 0.4, 1.1])),
    "lifted": Release(0.06, 1e-3, finger_load=Profile([0.0, 0.004, 0.01, 0.02], [1, 0, 0, 1])),
    "touch over time": Release(
        0.06, 1e-3, finger_load=harmonic(amplitude=0.4, frequency=40.0, mean=1.0)
    ),
    "across": Release(0.06, 1e-3, across_velocity=0.03),
    "pull": Release(0.06, 5e-4, plate_load=Profile([0.0, 0.02, 0.021], [60.0, 60.0, 1.0])),
}


@pytest.mark.parametrize("hand", HANDS)
@pytest.mark.parametrize("parameter", ["finger.damping", "finger.stiffness", "finger.kinetic"])
def test_derivatives(parameter: str, hand: str) -> None:
    name, contact, times = parameter.partition(".")[2], finger(0.3), np.linspace(0.001, 0.06, 60)
    found = simulate(pin(contact), HANDS[hand], duration=0.07).sensitivity([parameter])
    step = 1e-6 * getattr(contact, name)
    kept = {n: getattr(contact, n) for n in ("kinetic", "static", "stiffness", "damping")}
    near = [
        simulate(
            pin(Contact(**{**kept, name: kept[name] + by})), HANDS[hand], duration=0.07
        ).position(times)
        for by in (step, -step)
    ]
    expected = (near[0] - near[1]) / (2.0 * step)
    assert np.abs(expected).max() > 0.0
    assert found.position(times)[0] == pytest.approx(
        expected, abs=1e-6 * np.abs(expected).max() + 1e-15 / step
    )


@pytest.mark.parametrize("hand", [hand for hand in HANDS if hand != "touch over time"])
def test_little_damping_is_none(hand: str) -> None:
    """The distance falls with the damping, but for the time in which the stretch decays."""
    times = np.linspace(0.0, 0.06, 200)
    without = simulate(pin(finger(None)), HANDS[hand], duration=0.07).position(times)
    size = np.abs(without).max()
    apart = [
        np.abs(simulate(pin(finger(b)), HANDS[hand], duration=0.07).position(times) - without).max()
        for b in (1e-3, 1e-4, 1e-5)
    ]
    assert apart[0] > apart[1] > apart[2]
    assert apart[2] < 1e-3 * size


def test_much_damping_makes_a_rigid_finger() -> None:
    times = np.linspace(0.0, 0.06, 200)
    rigid = simulate(pin(Contact(0.030, 0.030)), HANDS["pull"], duration=0.07).position(times)
    apart = [
        np.abs(
            simulate(pin(finger(b, 0.030)), HANDS["pull"], duration=0.07).position(times) - rigid
        ).max()
        for b in (1e1, 1e2, 1e3)
    ]
    assert apart[0] > 3.0 * apart[1] > 9.0 * apart[2]


@pytest.mark.parametrize("ratio", [1.4, 3.0])
def test_a_pin_that_slips_on_skin_decays_as_on_a_rigid_finger(ratio: float) -> None:
    """The pin never stops; the rest criterion ends its motion long before a double underflows."""
    slipping = Release(0.25, -1.5e-3, velocity=0.25)
    rigid, skin = (
        simulate(
            Drive(mass=0.016, stiffness=240.0, damping_ratio=ratio, plate=plate, finger=finger),
            slipping,
        )
        for plate, finger in (
            (Contact(0.066), Contact(0.042)),
            (Contact(0.066), Contact(0.042, stiffness=1300.0, damping=2.3)),
        )
    )
    assert rigid.ending.kind == skin.ending.kind == "decaying"
    assert skin.segments[-1].begin < 2.0
    assert skin.ending.position == pytest.approx(rigid.ending.position, rel=1e-9)
    assert skin.transient.settling_time == pytest.approx(rigid.transient.settling_time, rel=1e-6)
    assert skin.transient.trough_time == rigid.transient.trough_time == np.inf


def test_the_damper_of_the_skin_has_its_own_energy() -> None:
    """The integral of b s' squared; and all parts add up."""
    motion = simulate(pin(finger(0.3)), HANDS["constant"], duration=0.07)
    t = np.linspace(0.0, 0.07, 700_001)
    rate = np.asarray(motion.stretch_rate(t))
    ledger = motion.energy
    assert ledger.skin_dissipated == pytest.approx(np.trapezoid(0.3 * rate**2, t), rel=1e-4)
    assert abs(ledger.residual) < 1e-15 * ledger.plate_dissipated + 1e-18


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"damping": 0.3}, "damping must be left out for a rigid contact; give stiffness too"),
        ({"stiffness": 300.0, "damping": -1.0}, "damping must be finite and at least 0 N"),
    ],
)
def test_damping_is_that_of_skin(given: dict[str, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Contact(0.005, **given)  # type: ignore[arg-type]

"""Random drives with piecewise-linear inputs, in named families."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

from oracle import make_cases
from oracle.make_cases import frequency, log_uniform, short
from oracle.mp_oracle import Event

Inputs = dict[str, Any]  # as mp_piecewise reads them
Rows = list[list[float]]


def common(rng: random.Random) -> Inputs:
    """The common pin of `make_cases`, in the form of `mp_piecewise`."""
    drawn = make_cases.common(rng)
    pin = {name: drawn[name] for name in ("mass", "stiffness", "damping", "displacement")}
    pin |= {"velocity": None, "skin_stretch": None, "load": [[0.0, 1.0]]}
    pin["mouse_velocity"] = [[0.0, drawn["mouse_velocity"]]]
    for name in ("plate", "finger"):
        force = drawn[f"{name}_kinetic"]
        pin[name] = {"curve": [[0.0, force]], "static": force, "stiffness": None}
    return pin


def rounded(rows: Rows) -> Rows:
    return [[short(value) for value in row] for row in rows]


def speed(pin: Inputs) -> float:
    """Return a start of the mouse, or an equivalent velocity of the pin."""
    start = abs(pin["mouse_velocity"][0][1])
    return float(start or frequency(pin) * abs(pin["displacement"]))


def period(pin: Inputs) -> float:
    return 2 * math.pi / frequency(pin)


def knots(rng: random.Random, pin: Inputs, values: list[float], first: float = 0.0) -> Rows:
    """Rows at increasing times, a fraction of a period to two periods apart."""
    time, rows = first * period(pin), []
    for value in values:
        rows.append([time, value])
        time += period(pin) * log_uniform(rng, 0.1, 2.0)
    return rounded(rows)


def raise_static(rng: random.Random, pin: Inputs, *contacts: str) -> None:
    for name in contacts:
        pin[name]["static"] = short(pin[name]["curve"][0][1] * rng.uniform(1.02, 2.5))


def maybe_static(rng: random.Random, pin: Inputs) -> Inputs:
    if rng.random() < 0.4:
        raise_static(rng, pin, "plate", "finger")
    return pin


def soften(rng: random.Random, pin: Inputs, low: float, high: float) -> None:
    pin["finger"]["stiffness"] = short(log_uniform(rng, low, high))


def bend(rng: random.Random, pin: Inputs, name: str, shape: str) -> None:
    """Give the contact a curve through its kinetic force at rest."""
    force, scale = pin[name]["curve"][0][1], speed(pin)
    speeds = [0.0, scale * log_uniform(rng, 0.05, 0.5)]
    for _ in range(rng.randint(0, 2)):
        speeds.append(speeds[-1] + scale * rng.uniform(0.1, 1.0))
    factors = [1.0]
    for i in range(1, len(speeds)):
        falls = shape == "falling" or (shape == "stribeck" and i == 1)
        factors.append(factors[-1] * (rng.uniform(0.4, 0.95) if falls else rng.uniform(1.02, 1.6)))
    if shape == "stribeck" and len(speeds) == 2:
        speeds, factors = (
            [*speeds, 2.5 * speeds[-1]],
            [*factors, factors[-1] * rng.uniform(1.0, 1.4)],
        )
    rows = [[u, force * f] for u, f in zip(speeds, factors, strict=True)]
    pin[name]["curve"] = rounded(rows)
    pin[name]["static"] = max(pin[name]["curve"][0][1], pin[name]["static"])


def steps(rng: random.Random, pin: Inputs) -> Rows:
    """A hand that speeds up, slows down, stands still and turns."""
    values = [speed(pin)]
    for _ in range(rng.randint(3, 7)):
        values.append(rng.choice([0.0, values[-1], rng.uniform(-1.5, 1.5) * speed(pin)]))
    return knots(rng, pin, values)


def pulls(rng: random.Random, pin: Inputs) -> Rows:
    """A magnet that rises and decays."""
    values = [rng.choice([0.0, 1.0, 2.0])]
    for _ in range(rng.randint(2, 5)):
        values.append(rng.choice([0.0, values[-1], rng.uniform(0.2, 3.0)]))
    return knots(rng, pin, values, rng.choice([0.0, 0.3]))


def hold(rng: random.Random, pin: Inputs, least: float = 1.1, most: float = 3.0) -> None:
    """Make the plate strong enough to carry the pin from the start, for a while."""
    start = pin["mouse_velocity"][0][1]
    pin["displacement"] = short(pin["displacement"] * rng.uniform(-0.3, 0.3))
    drag = pin["finger"]["static"] + pin["damping"] * abs(start)
    way = abs(start) * period(pin) * rng.uniform(0.3, 1.0)
    static = (pin["stiffness"] * (abs(pin["displacement"]) + way) + drag) * rng.uniform(least, most)
    pin["plate"]["curve"] = rounded([[0.0, static / rng.choice([1.0, 1.0, 1.5])]])
    pin["plate"]["static"] = max(short(static), pin["plate"]["curve"][0][1])


# -- families -----------------------------------------------------------------------------------


def mouse_accelerates(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    start = pin["mouse_velocity"][0][1]
    faster = rng.choice([0.0, 0.3, 1.0]) * start, start * rng.uniform(1.2, 3.0)
    pin["mouse_velocity"] = knots(rng, pin, list(faster), rng.choice([0.0, 0.2, 0.7]))
    return pin


def mouse_stops(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    pin["mouse_velocity"] = knots(rng, pin, [pin["mouse_velocity"][0][1], 0.0], rng.uniform(0, 1.5))
    return pin


def mouse_stops_while_carried(rng: random.Random) -> Inputs:
    pin = common(rng)
    hold(rng, pin, 0.6, 2.0)
    pin["mouse_velocity"] = knots(rng, pin, [pin["mouse_velocity"][0][1], 0.0], 0.05)
    if rng.random() < 0.4:
        more = knots(rng, pin, [rng.uniform(-1, 1) * speed(pin)])
        start = pin["mouse_velocity"][-1][0] + period(pin) * rng.uniform(0.2, 1)
        pin["mouse_velocity"] += rounded([[start, 0.0], [start + period(pin), more[0][1]]])
    return pin


def mouse_reverses(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    start = pin["mouse_velocity"][0][1]
    values = [start, -start * rng.uniform(0.3, 1.5)]
    if rng.random() < 0.5:
        values.append(start)
    pin["mouse_velocity"] = knots(rng, pin, values, rng.uniform(0, 1.0))
    return pin


def reversal_while_carried(rng: random.Random) -> Inputs:
    pin = common(rng)
    hold(rng, pin)
    start = pin["mouse_velocity"][0][1]
    values = [start, -start * rng.uniform(0.3, 1.5), start * rng.choice([-0.5, 0.0, 1.0])]
    pin["mouse_velocity"] = knots(rng, pin, values, 0.05)
    if rng.random() < 0.3:
        raise_static(rng, pin, "finger")
    return pin


def handed_over_at_the_turn(rng: random.Random) -> Inputs:
    """Carried towards the spring's rest; as the mouse turns, the finger's drag does so too."""
    pin = common(rng)
    make_cases.damp(pin, log_uniform(rng, 0.003, 0.1))
    start, drag = pin["mouse_velocity"][0][1], pin["finger"]["curve"][0][1]
    way, turn = math.copysign(1.0, start), period(pin) * rng.uniform(0.02, 0.2)
    over, path = drag * rng.uniform(-0.9, 0.5), start * turn / 2
    pull = pin["plate"]["static"] + over
    pin["displacement"] = short(-way * pull / pin["stiffness"] - path)
    pin["mouse_velocity"] = rounded([[0.0, start], [2 * turn, -start]])
    if rng.random() < 0.6:  # the finger can hold what the plate lets go
        needed = abs(pin["mass"] * abs(start) / turn - over)
        pin["finger"]["static"] = max(drag, short(needed * rng.uniform(1.05, 1.5)))
    return pin


def mouse_starts_again(rng: random.Random) -> Inputs:
    """Starts from rest, or stops and stays, then moves on."""
    pin = maybe_static(rng, common(rng))
    start = pin["mouse_velocity"][0][1]
    before = [0.0] if rng.random() < 0.5 else [start, 0.0, 0.0]
    pin["mouse_velocity"] = knots(rng, pin, [*before, start * rng.uniform(-1.5, 1.5)], 0.2)
    return pin


def hand(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    pin["mouse_velocity"] = steps(rng, pin)
    return pin


def resting_pin_shaken_loose(rng: random.Random) -> Inputs:
    """The finger holds the pin until the mouse accelerates."""
    pin = common(rng)
    pin["velocity"], start = 0.0, pin["mouse_velocity"][0][1]
    pin["displacement"] = short(pin["displacement"] * 0.1)
    needed = pin["stiffness"] * abs(pin["displacement"]) + pin["plate"]["static"]
    static = needed * rng.uniform(1.02, 1.5)
    pin["finger"]["curve"] = rounded([[0.0, static / rng.choice([1.0, 1.5])]])
    pin["finger"]["static"] = max(short(static), pin["finger"]["curve"][0][1])
    width = pin["mass"] * abs(start) / static / rng.uniform(1.2, 6.0)
    later = rng.uniform(0.1, 1.0) * period(pin)
    pin["mouse_velocity"] = rounded(
        [[later, start], [later + width, start * rng.choice([-1.0, 0.0, 2.0])]]
    )
    return pin


def load_falls(rng: random.Random) -> Inputs:
    """Carried, until the magnet lets go."""
    pin = common(rng)
    hold(rng, pin)
    pin["load"] = knots(rng, pin, [1.0, rng.choice([0.0, 0.0, 0.1])], rng.uniform(0.0, 0.3))
    return pin


def load_rises(rng: random.Random) -> Inputs:
    """A free pin is captured."""
    pin = maybe_static(rng, common(rng))
    pin["velocity"] = rng.choice([None, 0.0, short(speed(pin) * rng.uniform(-2, 2))])
    top = pin["stiffness"] * abs(pin["displacement"]) / pin["plate"]["static"]
    pin["load"] = knots(rng, pin, [rng.choice([0.0, 0.1]), top * rng.uniform(0.5, 2.0)], 0.1)
    return pin


def load_comes_and_goes(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    pin["load"] = pulls(rng, pin)
    return pin


def load_and_mouse(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    pin["load"], pin["mouse_velocity"] = pulls(rng, pin), steps(rng, pin)
    return pin


def curve(shape: str, *contacts: str) -> Callable[[random.Random], Inputs]:
    def draw(rng: random.Random) -> Inputs:
        pin = maybe_static(rng, common(rng))
        for name in contacts:
            bend(rng, pin, name, shape)
        if rng.random() < 0.4:
            pin["mouse_velocity"] = steps(rng, pin)
        if rng.random() < 0.3:
            pin["load"] = [[0.0, short(rng.uniform(0.3, 2.0))]]
        return pin

    draw.__name__ = f"{shape}_curve_at_{'_and_'.join(contacts)}"
    return draw


def curve_and_load(rng: random.Random) -> Inputs:
    pin = load_comes_and_goes(rng)
    bend(rng, pin, "finger", rng.choice(["rising", "falling", "stribeck"]))
    return pin


def soft_finger(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    soften(rng, pin, 1e2, 1e4)
    return pin


def stiff_finger(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    soften(rng, pin, 1e4, 1e6)
    return pin


def stretched_skin(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    soften(rng, pin, 1e2, 3e4)
    most = pin["finger"]["static"] / pin["finger"]["stiffness"]
    pin["skin_stretch"] = short(most * rng.uniform(-0.99, 0.99))
    pin["velocity"] = rng.choice([None, 0.0])
    return pin


def soft_finger_and_hand(rng: random.Random) -> Inputs:
    pin = maybe_static(rng, common(rng))
    soften(rng, pin, 1e2, 3e4)
    pin["mouse_velocity"] = steps(rng, pin)
    return pin


def soft_finger_carried(rng: random.Random) -> Inputs:
    pin = common(rng)
    soften(rng, pin, 1e2, 1e6)
    hold(rng, pin)
    start = pin["mouse_velocity"][0][1]
    values = [start, start * rng.choice([0.0, -1.0]), start * rng.choice([0.0, 0.5])]
    pin["mouse_velocity"] = knots(rng, pin, values, 0.1)
    if rng.random() < 0.6:
        pin["load"] = knots(rng, pin, [1.0, 1.0, 0.0])
    return pin


def static_above_kinetic(rng: random.Random) -> Inputs:
    pin = load_and_mouse(rng)
    raise_static(rng, pin, "plate", "finger")
    return pin


def any_damping(rng: random.Random) -> Inputs:
    """Undamped, at and beside critical, overdamped; the rest at random."""
    pin = rng.choice([hand, load_comes_and_goes, load_and_mouse, soft_finger_and_hand])(rng)
    ratios = [0.0, 0.0, 1.0, 1 + 1e-9, 1 - 1e-9, 1.001, log_uniform(rng, 1.02, 30), 0.9]
    make_cases.damp(pin, rng.choice(ratios))
    return pin


def all_together(rng: random.Random) -> Inputs:
    """A finger of skin, a magnet and a hand, static > kinetic."""
    pin = common(rng)
    pin["load"], pin["mouse_velocity"] = pulls(rng, pin), steps(rng, pin)
    raise_static(rng, pin, "plate", "finger")
    soften(rng, pin, 1e2, 1e5)
    if rng.random() < 0.5:
        make_cases.damp(pin, rng.choice([0.0, 1.0, log_uniform(rng, 1.05, 10.0)]))
    return pin


def all_together_at_constant_load(rng: random.Random) -> Inputs:
    """With a Stribeck curve at the plate, which the load may then only scale."""
    pin = all_together(rng)
    pin["load"] = [[0.0, short(rng.uniform(0.5, 2.0))]]
    bend(rng, pin, "plate", "stribeck")
    return pin


FAMILIES: dict[str, Callable[[random.Random], Inputs]] = {
    family.__name__: family
    for family in (
        mouse_accelerates,
        mouse_stops,
        mouse_stops_while_carried,
        mouse_reverses,
        reversal_while_carried,
        handed_over_at_the_turn,
        mouse_starts_again,
        hand,
        resting_pin_shaken_loose,
        load_falls,
        load_rises,
        load_comes_and_goes,
        load_and_mouse,
        curve("rising", "plate", "finger"),
        curve("falling", "plate"),
        curve("falling", "finger"),
        curve("stribeck", "plate"),
        curve("stribeck", "plate", "finger"),
        curve_and_load,
        soft_finger,
        stiff_finger,
        stretched_skin,
        soft_finger_and_hand,
        soft_finger_carried,
        static_above_kinetic,
        any_damping,
        all_together,
        all_together_at_constant_load,
    )
}


def curved_plate_under_load(rng: random.Random) -> Inputs:
    pin = rng.choice([load_falls, load_rises, load_comes_and_goes, load_and_mouse])(rng)
    bend(rng, pin, "plate", rng.choice(["rising", "falling", "stribeck"]))
    return pin


def curves_and_load(rng: random.Random) -> Inputs:
    pin = curved_plate_under_load(rng)
    bend(rng, pin, "finger", rng.choice(["rising", "falling", "stribeck"]))
    return pin


def curved_plate_under_load_and_skin(rng: random.Random) -> Inputs:
    pin = all_together(rng)
    bend(rng, pin, "plate", rng.choice(["rising", "stribeck"]))
    return pin


# What the plate does in these has no closed form.
SERIES_FAMILIES: dict[str, Callable[[random.Random], Inputs]] = {
    family.__name__: family
    for family in (curved_plate_under_load, curves_and_load, curved_plate_under_load_and_skin)
}


def has(contact: str, kind: str) -> Callable[[Event], bool]:
    return lambda event: (event.contact, event.kind) == (contact, kind)


# What a motion must show to belong; most families are defined by their inputs alone.
SHOWS: dict[str, Callable[[Event], bool]] = {
    "mouse_stops_while_carried": lambda e: e.velocity == 0 and e.contact != "plate",
    "reversal_while_carried": lambda e: has("finger", "reverse")(e) and e.velocity == 0,
    "handed_over_at_the_turn": lambda e: e.contact == "plate" and e.velocity == 0,
    "resting_pin_shaken_loose": has("finger", "slip"),
    "load_falls": has("plate", "slip"),
    "load_rises": lambda e: e.contact != "finger" and e.kind == "stick",
    "soft_finger": has("finger", "stick"),
    "stiff_finger": has("finger", "slip"),
    "stretched_skin": has("finger", "slip"),
    "soft_finger_carried": has("finger", "stick"),
    "all_together": has("finger", "stick"),
}

"""Draw random cases, answer them with the thirty-digit oracle, store both: COUNT SEED OUT.

    cd tests && python -m oracle.make_cases 300 298 oracle/cases.json.gz

Each case belongs to a named family and is drawn from its own random stream, so that the file does
not depend on how the work is shared out. Numbers are stored as Python prints them, which is exact.
A draw is discarded, and counted, only where the right answer hangs on a relative 1e-9 (an event
that one cannot ask to 1e-10 s), where an event falls on the end, or where the motion lacks what its
family is about.
"""

from __future__ import annotations

import gzip
import json
import math
import multiprocessing
import random
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path as File
from typing import Any

from oracle import mp_oracle

SAMPLES = 40
MARGIN = 1e-6  # s, between a stored time and an event
MOST_EVENTS = 20

Inputs = dict[str, Any]  # the arguments of mp_oracle.Pin


def common(rng: random.Random) -> Inputs:
    """A plausible released pin: static = kinetic, 0.01 < damping ratio < 0.5, released carried."""
    pin: Inputs = {
        "mass": rng.uniform(2e-3, 20e-3),
        "stiffness": log_uniform(rng, 20.0, 400.0),
        "mouse_velocity": rng.choice([1, 1, 1, -1]) * rng.uniform(0.02, 0.3),
        "displacement": rng.choice([1, 1, -1]) * rng.uniform(0.5e-3, 3e-3),
        "velocity": None,
    }
    swing = max(abs(pin["displacement"]), abs(pin["mouse_velocity"]) / frequency(pin))
    for contact, low, high in (("plate", 0.03, 0.4), ("finger", 0.02, 0.15)):
        force = pin["stiffness"] * swing * log_uniform(rng, low, high)
        pin[f"{contact}_kinetic"] = min(max(force, 1e-3), 0.1)
    pin = {name: value and short(value) for name, value in pin.items()}
    pin["plate_static"], pin["finger_static"] = pin["plate_kinetic"], pin["finger_kinetic"]
    damp(pin, log_uniform(rng, 0.01, 0.5))
    return pin


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def short(value: float) -> float:
    """Six digits are enough to draw, and readable when a case fails."""
    return float(f"{value:.6g}")


def frequency(pin: Inputs) -> float:
    return math.sqrt(pin["stiffness"] / pin["mass"])


def damp(pin: Inputs, ratio: float) -> None:
    """Damping from its ratio, unrounded: near 1 every digit counts."""
    pin["damping"] = ratio * 2 * math.sqrt(pin["mass"] * pin["stiffness"])


def set_friction(pin: Inputs, contact: str, kinetic: float, static: float | None = None) -> None:
    pin[f"{contact}_kinetic"] = short(kinetic)
    pin[f"{contact}_static"] = short(kinetic if static is None else static)


def raise_static(rng: random.Random, pin: Inputs, contact: str) -> None:
    kinetic = pin[f"{contact}_kinetic"]
    set_friction(pin, contact, kinetic, kinetic * rng.uniform(1.02, 2.5))


def maybe_static(rng: random.Random) -> Inputs:
    """The common pin; in half of the draws static > kinetic at both contacts."""
    pin = common(rng)
    if rng.random() < 0.5:
        raise_static(rng, pin, "plate")
        raise_static(rng, pin, "finger")
    return pin


# -- families -----------------------------------------------------------------------------------


def undamped_grazing(rng: random.Random) -> Inputs:
    pin = undamped(rng)
    set_friction(pin, "finger", 0.0)
    return pin


def undamped(rng: random.Random) -> Inputs:
    pin = common(rng)
    damp(pin, 0.0)
    return pin


def under_damped(rng: random.Random) -> Inputs:
    pin = common(rng)
    damp(pin, log_uniform(rng, 0.003, 0.95))
    return pin


def near_critical(rng: random.Random) -> Inputs:
    pin = maybe_static(rng)
    damp(pin, 1 + rng.choice([-1e-3, 1e-3, -1e-9, 1e-9]))
    return pin


def critical(rng: random.Random) -> Inputs:
    """Draw b^2 = 4 m k: exactly in half of the draws, otherwise to the last bit."""
    pin = maybe_static(rng)
    if rng.random() < 0.5:
        root_m = round(math.sqrt(pin["mass"]) * 2**22)
        root_k = round(math.sqrt(pin["stiffness"]) * 2**16)
        pin["mass"], pin["stiffness"] = (root_m / 2**22) ** 2, (root_k / 2**16) ** 2
        pin["damping"] = 2 * root_m * root_k / 2**38
    else:
        damp(pin, 1.0)
    return pin


def over_damped(rng: random.Random) -> Inputs:
    pin = maybe_static(rng)
    damp(pin, log_uniform(rng, 1.02, 30.0))
    return pin


def static_at_plate(rng: random.Random) -> Inputs:
    """Draw light damping with a weak or absent finger; many motions end in a stick-slip cycle."""
    pin = common(rng)
    damp(pin, rng.choice([0.0, rng.uniform(0.0, 0.1)]))
    set_friction(pin, "finger", rng.choice([0.0, 0.1, 1.0]) * pin["finger_kinetic"])
    raise_static(rng, pin, "plate")
    return pin


def static_at_finger(rng: random.Random) -> Inputs:
    pin = common(rng)
    raise_static(rng, pin, "finger")
    return pin


def static_at_both(rng: random.Random) -> Inputs:
    pin = common(rng)
    damp(pin, rng.choice([0.0, log_uniform(rng, 0.003, 1.5)]))
    raise_static(rng, pin, "plate")
    raise_static(rng, pin, "finger")
    if rng.random() < 0.3:
        pin["mouse_velocity"] = 0.0
    return pin


def negative_mouse_velocity(rng: random.Random) -> Inputs:
    pin = common(rng)
    pin["mouse_velocity"] = -abs(pin["mouse_velocity"])
    return pin


def zero_mouse_velocity(rng: random.Random) -> Inputs:
    """Draw two contacts with equal velocity; in some draws only one is present."""
    pin = common(rng)
    pin["mouse_velocity"] = 0.0
    pin["velocity"] = rng.choice([None, short(rng.uniform(-0.2, 0.2))])
    force = pin["stiffness"] * abs(pin["displacement"])
    set_friction(pin, "plate", force * log_uniform(rng, 0.02, 0.15))
    absent = rng.choice([None, None, "plate", "finger"])
    if absent:
        set_friction(pin, absent, 0.0)
    return pin


def no_plate_friction(rng: random.Random) -> Inputs:
    pin = common(rng)
    set_friction(pin, "plate", 0.0)
    return pin


def no_finger_friction(rng: random.Random) -> Inputs:
    pin = common(rng)
    set_friction(pin, "finger", 0.0)
    damp(pin, rng.choice([0.0, log_uniform(rng, 0.003, 0.1)]))
    if rng.random() < 0.5:
        raise_static(rng, pin, "plate")
    return pin


def no_friction(rng: random.Random) -> Inputs:
    pin = common(rng)
    set_friction(pin, "plate", 0.0)
    set_friction(pin, "finger", 0.0)
    damp(pin, rng.choice([0.0, 1.0, log_uniform(rng, 0.01, 5.0)]))
    return pin


def slippery_when_sliding(rng: random.Random) -> Inputs:
    """A contact that holds but slides without friction: kinetic 0, static above."""
    pin = common(rng)
    contact = rng.choice(["plate", "finger"])
    set_friction(pin, contact, 0.0, pin[f"{contact}_kinetic"])
    return pin


def carried_at_release(rng: random.Random) -> Inputs:
    """The plate holds the pin at first: spring, damper and finger together stay within static."""
    pin = common(rng)
    way = math.copysign(1.0, pin["mouse_velocity"])
    pin["displacement"] = short(pin["displacement"] * 0.3)
    damp(pin, log_uniform(rng, 0.003, 0.2))
    drag = pin["damping"] * pin["mouse_velocity"] + way * pin["finger_kinetic"]
    needed = abs(pin["stiffness"] * pin["displacement"] + drag)
    static = needed * rng.uniform(1.05, 2.0)
    set_friction(pin, "plate", static / rng.choice([1.0, 1.0, 1.5, 2.0]), static)
    return pin


def resting_at_release(rng: random.Random) -> Inputs:
    """Starts at rest on the finger, which holds it in some draws."""
    pin = common(rng)
    pin["velocity"] = 0.0
    if rng.random() < 0.4:
        drag = math.copysign(pin["plate_kinetic"], pin["mouse_velocity"])
        needed = abs(pin["stiffness"] * pin["displacement"] - drag)
        static = needed * rng.uniform(1.02, 2.0)
        set_friction(pin, "finger", static / rng.choice([1.0, 1.5]), static)
    return pin


def free_start(rng: random.Random) -> Inputs:
    pin = common(rng)
    pin["velocity"] = short(rng.uniform(-2.0, 2.0) * abs(pin["mouse_velocity"]))
    damp(pin, rng.choice([0.0, log_uniform(rng, 0.003, 1.5)]))
    return pin


def negative_displacement(rng: random.Random) -> Inputs:
    pin = common(rng)
    pin["displacement"] = -abs(pin["displacement"])
    return pin


def zero_displacement(rng: random.Random) -> Inputs:
    pin = common(rng)
    pin["displacement"] = 0.0
    pin["velocity"] = rng.choice([None, short(rng.uniform(-0.3, 0.3))])
    return pin


def trap(rng: random.Random) -> Inputs:
    """Reaches the plate's velocity with more spring force than friction holds: must cross."""
    pin = common(rng)
    damp(pin, rng.choice([0.0, log_uniform(rng, 0.003, 0.1)]))
    swing = pin["stiffness"] * abs(pin["displacement"])
    set_friction(pin, "plate", swing * rng.uniform(0.02, 0.15))
    set_friction(pin, "finger", rng.choice([0.0, swing * rng.uniform(0.005, 0.03)]))
    if rng.random() < 0.4:
        raise_static(rng, pin, "plate")
    return pin


def frequency_decades(rng: random.Random) -> Inputs:
    """The common pin with its unit of time changed: natural frequencies from 1 to 1e5 rad/s."""
    pin = common(rng)
    faster = log_uniform(rng, 1.0, 1e5) / frequency(pin)
    pin["mass"] = short(pin["mass"] / faster)
    pin["stiffness"] = short(pin["stiffness"] * faster)
    pin["mouse_velocity"] = short(pin["mouse_velocity"] * faster)
    for contact in ("plate", "finger"):
        set_friction(pin, contact, pin[f"{contact}_kinetic"] * faster)
    if rng.random() < 0.5:
        raise_static(rng, pin, "plate")
    return pin


FAMILIES: dict[str, Callable[[random.Random], Inputs]] = {
    family.__name__: family
    for family in (
        undamped_grazing,
        undamped,
        under_damped,
        near_critical,
        critical,
        over_damped,
        static_at_plate,
        static_at_finger,
        static_at_both,
        negative_mouse_velocity,
        zero_mouse_velocity,
        no_plate_friction,
        no_finger_friction,
        no_friction,
        slippery_when_sliding,
        carried_at_release,
        resting_at_release,
        free_start,
        negative_displacement,
        zero_displacement,
        trap,
        frequency_decades,
    )
}

# What a motion must show to belong; most families are defined by their inputs alone.
SHOWS: dict[str, Callable[[list[mp_oracle.Event]], bool]] = {
    "trap": lambda events: any((e.contact, e.kind) == ("plate", "reverse") for e in events),
    "undamped_grazing": lambda events: bool(events) and events[-1].kind == "slip",
}


# -- answers ------------------------------------------------------------------------------------


def answer(family: str, pin: Inputs, rng: random.Random) -> tuple[dict[str, Any] | None, str]:
    """The stored case, or None and why the draw is discarded."""
    period = 2 * math.pi / frequency(pin)
    ratio = pin["damping"] / (2 * math.sqrt(pin["mass"] * pin["stiffness"]))
    horizon = max(20 * period, 3 * pin["damping"] / pin["stiffness"])
    if 0 < ratio <= 1:  # no longer than the motion is there
        horizon = min(horizon, 40 / (ratio * frequency(pin)))
    path = mp_oracle.solve(mp_oracle.Pin(**pin), horizon, MOST_EVENTS + 1)

    times = [float(e.time) for e in path.events]
    wanted = rng.randint(3, MOST_EVENTS)
    if len(times) > wanted:
        begin, end = times[wanted - 1 : wanted + 1]
        duration = begin + (end - begin) * rng.uniform(0.1, 0.9)
    else:
        last = times[-1] if times else 0.0
        resting = path.mode(path.end) == "resting"
        duration = min(horizon, last + period * (0.5 if resting else rng.uniform(1.0, 5.0)))
    duration = short(duration)
    events = [e for e in path.events if e.time < duration]

    doubts = [reason for time, reason in path.doubts if time <= duration]
    if doubts:
        return None, doubts[0]
    if any(abs(time - duration) < MARGIN for time in times):
        return None, "event at the end"
    if family in SHOWS and not SHOWS[family](events):
        return None, "not of its family"

    sampled = sample_times(rng, times, duration)
    states = [path.state(time) for time in sampled]
    x, v, a = ([float(state[i]) for state in states] for i in range(3))
    case = {
        "family": family,
        "inputs": pin,
        "duration": duration,
        "mode": path.mode(duration),
        "events": [
            [float(e.time), e.contact, e.kind, float(e.position), float(e.velocity)] for e in events
        ],
        "times": sampled,
        "x": x,
        "v": v,
        "a": a,
    }
    return case, ""


def sample_times(rng: random.Random, events: list[float], duration: float) -> list[float]:
    """Return both ends and one random time in every equal part, away from the events."""
    parts = SAMPLES - 2
    times = [0.0, duration]
    for part in range(parts):
        for _ in range(100):
            time = duration * (part + rng.random()) / parts
            if all(abs(time - event) > MARGIN for event in events):
                times.append(time)
                break
    return sorted(times)


def make(job: tuple[int, int]) -> tuple[dict[str, Any], Counter[str]]:
    """Case number `index`: draws until one is kept."""
    index, seed = job
    family = list(FAMILIES)[index % len(FAMILIES)]
    discarded: Counter[str] = Counter()
    for attempt in range(1000):
        rng = random.Random(f"{seed}-{index}-{attempt}")
        case, reason = answer(family, FAMILIES[family](rng), rng)
        if case is not None:
            return case, discarded
        discarded[f"{family}: {reason}"] += 1
    raise RuntimeError(f"{family}: 1000 draws discarded: {dict(discarded)}")


def main(count: int, seed: int, out: File) -> None:
    cases: list[dict[str, Any]] = []
    discarded: Counter[str] = Counter()
    with multiprocessing.Pool(2) as pool:
        jobs = [(index, seed) for index in range(count)]
        for case, thrown in pool.imap(make, jobs):
            cases.append(case)
            discarded += thrown
            print(f"\r{len(cases)}/{count} cases", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    header = {
        "made_by": f"oracle.make_cases {count} {seed}",
        "digits": mp_oracle.DIGITS,
        "discarded": dict(sorted(discarded.items())),
        "families": dict(sorted(Counter(case["family"] for case in cases).items())),
    }
    text = json.dumps(header | {"cases": cases}, separators=(",", ":"))
    out.write_bytes(gzip.compress(text.encode(), mtime=0))
    for name, number in header.items():
        print(f"{name}: {number}")


def load(file: File) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(gzip.decompress(file.read_bytes()))
    return data


def pin_of(case: dict[str, Any]) -> mp_oracle.Pin:
    return mp_oracle.Pin(**case["inputs"])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(int(sys.argv[1]), int(sys.argv[2]), File(sys.argv[3]))

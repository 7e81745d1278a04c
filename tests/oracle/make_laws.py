"""Draw random drives under laws and functions, answered with thirty digits: INPUTS COUNT SEED OUT.

    cd tests && python -m oracle.make_laws rows 1200 47 oracle/law_cases.json.gz
    cd tests && python -m oracle.make_laws functions 1200 48 oracle/function_cases.json.gz

A draw that takes longer than `PATIENCE` is left out; gmpy2 beside mpmath halves the time.
"""

from __future__ import annotations

import gzip
import json
import math
import multiprocessing
import random
import signal
import sys
from pathlib import Path
from typing import Any

from oracle import mp_laws

__all__ = ["load"]

PATIENCE = 30  # s of processor time
LAWS = (("stribeck", 1), ("stribeck", 2), ("hess-soom", 1), ("coulomb", 1))
INPUTS = ("constant", "plate_load", "finger_load", "mouse_velocity", "force", "across_velocity")


FUNCTIONS = ("sinusoid", "stroke", "pull", "push", "touch", "mixed")


def load(path: Path) -> list[dict[str, Any]]:
    """The stored cases."""
    with gzip.open(path, "rt", encoding="utf-8") as file:
        found: list[dict[str, Any]] = json.load(file)
    return found


def draw(kinds: tuple[str, ...], number: int, seed: int) -> dict[str, Any]:
    """One drive, by its number: each law at the plate with each kind of input, in turn."""
    rng = random.Random(f"{seed}-{number}")
    digits = rng.choice([2, 3, 17])

    def of(low: float, high: float) -> float:
        return float(f"{math.exp(rng.uniform(math.log(low), math.log(high))):.{digits}g}")

    def law(name: str, exponent: int, most: float) -> dict[str, Any]:
        breakaway = of(most / 5, most)
        kinetic = float(f"{breakaway * rng.uniform(0.3, 0.95):.{digits}g}")
        found = {"name": name, "exponent": exponent, "kinetic": kinetic, "breakaway": breakaway}
        found |= {"velocity": of(3e-3, 0.2), "viscous": rng.choice([0.0, of(1e-3, 0.2)])}
        rest = kinetic if name == "coulomb" else breakaway
        found["static"] = rng.choice([rest, float(f"{rest * rng.uniform(1.05, 1.5):.{digits}g}")])
        return found

    kind = kinds[number // len(LAWS) % len(kinds)]
    mass, stiffness = of(2e-3, 0.05), of(30.0, 500.0)
    period = 2 * math.pi * math.sqrt(mass / stiffness)
    v_p = rng.choice([-1, 1]) * of(0.01, 0.15)
    inputs: dict[str, Any] = {
        "mouse_velocity": [[0.0, v_p]],
        "plate_load": [[0.0, 1.0]],
        "finger_load": [[0.0, 1.0]],
        "force": [[0.0, 0.0]],
        "across_velocity": [[0.0, 0.0]],
    }
    time = float(f"{period * rng.uniform(0.3, 1.5):.3g}")
    if kind in ("plate_load", "finger_load"):
        inputs[kind] = [[0.0, of(0.5, 3.0)], [time, of(0.2, 2.0)]]
    elif kind == "mouse_velocity":
        inputs[kind] = [[0.0, v_p], [time, float(f"{v_p * rng.uniform(0.1, 2.0):.3g}")]]
    elif kind == "force":
        inputs[kind] = [[0.0, 0.0], [time, rng.choice([-1, 1]) * of(0.005, 0.05)]]
    elif kind == "across_velocity":
        inputs[kind] = [[0.0, of(5e-3, 0.1)]]
    elif kind in FUNCTIONS:
        every = kind == "mixed"
        rate = float(f"{2 * math.pi / period * of(0.2, 5.0):.{digits}g}")
        if kind == "sinusoid" or every:
            wave = [0.0, of(0.2, 2.0) * v_p, 0.0, rate]
            inputs["mouse_velocity"] = {"pieces": [[0.0, [v_p], [wave]]]}
        if kind == "stroke":
            speed = 30 * v_p / 16
            stroke = [v_p / 4, 0.0, speed / time**2, -2 * speed / time**3, speed / time**4]
            inputs["mouse_velocity"] = {"pieces": [[0.0, stroke, []], [time, [v_p / 4], []]]}
            v_p /= 4
        if kind == "pull" or every:
            held, decay = of(0.5, 3.0), 1 / (period * of(0.02, 0.5))
            pull = [[held, 0.0, decay, 0.0], [-held / 2, 0.0, 2 * decay, 0.0]]
            inputs["plate_load"] = {"pieces": [[0.0, [1.0], pull]]}
        if kind == "push" or every:
            dies = [of(5e-3, 0.05), of(5e-3, 0.05), rate / 10, rate]
            inputs["force"] = {"pieces": [[0.0, [0.0, of(1e-3, 0.05)], [dies]]]}
        if kind == "touch" or every:
            inputs["finger_load"] = {
                "pieces": [[0.0, [1.0], [[0.0, rng.uniform(0.1, 0.9), 0.0, 2 * rate]]]]
            }
    duration = 2.5 * period
    return {
        "kind": kind,
        "mass": mass,
        "stiffness": stiffness,
        "damping": float(f"{2 * math.sqrt(mass * stiffness) * rng.uniform(0, 0.5):.{digits}g}"),
        "laws": {
            "plate": law(*LAWS[number % len(LAWS)], 0.05),
            "finger": law(*rng.choice(LAWS), 0.02),
        },
        "inputs": inputs,
        "displacement": rng.choice([-1, 1]) * of(5e-4, 3e-3),
        "velocity": rng.choice([v_p, of(0.01, 0.2)]),
        "times": [float(f"{duration * part / 8:.6g}") for part in range(1, 9)],
    }


def answered(case: dict[str, Any]) -> dict[str, Any]:
    """The case with its answer."""
    found = mp_laws.solve(case)
    events = [[float(t), contact, kind] for t, contact, kind in found["events"]]
    states = [[float(x), float(v)] for x, v in found["states"]]
    return case | {"events": events, "states": states}


def _one(task: tuple[tuple[str, ...], int, int]) -> dict[str, Any] | None:
    """The answered case; None where it takes too long."""
    signal.signal(signal.SIGVTALRM, _interrupt)
    signal.setitimer(signal.ITIMER_VIRTUAL, PATIENCE)
    try:
        return answered(draw(*task))
    except (TimeoutError, ArithmeticError):
        return None
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)


def _interrupt(*_: object) -> None:
    raise TimeoutError


def main(kinds: tuple[str, ...], count: int, seed: int, out: Path) -> None:
    """Draw until there are enough, on all cores."""
    with multiprocessing.Pool() as pool:
        made = pool.imap(_one, ((kinds, number, seed) for number in range(count)), 1)
        cases = [case for case in made if case]
    with gzip.GzipFile(out, "wb", mtime=0) as file:
        file.write(json.dumps(cases).encode())
    print(f"{len(cases)} cases, {sum(len(case['events']) for case in cases)} events")


if __name__ == "__main__":
    inputs = {"rows": INPUTS, "functions": FUNCTIONS}[sys.argv[1]]
    main(inputs, int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4]))

"""Draw random piecewise-linear cases and answer them with thirty digits: COUNT SEED OUT [series].

    cd tests && python -m oracle.make_piecewise 280 311 oracle/piecewise_cases.json.gz
    cd tests && python -m oracle.make_piecewise 90 312 oracle/series_motions.json.gz series

The last word takes the families whose modes have no closed form instead.
As `make_cases`, for everything that `mp_piecewise` can do. A draw is discarded, and counted, also
where it is too sensitive to be asked to 1e-10: where inputs off by a relative 1e-12 give answers
off by more than 1e-8.
"""

from __future__ import annotations

import gzip
import json
import math
import multiprocessing
import random
import sys
from collections import Counter
from functools import partial
from pathlib import Path as File
from typing import Any

from oracle import mp_piecewise
from oracle.make_cases import MARGIN, frequency, load, short
from oracle.mp_oracle import DIGITS
from oracle.piecewise_draws import FAMILIES, SERIES_FAMILIES, SHOWS, Inputs, period

__all__ = ["FAMILIES", "load", "make"]

PARTS = 30  # of the duration, one sample in each
MOST_EVENTS = 24
OFFSET = 1e-12  # relative, of all inputs
SENSITIVE = 1e-8  # relative, of the answer


def answer(family: str, pin: Inputs, rng: random.Random) -> tuple[dict[str, Any] | None, str]:
    """The stored case, or None and why the draw is discarded."""
    inner = sorted({row[0] for name in ("mouse_velocity", "load") for row in pin[name]})
    horizon = max(inner[-1] + 3 * period(pin), 8 * period(pin))
    if pin["finger"]["stiffness"]:  # thousands of ripples on stiff skin are of no use
        horizon = min(horizon, 3000 / math.sqrt(pin["finger"]["stiffness"] / pin["mass"]))
    wanted = rng.randint(4, MOST_EVENTS)
    path = mp_piecewise.solve(pin, horizon, wanted + 1)
    times = [float(e.time) for e in path.events]
    if len(times) > wanted:
        begin, end = times[wanted - 1 : wanted + 1]
        duration = short(begin + (end - begin) * rng.uniform(0.1, 0.9))
    else:
        last = max([*times, inner[-1]])
        duration = short(min(horizon, last + period(pin) * rng.uniform(0.5, 3.0)))
    events = [e for e in path.events if e.time < duration]

    doubts = [reason for time, reason in path.doubts if time <= duration]
    if doubts:
        return None, doubts[0]
    if any(abs(time - duration) < MARGIN for time in (*times, *inner)) or duration > path.end:
        return None, "event at the end"
    moments = Counter((e.time, e.contact) for e in events)
    if max(moments.values(), default=0) > 1:
        return None, "skin gripped for no time"
    if not events or (family in SHOWS and not any(map(SHOWS[family], events))):
        return None, "not of its family"

    case: dict[str, Any] = {
        "family": family,
        "inputs": pin,
        "duration": duration,
        "mode": path.mode(duration),
        "events": [
            [float(e.time), e.contact, e.kind, float(e.position), float(e.velocity)] for e in events
        ],
        "times": sample_times(rng, [*times, *inner], duration),
    }
    states = [path.state(time) for time in case["times"]]
    for i, name in enumerate(("x", "v", "a", "finger_force", "stretch")):
        case[name] = [float(state[i]) for state in states]
    if not pin["finger"]["stiffness"]:
        del case["stretch"]
    if sensitivity(case, rng) > SENSITIVE / OFFSET:
        return None, "sensitive to its inputs"
    return case, ""


def sensitivity(case: dict[str, Any], rng: random.Random) -> float:
    """Relative change of the answer over that of the inputs; equal inputs are changed alike."""
    factors: dict[float, float] = {}

    def off(given: Any) -> Any:
        if isinstance(given, dict):
            return {name: off(value) for name, value in given.items()}
        if isinstance(given, list):
            return [off(value) for value in given]
        return given and given * factors.setdefault(given, 1 + OFFSET * rng.choice([-1, 1]))

    path = mp_piecewise.solve(off(case["inputs"]), case["duration"])
    reported = [(e.contact, e.kind) for e in path.events]
    if reported != [(contact, kind) for _, contact, kind, _, _ in case["events"]]:
        return math.inf
    rate = frequency(case["inputs"])
    moved = [rate * abs(e.time - s[0]) for e, s in zip(path.events, case["events"], strict=True)]
    for i, name in enumerate("xv"):
        scale = max(map(abs, case[name]))
        moved += [
            abs(path.state(time)[i] - value) / scale
            for time, value in zip(case["times"], case[name], strict=True)
        ]
    return float(max(moved)) / OFFSET


def sample_times(rng: random.Random, kinks: list[float], duration: float) -> list[float]:
    """Return both ends and one random time in every equal part, away from events and knots."""
    times = [0.0, duration]
    for part in range(PARTS):
        for _ in range(100):
            time = duration * (part + rng.random()) / PARTS
            if all(abs(time - kink) > MARGIN for kink in kinks):
                times.append(time)
                break
    return sorted(times)


def make(job: tuple[int, int], series: bool = False) -> tuple[dict[str, Any], Counter[str]]:
    """Case number `index`: draws until one is kept."""
    index, seed = job
    families = SERIES_FAMILIES if series else FAMILIES
    family = list(families)[index % len(families)]
    discarded: Counter[str] = Counter()
    for attempt in range(1000):
        rng = random.Random(f"{seed}-{index}-{attempt}")
        pin = families[family](rng)
        try:
            case, reason = answer(family, pin, rng)
        except Exception as error:
            raise RuntimeError(f"{family}: {pin}") from error
        if case is not None:
            return case, discarded
        discarded[f"{family}: {reason}"] += 1
    raise RuntimeError(f"{family}: 1000 draws discarded: {dict(discarded)}")


def main(count: int, seed: int, out: File, series: bool) -> None:
    cases: list[dict[str, Any]] = []
    discarded: Counter[str] = Counter()
    with multiprocessing.Pool(2) as pool:
        for case, thrown in pool.imap(
            partial(make, series=series), [(i, seed) for i in range(count)]
        ):
            cases.append(case)
            discarded += thrown
            print(f"\r{len(cases)}/{count} cases", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    header = {
        "made_by": f"oracle.make_piecewise {count} {seed}" + " series" * series,
        "digits": DIGITS,
        "discarded": dict(sorted(discarded.items())),
        "families": dict(sorted(Counter(case["family"] for case in cases).items())),
    }
    text = json.dumps(header | {"cases": cases}, separators=(",", ":"))
    out.write_bytes(gzip.compress(text.encode(), mtime=0))
    for name, number in header.items():
        print(f"{name}: {number}")


if __name__ == "__main__":
    if sys.argv[4:] not in ([], ["series"]) or len(sys.argv) < 4:
        sys.exit(__doc__)
    main(int(sys.argv[1]), int(sys.argv[2]), File(sys.argv[3]), series=len(sys.argv) > 4)

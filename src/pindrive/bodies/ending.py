"""The ending of a motion of several bodies: rest, a motion that repeats, a drift, or nothing known.

A motion repeats where its state comes back, to 1e-8 of its amplitude: after one or several periods
of the inputs, or, where no input changes any more, at an event of the same kind. Positions may have
advanced alike in every round: the bodies then drift.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import inf, isfinite, lcm, nan, pi
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from pindrive.bodies.inputs import Given, integrated
from pindrive.motion.function import as_function
from pindrive.quantities.status import Status
from pindrive.quantities.value import concise

if TYPE_CHECKING:
    from pindrive.bodies.system import System
    from pindrive.bodies.system_motion import SystemMotion

SystemEndKind = Literal["rest", "settled", "periodic", "drifting", "unknown"]
ENDINGS: Final = {
    "rest": "at rest",
    "settled": "settled",
    "periodic": "periodic",
    "drifting": "drifting",
}
"""Words for each kind that is known."""
SAME: Final = 1e-8
"""Largest change of a state that repeats, over the amplitude of the motion."""
STEPS: Final = (1000, 4000, 16_000, 64_000)
"""Steps after which a motion without a duration is looked at."""
_MOST_ROUNDS: Final = 16
"""Rounds after which a response may repeat."""
_MOST_PARTS: Final = 64
"""Largest numerator and denominator of two frequencies with a common period."""
_SAMPLES: Final = 257
"""Instants at which the amplitude over some rounds is taken."""

Array = NDArray[np.float64]


@concise
@dataclass(frozen=True, slots=True)
class SystemEnding:
    """Ending of a motion of several bodies.

    Attributes:
        kind: `rest`: rigid contacts hold all bodies, and no input changes any more; `settled`: no
            body moves, to 1e-8 of how far it had moved, though nothing holds it; `periodic`: the
            motion repeats; `drifting`: it repeats while bodies advance, or all go on at constant
            velocities; `unknown`: neither, within the duration.
        period: Time after which the motion repeats, s; NaN without one.
        rounds: Periods of the inputs, or rounds from one event to the next of its kind, in that
            time; 0 without one.
        velocities: Mean velocity of each body at the end, m/s, by name.
        residual: Change of the state from one period to the next, over the amplitude.
    """

    kind: SystemEndKind
    period: float
    rounds: int
    velocities: dict[str, float]
    residual: float


def ending_of(motion: SystemMotion) -> SystemEnding:
    """Return the ending of a motion as far as its duration shows it."""
    names = [*motion.system.bodies]

    def ending(
        kind: SystemEndKind,
        period: float = nan,
        rounds: int = 0,
        velocities: Iterable[float] = (),
        residual: float = nan,
    ) -> SystemEnding:
        moving = dict(zip(names, map(float, velocities), strict=False))
        return SystemEnding(kind, period, rounds, moving or dict.fromkeys(names, 0.0), residual)

    if motion.core.rests:
        return ending("rest", residual=0.0)
    begin, period = forcing(motion.system)
    end = float(motion.core.end)
    if motion.status not in (Status.ok, Status.stopped) or not begin < end:
        return ending("unknown")
    rounds = [*_rounds(motion, begin, end, period)]
    for n in range(1, _MOST_ROUNDS + 1):
        if 2 * n >= len(rounds):
            break
        late, middle, early = (rounds[k * n] for k in range(3))
        lasts = late - middle
        change, advance = _changes(motion, late, middle, early)
        if change > SAME:
            continue
        if not advance.any():
            return ending("periodic", lasts, n, residual=change)
        return ending("drifting", lasts, n, advance / lasts, change)
    steady, velocities = _steady(motion, begin, end)
    if period != 0.0 or not steady <= SAME:
        return ending("unknown")
    return ending("drifting" if velocities.any() else "settled", nan, 0, velocities, steady)


def forcing(system: System) -> tuple[float, float]:
    """Return the time from which the inputs repeat, s, and their common period.

    The period is 0 s if they are constant then, and NaN if they have none; ends that move at a
    constant velocity are constant.
    """
    begin, rates = 0.0, set[float]()
    inputs: list[tuple[Given, int]] = [(body.force, 0) for body in system.bodies.values()]
    for contact in system.contacts.values():
        inputs += [(contact.load, 0), (contact.velocity, 0)]
    for spring in system.springs.values():
        inputs.append((spring.length, 1))
        if spring.motion is not None:
            inputs.append((integrated(spring.motion), 1))
    for feedback in system.feedbacks.values():
        inputs.append((integrated(feedback.reference), 1))
        if feedback.period:
            rates.add(1.0 / feedback.period)
    for given, degree in inputs:
        if isinstance(given, float):
            continue
        since, polynomial, terms = as_function(given, "").core[-1]
        begin = max(begin, since)
        if any(polynomial[degree + 1 :]):
            return begin, nan
        rates |= {w / (2.0 * pi) for *_, decay, w in terms if w and not decay}
    return begin, _common_period(sorted(rates))


def _common_period(rates: list[float]) -> float:
    """Return the shortest common period of some frequencies, Hz; 0 without any, NaN without one."""
    if not rates:
        return 0.0
    parts = [Fraction(rate / rates[0]).limit_denominator(_MOST_PARTS) for rate in rates]
    for part, rate in zip(parts, rates, strict=True):
        if abs(float(part) * rates[0] / rate - 1.0) > 1e-12 or part.numerator > _MOST_PARTS**2:
            return nan
    return lcm(*(part.denominator for part in parts)) / rates[0]


def _rounds(motion: SystemMotion, begin: float, end: float, period: float) -> Iterator[float]:
    """Yield the times of the begins of rounds, s, from the last one back."""
    if period > 0.0:
        counts = range(int(end / period), int(np.ceil(begin / period)) - 1, -1)
        yield from (k * period for k in counts if k * period < end)
    elif period == 0.0:
        events = [event for event in motion.events if begin < event.time < end]
        last_kind = [(e.contact, e.kind, e.before, e.after) for e in events[-1:]]
        for event in reversed(events):
            if [(event.contact, event.kind, event.before, event.after)] == last_kind:
                yield event.time


def _state(motion: SystemMotion, t: Array) -> tuple[Array, Array, Array]:
    """Positions, velocities and forces at times, shapes (bodies, n), (bodies, n), (parts, n)."""
    moving, touching, *forces = motion.state_at(t)
    return moving[0], moving[1], np.vstack([touching[0], *forces])


def _changes(motion: SystemMotion, late: float, middle: float, early: float) -> tuple[float, Array]:
    """Return the largest change of a state from a round to the next, and how far bodies advance.

    The change is over the amplitude of the motion in the last round; positions that change by
    rounding alone do not advance.
    """
    x, v, f = _state(motion, np.array([late, middle, early]))
    t = np.linspace(middle, late, _SAMPLES)
    within = _state(motion, t)
    ahead = x[:, 0] - x[:, 1]
    swing = within[0] - np.outer(ahead, (t - middle) / (late - middle))
    sizes = [np.ptp(swing, axis=1).max(), np.ptp(within[1], axis=1).max()]
    sizes.append(np.ptp(within[2], axis=1).max() if f.size else 0.0)
    changes = [
        np.abs(x[:, 0] - 2.0 * x[:, 1] + x[:, 2]).max(),
        np.abs(v[:, :1] - v[:, 1:]).max(),
        np.abs(f[:, :1] - f[:, 1:]).max() if f.size else 0.0,
    ]
    parts = [
        c / s if s else (0.0 if c == 0.0 else inf) for c, s in zip(changes, sizes, strict=True)
    ]
    ahead[np.abs(ahead) <= SAME * sizes[0]] = 0.0
    return float(max(parts)), ahead


def _steady(motion: SystemMotion, begin: float, end: float) -> tuple[float, Array]:
    """Return how far the last tenth is from constant velocities and forces, and the velocities.

    The distance is over the whole motion's; velocities below 1e-8 of the largest are none.
    """
    events = [event.time for event in motion.events]
    since = max(begin, end - 0.1 * (end - begin), *events[-1:])
    if not since < end:
        return inf, np.zeros(0)
    t = np.linspace(since, end, _SAMPLES)
    x, v, f = _state(motion, t)
    whole = _state(motion, motion.sample_times(_SAMPLES))
    velocities = (x[:, -1] - x[:, 0]) / (end - since)
    line = x[:, :1] + np.outer(velocities, t - since)
    size = np.ptp(whole[0], axis=1).max() or np.abs(whole[0]).max()
    fastest = np.abs(whole[1]).max()
    velocities[np.abs(velocities) <= SAME * fastest] = 0.0
    parts = [np.abs(v - velocities[:, None]).max() / fastest if fastest else 0.0]
    parts += [np.abs(x - line).max() / size] if size else []
    parts += [np.ptp(f, axis=1).max() / np.abs(whole[2]).max()] if whole[2].any() else []
    return float(max(parts)), velocities


def numbers_of_ending(ending: SystemEnding) -> dict[str, Any]:
    """Return the numbers of an ending, SI, by name."""
    found = {"ending.period": ending.period, "ending.rounds": float(ending.rounds)}
    velocities = {f"body.{name}.drift": v for name, v in ending.velocities.items()}
    return {name: x for name, x in (found | velocities).items() if isfinite(x)}

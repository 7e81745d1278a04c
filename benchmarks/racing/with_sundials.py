"""CVODE of SUNDIALS by scikit-sundae: explicit modes with its root functions.

Its documentation advises Adams for problems that are not stiff, which a slide is not, BDF for those
that are, and to begin anew at a discontinuity, which each slide does. A guard that a slide begins
at is watched from a first short way on: CVODE would take the rounding around it for a root.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks.racing.modes import Pin, Slid, Slide, Slider, follow
from benchmarks.racing.race import TIMES, FailureError, Racer, one_by_one
from benchmarks.racing.releases import DURATION, Floats

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
FIRST_WAY = 1e-3  # of the longest step, without the guard just left
MOST_STEPS = 100_000


def racers(everything: bool) -> Iterator[Racer]:
    """The better method, or both."""
    for method in ("Adams", "BDF") if everything else ("Adams",):
        for rtol in TOLERANCES:
            lap = one_by_one(in_modes(method, rtol))
            yield Racer("SUNDIALS", f"modes, CVODE {method}", f"rtol {rtol:g}", lap)


def part(
    slide: Slide,
    begin: float,
    end: float,
    state: Floats,
    watched: list[int],
    asked: Floats,
    options: dict[str, Any],
) -> tuple[float, Floats, int | None, Floats]:
    """One run of CVODE: when it ended, the state there, the contact reached, positions asked."""
    from sksundae.cvode import CVODE

    levels = [slide.pin.levels[i] for i in watched]

    def rate(_t: float, y: Floats, slope: Floats) -> None:
        x, v = y.tolist()
        slope[0], slope[1] = v, slide.acceleration(x, v)

    def guards(_t: float, y: Floats, value: Floats) -> None:
        v = float(y[1])
        for i, level in enumerate(levels):
            value[i] = v - level

    guards.terminal = [True] * len(levels)  # type: ignore[attr-defined]
    guards.direction = [-int(slide.sides[i]) for i in watched]  # type: ignore[attr-defined]
    rooted = {"eventsfn": guards, "num_events": len(levels)} if levels else {}
    solver = CVODE(rate, **options, **rooted)
    out = solver.solve(np.unique([begin, *asked, end]), state)
    if not out.success:
        raise FailureError("did not finish")
    stop, last = float(out.t[-1]), out.y[-1]
    rooted_at = levels and out.i_events is not None and len(out.i_events)
    reached = watched[int(np.flatnonzero(out.i_events[-1])[0])] if rooted_at else None
    passed = asked[asked <= stop]
    return stop, last, reached, out.y[np.searchsorted(out.t, passed), 0]


def slider(method: str, rtol: float) -> Slider:
    """Slides by CVODE, ended by its root functions."""

    def slide_on(slide: Slide) -> Slid:
        pin = slide.pin
        longest = pin.longest_step(12)
        options: dict[str, Any] = {
            "method": method,
            "rtol": rtol,
            "atol": np.array([rtol * pin.displacement, rtol * pin.levels[0]]),
            "max_step": longest,
            "max_num_steps": MOST_STEPS,
        }
        t, state, asked = slide.begin, np.array([slide.x, slide.v]), slide.requested
        away = [i for i, level in enumerate(pin.levels) if slide.v != level]
        middle = min(t + FIRST_WAY * longest, (t + slide.end) / 2)
        first = asked[asked < middle]
        t, state, reached, positions = part(slide, t, middle, state, away, first, options)
        if reached is None:
            later, both = asked[len(first) :], [0, 1]
            t, state, reached, last = part(slide, t, slide.end, state, both, later, options)
            positions = np.concatenate([positions, last])
        return Slid(t, float(state[0]), reached, positions)

    return slide_on


def in_modes(method: str, rtol: float) -> Callable[[Floats], Floats]:
    """Positions of one drive, mode by mode."""
    integrate = slider(method, rtol)

    def solve(drive: Floats) -> Floats:
        return follow(Pin.of(drive), integrate, TIMES, DURATION).positions

    return solve

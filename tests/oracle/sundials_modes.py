"""Third oracle: the modes of `explicit_piecewise` under CVODE of SUNDIALS, with its root functions.

A guard left at its zero is handed to CVODE only after a first short way: CVODE would take the zero
that it starts at for a root, or, where the pin leaves tangentially, the rounding around it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from sksundae.cvode import CVODE

from oracle import explicit_piecewise
from oracle.explicit_piecewise import Run
from oracle.watched_dop853 import Answer, Function, Integrator, State, Watch

RTOL = 1e-13
PHASE_TOLERANCE = 1e-8  # of event times, in radians of the natural frequency
STATE_TOLERANCE = 5e-8  # of the scales of x, v, a and force; stiff skin asks for this
HELD = 1e-12  # of its scale: a guard no larger after the first way does not move
FIRST_WAY = 1e-3  # of the longest step, without the guards just left


def _integrate(
    method: str,
    rhs: Function,
    watches: list[Watch],
    t: float,
    y: State,
    end: float,
    longest: float,
    atol: State,
    samples: list[float],
) -> Answer:
    parts = [(t, end, watches)]
    if any(watch.left for watch in watches):
        middle = min(t + FIRST_WAY * longest, (t + end) / 2)
        parts = [(t, middle, [w for w in watches if not w.left]), (middle, end, watches)]
    rows: list[State] = []
    for begin, stop, watched in parts:
        if begin > t:  # a skin held at its limit stays there
            watched = [w for w in watched if abs(w.value(begin, y)) > HELD * w.scale]
        last = stop == end
        requested = [u for u in samples if begin <= u < stop or (last and u == stop)]
        reached, y, which, found = _part(
            method, rhs, watched, begin, y, stop, longest, atol, requested
        )
        rows += found
        if which is not None:
            return reached, y, which, rows
    return end, y, None, rows


# both as `watched_dop853.dop853`; where the hand also moves across, creep makes equations stiff
cvode: Integrator = partial(_integrate, "Adams")
stiff: Integrator = partial(_integrate, "BDF")


def _part(
    method: str,
    rhs: Function,
    watches: list[Watch],
    t: float,
    y: State,
    end: float,
    longest: float,
    atol: State,
    requested: list[float],
) -> Answer:
    def right(u: float, z: State, slope: State) -> None:
        slope[:] = rhs(u, z)

    def guards(u: float, z: State, value: State) -> None:
        value[:] = [watch.value(u, z) / watch.scale for watch in watches]

    rooted: dict[str, Any] = {}
    if watches:
        guards.terminal = [True] * len(watches)  # type: ignore[attr-defined]
        guards.direction = [-1] * len(watches)  # type: ignore[attr-defined]
        rooted = {"eventsfn": guards, "num_events": len(watches)}
    solver = CVODE(
        right,
        method=method,
        rtol=RTOL,
        atol=0.1 * atol,
        max_step=longest,
        max_num_steps=10**6,
        **rooted,
    )
    times = np.array(sorted({t, *requested, end}))
    out = solver.solve(times, y)
    assert out.success, out.message
    which = None
    if watches and out.i_events is not None and len(out.i_events):
        which = watches[int(np.flatnonzero(out.i_events[-1])[0])]
    stop = float(out.t[-1])
    states = {float(u): z for u, z in zip(out.t, out.y, strict=True)}
    rows = [states[u] for u in requested if u in states and (which is None or u < stop)]
    return stop, np.array(out.y[-1]), which, rows


def solve(inputs: Mapping[str, Any], duration: float, samples: Sequence[float] = ()) -> Run:
    """The motion from release to `duration` (s), with the state at the sample times."""
    return explicit_piecewise.solve(inputs, duration, samples, cvode)

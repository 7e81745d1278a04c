"""SciPy's `solve_ivp`: friction smoothed by a tanh, and explicit modes with events.

SciPy's documentation advises RK45 or, for high accuracy, DOP853, for smooth problems, and Radau,
BDF or LSODA for stiff ones. A narrow tanh is stiff. It is given its width as a part of the mouse's
velocity, tolerances that follow the width, and its Jacobian.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import tanh

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.racing.modes import Pin, Slid, Slide, Slider, follow
from benchmarks.racing.race import TIMES, FailureError, Racer, Watch, one_by_one
from benchmarks.racing.releases import DURATION, Floats

WIDTHS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # of the tanh, a part of the mouse's velocity
# Relative tolerance, and the longest step as a part of the period T.
SETTINGS = ((1e-4, 12), (1e-6, 12), (1e-8, 12), (1e-10, 12), (1e-12, 12), (1e-12, 30))


def racers(everything: bool) -> Iterator[Racer]:
    """The best ways, or all that were tried."""
    for method in ("LSODA", "Radau", "BDF", "DOP853") if everything else ("LSODA",):
        for width in WIDTHS:
            if method != "DOP853" or width > 1e-3:  # explicit: its step is bound to the width
                lap = one_by_one(smoothed(method, width))
                yield Racer("SciPy", f"tanh, {method}", f"width {width:g} v_p", lap)
    for method in ("DOP853", "LSODA", "RK45", "Radau") if everything else ("DOP853", "LSODA"):
        for rtol, part in SETTINGS:
            if part == 12 or method == "DOP853":
                lap = one_by_one(in_modes(method, rtol, part))
                yield Racer("SciPy", f"modes, {method}", f"rtol {rtol:g}, T/{part}", lap)


def smoothed(method: str, width: float) -> Callable[[Floats], Floats]:
    """Positions of one drive, its friction F tanh(u / width)."""

    def solve(drive: Floats) -> Floats:
        m, k, b, plate, finger, level, x = drive.tolist()
        steep, watch = 1.0 / (width * level), Watch()

        def rate(_t: float, y: Floats) -> tuple[float, float]:
            watch.tick()
            x, v = y.tolist()
            friction = plate * tanh(steep * (v - level)) + finger * tanh(steep * v)
            return v, -(friction + b * v + k * x) / m

        def jacobian(_t: float, y: Floats) -> list[list[float]]:
            v = float(y[1])
            of_v = plate * (1.0 - tanh(steep * (v - level)) ** 2)
            of_v += finger * (1.0 - tanh(steep * v) ** 2)
            return [[0.0, 1.0], [-k / m, -(b + steep * of_v) / m]]

        rtol = min(1e-3, 0.01 * width)
        implicit = {} if method == "DOP853" else {"jac": jacobian}
        out = solve_ivp(
            rate,
            (0.0, DURATION),
            (x, level),
            method=method,
            t_eval=TIMES,
            rtol=rtol,
            atol=(rtol * x, rtol * level),
            **implicit,
        )
        if not out.success:
            raise FailureError("did not finish")
        return np.asarray(out.y[0])

    return solve


def slider(method: str, rtol: float, part: int) -> Slider:
    """Slides by `solve_ivp`, ended by its events; steps up to a `part` of a period."""

    def slide_on(slide: Slide) -> Slid:
        pin, watch = slide.pin, Watch()

        def rate(_t: float, y: Floats) -> tuple[float, float]:
            watch.tick()
            x, v = y.tolist()
            return v, slide.acceleration(x, v)

        guards = []
        for level, side in zip(pin.levels, slide.sides, strict=True):

            def guard(_t: float, y: Floats, level: float = level) -> float:
                return float(y[1]) - level

            guard.terminal, guard.direction = True, -side  # type: ignore[attr-defined]
            guards.append(guard)
        out = solve_ivp(
            rate,
            (slide.begin, slide.end),
            (slide.x, slide.v),
            method=method,
            t_eval=slide.requested,
            rtol=rtol,
            atol=(rtol * abs(pin.displacement), rtol * abs(pin.levels[0])),
            max_step=pin.longest_step(part),
            events=guards,
        )
        if not out.success:
            raise FailureError("did not finish")
        positions = out.y[0] if len(out.t) else np.empty(0)
        for i, (times, states) in enumerate(zip(out.t_events, out.y_events, strict=True)):
            if len(times):
                return Slid(float(times[-1]), float(states[-1][0]), i, positions)
        return Slid(slide.end, float(positions[-1]), None, positions)

    return slide_on


def in_modes(method: str, rtol: float, part: int) -> Callable[[Floats], Floats]:
    """Positions of one drive, mode by mode."""
    integrate = slider(method, rtol, part)

    def solve(drive: Floats) -> Floats:
        return follow(Pin.of(drive), integrate, TIMES, DURATION).positions

    return solve

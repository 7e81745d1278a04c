"""Time of one `simulate` beside SciPy's event location on the same drive.

SciPy gets the modes spelled out, so that it never integrates across a jump: each slide is a smooth
problem ended by an event, and stuck phases cost it nothing. Its steps are kept to a thirtieth of a
period: with longer ones a short slide fits into one step, which then finds only the event that the
slide began with, for ever. This is the careful way to use a general solver, not the naive one.
"""

from __future__ import annotations

import argparse
import os
import platform
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from math import copysign, sqrt
from pathlib import Path
from statistics import median
from timeit import Timer

from scipy.integrate import solve_ivp

from pindrive import Drive, Motion, simulate
from pindrive.config import load

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "tactile-mouse.toml"


@dataclass(frozen=True)
class Release:
    """A drive and how it is let go; SI."""

    drive: Drive
    mouse_velocity: float
    displacement: float


def with_scipy(release: Release, method: str, rtol: float) -> tuple[float, float]:
    """When and where the pin comes to rest on the finger, mode by mode."""
    drive = release.drive
    m, k, b = drive.mass, drive.stiffness, drive.damping
    kinetic = (drive.plate.kinetic, drive.finger.kinetic)
    static = (drive.plate.static_friction, drive.finger.static_friction)
    levels = (release.mouse_velocity, 0.0)
    t, x, v = 0.0, release.displacement, levels[0]
    sliding = [0.0, copysign(1.0, v)]  # at plate and finger; 0 is stuck

    while True:
        if 0.0 in sliding:
            stuck = sliding.index(0.0)
            need = k * x + b * v + kinetic[1 - stuck] * sliding[1 - stuck]
            if abs(need) <= static[stuck]:
                if v == 0.0:
                    return t, x
                hold = (copysign(static[stuck], v) - need) / (k * v)
                t, x, need = t + hold, x + hold * v, copysign(static[stuck], v)
            sliding[stuck] = -copysign(1.0, need)
        friction = -sum(f * s for f, s in zip(kinetic, sliding, strict=True))

        def slide(_t: float, y: list[float], friction: float = friction) -> tuple[float, float]:
            return y[1], (friction - b * y[1] - k * y[0]) / m

        guards = []
        for level, side in zip(levels, sliding, strict=True):

            def guard(_t: float, y: list[float], level: float = level) -> float:
                return y[1] - level

            guard.terminal, guard.direction = True, -side  # type: ignore[attr-defined]
            guards.append(guard)
        atol = [rtol * abs(release.displacement), rtol * abs(release.mouse_velocity)]
        out = solve_ivp(
            slide,
            (t, t + 10.0),
            [x, v],
            method=method,
            rtol=rtol,
            atol=atol,
            max_step=0.2 * sqrt(m / k),
            events=guards,
        )
        reached = next(i for i, times in enumerate(out.t_events) if len(times))
        t, x, v = float(out.t[-1]), float(out.y[0, -1]), levels[reached]
        sliding[reached] = 0.0


def per_call(call: Callable[[], object], rounds: int) -> float:
    """Median time of one call, s."""
    timer = Timer(call)
    number, _ = timer.autorange()
    return median(timer.repeat(rounds, max(1, number // 4))) / max(1, number // 4)


def machine() -> str:
    """Processor, cores, system, and what was compiled and imported."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    processor = models[0] if models else platform.processor() or platform.machine()
    packages = ", ".join(f"{name} {version(name)}" for name in ("pindrive", "scipy", "numpy"))
    return (
        f"{processor}, {os.cpu_count()} cores, {platform.system()} {platform.release()}\n"
        f"Python {platform.python_version()}, {packages}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="timings of which the median counts")
    rounds = parser.parse_args().rounds

    device = load(EXAMPLE)
    assert isinstance(device.mouse_velocity, float)
    release = Release(device.drive, device.mouse_velocity, device.displacement)

    def exact() -> Motion:
        return simulate(
            release.drive,
            mouse_velocity=release.mouse_velocity,
            displacement=release.displacement,
        )

    def with_numbers() -> object:
        motion = exact()
        return motion.transient, motion.ending

    motion = exact()
    print(f"{machine()}\n{EXAMPLE.name}: {len(motion.events)} events, {motion.ending.kind}\n")
    ours = per_call(exact, rounds)
    print(f"{'':24}{'median':>12}{'ratio':>9}{'error in x at rest':>22}")
    print(f"{'pindrive.simulate':24}{1e6 * ours:9.1f} µs{1:9.0f}{'':>22}")
    numbers = per_call(with_numbers, rounds)
    print(f"{'... and its numbers':24}{1e6 * numbers:9.1f} µs{numbers / ours:9.1f}")
    for method, rtol in (("RK45", 1e-8), ("DOP853", 1e-8)):

        def general(method: str = method, rtol: float = rtol) -> tuple[float, float]:
            return with_scipy(release, method, rtol)

        theirs = per_call(general, rounds)
        error = abs(general()[1] - motion.ending.position)
        name = f"SciPy {method}, rtol {rtol:g}"
        print(f"{name:24}{1e6 * theirs:9.1f} µs{theirs / ours:9.0f}{error:20.1e} m")


if __name__ == "__main__":
    main()

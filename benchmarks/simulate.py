"""Time of `simulate` beside SciPy's event location on one drive.

SciPy gets the modes spelled out, so that it never integrates across a jump: each slide is a smooth
problem ended by an event, and stuck phases cost it nothing (racing/modes.py). This is the careful
way to use a general solver, not the naive one; `peers` has more of them.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from statistics import median
from timeit import Timer

import numpy as np

from pindrive import Drive, Motion, Release, simulate
from pindrive.files.device import load_device

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.racing.modes import Pin, follow
from benchmarks.racing.with_scipy import slider

EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "tactile-mouse.toml"


def with_scipy(drive: Drive, release: Release, method: str, rtol: float) -> tuple[float, float]:
    """Time and place of the rest on the finger, mode by mode."""
    assert isinstance(release.mouse_velocity, float)
    pin = Pin(
        drive.mass,
        drive.stiffness,
        drive.damping,
        (drive.plate.kinetic, drive.finger.kinetic),
        (drive.plate.static_friction, drive.finger.static_friction),
        (release.mouse_velocity, 0.0),
        release.displacement,
    )
    rest = follow(pin, slider(method, rtol, part=30), np.empty(0), 10.0).rest
    assert rest is not None
    return rest


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
        f"{processor}, {os.cpu_count()} cores, {platform.system()}\n"
        f"Python {platform.python_version()}, {packages}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7, help="timings of which the median counts")
    rounds = parser.parse_args().rounds

    device = load_device(EXAMPLE)
    drive, release = device.drive, device.release

    def exact() -> Motion:
        return simulate(drive, release)

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
            return with_scipy(drive, release, method, rtol)

        theirs = per_call(general, rounds)
        error = abs(general()[1] - motion.ending.position)
        name = f"SciPy {method}, rtol {rtol:g}"
        print(f"{name:24}{1e6 * theirs:9.1f} µs{theirs / ours:9.0f}{error:20.1e} m")


if __name__ == "__main__":
    main()

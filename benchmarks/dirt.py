"""Fits of dirty recordings and of other laws, by an integrator without code of pindrive.

    python3 run.py bench dirt [COUNT [SEED [CLASS...]]]

Each recording is 0.25 s of a pin at 4 kHz, integrated by SciPy's DOP853 with explicit modes. A
class of dirt adds noise to it that is not white; a class of another law is simulated under it, and
fitted with Coulomb friction and linear damping. Printed are the intervals that hold the truth, the
recordings whose fit says that the model is wrong, and the time of a fit.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from math import isfinite, pi, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.signal import lfilter

from pindrive import Contact, Drive, Recording, Release
from pindrive.fitting import fit

Array = NDArray[np.float64]
COUNT, SEED = 200, 7501
SPAN, RATE = 0.25, 4e3
FREE = ("stiffness", "damping", "plate.kinetic", "finger.kinetic", "displacement")
NOISE = 4e-6
"""Standard deviation of the sensor, m."""
TINY = 1e-12
"""Speed with which a pin leaves stick, m/s."""


@dataclass(frozen=True)
class Pin:
    """A pin, SI, and what else may act on it."""

    mass: float
    stiffness: float
    damping: float
    plate: float
    finger: float
    speed: float
    displacement: float
    quadratic: float = 0.0  # N s²/m²
    breakaway: float = 1.0  # of the plate, of its friction at speed
    stribeck: float = 0.02  # m/s
    mount_mass: float = 0.0  # kg; 0: the housing is rigid
    mount_stiffness: float = 1.0
    mount_damping: float = 0.0

    def friction(self, sliding: float) -> float:
        """Friction of the plate at a sliding speed, N."""
        falls = np.exp(-abs(sliding) / self.stribeck) * (self.breakaway - 1.0)
        return float(self.plate * (1.0 + falls))


def _ahead(level: float, side: float) -> Callable[[float, Array], float]:
    """Return the velocity by which a pin is ahead of a contact's on one side of it, m/s."""
    return lambda _t, y: float((y[1] - level) * side)


def position(pin: Pin, times: Array) -> Array:
    """Position in the housing, m; modes of slip and stick, whose ends solve_ivp finds."""

    def pulled(y: Array) -> float:
        """Force on the pin but for friction, N."""
        speed = y[1] - y[3]
        drag = pin.damping * speed + pin.quadratic * speed * abs(speed)
        return float(-pin.stiffness * (y[0] - y[2]) - drag)

    def mount(y: Array) -> float:
        if not pin.mount_mass:
            return 0.0
        held = pin.mount_stiffness * y[2] + pin.mount_damping * y[3]
        return float((-pulled(y) - held) / pin.mount_mass)

    levels = {"plate": pin.speed, "finger": 0.0}
    statics = {"plate": pin.plate * pin.breakaway, "finger": pin.finger}

    def rubbed(name: str, speed: float, side: float) -> float:
        size = pin.friction(speed - pin.speed) if name == "plate" else pin.finger
        return -size * side

    y, t, end = np.array([pin.displacement, pin.speed, 0.0, 0.0]), 0.0, float(times[-1])
    found = np.empty_like(times)
    stuck: str | None = None
    sides = {"plate": -1.0, "finger": 1.0 if pin.speed > 0 else -1.0}
    done = 0
    while True:
        if stuck:
            other = "finger" if stuck == "plate" else "plate"
            side = np.sign(levels[stuck] - levels[other])

            def need(y: Array, other: str = other, side: float = side) -> float:
                return pulled(y) + rubbed(other, y[1], side)

            def rate(_t: float, y: Array) -> tuple[float, ...]:
                return y[1], 0.0, y[3], mount(y)

            def ends(_t: float, y: Array, stuck: str = stuck) -> float:
                return statics[stuck] - abs(need(y))

            events: list[Callable[[float, Array], float]] = [ends]
        else:

            def rate(_t: float, y: Array) -> tuple[float, ...]:
                force = pulled(y) + sum(rubbed(name, y[1], sides[name]) for name in sides)
                return y[1], force / pin.mass, y[3], mount(y)

            events = [_ahead(levels[name], sides[name]) for name in levels]
        for event in events:
            event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        out = solve_ivp(
            rate,
            (t, end),
            y,
            method="DOP853",
            rtol=1e-10,
            atol=1e-13,
            dense_output=True,
            events=events,
        )
        inside = int(np.searchsorted(times, out.t[-1], side="right"))
        if inside > done:
            found[done:inside] = out.sol(times[done:inside])[0]
            done = inside
        t, y = float(out.t[-1]), out.y[:, -1]
        if out.status == 0:
            found[done:] = y[0]
            return found
        if stuck:
            sides[stuck], sides[other] = float(np.sign(need(y))), float(side)
            y[1] += TINY * sides[stuck]
            stuck = None
            continue
        name = next(n for n, at in zip(levels, out.t_events, strict=True) if len(at))
        y[1] = levels[name]
        other = "finger" if name == "plate" else "plate"
        force = pulled(y) + rubbed(other, y[1], sides[other])
        if abs(force) <= statics[name]:
            stuck = name
        else:
            sides[name] = -sides[name]
            y[1] += TINY * sides[name]


def drawn(rng: np.random.Generator, **other: float) -> Pin:
    """A pin of random size."""

    def decades(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    mass, omega, x = decades(2e-3, 2e-2), 2.0 * pi * decades(10.0, 40.0), decades(1e-3, 4e-3)
    stiffness = mass * omega**2
    size = stiffness * x
    return Pin(
        mass,
        stiffness,
        2.0 * decades(0.03, 0.25) * mass * omega,
        size * decades(0.03, 0.15),
        size * decades(0.02, 0.08),
        omega * x * decades(0.1, 0.5),
        x,
        **other,
    )


def _drift(x: Array, t: Array, rng: np.random.Generator) -> Array:
    drift, offset = rng.choice([-20e-6, 20e-6]), rng.choice([-30e-6, 30e-6])
    return x + float(drift) / SPAN * t + float(offset)


def _far_drift(x: Array, t: Array, rng: np.random.Generator) -> Array:
    return x + float(10.0 * NOISE / SPAN * rng.choice([-1, 1])) * t


def _coloured(x: Array, t: Array, rng: np.random.Generator) -> Array:
    rho = 0.8
    white = rng.normal(size=len(t) + 200)
    coloured: Array = lfilter([NOISE * sqrt(1.0 - rho**2)], [1.0, -rho], white)[200:]
    return x + coloured


def _steps(x: Array, t: Array, rng: np.random.Generator) -> Array:
    noisy = x + NOISE * rng.normal(size=len(t))
    return 20e-6 * np.round(noisy / 20e-6)


def _hum(x: Array, t: Array, rng: np.random.Generator) -> Array:
    return x + 10e-6 * np.sin(2.0 * pi * (50.0 * t + rng.random()))


def _outliers(x: Array, t: Array, rng: np.random.Generator) -> Array:
    hit = rng.random(len(t)) < 0.01
    return x + np.where(hit, 50.0 * NOISE * rng.normal(size=len(t)), 0.0)


def _clean(x: Array, t: Array, rng: np.random.Generator) -> Array:
    return x


Dirt = Callable[[Array, Array, np.random.Generator], Array]
DIRT: dict[str, Dirt] = {
    "clean": _clean,
    "drift and offset": _drift,
    "drift of 10 sigma": _far_drift,
    "coloured": _coloured,
    "steps": _steps,
    "hum": _hum,
    "outliers": _outliers,
}
OWN_NOISE = ("coloured", "steps")
"""Dirt that adds the white noise itself, or has none."""


def law(name: str, rng: np.random.Generator) -> Pin:
    """A pin under a law that the fit does not have."""
    if name == "quadratic damping":
        pin = drawn(rng)
        speed = np.sqrt(pin.stiffness / pin.mass) * pin.displacement
        return Pin(**{**vars(pin), "quadratic": pin.damping / speed * rng.uniform(0.5, 2.0)})
    if name == "second mass":
        pin = drawn(rng)
        mass, ratio = pin.mass * rng.uniform(0.5, 3.0), rng.uniform(2.0, 4.0)
        stiffness = mass * pin.stiffness / pin.mass * ratio**2
        damping = 2.0 * 0.05 * np.sqrt(stiffness * mass)
        more = {"mount_mass": mass, "mount_stiffness": stiffness, "mount_damping": damping}
        return Pin(**{**vars(pin), **more})
    pin = drawn(rng)
    more = {"breakaway": rng.uniform(1.5, 2.5), "stribeck": pin.speed * rng.uniform(0.2, 0.6)}
    return Pin(**{**vars(pin), **more})


LAWS = ("quadratic damping", "second mass", "Stribeck")


@dataclass(frozen=True)
class Outcome:
    """Result of the fit of a recording."""

    held: tuple[bool, ...]
    """True of each closed interval that holds the truth."""
    names: tuple[str, ...]
    flagged: bool
    converged: bool
    noise: str
    warnings: tuple[str, ...]
    seconds: float


def recorded(kind: str, seed: int, i: int) -> tuple[Pin, Recording]:
    """The i-th recording of a class."""
    rng = np.random.default_rng([seed, [*DIRT, *LAWS].index(kind), i])
    pin = law(kind, rng) if kind in LAWS else drawn(rng)
    t = np.arange(round(SPAN * RATE)) / RATE
    x = position(pin, t)
    if kind in LAWS:
        x = x + NOISE * rng.normal(size=len(t))
    else:
        x = DIRT[kind](x, t, rng)
        if kind not in OWN_NOISE:
            x = x + NOISE * rng.normal(size=len(t))
    return pin, Recording(t, position=x, name=f"{kind} {i}")


def outcome(kind: str, seed: int, i: int) -> Outcome:
    """Make the i-th recording of a class, and fit it."""
    pin, recording = recorded(kind, seed, i)
    rng = np.random.default_rng([seed, 99, i])
    off = np.exp(rng.uniform(-0.5, 0.5, 5))
    start = Drive(
        mass=pin.mass,
        stiffness=pin.stiffness * off[0],
        damping=pin.damping * off[1],
        plate=Contact(pin.plate * off[2]),
        finger=Contact(pin.finger * off[3]),
    )
    release = Release(pin.speed, pin.displacement * off[4])
    truth = (pin.stiffness, pin.damping, pin.plate, pin.finger, pin.displacement)
    begin = time.perf_counter()
    found = fit(recording, start, release, free=FREE, seed=1)
    seconds = time.perf_counter() - begin
    held, names = [], []
    for value, estimate in zip(truth, found.estimates, strict=True):
        low, high = estimate.interval
        if isfinite(low) and isfinite(high):
            held.append(bool(low <= value <= high))
            names.append(estimate.name)
    return Outcome(
        tuple(held),
        tuple(names),
        found.structured,
        found.converged,
        str(found.residuals[0].model),
        found.warnings,
        seconds,
    )


def main(count: int, seed: int, kinds: list[str]) -> None:
    """Fit all recordings of each class, and print a row for each."""
    print(f"{count} recordings of each class, seed {seed}")
    print(
        f"{'class':20}{'hold the truth':>24}{'flagged':>9}{'lost':>6}{'median s':>10}{'longest':>9}"
    )
    with ProcessPoolExecutor() as pool:
        for kind in kinds:
            done = list(pool.map(partial(outcome, kind, seed), range(count)))
            held = [each for one in done for each in one.held]
            part = f"{sum(held)} of {len(held)} {100 * np.mean(held):5.1f} %"
            flagged = sum(one.flagged for one in done)
            lost = sum(not one.converged for one in done)
            times = [one.seconds for one in done]
            row = (
                f"{kind:20}{part:>24}{flagged:9d}{lost:6d}{np.median(times):10.2f}{max(times):9.2f}"
            )
            print(row, flush=True)
            noises = sorted({one.noise for one in done})
            counts = {noise: sum(one.noise == noise for one in done) for noise in noises}
            print("    " + "; ".join(f"{n} {c}" for n, c in counts.items()), flush=True)


if __name__ == "__main__":
    words = sys.argv[1:]
    count, seed = (*map(int, words[:2]), *(COUNT, SEED)[len(words) :])
    main(count, seed, words[2:] or [*DIRT, *LAWS])

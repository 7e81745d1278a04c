"""Random releases on which the report evaluates the formulas and statements of the paper.

Each set is drawn from one seed and therefore reproducible. A statement *holds* if it is true in all
trials. It *holds when* a condition is met if it is true in all trials with the condition, and false
in others. Otherwise it *does not hold*. A statement of impossibility that no trial contradicts is
*not proved*. Work of the authors is *done here* if it succeeds in all trials. A statement without
trials is *not evaluated*.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import xr
from pindrive.motion.drive import Contact, Drive
from pindrive.motion.motion import Motion
from pindrive.motion.release import Release
from pindrive.motion.simulate import simulated
from pindrive.paper import formulas
from pindrive.paper.formulas import Array, Releases
from pindrive.paper.wording import TEXTS, worded

Truth = NDArray[np.bool_]

SEED = 298
"""The paper's number in its journal."""
COUNT = 2000

RANGES = (
    "m 2–20 g, k 20–400 N/m, ζ 0–0.97 (denser where small), F 0–50 mN, v_p 0–300 mm/s; "
    "x_0 from where the pin breaks away, on average 1.5 mm beyond"
)
"""Ranges of `damped`, in words."""

UNDAMPED_RANGES = "F 5–50 mN, v_p 20–300 mm/s, x_0 0–3 mm"
"""Further ranges of `undamped`."""


def damped(count: int = COUNT, seed: int = SEED) -> Releases:
    """Releases to which the paper's analysis applies, `RANGES` wide, with x_0 > 0."""
    draw = np.random.default_rng(seed)
    m, k = draw.uniform(2e-3, 20e-3, count), draw.uniform(20.0, 400.0, count)
    ratio = 0.97 * draw.uniform(0.0, 1.0, count) ** 2
    friction, v = draw.uniform(0.0, 0.05, count), draw.uniform(0.0, 0.3, count)
    b = 2 * ratio * np.sqrt(m * k)
    held = np.maximum(friction - b * v, 0.0) / k
    return Releases(
        mass=m,
        stiffness=k,
        damping=b,
        friction=friction,
        mouse_velocity=v,
        displacement=held + draw.exponential(1.5e-3, count) + 1e-6,
    )


def undamped(count: int = COUNT, seed: int = SEED) -> Releases:
    """Releases without damping, `UNDAMPED_RANGES` wide, m and k as in `damped`."""
    draw = np.random.default_rng(seed)
    return Releases(
        mass=draw.uniform(2e-3, 20e-3, count),
        stiffness=draw.uniform(20.0, 400.0, count),
        damping=0.0,
        friction=draw.uniform(0.005, 0.05, count),
        mouse_velocity=draw.uniform(0.02, 0.3, count),
        displacement=draw.uniform(0.0, 3e-3, count),
    )


def limit_cases(count: int = COUNT, seed: int = SEED) -> Releases:
    """The releases of `damped` that lie beyond x_d, each with the damping of its limit case."""
    r = damped(count, seed)
    r = r.take((r.displacement > formulas.friction_offset(r)) & (r.mouse_velocity > 0.0))
    ratio = formulas.limit_damping_ratio(r)
    return r.replace(damping=2 * ratio * np.sqrt(r.mass * r.stiffness))


def motion_of(
    r: Releases,
    index: tuple[int, ...] | int = (),
    *,
    finger: float = 0.0,
    duration: float | None = None,
) -> Motion:
    """Return the exact motion of a release.

    Args:
        r: The releases.
        index: Index of the releases in their arrays.
        finger: Friction force of the finger, N, kinetic = static; the analysis has none.
        duration: Duration, as for `pindrive.simulate`.
    """
    drive = Drive(
        mass=float(r.mass[index]),
        stiffness=float(r.stiffness[index]),
        damping=float(r.damping[index]),
        plate=Contact(float(r.friction[index])),
        finger=Contact(finger),
    )
    release = Release(float(r.mouse_velocity[index]), float(r.displacement[index]))
    return simulated(drive, release, duration=duration)


SAMPLED: Final = 400
"""Number of releases that are sampled over time."""
SAMPLES: Final = 9


@dataclass(frozen=True)
class Facts:
    """Facts of the exact simulator on the stated releases."""

    r: Releases

    @cached_property
    def batch(self) -> xr.Dataset:
        """The numbers of every release, the finger frictionless."""
        return self.r.batch(duration=1.01 * formulas.limit_reversal_time(self.r))

    def number(self, name: str) -> Array:
        """Return a number of the transient."""
        return self.batch[f"transient_{name}"].to_numpy()

    @cached_property
    def until(self) -> Array:
        """Until when the analysis holds, or (26) where v_p is never reached."""
        t_1 = self.number("first_reversal_time")
        return np.where(np.isnan(t_1), formulas.limit_reversal_time(self.r), t_1)

    @cached_property
    def times(self) -> Array:
        """Sample times of the first `SAMPLED` releases, shape (`SAMPLES`, `SAMPLED`)."""
        return np.linspace(0.0, 1.0, SAMPLES)[:, None] * self.until[:SAMPLED]

    @cached_property
    def samples(self) -> tuple[Array, Array, Array]:
        """Exact position, velocity and acceleration there."""
        found = np.empty((3, SAMPLES, SAMPLED))
        for i in range(SAMPLED):
            motion, t = motion_of(self.r, i, duration=1.02 * float(self.until[i])), self.times[:, i]
            for row, of in enumerate((motion.position, motion.velocity, motion.acceleration)):
                found[row, :, i] = of(t, "left")
            found[2, 0, i] = motion.acceleration(0.0)
        return found[0], found[1], found[2]

    @cached_property
    def first(self) -> Releases:
        """The first `SAMPLED` releases."""
        return self.r.take(slice(SAMPLED))

    @cached_property
    def forward(self) -> tuple[Array, Array]:
        """Time and value of the exact extreme of the velocity forwards, where none reverses it.

        Found by releasing the pin anew from the trough; NaN where friction reverses before.
        """
        trough, t_c = self.number("trough_displacement"), self.number("trough_time")
        chosen = np.isnan(self.number("first_reversal_time")) & (trough < 0.0)
        found = self.r.batch(displacement=np.where(chosen, trough, -1.0), velocity=0.0)
        time = t_c + found["transient_return_velocity_time"].to_numpy()
        speed = found["transient_return_velocity"].to_numpy()
        return np.where(chosen, time, np.nan), np.where(chosen, speed, np.nan)

    def friction_law(self, sign: float) -> Array:
        """Worst residual of (1) with its friction times `sign`, part of the largest force.

        Of each of the first `SAMPLED` releases, with finger friction 0 to 10 mN, to the end.
        """
        draw = np.random.default_rng(SEED + 1)
        worst = np.empty(SAMPLED)
        r = self.r
        for i, finger in enumerate(draw.uniform(0.0, 0.01, SAMPLED)):
            motion = motion_of(r, i, finger=float(finger))
            t = draw.uniform(0.0, min(1.0, motion.duration), 20)
            x, v, a = motion.position(t), motion.velocity(t), motion.acceleration(t)
            u = v - r.mouse_velocity[i]
            slides = (np.abs(u) > 1e-9) & (np.abs(v) > 1e-9)
            friction = r.friction[i] * np.sign(u) + finger * np.sign(v)
            left = r.mass[i] * a + r.damping[i] * v + r.stiffness[i] * x
            force = r.stiffness[i] * np.abs(x).max() + r.friction[i] + finger
            residual = np.abs(left - sign * friction)[slides] / force
            worst[i] = residual.max(initial=0.0)
        return worst


TINY = 1e-9
"""A difference below this part is none: formulas and simulator agree to far better."""


@dataclass(frozen=True)
class Claim:
    """A sentence, where it stands, and on what it is true."""

    place: str
    sentence: str
    """Word for word."""
    true: Truth | None
    """Truth of the claim in each trial; None for a sentence that is no claim on the drive."""
    shown_by: str
    """The exhibit that shows it, or the table of equations; empty where none does."""
    finding: str
    """Result with its numbers."""
    condition: str = ""
    """Condition of the claim, in words."""
    meets: Truth | None = None
    """True for trials that meet the condition."""
    done: bool = False
    """True for a sentence on the authors' actions, which the trials repeat."""
    excludes: bool = False
    """True for a claim of impossibility, which trials can only contradict."""

    @property
    def verdict(self) -> str:
        """Verdict: holds, holds when …, does not hold, not proved, done here, or not evaluated."""
        if self.true is None:
            return "not evaluated"
        if self.done:
            return "done here" if self.true.all() else "not done here"
        everywhere = self.true.all()
        where = self.meets is not None and self.meets.any() and self.true[self.meets].all()
        if self.excludes and (everywhere or where):
            return "not proved"
        return (
            "holds" if everywhere else f"holds when {self.condition}" if where else "does not hold"
        )


def claim(
    name: str,
    true: Truth | None,
    *,
    meets: Truth | None = None,
    done: bool = False,
    excludes: bool = False,
    **slots: Any,
) -> Claim:
    """Return a sentence with its finding.

    Args:
        name: Name in `text.toml`.
        true: Truth in each trial; slot {true} of the finding.
        meets: Trials that meet the condition; {met} and {unmet} are the truth in them and beside.
        done: True for a sentence on the authors' actions.
        excludes: True for a claim of impossibility.
        **slots: Further slots of the finding.
    """
    of = TEXTS["claims"][name]
    if true is not None and meets is not None:
        slots = {"met": true[meets], "unmet": true[~meets]} | slots
    finding = worded(of["finding"], true=true, **slots)
    return Claim(
        of["place"],
        of["sentence"],
        true,
        of["shown_by"],
        finding,
        of.get("condition", ""),
        meets,
        done,
        excludes,
    )


def swing(found: xr.Dataset) -> Array:
    """From peak to trough; 0 where the pin comes to rest at its peak."""
    swings: Array = np.nan_to_num(found["transient_swing"].to_numpy())
    return swings


def finger_friction(count: int, most: float = 0.01) -> Array:
    """Random ones up to `most`, N."""
    return np.random.default_rng(SEED + 2).uniform(0.0, most, count)

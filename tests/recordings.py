"""Recordings that are made: a motion of known parameters, sampled with noise."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive import Contact, Drive, Motion, Recording, Release, simulate

Array = NDArray[np.float64]

TRUTH = Drive(
    mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.034), finger=Contact(0.011)
)
START = Drive(
    mass=0.006, stiffness=100.0, damping=0.40, plate=Contact(0.020), finger=Contact(0.005)
)
RELEASE = Release(mouse_velocity=0.12, displacement=2.2e-3)
FREE = ["stiffness", "damping", "plate.kinetic", "finger.kinetic", "displacement"]


def recorded(
    drive: Drive = TRUTH,
    release: Release = RELEASE,
    *channels: str,
    noise: float = 0.01,
    seed: int = 1,
    span: float = 0.15,
    rate: float = 10e3,
    delay: float = 0.0,
    **more: Any,
) -> Recording:
    """Samples of a release, each channel with noise that is this part of its largest value."""
    t = np.arange(round(span * rate)) / rate
    motion = simulate(drive, release, duration=span + 1.0 / rate)
    rng = np.random.default_rng(seed)
    found = {}
    for channel in channels or ("position",):
        values = sampled(motion, channel, t - delay, 1.0 / rate)
        found[channel] = values + noise * np.abs(values).max() * rng.normal(size=len(t))
    return Recording(t, **found, **more)


def sampled(motion: Motion, channel: str, t: Array, interval: float) -> Array:
    """A channel at times; before 0 the pin is carried. Of a rate the mean over the interval."""
    late = np.maximum(t, 0.0)
    v0 = motion.release.initial_velocity
    if channel == "position":
        return motion.position(late) + v0 * np.minimum(t, 0.0)
    if channel == "velocity":
        return np.asarray(motion.velocity(late))
    fine = t[:, None] + interval * ((np.arange(20) + 0.5) / 20.0 - 0.5)
    late = np.maximum(fine, 0.0)
    if channel == "acceleration":
        return np.asarray(np.where(fine < 0.0, 0.0, motion.acceleration(late)).mean(axis=1))
    drive = motion.drive
    carried = drive.stiffness * (motion.position(0.0) + v0 * fine) + drive.damping * v0
    force = motion.force("plate", late) + motion.force("finger", late)
    return np.asarray(np.where(fine < 0.0, carried, force).mean(axis=1))

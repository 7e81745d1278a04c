"""Steady motions: their stability, by exact derivatives over a period, and their fundamental."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

import pindrive
from pindrive import _core
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import INPUTS, Release
from pindrive.motion.simulate import simulate
from pindrive.quantities.refusal import refusal

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_PARTS: Final = 16
"""Number of even parts of a period, each integrated by Gauss's rule."""
_HELD: Final = (0, 3)
"""Contacts in stick, rigid or elastic, as the core numbers them."""


def multipliers(motion: pindrive.Motion) -> tuple[complex, ...]:
    """Return the Floquet multipliers of a steady motion, as `Motion.multipliers`."""
    if motion.ending.kind != "steady":
        raise ValueError(refusal("motion", "steady, to have multipliers", motion.ending.kind))
    period = motion.ending.period
    release = release_at(motion, _free_instant(motion))
    over = simulate(motion.drive, release, duration=1.01 * period)
    change = over.sensitivity(["displacement", "velocity"])
    monodromy = np.array([change.position(period), change.velocity(period)])
    if not np.isfinite(monodromy).all():
        why = "; ".join(change.gaps.values())
        raise ValueError(refusal("motion", "differentiable over its period", why))
    found = sorted(np.linalg.eigvals(monodromy).tolist(), key=abs, reverse=True)
    if motion.ending.cycle != "driven":  # a shift in time, which constant inputs do not see
        found.remove(min(found, key=lambda each: abs(each - 1.0)))
    return tuple(map(complex, found))


def release_at(motion: pindrive.Motion, time: float) -> Release:
    """Return the release that goes on as a motion from a time (s) without a contact in stick."""
    inputs: dict[str, Any] = {name: _from(getattr(motion.release, name), time) for name in INPUTS}
    x, v = motion.position(time), motion.velocity(time)
    return motion.release.replace(displacement=x, velocity=v, skin_stretch=None, **inputs)


def _from(given: float | Profile | Function, time: float) -> float | Profile | Function:
    """Return an input with its time counted from a time on."""
    if isinstance(given, float):
        return given
    if isinstance(given, Profile):
        later = [(t - time, y) for t, y in given.rows if t > time]
        times, values = zip((0.0, given(time)), *later, strict=True)
        return Profile(times, values) if later else given(time)
    return Function([piece.from_time(piece.begin - time) for piece in given.pieces], given.unit)


def _free_instant(motion: pindrive.Motion) -> float:
    """Return a time in the cycle at which both contacts slide: the middle of the longest slip."""
    core = _core.simulate(*motion.core_numbers)
    table = core.segments()
    begins, ends = table["begin"], table["end"]
    begin = max(core.cycle_begin, motion.ending.steady_since)
    until = begin + motion.ending.period
    first, last = np.maximum(begins, begin), np.minimum(ends, until)
    held = np.isin(table["plate"], _HELD) | np.isin(table["finger"], _HELD) | (table["stop"] != 0)
    lasts = np.where(held, 0.0, last - first)
    longest = int(np.argmax(lasts))
    if not lasts[longest] > 0.0:
        required = "one in which at some instant both contacts slide"
        raise ValueError(refusal("motion", required, "one that a contact always holds"))
    return float(0.5 * (first[longest] + last[longest]))


def fundamental(motion: pindrive.Motion) -> complex:
    """Return the fundamental of a steady motion, as `Motion.fundamental`."""
    if motion.ending.kind != "steady":
        raise ValueError(refusal("motion", "steady, to have a fundamental", motion.ending.kind))
    core, period = motion.core, motion.ending.period
    begin = max(core.cycle_begin, motion.ending.steady_since)
    table = core.segments()
    edges = np.unique(np.concatenate([table["begin"], table["end"]]))
    inside = edges[(edges > begin) & (edges < begin + period)]
    evenly = begin + period * np.linspace(0.0, 1.0, _PARTS + 1)
    ends = np.unique(np.concatenate([inside, evenly]))
    half, middle = 0.5 * np.diff(ends), 0.5 * (ends[1:] + ends[:-1])
    times = (middle[:, None] + half[:, None] * _NODES).ravel()
    weights = (half[:, None] * _WEIGHTS).ravel()
    turns = np.exp(-2j * np.pi * times / period)
    return complex(2j * np.sum(weights * motion.position(times) * turns) / period)

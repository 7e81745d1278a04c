"""The table of the paper's equations: as printed, as they should be, and how far each is off.

Each is held against exact motions of the stated releases, until the pin first reaches the plate's
velocity. The row states the reference of a deviation.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from pindrive.paper import as_printed, formulas
from pindrive.paper.baseline import FACTORS
from pindrive.paper.exhibit import at_most
from pindrive.paper.formulas import Array, Releases
from pindrive.paper.population import Facts
from pindrive.paper.wording import TEXTS, share, worded

GOOD: Final = 0.01
"""A printed form is good where it is off by no more."""


class Row(NamedTuple):
    """An equation of the paper."""

    number: str
    printed: str
    """TeX."""
    right: str
    """TeX; empty where it is right as printed."""
    against: str
    """Compared quantity and its unit."""
    off_printed: float
    """Largest deviation of the printed form; NaN where its units do not agree."""
    off_right: float
    """Error of the corrected form; equals the printed one if that is right."""
    off_lightly_damped: float
    """That of the printed form where ζ is at most the paper's largest damping factor."""
    good: str
    """Releases for which the printed form deviates by at most `GOOD`; empty if it is right."""


def _worst(deviation: Array) -> float:
    return float(np.nanmax(np.abs(deviation)))


def damping_ratio(r: Releases) -> Array:
    """ζ = b / 2 √(m k)."""
    ratio: Array = r.damping / (2 * np.sqrt(r.mass * r.stiffness))
    return ratio


def where_good(deviation: Array, r: Releases) -> str:
    """Return the releases with a deviation (NaN: not compared) of at most `GOOD`, in words."""
    compared = np.isfinite(deviation)
    good = np.abs(deviation[compared]) <= GOOD
    ratio = damping_ratio(r)[compared]
    beyond = (r.displacement > formulas.friction_offset(r))[compared]
    if good.all():
        return f"everywhere ({share(good)})"
    if good[beyond].all() and not good[~beyond].any():
        return f"x_0 > x_d ({share(good)})"
    least = ratio[~good].min()
    step = 10 ** (np.floor(np.log10(least)) - 1)  # two digits, downwards
    limit = f"{np.floor(least / step) * step:.2g}"
    below = ratio < float(limit)
    if below.sum() < GOOD * below.size:
        return f"nowhere ({share(good)} by chance)" if good.any() else "nowhere"
    return f"ζ < {limit} ({share(below)}; good in all: {good.sum()})"


def rows(facts: Facts) -> list[Row]:
    """Equations (1) to (26), in order."""
    r, f = facts.r, facts.first
    w0, w, size = formulas.natural_frequency(r), formulas.damped_frequency(r), formulas.amplitude(r)
    lag, xd = formulas.velocity_phase(r), formulas.friction_offset(r)
    x, v, a = facts.samples
    t = facts.times
    w0f, sizef, xdf = (
        formulas.natural_frequency(f),
        formulas.amplitude(f),
        formulas.friction_offset(f),
    )
    t_a, t_b, t_c = (facts.number(n) for n in ("peak_time", "return_velocity_time", "trough_time"))
    x_a, x_c = facts.number("peak_displacement"), facts.number("trough_displacement")
    exact_lag, exact_phase = np.pi / 2 - w * (t_b - t_a), w * t_a + lag
    before = r.displacement < xd
    half_turn = _worst(np.abs(as_printed.initial_phase(r) - exact_phase)[before] - np.pi)
    forward_time, forward_speed = facts.forward
    c1, c2 = formulas.coefficients(f)
    wf, alpha = formulas.damped_frequency(f), formulas.decay_rate(f)
    wave, cross = np.cos(wf * t), np.sin(wf * t)
    general = np.exp(alpha * t) * (c1 * wave + c2 * cross) + xdf
    slope = np.exp(alpha * t) * (
        c1 * (alpha * wave - wf * cross) + c2 * (alpha * cross + wf * wave)
    )
    oscillator = a + w0f**2 * (f.damping / f.stiffness) * v + w0f**2 * (x - xdf)
    at_peak = np.exp(-formulas.decay_rate(r) * t_a) * (x_a - xd) / np.cos(lag)
    has = np.isfinite(facts.number("first_reversal_time"))
    t_1 = np.where(has, facts.number("first_reversal_time"), np.nan)

    def evaluated(printed: Array, right: Array, of: Releases) -> tuple[float, float, float, str]:
        light = damping_ratio(of) <= max(FACTORS)
        return _worst(printed), _worst(right), _worst(printed[light]), where_good(printed, of)

    def compare(name: str, exact: Array, unit: Array | float) -> tuple[float, float, float, str]:
        right = (getattr(formulas, name)(r) - exact) / unit
        if not hasattr(as_printed, name):
            return same(right)
        return evaluated((getattr(as_printed, name)(r) - exact) / unit, right, r)

    def same(deviation: Array) -> tuple[float, float, float, str]:
        return _worst(deviation), _worst(deviation), _worst(deviation), ""

    acceleration = formulas.acceleration(t, f) - a
    found = {
        "1": evaluated(facts.friction_law(1.0), facts.friction_law(-1.0), f),
        "2": same(oscillator / (w0f**2 * sizef)),
        "3": same(w * (t_c - t_a) / np.pi - 1),
        "4": same((general - x) / sizef),
        "5": same((slope - v) / (w0f * sizef)),
        "6": same((formulas.position(t, f) - x) / sizef),
        "7": same(at_peak / size - 1),
        "8": compare("initial_phase", exact_phase, 1.0),
        "9": same((formulas.velocity(t, f) - v) / (w0f * sizef)),
        "10": (np.nan, _worst(lag - exact_lag), np.nan, ""),
        "11": same(acceleration / (w0f**2 * sizef)),
        "12, 13": compare("peak_time", t_a, 1 / w0),
        "14": compare("peak_displacement", x_a, size),
        "15": compare("trough_time", t_c, 1 / w0),
        "16": compare("trough_displacement", x_c, size),
        "17": compare("swing", x_a - x_c, size),
        "18, 19": compare("return_velocity_time", t_b, 1 / w0),
        "20": compare("return_velocity", facts.number("return_velocity"), w0 * size),
        "21, 22": same((formulas.velocity(t_1, r) - r.mouse_velocity) / (w0 * size)),
        "23": compare("forward_velocity", forward_speed, w0 * size),
        "24": same(formulas.acceleration(forward_time, r) / (w0**2 * size)),
        "25, 26": compare("limit_reversal_time", forward_time, 1 / w0),
    }
    return [
        Row(
            number,
            of["printed"],
            of.get("right", ""),
            worded(of["against"], half_turn=at_most(half_turn)),
            *found[number],
        )
        for number, of in TEXTS["equations"].items()
    ]

"""The table of the paper's equations: as printed, as they should be, and how far each is off.

Each is held against exact motions of the stated releases, until the pin first reaches the plate's
velocity. The row states the reference of a deviation.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from pindrive.paper import as_printed, formulas
from pindrive.paper.baseline import FACTORS
from pindrive.paper.exhibit import at_most, share
from pindrive.paper.formulas import Array, Releases
from pindrive.paper.population import Facts

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
    limit = compare("limit_reversal_time", forward_time, 1 / w0)
    return [
        Row(
            "1",
            r"m\ddot x + b\dot x + kx = F_1\,\mathrm{sign}(\dot x - v_p) + "
            r"F_2\,\mathrm{sign}\,\dot x",
            r"m\ddot x + b\dot x + kx = -F_1\,\mathrm{sign}\,\dot x - "
            r"F_2\,\mathrm{sign}(\dot x - v_p)",
            "its residual, part of the largest force; with the signs alone corrected, (2) does not "
            "follow from F_1 = 0",
            *evaluated(facts.friction_law(1.0), facts.friction_law(-1.0), f),
        ),
        Row(
            "2",
            r"\ddot x + \omega_0^2\tfrac bk\dot x + \omega_0^2x = \omega_0^2x_d,\ x_d = F_2/k",
            "",
            "its residual, part of ω_0² X_m,0; F_2 is the plate's friction, as in the right form "
            "of (1)",
            *same(oscillator / (w0f**2 * sizef)),
        ),
        Row(
            "3",
            r"\omega = \sqrt{\omega_0^2 - \alpha^2}",
            "",
            "ω, with half a period from peak to trough",
            *same(w * (t_c - t_a) / np.pi - 1),
        ),
        Row(
            "4",
            r"x = e^{\alpha t}(C_1\cos\omega t + C_2\sin\omega t) + x_d",
            "",
            "x(t), part of X_m,0",
            *same((general - x) / sizef),
        ),
        Row(
            "5",
            r"\dot x = e^{\alpha t}[C_1(\alpha\cos\omega t - \omega\sin\omega t) + "
            r"C_2(\alpha\sin\omega t + \omega\cos\omega t)]",
            "",
            "ẋ(t), part of ω_0 X_m,0",
            *same((slope - v) / (w0f * sizef)),
        ),
        Row(
            "6",
            r"x = e^{\alpha t}X_{m,0}\cos(\omega t - \varphi_0) + x_d",
            "",
            "x(t), part of X_m,0, with φ_0 corrected",
            *same((formulas.position(t, f) - x) / sizef),
        ),
        Row(
            "7",
            r"X_{m,0} = \sqrt{d^2 + ((v_p - \alpha d)/\omega)^2},\ d = x_0 - x_d",
            "",
            "X_m,0, with the exact peak",
            *same(at_peak / size - 1),
        ),
        Row(
            "8",
            r"\varphi_0 = \mathrm{arctg}\left(\frac{v_p}{\omega d} - \frac{\alpha}{\omega}\right)",
            r"\varphi_0 = \varphi'_0 + \mathrm{atan2}(\omega v_p,\ \omega_0^2d - \alpha v_p)",
            f"φ_0 in rad, with the exact time of the peak; as printed it is off by π to "
            f"${at_most(half_turn)}$ where x_0 < x_d",
            *compare("initial_phase", exact_phase, 1.0),
        ),
        Row(
            "9",
            r"\dot x = -e^{\alpha t}\omega_0X_{m,0}\sin(\omega t - \varphi_0 + \varphi'_0)",
            "",
            "ẋ(t), part of ω_0 X_m,0",
            *same((formulas.velocity(t, f) - v) / (w0f * sizef)),
        ),
        Row(
            "10",
            r"\varphi'_0 = \mathrm{arctg}\frac{b\omega_0}{\sqrt{4k^2 - b^2}}",
            r"\varphi'_0 = \mathrm{arctg}\frac{b}{\sqrt{4mk - b^2}}",
            "φ′_0 in rad, with the exact times of peak and extreme velocity; as printed 4k² and b² "
            "have different units, so that its error has no number",
            np.nan,
            _worst(lag - exact_lag),
            np.nan,
            "",
        ),
        Row(
            "11",
            r"\ddot x = -e^{\alpha t}\omega_0^2X_{m,0}\cos(\omega t - \varphi_0 + 2\varphi'_0)",
            "",
            "ẍ(t), part of ω_0² X_m,0",
            *same(acceleration / (w0f**2 * sizef)),
        ),
        Row(
            "12, 13",
            r"t_a = (\varphi_0 - \varphi'_0)/\omega",
            "",
            "t_a, in 1/ω_0",
            *compare("peak_time", t_a, 1 / w0),
        ),
        Row(
            "14",
            r"x_{m,a} = e^{\alpha t_a}X_{m,0} + x_d",
            r"x_{m,a} = e^{\alpha t_a}X_{m,0}\cos\varphi'_0 + x_d",
            "x_m,a, part of X_m,0",
            *compare("peak_displacement", x_a, size),
        ),
        Row(
            "15",
            r"t_c = (\pi + \varphi_0 - \varphi'_0)/\omega",
            "",
            "t_c, in 1/ω_0",
            *compare("trough_time", t_c, 1 / w0),
        ),
        Row(
            "16",
            r"x_{m,c} = -e^{\alpha t_c}X_{m,0} + x_d",
            r"x_{m,c} = -e^{\alpha t_c}X_{m,0}\cos\varphi'_0 + x_d",
            "x_m,c, part of X_m,0",
            *compare("trough_displacement", x_c, size),
        ),
        Row(
            "17",
            r"x_{m,a} - x_{m,c} = X_{m,0p}e^{\alpha t_a}(1 + e^{\alpha\pi/\omega})",
            r"x_{m,a} - x_{m,c} = X_{m,0}\cos\varphi'_0\,e^{\alpha t_a}(1 + e^{\alpha\pi/\omega})",
            "the swing, part of X_m,0",
            *compare("swing", x_a - x_c, size),
        ),
        Row(
            "18, 19",
            r"t_b = (\pi/2 + \varphi_0 - 2\varphi'_0)/\omega",
            "",
            "t_b, in 1/ω_0",
            *compare("return_velocity_time", t_b, 1 / w0),
        ),
        Row(
            "20",
            r"v_{m,b} = -e^{\alpha t_b}\omega_0X_{m,0}",
            r"v_{m,b} = -e^{\alpha t_b}\omega_0X_{m,0}\cos\varphi'_0",
            "v_m,b, part of ω_0 X_m,0",
            *compare("return_velocity", facts.number("return_velocity"), w0 * size),
        ),
        Row(
            "21, 22",
            r"e^{\alpha t_1}\sin(\omega t_1 - \varphi_0 + \varphi'_0) = -v_p/\omega_0X_{m,0}",
            "",
            "its residual at the exact t_1",
            *same((formulas.velocity(t_1, r) - r.mouse_velocity) / (w0 * size)),
        ),
        Row(
            "23",
            r"\dot x(t_1) = -\omega_0X_{m,0}e^{\alpha t_1}\sin(\omega t_1 - \varphi_0 + "
            r"2\varphi'_0)",
            r"\dot x(t_1) = -\omega_0X_{m,0}e^{\alpha t_1}\sin(\omega t_1 - \varphi_0 + "
            r"\varphi'_0)",
            "the extreme velocity forwards, part of ω_0 X_m,0",
            *compare("forward_velocity", forward_speed, w0 * size),
        ),
        Row(
            "24",
            r"\ddot x(t_1) = -\omega_0^2X_{m,0}e^{\alpha t_1}"
            r"\cos(\omega t_1 - \varphi_0 + 2\varphi'_0) = 0",
            "",
            "ẍ at the exact time of that extreme, part of ω_0² X_m,0",
            *same(formulas.acceleration(forward_time, r) / (w0**2 * size)),
        ),
        Row(
            "25, 26",
            r"t_1 = (0.5\pi + \varphi_0 - 2\varphi'_0)/\omega",
            r"t_1 = (1.5\pi + \varphi_0 - 2\varphi'_0)/\omega",
            "the time of that extreme, in 1/ω_0",
            *limit,
        ),
    ]

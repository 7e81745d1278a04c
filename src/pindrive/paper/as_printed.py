"""The paper's equations as they are printed, where that differs from the corrected ones.

For the comparison alone: each has the name of its corrected twin in `formulas.py`. References of a
printed equation are corrected, so that each equation has only its own error. (10) is not here: its
units do not agree, so that it has no value.
"""

from __future__ import annotations

import numpy as np

from pindrive.paper import formulas
from pindrive.paper.formulas import Array, Releases


def initial_phase(r: Releases) -> Array:
    """(8): arctg(v_p / (ω d) - α / ω)."""
    d, _ = formulas.coefficients(r)
    w = formulas.damped_frequency(r)
    with np.errstate(divide="ignore"):
        return np.arctan(r.mouse_velocity / (w * d) - formulas.decay_rate(r) / w)


def peak_displacement(r: Releases) -> Array:
    """(14)."""
    return _extreme(r, formulas.peak_time(r)) + formulas.friction_offset(r)


def trough_displacement(r: Releases) -> Array:
    """(16)."""
    return _trough(r) + formulas.friction_offset(r)


def swing(r: Releases) -> Array:
    """(17)."""
    return _extreme(r, formulas.peak_time(r)) - _trough(r)


def return_velocity(r: Releases) -> Array:
    """(20)."""
    return -formulas.natural_frequency(r) * _extreme(r, formulas.return_velocity_time(r))


def forward_velocity(r: Releases) -> Array:
    """(23), which is meant to be v_p in the limit case."""
    t = formulas.limit_reversal_time(r)
    lag = formulas.velocity_phase(r)
    wave = np.sin(formulas.damped_frequency(r) * t - formulas.initial_phase(r) + 2 * lag)
    return -formulas.natural_frequency(r) * _extreme(r, t) * wave


def limit_reversal_time(r: Releases) -> Array:
    """(25) and (26)."""
    quarter = np.pi / 2 + formulas.initial_phase(r) - 2 * formulas.velocity_phase(r)
    return quarter / formulas.damped_frequency(r)


def periods_to_steady(r: Releases) -> Array:
    """The text: 0.5 (x_0 / x_d + 1)."""
    return 0.5 * (r.displacement / formulas.friction_offset(r) + 1)


def periods_to_rest(r: Releases, finger_friction: Array) -> Array:
    """The text: v_p / (4 x_d ω_0), where x_d has to be the finger's."""
    offset = finger_friction / r.stiffness
    return r.mouse_velocity / (4 * offset * formulas.natural_frequency(r))


def _extreme(r: Releases, t: Array) -> Array:
    fading: Array = np.exp(formulas.decay_rate(r) * t)
    return fading * formulas.amplitude(r)


def _trough(r: Releases) -> Array:
    return -_extreme(r, formulas.trough_time(r))

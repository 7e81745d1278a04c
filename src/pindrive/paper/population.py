"""The stated sets of random releases on which the report tries the paper's formulas and sentences.

Each is drawn from one seed, so that whoever draws it again gets the same.
"""

from __future__ import annotations

import numpy as np

from pindrive.paper import formulas
from pindrive.paper.release import Release

SEED = 298
"""The paper's number in its journal."""
COUNT = 2000

RANGES = (
    "m 2–20 g, k 20–400 N/m, ζ 0–0.97 (denser where small), F 0–50 mN, v_p 0–300 mm/s; "
    "x_0 from where the plate lets go, on average 1.5 mm beyond"
)
"""What `damped` draws from, in words."""

UNDAMPED_RANGES = "F 5–50 mN, v_p 20–300 mm/s, x_0 0–3 mm"
"""What else `undamped` draws from."""


def damped(count: int = COUNT, seed: int = SEED) -> Release:
    """Releases to which the paper's analysis applies, `RANGES` wide, with x_0 > 0."""
    draw = np.random.default_rng(seed)
    m, k = draw.uniform(2e-3, 20e-3, count), draw.uniform(20.0, 400.0, count)
    ratio = 0.97 * draw.uniform(0.0, 1.0, count) ** 2
    friction, v = draw.uniform(0.0, 0.05, count), draw.uniform(0.0, 0.3, count)
    b = 2 * ratio * np.sqrt(m * k)
    held = np.maximum(friction - b * v, 0.0) / k
    return Release(
        mass=m,
        stiffness=k,
        damping=b,
        friction=friction,
        mouse_velocity=v,
        displacement=held + draw.exponential(1.5e-3, count) + 1e-6,
    )


def undamped(count: int = COUNT, seed: int = SEED) -> Release:
    """Releases without damping, `UNDAMPED_RANGES` wide, m and k as in `damped`."""
    draw = np.random.default_rng(seed)
    return Release(
        mass=draw.uniform(2e-3, 20e-3, count),
        stiffness=draw.uniform(20.0, 400.0, count),
        damping=0.0,
        friction=draw.uniform(0.005, 0.05, count),
        mouse_velocity=draw.uniform(0.02, 0.3, count),
        displacement=draw.uniform(0.0, 3e-3, count),
    )


def limit_cases(count: int = COUNT, seed: int = SEED) -> Release:
    """The releases of `damped` that lie beyond x_d, each with the damping of its limit case."""
    r = damped(count, seed)
    r = r.take((r.displacement > formulas.friction_offset(r)) & (r.mouse_velocity > 0.0))
    ratio = formulas.limit_damping_ratio(r)
    return r.replace(damping=2 * ratio * np.sqrt(r.mass * r.stiffness))

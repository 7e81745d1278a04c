"""All published cases, in the order of the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from . import belt, bodies, decay, end_stop, forced, friction_curve, shaken
from .case import Case

CASES: Final[tuple[Callable[[], Case], ...]] = (
    decay.aster,
    shaken.aster,
    friction_curve.msl,
    forced.den_hartog,
    forced.den_hartog_lag,
    belt.stick_slip,
    end_stop.aster,
    bodies.rubbed,
    bodies.struck,
    bodies.clutches,
)
"""Each computes its case when it is called, once."""

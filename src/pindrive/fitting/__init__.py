"""Fitting: recordings of a pin in, parameters of its drive with their uncertainty out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.lazy import attach

if TYPE_CHECKING:
    from pindrive.fitting.comparison import ModelComparison, compare_models
    from pindrive.fitting.estimation import fit
    from pindrive.fitting.friction_curve import FrictionCurve, fit_friction
    from pindrive.fitting.identifiability import Identifiability
    from pindrive.fitting.recording import Recording, read_recording
    from pindrive.fitting.results import Estimate, Fit

__all__ = [
    "Estimate",
    "Fit",
    "FrictionCurve",
    "Identifiability",
    "ModelComparison",
    "Recording",
    "compare_models",
    "fit",
    "fit_friction",
    "read_recording",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "Estimate": "pindrive.fitting.results",
        "Fit": "pindrive.fitting.results",
        "FrictionCurve": "pindrive.fitting.friction_curve",
        "Identifiability": "pindrive.fitting.identifiability",
        "ModelComparison": "pindrive.fitting.comparison",
        "Recording": "pindrive.fitting.recording",
        "compare_models": "pindrive.fitting.comparison",
        "fit": "pindrive.fitting.estimation",
        "fit_friction": "pindrive.fitting.friction_curve",
        "read_recording": "pindrive.fitting.recording",
    },
)

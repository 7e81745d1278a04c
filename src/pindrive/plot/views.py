"""The figure that each method of a result draws."""

from typing import Final

VIEWS: Final = {
    "Bifurcation.plot": "bifurcation:plot_bifurcation",
    "Design.plot": "design:plot_design",
    "Elasticities.plot": "sensitivity:plot_elasticities",
    "Evaluation.plot": "scan:plot_scan",
    "Fit.plot": "fit:plot_fit",
    "FrictionCurve.plot": "fit:plot_friction_curve",
    "ModelComparison.plot": "fit:plot_comparison",
    "Motion.plot": "motion:plot_motion",
    "NotebookHtml._repr_html_": "notebook:html",
    "PageSpeeds.plot": "resolution:plot_page_speeds",
    "Robustness.plot": "robustness:plot_robustness",
    "Robustness.plot_designs": "robustness:plot_designs",
    "Scan.plot_hand": "hand:plot_hand",
    "Sensitivity.plot": "sensitivity:plot_motion_sensitivity",
    "SobolIndices.plot": "sensitivity:plot_sobol_indices",
    "SpeedLimits.plot": "resolution:plot_speeds",
    "Sweep.plot": "slices:plot_sweep",
    "SystemMotion.plot": "system:plot_system",
}
"""Module and function of each method."""

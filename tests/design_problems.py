"""Design problems that several tests share, and how much is tried for them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pindrive.optimisation import Effort

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
MOUSE = EXAMPLES / "tactile-mouse.toml"
SMALL = Effort(1 << 14, 48, 120, 128, 11, 2000)
"""Sufficient effort for the design problems in the tests."""
PAPER: Mapping[str, Any] = {
    "name": "short transient",
    "axes": {
        "drive.stiffness": {"loguniform": [30.0, 600.0]},
        "drive.damping_ratio": {"uniform": [0.02, 0.6]},
        "finger.kinetic": {"uniform": ["2 mN", "30 mN"]},
    },
    "conditions": {"mouse_velocity": {"uniform": ["50 mm/s", "150 mm/s"]}},
    "specification": {
        "peak_displacement": ">= 2.1 mm",
        "trough_displacement": ">= -1.5 mm",
    },
    "tolerances": {
        "drive.stiffness": "5 %",
        "drive.damping_ratio": "10 %",
        "finger.kinetic": "20 %",
    },
    "goals": {"minimise": "settling_time"},
}
"""The paper's question: the shortest transitional period at a required displacement."""

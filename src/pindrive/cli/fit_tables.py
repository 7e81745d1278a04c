"""Fits as tables and words in a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.text import Text

from pindrive.cli.tables import new_table
from pindrive.fitting.recording import display_of
from pindrive.quantities.quantity import significant

NEAR = 3
"""Rejected noises that are named."""

if TYPE_CHECKING:
    from rich.table import Table

    from pindrive.fitting.results import Fit, ModelComparison


def fit_report(found: Fit) -> RenderableType:
    """Estimates, then correlations that matter, the noise of each channel, and what is doubtful."""
    percent = f"{100.0 * found.confidence:g} %"
    names = ", ".join(recording.name for recording in found.recordings)
    heads = (
        "parameter",
        ">value",
        ">± standard",
        f">{percent} from",
        ">to",
        "unit",
        "identifiable",
    )
    table = new_table(f"Fit to {names}", *heads)
    for row in found.table():
        table.add_row(*row)
    words = [*_choices(found), *_correlations(found), f"AICc {found.aicc:.1f}"]
    words += [f"warning: {line}" for line in found.warnings]
    lines = [Text(line, no_wrap=True, overflow="ignore") for line in words]
    return Group(table, _noise(found), *lines)


def _noise(found: Fit) -> Table:
    several = len(found.recordings) > 1
    heads = ("channel", ">samples", ">size", ">runs p", ">Ljung-Box p", "rest")
    table = new_table("Noise", *(["recording", *heads] if several else heads))
    for left in found.residuals:
        unit, scale = display_of(left.channel)
        size = f"{significant(left.noise * scale, 3)} {unit}"
        row = (
            left.channel,
            str(left.count),
            f"{size} given" if left.known else size,
            f"{left.runs:.2g}",
            f"{left.ljung_box:.2g}",
            "structure" if left.structured else "noise",
        )
        name = found.recordings[left.recording].name
        table.add_row(*([name, *row] if several else row))
    return table


def _choices(found: Fit) -> list[str]:
    """The noise of each channel; where it was chosen, others that come near, and white noise."""
    lines = []
    for left in found.residuals:
        name = found.recordings[left.recording].name
        of = f"Noise of the {left.channel} of {name}"
        if not left.rejected:
            lines.append(f"{of}, given: {left.description}")
            continue
        others = [*left.rejected.items()][:NEAR]
        if "white" in left.rejected and "white" not in dict(others):
            others.append(("white", left.rejected["white"]))
        rest = "; ".join(f"{words} {excess:+.1f}" for words, excess in others)
        lines += [f"{of}, by BIC: {left.description}", f"  rejected: {rest}"]
    return lines


def _correlations(found: Fit) -> list[str]:
    """The pairs whose estimates are strongly correlated."""
    strong = []
    for i, one in enumerate(found.estimates):
        for j in range(i):
            value = float(found.correlation[i, j])
            if np.isfinite(value) and abs(value) > 0.9:
                strong.append(f"{found.estimates[j].name} and {one.name} {value:+.3f}")
    return [f"Correlations above 0.9: {', '.join(strong)}"] if strong else []


def comparison_report(compared: ModelComparison) -> RenderableType:
    """The laws by AICc, and why others are missing."""
    heads = ("law of friction", ">parameters", ">AICc", ">above best", ">weight", "rest")
    table = new_table("Laws of friction", *heads)
    for law, found in sorted(compared.fits.items(), key=lambda item: item[1].aicc):
        structured = any(left.structured for left in found.residuals)
        table.add_row(
            law,
            str(len(found.theta)),
            f"{found.aicc:.1f}",
            f"{compared.excess[law]:.1f}",
            f"{compared.weights[law]:.3f}",
            "structure" if structured else "noise",
        )
    return Group(table, *(Text(f"{law}: {why}") for law, why in compared.refused.items()))

"""What the finger was shown as an xarray Dataset: a row for each line, and for each false line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pindrive.lazy import xr
from pindrive.quantities.results import LINE
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from pindrive.evaluation.results import Judgement


def dataset(judgement: Judgement) -> xr.Dataset:
    """Variables over `line` and `echo`, and a scalar for each count, with units."""
    from pindrive import __version__

    lines, echoes = judgement.lines, judgement.echoes
    data: dict[str, Any] = {
        "pin": ("line", np.array([line.pin for line in lines], np.int64)),
        "fate": ("line", np.array([line.fate for line in lines], "<U6")),
    }
    for end in ("begin", "end"):
        times = np.array([getattr(line, end).time for line in lines], np.float64)
        words = {"long_name": f"when the {end} of the line passed under the spot", "units": "s"}
        data[f"time_{end}"] = ("line", times, words)
    rows = [line.numbers for line in lines]
    for quantity in LINE:
        values = np.array([row[quantity.name] for row in rows], np.float64)
        data[quantity.name.replace(".", "_")] = ("line", values, quantity.attributes)
    data["echo_pin"] = ("echo", np.array([echo.pin for echo in echoes], np.int64))
    for name, unit, meaning in (
        ("time", "s", "when it was highest"),
        ("x", "m", "where the spot was then, across the page"),
        ("y", "m", "where the spot was then, down the page"),
        ("stroke", "m", "how high it was"),
    ):
        values = np.array([getattr(echo, name) for echo in echoes], np.float64)
        data[f"echo_{name}"] = ("echo", values, {"long_name": meaning, "units": unit})
    for name, count in judgement.counts.items():
        data[name.replace(".", "_")] = ((), count, QUANTITIES[name].attributes)
    title = f"Lines of {judgement.scan.scene.title}, as they were shown"
    return xr.Dataset(data, attrs={"title": title, "source": f"pindrive {__version__}"})

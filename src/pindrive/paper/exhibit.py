"""One figure of the report: its data, how it is drawn from them alone, and what is read off it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure

from pindrive.style import SMALL, STYLE

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr
    from matplotlib.axes import Axes

__all__ = ["Exhibit", "page", "summary", "tidy"]

WIDTH: Final = 180 / 25.4
"""Of every figure, inches."""
DPI: Final = 160


@dataclass(frozen=True)
class Exhibit:
    """A figure with everything that belongs to it."""

    name: str
    """Of its files, without ending."""
    title: str
    caption: str
    """What is drawn, and every parameter that was assumed."""
    data: xr.Dataset
    """All that the picture shows, SI or dimensionless, with units."""
    draw: Callable[[xr.Dataset], Figure]
    readings: tuple[str, ...] = ()
    """What is seen in it; every number and trend in these sentences is computed."""
    table: tuple[tuple[str, ...], ...] = ()
    """Headings and rows that belong to it, as Markdown with TeX between dollars."""

    def pictures(self) -> dict[str, bytes]:
        """The picture as "svg" (text as text) and "png" (its data's summary under `Data`)."""
        metadata = {
            "svg": {"Date": None},
            "png": {"Title": self.title, "Data": json.dumps(summary(self.data))},
        }
        found = {}
        with matplotlib.style.context(STYLE, after_reset=True):
            figure = self.draw(self.data)
            for format, about in metadata.items():
                file = BytesIO()
                figure.savefig(file, format=format, metadata=about, dpi=DPI)
                found[format] = file.getvalue()
                figure.set_layout_engine("none")  # laid out once
        return found

    def netcdf(self) -> bytes:
        """The data as NetCDF."""
        from pindrive import __version__

        attributes = {"title": self.title, "comment": self.caption}
        origin = {**attributes, "source": f"pindrive {__version__}"}
        file = BytesIO()
        self.data.assign_attrs(origin).to_netcdf(file, engine="h5netcdf")
        return file.getvalue()


def summary(data: xr.Dataset) -> dict[str, list[float]]:
    """Of each variable: how many values and how many of them are finite, least, mean, greatest."""
    found = {}
    for name, variable in sorted(data.variables.items(), key=lambda item: str(item[0])):
        if variable.dtype.kind in "biuf":
            values = variable.values.astype(np.float64).ravel()
            finite = values[np.isfinite(values)]
            middle = [finite.min(), finite.mean(), finite.max()] if finite.size else []
            numbers = (values.size, finite.size, *middle)
            found[str(name)] = [float(f"{x:.9g}") for x in numbers]  # not their rounding
    return found


def page(height: float, **arguments: Any) -> Figure:
    """An empty figure as wide as a page and `height` mm high."""
    return Figure(figsize=(WIDTH, height / 25.4), layout="constrained", **arguments)


def tidy(axes: Axes, title: str = "") -> None:
    """Small ticks, and a title that stands at the left."""
    axes.tick_params(labelsize=SMALL, width=0.6, length=2.5)
    if title:
        axes.set_title(title, loc="left", fontsize=8.0)

"""One figure of the report: its data, how it is drawn from them alone, and what is read off it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from io import BytesIO
from math import ceil, log10
from typing import Any, Final

import matplotlib.style
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from pindrive.lazy import stats, xr
from pindrive.paper.wording import TEXTS, listed, worded
from pindrive.plot.style import STYLE, new_figure

WIDTH: Final = 180.0
"""Width of every figure, mm."""
DPI: Final = 160


@dataclass(frozen=True)
class Exhibit:
    """A figure with everything that belongs to it."""

    name: str
    """Name of the files, without suffix."""
    title: str
    caption: str
    """Content of the figure, with every assumed parameter."""
    data: xr.Dataset
    """All that the picture shows, SI or dimensionless, with units."""
    draw: Callable[[xr.Dataset], Figure]
    readings: tuple[str, ...] = ()
    """Observations; every number and trend in these sentences is computed."""
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
            for artist in figure.findobj():
                artist.set_gid(None)  # a gid of several artists is no id of SVG
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


def exhibit(
    name: str,
    data: xr.Dataset,
    draw: Callable[[xr.Dataset], Figure],
    *,
    readings: Iterable[str] = (),
    table: tuple[tuple[str, ...], ...] = (),
    **slots: Any,
) -> Exhibit:
    """Return a figure with its texts, whose slots are filled; `readings` follow those."""
    texts = TEXTS["exhibits"][name]
    return Exhibit(
        name,
        texts["title"],
        worded(texts["caption"], **slots),
        data,
        draw,
        (*(worded(each, **slots) for each in texts.get("readings", ())), *readings),
        table,
    )


def summary(data: xr.Dataset) -> dict[str, list[float]]:
    """Return for each variable the counts of values and finite values, minimum, mean, maximum."""
    found = {}
    for name, variable in sorted(data.variables.items(), key=lambda item: str(item[0])):
        if variable.dtype.kind in "biuf":
            values = variable.values.astype(np.float64).ravel()
            finite = values[np.isfinite(values)]
            middle = [finite.min(), finite.mean(), finite.max()] if finite.size else []
            numbers = (values.size, finite.size, *middle)
            found[str(name)] = [float(f"{x:.9g}") for x in numbers]  # not their rounding
    return found


def page(height: float) -> Figure:
    """An empty figure as wide as a page and `height` mm high."""
    return new_figure(WIDTH, height)


def trend(values: ArrayLike) -> str:
    """Return the trend of values along their axis: strict, overall (rank correlation), or none."""
    y = np.asarray(values, dtype=np.float64)
    steps = np.diff(y)
    if (steps >= 0.0).all():
        return "rises throughout"
    if (steps <= 0.0).all():
        return "falls throughout"
    rank = float(stats.spearmanr(np.arange(len(y)), y).statistic)
    if abs(rank) < 0.5:
        return "goes up and down"
    return f"{'rises' if rank > 0 else 'falls'} on the whole (rank correlation {rank:.2f})".replace(
        "-", "−"
    )


def by_case(found: dict[str, str]) -> str:
    """Return the results of all cases, equal ones merged: "rises at 1 and 2, falls at 3"."""
    cases: dict[str, list[str]] = {}
    for case, words in found.items():
        cases.setdefault(words, []).append(case)
    return ", ".join(f"{words} at {listed(names)}" for words, names in cases.items())


def at_most(value: float) -> str:
    """A bound on a rounding error, as TeX: the next power of a thousand.

    Ten times the value for safety: other processors round otherwise.
    """
    return "0" if value == 0.0 else rf"< 10^{{{3 * ceil(log10(10 * value) / 3)}}}"


_INDEX: Final = re.compile(r"(?<![A-Za-z])([A-Za-zα-ωΑ-Ω]′?)_([a-z0-9]+(?:,[a-z0-9])?)")
"""A letter with an index: x_d, φ′_0, X_m,0."""


def markdown(text: str) -> str:
    """Text of the report as GitHub's Markdown.

    TeX stands between dollars, without thin spaces, which it takes for escapes; a letter with an
    index is written as such, but in TeX and code.
    """
    pieces = re.split(r"(\$[^$]+\$|`[^`]+`)", text)
    for i, piece in enumerate(pieces):
        tex = piece.startswith("$")
        pieces[i] = piece.replace(r"\,", " ") if tex else piece
        if i % 2 == 0:
            pieces[i] = _INDEX.sub(r"\1<sub>\2</sub>", piece)
    return "".join(pieces).replace("\n", "<br>")

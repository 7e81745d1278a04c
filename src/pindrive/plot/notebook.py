"""A result as a notebook shows it: its line, a table with units, and a small picture."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any, Final, Protocol

import numpy as np

from pindrive.lazy import matplotlib
from pindrive.plot.style import STYLE
from pindrive.quantities.quantity import DISPLAY, significant

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DPI: Final = 96
"""Of the picture: as large on the screen as on paper."""
_STYLE: Final = (
    "<style>.pindrive td,.pindrive th{padding:1px 8px;text-align:left}"
    ".pindrive td.value{text-align:right;font-variant-numeric:tabular-nums}"
    ".pindrive img{max-width:100%;height:auto;background:white}</style>"
)


class Result(Protocol):
    """What every result has."""

    def plot(self) -> Figure:
        """Its figure."""

    def to_dataset(self) -> xr.Dataset:
        """All of it as data."""


def html(result: Result) -> str:
    """The result as a piece of HTML that needs nothing else.

    A row for each number that exists, the terms of an energy ledger folded away; of what has
    dimensions, these and its smallest and largest value.
    """
    data = result.to_dataset()
    names = [str(name) for name in data.data_vars]
    energies = [name for name in names if name.startswith("energy_")]
    folded = _table(data, energies)
    shown = _table(data, [name for name in names if name not in energies])
    more = f"<details><summary>energy</summary>{folded}</details>" if energies else ""
    title = escape(repr(result).strip("<>"))
    return (
        f'<div class="pindrive">{_STYLE}<p><strong>{title}</strong></p>'
        f"{shown}{more}{_picture(result.plot(), title)}</div>"
    )


def _table(data: xr.Dataset, names: list[str]) -> str:
    rows = "".join(filter(None, (_row(name, data[name]) for name in names)))
    heads = "".join(f"<th>{head}</th>" for head in ("number", "value", "unit", "meaning"))
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"


def _row(name: str, variable: xr.DataArray) -> str:
    """One number, or the extent of many; nothing for a number that does not exist."""
    unit, scale = _display(str(variable.attrs.get("units", "")))
    value = _value(variable, scale)
    if not value:
        return ""
    meaning = escape(str(variable.attrs.get("long_name", "")))
    cells = f'<td>{escape(name)}</td><td class="value">{escape(value)}</td>'
    return f"<tr>{cells}<td>{escape(unit)}</td><td>{meaning}</td></tr>"


def _display(unit: str) -> tuple[str, float]:
    """The unit in which a person reads an SI unit, and how many of it make one."""
    return ("", 1.0) if unit == "1" else DISPLAY.get(unit, (unit, 1.0))


def _value(variable: xr.DataArray, scale: float) -> str:
    values: np.ndarray[Any, Any] = variable.values
    sizes = ", ".join(f"{dim} {size}" for dim, size in variable.sizes.items())
    if "flag_meanings" in variable.attrs and not sizes:
        flags: list[int] = np.asarray(variable.attrs["flag_values"]).tolist()
        meanings: list[str] = str(variable.attrs["flag_meanings"]).split()
        return meanings[flags.index(int(values))]
    if values.dtype.kind == "b" and not sizes:
        return "yes" if values else "no"
    if values.dtype.kind not in "iuf":
        return f"({sizes})" if sizes else str(values)
    if not sizes:
        return _number(float(values), scale, count="units" not in variable.attrs)
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    if not known.size:
        return ""
    ends = " to ".join(significant(float(end) * scale) for end in (known.min(), known.max()))
    return f"{ends} ({sizes})"


def _number(number: float, scale: float, count: bool) -> str:
    """A number to four digits, a count in full; nothing where there is none."""
    if np.isnan(number):
        return ""
    if np.isinf(number):
        return "infinite" if number > 0 else "-infinite"
    return f"{number:.0f}" if count and number.is_integer() else significant(number * scale)


def _picture(figure: Figure, title: str) -> str:
    file = BytesIO()
    with matplotlib.style.context(STYLE, after_reset=True):
        figure.savefig(file, format="png", dpi=_DPI)
    data = b64encode(file.getvalue()).decode("ascii")
    width = round(_DPI * figure.get_size_inches()[0])
    return f'<img alt="{title}" width="{width}" src="data:image/png;base64,{data}">'

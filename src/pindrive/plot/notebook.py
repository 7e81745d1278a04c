"""A result as a notebook shows it: its line, a table with units, and a small picture."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.lazy import matplotlib
from pindrive.plot.style import STYLE
from pindrive.quantities.quantity import DISPLAY, significant

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_DPI: Final = 96
"""Resolution of the picture: equal sizes on screen and on paper."""
_MOST_LABELS: Final = 12
_MOST_COLUMNS: Final = 8
_STYLE: Final = (
    "<style>.pindrive td,.pindrive th{padding:1px 8px;text-align:left}"
    ".pindrive td.value{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}"
    ".pindrive img{max-width:100%;height:auto;background:white}</style>"
)


def html(result: Any) -> str:
    """A result, which has `plot` and `to_dataset`, as a piece of HTML that needs nothing else.

    The picture; a table for each dimension with few labels, such as the parameters of a fit; a row
    for each number that exists. Folded away: the terms of an energy ledger, and other arrays, with
    their dimensions and their smallest and largest value.
    """
    data = result.to_dataset()
    labelled = {dim: names for dim in data.dims if (names := _columns(data, str(dim)))}
    shown = {name for names in labelled.values() for name in names}
    names = [str(name) for name in data.data_vars if name not in shown]
    groups: dict[str, list[str]] = {"numbers": [], "energy": [], "arrays": []}
    for name in names:
        energy = "energy" if name.startswith("energy_") else "numbers"
        groups["arrays" if data[name].ndim else energy].append(name)
    title = escape(repr(result).strip("<>"))
    tables = [_labelled(data, str(dim), names) for dim, names in labelled.items()]
    tables += [_folded(data, group, names) for group, names in groups.items()]
    return (
        f'<div class="pindrive">{_STYLE}<p><strong>{title}</strong></p>'
        f"{_picture(result.plot(), title)}{''.join(tables)}</div>"
    )


def _columns(data: xr.Dataset, dim: str) -> list[str]:
    """Return a table with a row for each label of a dimension; nothing without labels."""
    labels = data.coords.get(dim)
    if labels is None or labels.dtype.kind != "U" or labels.size > _MOST_LABELS:
        return []
    names = [str(name) for name, variable in data.data_vars.items() if variable.dims == (dim,)]
    return names if len(names) <= _MOST_COLUMNS else []


def _labelled(data: xr.Dataset, dim: str, names: list[str]) -> str:
    """The table of a dimension; each row has the unit of its own, where its label has one."""
    units = next(
        (c.values for c in data[dim].coords.values() if str(c.name).endswith("unit")), None
    )
    heads = [dim, *names, *(["unit"] if units is not None else [])]
    rows = []
    for i, label in enumerate(data[dim].values):
        unit, scale = _display("" if units is None else str(units[i]))
        values = [data[name].isel({dim: i}) for name in names]
        cells = [str(label), *(_value(value, scale) for value in values)]
        rows.append([*cells, *([unit] if units is not None else [])])
    top = "".join(f"<th>{escape(head)}</th>" for head in heads)
    body = "".join(f"<tr>{''.join(f'<td>{escape(c)}</td>' for c in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"


def _folded(data: xr.Dataset, title: str, names: list[str]) -> str:
    """A table below a line that opens it; numbers are open at first."""
    rows = "".join(_row(name, data[name]) for name in names)
    if not rows:
        return ""
    state = " open" if title == "numbers" else ""
    return f"<details{state}><summary>{title}</summary>{_table(rows)}</details>"


def _table(rows: str) -> str:
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
    """Return the display unit of an SI unit, and the number of display units in it."""
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
    ends = [significant(float(end) * scale) for end in (known.min(), known.max())]
    return f"{' to '.join(dict.fromkeys(ends))} ({sizes})"


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

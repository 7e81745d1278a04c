"""Datasets of results as files: NetCDF and JSON of all, CSV of the main table."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from io import BytesIO
from math import isfinite, isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pindrive.files.output import JSON, Kind, headed, titled

if TYPE_CHECKING:
    import xarray as xr

DATASET_JSON: Final = replace(JSON, library="xarray")


def writers(
    title: str, columns: Sequence[str]
) -> dict[str, tuple[Kind, Callable[[xr.Dataset, Path], None]]]:
    """Writers of a dataset by the suffix of the file.

    Args:
        title: Content of the files.
        columns: The first of the CSV.
    """
    return {
        ".csv": (replace(headed(f"CSV file of {title}", columns), library="xarray"), write_csv),
        ".nc": (titled(f"NetCDF file of {title}", title), partial(write_netcdf, title=title)),
        ".json": (DATASET_JSON, partial(write_json, title=title)),
    }


def write_netcdf(dataset: xr.Dataset, path: Path, title: str) -> None:
    """Write the dataset; made in memory first, so that a full disk raises an error."""
    file = BytesIO()
    dataset.assign_attrs(_head(title)).to_netcdf(file, engine="h5netcdf")
    path.write_bytes(file.getvalue())


def write_json(dataset: xr.Dataset, path: Path, title: str) -> None:
    """Write the dataset; null for a missing number, "Infinity" for an infinite one."""
    found = dataset.to_dict()
    variables = found["coords"] | found["data_vars"]
    document = {
        "pindrive": _head(title)["source"].partition(" ")[2],
        "title": title,
        "attributes": found["attrs"],
        "variables": {
            name: {
                "dimensions": list(one["dims"]),
                "attributes": one["attrs"],
                "values": one["data"],
            }
            for name, one in variables.items()
        },
    }
    text = json.dumps(finite(document), indent=2, ensure_ascii=False, allow_nan=False, default=str)
    path.write_text(text + "\n", encoding="utf-8")


def write_csv(dataset: xr.Dataset, path: Path) -> None:
    """Write the variables over the dimensions of the first one, a row for each place."""
    first = next(iter(dataset.data_vars.values()))
    table = dataset[[name for name, one in dataset.data_vars.items() if one.dims == first.dims]]
    units = {name: one.attrs.get("units", "1") for name, one in table.variables.items()}
    headings = {name: name if unit == "1" else f"{name} [{unit}]" for name, unit in units.items()}
    rows = table.to_dataframe().reset_index().rename(columns=headings)
    rows.to_csv(path, index=False, lineterminator="\n")


def _head(title: str) -> dict[str, str]:
    from pindrive import __version__

    return {"title": title, "source": f"pindrive {__version__}"}


def finite(value: Any) -> Any:
    """`value` with null for NaN and the text "Infinity" for infinity, which JSON lacks."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    if not isinstance(value, float) or isfinite(value):
        return value
    return None if isnan(value) else "Infinity" if value > 0 else "-Infinity"

"""A motion as columns over time, and with its events and numbers as an xarray Dataset."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive.lazy import xr
from pindrive.motion.motion import Motion
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.results import SERIES
from pindrive.quantities.status import outcome_attributes
from pindrive.quantities.table import QUANTITIES


def columns(motion: Motion, t: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Return the state of the motion at the times t (s, shape (n,)), by the names of `SERIES`.

    Right-hand limits, SI; what the motion does not have left out.
    """
    found = {"time": t, **motion.columns(t)}
    given = motion.release.mouse_velocity
    if not isinstance(given, float) and given.changes:
        found["plate_velocity"] = motion.plate_velocity(t)
    return found


def dataset(motion: Motion, t: NDArray[np.float64]) -> xr.Dataset:
    """The columns at the times t (s, shape (n,)), the events, the numbers and the inputs."""
    from pindrive import __version__

    data: dict[str, Any] = {
        name: ("time", column, SERIES[name].attributes)
        for name, column in columns(motion, t).items()
        if name != "time"
    }
    for name in ("time", "position", "velocity"):
        values = np.array([getattr(event, name) for event in motion.events], dtype=np.float64)
        data[f"event_{name}"] = ("event", values, {"units": SERIES[name].unit})
    for name in ("contact", "kind"):
        data[f"event_{name}"] = ("event", [str(getattr(e, name)) for e in motion.events])
    for name, value in motion.numbers().items():
        data[name.replace(".", "_")] = ((), value, QUANTITIES[name].attributes)
    data["status"] = ((), np.int8(motion.status), outcome_attributes("status"))
    data["ending"] = ((), np.int8(motion.ending.end), outcome_attributes("ending"))
    origin: dict[str, Any] = {
        "title": "Motion of a tactile device's pin after release",
        "source": f"pindrive {__version__}",
        **_attributes(motion),
    }
    return xr.Dataset(data, coords={"time": ("time", t, SERIES["time"].attributes)}, attrs=origin)


def _attributes(motion: Motion) -> dict[str, float | str | list[float]]:
    """The inputs; of rows one attribute for each column, as attributes have one dimension."""
    flat: dict[str, float | str | list[float]] = {}
    for name, value in motion.inputs().items():
        if isinstance(value, (float, str)):
            flat[name] = value
        else:
            names = (column.rpartition(".")[2] for column in COLUMNS[QUANTITIES[name].rows_of])
            across, along = (list(column) for column in zip(*value, strict=True))
            flat |= zip((f"{name}.{column}" for column in names), (across, along), strict=True)
    return flat

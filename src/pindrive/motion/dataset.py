"""A motion as columns over time, and with its events and numbers as an xarray Dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from pindrive.lazy import xr
from pindrive.motion.drive import Profile
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.status import End, Status, flag_attributes
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pindrive.motion.motion import Motion


class Column(NamedTuple):
    """One quantity over time."""

    values: NDArray[np.float64]
    """Right-hand limits, SI."""
    unit: str
    meaning: str


def columns(motion: Motion, t: NDArray[np.float64]) -> dict[str, Column]:
    """What the motion does at the times t (s, shape (n,)); what it does not have left out."""
    found = {
        "position": Column(motion.position(t), "m", "deflection of the pin from the spring's rest"),
        "velocity": Column(motion.velocity(t), "m/s", "velocity of the pin in the housing"),
        "acceleration": Column(
            motion.acceleration(t), "m/s2", "acceleration of the pin in the housing"
        ),
        "plate_force": Column(
            motion.force("plate", t), "N", "friction force of the plate on the pin"
        ),
        "finger_force": Column(
            motion.force("finger", t), "N", "friction force of the finger on the pin"
        ),
    }
    if not motion.drive.finger.rigid:
        found["stretch"] = Column(motion.stretch(t), "m", "stretch of the finger's skin")
        found["stretch_rate"] = Column(motion.stretch_rate(t), "m/s", "stretch rate of the skin")
    given = motion.release.mouse_velocity
    if isinstance(given, Profile) and given.changes:
        found["plate_velocity"] = Column(
            motion.plate_velocity(t), "m/s", "velocity of the plate in the housing"
        )
    return found


def dataset(motion: Motion, t: NDArray[np.float64]) -> xr.Dataset:
    """The columns at the times t (s, shape (n,)), the events, the numbers and the inputs."""
    from pindrive import __version__

    data: dict[str, Any] = {
        name: ("time", column.values, {"units": column.unit, "long_name": column.meaning})
        for name, column in columns(motion, t).items()
    }
    for name, unit in (("time", "s"), ("position", "m"), ("velocity", "m/s")):
        values = np.array([getattr(event, name) for event in motion.events], dtype=np.float64)
        data[f"event_{name}"] = ("event", values, {"units": unit})
    for name in ("contact", "kind"):
        data[f"event_{name}"] = ("event", [str(getattr(e, name)) for e in motion.events])
    for name, value in motion.numbers().items():
        quantity = QUANTITIES[name]
        attributes = {"long_name": quantity.meaning, "symbol": quantity.symbol}
        data[name.replace(".", "_")] = (
            (),
            value,
            {**attributes, "units": quantity.unit} if quantity.unit else attributes,
        )
    data["status"] = ((), np.int8(motion.status), flag_attributes(Status))
    data["ending"] = ((), np.int8(motion.ending.end), flag_attributes(End))
    origin: dict[str, Any] = {
        "title": "Motion of a tactile device's pin after release",
        "source": f"pindrive {__version__}",
        **_attributes(motion),
    }
    time = ("time", t, {"units": "s", "long_name": "time since the release"})
    return xr.Dataset(data, coords={"time": time}, attrs=origin)


def _attributes(motion: Motion) -> dict[str, float | list[float]]:
    """The inputs; of rows one attribute for each column, as attributes have one dimension."""
    flat: dict[str, float | list[float]] = {}
    for name, value in motion.inputs().items():
        if isinstance(value, float):
            flat[name] = value
        else:
            names = (column.rpartition(".")[2] for column in COLUMNS[QUANTITIES[name].rows_of])
            across, along = (list(column) for column in zip(*value, strict=True))
            flat |= zip((f"{name}.{column}" for column in names), (across, along), strict=True)
    return flat

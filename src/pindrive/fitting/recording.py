"""Recordings of a pin: what a bench measured of one release, over time, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.fitting.noise import Noise, noise_of
from pindrive.motion.profile import Profile
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.quantity import brief, counted
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.results import CHANNELS, SERIES
from pindrive.quantities.table import QUANTITIES, check
from pindrive.quantities.value import equal_by_value

__all__ = ["Recording", "read_recording"]

RECORDED_INPUTS: Final = ("mouse_velocity", "plate_load")
"""Inputs of a release that a recording may contain."""
EXAMPLE: Final = f"{SERIES['time'].heading}, {CHANNELS['position'].heading}"
FEWEST: Final = 8
"""Samples in a recording."""
INPUT_TOLERANCE: Final = 1e-3
"""Part of its largest value by which an input with fewer rows may differ from the samples."""


@equal_by_value
@dataclass(frozen=True, eq=False, init=False)
class Recording:
    """Samples of one release, with its known inputs.

    Position and velocity are those of the pin in the housing at the sample times. Acceleration and
    force are means over one sample interval, as a sensor delivers them that filters before it
    samples. Force is the friction force of both contacts together on the pin, positive as x is.

    Args:
        time: s, shape (n,), n >= 8, increasing; 0 is the release unless `time_offset` is free.
        position: m, shape (n,); NaN where a sample is missing, of any channel.
        velocity: m/s, shape (n,).
        acceleration: m/s², shape (n,).
        force: N, shape (n,).
        own: Channels of your own by name, each of shape (n,), whose functions a fit is given.
        mouse_velocity: Mouse velocity of this recording in place of the release's: m/s, a
            `Profile`, or one value for each time, shape (n,).
        plate_load: Factor on the friction of the plate, in the same notations.
        noise: Noise by channel: a `Noise`, its text, or its known standard deviation, SI; a channel
            that is left out has white noise, or what a fit chooses.
        name: Name in messages and figures, such as the file.

    Raises:
        ValueError: There is no channel, lengths differ, times do not increase, a value is
            infinite, a channel has fewer than 8 samples, or is zero throughout.
    """

    time: NDArray[np.float64]
    channels: Mapping[str, NDArray[np.float64]]
    mouse_velocity: float | Profile | None
    plate_load: float | Profile | None
    noise: Mapping[str, Noise]
    name: str
    sources: tuple[Path, ...] = field(default=())
    """The files that it was read from."""

    def __init__(
        self,
        time: ArrayLike,
        *,
        position: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        force: ArrayLike | None = None,
        own: Mapping[str, ArrayLike] | None = None,
        mouse_velocity: ArrayLike | str | Profile | None = None,
        plate_load: ArrayLike | str | Profile | None = None,
        noise: Mapping[str, float | str | Noise] | None = None,
        name: str = "recording",
    ) -> None:
        """Validate, and keep arrays of floats."""
        put = object.__setattr__
        given = {
            "position": position,
            "velocity": velocity,
            "acceleration": acceleration,
            "force": force,
        }
        for channel in own or {}:
            if channel in CHANNELS or not channel.isidentifier() or channel == "time":
                required = f"named by a word other than time, {', '.join(CHANNELS)}"
                raise ValueError(refusal("a channel of your own", required, repr(channel), name))
        given |= own or {}
        times = _column(time, "time", name)
        _check_times(times, name)
        channels = {
            channel: _column(values, channel, name, len(times), missing=True)
            for channel, values in given.items()
            if values is not None
        }
        if not channels:
            raise ValueError(refusal("a recording", f"of {' or '.join(CHANNELS)}", "none", name))
        for channel, values in channels.items():
            count = int(np.count_nonzero(np.isfinite(values)))
            if count < FEWEST:
                required = f"of at least {FEWEST} samples that are not missing"
                raise ValueError(refusal(channel, required, count, name))
            if not np.nan_to_num(values).any():
                needed = "other than zero somewhere; check the sensor and the heading"
                raise ValueError(refusal(channel, needed, "0 throughout", name))
        put(self, "time", times)
        put(self, "channels", channels)
        put(self, "mouse_velocity", _input(mouse_velocity, "mouse_velocity", times, name))
        put(self, "plate_load", _input(plate_load, "plate_load", times, name))
        put(self, "noise", _noise(noise or {}, channels, name))
        put(self, "name", name)
        put(self, "sources", ())

    def __repr__(self) -> str:
        """Its channels, samples and rate, in a line."""
        count = counted(len(self.time), "sample")
        rate = f"{brief(round(1.0 / self.interval, 6))} Hz"
        return f"<Recording {self.name}: {', '.join(self.channels)}, {count} at {rate}>"

    @property
    def interval(self) -> float:
        """The median time between two samples, s."""
        return float(np.median(np.diff(self.time)))

    def window(self, begin: float | str, end: float | str) -> Recording:
        """The samples from `begin` to `end` (s, both included); times stay as they are.

        Raises:
            ValueError: Fewer than 8 samples lie in it.
        """
        first, last = (check("profile.time", t, label="window") for t in (begin, end))
        inside = (self.time >= first) & (self.time <= last)
        if np.count_nonzero(inside) < FEWEST:
            span = f"{self.time[0]:g} s to {self.time[-1]:g} s"
            required = f"so wide that {FEWEST} samples of {span} lie in it"
            found = f"{first:g} s to {last:g} s with {np.count_nonzero(inside)}"
            raise ValueError(refusal("window", required, found, self.name))
        channels = {name: values[inside] for name, values in self.channels.items()}
        return self.with_changes(time=self.time[inside], channels=channels)

    def with_changes(self, **changes: Any) -> Recording:
        """Return the recording with some attributes replaced, unchecked."""
        made = object.__new__(Recording)
        for name in self.__dataclass_fields__:
            object.__setattr__(made, name, changes.get(name, getattr(self, name)))
        return made


def read_recording(
    path: str | PathLike[str],
    *,
    mouse_velocity: float | str | Profile | None = None,
    noise: Mapping[str, float | str | Noise] | None = None,
) -> Recording:
    """A recording from a CSV file whose header names columns with their units.

    Columns are `time`, at least one of `position`, `velocity`, `acceleration`, `force`, and where
    the inputs changed `mouse_velocity` and `plate_load`, apart by comma, semicolon or tab: "time
    [s], position [mm]". An empty entry, or "nan", is a sample that is missing. Lines that begin
    with # are skipped; other columns are ignored, so that what `Motion.to_csv` writes can be read.

    Args:
        path: The file, UTF-8.
        mouse_velocity: Mouse velocity of a recording without such a column, m/s.
        noise: Noise by channel, as for `Recording`.

    Returns:
        The recording, named as its file.

    Raises:
        ValueError: The file cannot be read, lacks a column or a unit, holds what is no number, or
            as for `Recording`; one line that names file, row and value.
    """
    file = str(path)
    table = CsvTable.read(path, "a recording", EXAMPLE)
    required = f"with time and at least one of {', '.join(CHANNELS)}, like {quoted(EXAMPLE)}"
    table.check_header("time" in table and any(name in table for name in CHANNELS), required)
    table.check_rows("a recording", FEWEST)
    time = np.array(table.column("time", SERIES["time"]))
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        row = table.numbers[int(back[0]) + 1]
        required = f"greater than the one before, {time[back[0]]:g} s; sort the rows, or split it"
        raise ValueError(refusal(f"row {row}: time", required, f"{time[back[0] + 1]:g} s", file))

    channels: dict[str, Any] = {
        name: np.array(table.column(name, quantity, missing=True))
        for name, quantity in CHANNELS.items()
        if name in table
    }
    inputs: dict[str, Any] = {
        name: np.array(table.column(name, QUANTITIES[name]))
        for name in RECORDED_INPUTS
        if name in table
    }
    if mouse_velocity is not None:
        if "mouse_velocity" in inputs:
            required = "left out where a column gives it"
            raise ValueError(refusal("mouse_velocity", required, repr(mouse_velocity), file))
        inputs["mouse_velocity"] = mouse_velocity
    made = Recording(time, **channels, **inputs, noise=noise, name=file)
    return made.with_changes(name=Path(file).name, sources=(Path(path),))


def unit_of(channel: str) -> str:
    """The SI unit of a channel; "1" of one of your own."""
    return CHANNELS[channel].unit if channel in CHANNELS else "1"


def display_of(channel: str) -> tuple[str, float]:
    """Display unit of a channel, and its number in an SI unit."""
    if channel not in CHANNELS:
        return "", 1.0
    return CHANNELS[channel].display_unit, CHANNELS[channel].display_scale


# ---- what is checked -----------------------------------------------------------------------------


def _column(
    values: ArrayLike, label: str, where: str, count: int | None = None, *, missing: bool = False
) -> NDArray[np.float64]:
    try:
        column = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(refusal(label, "numbers, SI", repr(values)[:60], where)) from None
    if column.ndim != 1 or (count is not None and len(column) != count):
        shape = "of one dimension" if count is None else f"one value for each time, ({count},)"
        raise ValueError(refusal(label, shape, f"shape {column.shape}", where))
    refused = np.isinf(column) if missing else ~np.isfinite(column)
    if refused.any():
        at = int(np.flatnonzero(refused)[0])
        raise ValueError(refusal(f"{label}[{at}]", "finite", f"{column[at]}", where))
    return column


def _check_times(times: NDArray[np.float64], where: str) -> None:
    if len(times) < FEWEST:
        raise ValueError(refusal("a recording", f"of at least {FEWEST} samples", len(times), where))
    back = np.flatnonzero(np.diff(times) <= 0.0)
    if back.size:
        i = int(back[0]) + 1
        required = f"greater than the one before, {times[i - 1]:g} s"
        raise ValueError(refusal(f"time[{i}]", required, f"{times[i]:g} s", where))


def _noise(
    given: Mapping[str, float | str | Noise], channels: Mapping[str, object], where: str
) -> dict[str, Noise]:
    for channel in given:
        if channel not in channels:
            raise ValueError(refusal("noise", f"of {' or '.join(channels)}", channel, where))
    return {
        channel: noise_of(noise, unit_of(channel), f"{where}: noise of {channel}")
        for channel, noise in given.items()
    }


# ---- inputs --------------------------------------------------------------------------------------


def _input(
    given: ArrayLike | str | Profile | None, name: str, times: NDArray[np.float64], where: str
) -> float | Profile | None:
    """A constant or a profile; samples become the fewest rows that follow them."""
    if given is None or isinstance(given, Profile):
        return given
    if isinstance(given, str) or np.ndim(given) == 0:
        return check(name, given, where=where)  # type: ignore[arg-type]
    values = _column(given, name, where, len(times))
    for i in (int(values.argmin()), int(values.argmax())):
        check(name, float(values[i]), where=where, label=f"{name}[{i}]")
    if np.ptp(values) == 0.0:
        return float(values[0])
    kept = _corners(times, values, INPUT_TOLERANCE * float(np.abs(values).max()))
    return Profile(times[kept], values[kept])


def _corners(
    times: NDArray[np.float64], values: NDArray[np.float64], tolerance: float
) -> NDArray[np.intp]:
    """Samples through which lines stay within `tolerance` of all (Douglas and Peucker, 1973)."""
    kept, open_ = [0, len(times) - 1], [(0, len(times) - 1)]
    while open_:
        a, b = open_.pop()
        t, y = times[a : b + 1], values[a : b + 1]
        off = np.abs(y - (y[0] + (y[-1] - y[0]) * (t - t[0]) / (t[-1] - t[0])))
        worst = int(off.argmax())
        if off[worst] > tolerance:
            kept.append(a + worst)
            open_ += [(a, a + worst), (a + worst, b)]
    return np.array(sorted(kept), np.intp)

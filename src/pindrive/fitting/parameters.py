"""Parameters of a fit: their names, the values that they begin with, and where they are sought."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isinf, isnan, sqrt
from typing import Any, Final

import numpy as np

from pindrive.fitting.noise import DRIFT_KEYS, HUM_KEYS, Noise
from pindrive.fitting.recording import Recording, unit_of
from pindrive.motion.core_numbers import PLACES, ROWS, CoreNumbers, entry
from pindrive.motion.drive import Drive
from pindrive.motion.friction import FALLING
from pindrive.motion.function import Function
from pindrive.motion.release import Release, core_numbers
from pindrive.quantities.drive import COLUMNS, FRICTION_LAWS
from pindrive.quantities.names import Names
from pindrive.quantities.quantity import DISPLAY, Bounds, Quantity, counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.results import CHANNELS
from pindrive.quantities.table import FUNCTION_PARAMETERS, QUANTITIES, check

DRIVE: Final = (
    *("mass", "stiffness", "damping", "damping_ratio", "plate.kinetic", "plate.static"),
    *("finger.kinetic", "finger.static", "finger.stiffness", "finger.damping", "load_exponent"),
    *(
        f"{contact}.{name}"
        for contact in ("plate", "finger")
        for name in ("breakaway", "stribeck_velocity", "viscous")
    ),
)
"""Parameters of the drive, which all recordings share."""
START: Final = ("displacement", "velocity", "skin_stretch", "mouse_velocity", "plate_load")
"""Parameters of each release."""
OF_FUNCTIONS: Final = tuple(
    q.name for q in FUNCTION_PARAMETERS if q.name.partition(".")[0] in START
)
"""Parameters of the functions of time in a release."""
SENSOR: Final = (
    "time_offset",
    *(f"{channel}_{key}" for channel in CHANNELS for key in DRIFT_KEYS),
)
"""Parameters of each recording: its time of the release, and what its sensors add."""
_NAMES: Final = Names(
    "parameter",
    {
        name: (QUANTITIES[name].key, QUANTITIES[name].variable)
        for name in (*DRIVE, *START, *OF_FUNCTIONS)
    }
    | dict.fromkeys(SENSOR, ()),
    listed="docs/fitting.md",
)
ROW: Final = re.compile(
    r"(plate_curve|finger_curve|mouse_velocity|plate_load)\[(\d+)\]\.(speed|force|time|value)"
)
_TABLES: Final = {
    "plate_curve": "plate.curve",
    "finger_curve": "finger.curve",
    "mouse_velocity": "mouse_velocity",
    "plate_load": "plate_load",
}
"""The quantity of each table of rows."""
FALLING_NUMBERS: Final = tuple(float(FRICTION_LAWS.index(law)) for law in FALLING)
"""Numbers of the laws by which friction falls."""
DECADE: Final = 10.0
"""A positive parameter is searched from its tenth to its tenfold unless bounds are given."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number that is fitted."""

    name: str
    """Reported name: "stiffness"; with several recordings "displacement@1" for the second."""
    key: str
    """Without the recording."""
    recording: int | None
    """The one that it belongs to; None for all."""
    unit: str
    """SI."""
    start: float
    """Value of the drive or the release."""
    lower: float
    upper: float
    """From where to where it is searched."""
    of_noise: bool = False
    """True if the noise of a channel brings it along; it is not named in `free`."""

    @property
    def logarithmic(self) -> bool:
        """True if candidates are spread logarithmically."""
        return self.lower > 0.0 and self.upper > 3.0 * self.lower

    @property
    def quantity(self) -> Quantity | None:
        """Its row of the table of quantities; None for what a sensor adds."""
        return _quantity(self.key)

    @property
    def scale(self) -> tuple[str, float]:
        """Display unit, and the number of display units in one SI unit."""
        return ("", 1.0) if self.unit == "1" else DISPLAY.get(self.unit, (self.unit, 1.0))


def parameters(
    free: Sequence[str],
    bounds: Mapping[str, tuple[float | str, float | str]],
    drive: Drive,
    releases: Sequence[Release],
    recordings: Sequence[Recording],
) -> tuple[Parameter, ...]:
    """Return the parameters named in `free`, sensor parameters once per recording.

    Raises:
        ValueError: A name is unknown or given twice, or the drive or the release does not have it;
            bounds of what is not free, or out of range.
    """
    if isinstance(free, str) or not free:
        raise ValueError(refusal("free", "a list of parameters, like ['stiffness']", repr(free)))
    scopes = [_scope(name) for name in free]
    keys = [_key(name) for name, _ in scopes]
    for i, key in enumerate(keys):
        if key in keys[:i]:
            raise ValueError(refusal("free", "names that differ", f"{key} twice"))
    if {"damping", "damping_ratio"} <= {*keys}:
        raise ValueError(refusal("free", "damping or damping_ratio", "both"))
    given = {_key(name): ends for name, ends in bounds.items()}
    for key in given:
        if key not in keys:
            raise ValueError(refusal("bounds", f"for a free parameter ({', '.join(keys)})", key))
    found = []
    for key, (_, scope) in zip(keys, scopes, strict=True):
        own = key in SENSOR or key in START or key.startswith(("mouse_velocity", "plate_load"))
        if key in SENSOR and scope == "all":
            required = "one of each recording: each has its own sensor"
            raise ValueError(refusal("free", required, f"{key}@all"))
        own = scope == "each" or (own and scope != "all")
        for r in range(len(releases)) if own else (None,):
            found += _parameter(key, r, given.get(key), drive, releases, recordings)
    if not found:
        raise ValueError(refusal("free", "parameters that the recordings have", ", ".join(free)))
    return (*found, *of_noise(found, recordings))


def of_noise(free: Sequence[Parameter], recordings: Sequence[Recording]) -> tuple[Parameter, ...]:
    """Return the parameters that the noise of the recordings brings along, without those given."""
    given = {(p.key, p.recording) for p in free}
    found = []
    for r, recording in enumerate(recordings):
        for channel, values in recording.channels.items():
            size = 2.0 * float(np.nanmax(values) - np.nanmin(values))
            for part in recording.noise.get(channel, Noise()).keys:
                key = f"{channel}_{part}"
                if (key, r) in given:
                    continue
                name = key if len(recordings) == 1 else f"{key}@{r}"
                unit = unit_of(channel)
                found.append(Parameter(name, key, r, unit, 0.0, -size, size, of_noise=True))
    return tuple(found)


def is_of_sensor(key: str) -> bool:
    """True of a parameter of a sensor, which does not change the motion."""
    return key in SENSOR or key.endswith(_ADDED)


_ADDED: Final = tuple(f"_{key}" for key in (*DRIFT_KEYS, *sum(HUM_KEYS, ())))


def key_of(name: str) -> str:
    """The key of a device file in which a parameter stands."""
    if name == "damping_ratio":  # written as the damping
        return QUANTITIES["damping"].key
    if name in OF_FUNCTIONS:
        name = name.partition(".")[0]
    match = ROW.fullmatch(name)
    return QUANTITIES[_TABLES[match[1]] if match else name].key


def _key(given: str) -> str:
    """The name of a parameter: a key of a device file, with its section or without."""
    name = str(given).strip().removeprefix("motion.").removeprefix("drive.")
    return name if ROW.fullmatch(name) else _NAMES.find(name, "free")


def _scope(given: str) -> tuple[str, str]:
    """Return a name and its scope: "each" or "all" recordings, or neither."""
    name, at, scope = str(given).strip().partition("@")
    if at and scope not in ("each", "all"):
        raise ValueError(refusal("free", "a name, with @each or @all at most", repr(given)))
    return name, scope


def _quantity(key: str) -> Quantity | None:
    if match := ROW.fullmatch(key):
        table = QUANTITIES[_TABLES[match[1]]]
        across, _ = COLUMNS[table.rows_of]
        return QUANTITIES[across] if match[3] in ("speed", "time") else table
    return QUANTITIES.get(key)


def _parameter(
    key: str,
    r: int | None,
    bounds: tuple[float | str, float | str] | None,
    drive: Drive,
    releases: Sequence[Release],
    recordings: Sequence[Recording],
) -> list[Parameter]:
    name = key if r is None or len(releases) == 1 else f"{key}@{r}"
    release, recording = releases[r or 0], recordings[r or 0]
    quantity = _quantity(key)
    if key in SENSOR:
        channel = key.rpartition("_")[0]
        if channel != "time" and channel not in recording.channels:
            if any(channel in other.channels for other in recordings):
                return []  # belongs to another recording
            raise ValueError(refusal("free", "an offset of a recorded channel", key))
        unit = "s" if channel == "time" else unit_of(channel)
        start, allowed = 0.0, Bounds()
        if channel == "time":
            first, last = float(recording.time[0]), float(recording.time[-1])
            ends = first - 0.25 * (last - first), 0.5 * (first + last)
        else:
            values = recording.channels[channel]
            half = float(np.nanmax(values) - np.nanmin(values))
            ends = -half, half
    else:
        assert quantity
        unit, allowed = quantity.unit, quantity.limits
        start = _start(key, core_numbers(drive, release, None), release)
        ends = _searched(start, quantity, drive, recordings if r is None else [recording], key)
    if bounds is not None:
        of = "profile.time" if unit == "s" else "profile.value"
        if quantity:
            of = quantity.name
        low, high = (check(of, end, label=f"bounds of {name}") for end in bounds)
        if not low < high:
            raise ValueError(refusal(f"bounds of {name}", "increasing", f"{low:g} to {high:g}"))
        ends = low, high
    ends = max(ends[0], allowed.lower), min(ends[1], allowed.upper)
    return [Parameter(name, key, r, unit, min(max(start, ends[0]), ends[1]), *ends)]


def _start(key: str, numbers: CoreNumbers, release: Release) -> float:
    """The value that drive and release have."""
    name, part = key.partition("[")[0].partition(".")[0], key.partition(".")[2]
    given = getattr(release, name, None)
    if key in OF_FUNCTIONS:
        if not isinstance(given, Function) or part not in given.parameters:
            required = "a parameter of a function that the release has"
            raise ValueError(refusal("free", required, key))
        return given.parameters[part]
    if isinstance(given, Function):
        known = ", ".join(f"{name}.{part}" for part in given.parameters) or "left out"
        raise ValueError(refusal("free", known, key))
    if match := ROW.fullmatch(key):
        rows = _rows(numbers, match[1])
        if int(match[2]) >= len(rows):
            one = f"one of {counted(len(rows), 'row')} of {match[1]}"
            raise ValueError(refusal("free", one, key))
        return float(rows[int(match[2])][match[3] in ("force", "value")])
    if key in ("mouse_velocity", "plate_load"):
        rows = _rows(numbers, key)
        if len(rows) > 1:
            required = f"a row of it, like {key}[0].value, where it changes over time"
            raise ValueError(refusal("free", required, key))
        return float(rows[0][1])
    if key == "load_exponent" and len(_rows(numbers, "finger_load")) < 2:
        required = "left out where the release has no finger_load that changes"
        raise ValueError(refusal("free", required, key))
    if key == "finger.stiffness" and isinf(numbers[4][2]):
        start = QUANTITIES["finger.stiffness"].example
        assert start
        return start
    if key == "damping_ratio":
        mass, stiffness, damping = numbers[:3]
        return damping / (2.0 * sqrt(mass) * sqrt(stiffness))
    contact, _, name = key.partition(".")
    if name in ("breakaway", "stribeck_velocity"):
        law = entry(numbers, PLACES[f"{contact}.breakaway"][:2])[0]
        if law not in FALLING_NUMBERS:
            required = f"left out without the law {' or '.join(FALLING)}"
            raise ValueError(refusal("free", required, key))
    found = entry(numbers, PLACES[key])
    if isnan(found):
        raise ValueError(refusal("free", "one that the release was given", key))
    return float(found)


def _rows(numbers: Any, table: str) -> Sequence[tuple[Any, Any]]:
    rows: Sequence[tuple[Any, Any]] = entry(numbers, ROWS[table])
    return rows


def _searched(
    start: float, quantity: Quantity, drive: Drive, recordings: Sequence[Recording], key: str
) -> tuple[float, float]:
    """From where to where a parameter is searched without bounds."""
    size = abs(start) or _size(quantity.unit, drive, recordings)
    if key.endswith(".static"):
        return 0.0, 2.0 * DECADE * size
    if quantity.bounds.lower == 0.0 and not quantity.bounds.lower_closed:
        return size / DECADE, size * DECADE
    if quantity.bounds.lower == 0.0:
        return 0.0, size * DECADE
    if quantity.unit == "m":
        size = max(size, _size("m", drive, recordings))
    if quantity.unit == "m/s":
        size = max(size, _size("m/s", drive, recordings))
    return start - 2.0 * size, start + 2.0 * size


def _size(unit: str, drive: Drive, recordings: Sequence[Recording]) -> float:
    """Return the size of a parameter without a size of its own, from the recordings."""
    omega = drive.natural_frequency
    per_length = {
        "position": 1.0,
        "velocity": omega,
        "acceleration": omega**2,
        "force": drive.stiffness,
    }
    lengths = [
        float(np.nanmax(np.abs(values))) / per_length[channel]
        for recording in recordings
        for channel, values in recording.channels.items()
        if channel in per_length
    ]
    held = (drive.plate.static_friction + drive.finger.static_friction) / drive.stiffness
    length = max(lengths, default=0.0) or held or 1e-3
    powers = {"m": length, "m/s": length * omega, "N": length * drive.stiffness, "s": 1.0 / omega}
    return powers.get(unit, drive.mass * omega if unit == "N*s/m" else 1.0)

"""Slices of a study's file: one number over one key or two; and how figures name both."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from os import PathLike
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.files.keys import NUMERIC_KEYS, WHOLE, variable
from pindrive.lazy import xr
from pindrive.quantities.names import Names, label
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted
from pindrive.quantities.table import short
from pindrive.quantities.units import UnitError, to_si
from pindrive.study.distributions import Distribution, Linked
from pindrive.study.outputs import (
    MEASURED,
    NUMBERS,
    OUTPUTS,
    SCAN_MEASURED,
    SCAN_OUTPUTS,
    from_attribute,
    known_output,
)

QUANTITY: Final[dict[str, Quantity]] = {
    variable(key): q for key, q in NUMERIC_KEYS.items()
} | NUMBERS
"""Inputs and numbers by the names of their variables."""

_WORDS: Final = {
    "plate_kinetic": "plate friction",
    "plate_static": "static plate friction",
    "finger_kinetic": "finger friction",
    "finger_static": "static finger friction",
    "finger_stiffness": "skin stiffness",
    "finger_damping": "skin damping",
    "velocity": "release velocity",
    "latency": "latency of the control block",
    "fall_time": "fall time of the pull",
    "rise_time": "rise time of the pull",
    "lines_shown_part": "part of the lines shown",
    "lines_shown": "lines shown",
    "lines_unseen": "lines not seen by the control block",
    "lines_merged": "lines merged",
    "lines_faint": "lines too faint",
    "lines_false": "false lines",
    "lines_unsettled": "lines not settled",
    "lines_direction": "lines with a direction",
    "lines_sure": "lines with a sure direction",
    "median_skin": "median skin motion",
    "worst_skin": "least skin motion",
    "hand_duration": "time of the hand's way",
    "hand_slowest_speed": "least speed of the hand",
    "hand_mean_speed": "mean speed of the hand",
    "hand_path_error": "error of the hand's path",
    "hand_stopped": "time for which the hand stood",
    "magnet_on_part": "part of the time a magnet is on",
    "coil_warming": "warming of the coil",
}
_TALL: Final = re.compile(r"([A-Za-z'α-ωΑ-Ω]+)_(.+)")


def words(name: str) -> str:
    """A variable in words: "plate friction", "settling time", "median lag at a line's end"."""
    if name in SCAN_MEASURED and name.endswith(("_on", "_off")):
        name, _, edge = name.rpartition("_")
        return f"{words(name)} at a line's {'begin' if edge == 'on' else 'end'}"
    return _WORDS.get(name, label(name).replace("_", " "))


def symbol(name: str) -> str:
    r"""Its symbol for mathtext: "$F_\mathrm{p}$"; empty where it has none."""
    text = QUANTITY[name].symbol
    parts = _TALL.fullmatch(text)
    if parts is None:
        return f"${text}$" if text else ""
    if " " in text:
        return ""
    return rf"${parts[1]}_\mathrm{{{parts[2].replace('_', ' ')}}}$"


def axis_label(name: str) -> str:
    r"""Return the label of an axis: "plate friction $F_\mathrm{p}$ (mN)"."""
    unit = QUANTITY[name].display_unit
    said = " ".join(filter(None, (words(name), symbol(name))))
    return f"{said} ({unit})" if unit else said


def value(name: str, number: float) -> str:
    """A value with its symbol: "$m$ = 10 g"."""
    return f"{symbol(name) or words(name)} = {short(QUANTITY[name].name, number)}"


def values(given: Mapping[str, float], width: int) -> str:
    """Return values in sequence, broken into lines of limited length."""
    lines = [""]
    for name, number in given.items():
        said = value(name, number)
        shown = re.sub(r"[$\\{}_]|mathrm", "", f"{lines[-1]}, {said}")
        if lines[-1] and len(shown) > width:
            lines.append(said)
        else:
            lines[-1] = f"{lines[-1]}, {said}" if lines[-1] else said
    return ",\n".join(lines)


def ranges(scatter: Mapping[str, Distribution]) -> str:
    """Return the varied keys with their ranges, five in a line: "m 9.4 … 10.6 g (3σ), k …"."""
    said = []
    for key, axis in scatter.items():
        quantity = QUANTITY[variable(key)]
        low, high = (f"{quantity.display_scale * x:.3g}" for x in axis.span)
        ends = f"{symbol(variable(key))} {low} … {high} {quantity.display_unit}".rstrip()
        said.append(ends + ("" if axis.kind in ("uniform", "loguniform") else " (3σ)"))
    return ",\n".join(", ".join(said[i : i + 5]) for i in range(0, len(said), 5))


_MOST_SLICES: Final = 3
_MOST_CURVES: Final = 5
_BINS: Final = 60


@dataclass(frozen=True, slots=True)
class Panel:
    """One number over x, or over y and x, SI; NaN where it does not exist."""

    number: str
    keys: Sequence[str]
    """x alone, or y and x: the axes of `values`."""
    at: Mapping[str, float]
    """Fixed values of all other varied keys."""
    along: Sequence[NDArray[np.float64]]
    """The values of each key."""
    values: NDArray[np.float64]
    unsettled: NDArray[np.bool_]
    absent: NDArray[np.bool_]
    """True for points without the number although the motion settles."""
    refused: NDArray[np.bool_]
    low: NDArray[np.float64] | None = None
    """5 % quantile of many draws, whose median is in `values`."""
    high: NDArray[np.float64] | None = None
    """The 95 % quantile."""
    met: NDArray[np.float64] | None = None
    """The part of the draws that meets the specification, 0 or 1 of a point; None: without one."""


class Slice:
    """Open study file with its varied keys and slices."""

    def __init__(self, path: str | PathLike[str]) -> None:
        """Open the file of a sweep.

        Raises:
            ValueError: The file cannot be read, or is not a study.
        """
        self.path = str(path)
        try:
            with open(path, "rb") as file:  # says more of what is wrong than HDF5 does
                if not file.read(4) == b"\x89HDF":
                    raise ValueError("it is no NetCDF file; `pindrive sweep` writes one of a study")
            self.data: xr.Dataset = xr.open_dataset(path, engine="h5netcdf")
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or str(error).splitlines()[0]
            raise ValueError(f"{self.path}: cannot be read: {reason}") from None
        if self.path.endswith(".partial"):
            self.data.close()
            raise ValueError(
                f"{self.path}: is not finished; `pindrive sweep --resume` continues it"
            )
        if "identity" not in self.data.attrs:
            self.data.close()
            raise ValueError(f"{self.path}: is not a study; `pindrive sweep` writes one")
        self.keys = [
            str(name)
            for name, c in self.data.coords.items()
            if c.dims and self.data.sizes[c.dims[0]] > 1
        ]
        self.sampled = [k for k in self.keys if self.data[k].dims == ("sample",)]
        self.page = str(self.data.attrs.get("page", ""))
        """Scanned page; empty for a study of releases."""
        known = SCAN_MEASURED if self.page else MEASURED
        self.numbers = [name for name in known if name in self.data]
        self.fixed = {
            str(name): c.item()
            for name, c in self.data.coords.items()
            if c.size == 1 and str(name) in QUANTITY
        }

        self.constraints = from_attribute(str(self.data.attrs.get("specification", "")))
        """The specification of the study."""
        links = json.loads(self.data.attrs["identity"])["links"]
        self.links = [
            Linked(**link).words(key, lambda key: words(variable(key)))
            for key, link in links.items()
        ]

    def __enter__(self) -> Slice:
        return self

    def __exit__(self, *_: object) -> None:
        self.data.close()

    # ---- what is requested -----------------------------------------------------------------------

    def key(self, given: str, argument: str) -> str:
        """The varied key that is meant.

        Raises:
            ValueError: The key is unknown, or was not varied.
        """
        names = Names("key", {name: (QUANTITY[name].key,) for name in self.keys})
        found = names.matches(given)
        if len(found) == 1:
            return found[0]
        stated = names.suggestion(given)
        raise ValueError(f"`{argument}` {given}: {self.path} does not vary it; {stated}")

    def number(self, given: str) -> str:
        """The number that is meant, if the file holds it."""
        name = known_output(given, "`number`", SCAN_OUTPUTS if self.page else OUTPUTS)
        if name not in self.numbers:
            held = ", ".join(self.numbers)
            raise ValueError(f"`number` {given}: {self.path} does not hold it; it holds {held}")
        return name

    def usual_numbers(self) -> list[str]:
        """The settling time, of scans the part of lines shown; or the first that the file holds."""
        usual = "transient_settling_time"
        if not self.numbers:
            raise ValueError(f"{self.path}: holds no number to draw")
        return [usual if usual in self.numbers else self.numbers[0]]

    @property
    def stated(self) -> dict[str, float]:
        """The device's values that a picture states: without a default, or other than it.

        For a study of releases, all values that were not varied.
        """
        standard = {variable(key): quantity.default for key, quantity in WHOLE.items()}
        return {
            name: value
            for name, value in self.fixed.items()
            if name not in standard or value != standard[name]
        }

    def held(self, given: Sequence[str]) -> dict[str, float]:
        """The values, SI, of "key=value" each."""
        found = {}
        for text in given:
            name, equals, written = (part.strip() for part in text.partition("="))
            if not equals:
                raise ValueError(f"`at` {quoted(text)}: must be key=value")
            key = self.key(name, "at")
            if key in self.sampled:
                raise ValueError(f"`at` {name}: is sampled, and cannot be held at one value")
            quantity = QUANTITY[key]
            try:
                found[key] = to_si(written, quantity.unit, quantity.usual)
            except UnitError as error:
                raise ValueError(f"`at` {name}: must be {error}, got {quoted(written)}") from None
        return found

    def axes(self, x: str | None, y: str | None, held: Mapping[str, float]) -> tuple[str, str]:
        """Return the keys of the axes: the given ones, or the first two free ones.

        Raises:
            ValueError: There are no axes, or the two change together.
        """
        if not self.keys:
            raise ValueError(f"{self.path}: holds a single point, there is nothing to draw over")
        if x and y and not self._independent(x, y):
            raise ValueError(f"`y` {y}: does not change independently of {x} in this study")
        chosen = [key for key in (x, y) if key]
        for key in self.keys:
            if len(chosen) < (2 if x is None else len(chosen)) and all(
                self._independent(key, other) for other in (*chosen, *held)
            ):
                chosen.append(key)
        if x is None and y:
            chosen = [*[key for key in chosen if key != y][:1], y]
        if not chosen or (x is None and chosen == [y]):
            raise ValueError(f"{self.path}: nothing is left to draw over; leave out `at` or `y`")
        return chosen[0], chosen[1] if len(chosen) > 1 else ""

    def _independent(self, one: str, other: str) -> bool:
        """Return True if two keys take all combinations of values, or are drawn independently."""
        return one != other and (
            self.dimension(one) != self.dimension(other) or one in self.sampled
        )

    def dimension(self, key: str) -> str:
        """Along which dimension of the file a key changes."""
        return str(self.data[key].dims[0])

    # ---- slices ----------------------------------------------------------------------------------

    def panels(self, number: str, x: str, y: str, held: Mapping[str, float]) -> Iterator[Panel]:
        """Slices of one number: for some values of the first key left, the middle of others.

        Draws that are not drawn over are summed up by their median.
        """
        used = {"sample", *(self.dimension(key) for key in (x, y) if key)}
        most = _MOST_SLICES if y else _MOST_CURVES
        picks: dict[str, list[int]] = {}
        for key in (*held, *self.keys):
            dimension, along = self.dimension(key), self.data[key].values
            if dimension in {*used, *picks}:
                continue
            if key in held:
                picks[dimension] = [int(np.argmin(np.abs(along - held[key])))]
            else:
                ends = (0, len(along) - 1) if most > 1 else (len(along) // 2,) * 2
                even = np.linspace(*ends, min(most, len(along)))
                picks[dimension] = np.unique(even.round().astype(int)).tolist()
                most = 1
        for choice in product(*picks.values()):
            yield self._panel(number, x, y, dict(zip(picks, choice, strict=True)))

    def _panel(self, number: str, x: str, y: str, choice: Mapping[str, int]) -> Panel:
        names = {number, "transient_settling_time", "transient_settled", "status"}
        names |= {constraint.name for constraint in self.constraints}
        part = self.data[sorted(name for name in names if name in self.data)].isel(choice)
        keys = [key for key in (y, x) if key]
        dims = list(dict.fromkeys(self.dimension(key) for key in keys))
        if "sample" in part.dims and "sample" not in dims:
            dims.append("sample")
        part = part.squeeze([d for d in part.dims if d not in dims]).load().transpose(*dims)
        values, refused = part[number].values, part["status"].values != 0
        unsettled = _unsettled(part) & ~refused
        absent = np.isnan(values) & ~unsettled & ~refused
        met = [constraint.met(part[constraint.name].values) for constraint in self.constraints]
        flags = np.array([unsettled, absent, refused, np.logical_and.reduce([*met, ~refused])])
        at = {
            key: float(self.data[key][choice[self.dimension(key)]])
            for key in self.keys
            if self.dimension(key) in choice
        }
        along = [part[key] for key in keys]
        if any(key in self.sampled for key in keys):
            spread = [np.broadcast_to(_beside(c, dims), values.shape).ravel() for c in along]
            found: tuple[Any, ...] = _binned(spread, values.ravel(), flags.reshape(4, -1))
        elif "sample" in dims:
            found = _summed_up([c.values for c in along], values, flags)
        else:
            found = ([c.values for c in along], values, *flags[:3], None, None, flags[3] * 1.0)
        panel = Panel(number, keys, at, *found)
        return panel if self.constraints else replace(panel, met=None)


def _unsettled(part: xr.Dataset) -> NDArray[np.bool_]:
    """Return True for points without a settled motion, as far as the file contains this."""
    if "transient_settled" in part:
        return np.asarray(~part["transient_settled"].values)
    if "transient_settling_time" in part:
        return np.asarray(np.isnan(part["transient_settling_time"].values))
    return np.zeros(part["status"].shape, np.bool_)


def _beside(coordinate: xr.DataArray, dims: Sequence[str]) -> NDArray[np.float64]:
    """Return the values of a coordinate, shaped for these dimensions."""
    shape = [coordinate.size if d == coordinate.dims[0] else 1 for d in dims]
    return np.asarray(coordinate.values).reshape(shape)


def _summed_up(
    places: Sequence[NDArray[np.float64]],
    values: NDArray[np.float64],
    flags: NDArray[np.bool_],
) -> tuple[Any, ...]:
    """Return the quantiles of a panel over the draws, which are the last axis."""
    shape = values.shape[:-1]
    group = np.repeat(np.arange(values[..., 0].size), values.shape[-1])
    low, middle, high = quantiles(group, values.ravel(), values[..., 0].size).reshape(3, *shape)
    parts = flags.mean(axis=-1)
    return places, middle, *(parts[:3] > 0.5), low, high, parts[3]


def _binned(
    along: Sequence[NDArray[np.float64]],
    values: NDArray[np.float64],
    flags: NDArray[np.bool_],
) -> tuple[Any, ...]:
    """Return the quantiles of a panel over the draws within many bins."""
    most = _BINS if len(along) == 1 else int(np.clip(np.sqrt(len(values) / 200), 4, _BINS))
    group, middles, shape = np.zeros(len(values), np.int64), [], []
    for places in along:
        different = np.unique(places[: 10 * most])
        if len(different) <= most and np.isin(places, different).all():
            number_of, middle = np.searchsorted(different, places), different
        else:
            edges = np.linspace(places.min(), places.max(), most + 1)
            number_of = np.clip(np.searchsorted(edges, places, "right") - 1, 0, most - 1)
            middle = 0.5 * (edges[1:] + edges[:-1])
        group = group * len(middle) + number_of
        middles.append(middle)
        shape.append(len(middle))
    count = int(np.prod(shape))
    low, middle, high = quantiles(group, values, count).reshape(3, *shape)
    drawn = np.maximum(np.bincount(group, minlength=count), 1)
    parts = [
        (np.bincount(group, weights=flag, minlength=count) / drawn).reshape(shape) for flag in flags
    ]
    return middles, middle, *(part > 0.5 for part in parts[:3]), low, high, parts[3]


def quantiles(
    group: NDArray[np.int64], values: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """Return the 5, 50 and 95 % quantiles of `count` groups of values without NaN, (3, n)."""
    exists = ~np.isnan(values)
    group, values = group[exists], values[exists]
    order = np.lexsort((values, group))
    values = values[order]
    sizes = np.bincount(group, minlength=count)
    first = np.cumsum(sizes) - sizes
    found = np.full((3, count), np.nan)
    full = sizes > 0
    for row, part in zip(found, (0.05, 0.5, 0.95), strict=True):
        place = part * (sizes[full] - 1)
        below = np.floor(place).astype(np.int64)
        above = np.minimum(below + 1, sizes[full] - 1)
        left, right = values[first[full] + below], values[first[full] + above]
        row[full] = left + (place - below) * (right - left)
    return found


def elasticity(value: float) -> str:
    """An elasticity to two decimals with its sign: "+0.57"; a point for none to speak of."""
    if np.isnan(value):
        return "-"
    return "·" if abs(value) < 0.005 else f"{value:+.2f}"

"""Bifurcation diagrams: the steady motions of a pin over one parameter, continued up and down."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite, nan
from typing import Any, Final

import numpy as np

from pindrive import lazy
from pindrive.files.keys import NAMES, NUMERIC_KEYS, variable
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.motion import Motion
from pindrive.motion.release import Release
from pindrive.motion.simulate import simulated
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import End, Status
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.value import equal_by_value
from pindrive.study.design import Columns
from pindrive.study.distributions import Even, Listed, with_links
from pindrive.study.study import Study

Progress = Callable[[int, int], None]

DIRECTIONS: Final = ("up", "down")
MOST_POINTS: Final = 256
"""Largest number of turning points of one motion."""
ALIKE: Final = 1e-7
"""Distance within which two turning points are one, over the amplitude."""
NUDGE: Final = 1e-6
"""Displacement by which a continued motion begins beside the one before, over its size.

An equilibrium that has lost its stability is then left.
"""


@equal_by_value
@dataclass(frozen=True, slots=True)
class SteadyMotion:
    """The ending of a motion at one value of the parameter."""

    value: float
    """Value of the parameter, SI."""
    end: End
    points: tuple[float, ...]
    """Displacements at the turning points away from the plate's pull, m; the position of a rest."""
    amplitude: float
    """Half of the range, m; 0 at rest."""
    period: float
    """s; NaN where the motion does not repeat."""
    multiplier: float
    """Absolute value of the largest Floquet multiplier; NaN where there is none."""


@equal_by_value
@dataclass(frozen=True, kw_only=True, repr=False)
class Bifurcation(lazy.NotebookHtml):
    """Result of `bifurcation`."""

    key: str
    """Parameter, a key of device files."""
    up: tuple[SteadyMotion, ...]
    """Motions as the parameter grows, in order of its values."""
    down: tuple[SteadyMotion, ...]
    """Motions as it falls, in order of its values."""
    name: str = ""
    """Name of the study."""

    def __repr__(self) -> str:
        """Return the parameter and the number of values in a line."""
        both = sum(_differ(one, other) for one, other in zip(self.up, self.down, strict=True))
        values = f"{counted(len(self.up), 'value')} of {self.key}"
        return f"<Bifurcation over {values}, {both} with two motions, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where the ending of a motion is not known."""
        known = all(motion.end != End.moving for motion in (*self.up, *self.down))
        return Status.ok if known else Status.incomplete

    def plot(self) -> mpl_figure.Figure:
        """Plot the turning points over the parameter, up and down."""
        from pindrive.plot.bifurcation import plot_bifurcation

        return plot_bifurcation(self)

    def to_dataset(self) -> xr.Dataset:
        """Return all motions.

        Returns:
            Over the direction, "up" and "down", and the values of the parameter: `ending` by its
            number, `amplitude` (m), `period` (s), `multiplier`, and over `point` also
            `displacement` (m), that of the turning points; NaN where there is none.
        """
        quantity, name = NUMERIC_KEYS[self.key], variable(self.key)
        branches = (self.up, self.down)
        most = max(len(motion.points) for branch in branches for motion in branch)
        points = np.full((2, len(self.up), most), nan)
        for i, branch in enumerate(branches):
            for j, motion in enumerate(branch):
                points[i, j, : len(motion.points)] = motion.points
        dims = ("direction", name)
        words = {"long_name": "displacement at the turning points", "units": "m"}
        data: dict[str, Any] = {"displacement": ((*dims, "point"), points, words)}
        for of, attributes in _NUMBERS.items():
            values = [[getattr(motion, of) for motion in branch] for branch in branches]
            data[of] = (dims, values, attributes)
        ends = [[int(motion.end) for motion in branch] for branch in branches]
        data["ending"] = (dims, np.array(ends, np.int8), {"long_name": "kind of the ending"})
        coords = {
            "direction": [*DIRECTIONS],
            name: (name, [motion.value for motion in self.up], quantity.attributes),
        }
        return xr.Dataset(data, coords=coords, attrs={"title": self.name, "key": self.key})


_NUMBERS: Final[dict[str, dict[str, str]]] = {
    "amplitude": {"long_name": QUANTITIES["ending.amplitude"].meaning, "units": "m"},
    "period": {"long_name": QUANTITIES["ending.period"].meaning, "units": "s"},
    "multiplier": {"long_name": "absolute value of the largest Floquet multiplier", "units": "1"},
}


def bifurcation(
    study: Study, over: str | None = None, *, progress: Progress = lambda done, total: None
) -> Bifurcation:
    """Follow the steady motions of a pin over one parameter, up and down.

    Each motion begins where the one at the value before has ended. Where two motions exist, the two
    directions find one each.

    Args:
        study: Study of releases.
        over: The axis to follow, a key of the study; further axes have the device's values. None:
            the only one.
        progress: Function called with the motions done and the motions in all.

    Returns:
        For each value and direction how the motion ends, with its turning points, amplitude, period
        and largest multiplier.

    Raises:
        ValueError: The study has no such axis, or several and none is named; it has a page; or a
            motion cannot be simulated.
    """
    key, columns = _axis(study, over)
    values = columns[key]
    found: dict[str, list[SteadyMotion]] = {}
    for i, direction in enumerate(DIRECTIONS):
        places = range(len(values)) if direction == "up" else reversed(range(len(values)))
        start: dict[str, float] = {}
        branch = []
        for j, place in enumerate(places):
            at = {name: float(column[place]) for name, column in columns.items()}
            motion = _motion(study, at, start)
            branch.append(_steady(at[key], motion))
            start = _state(motion)
            progress(i * len(values) + j + 1, 2 * len(values))
        found[direction] = branch if direction == "up" else branch[::-1]
    up, down = (tuple(found[direction]) for direction in DIRECTIONS)
    return Bifurcation(key=key, up=up, down=down, name=study.name)


def _axis(study: Study, over: str | None) -> tuple[str, Columns]:
    """Return the key of the axis, its increasing values and those of the keys linked to it."""
    grids = {key: axis for key, axis in study.axes.items() if isinstance(axis, Even | Listed)}
    if study.page:
        raise ValueError(refusal("the study", "of releases", "a page", str(study.path)))
    if over is None and len(grids) != 1:
        required = "one axis of values, or the name of one"
        given = counted(len(grids), "axis", "axes")
        raise ValueError(refusal("the study", required, given, str(study.path)))
    key = next(iter(grids)) if over is None else NAMES.find(over, "over")
    if key not in grids:
        raise ValueError(refusal("over", f"an axis ({', '.join(grids)})", key, str(study.path)))
    values = np.unique(grids[key].at(np.arange(grids[key].count)))
    links = {name: link for name, link in study.links.items() if link.of == key}
    return key, with_links(study.device, {key: values}, links)


def _motion(study: Study, at: Mapping[str, float], start: Mapping[str, float]) -> Motion:
    """Return the motion at a value from a start; without one, from that of the device."""
    file = study.device_at(at)
    release: Release = file.release.replace(**start)
    return simulated(file.drive, release, duration=file.duration, settling_band=file.settling_band)


def _steady(value: float, motion: Motion) -> SteadyMotion:
    """Return the ending of a motion."""
    end = motion.ending
    moves = end.kind in ("steady", "irregular") and end.amplitude > 0.0
    points = tuple(sorted(_turning_points(motion))) if moves else (end.position,)
    amplitude = end.amplitude if moves else 0.0
    period = end.period if end.kind == "steady" else nan
    return SteadyMotion(value, end.end, points, amplitude, period, _multiplier(motion))


def _multiplier(motion: Motion) -> float:
    if motion.ending.kind != "steady":
        return nan
    try:
        return max((abs(each) for each in motion.multipliers()), default=nan)
    except ValueError:
        return nan


def _turning_points(motion: Motion) -> list[float]:
    """Return the largest displacements of the rounds of a cycle, or of the last ones."""
    until = motion.core.until
    begin = motion.core.cycle_begin
    time, x = motion.core.extrema(0, until, 1 << 20)
    inside = (time > begin) & (time <= until)
    time, x = time[inside], x[inside]
    if len(x) < 3:
        return [motion.ending.position + motion.ending.amplitude]
    tops = x[(x >= np.roll(x, 1)) & (x >= np.roll(x, -1))]  # the end of a cycle is its begin
    if not len(tops):
        return [float(x.max())]
    ordered = np.sort(tops)
    apart = np.diff(ordered, prepend=-np.inf) > ALIKE * motion.ending.amplitude
    return list(map(float, ordered[apart][-MOST_POINTS:]))


def _state(motion: Motion) -> dict[str, float]:
    """Return the state from which the motion at the next value begins."""
    end = motion.ending
    if end.kind in ("resting", "decaying"):
        x, v = end.position, 0.0
    else:
        # The phase of inputs that repeat is that of the begin of a period.
        time = motion.core.cycle_begin if end.kind == "steady" else motion.core.until
        x, v = motion.position(time), motion.velocity(time)
    size = max(abs(x), end.amplitude if isfinite(end.amplitude) else 0.0)
    return {"displacement": x + NUDGE * size, "velocity": v}


def _differ(one: SteadyMotion, other: SteadyMotion) -> bool:
    """Return True if two motions at one value are not the same."""
    size = max(one.amplitude, other.amplitude)
    return abs(one.amplitude - other.amplitude) > 1e-3 * size

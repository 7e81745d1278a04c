"""Bifurcation diagrams: the steady motions of a pin over one parameter, continued up and down."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import nan
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

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
from pindrive.study.distributions import Even, Linked, Listed, with_links
from pindrive.study.study import Study
from pindrive.views import NotebookHtml, figure

Progress = Callable[[int, int], None]

DIRECTIONS: Final = ("up", "down")
MOST_POINTS: Final = 256
"""Largest number of turning points of one motion."""
ALIKE: Final = 1e-7
"""Distance within which two turning points are one, over the amplitude."""
NUDGE: Final = 1e-6
"""Displacement, over its size, by which a motion begins beside an equilibrium.

An equilibrium that has lost its stability is then left.
"""
HALVINGS: Final = 14
"""Bisections of the step in which a branch ends or jumps."""
_UNKNOWN: Final = (End.moving, End.growing, End.approaching)
_GRIPPING: Final = 3
"""State of a compliant finger whose skin sticks, in the table of segments."""
JUMP: Final = 0.1
"""Change of amplitude or period, over the larger one, from which a step may contain a jump."""


@equal_by_value
@dataclass(frozen=True, slots=True)
class SteadyMotion:
    """The ending of a motion at one value of the parameter."""

    value: float
    """Value of the parameter, SI."""
    end: End
    points: tuple[float, ...]
    """Displacements at the turning points away from the plate's pull, m; the position of a rest."""
    lowest: float
    """Lower envelope, the smallest displacement of the motion, m."""
    highest: float
    """Upper envelope, the largest displacement, m."""
    period: float
    """s; NaN where the motion does not repeat."""
    multiplier: float
    """Absolute value of the largest Floquet multiplier; NaN where there is none."""

    @property
    def amplitude(self) -> float:
        """Half of the range, m; 0 at rest."""
        return (self.highest - self.lowest) / 2.0


@equal_by_value
@dataclass(frozen=True, slots=True)
class BranchChange:
    """End or jump of a branch of motions, between two values of the parameter."""

    direction: str
    """Direction in which the branch is followed, "up" or "down"."""
    last: float
    """Value at which the branch still exists, SI."""
    first: float
    """Value at which another motion follows, SI."""
    before: SteadyMotion
    """Motion at the last value."""
    after: SteadyMotion
    """Motion at the next value of the study."""


@equal_by_value
@dataclass(frozen=True, kw_only=True, repr=False)
class Bifurcation(NotebookHtml):
    """Result of `bifurcation`."""

    key: str
    """Parameter, a key of device files."""
    up: tuple[SteadyMotion, ...]
    """Motions as the parameter grows, in order of its values."""
    down: tuple[SteadyMotion, ...]
    """Motions as it falls, in order of its values."""
    changes: tuple[BranchChange, ...] = ()
    """Ends and jumps of the branches, each within a ten-thousandth of a step."""
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
        known = all(motion.end not in _UNKNOWN for motion in (*self.up, *self.down))
        return Status.ok if known else Status.incomplete

    def plot(self) -> mpl_figure.Figure:
        """Plot the turning points over the parameter, up and down."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """Return all motions.

        Returns:
            Over the direction, "up" and "down", and the values of the parameter: `ending` by its
            number, the envelope `lowest` and `highest` (m), `amplitude` (m), `period` (s),
            `multiplier`, and over `point` also `displacement` (m), that of the turning points; NaN
            where there is none. Over `change`, each end or jump of a branch: `change_direction`,
            and the two values of the parameter between which it is, `change_last` and
            `change_first`, with the endings before and after.
        """
        quantity, name = NUMERIC_KEYS[self.key], variable(self.key)
        branches = (self.up, self.down)
        dims = ("direction", name)
        ends = [[int(motion.end) for motion in branch] for branch in branches]
        data: dict[str, Any] = {
            "ending": (dims, np.array(ends, np.int8), {"long_name": "kind of the ending"})
        }
        for of, attributes in _NUMBERS.items():
            values = [[getattr(motion, of) for motion in branch] for branch in branches]
            data[of] = (dims, values, attributes)
        most = max(len(motion.points) for branch in branches for motion in branch)
        points = np.full((2, len(self.up), most), nan)
        for i, branch in enumerate(branches):
            for j, motion in enumerate(branch):
                points[i, j, : len(motion.points)] = motion.points
        words = {"long_name": "displacement at the turning points", "units": "m"}
        data["displacement"] = ((*dims, "point"), points, words)
        changes = self.changes
        data["change_direction"] = ("change", [each.direction for each in changes])
        for at, meaning in (("last", "the branch exists"), ("first", "another motion follows")):
            found = np.array([getattr(each, at) for each in changes], float)
            attributes = quantity.attributes | {"long_name": f"value at which {meaning}"}
            data[f"change_{at}"] = ("change", found, attributes)
        for at in ("before", "after"):
            codes = np.array([int(getattr(each, at).end) for each in changes], np.int8)
            data[f"change_{at}"] = ("change", codes, {"long_name": f"ending {at} the change"})
        coords = {
            "direction": [*DIRECTIONS],
            name: (name, [motion.value for motion in self.up], quantity.attributes),
        }
        return xr.Dataset(data, coords=coords, attrs={"title": self.name, "key": self.key})


_NUMBERS: Final[dict[str, dict[str, str]]] = {
    "lowest": {"long_name": "smallest displacement", "units": "m"},
    "highest": {"long_name": "largest displacement", "units": "m"},
    "amplitude": {"long_name": QUANTITIES["ending.amplitude"].meaning, "units": "m"},
    "period": {"long_name": QUANTITIES["ending.period"].meaning, "units": "s"},
    "multiplier": {"long_name": "absolute value of the largest Floquet multiplier", "units": "1"},
}


def bifurcation(
    study: Study, over: str | None = None, *, progress: Progress = lambda done, total: None
) -> Bifurcation:
    """Follow the steady motions of a pin over one parameter, up and down.

    Each motion begins in the state of the one at the value before, at an event of its cycle. Where
    two motions exist, the two directions find one each. A step in which the branch ends, or jumps
    to another motion, is bisected to less than a ten-thousandth.

    Args:
        study: Study of releases.
        over: The axis to follow, a key of the study; further axes have the device's values. None:
            the only one.
        progress: Function called with the motions done and the motions in all.

    Returns:
        For each value and direction how the motion ends, with its turning points, envelope, period
        and largest multiplier, and the ends and jumps of the branches.

    Raises:
        ValueError: The study has no such axis, or several and none is named; it has a page; or a
            motion cannot be simulated.
    """
    key, values, links = _axis(study, over)
    found: dict[str, list[SteadyMotion]] = {}
    changes: list[BranchChange] = []

    def follow(value: float, start: _Start) -> tuple[SteadyMotion, _Start]:
        columns = with_links(study.device, {key: np.array([value])}, links)
        motion = _motion(study, {name: float(column[0]) for name, column in columns.items()}, start)
        return _steady(value, motion), _state(motion)

    for i, direction in enumerate(DIRECTIONS):
        start: _Start = {}
        branch: list[SteadyMotion] = []
        for j, value in enumerate(values if direction == "up" else values[::-1]):
            before = start
            motion, start = follow(float(value), before)
            if branch:
                changes += _change(direction, branch[-1], motion, before, follow)
            branch.append(motion)
            progress(i * len(values) + j + 1, 2 * len(values))
        found[direction] = branch if direction == "up" else branch[::-1]
    up, down = (tuple(found[direction]) for direction in DIRECTIONS)
    return Bifurcation(key=key, up=up, down=down, changes=tuple(changes), name=study.name)


_Start = dict[str, float | None]
"""Initial state, by the arguments of a release."""
_Follow = Callable[[float, _Start], tuple[SteadyMotion, _Start]]


def _change(
    direction: str, one: SteadyMotion, other: SteadyMotion, start: _Start, follow: _Follow
) -> list[BranchChange]:
    """Return the end or jump of a branch between two motions of a step, if there is one.

    Args:
        direction: Direction of the continuation.
        one: Motion before the step.
        other: Motion after the step.
        start: State of the motion before the step.
        follow: Simulates the motion at a value from a state.
    """
    after, ends = other, one.end != other.end
    if not ends and not _apart(one, other) > JUMP:
        return []
    for _ in range(HALVINGS):
        middle, state = follow(0.5 * (one.value + other.value), start)
        if middle.end == End.approaching:  # close to the motion before, by which it is continued
            one = replace(one, value=middle.value)
        elif one.end == middle.end if ends else _apart(one, middle) <= _apart(middle, other):
            one, start = middle, state
        else:
            other = middle
        # A steep branch changes by half in half of the step, a jump does not.
        if not ends and not _apart(one, other) > JUMP:
            return []
    return [BranchChange(direction, one.value, other.value, one, after)]


def _apart(one: SteadyMotion, other: SteadyMotion) -> float:
    """Return the larger of the relative differences of amplitude and period."""

    def difference(x: float, y: float) -> float:
        return abs(x - y) / max(x, y) if max(x, y) > 0.0 else 0.0

    return max(difference(one.amplitude, other.amplitude), difference(one.period, other.period))


def _axis(study: Study, over: str | None) -> tuple[str, NDArray[np.float64], dict[str, Linked]]:
    """Return the key of the axis, its increasing values, and the links to it."""
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
    return key, values, links


def _motion(study: Study, at: Mapping[str, float], start: _Start) -> Motion:
    """Return the motion at a value from a start; without one, from that of the device."""
    file = study.device_at(at)
    release: Release = file.release.replace(**start)
    return simulated(file.drive, release, duration=file.duration, settling_band=file.settling_band)


def _steady(value: float, motion: Motion) -> SteadyMotion:
    """Return the ending of a motion."""
    if End(motion.core.end) in _UNKNOWN:
        return SteadyMotion(value, End(motion.core.end), (nan,), nan, nan, nan, nan)
    end = motion.ending
    moves = end.kind in ("steady", "irregular") and end.amplitude > 0.0
    points = tuple(sorted(_turning_points(motion))) if moves else (end.position,)
    amplitude = end.amplitude if moves else 0.0
    low, high = (end.position + side * amplitude for side in (-1.0, 1.0))
    period = end.period if end.kind == "steady" else nan
    return SteadyMotion(value, end.end, points, low, high, period, _multiplier(motion))


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


def _state(motion: Motion) -> _Start:
    """Return the state from which the motion at the next value begins.

    A cycle is continued from its first event at which the plate takes the pin along: at another
    speed of the plate the pin then has that speed. Without stick, and under inputs that repeat, the
    cycle is continued from its begin.
    """
    core, end = motion.core, End(motion.core.end)
    if end in (End.resting, End.decaying):
        position = motion.ending.position
        return {"displacement": position + NUDGE * abs(position), "velocity": 0.0}
    table = core.segments()
    begins = table["begin"]
    time = core.until if end in _UNKNOWN or end == End.irregular else core.cycle_begin
    if end == End.stick_slip:
        time = float(begins[(begins >= time) & (table["plate"] == 0)][0])
    place = max(int(np.searchsorted(begins, time, side="right")) - 1, 0)
    carried = int(table["plate"][place]) == 0
    state: _Start = {
        "displacement": motion.position(time),
        "velocity": None if carried else motion.velocity(time),
    }
    if int(table["finger"][place]) == _GRIPPING:
        state["skin_stretch"] = motion.stretch(time)
    return state


def _differ(one: SteadyMotion, other: SteadyMotion) -> bool:
    """Return True if two motions at one value are not the same."""
    size = max(one.amplitude, other.amplitude)
    return abs(one.amplitude - other.amplitude) > 1e-3 * size

"""A system of several bodies, simulated for every combination of some of its parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from math import nan, prod
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.bodies.system import System
from pindrive.lazy import xr
from pindrive.quantities.bodies import number_of, quantity_of
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.names import Names
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import message_of, quoted, refusal
from pindrive.quantities.status import Status, outcome_attributes
from pindrive.quantities.table import check
from pindrive.study.axes import as_read
from pindrive.study.distributions import Even, Listed
from pindrive.study.workers import spread

_STEPS: Final = ("lin", "log")


class SystemStudy:
    """Numbers of a system over its parameters.

    Args:
        system: System of bodies.
        axes: Values of each parameter ("pin.mass", see `System.parameters`) that varies: a list,
            or even steps: ``{"lin": ["1 g", "5 g"], "count": 9}``, or even ratios: ``"log"``.
        outputs: Names of `SystemMotion.numbers`, as "body.pin.end"; None: all.
        duration: s; None: each motion until its ending is known.

    Raises:
        ValueError: A parameter is unknown, or a value out of range.

    Examples:
        >>> import pindrive as pd
        >>> system = pd.System()
        >>> box = system.body("box", "1 kg", velocity="2 m/s")
        >>> floor = system.contact(box, kinetic="4 N")
        >>> study = pd.SystemStudy(system, {"kinetic": ["2 N", "4 N"]}, ["box.end"])
        >>> study.run()["body.box.end"].values
        array([1. , 0.5])
    """

    def __init__(
        self,
        system: System,
        axes: Mapping[str, Any],
        outputs: Iterable[str] | None = None,
        *,
        duration: float | str | None = None,
    ) -> None:
        if not isinstance(system, System):
            raise ValueError(refusal("system", "a System", repr(system)))
        self.system = system.with_values({})
        self.duration = None if duration is None else check("duration", duration)
        read = as_read(axes, "axes")
        if not read:
            required = 'a mapping with a parameter, like {"pin.mass": ["1 g", "2 g"]}'
            raise ValueError(refusal("axes", required, repr(axes)))
        self.axes = {
            key: self._axis(key, spec)
            for key, spec in ((system.key_of(given), spec) for given, spec in read.items())
        }
        self._given = None if outputs is None else [*outputs]

    def __repr__(self) -> str:
        """Return the number of points and the axes in a line."""
        sizes = ", ".join(f"{key} {len(values)}" for key, values in self.axes.items())
        return f"<SystemStudy of {counted(self.size, 'point')}: {sizes}>"

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(values) for values in self.axes.values())

    @property
    def size(self) -> int:
        """Number of points."""
        return prod(self.shape)

    def run(
        self,
        *,
        threads: int | None = None,
        progress: Callable[[int, int], None] = lambda done, total: None,
    ) -> xr.Dataset:
        """Simulate every point.

        Args:
            threads: Number of threads; None: all cores.
            progress: Function called with the points done and the points in all.

        Returns:
            A dimension for each axis with its values, a variable for each output, `status`, and
            `reason`, which says why a point has no numbers. Numbers that a motion lacks are NaN.

        Raises:
            ValueError: An output is unknown, or no point can be simulated.
        """
        grids = np.meshgrid(*self.axes.values(), indexing="ij")
        columns = dict(zip(self.axes, (grid.ravel() for grid in grids), strict=True))
        points = [{key: float(c[i]) for key, c in columns.items()} for i in range(self.size)]
        count = worker_count(threads)
        portion = max(1, min(16, -(-self.size // (2 * count))))
        portions = [points[i : i + portion] for i in range(0, self.size, portion)]
        done: list[dict[str, Any]] = []
        group = 4 * count  # portions between two reports of the progress
        for first in range(0, len(portions), group):
            found = spread(_rows, self, portions[first : first + group], count)
            done += [row for rows in found for row in rows]
            progress(len(done), self.size)
        return self._dataset(done)

    def _dataset(self, rows: list[dict[str, Any]]) -> xr.Dataset:
        dims = (*self.axes,)
        known = {name: () for row in rows for name in row["numbers"]}
        if not known:
            raise ValueError(f"no point can be simulated: {rows[0]['reason']}")
        names = Names("output", known)
        outputs = [*known] if self._given is None else [names.find(n, "") for n in self._given]
        data: dict[str, Any] = {}
        for name in outputs:
            values = np.array([row["numbers"].get(name, nan) for row in rows])
            data[name] = (dims, values.reshape(self.shape), number_of(name).attributes)
        status = np.array([row["status"] for row in rows], np.int8).reshape(self.shape)
        data["status"] = (dims, status, outcome_attributes("status"))
        reasons = np.array([row["reason"] for row in rows], dtype=str).reshape(self.shape)
        data["reason"] = (dims, reasons)
        coords = {
            key: ((key,), values, quantity_of(key).attributes) for key, values in self.axes.items()
        }
        return xr.Dataset(data, coords=coords, attrs={"title": "Study of a system of bodies"})

    def _axis(self, key: str, spec: object) -> NDArray[np.float64]:
        """Values of an axis, SI."""
        label = f"axes.{key}"
        if isinstance(spec, list) and spec:
            return Listed(tuple(self._value(key, x) for x in spec)).at(np.arange(len(spec)))
        kinds = [kind for kind in _STEPS if isinstance(spec, dict) and kind in spec]
        required = 'a list of values, or even steps like {"lin": [first, last], "count": 9}'
        if not isinstance(spec, dict) or len(kinds) != 1 or {*spec} != {kinds[0], "count"}:
            raise ValueError(refusal(label, required, quoted(spec)))
        ends, count = spec[kinds[0]], spec["count"]
        if not isinstance(ends, list) or len(ends) != 2 or not isinstance(count, int) or count < 2:
            raise ValueError(refusal(label, required, quoted(spec)))
        low, high = (self._value(key, end) for end in ends)
        if kinds[0] == "log" and not min(low, high) > 0.0:
            raise ValueError(refusal(f"{label}.log", "two values greater than 0", quoted(ends)))
        return Even(low, high, count, kinds[0] == "log").at(np.arange(count))

    def _value(self, key: str, given: Any) -> float:
        return float(self.system.with_values({key: given}).inputs()[key])


def _rows(study: SystemStudy, points: list[dict[str, float]]) -> list[dict[str, Any]]:
    return [_row(study, point) for point in points]


def _row(study: SystemStudy, point: Mapping[str, float]) -> dict[str, Any]:
    """Numbers at a point; one without a motion has a status and no numbers."""
    try:
        motion = study.system.with_values(point).simulate(study.duration)
    except ValueError as error:
        return {"numbers": {}, "status": Status.refused, "reason": message_of(error)}
    followed = motion.status == Status.ok
    numbers = motion.numbers() if followed else {}
    words = "" if followed else motion.status.explanation
    return {"numbers": numbers, "status": motion.status, "reason": words}

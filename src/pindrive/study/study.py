"""`Study`: a device with varied keys, from a study file or from Python."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from pindrive.device.page_description import Page
from pindrive.files.device import DeviceFile
from pindrive.lazy import xr
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.study.axes import as_read
from pindrive.study.design import Plan
from pindrive.study.runner import Work, on_cluster, on_threads, sweep
from pindrive.study.spec import plan_of, read_study

_PLACE: Final = "Study"
"""Place of Python values in messages."""


class Study(Plan):
    """Device with varied keys; every point is a release, or a scan of a page.

    Args:
        device: as `load_device` reads it.
        axes: what varies, by key: "plate.kinetic", "plate_kinetic" as in Python, or the part after
            the dot where no other key has it ("latency"). A value is a sequence of values, or a
            mapping with one way to choose them: `lin` or `log` with two ends and `count`; `uniform`
            or `loguniform` with two ends; `normal` with mean and deviation; `lognormal` with median
            and factor; `times` and `of`, a multiple of another key. A number is SI, text has a
            unit.
        outputs: the numbers to keep, as "settling_time"; the usual ones unless given.
        page: what is scanned at every point, a `Page` or text; None: every point is a release.
        sample: how sampled axes are drawn: `count`, `method` ("random" or "sobol"), `seed`.
        tolerances: as `axes`, each a distribution, or text: "20 %" about the device's own value.
        specification: limits on outputs, as {"settling_time": "<= 60 ms"}.
        zip: groups of keys whose values go together.
        name: for titles.

    Raises:
        ValueError: a key or an output is unknown, or a value malformed, out of its bounds or in
            contradiction to others; each in a line.

    Examples:
        >>> import pindrive as pd
        >>> device = pd.load_device("tactile-mouse.toml")
        >>> study = pd.Study(
        ...     device,
        ...     axes={"mouse_velocity": [0.05, "100 mm/s"], "plate.kinetic": {
        ...         "lin": [0.01, 0.03], "count": 3}},
        ...     outputs=["settling_time"],
        ... )
        >>> study
        <Study 'tactile mouse' of 6 points: mouse_velocity 2, plate_kinetic 3>
        >>> data = study.run()
        >>> data.transient_settling_time.dims
        ('mouse_velocity', 'plate_kinetic')
    """

    __slots__ = ()

    def __init__(
        self,
        device: DeviceFile,
        axes: Mapping[str, Any] | None = None,
        outputs: Iterable[str] | None = None,
        *,
        page: Page | str | None = None,
        sample: Mapping[str, Any] | None = None,
        tolerances: Mapping[str, Any] | None = None,
        specification: Mapping[str, Any] | None = None,
        zip: Iterable[Iterable[str]] | None = None,
        name: str = "",
    ) -> None:
        if not isinstance(device, DeviceFile):
            raise ValueError(refusal("device", "what load_device reads", repr(device)))
        tables: dict[str, Any] = {
            "name": name or None,
            "axes": as_read(axes, "axes"),
            "tolerances": as_read(tolerances, "tolerances"),
            "outputs": None if outputs is None else list(outputs),
            "sample": None if sample is None else dict(sample),
            "specification": None if specification is None else dict(specification),
            "zip": None if zip is None else [list(group) for group in zip],
        }
        tables = {key: value for key, value in tables.items() if value is not None}
        whole = Page(text=page) if isinstance(page, str) else page
        if whole is not None:
            whole.check("page.{}")
            tables["page"] = whole
        text = json.dumps(tables, indent=1, ensure_ascii=False, default=repr)
        self._take(plan_of(tables, device, path=device.path, place=_PLACE, text=text, si=True))

    def _take(self, plan: Plan) -> None:
        """Become the study that a plan says."""
        Plan.__init__(self, **{field.name: getattr(plan, field.name) for field in fields(Plan)})

    def __repr__(self) -> str:
        """Return the number of points and the dimensions in a line."""
        sizes = ", ".join(f"{one.name} {one.size}" for one in self.dimensions)
        what = f"{counted(self.size, 'point')}: {sizes}" if sizes else "tolerances alone"
        return f"<Study{f' {self.name!r}' if self.name else ''} of {what}>"

    def run(
        self,
        path: str | PathLike[str] | None = None,
        *,
        resume: bool = False,
        force: bool = False,
        threads: int | None = None,
        cluster: str | None = None,
        progress: Callable[[int, int], None] = lambda done, total: None,
    ) -> xr.Dataset:
        """Simulate every point.

        Scans are shared out among processes: a script that sweeps them does so under
        `if __name__ == "__main__":`, as all that begin processes.

        Args:
            path: a NetCDF file that keeps the points; an interrupted run continues from it. None: a
                temporary file.
            resume: go on with an interrupted run of the same study.
            force: replace an interrupted run, or an earlier study.
            threads: how many work, at least 1; as many as there are cores unless given.
            cluster: the address of a Dask scheduler, whose workers do the work instead.
            progress: called with the points done and the points in all.

        Returns:
            A dimension for each axis (one, `sample`, for all that are drawn), the values of each
            key along it, a variable for each output, and `status` and `ending` as flags whose
            meaning their attributes say; NaN where a point has no such number. Units in the
            attributes. With `path` the numbers are read from the file when they are given.

        Raises:
            ValueError: nothing varies; or the file is there, or cannot be written.
        """
        if not self.dimensions:
            raise ValueError(f"{_PLACE}: has no axes; say what to vary in axes")
        if threads is not None and cluster is not None:
            raise ValueError("give threads or cluster, not both: workers have their own")
        work: Work = on_threads(threads) if cluster is None else on_cluster(cluster)
        if path is None:
            with TemporaryDirectory(prefix="pindrive-") as folder:
                target = Path(folder) / "study.nc"
                sweep(self, target, work=work, tell=progress)
                return xr.load_dataset(target, engine="h5netcdf")
        target = Path(path)
        done = sweep(self, target, resume=resume, force=force, work=work, tell=progress)
        return done.to_dataset()


def load_study(path: str | PathLike[str], overrides: Iterable[str] = ()) -> Study:
    """The study that a file describes.

    Args:
        path: a TOML file that names a device, or holds one, and says what to vary.
        overrides: "key=value" each, as for `load_device`; after those in its table [set].

    Returns:
        The study; `run` simulates its points.

    Raises:
        ConfigError: the file or its device cannot be read, or holds anything unknown, malformed,
            out of bounds or contradictory; a line for each problem.

    Examples:
        >>> import pindrive as pd
        >>> pd.load_study("tactile-mouse-study.toml").shape
        (146, 153, 3)
    """
    study = Study.__new__(Study)
    study._take(read_study(path, overrides))
    return study

"""`Study`: a device with varied keys, from a study file or from Python."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from math import prod
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pindrive.device.page_description import Page
from pindrive.files.device import DeviceFile
from pindrive.files.functions import plain
from pindrive.files.keys import has_part
from pindrive.files.overrides import ConfigError
from pindrive.lazy import xr
from pindrive.motion.drive import Drive
from pindrive.motion.release import Release
from pindrive.quantities import budgets
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import refusal
from pindrive.quantities.value import equal_by_value
from pindrive.study.axes import Source, as_read
from pindrive.study.design import CHUNK, SCANS, Columns, Dimension, StudyPage
from pindrive.study.distributions import Axis, Distribution, Linked, with_links
from pindrive.study.outputs import Constraint


@equal_by_value
@dataclass(frozen=True, slots=True, init=False, repr=False)
class Study:
    """Device with varied keys; every point is a release, or a scan of a page.

    The points are the product of the dimensions; the last dimension changes fastest.

    Args:
        device: Device as `load_device` reads it, or a `Drive`.
        axes: Varied values by key: "plate.kinetic", "plate_kinetic" as in Python, or the part after
            the dot where no other key has it ("latency"). A value is a sequence of values, or a
            mapping with one way to choose them: `lin` or `log` with two ends and `count`; `uniform`
            or `loguniform` with two ends; `normal` with mean and deviation; `lognormal` with median
            and factor; `times` and `of`, a multiple of another key. A number is SI, text has a
            unit.
        outputs: The numbers to keep, as "settling_time"; the usual ones unless given.
        release: Start and inputs of the motion of a `Drive`; a device file has its own.
        page: Page to scan at every point, a `Page` or text; None: every point is a release.
        sample: Sample of the drawn axes: `count`, `method` ("random" or "sobol"), `seed`.
        tolerances: Tolerances in the notation of `axes`, each a distribution, or text: "20 %" about
            the value of the device.
        specification: Limits on outputs, as {"settling_time": "<= 60 ms"}.
        zip: Groups of keys whose values go together.
        name: Name for titles.

    Raises:
        ValueError: A key or an output is unknown, or a value malformed, out of its bounds or in
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
        >>> pd.Study(device.drive, {"mass": ["8 g", "12 g"]}, release=device.release).shape
        (2,)
    """

    source: Source
    """Place of its tables: the study file, and the device file where it names one."""
    name: str
    device: DeviceFile
    dimensions: tuple[Dimension, ...]
    links: Mapping[str, Linked]
    outputs: tuple[str, ...]
    """Variables to keep, in the order of the file."""
    chunk: int
    tolerances: Mapping[str, Distribution]
    tolerance_links: Mapping[str, Linked]
    constraints: tuple[Constraint, ...]
    page: StudyPage | None
    """Scanned page of every point; None: every point is a release."""

    def __init__(
        self,
        device: DeviceFile | Drive,
        axes: Mapping[str, Any] | None = None,
        outputs: Iterable[str] | None = None,
        *,
        release: Release | None = None,
        page: Page | str | None = None,
        sample: Mapping[str, Any] | None = None,
        tolerances: Mapping[str, Any] | None = None,
        specification: Mapping[str, Any] | None = None,
        zip: Iterable[Iterable[str]] | None = None,
        name: str = "",
    ) -> None:
        from pindrive.study.tables import parts_of

        if isinstance(device, Drive) and isinstance(release, Release):
            device = DeviceFile.of(device, release)
        elif not isinstance(device, DeviceFile) or release is not None:
            required = "a DeviceFile, or a Drive with its release"
            raise ValueError(refusal("device", required, f"{device!r}, release={release!r}"))
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
        problems: list[str] = []
        source = Source(device.path, "Study", text, si=True)
        self._set(parts_of(tables, device, source, problems), problems)

    @classmethod
    def of_tables(
        cls,
        tables: Mapping[str, Any],
        device: DeviceFile,
        source: Source,
        problems: Iterable[str] = (),
    ) -> Study:
        """Read a study from the tables of a study file.

        Args:
            tables: Tables of the file; `page` is a `Page`, or None for a rejected page, and
                `conditions` are further axes, of a design problem (see `pindrive.optimisation`).
            device: Device with the keys to vary.
            source: Place of the tables.
            problems: Errors found before.

        Raises:
            ConfigError: An entry is unknown, malformed, out of bounds or contradictory.
        """
        from pindrive.study.tables import parts_of

        study, found = cls.__new__(cls), [*problems]
        study._set(parts_of(tables, device, source, found), found)
        return study

    def _set(self, parts: Mapping[str, Any], problems: list[str]) -> None:
        """Set all attributes; raise the errors found before and the contradictions."""
        from pindrive.study.validation import conflicts

        for name, value in parts.items():
            object.__setattr__(self, name, value)
        problems += self._too_much()
        problems += conflicts(self)
        if problems:
            raise ConfigError(list(dict.fromkeys(problems)))

    def _too_much(self) -> Iterator[str]:
        """Return the errors of a study beyond the budgets."""
        of = f"{self.size} points, {self.chunk} in each; a larger chunk makes fewer"
        for budget, count, words in (
            (budgets.CHUNKS, self.chunks, of),
            (budgets.CONSTRAINTS, len(self.constraints), ""),
        ):
            try:
                budget.check(count, words, where=str(self.path))
            except ValueError as error:
                yield str(error)

    @property
    def path(self) -> Path:
        """The file that it was read from; of a study from Python that of its device."""
        return self.source.path

    @property
    def inputs(self) -> tuple[Path, ...]:
        """The files that it was read from, or reads when it is computed."""
        page = self.page.page.files.values() if self.page else ()
        return (self.path, *self.device.inputs, *page)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each dimension."""
        return tuple(dimension.size for dimension in self.dimensions)

    @property
    def size(self) -> int:
        """Number of points."""
        return prod(self.shape)

    @property
    def chunks(self) -> int:
        """Number of chunks."""
        return -(-self.size // self.chunk)

    def bounds(self, chunk: int) -> tuple[int, int]:
        """The first point of a chunk, and the first of the next."""
        return chunk * self.chunk, min((chunk + 1) * self.chunk, self.size)

    def first_seen(self, chunk: int) -> Iterator[tuple[Dimension, int, int]]:
        """For each dimension, the places along it that no point of an earlier chunk has."""
        ends = self.bounds(chunk)
        for i, dimension in enumerate(self.dimensions):
            stride = prod(self.shape[i + 1 :])
            first, last = (min(-(-point // stride), dimension.size) for point in ends)
            if first < last:
                yield dimension, first, last

    @property
    def at_a_time(self) -> int:
        """Number of points between two reports of the progress."""
        return 16 * SCANS if self.page else CHUNK

    @property
    def values(self) -> dict[str, Any]:
        """The device's value of each key that has a part in this study, SI; None: not given."""
        derived = self.device.derived
        return {
            key: value
            for key, value in self.device.values().items()
            if has_part(key, self.page is not None) and key not in derived
        }

    @property
    def axes(self) -> dict[str, Axis]:
        """Every swept key with its values; dependent keys come last."""
        found: dict[str, Axis] = {}
        for dimension in self.dimensions:
            found.update(dimension.axes)
        return found | dict(self.links)

    def columns(self, begin: int, end: int) -> Columns:
        """The value of every swept key at the points from `begin` up to `end`."""
        places = np.unravel_index(np.arange(begin, end), self.shape)
        found: Columns = {}
        for dimension, index in zip(self.dimensions, places, strict=True):
            found |= dimension.at(index)
        return with_links(self.device, found, self.links)

    def device_at(self, at: Mapping[str, float]) -> DeviceFile:
        """Return the device at a point with these values of the keys, SI.

        Raises:
            ConfigError: The values contradict each other.
        """
        return self.device.with_values(at, whole=self.page is not None)

    def identity(self) -> dict[str, Any]:
        """All that its numbers follow from: two studies with one identity have one answer."""
        from pindrive import __version__

        page = {"page": self.page.identity()} if self.page else {}
        found: dict[str, Any] = json.loads(
            json.dumps(
                {
                    "pindrive": __version__,
                    "device": {key: plain(value) for key, value in self.values.items()},
                    **page,
                    "dimensions": [asdict(dimension) for dimension in self.dimensions],
                    "links": {key: asdict(link) for key, link in self.links.items()},
                    "outputs": self.outputs,
                    "chunk": self.chunk,
                }
            )
        )
        return found

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

        Args:
            path: A NetCDF file that keeps the points; an interrupted run continues from it. None: a
                temporary file.
            resume: Go on with an interrupted run of the same study.
            force: Replace an interrupted run, or an earlier study.
            threads: Number of workers, at least 1; None: all cores.
            cluster: The address of a Dask scheduler, whose workers do the work instead.
            progress: Function called with the points done and the points in all.

        Returns:
            A dimension for each axis (one, `sample`, for all that are drawn), the values of each
            key along it, a variable for each output, and `status` and `ending` as flags whose
            meaning their attributes say; NaN where a point has no such number. Units in the
            attributes. With `path` the numbers are read from the file when they are given.

        Raises:
            ValueError: Nothing varies; or the file exists, or cannot be written.
        """
        from pindrive.study.runner import on_cluster, on_threads, sweep

        if not self.dimensions:
            raise ValueError(f"{self.source.place}: has no axes; say what to vary in axes")
        if threads is not None and cluster is not None:
            raise ValueError("give threads or cluster, not both: workers have their own")
        work = on_threads(threads) if cluster is None else on_cluster(cluster)
        if path is None:
            with TemporaryDirectory(prefix="pindrive-") as folder:
                target = Path(folder) / "study.nc"
                sweep(self, target, work=work, progress=progress)
                return xr.load_dataset(target, engine="h5netcdf")
        target = Path(path)
        done = sweep(self, target, resume=resume, force=force, work=work, progress=progress)
        return done.to_dataset()

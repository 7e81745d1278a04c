"""Reader of the tables of a study: axes, tolerances, outputs, specification and sample.

All errors of the tables are collected, each in a line with place, key, value and bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from pindrive.device.page_description import Page
from pindrive.files.device import DeviceFile, device_of, read_tables
from pindrive.files.functions import check_parameter
from pindrive.files.keys import NAMES, TABLES, is_file, variable
from pindrive.files.overrides import ConfigError, Setting, settings_of
from pindrive.quantities import budgets
from pindrive.quantities.refusal import quoted, refusal
from pindrive.study.axes import AxisReader, Source, sweepable, written_axes
from pindrive.study.design import CHUNK, SCANS, Dimension, StudyPage, read_page
from pindrive.study.distributions import (
    MOST_SOBOL,
    Axis,
    Distribution,
    Grid,
    Linked,
    Sample,
    base_value,
    implied_links,
)
from pindrive.study.outputs import (
    OUTPUTS,
    SCAN_OUTPUTS,
    Constraint,
    constraints,
    known_output,
    usual_outputs,
)

_SAMPLE: Final = ("method", "count", "seed")


def parts_of(
    tables: Mapping[str, Any],
    device: DeviceFile,
    source: Source,
    problems: list[str],
) -> dict[str, Any]:
    """Return the attributes of a study from its tables; errors are appended to `problems`.

    Arguments as for `Study.of_tables`.
    """
    page = None
    if isinstance(tables.get("page"), Page):
        page = _gathered(tables["page"], source.place, problems)
        device = device.with_whole()
    reader = _Reader(source, tables, device, problems)
    required = constraints(reader.table("specification"), source.place, problems, reader.among)
    return {
        "source": source,
        "name": reader.text("name") or device.name,
        "device": device,
        "dimensions": reader.dimensions,
        "links": reader.links,
        "outputs": _with_required(reader.outputs(), required),
        "chunk": reader.chunk(),
        "tolerances": reader.tolerances,
        "tolerance_links": reader.tolerance_links,
        "constraints": required,
        "page": page,
    }


def device_in(
    tables: dict[str, Any], file: Path, overrides: Iterable[str], problems: list[str]
) -> tuple[DeviceFile, str]:
    """The device of a study file, and the text of all that describes it.

    The entry `page` of `tables` becomes a `Page`; what is wrong with it is appended to `problems`.

    Raises:
        ConfigError: There is no device, or it cannot be read.
    """
    if "page" in tables:
        tables["page"] = _page(tables["page"], file, problems)
    return _device(tables, file, overrides)


def _page(table: Any, file: Path, problems: list[str]) -> Page | None:
    """The page of a table [page]; what is wrong with it is appended to `problems`."""
    try:
        return read_page(table, file)
    except ValueError as error:
        problems.append(str(error))
        return None


def _device(
    tables: Mapping[str, Any], file: Path, overrides: Iterable[str]
) -> tuple[DeviceFile, str]:
    """The device, and the text of all that describes it."""
    settings, problems = settings_of(overrides)
    text = file.read_text("utf-8-sig")
    given, source = {k: v for k, v in tables.items() if k in TABLES}, file
    if "base" in tables:
        if not isinstance(tables["base"], str):
            required = "the path of a device file in quotes"
            raise ConfigError([refusal("base", required, quoted(tables["base"]), str(file))])
        source = file.parent / tables["base"]
        given = read_tables(source)
        text = f"{text.rstrip()}\n\n# ---- {tables['base']} ----\n\n{source.read_text('utf-8-sig')}"
    elif not given:
        raise ConfigError([f'{file}: has no device; write base = "device.toml" at the top'])
    if settings:
        said = "\n".join(f"# set {setting.key} = {setting.value}" for setting in settings)
        text = f"{text.rstrip()}\n\n{said}\n"
    device = device_of(
        source,
        given,
        [*_settings(tables, file), *settings],
        whole="page" in tables,
        problems=problems,
    )
    return device, text


def _settings(tables: Mapping[str, Any], file: Path) -> list[Setting]:
    """Return the settings of the table [set]."""
    given = tables.get("set", {})
    if not isinstance(given, dict):
        raise ConfigError([refusal("set", "a table, [set]", quoted(given), str(file))])
    settings = []
    inner = {name: t for name, t in given.items() if name in TABLES and isinstance(t, dict)}
    full = {f"{name}.{key}": value for name, t in inner.items() for key, value in t.items()}
    for key, value in ({k: v for k, v in given.items() if k not in inner} | full).items():
        keys = NAMES.matches(key)
        if len(keys) == 1 and is_file(keys[0], value):
            value = str((file.parent / value).absolute())
        settings.append(Setting(key, value, f"{file}: set"))
    return settings


def _with_required(outputs: Sequence[str], required: Iterable[Constraint]) -> tuple[str, ...]:
    """Return the stored variables and the variables of the specification."""
    added = dict.fromkeys(
        constraint.name for constraint in required if constraint.name not in outputs
    )
    kept = [name for name in outputs if name != "status"]
    return (*kept, *added, "status") if added else tuple(outputs)


def _gathered(page: Page, place: str, problems: list[str]) -> StudyPage | None:
    """A page with what its files hold; what is wrong with it is appended to `problems`."""
    try:
        return StudyPage.of(page, place)
    except ValueError as error:
        problems.append(str(error))
        return None


class _Reader:
    """Reads the tables of one study file; what is wrong is appended to `problems`."""

    def __init__(
        self,
        source: Source,
        tables: Mapping[str, Any],
        device: DeviceFile,
        problems: list[str],
    ) -> None:
        self._source, self._file, self._tables = source, source.place, tables
        self._device, self._problems, self._scans = device, problems, "page" in tables
        self.among = SCAN_OUTPUTS if self._scans else OUTPUTS
        axes = self._axes("axes") | self._axes("conditions")
        self.links = self._links(axes)
        tolerances = self._axes("tolerances")
        self.tolerance_links = self._links(tolerances)
        self.tolerances = {
            k: axis for k, axis in tolerances.items() if isinstance(axis, Distribution)
        }
        self._swept = axes.keys() | tolerances.keys()
        self.dimensions = self._dimensions(axes)

    def table(self, name: str) -> dict[str, Any]:
        """Return a table of the file; empty for a missing table."""
        given = self._tables.get(name, {})
        if isinstance(given, dict):
            return given
        self._problems.append(refusal(name, f"a table, [{name}]", quoted(given), self._file))
        return {}

    def text(self, name: str) -> str:
        """Text, empty where it is missing."""
        given = self._tables.get(name, "")
        if isinstance(given, str):
            return given
        self._problems.append(refusal(name, "text in quotes", quoted(given), self._file))
        return ""

    def whole(self, name: str, default: int, most: int, least: int = 1) -> int:
        """A whole number at the top or, as "sample.count", in a table."""
        table, _, key = name.rpartition(".")
        given = (self.table(table) if table else self._tables).get(key, default)
        if type(given) is int and least <= given <= most:
            return given
        required = f"a whole number from {least} to {most}"
        self._problems.append(refusal(name, required, quoted(given), self._file))
        return max(least, min(default, most))

    def chunk(self) -> int:
        """Points that are computed together."""
        most = budgets.CHUNK_OF_SCANS if self._scans else budgets.CHUNK
        return self.whole("chunk", SCANS if self._scans else CHUNK, most.most)

    def outputs(self) -> tuple[str, ...]:
        """The variables to keep, each once, with the status of every point."""
        given = self._tables.get("outputs")
        if given is None:
            rigid = self._device.drive.finger.rigid and "finger.stiffness" not in self._swept
            whole = self._device.whole
            coil = whole is not None and whole.magnet().coil is not None
            hand = whole is not None and whole.hand() is not None
            hand = hand or any(key.startswith("hand.") for key in self._swept)
            return usual_outputs(self.among, rigid=rigid, coil=coil, hand=hand)
        if not isinstance(given, list) or not given:
            required = 'a list of numbers, like ["settling_time", "swing"]'
            self._problems.append(refusal("outputs", required, quoted(given), self._file))
            return ("status",)
        found = []
        for name in given:
            try:
                found.append(known_output(name, f"{self._file}: outputs", self.among))
            except ValueError as error:
                self._problems.append(str(error))
        return tuple(dict.fromkeys((*found, "status")))

    def _links(self, axes: Mapping[str, Axis]) -> dict[str, Linked]:
        """Return the linked keys: the written links, and keys that keep their ratio."""
        written = {key: axis for key, axis in axes.items() if isinstance(axis, Linked)}
        return written | implied_links(self._device, axes.keys(), self._scans)

    # ---- axes ------------------------------------------------------------------------------------

    def _axes(self, table: str) -> dict[str, Axis]:
        found: dict[str, Axis] = {}
        names: dict[str, str] = {}
        for given, spec in written_axes(self.table(table)):
            try:
                key = sweepable(given, f"{self._file}: {table}", self._scans)
                if key in names:
                    raise ValueError(
                        f"{self._file}: {table}.{key} is given twice, as {names[key]} and {given}"
                    )
                names[key] = given
                check_parameter(self._device.release, key, f"{self._file}: {table}")
                base = base_value(self._device, key)
                number = base if isinstance(base, float) else None
                reader = AxisReader(self._source, table, key, number, scans=self._scans)
                found[key] = reader.read(spec)
            except ValueError as error:
                self._problems.append(str(error))
        return found

    def _dimensions(self, axes: Mapping[str, Axis]) -> tuple[Dimension, ...]:
        grids = {k: v for k, v in axes.items() if not isinstance(v, Distribution | Linked)}
        drawn = {k: v for k, v in axes.items() if isinstance(v, Distribution)}
        groups = self._zips(grids)
        dimensions: list[Dimension] = []
        done: set[str] = set()
        for key in axes:
            if key in drawn and "sample" not in done:
                done.add("sample")
                sample = self._sample(tuple(drawn))
                dimensions.append(Dimension("sample", sample.count, drawn, sample))
            elif key in grids and key not in done:
                group = next((g for g in groups if key in g), (key,))
                done |= {*group}
                own: dict[str, Grid] = {name: grids[name] for name in group}
                dimensions.append(Dimension(variable(group[0]), grids[key].count, own))
        if not drawn:
            for name in self.table("sample"):
                self._check_sample_key(name)
        return tuple(dimensions)

    def _zips(self, grids: Mapping[str, Grid]) -> list[tuple[str, ...]]:
        """The groups of keys that go together."""
        given = self._tables.get("zip", [])
        if not isinstance(given, list) or not all(isinstance(group, list) for group in given):
            required = 'a list of groups, like [["drive.mass", "drive.stiffness"]]'
            self._problems.append(refusal("zip", required, quoted(given), self._file))
            return []
        groups: list[tuple[str, ...]] = []
        for group in given:
            try:
                groups.append(self._zipped(group, grids, [key for g in groups for key in g]))
            except ValueError as error:
                self._problems.append(str(error))
        return groups

    def _zipped(
        self, group: Sequence[object], grids: Mapping[str, Grid], taken: Sequence[str]
    ) -> tuple[str, ...]:
        place = f"{self._file}: zip"
        keys = []
        for name in group:
            key = sweepable(str(name), place, self._scans)
            if key not in grids:
                raise ValueError(f"{place}: {key} is no axis of a list or of even steps")
            if key in taken or key in keys:
                raise ValueError(f"{place}: {key} is named twice")
            keys.append(key)
        if len(keys) < 2:
            raise ValueError(refusal("a group", "two keys or more", quoted(list(group)), place))
        if len({grids[key].count for key in keys}) > 1:
            lengths = ", ".join(f"{key} has {grids[key].count}" for key in keys)
            raise ValueError(f"{place}: axes that go together must be of one length; {lengths}")
        return tuple(keys)

    def _sample(self, keys: tuple[str, ...]) -> Sample:
        table = self.table("sample")
        for name in table:
            self._check_sample_key(name)
        method = table.get("method", "random")
        if method not in ("random", "sobol"):
            required = '"random" or "sobol"'
            self._problems.append(refusal("sample.method", required, quoted(method), self._file))
            method = "random"
        if "count" not in table:
            drawn = ", ".join(keys)
            self._problems.append(
                f"{self._file}: sample.count is missing for {drawn}; write count = 1024 in [sample]"
            )
        most = MOST_SOBOL if method == "sobol" else budgets.AXIS.most
        count = self.whole("sample.count", 1024, most)
        return Sample(keys, count, self.whole("sample.seed", 1, 2**63 - 1, 0), method)

    def _check_sample_key(self, name: str) -> None:
        if name not in _SAMPLE:
            self._problems.append(
                f"{self._file}: unknown key sample.{name}; there are {', '.join(_SAMPLE)}"
            )

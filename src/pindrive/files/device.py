"""Device files: TOML with units, read into a validated drive and the start of its motion.

Whatever is wrong is found in one pass and said in lines that name file, key, value and bound.
"""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Container, Iterable, Mapping
from dataclasses import dataclass
from math import inf
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from pindrive.device.controller import ControlBlock
from pindrive.device.device import Criteria, Device
from pindrive.device.reading import Reading
from pindrive.files.keys import (
    ALONE,
    AROUND,
    DRIVE,
    KEYS,
    NAMES,
    NUMERIC_KEYS,
    PARAMETERS,
    STUDY_KEYS,
    TABLES,
    Given,
    Tables,
    Value,
    names_in_file,
    unknown_in_file,
    written,
)
from pindrive.files.overrides import ConfigError, Setting, set_in_tables, settings_of
from pindrive.files.ratios import GivenValues, with_set
from pindrive.files.recording import files_named, recording_words, with_files_read
from pindrive.files.schema import (
    Place,
    Whole,
    complete,
    drive_of,
    over_time,
    read_given,
    release_of,
    table_of,
)
from pindrive.motion.drive import Contact, Drive, law_values
from pindrive.motion.friction import COEFFICIENTS
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import LOADS, Release, negative_load
from pindrive.quantities.contradictions import problems_of
from pindrive.quantities.drive import SUPPORTS
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.table import warn_of
from pindrive.quantities.value import equal_by_value


@equal_by_value
@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceFile:
    """A device file as `load_device` reads it, in SI units.

    The file holds the drive and the start of its motion, which `simulate` takes. `whole` is the
    table of the whole device and of the hand that reads with it, or `None` where the file has
    none and none was requested.
    """

    path: Path
    name: str
    description: str
    drive: Drive
    release: Release
    duration: float | None
    settling_band: float
    given: GivenValues
    """Value of each key that the file gives, SI, with the values that were set otherwise."""
    tables: Mapping[str, Any]
    """The same as the file has them: text with units, and the names of CSV files."""
    settings: tuple[Setting, ...] = ()
    """The values that were set otherwise."""
    whole: Whole | None = None

    @property
    def by_ratio(self) -> bool:
        """True if the damping is given as a ratio, which then holds for any mass and stiffness."""
        return "drive.damping_ratio" in self.given

    @property
    def derived(self) -> tuple[str, ...]:
        """Keys whose values follow from other keys of the file."""
        return _derived(self.drive, by_ratio=self.by_ratio)

    @property
    def followed(self) -> tuple[str, ...]:
        """The keys that are not given as they are.

        `derived` ones, static friction that is the kinetic one, and what keeps its ratio to a value
        that was set otherwise.
        """
        given = {key for setting in self.settings for key in NAMES.matches(setting.key)}
        moved, found = {*given}, {*self.derived}
        for key, quantity in DRIVE.items():
            if key not in given and moved.intersection(quantity.follows):
                moved.add(key)
                found.add(key)
        for table, contact in (("plate", self.drive.plate), ("finger", self.drive.finger)):
            if contact.static is None:
                found.add(f"{table}.static")
        return tuple(key for key in DRIVE if key in found)

    def __repr__(self) -> str:
        """Return the file and its content in a line."""
        pins = f", {counted(len(self.whole.array()), 'pin')}" if self.whole else ""
        name = f" {quoted(self.name)}" if self.name else ""
        return f"<DeviceFile {self.path}{name}: {self.drive.mass:g} kg{pins}>"

    @property
    def device(self) -> Device:
        """The whole device, with the usual values of what the file does not say.

        Raises:
            ConfigError: No magnet can hold by the plate of this drive.
        """
        whole = self._whole
        control = ControlBlock(**table_of(whole.values, "control"))
        return Device(
            drive=self.drive,
            magnet=whole.magnet(),
            control=control,
            array=whole.array(),
            hand=whole.hand(),
        )

    @property
    def reading(self) -> Reading:
        """Reading hand of the device."""
        given = table_of(self._whole.values, "scan")
        del given["touch"]
        return Reading(**given)

    @property
    def touch(self) -> float | Profile | None:
        """Touch force over the time of a scan, N; None: that of the drive."""
        value = over_time(self._whole.values["scan.touch"])
        assert not isinstance(value, Function)  # read_function refuses it
        return value

    @property
    def criteria(self) -> Criteria:
        """Criteria of the evaluation."""
        return Criteria(**table_of(self._whole.values, "criteria"))

    @property
    def inputs(self) -> tuple[Path, ...]:
        """The files that it was read from."""
        return self.path, *files_named(self.tables, self.path.parent).values()

    @property
    def recording_words(self) -> str:
        """Description of the recording of the mouse velocity, with smoothing; "" without one."""
        return recording_words(self.tables, self.path.parent)

    def with_whole(self) -> DeviceFile:
        """Return the file with `whole`, also for a file without that table."""
        return self if self.whole else _assembled(self, self.given, self.tables, whole=True)

    def with_values(self, values: Mapping[str, Given], *, whole: bool = False) -> DeviceFile:
        """Return the file with some values set otherwise.

        Values that follow them keep their ratio, as in `load_device`.

        Args:
            values: Value of each key in full ("plate.kinetic"), SI.
            whole: True for the whole device, also of a file without its tables.

        Raises:
            ConfigError: The values contradict each other or the values of the file.
        """
        changed = {
            k: v if isinstance(v, (tuple, Function)) else float(v) for k, v in values.items()
        }
        try:
            given = with_set(self.given, changed)
        except ValueError as error:
            raise ConfigError([f"{self.path}: {error}"]) from None
        tables = {name: dict(table) for name, table in self.tables.items()}
        for key in self.given.keys() | given.keys():
            if key not in given:
                table, _, name = key.partition(".")
                del tables[table][name]
            elif key not in self.given or given[key] != self.given[key]:
                _write(tables, key, given[key])
        settings = [Setting(key, written(key, value), "") for key, value in changed.items()]
        return _assembled(self, given, tables, settings, whole=whole or self.whole is not None)

    @property
    def _whole(self) -> Whole:
        whole = self.whole or self.with_whole().whole
        assert whole
        return whole

    @classmethod
    def of(cls, drive: Drive, release: Release, *, name: str = "") -> DeviceFile:
        """Return the device of a drive and its release, as a file would describe it.

        Args:
            drive: Drive.
            release: Start and inputs of its motion.
            name: Name for titles.
        """
        derived = _derived(drive, by_ratio=False)
        values = _values_of(drive, release).items()
        given = {
            key: v
            for key, v in values
            if v is not None and key not in derived and key not in PARAMETERS
        }
        tables: dict[str, dict[str, Any]] = {table: {} for table in TABLES}
        for key, value in given.items():
            _write(tables, key, value)
        return _assembled(_Source(Path("<drive>"), name, ""), given, tables, whole=False)

    def values(self) -> dict[str, Value]:
        """The value of every key that holds a quantity, in SI; None where it was left out.

        Values over time or speed are rows, (speed, force) or (time, value), or a `Function`, whose
        parameters have keys of their own: "motion.mouse_velocity.amplitude".
        """
        return self.values_of_drive() | (self.whole.in_si() if self.whole else {})

    def values_of_drive(self) -> dict[str, Value]:
        """Return the values of the drive and its motion alone."""
        own = {"motion.duration": self.duration, "motion.settling_band": self.settling_band}
        return _values_of(self.drive, self.release) | own


def _derived(drive: Drive, *, by_ratio: bool) -> tuple[str, ...]:
    """Return the keys of a drive whose values follow from others."""
    contacts = {"plate": drive.plate, "finger": drive.finger}
    return (
        "drive.damping" if by_ratio else "drive.damping_ratio",
        *(
            f"{table}.{name}"
            for table, contact in contacts.items()
            if contact.coefficient is not None
            for name in COEFFICIENTS
        ),
    )


def _values_of(drive: Drive, release: Release) -> dict[str, Value]:
    """Return the value of every key of a drive and its release, SI; None for no value."""
    contacts = {"plate": drive.plate, "finger": drive.finger}
    found: dict[str, Value] = {}
    for key, quantity in DRIVE.items():
        table, _, name = key.partition(".")
        if name in ("duration", "settling_band"):
            continue
        of = release if table == "motion" else contacts[table] if quantity.name == key else drive
        law = isinstance(of, Contact) and name == "law"
        value = law_values(contacts[table])["law"] if law else getattr(of, name)
        if name == "support":
            value = float(SUPPORTS.index(value)) or None
        found[key] = value.rows if isinstance(value, Profile) else None if value == inf else value
        if isinstance(value, Function):
            found |= {f"{key}.{part}": number for part, number in value.parameters.items()}
    return found


def load_device(
    path: str | PathLike[str],
    overrides: Iterable[str] | Mapping[str, object] = (),
    *,
    whole: bool = False,
) -> DeviceFile:
    """The device that the file at `path` describes, with single values set otherwise.

    Args:
        path: A TOML file; `pindrive init FILE` writes one.
        overrides: "key=value" each, or a mapping of keys to values, in which a number is SI and
            text has a unit. A key is written as in device files (plate.kinetic=30 mN), as in Python
            (plate_kinetic=30 mN) or by the part after the dot where no other key has it
            (latency=5 ms), rows as TOML has them (plate_load=[["0 ms", 1], ...]) or a
            CSV of them (mouse_velocity=speed.csv); a path is relative to the current folder.
            Setting damping replaces damping_ratio, and vice versa. What `Quantity.follows` ties to
            a value that is set keeps its ratio to it unless it is set too: Static friction and the
            friction curve to kinetic friction, the skin's stretch to the largest that it can have.
        whole: The whole device is wanted at once, also of a file without a table of it; otherwise
            what such a file leaves out has its usual value where it is requested.

    Returns:
        The drive and its release in SI; `device`, `reading` and `criteria` are the whole device,
        how a hand reads with it and what counts as felt. `scan` and `Study` take it.

    Raises:
        ConfigError: The file cannot be read, or holds anything unknown, missing or out of bounds;
            a line for each problem, with file, key, value and bound. It is a ValueError.

    Examples:
        >>> import pindrive as pd
        >>> device = pd.load_device("tactile-mouse.toml", {"mass": "12 g", "plate.kinetic": 0.03})
        >>> device.drive.mass, device.drive.plate.kinetic
        (0.012, 0.03)
    """
    file = Path(path)
    settings, problems = settings_of(overrides)
    return device_of(file, read_tables(file), settings, whole=whole, problems=problems)


def device_of(
    file: Path,
    given: Mapping[str, Any],
    settings: Iterable[Setting] = (),
    *,
    whole: bool = False,
    problems: Iterable[str] = (),
) -> DeviceFile:
    """Return the device of the tables `given`, with values set otherwise in sequence.

    Args:
        file: File of the tables.
        given: Tables as TOML has them.
        settings: Values set otherwise.
        whole: True for the whole device, also without its tables.
        problems: Errors found before.

    Raises:
        ConfigError: The file or a value is invalid, as for `load_device`.
    """
    _refuse_study(file, given)
    settings = tuple(settings)
    tables = _with_all_tables(file, given)
    before, _, _ = _read(tables, file.parent, Places(file)) if settings else ({}, {}, [])
    places, found = set_in_tables(tables, settings)
    place = Places(file, places)
    values, malformed, unread = _read(tables, file.parent, place)
    if places:
        changed = {key: values[key] for key in places if key in values}
        kept = with_set({k: v for k, v in before.items() if k not in malformed}, changed)
        for key in kept.keys() - changed.keys():
            if key in values and kept[key] != before[key]:
                values[key] = kept[key]
                _write(tables, key, kept[key])
    unknown = _unknown_keys(tables)
    meant = {name for key in unknown for name in names_in_file(key).nearest(key)[:1]}
    said = [
        *problems,
        *found,
        *(f"{file}: {unknown_in_file(key)}" for key in unknown),
        *_damping_problems(tables["drive"], meant, place),
        *_text_problems(tables["device"], place),
        *unread,
    ]
    return _assembled(
        _Source(
            path=file,
            name=tables["device"].get("name", ""),
            description=tables["device"].get("description", ""),
        ),
        values,
        tables,
        settings,
        whole=whole,
        malformed=malformed,
        meant=meant,
        place=place,
        problems=said,
    )


def _write(tables: Mapping[str, dict[str, Any]], key: str, value: Given) -> None:
    """Write a value, SI, into the tables of a device file."""
    table, _, name = key.partition(".")
    tables[table][name] = written(key, value)


def _read(
    tables: Tables, folder: Path, place: Place
) -> tuple[dict[str, Given], dict[str, str], list[str]]:
    """Return the given values, SI, the malformed ones, and the errors of the CSV files."""
    read, unread = with_files_read({name: dict(tables[name]) for name in TABLES}, folder, place)
    given, malformed = read_given(read, place)
    return given, malformed, unread


class Places:
    """Places of keys in messages: where a value was set, otherwise the file."""

    def __init__(self, file: Path, places: Mapping[str, str] | None = None) -> None:
        self._file, self._places = file, places or {}

    def __call__(self, *keys: str) -> str:
        """Return the place of the first of the keys that was set, otherwise the file."""
        return next((self._places[key] for key in keys if key in self._places), str(self._file))


class _Source(NamedTuple):
    """File of a device, with the text that describes it."""

    path: Path
    name: str
    description: str


def _assembled(
    source: _Source | DeviceFile,
    given: GivenValues,
    tables: Mapping[str, Any],
    settings: Iterable[Setting] = (),
    *,
    whole: bool,
    malformed: Mapping[str, str] = MappingProxyType({}),
    meant: Collection[str | None] = (),
    place: Place | None = None,
    problems: Iterable[str] = (),
) -> DeviceFile:
    """Return the device of the values that are given, SI; raise all errors."""
    if place is None:
        place = Places(source.path, {setting.key: setting.place for setting in settings})
    whole = whole or any(tables[name] for name in AROUND)
    hand = whole and "mouse_velocity" not in tables["motion"]
    left_out = {"motion.mouse_velocity"} if hand else set()
    names = TABLES if whole else ALONE
    values, found = complete(given, malformed, names, place, {*meant, *left_out})
    if hand:  # a single release is at the hand's speed then
        values["motion.mouse_velocity"] = values.get("scan.hand_speed")
    known = {
        **{key: v(0.0) if isinstance(v, Function) else v for key, v in given.items()},
        **dict.fromkeys(malformed),
    }
    found += [problem.at(place) for problem in problems_of(known, whole=whole)]
    duration = given.get("motion.duration")
    end = duration if isinstance(duration, float) else None
    for key in (f"motion.{name}" for name in LOADS):
        refused = negative_load(key, given.get(key), end)
        found += [refused.at(place(key), key)] if refused else []
    if problems := [*problems, *found]:
        raise ConfigError(problems)
    try:
        drive = drive_of(values)
    except ValueError as error:  # each value is in range, but a derived value is not
        raise ConfigError([f"{source.path}: {error}"]) from None
    device = DeviceFile(
        path=source.path,
        name=source.name,
        description=source.description,
        drive=drive,
        release=release_of(values),
        duration=table_of(values, "motion")["duration"],
        settling_band=table_of(values, "motion")["settling_band"],
        given=given,
        tables=tables,
        settings=tuple(settings),
        whole=Whole(values) if whole else None,
    )
    _warn(device, place)
    return device


# ---- the file's text -----------------------------------------------------------------------------


def read_tables(file: Path, template: str = "`pindrive init FILE` writes a device file") -> Any:
    """Read a TOML file as a dictionary; for an empty one `template` tells the remedy.

    Raises:
        ConfigError: The file cannot be read, is empty, or is not TOML.
    """
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        with file.open("rb") as opened:
            netcdf = opened.read(4) == b"\x89HDF"
        words = (
            "is a NetCDF file; `pindrive map` draws one that a sweep wrote"
            if netcdf
            else f"is not UTF-8 text, at byte {error.start}"
        )
        raise ConfigError([f"{file}: {words}"]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConfigError([f"{file}: cannot be read: {reason}"]) from None
    if not text.strip():
        raise ConfigError([f"{file}: is empty; {template}"])
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        hint = "; a value with a unit stands in quotes" if "Expected newline" in str(error) else ""
        raise ConfigError([f"{file}: is not valid TOML: {error}{hint}"]) from None


def _refuse_study(file: Path, given: Mapping[str, Any]) -> None:
    if "recording" in given:
        raise ConfigError([f"{file}: is a fit file, as it has recordings; `pindrive fit` takes it"])
    if "body" in given:
        said = "is a system file, as it has [body]; `pindrive simulate` and `load_system` take it"
        raise ConfigError([f"{file}: {said}"])
    found = [key for key in STUDY_KEYS if key in given]
    if found:
        shown = [f"[{key}]" if isinstance(given[key], dict) else key for key in found[:2]]
        raise ConfigError(
            [
                f"{file}: is a study file, as it has {' and '.join(shown)}; `pindrive sweep`, "
                "`sensitivity` and `robustness` take it"
            ]
        )


def _with_all_tables(file: Path, given: Mapping[str, Any]) -> dict[str, Any]:
    """Its tables, free to be changed; empty where they are missing."""
    tables = {name: {} for name in TABLES} | {
        name: dict(table) if isinstance(table, dict) else table for name, table in given.items()
    }
    flat = [name for name in TABLES if not isinstance(tables[name], dict)]
    if flat:
        raise ConfigError(
            [
                f"{file}: {refusal(name, f'a table, [{name}]', quoted(tables[name]))}"
                for name in flat
            ]
        )
    return tables


def _unknown_keys(tables: Mapping[str, Any]) -> list[str]:
    unknown = [name for name in tables if name not in TABLES]
    full = [f"{table}.{name}" for table in TABLES for name in tables[table]]
    return unknown + [key for key in full if key not in KEYS]


# ---- its values ----------------------------------------------------------------------------------


def _damping_problems(
    drive: Mapping[str, Any], meant: Container[str | None], place: Place
) -> list[str]:
    keys = ("drive.damping", "drive.damping_ratio")
    given = [key for key in keys if key.partition(".")[2] in drive]
    if len(given) == 1 or (not given and any(key in meant for key in keys)):
        return []
    found = "both" if given else "neither"
    return [f"{place(*keys)}: give exactly one of {' and '.join(keys)}, got {found}"]


def _text_problems(given: Mapping[str, Any], place: Place) -> list[str]:
    """Return the entries of [device] that are not text."""
    keys = {f"device.{name}": given.get(name, "") for name in ("name", "description")}
    return [
        refusal(key, "text in quotes", quoted(value), place(key))
        for key, value in keys.items()
        if not isinstance(value, str)
    ]


def _warn(device: DeviceFile, place: Place) -> None:
    """Warn of values that no such device has, with the place where each was written."""
    for key, value in device.values_of_drive().items():
        if value is not None and not isinstance(value, Function):
            warn_of(NUMERIC_KEYS[key].name, value, label=f"{place(key)}: {key}", stacklevel=4)

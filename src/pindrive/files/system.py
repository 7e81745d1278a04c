"""System files: several bodies in TOML, every value with its unit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any, Final

from pindrive.bodies.inputs import Given
from pindrive.bodies.parts import GROUND
from pindrive.bodies.system import System
from pindrive.files.device import read_tables
from pindrive.files.keys import SUFFIX
from pindrive.files.overrides import ConfigError
from pindrive.motion.function import Function, of_parameters
from pindrive.motion.profile import Profile
from pindrive.quantities.bodies import KINDS
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.functions import FUNCTIONS
from pindrive.quantities.names import Names
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.results import SERIES
from pindrive.quantities.table import check
from pindrive.quantities.value import equal_by_value

_HEAD: Final = ("name", "duration")
"""Keys of the table [system]."""
_OWN: Final[dict[str, tuple[str, ...]]] = {
    "body": (),
    "spring": ("between",),
    "contact": ("between", "pressed_by"),
    "stop": ("between",),
    "feedback": ("between", "measured"),
}
"""Keys of each part that name other parts."""
_ORDER: Final = ("body", "spring", "stop", "contact", "feedback")
"""Order in which parts are read: a contact may name a stop that presses it."""
_EXAMPLE: Final = """[body.pin] with mass = "1 g\""""


@equal_by_value
@dataclass(frozen=True, slots=True, repr=False)
class SystemFile:
    """A system file as `load_system` reads it.

    Attributes:
        path: The file.
        name: Name of the system, empty without one.
        system: Bodies, springs and contacts.
        duration: s; None: until the ending of the motion is known.
        rows: CSV files of inputs that were read.
    """

    path: Path
    name: str
    system: System
    duration: float | None
    rows: tuple[Path, ...] = ()

    @property
    def inputs(self) -> tuple[Path, ...]:
        """Files that were read."""
        return (self.path, *self.rows)

    def __repr__(self) -> str:
        """Return file and system in a line."""
        return f"<SystemFile {self.path}: {self.system!r}>"


def is_system_file(path: str | PathLike[str]) -> bool:
    """True if a file can be read as TOML and has a table of bodies."""
    import tomllib

    try:
        tables = tomllib.loads(Path(path).read_text("utf-8-sig"))
    except (OSError, ValueError, RecursionError):
        return False
    return "body" in tables


def load_system(
    path: str | PathLike[str], overrides: Iterable[str] | Mapping[str, Any] = ()
) -> SystemFile:
    """Read a system of several bodies from a file.

    The file has a table for each part, [body.NAME], [spring.NAME] and [contact.NAME], with the
    arguments of `System.body`, `System.spring` and `System.contact`; `between` names both bodies of
    a spring or a contact, and a spring may have a `motion` in place of the second. An input is text
    with a unit, rows of times and values, the name of a CSV with such rows beside the file, or the
    parameters of a function. [system] may have a
    `name` and the `duration`.

    Args:
        path: The file.
        overrides: Values that are set otherwise: "body.pin.mass=2 g", or a mapping.

    Returns:
        The system, and the duration for `System.simulate`.

    Raises:
        ConfigError: The file cannot be read, or a value is unknown, missing or out of range; a line
            each.
    """
    file = Path(path)
    reader = _Reader(file, read_tables(file, "docs/bodies.md shows a system file"))
    reader.read()
    if reader.problems:
        raise ConfigError(reader.problems)
    system, duration = reader.system, reader.duration
    problems = []
    given = overrides.items() if isinstance(overrides, Mapping) else map(_split, overrides)
    for key, value in given:
        place = f"`overrides` {key}"
        try:
            if key in ("duration", "system.duration"):
                duration = check("duration", value)
            else:
                system = system.with_values({key: value})
        except ValueError as error:
            problems.append(f"{place}: {error}")
    if problems:
        raise ConfigError(problems)
    return SystemFile(file, reader.name, system, duration, tuple(reader.read_files))


def _split(override: str) -> tuple[str, str]:
    key, equals, value = (part.strip() for part in override.partition("="))
    if not equals or not key:
        raise ConfigError([f"`overrides` {quoted(override)}: must be key=value"])
    return key, value


class _Reader:
    """The tables of a file on their way into a system; `problems` has a line for each mistake."""

    def __init__(self, file: Path, tables: Mapping[str, Any]) -> None:
        self.file, self.tables = file, tables
        self.system, self.name = System(), ""
        self.duration: float | None = None
        self.read_files: list[Path] = []
        self.problems: list[str] = []

    def read(self) -> None:
        """Read all tables."""
        self._attempt(self._head)
        names = Names("table", {name: () for name in ("system", *KINDS)})
        for table in self.tables:
            if table not in ("system", *KINDS):
                self.problems.append(f"{self.file}: {names.unknown(table)}")
        if not self.tables.get("body"):
            self.problems.append(f"{self.file}: has no body; write {_EXAMPLE}")
        for kind in _ORDER:
            entries = self.tables.get(kind, {})
            if not isinstance(entries, dict) or not all(
                isinstance(entry, dict) for entry in entries.values()
            ):
                required = f"tables [{kind}.NAME]"
                self.problems.append(refusal(kind, required, quoted(entries), str(self.file)))
                continue
            for name, entry in entries.items():
                self._attempt(partial(self._add, kind, name, entry))
            if kind == "body" and self.problems:  # others would only repeat that a body is unknown
                return

    def _attempt(self, read: Callable[[], None]) -> None:
        try:
            read()
        except ConfigError as error:
            self.problems += error.problems
        except ValueError as error:
            self.problems.append(f"{self.file}: {error}")

    def _head(self) -> None:
        head = self.tables.get("system", {})
        if not isinstance(head, dict):
            raise ValueError(refusal("system", "a table", quoted(head)))
        for key in head:
            if key not in _HEAD:
                raise ValueError(Names("key of system", dict.fromkeys(_HEAD, ())).unknown(key))
        self.name = str(head.get("name", ""))
        if "duration" in head:
            self.duration = check("duration", head["duration"], label="system.duration")

    def _add(self, kind: str, name: str, entry: Mapping[str, Any]) -> None:
        rows = {quantity.name: quantity for quantity in KINDS[kind]}
        own = _OWN[kind]
        values: dict[str, Any] = {}
        problems = []
        if kind == "contact" and "pressed_by" in entry:
            values["pressed_by"] = entry["pressed_by"]
        for key, value in entry.items():
            label = f"{kind}.{name}.{key}"
            if key in own:
                continue
            if key not in rows:
                names = Names(f"key of {kind}.{name}", dict.fromkeys((*own, *rows), ()))
                problems.append(f"{self.file}: {names.unknown(key)}")
                continue
            try:
                values[key] = self._value(value, rows[key], label)
            except ValueError as error:
                problems.append(f"{self.file}: {error}")
        needed = {"body": ("mass",), "contact": ("kinetic",)}.get(kind, ())
        for key in needed:
            if key not in entry:
                example = f"{key} = {quoted(rows[key].usual)}"
                problems.append(f"{self.file}: {kind}.{name}.{key} is missing; write {example}")
        if problems:
            raise ConfigError(problems)
        if kind == "body":
            force = values.pop("force", 0.0)
            self.system.body(name, **values)
            self.system.force(name, force)
            return
        one, other = self._between(kind, name, entry.get("between"), "motion" in values)
        add: Callable[..., object] = getattr(self.system, kind)
        if "measured" in entry:
            values["measured"] = self._pair(kind, name, "measured", entry["measured"], alone=True)
        add(one, values.pop("motion", other), name=name, **values)

    def _value(self, value: Any, quantity: Quantity, label: str) -> Given | str:
        """Return a value of the file; a text that names a CSV is a profile of its rows."""
        csv = isinstance(value, str) and value.strip().lower().endswith(SUFFIX)
        if not csv or quantity.rows_of != "profile":
            return _value(value, quantity, label)
        file = self.file.parent / value.strip()
        self.read_files.append(file)
        return _rows_of_csv(file, quantity)

    def _between(self, kind: str, name: str, given: object, moved: bool) -> tuple[str, str]:
        """Both bodies of a part; with a prescribed motion only the first."""
        label = f"{kind}.{name}.between"
        if given is None:
            raise ValueError(f'{label} is missing; write between = ["pin", "ground"]')
        one, other = self._pair(kind, name, "between", given, alone=moved)
        if moved and other != GROUND:
            required = 'one body beside a motion, or that and "ground"'
            raise ValueError(refusal(label, required, quoted(given)))
        return one, other

    def _pair(
        self, kind: str, name: str, key: str, given: object, *, alone: bool
    ) -> tuple[str, str]:
        """Names of two bodies; a text, or where that is allowed a list of one, is of the first."""
        label = f"{kind}.{name}.{key}"
        names = [given] if isinstance(given, str) else given
        counts = (1, 2) if alone or isinstance(given, str) else (2,)
        if not isinstance(names, list) or len(names) not in counts:
            required = 'two names, like ["pin", "ground"]'
            raise ValueError(refusal(label, required, quoted(given)))
        one, other = [*names, GROUND][:2]
        for each in (one, other):
            if each != GROUND and each not in self.system.bodies:
                known = {GROUND: (), **dict.fromkeys(self.system.bodies, ())}
                unknown = Names("body", known).unknown(str(each))
                raise ValueError(f"{label}: {unknown}")
        return one, other


def _value(value: Any, quantity: Quantity, label: str) -> Given | str:
    """Return a value of a file: text with a unit, a plain number, a profile or a function."""
    if isinstance(value, list):
        return _rows(value, quantity, label)
    if isinstance(value, dict):
        return _function(value, quantity, label)
    _check_text(value, quantity.unit, quantity.usual, label)
    return value if isinstance(value, str) else float(value)


def _check_text(value: object, unit: str, example: str, label: str) -> None:
    """Refuse a number without its unit."""
    bare = isinstance(value, (int, float)) and not isinstance(value, bool)
    if isinstance(value, str) or (bare and unit in ("", "1")):
        return
    kind = f"text with a unit, like {quoted(example)}" if unit not in ("", "1") else "a number"
    raise ValueError(refusal(label, kind, quoted(value)))


def _rows(value: list[Any], quantity: Quantity, label: str) -> Profile:
    if quantity.rows_of != "profile":
        raise ValueError(refusal(label, quantity.kind, quoted(value)))
    for i, row in enumerate(value):
        if not isinstance(row, list) or len(row) != 2:
            required = f'a time and a value, like ["10 ms", {quoted(quantity.usual)}]'
            raise ValueError(refusal(f"{label}[{i}]", required, quoted(row)))
        _check_text(row[0], "s", "10 ms", f"{label}[{i}] time")
        _check_text(row[1], quantity.unit, quantity.usual, f"{label}[{i}] value")
    try:
        return Profile([row[0] for row in value], [row[1] for row in value])
    except ValueError as error:
        raise ValueError(f"{label}: {error}") from None


def _rows_of_csv(file: Path, quantity: Quantity) -> Profile:
    """Return the rows of a CSV with the columns `time` and that of a quantity."""
    header = f"{SERIES['time'].heading}, {quantity.heading}"
    table = CsvTable.read(file, f"a CSV of {quantity.name}", header)
    table.check_header({"time", quantity.name} <= {*table.names}, f"like {quoted(header)}")
    table.check_rows(f"a CSV of {quantity.name}", 1)
    times, values = table.column("time", SERIES["time"]), table.column(quantity.name, quantity)
    try:
        return Profile(times, values)
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from None


def _function(table: Mapping[str, Any], quantity: Quantity, label: str) -> Function:
    if quantity.rows_of != "profile":
        raise ValueError(refusal(label, quantity.kind, quoted(table)))
    kinds = {kind: {p.name: p for p in parameters} for kind, parameters in FUNCTIONS.items()}
    every = {name: () for known in kinds.values() for name in known}
    for name in table:
        if name not in every:
            raise ValueError(Names(f"parameter of {label}", every).unknown(name))
    fits = [kind for kind, known in kinds.items() if table.keys() <= known.keys()]
    if not table or not fits:
        words = "; or ".join(", ".join(known) for known in kinds.values())
        raise ValueError(refusal(label, f"the parameters of one function: {words}", quoted(table)))
    known = kinds[fits[0]]
    numbers: dict[str, float | str] = {}
    for name, parameter in known.items():
        unit = parameter.unit or quantity.unit
        if name not in table and parameter.absent is None:
            raise ValueError(f"{label}.{name} is missing")
        if name not in table:
            numbers[name] = parameter.absent or 0.0
            continue
        example = quantity.usual if not parameter.unit else parameter.usual
        _check_text(table[name], unit, example, f"{label}.{name}")
        numbers[name] = table[name]
    return of_parameters(fits[0], numbers)

"""Device files: TOML with units, read into a validated drive and the start of its motion.

Whatever is wrong is found in one pass and said in lines that name file, key, value and bound.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from os import PathLike
from pathlib import Path
from textwrap import wrap
from typing import Any, ClassVar, Final, cast

from pydantic import (
    BaseModel,
    StrictStr,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from pindrive.drive import Contact, Drive, check_static
from pindrive.quantities import INPUTS, Quantity, check, refusal
from pindrive.units import UnitError, quoted, to_si

NUMBERS: Final[dict[str, Quantity]] = {quantity.key: quantity for quantity in INPUTS}
"""The keys of a device file that hold a quantity, in their order."""

KEYS: Final = ("device.name", "device.description", *NUMBERS)
TABLES: Final = ("device", "drive", "plate", "finger", "motion")


class ConfigError(ValueError):
    """A device file that cannot be used. `problems` holds one line each."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


@dataclass(frozen=True, slots=True, kw_only=True)
class DeviceFile:
    """What a device file says, in SI: the drive and the start of its motion (see `simulate`)."""

    path: Path
    name: str
    description: str
    drive: Drive
    mouse_velocity: float
    displacement: float
    velocity: float | None
    duration: float | None

    def values(self) -> dict[str, float | None]:
        """The value of every key that holds a number, in SI; None where it was left out."""
        owner = {"drive": self.drive, "plate": self.drive.plate, "finger": self.drive.finger}
        places = ((key, *key.split(".")) for key in NUMBERS)
        return {key: getattr(owner.get(table, self), name) for key, table, name in places}


Place = Callable[..., str]
"""Where keys were written: on the command line if one of them was, else in the file."""


def load(path: str | PathLike[str], overrides: Iterable[str] = ()) -> DeviceFile:
    """The device file at `path`, with single values set otherwise.

    Args:
        path: a TOML file; `template()` is one.
        overrides: "key=value" each, the key in full (plate.kinetic=30 mN) or its last part where
            that is unique (mass=12 g). Setting damping replaces damping_ratio, and vice versa.

    Raises:
        ConfigError: the file cannot be read, or holds anything unknown, missing or out of bounds.
    """
    file = Path(path)
    tables = _read(file)
    places, problems = _override(tables, overrides)

    def place(*keys: str) -> str:
        return next((places[key] for key in keys if key in places), str(file))

    unknown = _unknown_keys(tables)
    meant = {_nearest(key) for key in unknown}
    problems += [f"{file}: {_not_known(key)}" for key in unknown]
    problems += _damping_problems(tables["drive"], meant, place)
    try:
        schema = _Schema.model_validate(tables, context=place)
        if not problems:
            return _device(file, schema)
    except ValidationError as error:
        problems += _value_problems(error, meant, place)
    except ValueError as error:  # each value in range, but not all together
        problems.append(f"{file}: {error}")
    raise ConfigError(problems)


# ---- the file's text -----------------------------------------------------------------------------


def _read(file: Path) -> dict[str, Any]:
    """The tables of a TOML file, empty where they are missing."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError([f"{file}: is not UTF-8 text, at byte {error.start}"]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConfigError([f"{file}: cannot be read: {reason}"]) from None
    if not text.strip():
        raise ConfigError([f"{file}: is empty; `pindrive init FILE` writes a device file"])
    try:
        tables = {name: {} for name in TABLES} | tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        hint = "; a value with a unit stands in quotes" if "Expected newline" in str(error) else ""
        raise ConfigError([f"{file}: is not valid TOML: {error}{hint}"]) from None
    flat = [name for name in TABLES if not isinstance(tables[name], dict)]
    if flat:
        raise ConfigError(
            [
                f"{file}: {refusal(name, f'a table, [{name}]', quoted(tables[name]))}"
                for name in flat
            ]
        )
    return tables


def _override(tables: dict[str, Any], overrides: Iterable[str]) -> tuple[dict[str, str], list[str]]:
    """Set values in `tables`. Return where each set key was written, and what was wrong."""
    places: dict[str, str] = {}
    problems: list[str] = []
    for override in overrides:
        given, equals, value = (part.strip() for part in override.partition("="))
        place = f"--set {' '.join(given.split())}"
        keys = [key for key in KEYS if given in (key, key.partition(".")[2])]
        if not equals or not given:
            problems.append(f"--set {quoted(override)}: must be key=value")
        elif not keys:
            problems.append(f"{place}: {_not_known(given, tables=False)}")
        elif len(keys) > 1:
            problems.append(f"{place}: give the key in full, {' or '.join(keys)}")
        else:
            table, _, name = keys[0].partition(".")
            tables[table][name] = value
            places[keys[0]] = place
    for one, other in (("damping", "damping_ratio"), ("damping_ratio", "damping")):
        if f"drive.{one}" in places and f"drive.{other}" not in places:
            tables["drive"].pop(other, None)
    return places, problems


def _unknown_keys(tables: Mapping[str, Any]) -> list[str]:
    unknown = [name for name in tables if name not in TABLES]
    full = [f"{table}.{name}" for table in TABLES for name in tables[table]]
    return unknown + [key for key in full if key not in KEYS]


def _nearest(key: str, *, tables: bool = True) -> str | None:
    """The known table or key most like `key`; a known name in the wrong table finds its table."""
    names = {known.partition(".")[2]: known for known in KEYS}
    if tables and "." not in key:
        names |= {table: table for table in TABLES}
    name = key.rpartition(".")[2]
    near = get_close_matches(key, KEYS, 1, cutoff=0.8) or get_close_matches(name, names, 1)
    return names.get(near[0], near[0]) if near else None


def _not_known(key: str, *, tables: bool = True) -> str:
    """What to say of an unknown key; without `tables` where only a key can stand."""
    nearest = _nearest(key, tables=tables)
    said = key if re.fullmatch(r"[\w.-]{1,60}", key) else quoted(key)
    if nearest:
        return f"unknown key {said}; did you mean {nearest}?"
    table = key.partition(".")[0]
    known = [known for known in KEYS if known.startswith(f"{table}.")] or (
        TABLES if tables else KEYS
    )
    return f"unknown key {said}; there are {', '.join(known)}"


# ---- its values ----------------------------------------------------------------------------------


class _Table(BaseModel):
    """A table of the file. The context of its validation maps a key to the place it was written."""

    table: ClassVar[str]

    @field_validator("*", mode="before")
    @classmethod
    def _in_si(cls, value: object, info: ValidationInfo) -> object:
        key = f"{cls.table}.{info.field_name}"
        if key not in NUMBERS:
            return value
        quantity, place = NUMBERS[key], cast(Place, info.context)(key)
        try:
            number = _number(value, quantity)
        except UnitError as error:
            raise ValueError(refusal(key, str(error), quoted(value), place)) from None
        return check(quantity.name, number, where=place, label=key, given=quoted(value))


def _number(value: object, quantity: Quantity) -> float:
    """What TOML gave, in SI: text with a unit, or a bare number where the quantity has no unit."""
    bare = isinstance(value, (int, float)) and not isinstance(value, bool)
    text = value if isinstance(value, str) else repr(value) if bare else ""
    return to_si(text, quantity.unit, _written(quantity))


class _Device(_Table):
    table = "device"
    name: StrictStr = ""
    description: StrictStr = ""


class _Drive(_Table):
    table = "drive"
    mass: float
    stiffness: float
    damping: float | None = None
    damping_ratio: float | None = None


class _Contact(_Table):
    kinetic: float
    static: float | None = None

    @model_validator(mode="after")
    def _ordered(self, info: ValidationInfo) -> _Contact:
        key = f"{self.table}.static"
        if self.static is not None:
            place = cast(Place, info.context)(key, f"{self.table}.kinetic")
            check_static(self.static, self.kinetic, where=place, label=key)
        return self


class _Plate(_Contact):
    table = "plate"


class _Finger(_Contact):
    table = "finger"


class _Motion(_Table):
    table = "motion"
    mouse_velocity: float
    displacement: float = 0.0
    velocity: float | None = None
    duration: float | None = None


class _Schema(BaseModel):
    device: _Device
    drive: _Drive
    plate: _Plate
    finger: _Finger
    motion: _Motion


def _damping_problems(
    drive: Mapping[str, Any], meant: Container[str | None], place: Place
) -> list[str]:
    keys = ("drive.damping", "drive.damping_ratio")
    given = [key for key in keys if key.partition(".")[2] in drive]
    if len(given) == 1 or (not given and any(key in meant for key in keys)):
        return []
    found = "both" if given else "neither"
    return [f"{place(*keys)}: give exactly one of {' and '.join(keys)}, got {found}"]


def _value_problems(
    error: ValidationError, meant: Container[str | None], place: Place
) -> list[str]:
    problems = []
    for problem in error.errors():
        key = ".".join(str(part) for part in problem["loc"])
        if problem["type"] == "value_error":
            problems.append(str(problem["ctx"]["error"]))
        elif problem["type"] == "missing" and key not in meant:
            line, table = _line(NUMBERS[key]), key.partition(".")[0]
            problems.append(f"{place(key)}: {key} is missing; write {line} in [{table}]")
        elif problem["type"] == "string_type":
            problems.append(
                f"{place(key)}: {refusal(key, 'text in quotes', quoted(problem['input']))}"
            )
    return problems


def _device(file: Path, schema: _Schema) -> DeviceFile:
    drive, motion = schema.drive, schema.motion
    plate = Contact(schema.plate.kinetic, schema.plate.static)
    finger = Contact(schema.finger.kinetic, schema.finger.static)
    body = {"mass": drive.mass, "stiffness": drive.stiffness}
    return DeviceFile(
        path=file,
        name=schema.device.name,
        description=schema.device.description,
        drive=Drive(**body, damping=drive.damping, plate=plate, finger=finger)
        if drive.damping is not None
        else Drive.with_damping_ratio(
            **body, damping_ratio=drive.damping_ratio or 0.0, plate=plate, finger=finger
        ),
        mouse_velocity=motion.mouse_velocity,
        displacement=motion.displacement,
        velocity=motion.velocity,
        duration=motion.duration,
    )


# ---- writing -------------------------------------------------------------------------------------


def _written(quantity: Quantity) -> str:
    """A usual value of `quantity` as a device file has it: "10 g"."""
    value = quantity.example if quantity.default is None else quantity.default
    return "" if value is None else quantity.written(value)


def _line(quantity: Quantity) -> str:
    """A line of a device file: mass = "10 g"."""
    written, name = _written(quantity), quantity.key.partition(".")[2]
    return f"{name} = {written}" if quantity.unit == "1" else f'{name} = "{written}"'


def template() -> str:
    """A commented device file with usual values, as `pindrive init` writes it."""
    lines = [
        "# A pin drive of a tactile mouse, for pindrive.",
        "# Every value is written with its unit; the bounds below are in SI units.",
        "",
        "[device]",
        'name = "my pin drive"',
        '# description = "what is special about it"',
    ]
    table = "device"
    for key, quantity in NUMBERS.items():
        if key.partition(".")[0] != table:
            table = key.partition(".")[0]
            lines += ["", f"[{table}]"]
        unit = "" if quantity.unit == "1" else quantity.unit
        bounds = quantity.bounds.words(unit)
        lines.append(f"# {quantity.symbol}: {quantity.meaning}")
        lines.append("#   " + "; ".join(filter(None, (bounds, quantity.remark))))
        lines += [f"#   {line}" for line in wrap(quantity.source, 94)]
        lines.append(("# " if quantity.default is None else "") + _line(quantity))
    return "\n".join(lines) + "\n"

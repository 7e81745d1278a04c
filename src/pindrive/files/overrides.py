"""Values of a device file that are set otherwise, by a command, a study or Python."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import Any, NamedTuple

from pindrive.files.functions import set_in_function
from pindrive.files.keys import NAMES, NUMERIC_KEYS, is_file, written
from pindrive.motion.function import Function
from pindrive.quantities.refusal import quoted, refusal


class Setting(NamedTuple):
    """A value that is set otherwise than in a device file."""

    key: str
    """As it was written: plate.kinetic, plate_kinetic, mass."""
    value: object
    """As TOML has it."""
    place: str
    """Place of the file for messages."""


class ConfigError(ValueError):
    """A device file that cannot be used. `problems` holds one line each."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(self.problems))


def settings_of(
    overrides: Iterable[str] | Mapping[str, object],
) -> tuple[list[Setting], list[str]]:
    """Return the settings of "key=value" texts, or of a mapping, and their errors."""
    if isinstance(overrides, Mapping):
        return [_setting(str(key), value) for key, value in overrides.items()], []
    if isinstance(overrides, str):
        raise ConfigError([refusal("overrides", 'a list, like ["mass=12 g"]', quoted(overrides))])
    settings, problems = [], []
    for override in overrides:
        given, equals, text = (part.strip() for part in override.partition("="))
        place = f"`overrides` {' '.join(given.split())}"
        value: object = text
        if not equals or not given:
            problems.append(f"`overrides` {quoted(override)}: must be key=value")
            continue
        keys = NAMES.matches(given)
        if len(keys) == 1 and is_file(keys[0], text):
            value = str(Path(text).absolute())
        elif (
            len(keys) == 1
            and keys[0] in NUMERIC_KEYS
            and NUMERIC_KEYS[keys[0]].rows
            and text[:1] in ("[", "{")
        ):
            try:
                value = _as_toml(text)
            except (ValueError, RecursionError) as error:
                problems.append(f"{place}: {keys[0]} is not valid TOML: {error}")
                continue
        settings.append(Setting(given, value, place))
    return settings, problems


def _setting(given: str, value: object) -> Setting:
    """A value from Python: a number is SI."""
    keys = NAMES.matches(given)
    if len(keys) == 1 and keys[0] in NUMERIC_KEYS and isinstance(value, (Real, Function)):
        value = written(keys[0], value if isinstance(value, Function) else float(value))
    elif len(keys) == 1 and is_file(keys[0], value):
        value = str(Path(str(value)).absolute())
    return Setting(given, value, f"overrides[{quoted(given)}]")


def _as_toml(text: str) -> object:
    given = tomllib.loads(f"rows = {text}")
    if len(given) > 1:
        raise ValueError("more than one value")
    return given["rows"]


def set_in_tables(
    tables: dict[str, Any], settings: Iterable[Setting]
) -> tuple[dict[str, str], list[str]]:
    """Set values in the tables of a device file.

    Damping replaces the damping ratio, and vice versa.

    Returns:
        Place of each key that was set, and a line for each error.
    """
    places: dict[str, str] = {}
    problems: list[str] = []
    for given, value, place in settings:
        try:
            key = NAMES.find(given, place)
        except ValueError as error:
            problems.append(str(error))
            continue
        table, _, name = key.partition(".")
        owner, _, parameter = name.partition(".")
        if isinstance(value, dict) and not parameter:
            tables[table][name] = set_in_function(tables[table].get(name), value)
        elif not parameter:
            tables[table][name] = value
        elif isinstance(tables[table].get(owner), dict):
            tables[table][owner] = {**tables[table][owner], parameter: value}
            key = f"{table}.{owner}"
        else:
            problems.append(f"{place}: {key} cannot be set: {table}.{owner} is no function")
            continue
        places[key] = place
    for one, other in (("damping", "damping_ratio"), ("damping_ratio", "damping")):
        if f"drive.{one}" in places and f"drive.{other}" not in places:
            tables["drive"].pop(other, None)
    return places, problems

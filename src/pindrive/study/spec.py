"""Study files: a device, axes over its keys, tolerances and a specification, in TOML with units.

All errors of a file are reported together, each in a line with file, key, value and bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any, Final

from pindrive.files.device import read_tables
from pindrive.files.keys import STUDY_KEYS, TABLES
from pindrive.files.overrides import ConfigError
from pindrive.quantities.names import Names
from pindrive.quantities.refusal import quoted
from pindrive.study.axes import Source
from pindrive.study.study import Study
from pindrive.study.tables import device_in

_OWN: Final = ("name", *STUDY_KEYS)
_TEMPLATE: Final = 'a study names its device, base = "device.toml", and what to vary in [axes]'


def load_study(path: str | PathLike[str], overrides: Iterable[str] = ()) -> Study:
    """Read a study from a file.

    Args:
        path: A TOML file that names a device, or holds one, and says what to vary.
        overrides: "key=value" each, as for `load_device`; after those in its table [set].

    Returns:
        The study; `run` simulates its points.

    Raises:
        ConfigError: The file or its device cannot be read, or holds anything unknown, malformed,
            out of bounds or contradictory; a line for each problem.

    Examples:
        >>> import pindrive as pd
        >>> pd.load_study("tactile-mouse-study.toml").shape
        (146, 153, 3)
    """
    file = Path(path)
    tables = read_tables(file, _TEMPLATE)
    if not tables.keys() & {*STUDY_KEYS} and tables.keys() & {*TABLES}:
        raise ConfigError(
            [
                f"{file}: is a device file; a study names it, base = {quoted(file.name)}, and says "
                "what to vary in [axes] or [tolerances]"
            ]
        )
    problems = _unknown(tables, file)
    device, text = device_in(tables, file, overrides, problems)
    return Study.of_tables(tables, device, Source(file, str(file), text), problems)


def _unknown(tables: Mapping[str, Any], file: Path) -> list[str]:
    known = _OWN if "base" in tables else (*_OWN, *TABLES)
    names = Names("key", dict.fromkeys(known, ()), listed="docs/reference/study-file.md")
    problems = []
    for key in tables:
        if key in known:
            continue
        if key in TABLES:
            problems.append(f"{file}: give base or the table {key}, not both")
            continue
        problems.append(f"{file}: {names.unknown(key)}")
    return problems

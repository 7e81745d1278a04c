"""Reader of design problems: device, variables, conditions, constraints and goals.

A problem file is a study file (see `pindrive.study.spec`) with three tables more: `[conditions]`,
written as axes are, `[catalogues]` and `[goals]`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from itertools import combinations
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.page_description import Page
from pindrive.files.device import DeviceFile, read_tables
from pindrive.files.keys import NAMES, STUDY_KEYS, TABLES, written
from pindrive.files.overrides import ConfigError
from pindrive.optimisation.catalogue import Catalogue, read_catalogue
from pindrive.optimisation.goals import PRICE, SPEED, YIELD, DesignProblem, Goal, Variable
from pindrive.quantities import budgets
from pindrive.quantities.names import Names, label
from pindrive.quantities.refusal import quoted, refusal
from pindrive.study.axes import Source, as_read, written_axes
from pindrive.study.design import COUNTS, Dimension, read_page
from pindrive.study.distributions import Distribution
from pindrive.study.outputs import (
    DESIGN_OUTPUTS,
    OUTPUTS,
    SCAN_OUTPUTS,
    Constraint,
    constraints,
    is_measured,
    known_output,
)
from pindrive.study.study import Study
from pindrive.study.tables import device_in

Array = NDArray[np.float64]
MOST_GOALS: Final = 3
_DIRECTIONS: Final = ("minimise", "maximise")
_BESIDE: Final = ("conditions", "catalogues", "goals")
_KEYS: Final = (
    *("name", "base", "set", "page", "axes", "zip", "tolerances", "specification"),
    *_BESIDE,
)
_TEMPLATE: Final = (
    'a design problem names its device, base = "device.toml", its variables in [axes], its '
    "constraints in [specification] and its goals in [goals]"
)


def read_problem(
    path: str | PathLike[str], overrides: Iterable[str] = (), device: DeviceFile | None = None
) -> DesignProblem:
    """Read a design problem from a file.

    Args:
        path: A TOML file.
        overrides: "key=value" each, as for `load_device`.
        device: Device to vary in place of the device that the file names.

    Raises:
        ConfigError: The file cannot be read, or holds anything unknown, malformed, out of bounds or
            contradictory; a line for each problem.
    """
    file = Path(path)
    tables: dict[str, Any] = read_tables(file, _TEMPLATE)
    if not tables.keys() & {*STUDY_KEYS, *_BESIDE}:
        what = "is a device file" if tables.keys() & {*TABLES} else "is not a design problem"
        raise ConfigError([f"{file}: {what}; {_TEMPLATE}"])
    problems = [*_unknown(tables, file)]
    own, text = device_in(tables, file, overrides, problems)
    return _problem(tables, device or own, Source(file, str(file), text), problems)


def problem_of(device: DeviceFile, tables: Mapping[str, Any]) -> DesignProblem:
    """Read a design problem from tables: numbers are SI, texts have a unit.

    Paths are relative to the folder of the device file.

    Args:
        device: Device to vary.
        tables: `axes`, `goals` and the other tables of a problem file; `page` may be a `Page`.

    Raises:
        ConfigError: The tables are invalid, as for `read_problem`.
    """
    if not isinstance(device, DeviceFile):
        raise ValueError(refusal("device", "what load_device reads", repr(device)))
    given = dict(tables)
    problems = [*_unknown(given, Path("problem"))]
    for name in ("axes", "conditions", "tolerances"):
        if name in given:
            given[name] = as_read(given[name], name)
    if isinstance(given.get("page"), str):
        given["page"] = Page(text=given["page"])
    if isinstance(given.get("page"), Mapping):
        given["page"] = read_page(dict(given["page"]), device.path)
    if isinstance(given.get("page"), Page):
        given["page"].check("page.{}")
    text = json.dumps(given, indent=1, ensure_ascii=False, default=repr)
    return _problem(given, device, Source(device.path, "problem", text, si=True), problems)


def _unknown(tables: Mapping[str, Any], file: Path) -> Iterable[str]:
    known = _KEYS if "base" in tables else (*_KEYS, *TABLES)
    names = Names("key", dict.fromkeys(known, ()), listed="docs/reference/problem-file.md")
    for key in tables:
        if key in known:
            continue
        if key in TABLES:
            yield f"{file}: give base or the table {key}, not both"
            continue
        yield f"{file}: {names.unknown(key)}"


def _problem(
    tables: Mapping[str, Any],
    device: DeviceFile,
    source: Source,
    problems: list[str],
) -> DesignProblem:
    scans, place = "page" in tables, source.place
    for name in (*_BESIDE, "axes", "tolerances", "specification"):
        if not isinstance(tables.get(name, {}), Mapping):
            problems.append(refusal(name, f"a table, [{name}]", quoted(tables[name]), place))
    if problems:
        raise ConfigError(problems)
    catalogues = _catalogues(tables.get("catalogues", {}), source.path, place, scans, problems)
    chosen = {key: c.name for c in catalogues for key in c.values}
    conditions = _keys(tables.get("conditions", {}))
    for name in ("axes", "conditions", "tolerances"):
        for key in _keys(tables.get(name, {})):
            if name != "tolerances" and key in chosen:
                problems.append(
                    f"{place}: {key} is in [{name}] and in the catalogue {chosen[key]}; "
                    "leave one out"
                )
            if name != "conditions" and key in conditions:
                problems.append(f"{place}: {key} is in [{name}] and in [conditions]; leave one out")
    if not tables.get("axes") and not catalogues:
        problems.append(f"{place}: nothing may vary; write what may in [axes] or [catalogues]")
    goals = _goals(tables.get("goals", {}), place, _among(scans), problems)
    required = constraints(tables.get("specification", {}), place, problems, _among(scans))
    try:
        budgets.CONSTRAINTS.check(len(required), where=place)
    except ValueError as error:
        problems.append(str(error))
    least = _least_yield(required, goals, tables, place, problems)
    required = tuple(constraint for constraint in required if constraint.name != YIELD)
    if problems:
        raise ConfigError(problems)
    listed, groups = _as_axes(catalogues)
    axes = {**tables.get("axes", {}), **listed}
    rest = {k: v for k, v in tables.items() if k not in ("catalogues", "goals", "specification")}
    varied = rest | {"axes": axes, "zip": [*tables.get("zip", []), *groups]}
    chunk = (budgets.CHUNK_OF_SCANS if scans else budgets.CHUNK).most
    varied |= {"sample": {"count": 1}, "chunk": chunk}  # no points are computed of it
    study = Study.of_tables(varied, device, source, problems)
    problems += _contradictions(study, required, goals, catalogues, place)
    problems += _no_ranges(study, conditions, place)
    if problems:
        raise ConfigError([*dict.fromkeys(problems)])
    found = [*_variables(study, catalogues)]
    return DesignProblem(
        study=study,
        tables=tables,
        variables=tuple(v for v in found if not conditions & v.axes.keys()),
        conditions=tuple(v for v in found if conditions & v.axes.keys()),
        constraints=required,
        least_yield=least,
        goals=goals,
        catalogues=catalogues,
    )


def _among(scans: bool) -> tuple[str, ...]:
    return (*(SCAN_OUTPUTS if scans else OUTPUTS), *DESIGN_OUTPUTS)


def _keys(table: Mapping[str, Any]) -> set[str]:
    """The keys that a table names; what is unknown or ambiguous is said where it is read."""
    found = (NAMES.matches(given) for given, _ in written_axes(table))
    return {keys[0] for keys in found if len(keys) == 1}


def _catalogues(
    table: Mapping[str, Any], path: Path, place: str, scans: bool, problems: list[str]
) -> tuple[Catalogue, ...]:
    found = []
    for name, given in table.items():
        label_ = f"{place}: catalogues.{name}"
        try:
            if not isinstance(given, str | PathLike):
                required = 'the path of a CSV file, like "springs.csv"'
                raise ValueError(refusal(f"catalogues.{name}", required, quoted(given), place))
            found.append(read_catalogue(name, path.parent / given, label_, scans))
        except ValueError as error:
            problems.append(str(error))
    for one, other in combinations(found, 2):
        problems.extend(
            f"{place}: {key} is in the catalogues {one.name} and {other.name}; leave one out"
            for key in one.values.keys() & other.values.keys()
        )
    return tuple(found)


def _as_axes(catalogues: Iterable[Catalogue]) -> tuple[dict[str, Any], list[list[str]]]:
    """Return the keys of catalogues as axes of lists, and the zipped keys."""
    axes: dict[str, Any] = {}
    groups = []
    for catalogue in catalogues:
        for key, values in catalogue.values.items():
            axes[key] = [written(key, value) for value in values]
        if len(catalogue.values) > 1:
            groups.append([*catalogue.values])
    return axes, groups


def _variables(study: Study, catalogues: Iterable[Catalogue]) -> Iterable[Variable]:
    of = {key: catalogue for catalogue in catalogues for key in catalogue.values}
    for dimension in study.dimensions:
        if dimension.sample:
            for key, axis in dimension.axes.items():
                yield Variable(key, {key: axis})
        else:
            first = next(iter(dimension.axes))
            name = of[first].name if first in of else first
            yield Variable(name, dimension.axes, dimension.size, of.get(first))


def _goals(
    table: Mapping[str, Any], place: str, among: tuple[str, ...], problems: list[str]
) -> tuple[Goal, ...]:
    found: list[Goal] = []
    for direction, given in table.items():
        if direction not in _DIRECTIONS:
            problems.append(
                f"{place}: unknown key goals.{direction}; there are {' and '.join(_DIRECTIONS)}"
            )
            continue
        for one in given if isinstance(given, list) else [given]:
            try:
                name = known_output(one, f"{place}: goals.{direction}", among)
            except ValueError as error:
                problems.append(str(error))
                continue
            if not is_measured(name):
                problems.append(f"{place}: goals.{direction}: {one} is not a number")
            elif any(goal.name == name for goal in found):
                problems.append(f"{place}: goals: {label(name)} is named twice; leave one out")
            else:
                found.append(Goal(name, direction == "maximise"))
    if not problems and not 1 <= len(found) <= MOST_GOALS:
        example = 'minimise = ["settling_time"]'
        required = f"one to {MOST_GOALS} numbers, like {example}"
        problems.append(refusal("goals", required, str(len(found)) if found else "none", place))
    return tuple(found)


def _least_yield(
    required: tuple[Constraint, ...],
    goals: tuple[Goal, ...],
    tables: Mapping[str, Any],
    place: str,
    problems: list[str],
) -> float | None:
    """The yield that is required; what is wrong with it is appended to `problems`."""
    own = [constraint for constraint in required if constraint.name == YIELD]
    where = f"{place}: specification.yield"
    if any(goal.name == YIELD for goal in goals):
        problems.append(f'{place}: goals: yield cannot be a goal; constrain it, yield = ">= 95 %"')
    if not own:
        return None
    if len(own) > 1 or own[0].at_most or not 0.0 < own[0].limit < 1.0:
        given = quoted(tables["specification"].get("yield"))
        problems.append(f'{where}: must be one limit like ">= 95 %", got {given}')
    elif not tables.get("tolerances"):
        problems.append(f"{where}: needs tolerances; write them in [tolerances]")
    elif len(required) == 1:
        problems.append(
            f"{where}: needs another constraint; the yield is the part of devices that "
            "meets all others"
        )
    return own[0].limit


def _contradictions(
    study: Study,
    required: tuple[Constraint, ...],
    goals: tuple[Goal, ...],
    catalogues: tuple[Catalogue, ...],
    place: str,
) -> Iterable[str]:
    """Constraints that no number meets, and numbers that this design problem does not have."""
    for one, other in combinations(required, 2):
        low, high = (other, one) if one.at_most else (one, other)
        if one.name == other.name and one.at_most != other.at_most and low.limit > high.limit:
            yield (
                f"{place}: specification.{label(one.name)}: nothing is both {_side(high)} and "
                f"{_side(low)}; correct one of them"
            )
    names = {*(constraint.name for constraint in required), *(goal.name for goal in goals)}
    if PRICE in names and not any(catalogue.priced for catalogue in catalogues):
        yield f"{place}: no part has a price; give a catalogue with a column price in [catalogues]"
    if SPEED in names and not (study.page and study.page.page.grating):
        yield (
            f"{place}: {label(SPEED)} depends on the pitch of the lines; write it, as with "
            'grating = ["3 mm"] in [page]'
        )


def _side(constraint: Constraint) -> str:
    return f"{'≤' if constraint.at_most else '≥'} {constraint.shown()}"


def _no_ranges(study: Study, conditions: set[str], place: str) -> Iterable[str]:
    """Return the errors of axes without ends, and of counts without steps."""
    for dimension in study.dimensions:
        for key, axis in dimension.axes.items():
            table = "conditions" if key in conditions else "axes"
            if isinstance(axis, Distribution) and axis.kind not in ("uniform", "loguniform"):
                yield (
                    f"{place}: {table}.{key}: a range has two ends; write uniform or loguniform, "
                    f"not {axis.kind}"
                )
            if isinstance(axis, Distribution) and key in COUNTS:
                yield f"{place}: {table}.{key} counts pins; give a list of whole numbers"
        yield from _mixed(dimension, conditions, place)


def _mixed(dimension: Dimension, conditions: set[str], place: str) -> Iterable[str]:
    inside = conditions & dimension.axes.keys()
    if not dimension.sample and inside and inside != dimension.axes.keys():
        yield f"{place}: zip: {', '.join(dimension.axes)} are not all of one table"

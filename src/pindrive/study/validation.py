"""Checks of a study before anything is computed: contradictions, and the range of friction."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.files.keys import NUMERIC_KEYS
from pindrive.motion.coefficients import KINETIC, within
from pindrive.motion.friction import COEFFICIENTS, PRESSED_BY, normal_force
from pindrive.quantities import budgets
from pindrive.quantities.contradictions import problems_of
from pindrive.quantities.table import QUANTITIES
from pindrive.study.design import COUNTS, Columns
from pindrive.study.distributions import (
    Axis,
    Distribution,
    Linked,
    Listed,
    base_value,
    circle,
    with_links,
)

if TYPE_CHECKING:
    from pindrive.files.device import DeviceFile
    from pindrive.study.study import Study

_MOST_COMPARED = 1 << 20
"""Points of one dimension that are compared one by one."""


def conflicts(study: Study) -> list[str]:
    """A line for each contradiction among the axes, and between them and the device."""
    problems, file = [], study.source.place
    tolerances: dict[str, Axis] = {**study.tolerances, **study.tolerance_links}
    for table, axes in (("axes", study.axes), ("tolerances", tolerances)):
        if keys := circle({k: axis for k, axis in axes.items() if isinstance(axis, Linked)}):
            problems.append(f"{file}: {table}: {_in_words(keys)}")
            continue
        problems += [f"{file}: {table}: {words}" for words in _among(study.device, axes)]
        if study.page:
            problems += [f"{file}: {table}: {words}" for words in _around(study, axes)]
        for kinetic, static in _PAIRS:
            if words := _static_below_kinetic(study, axes, static, kinetic):
                problems.append(f"{file}: {table}: {words}")
    if study.page and not any(_sizes(key) for key in (*study.axes, *tolerances)):
        problems += [f"{file}: page: {words}" for words in _unreadable(study)]
    return problems


def _sizes(key: str) -> bool:
    """Return True if the size of a page, or a path over it, depends on a key."""
    return key.startswith(("array.", "scan."))


def _unreadable(study: Study) -> Iterator[str]:
    """Return the errors of a page that is equal at every point."""
    if study.page and study.device.whole:
        reading, array = study.device.reading, study.device.whole.array()
        try:
            study.page.hand(reading, study.page.scene(reading, array), array)
        except ValueError as error:
            yield str(error)


def _among(device: DeviceFile, axes: Mapping[str, Axis]) -> Iterator[str]:
    if {"drive.damping", "drive.damping_ratio"} <= axes.keys():
        yield "vary drive.damping or drive.damping_ratio, not both"
    given = dict.fromkeys((*device.given, *axes))
    yield from (problem.words for problem in problems_of(given, whole=True))
    drive = device.drive
    if "finger.touch_force" in axes and drive.finger.coefficient is None:
        yield "finger.touch_force cannot be varied where finger.kinetic is a force"
    if "motion.skin_stretch" in axes and drive.finger.rigid and "finger.stiffness" not in axes:
        yield "motion.skin_stretch cannot be varied for a rigid finger; give finger.stiffness"
    for key, link in axes.items():
        if not isinstance(link, Linked) or link.of in axes:
            continue
        if not isinstance(base_value(device, link.of), float):
            yield f"{key} follows {link.of}, which has no value"


def _in_words(keys: tuple[str, ...]) -> str:
    """Keys that follow each other in a circle."""
    first, *others = keys
    return f"{first} follows {', which follows '.join((*others, first))}; give one of them values"


def _around(study: Study, axes: Mapping[str, Axis]) -> Iterator[str]:
    """Return the errors of the tables around the drive."""
    if "scan.touch" in axes and study.device.drive.finger.coefficient is None:
        yield "scan.touch cannot be varied where finger.kinetic is a force"
    if "finger.touch_force" in axes and "scan.touch" in study.device.given:
        yield "finger.touch_force has no effect beside scan.touch, which gives the touch force"
    for key in COUNTS:
        axis = axes.get(key)
        if isinstance(axis, Distribution):
            yield f"{key} counts pins; give a list of whole numbers"
        elif axis is not None and not isinstance(axis, Linked):
            try:
                budgets.AXIS_VALUES.check(axis.count, key)
                few = axis.values if isinstance(axis, Listed) else axis.at(np.arange(axis.count))
            except ValueError as error:
                yield str(error)
                continue
            for value in few:
                yield from (p.words for p in problems_of({key: float(value)}, whole=True))


_PAIRS: Final = [
    (f"{contact}.{kinetic}", f"{contact}.{static}")
    for contact in ("plate", "finger")
    for kinetic, static in zip(
        *([name, COEFFICIENTS[name]] for name in ("kinetic", "static")), strict=True
    )
]
"""Kinetic and static friction, by forces and by coefficients."""


def _static_below_kinetic(study: Study, axes: Mapping[str, Axis], static: str, kinetic: str) -> str:
    """Words for static friction that is below kinetic friction at every point."""
    if not {static, kinetic} & axes.keys():
        return ""
    if static not in axes and study.device.values()[static] is None:
        return ""
    largest, smallest = _span(study, axes, static)[1], _span(study, axes, kinetic)[0]
    if largest >= smallest and not _below_along(study, static, kinetic):
        return ""
    unit = NUMERIC_KEYS[static]
    return (
        f"{static} is below {kinetic} at every point: at most {unit.written(largest)}, "
        f"{kinetic} at least {unit.written(smallest)}"
    )


def _span(study: Study, axes: Mapping[str, Axis], key: str) -> tuple[float, float]:
    """The smallest and the largest value of a key."""
    axis = axes.get(key)
    if axis is None:
        value = float(base_value(study.device, key))
        return value, value
    if isinstance(axis, Linked):
        of = _span(study, axes, axis.of)
        over = _span(study, axes, axis.over) if axis.over else (1.0, 1.0)
        ends = sorted(axis.times * end / part for end in of for part in over)
        return ends[0], ends[-1]
    return axis.span


def _below_along(study: Study, static: str, kinetic: str) -> bool:
    """Return True if two zipped keys contradict at every point, though their ranges overlap."""
    for dimension in study.dimensions:
        if {static, kinetic} <= dimension.axes.keys() and dimension.size <= _MOST_COMPARED:
            values = dimension.at(np.arange(dimension.size))
            return bool((values[static] < values[kinetic]).all())
    return False


def coefficient_range(study: Study, *, tolerances: bool) -> tuple[float, float] | None:
    """The least and the largest kinetic coefficient of the plate; None where it does not change.

    Args:
        study: The study.
        tolerances: True for the tolerances in place of the axes.
    """
    links = study.tolerance_links if tolerances else study.links
    by_coefficient = study.device.drive.plate.coefficient is not None
    own = "plate.coefficient" if by_coefficient else "plate.kinetic"
    pressing = [QUANTITIES[name].key for name in PRESSED_BY["plate"]]
    followed = [own] if by_coefficient else [own, *pressing]
    for key in followed:  # and what they follow, and so on
        if key in links:
            followed += [of for of in (links[key].of, links[key].over) if of and of not in followed]
    groups = [study.tolerances] if tolerances else [d.axes for d in study.dimensions]
    columns: list[Columns] = []
    for i, axes in enumerate(groups):
        here = [key for key in axes if key in followed]
        zipped = not tolerances and study.dimensions[i].sample is None
        if len(here) > 1 and zipped:
            every = study.dimensions[i].at(np.arange(study.dimensions[i].size))
            columns.append({key: every[key] for key in here})
        else:  # separately; the coefficient is monotone, so its ends suffice
            columns += [{key: np.array(axes[key].span)} for key in here]
    lengths = [len(next(iter(column.values()))) for column in columns]
    places = np.meshgrid(*(np.arange(length) for length in lengths), indexing="ij")
    spread = {
        key: values[index.ravel()]
        for column, index in zip(columns, places, strict=True)
        for key, values in column.items()
    }
    found = study.values | with_links(study.device, spread, links)
    # A spread that goes down to no mass has no upper end.
    with np.errstate(divide="ignore", invalid="ignore"):
        force = 1.0 if by_coefficient else normal_force("plate", lambda n: found[QUANTITIES[n].key])
        coefficient = np.asarray(found[own] / np.maximum(force, 0.0))
    low, high = float(coefficient.min()), float(coefficient.max())
    return (low, high) if high > low * (1.0 + 1e-9) else None


def coefficient_words(study: Study, *, tolerances: bool = False) -> tuple[str, bool] | None:
    """Return the range of the friction coefficients in a sentence; None without a change."""
    found = coefficient_range(study, tolerances=tolerances)
    if found is None:
        return None
    low, high = found
    over = "the tolerances" if tolerances else "the study"
    by_force = study.device.drive.plate.coefficient is None
    how = ", plate.kinetic over what presses" if by_force else ", plate.coefficient"
    known = all(within(value, KINETIC) for value in found)
    doubt = f"; steel on steel has {KINETIC[0]:.2f} to {KINETIC[1]:.2f} in handbooks"
    words = (
        f"the plate's friction coefficient{how}, goes from "
        f"{low:.3g} to {high:.3g} over {over}{'' if known else doubt}"
    )
    return words, not known

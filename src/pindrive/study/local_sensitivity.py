"""Local sensitivity at the device's own values: exact derivatives as elasticities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, nan
from typing import Final

import numpy as np

from pindrive.files.keys import variable
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.friction import COEFFICIENTS
from pindrive.motion.simulate import motion_of
from pindrive.quantities.quantity import counted
from pindrive.quantities.status import Status
from pindrive.quantities.value import equal_by_value
from pindrive.study.design import ranges_of
from pindrive.study.distributions import Linked, base_value, exponents
from pindrive.study.study import Study
from pindrive.views import NotebookHtml, figure

_WITHOUT: Final = ("motion.duration", "motion.settling_band")
"""Keys along which the core has no derivatives."""


@equal_by_value
@dataclass(frozen=True, slots=True, repr=False)
class Elasticities(NotebookHtml):
    """Relative change of each number, in per cent, when a key grows by one per cent."""

    keys: tuple[str, ...]
    values: Mapping[str, float]
    """The numbers themselves, by their variables, SI."""
    table: Mapping[str, Mapping[str, float]]
    """d ln N / d ln p by number and key; NaN where it does not exist."""
    duration: float
    """The time over which they hold, s: it does not change with the keys."""
    gaps: Mapping[str, str]
    """Reason, for each key with numbers that have no derivative."""
    name: str = ""
    """Name of the study."""

    def __repr__(self) -> str:
        """Return the counts of numbers and keys in a line."""
        numbers, keys = counted(len(self.table), "number"), counted(len(self.keys), "key")
        return f"<Elasticities of {numbers} to {keys}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where keys have no derivatives; `gaps` says why."""
        return Status.incomplete if self.gaps else Status.ok

    def plot(self) -> mpl_figure.Figure:
        """The elasticities as a table of colours, numbers down and keys across."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """The elasticities as data.

        Returns:
            `elasticity` over (number, key), without unit, and `value` over `number`, the numbers at
            the device's own values, SI; NaN where there is none.
        """
        numbers = [*self.table]
        rows = [[self.table[number][key] for key in self.keys] for number in numbers]
        data = {
            "elasticity": (("number", "key"), np.array(rows), {"units": "1"}),
            "value": ("number", np.array([self.values[number] for number in numbers])),
        }
        coords = {"number": numbers, "key": [*self.keys]}
        attributes = {"status": self.status.name, "duration": self.duration}
        return xr.Dataset(data, coords=coords, attrs=attributes)


def local_sensitivity(study: Study, *, tolerances: bool = False) -> Elasticities:
    """Compute the change of each number, in per cent, when a key of a study grows by one per cent.

    Exact derivatives at the device's own values, by dual numbers through every event.

    Args:
        study: Study of releases; its axes name the keys.
        tolerances: The keys of its tolerances instead.

    Returns:
        The elasticities, NaN where one does not exist, with the reason of a key that has none.

    Raises:
        ValueError: The study is one of scans, which have no exact derivatives, or nothing varies.

    Examples:
        >>> import pindrive as pd
        >>> study = pd.Study(
        ...     pd.load_device("tactile-mouse.toml"), axes={"drive.stiffness": [90.0, 110.0]}
        ... )
        >>> near = pd.local_sensitivity(study)
        >>> round(near.table["transient_swing"]["drive.stiffness"], 3)
        0.097
    """
    if study.page:
        raise ValueError(f"{study.path}: a study of scans has no exact derivatives; sobol takes it")
    ranges = ranges_of(study, tolerances)
    return elasticities(study, tuple(ranges.scatter), ranges.links)


def elasticities(study: Study, keys: Sequence[str], links: Mapping[str, Linked]) -> Elasticities:
    """The elasticity of every number to each key at the device's own values.

    Followers of a key change with the key: damping, where the device file gives its ratio, curves,
    and keys that are linked. The derivatives are the core's own, on dual numbers.

    Args:
        study: Study with the device.
        keys: Keys of device files, each with a value in the device.
        links: Keys that follow others.
    """
    motion = motion_of(study.device)
    changes, gaps = {}, {}
    for key in keys:
        followed = [key, *exponents(key, links)]
        if key in _WITHOUT:
            gaps[key] = "the core has none along it"
        elif not base_value(study.device, key) or not all(
            isinstance(base_value(study.device, name), float) for name in followed
        ):
            gaps[key] = "it is zero or not given"
        else:
            changes[key] = _changes(study, key, links)
    parameters = list(dict.fromkeys(name for change in changes.values() for name in change))
    numbers = {k.replace(".", "_"): v for k, v in motion.numbers().items()}
    slopes: dict[str, dict[str, float]] = {}
    if parameters:
        found = motion.sensitivity(parameters)
        slopes = {k.replace(".", "_"): v for k, v in found.numbers.items()}
        for key, change in changes.items():
            reasons = [found.gaps[name] for name in change if name in found.gaps]
            if reasons:
                gaps[key] = reasons[0]

    def elasticity(number: str, key: str) -> float:
        value = numbers[number]
        if key not in changes or number not in slopes or not isfinite(value) or value == 0.0:
            return nan
        slope = slopes[number]
        return sum(slope[name] * change for name, change in changes[key].items()) / value

    table = {number: {key: elasticity(number, key) for key in keys} for number in numbers}
    return Elasticities(tuple(keys), numbers, table, motion.duration, gaps, study.name)


def _changes(study: Study, key: str, links: Mapping[str, Linked]) -> dict[str, float]:
    """Return the change of each parameter of the motion, SI, when a key grows by its own size."""
    drive = study.device.drive
    if key == "drive.damping_ratio":
        return {"damping": drive.damping}
    shares = exponents(key, links)
    if study.device.by_ratio and key in ("drive.mass", "drive.stiffness"):
        shares["drive.damping"] = 0.5  # b = 2 ζ sqrt(m k)
    found = {}
    for name, share in shares.items():
        table, _, part = name.rpartition(".")
        contact = {"plate": drive.plate, "finger": drive.finger}.get(table)
        tied = (
            contact
            and part in ("static", COEFFICIENTS["static"])
            and contact.static_friction == contact.kinetic
        )
        if tied and name != key:
            continue  # one number with the kinetic friction, which the core changes, too
        found[variable(name)] = share * base_value(study.device, name)
        if contact and part in ("kinetic", "coefficient"):  # the curve keeps its shape
            rows = enumerate(contact.curve or ())
            found |= {f"{table}_curve[{i}].force": force for i, (_, force) in rows if i}
    return found

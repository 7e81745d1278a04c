"""Which parameter matters at the device's own values: exact derivatives as elasticities."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, nan
from typing import TYPE_CHECKING

from pindrive.config import motion_of
from pindrive.study.plan import base_value, variable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from pindrive.study.axis import Linked
    from pindrive.study.plan import Plan


@dataclass(frozen=True, slots=True)
class Elasticities:
    """By how many per cent each number changes when a key grows by one per cent."""

    keys: tuple[str, ...]
    values: Mapping[str, float]
    """The numbers themselves, by their variables, SI."""
    table: Mapping[str, Mapping[str, float]]
    """d ln N / d ln p by number and key; NaN where it does not exist."""
    duration: float
    """The time over which they hold, s: it does not change with the keys."""
    gaps: Mapping[str, str]
    """Why, for each key with numbers that have no derivative."""


def elasticities(plan: Plan, keys: Sequence[str], links: Mapping[str, Linked]) -> Elasticities:
    """The elasticity of every number to each key at the device's own values.

    What follows a key changes with it: damping, where the device file gives its ratio, and keys
    that are linked. The derivatives are the core's own, on dual numbers.

    Args:
        plan: whose device.
        keys: of device files, each with a value in the device.
        links: keys that follow others.
    """
    motion = motion_of(plan.device)
    shares = {key: _shares(plan, key, links) for key in keys}
    known = {key: share for key, share in shares.items() if _has_size(plan, share)}
    parameters = list(dict.fromkeys(name for share in known.values() for name in share))
    gaps = {key: "it is zero or not given" for key in keys if key not in known}
    numbers = {k.replace(".", "_"): v for k, v in motion.numbers().items()}
    slopes: dict[str, dict[str, float]] = {}
    if parameters:
        found = motion.sensitivity([variable(key) for key in parameters])
        slopes = {k.replace(".", "_"): v for k, v in found.numbers.items()}
        for key, share in known.items():
            reasons = [found.gaps[variable(k)] for k in share if variable(k) in found.gaps]
            if reasons:
                gaps[key] = reasons[0]

    def elasticity(number: str, key: str) -> float:
        value = numbers[number]
        if key not in known or number not in slopes or not isfinite(value) or value == 0.0:
            return nan
        change = sum(
            share * slopes[number][variable(name)] * base_value(plan.device, name)
            for name, share in known[key].items()
        )
        return float(change / value)

    table = {number: {key: elasticity(number, key) for key in keys} for number in numbers}
    return Elasticities(tuple(keys), numbers, table, motion.duration, gaps)


def _shares(plan: Plan, key: str, links: Mapping[str, Linked]) -> dict[str, float]:
    """How much of a per cent each parameter of the motion changes when a key changes by one."""
    shares = {key: 1.0} if key != "drive.damping_ratio" else {"drive.damping": 1.0}
    if plan.by_ratio and key in ("drive.mass", "drive.stiffness"):
        shares["drive.damping"] = 0.5  # b = 2 ζ sqrt(m k)
    return shares | {name: 1.0 for name, link in links.items() if link.of == key}


def _has_size(plan: Plan, share: Mapping[str, float]) -> bool:
    """Whether a per cent of each of these is something, of which the core knows derivatives."""
    values = [base_value(plan.device, key) for key in share]
    return "motion.duration" not in share and all(isinstance(v, float) and v for v in values)

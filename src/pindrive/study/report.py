"""Studies as a person reads them in a terminal."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pindrive import template
from pindrive.quantity import significant
from pindrive.study.evaluate import flags
from pindrive.study.outputs import NUMBERS, label
from pindrive.study.plan import base_value
from pindrive.study.sweeping import human_bytes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rich.console import RenderableType
    from rich.table import Table

    from pindrive.study.influence import Influence
    from pindrive.study.local import Elasticities
    from pindrive.study.plan import Plan
    from pindrive.study.robust import Robustness, Share
    from pindrive.study.sweeping import Result

QUANTILES = (0.01, 0.05, 0.5, 0.95, 0.99)
_AS_OPTION = re.compile(r"^--set [^:]*: ")
"""How `device_of` calls the place of a value that its file does not have."""
_SLICE = 1 << 24
"""Points of which the status is read at a time."""


def sweep_report(plan: Plan, done: Result) -> list[str]:
    """What a sweep came to, in lines."""
    points, size = count(done.points), human_bytes(done.path.stat().st_size)
    if not done.complete:
        lines = [f"Stopped at {points} of {count(plan.size)} points; --resume goes on"]
    elif done.worked_out:
        speed = count(round(done.worked_out / done.seconds))
        resumed = (
            "" if done.worked_out == done.points else f", {count(done.worked_out)} of them now"
        )
        lines = [
            f"Wrote {done.path}: {points} points{resumed}, {size}, "
            f"in {significant(done.seconds, 3)} s ({speed} a second)"
        ]
    else:
        lines = [f"{done.path} is complete: {points} points, {size}"]
    if done.points and done.settled >= 0:
        lines.append(f"settled: {percent(done.settled, done.points)}")
    if done.refused and done.complete:
        found = ", ".join(f"{percent(n, done.points)} {name}" for name, n in _reasons(done))
        lines.append(f"without numbers: {found} (see the variable status)")
        if plan.page:
            lines.append(f"the first of them: {_first_refusal(plan, done)}")
    return lines


def _first_refusal(plan: Plan, done: Result) -> str:
    """Why the first point without a scan has none."""
    import h5py

    from pindrive.study.scans import judged_at

    with h5py.File(done.path, "r") as file:
        first = int(np.flatnonzero(file["status"][()])[0])
    at = {key: float(values[0]) for key, values in plan.columns(first, first + 1).items()}
    try:
        judged_at(plan, at)
    except (ValueError, ArithmeticError, MemoryError) as error:
        return _AS_OPTION.sub("", str(error).splitlines()[0])
    return "it can be scanned by now"


def _reasons(done: Result) -> list[tuple[str, int]]:
    """Why points have no numbers, and how many of them, most first."""
    import h5py

    found = np.zeros(256, np.int64)
    with h5py.File(done.path, "r") as file:
        status = file["status"]
        rows = max(1, _SLICE // max(1, status.size // status.shape[0]))
        for first in range(0, status.shape[0], rows):
            found += np.bincount(status[first : first + rows].ravel(), minlength=256)
    meanings = flags("status")
    named = [(meanings[i], int(found[i])) for i in np.flatnonzero(found) if i]
    return sorted(named, key=lambda pair: -pair[1])


def influence_report(found: Influence) -> RenderableType:
    """Three tables: elasticities, and Sobol' indices of first order and in total."""
    from rich.console import Group

    told = [name for name in found.over if found.over[name].spread > 0.0]
    tables: list[RenderableType] = [_near(found, found.near)] if found.near else []
    for title, order in (
        ("Over the whole ranges: part of the variance due to, by itself", "first"),
        ("Over the whole ranges: part of the variance due to, with all interactions", "total"),
    ):
        cell = partial(_index, found, order)
        tables.append(_by_key(title, found.keys, told, cell))
    return Group(*tables, *_notes(found))


def _near(found: Influence, near: Elasticities) -> Table:
    names = [name for name in found.over if name != "transient_settled"]
    return _by_key(
        "Near the device's values: per cent of change for one per cent more of",
        found.keys,
        [name for name in names if not np.isnan(near.values[name])],
        lambda name, i: elasticity(near.table[name][found.keys[i]]),
    )


def _by_key(
    title: str, keys: Sequence[str], names: Sequence[str], cell: Callable[[str, int], str]
) -> Table:
    """A line for each number, a column for each key."""
    from pindrive.report import new_table

    heads = [template.NUMBERS[key].symbol for key in keys]
    made = new_table(title, "number", *(f">{head}" for head in heads))
    for name in names:
        made.add_row(label(name), *(cell(name, i) for i in range(len(keys))))
    return made


def _index(found: Influence, order: str, name: str, i: int) -> str:
    """An index and half its interval: "0.41 ±.02"; one that may be none is a point."""
    interval = getattr(found.over[name], order)
    value, half = interval.value[i], 0.5 * (interval.high[i] - interval.low[i])
    if np.isnan(value):
        return "-"
    if value < 0.005 and half < 0.02:
        return "·"
    return f"{max(value, 0.0):.2f} ±{half:.2f}".replace("±0.", "±.")


def elasticity(value: float) -> str:
    """An elasticity to two decimals with its sign: "+0.57"; a point for none to speak of."""
    if np.isnan(value):
        return "-"
    return "·" if abs(value) < 0.005 else f"{value:+.2f}"


def _notes(found: Influence) -> list[str]:
    """What the tables leave out, and from how much they come."""
    design = f"{count(found.points)} points (Sobol' design of {count(found.count)} rows)"
    lines = [
        f"{design}; ± half of the 95 % bootstrap interval; · below 0.005.",
        f"Elasticities hold over a fixed time, the {found.near.duration:.4g} s followed."
        if found.near
        else "No elasticities: a scan has no exact derivatives.",
    ]
    if found.refused:
        what = "motion" if found.near else "scan"
        lines.append(f"{percent(found.refused, found.points)} of them have no {what}: refused.")
    partly = [
        f"{label(n)} {100 * x.kept:.3g} %" for n, x in found.over.items() if 0.0 < x.kept < 1.0
    ]
    if partly:
        lines.append(
            "Rows where a number exists at every point; its indices hold there: "
            f"{', '.join(partly)}."
        )
    nothing = [label(name) for name, x in found.over.items() if x.kept == 0.0]
    if nothing:
        lines.append(f"Nowhere: {', '.join(nothing)}.")
    constant = [label(name) for name, x in found.over.items() if x.spread == 0.0]
    if constant:
        lines.append(f"The same everywhere: {', '.join(constant)}.")
    lines += [
        f"{template.NUMBERS[key].symbol}: some derivatives do not exist, {why}."
        for key, why in (found.near.gaps.items() if found.near else ())
    ]
    return lines


def robustness_report(plan: Plan, found: Robustness) -> RenderableType:
    """Spread of the watched numbers, yield, and the worst cases."""
    from rich.console import Group

    tables: list[RenderableType] = [_spread(found)]
    if found.all_met:
        tables.append(_yield(found, found.all_met))
        tables.append(_worst_cases(plan, found))
    return Group(*tables, *_draws(plan, found))


def _spread(found: Robustness) -> Table:
    """Quantiles over all designs of which the number exists."""
    from pindrive.report import new_table

    heads = ("number", ">design", *(f">{100 * q:g} %" for q in QUANTILES), "unit", ">exists in")
    made = new_table("How the designs scatter: quantiles", *heads)
    for name, values in found.values.items():
        quantity = NUMBERS[name]
        known = values[np.isfinite(values)]
        ends = np.quantile(known, QUANTILES) if known.size else np.full(len(QUANTILES), np.nan)
        shown = (quantity.digits(float(x)) for x in (found.own[name], *ends))
        unit = quantity.display_unit
        made.add_row(label(name), *shown, unit, percent(known.size, found.count))
    return made


def _yield(found: Robustness, all_met: Share) -> Table:
    from pindrive.report import new_table

    made = new_table("Yield", "demand", ">met by", "95 % interval")
    for demand, share in found.shares:
        made.add_row(demand.text(), *_share(share))
    if len(found.shares) > 1:
        made.add_row("all", *_share(all_met), style="bold")
    return made


def _share(share: Share) -> tuple[str, str]:
    low, high = 100.0 * share.low, 100.0 * share.high
    return f"{100.0 * share.met / share.of:.3f} %", f"{low:.3f} to {high:.3f} %"


def _worst_cases(plan: Plan, found: Robustness) -> Table:
    """The values at which each demand is missed by the most, beside the design's own."""
    from pindrive.report import new_table

    heads = (f">{label(case.demand.name)}" for case in found.worst)
    made = new_table("The worst found for", "key", ">design", *heads, "unit")
    for key in found.worst[0].keys:
        quantity, own = template.NUMBERS[key], base_value(plan.device, key)
        values = [quantity.digits(case.keys[key]) for case in found.worst]
        shown = quantity.digits(own) if isinstance(own, float) else "-"
        made.add_row(key, shown, *values, quantity.display_unit)
    results = []
    for case in found.worst:
        quantity = NUMBERS[case.demand.name]
        results.append("never" if np.isnan(case.value) else quantity.text(case.value))
    made.add_row("gives", "", *results, "", style="bold")
    sampled = []
    for case in found.worst:
        quantity = NUMBERS[case.demand.name]
        sampled.append("never" if np.isnan(case.sampled) else quantity.text(case.sampled))
    made.add_row("among the draws", "", *sampled, "")
    return made


def _draws(plan: Plan, found: Robustness) -> list[str]:
    lines = [f"{count(found.count)} independent random draws, seed {found.seed}."]
    if found.refused:
        what = "scan" if plan.page else "motion"
        lines.append(f"{percent(found.refused, found.count)} of them have no {what}: refused.")
    for case in found.worst if plan.device.path != plan.path else ():
        given = " ".join(
            f'--set {key}="{template.NUMBERS[key].written(value)}"'
            for key, value in case.keys.items()
        )
        command = (
            f"scan {plan.device.path} {plan.page.page.options}"
            if plan.page
            else f"simulate {plan.device.path}"
        )
        lines.append(f"Worst {label(case.demand.name)}: pindrive {command} {given}")
    if not found.all_met:
        lines.append("No specification is given: write what is demanded in [specification].")
    return lines


def count(number: int) -> str:
    """A count with its thousands apart: "10 000 000"."""
    return f"{number:,}".replace(",", " ")


def percent(part: int, whole: int) -> str:
    """A part of a whole: "98.5 %"; never 100 % nor 0 % by rounding."""
    if part in (0, whole):
        return "all" if part else "none"
    shown = f"{100.0 * part / whole:.3g} %"
    return f"all but {count(whole - part)}" if shown == "100 %" else shown

"""Studies as tables and text for the terminal."""

from __future__ import annotations

import json
import shlex
from functools import partial
from itertools import groupby
from math import floor, log10
from typing import TYPE_CHECKING

import numpy as np
import typer
from rich.console import Group

from pindrive.cli.tables import new_table, whole_lines
from pindrive.files.keys import NAMES, NUMERIC_KEYS
from pindrive.lazy import h5py
from pindrive.quantities.names import label
from pindrive.quantities.quantity import counted, significant
from pindrive.quantities.status import Status
from pindrive.quantities.table import QUANTITIES, digits
from pindrive.study.distributions import base_value
from pindrive.study.evaluate import why
from pindrive.study.outputs import NUMBERS, points_that_meet
from pindrive.study.runner import human_bytes
from pindrive.study.slices import QUANTITY, elasticity, words
from pindrive.study.validation import coefficient_words

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from rich.console import RenderableType
    from rich.table import Table

    from pindrive.quantities.quantity import Quantity
    from pindrive.study.bifurcation import Bifurcation, BranchChange, SteadyMotion
    from pindrive.study.evaluate import RefusedPoints
    from pindrive.study.local_sensitivity import Elasticities
    from pindrive.study.outputs import Share
    from pindrive.study.robustness import Robustness, WorstCase
    from pindrive.study.runner import Sweep
    from pindrive.study.sensitivity import SobolIndices
    from pindrive.study.slices import Panel
    from pindrive.study.study import Study

QUANTILES = (0.01, 0.05, 0.5, 0.95, 0.99)
_SLICE = 1 << 24
"""Points of which the status is read at a time."""


def sweep_report(study: Study, done: Sweep) -> list[str]:
    """The result of a sweep, in lines."""
    points, size = counted(done.points, "point"), human_bytes(done.path.stat().st_size)
    if not done.complete:
        of = counted(study.size, "point")
        lines = [f"Stopped at {count(done.points)} of {of}; --resume continues"]
    elif done.worked_out:
        speed = count(round(done.worked_out / done.seconds))
        resumed = (
            "" if done.worked_out == done.points else f", {count(done.worked_out)} of them now"
        )
        lines = [
            f"Wrote {done.path}: {points}{resumed}, {size}, "
            f"in {significant(done.seconds, 3)} s ({speed} a second)"
        ]
    else:
        lines = [f"{done.path} is complete: {points}, {size}"]
    numbered = done.points - done.refused
    if numbered and done.settled >= 0:
        of_them = " of those with numbers" if done.refused else ""
        lines.append(f"settled: {percent(done.settled, numbered)}{of_them}")
    if done.complete:
        lines += compliance_words(done.path)
    if done.refused and done.complete:
        lines.append(f"without numbers: {percent(done.refused, done.points)}, by their status")
        lines += [_why_without(study, done, *status) for status in _statuses(done)]
    return lines


def compliance_words(path: Path) -> list[str]:
    """Return the number of points of a study's file that meet its specification; "" without one."""
    counts = points_that_meet(path)
    if counts is None or not counts[1]:
        return []
    of = counted(counts[1], "point")
    return [f"specification met: {percent(*counts)} of {of} that exist"]


def _why_without(study: Study, done: Sweep, status: str, number: int, first: int) -> str:
    """Return the number of points with a status, and the reason of the first one."""
    columns = study.columns(first, first + 1)
    at = {key: float(values.ravel()[0]) for key, values in columns.items()}
    reason = why(study, at)
    shown = f"{'' if number == 1 else ', the first'}: {reason}" if reason else ""
    return f"  {percent(number, done.points)} {status}{shown}"


def _statuses(done: Sweep) -> list[tuple[str, int, int]]:
    """Return each status but ok, with its count and its first point, the most frequent first."""
    found: dict[int, tuple[int, int]] = {}
    with h5py.File(done.path, "r") as file:
        status = file["status"]
        inner = max(1, status.size // status.shape[0])
        rows = max(1, _SLICE // inner)
        for begin in range(0, status.shape[0], rows):
            part = status[begin : begin + rows].ravel()
            for flag, first, number in zip(*np.unique(part, True, False, True), strict=True):
                before, place = found.get(int(flag), (0, begin * inner + int(first)))
                found[int(flag)] = (before + int(number), place)
    named = [(Status(flag).name, *of) for flag, of in found.items() if flag]
    return sorted(named, key=lambda of: -of[1])


def slice_words(panel: Panel) -> str:
    """The least and the largest value of a slice, where they are, and how many points lack one."""
    exists, held = ~np.isnan(panel.values), _where(panel.at)
    name = f"{words(panel.number)} at {held}" if held else words(panel.number)
    lacking = int((~exists).sum())
    without = f"; without one: {percent(lacking, exists.size)}" if lacking else ""
    if not exists.any():
        return f"{name}{without}"

    def place(index: int) -> str:
        at = np.unravel_index(index, panel.values.shape)
        found = _short(panel.number, float(panel.values[at]))
        places = (float(along[i]) for along, i in zip(panel.along, at, strict=True))
        return f"{found} ({_where(dict(zip(panel.keys, places, strict=True)))})"

    least, largest = int(np.nanargmin(panel.values)), int(np.nanargmax(panel.values))
    return f"{name}: {place(least)} to {place(largest)}{without}"


def _where(at: Mapping[str, float]) -> str:
    """Values of keys, in a line."""
    return ", ".join(f"{words(key)} {_short(key, value)}" for key, value in at.items())


def _short(name: str, value: float) -> str:
    """The value of a variable with its unit."""
    quantity = QUANTITY[name]
    return f"{digits(value * quantity.display_scale)} {quantity.display_unit}".rstrip()


def bifurcation_report(found: Bifurcation) -> RenderableType:
    """A line for each range of the parameter in which the motions are alike."""
    quantity, length = NUMERIC_KEYS[found.key], QUANTITIES["displacement"]
    heads = (">from", ">to", "up", ">amplitude", "down", ">amplitude")
    made = new_table(f"Steady motions over {found.key}", *heads)
    unit, mm = quantity.display_unit, length.display_unit
    made.add_row(unit, unit, "", mm, "", mm, style="dim")
    pairs = zip(found.up, found.down, strict=True)
    alike = groupby(pairs, lambda pair: [(each.end, len(each.points)) for each in pair])
    for _, group in alike:
        both = [*group]
        ends = [quantity.digits(both[i][0].value) for i in (0, -1)]
        cells = []
        for branch in zip(*both, strict=True):
            low, high = (length.digits(f(m.amplitude for m in branch)) for f in (min, max))
            cells += [_kind(branch[0]), low if low == high else f"{low} to {high}"]
        made.add_row(*ends, *cells)
    lines = [f"{repr(found)[1:-1]}.", *map(partial(_change, quantity), found.changes)]
    return Group(made, *whole_lines(lines))


def _change(quantity: Quantity, change: BranchChange) -> str:
    """Return the bracket of an end or a jump of a branch, in a sentence."""
    ends = sorted((change.last, change.first))
    low, high = (end * quantity.display_scale for end in ends)
    digits = max(1, 1 - floor(log10(high - low))) if high > low else 6
    between = f"between {low:.{digits}f} and {high:.{digits}f} {quantity.display_unit}".rstrip()
    before, after = _kind(change.before), _kind(change.after)
    what = "jumps" if before == after else "ends"
    then = "" if before == after else f"; then {after}"
    return f"Parameter {change.direction}: {before} {what} {between}{then}."


def _kind(motion: SteadyMotion) -> str:
    """Return how a motion ends, in words."""
    name = motion.end.name.replace("_", " ")
    count = len(motion.points)
    return name if count < 2 else f"{name}, {counted(count, 'turning point')}"


def sobol_report(found: SobolIndices) -> RenderableType:
    """Three tables: elasticities, and Sobol' indices of first order and in total."""
    varied = [name for name in found.over if found.over[name].spread > 0.0]
    tables: list[RenderableType] = [_near(found, found.near)] if found.near else []
    for title, order in (
        ("Over the whole ranges: part of the variance due to, by itself", "first"),
        ("Over the whole ranges: part of the variance due to, with all interactions", "total"),
    ):
        cell = partial(_index, found, order)
        tables.append(_by_key(title, found.keys, varied, cell))
    return Group(*tables, *_notes(found))


def _near(found: SobolIndices, near: Elasticities) -> Table:
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
    heads = [NUMERIC_KEYS[key].symbol for key in keys]
    made = new_table(title, "number", *(f">{head}" for head in heads))
    for name in names:
        made.add_row(label(name), *(cell(name, i) for i in range(len(keys))))
    return made


def _index(found: SobolIndices, order: str, name: str, i: int) -> str:
    """An index and half its interval: "0.41 ±.02"; one that may be none is a point."""
    interval = getattr(found.over[name], order)
    value, half = interval.value[i], 0.5 * (interval.high[i] - interval.low[i])
    if np.isnan(value):
        return "-"
    if value < 0.005 and half < 0.02:
        return "·"
    return f"{max(value, 0.0):.2f} ±{half:.2f}".replace("±0.", "±.")


def _notes(found: SobolIndices) -> list[str]:
    """Return the notes on omitted values and on the sample sizes."""
    design = f"{counted(found.points, 'point')} (Sobol' design of {counted(found.rows, 'row')})"
    lines = [
        f"{design}; ± half of the 95 % bootstrap interval; · below 0.005.",
        f"Elasticities hold over a fixed time, the {found.near.duration:.4g} s followed."
        if found.near
        else "No elasticities: a scan has no exact derivatives.",
    ]
    lines += _refused(found.refusals, found.points, "point")
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
        f"{NUMERIC_KEYS[key].symbol}: some derivatives do not exist, {why}."
        for key, why in (found.near.gaps.items() if found.near else ())
    ]
    return lines


def _refused(found: Sequence[RefusedPoints], of: int, what: str) -> list[str]:
    """Return the number of designs that cannot exist and are left out, with the reasons."""
    if not found:
        return []
    number = sum(refusal.count for refusal in found)
    said = f"cannot exist and {'is' if number == 1 else 'are'} left out"
    lines = [f"{count(number)} of {counted(of, what)} ({percent(number, of)}) {said}:"]
    for refusal in found:
        first = "" if refusal.count == 1 else ", the first"
        lines.append(f"  {count(refusal.count)}{first}: {refusal.reason}")
    return lines


def robustness_report(study: Study, found: Robustness) -> RenderableType:
    """Spread of the watched numbers, yield, and the worst cases."""
    tables: list[RenderableType] = [_spread(found)]
    if found.all_met:
        tables.append(_yield(found, found.all_met))
        tables.append(_worst_cases(study, found))
    lines = whole_lines(_draws(study, found))
    return Group(*tables, *lines)  # a command that is broken into lines cannot be copied


def _spread(found: Robustness) -> Table:
    """Quantiles over all designs of which the number exists."""
    heads = ("number", ">design", *(f">{100 * q:g} %" for q in QUANTILES), "unit", ">exists in")
    made = new_table("Quantiles of the designs", *heads)
    for name, values in found.values.items():
        quantity = NUMBERS[name]
        known = values[np.isfinite(values)]
        ends = np.quantile(known, QUANTILES) if known.size else np.full(len(QUANTILES), np.nan)
        shown = (quantity.digits(float(x)) for x in (found.own[name], *ends))
        unit = quantity.display_unit
        made.add_row(label(name), *shown, unit, percent(known.size, found.designs))
    return made


def _yield(found: Robustness, all_met: Share) -> Table:
    title = f"Yield: of {counted(found.designs, 'design')}"
    made = new_table(title, "constraint", ">met by", "95 % interval", ">without a number")
    for constraint, share in found.shares:
        made.add_row(constraint.text(), *_share(share), percent(share.without, share.of))
    if len(found.shares) > 1:
        made.add_row("all", *_share(all_met), "", style="bold")
    return made


def _share(share: Share) -> tuple[str, str]:
    low, high = 100.0 * share.low, 100.0 * share.high
    return share.text, f"{low:.3f} to {high:.3f} %"


def _worst_cases(study: Study, found: Robustness) -> Table:
    """The values at which each constraint is missed by the most, beside the design's own."""
    heads = (f">{label(case.constraint.name)}" for case in found.worst)
    made = new_table("The worst found for", "key", ">design", *heads, "unit")
    for key in found.worst[0].keys:
        quantity, own = NUMERIC_KEYS[key], base_value(study.device, key)
        values = [quantity.digits(case.keys[key]) for case in found.worst]
        shown = quantity.digits(own) if isinstance(own, float) else "-"
        made.add_row(key, shown, *values, quantity.display_unit)
    results = []
    for case in found.worst:
        quantity = NUMBERS[case.constraint.name]
        results.append("never" if np.isnan(case.value) else quantity.text(case.value))
    made.add_row("gives", "", *results, "", style="bold")
    sampled = []
    for case in found.worst:
        quantity = NUMBERS[case.constraint.name]
        sampled.append("never" if np.isnan(case.sampled) else quantity.text(case.sampled))
    made.add_row("among the draws", "", *sampled, "")
    return made


def _draws(study: Study, found: Robustness) -> list[str]:
    lines = [f"{counted(found.draws, 'independent random draw')}, seed {found.seed}."]
    lines += _refused(found.refusals, found.draws, "draw")
    if any(share.without for _, share in found.shares):
        lines.append("A design without such a number (for example not settled) violates its limit.")
    if found.stopped:
        stopped = counted(found.stopped, "design was", "designs were")
        lines.append(f"{stopped} followed only up to the largest number of events.")
    for case in found.worst if study.device.path != study.path else ():
        given = " ".join(
            [
                *(f"--set {key}={shlex.quote(text)}" for key, text in _set_besides(study, case)),
                *(
                    f'--set {key}="{NUMERIC_KEYS[key].written(value)}"'
                    for key, value in case.keys.items()
                ),
            ]
        )
        command = (
            f"scan {study.device.path} {study.page.page.options}"
            if study.page
            else f"simulate {study.device.path}"
        )
        lines.append(f"Worst {label(case.constraint.name)}: pindrive {command} {given}")
    if not found.all_met:
        lines.append("No specification is given: write what is required in [specification].")
    return lines


def _set_besides(study: Study, case: WorstCase) -> Iterator[tuple[str, str]]:
    """Return the settings of the study beside the case, as the command line takes them."""
    for setting in study.device.settings:
        (key,) = NAMES.matches(setting.key)
        if key not in case.keys:
            value = setting.value
            yield key, value if isinstance(value, str) else json.dumps(value)


def say_coefficient(study: Study, *, tolerances: bool = False) -> None:
    """Print what becomes of the plate's friction coefficient, where the study changes it."""
    found = coefficient_words(study, tolerances=tolerances)
    if found:
        words, doubtful = found
        typer.echo(f"warning: {words}" if doubtful else words, err=doubtful)


def count(number: int) -> str:
    """A count with its thousands apart: "10 000 000"."""
    return f"{number:,}".replace(",", " ")


def percent(part: int, whole: int) -> str:
    """A part of a whole: "98.5 %"; never 100 % nor 0 % by rounding."""
    if part in (0, whole):
        return "all" if part else "none"
    shown = f"{100.0 * part / whole:.3g} %"
    return f"all but {count(whole - part)}" if shown == "100 %" else shown

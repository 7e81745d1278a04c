"""Designs as tables and words in a terminal."""

from __future__ import annotations

from math import isclose, isfinite, isnan
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType

from pindrive.cli.tables import new_table, whole_lines
from pindrive.files.keys import NUMERIC_KEYS
from pindrive.optimisation.catalogue import short_keys
from pindrive.optimisation.margins import WORSE
from pindrive.optimisation.results import shown
from pindrive.quantities.names import label
from pindrive.quantities.quantity import counted, significant
from pindrive.study.outputs import Constraint

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rich.table import Table

    from pindrive.optimisation.goals import Limit
    from pindrive.optimisation.results import ConstraintResult, Design, Front

MOST_OF_FRONT = 12
"""Designs of a front that are shown."""


def design_report(found: Design) -> RenderableType:
    """The design, its goals and constraints, the front, the nearest parts, and what is doubtful."""
    tables: list[RenderableType] = [_values(found), _limits(found)]
    if found.margins:
        tables.append(_margins(found))
    if found.front:
        tables.append(_front(found, found.front))
    if found.alternatives:
        tables.append(_alternatives(found))
    return Group(*tables, *whole_lines(_words(found)))


def _values(found: Design) -> Table:
    name = found.problem.study.name or found.device.name
    title = f"Design: {name}" if found.feasible else f"No design meets the constraints of {name}"
    table = new_table(title, "key", ">value", "unit", ">before", "chosen")
    before = found.problem.study.device.values()
    of = {key: v for v in found.problem.variables for key in v.axes}
    ends = dict(found.at_ends)
    for key, value in found.values.items():
        quantity, old = NUMERIC_KEYS[key], before.get(key)
        variable = of.get(key)
        if variable is None:
            how = "follows"
        elif variable.catalogue:
            how = f"{variable.name} {found.parts[variable.name]}"
        elif variable.choices:
            how = f"of {variable.choices}"
        else:
            how = f"at its {ends[key]} end" if key in ends else "free"
        was = quantity.digits(old) if isinstance(old, float) else "-"
        digits = _exact(key, value) if key in of else quantity.digits(value)
        table.add_row(key, digits, quantity.display_unit, was, how)
    return table


def _exact(key: str, value: float) -> str:
    """Return a value in display units, with the digits that give it back, four at least."""
    shown_ = NUMERIC_KEYS[key].display_scale * value
    texts = (significant(shown_, digits) for digits in range(4, 18))
    return next((text for text in texts if isclose(float(text), shown_, rel_tol=1e-12)), "-")


def _margins(found: Design) -> Table:
    """The way of each variable until a number changes, and what changes there."""
    title = "How far each variable may move, all else unchanged"
    table = new_table(title, "key", ">may move to", ">by", "what changes there")
    for margin in found.margins:
        key = next(iter(margin.variable.axes))
        for name, end in ((key, margin.below), ("", margin.above)):
            part = f"{100.0 * (end.value / margin.value - 1.0):+.2g} %" if margin.value else ""
            table.add_row(name, NUMERIC_KEYS[key].text(end.value), part, _end(end))
    return table


def _end(end: Limit) -> str:
    """Return what changes at the end of a way."""
    if end.number is None:
        return "the range ends"
    name = end.number.name
    if isnan(end.reached):
        return f"no {label(name)}"
    if end.jumps:
        return f"{label(name)} jumps to {shown(name, end.reached)}"
    if isinstance(end.number, Constraint):
        return f"{end.number.text()} is violated"
    return f"{label(name)} is {100.0 * WORSE:g} % worse"


def _limits(found: Design) -> Table:
    """Goals, then constraints, each at its worst condition."""
    gain = f">for {100.0 * found.gain:g} % gain"
    heads = ["goal or constraint", ">worst", ">margin", gain]
    conditions = [key for condition in found.problem.conditions for key in condition.axes]
    worst = f">worst at {short_keys(tuple(conditions))}"
    table = new_table("Goals and constraints", *heads, *([worst] if conditions else []))
    for reached in found.goals:
        row = [reached.goal.text(), shown(reached.goal.name, reached.value), "", ""]
        table.add_row(*row, *([_case(reached.case)] if conditions else []))
    for required in found.constraints:
        name = required.constraint.name
        over = required.excess
        margin = shown(name, -over) if isfinite(over) else "no number"
        row = [required.constraint.text(), shown(name, required.value), margin, _relaxed(required)]
        table.add_row(*row, *([_case(required.case)] if conditions else []))
    return table


def _relaxed(required: ConstraintResult) -> str:
    """Return the limit that would give the gain."""
    if not required.binds:
        return "-"
    constraint = required.constraint
    side = "≤" if constraint.at_most else "≥"
    return f"{side} {shown(constraint.name, required.relaxed)}"


def _case(case: Mapping[str, float]) -> str:
    return ", ".join(NUMERIC_KEYS[key].text(value) for key, value in case.items())


def _front(found: Design, front: Front) -> Table:
    names = [reached.goal.name for reached in found.goals]
    keys = [next(iter(v.axes)) for v in found.problem.variables]
    heads = [f">{label(name)}" for name in names] + [f">{short_keys((key,))}" for key in keys]
    title = f"Front: {counted(len(front.goals), 'design')}, of which none is better in all goals"
    table = new_table(title, *heads, "")
    rows = np.unique(np.linspace(0, len(front.goals) - 1, MOST_OF_FRONT).round().astype(int))
    for i in np.union1d(rows, [front.chosen]):
        table.add_row(
            *(shown(name, value) for name, value in zip(names, front.goals[i], strict=True)),
            *(NUMERIC_KEYS[key].text(front.columns[key][i]) for key in keys),
            "the design" if i == front.chosen else "",
        )
    return table


def _alternatives(found: Design) -> Table:
    names = [reached.goal.name for reached in found.goals]
    values = (f">{label(name)}" for name in names)
    heads = ["catalogue", "part", ">part price", *values, "violations"]
    table = new_table("Nearest parts, all else unchanged", *heads)
    for other in found.alternatives:
        table.add_row(
            other.catalogue,
            other.part,
            "-" if isnan(other.price) else significant(other.price),
            *(
                "-" if not isfinite(value) else shown(name, value)
                for name, value in zip(names, other.goals, strict=True)
            ),
            ", ".join(
                f"{label(constraint.name)} by {shown(constraint.name, over)}"
                if isfinite(over)
                else f"{label(constraint.name)}: no number"
                for constraint, over in other.violations
            )
            or "nothing",
        )
    return table


def _steady(found: Design) -> list[str]:
    """Return the design with a margin in words; nothing where the design has that margin itself."""
    best = found.steady
    if best is None:
        return []
    values = [
        f"{short_keys((key,))} {_exact(key, best.values[key])} {NUMERIC_KEYS[key].display_unit}"
        for v in found.problem.variables
        if not v.catalogue
        for key in v.axes
    ]
    parts = [f"{name} {part}" for name, part in best.parts.items()]
    goals = (
        f"{label(reached.goal.name)} {shown(reached.goal.name, value)}"
        for reached, value in zip(found.goals, best.goals, strict=True)
    )
    return [
        f"Best design with a margin of {100.0 * best.margin:g} % in each variable: "
        f"{', '.join(x.rstrip() for x in (*values, *parts))}; {', '.join(goals)} at worst"
    ]


def _words(found: Design) -> list[str]:
    lines = []
    if not found.feasible:
        lines.append(f"No design meets this: {found.closest}.")
    if found.built:
        share = found.built
        lines.append(
            f"Yield within the tolerances: {share.text} of {counted(share.of, 'device')} "
            f"(95 % interval {100.0 * share.low:.3f} to {100.0 * share.high:.3f} %)"
            + (f", ≥ {100.0 * least:g} % required" if (least := found.problem.least_yield) else "")
        )
        if not found.problem.least_yield and share.met < 0.9 * share.of:
            lines.append(
                'A constraint on the yield leaves a margin: yield = ">= 95 %" in [specification]'
            )
    lines += _steady(found)
    binding = [d.constraint.text() for d in found.constraints if d.binds]
    if binding:
        lines.append(f"Binding: {', '.join(binding)}")
    done = [
        counted(number, noun)
        for number, noun in ((found.count.motions, "motion"), (found.count.scans, "scan"))
        if number
    ]
    lines.append(f"Simulated: {' and '.join(done)}")
    lines += [f"warning: {line}" for line in found.warnings]
    return lines

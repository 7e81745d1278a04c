"""What a study does to the plate's coefficient of friction: forces are given, mass may change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.friction import GRAVITY, KINETIC, within
from pindrive.study.links import with_links

if TYPE_CHECKING:
    from pindrive.study.plan import Columns, Plan

_MASS: Final = "drive.mass"
_KINETIC: Final = "plate.kinetic"
_PRESSING: Final = "magnet.pressing"
_PARTS: Final = (_MASS, _KINETIC, _PRESSING)


def coefficient_range(plan: Plan, *, tolerances: bool) -> tuple[float, float] | None:
    """The least and the largest kinetic coefficient of the plate; None where it does not change.

    Args:
        plan: the study.
        tolerances: over its tolerances, not over its axes.
    """
    links = plan.tolerance_links if tolerances else plan.links
    followed = list(_PARTS)
    for key in followed:  # and what they follow, and so on
        if key in links:
            followed += [of for of in (links[key].of, links[key].over) if of and of not in followed]
    groups = [plan.tolerances] if tolerances else [d.axes for d in plan.dimensions]
    columns: list[Columns] = []
    for i, axes in enumerate(groups):
        here = [key for key in axes if key in followed]
        zipped = not tolerances and plan.dimensions[i].sample is None
        if len(here) > 1 and zipped:
            every = plan.dimensions[i].at(np.arange(plan.dimensions[i].size))
            columns.append({key: every[key] for key in here})
        else:  # each by itself; the coefficient is monotone in it, so that its ends tell
            columns += [{key: np.array(axes[key].span)} for key in here]
    lengths = [len(next(iter(column.values()))) for column in columns]
    places = np.meshgrid(*(np.arange(length) for length in lengths), indexing="ij")
    spread = {
        key: values[index.ravel()]
        for column, index in zip(columns, places, strict=True)
        for key, values in column.items()
    }
    found = plan.values | with_links(plan.device, spread, links)
    pressing = found.get(_PRESSING)
    force = found[_MASS] * GRAVITY if pressing is None else pressing
    # A spread that goes down to no mass has no upper end.
    with np.errstate(divide="ignore", invalid="ignore"):
        coefficient = np.asarray(found[_KINETIC] / np.maximum(force, 0.0))
    low, high = float(coefficient.min()), float(coefficient.max())
    return (low, high) if high > low * (1.0 + 1e-9) else None


def coefficient_words(plan: Plan, *, tolerances: bool = False) -> str | None:
    """The same in a sentence, a warning where it leaves what handbooks say; None: no change."""
    found = coefficient_range(plan, tolerances=tolerances)
    if found is None:
        return None
    low, high = found
    over = "the tolerances" if tolerances else "the study"
    known = all(within(value, KINETIC) for value in found)
    warning = "" if known else "warning: "
    doubt = f"; steel on steel has {KINETIC[0]:.2f} to {KINETIC[1]:.2f} in handbooks"
    return (
        f"{warning}the plate's friction coefficient, plate.kinetic over what presses, goes from "
        f"{low:.3g} to {high:.3g} over {over}{'' if known else doubt}"
    )

"""A device file with the values of a design, and what they are worth."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.files.device_text import device_text
from pindrive.optimisation.results import shown
from pindrive.study.outputs import label

if TYPE_CHECKING:
    from pathlib import Path

    from pindrive.optimisation.results import Design


def designed_file(found: Design, target: Path) -> str:
    """The text of a device file.

    Args:
        found: the design.
        target: where the text will stand; paths in it are relative to that.
    """
    head = [
        "Designed by pindrive.",
        f"Wish: {found.wish.plan.path.name}, {found.wish.plan.name}; seed {found.seed}.",
    ]
    if not found.feasible:
        head.append(f"No design meets the demands; {found.closest}.")
    head += [
        f"{reached.goal.text()}: {shown(reached.goal.name, reached.value)}"
        for reached in found.goals
    ]
    head += [f"part {name}: {part}" for name, part in found.parts.items()]
    head += [
        f"{demanded.demand.text()}: {label(demanded.demand.name)} is "
        f"{shown(demanded.demand.name, demanded.value)} at worst"
        for demanded in found.demands
    ]
    comments = {key: ["chosen by the design"] for v in found.wish.variables for key in v.axes}
    return device_text(found.device, {}, target, [*head, *found.warnings], comments)

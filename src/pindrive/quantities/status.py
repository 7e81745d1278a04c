"""The codes of a motion: whether it was followed to its end, and how it ends.

The numbers are the same in the core, in datasets and in the files of studies.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, Literal

import numpy as np

from pindrive.quantities.drive import DRIVE_QUANTITIES, PARTS

__all__ = ["OUTCOMES", "End", "Side", "SimulationError", "Status", "outcome_attributes"]

Side = Literal["left", "right"]
"""One-sided limit of a motion at an event."""


class Status(IntEnum):
    """Status of a motion or a scan: complete, or the reason for its end or its absence.

    The values below `incomplete` are those of `Status` in model.hpp: there are numbers, up to where
    the simulation stopped. From `refused` on there is no motion. A result made from many motions,
    or of derivatives, is `incomplete` where some of them do not exist.
    """

    ok = 0
    too_many_events = 1
    standstill = 2
    stopped = 3
    inconsistent = 4
    too_many_periods = 5
    incomplete = 14
    refused = 15
    bad_mass = 16
    bad_stiffness = 17
    bad_damping = 18
    bad_plate_kinetic = 19
    bad_plate_static = 20
    bad_finger_kinetic = 21
    bad_finger_static = 22
    bad_finger_stiffness = 23
    bad_mouse_velocity = 24
    bad_displacement = 25
    bad_velocity = 26
    bad_duration = 27
    bad_settling_band = 28
    bad_plate_load = 29
    bad_damping_ratio = 30
    bad_phase = 31
    bad_travel = 32
    bad_stop_stiffness = 33
    bad_stop_damping = 34
    bad_finger_damping = 35

    def __str__(self) -> str:
        """Its name, such as "ok"."""
        return self.name

    @property
    def exists(self) -> bool:
        """True if a motion exists, complete or up to the time at which it was stopped."""
        return self < Status.refused

    @property
    def explanation(self) -> str:
        """Explanation of the status, with the remedy."""
        if self > Status.refused:
            bad = self.name.removeprefix("bad_")
            known = {quantity.name: quantity.meaning for quantity in (*DRIVE_QUANTITIES, *PARTS)}
            name = bad if bad in known else bad.replace("_", ".", 1)
            return f"{name} is out of its range: {known[name]}"
        return _EXPLANATIONS[self]


_EXPLANATIONS = {
    Status.ok: "followed to the end",
    Status.too_many_events: (
        "stopped at a million segments before its ending or the end of its duration; give a "
        "shorter duration"
    ),
    Status.too_many_periods: (
        "stopped after 50 000 periods in which the motion neither ended nor repeated, nor steadily "
        "grew or decayed; give a duration"
    ),
    Status.standstill: (
        "stopped where events pile up at one instant; change a parameter by a little, and please "
        "report the drive"
    ),
    Status.inconsistent: (
        "stopped where no mode agrees with the state; change a parameter by a little, and please "
        "report the drive"
    ),
    Status.stopped: "was interrupted; run it again",
    Status.incomplete: "has parts that do not exist; the result says which and why",
    Status.refused: "cannot exist: its values contradict each other",
}


class SimulationError(ValueError):
    """A simulation that had to be given up; `status` says why."""

    def __init__(self, what: str, status: Status) -> None:
        self.what, self.status = what, status
        super().__init__(f"{what}: the simulation {status.explanation}")

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as it was made: it comes from other processes too."""
        return SimulationError, (self.what, self.status)


class End(IntEnum):
    """Ending of a motion, with the values of `End` in model.hpp; -1 without an ending."""

    unknown = -1
    moving = 0
    resting = 1
    decaying = 2
    free = 3
    grazing = 4
    stick_slip = 5
    limit_cycle = 6
    driven = 7
    irregular = 8
    drifting = 9
    growing = 10
    approaching = 11


OUTCOMES: dict[str, type[Status | End] | None] = {"status": Status, "ending": End, "events": None}
"""The variables of a dataset that say what became of a motion: codes, and a count."""
_MEANINGS = {
    "status": "whether the motion was followed to its end",
    "ending": "how the motion ends",
    "events": "changes at a contact; of a cycle, those of one round",
}


def outcome_attributes(name: str) -> dict[str, Any]:
    """The attributes of such a variable: meaning, and of codes each value with its name."""
    kind = OUTCOMES[name]
    flags: dict[str, Any] = {}
    if kind:
        flags["flag_values"] = np.array([*kind], np.int8)
        flags["flag_meanings"] = " ".join(code.name for code in kind)
    return {"long_name": _MEANINGS[name]} | flags

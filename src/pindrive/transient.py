"""The numbers of a motion as data: the transient, its ending, its energy and its certificate.

All SI; NaN where a number does not exist within the duration. `quantities.py` says what each means.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from math import isnan
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from pindrive import _core

EndKind = Literal["moving", "resting", "decaying", "steady"]
Cycle = Literal["free", "grazing", "stick-slip", "limit cycle"]

_ENDS: tuple[tuple[EndKind, Cycle | None], ...] = (
    ("moving", None),
    ("resting", None),
    ("decaying", None),
    ("steady", "free"),
    ("steady", "grazing"),
    ("steady", "stick-slip"),
    ("steady", "limit cycle"),
)
"""In the order of `End` in model.hpp."""


@dataclass(frozen=True, slots=True)
class ContactUse:
    """What one contact did during the motion."""

    reversals: int
    """How often its sliding velocity came to zero, whether the pin then stuck or crossed."""
    time_stuck: float
    """s"""
    distance_slid: float
    """m"""
    dissipated: float
    """J"""
    peak_force: float
    """Largest friction force on the pin, N."""


@dataclass(frozen=True, slots=True)
class Transient:
    """The transient after the release; the paper's names and equations in brackets."""

    peak_displacement: float
    """First turning point on the way out, or the start (x_m,a, eq. 14), m."""
    peak_time: float
    """(t_a, eq. 13), s."""
    trough_displacement: float
    """The turning point that follows (x_m,c, eq. 16), m."""
    trough_time: float
    """(t_c, eq. 15), s; infinite when the trough is approached but never reached."""
    swing: float
    """From peak to trough (eq. 17), m."""
    return_velocity: float
    """Extreme velocity on the way back (v_m,b, eq. 20), m/s."""
    return_velocity_time: float
    """(t_b, eq. 19), s."""
    first_reversal_time: float
    """First time the pin stops sliding on the plate (t_1, eq. 21), s."""
    settling_time: float
    """The paper's time of the transitional period, s: from then on x stays within the settling band
    about x_end; for a steady oscillation, when that begins."""
    rest_time: float
    """From then on the pin is at rest for good, s; infinite for a motion that never comes to rest:
    one that decays without end, or a steady oscillation."""
    last_event_time: float
    """Last change of a contact's state after the release, s: it sticks, slips or crosses; 0 without
    any, infinite where they go on for ever, as in a stick-slip cycle."""
    peak_stretch: float
    """Largest stretch of a compliant finger's skin, m; NaN for a rigid one."""
    peak_stretch_rate: float
    """How fast it stretched or relaxed at the most, m/s."""
    plate: ContactUse
    finger: ContactUse

    @property
    def settled(self) -> bool:
        """Whether the motion settled within its duration."""
        return not isnan(self.settling_time)


@dataclass(frozen=True, slots=True)
class Ending:
    """How a motion ends."""

    kind: EndKind
    """`resting`: at rest for ever; `steady`: an oscillation that lasts; `decaying`: a free damped
    oscillation or creep towards `position` without another event; `moving`: not known yet."""
    cycle: Cycle | None
    """Of a steady oscillation: `free` of any event, `grazing` the plate's velocity once a period,
    `stick-slip`, or a `limit cycle` that falling friction sustains without a carried phase."""
    position: float
    """Resting place, or middle of the final oscillation, m."""
    steady_since: float
    """When a steady oscillation began, s."""
    amplitude: float
    """Of a steady oscillation, m."""
    period: float
    """Of a steady oscillation, s."""

    @classmethod
    def of(cls, core: _core.Motion, numbers: dict[str, float]) -> Ending:
        """The ending that the core found, with the numbers measured on the segments."""
        kind, cycle = _ENDS[core.end]
        return cls(
            kind,
            cycle,
            numbers["end_position"],
            core.steady_since,
            numbers["amplitude"],
            core.period,
        )


@dataclass(frozen=True, slots=True)
class Ledger:
    """Where the energy came from and where it went, J.

    The damper's share is integrated, not inferred: the terms add up only if the motion is right.
    """

    kinetic_start: float
    kinetic_end: float
    spring_start: float
    spring_end: float
    skin_start: float
    """In a compliant finger."""
    skin_end: float
    plate_work: float
    """What the moving plate put in through friction."""
    inertia_work: float
    """What the housing put in by accelerating."""
    damper_dissipated: float
    plate_dissipated: float
    finger_dissipated: float
    residual: float
    """What the terms leave over: rounding alone."""


@dataclass(frozen=True, slots=True)
class Certificate:
    """The worst violation of each law over the motion, found without using the solver.

    Dimensionless: a part of the largest force, velocity, displacement or energy in the motion.
    """

    motion_law: float
    """m x'' + b x' + k x = R_plate + R_finger + m v_p'."""
    kinematics: float
    """x' and x'' are the derivatives of x."""
    friction_law: float
    """A sliding contact carries its kinetic friction."""
    force_bound: float
    """A stuck contact carries no more than its static friction."""
    sliding_sign: float
    """Friction opposes the sliding: no level was passed unseen."""
    sticking: float
    """A stuck contact does not slide."""
    continuity: float
    """x and x' do not jump."""
    transitions: float
    """A contact breaks loose or crosses only where it cannot hold."""
    energy: float
    """The ledger adds up."""
    dissipation: float
    """Friction and damper take energy, never give."""

    @property
    def worst(self) -> float:
        """The largest of all."""
        return float(max(astuple(self)))

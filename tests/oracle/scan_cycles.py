"""Scan of a pin under SUNDIALS: equal hand and pull, integrated by `sundials_modes`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from oracle import explicit_piecewise, sundials_modes
from oracle.watched_dop853 import Integrator
from pindrive import Contact, InputPiece, Profile
from pindrive.device import PinScan

SAMPLES = 300
JUST_BEFORE = 0.999
"""Fraction of the duration that is compared: at the end, where the hand stops, events may differ.
"""


@dataclass(frozen=True)
class Distance:
    """Distance of a pin's scan from SUNDIALS."""

    events: bool
    """True if equal events happened in equal order."""
    time: float
    """Between two times of one event at the most, s."""
    position: float
    """And the rest, parts of the largest deflection, velocity, force and stretch."""
    velocity: float
    force: float
    stretch: float

    @property
    def state(self) -> float:
        return max(self.position, self.velocity, self.force, self.stretch)


def distance(pin: PinScan, tool: Integrator | None = None) -> Distance:
    """Integrate it anew, and compare.

    The hand may move across the drive as well, if it does so at all times.
    """
    if tool is None:
        oblique = isinstance(pin.motion.release.across_velocity, Profile)
        tool = sundials_modes.stiff if oblique else sundials_modes.cvode
    last = JUST_BEFORE * pin.end
    samples = np.linspace(0.0, last, SAMPLES)
    run = explicit_piecewise.solve(_inputs(pin), pin.end, samples.tolist(), tool)
    mine = [(e.contact, e.kind, e.time) for e in pin.events if e.time < last]
    theirs = [(contact, kind, time) for time, contact, kind, _, _ in run.events if time < last]
    same = [row[:2] for row in mine] == [row[:2] for row in theirs]
    times = [abs(a[2] - b[2]) for a, b in zip(mine, theirs, strict=False)]
    x, v, _, force, stretch = np.array(run.rows).T
    parts = []
    for found, true in (
        (pin.position(samples), x),
        (pin.velocity(samples), v),
        (pin.skin_force(samples), -force),
        (pin.stretch(samples), 0.0 * x if pin.motion.drive.finger.rigid else stretch),
    ):
        parts.append(float(np.abs(found - true).max() / max(np.abs(true).max(), 1e-12)))
    return Distance(same, max(times, default=0.0), *parts)


def _inputs(pin: PinScan) -> dict[str, Any]:
    motion, load = pin.motion, pin.load
    assert isinstance(motion.release.mouse_velocity, Profile)
    across, touch = motion.release.across_velocity, pin.finger_load
    return {
        "mass": motion.drive.mass,
        "stiffness": motion.drive.stiffness,
        "damping": motion.drive.damping,
        "plate": _contact(motion.drive.plate),
        "finger": _contact(motion.drive.finger),
        "mouse_velocity": [list(row) for row in motion.release.mouse_velocity.rows],
        "load": [[0.0, load]] if isinstance(load, float) else [],
        "load_pieces": None if isinstance(load, float) else [*map(_pull, load.pieces)],
        "touch": touch.rows if isinstance(touch, Profile) else [[0.0, touch]],
        "touch_power": motion.drive.load_exponent,
        "across": across.rows if isinstance(across, Profile) else [[0.0, across]],
        "displacement": 0.0,
        "velocity": 0.0,
        "skin_stretch": None if motion.drive.finger.rigid else 0.0,
    }


def _pull(piece: InputPiece) -> tuple[float, float, float, list[tuple[float, float]]]:
    value, rate = (*piece.polynomial, 0.0)[:2]
    return piece.begin, value, rate, [(term.cosine, term.decay) for term in piece.terms]


def _contact(surface: Contact) -> dict[str, Any]:
    stiffness = None if surface.rigid else surface.stiffness
    curve = surface.curve or [(0.0, surface.kinetic)]
    return {
        "curve": curve,
        "static": surface.static_friction,
        "stiffness": stiffness,
        "damping": surface.damping or 0.0,
    }

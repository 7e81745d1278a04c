"""The path that a hand takes when its pins slow it, beside the path that it intended."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.device.hand import HandPath
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import SimulationError, Status
from pindrive.quantities.value import concise, equal_by_value

if TYPE_CHECKING:
    from pindrive.device.pin_scan import ScanInputs

FAST: Final = 0.5
"""Part of the largest intended speed from which on the slowest speed counts."""
STOPPED: Final = 0.01
"""Part of the intended speed below which a hand stands."""
HOLD: Final = 0.5
"""Time for which the arm holds the end of a path that ends at rest, s."""
_INSIDE: Final = np.linspace(0.0, 1.0, 5)[:-1]
"""Places in a stretch of the path at which deviation and speed are evaluated."""

Array = NDArray[np.float64]


@equal_by_value
@concise
@dataclass(frozen=True, slots=False, kw_only=True, eq=False)
class HandMotion:
    """Path of a hand that gave way to its pins, along the drive axis.

    Attributes:
        intended: Path that the arm meant to take.
        path: Path that the hand took.
        axis: Drive axis, rad.
        ambiguous: Sampling times of the control block, s, at which the place of the hand to its
            rounding decides about a magnet: from the first of them on, another path is as right.
    """

    intended: HandPath
    path: HandPath
    axis: float
    ambiguous: tuple[float, ...]

    @cached_property
    def times(self) -> Array:
        """Times at which the numbers are evaluated, s, shape (n,)."""
        t = self.path.times
        inside = t[:-1, None] + np.diff(t)[:, None] * _INSIDE
        return np.append(inside.ravel(), t[-1])

    def deviation(self, t: ArrayLike) -> Array:
        """Place of the hand less the intended place along the axis at times t (s), m."""
        (x, y), (x0, y0) = self.path.position(t), self.intended.position(t)
        return self._along(x - x0, y - y0)

    def speed(self, t: ArrayLike) -> Array:
        """Speed the way of the intended motion at times t (s), m/s; negative backwards."""
        own, meant = self._along(*self.path.velocity(t)), self._along(*self.intended.velocity(t))
        return own * np.where(meant < 0.0, -1.0, 1.0)

    def intended_speed(self, t: ArrayLike) -> Array:
        """Size of the intended velocity along the axis at times t (s), m/s."""
        return np.abs(self._along(*self.intended.velocity(t)))

    def _along(self, x: Array, y: Array) -> Array:
        along: Array = x * np.cos(self.axis) + y * np.sin(self.axis)
        return along

    @cached_property
    def _slowest(self) -> tuple[float, float]:
        meant = self.intended_speed(self.times)
        fast = meant >= FAST * meant.max()
        speeds = np.where(fast, self.speed(self.times), inf)
        i = int(np.argmin(speeds))
        return float(speeds[i]), float(self.times[i])

    @property
    def slowest_speed(self) -> float:
        """Least speed, m/s, while the intended speed is at least half its largest."""
        return self._slowest[0]

    @property
    def slowest_time(self) -> float:
        """Time of the least speed, s."""
        return self._slowest[1]

    @cached_property
    def mean_speed(self) -> float:
        """Mean speed, m/s, while the intended speed is at least half its largest."""
        meant = self.intended_speed(self.times)
        fast = meant >= FAST * meant.max()
        weights = np.diff(self.times, append=self.times[-1]) * fast
        return float((weights * self.speed(self.times)).sum() / weights.sum())

    @cached_property
    def error(self) -> float:
        """Largest distance from the intended path, m."""
        return float(np.abs(self.deviation(self.times)).max())

    @cached_property
    def stops(self) -> tuple[tuple[float, float], ...]:
        """Times from when to when the hand stood or went back, s, where it meant to move."""
        meant = self.intended_speed(self.times)
        moving = meant >= FAST * meant.max()
        stands = moving & (self.speed(self.times) <= STOPPED * meant)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], stands, [False]]).astype(int)))
        last = len(self.times) - 1
        return tuple(
            (float(self.times[a]), float(self.times[min(b, last)]))
            for a, b in zip(edges[::2], edges[1::2], strict=True)
        )

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of the path, SI, by the names of the table of quantities."""
        return {
            "hand.slowest_speed": self.slowest_speed,
            "hand.mean_speed": self.mean_speed,
            "hand.path_error": self.error,
            "hand.stopped": sum(end - begin for begin, end in self.stops),
        }


def follow_hand(given: ScanInputs) -> tuple[ScanInputs, HandMotion]:
    """Return the inputs of a scan with the path that the hand takes, and that path.

    Hand and pins are followed together, exactly; the control block samples the page where the hand
    is. Between two rows of the path its velocity is a polynomial of degree 4, within 1e-10 of the
    largest speed; where a pin strikes a rigid stop the velocity jumps, within 0.5 ns. Where the
    intended path ends at rest, the arm holds its end for another half
    second.

    Args:
        given: Inputs of a scan, whose path is the intended one.

    Raises:
        ValueError: The path is not along the drive axis, or the drive has a friction law that
            depends on the speed.
        SimulationError: The simulation had to be given up.
    """
    device, intended = given.device, given.path
    assert device.hand
    _check(given)
    given = replace(given, path=_held(intended))
    intended = given.path
    times, velocity, bends, ambiguous, status, *_ = given.core().hand(device.hand.core)
    if status != Status.ok:
        raise SimulationError("the hand with its pins", Status(status))
    way = device.array.direction
    bends = bends.reshape(-1, 3)
    path = HandPath(
        times,
        velocity * way[0],
        velocity * way[1],
        (float(intended.x[0]), float(intended.y[0])),
        intended.about,
        bend_x=bends * way[0],
        bend_y=bends * way[1],
    )
    motion = HandMotion(
        intended=intended, path=path, axis=device.array.axis, ambiguous=tuple(sorted({*ambiguous}))
    )
    return replace(given, path=path), motion


def _held(path: HandPath) -> HandPath:
    """Return a path that stays where it ends at rest, until the hand has come there too."""
    if path.vx[-1] or path.vy[-1]:
        return path
    bends = {
        name: np.vstack([bend, np.zeros(3)])
        for name, bend in (("bend_x", path.bend_x), ("bend_y", path.bend_y))
        if len(bend)
    }
    times = np.append(path.times, path.end + HOLD)
    start = float(path.x[0]), float(path.y[0])
    return HandPath(
        times, np.append(path.vx, 0.0), np.append(path.vy, 0.0), start, path.about, **bends
    )


def _check(given: ScanInputs) -> None:
    """Refuse a path or a drive with which the hand cannot be followed."""
    drive, axis = given.device.drive, given.device.array.axis
    if not isinstance(given.path.across_velocity(axis), float):
        largest, _ = given.path.angles(axis)
        required = "along the drive axis for a hand that gives way"
        words = f"a path at up to {np.degrees(largest):.3g} degrees to it"
        raise ValueError(refusal("the path of the hand", required, words))
    for name, contact in (("plate", drive.plate), ("finger", drive.finger)):
        if contact.curved:
            required = "Coulomb friction for a hand that gives way"
            raise ValueError(refusal(name, required, "friction that depends on the speed"))

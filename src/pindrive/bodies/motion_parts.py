"""The parts of a motion of several bodies: bodies, contacts, stops and the rest over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import _core
from pindrive.bodies.inputs import Given, integrated
from pindrive.bodies.parts import GROUND
from pindrive.motion.release import numbers_of
from pindrive.quantities.status import Side

if TYPE_CHECKING:
    from pindrive.bodies.system_motion import SystemEvent, SystemMotion


@dataclass(frozen=True, slots=True, repr=False)
class _Part:
    """A part of a motion, evaluated at times of any shape."""

    _motion: SystemMotion
    name: str

    def __repr__(self) -> str:
        """Return its name in a line."""
        return f"<{type(self).__name__} {self.name!r}>"

    def _at(
        self, contacts: bool, quantity: int, t: ArrayLike, side: Side
    ) -> float | NDArray[np.float64]:
        times = self._motion.known(t, side)
        system = self._motion.system
        place = [*(system.contacts if contacts else system.bodies)].index(self.name)
        found = self._motion.state_at(times.ravel(), side)[contacts][quantity, place]
        return float(found[0]) if times.ndim == 0 else found.reshape(times.shape)

    def _distance(
        self, between: tuple[str, str], t: NDArray[np.float64], side: Side
    ) -> NDArray[np.float64]:
        """Distance of two bodies and its rate at times (s, shape (n,)), shape (2, n)."""
        names = [*self._motion.system.bodies]
        moving, *_ = self._motion.state_at(t, side)
        one, other = (
            moving[:2, names.index(name)] if name != GROUND else np.zeros((2, len(t)))
            for name in between
        )
        return one - other


class BodyMotion(_Part):
    """Motion of one body."""

    __slots__ = ()

    @overload
    def position(self, t: float, side: Side = ...) -> float: ...
    @overload
    def position(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def position(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Position, m.

        Args:
            t: s, any shape, from 0 to the duration.
            side: Side of an event on which the limit is taken.

        Raises:
            ValueError: A time at which the motion is not known.
        """
        return self._at(False, 0, t, side)

    @overload
    def velocity(self, t: float, side: Side = ...) -> float: ...
    @overload
    def velocity(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def velocity(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Velocity, m/s; arguments as for `position`."""
        return self._at(False, 1, t, side)

    @overload
    def acceleration(self, t: float, side: Side = ...) -> float: ...
    @overload
    def acceleration(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def acceleration(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Acceleration, m/s²; it jumps where friction does. Arguments as for `position`."""
        return self._at(False, 2, t, side)


class ContactMotion(_Part):
    """One contact under way."""

    __slots__ = ()

    @property
    def events(self) -> tuple[SystemEvent, ...]:
        """Changes at this contact, in order."""
        kinds = ("stick", "slip", "reverse")
        every = (event for event in self._motion.events if event.contact == self.name)
        return tuple(event for event in every if event.kind in kinds)

    @overload
    def force(self, t: float, side: Side = ...) -> float: ...
    @overload
    def force(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def force(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Friction force on the first body, N; arguments as for `BodyMotion.position`.

        Of several rigid contacts that hold a body together only the sum of the forces is
        determined; each then has a part in proportion to its static friction.
        """
        return self._at(True, 0, t, side)

    @overload
    def stretch(self, t: float, side: Side = ...) -> float: ...
    @overload
    def stretch(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def stretch(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Stretch of the skin, m; 0 of a rigid contact."""
        return self._at(True, 1, t, side)

    @overload
    def sliding_speed(self, t: float, side: Side = ...) -> float: ...
    @overload
    def sliding_speed(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def sliding_speed(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Velocity of the first body, or of its skin, over the surface, m/s; 0 in stick."""
        return self._at(True, 2, t, side)

    @overload
    def slip(self, t: float, side: Side = ...) -> float: ...
    @overload
    def slip(self, t: ArrayLike, side: Side = ...) -> NDArray[np.float64]: ...
    def slip(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Direction of slip: -1, 1, or 0 in stick."""
        return self._at(True, 3, t, side)


class StopMotion(_Part):
    """One stop under way."""

    __slots__ = ()

    @property
    def events(self) -> tuple[SystemEvent, ...]:
        """Times at which the bodies meet the stop or leave it, in order."""
        names = {*self._motion.system.contacts}
        own = (event for event in self._motion.events if event.contact == self.name)
        return (
            tuple(own)
            if self.name not in names
            else tuple(event for event in own if event.kind in ("stop", "leave"))
        )

    def force(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Force of the stop on the first body, N; arguments as for `BodyMotion.position`."""
        times = self._motion.known(t, side)
        place = [*self._motion.system.stops].index(self.name)
        found = self._motion.state_at(times.ravel(), side)[2][place]
        return float(found[0]) if times.ndim == 0 else found.reshape(times.shape)


class FeedbackMotion(_Part):
    """One feedback under way."""

    __slots__ = ()

    def force(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Force on the first body, N; arguments as for `BodyMotion.position`."""
        times = self._motion.known(t, side)
        place = [*self._motion.system.feedbacks].index(self.name)
        found = self._motion.state_at(times.ravel(), side)[3][place]
        return float(found[0]) if times.ndim == 0 else found.reshape(times.shape)

    def error(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Reference less the measured distance, m."""
        times = self._motion.known(t, side)
        flat = times.ravel()
        feedback = self._motion.system.feedbacks[self.name]
        meant = _course(feedback.reference, flat, side)[0]
        found = (meant - self._distance(feedback.measured, flat, side)[0]).reshape(times.shape)
        return float(found) if found.ndim == 0 else found


class SpringMotion(_Part):
    """One spring under way."""

    __slots__ = ()

    def _pull(self, t: ArrayLike, side: Side) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Elongation and its rate."""
        times = self._motion.known(t, side)
        flat = times.ravel()
        spring = self._motion.system.springs[self.name]
        given = np.zeros((2, len(flat)))
        for part in (spring.length, spring.motion):
            if part is not None:
                given += _course(part, flat, side)
        longer, faster = self._distance(spring.between, flat, side) - given
        return longer.reshape(times.shape), faster.reshape(times.shape)

    def elongation(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Elongation of the spring, m; arguments as for `BodyMotion.position`."""
        longer, _ = self._pull(t, side)
        return float(longer) if longer.ndim == 0 else longer

    def force(self, t: ArrayLike, side: Side = "right") -> float | NDArray[np.float64]:
        """Force of spring and damper on the first body, N."""
        spring = self._motion.system.springs[self.name]
        longer, faster = self._pull(t, side)
        found = -(spring.stiffness * longer + spring.damping * faster)
        return float(found) if found.ndim == 0 else found


def _course(given: Given, t: NDArray[np.float64], side: Side) -> NDArray[np.float64]:
    """Values of an input and their rates, shape (2, n)."""
    if isinstance(given, float):
        return np.array([np.full_like(t, given), np.zeros_like(t)])
    values, rates = _core.input_at(numbers_of(integrated(given)), t, side == "right")
    return np.array([values, rates])

"""The exact core. All quantities in SI units; nothing is checked here."""

from collections.abc import Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray


class Motion:
    """A simulated motion and its segments."""

    def position(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def velocity(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def acceleration(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def plate_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def finger_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch_rate(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def segments(self) -> dict:
        """Columns, one row a segment."""

    def transient(self, duration: float, band: float) -> dict: ...

    def ledger(self, duration: float) -> dict: ...

    @property
    def steady_since(self) -> float: ...

    @property
    def period(self) -> float: ...

    def certificate(self, duration: float) -> dict: ...

    def duration(self, band: float) -> float: ...

    @property
    def known_until(self) -> float: ...

    @property
    def status(self) -> int: ...

    @property
    def end(self) -> int: ...

    @property
    def cycle_begin(self) -> float: ...

    @property
    def until(self) -> float: ...

    @property
    def segment_count(self) -> int: ...

class Derivative:
    """The derivatives of a motion along a direction of its inputs."""

    def position(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def velocity(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def acceleration(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def plate_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def finger_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch_rate(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def segments(self) -> dict:
        """Columns, one row a segment."""

    def transient(self, duration: float, band: float) -> dict: ...

    def ledger(self, duration: float) -> dict: ...

    @property
    def steady_since(self) -> float: ...

    @property
    def period(self) -> float: ...

def simulate(mass: float, stiffness: float, damping: float, plate: tuple[float, float, float, Sequence[tuple[float, float]]], finger: tuple[float, float, float, Sequence[tuple[float, float]]], mouse_velocity: Sequence[tuple[float, float]], plate_load: Sequence[tuple[float, float]], displacement: float, velocity: float, skin_stretch: float, duration: float) -> Motion:
    """
    Simulates one pin from its release until its ending is known or the duration is over. Contacts are (kinetic, static, stiffness, rows (speed, force) of the curve), inputs rows (time, value), one row for a constant.
    """

def differentiate(numbers: tuple[float, float, float, tuple[float, float, float, Sequence[tuple[float, float]]], tuple[float, float, float, Sequence[tuple[float, float]]], Sequence[tuple[float, float]], Sequence[tuple[float, float]], float, float, float, float], along: tuple[float, float, float, tuple[float, float, float, Sequence[tuple[float, float]]], tuple[float, float, float, Sequence[tuple[float, float]]], Sequence[tuple[float, float]], Sequence[tuple[float, float]], float, float, float, float]) -> Derivative:
    """
    The derivatives of a motion along a direction; both as the arguments of simulate.
    """

def simulate_batch(inputs: Sequence[Annotated[NDArray[numpy.float64], dict(device='cpu', writable=False)]], status: Annotated[NDArray[numpy.int8], dict(shape=(None,), order='C', device='cpu', writable=False)], threads: int, energy: bool) -> dict:
    """
    Columns of numbers, one row for each point of the inputs in C order: arrays of one shape (mass, stiffness, damping, plate kinetic and static, finger kinetic, static and stiffness, mouse velocity, displacement, velocity, duration, settling band). A point whose status is not 0 is left out: its numbers are NaN. With `energy` the ledger's terms too.
    """

settling_band: float = 0.05

event_limit: int = 1000000

statuses: dict = ...

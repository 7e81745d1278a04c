"""The exact core. All quantities in SI units; nothing is checked here."""

from collections.abc import Mapping, Sequence
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

    def housing_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stop_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch_rate(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def segments(self) -> dict:
        """Columns, one row a segment."""

    def transient(self, duration: float, band: float) -> dict: ...

    def ledger(self, duration: float) -> dict: ...

    def certificate(self, duration: float) -> dict: ...

    def columns(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> dict:
        """What there is at each time, by name."""

    def duration(self, band: float) -> float: ...

    def crossings(self, quantity: int, level: float, until: float, most: int) -> tuple:
        """Times and directions; position, velocity or acceleration is 0, 1 or 2."""

    def extrema(self, quantity: int, until: float, most: int) -> tuple:
        """Times and values."""

    def events(self, begin: float, end: float, most: int) -> tuple:
        """Times and the segments that the events end, cycles expanded."""

    def acceleration_bounds(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
        """
        Of each segment without a closed form, what |x''| stays below, m/s²; else NaN.
        """

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

    def housing_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stop_force(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def stretch_rate(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def segments(self) -> dict:
        """Columns, one row a segment."""

    def transient(self, duration: float, band: float) -> dict: ...

    def ledger(self, duration: float) -> dict: ...

def simulate(mass: float, stiffness: float, damping: float, plate: tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], finger: tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], mouse_velocity: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], plate_load: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], displacement: float, velocity: float, skin_stretch: float, force: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], across_velocity: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], finger_load: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], stops: tuple[float, float, float], duration: float, support: float, progress: object | None = None) -> Motion:
    """
    Simulates one pin from its release until its ending is known or the duration is over. Contacts are (kinetic, static, stiffness, rows (speed, force) of the curve, (law, breakaway, Stribeck velocity, exponent, viscous)), inputs rows (time, value), one row for a constant, or the pieces (begin, polynomial, terms (cosine, sine, decay, frequency)) of a function. In a long simulation, progress is called with the simulated time.
    """

def function_range(pieces: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], until: float) -> tuple[tuple[float, float], tuple[float, float, float]]:
    """
    The lowest value of a function until a time (time, value), and its first jump (time, before, after), at an infinite time without one.
    """

def input_period(inputs: Sequence[Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]]) -> tuple[float, float, bool]:
    """
    The time of the last breakpoint of all inputs (in the order of a release), their period from then on, infinite without one, and whether they are constant.
    """

def function_at(pieces: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
    """The values of a function at times (s)."""

def sum_of_functions(one: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], other: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]) -> list[tuple[float, list[float], list[list[float]]]]:
    """The pieces of the sum of two functions."""

def function_from(pieces: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], time: float) -> list[tuple[float, list[float], list[list[float]]]]:
    """The piece of a function from a time on (s), in a list."""

def function_of_rows(rows: Sequence[tuple[float, float]]) -> list[tuple[float, list[float], list[list[float]]]]:
    """The pieces of rows (time, value); the later value holds at a step."""

def function_pieces(kind: str, numbers: Sequence[float]) -> list[tuple[float, list[float], list[list[float]]]]:
    """
    The pieces of a named function; four numbers, of which the last may have no effect.
    """

def function_pieces_along(kind: str, numbers: Sequence[complex]) -> list[tuple[complex, list[complex], list[list[complex]]]]:
    """As function_pieces; imaginary parts are derivatives along a direction."""

function_kinds: dict = ...

def differentiate(numbers: tuple[float, float, float, tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], tuple[float, float, float], float, float], along: tuple[float, float, float, tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], tuple[float, float, float], float, float]) -> Derivative:
    """
    The derivatives of a motion along a direction; both as the arguments of simulate.
    """

def simulate_batch(inputs: Sequence[Annotated[NDArray[numpy.float64], dict(device='cpu', writable=False)]], bounds: Sequence[Sequence[float]], threads: int, outputs: Sequence[str], events: bool, width: int = 0, others: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]] = []) -> dict:
    """
    Columns of the numbers named in outputs, one row for each point of the inputs in C order: arrays of one shape (mass, stiffness, damping, plate kinetic and static, finger kinetic, static and stiffness, mouse velocity, displacement, velocity, duration, settling band, plate load). A point that breaks one of the bounds (the least value, the largest, and one beside them or NaN) of the arguments in this order, of the damping ratio and of the phase is left out: its status says which, its numbers are NaN. The column of events is there if asked for; `general` says how many points the general core followed, `extremes` the least and the largest value of each argument, NaN if one is NaN. The kernel works in packs of `width`; 0: the widest. Where others are given (of the end stops travel, infinite: none, stiffness, infinite: rigid, and damping; damping of the skin; a NaN is a number that is refused) the general core follows all points.
    """

def kernel_widths() -> list[int]:
    """The widths of the kernel that this processor runs."""

def elementary(which: int, a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], width: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
    """
    Values of one of the elementary functions: sine, cosine, exp, expm1, log, log1p of a, or the angle of the points (b, a), by the kernel of a width.
    """

class SystemMotion:
    """A simulated motion of several bodies."""

    def at(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> tuple:
        """
        Position, velocity and acceleration of each body, and friction, stretch, sliding speed and slip of each contact, and the force of each stop and of each feedback, over all times.
        """

    def changes(self) -> dict:
        """Columns, one row an event."""

    @property
    def status(self) -> int: ...

    @property
    def rests(self) -> bool: ...

    def range(self, body: int) -> tuple[float, float]:
        """Least and largest position of a body."""

    @property
    def end(self) -> float: ...

    @property
    def step_count(self) -> int: ...

class SystemDerivative:
    """The derivatives of such a motion along a direction."""

    def at(self, times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> tuple:
        """
        Position, velocity and acceleration of each body, and friction, stretch, sliding speed and slip of each contact, and the force of each stop and of each feedback, over all times.
        """

    def changes(self) -> dict:
        """Columns, one row an event."""

def simulate_system(numbers: tuple[Sequence[tuple[float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float]], Sequence[tuple[int, int, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]]], Sequence[tuple[int, int, float, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, int, float]], Sequence[tuple[int, int, float, int, float, float, float]], Sequence[tuple[int, int, int, int, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float]]], duration: float, most_steps: int = 0) -> SystemMotion:
    """
    Simulates several bodies; without a duration until they rest, or for so many steps. Bodies are (mass, force, position, velocity); springs (first body, second or -1, stiffness, damping, length); contacts (first body, second or -1, kinetic, static, stiffness, damping, load, velocity, stretch, place of what presses it or -1, share); stops (first body, second or -1, position, side, stiffness, damping, restitution); feedbacks (both bodies of the force, both bodies that are measured, gains of position, velocity and integral, reference, period).
    """

def differentiate_system(numbers: tuple[Sequence[tuple[float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float]], Sequence[tuple[int, int, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]]], Sequence[tuple[int, int, float, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, int, float]], Sequence[tuple[int, int, float, int, float, float, float]], Sequence[tuple[int, int, int, int, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float]]], along: tuple[Sequence[tuple[float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float]], Sequence[tuple[int, int, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]]], Sequence[tuple[int, int, float, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, int, float]], Sequence[tuple[int, int, float, int, float, float, float]], Sequence[tuple[int, int, int, int, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float]]], duration: float) -> SystemDerivative:
    """The derivatives of a motion of several bodies along a direction."""

def input_at(input: Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], right: bool) -> tuple:
    """Values and rates of an input at times."""

def function_integral(pieces: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]) -> list[tuple[float, list[float], list[list[float]]]]:
    """The pieces of the integral of a function from t = 0 on."""

def function_integral_along(pieces: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], along: Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]) -> list[tuple[float, list[float], list[list[float]]]]:
    """The derivative of that integral along a direction of the pieces."""

def certify_system(numbers: tuple[Sequence[tuple[float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, float]], Sequence[tuple[int, int, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]]]], Sequence[tuple[int, int, float, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float, int, float]], Sequence[tuple[int, int, float, int, float, float, float]], Sequence[tuple[int, int, int, int, float, float, float, Sequence[tuple[float, float]] | Sequence[tuple[float, Sequence[float], Sequence[Sequence[float]]]], float]]], duration: float) -> dict:
    """The worst violation of each law, and the energy."""

def direction(angle: float) -> tuple[float, float]:
    """Unit vector at an angle, rad."""

def luminance(raster: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], float, float, float], x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

def on_page(raster: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], float, float, float], x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C')]: ...

def hand_position(path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple: ...

def hand_velocity(path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple: ...

def way(path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], times: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
    """Length of the way of the hand until each time."""

def turnings(path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], axis: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

def printed_lines(raster: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], float, float, float], path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], axis: float, threshold: float, spots: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], most: int) -> tuple:
    """
    Begins, ends and wholeness of the lines along the way of each spot, and the number of edges; incomplete at `most` edges.
    """

def plate_velocity(path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], axis: float) -> tuple:
    """
    Times since the begin; velocity along and across the axis, at these times and as pieces where the path has bends; whether across it moves.
    """

def coil_numbers(values: Mapping[str, float]) -> dict[str, float]:
    """Derived numbers of a coil by the keys of a device file, SI."""

def magnet_numbers(values: Mapping[str, float], along: str) -> tuple:
    """
    Numbers of an electromagnet by the keys of a device file; their derivatives by one key.
    """

def coil_course(magnet: tuple[Sequence[float], Sequence[tuple[float, float]]], state: tuple[float, float, float, float, float, bool, bool], switchings: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], begin: float, end: float, most: int) -> tuple:
    """
    Pieces of a coil under commands, those of its pull (N), and its state at the end.
    """

def load_along(magnet: tuple[Sequence[float], Sequence[tuple[float, float]]], along: tuple[Sequence[float], Sequence[tuple[float, float]]], pressing: tuple[tuple[float, float], tuple[float, float]], touch: Sequence[tuple[float, float]], state: tuple[float, float, float, float, float, bool, bool], switchings: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], delay: float, begin: float, end: float) -> list:
    """
    Derivative of the pieces of the factor of the plate friction: begin, polynomial, terms.
    """

def closest_approaches(motions: Sequence[Motion], pairs: Sequence[tuple[int, int]], duration: float) -> tuple:
    """
    Smallest x(behind) - x(ahead) of each pair of motions, m, and its time, s.
    """

class Device:
    """Device whose pins are alike."""

    def __init__(self, drive: tuple[float, float, float, tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], tuple[float, float, float, Sequence[tuple[float, float]], tuple[float, float, float, float, float], float, float], tuple[float, float, float]], pressing: tuple[float, float], magnet: tuple[Sequence[float], Sequence[tuple[float, float]]], control: tuple[float, float, float, float], axis: float, spots: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> None: ...

class Scan:
    """Pins under a hand that moves over a page."""

    def __init__(self, device: Device, raster: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], float, float, float], path: tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]], touch: Sequence[tuple[float, float]], states: Sequence[tuple[float, float, float, tuple[float, float, float, float, float, bool, bool], bool, Sequence[float], Sequence[float]]]) -> None: ...

    def energise(self, most_switchings: int, most_rows: int) -> tuple: ...

    def hand(self, hand: Sequence[float]) -> tuple:
        """
        Path that a hand takes with its pins: times, velocities along the axis, bends, ambiguous samples, status, steps, and deflections of the pins at the end.
        """

    def simulate(self, threads: int, most_segments: int, progress: object | None) -> tuple: ...

    def motion(self, pin: int) -> Motion: ...

    def switchings(self, pin: int) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]: ...

    def coil(self, pin: int) -> tuple: ...

    def load(self, pin: int) -> list:
        """Pieces of the factor of the plate friction: begin, polynomial, terms."""

    def energised(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C')]:
        """Time for which the magnet of each pin is switched on, s."""

    def control(self, pin: int) -> tuple:
        """
        Whether it was commanded on at first; the last decision; pending switchings.
        """

    def end(self, pin: int) -> list[float]:
        """
        State of the pin at the end: time, twice, and its error; x, v, skin force; ...
        """

class Evaluation:
    """Lines and false lines under the pins of a scan."""

    def columns(self) -> dict: ...

    def counts(self) -> dict: ...

    def spreads(self) -> dict:
        """Least, median and largest of each number of the lines shown."""

def evaluate(scan: Scan, criteria: tuple[float, float, float, float, float, float], most: int) -> tuple: ...

tried_speeds: int = 32

speed_precision: float = 0.001

def two_lines(device: Device, pitch: float, width: float, criteria: tuple[float, float, float, float, float, float], speed: float) -> tuple[float, float, float, bool, int]: ...

def speed_limit(device: Device, pitch: float, width: float, criteria: tuple[float, float, float, float, float, float], tried: tuple[float, float], progress: object | None) -> tuple[list[tuple[float, float]], list[tuple[float, float]], tuple[float, float, float, bool, int] | None, int]: ...

friction_laws: tuple = ('coulomb', 'stribeck', 'hess-soom', 'table')

def input_quantities() -> list:
    """
    Key, unit, bounds, computable bounds and value without the key, of each input.
    """

def bounds_words(bounds: tuple[float, float, bool, bool, float], unit: str) -> str: ...

def value_problems(given: Sequence[tuple[str, float | Sequence[tuple[float, float]] | None]], whole: bool) -> list[tuple[str, str, str, str, list[str]]]:
    """Problems of values by key, SI: bounds of each, and contradictions."""

settling_band: float = 0.05

event_limit: int = 1000000

statuses: dict = ...

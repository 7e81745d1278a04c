"""Predicted recordings for given parameters, with exact derivatives.

Before the release the pin moves on at its initial velocity: carried by the plate, or at rest. This
matters for a fitted time of the release.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.fitting.assembly import Assembly
from pindrive.fitting.noise import Noise, column
from pindrive.fitting.parameters import Parameter
from pindrive.fitting.recording import Recording
from pindrive.motion.drive import Drive
from pindrive.motion.motion import Motion
from pindrive.motion.release import Release
from pindrive.motion.simulate import simulated

Array = NDArray[np.float64]
OwnChannel = Callable[[Motion, Array], Any]
"""Values of a channel, SI, from a motion and times since its release, s, negative before it."""

DIFFERENCE: Final = 1e-6
"""Step of differences, a part of a parameter or of a thousandth of its range."""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Samples of one channel of one recording, within the vector of all samples."""

    recording: int
    channel: str
    place: slice
    times: Array
    """Sample times, s, shape (n,), without those of missing samples."""

    @property
    def size(self) -> int:
        """Number of samples."""
        return int(self.place.stop - self.place.start)


class Model:
    """The recordings as functions of the parameters.

    Args:
        found: The parameters.
        drive: Drive that the parameters change.
        releases: Releases that the parameters change, one for each recording.
        recordings: Measurements.
        strides: Stride of the used samples of each recording.
        own: Channels of the user's own, as functions of the motion and of times since the release.
    """

    def __init__(
        self,
        found: Sequence[Parameter],
        drive: Drive,
        releases: Sequence[Release],
        recordings: Sequence[Recording],
        strides: Sequence[int] | None = None,
        own: Mapping[str, OwnChannel] | None = None,
    ) -> None:
        self.own = dict(own or {})
        self.parameters, self.drive, self.releases = tuple(found), drive, tuple(releases)
        self.recordings = tuple(recordings)
        strides = strides or [1] * len(recordings)
        self._half = [0.5 * recording.interval for recording in recordings]
        self.blocks: list[Block] = []
        data, at = [], 0
        for r, (recording, stride) in enumerate(zip(recordings, strides, strict=True)):
            for channel, values in recording.channels.items():
                rows = np.flatnonzero(np.isfinite(values))[::stride]
                times = np.ascontiguousarray(recording.time[rows])
                self.blocks.append(Block(r, channel, slice(at, at + len(rows)), times))
                data.append(values[rows])
                at += len(rows)
        self.data: Array = np.concatenate(data)
        latest = [self._latest(r) for r in range(len(recordings))]
        self.assembly = Assembly(found, drive, releases, latest)
        self._times_offset = [
            next(
                (i for i, p in enumerate(found) if (p.key, p.recording) == ("time_offset", r)), None
            )
            for r in range(len(recordings))
        ]
        self._added = [self._sensor(block) for block in self.blocks]

    def _sensor(self, block: Block) -> tuple[list[int], Array]:
        """Return the parameters of a sensor by their places, and their columns, shape (n, k)."""
        recording = self.recordings[block.recording]
        noise = recording.noise.get(block.channel, Noise())
        span = float(recording.time[0]), float(recording.time[-1])
        places, columns = [], np.empty((block.size, 0))
        for i, p in enumerate(self.parameters):
            if p.recording == block.recording and p.key.startswith(f"{block.channel}_"):
                key = p.key.removeprefix(f"{block.channel}_")
                places.append(i)
                own = column(key, block.times, span, float(noise.hum or 0.0))
                columns = np.column_stack([columns, own])
        return places, columns

    def thinned(self, samples: int) -> Model:
        """Return the model at evenly spaced samples of each recording, at least so many or all."""
        strides = [max(1, len(recording.time) // samples) for recording in self.recordings]
        return Model(self.parameters, self.drive, self.releases, self.recordings, strides, self.own)

    def _latest(self, r: int) -> float:
        """Until when a recording is simulated, s."""
        own = [p.lower for p in self.parameters if p.key == "time_offset" and p.recording == r]
        end = float(self.recordings[r].time[-1]) - min([0.0, *own])
        return max(end, 0.0) + 4.0 * self._half[r]

    @cached_property
    def range(self) -> Array:
        """The extent of the data of each block."""
        return np.array([np.ptp(self.data[block.place]) or 1.0 for block in self.blocks])

    def added(self, i: int) -> tuple[list[int], Array]:
        """Return what a sensor adds to a block: parameters by place, and columns, shape (n, k)."""
        return self._added[i]

    def offset(self, theta: Any, r: int) -> Any:
        """Return the recorded time of a release, s."""
        i = self._times_offset[r]
        return 0.0 if i is None else theta[i]

    def over(self, theta: Array, block: Block) -> dict[str, Array]:
        """Return "time", "speed" and "position" of the pin at the samples of a block, SI."""
        trace = _Trace(self.assembly.numbers(theta, block.recording))
        times = block.times - self.offset(theta, block.recording)
        speed, position = trace.velocity(times), trace.position(times)
        return {"time": block.times, "speed": speed, "position": position}

    def predict(self, theta: Array) -> Array:
        """All samples, shape (n,); NaN where the motion could not be followed."""
        values, _ = self._computed(theta, derivatives=False)
        return values

    def linearise(self, theta: Array) -> tuple[Array, Array]:
        """All samples, shape (n,), and their derivatives, shape (n, k)."""
        return self._computed(theta, derivatives=True)

    def _computed(self, theta: Array, *, derivatives: bool) -> tuple[Array, Array]:
        values = np.empty(len(self.data))
        slopes = np.zeros((len(self.data) if derivatives else 0, len(theta)))
        for r in range(len(self.recordings)):
            numbers = self.assembly.numbers(theta, r)
            trace = _Trace(numbers)
            begin = self.offset(theta, r)
            sampled = [
                (block, _Sampling(block.times - begin, self._half[r], self._average(block)), *added)
                for block, added in zip(self.blocks, self._added, strict=True)
                if block.recording == r
            ]
            for block, sampling, places, columns in sampled:
                computed = self._channel(trace, theta, block, sampling)
                values[block.place] = computed + columns @ theta[places]
            if not derivatives:
                continue
            for i in self.assembly.places(r):
                tangent = trace.along(self.assembly.along(theta.tolist(), i, r))
                for block, sampling, _, _ in sampled:
                    if block.channel not in self.own:
                        slopes[block.place, i] = tangent.channel(block.channel, sampling)
            for block, sampling, places, columns in sampled:
                slopes[block.place, places] = columns
                late = self._times_offset[r]
                if block.channel in self.own:
                    self._differences(theta, block, sampling, slopes)
                elif late is not None:
                    slopes[block.place, late] = -trace.rate(block.channel, sampling)
        return values, slopes

    def _channel(self, trace: _Trace, theta: Array, block: Block, sampling: _Sampling) -> Array:
        if block.channel not in self.own:
            return trace.channel(block.channel, sampling)
        r = block.recording
        motion = simulated(
            self.assembly.drive(theta, r), self.assembly.release(theta, r), duration=self._latest(r)
        )
        own = self.own[block.channel]
        return sampling.value_of(lambda t: np.asarray(own(motion, t), float))

    def _differences(self, theta: Array, block: Block, sampling: _Sampling, slopes: Array) -> None:
        """Fill in the derivatives of a channel of the user's own, by central differences."""
        r, late = block.recording, self._times_offset[block.recording]
        for i in [*self.assembly.places(r), *([] if late is None else [late])]:
            p = self.parameters[i]
            step = DIFFERENCE * max(abs(theta[i]), 1e-3 * (p.upper - p.lower))
            ends = []
            for way in (1.0, -1.0):
                moved = theta.copy()
                moved[i] += way * step
                shift = self.offset(theta, r) - self.offset(moved, r)
                trace = _Trace(self.assembly.numbers(moved, r))
                ends.append(self._channel(trace, moved, block, sampling.moved(shift)))
            slopes[block.place, i] = (ends[0] - ends[1]) / (2.0 * step)

    def _average(self, block: Block) -> str:
        noise = self.recordings[block.recording].noise.get(block.channel, Noise())
        filtered = block.channel in ("acceleration", "force") and noise.average == "instant"
        return "centred" if filtered else noise.average


@dataclass(frozen=True, slots=True)
class _Sampling:
    """Times of samples, and the interval over which each is a mean; none of an instant."""

    times: Array
    half: float
    average: str

    @property
    def middle(self) -> Array:
        shift = {"before": -self.half, "after": self.half}.get(self.average, 0.0)
        return self.times + shift

    def slope(self, of: Any) -> Array:
        """The mean rate of a function of time over each interval."""
        middle, half = self.middle, self.half
        found: Array = (of(middle + half) - of(middle - half)) / (2.0 * half)
        return found

    def mean(self, of: Any) -> Array:
        """The mean over each interval, by Simpson's rule."""
        middle, half = self.middle, self.half
        found: Array = (of(middle - half) + 4.0 * of(middle) + of(middle + half)) / 6.0
        return found

    def value_of(self, of: Any) -> Array:
        """A function at the samples, or its mean over each interval."""
        found: Array = of(self.times) if self.average == "instant" else self.mean(of)
        return found

    def moved(self, by: float) -> _Sampling:
        """The samples at later times."""
        return replace(self, times=self.times + by)

    def value(self, of: Any, rate: Any) -> Array:
        """A function at the samples, or the mean of its rate over each interval."""
        return of(self.times) if self.average == "instant" else self.slope(rate)


class _Trace:
    """One motion, extended before its release."""

    def __init__(self, numbers: Any) -> None:
        self.numbers = numbers
        self.core = _core.simulate(*numbers)

    def along(self, direction: Any) -> _Tangent:
        return _Tangent(self, direction)

    def position(self, t: Array) -> Array:
        found = self.core.position(np.maximum(t, 0.0), True)
        return found if t[0] >= 0.0 else found + self.numbers[8] * np.minimum(t, 0.0)

    def velocity(self, t: Array) -> Array:
        return self.core.velocity(np.maximum(t, 0.0), True)

    def acceleration(self, t: Array) -> Array:
        found = self.core.acceleration(np.maximum(t, 0.0), True)
        return np.where(t < 0.0, 0.0, found)

    def plate_velocity(self, t: Array) -> Array:
        times, values = np.transpose(self.numbers[5])
        found: Array = np.interp(t, times, values)
        return found

    def channel(self, name: str, sampling: _Sampling) -> Array:
        match name:
            case "position" if sampling.average == "instant":
                return self.position(sampling.times)
            case "position":
                return sampling.mean(self.position)
            case "velocity":
                return sampling.value(self.velocity, self.position)
            case "acceleration":
                return sampling.slope(self.velocity)
        mass, stiffness, damping = self.numbers[:3]
        inertia = sampling.slope(self.velocity) - sampling.slope(self.plate_velocity)
        spring = stiffness * sampling.mean(self.position)
        force: Array = mass * inertia + damping * sampling.slope(self.position) + spring
        return force

    def rate(self, name: str, sampling: _Sampling) -> Array:
        """The rate of a channel."""
        match name:
            case "position":
                return sampling.value(self.velocity, self.position)
            case "velocity":
                return sampling.value(self.acceleration, self.velocity)
            case "acceleration":
                return sampling.slope(self.acceleration)
        mass, stiffness, damping = self.numbers[:3]
        inertia = sampling.slope(self.acceleration) - sampling.slope(self.plate_acceleration)
        spring = stiffness * sampling.mean(self.velocity)
        rate: Array = mass * inertia + damping * sampling.slope(self.velocity) + spring
        return rate

    def plate_acceleration(self, t: Array) -> Array:
        times, values = np.transpose(self.numbers[5])
        if len(times) == 1:
            return np.zeros_like(t)
        slopes = np.concatenate([[0.0], np.diff(values) / np.diff(times), [0.0]])
        return slopes[np.searchsorted(times, t, side="right")]


class _Tangent:
    """The derivatives of a trace along a direction of the core's numbers."""

    def __init__(self, trace: _Trace, direction: Any) -> None:
        self._trace, self._direction = trace, direction
        self._core = _core.differentiate(trace.numbers, direction)

    def position(self, t: Array) -> Array:
        found = self._core.position(np.maximum(t, 0.0), True)
        return found if t[0] >= 0.0 else found + self._direction[8] * np.minimum(t, 0.0)

    def velocity(self, t: Array) -> Array:
        return self._core.velocity(np.maximum(t, 0.0), True)

    def plate_velocity(self, t: Array) -> Array:
        times, values = np.transpose(self._direction[5])
        if not times.any() and not values.any():
            return np.zeros_like(t)
        at, _ = np.transpose(self._trace.numbers[5])
        moved = self._trace.plate_acceleration(t) * np.interp(t, at, times)
        found: Array = np.interp(t, at, values) - moved
        return found

    def channel(self, name: str, sampling: _Sampling) -> Array:
        trace = self._trace
        match name:
            case "position" if sampling.average == "instant":
                return self.position(sampling.times)
            case "position":
                return sampling.mean(self.position)
            case "velocity":
                return sampling.value(self.velocity, self.position)
            case "acceleration":
                return sampling.slope(self.velocity)
        mass, stiffness, damping = trace.numbers[:3]
        d_mass, d_stiffness, d_damping = self._direction[:3]
        found: Array = mass * (sampling.slope(self.velocity) - sampling.slope(self.plate_velocity))
        found += damping * sampling.slope(self.position) + stiffness * sampling.mean(self.position)
        if d_mass:
            inertia = sampling.slope(trace.velocity) - sampling.slope(trace.plate_velocity)
            found += d_mass * inertia
        if d_damping:
            found += d_damping * sampling.slope(trace.position)
        if d_stiffness:
            found += d_stiffness * sampling.mean(trace.position)
        return found

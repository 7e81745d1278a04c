"""Predicted recordings for given parameters, with exact derivatives.

Before the release the pin moves on at its initial velocity: carried by the plate, or at rest. This
matters for a fitted time of the release.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pindrive import _core
from pindrive.fitting.parameters import Assembly, Parameter
from pindrive.fitting.recording import Recording
from pindrive.motion.drive import Drive
from pindrive.motion.release import Release

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Block:
    """Samples of one channel of one recording, within the vector of all samples."""

    recording: int
    channel: str
    place: slice

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
    """

    def __init__(
        self,
        found: Sequence[Parameter],
        drive: Drive,
        releases: Sequence[Release],
        recordings: Sequence[Recording],
        strides: Sequence[int] | None = None,
    ) -> None:
        self.parameters, self.drive, self.releases = tuple(found), drive, tuple(releases)
        self.recordings = tuple(recordings)
        strides = strides or [1] * len(recordings)
        self._times = [
            np.ascontiguousarray(recording.time[::stride])
            for recording, stride in zip(recordings, strides, strict=True)
        ]
        self._half = [0.5 * recording.interval for recording in recordings]
        self.blocks: list[Block] = []
        data, at = [], 0
        for r, (recording, stride) in enumerate(zip(recordings, strides, strict=True)):
            for channel, values in recording.channels.items():
                part = values[::stride]
                self.blocks.append(Block(r, channel, slice(at, at + len(part))))
                data.append(part)
                at += len(part)
        self.data: Array = np.concatenate(data)
        latest = [self._latest(r) for r in range(len(recordings))]
        self.assembly = Assembly(found, drive, releases, latest)
        self._sensor = [
            {p.key: i for i, p in enumerate(found) if p.recording == r and "_offset" in p.key}
            for r in range(len(recordings))
        ]

    def thinned(self, samples: int) -> Model:
        """Return the model at evenly spaced samples of each recording, at least so many or all."""
        strides = [max(1, len(recording.time) // samples) for recording in self.recordings]
        return Model(self.parameters, self.drive, self.releases, self.recordings, strides)

    def _latest(self, r: int) -> float:
        """Until when a recording is simulated, s."""
        own = [p.lower for p in self.parameters if p.key == "time_offset" and p.recording == r]
        end = float(self._times[r][-1]) - min([0.0, *own])
        return max(end, 0.0) + 4.0 * self._half[r]

    @cached_property
    def range(self) -> Array:
        """The extent of the data of each block."""
        return np.array([np.ptp(self.data[block.place]) or 1.0 for block in self.blocks])

    def times(self, r: int) -> Array:
        """The recorded times of a recording, s."""
        return self._times[r]

    def place(self, key: str, r: int) -> int | None:
        """Return the place of a sensor parameter of a recording; None if it is not free."""
        return self._sensor[r].get(key)

    def offset(self, theta: Any, r: int, key: str = "time_offset") -> Any:
        """Return the offset of the sensors of a recording: of the time, or of a channel."""
        i = self.place(key, r)
        return 0.0 if i is None else theta[i]

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
            trace = _Trace(numbers, self._times[r] - self.offset(theta, r), self._half[r])
            own = [block for block in self.blocks if block.recording == r]
            for block in own:
                added = self.offset(theta, r, f"{block.channel}_offset")
                values[block.place] = trace.channel(block.channel) + added
            if not derivatives:
                continue
            for i in self.assembly.places(r):
                tangent = trace.along(self.assembly.along(theta.tolist(), i, r))
                for block in own:
                    slopes[block.place, i] = tangent.channel(block.channel)
            for key, i in self._sensor[r].items():
                for block in own:
                    if key == "time_offset":
                        slopes[block.place, i] = -trace.rate(block.channel)
                    elif key == f"{block.channel}_offset":
                        slopes[block.place, i] = 1.0
        return values, slopes


class _Trace:
    """One motion at the sample times, extended before its release."""

    def __init__(self, numbers: Any, times: Array, half: float) -> None:
        self.numbers, self.times, self.half = numbers, times, half
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

    @cached_property
    def edges(self) -> tuple[Array, Array]:
        return self.times - self.half, self.times + self.half

    def mean_slope(self, of: Any) -> Array:
        """The mean rate of a function of time over each sample interval."""
        before, after = self.edges
        found: Array = (of(after) - of(before)) / (2.0 * self.half)
        return found

    def mean(self, of: Any) -> Array:
        """The mean over each sample interval, by Simpson's rule."""
        before, after = self.edges
        found: Array = (of(before) + 4.0 * of(self.times) + of(after)) / 6.0
        return found

    def channel(self, name: str) -> Array:
        match name:
            case "position":
                return self.position(self.times)
            case "velocity":
                return self.velocity(self.times)
            case "acceleration":
                return self.mean_slope(self.velocity)
        mass, stiffness, damping = self.numbers[:3]
        inertia = self.mean_slope(self.velocity) - self.mean_slope(self.plate_velocity)
        spring = stiffness * self.mean(self.position)
        force: Array = mass * inertia + damping * self.mean_slope(self.position) + spring
        return force

    def rate(self, name: str) -> Array:
        """The rate of a channel."""
        match name:
            case "position":
                return self.velocity(self.times)
            case "velocity":
                return self.acceleration(self.times)
            case "acceleration":
                return self.mean_slope(self.acceleration)
        mass, stiffness, damping = self.numbers[:3]
        inertia = self.mean_slope(self.acceleration) - self.mean_slope(self.plate_acceleration)
        spring = stiffness * self.mean(self.velocity)
        rate: Array = mass * inertia + damping * self.mean_slope(self.velocity) + spring
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

    def channel(self, name: str) -> Array:
        trace = self._trace
        match name:
            case "position":
                return self.position(trace.times)
            case "velocity":
                return self.velocity(trace.times)
            case "acceleration":
                return trace.mean_slope(self.velocity)
        mass, stiffness, damping = trace.numbers[:3]
        d_mass, d_stiffness, d_damping = self._direction[:3]
        found: Array = mass * (
            trace.mean_slope(self.velocity) - trace.mean_slope(self.plate_velocity)
        )
        found += damping * trace.mean_slope(self.position) + stiffness * trace.mean(self.position)
        if d_mass:
            inertia = trace.mean_slope(trace.velocity) - trace.mean_slope(trace.plate_velocity)
            found += d_mass * inertia
        if d_damping:
            found += d_damping * trace.mean_slope(trace.position)
        if d_stiffness:
            found += d_stiffness * trace.mean(trace.position)
        return found

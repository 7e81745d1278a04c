"""Scanned devices, so that no device is scanned twice, and the model between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pindrive.optimisation.kriging import Kriging

Array = NDArray[np.float64]


@dataclass
class Scanned:
    """The numbers of devices under conditions, by their place in the unit cube."""

    _places: dict[bytes, int] = field(default_factory=dict)
    _inputs: list[Array] = field(default_factory=list)
    _numbers: dict[str, list[float]] = field(default_factory=dict)
    _models: dict[str, Kriging | None] = field(default_factory=dict)
    _before: dict[str, Kriging | None] = field(default_factory=dict)
    _confirmed: set[bytes] = field(default_factory=set)

    @property
    def count(self) -> int:
        """Number of places."""
        return len(self._inputs)

    @property
    def inputs(self) -> Array:
        """All places, shape (count, k)."""
        return np.array(self._inputs)

    def missing(self, inputs: Array) -> NDArray[np.int64]:
        """Return True for unknown places (m, k); for equal ones only the first."""
        found: dict[bytes, int] = {}
        for i, place in enumerate(inputs):
            if place.tobytes() not in self._places:
                found.setdefault(place.tobytes(), i)
        return np.array([*found.values()], np.int64)

    def unconfirmed(self, inputs: Array) -> NDArray[np.int64]:
        """Return True for places (m, k) with numbers that are not confirmed."""
        each = [place.tobytes() not in self._confirmed for place in inputs]
        return np.flatnonzero(each)

    def keep(self, inputs: Array, numbers: Mapping[str, Array], *, confirmed: bool = False) -> None:
        """Store the numbers (m,) of places (m, k); replaces known numbers."""
        if confirmed:
            self._confirmed |= {place.tobytes() for place in inputs}
        for i, place in enumerate(inputs):
            at = self._places.setdefault(place.tobytes(), len(self._inputs))
            if at == len(self._inputs):
                self._inputs.append(place.copy())
            for name, values in numbers.items():
                column = self._numbers.setdefault(name, [])
                column[at : at + 1] = [float(values[i])]
        self._before |= self._models
        self._models.clear()

    def look_up(self, inputs: Array) -> dict[str, Array]:
        """The numbers at places that are known, each (m,)."""
        places = [self._places[place.tobytes()] for place in inputs]
        return {name: np.array(column)[places] for name, column in self._numbers.items()}

    def expected(
        self, name: str, inputs: Array, trust: float, *, large_is_bad: bool
    ) -> tuple[Array, Array]:
        """A number at any places, from below to above its mean; NaN where nothing is known.

        Args:
            name: Name of the number.
            inputs: Shape (m, k).
            trust: Standard deviations.
            large_is_bad: True if a large value stands for the missing number of a device.
        """
        if name not in self._models:
            self._models[name] = self._model(name, large_is_bad)
        model = self._models[name]
        if model is None:
            nothing = np.full(len(inputs), np.nan)
            return nothing, nothing
        return model(inputs, trust)

    def _model(self, name: str, large_is_bad: bool) -> Kriging | None:
        values = np.array(self._numbers.get(name, ()))
        if not np.isfinite(values).any() or len(values) < 2:
            return None
        finite = values[np.isfinite(values)]
        worst = finite.max() if large_is_bad else finite.min()
        known = np.where(np.isfinite(values), values, worst)
        return Kriging(self.inputs, known, self._before.get(name))

"""A drive and how it is released, as the paper's analysis sees it: arrays that broadcast."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive.motion.batch import batched
from pindrive.motion.drive import Contact, Drive
from pindrive.motion.release import Release
from pindrive.quantities.quantity import NON_NEGATIVE
from pindrive.quantities.refusal import refusal
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Releases"]

UNIT_DRIVE: Final = Drive(
    mass=1.0, stiffness=1.0, damping=0.0, plate=Contact(0.0), finger=Contact(0.0)
)
UNIT_RELEASE: Final = Release(mouse_velocity=0.0, displacement=1.0)
"""A drive without friction and damping, and its release, in units of m, x_0 and 1/ω_0."""

_QUANTITY: Final = {"friction": "plate.kinetic"}
"""Where a field's bounds stand in the table of quantities, if not under its own name."""
_ARGUMENT: Final = {"friction": "plate_kinetic"}
"""What a field is called in `simulate_batch`, if not the same."""


@dataclass(frozen=True, init=False, eq=False)
class Releases:
    """The release that equations (2) to (26) describe: of a pin that the plate carried.

    One contact, the plate, with kinetic = static friction; the finger is frictionless. Each
    argument is a number or an array of numbers, SI; they broadcast against each other.

    Args:
        mass: m, kg, above 0.
        stiffness: k, N/m, above 0.
        damping: b, N·s/m, at least 0.
        friction: friction force of the plate, N, at least 0: F_2 in the paper's x_d = F_2 / k.
        mouse_velocity: v_p, m/s, at least 0; for a negative one mirror the release. It is also the
            pin's velocity at the release.
        displacement: x_0, m.

    Raises:
        ValueError: a value is no number or out of its range, or the shapes do not broadcast.
    """

    mass: NDArray[np.float64]
    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]
    friction: NDArray[np.float64]
    mouse_velocity: NDArray[np.float64]
    displacement: NDArray[np.float64]

    def __init__(
        self,
        *,
        mass: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike,
        friction: ArrayLike,
        mouse_velocity: ArrayLike,
        displacement: ArrayLike,
    ) -> None:
        given = (mass, stiffness, damping, friction, mouse_velocity, displacement)
        names = [field.name for field in fields(self)]
        checked = [_checked(name, values) for name, values in zip(names, given, strict=True)]
        try:
            arrays = np.broadcast_arrays(*checked)
        except ValueError:
            shapes = ", ".join(f"{n} {a.shape}" for n, a in zip(names, checked, strict=True))
            raise ValueError(refusal("release", "of shapes that broadcast", shapes)) from None
        for name, array in zip(names, arrays, strict=True):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of every field, and of every answer."""
        return self.mass.shape

    def take(self, index: slice | NDArray[np.bool_]) -> Releases:
        """Some of these releases, by a slice or a mask of their (one-dimensional) arrays."""
        return Releases(**{field.name: getattr(self, field.name)[index] for field in fields(self)})

    def replace(self, **changes: ArrayLike) -> Releases:
        """The same releases with other values for some fields."""
        return Releases(
            **{f.name: changes.get(f.name, getattr(self, f.name)) for f in fields(self)}
        )

    def batch(
        self, *, outputs: Sequence[str] | None = None, **others: ArrayLike | None
    ) -> xr.Dataset:
        """The exact numbers of every release, the finger frictionless.

        Args:
            outputs: which, as for `simulate_batch`.
            others: what stands for, or beside, the arrays of the releases, as for `simulate_batch`.
        """
        given = {_ARGUMENT.get(f.name, f.name): getattr(self, f.name) for f in fields(self)}
        return batched(UNIT_DRIVE, UNIT_RELEASE, given | others, outputs=outputs)


def _checked(name: str, values: ArrayLike) -> NDArray[np.float64]:
    quantity = QUANTITIES[_QUANTITY.get(name, name)]
    bounds = NON_NEGATIVE if name == "mouse_velocity" else quantity.bounds
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(refusal(name, quantity.kinds, repr(values))) from None
    bad = [value for value in array.flat if float(value) not in bounds]
    if bad:
        shown = f"{float(bad[0])!r} {quantity.unit}"
        raise ValueError(refusal(name, bounds.words(quantity.unit), shown))
    return array

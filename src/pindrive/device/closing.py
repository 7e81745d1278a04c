"""The gap under the poles of a coil that closes as its pull grows, quasi-statically.

With the flux linkage λ, U = R i + λ' and λ = L i. The gap is closed while the pull is more than a
given force, else open by the lift; its motion between both takes no time. The flux linkage is
continuous, and with it the pull, while the inductance, and so the current, jumps. With c the flux
linkage over that of the full current and the closed gap, it tends exponentially to the voltage's
part with L/R while the gap is closed, and to q times that with q L/R while it is open, where q is
the inductance with the open gap over that with the closed one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from typing import Final

from pindrive.quantities.refusal import refusal


@dataclass(frozen=True, slots=True)
class Closing:
    """Closing and opening of the gap, and its effect on the inductance."""

    flux: float
    """The flux linkage at which it closes and opens, a part of that of the full current."""
    inductance: float
    """q, the inductance while it is open over that while it is closed."""


CLOSED: Final = Closing(flux=0.0, inductance=1.0)
"""That of a gap that does not open."""


def closing_at(
    force: float, inductance: float, pull: Callable[[float], float], saturation: float
) -> Closing:
    """The closing of a gap that closes against a force (N).

    Args:
        force: The pull beyond which it is closed, N.
        inductance: Inductance with the open gap over that with the closed gap.
        pull: Pull at a flux linkage, given as a part of that of the full current, N.
        saturation: The part at which the pull stops growing.

    Raises:
        ValueError: The gap would never close, or never open.
    """
    residual, most = pull(0.0), pull(inductance)
    if force <= residual:
        required = f"more than the residual pull, {residual!r} N"
        raise ValueError(refusal("closing_force", required, f"{force!r} N"))
    flux = saturation * sqrt((force - residual) / (pull(1.0) - residual))
    if force >= most or flux >= inductance:
        required = f"less than the pull of full current with the open gap, {most!r} N"
        raise ValueError(refusal("closing_force", required, f"{force!r} N"))
    return Closing(flux, inductance)

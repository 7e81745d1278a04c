"""The gap under the poles of a coil that closes as its pull grows, quasi-statically.

With the flux linkage λ, U = R i + λ' and λ = L i. The gap is closed while the pull is more than a
given force, else open by the lift; its motion between both takes no time. The flux linkage is
continuous, and with it the pull, while the inductance, and so the current, jumps. With c the flux
linkage over that of the full current and the closed gap, it tends exponentially to the voltage's
part with L/R while the gap is closed, and to q times that with q L/R while it is open, where q is
the inductance with the open gap over that with the closed one.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Closing:
    """Closing and opening of the gap, and its effect on the inductance."""

    flux: float
    """The flux linkage at which it closes and opens, a part of that of the full current."""
    inductance: float
    """q, the inductance while it is open over that while it is closed."""

"""What counts as felt, by the sources in the table of quantities."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.quantities.table import checked, default

if TYPE_CHECKING:
    from pindrive.quantities.part import Number


@checked
class Criteria:
    """What counts as felt.

    Args:
        felt: motion that is felt as a pulse, m, greater than 0.
        direction: motion of skin whose direction is perceived, m, greater than 0.
        direction_sure: whose direction is told right in more than 95 % of cases, m.
        direction_speed: at which that must be gone, m/s.
        echo: a swing so high, a part of the line before it, is a false line; in (0, 1].

    Raises:
        ValueError: a value is no number or out of its range.
    """

    felt: Number = default("felt")
    direction: Number = default("direction")
    direction_sure: Number = default("direction_sure")
    direction_speed: Number = default("direction_speed")
    echo: Number = default("echo")

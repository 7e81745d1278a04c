"""Keys that follow others: as a study writes it, or as the table of quantities says."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.files.template import DRIVE
from pindrive.study.distributions import Linked

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from numpy.typing import NDArray

    from pindrive.files.device import DeviceFile

    Columns = dict[str, NDArray[np.float64]]

LEFT_OUT: Final = {
    "plate.static": "plate.kinetic",
    "finger.static": "finger.kinetic",
    "motion.velocity": "motion.mouse_velocity",
}
"""Keys that are another one's value where a device file leaves them out."""


def base_value(device: DeviceFile, key: str) -> Any:
    """What the device has for a key, in SI; for what it leaves out, what holds then."""
    value = device.values()[key]
    if value is not None or key not in LEFT_OUT:
        return value
    return device.values()[LEFT_OUT[key]]


def implied_links(device: DeviceFile, varied: Collection[str], scans: bool) -> dict[str, Linked]:
    """The keys that a device gives and that keep their ratio to varied ones (`Quantity.follows`).

    A curve is no single value: it keeps its ratio where a motion is put together. A ratio to zero
    does not exist; such a key stays as it is.

    Args:
        device: whose ratios they are.
        varied: keys that have values of their own.
        scans: whether the study is one of scans, in which the keys of [motion] have no part.
    """
    moving = {*varied}
    found = {}
    for key, quantity in DRIVE.items():
        if key in moving or not moving.intersection(quantity.follows):
            continue
        value, leaders = device.values()[key], [base_value(device, k) for k in quantity.follows]
        if value is None and key in LEFT_OUT:
            moving.add(key)  # what is left out is the leader's value in any case
        if (scans and key.startswith("motion.")) or not isinstance(value, float):
            continue
        if all(isinstance(leader, float) and leader for leader in leaders):
            first, *over = leaders
            times = value / (first / over[0] if over else first)
            found[key] = Linked(quantity.follows[0], times, "".join(quantity.follows[1:]))
            moving.add(key)
    return found


def with_links(device: DeviceFile, columns: Columns, links: Mapping[str, Linked]) -> Columns:
    """The columns, and those of the keys that follow them or a value of the device.

    The links have no circle (see `circle`).
    """

    def value(key: str) -> NDArray[np.float64]:
        if key in columns:
            return columns[key]
        if key in links:
            link = links[key]
            leader = value(link.of) / value(link.over) if link.over else value(link.of)
            return link.times * leader
        if key in LEFT_OUT and device.values()[key] is None:
            return value(LEFT_OUT[key])
        return np.asarray(base_value(device, key))

    return columns | {key: value(key) for key in links}


def exponents(key: str, links: Mapping[str, Linked]) -> dict[str, float]:
    """To which power of `key` every key changes that follows it, itself included."""

    def power(name: str) -> float:
        if name == key:
            return 1.0
        if name in links:
            link = links[name]
            return power(link.of) - (power(link.over) if link.over else 0.0)
        return power(LEFT_OUT[name]) if name in LEFT_OUT else 0.0

    found = {name: power(name) for name in links}
    return {key: 1.0} | {name: n for name, n in found.items() if n}


def circle(links: Mapping[str, Linked]) -> tuple[str, ...]:
    """Keys of which each follows the next and the last the first; none where there is no circle."""
    for start in links:
        way = [start]
        while way[-1] in links:
            of = links[way[-1]].of
            if of == start:
                return tuple(way)
            if of in way:
                break
            way.append(of)
    return ()

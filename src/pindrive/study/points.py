"""One point of a study: the device there, and what its status means."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from pindrive.batch import batched
from pindrive.config import Setting, device_of
from pindrive.ratios import written

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pindrive.config import DeviceFile
    from pindrive.study.plan import Plan


def device_at(plan: Plan, at: Mapping[str, float]) -> DeviceFile:
    """The device at one point, which the keys' values (SI) say.

    Raises:
        ConfigError: there is none, the values do not go together.
    """
    given = [Setting(key, written(key, value), "") for key, value in at.items()]
    return device_of(plan.device.path, plan.device.tables, given, whole=plan.page is not None)


@cache
def flags(name: str) -> tuple[str, ...]:
    """What the values of `status`, from 0 on, and of `ending`, from -1 on, mean."""
    names = ("mass", "stiffness", "damping", "plate_kinetic", "finger_kinetic", "mouse_velocity")
    one = batched({**dict.fromkeys(names, 1.0), "displacement": 0.0})
    refused = ("refused",) if name == "status" else ()
    return (*one[name].attrs["flag_meanings"].split(), *refused)

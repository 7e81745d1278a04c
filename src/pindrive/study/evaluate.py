"""The numbers of many points of one device, each with other values of its swept keys."""

from __future__ import annotations

from functools import cache
from math import inf, nan
from typing import TYPE_CHECKING, Any

import numpy as np

from pindrive.batch import simulate_batch
from pindrive.drive import Contact, Drive, Profile
from pindrive.motion import Motion, simulate
from pindrive.study.outputs import MEASURED
from pindrive.study.plan import variable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from pindrive.config import DeviceFile
    from pindrive.study.plan import Columns, Plan

Table = dict[str, Any]
"""Arrays of one length by the names of their variables."""

_BATCH = (
    *("mass", "stiffness", "damping", "plate_kinetic", "plate_static", "finger_kinetic"),
    *("finger_static", "finger_stiffness", "mouse_velocity", "displacement", "velocity"),
    "duration",
)


def evaluate(
    plan: Plan, columns: Columns, count: int, outputs: Sequence[str], threads: int | None = 1
) -> Table:
    """The outputs at `count` points, where the columns stand for what the device has.

    A point that cannot be simulated has a status other than 0 and no numbers. A device that
    `simulate_batch` does not take (a friction curve, an input that changes, a given stretch of the
    skin) is simulated point by point: the same numbers, fifty times slower.

    Args:
        plan: whose device and way of damping.
        columns: by the keys of device files, each of shape (count,), SI.
        count: how many points.
        outputs: names of variables.
        threads: for `simulate_batch`, or processes for scans; None: all cores.
    """
    if plan.page:
        from pindrive.study.scans import evaluate_scans

        return evaluate_scans(plan, columns, count, outputs, threads)
    inputs = _inputs(plan.device, plan.by_ratio, columns)
    if is_slow(plan.device, columns):
        table = _one_by_one(inputs, count)
    else:
        for static in ("plate_static", "finger_static"):
            if inputs[static] is None:
                inputs[static] = inputs[static.replace("static", "kinetic")]
        inputs["plate_static"] = inputs["plate_static"] * inputs["plate_load"]
        inputs["plate_kinetic"] = inputs["plate_kinetic"] * inputs["plate_load"]
        given = {k: v for k, v in inputs.items() if k in _BATCH and v is not None}
        given["mass"] = np.broadcast_to(given["mass"], (count,))
        found = simulate_batch(**given, outputs=outputs, threads=threads)
        table = {name: found[name].values for name in outputs}
    return {name: table[name] for name in outputs}


def follow(plan: Plan, at: Mapping[str, float]) -> Motion:
    """The motion at one point, which the keys' values say.

    Raises:
        ValueError: there is none, as for `simulate`.
    """
    columns = {key: np.array([value]) for key, value in at.items()}
    return _motion(_point(_inputs(plan.device, plan.by_ratio, columns), 0))


def is_slow(device: DeviceFile, swept: Mapping[str, object]) -> bool:
    """Whether the points of a device must be simulated one by one."""
    changes = {
        "motion.mouse_velocity": isinstance(device.mouse_velocity, Profile),
        "motion.plate_load": isinstance(device.plate_load, Profile),
    }
    return (
        any(changing and key not in swept for key, changing in changes.items())
        or device.drive.plate.curved
        or device.drive.finger.curved
        or device.skin_stretch is not None
        or "motion.skin_stretch" in swept
    )


def _inputs(device: DeviceFile, by_ratio: bool, columns: Columns) -> dict[str, Any]:
    """Every input of a motion by its name in Python: a column, or what the device has."""
    given: dict[str, Any] = {variable(key): value for key, value in device.values().items()}
    given |= {"mouse_velocity": device.mouse_velocity, "plate_load": device.plate_load}
    given |= {variable(key): values for key, values in columns.items()}
    if "drive.damping_ratio" in columns or (by_ratio and "drive.damping" not in columns):
        mass, stiffness = np.sqrt(given["mass"]), np.sqrt(given["stiffness"])
        given["damping"] = 2.0 * given["damping_ratio"] * mass * stiffness
    return given


@cache
def flags(name: str) -> tuple[str, ...]:
    """What the values of `status`, from 0 on, and of `ending`, from -1 on, mean."""
    one = simulate_batch(
        mass=1.0,
        stiffness=1.0,
        damping=1.0,
        plate_kinetic=1.0,
        finger_kinetic=1.0,
        mouse_velocity=1.0,
        displacement=0.0,
    )
    refused = ("refused",) if name == "status" else ()
    return (*one[name].attrs["flag_meanings"].split(), *refused)


def _one_by_one(inputs: Mapping[str, Any], count: int) -> Table:
    rows = [_numbers(_point(inputs, i)) for i in range(count)]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _point(inputs: Mapping[str, Any], i: int) -> dict[str, Any]:
    """The inputs of one point; where none varies there is a number, not an array."""
    return {
        name: value.item(i if value.ndim else 0) if isinstance(value, np.ndarray) else value
        for name, value in inputs.items()
    }


def _numbers(given: Mapping[str, Any]) -> dict[str, float]:
    """What `evaluate` gives of one point."""
    try:
        motion = _motion(given)
    except ValueError:
        refused = {"status": flags("status").index("refused"), "ending": -1, "events": 0}
        return dict.fromkeys(MEASURED, nan) | refused | {"transient_settled": False}
    end = motion.ending
    failures = {"ok": 0, "stopped after": 1, "stopped at": 2}
    return {name.replace(".", "_"): value for name, value in motion.numbers().items()} | {
        "status": next(flag for text, flag in failures.items() if motion.status.startswith(text)),
        "ending": flags("ending").index((end.cycle or end.kind).replace("-", "_").replace(" ", "_"))
        - 1,
        "events": len(motion.events),
    }


def _motion(given: Mapping[str, Any]) -> Motion:
    plate, finger = (
        Contact(
            given[f"{name}_kinetic"],
            given[f"{name}_static"],
            given[f"{name}_curve"],
            stiffness,
        )
        for name, stiffness in (("plate", inf), ("finger", given["finger_stiffness"] or inf))
    )
    body = {name: given[name] for name in ("mass", "stiffness", "damping")}
    start = ("mouse_velocity", "displacement", "velocity", "plate_load", "skin_stretch", "duration")
    return simulate(
        Drive(**body, plate=plate, finger=finger), **{name: given[name] for name in start}
    )

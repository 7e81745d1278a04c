"""The numbers of many points of one device, releases or scans; which cannot exist, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.pin_scan import Progress
from pindrive.device.scanning import scan
from pindrive.files.device import DeviceFile
from pindrive.files.keys import variable
from pindrive.motion.batch import batched
from pindrive.motion.function import Function
from pindrive.motion.profile import Profile
from pindrive.motion.release import INPUTS
from pindrive.motion.simulate import motion_of
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.refusal import Refusal, message_of, refused_by
from pindrive.quantities.status import End, SimulationError, Status
from pindrive.study.design import Columns, Ranges
from pindrive.study.outputs import MEASURED, SCANNED, variables
from pindrive.study.workers import spread

if TYPE_CHECKING:
    from pindrive.study.study import Study

Row = dict[str, Any]

_PORTION: Final = 8
"""Points that a thread takes at a time, at most."""


def scan_numbers(study: Study, at: Mapping[str, float]) -> dict[str, float]:
    """The numbers of the scan at one point, which the keys' values (SI) say, by their names.

    Raises:
        ValueError: No such device exists: the values contradict each other, or a spot leaves the
            page.
    """
    if study.page is None:
        raise ValueError(f"{study.path}: has no page to scan; write what is on it in [page]")
    file = study.device_at(at)
    device, reading = file.device, file.reading
    scene = study.page.scene(reading, device.array)
    path = study.page.hand(reading, scene, device.array)
    done = scan(device, scene, path, touch=file.touch, max_angle=reading.max_angle, threads=1)
    numbers: dict[str, float] = done.evaluate(file.criteria).numbers
    return numbers


def _one_by_one(
    study: Study, columns: Columns, count: int, outputs: Sequence[str], threads: int | None
) -> Table:
    """The outputs at points that are simulated one by one; arguments as for `evaluate`.

    Raises:
        ValueError: A file of the page has changed since the study was read.
    """
    if study.page:
        study.page.check()
    every = {key: np.broadcast_to(values, (count,)) for key, values in columns.items()}
    points = [{key: float(values[i]) for key, values in every.items()} for i in range(count)]
    threads = worker_count(threads)
    portion = min(_PORTION, -(-count // (2 * threads)))
    portions = [points[i : i + portion] for i in range(0, count, portion)]
    done = spread(_rows, study, portions, threads)
    rows = [row for portion in done for row in portion]
    return {name: np.array([row[name] for row in rows], _KINDS.get(name)) for name in outputs}


def _rows(study: Study, points: Sequence[Mapping[str, float]]) -> list[Row]:
    return [_row(study, point) for point in points]


def _row(study: Study, point: Mapping[str, float]) -> Row:
    """The numbers at a point; one that is refused has a status and no numbers."""
    try:
        return _of_scan(study, point) if study.page else _of_motion(study, point)
    except (ValueError, ArithmeticError, MemoryError) as error:
        status = error.status if isinstance(error, SimulationError) else Status.refused
        numbers = variables(SCANNED) if study.page else MEASURED
        unsettled = {"transient_settled": False, "ending": End.unknown, "events": 0}
        refused = unsettled | {"status": status, "reason": refused_by(error)}
        return dict.fromkeys(numbers, nan) | refused


def _of_scan(study: Study, point: Mapping[str, float]) -> Row:
    found = scan_numbers(study, point)
    given = {name: found[quantity.name] for name, quantity in variables(SCANNED).items()}
    return given | {"status": Status.ok, "reason": ""}


def _of_motion(study: Study, point: Mapping[str, float]) -> Row:
    motion = motion_of(study.device_at(point))
    return {name.replace(".", "_"): value for name, value in motion.numbers().items()} | {
        "status": motion.status,
        "ending": motion.ending.end,
        "events": len(motion.events),
        "reason": "",
    }


_KINDS: Final = {
    **dict.fromkeys(MEASURED, np.float64),
    **dict.fromkeys(("status", "ending", "events"), np.int64),
    "transient_settled": np.bool_,
    "reason": object,
}
"""Types of the outputs of a motion. Counts among its numbers are floats, as they may be NaN."""
_NOT_OF_THE_DRIVE: Final = ("duration", "settling_band")
"""Parameters of a motion beside its drive and its release."""
_FOLLOWED: Final = tuple(
    f"motion.{name}" for name in ("skin_stretch", "force", "across_velocity", "finger_load")
)
"""Reasons for which `simulate_batch` does not simulate a point."""
Table = dict[str, Any]
"""Arrays of one length by the names of their variables."""


def evaluate(
    study: Study, columns: Columns, count: int, outputs: Sequence[str], threads: int | None = 1
) -> Table:
    """The outputs at `count` points, where the columns stand for what the device has.

    A point that cannot be simulated has a status other than 0 and no numbers. A device that
    `simulate_batch` does not take (a friction curve, an input that changes, a given stretch of the
    skin) is simulated point by point: the same numbers, some hundred times slower.

    Args:
        study: Study with the device.
        columns: Values by the keys of device files, each of shape (count,), SI.
        count: Number of points.
        outputs: Names of variables; `reason` among them is text: what is refused of a point that
            cannot exist, the same for points that are refused alike, and empty where it exists.
        threads: Number of threads; None: all cores.
    """
    device = study.device
    if study.page or is_slow(device, columns):
        return _one_by_one(study, columns, count, outputs, threads)
    kept = [name for name in outputs if name != "reason"]
    varied = _varied(device, columns, count)
    found = batched(device.drive, device.release, varied, outputs=kept, threads=threads)
    table = {name: found[name].values for name in kept}
    if "reason" in outputs:
        table["reason"] = _refused(found["status"].values)
    return {name: table[name] for name in outputs}


def _varied(device: DeviceFile, columns: Columns, count: int) -> dict[str, Any]:
    """The arguments of `batched` for columns of values."""
    own = {variable(key): value for key, value in device.values().items()}
    given = {variable(key): values for key, values in columns.items()}
    varied: dict[str, Any] = {name: own[name] for name in _NOT_OF_THE_DRIVE} | given
    varied["mass"] = np.broadcast_to(varied.get("mass", device.drive.mass), (count,))
    ratio = varied.pop("damping_ratio", own["damping_ratio"] if device.by_ratio else None)
    if ratio is not None and "damping" not in given:
        stiffness = varied.get("stiffness", device.drive.stiffness)
        varied["damping"] = 2.0 * ratio * np.sqrt(varied["mass"]) * np.sqrt(stiffness)
    return varied


def evaluate_all(
    study: Study,
    ranges: Ranges,
    points: NDArray[np.float64],
    outputs: Sequence[str],
    threads: int | None,
    progress: Progress,
) -> tuple[Table, tuple[RefusedPoints, ...]]:
    """The outputs and the status at many points, part by part; and which points cannot exist.

    Args:
        study: The study.
        ranges: Varied keys.
        points: Values of the keys of `ranges.scatter`, SI, shape (keys, n).
        outputs: Names of variables.
        threads: Number of threads, as for `evaluate`.
        progress: Function called with the points done and the points in all.
    """
    total, parts = points.shape[1], []
    for begin in range(0, total, study.at_a_time):
        part = points[:, begin : begin + study.at_a_time]
        columns, count = ranges.columns(study, part), part.shape[1]
        parts.append(evaluate(study, columns, count, (*outputs, "status", "reason"), threads))
        progress(begin + count, total)
    table = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return table, refusals(study, ranges.columns(study, points), table.pop("reason"))


def is_slow(device: DeviceFile, swept: Mapping[str, object]) -> bool:
    """Return True if the points of a device must be simulated one by one."""
    changes = {
        f"motion.{name}": isinstance(getattr(device.release, name), (Profile, Function))
        for name in INPUTS
    }
    return (
        any(changing and key not in swept for key, changing in changes.items())
        or device.drive.plate.curved
        or device.drive.finger.curved
        or device.release.skin_stretch is not None
        or device.release.force != 0.0
        or device.release.across_velocity != 0.0
        or device.release.finger_load != 1.0
        or not swept.keys().isdisjoint(_FOLLOWED)
    )


def _refused(status: NDArray[np.int8]) -> NDArray[Any]:
    """Return the rejected argument of each point by its status; empty without one."""
    names = np.full(max(Status) + 1, "", object)
    for code in Status:
        names[code] = "" if code.exists else code.name
    return names[status]


@dataclass(frozen=True, slots=True)
class RefusedPoints:
    """Points that cannot exist for one reason."""

    count: int
    reason: str
    """Return the reason of the first rejected point in words, with the values."""


def exist(status: NDArray[Any]) -> NDArray[np.bool_]:
    """Return True for points with a motion or a scan, by their `status`; a stopped one counts."""
    return np.asarray(status < Status.refused)


def refusals(study: Study, columns: Columns, reasons: NDArray[Any]) -> tuple[RefusedPoints, ...]:
    """The points that cannot exist, by reason, most first.

    Args:
        study: The study.
        columns: The values of the varied keys at the points, SI.
        reasons: Reason for each rejected point, as `evaluate` gives it; empty for an existing
            point.
    """
    alike: dict[str, list[int]] = {}
    for i in np.flatnonzero(reasons != ""):
        alike.setdefault(str(reasons[i]), []).append(int(i))
    found = []
    for reason, points in alike.items():
        first = points[0]
        at = {key: float(np.broadcast_to(x, reasons.shape)[first]) for key, x in columns.items()}
        found.append(RefusedPoints(len(points), why(study, at) or reason))
    return tuple(sorted(found, key=lambda refusal: -refusal.count))


def why(study: Study, at: Mapping[str, float]) -> str:
    """Return the reason for a missing motion or scan at these values (SI); empty if it exists.

    The reason has the values to six digits, if these are refused, too.
    """
    rounded = {key: float(f"{x:.6g}") for key, x in at.items()}
    return _reason(study, rounded) or _reason(study, at)


def _reason(study: Study, at: Mapping[str, float]) -> str:
    """Return the rejection of a point; empty without one."""
    try:
        if study.page:
            scan_numbers(study, at)
        else:
            motion_of(study.device_at(at))
    except (ValueError, ArithmeticError, MemoryError) as error:
        message = message_of(error)
        return message.said if isinstance(message, Refusal) else message
    return ""

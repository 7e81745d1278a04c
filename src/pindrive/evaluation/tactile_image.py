"""The tactile image: what each pin did, painted on the page where its spot was at that time.

Each pin's way is a brush stroke as wide as the pins' tracks are apart, its colour the deflection,
counted forward: the way the plate goes while the hand reads. Several pins give their mean. The way
back to the next line is not painted, nor is what passes under a finger that is lifted.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.hand import PEAK
from pindrive.device.scanning import Scan
from pindrive.device.touch import spans
from pindrive.quantities import budgets

CELLS: Final = 1400
"""Cells across the longer side of the page at most."""
ALONE: Final = 0.00125
"""Half a brush where all pins go on one track, m: as of pins 2.5 mm apart."""
ROOM: Final = 0.002
"""Above and below what is drawn of the page, m."""
AROUND: Final = 0.003
"""Before the print, m; four times as much after it."""
AT_ONCE: Final = 1 << 20
"""Places that are painted together: more take memory and save no time."""
FINER: Final = 2.0
"""Places painted in each cell of the way."""


@dataclass(frozen=True, slots=True, eq=False)
class Painting:
    """The tactile image of a scan."""

    deflection: NDArray[np.float64]
    """Mean deflection forward, m, (rows, columns); NaN where no pin passed that was touched."""
    extent: tuple[float, float, float, float]
    """Left, right, top and bottom on the page, m."""


def paint(scan: Scan) -> Painting:
    """Paint what each pin of a scan did.

    Raises:
        ValueError: Too many places to paint.
    """
    left, right, top, bottom = scan.scene.extent
    cell = max(scan.scene.pixel, max(right - left, bottom - top) / CELLS)
    columns, rows = (max(1, round(side / cell)) for side in (right - left, bottom - top))
    t, sign = _reading(scan, cell)
    half = _brush(scan) + 0.5 * cell
    offsets = np.linspace(-half, half, 2 * int(half / cell) + 3)
    ax, ay = scan.device.array.direction
    total, count = np.zeros(rows * columns), np.zeros(rows * columns)
    of = f"{len(scan.pins)} pins at {len(t)} times, {len(offsets)} side by side"
    budgets.PAINTED.check(len(scan.pins) * len(t) * len(offsets), of)
    step = max(1, AT_ONCE // len(offsets))
    hand = np.stack(scan.path.position(t), axis=-1)
    spots = scan.device.array.on_page(scan.device.array.spots)
    for pin, spot in zip(scan.pins, spots, strict=True):
        position = sign * pin.position(t)
        for first in range(0, len(t), step):
            places = hand[first : first + step] + spot
            x = places[:, :1] - ay * offsets
            y = places[:, 1:] + ax * offsets
            i, j = np.floor((x - left) / cell).astype(int), np.floor((y - top) / cell).astype(int)
            inside = (i >= 0) & (i < columns) & (j >= 0) & (j < rows)
            where = (j * columns + i)[inside]
            shown = np.broadcast_to(position[first : first + step, np.newaxis], x.shape)[inside]
            np.add.at(total, where, shown)
            np.add.at(count, where, 1.0)
    mean = np.divide(total, count, out=np.full_like(total, np.nan), where=count > 0.0)
    return Painting(mean.reshape(rows, columns), scan.scene.extent)


def _reading(scan: Scan, cell: float) -> tuple[NDArray[np.float64], float]:
    """Times at which the hand reads, close together on the page, and the sign of the plate then.

    It reads the way that it goes further while it is slower on the whole: where it goes back and
    forth, the direction in which it spends more time.
    """
    path = scan.path
    lengths = np.diff(path.way(path.times))
    counts = np.ceil(PEAK * lengths * FINER / cell).astype(int)
    t = np.concatenate(
        [
            t0 + (t1 - t0) * (np.arange(n) + 0.5) / n
            for t0, t1, n in zip(path.times[:-1], path.times[1:], counts, strict=True)
        ]
        or [np.zeros(0)]
    )
    plate = path.plate_velocity(scan.device.array.axis)
    begins, ends = path.times[:-1] - path.begin, path.times[1:] - path.begin
    along = plate(0.5 * (begins + ends))
    lasts = ends - begins
    forward = bool(lasts[along > 0.0].sum() >= lasts[along < 0.0].sum())
    sign = 1.0 if forward else -1.0
    t = t[sign * plate(t - path.begin) > 0.0]
    touched = np.zeros(t.shape, bool)
    for touch, lift in spans(scan.pins[0].finger_load):  # alike at all pins
        touched |= (t - path.begin >= touch) & (t - path.begin < lift)
    return t[touched], sign


def _brush(scan: Scan) -> float:
    """Half the distance between neighbouring tracks, m."""
    across = np.unique(np.round([y for _, y in scan.device.array.spots], 9))
    return 0.5 * float(np.diff(across).min()) if len(across) > 1 else ALONE


def view(scan: Scan, around: bool = False) -> tuple[float, float, float, float]:
    """Left, right, top and bottom of what is worth a look: the print and the pins' tracks, m.

    Args:
        scan: The scan.
        around: Across the page the print alone, with room for what follows it.
    """
    scene = scan.scene
    left, right, top, bottom = scene.extent
    dark = scene.dark(scan.device.control.threshold)
    rows, columns = (np.flatnonzero(dark.any(axis=axis)) for axis in (1, 0))
    if around and columns.size:
        right = min(right, left + scene.pixel * columns[-1] + 4.0 * AROUND)
        left = max(left, left + scene.pixel * columns[0] - AROUND)
    spots = scan.spots(np.linspace(scan.path.begin, scan.path.end, 500))
    ink = top + scene.pixel * rows[[0, -1]] if rows.size else np.zeros(0)
    down = np.concatenate([spots[..., 1].ravel(), ink])
    return left, right, max(top, down.min() - ROOM), min(bottom, down.max() + ROOM)

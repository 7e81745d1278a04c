"""What is printed along a pin's way: the lines that its spot passes, to the instant."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import TYPE_CHECKING, Final

import numpy as np

from pindrive import budgets
from pindrive.device.course import Way, halved
from pindrive.device.scanning import AT_ONCE, FINER

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pindrive.device.scanning import Scan

GRAZED: Final = 0.5
"""What is shorter than this part of a pixel is an edge that the way grazes, no line and no gap."""


@dataclass(frozen=True, slots=True)
class Printed:
    """A line printed across a pin's way, while its spot was on it."""

    begin: float
    """When the spot came upon it, s."""
    end: float
    """When it left it, s."""
    whole: bool
    """Whether it did both: the way neither begins nor ends on the line, nor turns back there."""


def printed(scan: Scan) -> list[list[Printed]]:
    """The lines along the way of each pin: where the luminance is below the threshold.

    The luminance is linear between the middles of pixels (`Scene.at`), its edges are found by
    bisection. A line on which the hand turns back is not whole, nor is one under the spot at the
    path's begin or end.

    Raises:
        ValueError: too many lines.
    """
    path, scene, device = scan.path, scan.scene, scan.device
    way = Way(path)
    lengths = np.diff(way(path.times))
    counts = 1 + np.ceil(lengths * FINER / scene.pixel).astype(int)
    looks = np.concatenate(
        [
            t0 + (t1 - t0) * np.arange(n) / n
            for t0, t1, n in zip(path.times[:-1], path.times[1:], counts, strict=True)
        ]
        + [path.times[-1:]]
    )
    turned = turnings(scan)
    threshold = device.control.threshold
    offsets = device.array.on_page(device.array.spots)
    found: list[list[Printed]] = []
    passed = 0
    for dx, dy in offsets.tolist():

        def lightness(
            t: NDArray[np.float64], dx: float = dx, dy: float = dy
        ) -> NDArray[np.float64]:
            x, y = path.position(t)
            left, right, top, bottom = scene.extent
            return scene.at(np.clip(x + dx, left, right), np.clip(y + dy, top, bottom)) - threshold

        dark = np.concatenate(
            [lightness(looks[i : i + AT_ONCE]) < 0.0 for i in range(0, len(looks), AT_ONCE)]
        )
        changes = np.flatnonzero(dark[1:] != dark[:-1])
        passed += len(changes) // 2
        budgets.LINES.check(passed, f"up to pin {len(found)} of {len(offsets)}")
        edges = halved(lightness, looks[changes], looks[changes + 1])
        times = np.concatenate([[path.begin], edges, [path.end]])
        times = times[0 if dark[0] else 1 : None if dark[-1] else -1]
        begins, ends = times[::2], times[1::2]
        shortest = GRAZED * scene.pixel
        gaps = way(begins[1:]) - way(ends[:-1]) > shortest if len(begins) else np.zeros(0, bool)
        begins = begins[np.append(True, gaps)] if len(begins) else begins
        ends = ends[np.append(gaps, True)] if len(ends) else ends
        long = way(ends) - way(begins) > shortest if len(begins) else np.zeros(0, bool)
        found.append(
            [
                Printed(
                    a,
                    b,
                    path.begin < a and b < path.end and not ((turned > a) & (turned < b)).any(),
                )
                for a, b in zip(begins[long].tolist(), ends[long].tolist(), strict=True)
            ]
        )
    return found


def turnings(scan: Scan) -> NDArray[np.float64]:
    """When the hand comes to a stop or turns back along the drive axis, s, increasing."""
    axis, path = scan.device.array.axis, scan.path
    along = path.vx * cos(axis) + path.vy * sin(axis)
    along[np.abs(along) < 1e-9 * np.abs(along).max()] = 0.0  # across the axis but for rounding
    still = path.times[1:-1][(along[1:-1] == 0.0) & ((along[:-2] != 0.0) | (along[2:] != 0.0))]
    through = np.flatnonzero(along[1:] * along[:-1] < 0.0)
    part = along[through] / (along[through] - along[through + 1])
    across = path.times[through] + part * (path.times[through + 1] - path.times[through])
    return np.union1d(still, across)

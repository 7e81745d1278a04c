"""Contours of a map that jumps: they end at a jump, which is a line of its own."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Final

import matplotlib
import numpy as np
from contourpy import contour_generator
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from pindrive.plot.style import GREY, SMALL

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Mask = NDArray[np.bool_]

MAP: Final = "viridis"
JUMP: Final = 0.9
"""Width of the line along a jump, points; contours have half that width."""
_STEEP: Final = 4.0
"""Factor beyond the usual neighbouring step from which on a step is a jump."""
_SEEN: Final = 0.02
"""Smallest visible jump, as a fraction of the scale of colours."""
_SHORTEST: Final = 0.04
"""Shortest drawn piece of a contour, as a fraction of the panel's width or height."""
_ROOM: Final = 0.06
"""Distance from the middle of a label to the frame, as a fraction of the panel; twice between
labels."""
_BRIGHT: Final = 0.5
"""From this luminance of a colour on, lines on it are black."""


def jump_key(figure: Figure) -> list[Line2D]:
    """The sign of a jump, for a legend, where a figure has one."""
    jumps = any(c.get_gid() == "jumps" for axes in figure.axes for c in axes.collections)
    sign = Line2D([], [], color=GREY, lw=JUMP, label="jump, at which contours end")
    return [sign] if jumps else []


def draw_contours(
    axes: Axes, x: Array, y: Array, values: Array, levels: Sequence[float], norm: Normalize
) -> None:
    """Draw contours, each labelled once where there is room, and the jumps that end them.

    Args:
        axes: Axes with the map.
        x: The columns' places.
        y: The rows' places.
        values: Shape (len(y), len(x)); NaN where there is no number.
        levels: Levels of the contours.
        norm: The map's scale of colours.
    """
    seen = np.clip(np.ma.filled(norm(np.ma.masked_invalid(values)), np.nan), 0.0, 1.0)
    jumps = find_jumps(seen, x), find_jumps(seen.T, y).T
    fronts = [*_fronts(jumps[0], x, y), *(f[:, ::-1] for f in _fronts(jumps[1].T, y, x))]
    beside = [*values[:, 1:][jumps[0]], *values.T[:, 1:][jumps[1].T]]  # in the order of the fronts
    if fronts:
        style: dict[str, Any] = {"linewidths": JUMP, "gid": "jumps", "capstyle": "round"}
        axes.add_collection(LineCollection(fronts, colors=line_colours(beside, norm), **style))
    generator = contour_generator(x, y, np.ma.masked_invalid(values))
    cells = jumps[0][1:] | jumps[0][:-1] | jumps[1][:, 1:] | jumps[1][:, :-1]
    places: list[Array] = []
    for level, colour in zip(levels, line_colours(levels, norm), strict=True):
        pieces = [
            piece
            for line in generator.lines(level)
            for piece in _outside(np.asarray(line), x, y, cells)
        ]
        lines = LineCollection(pieces, colors=colour, linewidths=0.5 * JUMP, gid="contour")
        lines.set_label(f"{level:.6g}")
        axes.add_collection(lines)
        place = _label_place(pieces, x, y, places)
        if place is not None:
            places.append(_part_of_panel(place, x, y))
            beneath: Any = matplotlib.colormaps[MAP](norm(level))
            axes.text(
                float(place[0]),
                float(place[1]),
                f"{level:.6g}",
                color=colour,
                fontsize=SMALL - 1.0,
                ha="center",
                va="center",
                gid="level",
                bbox={"facecolor": beneath, "lw": 0.0, "pad": 0.6},
            )


def line_colours(values: Sequence[float], norm: Normalize) -> list[str]:
    """For each value black or white, whichever is seen on its colour."""
    colours = matplotlib.colormaps[MAP](norm(np.asarray(values, np.float64)))
    bright = np.atleast_2d(colours)[:, :3] @ (0.2126, 0.7152, 0.0722) > _BRIGHT
    return ["black" if one else "white" for one in bright.tolist()]


def find_jumps(values: Array, places: Array) -> Mask:
    """Between which values, along the last axis, there is a jump, shape (..., n - 1).

    A jump is a step of more than 0.02 that is more than 4 times as steep as the median of the two
    steps on either side; the values are places on a scale of colours, 0 to 1.
    """
    apart = np.abs(np.diff(places))
    steps = np.abs(np.diff(values, axis=-1))
    count = steps.shape[-1]
    padded = np.pad(steps / apart, [(0, 0)] * (steps.ndim - 1) + [(2, 2)], constant_values=np.nan)
    beside = [padded[..., shift : shift + count] for shift in (0, 1, 3, 4)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # nothing beside a step: no jump
        usual = np.nanmedian(beside, axis=0) * apart
    return (steps > _SEEN) & (steps > _STEEP * usual)


def _fronts(jumps: Mask, x: Array, y: Array) -> list[Array]:
    """The border between two cells of the map for each jump from one column to the next."""
    edges = np.concatenate([y[:1], 0.5 * (y[1:] + y[:-1]), y[-1:]])
    middles = 0.5 * (x[1:] + x[:-1])
    return [
        np.array([[middles[i], edges[j]], [middles[i], edges[j + 1]]])
        for j, i in zip(*np.nonzero(jumps), strict=True)
    ]


def _outside(line: Array, x: Array, y: Array, cells: Mask) -> Iterator[Array]:
    """Return the pieces of a contour outside of certain cells, without the shortest pieces."""
    middles = 0.5 * (line[1:] + line[:-1])
    column = np.clip(np.searchsorted(x, middles[:, 0]) - 1, 0, len(x) - 2)
    row = np.clip(np.searchsorted(y, middles[:, 1]) - 1, 0, len(y) - 2)
    inside = np.flatnonzero(cells[row, column])
    begins, ends = [0, *(inside + 1)], [*inside, len(line) - 1]
    for begin, end in zip(begins, ends, strict=True):
        piece = line[begin : end + 1]
        if end > begin and np.ptp(_part_of_panel(piece, x, y), axis=0).max() > _SHORTEST:
            yield piece


def _part_of_panel(points: Array, x: Array, y: Array) -> Array:
    """Points as parts of the panel's width and height, for axes of any scale."""
    along = [
        np.interp(points[..., i], places, np.linspace(0.0, 1.0, len(places)))
        for i, places in enumerate((x, y))
    ]
    return np.stack(along, axis=-1)


def _label_place(pieces: list[Array], x: Array, y: Array, taken: list[Array]) -> Array | None:
    """A point of the longest piece with room around it, as near to its middle as there is one."""
    longest = max(pieces, key=lambda p: np.ptp(_part_of_panel(p, x, y), axis=0).sum(), default=None)
    if longest is None:
        return None
    parts = _part_of_panel(longest, x, y)
    way = np.cumsum(np.concatenate([[0.0], np.hypot(*np.diff(parts, axis=0).T)]))
    free = ((parts > _ROOM) & (parts < 1.0 - _ROOM)).all(axis=1)
    for place in taken:
        free &= np.abs(parts - place).max(axis=1) > 2.0 * _ROOM
    if not free.any():
        return None
    off_middle = np.where(free, np.abs(way - 0.5 * way[-1]), np.inf)
    return np.asarray(longest[np.argmin(off_middle)])

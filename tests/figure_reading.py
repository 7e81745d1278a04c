"""Contents of a figure, read back from its artists by their labels and ids."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

Array = NDArray[np.float64]


def panel(figure: Figure, name: str) -> Axes:
    """The axes with this label."""
    (found,) = (axes for axes in figure.axes if axes.get_label() == name)
    return found


def lines(axes: Axes, gid: str) -> list[Line2D]:
    return [line for line in axes.lines if line.get_gid() == gid]


def points(line: Line2D) -> tuple[Array, Array]:
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def data(axes: Axes, gid: str) -> tuple[Array, Array]:
    """Return the data of the only line with this id."""
    (line,) = lines(axes, gid)
    return points(line)


def events(axes: Axes, kind: str, contact: str) -> tuple[Array, Array]:
    """Return the marked times of the events of this kind at this contact."""
    found = [points(line) for line in lines(axes, f"{kind} {contact}")]
    return found[0] if found else (np.zeros(0), np.zeros(0))


def spans(axes: Axes, gid: str) -> list[tuple[float, float]]:
    """From where to where each bar of a collection goes."""
    (bars,) = (c for c in axes.collections if c.get_gid() == gid)
    edges = [np.asarray(path.vertices)[:, 0] for path in bars.get_paths()]
    return [(float(edge.min()), float(edge.max())) for edge in edges]


def patch_spans(axes: Axes, gid: str | None) -> list[tuple[float, float, float, float]]:
    """X and y, from and to, of each rectangle with this id."""
    chosen = [patch for patch in axes.patches if patch.get_gid() == gid]
    boxes = [patch.get_path().get_extents(patch.get_patch_transform()) for patch in chosen]
    return [(box.x0, box.x1, box.y0, box.y1) for box in boxes]


def legend_of(owner: Any) -> dict[str, Any]:
    """The handles of a legend (or of the one legend of a figure) by their texts."""
    legend = owner.legends[0] if hasattr(owner, "legends") else owner.get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    assert len(texts) == len(set(texts)), "each sign is explained once"
    return dict(zip(texts, legend.legend_handles, strict=True))


def lay_out(figure: Figure) -> None:
    """Puts everything in its place, unless nothing has changed since that was done."""
    if figure.stale:
        figure.draw_without_rendering()


def collisions(figure: Figure) -> list[tuple[str, str]]:
    """Pairs of texts that overlap on the page, but for labels along contours."""
    lay_out(figure)
    found = []
    texts = [*figure.texts]
    for legend in figure.legends:
        texts += legend.get_texts()
    for axes in figure.axes:
        texts += [*axes.texts, axes.title, axes._left_title, axes._right_title]  # type: ignore[attr-defined]
        for along in (axes.xaxis, axes.yaxis):
            if axes.axison:
                low, high = sorted(along.get_view_interval())
                ticks = [t for t in along.get_major_ticks() if low <= t.get_loc() <= high]
                texts += [along.label, *(t.label1 for t in ticks if t.label1.get_visible())]
        if (own := axes.get_legend()) is not None:
            texts += own.get_texts()
    boxes = [
        (text.get_text(), text.get_window_extent())
        for text in texts
        if text.get_text().strip() and text.get_visible()
    ]
    figure.stale = False  # Matplotlib takes a figure for changed that is asked where its texts are
    for i, (one, box) in enumerate(boxes):
        for other, other_box in boxes[i + 1 :]:
            across = min(box.x1, other_box.x1) - max(box.x0, other_box.x0)
            down = min(box.y1, other_box.y1) - max(box.y0, other_box.y0)
            if across > 2.0 and down > 2.0:
                found.append((one, other))
    return found

"""Figure of a scan: page, tactile image, and the history of one pin."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from pindrive.device.dataset import gap_words
from pindrive.evaluation.tactile_image import Painting, paint, view
from pindrive.plot.pin import Moment, draw_history, moment
from pindrive.plot.style import MM, PALETTE, SMALL, STYLE, Figure, new_figure, plain
from pindrive.quantities.quantity import counted
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage
    from numpy.typing import NDArray

    from pindrive.device.scanning import Scan
    from pindrive.evaluation.perception import Evaluation

WIDTH: Final = 180.0
"""Assumed width of the page, mm."""
WIDE: Final = 1.7
"""Ratio of width to height from which on the scene stands above its tactile image."""
MOST: Final = 99.0
"""Percent of the tactile image within the scale of colours."""
LABELS: Final = {"lag_on": "lag on", "lag_off": "lag off"}
APART: Final = 1.5
"""Space between words of neighbouring rows, mm; the layout alone would let them touch."""
BAR: Final = 0.022
"""Width of the scale of colours, a part of the page's."""
TALLEST: Final = 1000.0
"""Height of a page as drawn at most, mm: a longer one is drawn smaller."""
HISTORY: Final = 124.0
"""Height of the history of a pin, mm."""
KEY_COLUMNS: Final = 4
SPOT: Final[dict[str, Any]] = {
    **{"ls": "none", "marker": "o", "ms": 2.6, "mew": 0.7},
    **{"mfc": "white", "mec": PALETTE["stick"]},
}
RETURN: Final[dict[str, Any]] = {"ls": (0, (1, 2)), "lw": 0.7}
RELIEF: Final = LinearSegmentedColormap.from_list(
    "relief",
    [
        (0.0, "#A84300"),
        (0.2, "#D55E00"),
        (0.5, "#FFFFFF"),
        (0.8, "#0072B2"),
        (1.0, "#00263F"),
    ],
)
"""Back is orange, at rest is white, forward is blue."""
BACK: Final = 0.1
"""Fraction of the scale from which on backward deflection is dotted, for grey print."""
SEEN: Final = 0.01
"""Shortest visible line, as a fraction of the page's width; its dot hides a shorter one."""
DOTTED: Final[dict[str, Any]] = {"fc": "none", "ec": "0.35", "hatch": "....", "lw": 0.0}


def plot_scan(evaluation: Evaluation, pin: int | None = None) -> Figure:
    """Draw a scan: the page and the way over it, the tactile image, and one pin's history.

    Args:
        evaluation: Evaluation of the scan.
        pin: Number of the pin with the drawn history; None: a pin with many lines, near the middle.

    Returns:
        A figure that belongs to nobody else.

    Raises:
        ValueError: No pin has this number.
    """
    scan = evaluation.scan
    left, right, top, bottom = view(scan)
    wide = right - left > WIDE * (bottom - top)
    chosen = moment(evaluation, pin)
    with matplotlib.style.context(STYLE, after_reset=True):
        scale = (WIDTH - 32.0) / (1 if wide else 2) / (right - left)
        scale = min(scale, TALLEST / (bottom - top))
        page = scale * (bottom - top) + 9.0
        pages = (2.0 * page if wide else page) + 6.0
        figure = new_figure(WIDTH, pages)
        figure.set_layout_engine(
            "constrained", h_pad=0.03, w_pad=0.03, rect=(0.012, 0.0, 0.98, 1.0)
        )
        rows = figure.add_gridspec(4, 1, height_ratios=(APART, pages, APART, HISTORY))
        if wide:
            cells = rows[1].subgridspec(2, 2, width_ratios=(1.0, BAR))
            places = cells[0, 0], cells[1, 0], cells[:, 1]
        else:
            cells = rows[1].subgridspec(1, 3, width_ratios=(1.0, 1.0, 2.0 * BAR))
            places = cells[0, 0], cells[0, 1], cells[0, 2]
        printed = figure.add_subplot(places[0], label="print")
        felt = figure.add_subplot(places[1], label="felt", sharex=printed, sharey=printed)
        key = figure.add_subplot(places[2], label="scale")
        _draw_print(scan, printed, chosen)
        image = _draw_felt(scan, felt, chosen)
        printed.set_xlim(MM * left, MM * right)
        printed.set_ylim(MM * bottom, MM * top)
        _scale(figure, image, key)
        if wide:
            printed.set_xlabel("")
            printed.tick_params(labelbottom=False)
        else:
            felt.set_ylabel("")
            felt.tick_params(labelleft=False)
        handles = [
            *_key(scan, [felt]),
            *draw_history(evaluation, chosen, figure, rows[3], _where(scan, chosen)),
        ]
        lines = -(-len(handles) // KEY_COLUMNS)
        figure.set_figheight((pages + HISTORY + 6.0 + 2.0 * APART + 4.0 * lines) / 25.4)
        _draw_key(figure, handles, KEY_COLUMNS)
        figure.head(_title(evaluation))
    return figure


def plot_reliefs(evaluations: Sequence[Evaluation]) -> Figure:
    """Draw what several scans of one scene showed, side by side in one scale, beside the print.

    Args:
        evaluations: Evaluations of the scans, at least one; the page is drawn by the first.

    Returns:
        A figure that belongs to nobody else.
    """
    first = evaluations[0].scan
    left, right, top, bottom = view(first, around=True)
    with matplotlib.style.context(STYLE, after_reset=True):
        side = (WIDTH - 26.0) / (len(evaluations) + 1)
        height = min(side * (bottom - top) / (right - left), TALLEST) + 33.0
        figure = new_figure(WIDTH, height)
        figure.set_layout_engine(
            "constrained", h_pad=0.03, w_pad=0.03, rect=(0.012, 0.0, 0.98, 1.0)
        )
        count = len(evaluations) + 1
        cells = figure.add_gridspec(1, count + 1, width_ratios=(*[1.0] * count, 2.0 * BAR))
        panels = [figure.add_subplot(cells[0, 0], label="print")]
        panels += [
            figure.add_subplot(cells[0, i], label=f"felt {i}", sharex=panels[0], sharey=panels[0])
            for i in range(1, count)
        ]
        _draw_print(first, panels[0], None)
        size = max(_size(paint(evaluation.scan)) for evaluation in evaluations)
        for axes, evaluation in zip(panels[1:], evaluations, strict=True):
            image = _draw_felt(evaluation.scan, axes, None, size)
            axes.set_title(_relief_title(evaluation), loc="left", fontsize=SMALL, pad=3.0)
            axes.set_ylabel("")
            axes.tick_params(labelleft=False)
        panels[0].set_xlim(MM * left, MM * right)
        panels[0].set_ylim(MM * bottom, MM * top)
        _scale(figure, image, figure.add_subplot(cells[0, count], label="scale"))
        _draw_key(figure, _key(first, panels), 4)
    return figure


def _key(scan: Scan, panels: Iterable[Axes]) -> list[Artist]:
    """Draw the legend of the signs on the page."""
    way: dict[str, Any] = {"color": PALETTE["stick"], "alpha": 0.8}
    handles: list[Artist] = [Line2D([], [], **way, lw=0.9, label="way of the hand, reading")]
    if any(back for _, back in _strokes(scan)):
        handles.append(Line2D([], [], **way, **RETURN, label="and back"))
    spot = Line2D([], [], **SPOT, label="initial sensing spot of a pin")
    handles += [spot, Line2D([], [], color="0.35", lw=0.5, label="outline of the print")]
    if any(mark.get_gid() == "back" for axes in panels for mark in axes.collections):
        handles.append(Patch(**DOTTED, label="deflected backwards"))
    return handles


def _draw_key(figure: Figure, handles: list[Artist], columns: int) -> None:
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=columns,
        handlelength=1.4,
        columnspacing=1.4,
    )


def _relief_title(evaluation: Evaluation) -> str:
    """Return the hand speed and the result of the evaluation, as a title."""
    counts = evaluation.counts
    speed = f"{MM * evaluation.scan.path.peak_speed:.4g} mm/s"
    lag, smear = (evaluation.spread(f"line.{name}")[1] for name in ("lag_off", "smear"))
    found = f"{counts['lines.shown']} of {counted(counts['lines.crossed'], 'line')} shown"
    smeared = "not settled" if isnan(smear) else f"smear {MM * smear:.2g} mm"
    scan = evaluation.scan
    overlap = "".join(
        f"\n{name} overlap by {-MM * gap.size:.2g} mm"
        for name, gap in (("pins", scan.smallest_gap), ("magnets", scan.smallest_magnet_gap))
        if gap and gap.size < 0.0
    )
    return f"hand at up to {speed}\n{found}\nlag {MM * lag:.2g} mm\n{smeared}{overlap}"


def _draw_print(scan: Scan, axes: Axes, chosen: Moment | None) -> None:
    left, right, top, bottom = (MM * edge for edge in scan.scene.extent)
    axes.imshow(
        scan.scene.luminance,
        cmap="gray",
        vmin=-0.35,  # a dark grey, so that the way is seen on it
        vmax=1.0,
        extent=(left, right, bottom, top),
        interpolation="antialiased",
        gid="scene",
    )
    _draw_way(scan, axes)
    _frame(axes, f"printed: {plain(scan.scene.title)}")
    spots = MM * scan.spots([scan.path.begin])[:, 0]
    axes.plot(*spots.T, **SPOT, gid="spots")
    if chosen:
        _draw_moment(scan, axes, chosen)


def _draw_way(scan: Scan, axes: Axes) -> None:
    """The hand's strokes: reading solid with an arrow, back dotted."""
    strokes = [(t, back, scan.path.position(t)) for t, back in _strokes(scan)]
    longest = max((t[-1] - t[0] for t, _, _ in strokes), default=0.0)
    for t, back, (x, y) in strokes:
        style: dict[str, Any] = RETURN if back else {"lw": 0.9}
        gid = "return" if back else "way"
        axes.plot(MM * x, MM * y, color=PALETTE["stick"], alpha=0.8, gid=gid, **style)
        if not back and t[-1] - t[0] > 0.1 * longest:
            axes.annotate(
                "",
                (MM * x[-1], MM * y[-1]),
                (MM * x[-12], MM * y[-12]),
                arrowprops={"arrowstyle": "-|>", "color": PALETTE["stick"], "lw": 0.9},
            )


def _strokes(scan: Scan) -> Iterator[tuple[NDArray[np.float64], bool]]:
    """Times along each stroke of the hand, and whether it goes back; pauses are left out."""
    path = scan.path
    cuts = np.unique([path.begin, *path.turnings(scan.device.array.axis).tolist(), path.end])
    plate = path.plate_velocity(scan.device.array.axis)
    for begin, end in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
        t = np.linspace(begin, end, 200)
        x, y = path.position(t)
        if np.hypot(np.ptp(x), np.ptp(y)) >= 1e-9:
            yield t, float(plate(0.5 * (begin + end) - path.begin)) < 0.0


def _draw_felt(
    scan: Scan, axes: Axes, chosen: Moment | None, size: float | None = None
) -> AxesImage:
    painting = paint(scan)
    size = _size(painting) if size is None else size
    left, right, top, bottom = (MM * edge for edge in painting.extent)
    image = axes.imshow(
        MM * painting.deflection,
        cmap=RELIEF,
        norm=TwoSlopeNorm(0.0, -size, size),
        extent=(left, right, bottom, top),
        interpolation="nearest",
        gid="relief",
    )
    _dot_back(axes, painting, size)
    dark = scan.scene.luminance
    if dark.min() < scan.device.control.threshold < dark.max():
        outline = axes.contour(
            *_middles(painting, dark.shape),
            dark,
            [scan.device.control.threshold],
            colors="0.35",
            linewidths=0.5,
        )
        outline.set_gid("outline")
    axes.set_facecolor("0.94")
    _frame(axes, "shown to the finger")
    if chosen:
        _draw_moment(scan, axes, chosen)
    return image


def _dot_back(axes: Axes, painting: Painting, size: float) -> None:
    """Dots where the pin was deflected backwards, which a colour alone would say."""
    back = MM * painting.deflection < -BACK * size
    if back.any() and min(back.shape) > 1:
        middles = _middles(painting, back.shape)
        marks = axes.contourf(*middles, back, [0.5, 1.5], colors="none", hatches=[DOTTED["hatch"]])
        marks.set(edgecolor=DOTTED["ec"], linewidth=0.0, gid="back")


def _middles(painting: Painting, shape: tuple[int, ...]) -> tuple[NDArray[np.float64], ...]:
    """Return the centres x and y (mm) of rows and columns on the extent."""
    left, right, top, bottom = (MM * edge for edge in painting.extent)
    rows, columns = shape
    x = left + (np.arange(columns) + 0.5) * (right - left) / columns
    return x, top + (np.arange(rows) + 0.5) * (bottom - top) / rows


def _size(painting: Painting) -> float:
    """The deflection at the ends of the scale of colours, mm."""
    painted = np.abs(painting.deflection[~np.isnan(painting.deflection)])
    return max(MM * float(np.percentile(painted, MOST)), 1e-6) if painted.size else 1.0


def _scale(figure: Figure, image: AxesImage, place: Axes) -> None:
    bar = figure.colorbar(image, cax=place, extend="both")
    bar.set_label("deflection, forward (mm)", fontsize=SMALL)


def _draw_moment(scan: Scan, axes: Axes, chosen: Moment) -> None:
    """Mark the place of the history on the page."""
    x, y = MM * _track(scan, chosen)
    axes.plot(x, y, color=PALETTE["slip"], lw=1.6, solid_capstyle="butt", gid="moment")
    axes.plot(x[:1], y[:1], "o", color=PALETTE["slip"], ms=3.5, gid="moment")


def _track(scan: Scan, chosen: Moment) -> NDArray[np.float64]:
    """Return the path of the pin's spot in that time, m, of shape (2, n)."""
    spots: NDArray[np.float64] = scan.spots(np.linspace(chosen.begin, chosen.end, 200))[chosen.pin]
    return spots.T


def _where(scan: Scan, chosen: Moment) -> str:
    """Return the visible part of the path in the pictures above: a line, its dot, or nothing."""
    left, right, top, bottom = view(scan)
    x, y = _track(scan, chosen)
    inside = (left <= x) & (x <= right) & (top <= y) & (y <= bottom)
    length = np.hypot(np.diff(x), np.diff(y))[inside[1:]].sum()
    if length > SEEN * (right - left):
        return "along the thick line above"
    return "at the dot above" if inside[0] else "beyond the page"


def _frame(axes: Axes, title: str) -> None:
    axes.set_title(title, loc="left", fontsize=SMALL + 0.5, pad=3.0)
    axes.set_xlabel("across the page (mm)")
    axes.set_ylabel("down (mm)")
    axes.set_aspect("equal")
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_linewidth(0.4)
        spine.set_color("0.6")


def _title(evaluation: Evaluation) -> str:
    """Return the scanned page and the counts of its lines, as a title."""
    scan, counts = evaluation.scan, evaluation.counts
    lines, shown = counts["lines.crossed"], counts["lines.shown"]
    pins = f"{len(scan.pins)} pin{'s' if len(scan.pins) > 1 else ''}"
    speed = QUANTITIES["hand_speed"].text(scan.path.peak_speed)
    what = f"{pins}, {scan.path.end - scan.path.begin:.3g} s, hand at up to {speed}"
    if not lines:
        return "\n".join([f"{what}; no line passed completely under a pin.", *gap_words(scan)])
    medians = []
    for name in ("lag_on", "lag_off", "smear", "overshoot", "contrast"):
        value, unit = evaluation.spread(f"line.{name}")[1], QUANTITIES[f"line.{name}"].unit
        if not isnan(value):
            label = LABELS.get(name, name)
            medians.append(
                f"{label} {value:.2f}" if unit == "1" else f"{label} {MM * value:.2g} mm"
            )
    found = f"{shown} of {counted(lines, 'line')} shown, {counts['lines.false']} false"
    notes = [*([f"Medians: {', '.join(medians)}."] if medians else []), *gap_words(scan)]
    return "\n".join([f"{what}: {found}.", *notes])

"""The path of a hand that gave way to its pins: speed, deviation, and the magnets that are on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib.style
import numpy as np

from pindrive.plot.style import GREY, MM, PALETTE, STYLE, new_figure, plain, shade

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from pindrive.device.compliant_hand import HandMotion
    from pindrive.device.scanning import Scan
    from pindrive.plot.style import Figure


def plot_hand(scan: Scan, hand: HandMotion) -> Figure:
    """Draw the speed of a hand, its distance from the intended path, and the magnets that are on.

    Args:
        scan: A scan.
        hand: Path of its hand.

    Returns:
        A figure 180 mm wide that belongs to nobody else.
    """
    with matplotlib.style.context(STYLE, after_reset=True):
        figure = new_figure(180, 105)
        rows = figure.add_gridspec(3, 1, height_ratios=(2.0, 1.4, 0.9))
        v = figure.add_subplot(rows[0], label="speed")
        e = figure.add_subplot(rows[1], label="deviation", sharex=v)
        n = figure.add_subplot(rows[2], label="magnets", sharex=v)
        t = hand.times
        for axes in (v, e):
            axes.axhline(0.0, color="0.8", lw=0.5, zorder=0, gid="zero")
            stops = [(begin, end - begin) for begin, end in hand.stops]
            shade(axes, stops, "stopped", color=PALETTE["stick"], alpha=0.25, zorder=0.5)
            axes.tick_params(labelbottom=False)
        v.plot(t, MM * hand.intended_speed(t), color=GREY, ls=(0, (6, 2)), label="intended")
        v.plot(t, MM * hand.speed(t), color=PALETTE["curve"], label="hand", gid="speed")
        v.set_ylabel("speed (mm/s)")
        v.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        e.plot(t, MM * hand.deviation(t), color=PALETTE["curve"], gid="deviation")
        e.set_ylabel("off its path (mm)")
        times, counts = _magnets(scan)
        n.step(times, counts, where="post", color="black", lw=0.9, gid="magnets")
        n.set_ylabel("magnets on")
        n.set_ylim(0.0, max(1.0, 1.15 * counts.max()))
        n.set_xlabel("time (s)")
        n.set_xlim(float(t[0]), float(t[-1]))
        figure.align_ylabels((v, e, n))
        slowest = f"slowest {MM * hand.slowest_speed:.3g} mm/s at {hand.slowest_time:.3g} s"
        off = f"up to {MM * hand.error:.3g} mm off its path"
        figure.head(plain(f"Hand over {scan.scene.title}: {slowest}, {off}"))
    return figure


def _magnets(scan: Scan) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times at which the number of magnets that are on changes, s, and the numbers."""
    spans = [span for pin in scan.pins for span in pin.energised]
    changes = sorted([(begin, 1) for begin, _ in spans] + [(end, -1) for _, end in spans])
    times = np.array([scan.path.begin, *(time for time, _ in changes), scan.path.end])
    counts = np.cumsum([0, *(step for _, step in changes), 0]).astype(np.float64)
    return times, counts

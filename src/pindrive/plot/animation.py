"""A scan as a moving picture: the mouse over the page, the pins under the finger, slowed down.

Only what moves is drawn anew in each frame. GIF is written by Pillow, MP4 by ffmpeg.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import matplotlib.style
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, FancyBboxPatch
from PIL import Image

from pindrive.evaluation.tactile_image import view
from pindrive.plot.pin import moment
from pindrive.plot.style import GREY, MM, PALETTE, SMALL, STYLE, plain
from pindrive.quantities import budgets
from pindrive.quantities.refusal import refusal

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from pindrive.device.hand import HandPath
    from pindrive.device.pin_scan import Progress
    from pindrive.device.scanning import Scan
    from pindrive.evaluation.perception import Evaluation


FRAMES: Final = 25
"""In each second."""
SIZE: Final = (960, 540)
"""Pixels."""
DPI: Final = 110
ROOM: Final = 3.0
"""About the pins, in the mouse and under the finger, mm."""
FORMATS: Final = (".gif", ".mp4")


def animation_format(path: Path) -> str:
    """The format that the name of an animation asks for, if this machine can write it.

    Raises:
        ValueError: The suffix is neither .gif nor .mp4, or ffmpeg is missing for MP4.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise ValueError(f"{path}: must end in {' or '.join(FORMATS)}")
    if suffix == ".mp4" and ffmpeg() is None:
        raise ValueError(
            f"{path}: MP4 takes ffmpeg, which is not here; install it, or "
            "pip install imageio-ffmpeg, or write a .gif"
        )
    return suffix.removeprefix(".")


def ffmpeg() -> str | None:
    """Path of ffmpeg: from the search path, or from the package imageio-ffmpeg."""
    found = shutil.which("ffmpeg")
    if found is None:
        try:
            from imageio_ffmpeg import get_ffmpeg_exe

            found = str(get_ffmpeg_exe())
        except (ImportError, RuntimeError):
            return None
    return found


def frame_times(path: HandPath, slow: float) -> NDArray[np.float64]:
    """Return the times of the frames, s, for an animation slowed down by a factor.

    Raises:
        ValueError: `slow` is not greater than 0, or there would be too many frames.
    """
    if not slow > 0.0:
        raise ValueError(refusal("`slow`", "greater than 0", repr(slow)))
    lasts = path.end - path.begin
    count = ceil(min(lasts * slow * FRAMES, 1e15)) + 1
    most = budgets.FRAMES.most
    if count > most:
        fit = (most - 1) / FRAMES / lasts
        given = f"{slow:g}, which makes {count} frames of at most {most}"
        raise ValueError(refusal("`slow`", f"at most {fit:.3g} for {lasts:.3g} s", given))
    return np.minimum(path.begin + np.arange(count) / (slow * FRAMES), path.end)


def animate(
    evaluation: Evaluation,
    target: Path,
    kind: str,
    *,
    slow: float = 4.0,
    progress: Progress | None = None,
) -> None:
    """Write a scan as a moving picture.

    Args:
        evaluation: Evaluation of the scan.
        target: File to write.
        kind: "gif" or "mp4".
        slow: Factor by which the animation is slower than the hand; greater than 0.
        progress: Function called after each frame.

    Raises:
        ValueError: Too many frames, or ffmpeg fails.
    """
    times = frame_times(evaluation.scan.path, slow)
    with matplotlib.style.context(STYLE, after_reset=True):
        stage = _Stage.of(evaluation, times, slow)
        write = _write_gif if kind == "gif" else _write_mp4
        write(_told(stage, len(times), progress), target)


def _told(stage: _Stage, count: int, progress: Progress | None) -> Iterator[NDArray[np.uint8]]:
    for i in range(count):
        yield stage.frame(i)
        if progress:
            progress(i + 1, count)


# ---- files ---------------------------------------------------------------------------------------


def _write_gif(frames: Iterator[NDArray[np.uint8]], target: Path) -> None:
    def quantized() -> Iterator[Image.Image]:
        palette: Image.Image | None = None
        for frame in frames:
            image = Image.fromarray(frame[..., :3])
            if palette is None:  # one palette for all frames: still parts stay equal
                palette = _palette(image)
            yield image.quantize(palette=palette, dither=Image.Dither.NONE)

    images = quantized()
    first = next(images)
    first.save(
        target,
        format="GIF",
        save_all=True,
        append_images=images,
        duration=1000 // FRAMES,
        loop=0,
        optimize=False,
    )


def _palette(image: Image.Image) -> Image.Image:
    """Return a palette with the colours of moving parts, beside the colours of the first frame."""
    tints = np.linspace(0.0, 1.0, 9)[:, np.newaxis]
    rows = [
        np.round(255.0 * (tints * np.array(to_rgb(PALETTE[name])) + 1.0 - tints))
        for name in ("curve", "stick", "slip", "carried")
    ]
    moving = np.concatenate(rows).astype(np.uint8)
    swatch = np.repeat(np.repeat(moving[np.newaxis], 400, axis=0), 4, axis=1)
    both = Image.new("RGB", (max(image.width, swatch.shape[1]), image.height + 400))
    both.paste(image, (0, 0))
    both.paste(Image.fromarray(swatch), (0, image.height))
    return both.quantize(255)


def _write_mp4(frames: Iterator[NDArray[np.uint8]], target: Path) -> None:
    command = [
        ffmpeg() or "ffmpeg",
        *("-hide_banner", "-loglevel", "error", "-y"),
        *("-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{SIZE[0]}x{SIZE[1]}"),
        *("-r", str(FRAMES), "-i", "-"),
        *("-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-movflags", "+faststart"),
        *("-f", "mp4", str(target)),
    ]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as writer:
        assert writer.stdin and writer.stderr
        try:
            for frame in frames:
                writer.stdin.write(frame.tobytes())
            writer.stdin.close()
        except BrokenPipeError:
            pass  # the reason follows below
        said = writer.stderr.read().decode(errors="replace").strip()
    if writer.returncode:
        raise ValueError(f"ffmpeg could not write MP4: {said.splitlines()[-1] if said else ''}")


# ---- the stage -----------------------------------------------------------------------------------


@dataclass(eq=False)
class _Stage:
    """Still parts, drawn once, and moving parts of an animation."""

    canvas: Any
    background: Any
    moving: list[tuple[Axes, Artist]]
    place: Callable[[int], None]
    """Puts what moves where it is in a frame."""

    def frame(self, i: int) -> NDArray[np.uint8]:
        """Frame i, shape (height, width, 4)."""
        self.place(i)
        self.canvas.restore_region(self.background)
        for axes, artist in self.moving:
            axes.draw_artist(artist)
        return np.array(self.canvas.buffer_rgba())

    @classmethod
    def of(cls, evaluation: Evaluation, times: NDArray[np.float64], slow: float) -> _Stage:
        """Set it for a scan."""
        scan = evaluation.scan
        figure = Figure(figsize=(SIZE[0] / DPI, SIZE[1] / DPI), dpi=DPI, layout="constrained")
        canvas: Any = FigureCanvasAgg(figure)
        rows = figure.add_gridspec(2, 2, height_ratios=(2.6, 1.0), width_ratios=(1.6, 1.0))
        page = figure.add_subplot(rows[0, 0])
        finger = figure.add_subplot(rows[0, 1])
        strip = figure.add_subplot(rows[1, :])
        parts = [
            _page(scan, page, times),
            _finger(scan, finger, times),
            _strip(evaluation, strip, times, slow),
        ]
        moving = [
            (axes, artist)
            for axes, (artists, _) in zip((page, finger, strip), parts, strict=True)
            for artist in artists
        ]
        for _, artist in moving:
            artist.set_animated(True)
        canvas.draw()

        def place(i: int) -> None:
            for _, move in parts:
                move(i)

        return cls(canvas, canvas.copy_from_bbox(figure.bbox), moving, place)


Part = tuple[list[Any], Callable[[int], None]]


def _page(scan: Scan, axes: Axes, times: NDArray[np.float64]) -> Part:
    """The print, the mouse on it, and the way that its middle went."""
    left, right, top, bottom = (MM * edge for edge in scan.scene.extent)
    axes.imshow(
        scan.scene.luminance, cmap="gray", vmin=0.0, vmax=1.0, extent=(left, right, bottom, top)
    )
    axes.set_title(
        f"{plain(scan.scene.title)}; red line: way of the hand",
        loc="left",
        fontsize=SMALL,
        pad=3.0,
    )
    _bare(axes)
    spots = MM * scan.spots(times)
    x, y = (MM * place for place in scan.path.position(times))
    offsets = MM * scan.device.array.on_page(scan.device.array.spots)
    low, high = offsets.min(axis=0) - ROOM, offsets.max(axis=0) + ROOM
    mouse = FancyBboxPatch(
        (0.0, 0.0),
        float(high[0] - low[0]),
        float(high[1] - low[1]),
        boxstyle="round,pad=0,rounding_size=2.5",
        fc=PALETTE["carried"],
        alpha=0.35,
        ec=PALETTE["curve"],
        lw=1.0,
    )
    axes.add_patch(mouse)
    (way,) = axes.plot([], [], color=PALETTE["stick"], lw=0.9, alpha=0.8)
    shown = axes.scatter(spots[:, 0, 0], spots[:, 0, 1], s=9.0, lw=0.5, ec="black", zorder=4)
    on = np.stack([pin.commands.on(times) for pin in scan.pins])

    def move(i: int) -> None:
        mouse.set_x(x[i] + low[0])
        mouse.set_y(y[i] + low[1])
        way.set_data(x[: i + 1], y[: i + 1])
        shown.set_offsets(spots[:, i])
        shown.set_facecolor(_colours(on[:, i]))

    left, right, top, bottom = (MM * edge for edge in view(scan))
    axes.set_xlim(left - ROOM, right + ROOM)
    axes.set_ylim(bottom + ROOM, top - ROOM)
    return [mouse, way, shown], move


def _finger(scan: Scan, axes: Axes, times: NDArray[np.float64]) -> Part:
    """The pins under the fingertip, in their true size, and the force of each on the skin."""
    array = scan.device.array
    places = MM * array.on_page(array.places)
    direction = np.array(array.direction)
    x = MM * np.stack([pin.position(times) for pin in scan.pins])
    force = np.stack([pin.skin_force(times) for pin in scan.pins])
    on = np.stack([pin.commands.on(times) for pin in scan.pins])
    middle, extent = places.mean(axis=0), np.ptp(places, axis=0) + 4.0 * ROOM
    axes.add_patch(Ellipse(tuple(middle), *(1.15 * extent), fc="#f3d3bd", ec="#c9926d", lw=1.0))
    farthest = max(float(np.abs(x).max()), 1e-3)
    for place in places:
        ends = place + np.outer((-farthest, farthest), direction)
        axes.plot(*ends.T, color="0.55", lw=0.6, solid_capstyle="round")
        axes.plot(*place, "+", color="0.35", ms=4.0, mew=0.6)
    pins = EllipseCollection(
        *np.broadcast_to(
            [[MM * array.pin_diameter], [MM * array.pin_diameter], [0.0]], (3, len(array))
        ),
        units="xy",
        offsets=places,
        offset_transform=axes.transData,
        lw=0.8,
        ec="black",
        zorder=4,
    )
    axes.add_collection(pins)
    arrows = LineCollection([], colors="black", lw=1.6, zorder=5)
    axes.add_collection(arrows)
    longest = 2.2 / max(float(np.abs(force).max()), 1e-12)  # mm for each newton
    axes.set_title(
        "under the finger; red: magnet on, bars: force on the skin", fontsize=SMALL, pad=3.0
    )
    reach = 0.62 * extent + farthest * np.abs(direction)
    axes.set_xlim(middle[0] - reach[0], middle[0] + reach[0])
    axes.set_ylim(middle[1] + reach[1], middle[1] - reach[1])
    _bare(axes)

    def move(i: int) -> None:
        at = places - np.outer(x[:, i], direction)  # x counts against the hand's own motion
        pins.set_offsets(at)
        pins.set_facecolor(_colours(on[:, i]))
        tips = at - np.outer(longest * force[:, i], direction)
        arrows.set_segments(list(np.stack([at, tips], axis=1)))

    return [pins, arrows], move


def _strip(evaluation: Evaluation, axes: Axes, times: NDArray[np.float64], slow: float) -> Part:
    """One pin's deflection over the whole scan, and now."""
    scan = evaluation.scan
    pin = scan.pins[moment(evaluation).pin]
    t = np.linspace(pin.begin, pin.end, 4000)
    axes.axhline(0.0, color="0.8", lw=0.5)
    for on, off in pin.energised:
        axes.axvspan(on, off, color=PALETTE["stick"], alpha=0.18, lw=0.0)
    axes.plot(t, MM * pin.position(t), color=PALETTE["curve"], lw=1.0)
    axes.set_xlim(pin.begin, pin.end)
    axes.margins(y=0.1)
    axes.set_xlabel("time (s)", fontsize=SMALL)
    axes.set_ylabel(f"pin {pin.number} (mm)", fontsize=SMALL)
    axes.set_title(
        f"shaded: magnet on; {slow:g} times slower than the hand",
        loc="right",
        fontsize=SMALL,
        pad=2.0,
        color=GREY,
    )
    now = axes.axvline(pin.begin, color="black", lw=0.9)
    (dot,) = axes.plot([], [], "o", color="black", ms=4.0)
    x = MM * pin.position(times)

    def move(i: int) -> None:
        now.set_xdata([times[i]] * 2)
        dot.set_data([times[i]], [x[i]])

    return [now, dot], move


def _colours(on: NDArray[np.bool_]) -> list[str]:
    return [PALETTE["stick"] if lit else "white" for lit in on.tolist()]


def _bare(axes: Axes) -> None:
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)

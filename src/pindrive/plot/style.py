"""The look of every figure: type, lines, colours, and how a figure is written."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from io import BytesIO
from itertools import product
from pathlib import Path
from textwrap import fill
from typing import IO, TYPE_CHECKING, Any, Final

import matplotlib.style
from matplotlib.figure import Figure as _Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

Sign = tuple[str, str]
"""Kind and contact of an event."""

PALETTE: Final = {
    "curve": "#0072B2",  # blue
    "stick": "#D55E00",  # vermillion
    "slip": "#009E73",  # bluish green
    "reverse": "#000000",
    "stop": "#000000",
    "leave": "#000000",
    "plate": "#000000",
    "carried": "#56B4E9",  # sky blue
    "resting": "#E69F00",  # orange
    "gripping": "#CC79A7",  # reddish purple
}
"""Okabe and Ito's colours, which colour-blind readers tell apart (Color Universal Design, 2008)."""

EVENT_SHAPE: Final = {"stick": "s", "slip": "^", "reverse": "D", "stop": "X", "leave": "o"}
CONTACTS: Final = {
    "plate": ("full", 3.2),
    "finger": ("none", 6.0),
    "both": ("left", 6.0),
    "stop": ("none", 9.0),
}
"""Fill and size of a marker, by the contact that changes."""
SIGNS: Final[tuple[Sign, ...]] = (
    *product(("stick", "slip", "reverse"), ("plate", "finger", "both")),
    ("stop", "stop"),
    ("leave", "stop"),
)
"""All that can occur, in the order of a legend."""

CURVES: Final[tuple[dict[str, Any], ...]] = (
    {"color": "#0072B2", "ls": "-"},
    {"color": "#D55E00", "ls": (0, (6, 2))},
    {"color": "#009E73", "ls": (0, (6, 2, 1.5, 2))},
    {"color": "#CC79A7", "ls": (0, (3, 1.5))},
    {"color": "#E69F00", "ls": "-", "lw": 2.0},
    {"color": "#56B4E9", "ls": (0, (1.5, 1.5)), "lw": 1.6},
)
"""Colours and dashes of neighbouring curves; dashes are for grey print."""

PRINTED: Final[dict[str, Any]] = {"fc": "0.96", "ec": "0.72", "hatch": "/////", "lw": 0.0}
"""Hatching of the passage of a printed line, to be distinguishable in grey."""
LIFTED: Final[dict[str, Any]] = {"fc": "none", "ec": "#0072B2", "hatch": "....", "lw": 0.0}
"""While the finger is lifted: dotted, as nothing is felt."""
HANDS: Final[dict[str, Any]] = {"fc": "#FBF0D8", "ec": "#E69F00", "hatch": "\\\\\\\\", "lw": 0.0}
"""A band that other areas cover."""
HALO: Final = [withStroke(linewidth=2.0, foreground="white")]
"""Outline of a text that a line may cross."""

MM: Final = 1e3
"""Millimetres per metre, for lengths and velocities."""
MS: Final = 1e3
"""Milliseconds per second."""

GREY: Final = "0.45"
SMALL: Final = 7.0

STYLE: Final[dict[str, Any]] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    **{f"{axis}tick.labelsize": SMALL for axis in "xy"},
    **{f"{axis}tick.major.width": 0.6 for axis in "xy"},
    **{f"{axis}tick.major.size": 2.5 for axis in "xy"},
    "axes.formatter.useoffset": False,
    "axes.formatter.use_mathtext": True,
    "axes.formatter.limits": (-2, 5),
    "lines.linewidth": 1.1,
    "lines.markersize": 4.0,
    "axes.titlesize": 8.0,
    "figure.titlesize": 8.0,
    "figure.dpi": 250,
    "figure.constrained_layout.use": True,
    "legend.fontsize": SMALL,
    "legend.frameon": False,
    "hatch.linewidth": 0.5,
    "agg.path.chunksize": 5000,  # a third faster with a hundred thousand points
    "svg.fonttype": "none",  # text as text
    "svg.hashsalt": "pindrive",  # one motion makes one file
    "pdf.fonttype": 42,  # TrueType: journals refuse Type 3
}
_SAVING: Final[dict[str, dict[str, Any]]] = {
    "png": {},
    "svg": {"metadata": {"Date": None}},
    "pdf": {"metadata": {"CreationDate": None}},
}


def plain(text: str, width: int = 10_000) -> str:
    """Return a user's text in lines of limited length, safe from formula syntax."""
    return fill(text, width).replace("$", r"\$")


def event_name(kind: str, contact: str) -> str:
    """Return the name of an event: "sticks at the plate", "strikes an end stop"."""
    if contact == "stop":
        return {"stop": "strikes an end stop", "leave": "leaves an end stop"}[kind]
    change = {"stick": "sticks", "slip": "slips", "reverse": "reverses"}[kind]
    return f"{change} at {'both' if contact == 'both' else f'the {contact}'}"


def event_marker(kind: str, contact: str) -> dict[str, Any]:
    """The marker of an event: its shape is the kind, how it is filled the contact.

    Symbols of the finger are larger than those of the plate: both are seen in one place.
    """
    fill, size = CONTACTS[contact]
    look = {"marker": EVENT_SHAPE[kind], "color": PALETTE[kind], "fillstyle": fill, "ms": size}
    return {"ls": "none", "mew": 0.9, "mfcalt": "white", **look, "gid": f"{kind} {contact}"}


def mark_events(axes: Axes, points: Iterable[tuple[str, str, float, float]]) -> list[Sign]:
    """Mark events, each given by kind, contact and place; the signs that occur, for a legend."""
    places: dict[Sign, list[tuple[float, float]]] = {}
    for kind, contact, *place in points:
        places.setdefault((kind, contact), []).append((place[0], place[1]))
    signs = [sign for sign in SIGNS if sign in places]
    for sign in signs:
        axes.plot(*zip(*places[sign], strict=True), **event_marker(*sign), zorder=3)
    return signs


def event_key(signs: Iterable[Sign]) -> list[Artist]:
    """Return the legend of the markers of events."""
    return [Line2D([], [], **event_marker(*sign), label=event_name(*sign)) for sign in signs]


def shade(axes: Axes, spans: Sequence[tuple[float, float]], gid: str, **look: Any) -> None:
    """Shade stretches along the abscissa (begin, length) over the height of a panel."""
    up = axes.get_xaxis_transform()
    axes.broken_barh(spans, (0.0, 1.0), transform=up, **{"lw": 0.0, **look}, gid=gid)


class Figure(_Figure):
    """A figure that a notebook shows where its cell ends in one.

    Matplotlib leaves that to pyplot, which this package does without: it would open windows.
    """

    def head(self, text: str) -> None:
        """Write lines of text at its top, on the left."""
        self.suptitle(text, x=0.008, ha="left")

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        """The picture, and its size on the screen, at which it is as large as on paper."""
        file = BytesIO()
        save(self, file, "png")
        width, height = (round(96 * inches) for inches in self.get_size_inches())
        return file.getvalue(), {"width": width, "height": height}


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure with a size in millimetres; made, and drawn in, within `STYLE`."""
    return Figure(figsize=(width / 25.4, height / 25.4))


def save(
    figure: _Figure, target: str | os.PathLike[str] | IO[bytes], format: str | None = None
) -> None:
    """Write a figure, with its text as text where the format has text.

    Args:
        figure: Any that this package drew.
        target: A path or a file open for writing bytes.
        format: "png" (250 dpi), "svg" or "pdf"; the ending of the path unless given.
    """
    kind = format or str(target).rpartition(".")[2].lower()
    file = BytesIO()  # a disk that is full then fails here, not in Matplotlib, which leaves it open
    with matplotlib.style.context(STYLE, after_reset=True):
        figure.savefig(file, format=kind, **_SAVING.get(kind, {}))
    if isinstance(target, (str, os.PathLike)):
        Path(target).write_bytes(file.getvalue())
    else:
        target.write(file.getvalue())

"""Lazy imports of slow libraries, at the first use of a name.

The libraries of the extra "complete" need not be installed: what needs none of them works without.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Final

__all__ = [
    "COMPLETE",
    "PAPER",
    "Image",
    "ImageDraw",
    "ImageFont",
    "ImageOps",
    "features",
    "ft2font",
    "h5netcdf",
    "h5py",
    "linalg",
    "matplotlib",
    "missing",
    "mpl_figure",
    "optimize",
    "pint",
    "qmc",
    "require",
    "rich_console",
    "rich_progress",
    "signal",
    "special",
    "stats",
    "xr",
]

if TYPE_CHECKING:
    from types import ModuleType

    import h5netcdf
    import h5py
    import matplotlib
    import pint
    import rich.console as rich_console
    import rich.progress as rich_progress
    import xarray as xr
    from matplotlib import figure as mpl_figure
    from matplotlib import ft2font
    from PIL import Image, ImageDraw, ImageFont, ImageOps, features
    from scipy import linalg, optimize, signal, special, stats
    from scipy.stats import qmc
else:

    class _Module:
        """A module that is loaded when a name in it is first used."""

        def __init__(self, name: str) -> None:
            self._name = name

        def __getattr__(self, name: str) -> object:
            return getattr(_loaded(self._name), name)

    h5netcdf = _Module("h5netcdf")
    h5py = _Module("h5py")
    matplotlib = _Module("matplotlib")
    mpl_figure = _Module("matplotlib.figure")
    pint = _Module("pint")
    xr = _Module("xarray")
    ft2font = _Module("matplotlib.ft2font")
    Image = _Module("PIL.Image")
    ImageDraw = _Module("PIL.ImageDraw")
    ImageFont = _Module("PIL.ImageFont")
    ImageOps = _Module("PIL.ImageOps")
    features = _Module("PIL.features")
    rich_console = _Module("rich.console")
    rich_progress = _Module("rich.progress")
    linalg = _Module("scipy.linalg")
    optimize = _Module("scipy.optimize")
    signal = _Module("scipy.signal")
    special = _Module("scipy.special")
    stats = _Module("scipy.stats")
    qmc = _Module("scipy.stats.qmc")

COMPLETE: Final = {
    "PIL": "pillow",
    "h5netcdf": "h5netcdf",
    "h5py": "h5py",
    "matplotlib": "matplotlib",
    "scipy": "scipy",
    "xarray": "xarray",
}
"""Distributions of the extra "complete", by the names of their packages."""
PAPER: Final = {"latex2mathml": "latex2mathml", "markdown_it": "markdown-it-py"}
"""Distributions that the extra "paper" adds to "complete", by the names of their packages."""


def missing(error: ModuleNotFoundError) -> str:
    """Return the advice to install a missing import; empty outside of both extras."""
    name = (error.name or "").partition(".")[0]
    for extra, libraries in (("complete", COMPLETE), ("paper", PAPER)):
        if name in libraries:
            needed = f'python -m pip install "pindrive[{extra}]"'
            return f"{libraries[name]} is not installed; {needed} installs it"
    return ""


def require(name: str) -> None:
    """Refuse where a package of the extra "complete" is not installed; nothing is loaded.

    Raises:
        ModuleNotFoundError: The module is not installed; the message tells the installation.
    """
    from importlib.util import find_spec

    if find_spec(name) is None:
        raise ModuleNotFoundError(missing(ModuleNotFoundError(name=name)), name=name)


def _loaded(name: str) -> ModuleType:
    """A module by its full name, without importlib: that is not loaded yet when Python starts."""
    try:
        __import__(name)
    except ModuleNotFoundError as error:
        if reason := missing(error):
            raise ModuleNotFoundError(reason, name=error.name) from None
        raise
    return sys.modules[name]

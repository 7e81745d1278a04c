"""The kinds of files that commands write, each told by what stands in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from pindrive.output import Kind

_HEAD: Final = 4096


def _beginning(name: str, *beginnings: bytes) -> Kind:
    """A kind whose files begin so."""
    return Kind(name, lambda path: _head(path).startswith(beginnings))


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(_HEAD)


def _titled(name: str, beginning: str) -> Kind:
    """A NetCDF file of pindrive by the beginning of its title."""
    return Kind(name, lambda path: _attribute(path, "title").startswith(beginning))


def _attribute(path: Path, name: str) -> str:
    """A text of a NetCDF file that pindrive wrote; empty where there is none."""
    import h5py

    if not _head(path).startswith(b"\x89HDF\r\n\x1a\n"):
        return ""
    try:
        with h5py.File(path, "r") as file:
            of_pindrive = str(file.attrs.get("source", "")).startswith("pindrive ")
            return str(file.attrs.get(name, "")) if of_pindrive else ""
    except OSError:  # cut off
        return ""


def _tables(path: Path) -> dict[str, Any]:
    """What a TOML file holds; nothing where it is none."""
    from tomllib import loads

    try:
        return loads(path.read_text("utf-8-sig"))
    except (ValueError, RecursionError):
        return {}


def _is_device_file(path: Path) -> bool:
    from pindrive.config import STUDY_KEYS, TABLES

    tables = _tables(path)
    return not tables.keys().isdisjoint(TABLES) and tables.keys().isdisjoint(STUDY_KEYS)


def _is_study_file(path: Path) -> bool:
    from pindrive.config import STUDY_KEYS

    return not _tables(path).keys().isdisjoint(STUDY_KEYS)


PICTURES: Final = {
    ".png": _beginning("PNG picture", b"\x89PNG\r\n\x1a\n"),
    ".svg": Kind("SVG picture", lambda path: b"<svg" in _head(path)),
    ".pdf": _beginning("PDF file", b"%PDF-"),
}
"""By the ending of a name."""
FILMS: Final = {
    ".gif": _beginning("GIF film", b"GIF87a", b"GIF89a"),
    ".mp4": Kind("MP4 film", lambda path: _head(path)[4:8] == b"ftyp"),
}
MOTION_CSV: Final = _beginning("CSV file of a motion", b"time_s,position_m,")
MOTION_JSON: Final = _beginning("JSON file of a motion", b'{\n  "pindrive": ')
MOTION_NETCDF: Final = _titled("NetCDF file of a motion", "Motion of ")
LINES_CSV: Final = _beginning("CSV file of lines", b"pin,fate,")
SCAN_NETCDF: Final = _titled("NetCDF file of a scan", "Scan of ")
STUDY_NETCDF: Final = Kind(
    "NetCDF file of a study", lambda path: _attribute(path, "identity") != "", "--restart"
)
DEVICE_FILE: Final = Kind("device file", _is_device_file, "--force")
STUDY_FILE: Final = Kind("study file", _is_study_file, "--force")
REPORT: Final = Kind("report of the paper", lambda path: b"Dynamics of tactile" in _head(path))

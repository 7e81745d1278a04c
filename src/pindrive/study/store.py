"""The NetCDF file of a study: laid out whole at once, then filled piece by piece at fixed places.

HDF5 stores a contiguous array as one run of bytes. Therefore the structure of the file is written
first, for all points, and closed; the numbers of a chunk are then plain bytes at known offsets. A
process that dies leaves the structure as it was, chunks may come in any order, and nothing is
copied when the last one is there.

The journal beside it says which chunks are done, a line for each with a checksum of its bytes. A
line is written when its chunk is. An entry that is cut off, or whose bytes are not in the file
after a power failure, is ignored: its chunk is computed again.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from pindrive.device.coil import BY_SHEET, COIL
from pindrive.device.electromagnet import DIRECT
from pindrive.files.keys import NUMERIC_KEYS, variable
from pindrive.files.output import OutputError, naming
from pindrive.lazy import h5netcdf, h5py
from pindrive.study import outputs

if TYPE_CHECKING:
    from pindrive.study.study import Study


class Piece(NamedTuple):
    """A run of values of one variable."""

    name: str
    start: int
    """Place of the first value in the variable's flat order."""
    values: NDArray[Any]


def extents(study: Study, chunk: int) -> list[tuple[str, int, int]]:
    """Name, start and length of the pieces of a chunk, in their order."""
    begin, end = study.bounds(chunk)
    coordinates = [
        (variable(key), first, last - first)
        for dimension, first, last in study.first_seen(chunk)
        for key in dimension.axes
    ]
    return [*coordinates, *((name, begin, end - begin) for name in study.outputs)]


def checksum(pieces: list[Piece]) -> int:
    """One number for the bytes of a chunk."""
    found = 0
    for piece in pieces:
        found = crc32(piece.values.data.cast("B"), found)
    return found


class Store:
    """An open file of a study, to put pieces in and to read them back."""

    def __init__(self, path: Path, study: Study) -> None:
        """Open a file that `lay_out` made."""
        self._path, self._lock = path, Lock()
        names = {variable(key) for d in study.dimensions for key in d.axes} | {*study.outputs}
        try:
            with h5py.File(path, "r") as file:
                found = {name: (file[name].id.get_offset(), file[name].dtype) for name in names}
        except (OSError, KeyError) as error:
            reason = str(error).strip("'").replace("\n", " ")
            raise OutputError(f"{path}: is damaged: {reason}; `force=True` begins anew") from None
        self._places = found
        with naming(path):
            self._file = path.open("r+b", buffering=0)

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def put(self, pieces: list[Piece]) -> None:
        """Write the pieces of a chunk.

        Raises:
            OSError: The disk is full or fails.
        """
        for name, start, values in pieces:
            offset, kind = self._places[name]
            bytes_left = values.data.cast("B")
            with self._lock:
                self._file.seek(offset + start * kind.itemsize)
                while bytes_left:
                    bytes_left = bytes_left[self._file.write(bytes_left) :]

    def read(self, study: Study, chunk: int) -> list[Piece]:
        """The pieces of a chunk as they stand in the file."""
        found = []
        for name, start, length in extents(study, chunk):
            offset, kind = self._places[name]
            with self._lock:
                self._file.seek(offset + start * kind.itemsize)
                content = self._file.read(length * kind.itemsize)
            found.append(Piece(name, start, np.frombuffer(content, kind)))
        return found

    def sync(self) -> None:
        """Return when all is on the disk."""
        os.fsync(self._file.fileno())


def bytes_of(study: Study) -> int:
    """The size of the file without its structure."""
    each = sum(outputs.dtype(name).itemsize for name in study.outputs)
    return study.size * each + sum(8 * d.size * len(d.axes) for d in study.dimensions)


# ---- the structure -------------------------------------------------------------------------------


def lay_out(path: Path, study: Study) -> None:
    """Write the file's structure: dimensions, coordinates, variables, units, the study itself."""
    from pindrive import __version__

    links = "\n".join(link.words(key) for key, link in study.links.items())
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {dimension.name: dimension.size for dimension in study.dimensions}
        for dimension in study.dimensions:
            for key, axis in dimension.axes.items():
                made = _variable(file, variable(key), (dimension.name,), "<f8")
                made.attrs.update(NUMERIC_KEYS[key].attributes, key=key)
                if getattr(axis, "log", False):
                    made.attrs["spacing"] = "log"
        for key, value in _fixed(study).items():
            made = file.create_variable(variable(key), (), "<f8", data=value)
            made.attrs.update(NUMERIC_KEYS[key].attributes, key=key)
        names = tuple(dimension.name for dimension in study.dimensions)
        for name in study.outputs:
            made = _variable(file, name, names, outputs.dtype(name), outputs.missing(name))
            made.attrs.update(outputs.attributes(name))
            beside = [
                variable(key) for key in (*study.axes, *_fixed(study)) if key not in study.links
            ]
            made.attrs["coordinates"] = " ".join(v for v in beside if v not in names)
        file.attrs.update(
            {
                "Conventions": "CF-1.11",
                "title": study.name or "A study of a pin drive",
                "source": f"pindrive {__version__}",
                "study": study.source.text,
                **({"page": study.page.page.words} if study.page else {}),
                **({"links": links} if links else {}),
                "specification": outputs.as_attribute(study.constraints),
                "identity": identity(study),
            }
        )


def _fixed(study: Study) -> dict[str, float]:
    """The values of the device that no axis changes."""
    swept = {*study.axes}
    if swept & {"drive.damping", "drive.damping_ratio"}:
        swept |= {"drive.damping", "drive.damping_ratio"}
    if any(key == f"magnet.{name}" for key in swept for name in (*COIL, *BY_SHEET)):
        swept |= {f"magnet.{name}" for name in DIRECT}
    return {
        key: value
        for key, value in study.values.items()
        if isinstance(value, float) and key not in swept
    }


def identity(study: Study) -> str:
    """Return the text on which the study's numbers depend."""
    return json.dumps(study.identity(), sort_keys=True)


def _variable(
    file: Any, name: str, dims: tuple[str, ...], kind: Any, missing: int | None = None
) -> Any:
    """A contiguous variable whose place in the file is fixed, and whose bytes come later."""
    fill = None if missing is None else np.dtype(kind).type(missing)
    made = file.create_variable(name, dims, kind, fillvalue=fill, fill_time="never")
    made[(slice(0, 1),) * len(dims)] = 0  # the first write fixes the place
    return made


class Tally(NamedTuple):
    """Number of points of a chunk by their status."""

    points: int
    refused: int
    """With a status other than 0."""
    settled: int
    """-1 where the settling time is not among the outputs."""


class Journal:
    """The open journal of a study: held by one process at a time."""

    def __init__(self, path: Path, identity: dict[str, Any], force: bool = False) -> None:
        """Open it, or begin it; what it holds is thrown away where `force`.

        Raises:
            OutputError: The file is that of another study, another process holds it, or it cannot
                be written.
        """
        self._path = path
        with naming(path):
            self._file = path.open("a+b", buffering=0)
        try:
            self._hold()
            if force:
                self._file.truncate(0)
            self.done = self._read(identity)
        except BaseException as error:
            self._file.close()
            ours = not isinstance(
                error, OutputError
            )  # otherwise another process may have just begun
            if ours and not path.stat().st_size:
                path.unlink()
            raise

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def note(self, chunk: int, checksum: int, tally: Tally) -> None:
        """A chunk's numbers are in the file."""
        self._write([chunk, checksum, *tally])
        self.done[chunk] = (checksum, tally)

    def _write(self, entry: object) -> None:
        line = json.dumps(entry).encode() + b"\n"
        if self._file.write(line) != len(line):
            raise OSError(28, "No space left on device")

    def _read(self, identity: dict[str, Any]) -> dict[int, tuple[int, Tally]]:
        self._file.seek(0)
        content = self._file.read()
        *lines, cut = content.split(b"\n")
        if not lines:
            self._file.truncate(0)
            self._write(identity)
            return {}
        self._file.truncate(len(content) - len(cut))
        try:
            begun = json.loads(lines[0])
            entries = [json.loads(line) for line in lines[1:]]
            done = {chunk: (checksum, Tally(*tally)) for chunk, checksum, *tally in entries}
        except (ValueError, TypeError):
            raise OutputError(f"{self._path}: is no journal of a study") from None
        if begun != identity:
            what = difference(begun, identity)
            raise OutputError(
                f"{self._path}: another study was begun there: {what}; `force=True` begins anew"
            )
        return done

    def _hold(self) -> None:
        try:
            import fcntl
        except ImportError:  # Windows lets only one process truncate it anyway
            return
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise OutputError(f"{self._path}: another process is at this study") from None


def difference(one: Any, other: Any, where: str = "") -> str:
    """Return the first difference of two identities: "device drive.mass was 0.01, is 0.02"."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in [*one, *(key for key in other if key not in one)]:
            if one.get(key) != other.get(key):
                return difference(one.get(key), other.get(key), f"{where} {key}".strip())
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for i, (a, b) in enumerate(zip(one, other, strict=True)):
            if a != b:
                return difference(a, b, f"{where}[{i}]")
    shown = (json.dumps(value)[:80] for value in (one, other))
    return "{} was {}, is {}".format(where or "the study", *shown)

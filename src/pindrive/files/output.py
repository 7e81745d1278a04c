"""Files that are written whole or not at all, and replace files of their own kind only; the kinds.

Files are written beside their target and renamed when complete. A file that is there is replaced
only if it is of the kind that is written, or on request, and never if the command reads it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from secrets import token_hex
from typing import Any, Final

from pindrive.files.keys import STUDY_KEYS, TABLES
from pindrive.lazy import h5py, require
from pindrive.quantities.results import MOTION

_HEAD = 4096
"""Bytes in which a file says what it is."""
_ALWAYS: Final = tuple(quantity.heading for quantity in MOTION[:6])
"""The first columns of any motion, with both friction forces, which no recording of a bench has."""
EVENT_HEADINGS: Final = (_ALWAYS[0], "contact", "kind", *_ALWAYS[1:3])
"""The columns of a file of events."""


class OutputError(ValueError):
    """A file that cannot be written; says which and why."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of file: what it is called, and whether a file is one."""

    name: str
    holds: Callable[[Path], bool]
    costly: bool = False
    """True for files that took long to compute; only `force=True` replaces them."""
    library: str = ""
    """That of the extra "complete" which writes one."""


@dataclass(frozen=True, slots=True)
class Output:
    """A file that a command is asked to write."""

    path: Path
    kind: Kind
    option: str = ""
    """Name of the option for messages."""

    def __str__(self) -> str:
        """As it was named."""
        return f"{self.option} {self.path}".lstrip()


def check_outputs(
    outputs: Sequence[Output], inputs: Iterable[Path] = (), *, force: bool = False
) -> None:
    """Refuse to write over what is needed.

    Args:
        outputs: Files to write.
        inputs: Files that the command reads; compared as files, through links of any sort.
        force: True to replace files of another kind, or files that took long to compute.

    Raises:
        OutputError: Two outputs are one file, an output is an input, a file is there that may not
            be replaced, or the library that writes it is not installed.
    """
    read = [*inputs]
    for i, output in enumerate(outputs):
        if output.kind.library:
            try:
                require(output.kind.library)
            except ModuleNotFoundError as error:
                raise OutputError(f"{output}: {error}") from None
        if any(_are_one(output.path, other.path) for other in outputs[:i]):
            raise OutputError(f"{output}: is named twice; give each file a name of its own")
        check_unread(output.path, read, str(output))
        with naming(output.path):
            if force or not output.path.is_file() or not output.path.stat().st_size:
                continue
        try:
            alike = output.kind.holds(output.path)
        except OSError as error:
            raise OutputError(f"{output}: exists, and cannot be read: {error.strerror}") from None
        if not alike:
            raise OutputError(
                f"{output}: exists and is no {output.kind.name}; give another name, or `force=True`"
            )
        if output.kind.costly:
            raise OutputError(f"{output}: exists already; `force=True` replaces it")


def check_unread(path: Path, inputs: Iterable[Path], label: str = "") -> None:
    """Refuse to write to a file that is read."""
    if any(_are_one(path, other) for other in inputs):
        raise OutputError(f"{label or path}: is read by this command; give another name")


def _are_one(one: Path, other: Path) -> bool:
    try:
        return os.path.samefile(one, other)
    except (OSError, ValueError):  # a file does not exist
        return os.path.realpath(one) == os.path.realpath(other)


@contextmanager
def writing(
    outputs: Sequence[Output], inputs: Iterable[Path] = (), *, force: bool = False
) -> Iterator[dict[Path, Path]]:
    """For the path of each output a path to write to, as `atomic_write` gives it.

    Arguments and errors as for `check_outputs` and `atomic_write`.
    """
    check_outputs(outputs, inputs, force=force)
    with ExitStack() as stack:
        yield {output.path: stack.enter_context(atomic_write(output.path)) for output in outputs}


@contextmanager
def atomic_write(target: str | os.PathLike[str]) -> Iterator[Path]:
    """A path beside `target` to write to; it takes the target's place when the block ends well.

    Entering creates the file, so that a target that cannot be written is refused at once. After an
    exception in the block nothing is left behind and an older file at `target` is as it was.

    Raises:
        OutputError: The target is no regular file, or cannot be created or replaced.
    """
    path = Path(os.path.realpath(target))  # a link stays, what it points to is replaced
    part = path.with_name(f".{path.name[:200]}.{token_hex(4)}.part")
    try:
        with naming(target):
            if path.exists() and not path.is_file():
                raise OSError("not a regular file")
            if path.exists() and not os.access(path, os.W_OK):
                raise PermissionError("it is read-only")
            part.touch(exist_ok=False)
        yield part
        with naming(target):
            os.replace(part, path)
    finally:
        with suppress(FileNotFoundError, NotADirectoryError):
            part.unlink()


def _like(name: str, content: bytes) -> Kind:
    """Files that begin as this one does."""

    def beginning(content: bytes) -> tuple[bytes, list[bytes]]:
        return content.partition(b"\n")[0], re.findall(rb"<title>.*?</title>", content)

    head = beginning(content[:_HEAD])

    def holds(path: Path) -> bool:
        with path.open("rb") as file:
            return beginning(file.read(_HEAD)) == head

    return Kind(f"{Path(name).name} of an earlier run", holds)


@contextmanager
def naming(target: str | os.PathLike[str]) -> Iterator[None]:
    """Turn what the system refuses in the block into an `OutputError` that names `target`."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(f"{os.fspath(target)}: cannot be written: {reason}") from error


def check_folder(folder: str | os.PathLike[str]) -> None:
    """Refuse at once what `write_files` would refuse of a folder; nothing is made.

    Raises:
        OutputError: The file or its folder is not a folder or cannot be written.
    """
    path = Path(os.path.realpath(folder))
    while not path.exists():
        path = path.parent
    with naming(folder):
        if not path.is_dir():
            raise NotADirectoryError(f"{path.name} is not a folder")
        if not os.access(path, os.W_OK | os.X_OK):
            raise PermissionError(f"{path} is read-only")


def write_files(
    folder: str | os.PathLike[str], files: Mapping[str, bytes], *, force: bool = False
) -> None:
    """Write files into a folder that need not be there: all, or none.

    Args:
        folder: Folder of the files; other files in it are kept.
        files: Content of each file by its path in the folder. An existing file is replaced if it
            begins with the same line and has the same title.
        force: True to replace any other existing file.

    Raises:
        OutputError: A file or a folder cannot be written, or would replace something else.
    """
    top, made = Path(folder), []
    outputs = [Output(top / name, _like(name, content)) for name, content in files.items()]
    check_outputs(outputs, force=force)
    try:
        with ExitStack() as stack:
            for name, content in files.items():
                target = top / name
                for place in reversed([p for p in target.parents if not p.exists()]):
                    with naming(place):
                        place.mkdir()
                    made.append(place)
                part = stack.enter_context(atomic_write(target))
                with naming(target):
                    part.write_bytes(content)
    except BaseException:
        for place in reversed(made):
            with suppress(OSError):  # a file that was written meanwhile stays
                place.rmdir()
        raise


def _beginning(name: str, *beginnings: bytes, library: str = "") -> Kind:
    """A kind whose files begin so."""
    return Kind(name, lambda path: _head(path).startswith(beginnings), library=library)


def headed(name: str, headings: Sequence[str]) -> Kind:
    """A CSV whose first columns are headed so."""
    return _beginning(name, ",".join(headings).encode())


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(_HEAD)


def titled(name: str, beginning: str) -> Kind:
    """A NetCDF file of pindrive by the beginning of its title."""
    return Kind(
        name, lambda path: _attribute(path, "title").startswith(beginning), library="h5netcdf"
    )


def _attribute(path: Path, name: str) -> str:
    """A text of a NetCDF file that pindrive wrote; empty where there is none."""
    if not _head(path).startswith(b"\x89HDF\r\n\x1a\n"):
        return ""
    try:
        with h5py.File(path, "r") as file:
            of_pindrive = str(file.attrs.get("source", "")).startswith("pindrive ")
            return str(file.attrs.get(name, "")) if of_pindrive else ""
    except OSError:  # cut off
        return ""


def _tables(path: Path) -> dict[str, Any]:
    """Return the tables of a TOML file; nothing for other files."""
    from tomllib import loads

    try:
        return loads(path.read_text("utf-8-sig"))
    except (ValueError, RecursionError):
        return {}


def _is_device_file(path: Path) -> bool:
    tables = _tables(path)
    return not tables.keys().isdisjoint(TABLES) and tables.keys().isdisjoint(STUDY_KEYS)


def _is_study_file(path: Path) -> bool:
    return not _tables(path).keys().isdisjoint(STUDY_KEYS)


PICTURES: Final = {
    ".png": _beginning("PNG picture", b"\x89PNG\r\n\x1a\n", library="matplotlib"),
    ".svg": Kind("SVG picture", lambda path: b"<svg" in _head(path), library="matplotlib"),
    ".pdf": _beginning("PDF file", b"%PDF-", library="matplotlib"),
}
"""By the ending of a name."""
FILMS: Final = {
    ".gif": _beginning("GIF film", b"GIF87a", b"GIF89a", library="matplotlib"),
    ".mp4": Kind("MP4 film", lambda path: _head(path)[4:8] == b"ftyp", library="matplotlib"),
}
MOTION_CSV: Final = headed("CSV file of a motion", _ALWAYS)
EVENTS_CSV: Final = headed("CSV file of the events of a motion", EVENT_HEADINGS)
SCAN_CSV: Final = headed("CSV file of a scan", ("pin", *_ALWAYS))
SCAN_EVENTS_CSV: Final = headed("CSV file of the events of a scan", ("pin", *EVENT_HEADINGS))
JSON: Final = _beginning("JSON file of pindrive", b'{\n  "pindrive": ')
MOTION_NETCDF: Final = titled("NetCDF file of a motion", "Motion of ")
LINES_CSV: Final = headed("CSV file of lines", ("pin", "fate", "cue_on"))
SCAN_NETCDF: Final = titled("NetCDF file of a scan", "Scan of ")
FMU: Final = Kind("FMU", lambda path: b"modelDescription.xml" in _head(path))
STUDY_NETCDF: Final = Kind(
    "NetCDF file of a study",
    lambda path: _attribute(path, "identity") != "",
    costly=True,
    library="h5netcdf",
)
DEVICE_FILE: Final = Kind("device file", _is_device_file, costly=True)
STUDY_FILE: Final = Kind("study file", _is_study_file, costly=True)
PROBLEM_FILE: Final = Kind("problem file", lambda path: "goals" in _tables(path), costly=True)
REPORT: Final = Kind("report of the paper", lambda path: b"Dynamics of tactile" in _head(path))

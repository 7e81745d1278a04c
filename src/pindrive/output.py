"""Files that are whole or not there: written beside their target, renamed when complete."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from secrets import token_hex


class OutputError(ValueError):
    """A file that cannot be written; says which and why."""


@contextmanager
def atomic_write(target: str | os.PathLike[str]) -> Iterator[Path]:
    """A path beside `target` to write to; it takes the target's place when the block ends well.

    Entering creates the file, so that a target that cannot be written is refused at once. After an
    exception in the block nothing is left behind and an older file at `target` is as it was.

    Raises:
        OutputError: the target is no regular file, or cannot be created or replaced.
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
        OutputError: it, or what it would be made in, is no folder or cannot be written.
    """
    path = Path(os.path.realpath(folder))
    while not path.exists():
        path = path.parent
    with naming(folder):
        if not path.is_dir():
            raise NotADirectoryError(f"{path.name} is no folder")
        if not os.access(path, os.W_OK | os.X_OK):
            raise PermissionError(f"{path} is read-only")


def write_files(folder: str | os.PathLike[str], files: Mapping[str, bytes]) -> None:
    """Write files into a folder that need not be there: all, or none.

    Args:
        folder: where; other files in it stay as they are.
        files: what, by the path in the folder.

    Raises:
        OutputError: a file or a folder cannot be written.
    """
    top, made = Path(folder), []
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
            with suppress(OSError):  # where something was written meanwhile, it stays
                place.rmdir()
        raise

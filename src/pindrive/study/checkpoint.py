"""Which chunks of an unfinished study are done: a line for each, with a checksum of its bytes.

A line is written when its chunk is. One that is cut off, or whose bytes are not in the file after a
power failure, is ignored: its chunk is computed again.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

from pindrive.files.output import OutputError, naming

if TYPE_CHECKING:
    from pathlib import Path


class Tally(NamedTuple):
    """The numbers of points of a chunk, by what became of them."""

    points: int
    refused: int
    """With a status other than 0."""
    settled: int
    """-1 where the settling time is not among the outputs."""


class Journal:
    """The open journal of a study: held by one process at a time."""

    def __init__(self, path: Path, identity: dict[str, Any], restart: bool = False) -> None:
        """Open it, or begin it; what it holds is thrown away where `restart`.

        Raises:
            OutputError: it is another study's, another process holds it, or it cannot be written.
        """
        self._path = path
        with naming(path):
            self._file = path.open("a+b", buffering=0)
        try:
            self._hold()
            if restart:
                self._file.truncate(0)
            self.done = self._read(identity)
        except BaseException:
            self._file.close()
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
                f"{self._path}: another study was begun there: {what}; --restart begins anew"
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
    """Where two identities first differ, and how: "device drive.mass was 0.01, is 0.02"."""
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

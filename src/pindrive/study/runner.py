"""A study computed in chunks into one file; an interrupted run continues where it stopped."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from pindrive.device.pin_scan import Progress
from pindrive.files.keys import variable
from pindrive.files.output import (
    STUDY_NETCDF,
    Output,
    OutputError,
    check_outputs,
    check_unread,
    naming,
)
from pindrive.lazy import h5py, mpl_figure, xr
from pindrive.quantities.budgets import worker_count
from pindrive.quantities.quantity import counted
from pindrive.quantities.status import Status
from pindrive.study import outputs
from pindrive.study.evaluate import evaluate
from pindrive.study.store import (
    Journal,
    Piece,
    Store,
    Tally,
    bytes_of,
    checksum,
    difference,
    lay_out,
)
from pindrive.study.study import Study
from pindrive.study.workers import check_installed, cluster_executor
from pindrive.views import NotebookHtml, figure

Work = Callable[["Study", list[int]], Iterator[tuple[int, list[Piece]]]]
"""Computes chunks of a study, and yields each when it is done, in any order."""


@dataclass(frozen=True, slots=True, repr=False)
class Sweep(NotebookHtml):
    """Result of `sweep`, and its file."""

    path: Path
    points: int
    """Number of points in the file."""
    worked_out: int
    """Number of points computed in this run."""
    refused: int
    settled: int
    """-1 where the settling time is not among the outputs."""
    seconds: float
    complete: bool

    def __repr__(self) -> str:
        """Return the number of points in the file in a line."""
        points = counted(self.points, "point")
        refused = f", {self.refused} without numbers" if self.refused else ""
        return f"<Sweep {self.path.name} of {points}{refused}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where points are still to be computed, or cannot exist."""
        return Status.ok if self.complete and not self.refused else Status.incomplete

    def plot(self) -> mpl_figure.Figure:
        """The settling time, or the part of lines shown, over the first two keys that vary.

        Raises:
            ValueError: The sweep is not complete, or holds a single point.
        """
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """The points, as `Study.run` gives them; read from the file when they are needed."""
        return xr.open_dataset(self.path, engine="h5netcdf")


def sweep(
    study: Study,
    target: Path,
    *,
    resume: bool = False,
    force: bool = False,
    stop_after: int | None = None,
    work: Work | None = None,
    progress: Progress = lambda done, total: None,
) -> Sweep:
    """Compute all points of a study and write them into the NetCDF file `target`.

    Until it is whole the file is called TARGET.partial, with TARGET.journal beside it.

    Args:
        study: The study.
        target: A NetCDF file.
        resume: Continue an interrupted run, if there is one.
        force: Discard an interrupted run; an earlier study at `target` is replaced
            when the new one is whole.
        stop_after: Stop when at least so many points are done; `resume` continues.
        work: Computation of the chunks; None: on all cores.
        progress: Function called after each chunk with the points done and the points in all.

    Raises:
        OutputError: An interrupted run or an earlier study is there and neither `resume` nor
            `force` is given, it is of another study, another file is there, or the disk is full
            or cannot be written. Finished chunks are kept.
    """
    started = perf_counter()
    if target.exists() and not target.is_file():
        raise OutputError(f"{target}: cannot be written: not a regular file")
    part, notes = (target.with_name(f"{target.name}.{end}") for end in ("partial", "journal"))
    kind = replace(STUDY_NETCDF, costly=not resume)
    check_outputs([Output(target, kind)], study.inputs, force=force)
    for path in (part, notes):
        check_unread(path, study.inputs)
    if resume and not notes.exists() and _is_complete(target, study):
        return Sweep(target, study.size, 0, *_counted(target, study), 0.0, True)
    _check_target(target, notes, resume or force)
    with _journal(notes, part, study, force) as journal:
        if not (journal.done and part.exists()):
            journal.done.clear()
            _begin(part, study, target)
        with Store(part, study) as store, _keeping(part, journal):
            _drop_damaged(journal, store, study)
            done = before = sum(tally.points for _, tally in journal.done.values())
            progress(done, study.size)
            todo = [chunk for chunk in range(study.chunks) if chunk not in journal.done]
            if stop_after is not None:
                todo = todo[: max(0, -(-(stop_after - done) // study.chunk))]
            for chunk, pieces in (work or on_threads())(study, todo):
                store.put(pieces)
                tally = _tally(pieces)
                journal.note(chunk, checksum(pieces), tally)
                done += tally.points
                progress(done, study.size)
            complete = done == study.size
            if complete:
                store.sync()
        tallies = [tally for _, tally in journal.done.values()]
        if complete:
            with naming(target):
                os.replace(part, target)
    if complete:
        notes.unlink(missing_ok=True)
    refused, settled = (sum(column) for column in list(zip(*tallies, strict=True))[1:] or ((), ()))
    return Sweep(
        target if complete else part,
        done,
        done - before,
        refused,
        settled if settled >= 0 else -1,
        perf_counter() - started,
        complete,
    )


def on_threads(threads: int | None = None) -> Work:
    """Compute chunks in parallel on the cores of this machine, one per thread at a time."""
    count = worker_count(threads)

    def work(study: Study, chunks: list[int]) -> Iterator[tuple[int, list[Piece]]]:
        pool = ThreadPoolExecutor(min(count, len(chunks) or 1))
        try:
            yield from in_flight(chunks, count + 1, lambda k: pool.submit(work_out, study, k))
        finally:
            pool.shutdown(wait=False, cancel_futures=True)

    return work


def work_out(study: Study, chunk: int) -> list[Piece]:
    """The numbers of a chunk's points, and of each coordinate the part that appears there first."""
    begin, end = study.bounds(chunk)
    coordinates = [
        Piece(variable(key), first, np.ascontiguousarray(values, "<f8"))
        for dimension, first, last in study.first_seen(chunk)
        for key, values in dimension.at(np.arange(first, last)).items()
    ]
    table = evaluate(study, study.columns(begin, end), end - begin, study.outputs)
    numbers = [Piece(name, begin, outputs.encoded(name, table[name])) for name in study.outputs]
    return [*coordinates, *numbers]


def in_flight(
    chunks: Iterable[int], most: int, submit: Callable[[int], Future[list[Piece]]]
) -> Iterator[tuple[int, list[Piece]]]:
    """The chunks as they get done, never more than `most` begun and not handed over."""
    waiting = iter(chunks)
    begun: dict[Future[list[Piece]], int] = {}
    while True:
        for chunk in waiting:
            begun[submit(chunk)] = chunk
            if len(begun) >= most:
                break
        if not begun:
            return
        ready, _ = wait(begun, return_when=FIRST_COMPLETED)
        for future in ready:
            chunk = begun.pop(future)
            yield chunk, future.result()


# ---- beginning and going on ----------------------------------------------------------------------


def _check_target(target: Path, notes: Path, may_be_there: bool) -> None:
    if not target.parent.is_dir():
        raise OutputError(f"{target}: cannot be written: there is no folder {target.parent}")
    if notes.exists() and not may_be_there:
        raise OutputError(
            f"{notes}: an unfinished run is there; "
            "`resume=True` continues it, `force=True` begins anew"
        )


@contextmanager
def _journal(notes: Path, part: Path, study: Study, force: bool) -> Iterator[Journal]:
    """The study's journal; where it ends without a finished chunk nothing is left behind."""
    empty = False
    try:
        with Journal(notes, study.identity(), force) as journal:
            try:
                yield journal
            finally:
                empty = not journal.done
    finally:
        if empty:
            for path in (part, notes):
                path.unlink(missing_ok=True)


def _begin(part: Path, study: Study, target: Path) -> None:
    """Lay the file out, where there is room for it."""
    needed, free = bytes_of(study), shutil.disk_usage(target.parent).free
    if needed > free:
        raise OutputError(
            f"{target}: needs {human_bytes(needed)}, and the disk has {human_bytes(free)}; "
            "take fewer points, or fewer outputs"
        )
    with naming(part):
        part.unlink(missing_ok=True)
        lay_out(part, study)


@contextmanager
def _keeping(part: Path, journal: Journal) -> Iterator[None]:
    """Says of a disk that fails which chunks are kept."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise OutputError(
            f"{part}: cannot be written: {reason}; {_kept(len(journal.done))}"
        ) from error


def _kept(chunks: int) -> str:
    """Result of an interrupted run."""
    if not chunks:
        return "no chunk was finished yet"
    finished = counted(chunks, "finished chunk is", "finished chunks are")
    return f"{finished} kept, `resume=True` continues with {'it' if chunks == 1 else 'them'}"


def _drop_damaged(journal: Journal, store: Store, study: Study) -> None:
    """Discard chunks whose bytes differ from the written ones."""
    for chunk, (noted, _) in list(journal.done.items()):
        if not 0 <= chunk < study.chunks or checksum(store.read(study, chunk)) != noted:
            del journal.done[chunk]


def _is_complete(target: Path, study: Study) -> bool:
    """Return True if the file holds the whole study; reject the file of another study."""
    if not target.is_file():
        return False
    try:
        with h5py.File(target, "r") as file:
            found: Any = file.attrs.get("identity")
        written = json.loads(found)
    except (OSError, ValueError, TypeError):
        raise OutputError(f"{target}: is damaged; `force=True` replaces it") from None
    if written != study.identity():
        what = difference(written, study.identity())
        raise OutputError(f"{target}: holds another study: {what}; `force=True` replaces it")
    return True


def _counted(target: Path, study: Study) -> tuple[int, int]:
    """Refused and settled points of a finished file."""
    with Store(target, study) as store:
        tallies = [_tally(store.read(study, k)) for k in range(study.chunks)]
    settled = sum(tally.settled for tally in tallies)
    return sum(tally.refused for tally in tallies), settled if settled >= 0 else -1


def _tally(pieces: list[Piece]) -> Tally:
    values = {piece.name: piece.values for piece in pieces}
    time = values.get("transient_settling_time")
    settled = -1 if time is None else int(np.count_nonzero(~np.isnan(time)))
    status = values["status"]
    return Tally(len(status), int(np.count_nonzero(status)), settled)


def human_bytes(number: int) -> str:
    """Bytes for a person: "2.4 GB"."""
    value = float(number)
    for unit in ("bytes", "kB", "MB", "GB"):
        if value < 1000.0:
            return f"{value:.3g} {unit}"
        value /= 1000.0
    return f"{value:.3g} TB"


def on_cluster(address: str) -> Work:
    """Chunks on the workers of a Dask scheduler, such as tcp://10.0.0.1:8786.

    A worker that dies loses what it was at, and the scheduler gives it to another. The workers need
    the same version of pindrive.

    Raises:
        ValueError: Dask's distributed is not installed, or nothing answers at the address.
    """
    check_installed()

    def work(study: Study, chunks: list[int]) -> Iterator[tuple[int, list[Piece]]]:
        kept = "finished chunks are kept, `resume=True` continues with them"
        with cluster_executor(address, kept) as (executor, threads):
            yield from in_flight(chunks, 2 * threads, lambda k: executor.submit(work_out, study, k))

    return work

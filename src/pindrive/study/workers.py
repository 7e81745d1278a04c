"""Workers of a study: threads of this process, or a Dask cluster."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from time import monotonic, sleep
from typing import Any, Final, TypeVar

from pindrive.files.output import OutputError
from pindrive.quantities.refusal import refusal

Shared = TypeVar("Shared")
Given = TypeVar("Given")
Done = TypeVar("Done")


def spread(
    work: Callable[[Shared, Given], Done], shared: Shared, portions: Sequence[Given], threads: int
) -> list[Done]:
    """Compute each portion on threads, in order; `shared` is passed to all portions."""
    if threads == 1 or len(portions) < 2:
        return [work(shared, portion) for portion in portions]
    pool = ThreadPoolExecutor(min(threads, len(portions)))
    try:
        return list(pool.map(partial(work, shared), portions))
    finally:  # after an error or Ctrl-C no further portion begins
        pool.shutdown(wait=False, cancel_futures=True)


# ---- a Dask scheduler ----------------------------------------------------------------------------


_PATIENCE: Final = 20.0
"""Longest wait for a scheduler to write its file, and to respond, s."""


class Here:
    """Worker that computes parts in sequence, in this thread."""

    def spread(
        self,
        work: Callable[[Shared, Given], Done],
        shared: Shared,
        portions: Sequence[Given],
    ) -> Iterator[Done]:
        """The work of each portion, in their order."""
        return (work(shared, portion) for portion in portions)


class Cluster:
    """Parts on the workers of a Dask scheduler."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor

    def spread(
        self,
        work: Callable[[Shared, Given], Done],
        shared: Shared,
        portions: Sequence[Given],
    ) -> Iterator[Done]:
        """The work of each portion, in their order."""
        begun = [self._executor.submit(work, shared, portion) for portion in portions]
        return (future.result() for future in begun)


@contextmanager
def crew(address: str | None) -> Iterator[Here | Cluster]:
    """Return the workers of independent parts: a scheduler, else this thread.

    Raises:
        ValueError: The address is invalid, as for `cluster_executor`.
    """
    if address is None:
        yield Here()
        return
    check_installed()
    with cluster_executor(address, "nothing was written") as (executor, _):
        yield Cluster(executor)


def check_installed() -> None:
    """Refuse where Dask's distributed is not installed."""
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise ValueError(
            "`cluster` needs Dask's distributed; pip install 'pindrive[cluster]'"
        ) from None


@contextmanager
def cluster_executor(address: str, kept: str) -> Iterator[tuple[Executor, int]]:
    """An executor on the workers of a scheduler, and how many threads they have, at least 1.

    Args:
        address: Address such as tcp://10.0.0.1:8786, or the file of the scheduler, which ends in
            .json.
        kept: Content that is kept if workers die one after the other, for the message.

    Raises:
        ValueError: No scheduler answers at the address, or a worker has another version.
    """
    from distributed import Client, KilledWorker

    try:
        place = _written(Path(address)) if address.endswith(".json") else address
        client = Client(place, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        required = "the address of a Dask scheduler, like tcp://10.0.0.1:8786, or its .json file"
        given = f"{address}: {str(error) or type(error).__name__}"
        raise ValueError(refusal("`cluster`", required, given)) from None
    with client, client.get_executor(pure=False) as executor:
        _check_versions(client.run(_version))
        try:
            yield executor, max(1, sum(client.nthreads().values()))
        except KilledWorker as error:
            raise OutputError(
                f"`cluster` {address}: workers died one after the other: {error}; {kept}"
            ) from None


def _written(file: Path) -> str:
    """The address in the file of a scheduler, which may have just begun.

    Raises:
        ValueError: The file does not exist, or holds no address, after `_PATIENCE`.
    """
    end = monotonic() + _PATIENCE
    while True:
        try:
            return str(json.loads(file.read_text("utf-8"))["address"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            if monotonic() > end:
                missing = isinstance(error, OSError)
                raise ValueError("cannot be read" if missing else "holds no address") from None
        sleep(0.05)


def _version() -> str:
    """The version that a worker has."""
    from pindrive import __version__

    return __version__


def _check_versions(of_workers: Mapping[str, Any]) -> None:
    """Refuse workers that would compute with another version."""
    for worker, version in of_workers.items():
        if version != _version():
            given = f"{version} on {worker}"
            raise ValueError(refusal("the workers' pindrive", f"version {_version()}", given))

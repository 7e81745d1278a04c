"""The chunks of a study worked out by the workers of a Dask cluster, and written here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pindrive.output import OutputError
from pindrive.quantities import refusal
from pindrive.study.store import Piece, work_out
from pindrive.study.sweeping import Work, in_flight

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from pindrive.study.plan import Plan

_PATIENCE = "20s"
"""How long a scheduler may take to answer."""


def on_cluster(address: str) -> Work:
    """Chunks on the workers of a Dask scheduler, such as tcp://10.0.0.1:8786.

    A worker that dies loses what it was at, and the scheduler gives it to another. The workers need
    the same version of pindrive.

    Raises:
        ValueError: Dask's distributed is not installed, or nothing answers at the address.
    """
    try:
        from distributed import Client, KilledWorker
    except ImportError:
        raise ValueError(
            "--cluster needs Dask's distributed; pip install 'pindrive[cluster]'"
        ) from None

    def work(plan: Plan, chunks: list[int]) -> Iterator[tuple[int, list[Piece]]]:
        try:
            client = Client(address, timeout=_PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            required = "the address of a Dask scheduler, like tcp://10.0.0.1:8786"
            given = f"{address}: {str(error) or type(error).__name__}"
            raise ValueError(refusal("--cluster", required, given)) from None
        with client, client.get_executor(pure=False) as executor:
            _check_versions(client.run(_version))
            most = 2 * max(1, sum(client.nthreads().values()))
            try:
                yield from in_flight(chunks, most, lambda k: executor.submit(work_out, plan, k))
            except KilledWorker as error:
                raise OutputError(
                    f"--cluster {address}: workers died one after the other: {error}; finished "
                    "chunks are kept, --resume goes on with them"
                ) from None

    return work


def _version() -> str:
    """The version that a worker has."""
    from pindrive import __version__

    return __version__


def _check_versions(of_workers: Mapping[str, str]) -> None:
    """Refuse workers that would compute with another version."""
    for worker, version in of_workers.items():
        if version != _version():
            given = f"{version} on {worker}"
            raise ValueError(refusal("the workers' pindrive", f"version {_version()}", given))

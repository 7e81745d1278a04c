"""The files that a command writes of its result: of which kind, by their suffix."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Generic, TypeVar

import typer

from pindrive.cli.help import FILES
from pindrive.cli.options import file_option, measure, option
from pindrive.files.output import PICTURES, Kind, Output, naming, writing

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

Result = TypeVar("Result")

PlotOption = Annotated[Path | None, file_option("Figure: .png, .svg or .pdf.", "--plot")]
ForceOption = Annotated[bool, option(FILES, "Replace existing files.", "--force")]


def output_option(help: str) -> Any:
    """The option that names the files to write; it may be given several times."""
    return file_option(help, "--output", "-o")


ResultOption = Annotated[list[Path] | None, output_option("Numbers: .csv, .nc or .json.")]


@dataclass(frozen=True, slots=True)
class Target(Generic[Result]):
    """A file that is to be written of a result."""

    output: Output
    write: Callable[[Result, Path], None]
    """Writes a result to a path."""


Writer = tuple[Kind, Callable[[Result, Path], None]]
"""A kind of file, and what writes one."""


def by_suffix(
    paths: Iterable[Path], writers: Mapping[str, Writer[Result]], option: str = "-o"
) -> list[Target[Result]]:
    """Return the files at `paths`, each by the suffix of its name.

    Raises:
        ValueError: A suffix asks for none.
    """
    targets = []
    for path in paths:
        suffix = path.suffix.lower()
        if suffix not in writers:
            raise ValueError(f"{option} {path}: must end in {', '.join(writers)}")
        kind, write = writers[suffix]
        targets.append(Target(Output(path, kind, option), write))
    return targets


def pictures(
    path: Path | None, draw: Callable[[Result], Figure], option: str = "--plot"
) -> list[Target[Result]]:
    """The picture at `path`, if one is wanted, in the format of its suffix.

    Raises:
        ValueError: The suffix asks for none.
    """

    def writer(suffix: str) -> Callable[[Result, Path], None]:
        def write(result: Result, part: Path) -> None:
            from pindrive.plot.style import save

            save(draw(result), part, suffix.removeprefix("."))

        return write

    writers = {suffix: (kind, writer(suffix)) for suffix, kind in PICTURES.items()}
    return by_suffix([path] if path else [], writers, option)


def dataset_writers(
    title: str, columns: Sequence[str], dataset: Callable[[Result], xr.Dataset]
) -> dict[str, Writer[Result]]:
    """Return the writers of a dataset by file suffix: NetCDF, JSON, and CSV of the main table.

    Args:
        title: Content of the files.
        columns: The first of the CSV.
        dataset: Makes the dataset of a result.
    """
    from pindrive.files import dataset as files

    def writer(write: Callable[[xr.Dataset, Path], None]) -> Callable[[Result, Path], None]:
        return lambda result, part: write(dataset(result), part)

    return {
        suffix: (kind, writer(write))
        for suffix, (kind, write) in files.writers(title, columns).items()
    }


def datasets(
    paths: Iterable[Path] | None,
    title: str,
    columns: Sequence[str],
    dataset: Callable[[Result], xr.Dataset],
) -> list[Target[Result]]:
    """Files of a result that is a dataset, arguments as for `dataset_writers`.

    Raises:
        ValueError: A suffix asks for no such file.
    """
    return by_suffix(paths or (), dataset_writers(title, columns, dataset))


def with_events(
    targets: Iterable[Target[Result]], kind: Kind, write: Callable[[Result, Path], None]
) -> list[Target[Result]]:
    """The targets, and beside each CSV that of the events."""
    from pindrive.files.export import events_path

    every = []
    for target in targets:
        every.append(target)
        path, option = target.output.path, target.output.option
        if path.suffix.lower() == ".csv":
            every.append(Target(Output(events_path(path), kind, option), write))
    return every


@contextmanager
def results(
    targets: Sequence[Target[Result]], inputs: Iterable[Path], *, force: bool
) -> Iterator[Callable[[Result], None]]:
    """Begin the files, and give what writes them all of a result.

    Raises:
        OutputError: A file cannot be written, is one of the inputs, or exists and may not be
            replaced.
    """
    with writing([target.output for target in targets], inputs, force=force) as parts:
        yield partial(_write, targets, parts)


def _write(targets: Sequence[Target[Result]], parts: Mapping[Path, Path], result: Result) -> None:
    for target in targets:
        with naming(target.output.path):
            target.write(result, parts[target.output.path])


def say_written(targets: Iterable[Target[Any]]) -> None:
    """Print which files were written."""
    for target in targets:
        typer.echo(f"Wrote {target.output.path}")


def csv_rate(rate: str | None, outputs: Iterable[Path]) -> float | None:
    """The frequency of a CSV's samples, Hz; None where none is given.

    Raises:
        ValueError: The value is no frequency, or no CSV is written.
    """
    if rate is None:
        return None
    if not any(path.suffix.lower() == ".csv" for path in outputs):
        raise ValueError("--rate goes with -o FILE.csv")
    return measure(rate, "rate", "1 kHz", "--rate")

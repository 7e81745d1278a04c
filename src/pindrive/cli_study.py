"""The commands of studies: many releases or scans of one device, each with other values."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from pindrive.refusing import INTERRUPTED, check_distinct, figure_format, refusing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from pindrive.study.influence import Influence
    from pindrive.study.plan import Plan
    from pindrive.study.robust import Robustness

    Tell = Callable[[int, int], None]

Found = TypeVar("Found")
StudyArgument = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (TOML).")]


def sweep(
    study: StudyArgument,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="NetCDF; STUDY.nc unless given."),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with a run cut short.")] = False,
    restart: Annotated[bool, typer.Option("--restart", help="Throw away a run cut short.")] = False,
    stop_after: Annotated[
        int | None,
        typer.Option(metavar="POINTS", min=1, help="Stop there; --resume goes on."),
    ] = None,
    threads: Annotated[
        int | None, typer.Option(metavar="COUNT", min=1, help="All cores unless given.")
    ] = None,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Work on a Dask cluster instead.")
    ] = None,
) -> None:
    """Work out all points of a study into one NetCDF file."""
    from pindrive.study.report import sweep_report
    from pindrive.study.studyfile import load_study
    from pindrive.study.sweeping import on_threads
    from pindrive.study.sweeping import sweep as work_off

    target = output or study.with_suffix(".nc")
    with refusing():
        if resume and restart:
            raise ValueError("give --resume or --restart, not both")
        if threads and cluster:
            raise ValueError("give --threads or --cluster, not both: workers have their own")
        plan = load_study(study)
        if not plan.dimensions:
            raise ValueError(f"{study}: has no axes; write what to vary in [axes]")
        check_distinct([*{study, plan.device.path}, target])
        if cluster:
            from pindrive.study.cluster import on_cluster

            work = on_cluster(cluster)
        else:
            work = on_threads(threads)
        try:
            with _bar() as tell:
                done = work_off(
                    plan,
                    target,
                    resume=resume,
                    restart=restart,
                    stop_after=stop_after,
                    work=work,
                    tell=tell,
                )
        except KeyboardInterrupt:
            kept = target.with_name(f"{target.name}.journal").exists()
            words = "finished chunks are kept, --resume goes on with them"
            typer.echo(f"stopped; {words if kept else 'no chunk was finished yet'}", err=True)
            raise typer.Exit(INTERRUPTED) from None
    for line in sweep_report(plan, done):
        typer.echo(line)


@contextmanager
def _bar() -> Iterator[Callable[[int, int], None]]:
    """A progress bar with points per second and time left, where somebody looks on."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.percentage:>3.0f} %"),
        BarColumn(),
        TextColumn("{task.fields[speed]}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None, speed="")

        def tell(done: int, total: int) -> None:
            speed = bar.tasks[task].speed
            digits = 0 if speed and speed >= 10.0 else 1
            shown = f"{speed:,.{digits}f} points/s".replace(",", " ") if speed else ""
            bar.update(task, completed=done, total=total, speed=shown)

        yield tell


def map_study(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="What a sweep wrote (NetCDF).")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FIGURE", help=".png, .svg or .pdf.")
    ],
    x: Annotated[str | None, typer.Option("--x", metavar="KEY", help="Along the abscissa.")] = None,
    y: Annotated[
        str | None, typer.Option("--y", metavar="KEY", help="Along the ordinate; curves if none.")
    ] = None,
    number: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="What to draw; settling_time or shown_part if none."),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option("--at", metavar="KEY=VALUE", help="A slice at the nearest value."),
    ] = None,
) -> None:
    """Draw a study: maps over two keys, curves over one, slices side by side."""
    from pindrive.output import atomic_write, naming

    with refusing():
        kind = figure_format(output, "--output")
        check_distinct([file, output])

        from pindrive.study.view import View

        with View(file) as view:
            over = [given and view.key(given, option) for given, option in ((x, "--x"), (y, "--y"))]
            held = view.held(at or ())
            names = [view.number(name) for name in number or view.usual_numbers()]
            chosen = view.axes(over[0], over[1], held)

            from pindrive.study.maps import plot_study
            from pindrive.style import save

            with atomic_write(output) as part, naming(output):
                save(plot_study(view, names, *chosen, held), part, kind)
    typer.echo(f"Wrote {output}")


def sensitivity(
    study: StudyArgument,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    tolerances: Annotated[
        bool, typer.Option("--tolerances", help="Over [tolerances] instead of [axes].")
    ] = False,
    rows: Annotated[
        int | None,
        typer.Option(
            metavar="COUNT",
            help="Rows of the design, a power of 2; 8192 unless given, of scans 256.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the design and the bootstrap.")] = 1,
    threads: Annotated[
        int | None, typer.Option(metavar="COUNT", min=1, help="All cores unless given.")
    ] = None,
) -> None:
    """Say which parameter matters: elasticities at the device, Sobol' indices over the ranges."""

    def answer(plan: Plan, tell: Tell) -> Influence:
        from pindrive.study.influence import influence

        return influence(
            plan, tolerances=tolerances, count=rows, seed=seed, threads=threads, tell=tell
        )

    def picture(found: Influence, name: str) -> Figure:
        from pindrive.study.charts import plot_influence

        return plot_influence(found, name)

    _, found = _answered(study, answer, plot, picture)
    from pindrive.report import show
    from pindrive.study.report import influence_report

    show(influence_report(found))
    if plot:
        typer.echo(f"Wrote {plot}")


def robustness(
    study: StudyArgument,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    draws: Annotated[
        int | None,
        typer.Option(
            metavar="COUNT",
            min=1,
            help="Random designs; 100 000 unless given, of scans 1000.",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the draws and the search.")] = 1,
    threads: Annotated[
        int | None, typer.Option(metavar="COUNT", min=1, help="All cores unless given.")
    ] = None,
) -> None:
    """Say how a design fares within its tolerances: spread, yield, worst case."""

    def answer(plan: Plan, tell: Tell) -> Robustness:
        from pindrive.study.robust import robustness

        return robustness(plan, count=draws, seed=seed, threads=threads, tell=tell)

    def picture(found: Robustness, name: str) -> Figure:
        from pindrive.study.histograms import plot_robustness

        return plot_robustness(found, name)

    plan, found = _answered(study, answer, plot, picture)
    from pindrive.report import show
    from pindrive.study.report import robustness_report

    show(robustness_report(plan, found))
    if plot:
        typer.echo(f"Wrote {plot}")


def _answered(
    study: Path,
    answer: Callable[[Plan, Tell], Found],
    plot: Path | None,
    picture: Callable[[Found, str], Figure],
) -> tuple[Plan, Found]:
    """A study and what was asked of it, with a progress bar and, where wanted, a picture."""
    from pindrive.output import atomic_write, naming
    from pindrive.study.studyfile import load_study

    with refusing(), ExitStack() as stack:
        plan = load_study(study)
        check_distinct([*{study, plan.device.path}, *([plot] if plot else [])])
        kind = figure_format(plot) if plot else ""
        part = stack.enter_context(atomic_write(plot)) if plot else None
        with _bar() as tell:
            found = answer(plan, tell)
        if plot and part:
            from pindrive.style import save

            with naming(plot):
                save(picture(found, plan.name), part, kind)
    return plan, found

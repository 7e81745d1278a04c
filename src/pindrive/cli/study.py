"""The commands of studies: many releases or scans of one device, each with other values."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from pindrive.cli.errors import (
    INTERRUPTED,
    OverridesOption,
    count_option,
    picture,
    picture_format,
    refusing,
)
from pindrive.lazy import rich_console, rich_progress

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from pindrive.device.scanning import Progress
    from pindrive.study.design import Plan
    from pindrive.study.robustness import Robustness
    from pindrive.study.sensitivity import Influence

Found = TypeVar("Found")
StudyArgument = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file (TOML).")]
ThreadsOption = Annotated[int | None, count_option("--threads", "All cores unless given.")]


def sweep(
    study: StudyArgument,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="NetCDF; STUDY.nc unless given."),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with a run cut short.")] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Replace an earlier study, or a run cut short.")
    ] = False,
    stop_after: Annotated[
        int | None, count_option("--stop-after", "Stop there; --resume continues.", "POINTS")
    ] = None,
    threads: ThreadsOption = None,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Work on a Dask cluster instead.")
    ] = None,
    overrides: OverridesOption = None,
) -> None:
    """Compute all points of a study and write them into one NetCDF file.

    What keeps its ratio to a varied value changes with it, as for `robustness`.
    """
    from pindrive.cli.study_tables import sweep_report
    from pindrive.study.runner import on_threads
    from pindrive.study.runner import sweep as work_off
    from pindrive.study.study import load_study

    target = output or study.with_suffix(".nc")
    with refusing():
        if resume and restart:
            raise ValueError("give --resume or --restart, not both")
        if threads and cluster:
            raise ValueError("give --threads or --cluster, not both: workers have their own")
        plan = load_study(study, overrides or ())
        if not plan.dimensions:
            raise ValueError(f"{study}: has no axes; write what to vary in [axes]")
        if cluster:
            from pindrive.study.runner import on_cluster

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
            words = "finished chunks are kept, --resume continues with them"
            typer.echo(f"stopped; {words if kept else 'no chunk was finished yet'}", err=True)
            raise typer.Exit(INTERRUPTED) from None
    for line in sweep_report(plan, done):
        typer.echo(line)
    _say_coefficient(plan)


@contextmanager
def _bar() -> Iterator[Progress]:
    """A progress bar with points per second and time left, shown in a terminal."""
    if not sys.stderr.isatty():
        yield lambda done, total: None
        return
    columns = (
        rich_progress.TextColumn("{task.percentage:>3.0f} %"),
        rich_progress.BarColumn(),
        rich_progress.TextColumn("{task.fields[speed]}"),
        rich_progress.TimeRemainingColumn(),
    )
    with rich_progress.Progress(
        *columns, console=rich_console.Console(stderr=True), transient=True
    ) as bar:
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
    from pindrive.files.output import check_outputs, naming, writing

    with refusing():
        target = picture(output, "--output")
        check_outputs([target], [file])

        from pindrive.study.slices import View

        with View(file) as view:
            over = [given and view.key(given, option) for given, option in ((x, "--x"), (y, "--y"))]
            held = view.held(at or ())
            names = [view.number(name) for name in number or view.usual_numbers()]
            chosen = view.axes(over[0], over[1], held)

            from pindrive.plot.slices import plot_study
            from pindrive.plot.style import save

            with writing([target], [file]) as parts, naming(output):
                figure = plot_study(view, names, *chosen, held)
                save(figure, parts[output], picture_format(output))
    typer.echo(f"Wrote {output}")


def sensitivity(
    study: StudyArgument,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    tolerances: Annotated[
        bool, typer.Option("--tolerances", help="Over [tolerances] instead of [axes].")
    ] = False,
    number: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="A number to analyse; all unless given."),
    ] = None,
    rows: Annotated[
        int | None,
        count_option(
            "--rows",
            "Rows of the design, a power of 2 from 128 on; 8192 unless given, of scans 256.",
            least=128,
            power_of_2=True,
        ),
    ] = None,
    seed: Annotated[int, count_option("--seed", "Of the design and the bootstrap.", least=0)] = 1,
    threads: ThreadsOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Say which parameter matters: elasticities at the device, Sobol' indices over the ranges.

    What keeps its ratio to a varied value changes with it, as for `robustness`.
    """

    def answer(plan: Plan, tell: Progress) -> Influence:
        from pindrive.study.outputs import known_output
        from pindrive.study.sensitivity import askable, influence

        among = askable(plan)
        return influence(
            plan,
            tolerances=tolerances,
            numbers=[known_output(name, "--number", among) for name in number or ()],
            rows=rows,
            seed=seed,
            threads=threads,
            progress=tell,
        )

    def draw(found: Influence, name: str) -> Figure:
        from pindrive.plot.sensitivity import plot_influence

        return plot_influence(found, name)

    plan, found = _answered(study, overrides, answer, plot, draw)
    from pindrive.cli.study_tables import influence_report
    from pindrive.cli.tables import show

    show(influence_report(found))
    _say_coefficient(plan, tolerances=tolerances)
    if plot:
        typer.echo(f"Wrote {plot}")


def robustness(
    study: StudyArgument,
    plot: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw it: .png, .svg or .pdf.")
    ] = None,
    draws: Annotated[
        int | None, count_option("--draws", "Random draws; 100 000 unless given, of scans 1000.")
    ] = None,
    seed: Annotated[int, count_option("--seed", "Of the draws and the search.", least=0)] = 1,
    threads: ThreadsOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Analyse a design within its tolerances: spread, yield, worst case.

    Static friction and friction curves keep their ratio to kinetic friction, and the skin's stretch
    to the largest that it can have, unless they have a tolerance of their own. Draws that cannot
    exist all the same are counted apart, with the reason.
    """

    def answer(plan: Plan, tell: Progress) -> Robustness:
        from pindrive.study.robustness import robustness

        return robustness(plan, count=draws, seed=seed, threads=threads, progress=tell)

    def draw(found: Robustness, name: str) -> Figure:
        from pindrive.plot.robustness import plot_robustness

        return plot_robustness(found, name)

    plan, found = _answered(study, overrides, answer, plot, draw)
    from pindrive.cli.study_tables import robustness_report
    from pindrive.cli.tables import show

    show(robustness_report(plan, found))
    _say_coefficient(plan, tolerances=True)
    if plot:
        typer.echo(f"Wrote {plot}")


def _say_coefficient(plan: Plan, *, tolerances: bool = False) -> None:
    """What becomes of the plate's friction coefficient, where the study changes it."""
    from pindrive.study.validation import coefficient_words

    found = coefficient_words(plan, tolerances=tolerances)
    if found:
        words, doubtful = found
        typer.echo(f"warning: {words}" if doubtful else words, err=doubtful)


def _answered(
    study: Path,
    overrides: list[str] | None,
    answer: Callable[[Plan, Progress], Found],
    plot: Path | None,
    draw: Callable[[Found, str], Figure],
) -> tuple[Plan, Found]:
    """A study and what was asked of it, with a progress bar and, where wanted, a picture."""
    from pindrive.files.output import naming, writing
    from pindrive.study.study import load_study

    with refusing():
        plan = load_study(study, overrides or ())
        try:
            with writing([picture(plot)] if plot else [], plan.inputs) as parts:
                with _bar() as tell:
                    found = answer(plan, tell)
                if plot:
                    from pindrive.plot.style import save

                    with naming(plot):
                        save(draw(found, plan.name), parts[plot], picture_format(plot))
        except KeyboardInterrupt:
            typer.echo("stopped; nothing was written", err=True)
            raise typer.Exit(INTERRUPTED) from None
    return plan, found

"""The command `pindrive design`: the design that meets a wish best."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import command
from pindrive.cli.options import (
    ClusterOption,
    OverridesOption,
    ThreadsOption,
    count_option,
    file_option,
)
from pindrive.cli.outputs import ForceOption
from pindrive.cli.progress import bar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from pindrive.optimisation.results import Design

NONE_MEETS = 1
"""Exit status where no design meets the demands."""
FILES = ("design.toml", "design.nc", "design.png", "transient.png", "speed.png")


@command("Designs", "pindrive design wish.toml -o design")
def design(
    wish: Annotated[Path, typer.Argument(metavar="WISH", help="Wish file (TOML).")],
    output: Annotated[
        Path | None,
        file_option("A folder for the design and its figures.", "--output", "-o", metavar="DIR"),
    ] = None,
    force: ForceOption = False,
    seed: Annotated[int, count_option("--seed", "Of all draws.", least=0)] = 1,
    threads: ThreadsOption = None,
    cluster: ClusterOption = None,
    overrides: OverridesOption = None,
) -> None:
    """Find the design that meets a wish best.

    A wish names a device, what may vary (ranges and catalogues), what is demanded under which
    conditions, tolerances and one to three goals. Exit status 1: no design meets the demands, and
    what is printed and written is the closest.
    """
    from pindrive.files.output import check_folder, write_files
    from pindrive.optimisation.designing import optimise
    from pindrive.optimisation.wish import read_wish

    with refusing():
        if threads and cluster:
            raise ValueError("give --threads or --cluster, not both: workers have their own")
        wanted = read_wish(wish, overrides or ())
        if output:
            if not force:
                _check_folder(output)
            check_folder(output)
        with bar("Designs") as progress:
            tell = progress or (lambda done, total: None)
            found = optimise(
                None, wanted, seed=seed, threads=threads, cluster=cluster, progress=tell
            )
        if output:
            write_files(output, _files(found, output), force=force)
    from pindrive.cli.design_tables import design_report
    from pindrive.cli.tables import show

    show(design_report(found))
    if output:
        typer.echo(f"Wrote {output}")
    if not found.feasible:
        raise typer.Exit(NONE_MEETS)


def _check_folder(folder: Path) -> None:
    """Refuse a folder that holds something else than an earlier design."""
    if folder.is_dir():
        for path in sorted(folder.iterdir()):
            if path.name not in FILES:
                raise ValueError(
                    f"-o {folder}: holds {path.name}, which is of no design; "
                    "give another folder, or --force"
                )


def _files(found: Design, folder: Path) -> dict[str, bytes]:
    """What is written, by name."""
    from pindrive.optimisation.results import designed_file

    files = {"design.toml": designed_file(found, folder / "design.toml").encode("utf-8")}
    with TemporaryDirectory(prefix="pindrive-") as place:
        path = Path(place) / "design.nc"
        found.to_dataset().to_netcdf(path, engine="h5netcdf")
        files["design.nc"] = path.read_bytes()
    files["design.png"] = _png(found.plot())
    if found.motion:
        files["transient.png"] = _png(found.motion.plot())
    else:
        files["speed.png"] = _png(_speeds(found))
    return files


def _png(figure: Figure) -> bytes:
    from pindrive.plot.style import save

    file = BytesIO()
    save(figure, file, "png")
    return file.getvalue()


def _speeds(found: Design) -> Figure:
    """How fast a hand may move with the design, for pitches around those of the page."""
    from pindrive.evaluation.resolution import largest_speeds

    page = found.wish.plan.page
    assert page
    own = page.page.grating or (0.003,)
    pitches = sorted({factor * pitch for pitch in own for factor in (0.5, 1.0, 2.0)})
    criteria = found.device.criteria
    limits = largest_speeds(found.device.device, pitches, criteria=criteria)
    return limits.plot(found.device.name)

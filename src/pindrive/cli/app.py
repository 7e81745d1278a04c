"""The command line. Commands import their modules when they run, so that help is fast."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated, Any

import typer

from pindrive.cli.errors import in_options
from pindrive.cli.help import Program, register
from pindrive.cli.interrupts import INTERRUPTED, STOPPED, ignore_more
from pindrive.lazy import missing

app = typer.Typer(
    name="pindrive",
    cls=Program,
    help="Exact dynamics of the pin drives of tactile devices.",
    no_args_is_help=True,
    rich_markup_mode=None,  # plain help is here in a third of the time
    pretty_exceptions_enable=False,
)
register(app)


def main() -> None:
    """Run the command line."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without µ shows ? instead
    status: int | str | None = None
    try:
        app()
    except KeyboardInterrupt:
        ignore_more()
        print(STOPPED, file=sys.stderr)
        status = INTERRUPTED
    except SystemExit as end:
        status = end.code
    except ModuleNotFoundError as error:
        reason = missing(error)
        if not reason:
            raise
        print(reason, file=sys.stderr)
        status = 2
    except OSError as error:  # other files have been named already
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing to flush at exit
        print(f"standard output: cannot be written: {error.strerror}", file=sys.stderr)
        sys.exit(2)
    if status == INTERRUPTED:
        gc.collect()  # close what the exception holds, so that no file is left half written
        os._exit(INTERRUPTED)  # threads at work would be waited for
    sys.exit(status)


def _print_version(wanted: bool) -> None:
    if wanted:
        from pindrive import __version__

        typer.echo(f"pindrive {__version__}")
        raise typer.Exit


@app.callback()
def _program(
    context: typer.Context,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_print_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    context.with_resource(_brief_warnings())


@contextmanager
def _brief_warnings() -> Iterator[None]:
    """Warnings of implausible values are lines on the standard error, as refusals are."""
    import warnings

    from pindrive.quantities.table import ImplausibleValueWarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, ImplausibleValueWarning):
            typer.echo(f"warning: {in_options(str(message))}", err=True)
        else:
            usual(message, category, *place, **more)

    with warnings.catch_warnings():
        usual = warnings.showwarning
        warnings.simplefilter("always", ImplausibleValueWarning)
        warnings.showwarning = show
        yield

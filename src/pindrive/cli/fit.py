"""The command `pindrive fit`: parameters of a device from recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from pindrive.cli.errors import refusing
from pindrive.cli.help import ASKED, COMPUTED, command
from pindrive.cli.options import (
    ClusterOption,
    OverridesOption,
    count_option,
    option,
)
from pindrive.cli.outputs import (
    ForceOption,
    PlotOption,
    by_suffix,
    output_option,
    pictures,
    results,
    say_written,
)

if TYPE_CHECKING:
    from pindrive.files.device import DeviceFile
    from pindrive.fitting.problem import FitProblem
    from pindrive.fitting.recording import Recording

EXAMPLE = "stiffness, damping, plate.kinetic=5 mN..50 mN"


@command("Measurements", 'pindrive fit device.toml pin.csv --free "stiffness, damping"')
def fit(
    device: Annotated[
        Path,
        typer.Argument(
            metavar="DEVICE|FIT", help="Device file, or fit file that names recordings (TOML)."
        ),
    ],
    recordings: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="[RECORDING...]",
            help="Recordings of releases (CSV files with units in the header).",
        ),
    ] = None,
    free: Annotated[
        list[str] | None,
        option(ASKED, f'Free parameters, optionally with bounds: "{EXAMPLE}".', metavar="KEYS"),
    ] = None,
    output: Annotated[Path | None, output_option("Device file of the fit: .toml.")] = None,
    mouse_velocity: Annotated[
        list[str] | None,
        option(ASKED, "Mouse velocity of each recording, or of all.", metavar="SPEED|CSV"),
    ] = None,
    window: Annotated[
        str | None,
        option(ASKED, 'Time range of the samples, for example "5 ms..150 ms".', metavar="FROM..TO"),
    ] = None,
    noise: Annotated[
        list[str] | None,
        option(
            ASKED,
            'Noise of a channel, such as "position=drift, hum 50 Hz"; else chosen.',
            metavar="CHANNEL=NOISE",
        ),
    ] = None,
    compare: Annotated[
        bool, option(COMPUTED, "Compare friction laws by AICc.", "--compare")
    ] = False,
    plot: PlotOption = None,
    seed: Annotated[int, count_option("--seed", "Seed of the candidates.", least=0)] = 1,
    cluster: ClusterOption = None,
    overrides: OverridesOption = None,
    force: ForceOption = False,
) -> None:
    """Fit a device to recordings of its pin, and report undetermined parameters.

    A fit file names the device, free keys, and recordings with their noise (docs/fitting.md).
    A recording has columns time and position, velocity, acceleration or force, and mouse_velocity
    and plate_load if they vary, for example "time [s], position [m]". Parameters of a fit are the
    keys of a drive and its motion, time_offset, and the offset of a channel (position_offset).
    The noise of a channel lists, apart by commas: a size (5 um), offset, drift, quadratic drift,
    hum 50 Hz, harmonic, correlated, outliers, step 20 um, average before, white, choose.
    """
    from pindrive.files.output import DEVICE_FILE
    from pindrive.fitting.results import Fit

    with refusing():
        problem = _problem(
            device, recordings or [], free or [], mouse_velocity, noise, window, overrides, seed
        )

        def write_device(found: Fit, part: Path) -> None:
            from pindrive.fitting.device_file import fitted_file

            part.write_text(fitted_file(problem.device, found, part), encoding="utf-8")

        targets = by_suffix([output] if output else [], {".toml": (DEVICE_FILE, write_device)})
        targets += pictures(plot, Fit.plot)
        with results(targets, problem.files, force=force) as write:
            from pindrive.fitting.comparison import compare_models

            found = problem.run(cluster=cluster)
            compared = compare_models(found, problem.seed) if compare else None
            write(found)
    from pindrive.cli.fit_tables import comparison_report, fit_report
    from pindrive.cli.tables import show

    show(fit_report(found))
    if compared:
        show(comparison_report(compared))
    say_written(targets)


def _problem(
    device: Path,
    recordings: Sequence[Path],
    free: Sequence[str],
    mouse_velocity: Sequence[str] | None,
    noise: Sequence[str] | None,
    window: str | None,
    overrides: Sequence[str] | None,
    seed: int,
) -> FitProblem:
    """Return the fit of a fit file, or of a device file with recordings and options."""
    from pindrive.files.device import load_device
    from pindrive.fitting.problem import FitProblem, is_fit_file, load_fit

    if not recordings and is_fit_file(device):
        for name, given in (
            ("--free", free),
            ("--mouse-velocity", mouse_velocity),
            ("--noise", noise),
            ("--window", window),
        ):
            if given:
                raise ValueError(f"{name} must be left out with a fit file, which gives it")
        found = load_fit(device, overrides or ())
        return found if seed == 1 else replace(found, seed=seed)
    if not free:
        raise ValueError(f'--free KEYS must say what is fitted, such as --free "{EXAMPLE}"')
    if not recordings:
        raise ValueError(f"{device}: names no recordings; give their files after it")
    loaded = load_device(device, overrides or ())
    keys, bounds = _free(free)
    made = _recordings(recordings, mouse_velocity or [], noise or [], window, loaded)
    return FitProblem(
        device=loaded,
        recordings=tuple(made),
        free=tuple(keys),
        bounds=bounds,
        seed=seed,
        files=(*loaded.inputs, *recordings),
    )


def _free(given: Sequence[str]) -> tuple[list[str], dict[str, tuple[float | str, float | str]]]:
    """Return the free keys, and their bounds as far as given."""
    keys, bounds = [], {}
    for part in (part.strip() for text in given for part in text.split(",")):
        key, equals, ends = (piece.strip() for piece in part.partition("="))
        if not key:
            raise ValueError(
                f'--free: must be keys apart by commas, like "{EXAMPLE}", got "{part}"'
            )
        keys.append(key)
        if equals:
            bounds[key] = _ends(ends, f"--free {key}", EXAMPLE.partition("=")[2])
    return keys, bounds


def _ends(text: str, option: str, example: str) -> tuple[Any, Any]:
    low, dots, high = (piece.strip() for piece in text.partition(".."))
    if not (low and dots and high):
        raise ValueError(f'{option}: must be two values, like "{example}", got "{text}"')
    return low, high


def _recordings(
    paths: Sequence[Path],
    velocities: Sequence[str],
    noise: Sequence[str],
    window: str | None,
    device: DeviceFile,
) -> list[Recording]:
    from pindrive.fitting.recording import read_recording

    if len(velocities) not in (0, 1, len(paths)):
        required = f"given once, or once for each of {len(paths)} recordings"
        raise ValueError(f"--mouse-velocity must be {required}, got {len(velocities)} of them")
    each: list[str | None] = [*velocities] * (len(paths) if len(velocities) == 1 else 1)
    each = each or [None] * len(paths)
    sizes = {}
    for text in noise:
        channel, equals, size = (piece.strip() for piece in text.partition("="))
        if not equals:
            raise ValueError(f'--noise must be like "position=5 um", got "{text}"')
        sizes[channel] = size
    found = []
    for path, velocity in zip(paths, each, strict=True):
        speed = None if velocity is None else _velocity(velocity, device)
        made = read_recording(path, mouse_velocity=speed, noise=sizes)
        found.append(made.window(*_ends(window, "--window", "5 ms..150 ms")) if window else made)
    return found


def _velocity(text: str, device: DeviceFile) -> Any:
    """Return a speed, or the velocity profile of a CSV or of a recorded hand."""
    from pindrive.files.device import load_device
    from pindrive.files.keys import is_file

    if not is_file("motion.mouse_velocity", text):
        return text
    return load_device(device.path, [f"mouse_velocity={text}"]).release.mouse_velocity

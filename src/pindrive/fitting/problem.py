"""Fit files: a device, its recordings, and the fitted parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any, Final

from pindrive.files.device import DeviceFile, read_tables
from pindrive.files.keys import TABLES, is_file
from pindrive.files.overrides import ConfigError
from pindrive.fitting.estimation import fit
from pindrive.fitting.recording import Recording, read_recording
from pindrive.fitting.results import Fit
from pindrive.motion.profile import Profile
from pindrive.quantities.names import Names
from pindrive.quantities.refusal import quoted, refusal
from pindrive.quantities.value import concise, equal_by_value
from pindrive.study.tables import device_in

__all__ = ["FitProblem", "load_fit"]

_BESIDE: Final = ("free", "bounds", "seed", "confidence", "recording")
_OF_RECORDING: Final = ("file", "mouse_velocity", "window", "noise")
_TEMPLATE: Final = "docs/fitting.md shows a fit file"


@equal_by_value
@concise
@dataclass(frozen=True, kw_only=True)
class FitProblem:
    """A fit as its file describes it.

    Attributes:
        device: Device with the known values and the start of the search.
        recordings: Recordings, each with its mouse velocity, window and noise.
        free: Fitted parameters, as for `fit`.
        bounds: (least, largest) by name.
        seed: Seed of the candidates.
        confidence: Confidence of the intervals, between 0 and 1.
        files: Files that were read.
    """

    device: DeviceFile
    recordings: tuple[Recording, ...]
    free: tuple[str, ...]
    bounds: Mapping[str, tuple[float | str, float | str]] = field(default_factory=dict)
    seed: int = 1
    confidence: float = 0.95
    files: tuple[Path, ...] = ()

    def run(self, *, profiles: bool = True, cluster: str | None = None) -> Fit:
        """Return the fit; arguments and errors as for `fit`."""
        return fit(
            self.recordings,
            self.device.drive,
            self.device.release,
            free=self.free,
            bounds=self.bounds,
            seed=self.seed,
            confidence=self.confidence,
            profiles=profiles,
            cluster=cluster,
        )


def is_fit_file(path: Path) -> bool:
    """True if a TOML file names recordings; also of none that can be read."""
    try:
        return "recording" in read_tables(path)
    except ConfigError:
        return False


def load_fit(path: str | PathLike[str], overrides: Iterable[str] = ()) -> FitProblem:
    """Read a fit from a file.

    Args:
        path: A TOML file that names a device, what is free, and recordings.
        overrides: "key=value" each, as for `load_device`.

    Returns:
        The fit; `run` computes it.

    Raises:
        ConfigError: The file, its device or a recording cannot be read, or holds anything unknown,
            malformed or out of bounds; a line for each problem.
    """
    file = Path(path)
    tables: dict[str, Any] = read_tables(file, _TEMPLATE)
    problems = [*_unknown(tables, ("base", *_BESIDE, *TABLES), file, "")]
    device, _ = device_in(tables, file, overrides, problems)
    free = tables.get("free")
    if not isinstance(free, list) or not free or not all(isinstance(key, str) for key in free):
        required = 'a list of keys, like ["stiffness", "plate.kinetic"]'
        problems.append(refusal("free", required, quoted(free), str(file)))
    bounds = _bounds(tables.get("bounds", {}), file, problems)
    listed = tables.get("recording")
    if not isinstance(listed, list) or not all(isinstance(each, dict) for each in listed):
        required = "one table [[recording]] or several, each with a file"
        problems.append(refusal("recording", required, quoted(listed), str(file)))
        listed = []
    found = []
    for i, table in enumerate(listed):
        problems += _unknown(table, _OF_RECORDING, file, f"recording {i + 1}: ")
        made = _attempt(problems, partial(_recording, table, file, device))
        if made is not None:
            found.append(made)
    if problems:
        raise ConfigError(problems)
    return FitProblem(
        device=device,
        recordings=tuple(found),
        free=tuple(tables["free"]),
        bounds=bounds,
        seed=tables.get("seed", 1),
        confidence=tables.get("confidence", 0.95),
        files=(file, *device.inputs, *(source for each in found for source in each.sources)),
    )


def _unknown(table: Mapping[str, Any], known: Iterable[str], file: Path, where: str) -> list[str]:
    names = Names("key", dict.fromkeys(known, ()), listed="docs/fitting.md")
    problems = []
    for key in table:
        try:
            names.find(key, f"{file}: {where}{key}")
        except ValueError as error:
            problems.append(str(error))
    return problems


def _attempt(problems: list[str], made: Callable[[], Recording]) -> Recording | None:
    try:
        return made()
    except ValueError as error:
        problems.append(str(error))
        return None


def _bounds(given: Any, file: Path, problems: list[str]) -> dict[str, tuple[Any, Any]]:
    found = {}
    for key, ends in given.items() if isinstance(given, dict) else [("bounds", given)]:
        if not isinstance(ends, list) or len(ends) != 2:
            required = 'two values, like ["50 N/m", "200 N/m"]'
            problems.append(refusal(f"bounds of {key}", required, quoted(ends), str(file)))
        else:
            found[key] = (ends[0], ends[1])
    return found


def _recording(table: Mapping[str, Any], file: Path, device: DeviceFile) -> Recording:
    """Return the recording of a table."""
    if not isinstance(table.get("file"), str):
        required = "the path of a CSV in quotes"
        given = quoted(table.get("file"))
        raise ValueError(refusal("file of a recording", required, given, str(file)))
    path, speed = file.parent / table["file"], _velocity(table.get("mouse_velocity"), file, device)
    noise = table.get("noise")
    if isinstance(noise, str):  # noise of all channels
        noise = dict.fromkeys(read_recording(path, mouse_velocity=speed).channels, noise)
    made = read_recording(path, mouse_velocity=speed, noise=noise)
    window = table.get("window")
    if window is None:
        return made
    if not isinstance(window, list) or len(window) != 2:
        required = 'two times, like ["5 ms", "150 ms"]'
        raise ValueError(refusal("window", required, quoted(window), str(file)))
    return made.window(*window)


def _velocity(given: Any, file: Path, device: DeviceFile) -> float | str | Profile | None:
    """Return a speed, or the profile of a CSV beside the fit file."""
    if not isinstance(given, str) or not is_file("motion.mouse_velocity", given):
        found: float | str | None = given
        return found
    from pindrive.files.device import load_device

    csv = (file.parent / given).resolve()
    profile = load_device(device.path, [f"mouse_velocity={csv}"]).release.mouse_velocity
    assert isinstance(profile, (float, Profile))
    return profile

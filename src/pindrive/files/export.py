"""A motion as files: a figure, samples as CSV, everything as NetCDF, the numbers as JSON.

Pictures and NetCDF are made in memory first: on a full disk the libraries that make them fail in
ways of their own, while plain writing raises OSError.
"""

from __future__ import annotations

import csv
import json
from dataclasses import asdict
from io import BytesIO
from math import isfinite, isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.table import QUANTITIES

if TYPE_CHECKING:
    from pindrive.files.device import DeviceFile
    from pindrive.motion.motion import Motion

AT_ONCE: Final = 1 << 16
"""Rows that are made into text together: more take memory and save no time."""


def write_csv(motion: Motion, path: Path, samples: int) -> None:
    """Write the motion, SI, at even times and at its events (right-hand limits), a row each."""
    from pindrive.motion.dataset import Column, columns

    t = motion.sample_times(samples)
    found = {"time": Column(t, "s", "time since the release"), **columns(motion, t)}
    names = [f"{name}_{column.unit.replace('/', '_per_')}" for name, column in found.items()]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(names)
        for begin in range(0, len(t), AT_ONCE):
            part = (column.values[begin : begin + AT_ONCE].tolist() for column in found.values())
            writer.writerows(zip(*part, strict=True))


def write_netcdf(motion: Motion, path: Path, samples: int) -> None:
    """Write `motion.to_dataset` at even times and at its events."""
    file = BytesIO()
    dataset = motion.to_dataset(motion.sample_times(samples))
    dataset.to_netcdf(file, engine="h5netcdf")
    path.write_bytes(file.getvalue())


def write_json(motion: Motion, device: DeviceFile, path: Path) -> None:
    """Write what was simulated and every number that came out; null where one does not exist.

    An infinite one is the text "Infinity".

    Raises:
        ValueError: the motion has more phases than `pindrive.quantities.budgets` allow.
    """
    from pindrive import __version__
    from pindrive.quantities import budgets

    budgets.MOTION_PHASES.check(motion.segment_count)
    inputs, numbers = motion.inputs(), motion.numbers()
    certificate = motion.certificate()
    document = {
        "pindrive": __version__,
        "device": {
            "file": str(device.path),
            "name": device.name,
            "description": device.description,
        },
        "config": device.values(),
        "status": motion.status.name,
        "inputs": inputs,
        "ending": {"kind": motion.ending.kind, "cycle": motion.ending.cycle},
        "numbers": numbers,
        "units": {name: _units(name, value) for name, value in (inputs | numbers).items()},
        "certificate": {**asdict(certificate), "worst": certificate.worst},
        "events": [asdict(event) for event in motion.events],
        "segments": [asdict(segment) for segment in motion.segments],
    }
    text = json.dumps(_finite(document), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _units(name: str, value: object) -> str | list[str]:
    """The SI unit of a number, or of both columns of rows."""
    unit = QUANTITIES[name].unit
    if not isinstance(value, tuple):
        return unit
    return [QUANTITIES[COLUMNS[QUANTITIES[name].rows_of][0]].unit, unit]


def _finite(value: Any) -> Any:
    """`value` with null for NaN and the text "Infinity" for infinity, which JSON lacks."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    if not isinstance(value, float) or isfinite(value):
        return value
    return None if isnan(value) else "Infinity" if value > 0 else "-Infinity"

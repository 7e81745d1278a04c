"""Motions of several bodies as files: samples and events as CSV, numbers as JSON, NetCDF."""

from __future__ import annotations

import json
from dataclasses import asdict
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.bodies.dataset import columns
from pindrive.bodies.system_motion import SystemMotion
from pindrive.files.dataset import finite
from pindrive.files.export import even_times, rows_of_columns, with_events, write_table
from pindrive.files.output import headed, titled

_EVENTS: Final = ("time [s]", "contact", "kind", "before", "after")
SYSTEM_CSV: Final = headed("CSV file of a motion of several bodies", ("time [s]", "body."))
SYSTEM_EVENTS_CSV: Final = headed("CSV file of the events of several bodies", _EVENTS)
SYSTEM_NETCDF: Final = titled("NetCDF file of a motion of several bodies", "Motion of a system")


def to_csv(motion: SystemMotion, path: str | PathLike[str], rate: float | str) -> Path:
    """Write a motion as `SystemMotion.to_csv`; return the path of the events."""
    times = even_times(0.0, motion.core.end, rate, len(motion.system.bodies))
    return with_events(
        Path(path),
        (SYSTEM_CSV, SYSTEM_EVENTS_CSV),
        lambda part: write_csv(motion, part, times),
        lambda part: write_events(motion, part),
    )


def write_csv(motion: SystemMotion, path: Path, times: NDArray[np.float64]) -> None:
    """Write all bodies, contacts and springs, SI, at times (s, shape (n,)), a row each."""
    found = columns(motion, times)
    write_table(path, found, rows_of_columns([*found.values()]))


def write_events(motion: SystemMotion, path: Path) -> None:
    """Write the events of a motion, a row each."""
    rows = ([e.time, e.contact, e.kind, e.before, e.after] for e in motion.events)
    write_table(path, _EVENTS, rows)


def write_netcdf(motion: SystemMotion, path: Path, samples: int) -> None:
    """Write `motion.to_dataset` at even times and at its events."""
    file = BytesIO()
    motion.to_dataset(motion.sample_times(samples)).to_netcdf(file, engine="h5netcdf")
    path.write_bytes(file.getvalue())


def write_json(motion: SystemMotion, source: Path, path: Path) -> None:
    """Write what was simulated, and every number and event of the motion."""
    from pindrive import __version__

    certificate = motion.certificate()
    document = {
        "pindrive": __version__,
        "system": {"file": str(source)},
        "status": motion.status.name,
        "duration": motion.duration,
        "ending": asdict(motion.ending),
        "inputs": {key: _plain(value) for key, value in motion.system.inputs().items()},
        "numbers": motion.numbers(),
        "certificate": {**asdict(certificate), "worst": certificate.worst},
        "events": [asdict(event) for event in motion.events],
    }
    text = json.dumps(finite(document), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    described = getattr(value, "described", None) or getattr(value, "rows", None)
    return described or value

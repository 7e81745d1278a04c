"""Motions and scans as files: samples as CSV, a motion as NetCDF, its numbers as JSON.

Pictures and NetCDF are made in memory first: on a full disk the libraries that make them fail in
ways of their own, while plain writing raises OSError.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from io import BytesIO
from math import isnan
from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.device.pin_scan import PinScan
from pindrive.device.scanning import Scan
from pindrive.files.dataset import finite
from pindrive.files.device import DeviceFile
from pindrive.files.functions import plain
from pindrive.files.output import (
    EVENT_HEADINGS,
    EVENTS_CSV,
    MOTION_CSV,
    SCAN_CSV,
    SCAN_EVENTS_CSV,
    Kind,
    Output,
    naming,
    writing,
)
from pindrive.motion.dataset import columns
from pindrive.motion.motion import Motion
from pindrive.motion.results import Event
from pindrive.quantities import budgets
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.results import EDGES, LINE, SERIES
from pindrive.quantities.table import QUANTITIES, check

AT_ONCE: Final = 1 << 16
"""Rows that are made into text together: more take memory and save no time."""


def events_path(path: Path) -> Path:
    """Return the path of the events beside a file of samples: m-events.csv for m.csv."""
    return path.with_name(f"{path.stem}-events{path.suffix}")


def even_times(begin: float, end: float, rate: float | str, curves: int = 1) -> NDArray[np.float64]:
    """The times begin + i / rate up to the end, s.

    Args:
        begin: s.
        end: s, later.
        rate: Samples a second, Hz, from 1e-6 to 1e12.
        curves: Number of motions that are sampled at the times.

    Raises:
        ValueError: The samples exceed a budget of `pindrive.quantities.budgets`.
    """
    per_second = check("rate", rate)
    count = (end - begin) * per_second + 1.0
    budgets.MOTION_SAMPLES.check(curves * count, f"{end - begin:g} s at {per_second:g} Hz")
    # A count that is whole but for rounding is whole.
    return np.minimum(begin + np.arange(int(count * (1.0 + 1e-15))) / per_second, end)


def to_csv(motion: Motion, path: str | PathLike[str], rate: float | str) -> Path:
    """Write a motion as `Motion.to_csv`; return the path of the events."""
    times = even_times(0.0, motion.duration, rate)
    return with_events(
        Path(path),
        (MOTION_CSV, EVENTS_CSV),
        lambda part: write_csv(motion, part, times),
        lambda part: write_events(motion, part),
    )


def write_csv(motion: Motion, path: Path, times: NDArray[np.float64]) -> None:
    """Write the motion, SI, at times (s, shape (n,)), a row each; right-hand limits."""
    found = columns(motion, times)
    write_table(path, _headings(found), rows_of_columns([*found.values()]))


def write_events(motion: Motion, path: Path) -> None:
    """Write the events of a motion, SI, a row each; of a cycle, one round."""
    write_table(path, EVENT_HEADINGS, map(_event_row, motion.events))


def scan_to_csv(scan: Scan, path: str | PathLike[str], rate: float | str) -> Path:
    """Write a scan as `Scan.to_csv`; return the path of the events."""
    times = even_times(scan.path.begin, scan.path.end, rate, len(scan.pins))
    return with_events(
        Path(path),
        (SCAN_CSV, SCAN_EVENTS_CSV),
        lambda part: write_scan_csv(scan, part, times),
        lambda part: write_scan_events(scan, part),
    )


def write_scan_csv(scan: Scan, path: Path, times: NDArray[np.float64]) -> None:
    """Write each pin at times on the path's clock (s, shape (n,)), pin after pin, a row each.

    The last column is the force of all pins on the hand, in the rows of each pin.
    """
    hand = scan.force_on_hand(times)

    def found(pin: PinScan) -> dict[str, NDArray[Any]]:
        return {**columns(pin.motion, pin.since(times)), "time": times, "hand_force": hand}

    rows = (
        row
        for pin in scan.pins
        for row in rows_of_columns([np.full(len(times), pin.number), *found(pin).values()])
    )
    names = [*columns(scan.pins[0].motion, scan.pins[0].since(times[:1])), "hand_force"]
    write_table(path, ["pin", *_headings(names)], rows)


def write_scan_events(scan: Scan, path: Path) -> None:
    """Write the events of each pin, pin after pin, on the path's clock, a row each."""
    rows = ([pin.number, *_event_row(event)] for pin in scan.pins for event in pin.events)
    write_table(path, ["pin", *EVENT_HEADINGS], rows)


def write_lines(found: Mapping[str, NDArray[Any]], path: Path) -> None:
    """Write `Evaluation.columns`, a row for each line; a number that does not exist is empty."""
    stated = {quantity.variable: quantity.heading for quantity in (*EDGES, *LINE)}
    rows = (
        ["" if isinstance(cell, float) and isnan(cell) else cell for cell in row]
        for row in rows_of_columns([*found.values()])
    )
    write_table(path, [stated.get(name, name) for name in found], rows)


def write_table(path: Path, head: Iterable[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write a CSV with a line of headings."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows(rows)


def rows_of_columns(table: Sequence[NDArray[Any]]) -> Iterator[tuple[Any, ...]]:
    """Yield the rows of columns, with a limited number of Python numbers at a time."""
    for begin in range(0, len(table[0]), AT_ONCE):
        yield from zip(*(part[begin : begin + AT_ONCE].tolist() for part in table), strict=True)


def with_events(
    target: Path,
    kinds: tuple[Kind, Kind],
    write_samples: Callable[[Path], None],
    write_events: Callable[[Path], None],
) -> Path:
    """Write samples and events, both files or neither; return the path of the events."""
    events = events_path(target)
    outputs = [Output(path, kind) for path, kind in zip((target, events), kinds, strict=True)]
    with writing(outputs) as parts:
        with naming(target):
            write_samples(parts[target])
        with naming(events):
            write_events(parts[events])
    return events


def _headings(names: Iterable[str]) -> list[str]:
    return [SERIES[name].heading for name in names]


def _event_row(event: Event) -> list[Any]:
    return [event.time, event.contact, event.kind, event.position, event.velocity]


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
        ValueError: The motion has more phases than `pindrive.quantities.budgets` allow.
    """
    from pindrive import __version__

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
        "config": {key: plain(value) for key, value in device.values().items()},
        "status": motion.status.name,
        "inputs": inputs,
        "ending": {"kind": motion.ending.kind, "cycle": motion.ending.cycle},
        "numbers": numbers,
        "units": {name: _units(name, value) for name, value in (inputs | numbers).items()},
        "certificate": {**asdict(certificate), "worst": certificate.worst},
        "events": [asdict(event) for event in motion.events],
        "segments": [asdict(segment) for segment in motion.segments],
    }
    text = json.dumps(finite(document), indent=2, ensure_ascii=False, allow_nan=False)
    path.write_text(text + "\n", encoding="utf-8")


def _units(name: str, value: object) -> str | list[str]:
    """The SI unit of a number, or of both columns of rows."""
    unit = QUANTITIES[name].unit
    if not isinstance(value, tuple):
        return unit
    return [QUANTITIES[COLUMNS[QUANTITIES[name].rows_of][0]].unit, unit]

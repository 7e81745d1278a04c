"""Table of quantities, last part: results of motions and scans, and criteria of the evaluation."""

from __future__ import annotations

from typing import Final

from pindrive.quantities.quantity import Quantity, fields_of, quantities, stored, stored_inputs

_FILE: Final = stored("results.toml")


def _of(group: str) -> tuple[Quantity, ...]:
    """The numbers of a group, each named after it."""
    return quantities(_FILE[group], f"{group}.")


def _of_contacts(group: str) -> tuple[Quantity, ...]:
    """The numbers of each contact in a group."""
    return tuple(
        Quantity(f"{group}.{contact}.{name}", **fields_of(row, contact=contact, letter=contact[0]))
        for contact in ("plate", "finger")
        for name, row in _FILE[f"{group}_of_contact"].items()
    )


TRANSIENT: Final = _of("transient") + _of_contacts("transient")
"""The numbers of a transient."""

ENDING: Final = _of("ending") + _of_contacts("ending")
"""Numbers of the ending of a motion."""

FINAL: Final = _of("final")
"""The state at the end, which `simulate_batch` gives on request."""

ENERGY: Final = _of("energy")
"""The energy ledger of a motion."""

CERTIFICATE: Final = _of("certificate")
"""The largest residual of each law, relative to the size of its terms."""

OUTPUTS: Final = TRANSIENT + ENDING + ENERGY + CERTIFICATE

RATE, _FORCE = quantities(_FILE["others"])

MOTION: Final = quantities(_FILE["motion"])
"""State of a motion at a time."""

SCANNED: Final = quantities(_FILE["scanned"])
"""Additional state of a scan at a time, on the clock of the hand's path."""

SERIES: Final[dict[str, Quantity]] = {quantity.name: quantity for quantity in (*MOTION, *SCANNED)}
"""The columns over time of files and datasets, by their names."""

CHANNELS: Final[dict[str, Quantity]] = {
    **{name: SERIES[name] for name in ("position", "velocity", "acceleration")},
    "force": _FORCE,
}
"""Columns of a recording of a release."""

CRITERIA: Final = stored_inputs("criteria", _FILE["criteria"])
"""Criteria of the evaluation of a scan: a table of a device file."""

LINE: Final = _of("line")
"""Numbers of each line under each pin."""

EDGES: Final[tuple[Quantity, ...]] = tuple(
    Quantity(
        f"{end}.{name}", symbol, unit, f"{meaning} the {end} of the line passed under the spot"
    )
    for end in ("begin", "end")
    for name, symbol, unit, meaning in (
        ("time", "t", "s", "when"),
        ("x", "x", "m", "where across the page"),
        ("y", "y", "m", "where down the page"),
    )
)
"""Time and place of the edges of a line."""

BAD_WHEN_SMALL: Final = ("stroke", "skin_on", "skin_off", "contrast")
"""Numbers of a line, by their last parts, whose worst value is the least."""


def last_part(quantity: Quantity) -> str:
    """The last part of the name of a line's number."""
    return quantity.name.partition(".")[2]


LINE_COUNTS: Final = _of("lines")
"""Counts of the evaluation of a scan."""

SPEED: Final = _of("speed")
"""Quantities of the search for the largest hand speed."""

HAND_PATH: Final = _of("hand")
"""Numbers of the path of a hand that gives way to its pins."""

JUDGE: Final = LINE + LINE_COUNTS + SPEED + HAND_PATH
"""Results of scans and speeds."""

DESIGNED: Final = _of("design")
"""Numbers of a design beside the numbers of its motions and scans."""

"""The numbers that a study can keep of each motion or scan, and how a file holds them."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from pindrive.quantities import ENDING, ENERGY, QUANTITIES, TRANSIENT, refusal
from pindrive.study.scanned import COUNTED, SCANNED
from pindrive.units import quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from pindrive.config import DeviceFile
    from pindrive.quantity import Quantity


def variables(quantities: Iterable[Quantity]) -> dict[str, Quantity]:
    """Quantities by the names of their variables."""
    return {quantity.name.replace(".", "_"): quantity for quantity in quantities}


_OF_MOTIONS: Final = variables(TRANSIENT + ENDING + ENERGY)
_OF_SCANS: Final = variables(SCANNED)
NUMBERS: Final[dict[str, Quantity]] = _OF_MOTIONS | _OF_SCANS
"""By the names of their variables."""
OUTPUTS: Final = (*_OF_MOTIONS, "status", "ending", "events")
"""Of a motion."""
SCAN_OUTPUTS: Final = (*_OF_SCANS, "status")
"""Of a scan."""

LEDGER: Final = tuple(variables(ENERGY))
"""The terms of the energy ledger: they take long, and are kept where a study names them."""

_SKIN: Final = ("transient_peak_stretch", "transient_peak_stretch_rate")
_COUNTS: Final = (
    *("transient_plate_reversals", "transient_finger_reversals"),
    *(name.replace(".", "_") for name in COUNTED),
)
_SETTLED: Final = "transient_settled"

MEASURED: Final = tuple(name for name in _OF_MOTIONS if name != _SETTLED)
"""Those of a motion that are numbers, not yes or no."""
SCAN_MEASURED: Final = tuple(_OF_SCANS)
"""Those of a scan: all."""


def is_measured(name: str) -> bool:
    """Whether a variable is a number, not a flag."""
    return name in NUMBERS and name != _SETTLED


def is_stepped(name: str) -> bool:
    """Whether a variable is a count, or a part of one: it has no values between."""
    return name in _COUNTS or name == "judged_shown_part"


def usual_outputs(
    device: DeviceFile, keys: set[str], among: Sequence[str] = OUTPUTS
) -> tuple[str, ...]:
    """All numbers that exist but the ledger's; the skin's only of a skin, the coil's likewise."""
    rigid = device.drive.finger.rigid and "finger.stiffness" not in keys
    coil = device.whole and device.whole.magnet.magnet().coil
    missing = (*LEDGER, *(_SKIN if rigid else ()), *(() if coil else ("coil_warming",)))
    return tuple(name for name in among if name not in missing)


def known_output(given: object, place: str, among: Sequence[str] = OUTPUTS) -> str:
    """The variable that a name means: its own, the table's, or the last part where unique.

    The last part alone of a median and a worst value is the median.

    Raises:
        ValueError: there is none, or more than one.
    """
    if not isinstance(given, str):
        raise ValueError(refusal("an output", "the name of a number", quoted(given), place))
    name = given.replace(".", "_")
    shorts = {full: full.partition("_")[2] for full in among if full in NUMBERS}
    found = [full for full in among if name in (full, shorts.get(full))]
    if found:
        return found[0]
    ends = [full for full in among if full.endswith(f"_{name}")]
    if len(ends) == 1:
        return ends[0]
    if ends:
        raise ValueError(f"{place}: {quoted(given)} may be {' or '.join(ends)}; give it in full")
    names = {short: short for short in shorts.values()} | {full: full for full in among}
    near = get_close_matches(name, names, 1)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(map(label, among))}"
    raise ValueError(f"{place}: unknown number {quoted(given)}; {hint}")


def dtype(name: str) -> np.dtype[Any]:
    """How a variable is held: counts and flags as whole numbers."""
    if name in ("status", "ending", _SETTLED):
        return np.dtype("<i1")
    return np.dtype("<i4" if name in _COUNTS or name == "events" else "<f8")


def encoded(name: str, values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Values as a file holds them; -1 for a count that does not exist."""
    if name in _COUNTS:
        values = np.where(np.isnan(values), -1.0, values)
    return np.ascontiguousarray(values, dtype(name))


def attributes(name: str) -> dict[str, Any]:
    """Unit and meaning of a number; xarray reads a missing count as NaN."""
    if name not in NUMBERS:
        return {}
    quantity = NUMBERS[name]
    found: dict[str, Any] = {"long_name": quantity.meaning}
    if quantity.symbol:
        found["symbol"] = quantity.symbol
    if quantity.unit:
        found["units"] = quantity.unit
    if name == _SETTLED:
        found["dtype"] = "bool"
    return found


def missing(name: str) -> int | None:
    """The value that stands for none."""
    return -1 if name in _COUNTS else None


def label(name: str) -> str:
    """A number as a table names it: "settling_time", "shown"; an ending's, a median in full."""
    head, _, tail = name.partition("_")
    return tail if head in ("transient", "judged") else name


def measured(name: str) -> Quantity:
    """The quantity that a variable holds, of an input or of a motion."""
    return NUMBERS[name] if name in NUMBERS else QUANTITIES[name]

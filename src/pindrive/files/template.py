"""How a device file is written: a usual value of each key, and all of them as a commented file."""

from __future__ import annotations

from dataclasses import replace
from textwrap import wrap
from typing import Final

from pindrive.quantities.device import READER
from pindrive.quantities.drive import COLUMNS, INPUTS
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.table import DEVICE_INPUTS, QUANTITIES

DRIVE: Final[dict[str, Quantity]] = {quantity.key: quantity for quantity in INPUTS}
"""The keys of a device file that describe the drive and its motion, in their order."""
WHOLE: Final[dict[str, Quantity]] = {quantity.key: quantity for quantity in DEVICE_INPUTS}
"""The keys that describe the whole device around it, in their order."""
NUMBERS: Final[dict[str, Quantity]] = DRIVE | WHOLE
"""The keys of a device file that hold a quantity."""

STUDY_KEYS: Final = (
    *("base", "set", "page", "outputs", "zip", "chunk"),
    *("axes", "sample", "tolerances", "specification"),
)
"""What stands at the top of a study file beside the tables of a device and the name."""
KEYS: Final = ("device.name", "device.description", *NUMBERS)
AROUND: Final = ("magnet", "control", "array", "scan", "judge")
ALONE: Final = ("device", "drive", "plate", "finger", "motion")
TABLES: Final = (*ALONE, *AROUND)


def usual(quantity: Quantity) -> str:
    """A usual value of `quantity` as text: "10 g"; of one that must be rows, their last."""
    return quantity.usual


def usual_rows(quantity: Quantity) -> str:
    """Its usual rows: [["0 ms", "60 mm/s"], ["40 ms", "0 mm/s"]]."""
    across = QUANTITIES[COLUMNS[quantity.rows_of][0]]
    rows = (f"[{_quoted(across, t)}, {_quoted(quantity, y)}]" for t, y in quantity.rows)
    return f"[{', '.join(rows)}]"


def line(quantity: Quantity) -> str:
    """A line of a device file: mass = "10 g"."""
    value = quantity.example if quantity.default is None else quantity.default
    written = usual_rows(quantity) if value is None else _quoted(quantity, value)
    return f"{quantity.key.partition('.')[2]} = {written}"


def _quoted(quantity: Quantity, value: float) -> str:
    written = quantity.written(value)
    return written if quantity.unit == "1" else f'"{written}"'


def template(whole: bool = False) -> str:
    """A commented device file with usual values, as `pindrive init` writes it.

    Args:
        whole: with the tables of the whole device, as `pindrive init --device` writes it.
    """
    lines = [
        "# A tactile device, for pindrive."
        if whole
        else "# A pin drive of a tactile mouse, for pindrive.",
        "# Every value is written with its unit; the bounds below are in SI units.",
        "",
        "[device]",
        'name = "my tactile device"' if whole else 'name = "my pin drive"',
        '# description = "what is special about it"',
    ]
    table = "device"
    for key, usual_one in (NUMBERS if whole else DRIVE).items():
        quantity = replace(usual_one, **READER.get(key, {})) if whole else usual_one
        if key.partition(".")[0] != table:
            table = key.partition(".")[0]
            lines += ["", f"[{table}]"]
        unit = "" if quantity.unit == "1" else quantity.unit
        bounds = quantity.bounds.words(unit)
        lines.append(f"# {quantity.symbol}: {quantity.meaning}")
        follows = f"keeps its ratio to {' over '.join(quantity.follows)} where it is not set itself"
        said = (bounds, quantity.unless_given, quantity.remark, follows if quantity.follows else "")
        lines += [f"#   {text}" for text in wrap("; ".join(filter(None, said)), 94)]
        lines += [f"#   {text}" for text in wrap(quantity.source, 94)]
        lines.append(("# " if quantity.default is None else "") + line(quantity))
        if quantity.rows and quantity.may_be_constant:
            lines.append(f"# {key.partition('.')[2]} = {usual_rows(quantity)}")
    return "\n".join(lines) + "\n"

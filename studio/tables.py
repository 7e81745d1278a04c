"""Writes what the page knows of quantities, units, keys and colours as JSON, from their tables.

python studio/tables.py FILE
"""

from __future__ import annotations

import json
import sys
from decimal import Decimal
from math import inf, isfinite
from pathlib import Path
from typing import Any

import pint

from pindrive import __version__
from pindrive.files.keys import (
    ALONE,
    AROUND,
    DRIVE,
    FILE_KEYS,
    KEYS,
    STUDY_KEYS,
    TABLES,
    line,
    template,
    usual_rows,
)
from pindrive.motion.friction import COEFFICIENT_OF, GRAVITY, PRESSED_BY
from pindrive.motion.release import INPUTS
from pindrive.plot.style import CURVES, EVENT_SHAPE, PALETTE, SIGNS, event_name
from pindrive.quantities import budgets
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.functions import EXAMPLES_OF, FUNCTIONS, FUNCTIONS_OF, OWN_UNIT
from pindrive.quantities.names import OTHER_WORDS
from pindrive.quantities.quantity import Bounds, Quantity
from pindrive.quantities.results import CHANNELS, MOTION, OUTPUTS
from pindrive.quantities.table import QUANTITIES
from pindrive.quantities.units import DEFINITIONS

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
RECORDINGS = ("release-recording.csv", "skin-recording.csv")
PARTS = [name for pair in COLUMNS.values() for name in pair]
"""Quantities of a drive's parts in its rows."""
UNITS = {"1": "", OWN_UNIT: "{unit}"}
"""Words of units; the page has that of the input for a parameter of a function."""


def brief(fields: dict[str, Any]) -> dict[str, Any]:
    """Without the fields that say nothing; the page takes a field that is missing as empty."""
    said = {name: value for name, value in fields.items() if value is not None}
    return {name: value for name, value in said.items() if isinstance(value, float) or value}


def number(value: float | None) -> float | None:
    """A number that JSON has; no number where it is infinite."""
    return value if value is not None and isfinite(value) else None


def bounds(quantity: Quantity, of: Bounds) -> dict[str, Any]:
    """An interval, and how it reads; an end that is missing is infinite."""
    return brief(
        {
            "lower": number(of.lower),
            "upper": number(of.upper),
            "lowerClosed": of.lower_closed,
            "upperClosed": of.upper_closed,
            "infinite": of.also == inf,
            "zero": of.also == 0.0,
            "words": of.words(UNITS.get(quantity.unit, quantity.unit)),
        }
    )


def row(quantity: Quantity, explained: bool = True) -> dict[str, Any]:
    """What every row of the table has."""
    return brief(
        {
            "key": quantity.key,
            "name": quantity.name,
            "symbol": quantity.symbol,
            "unit": quantity.unit,
            "displayUnit": quantity.display_unit,
            "displayScale": quantity.display_scale,
            "meaning": quantity.meaning if explained else "",
        }
    )


def column(quantity: Quantity) -> dict[str, Any]:
    """A row of what is known over time."""
    return row(quantity) | {"heading": quantity.heading}


def checked(quantity: Quantity) -> dict[str, Any]:
    """A row whose values are read from text, and checked."""
    of_drive = quantity.key in DRIVE
    return row(quantity, of_drive) | brief(
        {
            "bounds": [bounds(quantity, of) for of in (quantity.bounds, quantity.limits)],
            "choices": quantity.choices,
            "seen": [quantity.seen.lower, quantity.seen.upper] if quantity.seen else None,
            "default": quantity.default,
            "absent": quantity.absent,
            "example": quantity.example,
            "remark": quantity.remark if of_drive else "",
            "source": quantity.source if of_drive else "",
            "mandatory": quantity.mandatory,
            "alternative": quantity.alternative,
            "follows": quantity.follows,
            "rowsOf": quantity.rows_of,
            "rows": quantity.rows,
            "mayBeConstant": quantity.may_be_constant,
            "usual": quantity.usual,
            "usualRows": usual_rows(quantity) if quantity.rows else "",
            "line": line(quantity) if quantity.key in FILE_KEYS else "",
        }
    )


def dashes(style: Any) -> list[float]:
    """The dashes of a line of Matplotlib's; none of one drawn through."""
    return [] if style == "-" else [2.0 * length for length in style[1]]


def units() -> dict[str, Any]:
    """Each unit, and each prefix, that a value may be written in: its factor and its dimension."""
    registry: pint.UnitRegistry[Decimal] = pint.UnitRegistry(None, non_int_type=Decimal)
    definitions = DEFINITIONS.strip().splitlines()
    registry.load_definitions(definitions)
    atoms, prefixes = {}, {}
    for definition in definitions:
        first, meaning, *more = (part.strip() for part in definition.split("="))
        for name in (first, *more):
            if name.endswith("-"):
                prefixes[name[:-1]] = str(Decimal(meaning))
            else:
                one = registry.Quantity(Decimal(1), name).to_root_units()
                # The root unit of mass is the gram here: SI counts kilograms.
                powers = {str(base): int(str(power)) for base, power in one.unit_items()}
                found = {base: power for base, power in powers.items() if base != "radian"}
                factor = Decimal(one.magnitude) / Decimal(1000) ** found.get("gram", 0)
                atoms[name] = [str(factor), found]
    return {"atoms": atoms, "prefixes": prefixes}


def tables() -> dict[str, Any]:
    """All that the page knows."""
    return {
        "version": __version__,
        "inputs": [checked(quantity) for quantity in FILE_KEYS.values()],
        "drive": [*DRIVE],
        "parts": {name: checked(QUANTITIES[name]) for name in PARTS},
        "columns": COLUMNS,
        "numbers": [row(quantity) for quantity in OUTPUTS],
        "series": [column(quantity) for quantity in MOTION],
        "channels": [column(quantity) for quantity in CHANNELS.values()],
        "keys": KEYS,
        "variables": {key: quantity.variable for key, quantity in FILE_KEYS.items()},
        "otherWords": OTHER_WORDS,
        "tables": TABLES,
        "alone": ALONE,
        "around": AROUND,
        "coefficients": COEFFICIENT_OF,
        "pressedBy": {
            contact: [QUANTITIES[name].key for name in names]
            for contact, names in PRESSED_BY.items()
        },
        "gravity": GRAVITY,
        "functions": {
            kind: [checked(parameter) for parameter in parameters]
            for kind, parameters in FUNCTIONS.items()
        },
        "functionsOf": FUNCTIONS_OF,
        "functionExamples": EXAMPLES_OF,
        "overTime": INPUTS,
        "studyKeys": STUDY_KEYS,
        "inputRows": budgets.INPUT_ROWS.most,
        "units": units(),
        "palette": PALETTE,
        "shapes": EVENT_SHAPE,
        "curves": [{"color": look["color"], "dash": dashes(look["ls"])} for look in CURVES],
        "events": {
            kind: {contact: event_name(kind, contact) for k, contact in SIGNS if k == kind}
            for kind in EVENT_SHAPE
        },
        "template": template(),
        "reader": without_remarks((EXAMPLES / "tactile-reader.toml").read_text("utf-8")),
        "recordings": {
            name: without_remarks((EXAMPLES / name).read_text("utf-8")) for name in RECORDINGS
        },
    }


def without_remarks(text: str) -> str:
    """A file without its comments."""
    kept = [line for line in text.splitlines() if not line.startswith("#")]
    return "\n".join(kept).strip() + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(
        json.dumps(tables(), ensure_ascii=False, allow_nan=False, separators=(",", ":")) + "\n",
        encoding="utf-8",
    )

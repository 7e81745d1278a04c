"""The tables of a device file: which keys they have, in which units, and what fits together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf
from typing import Any, ClassVar, cast

from pydantic import BaseModel, StrictStr, ValidationInfo, field_validator, model_validator

from pindrive.files.template import NUMBERS, usual, usual_rows
from pindrive.motion.drive import (
    Contact,
    Profile,
    check_curve,
    check_increasing,
    check_load,
    check_skin,
    check_slopes,
    check_static,
    check_stretch,
    check_times,
)
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import Quantity, Rows
from pindrive.quantities.table import QUANTITIES, check, refusal
from pindrive.quantities.units import UnitError, quoted, to_si

Place = Callable[..., str]
"""Where keys were written: on the command line if one of them was, else in the file."""


class Table(BaseModel):
    """A table of the file. The context of its validation maps a key to the place it was written."""

    table: ClassVar[str]

    @field_validator("*", mode="before")
    @classmethod
    def _in_si(cls, value: object, info: ValidationInfo) -> object:
        key = f"{cls.table}.{info.field_name}"
        if key not in NUMBERS or value is None:
            return value
        quantity, place = NUMBERS[key], cast(Place, info.context)(key)
        if quantity.rows and (isinstance(value, list | tuple) or not quantity.may_be_constant):
            return _rows(value, quantity, key, place)
        return number(value, quantity, usual(quantity), key, place)


def number(value: object, quantity: Quantity, example: str, label: str, place: str) -> float:
    """What TOML gave, in SI: text with a unit, or a bare number where the quantity has no unit."""
    bare = isinstance(value, (int, float)) and not isinstance(value, bool)
    text = value if isinstance(value, str) else repr(value) if bare else ""
    try:
        si = to_si(text, quantity.unit, example)
    except UnitError as error:
        raise ValueError(refusal(label, str(error), quoted(value), place)) from None
    return check(quantity.name, si, where=place, label=label, given=quoted(value))


def _rows(value: object, quantity: Quantity, key: str, place: str) -> Rows:
    """Rows in SI, each checked and in order; a mistake is said with its row, counted from 0."""
    if isinstance(value, tuple):  # read from a file of their own, and checked there
        return value
    across, along = (QUANTITIES[name] for name in COLUMNS[quantity.rows_of])
    words = [column.name.rpartition(".")[2] for column in (across, along)]
    examples = across.written(quantity.rows[-1][0]), quantity.written(quantity.rows[-1][1])
    if not isinstance(value, list) or not value:
        raise ValueError(refusal(key, f"rows, like {usual_rows(quantity)}", quoted(value), place))
    rows = []
    for i, row in enumerate(value):
        if not isinstance(row, list) or len(row) != 2:
            required = f"a {words[0]} and a {words[1]}, like {', '.join(map(quoted, examples))}"
            raise ValueError(refusal(f"{key}[{i}]", required, quoted(row), place))
        rows.append(
            (
                number(row[0], across, examples[0], f"{key}[{i}] {words[0]}", place),
                number(row[1], quantity, examples[1], f"{key}[{i}] {words[1]}", place),
            )
        )
    if quantity.rows_of == "places":
        return tuple(rows)
    label = f"{key}[{{}}] {words[0]}"
    firsts = [first for first, _ in rows]
    if quantity.rows_of == "curve":
        check_increasing(firsts, across.unit, where=place, label=label)
        check_slopes(rows, "curve.slope", where=place, label=key)
    else:
        no_step = " (a jump would take an infinite force)" if key == "motion.mouse_velocity" else ""
        check_times(firsts, where=place, label=label, steps=not no_step, why=no_step)
        check_slopes(rows, "profile.rate", where=place, label=key)
    return tuple(rows)


class _Device(Table):
    table = "device"
    name: StrictStr = ""
    description: StrictStr = ""


class _Drive(Table):
    table = "drive"
    mass: float
    stiffness: float
    damping: float | None = None
    damping_ratio: float | None = None


class _Contact(Table):
    kinetic: float | None
    static: float | None = None
    curve: Rows | None = None

    @model_validator(mode="before")
    @classmethod
    def _curve_says_kinetic(cls, data: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"kinetic": None, **data} if "curve" in data else data

    @model_validator(mode="after")
    def _fits(self, info: ValidationInfo) -> _Contact:
        place, table = cast(Place, info.context), self.table
        keys = [f"{table}.{name}" for name in ("curve", "kinetic", "static")]
        if self.curve:
            at_rest = self.curve[0][1] if self.kinetic is None else self.kinetic
            check_curve(self.curve, at_rest, where=place(*keys[:2]), label=keys[0])
            self.kinetic = at_rest
        if self.static is not None and self.kinetic is not None:
            check_static(
                self.static, self.kinetic, where=place(*reversed(keys)), label=f"{table}.static"
            )
        return self

    def contact(self) -> Contact:
        """What it describes."""
        return Contact(self.kinetic, self.static, self.curve, getattr(self, "stiffness", inf))


class _Plate(_Contact):
    table = "plate"


class _Finger(_Contact):
    table = "finger"
    stiffness: float = inf


class _Motion(Table):
    table = "motion"
    mouse_velocity: float | Rows
    plate_load: float | Rows = 1.0
    displacement: float = 0.0
    velocity: float | None = None
    skin_stretch: float | None = None
    duration: float | None = None
    settling_band: float = QUANTITIES["settling_band"].default or 0.0


class Schema(BaseModel):
    """A device file whose every value is in range."""

    device: _Device
    drive: _Drive
    plate: _Plate
    finger: _Finger
    motion: _Motion

    def conflicts(self, place: Place) -> list[str]:
        """What does not fit together between its tables."""
        plate, finger = self.plate.contact(), self.finger.contact()
        load, stretch = over_time(self.motion.plate_load), self.motion.skin_stretch
        problems = []

        def say(check: Callable[..., None], *values: object, keys: tuple[str, ...]) -> None:
            try:
                check(*values, where=place(*keys), label=keys[0])
            except ValueError as error:
                problems.append(error.args[0])

        say(check_skin, finger, keys=("finger.curve", "finger.stiffness"))
        say(check_load, plate, load, keys=("motion.plate_load", "plate.curve"))
        if stretch is not None:
            say(check_stretch, stretch, finger, keys=("motion.skin_stretch", "finger.stiffness"))
        return problems


def over_time(value: float | Rows) -> float | Profile:
    """A constant, or rows (time, value) as a profile."""
    return value if isinstance(value, float) else Profile(*zip(*value, strict=True))

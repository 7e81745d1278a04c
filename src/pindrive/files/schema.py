"""The tables of a device file: which keys they have, in which units, and what fits together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf
from typing import Any, ClassVar, cast

from pydantic import (
    BaseModel,
    StrictStr,
    ValidationInfo,
    field_validator,
    model_validator,
)

from pindrive.device.coil import COIL_MAY, COIL_NEEDS, Coil, check_one_way
from pindrive.device.controller import ControlBlock, check_band
from pindrive.device.device import Device, check_plate
from pindrive.device.electromagnet import Electromagnet
from pindrive.device.pin_array import PinArray, check_apart, check_count, check_pins
from pindrive.device.reading import Reading
from pindrive.evaluation.results import Criteria
from pindrive.files.template import NUMBERS, usual, usual_rows
from pindrive.motion.drive import (
    Contact,
    Drive,
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
        if quantity.rows and (isinstance(value, list) or not quantity.may_be_constant):
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
                problems.append(str(error))

        say(check_skin, finger, keys=("finger.curve", "finger.stiffness"))
        say(check_load, plate, load, keys=("motion.plate_load", "plate.curve"))
        if stretch is not None:
            say(check_stretch, stretch, finger, keys=("motion.skin_stretch", "finger.stiffness"))
        return problems


def over_time(value: float | Rows) -> float | Profile:
    """A constant, or rows (time, value) as a profile."""
    return value if isinstance(value, float) else Profile(*zip(*value, strict=True))


def _standard(name: str) -> Any:
    """What holds where a key is left out: the usual value."""
    return QUANTITIES[name].default


class _Magnet(Table):
    table = "magnet"
    hold_force: float | None = None
    rise_time: float | None = None
    fall_time: float | None = None
    saturation: float | None = None
    residual: float = _standard("residual")
    pressing: float | None = None
    deviation: float = _standard("deviation")
    turns: float | None = None
    pole_area: float | None = None
    gap: float | None = None
    wire_diameter: float | None = None
    turn_length: float | None = None
    supply_voltage: float | None = None
    release_resistance: float | None = None
    saturation_field: float | None = None
    thermal_resistance: float | None = None
    temperature_rise: float | None = None

    def magnet(self) -> Electromagnet:
        """What it describes: by how it is made where it says so, else by what it does."""
        given = {name: value for name, value in self if value is not None}
        coil = {name: given.pop(name) for name in (*COIL_NEEDS, *COIL_MAY) if name in given}
        if coil:
            return Electromagnet.from_coil(Coil(**coil), **given)
        return Electromagnet.from_times(**given)


class _Control(Table):
    table = "control"
    sample_rate: float = _standard("sample_rate")
    latency: float = _standard("latency")
    threshold: float = _standard("threshold")
    hysteresis: float = _standard("hysteresis")


class _Array(Table):
    table = "array"
    alone: ClassVar = ("columns", "rows", "pitch")
    columns: float = 1.0
    rows: float = 1.0
    pitch: float = _standard("pitch")
    pin_diameter: float = _standard("pin_diameter")
    places: Rows | None = None
    spot_scale: float = _standard("spot_scale")
    axis: float = _standard("axis")

    def array(self) -> PinArray:
        """What it describes: pins at given places, or a grid."""
        how = {name: getattr(self, name) for name in ("spot_scale", "axis", "pin_diameter")}
        if self.places is not None:
            return PinArray.at(self.places, **how)
        return PinArray.grid(self.columns, self.rows, self.pitch, **how)


class _Scan(Table):
    table = "scan"
    hand_speed: float = _standard("hand_speed")
    return_speed: float = _standard("return_speed")
    pause: float = _standard("pause")
    line_pitch: float | None = None
    text_height: float = _standard("text_height")
    pixel: float | None = None
    max_angle: float = _standard("max_angle")
    hand_acceleration: float = _standard("hand_acceleration")
    path_deviation: float = _standard("path_deviation")


class _Judge(Table):
    table = "judge"
    felt: float = _standard("felt")
    direction: float = _standard("direction")
    direction_sure: float = _standard("direction_sure")
    direction_speed: float = _standard("direction_speed")
    echo: float = _standard("echo")


class Whole(BaseModel):
    """The tables of the whole device, every value in range."""

    magnet: _Magnet
    control: _Control
    array: _Array
    scan: _Scan
    judge: _Judge

    def device(self, drive: Drive) -> Device:
        """The whole device about a drive."""
        return Device(
            drive=drive,
            magnet=self.magnet.magnet(),
            control=ControlBlock(**dict(self.control)),
            array=self.array.array(),
        )

    def reading(self) -> Reading:
        """How a hand reads with it."""
        return Reading(**dict(self.scan))

    def criteria(self) -> Criteria:
        """What counts as felt."""
        return Criteria(**dict(self.judge))

    def value(self, key: str) -> float | Rows | None:
        """The value of a key, SI, given or not; None where nothing was given and nothing holds."""
        table, _, name = key.partition(".")
        value: float | Rows | None = getattr(getattr(self, table), name)
        if table == "magnet" and value is None:
            magnet = self.magnet.magnet()
            made = magnet.coil if name in (*COIL_NEEDS, *COIL_MAY) else magnet
            return None if made is None else getattr(made, name)
        return None if name in _Array.alone and self.array.places is not None else value

    def conflicts(self, schema: Schema, given: Mapping[str, Any], place: Place) -> list[str]:
        """What does not fit together; `given` is the file's tables."""
        problems: list[str] = []

        def say(check: Callable[..., object], *values: object, keys: tuple[str, ...]) -> None:
            try:
                check(*values, where=place(*keys), label=keys[0])
            except ValueError as error:
                problems.append(str(error))

        say(check_plate, schema.plate.contact(), keys=("plate", "plate.curve", "plate.kinetic"))
        keys = tuple(f"magnet.{name}" for name in given["magnet"]) or ("magnet",)
        say(self.check_magnet, set(given["magnet"]), keys=keys)
        band = self.control.threshold, self.control.hysteresis
        say(check_band, *band, keys=("control.hysteresis", "control.threshold"))
        if self.array.places is not None:
            say(self.check_alone, given["array"], keys=("array.places",))
            say(check_apart, self.array.places, keys=("array.places",))
        for name in ("columns", "rows"):
            count = getattr(self.array, name)
            say(check_count, name, count, keys=(f"array.{name}",))
        size = self.array.columns, self.array.rows
        say(check_pins, *size, keys=("array.columns", "array.rows"))
        return problems

    def check_magnet(self, given: set[str], *, where: str, label: str) -> None:
        """Refuse a magnet described by two ways or by half of one, or one that cannot be."""
        check_one_way(given, where=where, table="magnet")
        try:
            self.magnet.magnet()
        except ValueError as error:
            raise ValueError(f"{where}: {error}") from None

    def check_alone(self, given: Mapping[str, Any], *, where: str, label: str) -> None:
        """Refuse a grid beside places."""
        for name in _Array.alone:
            if name in given:
                required = "left out where columns, rows or pitch are given"
                raise ValueError(refusal(label, required, f"it beside array.{name}", where))

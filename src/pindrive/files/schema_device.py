"""The tables of a device file that describe the whole device around the drive.

Imported only where such a device is wanted: it takes NumPy.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from pydantic import BaseModel

from pindrive.device.coil import COIL_MAY, COIL_NEEDS, Coil, check_one_way
from pindrive.device.controller import ControlBlock, check_band
from pindrive.device.device import Device, check_plate
from pindrive.device.electromagnet import Electromagnet
from pindrive.device.pin_array import PinArray, check_apart, check_count, check_pins
from pindrive.device.reading import Reading
from pindrive.evaluation.results import Criteria
from pindrive.files.schema import Place, Schema, Table
from pindrive.motion.drive import Drive
from pindrive.quantities.quantity import Rows
from pindrive.quantities.table import QUANTITIES, refusal


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
    mouse_resolution: float = _standard("mouse_resolution")
    smoothing_cutoff: float = _standard("smoothing_cutoff")
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

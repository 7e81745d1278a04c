"""The whole device that the tables around the drive describe, and how a hand reads with it.

Imported only where such a device is wanted: it takes NumPy.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from pindrive.device.controller import ControlBlock, check_band
from pindrive.device.device import Device, check_plate
from pindrive.device.electromagnet import (
    COIL,
    COIL_NEEDS,
    DIRECT,
    Coil,
    Electromagnet,
    check_one_way,
)
from pindrive.device.pin_array import PinArray, check_apart, check_count, check_pins
from pindrive.device.reading import Reading
from pindrive.evaluation.results import Criteria
from pindrive.files.schema import Place, Problems, Value, contact_of, table_of
from pindrive.motion.drive import Drive
from pindrive.quantities.table import refusal

_GRID: Final = ("columns", "rows", "pitch")


@dataclass(frozen=True, slots=True)
class Whole:
    """The values of the tables of the whole device, each in range."""

    values: Mapping[str, Value]

    def magnet(self) -> Electromagnet:
        """The electromagnet: by how it is made where the file says so, else by what it does."""
        given = table_of(self.values, "magnet")
        coil = {name: given.pop(name) for name in COIL}
        if all(coil[name] is None for name in COIL_NEEDS):
            return Electromagnet.from_times(**given)
        around = {name: value for name, value in given.items() if name not in DIRECT}
        return Electromagnet.from_coil(Coil(**coil), **around)

    def array(self) -> PinArray:
        """The pins: at given places, or a grid."""
        given = table_of(self.values, "array")
        grid, places = {name: given.pop(name) for name in _GRID}, given.pop("places")
        return PinArray.grid(**grid, **given) if places is None else PinArray.at(places, **given)

    def device(self, drive: Drive) -> Device:
        """The whole device about a drive."""
        control = ControlBlock(**table_of(self.values, "control"))
        return Device(drive=drive, magnet=self.magnet(), control=control, array=self.array())

    def reading(self) -> Reading:
        """How a hand reads with it."""
        return Reading(**table_of(self.values, "scan"))

    def criteria(self) -> Criteria:
        """What counts as felt."""
        return Criteria(**table_of(self.values, "judge"))

    def value(self, key: str) -> Value:
        """The value of a key, SI, given or not; None where nothing was given and nothing holds."""
        table, _, name = key.partition(".")
        value = self.values[key]
        if table == "magnet" and name in (*COIL, *DIRECT):
            magnet = self.magnet()
            if name in COIL:
                return None if magnet.coil is None else getattr(magnet.coil, name)
            return value if magnet.coil is None else getattr(magnet, name)
        return None if name in _GRID and self.values["array.places"] is not None else value

    def problems(self, given: dict[str, Any], place: Place) -> list[str]:
        """What does not fit together; `given` is the file's tables."""
        values, problems = self.values, Problems(place)
        plate_keys = ("plate", "plate.curve", "plate.kinetic")
        problems.check(check_plate, contact_of(values, "plate"), keys=plate_keys)
        magnet_keys = tuple(f"magnet.{name}" for name in given["magnet"]) or ("magnet",)
        problems.check(self._check_magnet, set(given["magnet"]), keys=magnet_keys)
        band = values["control.threshold"], values["control.hysteresis"]
        problems.check(check_band, *band, keys=("control.hysteresis", "control.threshold"))
        if (places := values["array.places"]) is not None:
            problems.check(_check_no_grid, given["array"], keys=("array.places",))
            problems.check(check_apart, places, keys=("array.places",))
        counts = "array.columns", "array.rows"
        for key in counts:
            problems.check(check_count, key.partition(".")[2], values[key], keys=(key,))
        problems.check(check_pins, *(values[key] for key in counts), keys=counts)
        return problems

    def _check_magnet(self, given: set[str], *, where: str, label: str) -> None:
        """Refuse a magnet described by two ways or by half of one, or one that cannot be."""
        check_one_way(given, where=where, table="magnet")
        try:
            self.magnet()
        except ValueError as error:
            raise ValueError(f"{where}: {error}") from None


def _check_no_grid(given: dict[str, Any], *, where: str, label: str) -> None:
    """Refuse a grid beside places."""
    for name in _GRID:
        if name in given:
            required = "left out where columns, rows or pitch are given"
            raise ValueError(refusal(label, required, f"it beside array.{name}", where))

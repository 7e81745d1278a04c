"""An electromagnet by its data sheet: its winding, and the pull at a current."""

from __future__ import annotations

from dataclasses import replace
from math import exp
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from command import run
from pindrive.device import Coil, DataSheet, Electromagnet
from pindrive.files import load_device
from pindrive.files.keys import template

SHEET = DataSheet(hold_force=1.0, resistance=25.0, inductance=0.025, supply_voltage=5.0)
GIVEN = 'hold_force = "1 N"\nresistance = "25 ohm"\ninductance = "25 mH"\nsupply_voltage = "5 V"\n'


def test_rise_and_fall_follow_from_the_winding() -> None:
    magnet = Electromagnet.from_coil(replace(SHEET, release_resistance=75.0))
    assert (magnet.rise_constant, magnet.fall_constant) == (1e-3, 0.25e-3)
    assert magnet.coil is not None
    assert (magnet.coil.current, magnet.coil.power) == (0.2, 1.0)
    share = (1.0 - exp(-magnet.rise_time / 1e-3)) ** 2
    assert share == pytest.approx(0.9, rel=1e-14)


def test_the_pull_grows_with_the_square_of_the_current() -> None:
    for current, pull in ((0.2, 1.0), (0.1, 4.0), (0.4, 0.25)):
        magnet = Electromagnet.from_coil(replace(SHEET, hold_current=current))
        assert magnet.hold_force == pytest.approx(pull, rel=1e-15)


def test_it_is_the_coil_of_which_it_is_the_data_sheet() -> None:
    coil = Coil(
        turns=250,
        pole_area=3e-6,
        gap=5e-5,
        wire_diameter=1e-4,
        turn_length=0.0085,
        supply_voltage=1.0,
        heat_capacity=0.42,
    )
    sheet = DataSheet(
        hold_force=coil.pull,
        resistance=coil.resistance,
        inductance=coil.inductance,
        supply_voltage=1.0,
        saturation=coil.saturation,
        heat_capacity=0.42,
    )
    one, other = (Electromagnet.from_coil(each) for each in (coil, sheet))
    assert np.asarray(one.core_numbers[0]) == pytest.approx(other.core_numbers[0], rel=1e-14)
    assert (coil.duty, coil.heat) == (sheet.duty, sheet.heat)


def whole(lines: str) -> str:
    """The template of a whole device with these lines of the magnet."""
    text = template(whole=True)
    for name in ("hold_force", "rise_time", "fall_time", "saturation", "residual"):
        text = "\n".join(line for line in text.splitlines() if not line.startswith(f"{name} ="))
    return text.replace("[magnet]\n", f"[magnet]\n{lines}")


def test_a_file_has_it(tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text(whole(GIVEN), "utf-8")
    file = load_device(path, whole=True)
    values: dict[str, Any] = {**file.values()}
    sizes = ("outer_diameter", "height", "spring_height", "pin_height")
    given = {name: values[f"magnet.{name}"] for name in sizes}
    assert file.device.magnet == Electromagnet.from_coil(SHEET, **given)
    assert values["magnet.rise_time"] == pytest.approx(2.96974e-3, rel=1e-5)
    assert (values["magnet.resistance"], values["magnet.turns"]) == (25.0, None)
    checked = run("check", path)
    assert checked.exit_code == 0, checked.output
    assert "25.00 ohm" in checked.stdout


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            GIVEN + "turns = 200",
            "magnet.turns must be left out where resistance is that of a data ",
        ),
        (GIVEN + 'rise_time = "3 ms"', "magnet.rise_time must be left out where resistance is tha"),
        (GIVEN + 'lift = "10 um"', "magnet.lift must be left out where resistance is that of a da"),
        (
            'resistance = "25 ohm"\nhold_force = "1 N"',
            "magnet.resistance must be given with inductance, supply_voltage, got resistance, "
            "hold_force alone",
        ),
        ('hold_current = "1 A"', "magnet.hold_current must be given with resistance, inductance, "),
        (GIVEN + 'residual = "2 N"', "magnet.residual must be less than the hold force, 1.0 N"),
        (GIVEN + 'voltage = [["0 ms", "6 V"]]', "from 0 V to the supply voltage, 5.0 V"),
        (
            GIVEN.replace("25 ohm", "1e-9 ohm"),
            "magnet.resistance must be finite and at least",
        ),
    ],
)
def test_what_contradicts_it_is_one_line(tmp_path: Path, lines: str, message: str) -> None:
    path = tmp_path / "device.toml"
    path.write_text(whole(lines + "\n"), "utf-8")
    checked = run("check", path)
    assert checked.exit_code == 2
    assert message in checked.stderr
    assert len(checked.stderr.splitlines()) == 1

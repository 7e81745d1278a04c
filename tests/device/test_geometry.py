"""Sizes: what cannot be built so, and what a scan says of magnets that meet and slots that end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import hypot, pi, sqrt
from pathlib import Path
from random import Random

import numpy as np
import pytest
import xarray as xr

from command import GOOD, refused, run
from pindrive import Contact, Drive, load_device
from pindrive.device import Coil, Device, Electromagnet, PinArray, scan
from pindrive.device.coil import COIL_NEEDS
from pindrive.device.electromagnet import DIRECT
from pindrive.device.geometry import COPPER, doubts, nearest_pins, tipping
from pindrive.device.reading import Reading
from pindrive.evaluation import evaluate
from pindrive.files.keys import NUMERIC_KEYS, line, template
from pindrive.plot.scan import plot_reliefs, plot_scan
from pindrive.quantities.device import READER
from tactile_mouse import SKIN, drive

DRIVE = drive(SKIN)
WIDE = Electromagnet(hold_force=1.0, outer_diameter="8 mm", height="24 mm")


def device(magnet: Electromagnet = WIDE, pitch: float = 0.010, slot: float | None = None) -> Device:
    return Device(drive=DRIVE, magnet=magnet, array=PinArray.grid(2, 1, pitch, slot_length=slot))


# ---- what cannot be built ------------------------------------------------------------------------


def test_nearest_pins_are_those_of_all_pairs() -> None:
    random = Random(5)
    for count in (2, 3, 30):
        places = [(random.random(), random.random()) for _ in range(count)]
        pairs = [(i, j) for j in range(count) for i in range(j)]
        apart = [hypot(*np.subtract(places[i], places[j])) for i, j in pairs]
        best = int(np.argmin(apart))
        found = nearest_pins(places)
        assert found and found[:2] == pairs[best]
        assert found[2] == pytest.approx(apart[best])
    assert nearest_pins([(0.0, 0.0)]) is None


SOLID = COPPER * pi / 4.0 * 0.008**2 * 0.024


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (device(), []),
        (device(pitch=0.008), []),  # side by side, touching
        (
            device(pitch=0.0079),
            [
                "magnets cannot stand side by side: magnet.outer_diameter is 8.000 mm, and pins 0 "
                "and 1 are 7.900 mm apart"
            ],
        ),
        (device(slot=0.010), []),
        (
            device(slot=0.0101),
            [
                "slots overlap: array.slot_length is 10.10 mm, and pins 0 and 1 are 10.00 mm apart "
                "along the drive axis"
            ],
        ),
        (replace(device(), drive=replace(DRIVE, mass=SOLID)), []),
        (
            replace(device(), drive=replace(DRIVE, mass=1.001 * SOLID)),
            [
                "a magnet cannot be so heavy: drive.mass is 10.82 g, and a cylinder as wide and "
                "high as magnet.outer_diameter and magnet.height say weighs 10.81 g in solid copper"
            ],
        ),
        (device(Electromagnet(), pitch=0.001), []),  # sizes that are not known
        (replace(device(slot=0.0055), drive=replace(DRIVE, travel=0.002)), []),
        (
            replace(device(slot=0.0055), drive=replace(DRIVE, travel=0.0021)),
            [
                "end stops outside the slot: drive.travel is 2.100 mm either way, and in a slot "
                "(array.slot_length) of 5.500 mm a pin 1.500 mm wide (array.pin_diameter) has "
                "2.000 mm"
            ],
        ),
        (replace(device(), drive=replace(DRIVE, travel=0.5)), []),
    ],
)
def test_doubts(made: Device, words: list[str]) -> None:
    assert [*doubts(made)] == words


def reader(spring_height: str | None) -> Device:
    """The default device with its spring at a height."""
    magnet = Electromagnet.from_times(
        outer_diameter="3.5 mm", height="12.4 mm", spring_height=spring_height
    )
    body = Drive(
        mass="1 g",
        stiffness="250 N/m",
        damping_ratio=0.5,
        plate=Contact(coefficient=0.225, static_coefficient=0.27),
        finger=Contact(coefficient=0.5, static_coefficient=0.75),
        touch_force="60 mN",
    )
    return Device(drive=body, magnet=magnet)


def test_a_magnet_tips_over_its_edge() -> None:
    """The friction of the plate against spring and finger, by hand."""
    pressed = 1.0 + 0.060 + 0.001 * 9.80665
    held = 0.27 * pressed
    for height in (None, "4 mm"):
        moments = tipping(reader(height))
        assert moments
        at = 6.2e-3 if height is None else 4e-3
        assert moments.turns == pytest.approx((held - 0.045) * at + 0.045 * 12.4e-3, rel=1e-14)
        assert moments.stays == pytest.approx(1.75e-3 * pressed, rel=1e-14)
        assert moments.tips == (height is None)
    (tips,) = doubts(reader(None))
    assert tips.startswith("a magnet tips before it lets its pin go: spring (243.8 mN at magnet.sp")
    assert tips.endswith("turn it with 2.07 mN*m, and it stands with 1.87 mN*m")
    assert [*doubts(reader("4 mm"))] == []


def test_magnets_of_other_rows_come_as_close() -> None:
    """Pins that pass each other, and magnets of twice their width that do not."""
    array = PinArray([(0.0, 0.0), (0.004, 0.003)], pin_diameter=0.002)
    wide = Device(drive=DRIVE, magnet=Electromagnet(outer_diameter=0.004), array=array)
    assert array.neighbours == ()
    (pair,) = wide.magnet_neighbours
    assert pair.clearance == pytest.approx(0.004 - sqrt(0.004**2 - 0.003**2))
    assert [*doubts(wide)] == []


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: PinArray(pin_diameter=0.002, slot_length=0.001),
            "slot_length must be at least array.pin_diameter, 0.002 m, which moves in it, got "
            "0.001 m",
        ),
        (
            lambda: Electromagnet.from_coil(
                Coil(
                    turns=250,
                    pole_area=3e-6,
                    gap=5e-5,
                    wire_diameter=1e-4,
                    turn_length=0.0085,
                    supply_voltage=1.0,
                ),
                outer_diameter=0.0025,
            ),
            "pole_area must be at most half of the magnet's face, 2.45437e-06 m^2, as it has two "
            "poles, got 3e-06 m^2",
        ),
        (
            lambda: Electromagnet(outer_diameter=-0.003),
            "outer_diameter must be finite and at least 1e-6 m and at most 1 m, got -0.003 m",
        ),
    ],
)
def test_impossible_sizes_are_refused(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError) as error:
        make()
    assert str(error.value) == message


@pytest.mark.usefixtures("in_empty_folder")
def test_impossible_sizes_are_reported_in_one_line() -> None:
    Path("device.toml").write_text(GOOD + '\n[array]\nslot_length = "1 mm"\n')
    assert refused("check", "device.toml") == (
        "device.toml: array.slot_length must be at least array.pin_diameter, 0.0015 m, which moves "
        "in it, got 0.001 m"
    )


# ---- what check and scan say ---------------------------------------------------------------------

SIZES = """
[magnet]
outer_diameter = "6 mm"
height = "10 mm"
[array]
columns = 2
pitch = "6.5 mm"
slot_length = "5 mm"
"""


@pytest.mark.usefixtures("in_empty_folder")
def test_check_and_scan_report_misfits() -> None:
    Path("device.toml").write_text(GOOD + SIZES)
    heavy = "warning: a magnet cannot be so heavy: drive.mass is 10.00 g"
    checked = run("check", "device.toml")
    assert checked.exit_code == 0
    assert [line for line in checked.stderr.splitlines() if line.startswith(heavy)]
    said = " ".join(checked.stdout.split())
    assert "Neighbouring magnets have 0.5000 mm between them at rest, and can meet" in said
    assert "In its slot a pin has 1.750 mm either way, and can come to its ends" in said
    assert "density 35.4 g/cm3; that of iron is 7.87, of copper 8.96" in said
    scanned = run("scan", "device.toml", "--grating", "4 mm", "-o", "a.nc")
    assert scanned.exit_code == 0
    magnets, slot = (
        next(line for line in scanned.stderr.splitlines() if line.startswith(f"warning: {words}"))
        for words in ("magnets 0 and 1 overlap by ", "pin 1 goes ")
    )
    assert magnets.endswith("real magnets would push each other, these pass through")
    assert slot.endswith("beyond the end of its slot, 5 mm long: a real one would stop there")
    with xr.open_dataset("a.nc", engine="h5netcdf") as data:
        overlap, beyond = data.smallest_magnet_gap, data.slot_room
        assert overlap == float(data.magnet_gap[0]) < 0.0 < data.smallest_pin_gap
        assert overlap == pytest.approx(data.smallest_pin_gap - 0.0045)
        most = float(np.abs(data.position).max())
        assert beyond < 0.0 and -beyond == pytest.approx(most - 0.00175, abs=2e-5)
    assert f"Magnets overlap by up to {-1e3 * overlap:.4g}" in scanned.stdout
    assert f"Pin 1 would go {-1e3 * beyond:.4g}" in scanned.stdout


def test_picture_states_it() -> None:
    made = device(pitch=0.0082, slot=0.005)
    reading = Reading(hand_speed=0.1)
    scene = reading.grating([0.004], made.array)
    evaluated = evaluate(scan(made, scene, reading.strokes(scene, made.array)))
    gap, room = evaluated.scan.smallest_magnet_gap, evaluated.scan.slot_room
    assert gap and gap.size < 0.0 and room and room.size < 0.0
    title = plot_scan(evaluated).get_suptitle().splitlines()
    assert f"Magnets overlap by up to {-1e3 * gap.size:.4g}" in title[-2]
    assert title[-1].startswith(f"Pin {room.pin} would go {-1e3 * room.size:.4g}")
    relief = plot_reliefs([evaluated]).axes[1].get_title(loc="left")
    assert f"magnets overlap by {-1e3 * gap.size:.2g} mm" in relief


def test_the_device_that_is_written_can_be_built_with_end_stops_and_a_coil(tmp_path: Path) -> None:
    """As its comments have them."""
    given = replace(NUMERIC_KEYS["drive.travel"], **READER["drive.travel"])
    text = template(whole=True).replace(f"# {line(given)}", line(given))
    for key in COIL_NEEDS:
        row = line(NUMERIC_KEYS[f"magnet.{key}"])
        text = text.replace(f"# {row}", row)
    direct = [line(NUMERIC_KEYS[f"magnet.{name}"]) for name in DIRECT]
    text = "\n".join(row for row in text.splitlines() if row not in direct)
    file = tmp_path / "device.toml"
    file.write_text(text)
    made = load_device(file).device
    assert made.drive.travel == 0.0013
    assert made.magnet.coil is not None
    assert made.magnet.hold_force == pytest.approx(1.08, abs=0.005)
    assert list(doubts(made)) == []

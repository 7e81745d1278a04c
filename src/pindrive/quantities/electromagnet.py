"""The table of quantities, third part: the electromagnet.

Bounds are far outside of what any such magnet has, and such that nothing computed from values
within them overflows or vanishes.
"""

from __future__ import annotations

from typing import Final

from pindrive.quantities.quantity import SHARE, Quantity, between, inputs

MAGNET: Final = inputs(
    "magnet",
    Quantity(
        "hold_force",
        "P_h",
        "N",
        "pull of the energised electromagnet on the plate",
        1.0,
        "assumed: at a friction coefficient of 0.27 it carries a pin of 1 g 1 mm against 250 N/m",
        remark="follows from the coil if one is given",
    ),
    Quantity(
        "rise_time",
        "t_r",
        "s",
        "time from switching on to 90 % of the pull",
        0.003,
        "assumed: an L/R of 1 ms, twice that of the coil below",
        remark="follows from the coil if one is given",
    ),
    Quantity(
        "fall_time",
        "t_f",
        "s",
        "time from switching off to 10 % of the pull",
        0.005,
        "assumed: longer than the rise, as current dies away through a diode",
        remark="follows from the coil if one is given",
    ),
    Quantity(
        "saturation",
        "σ",
        "1",
        "part of the full current above which the iron is saturated and the pull constant",
        1.0,
        "assumed: a coil just strong enough",
        remark="follows from the coil if one is given",
    ),
    Quantity(
        "hold_current",
        "I_h",
        "A",
        "current at which the pull is hold_force; below, it falls with the square",
        source="assumed: a data sheet gives the pull at its rated current",
        example=0.2,
        remark="with resistance; the full current unless given",
    ),
    Quantity(
        "resistance",
        "R",
        "ohm",
        "resistance of the winding at 20 °C",
        source="assumed",
        example=25.0,
        remark="of a data sheet, in place of rise_time and fall_time; with inductance, "
        "supply_voltage, hold_force",
    ),
    Quantity(
        "inductance",
        "L",
        "H",
        "inductance of the coil on the plate",
        source="assumed: an L/R of 1 ms",
        example=0.025,
        remark="with resistance",
    ),
    Quantity(
        "residual",
        "P_r",
        "N",
        "pull that remains without current",
        0.0,
        "assumed: soft iron and a paint thick enough",
    ),
    Quantity(
        "pwm_frequency",
        "f_PWM",
        "Hz",
        "frequency of the pulses while the coil is on",
        source="assumed: such that the current follows by a part; beyond 20 kHz eddy currents in "
        "the iron decide, which are not simulated",
        example=500.0,
        remark="with pwm_duty; continuous current unless both are given",
    ),
    Quantity(
        "pwm_duty",
        "D",
        "1",
        "duty cycle of the pulses",
        source="assumed: a pull that holds with half of the current",
        example=0.5,
        remark="with pwm_frequency",
    ),
    Quantity(
        "outer_diameter",
        "d_e",
        "m",
        "diameter of the electromagnet, a cylinder",
        source="assumed: a pot of steel 0.3 mm thick about a winding 0.45 mm thick and a core 2 mm "
        "wide",
        example=0.0035,
        remark="without it, collisions of magnets are not checked",
    ),
    Quantity(
        "height",
        "H_e",
        "m",
        "height of the electromagnet",
        source="1 g at 8.4 g/cm3, between iron, 7.87, and copper, 8.96 (CRC Handbook)",
        example=0.0124,
        remark="diameter and height bound the mass",
    ),
    Quantity(
        "spring_height",
        "h_s",
        "m",
        "height above the plate at which the spring pulls on the electromagnet",
        source="assumed: the sleeve holds it at a third of its height, so that it does not tip",
        example=0.004,
        remark="half of the height unless given; with diameter and height, tipping is checked",
    ),
    Quantity(
        "pin_height",
        "h_p",
        "m",
        "height above the plate at which the finger rubs on the pin",
        source="assumed: on top of the electromagnet",
        example=0.0124,
        remark="the height of the electromagnet unless given",
    ),
)
"""The electromagnet by what it does."""

COIL: Final = inputs(
    "magnet",
    Quantity(
        "turns",
        "N",
        "1",
        "turns of the winding",
        source="assumed",
        example=250,
        remark="in place of hold_force, rise_time, fall_time, saturation; with pole_area, gap, "
        "wire_diameter, turn_length, supply_voltage",
    ),
    Quantity(
        "pole_area",
        "A",
        "m^2",
        "area of one of its two poles",
        source="assumed: a core 2 mm wide",
        example=3e-6,
    ),
    Quantity(
        "gap",
        "g",
        "m",
        "gap between each pole and the steel: paint, roughness",
        source="assumed: with the coil below it pulls with 1.08 N",
        example=5e-5,
    ),
    Quantity(
        "lift",
        "s",
        "m",
        "additional width of the gap under each pole while it is open",
        source="assumed: as much again as the gap",
        example=5e-5,
        remark="with closing_force; the gap stays closed unless both are given",
    ),
    Quantity(
        "closing_force",
        "F_c",
        "N",
        "pull above which the gap is closed, against suspension or pad",
        source="assumed: twice the weight of 1 g",
        example=0.02,
        remark="with lift",
    ),
    Quantity(
        "wire_diameter",
        "d",
        "m",
        "diameter of the copper in its wire",
        source="assumed: 250 turns fill 36 % of a winding 0.45 mm thick and 12 mm high",
        example=1e-4,
    ),
    Quantity(
        "turn_length",
        "l",
        "m",
        "mean length of a turn",
        source="assumed: round a core 2 mm wide",
        example=0.0085,
    ),
    Quantity(
        "supply_voltage",
        "U",
        "V",
        "voltage across the coil while it is on",
        source="assumed",
        example=1.0,
    ),
    Quantity(
        "voltage",
        "U(t)",
        "V",
        "voltage across the coil over the time since it was switched on; each row holds until the "
        "next",
        source="assumed: full voltage until the pull is there, then half of it",
        remark="rows or a CSV of them, at most supply_voltage, which holds throughout unless given",
        rows_of="steps",
        rows=((0.0, 1.0), (0.005, 0.5)),
    ),
    Quantity(
        "release_resistance",
        "R_d",
        "ohm",
        "additional resistance while the current decays",
        source="assumed: a diode alone, its voltage neglected",
        example=0.0,
    ),
    Quantity(
        "saturation_field",
        "B_s",
        "T",
        "field at which the iron saturates",
        source="iron, 1.5-2.1 T (handbook tables); the lower middle",
        example=1.6,
    ),
    Quantity(
        "thermal_resistance",
        "R_th",
        "K/W",
        "temperature rise of the electromagnet per watt",
        source="1.55 cm2 (a cylinder 3.5 mm wide, 12.4 mm high) in still air at 15 W/(m2 K), of "
        "2-25 (Incropera, table 1.1)",
        example=430.0,
    ),
    Quantity(
        "heat_capacity",
        "C_th",
        "J/K",
        "heat capacity of the electromagnet",
        source="1 g of copper, 0.385, and iron, 0.449 J/(g K) (CRC Handbook)",
        example=0.42,
        remark="simulates the temperature, from 20 °C on, with which the resistance grows",
    ),
    Quantity(
        "temperature_rise",
        "ΔT",
        "K",
        "allowed temperature rise",
        source="assumed: from 25 °C to 45 °C, for a finger stays on it",
        example=20.0,
    ),
)
"""The electromagnet by how it is made."""

MADE: Final[tuple[Quantity, ...]] = (
    Quantity(
        "coil.resistance",
        "R",
        "ohm",
        "resistance of the winding at 20 °C",
    ),
    Quantity(
        "coil.inductance",
        "L",
        "H",
        "inductance of the coil on the plate",
    ),
    Quantity("coil.current", "I", "A", "full current"),
    Quantity(
        "coil.field",
        "B",
        "T",
        "field in the gap at full current, without saturation",
    ),
    Quantity("coil.power", "P_el", "W", "power while it is on"),
    Quantity("coil.duty", "D_th", "1", "duty cycle at the allowed temperature rise", bounds=SHARE),
    Quantity(
        "rise_constant",
        "τ_r",
        "s",
        "time constant of the rising current",
        source="assumed: a third of rise_time",
        absent=0.001,
        bounds=between(1e-9, 1e6),
    ),
    Quantity(
        "fall_constant",
        "τ_f",
        "s",
        "time constant of the falling current",
        source="assumed: four fifths of fall_time",
        absent=0.004,
        bounds=between(1e-9, 1e6),
    ),
)
"""Quantities derived from the design of the magnet, with the time constants that replace its times.
"""

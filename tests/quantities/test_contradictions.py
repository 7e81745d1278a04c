"""Each rule between values of a device file, in its words, which all interfaces share."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from pindrive.quantities.contradictions import problems_of

GOOD: dict[str, Any] = {
    **{"drive.mass": 0.01, "drive.stiffness": 100.0, "drive.damping": 0.4},
    **{"plate.kinetic": 0.02, "finger.kinetic": 0.005},
}
COIL: dict[str, Any] = {
    **{"magnet.turns": 250.0, "magnet.pole_area": 3e-6, "magnet.gap": 1e-4},
    **{"magnet.wire_diameter": 1e-4, "magnet.turn_length": 0.01, "magnet.supply_voltage": 5.0},
}
FALLING: dict[str, Any] = {
    **{"plate.law": 1.0, "plate.breakaway": 0.03, "plate.stribeck_velocity": 0.03},
}
RULES: list[tuple[dict[str, Any], str]] = [
    # bounds and rows
    ({"drive.mass": -1.0}, "drive.mass must be finite and greater than 0 kg, got -1.0 kg"),
    ({"drive.mass": 1e13}, "drive.mass must be finite and at least 1e-12 kg and at most 1e12 kg, "
     "got 10000000000000.0 kg"),
    ({"plate.kinetic": None, "plate.curve": ((0.0, 0.02), (0.1, -1.0))},
     "plate.curve[1] force must be finite and at least 0 N, got -1.0 N"),
    ({"plate.curve": ((0.0, 0.02), (-0.1, 1.0))},
     "plate.curve[1] speed must be finite and at least 0 m/s and at most 1e12 m/s, got -0.1 m/s"),
    ({"plate.curve": ((0.0, 0.02), (0.1, 0.02), (0.1, 1.0))},
     "plate.curve[2] speed must be greater than the one before, 0.1 m/s, got 0.1 m/s"),
    ({"plate.curve": ((0.0, 0.02), (1e-300, 1.0))},
     "plate.curve slope must be finite and at least -1e12 N*s/m and at most 1e12 N*s/m, "
     "got 9.8e+299 N*s/m"),
    ({"motion.mouse_velocity": ((0.0, 1.0), (0.0, 2.0))},
     "motion.mouse_velocity[1] time must be greater than the one before, 0.0 s (a jump would take "
     "an infinite force), got 0.0 s"),
    ({"motion.force": ((1.0, 1.0), (0.0, 2.0))},
     "motion.force[1] time must be at least the one before, 1.0 s, got 0.0 s"),
    ({"motion.force": ((1.0, 1.0), (1.0, 2.0), (1.0, 3.0))},
     "motion.force[2] time must be greater than the one before, 1.0 s: two rows at one time are a "
     "step, a third is none, got 1.0 s"),
    # friction
    ({"plate.coefficient": 0.2}, "plate.coefficient must be left out where plate.kinetic gives the "
     "friction as a force, got both, plate.coefficient and plate.kinetic"),
    ({"plate.static": 0.01}, "plate.static must be at least the kinetic friction, 0.02 N, "
     "got 0.01 N"),
    ({"plate.curve": ((0.0, 0.03),)},
     "plate.curve[0] force must be the kinetic friction, 0.02 N, got 0.03 N"),
    ({"plate.curve": ((0.1, 0.02),)}, "plate.curve[0] speed must be 0 m/s, got 0.1 m/s"),
    ({"finger.touch_force": 0.1}, "finger.touch_force must be left out where the finger's "
     "friction is given as a force, got 0.1 N"),
    ({"finger.kinetic": "gone", "finger.coefficient": 0.5}, "finger.touch_force must be given "
     "where a coefficient gives the finger's friction, got none"),
    ({"plate.law": 0.5}, "plate.law must be 0, 1, 2 or 3, got 0.5"),
    (FALLING | {"plate.breakaway": "gone"},
     "plate.breakaway must be given under law stribeck, got none"),
    (FALLING | {"plate.law": 2.0, "plate.stribeck_velocity": "gone"},
     "plate.stribeck_velocity must be given under law hess-soom, got none"),
    ({"plate.breakaway": 0.03}, "plate.breakaway must be left out under law coulomb, got 0.03 N"),
    ({"plate.exponent": 1.0}, "plate.exponent must be left out under law coulomb, got 1.0"),
    (FALLING | {"plate.exponent": 1.5}, "plate.exponent must be 1 or 2, got 1.5"),
    (FALLING | {"plate.breakaway": 0.01},
     "plate.breakaway must be at least the kinetic friction, 0.02 N, got 0.01 N"),
    (FALLING | {"plate.static": 0.025},
     "plate.static must be at least the kinetic friction at rest, 0.03 N, got 0.025 N"),
    (FALLING | {"plate.curve": ((0.0, 0.02), (0.1, 0.01))},
     "plate.curve must be left out under law stribeck, got both"),
    ({"plate.law": 0.0, "plate.curve": ((0.0, 0.02), (0.1, 0.01))},
     "plate.curve must be left out under law coulomb, got both"),
    ({"plate.law": 3.0}, "plate.curve must be given under law table, got none"),
    ({"finger.law": 2.0, "finger.breakaway": 0.006, "finger.stribeck_velocity": 0.03,
      "finger.stiffness": 1e3},
     "finger.law must be coulomb or table on skin that stretches, got hess-soom"),
    (FALLING | {"plate.stribeck_velocity": 1e-12},
     "plate.stribeck_velocity must be such that friction falls at most with 1e6 times critical "
     "damping, got 1e+10 N*s/m"),
    ({"plate.viscous": 1e8},
     "plate.viscous must be at most 1e6 times critical damping, got 1e+08 N*s/m"),
    # drive and release
    ({"drive.stop_damping": 1.0},
     "drive.stop_damping must be left out without travel, as there are no end stops, "
     "got 1.0 N*s/m"),
    ({"drive.travel": 1e-3, "drive.stop_damping": 1.0}, "drive.stop_damping must be left out for "
     "rigid end stops; give stop_stiffness too, got 1.0 N*s/m"),
    ({"drive.travel": 1e-3, "motion.displacement": -2e-3},
     "motion.displacement must be at most travel, 0.001 m, either way, got -0.002 m"),
    ({"motion.skin_stretch": 1e-6},
     "motion.skin_stretch must be left out for a rigid finger, got 1e-06 m"),
    ({"finger.stiffness": 1e3, "motion.skin_stretch": -6e-6}, "motion.skin_stretch must be at most "
     "static friction over stiffness, 5e-06 m, either way, got -6e-06 m"),
    ({"finger.stiffness": 1e3, "motion.skin_stretch": 6e-6,
      "motion.finger_load": ((-1.0, 2.0), (0.0, 2.0), (0.0, 1.0), (1.0, 9.0))},
     "motion.skin_stretch must be at most static friction over stiffness, 5e-06 m, either way, "
     "got 6e-06 m"),
    ({"drive.damping": 1e-12}, "drive.damping must be such that the damping ratio is 0 or at least "
     "1e-11 and at most 1e6, got 1e-12 N*s/m, which makes it 5e-13"),
    ({"plate.curve": ((0.0, 0.02), (1e-3, 1e4))},
     "plate.curve slope must be at most 1e6 times critical damping, got 9.99998e+06 N*s/m"),
    ({"motion.duration": 1e11},
     "motion.duration must be at most 1e10 s, 1e12 over the natural frequency, "
     "got 100000000000.0 s"),
    # magnet
    ({"plate.kinetic": 0.0}, "plate.kinetic must be greater than 0 N where a magnet holds by "
     "friction, got 0.0 N"),
    ({"magnet.turns": 3.0, "magnet.hold_force": 1.0}, "magnet.hold_force must be left out where "
     "turns describes the coil, got both, hold_force and turns"),
    ({"magnet.lift": 1e-4}, "magnet.lift must be given with turns, pole_area, gap, wire_diameter, "
     "turn_length, supply_voltage, got lift alone"),
    ({"magnet.voltage": ((0.0, 1.0),)}, "magnet.voltage must be given with a coil, by turns, gap, "
     "wire_diameter and the like, got it alone"),
    ({"magnet.residual": 2.0}, "magnet.residual must be less than the hold force, 1.0 N, "
     "got 2.0 N"),
    (COIL | {"magnet.turns": 1.0, "magnet.wire_diameter": 1e-7, "magnet.supply_voltage": 1e-3,
             "magnet.turn_length": 10.0, "magnet.gap": 0.1},
     "magnet.turns must be such that the field of the coil is finite and at least 1e-12 T and at "
     "most 1e12 T, got values that make it 2.862185275938011e-16 T"),
    (COIL | {"magnet.lift": 1e-4}, "magnet.lift must be given with closing_force, got it alone"),
    (COIL | {"magnet.lift": 1e-4, "magnet.closing_force": 1e3}, "magnet.closing_force must be less "
     "than the pull of full current with the open gap, 1.2"),
    (COIL | {"magnet.lift": 1e-4, "magnet.closing_force": 0.01, "magnet.residual": 0.02},
     "magnet.closing_force must be more than the residual pull, 0.02 N, got 0.01 N"),
    (COIL | {"magnet.outer_diameter": 2.7e-3}, "magnet.pole_area must be at most half of the "
     "magnet's face, 2.86278e-06 m^2, as it has two poles, got 3e-06 m^2"),
    ({"magnet.pwm_duty": 0.5}, "magnet.pwm_duty must be given with pwm_frequency, got it alone"),
    (COIL | {"magnet.voltage": ((0.0, 1.0),), "magnet.pwm_duty": 0.5,
             "magnet.pwm_frequency": 400.0},
     "magnet.voltage must be left out where pwm_frequency gives pulses, got both"),
    (COIL | {"magnet.voltage": ((1e-3, 1.0),)},
     "magnet.voltage[0] time must be 0 s, when the coil is switched on, got 0.001 s"),
    (COIL | {"magnet.voltage": ((0.0, 1.0), (1.0, 6.0))},
     "magnet.voltage[1] must be from 0 V to the supply voltage, 5.0 V, got 6.0 V"),
    # control block, array, hand
    ({"control.threshold": 0.9, "control.hysteresis": 0.3},
     "control.hysteresis must be at most 0.2 about a threshold of 0.9, got 0.3"),
    ({"array.places": ((0.0, 0.0),), "array.rows": 2.0}, "array.places must be left out where "
     "columns, rows or pitch are given, got it beside array.rows"),
    ({"array.places": ((0.0, 0.0), (1.0, 0.0), (0.0, 0.0))},
     "array.places must be places of their own, got pins 0 and 2 both at (0.0 m, 0.0 m)"),
    ({"array.slot_length": 1e-3}, "array.slot_length must be at least array.pin_diameter, 0.0015 "
     "m, which moves in it, got 0.001 m"),
    ({"array.columns": 2.5}, "array.columns must be a whole number, got 2.5"),
    ({"array.columns": 200.0, "array.rows": 200.0}, "array.columns must be such that there are at "
     "most 10000 pins, got 200 columns of 200 rows"),
    ({"scan.touch": 0.1}, "scan.touch must be left out where the finger's friction is given as a "
     "force; it needs finger.coefficient and a finger.touch_force greater than 0 N, got 0.1 N"),
    ({"finger.kinetic": "gone", "finger.coefficient": 0.5, "finger.touch_force": 0.0,
      "scan.touch": ((0.0, 1.0), (1.0, 2.0))},
     "scan.touch must be left out where the finger's friction is no force; it needs "
     "finger.coefficient and a finger.touch_force greater than 0 N, got one over time"),
]  # fmt: skip
"""Values beside good ones, and the first of their problems."""


def words(values: dict[str, Any], *, whole: bool = True) -> list[str]:
    given = {key: value for key, value in (GOOD | values).items() if value != "gone"}
    return [problem.words for problem in problems_of(given, whole=whole)]


@pytest.mark.parametrize(("values", "expected"), RULES, ids=lambda value: str(value)[:60])
def test_each_rule_has_its_words(values: dict[str, Any], expected: str) -> None:
    assert words(values)[0].startswith(expected)


def test_what_fits_together_has_no_problem() -> None:
    assert not words({}) + words(COIL | {"magnet.residual": 0.01})
    assert not words({"drive.travel": 1e-3, "drive.stop_stiffness": 1e4, "drive.stop_damping": 1.0})
    curve = ((0.0, 0.02), (0.1, 0.01))
    assert not words({"plate.curve": curve, "plate.static": 0.03})
    assert not words({"plate.kinetic": "gone", "plate.curve": curve})
    assert not words({"magnet.pwm_duty": 0.5, "plate.kinetic": 0.0}, whole=False)


def test_unknown_values_contradict_nothing_by_their_size() -> None:
    for values, _ in RULES:
        malformed = dict.fromkeys(GOOD | values)
        said = [problem.words for problem in problems_of(malformed, whole=True)]
        assert not any(" got nan" in text or " nan " in text for text in said), said


def test_values_in_any_units_fit_alike() -> None:
    """No rule depends on the size of the device: values scaled with the mass fit, too."""
    random = np.random.default_rng(45)
    keys = ("drive.mass", "drive.stiffness", "drive.damping", "plate.kinetic", "finger.kinetic")
    for scale in 10.0 ** random.uniform(-6, 6, 50):
        scaled = {key: GOOD[key] * scale for key in keys}
        assert not words(scaled)
        still = scaled | {"plate.static": scaled["plate.kinetic"] * 0.99}
        assert words(still)[0].startswith("plate.static must be at least")

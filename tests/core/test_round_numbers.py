"""Drives with round values end alike in `simulate`, in `simulate_batch`, in C and as FMUs.

The drives are those of tests/fuzz/round_numbers.hpp: documented features, three at a time. That
their endings do not depend on units, mirror image and duration is shown by tests/fuzz/endings.cpp.
"""

from __future__ import annotations

import subprocess
from ctypes import byref, c_double, c_void_p
from itertools import pairwise
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from c_interface import Interface, Outcome, doubles
from cases import EXPLORES
from core_case import Case, line, read
from fmu_unit import Unit, unpacked
from pindrive import Status, load_device, simulate, simulate_batch

pytestmark = [pytest.mark.explore, pytest.mark.timeout(1800)]  # the first test compiles
COUNT = 4000 if EXPLORES else 680
"""680 has each three of the 17 features once."""


@pytest.fixture(scope="module")
def cases(programs: Path) -> list[Case]:
    command = [str(programs / "endings"), "--write", str(COUNT), "2"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = list(read(said.splitlines()))
    assert len(found) == COUNT
    return found


def test_batch_ends_as_simulate(cases: list[Case]) -> None:
    same = 0
    for number, case in enumerate(cases):
        drive, release = case.plain().python()
        motion = simulate(drive, release)
        expected = motion.to_dataset()
        found = simulate_batch(drive, release)
        assert found.status == motion.status, number
        assert found.ending == motion.ending.end, number
        names = [name for name in found.data_vars if name in expected]
        bits = [float(found[name]) for name in names], [float(expected[name]) for name in names]
        # The kernel has its own sine and exponential function: the same to rounding.
        scale = np.abs(bits[1]).max(initial=0.0, where=np.isfinite(bits[1]))
        np.testing.assert_allclose(*bits, rtol=1e-9, atol=1e-15 * scale, err_msg=str(number))
        same += np.array_equal(*bits, equal_nan=True)
    assert same > 0.6 * COUNT


def test_c_ends_as_simulate(cases: list[Case], c_library: Path) -> None:
    c = Interface(c_library)
    names = c.names("number")
    for number, case in enumerate(cases):
        core = case.core()
        handles = c.given(case)
        motion, outcome, duration = c_void_p(), Outcome(), c_double()
        c("simulate", *handles, None, None, byref(motion))
        c("outcome_of", motion, byref(outcome))
        assert (outcome.status, outcome.end) == (core.status, core.end), number
        if Status(outcome.status) is Status.ok:
            c("duration", motion, c_double(0.05), byref(duration))
            values = np.empty(len(names))
            c("numbers", motion, duration, c_double(0.05), doubles(values))
            expected = core.transient(duration.value, 0.05)
            assert_array_equal(values, [expected[name] for name in names], str(number))
        c.free(motion=motion, drive=handles[0], release=handles[1])


# ---- as functional mock-up units -----------------------------------------------------------------

START = ("displacement", "velocity")


class Units:
    """FMUs by what a drive consists of; values are parameters of one."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.made: dict[str, Unit] = {}

    def begun(self, case: Case) -> Unit:
        """A unit with the numbers of a case, before its first step."""
        text = device_text(case)
        if text not in self.made:
            path = self.folder / f"{len(self.made)}.toml"
            path.write_text(text, encoding="utf-8")
            folder, description = unpacked(load_device(path), path.with_suffix(".fmu"), 3)
            self.made[text] = Unit(folder, description)
        else:
            self.made[text].slave.reset()
        unit = self.made[text]
        given = {
            name if "." in name else f"{'motion' if name in START else 'drive'}.{name}": value
            for name, value in case.numbers.items()
        }
        for contact, rows in case.curves.items():
            for i, (speed, force) in enumerate(rows, 1):
                given |= {f"{contact}.curve.speed[{i}]": speed}
                given |= {f"{contact}.curve.force[{i}]": force}
        given |= {name: rows[0][1] for name, rows in case.inputs.items()}
        return unit.begin(**{name: x for name, x in given.items() if name in unit.numbers})


def device_text(case: Case) -> str:
    """A device file with the parts of a case, whose values do not matter."""
    n = case.numbers
    lines = ["[drive]", 'mass = "10 g"', 'stiffness = "100 N/m"', 'damping = "0.4 N*s/m"']
    lines += ['travel = "1 mm"'] * isfinite(n["travel"])
    lines += ['stop_stiffness = "1 N/mm"', 'stop_damping = "0 N*s/m"'] * isfinite(
        n["stop_stiffness"]
    )
    for contact, rows in case.curves.items():
        curve = ", ".join(f'["{100 * i} mm/s", "1 mN"]' for i in range(len(rows)))
        lines += [f"[{contact}]", f"curve = [{curve}]" if rows else 'kinetic = "1 mN"']
        lines += ['static = "9 mN"']
    lines += ['stiffness = "100 N/m"'] * isfinite(n["finger.stiffness"])
    lines += ['damping = "1 N*s/m"'] * (n["finger.damping"] > 0.0)
    lines += ["[motion]", 'mouse_velocity = "0 m/s"', 'velocity = "0 m/s"', 'displacement = "0 m"']
    return "\n".join(lines)


def test_units_end_as_simulate(cases: list[Case], tmp_path: Path) -> None:
    units, random = Units(tmp_path), np.random.default_rng(3)
    for number, case in enumerate(cases):
        core = case.core()
        if core.status != Status.ok:
            continue
        until = min(1.5 * float(core.duration(0.05)), core.known_until)
        unit = units.begun(case)
        rows = {t for rows in case.inputs.values() for t, _ in rows if t < until}
        times = sorted(rows | {until} | set(random.uniform(0.0, until, 3)))
        for time, end in pairwise(times):
            if time in rows:
                for name, of_input in case.inputs.items():
                    value, rate = line(of_input, time)
                    unit.set(**{name: value, f"{name}_rate": rate})
            unit.step(end)
            check(unit, core, end, number)


def check(unit: Unit, core: Any, time: float, number: int) -> None:
    """Check that position and velocity agree with one simulation.

    Which continues a cycle by its first period where that repeats to 1e-8 of the amplitude; a unit
    follows every round, and the rounding of each adds to its time.
    """
    samples = np.linspace(0.0, time, 50)
    for name in ("position", "velocity"):
        values = getattr(core, name)
        size = np.abs(values(samples, True)).max()
        (found,), (expected,) = unit.get(name), values(np.array([time]), True)
        assert abs(found - expected) <= (3e-8 + 3e-11 * time) * size, (number, name, time)

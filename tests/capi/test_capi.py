"""C interface, installed and used from C, compared with the extension."""

from __future__ import annotations

import ast
import ctypes
import re
import shutil
import subprocess
import sys
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t, c_void_p
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import pindrive as pd
from c_interface import QUANTITIES, Event, Interface, Outcome, Segment, doubles
from core_case import Case, line
from pindrive import Status, _core
from pindrive.quantities.results import ENDING, TRANSIENT

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(sys.executable).parent

pytestmark = [
    pytest.mark.timeout(1800),  # the first of them compiles the library
    pytest.mark.skipif(
        sys.platform == "win32", reason="where the library lies is tested on the others"
    ),
]


def run(*command: str | Path) -> None:
    program = shutil.which(str(command[0]), path=str(BIN)) or str(command[0])
    done = subprocess.run(
        [program, *map(str, command[1:])], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_program_in_c99(c_library: Path, tmp_path: Path) -> None:
    source = ROOT / "tests" / "capi"
    run("cmake", "-S", source, "-B", tmp_path, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={c_library}")
    run("cmake", "--build", tmp_path)
    run(tmp_path / "consumer")


def test_the_example_of_the_header_is_a_program(c_library: Path, tmp_path: Path) -> None:
    header = (ROOT / "capi" / "pindrive.h").read_text("utf-8")
    lines = re.findall(r"^ \*     (.*)$", header, re.MULTILINE)
    source, program = tmp_path / "example.c", tmp_path / "example"
    body = "\n".join(lines)
    source.write_text(
        "#include <stdio.h>\n#include <pindrive.h>\nint main(void) {\n"
        f'{body}\nprintf("%.17g\\n", x);\nreturn 0;\n}}\n'
    )
    library = c_library / "lib"
    run(
        *("cc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", source, "-o", program),
        *(f"-I{c_library / 'include'}", f"-L{library}", f"-Wl,-rpath,{library}", "-lpindrive"),
    )
    said = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    case = Case()
    assert float(said) == case.core().position(np.array([0.02]), True)[0]


# ---- random drives, to the bit -------------------------------------------------------------------


def drawn(random: np.random.Generator) -> Case:
    """A drive of any kind that the core can follow."""
    case = Case()
    n = case.numbers

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    n["mass"], n["stiffness"] = between(2e-3, 2e-2), between(20, 400)
    ratio = random.choice([0.0, between(0, 0.3), between(0, 2), 1.0])
    n["damping"] = float(ratio * 2 * np.sqrt(n["mass"] * n["stiffness"]))
    for contact, largest in (("plate", 0.1), ("finger", 0.05)):
        kinetic = between(1e-3, largest) * bool(random.integers(5))
        n[f"{contact}.kinetic"] = kinetic
        n[f"{contact}.static"] = kinetic * random.choice([1.0, between(1, 2)])
    n["displacement"] = between(-3e-3, 3e-3)
    kind = random.integers(5)
    speed = between(-0.3, 0.3)
    if kind == 4:
        for contact in ("plate", "finger"):
            kinetic, law = n[f"{contact}.kinetic"], int(random.integers(3))
            rest = kinetic * between(1, 2)
            n[f"{contact}.law"], n[f"{contact}.breakaway"] = float(law), rest if law else 0.0
            n[f"{contact}.stribeck_velocity"] = between(5e-3, 0.1)
            n[f"{contact}.exponent"] = random.choice([1.0, 2.0])
            n[f"{contact}.viscous"] = random.choice([0.0, between(0, 0.1)])
            n[f"{contact}.static"] = (rest if law else kinetic) * random.choice([1.0, 1.3])
    case.inputs["mouse_velocity"] = [(0.0, speed)]
    if kind == 1:
        n["finger.stiffness"] = n["stiffness"] * between(1, 50)
    if kind == 2:
        fall = between(0.3, 1.1)
        for contact in ("plate", "finger"):
            kinetic = n[f"{contact}.kinetic"]
            case.curves[contact] = [(0.0, kinetic), (0.05, kinetic * fall), (0.3, kinetic)]
    times = [0.0, between(0.01, 0.1), between(0.11, 0.3)]
    if kind == 3:
        case.inputs["mouse_velocity"] = [(t, between(-0.3, 0.3)) for t in times]
    if kind == 3 or (kind == 2 and random.integers(2)):
        case.inputs["plate_load"] = [(t, between(0, 2)) for t in times]
        case.inputs["force"] = [(t, between(-0.1, 0.1)) for t in [*times, times[-1]]]
        if random.integers(2):
            n["duration"] = between(0.05, 0.3)
            case.inputs["across_velocity"] = [(t, between(-0.1, 0.1)) for t in times]
    if kind == 3:
        case.inputs["finger_load"] = [(t, between(0, 2)) for t in times]
    n["velocity"] = case.inputs["mouse_velocity"][0][1] if random.integers(2) else speed
    if kind == 3 and random.integers(2):
        n["travel"] = abs(n["displacement"]) + between(0, 1e-3)
        n["stop_stiffness"] = random.choice([inf, n["stiffness"] * between(1, 100)])
    if random.integers(3) == 0:
        n["duration"] = between(0.01, 1)
    return case


@pytest.fixture(scope="module")
def c(c_library: Path) -> Interface:
    return Interface(c_library)


def test_numbers_have_their_names_of_the_table(c: Interface) -> None:
    assert c.names("number") == [
        number.name for number in (*TRANSIENT, *ENDING) if number.name != "transient.settled"
    ]
    core = Case().core()
    assert c.names("number") == [*core.transient(0.1, 0.05)]
    assert c.names("energy") == [*core.ledger(0.1)]
    assert c.names("certificate") == [*core.certificate(0.1)]


def test_codes_are_those_of_python(c: Interface) -> None:
    header = (ROOT / "capi" / "pindrive.h").read_text("utf-8")
    codes = dict(re.findall(r"PINDRIVE_STATUS_(\w+) = (\d+)", header))
    assert codes == {
        status.name.upper(): str(status.value)
        for status in Status
        if status < Status.incomplete and status is not Status.stopped
    }
    for code in codes.values():
        assert c.library.pindrive_status_text(int(code)).decode() == Status(int(code)).explanation


IN_C = {
    "Motion": dict.fromkeys(
        ("position", "velocity", "acceleration", "plate_force", "finger_force", "stretch"),
        "evaluate",
    )
    | {
        **{"stretch_rate": "evaluate", "segments": "segment_of", "transient": "numbers"},
        **{"ledger": "energy", "acceleration_bounds": "segment_of", "status": "outcome_of"},
        **dict.fromkeys(("known_until", "end", "cycle_begin", "until"), "outcome_of"),
        "segment_count": "outcome_of",
        **dict.fromkeys(("stop_force", "housing_force", "columns"), "evaluate"),
    },
    "": {
        "simulate_batch": "batch",
        "statuses": "status_text",
        "value_problems": "check_values",
    },
}
"""The function of pindrive.h for what the extension calls otherwise."""
OF_THE_DEVICE = {
    "luminance",
    "on_page",
    "hand_position",
    "hand_velocity",
    "way",
    "turnings",
    "printed_lines",
    "plate_velocity",
    "coil_course",
    "coil_numbers",
    "load_along",
    "magnet_numbers",
    "closest_approaches",
    "Device",
    "Scan",
    "Evaluation",
    "evaluate",
    "two_lines",
    "speed_limit",
    "tried_speeds",
    "speed_precision",
    "SystemMotion",
    "SystemDerivative",
}
"""Names of the device layer, whose functions in C are those of a device and its scan."""
OF_THE_EXTENSION = {
    "input_quantities",
    "bounds_words",
    "friction_laws",
    "kernel_widths",
    "elementary",
    "settling_band",
    "event_limit",
    "function_range",
    "function_at",
    "function_kinds",
    "function_from",
    "function_of_rows",
    "function_pieces",
    "function_pieces_along",
    "sum_of_functions",
    "input_period",
    "input_at",
    "function_integral",
    "function_integral_along",
    "simulate_system",
    "differentiate_system",
    "certify_system",
} | OF_THE_DEVICE
"""Names of the extension without a function in C."""


def test_c_has_the_functions_of_python() -> None:
    header = (ROOT / "capi" / "pindrive.h").read_text("utf-8")
    functions = set(re.findall(r"pindrive_(\w+)\(", header))
    stub = ast.parse((ROOT / "src" / "pindrive" / "_core.pyi").read_text("utf-8"))
    requested = 0
    for node in stub.body:
        if isinstance(node, ast.ClassDef) and node.name not in OF_THE_DEVICE:
            names = [each.name for each in node.body if isinstance(each, ast.FunctionDef)]
        elif isinstance(node, ast.FunctionDef):
            names = [node.name]
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names = [node.target.id]
        else:
            continue
        of = IN_C["Motion" if isinstance(node, ast.ClassDef) else ""]
        for name in names:
            if name not in OF_THE_EXTENSION:
                assert of.get(name, name) in functions, name
                requested += 1
    assert requested > 25


def same(found: Any, expected: Any, case: int) -> None:
    """Return True for equal bits, or two NaN."""
    assert_array_equal(np.asarray(found, float), np.asarray(expected, float), f"case {case}")


def compare(c: Interface, number: int, motion: c_void_p, core: Any) -> float:
    """Values, segments and numbers of a motion, or their derivatives; the duration looked at."""
    outcome = Outcome()
    c("outcome_of", motion, byref(outcome))
    numbers = core.transient(0.1, 0.05)
    ending = [numbers[f"ending.{name}"] for name in ("steady_since", "period")]
    same((outcome.steady_since, outcome.period), ending, number)
    table = core.segments()
    if isinstance(core, _core.Motion):
        table["acceleration_bound"] = core.acceleration_bounds()
    assert outcome.segments == len(table["begin"])
    for i in range(0, outcome.segments, max(outcome.segments // 7, 1)):
        segment = Segment()
        c("segment_of", motion, c_size_t(i), byref(segment))
        assert table.keys() <= {column[0] for column in Segment._fields_}
        for name in table:
            same(getattr(segment, name), table[name][i], number)
    return float(outcome.known_until)


def evaluated(c: Interface, motion: c_void_p, quantity: int, times: Any, side: int) -> Any:
    values = np.empty(len(times))
    c("evaluate", motion, quantity, doubles(times), c_size_t(len(times)), side, doubles(values))
    return values


def test_a_thousand_random_drives_have_the_bits_of_python(c: Interface) -> None:
    random = np.random.default_rng(16)
    capacity = 4000
    events, count = (Event * capacity)(), c_size_t()
    times, values = np.empty(capacity), np.empty(capacity)
    sides = np.empty(capacity, np.int8)
    endings, stops = set(), 0
    for number in range(1000):
        case = drawn(random)
        core = case.core()
        drive, release = c.given(case)
        motion = c_void_p()
        c("simulate", drive, release, None, None, byref(motion))
        known = compare(c, number, motion, core)
        assert known == core.known_until
        endings.add(core.end)

        duration = core.duration(0.05)
        found = c_double()
        c("duration", motion, c_double(0.05), byref(found))
        assert found.value == duration
        at = np.append(random.uniform(0, duration, 5), 0.0)
        for quantity, name in enumerate(QUANTITIES):
            same(evaluated(c, motion, quantity, at, 1), getattr(core, name)(at, True), number)
        for of, expected in (
            ("numbers", [*core.transient(duration, 0.05).values()]),
            ("energy", [*core.ledger(duration).values()]),
            ("certificate", [*core.certificate(duration).values()]),
        ):
            row = np.empty(len(expected))
            band = (c_double(0.05),) if of == "numbers" else ()
            c(of, motion, c_double(duration), *band, doubles(row))
            same(row, expected, number)
        until = min(duration, known)
        c(
            *("events", motion, c_double(0), c_double(until)),
            *(events, c_size_t(capacity), byref(count)),
        )
        same([e.time for e in events[: count.value]], core.events(0.0, until, capacity)[0], number)
        instants = np.array([e.time for e in events[: count.value]])
        for name in ("position", "velocity"):
            told = [getattr(e, name) for e in events[: count.value]]
            # Of a cycle an event is evaluated in the first round.
            assert_allclose(told, getattr(core, name)(instants, True), rtol=1e-12, atol=1e-14)
        at_stops = [e.velocity for e in events[: count.value] if e.stop]
        assert not any(at_stops) or case.numbers["stop_stiffness"] < inf
        stops += len(at_stops)
        quantity = int(random.integers(3))
        arrays = doubles(times), doubles(values), c_size_t(capacity), byref(count)
        c("extrema", motion, quantity, c_double(until), *arrays)
        turns = core.extrema(quantity, until, capacity)
        same((times[: count.value], values[: count.value]), turns, number)
        level = float(np.median(turns[1]))
        c(
            *("crossings", motion, quantity, c_double(level), c_double(until), doubles(times)),
            *(sides.ctypes.data_as(c_char_p), c_size_t(capacity), byref(count)),
        )
        across = core.crossings(quantity, level, until, capacity)
        same((times[: count.value], sides[: count.value]), across, number)
        c.free(drive=drive, release=release, motion=motion)
    assert len(endings) >= 4 and stops > 50


class Instant(ctypes.Structure):
    """pindrive_instant."""

    _fields_ = (
        *((name, c_double) for name in ("time", "next_event", "mouse_velocity")),
        *((name, c_double) for name in ("mouse_velocity_rate", "plate_load", "plate_load_rate")),
        *((name, c_double) for name in ("across_velocity", "across_velocity_rate")),
        *((name, c_double) for name in ("force", "force_rate")),
        *((name, c_double) for name in ("finger_load", "finger_load_rate")),
        *((name, ctypes.c_int) for name in ("plate", "finger", "plate_event", "finger_event")),
        ("stop", ctypes.c_int),
        ("stop_event", ctypes.c_int),
    )


def test_random_steps_lead_to_what_one_simulation_has(c: Interface) -> None:
    """Whatever the steps, and the inputs that change on the way."""
    random = np.random.default_rng(17)
    worst, steps, kept, oblique, at_stops = 0.0, 0, 0, 0, 0
    for number in range(150):
        case = drawn(random)
        case.numbers["velocity"] = case.inputs["mouse_velocity"][0][1]
        if number % 3 == 0:
            case.numbers["travel"] = abs(case.numbers["displacement"]) + random.uniform(0, 3e-4)
            case.numbers["stop_stiffness"] = random.choice([inf, 1e3])
        rows = case.inputs
        oblique += len(rows["across_velocity"]) > 1
        changes = sorted({t for of_input in rows.values() for t, _ in of_input})
        case.numbers["duration"] = changes[-1] + 0.2
        core = case.core()
        held = Case(case.numbers, case.curves, {n: [(0.0, r[0][1])] for n, r in rows.items()})
        drive, release = c.given(held)
        stepper, instant = c_void_p(), Instant()
        c("stepper_new", drive, release, c_double(0), byref(stepper))
        time = 0.0
        scale = {}
        for quantity, name in enumerate(QUANTITIES):
            at = np.linspace(0, case.numbers["duration"], 200)
            scale[quantity] = np.abs(getattr(core, name)(at, True)).max() + 1e-300
        for begin, end in zip(changes, [*changes[1:], case.numbers["duration"]], strict=True):
            for name, of_input in rows.items():
                value, rate = line(of_input, begin)
                c("stepper_set", stepper, name.encode(), c_double(value), c_double(rate))
            while time < end:
                until = min(end, time + random.uniform(0, 0.02))
                stop = int(random.integers(2))
                c("stepper_step", stepper, c_double(until), stop, None, None)
                c("stepper_now", stepper, byref(instant))
                assert time < instant.time <= until
                assert instant.next_event > instant.time
                assert stop or instant.time == until
                time = instant.time
                if random.integers(8) == 0:  # going astray, and back to a state that was kept
                    state = c_void_p()
                    c("stepper_copy", stepper, byref(state))
                    c("stepper_set", stepper, b"plate_load", c_double(2), c_double(-30))
                    c("stepper_step", stepper, c_double(time + 0.1), 0, None, None)
                    c.free(stepper=stepper)
                    stepper, kept = state, kept + 1
                at_stops += instant.stop != 0
                for quantity, name in enumerate(QUANTITIES):
                    if "stretch" in name:
                        continue
                    value_now = c_double()
                    c("stepper_evaluate", stepper, quantity, byref(value_now))
                    event = time > end - 1e-9 or instant.plate_event or instant.finger_event
                    if instant.stop_event or (quantity > 1 and event):
                        continue  # it jumps there
                    expected = getattr(core, name)(np.array([time]), True)[0]
                    apart = abs(value_now.value - expected) / scale[quantity]
                    # A pin over a plate that slides across rests by the rest criterion.
                    across = len(rows["across_velocity"]) > 1
                    assert apart < (1e-10 if across else 1e-12), (number, name, time)
                    worst, steps = max(worst, apart), steps + 1
        c.free(drive=drive, release=release, stepper=stepper)
    print(f"{steps} values, {kept} states gone back to: within {worst:.1e} of their largest")
    assert kept > 100
    assert oblique > 10
    assert at_stops > 10


class Varied(ctypes.Structure):
    """pindrive_varied."""

    _fields_ = (("name", c_char_p), ("values", POINTER(c_double)))


def test_a_batch_has_the_bits_of_python(c: Interface) -> None:
    """By the kernel, and by the general core where the kernel gives up."""
    random = np.random.default_rng(23)
    points = 3000
    plate, finger = random.uniform(0, 0.1, points), random.uniform(1e-3, 0.05, points)
    plate[random.integers(points, size=50)] = 0.0
    varied: dict[str, Any] = {
        "mass": random.uniform(2e-3, 2e-2, points),
        "stiffness": random.uniform(20, 400, points),
        "damping": random.uniform(0, 2, points),
        "plate.kinetic": plate,
        "plate.static": plate * random.uniform(1, 2, points),
        "finger.kinetic": finger,
        "finger.static": finger * random.uniform(1, 2, points),
        "finger.stiffness": np.where(random.integers(20, size=points) == 0, 2000.0, inf),
        "mouse_velocity": random.uniform(-0.3, 0.3, points),
        "displacement": random.uniform(-3e-3, 3e-3, points),
        "velocity": random.uniform(-0.3, 0.3, points),
        "plate_load": random.choice([1.0, 0.5, 3.0], points),
        "duration": np.where(random.integers(5, size=points) == 0, 0.1, inf),
    }
    varied["mass"][7] = -1.0
    motion, energy = c.names("number"), [f"energy.{name}" for name in c.names("energy")]
    names = [*motion, *energy, "duration", "final.position", "final.velocity"]
    expected = pd.simulate_batch(
        pd.Drive(
            mass=0.01,
            stiffness=100.0,
            damping=0.0,
            plate=pd.Contact(kinetic=0.02),
            finger=pd.Contact(kinetic=0.005),
        ),
        pd.Release(mouse_velocity=0.1),
        **{name.replace(".", "_"): values for name, values in varied.items()},
        outputs=[name.replace(".", "_") for name in names] + ["ending", "status", "events"],
    )
    drive, release = c.given(Case())
    listed = (Varied * len(varied))(
        *(Varied(name.encode(), doubles(values)) for name, values in varied.items())
    )
    numbers = np.empty((points, len(names)))
    events, *codes = (np.empty(points, np.int32) for _ in range(4))
    filled = (doubles(numbers), *(array.ctypes.data_as(c_void_p) for array in (events, *codes)))
    outputs = (c_char_p * len(names))(*(name.encode() for name in names))
    c(
        *("batch", drive, release, listed, c_size_t(len(varied)), c_size_t(points)),
        *(c_double(0.05), outputs, c_size_t(len(names)), None, None, *filled),
    )
    for k, name in enumerate(names):
        same(numbers[:, k], expected[name.replace(".", "_")].values, k)
    good = expected["status"].values == Status.ok
    assert_array_equal(codes[2] == 0, expected["status"].values < Status.incomplete)
    assert_array_equal(codes[1][good], expected["ending"].values[good])
    assert_array_equal(events, expected["events"].values)
    assert not good[7] and good.sum() > 0.99 * points
    c.free(drive=drive, release=release)


def test_derivatives_have_the_bits_of_python(c: Interface) -> None:
    random = np.random.default_rng(61)
    for number in range(100):
        case, rate = drawn(random), Case()
        rate.numbers = {name: float(random.normal()) for name in case.numbers}
        for name in ("finger.stiffness", "skin_stretch", "duration"):
            if not np.isfinite(case.numbers[name]):
                rate.numbers[name] = 0.0
        for rates, given in ((rate.curves, case.curves), (rate.inputs, case.inputs)):
            for name, rows in given.items():
                rates[name] = [tuple(random.normal(size=2)) for _ in rows]
        for contact, rows in rate.curves.items():
            if rows:
                rate.numbers[f"{contact}.kinetic"] = rows[0][1]
        core = _core.differentiate(case.as_core(), rate_as_core(rate))
        drive, release = c.given(case)
        of_drive, of_release = c.rate(rate, drive, release)
        derivative = c_void_p()
        handles = (drive, release, of_drive, of_release)
        c("differentiate", *handles, None, None, byref(derivative))
        compare(c, number, derivative, core)
        duration = case.core().duration(0.05)
        at = random.uniform(0, duration, 5)
        for quantity, name in enumerate(QUANTITIES):
            same(evaluated(c, derivative, quantity, at, 1), getattr(core, name)(at, True), number)
        row = np.empty(len(c.names("number")))
        c("numbers", derivative, c_double(duration), c_double(0.05), doubles(row))
        same(row, [*core.transient(duration, 0.05).values()], number)
        c.free(drive=drive, release=release, motion=derivative)
        c.free(drive=of_drive, release=of_release)


def rate_as_core(rate: Case) -> tuple[Any, ...]:
    """Along a direction the stiffness of the plate stays infinite."""
    numbers = list(rate.as_core())
    kinetic, at_rest, _, rows, law, *_ = numbers[3]
    numbers[3] = (kinetic, at_rest, 0.0, rows, law, 0.0, 0.0)
    return tuple(numbers)

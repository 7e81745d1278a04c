"""Random cases of the fuzz of files: a command, its files and options, by seed and number."""

from __future__ import annotations

import gc
import os
from dataclasses import dataclass
from math import inf, log10
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pindrive.device.coil import COIL, COIL_NEEDS
from pindrive.device.electromagnet import DIRECT
from pindrive.files.keys import DRIVE, NUMERIC_KEYS
from pindrive.quantities.drive import COLUMNS
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.table import QUANTITIES

KEYS = tuple(NUMERIC_KEYS)
COMMANDS = ("check", "simulate", "scan", "speed", "sweep", "sensitivity", "robustness")
WEIGHTS = (0.06, 0.2, 0.36, 0.14, 0.12, 0.05, 0.07)
INTERRUPTED = 0.04
"""The part of the cases that Ctrl-C ends."""
TEXTS = (
    *("A", "Hi", "a\\nb", " ", "", "é", "e\u0301", "שלום", "سلام عليكم", "हिन्दी", "漢字", "\u200d"),
    *("x" * 3000, "W\\n" * 300, "\x00", "\ufffd", "👍🏽", "i" * 200_000),
)
LENGTHS = ("4 mm", "2 mm", "0.1 mm", "1e-6 m", "1e-9 m", "1 m", "100 m", "0 m", "-1 mm", "nan m")
SPEEDS = ("5 mm/s", "1 m/s", "1e-4 m/s", "100 m/s", "1e9 m/s", "1e-9 m/s", "0 m/s", "inf m/s")
COUNTS = ("1", "2", "7", "128", "1000000", "1000000000000", "1" + "0" * 30, "0", "-3", "1.5")


@dataclass(frozen=True)
class Case:
    """One command and the files that it reads."""

    number: int
    command: tuple[str, ...]
    files: dict[str, str]
    keys: tuple[str, ...]
    """The keys that were drawn."""
    drawn: str
    """Them with their values, for a message."""
    interrupt: float | None
    """Time of Ctrl-C, s; None: never."""

    @classmethod
    def of(cls, seed: int, number: int) -> Case:
        """The case of this number: its first key is the one whose turn it is."""
        rng = np.random.default_rng((seed, number))
        keys = [KEYS[number % len(KEYS)]]
        others = int(rng.choice((0, 1, 1, 2, 5)))
        keys += [k for k in rng.choice(KEYS, others, replace=False).tolist() if k not in keys]
        command = str(rng.choice(COMMANDS, p=WEIGHTS))
        around = [key for key in keys if key not in DRIVE]
        if command == "sensitivity" or (command == "simulate" and rng.random() < 0.8):
            keys = [key for key in keys if key in DRIVE] or [keys[0]]
        values = {key: written(NUMERIC_KEYS[key], rng) for key in keys}
        study = command in ("sweep", "sensitivity", "robustness")
        varied = dict(list(values.items())[: int(rng.integers(1, 3))]) if study else {}
        fixed = {key: value for key, value in values.items() if key not in varied}
        files = {"device.toml": device(fixed, varied)}
        scans = study and command != "sensitivity" and (bool(around) or rng.random() < 0.3)
        if study:
            files["study.toml"] = study_file(varied, scans, rng)
        interrupt = float(rng.uniform(0.0, 1.5)) if rng.random() < INTERRUPTED else None
        return cls(
            number,
            (command, *options(command, scans, rng)),
            files,
            tuple(keys),
            ", ".join(f"{key}={value}" for key, value in values.items()),
            interrupt,
        )


def warm_up() -> None:
    """Do once what every command does first, so that a fork has it."""
    from importlib import import_module

    from typer.testing import CliRunner

    from pindrive.cli.app import app

    for name in ("h5netcdf", "pindrive.plot.robustness", "pindrive.plot.slices"):
        import_module(name)

    files = {
        "device.toml": device({}, {}),
        "study.toml": 'base = "device.toml"\n[axes]\nplate.kinetic = { uniform = ["1 mN", "9 mN"] }'
        '\n[sample]\ncount = 2\n[tolerances]\nmass = "5 %"\n[specification]\nswing = ">= 1 mm"\n',
    }
    before = Path.cwd()
    with TemporaryDirectory() as place:
        os.chdir(place)
        for name, content in files.items():
            Path(name).write_text(content, encoding="utf-8")
        for line in (
            "check device.toml",
            "simulate device.toml --plot a.png -o a.nc",
            "scan device.toml --text A --lines a.csv -o b.nc --plot b.png",
            "speed device.toml --pitch 9mm --slowest 50mm/s",
            "sweep study.toml --threads 1",
            "sensitivity study.toml --threads 1 --rows 128",
            "robustness study.toml --threads 1 --draws 5",
        ):
            done = CliRunner().invoke(app, line.split())
            assert done.exit_code == 0, done.output
        os.chdir(before)
    gc.collect()
    gc.freeze()  # a collection in a fork would copy all of it


# ---- values --------------------------------------------------------------------------------------


def number(quantity: Quantity, rng: np.random.Generator) -> float:
    """A value of a quantity: at a bound, beyond it, within, or near a usual one."""
    lower, upper = quantity.bounds.lower, quantity.bounds.upper
    whole = quantity.name in ("columns", "rows", "turns")
    usual = quantity.default or quantity.example or (quantity.rows[-1][1] if quantity.rows else 1.0)
    usual = usual or 1.0
    low = max(lower, 1e-9 * abs(usual)) if lower > -inf else 1e-9 * abs(usual)
    high = upper if upper < inf else 1e9 * abs(usual)
    kind = rng.choice(("bound", "within", "near", "beyond"), p=(0.2, 0.3, 0.43, 0.07))
    if kind == "bound":
        ends = [end for end in (lower, upper) if abs(end) < inf]
        return float(rng.choice(ends or [low, high]))
    if kind == "within" and 0.0 < low < high:
        found = float(10.0 ** rng.uniform(log10(low), log10(high)))
        return float(round(found)) if whole else found
    if kind == "beyond":
        far = (0.0, -usual, 1e-300, 1e300, -1e300, np.nan, inf, 10.0 * high, 0.1 * low, 5e-324)
        return float(rng.choice(far))
    found = float(np.clip(usual * 10.0 ** rng.uniform(-1.5, 1.5), low, high))
    return float(max(1, round(found))) if whole else found


def written(quantity: Quantity, rng: np.random.Generator) -> str:
    """A value as TOML has it; rows where the quantity takes them."""
    if quantity.rows and (not quantity.may_be_constant or rng.random() < 0.4):
        return rows(quantity, rng)
    return text(number(quantity, rng), quantity.unit)


def text(value: float, unit: str) -> str:
    """A number with its unit, quoted."""
    return repr(value) if unit == "1" else f'"{value!r} {unit}"'


def rows(quantity: Quantity, rng: np.random.Generator) -> str:
    """Some rows, in order as a rule."""
    across, _ = (QUANTITIES[name] for name in COLUMNS[quantity.rows_of])
    count = int(rng.choice((1, 2, 3, 3, 20, 2000)))
    scale = 10.0 ** rng.uniform(-9.0, 4.0)
    first = np.sort(rng.random(count)) * scale
    if quantity.rows_of == "curve":
        first[0] = 0.0
    if rng.random() < 0.05:
        first = first[::-1]
    cells = (
        f"[{text(float(a), across.unit)}, {text(number(quantity, rng), quantity.unit)}]"
        for a in first
    )
    return f"[{', '.join(cells)}]"


# ---- files ---------------------------------------------------------------------------------------

BASE: dict[str, str] = {
    "drive.mass": '"10 g"',
    "drive.stiffness": '"100 N/m"',
    "drive.damping_ratio": "0.32",
    "plate.kinetic": '"22 mN"',
    "finger.kinetic": '"5 mN"',
    "control.latency": '"5 ms"',
    "scan.pause": '"20 ms"',
    "scan.text_height": '"4 mm"',
}
BESIDE = {"drive.damping": "drive.damping_ratio", "drive.damping_ratio": "drive.damping"}


def device(given: dict[str, str], varied: dict[str, str]) -> str:
    """A device file with these values, and what they need or exclude."""
    values = dict(BASE)
    coil = [*(f"magnet.{name}" for name in COIL), "magnet.voltage"]
    if any(key in coil for key in (*given, *varied)):
        for name in COIL_NEEDS:
            quantity = NUMERIC_KEYS[f"magnet.{name}"]
            values[quantity.key] = text(float(quantity.example or 1.0), quantity.unit)
        direct = [f"magnet.{name}" for name in DIRECT]
        given = {key: value for key, value in given.items() if key not in direct}
    for key in (*given, *varied):
        if key in given or key == "drive.damping":
            values.pop(BESIDE.get(key, ""), None)
        if key == "drive.damping":
            values[key] = '"0.3 N*s/m"'
        if key.endswith(".curve") and key in given:
            values.pop(key.replace("curve", "kinetic"), None)
        if "coefficient" in key or key == "finger.touch_force":  # in place of the forces
            table = key.partition(".")[0]
            values.pop(f"{table}.kinetic", None)
            values[f"{table}.coefficient"] = "0.2"
            if table == "finger":
                values["finger.touch_force"] = '"10 mN"'
        if key in ("magnet.pwm_frequency", "magnet.pwm_duty"):
            values |= {"magnet.pwm_frequency": '"500 Hz"', "magnet.pwm_duty": "0.5"}
    if "motion.skin_stretch" in (*given, *varied):
        values["finger.stiffness"] = '"300 N/m"'
    values |= given
    values.setdefault("motion.mouse_velocity", '"60 mm/s"')
    tables: dict[str, list[str]] = {}
    for key, value in values.items():
        table, _, name = key.partition(".")
        tables.setdefault(table, []).append(f"{name} = {value}")
    return "\n".join(f"[{table}]\n" + "\n".join(lines) for table, lines in tables.items()) + "\n"


def study_file(varied: dict[str, str], scans: bool, rng: np.random.Generator) -> str:
    """Return a study with the given keys."""
    lines = ['base = "device.toml"']
    if rng.random() < 0.08:
        lines.append(f"chunk = {rng.choice(COUNTS)}")
    axes, tolerances, sampled = [], [], False
    for key in varied:
        quantity = NUMERIC_KEYS[key]
        pair = [text(x, quantity.unit) for x in sorted(number(quantity, rng) for _ in range(2))]
        ends = f"[{', '.join(pair)}]"
        way = rng.choice(("list", "lin", "log", "uniform", "normal", "lognormal"))
        count = rng.choice(COUNTS) if rng.random() < 0.1 else "3"
        if way == "list":
            axes.append(f"{key} = {ends}")
        elif way in ("lin", "log"):
            axes.append(f"{key} = {{ {way} = {ends}, count = {count} }}")
        else:
            sampled = True
            ends = f"[{pair[0]}, 2.0]" if way == "lognormal" else ends
            axes.append(f"{key} = {{ {way} = {ends} }}")
        part = rng.choice(("5 %", "5 %", "50 %", "1e-9 %", "99.9 %", "1000 %"))
        wide = f'{{ normal = "{part}" }}' if rng.random() < 0.3 else f'"{part}"'
        if key in BASE or quantity.default is not None:
            tolerances.append(f"{key} = {wide}")
    if not tolerances:
        tolerances = ['plate.kinetic = "20 %"']
    if scans:
        lines.append(
            f'[page]\ngrating = ["{rng.choice(LENGTHS) if rng.random() < 0.2 else "2 mm"}"]'
        )
    lines += ["[axes]", *axes, "[tolerances]", *tolerances]
    if sampled or rng.random() < 0.05:
        count = rng.choice(COUNTS) if rng.random() < 0.3 else "4"
        method = rng.choice(("random", "sobol"))
        lines += ["[sample]", f"count = {count}", f'method = "{method}"']
    if rng.random() < 0.6:
        lines += ["[specification]", *specification(scans, rng)]
    return "\n".join(lines) + "\n"


def specification(scans: bool, rng: np.random.Generator) -> list[str]:
    """Some limits on results."""
    from pindrive.study.outputs import NUMBERS as RESULTS
    from pindrive.study.outputs import OUTPUTS, SCAN_OUTPUTS, is_measured

    among = [name for name in (SCAN_OUTPUTS if scans else OUTPUTS) if is_measured(name)]
    found = []
    for name in rng.choice(among, int(rng.integers(1, 3)), replace=False).tolist():
        unit = RESULTS[name].unit
        value: Any = rng.choice((0.0, 1e-3, 1.0, -1.0, 1e300, -1e300, 1e-300, 5e-324, inf, np.nan))
        sign = rng.choice(("<=", ">="))
        shown = f"{float(value)!r} {unit if unit != '1' else ''}".strip()
        found.append(f'{name} = "{sign} {shown}"')
    return found


# ---- options -------------------------------------------------------------------------------------


def options(command: str, scans: bool, rng: np.random.Generator) -> list[str]:
    """The arguments of a command; outputs now and then.

    Studies of many scans are no mistake, and take as long as they take: here they are cut short.
    """
    if command == "check":
        return ["device.toml"]
    if command == "simulate":
        kinds = (
            ["-o", "a.csv"],
            ["-o", "a.nc"],
            ["-o", "a.json"],
            ["--plot", "a.png"],
        )
        chosen = [part for kind in kinds if rng.random() < 0.12 for part in kind]
        samples = ["--samples", str(rng.choice(COUNTS))] if rng.random() < 0.1 else []
        return ["device.toml", *chosen, *samples]
    if command == "scan":
        if rng.random() < 0.6:
            page = ["--grating", str(rng.choice(LENGTHS)) if rng.random() < 0.2 else "3 mm, 1 mm"]
        else:
            page = ["--text", str(rng.choice(TEXTS)) if rng.random() < 0.4 else "A"]
        outputs = (("--lines", "a.csv", 0.2), ("-o", "a.nc", 0.1), ("--plot", "a.png", 0.06))
        chosen = [
            part for option, file, p in outputs if rng.random() < p for part in (option, file)
        ]
        return ["device.toml", *page, *chosen]
    if command == "speed":
        given = ["--pitch", str(rng.choice(LENGTHS)) if rng.random() < 0.2 else "3 mm"]
        for option, among in (
            ("--width", LENGTHS),
            ("--slowest", SPEEDS),
            ("--fastest", SPEEDS),
            ("--set", ("criteria.distinct=0.5", "criteria.distinct=0", "criteria.distinct=nan")),
        ):
            if rng.random() < 0.12:
                given += [option, str(rng.choice(among))]
        return ["device.toml", *given]
    if command == "sweep":
        return ["study.toml", "--threads", "1", *(["--stop-after", "4"] if scans else [])]
    option, few = {"sensitivity": ("--rows", "128"), "robustness": ("--draws", "5")}[command]
    count = str(rng.choice(COUNTS)) if rng.random() < 0.15 else few
    if scans and count == "1000000":
        count = few
    return ["study.toml", "--threads", "1", option, count]

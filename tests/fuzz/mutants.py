"""Whether fuzz sees what is wrong: the solver is spoiled in one place at a time, and must fail.

python3 tests/fuzz/mutants.py [COUNT]

Each mutant of the core is built beside the sources and runs COUNT drives (50 000) of seed 1, then
those of tests/hard. A mutant that passes them all, or whose text is no longer in the core, is an
error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Mutant:
    """One thing made wrong in one header."""

    what: str
    header: str
    text: str
    instead: str


MUTANTS = (
    Mutant(
        "breaks loose to the wrong side",
        "friction.hpp",
        "const auto slide = static_cast<ContactState>(side);",
        "const auto slide = static_cast<ContactState>(-side);",
    ),
    Mutant(
        "always sticks on arrival",
        "friction.hpp",
        "overload(stuck, now, x, skin_force) == side ?",
        "overload(stuck, now, x, skin_force) == 7 * side ?",
    ),
    Mutant(
        "crosses where a tenth of the capacity is left",
        "friction.hpp",
        "capacity(stuck, now).value + blur",
        "T(0.9) * capacity(stuck, now).value + blur",
    ),
    Mutant(
        "static friction of the plate is its kinetic friction",
        "friction.hpp",
        "sum = {drive_.plate.static_limit * now.load.value, "
        "drive_.plate.static_limit * now.load.rate};",
        "sum = {drive_.plate.kinetic * now.load.value, drive_.plate.kinetic * now.load.rate};",
    ),
    Mutant(
        "static friction of the finger is doubled",
        "friction.hpp",
        "if (stuck.finger == ContactState::stick) sum.value += drive_.finger.static_limit;",
        "if (stuck.finger == ContactState::stick) sum.value += 2 * drive_.finger.static_limit;",
    ),
    Mutant(
        "no inertial force",
        "friction.hpp",
        "const T inertia = drive_.mass * now.plate_velocity.rate, spring",
        "const T inertia = 0 * now.plate_velocity.rate, spring",
    ),
    Mutant(
        "a changing load acts as if it were constant",
        "friction.hpp",
        "sum.pull.rate -= force * load.rate;",
        "",
    ),
    Mutant(
        "of parting surfaces the finger is followed first",
        "friction.hpp",
        "{plate_first ? with_plate : with_finger, plate_first ? with_finger : with_plate}",
        "{with_finger, with_plate}",
    ),
    Mutant(
        "never thrown ahead of parting surfaces",
        "friction.hpp",
        "if (acceleration(ahead) > std::max(w, T(0))) return ahead;",
        "(void)ahead;",
    ),
    Mutant(
        "a curve's row is passed without a change",
        "simulation.hpp",
        "      index += step;\n",
        "      index += step > 0 ? 1 : 0;\n",
    ),
    Mutant(
        "skin grips with a thousandth more stretch",
        "simulation.hpp",
        "skin_ = sign(mode_.finger) * drive_.finger.kinetic;",
        "skin_ = sign(mode_.finger) * drive_.finger.kinetic * T(1.001);",
    ),
    Mutant(
        "skin slips only while the plate holds the pin",
        "simulation.hpp",
        "if (!Surface::plain && mode.finger == ContactState::elastic_stick)\n      holding(",
        "if (mode.finger == ContactState::elastic_stick && mode.plate == ContactState::stick)\n      holding(",
    ),
    Mutant(
        "the plate holds for ever",
        "simulation.hpp",
        "    if (mode.stuck())\n      holding(",
        "    if (mode.stuck() && mode.plate != ContactState::stick)\n      holding(",
    ),
    Mutant(
        "the rows of the load are overlooked",
        "simulation.hpp",
        "row_ = std::min(inputs_.mouse_velocity.next_row(time_), "
        "inputs_.plate_load.next_row(time_));",
        "row_ = inputs_.mouse_velocity.next_row(time_);",
    ),
    Mutant(
        "a cycle is closed a thousandth too soon",
        "model.hpp",
        "recurrence = 1e-14;",
        "recurrence = 1e-3;",
    ),
    Mutant(
        "every second zero of an oscillation is missed",
        "roots.hpp",
        "zeros_.first + count_ * zeros_.spacing;",
        "zeros_.first + 2 * count_ * zeros_.spacing;",
    ),
    Mutant(
        "the first root is passed over for the second",
        "roots.hpp",
        "      first = root;\n      return false;",
        "      const bool again = first < never;\n      first = root;\n      return !again;",
    ),
    Mutant(
        "a search is given up where even a growing oscillation turns",
        "roots.hpp",
        "      exhausted_ = shrinks();",
        "      exhausted_ = true;",
    ),
    Mutant(
        "what is out of reach is leapt over too far",
        "roots.hpp",
        "out_of_reach(oscillator, rest, side) * T(0.99)",
        "out_of_reach(oscillator, rest, side) * T(1.2)",
    ),
    Mutant(
        "eight swings too many of a growing oscillation are skipped",
        "roots.hpp",
        "const T periods = floor(log(short_of) / growth) - 1;",
        "const T periods = floor(log(short_of) / growth) + 3;",
    ),
    Mutant(
        "a zero is placed half a wave late",
        "flow.hpp",
        "if (angle <= 0) angle += pi;",
        "if (angle <= 0) angle += 2 * pi;",
    ),
    Mutant(
        "two growing waves are followed for long in one closed form",
        "flow.hpp",
        "return alpha_ > 0 && discriminant_ < 0 ? 3 / omega_",
        "return alpha_ > 0 && discriminant_ < 0 ? 60 / omega_",
    ),
    Mutant(
        "the series of the first instants is short",
        "flow.hpp",
        "n <= 14; ++n",
        "n <= 5; ++n",
    ),
)


def judged(mutant: Mutant, count: int, folder: Path) -> str:
    """How the mutant ends: what fuzz found, or an empty string if nothing."""
    include = folder / "include"
    shutil.copytree(ROOT / "include", include, dirs_exist_ok=True)
    header = include / "pindrive" / mutant.header
    source = header.read_text("utf-8")
    if source.count(mutant.text) != 1:
        raise SystemExit(f"{mutant.what}: its text is not once in {mutant.header}")
    header.write_text(source.replace(mutant.text, mutant.instead), "utf-8")
    compiler = os.environ.get("CXX", "c++")
    flags = ["-std=c++17", "-O1", "-ffp-contract=off", "-pthread", f"-I{include}"]
    program = ROOT / "tests" / "fuzz" / "fuzz.cpp"
    subprocess.run([compiler, *flags, str(program), "-o", str(folder / "fuzz")], check=True)
    for drives in (100, count):  # few are enough for most
        command = [str(folder / "fuzz"), str(drives), "1"]
        try:
            result = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, timeout=300, check=False
            )
        except subprocess.TimeoutExpired:
            return f"{drives} drives do not end"
        if result.returncode not in (0, 1):
            return f"dies with status {result.returncode}"
        failed = result.stdout.splitlines()[-1].split()
        if int(failed[1]) > 0:
            return f"{failed[1]} of {drives} drives fail, case {failed[2]} first"
    hard = sorted((ROOT / "tests" / "hard").glob("*.txt"))
    command = [str(folder / "fuzz"), "--replay", *map(str, hard)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    return result.stdout.splitlines()[-1] if result.returncode else ""


def main(arguments: list[str]) -> int:
    """Judges every mutant; 1 if one passes."""
    count = int(arguments[0]) if arguments else 50_000
    passed = 0
    for mutant in MUTANTS:
        with tempfile.TemporaryDirectory() as folder:
            found = judged(mutant, count, Path(folder))
        passed += not found
        print(f"{mutant.what}: {found or 'NOT SEEN'}", flush=True)
    print(f"{len(MUTANTS)} mutants, {passed} not seen")
    return 1 if passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

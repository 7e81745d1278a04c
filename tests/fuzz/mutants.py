"""Mutation test of the core: a change in one place must make fuzz fail.

python3 tests/fuzz/mutants.py [COUNT [PART...]]

Each mutant of the core is built beside the sources and runs COUNT drives (50 000) of seed 1, then
those of tests/hard; a mutant of the device layer runs the C++ test of its header. With PARTs only
those mutants whose name has one of them. A mutant that passes them all, or whose text is not in
the core exactly once, is an error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ROOT / "include" / "pindrive"


@dataclass(frozen=True)
class Mutant:
    """One thing made wrong in one header."""

    what: str
    header: str
    text: str
    instead: str


MUTANTS = (
    Mutant(
        "a cycle's period is a thousandth too long",
        "events/recurrence.hpp",
        "outcome.period = (now.time - begin.time) +",
        "outcome.period = (now.time - begin.time) * T(1.001) +",
    ),
    Mutant(
        "a motion is steady before it repeats",
        "motion/steady_since.hpp",
        "const T tolerance = T(repeat_tolerance) * amplitude();",
        "const T tolerance = T(1e-3) * amplitude();",
    ),
    Mutant(
        "a motion is steady from where its period was found on",
        "motion/steady_since.hpp",
        "for (T since = known_; since > last_breakpoint_ && go_on_();) {",
        "for (T since = known_; since > last_breakpoint_ && go_on_();) {\n"
        "      if (known_ > 0) return known_;",
    ),
    Mutant(
        "breaks away and crosses to the wrong side",
        "law/contact_point.hpp",
        "return inwards > 0 ||",
        "return inwards < 0 ||",
    ),
    Mutant(
        "always sticks at a surface velocity",
        "law/selection.hpp",
        "if (limit.value - abs(force) < -error && (force",
        "if (limit.value > 1e99 && (force",
    ),
    Mutant(
        "slips where a tenth of the stick limit is left",
        "law/selection.hpp",
        "const T force = holding_force(on, other.force(pin_.state));\n    const int at_limit",
        "const T force = holding_force(on, other.force(pin_.state)) / T(0.9);\n"
        "    const int at_limit",
    ),
    Mutant(
        "static friction of the sticking contact is its kinetic friction",
        "law/selection.hpp",
        "const T own_limit = on.contact.static_limit;",
        "const T own_limit = on.contact.kinetic;",
    ),
    Mutant(
        "static friction is doubled where both stick",
        "law/selection.hpp",
        "other.stuck() ? other.contact.static_limit : T(0)",
        "other.stuck() ? own_limit + 2 * other.contact.static_limit : T(0)",
    ),
    Mutant(
        "no inertial force",
        "law/selection.hpp",
        "applied_force = pin_.drive.mass * pin_.plate.surface.rate;",
        "applied_force = 0 * pin_.plate.surface.rate;",
    ),
    Mutant(
        "a changing load acts as if it were constant",
        "law/contact_point.hpp",
        "Force<T> law{{force * load.value, force * load.rate}};",
        "Force<T> law{{force * load.value, T(0)}};",
    ),
    Mutant(
        "of two contacts the first is not asked whether it sticks",
        "law/selection.hpp",
        "if (first.may_stick() && try_stick_beside(first, second, 0)) return true;",
        "",
    ),
    Mutant(
        "parting surfaces never throw the pin ahead of both",
        "law/selection.hpp",
        "if (relative != 0) return !side.stuck() && side",
        "if (relative != 0) return side.stuck() || side",
    ),
    Mutant(
        "the skin does not pull on a pin at its stick limit",
        "law/selection.hpp",
        "const T holding = stiffness_with_skin() * surface",
        "const T holding = stiffness() * surface",
    ),
    Mutant(
        "the terms of a function cancel where it begins",
        "model/input_function.hpp",
        "      if (turned_by(term, tau) < begun) {",
        "      if (turned_by(term, tau) < 0) {",
    ),
    Mutant(
        "a guard at its zero is not asked by its derivatives",
        "law/selection.hpp",
        "if (first < 0) return false;",
        "",
    ),
    Mutant(
        "a stick force leaves its limit by its second derivative at most",
        "law/selection.hpp",
        "third_or_later(margin)",
        "T(0)",
    ),
    Mutant(
        "a tangential departure goes on although another force jumps",
        "law/contact_point.hpp",
        "if (contact.kinetic != contact.static_limit && load.value != 0) return false;",
        "",
    ),
    Mutant(
        "the force at a breakpoint is that of the wrong branch",
        "law/contact_point.hpp",
        "contact.branch(faster ? mode.branch + 1 : mode.branch).force",
        "contact.branch(faster ? mode.branch : mode.branch - 1).force",
    ),
    Mutant(
        "a breakpoint is passed without a change",
        "law/contact_point.hpp",
        "mode.branch + (faster ? 1 : -1),",
        "mode.branch + (faster ? 1 : 0),",
    ),
    Mutant(
        "skin sticks with a thousandth more stretch",
        "law/contact_point.hpp",
        "if (start.shortens_skin) s.skin = skin_tension(s);",
        "if (start.shortens_skin) s.skin = skin_tension(s);\n"
        "    if (elastic() && before != mode.state) s.skin *= T(1.001);",
    ),
    Mutant(
        "skin slips only while the plate holds the pin",
        "law/guards.hpp",
        "    if (side.elastic()) {\n      const Path<T> limit",
        "    if (side.elastic() && segment.mode.plate == ContactState::stick) {\n"
        "      const Path<T> limit",
    ),
    Mutant(
        "skin slips at its limit though it turns back",
        "law/contact_point.hpp",
        "if (faster == 0) return slip_sign * decides >= 0;",
        "if (faster == 0) return slip_sign * decides > 0;",
    ),
    Mutant(
        "the plate holds for ever",
        "law/selection.hpp",
        "selected_.guards.add_force(margin,",
        "if (!pin_.plate.stuck()) selected_.guards.add_force(margin,",
    ),
    Mutant(
        "the breakpoints of the load are overlooked",
        "model/model.hpp",
        "mouse_velocity.next_breakpoint(t), plate_load.next_breakpoint(t),",
        "mouse_velocity.next_breakpoint(t),",
    ),
    Mutant(
        "of two bounds the farther one is watched",
        "law/guards.hpp",
        "if (path.start > other.path.start) return;",
        "if (path.start < other.path.start) return;",
    ),
    Mutant(
        "a cycle is closed a thousandth too soon",
        "numbers/limits.hpp",
        "return_tolerance = 1e-12;",
        "return_tolerance = 1e-3;",
    ),
    Mutant(
        "every second zero of an oscillation is missed",
        "flow/oscillator.hpp",
        "first + index * spacing;",
        "first + 2 * index * spacing;",
    ),
    Mutant(
        "the first root is passed over for the second",
        "flow/roots.hpp",
        "      first = root;\n      return false;",
        "      const bool again = first < never;\n      first = root;\n      return !again;",
    ),
    Mutant(
        "a search is given up where even a growing oscillation turns",
        "flow/roots.hpp",
        "      exhausted_ = shrinks();",
        "      exhausted_ = true;",
    ),
    Mutant(
        "what is out of reach is leapt over too far",
        "flow/roots.hpp",
        "out_of_reach(oscillator, rest, side) * T(0.99)",
        "out_of_reach(oscillator, rest, side) * T(1.2)",
    ),
    Mutant(
        "eight swings too many of a growing oscillation are skipped",
        "flow/roots.hpp",
        "const T periods = floor(log(short_of) / growth) - 1;",
        "const T periods = floor(log(short_of) / growth) + 3;",
    ),
    Mutant(
        "a zero is placed half a wave late",
        "flow/oscillator.hpp",
        "if (angle <= 0) angle += pi;",
        "if (angle <= 0) angle += 2 * pi;",
    ),
    Mutant(
        "two growing waves are followed for long in one closed form",
        "flow/oscillator.hpp",
        "return alpha_ > 0 && discriminant_ < 0 ? 3 / omega_",
        "return alpha_ > 0 && discriminant_ < 0 ? 60 / omega_",
    ),
    Mutant(
        "the series of the first instants is short",
        "flow/oscillator.hpp",
        "n <= 14; ++n",
        "n <= 5; ++n",
    ),
    Mutant(
        "the load of a series falls where it should rise",
        "series/series_inputs.hpp",
        "c_[1] = curve.rate * step;",
        "c_[1] = -curve.rate * step;",
    ),
    Mutant(
        "a step of a series begins without its acceleration",
        "events/series_segment.hpp",
        "{velocity, T(0), T(0), rate}",
        "{velocity, T(0), T(0), 0 * rate}",
    ),
    Mutant(
        "a motion in closed form under functions is damped the wrong way",
        "series/driven_motion.hpp",
        "t.frequency * (b - 2 * a * t.decay)",
        "t.frequency * (2 * a * t.decay - b)",
    ),
    Mutant(
        "a growing oscillation is bounded by its begin",
        "series/term_sum.hpp",
        "(decay < 0 ? exp(-decay * length) : Real(1))",
        "Real(1)",
    ),
    Mutant(
        "skin without static friction carries nothing until the next breakpoint",
        "law/skin.hpp",
        "const T round = point.stretch_rate(largest_friction(contact, 2 * u));",
        "const T round = most;",
    ),
    Mutant(
        "a plate that comes to rest along and across turns before it does",
        "model/input_curves.hpp",
        "if (held && along.rate != 0 &&",
        "if (held && along.rate != 0 && time < 0 &&",
    ),
    Mutant(
        "the slider of a load that grows from zero does not follow the growth",
        "series/series_equation.hpp",
        "(skin_decay + turns);",
        "skin_decay;",
    ),
    Mutant(
        "skin without static friction sticks a pin at rest as its load grows from none",
        "law/skin.hpp",
        "if (must_jump_ && jump.sticks && u_ != 0)",
        "if (must_jump_ && jump.sticks)",
    ),
    Mutant(
        "a slider of stiff skin is slow whatever speed it begins at",
        "series/slow_slider.hpp",
        "    if (!within_step && !starts_from(start)) return;\n",
        "",
    ),
    # This one is seen by the mirror alone …
    Mutant(
        "of the limits of skin, the upper one is looked at first",
        "law/guards.hpp",
        "const int near = -leading_sign(segment.finger_force);",
        "const int near = 1;",
    ),
    Mutant(
        "damped skin pulls by its stretch alone",
        "law/contact_point.hpp",
        "s.v - s.skin, T(0)}, contact.damping, contact.stiffness, T(0)};",
        "s.v - s.skin, T(0)}, T(0), contact.stiffness, T(0)};",
    ),
    Mutant(
        "damped skin does not feel that a stop takes the velocity",
        "events/evolution.hpp",
        "if (pin.drive.finger.damped()) pin.state.skin -= pin.drive.finger.damping * arrives;",
        "",
    ),
    Mutant(
        "the slider of damped skin does not follow the acceleration of the pin",
        "series/series_mode.hpp",
        "e.skin_damping = drive_.finger.damping;",
        "e.skin_damping = T(0);",
    ),
    Mutant(
        "damped skin begins to slip from rest",
        "law/damped_skin.hpp",
        "+ (tension - tension_at_begin(branch)) / rise(branch);",
        "+ T(0.5) * (tension - tension_at_begin(branch)) / rise(branch);",
    ),
    Mutant(
        "damped skin grips whatever moves it",
        "law/contact_point.hpp",
        "const T damped = sign * by_damping(first), unloads = stretch_rate(friction);",
        "const T damped = T(0), unloads = stretch_rate(friction);",
    ),
    # … and these two where a motion is cut in two.
    Mutant(
        "skin that is given is a thousandth tighter",
        "events/evolution.hpp",
        "state.skin = drive.finger.stiffness * inputs.skin_stretch;",
        "state.skin = T(1.001) * drive.finger.stiffness * inputs.skin_stretch;",
    ),
    Mutant(
        "a pin beyond an elastic stop at the start is pushed, whether it comes back or not",
        "law/stops.hpp",
        "state = at_end(end, push(s, end) > 0);",
        "state = at_end(end, true);",
    ),
    Mutant(
        "luminance of the pixel to the left",
        "device/raster.hpp",
        "upper[i] * (1 - u) + upper[next] * u",
        "upper[i] * u + upper[next] * (1 - u)",
    ),
    Mutant(
        "the page ends within its border",
        "device/raster.hpp",
        "static constexpr double border = 1e-9;",
        "static constexpr double border = 0;",
    ),
    Mutant(
        "velocities are integrated from the end of a stretch",
        "device/hand_path.hpp",
        "since * (v[i] + 0.5 *",
        "since * (v[i + 1] + 0.5 *",
    ),
    Mutant(
        "a rest of the hand is no turn",
        "device/hand_path.hpp",
        "if (i > 0 && speed.row(i) == 0",
        "if (i > 0 && speed.row(i) == 1",
    ),
    Mutant(
        "rounding across the axis is a turn",
        "device/hand_path.hpp",
        "speed.drop(across * most);",
        "",
    ),
    Mutant(
        "a sign change is found to half a bracket",
        "device/sign_change.hpp",
        "const bool neighbours = half <= low || high <= half;",
        "const bool neighbours = half <= low + 1e-9 || high <= half;",
    ),
    Mutant(
        "lines are where it is bright",
        "device/printed_lines.hpp",
        "lightness(spot, t, i) < 0;",
        "lightness(spot, t, i) > 0;",
    ),
    Mutant(
        "a line on which the hand turns is whole",
        "device/printed_lines.hpp",
        "return line.begin < t && t < line.end;",
        "return t < line.begin && line.end < t;",
    ),
    Mutant(
        "grazed gaps part lines",
        "device/printed_lines.hpp",
        "way.between(found.back().end, at[i]) > shortest",
        "true",
    ),
    Mutant(
        "sure directions count with all",
        "device/scan_evaluation.hpp",
        "if (line.begin.cue >= Cue::sure) ++found.sure;",
        "if (line.begin.cue >= Cue::direction) ++found.sure;",
    ),
    Mutant(
        "the larger of the middle values for the median",
        "device/scan_evaluation.hpp",
        "0.5 * (known[half - 1] + known[half])",
        "known[half]",
    ),
    Mutant(
        "the last phase for the worst",
        "device/two_lines.hpp",
        "trial.back = std::min(trial.back, part_back(first));",
        "trial.back = part_back(first);",
    ),
    Mutant(
        "lines that merge count as apart",
        "device/two_lines.hpp",
        "second.outcome == LineOutcome::shown",
        "second.pin >= 0",
    ),
    Mutant(
        "a line is distinct as soon as its return is felt",
        "device/pin_evaluation.hpp",
        "std::max(setting_.criteria.felt, setting_.criteria.distinct * way)",
        "std::max(setting_.criteria.felt, 0 * way)",
    ),
    Mutant(
        "a border of a speed is found to a tenth",
        "device/speed_limit.hpp",
        "fast - slow > search_.precision * slow",
        "fast - slow > 0.1 * slow",
    ),
    Mutant(
        "the highest value is that of a begin",
        "device/monotone_pieces.hpp",
        "if (b.value > end.value) end = b;",
        "",
    ),
    Mutant(
        "a climb is counted from the first value",
        "device/monotone_pieces.hpp",
        "if (a.value <= low.value) low = a;",
        "if (low.value == infinity) low = a;",
    ),
    Mutant(
        "the first instant beyond a band for the last",
        "device/monotone_pieces.hpp",
        "if (beyond(a.value)) low = a.time",
        "if (beyond(a.value) && std::isnan(low)) low = a.time",
    ),
    Mutant(
        "swings of one rise are apart",
        "device/monotone_pieces.hpp",
        "if (rising)\n          found.back().high = b;\n        else\n",
        "",
    ),
    Mutant(
        "an instant without load joins two touches",
        "device/evaluation.hpp",
        "if (at_begin && !found.empty()",
        "if (!found.empty()",
    ),
    Mutant(
        "a heavily damped pin settles in half a period",
        "device/evaluation.hpp",
        "if (!(ratio > 1)) return half_period;",
        "return half_period;",
    ),
    Mutant(
        "unseen lines are merged",
        "device/pin_evaluation.hpp",
        "seen ? LineOutcome::merged : LineOutcome::unseen",
        "seen ? LineOutcome::unseen : LineOutcome::merged",
    ),
    Mutant(
        "a stroke from zero",
        "device/pin_evaluation.hpp",
        "found.stroke = peak.value - pieces_.at(x, first->dip);",
        "found.stroke = 2 * peak.value;",
    ),
    Mutant(
        "the lag of the hand is counted from the switching",
        "device/pin_evaluation.hpp",
        "setting_.way->between(edge.time, edge.response)",
        "setting_.way->between(edge.command, edge.response)",
    ),
    Mutant(
        "smear from the begin of the scan",
        "device/pin_evaluation.hpp",
        "setting_.way->between(found.release, found.settled)",
        "setting_.way->between(origin_, found.settled)",
    ),
    Mutant(
        "false lines of any height",
        "device/pin_evaluation.hpp",
        "if (swing.height() < std::max(usual, least)) continue;",
        "",
    ),
    Mutant(
        "swings of a magnet are false lines",
        "device/pin_evaluation.hpp",
        "        before = heights[pull - pulls_.data()];\n        continue;",
        "        before = heights[pull - pulls_.data()];",
    ),
    Mutant(
        "a lifted finger feels",
        "device/pin_evaluation.hpp",
        "if (!(begin < end)) continue;",
        "if (!(begin < end)) return skin_motion_in_touch(skin, from, to);",
    ),
    Mutant(
        "a coil does not warm in a piece",
        "device/electromagnet.hpp",
        "return most > 0 ? now + 0.5",
        "return most > 1e9 ? now + 0.5",
    ),
    Mutant(
        "a warming coil is one piece",
        "device/electromagnet.hpp",
        "return rate > 0 ? T(resistance_step / (copper_rise * rate)) : infinity;",
        "return infinity;",
    ),
    Mutant(
        "a pull without its slow exponential",
        "device/electromagnet.hpp",
        "2 * whole * target * swing",
        "whole * target * swing",
    ),
    Mutant(
        "the flux decides nothing at the closing",
        "device/electromagnet.hpp",
        "const bool closed = start > edge || (start == edge && target > edge);",
        "const bool closed = start > edge;",
    ),
    Mutant(
        "a pulse begins where rounding has it",
        "device/coil.hpp",
        "if ((number + 1) / frequency <= time) return number + 1;  // rounded down",
        "",
    ),
    Mutant(
        "a voltage step is counted from zero",
        "device/coil.hpp",
        "return next < steps.size() ? state_.commanded + steps[next].time : infinity;",
        "return next < steps.size() ? steps[next].time : infinity;",
    ),
    Mutant(
        "a command after the pulse at its time",
        "device/coil_course.hpp",
        "for (T time = coil.next(); time < to && !full(); time = coil.next()) {",
        "for (T time = coil.next(); time <= to && !full(); time = coil.next()) {",
    ),
    Mutant(
        "a sample at the end",
        "device/controller.hpp",
        "if (begin <= time && time < end && !visit(time)) return;",
        "if (begin <= time && time <= end && !visit(time)) return;",
    ),
    Mutant(
        "no hysteresis",
        "device/controller.hpp",
        "return on && !(luminance > threshold + 0.5 * hysteresis);",
        "return false;",
    ),
    Mutant(
        "two gaps are one",
        "device/magnet_construction.hpp",
        "return magnetic_constant * turns * turns * pole_area / (2 * gap);",
        "return magnetic_constant * turns * turns * pole_area / gap;",
    ),
    Mutant(
        "a switching that is due is forgotten",
        "device/scan.hpp",
        "std::vector<double> due = from.pending;",
        "std::vector<double> due;",
    ),
    Mutant(
        "skin keeps any stretch",
        "device/scan_inputs.hpp",
        "    return std::copysign(finger.kinetic * pressed / finger.stiffness, stretch);",
        "    return stretch;",
    ),
    Mutant(
        "switchings that are due are foreseen",
        "device/pin_follower.hpp",
        "const double horizon = std::min(coil_.next() - begin_, scan.next_row(passed_));",
        "const double horizon = next(scan);",
    ),
    Mutant(
        "the coil that a pin kept is not saturated yet",
        "device/pin_follower.hpp",
        "    while (coil.next() - begin <= time) coil.pass(coil.next());\n",
        "",
    ),
    Mutant(
        "an acceleration is bounded by its begin",
        "device/closest_approach.hpp",
        "return detail::hypot(now, jerk / std::sqrt(oscillator.omega0_squared())) * growth;",
        "return std::abs(now) * growth;",
    ),
    Mutant(
        "a closest approach is at a knot",
        "device/closest_approach.hpp",
        "    visit(middle, value);\n",
        "",
    ),
)


def problems(mutants: Sequence[Mutant]) -> list[str]:
    """Return the mutants whose text does not occur exactly once in the core."""
    found = []
    for mutant in mutants:
        source = (HEADERS / mutant.header).read_text("utf-8")
        times = source.count(mutant.text)
        if times != 1:
            found.append(f"{mutant.what}: its text is {times} times in {mutant.header}, not once")
        if mutant.instead == mutant.text:
            found.append(f"{mutant.what}: it changes nothing")
    return found


def judged(mutant: Mutant, count: int, folder: Path) -> str:
    """Return the detection of the mutant by its test or by fuzz, or an empty string."""
    include = folder / "include"
    shutil.copytree(ROOT / "include", include, dirs_exist_ok=True)
    header = include / "pindrive" / mutant.header
    source = header.read_text("utf-8")
    header.write_text(source.replace(mutant.text, mutant.instead), "utf-8")
    compiler = os.environ.get("CXX", "c++")
    flags = ["-std=c++17", "-O1", "-ffp-contract=off", "-pthread", f"-I{include}"]
    layer, _, name = mutant.header.removesuffix(".hpp").partition("/")
    if layer == "device":
        test, program = ROOT / "tests" / "cpp" / f"{name}_test.cpp", folder / "test"
        flags.append(f"-I{ROOT / 'tests' / 'fuzz'}")
        subprocess.run([compiler, *flags, str(test), "-o", str(program)], check=True)
        try:
            result = subprocess.run(
                [program], capture_output=True, text=True, timeout=60, check=False
            )
        except subprocess.TimeoutExpired:
            return "its test does not end"
        failed = [line for line in result.stdout.splitlines() if line.startswith("FAIL")]
        return "; ".join(failed) or (f"status {result.returncode}" if result.returncode else "")
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
    """Evaluate every mutant, or the named ones; 1 if one is not detected."""
    count = int(arguments[0]) if arguments else 50_000
    parts = arguments[1:]
    chosen = [one for one in MUTANTS if not parts or any(part in one.what for part in parts)]
    unknown = [part for part in parts if not any(part in one.what for one in MUTANTS)]
    wrong = problems(MUTANTS) + [f"{part}: no mutant's name has it" for part in unknown]
    if wrong:
        raise SystemExit("\n".join(wrong))
    passed = 0
    for mutant in chosen:
        with tempfile.TemporaryDirectory() as folder:
            found = judged(mutant, count, Path(folder))
        passed += not found
        print(f"{mutant.what}: {found or 'NOT SEEN'}", flush=True)
    print(f"{len(chosen)} mutants, {passed} not seen")
    return 1 if passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

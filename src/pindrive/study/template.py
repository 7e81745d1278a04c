"""Template of a study file: a device, varied keys, and the rest as comments."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from pindrive.files.keys import DRIVE, FILE_KEYS, line
from pindrive.quantities.device import READER

_RELEASES: Final = """\
[axes]
# Every combination of these is computed: 19 x 15 x 3 releases.
motion.mouse_velocity = { lin = ["20 mm/s", "200 mm/s"], count = 19 }
plate.kinetic = { lin = ["15 mN", "29 mN"], count = 15 }
drive.damping_ratio = [0.04, 0.16, 0.32]

[tolerances]
# How far the values of a built device are from those above, for `robustness`, and for `sensitivity`
# with --tolerances: either way, or as a normal distribution with this standard deviation.
plate.kinetic = "25 %"
finger.kinetic = "50 %"
drive.mass = { normal = "2 %" }
drive.stiffness = { normal = "5 %" }
motion.mouse_velocity = { normal = "15 %" }

[specification]
# What a good design meets, for `robustness`.
settling_time = "<= 130 ms"
swing = ">= 2.5 mm"
"""
_SCANS: Final = """\
[page]
# What the hand moves over: four lines each, half as wide as they are apart. Or text = "Hello", or
# image = "page.png".
grating = ["4 mm", "2 mm"]

[axes]
# Every combination of these is computed: 5 x 3 x 2 scans.
scan.hand_speed = { lin = ["30 mm/s", "150 mm/s"], count = 5 }
magnet.fall_time = { lin = ["3 ms", "15 ms"], count = 3 }
finger.touch_force = ["40 mN", "80 mN"]

[tolerances]
# How far the values of a built device are from those above, for `robustness`, and for `sensitivity`
# with --tolerances: either way, as a normal distribution with this standard deviation, or between
# two values.
finger.touch_force = "50 %"
finger.load_exponent = { uniform = [0.7, 1.1] }
plate.coefficient = "15 %"
control.latency = { uniform = ["2 ms", "10 ms"] }
scan.hand_speed = { normal = "15 %" }

[specification]
# What a good design meets, for `robustness`.
worst_lag_on = "<= 1 mm"
shown_part = ">= 0.9"
"""
_SAMPLE: Final = """\
# Random draws, or a Sobol' sequence, in place of even steps: write a distribution in [axes], as in
#   drive.mass = { uniform = ["8 g", "12 g"] }
# and how many here.
# [sample]
# method = "sobol"
# count = 1024
# seed = 1
"""
_ONE_PIN: Final = ("array.columns", "array.rows")


def study_template(*, whole: bool = False) -> str:
    """A commented study file that holds its device, as `pindrive init --study` writes it.

    Args:
        whole: A study of scans with the whole device, as `pindrive init --study --device` writes
            it; of single releases otherwise.
    """
    what = "scans over a page" if whole else "single releases"
    head = [
        f"# A study for pindrive: {what}, each with other values of the device.",
        "# `outputs` names the numbers to keep; unless it does, all that the values can change.",
        "",
        'name = "my study"',
        '# outputs = ["worst_lag_on", "shown_part"]' if whole else '# outputs = ["settling_time"]',
        "",
        *device_lines(whole=whole),
    ]
    return "\n".join([*head, "", _SCANS if whole else _RELEASES, _SAMPLE])


def device_lines(*, whole: bool) -> list[str]:
    """The device as tables of a study or a design problem, one pin where it is a whole one."""
    lines = [
        '# The device. A line base = "device.toml" in place of these tables takes it from a file;',
        f"# `pindrive init device.toml{' --device' if whole else ''}` writes one with all keys.",
    ]
    if whole:
        lines.append("# [array] has neither columns nor rows: one pin, which takes the least time.")
    table = ""
    for key, quantity in (FILE_KEYS if whole else DRIVE).items():
        if whole:
            quantity = replace(quantity, **READER.get(key, {}))
        kept = key not in _ONE_PIN and not key.startswith("criteria.")
        if quantity.default is None or not kept:
            continue
        if key.partition(".")[0] != table:
            table = key.partition(".")[0]
            lines += ["", f"[{table}]"]
        lines.append(line(quantity))
    return lines

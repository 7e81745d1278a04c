"""Template of a problem file: device, variables, constraints and goals."""

from __future__ import annotations

from typing import Final

from pindrive.study.template import device_lines

_RELEASES: Final = """\
[axes]
# What may vary: a range, a range over decades, or a list of which one is chosen.
drive.stiffness = { loguniform = ["30 N/m", "600 N/m"] }
drive.damping_ratio = { uniform = [0.02, 0.6] }
finger.kinetic = { uniform = ["2 mN", "30 mN"] }

# [catalogues]
# Parts that can be bought: a CSV with columns part, keys of the device with units, and price, like
# "part, drive.stiffness [N/m], price". Leave its keys out of [axes]; price is then a number, too.
# spring = "springs.csv"

[conditions]
# Under which each constraint must be met, and each goal counts by its worst.
motion.mouse_velocity = { uniform = ["50 mm/s", "150 mm/s"] }

[specification]
# What is required. With yield = ">= 95 %", of so many of those that are built within [tolerances].
peak_displacement = ">= 2.1 mm"
trough_displacement = ">= -1.5 mm"

[tolerances]
# How far the values of a built device are from those of the design.
drive.stiffness = "5 %"
drive.damping_ratio = "10 %"
finger.kinetic = "20 %"

[goals]
# One to three numbers: minimise = [...] and maximise = [...]. With more than one, a front.
minimise = "settling_time"
"""
_SCANS: Final = """\
[page]
# What the hand moves over: lines so far apart, half as wide.
grating = ["3 mm"]

[axes]
# What may vary: a range, a range over decades, or a list of which one is chosen.
drive.stiffness = { loguniform = ["100 N/m", "1000 N/m"] }
drive.damping_ratio = { uniform = [0.1, 1.0] }
magnet.hold_force = { uniform = ["0.5 N", "2 N"] }
control.latency = { uniform = ["2 ms", "10 ms"] }

[specification]
# What is required, at the hand speed of the device.
worst_overshoot = "<= 2 %"
worst_stroke = ">= 0.5 mm"

[goals]
# One to three numbers; this one is the largest hand speed at which the lines stay distinct.
maximise = "distinct_speed"
"""


def problem_template(*, whole: bool = False) -> str:
    """A commented problem file that holds its device, as `pindrive init --problem` writes it.

    Args:
        whole: A design problem for a whole device, which is scanned; for single releases otherwise.
    """
    head = [
        "# A design problem for pindrive: variables, constraints and goals of a device.",
        "",
        'name = "my design"',
        "",
        *device_lines(whole=whole),
    ]
    return "\n".join([*head, "", _SCANS if whole else _RELEASES])

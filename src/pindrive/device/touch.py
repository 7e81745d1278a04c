"""Touch of the finger during a scan: its factor on the usual touch, and times of contact."""

from __future__ import annotations

from itertools import pairwise
from math import copysign, inf

from pindrive.motion.drive import Drive, values_of
from pindrive.motion.profile import Profile
from pindrive.motion.release import initial, input_of
from pindrive.quantities.contradictions import refuse


def finger_load(drive: Drive, touch: float | str | Profile | None, begin: float) -> float | Profile:
    """The touch over the usual one, over the time since `begin`.

    Args:
        drive: Drive of each pin, with the friction under its `touch_force`.
        touch: Touch force, N, over the time of the scan; None: that of the drive.
        begin: Begin of the scan, s.

    Raises:
        ValueError: A value is not a number or out of its range, or friction does not follow it.
    """
    if touch is None:
        return 1.0
    given = input_of("touch", touch)
    rows = given.rows if isinstance(given, Profile) else given
    refuse(values_of(drive) | {"scan.touch": rows}, whole=True)
    usual = drive.touch_force
    assert usual
    if not isinstance(given, Profile):
        return given / usual
    return Profile([t - begin for t in given.times], [force / usual for force in given.values])


def spans(load: float | Profile) -> list[tuple[float, float]]:
    """From when to when a finger under a load touches, s; in between it is lifted."""
    if not isinstance(load, Profile):
        return [(-inf, inf)] if load > 0.0 else []
    first, last = load.values[0], load.values[-1]
    rows = [(-inf, first), *load.rows, (inf, last)]
    found: list[tuple[float, float]] = []
    for (begin, y), (end, z) in pairwise(rows):
        if end > begin and max(y, z) > 0.0:
            if found and found[-1][1] == begin and y > 0.0:
                begin, _ = found.pop()
            found.append((begin, end))
    return found


def held_stretch(stretch: float, drive: Drive, load: float | Profile) -> float:
    """Return the skin stretch (m) kept as a load begins: beyond it, undamped skin slips at once."""
    finger, pressed = drive.finger, initial(load) ** drive.load_exponent
    if finger.damping or abs(stretch) <= finger.static_friction * pressed / finger.stiffness:
        return stretch
    return copysign(finger.kinetic * pressed / finger.stiffness, stretch)

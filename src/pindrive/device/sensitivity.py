"""Derivatives of a pin's motion in a scan by parameters of its device."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from pindrive import _core
from pindrive.device.current import Numbers
from pindrive.motion.core_numbers import PLACES, CoreNumbers, mapped, replaced
from pindrive.motion.friction import PRESSED_BY, normal_force_by
from pindrive.motion.function import Function
from pindrive.motion.motion import Motion
from pindrive.motion.release import rows_of
from pindrive.motion.sensitivity import Sensitivity, direction_of, key_as_name

if TYPE_CHECKING:
    from pindrive.device.pin_scan import PinScan

_LATENCY: Final = "control.latency"


def sensitivity_of(pin: PinScan, parameters: Sequence[str]) -> Sensitivity:
    """Derivatives of the motion of a pin, as `PinScan.sensitivity` returns them."""
    return Sensitivity(pin.motion, parameters, partial(_direction, pin))


def _direction(pin: PinScan, motion: Motion, name: str) -> tuple[CoreNumbers, float]:
    """Return the derivative of the core's numbers by a parameter, and the size of the parameter."""
    device, drive = pin.inputs.device, pin.drive
    numbers, levels = device.magnet.core_numbers
    magnet: Numbers = [0.0] * len(numbers), [(time, 0.0) for time, _ in levels]
    pressed, delay, of_magnet = 0.0, 0.0, name.startswith("magnet.")
    own, touched = name, dict[str, float]()
    along: CoreNumbers = mapped(lambda _: 0.0, motion.core_numbers)
    if name == _LATENCY:
        delay, size = 1.0, device.control.latency or 1.0 / device.control.sample_rate
    elif of_magnet:
        magnet, size = device.magnet.core_derivative(name)
    else:
        own = key_as_name(name).removeprefix("drive.")
        if own in PRESSED_BY["plate"]:
            pressed = normal_force_by("plate", own, partial(getattr, drive))
            touched = {"touch_share": drive.touch_force or 0.0, "touch_force": drive.touch_share}
        if own in ("preload", "touch_share") and drive.plate.coefficient is None:
            size = getattr(drive, own) or drive.normal_force
        else:
            along, size = direction_of(motion, name)
    if of_magnet or pressed or delay:
        load = _load_along(pin, magnet, (pressed, touched.get(own, 0.0)), delay)
        along = replaced(along, PLACES["plate_load"], load)
    return along, size


def _load_along(pin: PinScan, magnet: Numbers, pressed: tuple[float, float], delay: float) -> Any:
    """Derivative of the pieces of the load on the plate; the samples of the page hold."""
    given, commands = pin.inputs, pin.commands
    pieces = _core.load_along(
        given.device.magnet.core_numbers,
        magnet,
        ((pin.drive.normal_force, pressed[0]), (pin.drive.plate_touch, pressed[1])),
        rows_of(given.finger_load),
        given.coil_numbers(given.states[pin.number]),
        commands.times,
        delay,
        pin.begin,
        pin.end,
    )
    if not isinstance(pin.load, Function):
        return ((0.0, pieces[0][1][0]),)
    return tuple((begin, (*constant, *4 * (0.0,)), terms) for begin, constant, terms in pieces)

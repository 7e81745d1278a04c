"""200 random devices with all their parts, against the replaced evaluation, coil and control block.

Coils by their construction or times, pulses, voltage steps, gaps that open, heat; rigid and
compliant fingers that press over time; end stops; oblique, recorded and straight hands; states to
go on from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from cases import cases
from oracle.coil_course import ReferenceMagnet, decide
from oracle.scan_evaluation import evaluated
from pindrive import Contact, Drive, Function, Profile, simulate
from pindrive.device import CoilState, Criteria, Device, HandPath, Scan, Scene, scan
from pindrive.motion.results import Event
from random_scans import RandomScan, random_magnet


@dataclass(frozen=True)
class Case:
    """A device, its page and hand, and the touch of the finger."""

    device: Device
    scene: Scene
    path: HandPath
    touch: Profile | None
    goes_on: bool
    """True for a scan that begins in the state in which another one ended."""

    @classmethod
    def of(cls, seed: int) -> Case:
        draw = np.random.default_rng([45, seed])
        case = RandomScan.of(seed, oblique=draw.random() < 0.3).linear()
        device, path = case.device, case.path
        for _ in range(20):
            magnet = random_magnet(draw, warms=draw.random() < 0.3)
            if magnet is not None:
                break
        device = replace(device, magnet=magnet or device.magnet)
        touch = None
        if draw.random() < 0.5:
            touch = cls._touched(path.end)
            finger = Contact(coefficient=0.5, stiffness=device.drive.finger.stiffness)
            device = replace(device, drive=_with(device.drive, finger, draw))
        if draw.random() < 0.3:
            path = _recorded(path, draw)
        return cls(device, case.scene, path, touch, draw.random() < 0.3)

    @staticmethod
    def _touched(lasts: float) -> Profile:
        times = [0.0, 0.3 * lasts, 0.31 * lasts, 0.5 * lasts, 0.51 * lasts]
        return Profile(times, [0.02, 0.03, 0.0, 0.0, 0.01])

    def scan(self) -> Scan:
        done = scan(self.device, self.scene, self.path, touch=self.touch)
        if not self.goes_on:
            return done
        return scan(self.device, self.scene, self.path, touch=self.touch, start=done.state)


def _with(given: Drive, finger: Contact, draw: np.random.Generator) -> Drive:
    """The drive with a finger that presses, and end stops."""
    return Drive(
        mass=given.mass,
        stiffness=given.stiffness,
        damping=given.damping,
        plate=given.plate,
        finger=finger,
        touch_force=0.02,
        travel=float(draw.choice([0.5e-3, 2e-3, 10e-3])),
        stop_stiffness=50.0 * given.stiffness if draw.random() < 0.5 else None,
    )


def _recorded(path: HandPath, draw: np.random.Generator) -> HandPath:
    """The hand as a recording has it: 125 reports a second, with tremor both ways."""
    times = np.arange(0.0, path.end, 0.008)
    speeds = [np.interp(times, path.times, v) for v in (path.vx, path.vy)]
    tremor = [draw.normal(0.0, 2e-3, len(times)) for _ in speeds]
    vx, vy = (v + shaken for v, shaken in zip(speeds, tremor, strict=True))
    return HandPath(times, vx, vy, (float(path.x[0]), float(path.y[0])))


def commands_and_loads(done: Scan) -> int:
    """Compare control block and coil of the pin; returns the number of switchings."""
    (pin,) = done.pins
    device = done.device
    before = pin.inputs.states[0]
    if before.coil is None:
        commands, decision = decide(device.control, pin.luminance, pin.sample_times, pin.end)
        np.testing.assert_array_equal(pin.commands.times, commands.times)
        assert pin.state.decision == decision
    warms = device.magnet.coil is not None and device.magnet.coil.heat is not None
    # A coil that warms is compared with the coupled equations in tests/device/test_pulses.py.
    if before.coil is None and len(pin.commands.times) and not warms:
        reference = ReferenceMagnet(device.magnet)
        current = reference.current(commands, CoilState(pin.begin), pin.begin, pin.end)
        assert isinstance(pin.load, Function)
        t = np.linspace(pin.begin, pin.end, 401)
        touch = (
            pin.finger_load
            if isinstance(pin.finger_load, float)
            else pin.finger_load(t - pin.begin)
        )
        touched = device.drive.plate_touch * (touch - 1.0)
        load = device.load(reference.pull_of(current, t) + touched)
        np.testing.assert_allclose(pin.load(t - pin.begin), load, rtol=1e-11)
    return len(pin.commands.times)


def lasting(events: tuple[Event, ...]) -> list[tuple[str, str]]:
    """Contacts and kinds of the events, but for a slip that sticks again within rounding."""
    found: list[Event] = []
    for event in events:
        last = found[-1] if found else None
        if last and last.contact == event.contact and event.time - last.time < 1e-14:
            found.pop()
        else:
            found.append(event)
    return [(event.contact, event.kind) for event in found]


def motions(done: Scan) -> None:
    """Compare the pin with the release that its inputs describe, followed by `simulate`."""
    (pin,) = done.pins
    if pin.inputs.states[0].contacts is not None:
        return  # contacts of a scan that goes on are no release
    alone = simulate(pin.drive, pin.release, duration=pin.end - pin.begin)
    t = np.linspace(0.0, pin.end - pin.begin, 300)
    expected = alone.position(t)
    largest = float(np.abs(expected).max())
    np.testing.assert_allclose(pin.motion.position(t), expected, rtol=0, atol=1e-11 * largest)
    assert lasting(pin.motion.events) == lasting(alone.events)


def lines(done: Scan) -> int:
    """Compare the outcomes of the lines; returns their number."""
    expected, false_lines = evaluated(done, Criteria())
    found = done.evaluate(Criteria())
    resolution = 16 * np.spacing(done.pins[0].end)  # of the difference of two times
    for one, other in zip(expected, found.lines, strict=True):
        assert (one.fate, one.pin) == (other.fate, other.pin)
        for name, value in one.numbers.items():
            known = resolution if "time" in name or "latency" in name else 1e-15
            assert other.numbers[name] == pytest.approx(value, rel=1e-11, abs=known, nan_ok=True)
    assert [line.time for line in found.false_lines] == pytest.approx(
        [line.time for line in false_lines], rel=1e-12
    )
    return len(expected)


@pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")
@pytest.mark.explore
@pytest.mark.parametrize("begin", range(0, cases(500), 25))
def test_random_devices_equal_the_reference(begin: int) -> None:
    switchings = printed = 0
    for seed in range(begin, begin + 25):
        done = Case.of(seed).scan()
        switchings += commands_and_loads(done)
        motions(done)
        printed += lines(done)
    assert switchings > 30
    assert printed > 15

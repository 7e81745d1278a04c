"""A hand that gives way: against an integrator, against one that nothing slows, in all outputs."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from command import run
from oracle.bodies_by_dop853 import follow
from pindrive.device import Hand, PinArray
from pindrive.device.compliant_hand import HOLD
from pindrive.device.pin_scan import ScanInputs

READER = Path(__file__).resolve().parents[2] / "examples" / "tactile-reader.toml"
ARM = {"hand.mass": 0.55, "hand.stiffness": 135.0, "hand.damping": 6.5}
SPEED = 0.06
PIXEL = 5e-5


def lines_under(
    pins: int, width: float = 1e-3, stagger: float = 0.4e-3, lead: float = 15e-3, **values: Any
) -> tuple[pd.Device, pd.Scene, pd.HandPath]:
    """Pins in a row, under each a line that begins `stagger` later, and a steady stroke."""
    file = pd.load_device(READER, ARM | {"array.columns": 1, "array.rows": 1} | values)
    device = replace(file.device, array=PinArray.at([(0.0, 1e-3 * i) for i in range(pins)]))
    length = lead + pins * stagger + width + 15e-3
    luminance = np.ones((pins, round(length / PIXEL)))
    for i in range(pins):
        begin = lead + i * stagger
        luminance[pins - 1 - i, round(begin / PIXEL) : round((begin + width) / PIXEL)] = 0.0
    scene = pd.Scene(np.repeat(luminance, 20, axis=0), PIXEL, (0.0, -0.5e-3))
    duration = (length - 2e-3) / SPEED
    path = pd.HandPath([0.0, duration], [SPEED, SPEED], [0.0, 0.0], (1e-3, 0.0))
    return device, scene, path


def test_a_heavy_hand_moves_as_one_that_nothing_slows() -> None:
    device, scene, path = lines_under(4, **{"hand.mass": 1e12})
    given = pd.scan(device, scene, path)
    free = pd.scan(replace(device, hand=None), scene, path)
    assert free.hand is None
    t = np.linspace(path.begin, path.end, 2001)
    for heavy, usual in zip(given.pins, free.pins, strict=True):
        assert np.abs(heavy.position(t) - usual.position(t)).max() < 1e-11
        assert len(heavy.events) == len(usual.events)
        for one, other in zip(heavy.events, usual.events, strict=True):
            assert abs(one.time - other.time) < 1e-11
            assert (one.contact, one.kind) == (other.contact, other.kind)
    assert given.hand is not None
    assert given.hand.error < 1e-11


@pytest.mark.parametrize("values", [{}, {"finger.stiffness": 900.0, "hand.kinetic": 0.2}])
def test_hand_and_pins_move_as_an_integrator_has_them(values: dict[str, float]) -> None:
    """Loads as in the scan, modes and events by DOP853."""
    device, scene, path = lines_under(2, **values)
    scan = pd.scan(device, scene, path)
    drive, hand = device.drive, device.hand
    assert hand
    assert scan.hand
    system = pd.System()
    system.body("hand", hand.mass, velocity=SPEED)
    system.force("hand", hand.kinetic)  # the arm overcomes the friction of the mouse
    stroke = pd.Profile([0.0, path.end], [0.0, SPEED * path.end])
    as_function = pd.harmonic(0.0, 0.0, 1.0) + stroke
    system.spring("hand", stiffness=hand.stiffness, damping=hand.damping, length=as_function)
    if hand.kinetic:
        system.contact("hand", kinetic=hand.kinetic)
    breaks: list[float] = []
    for i, pin in enumerate(scan.pins):
        name = f"pin {i}"
        system.body(name, drive.mass, velocity=SPEED)
        system.spring(name, "hand", stiffness=drive.stiffness, damping=drive.damping)
        load = pin.load
        assert not isinstance(load, float)
        breaks += [piece.begin for piece in load.pieces]
        plate, finger = drive.plate, drive.finger
        system.contact(name, kinetic=plate.kinetic, static=plate.static_friction, load=load)
        system.contact(
            name,
            "hand",
            kinetic=finger.kinetic,
            static=finger.static_friction,
            stiffness=finger.stiffness,
            damping=finger.damping or 0.0,
        )
    until = float(scan.hand.path.end) * 0.8
    expected, changes = follow(system, until, breaks)
    assert changes > 10
    (x, _), lag = scan.path.position(until), path.x[0]
    assert float(x) - lag == pytest.approx(expected[0], abs=1e-9)
    for pin, place in zip(scan.pins, expected[1:], strict=True):
        assert -float(pin.position(until)) == pytest.approx(place - expected[0], abs=1e-9)


def test_pins_follow_the_hand_as_they_moved_with_it() -> None:
    """The scan along the path that was found gives the pins that slowed the hand."""
    device, scene, path = lines_under(16)
    scan = pd.scan(device, scene, path)
    given = ScanInputs(device, scene, path, None, None)
    *_, deflections = given.core().hand(device.hand.core)  # type: ignore[union-attr]
    at_end = [float(pin.position(path.end)) for pin in scan.pins]
    assert np.abs(np.array(at_end) - deflections).max() < 1e-9
    assert max(map(abs, at_end)) > 1e-5


def test_more_pins_slow_the_hand_more() -> None:
    slowest, errors = [], []
    for pins in (1, 4, 16):
        device, scene, path = lines_under(pins)
        hand = pd.scan(device, scene, path).hand
        assert hand is not None
        slowest.append(hand.slowest_speed)
        errors.append(hand.error)
        assert hand.mean_speed < SPEED
    assert slowest == sorted(slowest, reverse=True)
    assert errors == sorted(errors)
    device, scene, path = lines_under(16, width=8e-3, stagger=0.0)
    scan = pd.scan(device, scene, path)
    assert scan.hand is not None
    assert scan.hand.slowest_speed < 0
    assert scan.hand.stops
    assert any(warning.startswith("the pins stop the hand") for warning in scan.warnings)


def test_friction_of_the_mouse_matters_where_the_hand_stops() -> None:
    """The arm overcomes it while the mouse slides; a stopped mouse sticks for longer."""
    stopped = []
    for friction in (0.0, 0.8):
        device, scene, path = lines_under(16, 8e-3, 0.0, **{"hand.kinetic": friction})
        hand = pd.scan(device, scene, path).hand
        assert hand is not None
        assert 1e3 * hand.speed(0.2) == pytest.approx(58.0, abs=3.0)
        stopped.append(hand.numbers["hand.stopped"])
    assert stopped[1] > 1.2 * stopped[0]


def test_the_arm_holds_the_end_of_a_stroke() -> None:
    file = pd.load_device(READER, ARM | {"array.columns": 1, "array.rows": 1})
    scan = pd.scan(file, pd.Page(grating=[0.008]))
    assert scan.hand is not None
    usual = pd.load_device(READER, {"array.columns": 1, "array.rows": 1})
    alone = pd.scan(usual, pd.Page(grating=[0.008]))
    assert scan.path.end == pytest.approx(alone.path.end + HOLD)
    assert abs(float(scan.hand.deviation(scan.path.end))) < 2e-3
    assert scan.evaluate().counts["lines.shown"] > 0


def test_the_path_is_a_result(tmp_path: Path) -> None:
    device, scene, path = lines_under(4)
    scan = pd.scan(device, scene, path)
    data = scan.to_dataset(np.linspace(path.begin, path.end, 50))
    assert scan.hand is not None
    assert data.hand_deviation.attrs["units"] == "m"
    assert data.attrs["hand_slowest_speed"] == scan.hand.slowest_speed
    assert scan.evaluate().numbers["hand.path_error"] == scan.hand.error
    labels = [axes.get_label() for axes in scan.plot_hand().axes]
    assert labels == ["speed", "deviation", "magnets"]
    assert pickle.loads(pickle.dumps(scan)).hand == scan.hand
    words = [option for key, value in ARM.items() for option in ("--set", f"{key}={value}")]
    units = {"hand.mass": "kg", "hand.stiffness": "N/m", "hand.damping": "N*s/m"}
    words = [f"{word} {units[word.partition('=')[0]]}" if "=" in word else word for word in words]
    found = run("scan", READER, "--grating", "8mm", *words, "-o", tmp_path / "scan.nc")
    assert found.exit_code == 0, found.output
    assert "The hand slows to" in found.output


def test_a_study_keeps_the_numbers_of_the_hand() -> None:
    device = pd.load_device(READER, ARM | {"array.columns": 1, "array.rows": 1})
    study = pd.Study(
        device, {"hand.mass": ["0.3 kg", "1 kg"]}, page=pd.Page(grating=["8 mm"]), name="hands"
    )
    data = study.run()
    assert "hand_slowest_speed" in data
    assert (np.diff(data.hand_slowest_speed) > 0.0).all()
    usual = pd.Study(pd.load_device(READER), {"mass": ["1 g"]}, page=pd.Page(grating=["8 mm"]))
    assert "hand_slowest_speed" not in usual.outputs


@pytest.mark.parametrize("stop", [{}, {"drive.stop_stiffness": 2e4, "drive.stop_damping": 1.0}])
def test_pins_strike_the_ends_of_their_travel(stop: dict[str, float]) -> None:
    """The hand feels the impacts, and the pins of the scan agree with them."""
    device, scene, path = lines_under(4, 8e-3, 0.0, **{"drive.travel": 0.5e-3, **stop})
    scan = pd.scan(device, scene, path)
    struck = [event for pin in scan.pins for event in pin.events if event.contact == "stop"]
    assert len(struck) > 4
    given = ScanInputs(device, scene, path, None, None)
    *_, deflections = given.core().hand(device.hand.core)  # type: ignore[union-attr]
    at_end = [float(pin.position(path.end)) for pin in scan.pins]
    assert np.abs(np.array(at_end) - deflections).max() < 1e-8
    assert scan.hand is not None
    assert scan.hand.slowest_speed < 0.01


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"hand.stiffness": 0.0, "hand.damping": 0.0}, "to lead the hand"),
        ({"hand.kinetic": 0.4, "hand.static": 0.3}, "hand.static must be at least hand.kinetic"),
        ({"array.axis": 0.3}, "must be along the drive axis for a hand that gives way"),
    ],
)
def test_a_hand_that_cannot_be_followed_is_refused(values: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        pd.scan(pd.load_device(READER, ARM | values), pd.Page(grating=[0.008]))


def test_a_hand_is_checked() -> None:
    with pytest.raises(ValueError, match=r"hand\.mass must be finite and greater than 0 kg"):
        Hand(mass=0.0, damping=1.0)
    with pytest.raises(ValueError, match="one with a hand"):
        pd.scan(pd.load_device(READER), pd.Page(grating=[0.008])).plot_hand()


def test_the_speed_over_two_lines_is_that_of_a_hand_that_gives_way() -> None:
    """A heavy hand has the speed of one that nothing slows; an arm with many pins has another."""
    from pindrive.evaluation import largest_hand_speeds, largest_speeds
    from pindrive.optimisation.line_speed import Climb

    found = {}
    for mass, stiffness in ((1e9, 1e9), (0.55, 135.0)):
        given = {**ARM, "hand.mass": mass, "hand.stiffness": stiffness, "array.columns": 2}
        file = pd.load_device(READER, {**given, "array.rows": 1})
        (found[mass],) = largest_hand_speeds(
            file.device, file.reading, [0.003], slowest=0.05, fastest=0.5
        )
    (fixed,) = largest_speeds(file.device, [0.003], slowest=0.05, fastest=0.5)
    assert found[1e9].speed == pytest.approx(fixed.speed, rel=0.1)
    assert found[0.55].speed != pytest.approx(found[1e9].speed, rel=0.02)
    assert found[0.55].settled == ()
    designed = Climb(file, 0.003).bracket(found[0.55].speed, 0.0, 0.5)
    assert designed == pytest.approx(found[0.55].speed, rel=0.03)

"""A finger that presses and lifts over a scan."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

from oracle.scan_cycles import distance
from pindrive import Contact, Profile, load_device
from pindrive.device import Device, Electromagnet, HandPath, PinArray, Scene, scan, strokes
from pindrive.device.touch import spans
from pindrive.evaluation.tactile_image import paint
from random_scans import sampled
from tactile_mouse import drive

RIGID = Contact(coefficient=0.5, static_coefficient=0.75)
SKIN = Contact(coefficient=0.5, static_coefficient=0.75, stiffness=300.0)
LIFTS = Profile([0.15, 0.17, 0.45, 0.5], [0.010, 0.0, 0.0, 0.030])
"""Over two lines in the middle of the scan below it is lifted."""


def device(finger: Contact = RIGID, touch_force: float = 0.010, pins: int = 1) -> Device:
    return Device(
        drive=drive(finger, touch_force=touch_force, touch_share=0.0),
        magnet=Electromagnet.from_times(hold_force=1.2),
        array=PinArray.grid(pins, 1, 0.002),
    )


def page() -> tuple[Scene, HandPath]:
    scene = Scene.from_grating([0.004], count=5, margin=0.010)
    left, right, _, _ = scene.extent
    y = scene.lines[0]
    return scene, strokes([(left + 0.005, y), (right - 0.005, y)], 0.06, pause=0.1)


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
def test_one_row_is_the_touch_force_of_the_drive(finger: Contact) -> None:
    given, (scene, path) = device(finger, 0.020, pins=2), page()
    usual = scan(given, scene, path)
    for touch in (0.020, "20 mN", Profile([0.3], [0.020])):
        pressed = scan(device(finger, 0.010, pins=2), scene, path, touch=touch)
        t = np.linspace(path.begin, path.end, 997)
        for pin, other in zip(usual.pins, pressed.pins, strict=True):
            assert len(pin.events) == len(other.events) > 10
            found, x = other.position(t), pin.position(t)
            assert np.abs(found - x).max() <= 1e-15 * np.abs(x).max() + 1e-15


@pytest.mark.parametrize("touch_force", [0.010, 0.025])
def test_a_finger_that_lifts_against_sundials(touch_force: float) -> None:
    """Whatever the force is that its coefficient is given with."""
    scene, path = page()
    (pin,) = scan(device(touch_force=touch_force), scene, sampled(path), touch=LIFTS).pins
    assert isinstance(pin.finger_load, Profile)
    assert pin.finger_load(0.5) == pytest.approx(0.030 / touch_force, rel=1e-15)
    found = distance(pin)
    assert found.events
    assert found.time < 1e-8
    assert found.state < 1e-8
    assert pin.motion.certificate().worst < 1e-12


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
def test_a_lifted_finger_does_not_rub(finger: Contact) -> None:
    (pin,) = scan(device(finger), *page(), touch=LIFTS).pins
    t = np.linspace(0.17, 0.45, 300)
    assert not pin.skin_force(t).any()
    assert not pin.stretch(t).any()
    assert np.abs(pin.skin_force(np.linspace(0.0, 0.15, 300))).max() > 0.004
    assert pin.motion.certificate().worst < 1e-11


@pytest.mark.parametrize("finger", [RIGID, SKIN], ids=["rigid", "skin"])
@pytest.mark.parametrize("at", [0.1, 0.16, 0.3, 0.47])
def test_a_scan_goes_on_with_the_touch_where_it_is(finger: Contact, at: float) -> None:
    given, (scene, path) = device(finger), page()
    (whole,) = scan(given, scene, path, touch=LIFTS).pins
    before = scan(given, scene, path.between(path.begin, at), touch=LIFTS)
    (after,) = scan(given, scene, path.between(at, path.end), start=before.state, touch=LIFTS).pins
    t = np.linspace(at, path.end, 500)
    assert np.abs(after.position(t) - whole.position(t)).max() < 1e-12


def test_skin_slips_where_a_scan_goes_on_with_a_step_down() -> None:
    given, (scene, path) = device(SKIN), page()
    at = 0.2
    step = Profile([at, at], [0.010, 0.002])
    (whole,) = scan(given, scene, path, touch=step).pins
    before = scan(given, scene, path.between(path.begin, at), touch=step)
    (after,) = scan(given, scene, path.between(at, path.end), start=before.state, touch=step).pins
    t = np.linspace(at, path.end, 500)
    assert np.abs(after.position(t) - whole.position(t)).max() < 1e-12


def test_nothing_is_felt_under_a_lifted_finger() -> None:
    given, (scene, path) = device(pins=2), page()
    pressed = scan(given, scene, path, touch=0.010).evaluate()
    assert {line.fate for line in pressed.lines} == {"shown"}
    lifted = scan(given, scene, path, touch=0.0).evaluate()
    assert {line.fate for line in lifted.lines} == {"faint"}
    assert not lifted.false_lines
    assert not np.isfinite(paint(lifted.scan).deflection).any()
    partly = scan(given, scene, path, touch=LIFTS).evaluate()
    for line in partly.lines:
        touched = line.begin.response < 0.17 or line.end.time > 0.47
        apart = line.begin.time > 0.17 and line.end.response < 0.45
        assert (line.fate == "shown") or not touched
        assert (line.fate == "faint") or not apart
    assert {line.fate for line in partly.lines} == {"shown", "faint"}
    t, dataset = np.array([0.1, 0.16, 0.3, 0.6]), partly.scan.to_dataset([0.1, 0.16, 0.3, 0.6])
    assert dataset.touch.values == pytest.approx(LIFTS(t), abs=0.0)
    assert dataset.touch.units == "N"


def test_times_of_touch() -> None:
    assert spans(0.0) == []
    assert spans(2.0) == [(-inf, inf)]
    assert spans(Profile([0, 1, 2, 3], [1, 0, 0, 1])) == [(-inf, 1.0), (2.0, inf)]
    assert spans(Profile([0, 1, 1, 3, 3], [0, 0, 1, 1, 0])) == [(1.0, 3.0)]
    assert spans(Profile([0, 1, 2], [1, 2, 1])) == [(-inf, inf)]


@pytest.mark.parametrize(
    ("touch", "said"),
    [
        ("-1 mN", "touch must be finite and at least 0 N, got '-1 mN'"),
        (Profile([0, 1], [0.01, -0.01]), "touch values[1] must be finite and at least 0 N, got "),
        (Profile([0], ["3 mm/s"]), "touch must be a Profile of numbers in N, got values in m/s"),
    ],
)
def test_a_touch_that_cannot_be(touch: str | Profile, said: str) -> None:
    with pytest.raises(ValueError, match=r".") as caught:
        scan(device(), *page(), touch=touch)
    assert str(caught.value).replace('"', "'").startswith(said)


def test_a_touch_needs_a_coefficient() -> None:
    drive = replace(device().drive, finger=Contact(0.005, 0.0075), touch_force=None)
    with pytest.raises(ValueError, match="touch must be left out where the finger's friction is "):
        scan(replace(device(), drive=drive), *page(), touch=LIFTS)
    with pytest.raises(ValueError, match=r"friction is no force; it needs .*, got 0\.01 N"):
        scan(device(touch_force=0.0), *page(), touch="10 mN")


READER = """
[drive]
mass = "1 g"
stiffness = "250 N/m"
damping_ratio = 0.5

[plate]
coefficient = 0.225

[finger]
{finger}

[scan]
{touch}
"""
BY_COEFFICIENT = 'coefficient = 0.5\ntouch_force = "60 mN"'


def written(folder: Path, touch: str, finger: str = BY_COEFFICIENT) -> Path:
    file = folder / "reader.toml"
    file.write_text(READER.format(touch=touch, finger=finger))
    return file


def test_device_file_has_the_touch_of_the_finger(tmp_path: Path) -> None:
    (tmp_path / "press.csv").write_text("time [ms], touch [mN]\n0, 60\n200, 60\n220, 0\n")
    rows = Profile([0.0, 0.2, 0.22], [0.06, 0.06, 0.0])
    for touch in (
        'touch = "press.csv"',
        'touch = [["0 s", "60 mN"], ["200 ms", "60 mN"], ["220 ms", "0 N"]]',
    ):
        file = load_device(written(tmp_path, touch))
        assert isinstance(file.touch, Profile)
        assert file.touch.times == pytest.approx(rows.times, rel=1e-15)
        assert file.touch.values == pytest.approx(rows.values, rel=1e-15)
        done = scan(file, *page())
        assert not done.pins[0].skin_force(np.linspace(0.22, 0.5, 9)).any()
        assert done.pins[0].skin_force(0.1).any()
    assert load_device(written(tmp_path, 'touch = "30 mN"')).touch == 0.030
    assert load_device(written(tmp_path, 'pause = "0 s"')).touch is None


@pytest.mark.parametrize(
    ("touch", "finger", "said"),
    [
        (
            'touch = "30 mN"',
            'kinetic = "30 mN"',
            "scan.touch must be left out where the finger's friction is given as a force; it needs "
            "finger.coefficient and a finger.touch_force greater than 0 N, got 0.03 N",
        ),
        (
            'touch = "-30 mN"',
            BY_COEFFICIENT,
            'scan.touch must be finite and at least 0 N, got "-30 mN"',
        ),
        (
            'touch = [["0 s", "60 mN"], ["1 s", "-1 mN"]]',
            BY_COEFFICIENT,
            'scan.touch[1] value must be finite and at least 0 N, got "-1 mN"',
        ),
    ],
)
def test_a_device_file_that_cannot_be(tmp_path: Path, touch: str, finger: str, said: str) -> None:
    file = written(tmp_path, touch, finger)
    with pytest.raises(ValueError, match=r".") as caught:
        load_device(file)
    assert str(caught.value) == f"{file}: {said}"


def test_a_csv_names_file_row_and_column(tmp_path: Path) -> None:
    file = written(tmp_path, 'touch = "press.csv"')
    (tmp_path / "press.csv").write_text("time [ms], touch [mN]\n0, 60\n200, -1\n")
    with pytest.raises(ValueError, match=r".") as caught:
        load_device(file)
    said = str(caught.value)
    assert said.startswith(f"{file}: scan.touch: {tmp_path / 'press.csv'}: row 3")
    assert "touch" in said.rpartition("press.csv")[2]
    assert "at least 0 N" in said
    assert "\n" not in said

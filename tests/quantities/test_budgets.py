"""Requests beyond a budget are rejected before any allocation."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest
from PIL import Image

from command import run
from pindrive import Contact, Drive, Status
from pindrive.device import Device, Electromagnet, PinArray, Scene, scan, strokes
from pindrive.evaluation.perception import evaluate
from pindrive.evaluation.resolution import largest_speeds
from pindrive.files.keys import template
from pindrive.quantities import budgets
from pindrive.quantities.budgets import Budget

pytestmark = pytest.mark.usefixtures("in_empty_folder")

MEGABYTE = 1 << 20
Found = TypeVar("Found")
TABLE = {name: part for name, part in vars(budgets).items() if isinstance(part, Budget)}

CONTROL = "the samples of the control block must be at most 20000000, got "
STIFF = "--set finger.stiffness: finger.stiffness must be finite and at least 1e-12 N/m"
TURNS = "the turning points of the pins must be at most 1500000, got "
REFUSED = {
    # command, --set: what the only line begins with
    ("scan --text Hello", "finger.stiffness=1e12 N/m"): TURNS,
    ("speed --pitch 2mm", "finger.stiffness=1e12 N/m"): TURNS,
    ("scan --text Hello", "finger.stiffness=1e13 N/m"): STIFF,
    ("speed --pitch 2mm", "finger.stiffness=1e15 N/m"): STIFF,
    ("scan --text Hello", "array.columns=10000"): "--set array.columns: array.columns must be",
    ("speed --pitch 2mm", "array.columns=1e9"): "--set array.columns: array.columns must be",
    ("scan --text Hello", "array.columns=1000"): "the pixels of the page must be at most 40000000",
    ("scan --text A", "control.sample_rate=1e12 Hz"): "--set control.sample_rate: control.sample",
    ("scan --text Hello", "control.sample_rate=1e6 Hz"): f"{CONTROL}",
    ("speed --pitch 2mm", "control.sample_rate=1e6 Hz"): f"{CONTROL}",
    ("scan --text A", "scan.pause=1e9 s"): "--set scan.pause: scan.pause must be finite and at",
    ("scan --text Hello", "scan.pause=3600 s"): f"{CONTROL}",
    ("scan --text A", "magnet.saturation=1e-300"): "--set magnet.saturation: magnet.saturation",
    ("scan --text A", "hand_speed=1e-9 m/s"): "--set hand_speed: scan.hand_speed must be finite",
    ("scan --text Hello", "scan.pixel=1e-7 m"): "the pixels of the page must be at most 40000000",
    ("scan --grating 1m", "scan.pixel=0.01 mm"): "the pixels of the page must be at most 40000000",
    ("scan --grating 100m", ""): "--grating: pitch must be finite and at least 1e-6 m and at most",
    ("speed --pitch 100m", ""): "--pitch: pitch must be finite and at least 1e-6 m and at most 10",
    ("speed --pitch 10m", ""): TURNS,
    ("speed --pitch 1e-9m", ""): "--pitch: pitch must be finite and at least 1e-6 m",
    (f"speed --pitch {'1mm,' * 999}1mm", ""): "the pitches must be at most 50, got 1000",
    ("speed --pitch 2mm --fastest 1e9m/s", ""): "--fastest: fastest must be finite and at least",
    ("speed --pitch 1e-6m --width 0.9e-6m --fastest 100m/s", ""): "the pixels of the page must be",
    (
        "simulate --samples 1000000000000 -o a.csv",
        "",
    ): "--samples: the samples of the motion must",
}


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> None:
    """The imports of the commands take no further memory."""
    file = tmp_path_factory.mktemp("imported") / "device.toml"
    file.write_text(template(whole=True), encoding="utf-8")
    for line in (
        "scan --text A --set pixel=1um",
        "speed --pitch 10m",
        "simulate --samples 9999999999",
    ):
        command, *options = line.split()
        assert run(command, file, *options).exit_code == 2


@pytest.mark.usefixtures("imported")
@pytest.mark.parametrize(("line", "setting"), REFUSED)
def test_a_few_lines_cannot_take_the_machine(line: str, setting: str) -> None:
    """One line that says what, how many and how many may be; and no memory is taken for it."""
    Path("device.toml").write_text(template(whole=True), encoding="utf-8")
    command, *options = line.split()
    arguments = [command, "device.toml", *options, *(["--set", setting] if setting else [])]
    said, peak = traced(lambda: run(*arguments))
    assert said.exit_code == 2, said.output
    (words,) = said.stderr.splitlines()
    assert words.startswith(REFUSED[line, setting])
    assert "at most" in words and "got" in words
    assert [path.name for path in Path().iterdir()] == ["device.toml"]
    assert peak < 25 * MEGABYTE


def test_a_motion_of_very_many_phases_is_no_json() -> None:
    """Weak friction takes 400 000 half periods to stop an undamped pin."""
    Path("device.toml").write_text(
        '[drive]\nmass = "10 g"\nstiffness = "100 N/m"\ndamping_ratio = 0\n[plate]\n'
        'kinetic = "0 N"\n[finger]\nkinetic = "10 nN"\n[motion]\nmouse_velocity = "0 m/s"\n'
        'velocity = "8 mm/s"\n',
        encoding="utf-8",
    )
    said = run("simulate", "device.toml", "-o", "a.json")
    assert said.exit_code == 2, said.output
    assert said.stderr.startswith("the phases of a motion that is written as JSON must be at most")
    assert not Path("a.json").exists()


def test_damping_ratio_of_any_size_is_evaluated() -> None:
    Path("device.toml").write_text(template(whole=True), encoding="utf-8")
    one = ("--set", "damping_ratio=1e6", "--set", "array.columns=1", "--set", "array.rows=1")
    for line in (
        "scan device.toml --grating 4mm",
        "speed device.toml --pitch 9mm --slowest 0.3m/s",
    ):
        said = run(*line.split(), *one)
        assert said.exit_code == 0, said.output
    drive = Drive(
        mass=0.01, stiffness=100.0, damping_ratio=1e6, plate=Contact(0.02), finger=Contact(0.005)
    )
    assert drive.slowest_rate == pytest.approx(drive.natural_frequency / 2e6, rel=1e-12)
    below = replace(drive, damping=0.5)
    assert below.slowest_rate == pytest.approx(0.5 / (2.0 * 0.01), rel=1e-12)


def test_the_table_has_a_reason_for_each() -> None:
    assert len(TABLE) > 10
    for name, budget in TABLE.items():
        assert budget.most > 0 and len(budget.why) > 20, name
        assert budget.counted.startswith("the "), name
        budget.check(budget.most)
        with pytest.raises(ValueError, match=f"a: {budget.counted} must be at most {budget.most}"):
            budget.check(budget.most + 1, where="a")
    with pytest.raises(ValueError, match=r"got nan$"):
        budgets.SAMPLES_OF_CONTROL.check(float("nan"))
    with pytest.raises(ValueError, match=r"got 1e\+40 \(why\)$"):
        budgets.SAMPLES_OF_CONTROL.check(1e40, "why")


# ---- memory grows with what is kept --------------------------------------------------------------


def device(count: int = 1, stiffness: float = float("inf")) -> Device:
    finger = Contact(0.02, stiffness=stiffness)
    drive = Drive(mass=0.01, stiffness=100.0, damping=0.3, plate=Contact(0.022), finger=finger)
    return Device(drive=drive, array=PinArray.grid(1, count, 1e-3))


def traced(work: Callable[[], Found]) -> tuple[Found, int]:
    """Return a result and the peak memory of Python and NumPy."""
    gc.collect()
    tracemalloc.start()
    try:
        return work(), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_samples_of_the_page_are_not_kept() -> None:
    page = np.ones((30, 6000))
    page[:, 1000:2000] = page[:, 3000:4000] = 0.0
    path = strokes([(1e-5, 1.5e-5), (0.00599, 1.5e-5)] * 40, 1.0)
    done = scan(device(), Scene(page, 1e-6), path, threads=1)
    sample_times = 4.0 * 79 * 5980
    found, peak = traced(lambda: evaluate(done))
    assert len(found.lines) == 79 * 2
    assert sample_times > 1.8e6
    assert (
        peak < 4 * 8 * sample_times
    )  # a few hundred thousand at once, and a dozen numbers of each


def test_a_picture_is_turned_into_luminance_strip_by_strip(tmp_path: Path) -> None:
    side = 2000
    shade = np.add.outer(np.arange(side), np.arange(side))
    colours = np.stack([shade, 2 * shade, 3 * shade], axis=2).astype(np.uint8)
    Image.fromarray(colours).save(tmp_path / "page.bmp")
    read, peak = traced(lambda: Scene.from_image(tmp_path / "page.bmp", 1e-4))
    red, green, blue = np.moveaxis(colours[-2:].astype(float), 2, 0)
    grey = (0.299 * red + 0.587 * green + 0.114 * blue) / 255.0
    assert np.array_equal(read.luminance[-2:], np.minimum(grey, 1.0))
    assert peak < 2.0 * read.luminance.nbytes + 40 * MEGABYTE


def test_a_picture_is_refused_before_it_is_read(tmp_path: Path) -> None:
    Image.new("1", (10_000, 10_000)).save(tmp_path / "page.png")
    words = r"page.png: the pixels of the page must be at most 40000000, got 100000000 \(10000 by"
    with pytest.raises(ValueError, match=words):
        Scene.from_image(tmp_path / "page.png", 1e-4)


# ---- what is known only as a run goes ------------------------------------------------------------


def test_segments_are_counted_as_the_pins_are_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first pin exceeds the budget: pins that have not begun never begin."""
    followed: list[int] = []
    monkeypatch.setattr(budgets, "SEGMENTS", replace(budgets.SEGMENTS, most=4))
    path = strokes([(0.0005, 0.004), (0.0095, 0.004)], 0.1)
    words = (
        r"the segments of the motions of all pins must be at most 4, got \d+ \(after 1 of 8 pins\)"
    )
    with pytest.raises(ValueError, match=words):
        scan(device(8), tall(), path, threads=1, progress=lambda done, of: followed.append(done))
    assert followed == []


def test_switchings_and_rows_are_counted_pin_by_pin(monkeypatch: pytest.MonkeyPatch) -> None:
    path = strokes([(0.0005, 0.004), (0.0095, 0.004)], 0.1)
    rows = len(path.times)
    for name, most, words in (
        ("SWITCHINGS", 3, r"got 4 \(up to pin 0 of 2\)"),
        ("INPUT_ROWS", 2 * rows + 5, r"got \d+ \(up to pin 1 of 2\)"),
        ("INPUT_ROWS", rows, rf"got {2 * rows} \(2 pins, {rows} rows of hand speed for each\)"),
        ("SAMPLES_OF_PAGE", 1000, r"2 pins, 0.009 m of way, pixels of 0.1 mm"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(budgets, name, replace(getattr(budgets, name), most=most))
            with pytest.raises(ValueError, match=words):
                scan(device(2), tall(), path, threads=1)
    scan(device(2), tall(), path, threads=1)


def test_many_pulses_are_refused_and_not_made(monkeypatch: pytest.MonkeyPatch) -> None:
    pulsed = replace(device(), magnet=Electromagnet(pwm_frequency=20_000.0, pwm_duty=0.5))
    path = strokes([(0.0005, 0.004), (0.0095, 0.004)], 0.1)
    assert scan(pulsed, tall(), path).pins[0].motion.status == Status.ok
    monkeypatch.setattr(budgets, "INPUT_ROWS", replace(budgets.INPUT_ROWS, most=1_000))
    with pytest.raises(ValueError, match=r"over all pins, must be at most 1000, got \d+ \("):
        scan(pulsed, tall(), path)


def test_samples_of_a_scan_are_counted_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("device.toml").write_text(template(whole=True), encoding="utf-8")
    monkeypatch.setattr(budgets, "SAMPLES", replace(budgets.SAMPLES, most=1000))
    monkeypatch.setattr("pindrive.device.scanning.scan", None)  # it is not come to
    said = run("scan", "device.toml", "--text", "A", "-o", "a.nc")
    assert said.exit_code == 2
    assert said.stderr.startswith("the samples of all pins must be at most 1000, got ")
    assert "(16 pins at " in said.stderr


def test_pitches_and_trials_are_counted_before_the_first() -> None:
    with pytest.raises(ValueError, match="the pitches must be at most 50, got 51"):
        largest_speeds(device(), [0.002] * 51)
    with pytest.raises(
        ValueError, match=r"got \d+ \(50 pitches, hands from 0.0001 m/s, at 1000 Hz"
    ):
        largest_speeds(device(), [0.01] * 50, slowest=1e-4)


def tall() -> Scene:
    """Two lines, 8 mm high."""
    return Scene.from_grating([0.004], count=2, height=0.004, margin=0.002)

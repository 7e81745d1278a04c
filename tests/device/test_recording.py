"""Recordings of a hand: what they are, smoothing of raw ones against known truth, refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from numpy.typing import NDArray

import pindrive as pd
from command import refused, run
from pindrive.device import (
    Device,
    HandPath,
    HandRecording,
    Page,
    PinArray,
    Reading,
    Scene,
    read_csv,
    strokes,
)
from pindrive.device.recording import PEAK_LOSS

Values = NDArray[np.float64]
STEP = 0.0254 / 1000.0
READER = Path(__file__).parents[2] / "examples" / "tactile-reader.toml"
SPEED = 0.0625
LENGTH = 0.03
DURATION = 1.875 * LENGTH / SPEED


def truth() -> HandPath:
    """Out and back at 62.5 mm/s, with a rest of 0.25 s after each."""
    return strokes([(0.01, 0.004), (0.04, 0.004), (0.01, 0.004)], SPEED, pause=0.25)


def mouse(path: HandPath, rate: float = 1000.0, jitter: float = 1e-4) -> tuple[Values, Values]:
    """Times of reports (s), and the whole steps since the report before: none while it rests."""
    rng = np.random.default_rng(7)
    t = np.arange(path.begin, path.end, 1.0 / rate)
    counts = np.floor(path.position(t)[0] / STEP + 0.5)
    paths = np.diff(counts, prepend=counts[0])
    moved = (paths != 0.0) | (np.arange(len(t)) % len(t) == 0) | (t == t[-1])
    return (t + rng.uniform(-jitter, jitter, len(t)))[moved], paths[moved]


def write(file: Path, header: str, *columns: Any) -> Path:
    rows = [",".join(f"{cell:.10g}" for cell in row) for row in zip(*columns, strict=True)]
    file.write_text("\n".join([header, *rows]), encoding="utf-8")
    return file


# ---- known truth ---------------------------------------------------------------------------------


def test_a_raw_recording_of_a_mouse_is_the_hand_that_made_it(tmp_path: Path) -> None:
    """Speeds within 2 % of the peak, which is within 0.3 %; from row to row they are 70 % off."""
    t, paths = mouse(truth())
    file = write(tmp_path / "raw.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    recording = HandRecording.read(file)
    assert recording.raw
    assert recording.resolved == pytest.approx(STEP)
    assert recording.rate == pytest.approx(1000.0, rel=0.05)
    assert recording.peak_speed() > 1.2 * SPEED
    path = read_csv(file)
    assert path.peak_speed == pytest.approx(SPEED, rel=3e-3)
    at = np.linspace(path.begin + 0.05, path.end - 0.05, 5000)
    assert_allclose(path.velocity(at)[0], truth().velocity(at)[0], atol=0.02 * SPEED)
    there = truth().position(at)[0] - truth().position(path.begin)[0]
    assert_allclose(path.position(at)[0], there, atol=1.5 * STEP)
    assert_allclose(path.vy, 0.0, atol=1e-15)


def test_a_mouse_that_rests_reports_nothing_and_stays(tmp_path: Path) -> None:
    """In the pause after the first stroke the hand stands, though no row says so."""
    t, paths = mouse(truth())
    gap = int(np.argmax(np.diff(t)))
    assert t[gap + 1] - t[gap] > 0.25
    file = write(tmp_path / "raw.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    path = read_csv(file)
    x, _ = path.position(np.linspace(t[gap] + 0.05, t[gap + 1] - 0.05, 100))
    assert np.ptp(x) < 0.1 * STEP
    assert x[0] == pytest.approx(paths[: gap + 1].sum() * STEP, abs=0.1 * STEP)


FORMS = {
    "steps since the row before": ("time [s], dx [count], dy [count]", 1.0, True),
    "places in steps": ("time [ms], x [counts], y [counts]", 1.0, False),
    "places in millimetres": ("time [s], x [mm], y [mm]", 1e3 * STEP, False),
}


@pytest.mark.parametrize("form", FORMS)
def test_one_hand_in_all_notations(tmp_path: Path, form: str) -> None:
    header, scale, relative = FORMS[form]
    t, paths = mouse(truth())
    x = scale * (paths if relative else np.cumsum(paths))
    file = write(tmp_path / "a.csv", header, (1e3 if "[ms]" in header else 1.0) * t, x, 0.0 * x)
    usual = write(tmp_path / "b.csv", "time [s], x [m], y [m]", t, STEP * np.cumsum(paths), 0.0 * x)
    one, other = read_csv(file), read_csv(usual)
    at = np.linspace(one.begin, one.end, 777)
    assert_allclose(one.position(at), other.position(at), atol=1e-3 * STEP)


def test_the_resolution_is_that_of_the_mouse(tmp_path: Path) -> None:
    t, paths = mouse(truth())
    file = write(tmp_path / "raw.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    one, other = read_csv(file), read_csv(file, resolution=400.0 / 0.0254)
    assert other.peak_speed == pytest.approx(2.5 * one.peak_speed, rel=1e-9)


# ---- the filter ----------------------------------------------------------------------------------


@pytest.mark.parametrize("cutoff", [8.0, 20.0])
def test_at_the_cut_off_three_decibels_are_lost_and_no_time(cutoff: float) -> None:
    t = np.linspace(0.0, 4.0, 4001)
    for part, gain in ((0.5, 1.0 / (1.0 + (np.sqrt(2.0) - 1.0) / 16.0)), (1.0, np.sqrt(0.5))):
        wave = np.sin(2.0 * np.pi * part * cutoff * t)
        smooth = HandRecording(t, 1e-3 * wave, 0.0 * t).smoothed(cutoff)
        inner = (t > 1.0) & (t < 3.0)
        assert_allclose(smooth.x[inner], 1e-3 * gain * wave[inner], atol=2e-3 * 1e-3)


@pytest.mark.parametrize("lasts", [0.1, 0.15])
def test_the_peak_that_is_lost_is_the_one_stated(lasts: float) -> None:
    """0.102 / (f_c T)^4 of the peak of a minimum-jerk stroke."""
    assert pytest.approx(0.102, rel=2e-3) == PEAK_LOSS
    true = strokes([(0.0, 0.0), (SPEED * lasts / 1.875, 0.0)], SPEED, pause=0.5)
    t = np.linspace(-0.5, true.end, 20_001)
    x = np.where(t > 0.0, true.position(np.maximum(t, 0.0))[0], 0.0)
    smooth = HandRecording(t, x, 0.0 * t).smoothed(20.0)
    lost = 1.0 - smooth.peak_speed() / SPEED
    assert lost == pytest.approx(PEAK_LOSS / (20.0 * lasts) ** 4, rel=0.1, abs=2e-5)


# ---- what a recording is -------------------------------------------------------------------------


def test_a_page_says_whether_its_path_is_smoothed(tmp_path: Path) -> None:
    t = np.arange(0.0, 0.4, 1e-3)
    counts = np.diff(np.round(39370.0 * 0.06 * t), prepend=0.0)
    header = "time [s], dx [count], dy [count]"
    file = write(tmp_path / "raw.csv", header, t, counts, 0.0 * counts)
    reading, array = Reading(), PinArray([(0.0, 0.0)])
    scene = reading.text("a", array)
    peaks = {}
    for smooth in (None, True, False):
        page = Page(text="a", path=file, smooth=smooth)
        page.check("{}")
        peaks[smooth] = page.hand(reading, scene, array).peak_speed
    assert peaks[None] == peaks[True] < 0.9 * peaks[False]
    assert Page(text="a", path=file, smooth=False).options.endswith(f'--path "{file}" --no-smooth')
    with pytest.raises(ValueError, match="--smooth must be left out without a recorded --path"):
        Page(text="a", smooth=True).check("--{}")


def test_only_recordings_in_coarse_steps_are_raw() -> None:
    t = np.arange(2000) / 1000.0
    x = truth().position(t)[0]
    still = 0.0 * t

    def raw(place: Values, every: int = 1) -> bool:
        return HandRecording(t[::every], place[::every], still[::every]).raw

    counts = np.round(x / STEP)
    assert raw(STEP * counts)
    assert raw(np.round(1e3 * STEP * counts, 3) * 1e-3), "written with three decimals"
    assert not raw(x)
    assert not raw(SPEED * t), "a constant speed"
    assert not raw(STEP * counts, every=20), "a step within 20 ms is no speed of note"
    assert raw(np.round(STEP * counts, 5)), "counts written in hundredths of a millimetre"
    assert not raw(np.round(x, 7)), "steps of 0.1 µm"


@pytest.mark.parametrize("angle", [0.0, 8.0, 40.0])
def test_the_data_and_not_the_unit_decide_on_smoothing(angle: float, tmp_path: Path) -> None:
    """One hand, written in counts, in millimetres to three decimals and to two."""
    t = np.arange(1500) / 1000.0
    way = truth().position(t)[0]
    way = way - way[0]
    x, y = (
        np.round(way * f / STEP) for f in (np.cos(np.radians(angle)), np.sin(np.radians(angle)))
    )
    peaks = []
    for unit, scale, digits in (("count", 1.0, 0), ("mm", 1e3 * STEP, 3), ("mm", 1e3 * STEP, 2)):
        columns = np.round(scale * x, digits), np.round(scale * y, digits)
        file = write(tmp_path / "hand.csv", f"time [s], x [{unit}], y [{unit}]", t, *columns)
        recording = HandRecording.read(file)
        assert recording.raw
        peaks.append(recording.path().peak_speed)
        rough = recording.path(1e3, smooth=False)
        assert rough.about.endswith("without smoothing.") and rough.peak_speed > peaks[-1]
    assert peaks == pytest.approx([peaks[0]] * 3, rel=2e-3)
    assert peaks[0] == pytest.approx(truth().peak_speed, rel=0.03)


def test_a_smooth_recording_is_followed_as_it_is() -> None:
    t = np.linspace(0.0, truth().end, 2000)
    recording = HandRecording(t, *truth().position(t))
    path = recording.path()
    middles = 0.5 * (t[1:] + t[:-1])
    x = recording.x
    assert_allclose(path.position(middles)[0], 0.5 * (x[1:] + x[:-1]), atol=1e-15)
    assert path.about.endswith("It is used without smoothing.")


# ---- refusals ------------------------------------------------------------------------------------


def test_refusals(tmp_path: Path) -> None:
    t, paths = mouse(truth())
    file = write(tmp_path / "raw.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    with pytest.raises(ValueError) as error:
        read_csv(file, cutoff=300.0)
    assert str(error.value).startswith(
        f"{file}: smoothing_cutoff must be at most a fifth of the recording's rate, "
    )
    with pytest.raises(ValueError, match="resolution must be finite and at least 100 1/m"):
        read_csv(file, resolution=0.0)
    paths[len(paths) // 4] = 2000.0  # the mouse was lifted, or a report is wrong
    file = write(tmp_path / "jump.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    with pytest.raises(ValueError, match=r"jump\.csv, smoothed: t\[\d+\] must be without a jump"):
        read_csv(file)
    file = write(tmp_path / "lone.csv", "time [s], dx [count]", t, paths)
    with pytest.raises(
        ValueError, match=r'lone\.csv: the header must be like "time \[s\], x \[m\]'
    ):
        read_csv(file)


# ---- in scans and on the command line ------------------------------------------------------------


def test_a_scan_along_a_raw_recording_shows_what_the_hand_itself_does(tmp_path: Path) -> None:
    """Off the page too, where the paper is blank."""
    device = Device(drive=pd.load_device(READER).drive)
    page = np.ones((80, 320))
    page[:, 150:170] = page[:, 240:260] = 0.0
    scene = Scene(page, 1e-4)
    t, paths = mouse(truth())
    x = 0.01 / STEP + np.cumsum(paths)
    y = np.full_like(x, 0.004 / STEP)
    file = write(tmp_path / "raw.csv", "time [s], x [count], y [count]", t, x, y)
    one, other = pd.scan(device, scene, file).evaluate(), pd.scan(device, scene, truth()).evaluate()
    assert any("beyond the page" in words for words in one.scan.warnings)
    assert one.counts == other.counts
    assert one.counts["lines.shown"] == 4
    for line, like in zip(one.lines, other.lines, strict=True):
        assert line.begin.response == pytest.approx(
            like.begin.response, abs=2e-3
        )  # a look and a step
        assert line.stroke == pytest.approx(like.stroke, rel=0.05)


@pytest.mark.usefixtures("in_empty_folder")
def test_check_reports_a_recording(tmp_path: Path) -> None:
    t, paths = mouse(truth())
    file = write(tmp_path / "raw.csv", "time [s], dx [count], dy [count]", t, paths, 0.0 * paths)
    result = run("check", str(file))
    assert result.exit_code == 0
    recording, path = result.output.splitlines()
    before, after = HandRecording.read(file).peak_speed(), read_csv(file).peak_speed
    assert f"The recording: {len(t)} rows over " in recording
    assert " Hz, in steps of 0.0254 mm (1000 dpi); noise of the speed " in recording
    assert f"{1e3 * before:.2f} mm/s from row to row, {1e3 * after:.2f} mm/s smoothed." in recording
    assert (
        "Butterworth of 2nd order forwards and backwards, -3 dB at 20 Hz; it takes 1%" in recording
    )
    assert path.startswith("The hand's path takes 2.")
    scanned = run("scan", str(READER), "--text", "I", "--path", str(file))
    assert recording in scanned.output
    assert refused("check", str(tmp_path / "none.csv")).endswith("No such file or directory")

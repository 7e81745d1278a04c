"""Gaps of neighbouring pins: closed forms, samples, laws, and their report.

x counts against the drive axis: a pin that is carried forward goes towards the one behind it.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import exp, pi, sqrt
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from command import GOOD, run
from pindrive import Contact, Motion, Profile, Release, simulate
from pindrive.cli.scan_tables import scan_report
from pindrive.cli.tables import console, meeting_words
from pindrive.device import Device, Electromagnet, HandPath, PinArray, Scan, Scene, scan
from pindrive.device.geometry import COPPER, IRON, doubts, smallest_gaps
from pindrive.device.pin_array import Neighbours
from pindrive.evaluation import evaluate
from pindrive.files.device import load_device
from pindrive.plot.scan import plot_reliefs, plot_scan
from random_scans import RandomScan
from tactile_mouse import SKIN, drive

NOTHING = Contact(0.0)


def closest(behind: Motion, ahead: Motion) -> tuple[float, float]:
    """The least x(behind) - x(ahead) and when, of pins that stand at one place."""
    (gap,) = smallest_gaps([Neighbours(0, 1, 0.0)], [behind.core, ahead.core], 0.0, behind.duration)
    return gap.size, gap.time


def sampled(behind: Motion, ahead: Motion, count: int = 40_001) -> float:
    """Return the smallest gap from samples, refined by a search."""
    knots = [s.end for m in (behind, ahead) for s in m.segments if s.end < m.duration]
    t = np.union1d(np.linspace(0.0, behind.duration, count), knots)
    x = behind.position(t) - ahead.position(t)
    i = int(np.argmin(x))
    low, high = t[max(i - 1, 0)], t[min(i + 1, len(t) - 1)]
    found = minimize_scalar(
        lambda s: float(behind.position(s) - ahead.position(s)),
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return min(float(x[i]), float(found.fun))


# ---- against closed forms and samples ------------------------------------------------------------


def test_two_free_pins_by_hand() -> None:
    """X = X e^(-δt) (cos ωt + δ/ω sin ωt), its extremes every half period; their difference too."""
    free = drive(NOTHING, NOTHING, damping=0.2)
    delta = 0.2 / 0.020
    omega = sqrt(1e4 - delta**2)
    for x0, x1 in ((0.001, 0.003), (0.003, 0.001), (-0.002, 0.001)):
        motions = [simulate(free, Release(0.0, x), duration=0.3) for x in (x0, x1)]
        start = x0 - x1
        expected, when = min((start, 0.0), (-start * exp(-delta * pi / omega), pi / omega))
        size, time = closest(*motions)
        assert size == pytest.approx(expected, abs=1e-12)
        assert time == pytest.approx(when, abs=1e-6)


def test_two_frequencies_by_hand() -> None:
    """Undamped, one pin twice as heavy four times: cos 100 t against cos 50 t."""
    light, heavy = (replace(drive(NOTHING, NOTHING, damping=0.0), mass=m) for m in (0.010, 0.040))
    motions = [simulate(body, Release(0.0, 0.001), duration=0.5) for body in (light, heavy)]
    # cos 2u - cos u is least where 4 cos u = 1: 2/16 - 1 - 1/4
    assert closest(*motions)[0] == pytest.approx(-1.125e-3, abs=1e-12)


@pytest.mark.parametrize(
    ("seed", "curved"), [*((s, False) for s in range(12)), (0, True), (3, True)]
)
def test_random_devices_against_samples(seed: int, curved: bool) -> None:
    """Pins of all kinds that are switched by different spots."""
    one = RandomScan.of(seed, curved=curved)
    array = PinArray(
        [(0.0, 0.0), (0.003, 0.0), (0.0055, 0.001)], [(0.0, 0.0), (-0.0007, 0.0), (0.0009, 0.0)]
    )
    done = scan(replace(one.device, array=array), one.scene, one.path, threads=1)
    assert [(gap.behind, gap.ahead) for gap in done.gaps] == [(0, 1), (1, 2)] or done.gaps
    for gap, pair in zip(done.gaps, array.neighbours, strict=True):
        motions = done.pins[pair.behind].motion, done.pins[pair.ahead].motion
        assert gap.size == pytest.approx(pair.clearance + sampled(*motions), abs=2e-12)
        x, y = (float(m.position(gap.time - done.path.begin)) for m in motions)
        assert gap.size == pytest.approx(pair.clearance + x - y, abs=1e-15)
    assert done.smallest_gap == min(done.gaps, key=lambda gap: gap.size)


def test_friction_curves_and_cycles_against_samples() -> None:
    """Falling friction, by which amplitudes grow within a piece; and stick-slip that goes on."""
    falling = Contact(curve=[(0.0, 0.03), (0.05, 0.015), (0.2, 0.01)])
    slipping = Contact(0.05, 0.15)
    for body, speed in (
        (drive(falling, damping=0.05), Profile([0.0, 0.4, 2.0], [0.02, 0.12, -0.05])),
        (drive(Contact(0.002), slipping, damping=0.1), 0.02),
    ):
        motions = [
            simulate(body, Release(speed, x, velocity=0.0), duration=2.0) for x in (0.0, 0.004)
        ]
        one, other = motions
        for pair in ((one, other), (other, one)):
            assert closest(*pair)[0] == pytest.approx(sampled(*pair), abs=2e-12)
    assert motions[0].ending.cycle == "stick-slip" and motions[0].segments[-1].end < 1.0


def test_the_bound_on_the_acceleration_holds_where_the_damping_changes() -> None:
    """A steep curve under a load that comes and goes: the bound is above all samples, and near."""
    body = drive(NOTHING, Contact(curve=[(0.0, 0.05), (0.02, 0.01), (0.2, 0.2)]), damping=0.05)
    load = Profile([0.0, 0.1, 0.2, 0.4], [1.0, 20.0, 0.1, 5.0])
    motion = simulate(body, Release(0.06, 0.002, plate_load=load), duration=0.4)
    steps = ~np.isnan(motion.acceleration_bounds)
    assert steps.sum() > 10
    ratios = []
    for segment, bound in zip(motion.segments, motion.acceleration_bounds, strict=True):
        t = np.linspace(segment.begin, segment.end, 200)[1:-1]
        if segment.end > segment.begin and not np.isnan(bound):
            ratios.append(np.abs(motion.acceleration(t)).max() / bound)
    assert max(ratios) <= 1.0 + 1e-12
    assert np.median(ratios) > 0.9, "a bound that says something"


def test_acceleration_of_series_steps_is_not_evaluated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Their bounds are known: of pins that never stop slipping only positions are evaluated."""
    body = drive(NOTHING, Contact(curve=[(0.0, 0.05), (0.02, 0.01), (0.2, 0.2)]), damping=0.05)
    load = Profile([0.0, 0.2], [1.0, 0.1])
    pair = [simulate(body, Release(0.3, x, plate_load=load), duration=0.2) for x in (2e-3, 1e-3)]
    series = [~np.isnan(motion.acceleration_bounds) for motion in pair]
    assert all(steps.all() and steps.sum() > 3 for steps in series)
    requested: list[int] = []

    def counted(motion: Motion, t: NDArray[np.float64], side: str = "right") -> NDArray[np.float64]:
        requested.append(np.size(t))
        return np.zeros(np.shape(t))

    expected = closest(*pair)
    monkeypatch.setattr(Motion, "acceleration", counted)
    monkeypatch.setattr(Motion, "velocity", counted)
    assert closest(*pair) == expected
    assert sum(requested) == 0


# ---- laws ----------------------------------------------------------------------------------------


def grating() -> Scene:
    return Scene.from_grating([0.004, 0.007], count=2, margin=0.03, height=0.004)


def across(scene: Scene, margin: float = 0.017, speed: float = 0.06) -> HandPath:
    left, right, _, _ = scene.extent
    lasts = (right - left - 2.0 * margin) / speed
    return HandPath([0.0, lasts], [speed] * 2, [0.0] * 2, (left + margin, scene.lines[0]))


def scanned(array: PinArray) -> Scan:
    magnet = Electromagnet.from_times(hold_force=3.0)
    scene = grating()
    return scan(Device(drive=drive(SKIN), magnet=magnet, array=array), scene, across(scene))


def test_a_pin_that_is_carried_comes_closer_to_the_one_behind() -> None:
    """The page passes under the mouse against the hand: so does what it carries."""
    done = scanned(PinArray.grid(2, 1, 0.012))
    (gap,) = done.gaps
    assert (gap.behind, gap.ahead) == (0, 1)
    behind, ahead = (float(pin.position(gap.time)) for pin in done.pins)
    assert ahead > 0.0015 and ahead > behind
    assert gap.size == pytest.approx(0.012 - 0.0015 - (ahead - behind), abs=1e-15)


def test_pins_that_show_the_same_keep_their_distance() -> None:
    done = scanned(PinArray([(0.0, 0.0), (0.004, 0.0)], [(0.0, 0.0), (0.0, 0.0)]))
    assert done.gaps[0].size == pytest.approx(0.0025, abs=1e-15)


def test_a_turned_device_on_a_turned_page_has_the_same_gaps() -> None:
    scene, path = grating(), across(grating())
    turned = Scene(scene.luminance[::-1, ::-1], scene.pixel, (-scene.extent[1], -scene.extent[3]))
    back = HandPath(path.times, -path.vx, -path.vy, (-float(path.x[0]), -float(path.y[0])))
    body, magnet = drive(SKIN), Electromagnet.from_times(hold_force=3.0)
    one, other = (
        scan(Device(drive=body, magnet=magnet, array=PinArray.grid(3, 1, a, axis=axis)), s, p)
        for a, axis, s, p in ((0.003, 0.0, scene, path), (0.003, pi, turned, back))
    )
    assert [g.size for g in one.gaps] == pytest.approx([g.size for g in other.gaps], abs=1e-11)


def test_later_clock_shifts_all_times() -> None:
    scene, path = grating(), across(grating())
    late = HandPath(path.times + 16.0, path.vx, path.vy, (float(path.x[0]), float(path.y[0])))
    device = Device(drive=drive(SKIN), array=PinArray.grid(2, 1, 0.003))
    one, other = (scan(device, scene, p).gaps[0] for p in (path, late))
    assert other.time - one.time == pytest.approx(16.0, abs=1e-6)
    assert other.size == pytest.approx(one.size, abs=1e-9)


# ---- who is next to whom -------------------------------------------------------------------------


def pairs(array: PinArray) -> list[tuple[int, int, float]]:
    return [(p.behind, p.ahead, p.clearance) for p in array.neighbours]


def test_neighbours_of_a_grid_are_next_in_their_row() -> None:
    found = pairs(PinArray.grid(3, 2, 0.005))
    assert [(a, b) for a, b, _ in found] == [(0, 1), (1, 2), (3, 4), (4, 5)]
    assert [room for *_, room in found] == pytest.approx([0.0035] * 4)
    assert PinArray.grid(1, 5, 0.005).neighbours == ()


def test_rows_closer_than_a_diameter_have_neighbours_in_each_other() -> None:
    """Two discs of 1.5 mm, 0.9 mm apart across the axis, touch 1.2 mm apart along it."""
    staggered = PinArray([(0.0, 0.0), (0.004, 0.0009), (0.009, 0.0)], pin_diameter=0.0015)
    found = pairs(staggered)
    assert [(a, b) for a, b, _ in found] == [(0, 1), (0, 2), (1, 2)]
    assert [room for *_, room in found] == pytest.approx([0.0028, 0.0075, 0.0038])
    apart = PinArray([(0.0, 0.0), (0.004, 0.0015), (0.009, 0.003)], pin_diameter=0.0015)
    assert apart.neighbours == ()


def test_pins_abreast_overlap_for_good() -> None:
    array = PinArray([(0.0, 0.0), (0.0, 0.0012), (0.004, 0.0), (0.0, 0.0024)])
    assert array.abreast == ((0, 1), (1, 3))
    assert (0, 1) not in [(a, b) for a, b, _ in pairs(array)]
    assert scanned(array).warnings[-1] == (
        "pins 0 and 1 stand 1.2 mm apart across the drive axis, less than array.pin_diameter, "
        "1.5 mm: they overlap at rest"
    )


def test_a_diameter_is_checked() -> None:
    with pytest.raises(
        ValueError, match="pin_diameter must be finite and at least 1e-6 m and at most 1 m, got 0"
    ):
        PinArray.grid(pin_diameter=0.0)


# ---- what is said --------------------------------------------------------------------------------


def said(done: Scan) -> str:
    shown = console()
    with shown.capture() as captured:
        shown.print(scan_report(done), crop=False)
    return captured.get()


def test_overlapping_pins_are_reported_everywhere() -> None:
    """The first default array: 2.5 mm apart, and pins that go 7 mm."""
    done = scanned(PinArray.grid(2, 1, 0.0025))
    gap = done.smallest_gap
    assert gap and gap.size < -0.001
    (warning,) = done.warnings
    assert warning.startswith(
        f"pins 0 and 1 overlap by {-1e3 * gap.size:.4g} mm at {gap.time:.4g} s"
    )
    assert f"Pins overlap by up to {-1e3 * gap.size:.3f} mm, pins 0 and 1 at " in said(done)
    data = done.to_dataset([0.0, 0.1])
    assert float(data.pin_gap[0]) == gap.size == data.attrs["smallest_pin_gap"]
    assert float(data.pin_gap_time[0]) == gap.time
    assert (int(data.pin_gap_behind[0]), int(data.pin_gap_ahead[0])) == (0, 1)
    assert data.pin_gap.attrs["units"] == "m"
    evaluated = evaluate(done)
    assert "Pins overlap by up to " in plot_scan(evaluated).get_suptitle()
    reliefs = plot_reliefs([evaluated])
    assert "pins overlap by " in reliefs.axes[1].get_title(loc="left")


def test_pins_with_room_are_reported() -> None:
    done = scanned(PinArray.grid(3, 1, 0.015))
    gap = done.smallest_gap
    assert gap and gap.size > 0.0
    assert done.warnings == ()
    words = f"Smallest gap between neighbouring pins: {1e3 * gap.size:.3f} mm, pins {gap.behind}"
    assert words in said(done) and words in plot_scan(evaluate(done)).get_suptitle()
    alone = scanned(PinArray())
    assert alone.gaps == () and alone.smallest_gap is None
    assert "gap" not in said(alone) and "pin_gap" not in alone.to_dataset([0.0])


def test_the_table_shows_the_least_gap_of_each_pin() -> None:
    done = scanned(PinArray.grid(3, 1, 0.015))
    rows = [line.split() for line in said(done).splitlines() if line[:5].strip().isdigit()]
    least = [row[-1] for row in rows]
    (first, second) = (f"{1e3 * gap.size:.3f}"[:5] for gap in done.gaps)
    assert least == [first, min(first, second, key=float), second]


# ---- whether pins can meet -----------------------------------------------------------------------


def test_no_pin_goes_beyond_its_excursion() -> None:
    """Random devices whose hands accelerate and decelerate."""
    closest_ = 0.0
    for seed in range(60):
        one = RandomScan.of(seed, curved=seed < 8).linear()
        body, path = one.device.drive, one.path
        hurry = np.abs(np.diff(path.vx) / np.diff(path.times)).max() * body.mass / body.stiffness
        most = one.device.excursion(path.peak_speed) + 2.0 * hurry
        pin = one.scan()
        x = np.abs(pin.position(np.linspace(pin.begin, pin.end, 20_001))).max()
        assert x <= most, seed
        closest_ = max(closest_, x / most)
    assert closest_ > 0.8, "a bound that says something"


@pytest.mark.parametrize(
    ("pitch", "words"),
    [
        (0.0010, "Neighbouring pins overlap by 0.5000 mm at rest."),
        (
            0.0025,
            "Neighbouring pins have 1.000 mm between them at rest, and can meet: at 60.00 mm/s",
        ),
        (0.0400, "Neighbouring pins have 38.50 mm between them at rest, and cannot meet: at 60.00"),
    ],
)
def test_geometry_reports_whether_pins_can_meet(pitch: float, words: str) -> None:
    magnet = Electromagnet.from_times(hold_force=3.0)
    device = Device(drive=drive(SKIN), magnet=magnet, array=PinArray.grid(2, 2, pitch))
    found = " ".join(meeting_words(device, 0.06))
    assert words in found
    reach = 0.0265 * (1.0 + 3.0 / 0.0980665) / 100.0 + 0.06 / 100.0
    assert device.excursion(0.06) == pytest.approx(reach, rel=1e-12)
    assert (f"up to {1e3 * reach:.3f} mm either way" in found) == (pitch > 0.0015)


@pytest.mark.usefixtures("in_empty_folder")
def test_check_and_scan_report_it() -> None:
    Path("device.toml").write_text(GOOD + '\n[array]\ncolumns = 2\npitch = "2.5 mm"\n')
    checked = run("check", "device.toml")
    assert "Neighbouring pins have 1.000 mm between them at rest, and can meet" in checked.stdout
    scanned_ = run("scan", "device.toml", "--grating", "4 mm", "-o", "a.nc")
    assert scanned_.exit_code == 0
    assert scanned_.stderr.startswith("warning: pins 0 and 1 overlap by ")
    with xr.open_dataset("a.nc", engine="h5netcdf") as data:
        assert data.smallest_pin_gap < 0.0
    wide = run("check", "device.toml", "--help")
    assert wide.exit_code == 0


@pytest.mark.parametrize("what", ["template", "example"])
@pytest.mark.usefixtures("in_empty_folder")
def test_the_device_that_is_handed_out_can_be_built_and_works(what: str) -> None:
    """Its magnets find room, its pins cannot meet; every line is shown and felt, none is false."""
    if what == "template":
        assert run("init", "device.toml", "--device").exit_code == 0
    example = Path(__file__).parents[2] / "examples" / "tactile-reader.toml"
    file = load_device("device.toml" if what == "template" else example)
    assert file.whole
    device, reading = file.device, file.reading
    assert "cannot meet" in " ".join(meeting_words(device, reading.return_speed))
    assert device.friction.doubt is None
    magnet, height = device.magnet.outer_diameter, device.magnet.height
    assert magnet and height
    assert IRON < device.drive.mass / (pi / 4.0 * magnet**2 * height) < COPPER
    assert min(b[0] - a[0] for a, b in pairwise(device.array.places) if a[1] == b[1]) > magnet
    assert [*doubts(device)] == []
    travel, slot = device.array.travel, device.array.slot_length
    assert travel and slot and slot < 0.005
    assert device.excursion(reading.return_speed) < travel
    for scene in (
        reading.text("Hello", device.array),
        reading.grating([0.001, 0.002, 0.004, 0.008], device.array),
    ):
        evaluated = evaluate(scan(device, scene, reading.strokes(scene, device.array)))
        counts = evaluated.counts
        (of_hand,) = evaluated.scan.warnings
        assert of_hand.startswith("the pins push the hand")
        assert counts["lines.crossed"] > 50
        assert counts["lines.shown"] == counts["lines.crossed"] == counts["lines.direction"]
        assert counts["lines.false"] == 0
        room = evaluated.scan.smallest_gap
        assert room and room.size > 0.0015
        magnets, end = evaluated.scan.smallest_magnet_gap, evaluated.scan.slot_room
        assert magnets and magnets.size == pytest.approx(room.size - (magnet - 0.0015), rel=1e-12)
        assert magnets.size > 0.0 and end and end.size > 0.0

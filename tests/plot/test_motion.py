"""The picture says what the motion says: curves, jumps, events, stuck phases, levels, words."""

import io
import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from subprocess import run

import matplotlib
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from figure_reading import collisions, data, events, lay_out, legend_of, lines, panel, points, spans
from pindrive import Contact, Drive, Motion, Profile, Release, simulate
from pindrive.plot.motion import plot_motion
from pindrive.plot.style import PALETTE, save
from pindrive.plot.trace import Trace

OKABE_ITO = {
    *("#000000", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7"),
}


def drive(
    damping: float = 0.32,
    plate: tuple[float, float] = (0.022, 0.0265),
    finger: tuple[float, float] = (0.005, 0.0075),
) -> Drive:
    return Drive(
        mass=0.010,
        stiffness=100.0,
        damping=damping,
        plate=Contact(*plate),
        finger=Contact(*finger),
    )


SKIN = Drive(
    mass=0.010,
    stiffness=100.0,
    damping=0.32,
    plate=Contact(static=0.0265, curve=[(0.0, 0.022), (0.05, 0.015), (0.1, 0.015)]),
    finger=Contact(0.020, 0.030, stiffness=1000.0),
)
STOP = Profile([0.0, 0.1], [0.06, 0.0])
NONE = (0.0, 0.0)
MOTIONS: dict[str, Callable[[], Motion]] = {
    "example": lambda: simulate(drive(), Release(0.06, 2e-3)),
    "still plate": lambda: simulate(drive(), Release(0.0, 2e-3)),
    "backwards": lambda: simulate(drive(0.2), Release(-0.1, -1.5e-3)),
    "grazing": lambda: simulate(drive(0.0, (0.02, 0.02), NONE), Release(0.1, 3e-3)),
    "stick-slip": lambda: simulate(drive(0.1, (0.05, 0.12), (0.005, 0.005)), Release(0.02, 1e-3)),
    "creep": lambda: simulate(drive(6.0, NONE, NONE), Release(0.05, 2e-3)),
    "slow creep": lambda: simulate(drive(2e4, NONE, NONE), Release(0.05, 2e-3)),
    "free": lambda: simulate(drive(0.0, NONE, NONE), Release(0.06, 2e-3)),
    "at rest": lambda: simulate(drive(), Release(0.0)),
    "pushed": lambda: simulate(drive(), Release(-0.1234, -1.234e-5, velocity=-0.04321)),
    "cut": lambda: simulate(drive(), Release(0.06, 2e-3), duration=0.05),
    "long": lambda: simulate(drive(), Release(0.06, 2e-3), duration=20.0),
    "skin": lambda: simulate(SKIN, Release(STOP, 2e-3)),
    "stiff skin": lambda: simulate(
        replace(SKIN, finger=Contact(0.02, 0.03, stiffness=1e8)), Release(0.06, 2e-3)
    ),
    "magnet": lambda: simulate(
        drive(), Release(STOP, 2e-3, plate_load=Profile([0.0, 0.005], [1.0, 0.2]))
    ),
    "many": lambda: simulate(
        drive(0.0, (1e-6, 1e-6), (1e-6, 1e-6)), Release(0.0, 0.1), duration=200.0
    ),
}
MARKED = [name for name in MOTIONS if name != "many"]


@pytest.fixture(scope="module")
def drawn() -> dict[str, tuple[Motion, Figure]]:
    motions = {name: make() for name, make in MOTIONS.items()}
    return {name: (motion, plot_motion(motion)) for name, motion in motions.items()}


def test_axes_have_units(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    for name, unit in (("example", "ms"), ("long", "s")):
        figure = drawn[name][1]
        assert panel(figure, "a").get_xlabel() == f"time after release ({unit})"
        for axes, ending in (("x", "(mm)"), ("v", "(mm/s)"), ("a", "(m/s²)")):
            assert panel(figure, axes).get_ylabel().endswith(ending)
        assert panel(figure, "portrait").get_xlabel().endswith("(mm)")
        assert panel(figure, "portrait").get_ylabel().endswith("(mm/s)")


@pytest.mark.parametrize(
    "name",
    ["example", "still plate", "backwards", "grazing", "cut", "creep", "skin", "magnet"],
)
def test_curves_are_the_motion(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    motion, figure = drawn[name]
    ends = [s.begin for s in motion.segments[1:]]
    for axes, of, scale in (
        ("x", motion.position, 1e3),
        ("v", motion.velocity, 1e3),
        ("a", motion.acceleration, 1.0),
    ):
        t, y = data(panel(figure, axes), "curve")
        t, y = t[~np.isnan(t)] / 1e3, y[~np.isnan(t)]
        assert t[0] == 0.0
        assert t[-1] == pytest.approx(motion.duration, rel=1e-15)
        assert np.all(np.diff(t) >= 0.0)
        inside = np.min(np.abs(t[:, None] - np.array([*ends, np.inf])), axis=1) > 1e-12
        assert y[inside] == pytest.approx(scale * of(t[inside]), rel=1e-9, abs=1e-12)
        for end in ends:  # each end is there twice: from the left and from the right
            at = np.flatnonzero(np.abs(t - end) < 1e-12)
            limits = [scale * of(end, "left"), scale * of(end, "right")]
            assert y[at] == pytest.approx(limits, rel=1e-12, abs=1e-12)
    x, v = data(panel(figure, "portrait"), "curve")
    assert x.tolist() == data(panel(figure, "x"), "curve")[1].tolist()
    assert v.tolist() == data(panel(figure, "v"), "curve")[1].tolist()


def test_acceleration_jumps(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    motion, figure = drawn["example"]
    a = panel(figure, "a")
    t, _ = data(a, "curve")
    assert np.isnan(t).sum() == len(motion.segments) - 1  # the curve itself does not cross a jump
    (jumps,) = (c for c in a.collections if c.get_gid() == "jumps")
    assert isinstance(jumps, LineCollection)
    drawn_jumps = np.array(jumps.get_segments())
    assert drawn_jumps.shape == (len(motion.segments) - 1, 2, 2)
    for event, ((t0, y0), (t1, y1)) in zip(motion.events, drawn_jumps, strict=True):
        assert t0 == t1 == pytest.approx(1e3 * event.time)
        assert [y0, y1] == pytest.approx(
            [motion.acceleration(event.time, "left"), motion.acceleration(event.time, "right")]
        )


@pytest.mark.parametrize("name", MARKED)
def test_events_are_marked(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    motion, figure = drawn[name]
    if motion.ending.cycle == "stick-slip":
        return
    scale = 1e3 if motion.duration < 2.0 else 1.0
    for kind, contact in product(("stick", "slip", "reverse"), ("plate", "finger", "both")):
        chosen = [e for e in motion.events if (e.kind, e.contact) == (kind, contact)]
        for axes, field in (("x", "position"), ("v", "velocity"), ("portrait", "velocity")):
            across, up = events(panel(figure, axes), kind, contact)
            assert up == pytest.approx([1e3 * getattr(e, field) for e in chosen])
            along = [1e3 * e.position if axes == "portrait" else scale * e.time for e in chosen]
            assert across == pytest.approx(along)


def test_kinds_and_contacts_differ_without_colour(
    drawn: dict[str, tuple[Motion, Figure]],
) -> None:
    """The shape marks the kind; filled at the plate, open at the finger, half at both."""
    seen: dict[str, set[object]] = {}
    for name in ("example", "skin", "still plate"):
        motion, figure = drawn[name]
        handles = legend_of(panel(figure, "key"))
        for kind, contact in {(e.kind, e.contact) for e in motion.events}:
            (line,) = lines(panel(figure, "x"), f"{kind} {contact}")
            seen.setdefault(kind, set()).add(line.get_marker())
            filled = {"plate": "full", "finger": "none", "both": "left"}[contact]
            assert line.get_fillstyle() == filled
            words = {"stick": "sticks", "slip": "slips", "reverse": "reverses"}[kind]
            where = "both" if contact == "both" else f"the {contact}"
            handle = handles[f"{words} at {where}"]
            assert (handle.get_marker(), handle.get_fillstyle()) == (line.get_marker(), filled)
            assert to_hex(handle.get_color()) == to_hex(line.get_color())
    assert seen == {"stick": {"s"}, "slip": {"^"}, "reverse": {"D"}}


@pytest.mark.parametrize("name", MARKED)
def test_stuck_phases_are_shaded(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    motion, figure = drawn[name]
    if motion.ending.cycle == "stick-slip":
        return
    for axes in ("x", "v", "a"):
        for mode in ("carried", "resting"):
            stuck = [s for s in motion.segments if s.mode == mode and s.begin < motion.duration]
            scale = 1e3 if motion.duration < 2.0 else 1.0
            expected = [(scale * s.begin, scale * min(s.end, motion.duration)) for s in stuck]
            found = spans(panel(figure, axes), mode)
            assert found == [pytest.approx(span) for span in expected]


def test_cycle_goes_on_round_after_round(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    motion, figure = drawn["stick-slip"]
    assert motion.duration > motion.segments[-1].end + motion.ending.period
    for axes, of in (("x", motion.position), ("v", motion.velocity)):
        t, y = data(panel(figure, axes), "curve")
        assert t[-1] == pytest.approx(1e3 * motion.duration)
        away = [np.ptp(of(np.clip(ti / 1e3 + np.array([-1e-9, 1e-9]), 0, None))) for ti in t]
        assert np.max(np.abs(y - 1e3 * of(t / 1e3))) < 1e-6 + 1e3 * np.max(away)
    times = events(panel(figure, "v"), "stick", "plate")[0] / 1e3
    assert len(times) > 2
    assert np.diff(times) == pytest.approx(motion.ending.period)
    before = times[times < motion.duration * (1 - 1e-9)]  # the picture ends at a stick
    assert len(spans(panel(figure, "v"), "carried")) == len(before) + 1  # it starts carried


@pytest.mark.parametrize("name", [name for name in MOTIONS if name not in ("skin", "magnet")])
def test_plate_velocity_is_drawn_and_named(
    drawn: dict[str, tuple[Motion, Figure]], name: str
) -> None:
    motion, figure = drawn[name]
    for axes in (panel(figure, "v"), panel(figure, "portrait")):
        level = data(axes, "plate")[1]
        assert level == pytest.approx(1e3 * float(motion.plate_velocity(0.0)))
        low, high = axes.get_ylim()
        assert low < level[0] < high
        assert any(text.get_text().startswith("plate") for text in axes.texts)


def test_a_plate_velocity_that_changes_is_drawn(
    drawn: dict[str, tuple[Motion, Figure]],
) -> None:
    motion, figure = drawn["skin"]
    t, v = data(panel(figure, "v"), "plate")
    assert t == pytest.approx([0.0, 100.0, 1e3 * motion.duration])
    assert v == pytest.approx([60.0, 0.0, 0.0])
    assert not lines(panel(figure, "portrait"), "plate")


def test_skin_has_a_panel(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    motion, figure = drawn["skin"]
    s = panel(figure, "s")
    assert s.get_ylabel().endswith("(µm)")
    assert s.get_xlabel() == "time after release (ms)"
    assert not panel(figure, "a").get_xlabel()
    t, stretch = data(s, "curve")
    inside = np.min(np.abs(t[:, None] / 1e3 - [p.begin for p in motion.segments]), axis=1) > 1e-12
    assert stretch[inside] == pytest.approx(1e6 * motion.stretch(t[inside] / 1e3), abs=1e-9)
    assert stretch.max() == pytest.approx(30.0), "what static friction holds"
    gripping = [p for p in motion.segments if p.finger == 0]
    ends = [1e3 * min(p.end, motion.duration) for p in gripping]
    expected = [(1e3 * p.begin, end) for p, end in zip(gripping, ends, strict=True)]
    assert spans(s, "gripping") == [pytest.approx(span) for span in expected]
    assert "skin grips the pin" in legend_of(panel(figure, "key"))


@pytest.mark.parametrize("name", ["example", "magnet"])
def test_a_rigid_finger_has_no_panel(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    assert "s" not in [axes.get_label() for axes in drawn[name][1].axes]


def test_title_has_the_varied_keys(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    skin, magnet = (drawn[name][1].get_suptitle() for name in ("skin", "magnet"))
    assert r"$F_\mathrm{p}$ = 22 → 15 mN (static 26.5 mN)" in skin
    assert r"$k_\mathrm{f}$ = 1000 N/m" in skin
    assert r"$v_\mathrm{p}$ = 60 → 0 mm/s" in skin
    assert "$λ$ = 1 → 0.2" in magnet
    assert "λ" not in skin
    many = simulate(drive(), Release(Profile(range(9), [0.01 * i for i in range(9)])))
    assert "= 0 mm/s … 80 mm/s" in plot_motion(many).get_suptitle()


def test_settling_is_marked(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    motion, figure = drawn["example"]
    x = panel(figure, "x")
    end, band = motion.ending.position, 0.05 * abs(2e-3 - motion.ending.position)
    levels = sorted(points(line)[1][0] for line in lines(x, "band"))
    assert levels == pytest.approx([1e3 * (end - band), 1e3 * (end + band)])
    time, _ = data(x, "settling")
    assert time == pytest.approx(1e3 * motion.transient.settling_time)
    assert "settled at 116.2 ms" in {text.get_text() for text in x.texts}
    (label,) = (text for text in x.texts if "end" in text.get_text())
    assert label.xy[1] == pytest.approx(1e3 * end)  # type: ignore[attr-defined]
    said = r"$x_\mathrm{end}$ ± 5 % of $|x_0 - x_\mathrm{end}|$"
    assert legend_of(panel(figure, "key"))[said].get_linestyle() == ":"
    assert not lines(panel(drawn["cut"][1], "x"), "settling")


@pytest.mark.parametrize("name", ["example", "backwards", "skin"])
def test_peak_and_trough_are_where_they_are(
    drawn: dict[str, tuple[Motion, Figure]], name: str
) -> None:
    motion, figure = drawn[name]
    numbers = motion.transient
    t, x = data(panel(figure, "x"), "curve")
    outward = 1.0 if name != "backwards" else -1.0
    for label, time, place, extreme in (
        ("peak", numbers.peak_time, numbers.peak_displacement, outward),
        ("trough", numbers.trough_time, numbers.trough_displacement, -outward),
    ):
        (text,) = (i for i in panel(figure, "x").texts if i.get_text().startswith(label))
        assert text.xy == pytest.approx((1e3 * time, 1e3 * place))  # type: ignore[attr-defined]
        shown = text.get_text().removeprefix(label).removesuffix(" mm").replace("−", "-")
        assert float(shown) == pytest.approx(1e3 * place, rel=1e-3)
        assert text.get_verticalalignment() == ("bottom" if extreme > 0.0 else "top"), (
            "outside of the curve"
        )
    first = x[t <= 1e3 * max(numbers.peak_time, numbers.trough_time)]
    assert max(outward * first) == pytest.approx(outward * 1e3 * numbers.peak_displacement)
    assert min(outward * first) == pytest.approx(outward * 1e3 * numbers.trough_displacement)


@pytest.mark.parametrize("name", ["example", "backwards", "cut", "skin"])
def test_the_portrait_begins_and_ends_where_the_motion_does(
    drawn: dict[str, tuple[Motion, Figure]], name: str
) -> None:
    motion, figure = drawn[name]
    axes = panel(figure, "portrait")
    start, end = (points(line) for line in lines(axes, "ends"))
    assert [i.item() for i in start] == pytest.approx(
        [1e3 * float(motion.position(0.0)), 1e3 * float(motion.velocity(0.0))]
    )
    last = [1e3 * float(of(motion.duration)) for of in (motion.position, motion.velocity)]
    assert [i.item() for i in end] == pytest.approx(last, abs=1e-9)
    words = {text.get_text(): text.xy for text in axes.texts}  # type: ignore[attr-defined]
    assert words["start"] == pytest.approx(tuple(i.item() for i in start))
    assert words["50 ms" if name == "cut" else "end"] == pytest.approx(last, abs=1e-9)
    for mode in ("carried", "resting"):
        x, v = data(axes, mode)
        stuck = [s for s in motion.segments if s.mode == mode and s.begin < motion.duration]
        assert (~np.isnan(x)).any() == bool(stuck)
        assert mode != "resting" or v[~np.isnan(v)] == pytest.approx(0.0, abs=1e-9)


def test_a_steady_motion_names_its_middle(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    motion, figure = drawn["stick-slip"]
    (line,) = lines(panel(figure, "x"), "middle")
    assert points(line)[1] == pytest.approx(1e3 * motion.ending.position)
    assert any("about which it oscillates" in said for said in legend_of(panel(figure, "key")))


def test_each_tint_and_jump_is_explained(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    for name, (motion, figure) in drawn.items():
        said = legend_of(panel(figure, "key"))
        x = panel(figure, "x")
        tints = [mode for mode in ("carried", "resting") if spans(x, mode)]
        colours = {to_hex(h.get_facecolor()) for h in said.values() if hasattr(h, "get_hatch")}
        assert {to_hex(PALETTE[mode]) for mode in tints} <= colours, name
        assert ("acceleration jumps" in said) == (len(motion.segments) > 1), name
    example = legend_of(panel(drawn["example"][1], "key"))
    for words, mode in (
        ("carried by the plate", "carried"),
        ("resting on the finger", "resting"),
    ):
        assert to_hex(example[words].get_facecolor()) == to_hex(PALETTE[mode])


def test_title_has_the_numbers(drawn: dict[str, tuple[Motion, Figure]]) -> None:
    _, figure = drawn["example"]
    title = figure.get_suptitle()
    for words in ("settling time 116.2 ms", "swing 2.914 mm", "10 g", "100 N/m", "60 mm/s"):
        assert words in title


def test_too_many_events_are_not_marked_and_this_is_reported(
    drawn: dict[str, tuple[Motion, Figure]],
) -> None:
    motion, figure = drawn["many"]
    assert len(motion.events) > 5000
    assert {line.get_gid() for line in panel(figure, "x").lines} == {"zero", "curve"}
    assert "5000 events: too many to mark" in legend_of(panel(figure, "key"))
    t, _ = data(panel(figure, "x"), "curve")
    assert 100.0 < t[-1] < 200.0
    assert panel(figure, "a").get_xlim() == pytest.approx((0.0, t[-1]))
    said = f"time after release (s): the first {t[-1]:.4g} s of 200 s"
    assert panel(figure, "a").get_xlabel() == said


def test_a_long_motion_is_drawn_round() -> None:
    """Halfway between two points of the curve the pin is next to the line that joins them."""
    freely = drive(2e-4, NONE, (2e-5, 2e-5))
    motion = simulate(freely, Release(0.06, 2e-3), duration=40.0)
    trace = Trace.of(motion)
    assert trace.end > 30.0
    between = (trace.t[1:] + trace.t[:-1]) / 2.0 / trace.scale
    off = np.abs(1e3 * motion.position(between) - (trace.x[1:] + trace.x[:-1]) / 2.0)
    assert off.max() < 5e-4 * np.ptp(trace.x)


def test_a_pin_that_is_carried_for_days_is_drawn_to_its_end() -> None:
    motion = simulate(drive(plate=(1e3, 1e3)), Release(1e-5))
    assert motion.duration > 1e6
    figure = plot_motion(motion)
    t, x = data(panel(figure, "x"), "curve")
    assert t[-1] == pytest.approx(motion.duration)
    assert panel(figure, "a").get_xlabel() == "time after release (s)"
    assert x.max() == pytest.approx(1e3 * motion.transient.peak_displacement)
    assert len(t) < 200_000


@pytest.mark.parametrize("name", MOTIONS)
def test_no_words_overlap(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    assert collisions(drawn[name][1]) == []


def test_colours_are_from_the_palette() -> None:
    assert {to_hex(colour).upper() for colour in PALETTE.values()} <= OKABE_ITO
    assert len({PALETTE[name] for name in ("curve", "stick", "slip", "reverse")}) == 4
    assert PALETTE["carried"] != PALETTE["resting"]


@pytest.mark.parametrize("name", MOTIONS)
def test_words_stay_on_the_page(drawn: dict[str, tuple[Motion, Figure]], name: str) -> None:
    figure = drawn[name][1]
    lay_out(figure)
    page = figure.bbox
    legend = panel(figure, "key").get_legend()
    words = [*figure.texts, *(legend.get_texts() if legend else [])]
    for axes in figure.axes:
        words += [*axes.texts, axes.xaxis.label, axes.yaxis.label]
    assert len(words) > 15
    for text in words:
        box = text.get_window_extent()
        assert page.x0 <= box.x0 and box.x1 <= page.x1, text
        assert page.y0 <= box.y0 and box.y1 <= page.y1, text


def test_a_motion_cut_short_leaves_out_what_lies_far_beyond() -> None:
    """It goes on for days: where it will rest takes no room, where the drawing stops is said."""
    motion = simulate(drive(plate=(1e3, 1e3)), Release(1e-5), duration=10.0)
    figure = plot_motion(motion)
    figure.draw_without_rendering()  # a layout that fails warns, which is an error here
    portrait = {text.get_text() for text in panel(figure, "portrait").texts}
    assert {"start", "10 s"} <= portrait and "end" not in portrait
    assert panel(figure, "x").get_ylim()[1] < 1.0, "mm"
    assert panel(figure, "x").get_window_extent().width > 0.25 * figure.bbox.width


def test_end_stops_are_marked_and_named() -> None:
    stops = replace(drive(), travel=1e-3, stop_stiffness=1e3)
    motion = simulate(stops, Release(0.06, displacement=2e-3))
    figure = plot_motion(motion)
    legend = panel(figure, "key").get_legend()
    words = {text.get_text() for text in legend.get_texts()} if legend else set()
    assert {"strikes an end stop", "leaves an end stop"} <= words
    force = panel(figure, "f")
    (curve,) = [line for line in force.lines if line.get_gid() == "curve"]
    t, drawn = np.asarray(curve.get_xdata()) / 1e3, np.asarray(curve.get_ydata())
    inside = ~np.isnan(drawn)
    inside[[0, *np.flatnonzero(np.diff(inside)), *np.flatnonzero(np.diff(inside)) + 1]] = False
    assert np.abs(drawn[inside] - motion.force("stop", t[inside])).max() < 1e-12
    assert np.nanmin(drawn) < -0.1 and np.nanmax(drawn) >= 0.0, "N: it pushes the pin back"
    assert force.get_ylabel() == "stop force $R_s$ (N)"
    assert force.get_xlabel().startswith("time after release")
    assert not panel(figure, "a").get_xlabel()


def test_a_drive_without_end_stops_has_no_panel_of_their_force(
    drawn: dict[str, tuple[Motion, Figure]],
) -> None:
    for _, figure in drawn.values():
        assert "f" not in [axes.get_label() for axes in figure.axes]


@pytest.mark.parametrize(("format", "start"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_save(drawn: dict[str, tuple[Motion, Figure]], format: str, start: bytes) -> None:
    file = io.BytesIO()
    save(drawn["creep"][1], file, format)
    assert file.getvalue().startswith(start)


def test_svg_has_text_and_is_reproducible(
    drawn: dict[str, tuple[Motion, Figure]], tmp_path: Path
) -> None:
    files = [tmp_path / "a.svg", tmp_path / "b.svg"]
    for file in files:
        save(plot_motion(drawn["creep"][0]), file)
    text = files[0].read_text(encoding="utf-8")
    assert ">time after release (ms)</text>" in text
    assert text == files[1].read_text(encoding="utf-8")


def test_a_readers_settings_neither_matter_nor_change() -> None:
    motion = MOTIONS["creep"]()
    plain = io.BytesIO()
    save(plot_motion(motion), plain, "svg")
    with matplotlib.rc_context({"font.size": 30.0, "lines.linewidth": 9.0, "svg.fonttype": "path"}):
        before = dict(matplotlib.rcParams)
        themed = io.BytesIO()
        save(plot_motion(motion), themed, "svg")
        assert dict(matplotlib.rcParams) == before
    assert plain.getvalue() == themed.getvalue()


def test_pyplot_is_not_imported() -> None:
    code = "import pindrive.plot.motion, sys; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert run([sys.executable, "-c", code], check=False).returncode == 0

"""The page in headless Chromium, opened from disk."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import pindrive as pd
from command import EXAMPLE, EXAMPLES, SKIN, run
from pindrive.files.keys import template
from pindrive.fitting.recording import read_recording
from pindrive.motion.simulate import motion_of
from pindrive.quantities.csv_table import CsvTable
from pindrive.quantities.results import SERIES
from studio_cases import NAMES, Ask, questions
from studio_page import (
    VALUES,
    choose_example,
    elastic_stops,
    numbers_shown,
    opened,
    pushed,
    rigid_stops,
    saved,
    settled,
    value,
)

AXE = Path(__file__).parents[2] / "studio" / "node_modules" / "axe-core" / "axe.min.js"
READER = EXAMPLES / "tactile-reader.toml"


def test_a_thousand_random_drives_give_the_bits_of_node(page: Any, node: Ask) -> None:
    """The bits of Node equal Python's: test_core.py."""
    _, requested = questions(1000, 16)
    answers = page.evaluate(
        "asked => asked.map(q => pindrive.answerOf(pindrive.core, q.simulate, q.duration))",
        requested,
    )
    assert answers == node(requested)


def test_sliders_fields_keys_and_undo_change_the_motion(page: Any) -> None:
    slider = page.locator("#drive-mass-slider")
    before = page.locator("#summary").inner_text()
    slider.focus()
    page.keyboard.press("PageUp")
    settled(page)
    heavier = value(page, "drive.mass")
    assert heavier > 0.01
    assert page.locator("#summary").inner_text() != before
    page.keyboard.press("Control+z")
    settled(page)
    assert value(page, "drive.mass") == 0.01
    assert page.locator("#summary").inner_text() == before
    page.keyboard.press("Control+Shift+z")
    settled(page)
    assert value(page, "drive.mass") == heavier
    page.fill("#plate-kinetic", "0.03 N")
    page.keyboard.press("Enter")
    settled(page)
    assert value(page, "plate.kinetic") == 0.03
    assert value(page, "plate.static") == pytest.approx(0.03 * 26.5 / 22, rel=1e-15)
    assert page.input_value("#plate-static") == "36.1364"
    assert page.input_value("#plate-kinetic") == "30"
    page.fill("#plate-kinetic", "heavy")
    page.keyboard.press("Enter")
    assert (
        "plate.kinetic must be a number with its unit"
        in page.locator("#plate-kinetic-note").inner_text()
    )
    assert value(page, "plate.kinetic") == 0.03


def test_two_changes_before_a_drawing_are_both_kept(page: Any) -> None:
    page.evaluate(
        """() => {
          const set = (id, value, event) => {
            const input = document.getElementById(id);
            input.value = value;
            input.dispatchEvent(new Event(event));
          };
          set("map-x", "drive.mass", "change");
          set("map-y", "drive.stiffness", "change");
          set("drive-mass", "3", "change");
          set("drive-stiffness", "200", "change");
          document.getElementById("design-name").value = "two";
          document.getElementById("design-name").dispatchEvent(new Event("change"));
        }"""
    )
    settled(page)
    state = page.evaluate("pindrive.release.state")
    assert state["map"] == {"x": "drive.mass", "y": "drive.stiffness"}
    assert state["designs"][0]["name"] == "two"
    assert (value(page, "drive.mass"), value(page, "drive.stiffness")) == (0.003, 200)


def test_a_ratio_survives_a_value_of_zero(page: Any) -> None:
    for given in ("0 N", "22 mN"):
        page.fill("#plate-kinetic", given)
        page.keyboard.press("Enter")
        settled(page)
        assert page.locator("#plate-kinetic-note").inner_text() == ""
    assert value(page, "plate.static") == pytest.approx(0.0265, rel=1e-15)
    page.fill("#plate-kinetic", "0 N")
    page.keyboard.press("Enter")
    page.fill("#drive-mass", "11 g")
    page.keyboard.press("Enter")
    page.fill("#plate-kinetic", "22 mN")
    page.keyboard.press("Enter")
    settled(page)
    assert value(page, "plate.static") == value(page, "plate.kinetic") == 0.022


@pytest.mark.parametrize("device", [EXAMPLE, SKIN, READER, pushed, rigid_stops, elastic_stops])
def test_displayed_values_equal_python(
    page: Any, device: Path | Callable[[Path], Path], tmp_path: Path
) -> None:
    device = device if isinstance(device, Path) else device(tmp_path)
    opened(page, device)
    motion = motion_of(pd.load_device(device))
    curves = "pindrive.release.view.lines[0].result.curves"
    phases = page.evaluate(f"{curves}.phases.map(({{kind, begin, end}}) => [kind, begin, end])")
    window = page.evaluate("pindrive.release.view.end")
    last = motion.segments[-1].end  # from where on a cycle goes on, of which Python keeps one round
    for kind in ("carried", "resting"):
        shown_ends = {end for name, *ends in phases if name == kind for end in ends if end <= last}
        stuck = [s for s in motion.segments if s.mode == kind and s.begin < window]
        ends = {end for s in stuck for end in (s.begin, min(s.end, window))}
        assert shown_ends <= ends, kind
        assert bool(shown_ends) == bool(ends), kind
    shown = numbers_shown(page)
    for name in NAMES:
        expected = float(motion.numbers()[name])
        assert shown[name] == (
            pytest.approx(expected, rel=1e-12, abs=1e-15) if np.isfinite(expected) else None
        ), name
    events = page.evaluate("pindrive.release.view.lines[0].result.curves.events")
    assert [(e["contact"], e["kind"]) for e in events] == [
        (event.contact, event.kind) for event in motion.events
    ]
    for shown_event, event in zip(events, motion.events, strict=True):
        for quantity in ("time", "position", "velocity"):
            given = getattr(event, quantity)
            assert shown_event[quantity] == pytest.approx(given, rel=1e-12, abs=1e-17), quantity
    rows = page.locator("section.events tbody tr").count()
    assert rows == min(len(motion.events), 100)
    kinds = {event.kind for event in motion.events}
    stops = page.locator("p.legend .mark.stop").first.is_visible()
    assert stops == (device.stem == "stopped") == ({"stop", "leave"} <= kinds)


def test_a_velocity_that_is_zero_but_for_rounding_is_shown_as_zero(page: Any) -> None:
    opened(page, EXAMPLE)
    page.fill("#drive-damping_ratio", "0.32")
    page.keyboard.press("Enter")
    settled(page)
    rows = page.locator("section.events tbody tr")
    assert rows.count() == 4
    assert {rows.nth(i).locator("td").last.inner_text() for i in range(4)} == {"0"}


def test_derivatives_are_those_of_python(page: Any) -> None:
    opened(page, EXAMPLE)
    bars = page.evaluate(
        "(() => { const rows = {}; for (const row of document.querySelectorAll('.bars tbody tr'))"
        " rows[row.querySelector('th').textContent] = row.querySelector('td.figure').textContent;"
        " return rows; })()"
    )
    device = pd.load_device(EXAMPLE)
    base = motion_of(device).transient.settling_time
    step = 1e-6
    for key, name in (
        ("mass", "mass"),
        ("plate.kinetic", "plate kinetic"),
        ("displacement", "displacement"),
    ):
        values = device.values()
        full = next(full for full in values if full.endswith(key))
        given = values[full]
        assert isinstance(given, float)
        more = motion_of(
            pd.load_device(EXAMPLE, {full: given * (1 + step)})
        ).transient.settling_time
        expected = (more - base) / step * 0.01 * 1e3
        shown = float(bars[name].split(" ")[0].replace("−", "-").replace("+", ""))
        assert shown == pytest.approx(expected, rel=5e-3), name
    page.get_by_label("duration", exact=False).first.check()
    page.fill("#motion-duration", "5")  # ms, in which it does not settle
    page.keyboard.press("Enter")
    settled(page)
    assert page.locator(".bars").inner_text() == "This motion has no settling time."


def test_every_file_goes_out_and_in_again(
    page: Any, browser: Any, page_file: Path, tmp_path: Path
) -> None:
    opened(page, SKIN)
    toml = saved(page, "toml", tmp_path)
    assert pd.load_device(toml).values() == pd.load_device(SKIN).values()
    opened(page, toml)
    assert page.evaluate(
        "JSON.stringify(pindrive.release.state.designs[1].values)"
    ) == page.evaluate("JSON.stringify(pindrive.release.state.designs[2].values)")
    csv = saved(page, "csv", tmp_path)
    recording = read_recording(csv)
    motion = motion_of(pd.load_device(SKIN))
    expected = motion.position(recording.time)
    np.testing.assert_allclose(recording.channels["position"], expected, rtol=0, atol=1e-17)
    opened(page, csv)
    assert page.evaluate("pindrive.release.state.overlay.recording.times.length") == len(
        recording.time
    )
    events = CsvTable.read(saved(page, "events", tmp_path), "events", "")
    times = events.column("time", SERIES["time"])
    assert times == pytest.approx([event.time for event in motion.events], rel=1e-14)
    svg = ET.fromstring(saved(page, "svg", tmp_path).read_text("utf-8"))
    drawn = {g.get("data-quantity") for g in svg.iter("{http://www.w3.org/2000/svg}g")}
    assert drawn >= {"position", "velocity", "acceleration", "plate_force", "stretch"}
    with Image.open(saved(page, "png", tmp_path)) as picture:
        assert picture.format == "PNG"
        assert picture.width == 3 * 640
        assert len(picture.convert("RGB").getcolors(1 << 24) or ()) > 20
    link = page.evaluate("pindrive.studio.link()")
    other = browser.new_context().new_page()
    other.goto(link)
    other.wait_for_selector("html[data-ready]")
    state = "JSON.stringify({...pindrive.release.state, cursor: 0})"
    assert other.evaluate(state) == page.evaluate(state)
    other.context.close()


def test_friction_is_given_by_forces_or_by_coefficients(page: Any, tmp_path: Path) -> None:
    before = numbers_shown(page)
    assert page.locator("#plate-coefficient").is_hidden()
    for contact in ("plate", "finger"):
        page.select_option(f"#{contact}-kind", "coefficient")
        settled(page)
    pressed = 0.01 * 9.80665 + 0.01  # weight and touch
    assert value(page, "plate.coefficient") == pytest.approx(0.022 / pressed, rel=1e-13)
    assert value(page, "finger.touch_force") == 0.01
    assert value(page, "plate.kinetic") is None
    assert page.locator("#plate-kinetic").is_hidden()
    after = numbers_shown(page)
    known = [name for name, number in before.items() if number is not None]
    assert [after[name] for name in known] == pytest.approx([before[name] for name in known], 1e-9)
    page.fill("#drive-mass", "20")  # and with it the weight
    page.keyboard.press("Enter")
    settled(page)
    written = pd.load_device(saved(page, "toml", tmp_path))
    heavier = 0.022 * (0.02 * 9.80665 + 0.01) / pressed
    assert written.drive.plate.kinetic == pytest.approx(heavier, rel=1e-13)
    for contact in ("plate", "finger"):
        page.select_option(f"#{contact}-kind", "force")
        settled(page)
    assert value(page, "plate.kinetic") == pytest.approx(heavier, rel=1e-13)
    assert value(page, "finger.touch_force") is None


def test_a_recording_is_dropped_and_shifted_by_hand(page: Any) -> None:
    page.evaluate(
        """() => {
          const rows = Array.from({length: 20}, (_, i) => `${i},${Math.cos(i / 3)}`).join("\\n");
          const data = new DataTransfer();
          data.items.add(new File([`time [ms],position [mm]\\n${rows}\\n`], "dropped.csv"));
          document.body.dispatchEvent(new DragEvent("drop", {dataTransfer: data, bubbles: true}));
        }"""
    )
    page.wait_for_selector("#recording-words")
    assert "dropped.csv: 20 samples of position" in page.locator("#recording-words").inner_text()
    page.fill("#offset", "7.5")
    page.keyboard.press("Enter")
    settled(page)
    assert page.evaluate("pindrive.release.state.overlay.offset") == 0.0075


@pytest.mark.parametrize(
    ("old", "new"),
    [("10 g", "10"), ("mass", "mas"), ("22 mN", "-1 mN")],
)
def test_error_has_the_words_of_the_command(page: Any, tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(template().replace(old, new, 1), "utf-8")
    opened(page, path)
    said = page.locator("#problem").inner_text().strip()
    assert said == run("check", path).stderr.strip().replace(str(path), path.name)
    opened(page, EXAMPLE)
    assert page.locator("#problem").is_hidden()


def test_an_error_of_the_syntax_has_its_place(page: Any, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(template().replace("kinetic = ", "kinetic ", 1), "utf-8")
    opened(page, path)
    said = page.locator("#problem").inner_text().strip()
    place = run("check", path).stderr.partition("(")[2].strip()
    assert said.startswith("bad.toml: is not valid TOML: ") and said.endswith(f"({place}")


def test_device_and_curve_stay_in_sight_beside_a_slider_on_a_telephone(page: Any) -> None:
    page.set_viewport_size({"width": 390, "height": 844})
    settled(page)
    for key in ("drive-mass", "finger-kinetic", "motion-displacement"):
        slider = page.locator(f"#{key}-slider")
        slider.scroll_into_view_if_needed()
        slider.focus()
        settled(page)
        device, curve = (page.locator(of).bounding_box() for of in (".animation", ".sketch"))
        place = slider.bounding_box()
        assert device["y"] >= -1 and curve["y"] + curve["height"] < place["y"] < 844, key


def test_help_explains_the_view_and_closes(page: Any) -> None:
    page.get_by_role("button", name="Help", exact=True).click()
    words = page.get_by_role("dialog").inner_text()
    assert "Space" in words and pd.__version__ in words
    page.keyboard.press("Escape")
    assert page.get_by_role("dialog").count() == 0


def test_the_time_axis_zooms_and_pans(page: Any, tmp_path: Path) -> None:
    """A zoom samples the shown span as finely as the whole motion."""
    span = "pindrive.release.view.span"
    samples = (
        "(() => { const {view: {span: [from, to], lines}} = pindrive.release;"
        " return lines[0].result.curves.times.filter(t => t >= from && t <= to).length; })()"
    )
    axis = page.get_by_role("group", name="time axis")

    def click(name: str) -> None:
        axis.get_by_role("button", name=name, exact=True).click()
        settled(page)

    begin, end = page.evaluate(span)
    assert begin == 0
    page.evaluate("pindrive.release.setCursor(0.05)")
    for _ in range(7):
        click("+")
    left, right = page.evaluate(span)
    assert right - left == pytest.approx(end / 128) and left < 0.05 < right
    assert page.evaluate(samples) > 800
    click("›")
    assert page.evaluate(span) == pytest.approx([left + 0.5 * (right - left)] * 2, abs=right - left)
    assert page.evaluate(span)[0] > left
    svg = saved(page, "svg", tmp_path).read_text("utf-8")
    times = [float(x) for x in re.findall(r'text-anchor="middle">([\d.]+)</text>', svg)]
    assert min(times) >= 1e3 * left and max(times) <= 1e3 * (right + 0.5 * (right - left)) + 1e-9
    click("All")
    assert page.evaluate(span) == [0, end]
    box = page.locator(".chart .u-over").first.bounding_box()
    page.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 20, steps=5)
    page.mouse.up()
    settled(page)
    assert page.evaluate(span) == pytest.approx([0.25 * end, 0.5 * end], rel=0.02)
    page.mouse.dblclick(box["x"] + 0.3 * box["width"], box["y"] + 20)
    settled(page)
    assert page.evaluate(span) == [0, end]


def test_each_quantity_has_a_panel(page: Any, tmp_path: Path) -> None:
    """The force on the housing is one; a finger with skin adds its stretch, damped or not."""

    def titles() -> list[str]:
        names = "plots => plots.map((plot) => plot.getAttribute('aria-label'))"
        found = page.locator(".chart .uplot").evaluate_all(names)
        return [title.removesuffix(" over time") for title in found]

    rigid = titles()
    assert rigid[-1] == "Force on the housing"
    assert len(rigid) == 5
    path = tmp_path / "skin.toml"
    text = EXAMPLE.read_text("utf-8")
    given = 'static = "7.5 mN"\nstiffness = "300 N/m"\ndamping = "0.3 N*s/m"'
    path.write_text(text.replace('static = "7.5 mN"', given), "utf-8")
    opened(page, path)
    settled(page)
    assert titles() == [*rigid, "Skin stretch"]


def test_a_long_motion_leaves_the_page_free_and_is_stopped(page: Any, tmp_path: Path) -> None:
    """An undamped pin under hardly any friction turns a million times."""
    path = tmp_path / "long.toml"
    text = EXAMPLE.read_text("utf-8").replace("damping_ratio = 0.16", "damping_ratio = 0")
    for given in ('"22 mN"', '"26.5 mN"', '"5 mN"', '"7.5 mN"'):
        text = text.replace(f"= {given}", '= "1e-7 N"')
    path.write_text(text, "utf-8")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Open …", exact=True).click()
    chooser.value.set_files(path)
    stop = page.get_by_role("button", name="Stop", exact=True)
    stop.wait_for(state="visible")
    longest = page.evaluate("""async () => {
      let [longest, last] = [0, performance.now()];
      for (let i = 0; i < 30; ++i) {
        await new Promise(done => setTimeout(done));
        longest = Math.max(longest, performance.now() - last);
        last = performance.now();
      }
      return longest;
    }""")
    assert longest < 1000  # the simulation itself takes ten times as long
    page.fill("#drive-mass", "12")
    page.keyboard.press("Enter")
    assert value(page, "drive.mass") == pytest.approx(0.012)
    stop.click()
    page.wait_for_timeout(400)
    stop.click()  # of the mass that was typed
    settled(page)
    assert page.locator("#summary").inner_text().startswith("Stopped.")
    assert stop.is_hidden()
    page.fill("#drive-damping_ratio", "0.16")
    page.keyboard.press("Enter")
    settled(page)
    assert "rests" in page.locator("#summary").inner_text() or numbers_shown(page)


def test_typed_text_outlasts_a_drawing_of_the_page(page: Any) -> None:
    """A field keeps its text while the page is redrawn in the next frame."""
    page.locator("#drive-stiffness").select_text()
    page.keyboard.type("15")
    page.evaluate("pindrive.release.render()")
    page.keyboard.type("0")
    page.evaluate("pindrive.release.render()")
    assert page.input_value("#drive-stiffness") == "150"
    assert value(page, "drive.stiffness") == 100
    page.keyboard.press("Enter")
    settled(page)
    assert value(page, "drive.stiffness") == 150
    page.keyboard.type("7")
    page.locator("#drive-stiffness").blur()
    page.get_by_role("button", name="Undo").click()
    settled(page)
    assert page.input_value("#drive-stiffness") == "150"


def test_designs_ghost_and_delete(page: Any) -> None:
    page.get_by_role("button", name="Keep ghost").click()
    page.fill("#drive-stiffness", "150")
    page.keyboard.press("Enter")
    settled(page)
    kinds = "pindrive.release.view.lines.map(line => [line.kind, line.values['drive.stiffness']])"
    assert page.evaluate(kinds) == [["current", 150], ["ghost", 100]]
    page.get_by_role("button", name="Copy").click()
    settled(page)
    page.fill("#design-name", "soft")
    page.keyboard.press("Enter")
    page.fill("#drive-stiffness", "50")
    page.keyboard.press("Enter")
    settled(page)
    assert page.evaluate(kinds) == [["current", 50], ["ghost", 100], ["other", 150]]
    assert page.locator("section.numbers thead").inner_text().split() == [
        "number", "unit", "soft", "ghost", "my", "pin", "drive",
    ]  # fmt: skip
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("button", name="Drop ghost").click()
    settled(page)
    assert page.evaluate(kinds) == [["current", 150]]


def test_the_map_holds_the_numbers_of_python_and_its_dot_moves(page: Any) -> None:
    page.wait_for_selector(".map-holder[data-took]")
    found = page.evaluate(
        "(() => { const r = pindrive.release.map; return {values: [...r.last.values],"
        " met: [...r.last.met],"
        " x: [...r.task.varied.mouse_velocity.x], y: [...r.task.varied['plate.kinetic'].y]}; })()"
    )
    assert min(found["x"]) > 0.0  # the hand moves as it does in the design
    device = pd.load_device(EXAMPLE)
    for i, j in ((0, 0), (63, 5), (31, 40), (50, 63)):
        given = {"motion.mouse_velocity": found["x"][i], "plate.kinetic": found["y"][j]}
        time = motion_of(pd.load_device(EXAMPLE, given)).transient.settling_time
        assert device.drive.plate.static is not None
        assert found["values"][64 * j + i] == pytest.approx(time, rel=1e-9)
        assert found["met"][64 * j + i] == (time <= 0.1)
    alpha = page.evaluate(
        "(() => { const {image} = pindrive.release.map.view;"
        " const {data} = image.getContext('2d').getImageData(0, 0, 64, 64);"
        " return Array.from({length: 4096}, (_, i) => data[4 * i + 3]); })()"
    )
    shaded = np.reshape(alpha, (64, 64))[::-1].ravel() < 255  # rows from the smallest y
    assert np.array_equal(shaded, np.array(found["met"]) == 0)
    assert 0 < shaded.sum() < shaded.size
    canvas = page.locator("canvas.map")
    canvas.hover(position={"x": 120, "y": 90})
    told = page.locator(".pointed").inner_text()
    number, x, y = (float(part) for part in re.findall(r"[\d.]+", told))
    given = {"motion.mouse_velocity": 1e-3 * x, "plate.kinetic": 1e-3 * y}
    time = motion_of(pd.load_device(EXAMPLE, given)).transient.settling_time
    assert number == pytest.approx(1e3 * time, rel=2e-2), told
    page.mouse.move(5, 5)
    assert page.locator(".pointed").inner_text() == ""
    canvas.focus()
    page.keyboard.press("ArrowRight")
    settled(page)
    assert value(page, "motion.mouse_velocity") > 0.06
    box = canvas.bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 60)
    page.mouse.down()
    page.mouse.move(box["x"] + 110, box["y"] + 80)
    page.mouse.up()
    settled(page)
    assert value(page, "motion.mouse_velocity") < 0.06
    assert value(page, "plate.kinetic") > 0.022


def recorded(path: Path, rows: int, offset: float, **drive: Any) -> None:
    """Writes a recording of a release of the template's drive with other values, in ms and mm."""
    motion = motion_of(pd.load_device(EXAMPLE, drive))
    t = np.linspace(0, 0.2, rows)
    since = t - offset
    x = motion.position(np.maximum(since, 0)) + float(motion.velocity(0.0)) * np.minimum(since, 0)
    np.savetxt(
        path,
        np.column_stack([1e3 * t, 1e3 * x]),
        "%.9g",
        ",",
        header="time [ms],position [mm]",
        comments="",
    )


def test_a_recording_of_a_hundred_thousand_rows_is_fitted(page: Any, tmp_path: Path) -> None:
    path = tmp_path / "bench.csv"
    recorded(path, 100_000, 0.012, mass=0.0125, **{"drive.damping_ratio": 0.11})
    opened(page, EXAMPLE, path)
    page.wait_for_selector("#recording-words", timeout=20_000)
    assert "100000 samples of position" in page.locator("#recording-words").inner_text()
    page.get_by_role("button", name="by least squares").click()
    settled(page)
    assert page.evaluate("pindrive.release.state.overlay.offset") == pytest.approx(0.012, abs=5e-3)
    for box in ("#fit-drive-mass", "#fit-drive-damping_ratio", "#fit-offset"):
        page.check(box)
    page.get_by_role("button", name="Fit", exact=True).click()
    settled(page)
    assert value(page, "drive.mass") == pytest.approx(0.0125, rel=1e-4)
    assert value(page, "drive.damping_ratio") == pytest.approx(0.11, rel=1e-3)
    assert page.evaluate("pindrive.release.state.overlay.offset") == pytest.approx(0.012, abs=1e-5)


def test_one_cursor_runs_through_all_curves(page: Any) -> None:
    page.locator(".u-over").first.hover(position={"x": 150, "y": 40})
    settled(page)
    places = page.evaluate(
        "[...document.querySelectorAll('.u-cursor-x')].map(e => e.style.transform.split('px')[0])"
    )
    assert len(places) == 5 and len(set(places)) == 1
    assert page.evaluate("pindrive.release.state.cursor") > 0.01


def test_the_device_moves_with_the_cursor_and_can_be_heard(page: Any) -> None:
    picture = "document.querySelector('canvas.animation').toDataURL()"
    before = page.evaluate(picture)
    page.evaluate("pindrive.release.setCursor(0.03)")
    assert page.locator(".player output").inner_text() == "30.00 ms"
    assert page.evaluate(picture) != before
    positions = page.evaluate("document.querySelector('.u-cursor-x').style.transform")
    page.get_by_role("button", name="Play").click()
    page.wait_for_timeout(250)
    page.get_by_role("button", name="Pause").click()
    assert page.evaluate("pindrive.release.state.cursor") > 0.03
    assert page.evaluate("document.querySelector('.u-cursor-x').style.transform") != positions
    page.get_by_role("button", name="Listen").click()
    page.get_by_role("button", name="Stop").click()
    page.get_by_role("button", name="Listen").wait_for()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation_at_any_width(page: Any, tmp_path: Path, scheme: str) -> None:
    page.emulate_media(color_scheme=scheme)
    recorded(tmp_path / "r.csv", 50, 0.0)
    bad = tmp_path / "bad.toml"
    bad.write_text("x", "utf-8")
    page.get_by_role("button", name="Keep ghost").click()
    page.get_by_role("button", name="Copy").click()
    opened(page, SKIN, tmp_path / "r.csv", bad)
    page.evaluate(AXE.read_text("utf-8"))
    for width in (320, 1280):
        page.set_viewport_size({"width": width, "height": 900})
        settled(page)
        found = page.evaluate("axe.run({resultTypes: ['violations']})")
        assert [
            (v["id"], [n["html"][:120] for n in v["nodes"]][:3]) for v in found["violations"]
        ] == []


def test_nothing_is_cut_off_from_320_to_3840_pixels(page: Any) -> None:
    for width, height in ((320, 640), (768, 1024), (1440, 900), (2560, 1440), (3840, 2160)):
        page.set_viewport_size({"width": width, "height": height})
        settled(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width, width
        chart = page.locator(".chart").first.bounding_box()
        assert chart["width"] > 0.3 * min(width, 800)


def test_the_network_is_refused_by_the_page_itself(browser: Any, page_file: Path) -> None:
    opened = browser.new_context().new_page()
    opened.goto(page_file.as_uri())
    refused = opened.evaluate("fetch('https://example.org').then(() => '', error => String(error))")
    assert refused
    assert "default-src 'none'" in page_file.read_text("utf-8")
    opened.context.close()


def test_the_command_opens_a_device(browser: Any, page_file: Path) -> None:
    said = run("studio", EXAMPLE, "--no-browser")
    assert said.exit_code == 0, said.output
    opened = browser.new_context().new_page()
    opened.goto(Path(said.stdout.strip()).as_uri())
    opened.wait_for_selector("html[data-ready]")
    name, mass = opened.evaluate(
        f"[pindrive.release.state.designs[0].name, {VALUES}['drive.mass']]"
    )
    assert (name, mass) == ("tactile mouse", 0.01)
    assert (
        json.loads(opened.evaluate("document.getElementById('device').textContent"))["rows"] == {}
    )
    opened.context.close()


def test_examples_show_what_they_say(page: Any) -> None:
    names = page.locator("header .menu").first.locator("li button").all_text_contents()
    assert len(names) == 7
    summaries = {}
    for name in names:
        choose_example(page, name)
        settled(page)
        assert page.locator("#problem").is_hidden()
        assert len(page.locator(".introduction [role=status]").inner_text()) > 60
        summaries[name] = page.locator("#summary").inner_text()
        if name == "The paper's Figure 4":
            shown = page.evaluate("pindrive.release.view.lines.map(line => line.name)")
            assert shown == [f"damping ratio {ratio}" for ratio in (0.04, 0.16, 0.32)]
        if name == "Stick-slip on a belt":
            assert numbers_shown(page)["ending.period"] == pytest.approx(0.671239, rel=1e-5)
    assert len(set(summaries.values())) == 5  # a recording is over the first motion
    assert "stick-slip" in summaries["Stick-slip on a belt"]


def test_a_recording_among_the_examples_is_fitted(page: Any) -> None:
    """Values as printed by `pindrive fit` in docs/fitting.md."""
    choose_example(page, "A recording to be fitted")
    page.get_by_role("button", name="Fit", exact=True).click()
    settled(page)
    found = {
        key: value(page, key)
        for key in ("drive.stiffness", "drive.damping_ratio", "plate.kinetic", "finger.kinetic")
    }
    assert list(found.values()) == pytest.approx([118.07, 0.12487, 18.527e-3, 6.1624e-3], rel=1e-4)
    assert value(page, "motion.displacement") == pytest.approx(2.1021e-3, rel=1e-4)
    words = page.locator("#fit-words").inner_text()
    assert "converged: " in words and "release at 6.000 ms" in words
    assert "2.0 % of the recording is left (root mean square), and its noise is 1.9 %." in words
    assert "times the noise" not in words
    for box in page.locator(".fit [type=checkbox]").all():
        box.check()
    page.get_by_role("button", name="Fit", exact=True).click()
    settled(page)
    words = page.locator("#fit-words").inner_text()
    assert re.search(r"does not determine stiffness, plate kinetic, .*mass", words), words
    page.get_by_role("button", name="Undo", exact=True).click()
    settled(page)
    assert value(page, "drive.stiffness") == found["drive.stiffness"]


def test_a_fit_of_the_wrong_model_says_so(page: Any) -> None:
    choose_example(page, "A recording that needs skin")
    page.get_by_role("button", name="Fit", exact=True).click()
    settled(page)
    words = page.locator("#fit-words").inner_text()
    left = float(re.search(r"That is ([\d.]+) times the noise", words)[1])  # type: ignore[index]
    assert left > 2.0
    page.check("#finger-stiffness-given")
    page.check("#fit-finger-stiffness")
    page.get_by_role("button", name="Fit", exact=True).click()
    settled(page)
    assert "times the noise" not in page.locator("#fit-words").inner_text()
    assert value(page, "finger.stiffness") == pytest.approx(300.0, rel=0.1)
    assert value(page, "finger.kinetic") == pytest.approx(12e-3, rel=0.05)


def test_the_pin_is_dragged_in_the_drawing(page: Any) -> None:
    box = page.locator("canvas.animation").bounding_box()
    y = box["y"] + 0.6 * box["height"]
    before = value(page, "motion.displacement")
    page.mouse.move(box["x"] + 0.6 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.64 * box["width"], y, steps=4)
    settled(page)
    first = value(page, "motion.displacement")
    page.mouse.move(box["x"] + 0.44 * box["width"], y, steps=4)
    page.mouse.up()
    settled(page)
    assert first > 0 > value(page, "motion.displacement")
    page.keyboard.press("Control+z")
    settled(page)
    assert value(page, "motion.displacement") == before


LONG = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping_ratio = 2e-4

[plate]
kinetic = "0 N"

[finger]
kinetic = "0 N"

[motion]
mouse_velocity = "0 mm/s"
displacement = "1 mm"
duration = "100 s"
"""


def test_curves_follow_a_decay_of_1600_turns(page: Any, tmp_path: Path) -> None:
    path = tmp_path / "long.toml"
    path.write_text(LONG, "utf-8")
    opened(page, path)
    times, position = page.evaluate(
        "(({times, columns}) => [Array.from(times), Array.from(columns.position)])"
        "(pindrive.release.view.lines[0].result.curves)"
    )
    x, t = np.asarray(position), np.asarray(times)
    for begin in np.arange(0.0, 99.0, 0.5):
        part = x[(t >= begin) & (t < begin + 0.5)]
        envelope = 1e-3 * np.exp(-0.02 * begin)
        assert part.max() > 0.98 * envelope and part.min() < -0.98 * envelope
    assert len(x) < 8000


def test_all_events_are_counted_and_written(page: Any, tmp_path: Path) -> None:
    path = tmp_path / "belt.toml"
    path.write_text(
        LONG.replace('kinetic = "0 N"', 'kinetic = "0.1 N"\nstatic = "0.2 N"', 1)
        .replace('"0 mm/s"', '"100 mm/s"')
        .replace("damping_ratio = 2e-4", "damping_ratio = 0.0"),
        "utf-8",
    )
    opened(page, path)
    expected = len(motion_of(pd.load_device(path)).core.events(0.0, 100.0, 100_000)[0])
    events = page.evaluate("pindrive.release.view.lines[0].result.curves.events.length")
    assert events == expected > 2000
    count = f"{expected:,}".replace(",", " ")
    assert f"of {count} events" in page.locator("section.events").inner_text()
    written = CsvTable.read(saved(page, "events", tmp_path), "events", "")
    assert len(written.column("time", SERIES["time"])) == expected

"""The view "Read" in headless Chromium: a hand, its pins, and the readings that Python repeats."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import pindrive as pd
from command import EXAMPLES
from pindrive.files.reading import load_reading
from studio_page import settled, until

AXE = Path(__file__).parents[2] / "studio" / "node_modules" / "axe-core" / "axe.min.js"
READER = EXAMPLES / "tactile-reader.toml"
HAND = "pindrive.read.session.hand"


@pytest.fixture
def read(page: Any) -> Any:
    """The view, with its demonstration."""
    page.get_by_role("link", name="Read").click()
    until(page, "pindrive.read && pindrive.read.session.took.length > 5")
    return page


def stroke(page: Any, seconds: float = 1.5, slope: float = 0.0, end: float = 0.97) -> None:
    """Moves the pointer over the page from left to right, up to a part of its width."""
    box = page.locator("canvas.sheet").bounding_box()
    steps = int(60 * seconds)
    for i in range(steps + 1):
        part = i / steps
        x = box["x"] + box["width"] * (0.03 + (end - 0.03) * part)
        page.mouse.move(x, box["y"] + box["height"] * (0.5 + slope * part))
        page.wait_for_timeout(1000 * seconds / steps)


def press(page: Any) -> None:
    """Presses at the left of the page: a hand begins there."""
    box = page.locator("canvas.sheet").bounding_box()
    page.mouse.move(box["x"] + 0.03 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.up()


def counts(page: Any) -> list[str]:
    page.wait_for_timeout(900)  # evaluated and shown
    shown: list[str] = page.locator(".counts dd").all_inner_texts()
    return shown


def leave(page: Any) -> None:
    """Moves the pointer off the page, and waits until the reading is kept."""
    page.mouse.move(5, 5)
    until(page, "pindrive.read.phase === 'kept' && pindrive.read.session.judge.idle")


def saved(page: Any, kind: str, folder: Path) -> Path:
    with page.expect_download() as download:
        page.locator("header .menu summary").last.click()
        page.locator(f"header .menu [data-name={kind}]").click()
    path = folder / str(download.value.suggested_filename)
    download.value.save_as(path)
    return path


def test_a_demonstration_runs_until_someone_takes_the_hand(read: Any) -> None:
    until(read, "pindrive.read.evaluated.length > 20", timeout=20_000)
    first = read.evaluate(f"{HAND}.count")
    read.wait_for_timeout(300)
    assert read.evaluate(f"{HAND}.count") > first
    stroke(read, 0.3)
    assert read.evaluate(f"{HAND}.start.x") == pytest.approx(0.03 * 0.044, abs=2e-4)
    assert "Demonstration" not in read.locator("main.reading").inner_text()


def test_a_saved_reading_is_repeated_by_python(read: Any, tmp_path: Path) -> None:
    stroke(read, slope=0.08, end=0.52)  # rests over the print, where magnets hold pins
    read.wait_for_timeout(4500)  # until the hand needs no more rows
    leave(read)
    shown = counts(read)
    path = saved(read, "file", tmp_path)
    assert path.name == "the-text-hello.json"
    reading = load_reading(path)
    assert reading.page.title == "the text “Hello”"
    evaluation = pd.scan(reading.device, reading.page, reading.hand).evaluate()
    found = evaluation.counts
    missed = found["lines.unseen"] + found["lines.faint"]
    expected = [found["lines.crossed"], found["lines.shown"], found["lines.merged"], missed]
    assert expected[0] > 20 and expected[1] > 10
    assert [int(cell) for cell in shown[:5]] == [*expected, found["lines.false"]]
    time, shown_pins = read.evaluate(
        "(({time, values}) => [time, Array.from(values.position)])"
        "(pindrive.read.session.samples.at(-1))"
    )
    scanned = pd.scan(reading.device, reading.page, reading.hand)
    expected_pins = [float(pin.position(time)) for pin in scanned.pins]
    np.testing.assert_allclose(shown_pins, expected_pins, rtol=0.0, atol=1e-15)
    assert max(map(abs, shown_pins)) > 1e-4
    written = saved(read, "device", tmp_path)
    assert pd.load_device(written, whole=True).values() == reading.device.values()


def test_a_link_holds_a_reading_and_repeats_it(read: Any, page_file: Path, tmp_path: Path) -> None:
    stroke(read, 0.8)
    leave(read)
    read.get_by_role("button", name="Share").click()
    until(read, "location.hash.length > 5000")
    link = read.evaluate("location.href")
    assert "#read=" in link
    kept = load_reading(link)
    assert len(kept.hand.times) > 50
    other = read.context.new_page()
    other.goto(link)
    until(other, "window.pindrive?.read?.session.repeating && pindrive.read.session.time > 0")
    until(other, f"pindrive.read.session.time === {HAND}.end")
    rows = other.evaluate(f"{HAND}.saved.rows")
    times, vx, _ = np.array([[0, 0, 0], *rows]).T
    np.testing.assert_array_equal(times / 5000, kept.hand.times)
    np.testing.assert_array_equal(vx / 1e6, kept.hand.vx)
    other.get_by_role("button", name="Play").click()
    until(other, "pindrive.read.session.time > 0.01 && pindrive.read.session.time < 0.1")
    scrub = other.get_by_label("time of the reading")
    scrub.focus()
    scrub.evaluate("e => { e.value = 300; e.dispatchEvent(new Event('input')) }")
    end = other.evaluate(f"{HAND}.end")
    until(other, f"Math.abs(pindrive.read.session.time - 0.3 * {end}) < 1e-9")
    other.close()


def test_arrow_keys_move_the_hand_at_a_set_speed(read: Any) -> None:
    sheet = read.locator("canvas.sheet")
    sheet.focus()
    read.keyboard.down("ArrowRight")
    read.wait_for_timeout(1500)
    speed = read.evaluate(f"{HAND}.at({HAND}.end).vx")
    height = read.evaluate(f"{HAND}.at({HAND}.end).vy")
    read.keyboard.up("ArrowRight")
    assert (speed, height) == (pytest.approx(0.060, rel=1e-2), 0.0)
    read.wait_for_timeout(700)
    assert read.evaluate(f"Math.abs({HAND}.at({HAND}.end).vx)") < 2e-4


def test_two_lines_merge_under_a_fast_hand(read: Any) -> None:
    read.get_by_role("button", name="2", exact=True).click()
    task = read.locator(".tasks-card")
    stroke(read, 4.0)
    read.wait_for_timeout(900)
    assert "Still two at" in task.inner_text()
    for _ in range(3):
        leave(read)
        press(read)
        stroke(read, 0.35)
        read.wait_for_timeout(900)
        if "became one" in task.inner_text():
            break
    assert "became one. The device's own limit: 250 mm/s" in task.inner_text()


def test_the_task_of_figure_4_tells_the_swing(read: Any) -> None:
    read.get_by_role("button", name="4", exact=True).click()
    task = read.locator(".tasks-card")
    for _ in range(4):
        press(read)
        stroke(read, 2.0)
        read.wait_for_timeout(900)
        if "past its rest" in task.inner_text():
            break
        leave(read)
    told = task.inner_text()
    assert re.search(r"Let go at 0\.\d\d mm|Let go at 1\.\d\d mm", told), told
    assert "% past its rest at damping ratio 0." in told


def dropped(read: Any, path: Path) -> str:
    """Open a file in the view; returns its error."""
    with read.expect_file_chooser() as chooser:
        read.get_by_role("button", name="Open …", exact=True).click()
    problem = "document.querySelector('#problem').textContent"
    read.evaluate("document.querySelector('#problem').textContent = ''")
    chooser.value.set_files(path)
    until(read, problem, 20_000)
    return str(read.evaluate(problem))


def test_hostile_files_and_links_are_rejected_in_a_line(read: Any, tmp_path: Path) -> None:
    vector = tmp_path / "page.svg"
    vector.write_text(
        "<svg xmlns='http://www.w3.org/2000/svg' width='10' height='10' onload='hacked = 1'>"
        "<script>hacked = 1</script><rect width='10' height='10'/></svg>",
        "utf-8",
    )
    huge = tmp_path / "huge.png"
    Image.new("1", (10_000, 10_000)).save(huge)
    broken = tmp_path / "broken.json"
    whole = (EXAMPLES / "reading.json").read_text("utf-8")
    named = tmp_path / "named.toml"
    named.write_text(
        READER.read_text("utf-8").replace('name = "', 'name = "<img src=x onerror=hacked=1>', 1)
        + "\nx = 1\n",
        "utf-8",
    )
    assert dropped(read, vector) == "page.svg: is no picture that this browser shows"
    assert dropped(read, huge).startswith("huge.png: must have at most 40 megapixels, got 10000")
    for text in (whole[: len(whole) // 2], "{}", "[]", whole.replace('"rows"', '"row"'), "null"):
        broken.write_text(text, "utf-8")
        said = dropped(read, broken)
        assert said.startswith("broken.json: is no") and "\n" not in said, text[:40]
    assert "named.toml" in dropped(read, named)
    read.get_by_label("text", exact=False).first.fill("\u202eabc\u2066\u200f<b>")
    link = read.evaluate("(async () => { await pindrive.studio.link(); return location.hash; })()")
    for cut in (link[: len(link) // 2], link[:10], link + "AAAA", "#read=%00"):
        read.evaluate("hash => { location.hash = hash; }", cut)
        read.wait_for_timeout(300)
        said = read.locator("#problem").inner_text()
        assert "\n" not in said and said.startswith("Of the link not everything"), said
    assert read.evaluate("typeof hacked") == "undefined"
    assert read.locator("img").count() == 0


def test_sliders_change_the_device_and_its_limits(read: Any, tmp_path: Path) -> None:
    until(read, "pindrive.read.display.limits.length === 4")
    before = read.evaluate("pindrive.read.display.limits[1].speed")
    slider = read.get_by_label("Magnet lets go in")
    slider.evaluate("e => { e.value = 0.8; e.dispatchEvent(new Event('input')) }")
    until(read, f"pindrive.read.display.limits[1].speed < 0.8 * {before}")
    path = saved(read, "device", tmp_path)
    fall = pd.load_device(path, whole=True).values()["magnet.fall_time"]
    assert fall == pytest.approx(5e-3 * 8**0.8, rel=1e-2)
    told = read.locator(".speed-card").inner_text()
    slower, first = map(int, re.findall(r"up to (\d+) mm/s", told))
    assert "Two lines 1 mm apart are felt as two" in told and "with the device before" in told
    assert slower < first


def test_devices_pictures_and_readings_are_opened(read: Any, tmp_path: Path) -> None:
    device = tmp_path / "two.toml"
    text = READER.read_text("utf-8").replace("columns = 4", "columns = 2")
    device.write_text(text.replace("rows = 4", "rows = 1"), "utf-8")
    picture = tmp_path / "picture.png"
    Image.new("L", (88, 25), 0).save(picture)
    bad = tmp_path / "bad.json"
    bad.write_text("{}", "utf-8")

    def opened(file: Path) -> None:
        with read.expect_file_chooser() as chooser:
            read.get_by_role("button", name="Open …", exact=True).click()
        chooser.value.set_files(file)
        read.wait_for_timeout(400)

    opened(device)
    assert read.evaluate("pindrive.read.session.pins") == 2
    opened(picture)
    grey = read.evaluate("Array.from(pindrive.read.paper.raster.grey.subarray(100_000, 100_010))")
    assert grey == [0] * 10
    opened(bad)
    assert "bad.json: is no reading" in read.locator("#problem").inner_text()
    device.write_text(text.replace('hold_force = "1 N"', 'hold_force = "-1 N"'), "utf-8")
    opened(device)
    assert "magnet.hold_force" in read.locator("#problem").inner_text()


def test_a_whole_device_of_the_other_view_is_read_with(page: Any, tmp_path: Path) -> None:
    device = tmp_path / "three.toml"
    device.write_text(READER.read_text("utf-8").replace("columns = 4", "columns = 3"), "utf-8")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Open …", exact=True).click()
    chooser.value.set_files(device)
    page.wait_for_timeout(300)
    page.get_by_role("link", name="Read").click()
    until(page, "pindrive.read && pindrive.read.session.pins === 12")
    page.get_by_role("link", name="One release").click()
    settled(page)
    assert page.locator(".read").is_hidden() and page.locator("#summary").is_visible()


def test_drawing_makes_a_page(read: Any) -> None:
    read.get_by_role("button", name="Draw", exact=True).click()
    box = read.locator("canvas.sheet").bounding_box()
    x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.2 * box["height"]
    read.mouse.move(x, y)
    read.mouse.down()
    read.mouse.move(x, y + 0.6 * box["height"], steps=8)
    read.mouse.up()
    read.wait_for_timeout(200)
    dark = read.evaluate("pindrive.read.paper.raster.grey.filter(g => g < 128).length")
    assert 0.5 < dark / (1.2 * 22 * 0.6 * 12.5 * 22) < 2.0
    read.get_by_role("button", name="Draw", exact=True).click()
    stroke(read, 1.5)
    assert int(counts(read)[0]) >= 4


def test_reduced_motion_has_no_demonstration(page: Any) -> None:
    page.emulate_media(reduced_motion="reduce")
    page.get_by_role("link", name="Read").click()
    until(page, "pindrive.read && pindrive.read.session.took.length > 5")
    assert page.evaluate(f"{HAND}.at({HAND}.end).vx") == 0
    assert "Move across the print" in page.locator(".read .now").inner_text()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_no_violation_and_nothing_is_cut_off(read: Any, scheme: str) -> None:
    read.emulate_media(color_scheme=scheme)
    read.evaluate(AXE.read_text("utf-8"))
    for width, height in ((320, 640), (390, 844), (1440, 900), (2560, 1440), (3840, 2160)):
        read.set_viewport_size({"width": width, "height": height})
        read.wait_for_timeout(300)
        assert read.evaluate("document.documentElement.scrollWidth") <= width, width
        found = read.evaluate("axe.run({resultTypes: ['violations']})")
        assert [
            (v["id"], [n["html"][:120] for n in v["nodes"]][:3]) for v in found["violations"]
        ] == []
        if width < 600:
            small = read.evaluate(
                "[...document.querySelectorAll("
                "'button, select, nav a, summary, input:not([type=checkbox])')]"
                ".filter(e => e.offsetParent && e.getBoundingClientRect().height < 43.5)"
                ".map(e => e.outerHTML.slice(0, 80))"
            )
            assert small == []


def test_a_pin_opens_its_motion_in_the_other_view(read: Any, tmp_path: Path) -> None:
    read.get_by_role("button", name="Along a ruler").click()
    stroke(read, 2.0)
    leave(read)
    reading = load_reading(saved(read, "file", tmp_path))
    read.get_by_label("pin from the side", exact=True).select_option("6")
    read.get_by_role("button", name="Open its motion", exact=True).click()
    until(read, "window.pindrive.release?.view.lines.length === 1")
    settled(read)
    assert read.evaluate("pindrive.release.state.designs.length") == 2
    times, shown = read.evaluate(
        "(({times, columns}) => [Array.from(times), Array.from(columns.position)])"
        "(pindrive.release.view.lines.find(line => line.kind === 'current').result.curves)"
    )
    pin = pd.scan(reading.device, reading.page, reading.hand).pins[6]
    t = np.asarray(times)
    within = t <= pin.end - pin.begin
    np.testing.assert_allclose(
        np.asarray(shown)[within], pin.motion.position(t[within]), rtol=0.0, atol=1e-12
    )
    assert np.ptp(np.asarray(shown)[within]) > 2e-4
    assert read.evaluate("pindrive.release.state.designs[1].name") == "pin 7 of a reading"


def test_a_hand_at_rest_needs_no_rows(read: Any) -> None:
    stroke(read, 0.3)
    read.wait_for_timeout(4500)
    rests = read.evaluate(f"{HAND}.count")
    read.wait_for_timeout(500)
    assert read.evaluate(f"{HAND}.count") == rests
    assert read.evaluate(f"{HAND}.end - pindrive.read.session.time") < 1e-3
    box = read.locator("canvas.sheet").bounding_box()
    read.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    read.wait_for_timeout(300)
    assert read.evaluate(f"{HAND}.count") > rests


def test_a_hand_that_gives_way_lags_its_ruler_while_magnets_hold_it(read: Any) -> None:
    """The mark of the ruler is ahead of the mouse, words say by how much; the reading is kept."""
    read.get_by_role("button", name="Hand gives way").click()
    press(read)
    box = read.locator("canvas.sheet").bounding_box()
    lags, held, said = [], [], set()
    for i in range(120):
        read.mouse.move(
            box["x"] + box["width"] * (0.03 + 0.0075 * i), box["y"] + 0.5 * box["height"]
        )
        read.wait_for_timeout(16)
        found = read.evaluate(
            """() => {
              const { intended, hand, sample } = pindrive.read.display.picture;
              return [intended.x - hand.x, sample.values.pull.reduce((n, p) => n + (p > 0.5), 0)];
            }"""
        )
        lags.append(found[0])
        held.append(found[1])
        said.add(read.locator(".lag").inner_text())
    assert max(held) >= 4
    assert 2e-4 < max(lags) < 0.03
    assert any(re.search(r"[1-9] magnets hold, the pins pull with \d\.\d\d N", one) for one in said)
    leave(read)
    assert read.evaluate("pindrive.read.session.intended") is None
    assert read.locator(".lag").is_hidden() or read.evaluate("pindrive.read.phase") == "kept"

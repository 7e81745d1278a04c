"""Readings in headless Chromium: their begin and end, replay, states that are kept, links."""

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
from studio_page import VALUES, choose_example, settled, until, value

HAND = "pindrive.read.session.hand"
COUNTS = "[...document.querySelectorAll('.counts dd')].map(e => Number(e.textContent))"
SAVED = EXAMPLES / "reading.json"


@pytest.fixture
def read(page: Any) -> Any:
    """The view "Read" with a hand that waits."""
    page.emulate_media(reduced_motion="reduce")
    page.get_by_role("link", name="Read").click()
    until(page, "pindrive.read?.phase === 'waiting' && pindrive.read.display.limits.length")
    return page


def sheet(page: Any) -> tuple[float, float, float, float]:
    box = page.locator("canvas.sheet").bounding_box()
    return box["x"], box["y"], box["width"], box["height"]


def cross(page: Any, seconds: float = 1.0) -> None:
    """Moves the pointer over the whole page."""
    x, y, width, height = sheet(page)
    for part in np.linspace(0.03, 0.97, int(60 * seconds)):
        page.mouse.move(x + part * width, y + 0.5 * height)
        page.wait_for_timeout(1000 / 60)


def kept(page: Any) -> None:
    """Waits until the reading is finished and judged."""
    until(page, "pindrive.read.phase === 'kept' && pindrive.read.session.judge.idle")
    page.wait_for_timeout(100)


def opened(page: Any, *files: Path) -> None:
    for file in files:
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="Open …", exact=True).click()
        chooser.value.set_files(file)
        page.wait_for_timeout(400)


# ---- begin and end -------------------------------------------------------------------------------


def test_the_way_to_a_button_leaves_a_reading_as_it_is(read: Any) -> None:
    cross(read, 3.0)
    x, y, width, height = sheet(read)
    read.mouse.move(x + 0.97 * width, y + height + 40)
    kept(read)
    shown, rows = read.evaluate(COUNTS), read.evaluate(f"{HAND}.count")
    assert shown[0] > 60 and shown[1] > 50
    for part in np.linspace(0.97, 0.03, 40):  # back over the page, to the toolbar above it
        read.mouse.move(x + part * width, y + height * (part - 0.03))
        read.wait_for_timeout(16)
    read.mouse.move(x + 0.1 * width, y - 20)
    read.wait_for_timeout(700)
    assert read.evaluate(COUNTS) == shown
    assert read.evaluate(f"{HAND}.count") == rows
    read.mouse.move(x + 0.3 * width, y + 0.5 * height)
    read.mouse.down()  # on purpose
    read.mouse.up()
    until(read, "pindrive.read.phase === 'reading'")
    assert read.evaluate(f"{HAND}.start.x") == pytest.approx(0.3 * 0.044, abs=2e-4)
    read.mouse.move(5, 5)
    until(read, "pindrive.read.phase === 'kept'")
    assert read.evaluate(f"{HAND}.count") == rows  # the hand went nowhere: the reading is back
    until(read, f"String({COUNTS}) === '{','.join(map(str, shown))}'")


def test_a_pressed_button_holds_the_hand_beyond_the_edge(read: Any) -> None:
    x, y, width, height = sheet(read)
    read.mouse.move(x + 0.1 * width, y + 0.5 * height)
    read.mouse.down()
    read.mouse.move(x + 0.4 * width, y - 60, steps=10)
    read.wait_for_timeout(200)
    assert read.evaluate("pindrive.read.phase") == "reading"
    read.mouse.move(x + 0.7 * width, y - 60, steps=10)
    read.mouse.up()
    kept(read)
    assert read.evaluate(f"{HAND}.last.x") == pytest.approx(0.7 * 0.044, abs=2e-4)


def test_undo_brings_the_reading_before_back(read: Any) -> None:
    cross(read, 0.6)
    read.mouse.move(5, 5)
    kept(read)
    first = read.evaluate(COUNTS)
    x, y, width, height = sheet(read)
    read.mouse.move(x + 0.5 * width, y + 0.5 * height)
    read.mouse.down()
    read.mouse.move(x + 0.7 * width, y + 0.5 * height, steps=20)
    read.mouse.up()
    read.mouse.move(5, 5)
    kept(read)
    assert read.evaluate(COUNTS) != first
    read.get_by_role("button", name="Undo", exact=True).click()
    kept(read)
    until(read, f"pindrive.read.session.time === {HAND}.end")
    assert read.evaluate(COUNTS) == first
    read.get_by_role("button", name="Undo", exact=True).click()
    until(read, "pindrive.read.phase === 'waiting'")
    for _ in range(2):
        read.keyboard.press("Control+Shift+z")
    kept(read)
    assert read.evaluate("pindrive.studio.states.read.canRedo") is False


def test_a_full_reading_is_kept(read: Any) -> None:
    x, y, width, height = sheet(read)
    read.mouse.move(x + 0.1 * width, y + 0.5 * height)
    read.mouse.move(x + 0.5 * width, y + 0.5 * height, steps=10)
    until(read, f"pindrive.read.phase === 'reading' && {HAND}.last.x > 0.02")
    read.evaluate(f"void Object.defineProperty({HAND}, 'count', {{get: () => 30_000}})")
    read.mouse.move(x + 0.6 * width, y + 0.5 * height, steps=10)
    until(read, "pindrive.read.phase !== 'reading'")
    assert "The reading is full" in read.locator("#problem").inner_text()


def test_blank_paper_stays_blank_when_the_hand_turns(read: Any) -> None:
    """A pin that friction holds off its rest moves no skin."""
    read.get_by_role("button", name="3", exact=True).click()  # one line in the middle
    cross(read, 3.0)
    x, y, width, height = sheet(read)
    for part in np.linspace(0.97, 0.86, 30):
        read.mouse.move(x + part * width, y + 0.5 * height)
        read.wait_for_timeout(20)
    read.mouse.move(5, 5)
    kept(read)
    assert max(map(abs, read.evaluate(
        "Array.from(pindrive.read.session.samples.at(-1).values.position)"))) > 2e-5  # fmt: skip
    painted = read.evaluate(
        "(() => { const { canvas } = pindrive.read.display.felt;"
        " const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);"
        " const found = [0, 0]; for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 25) {"
        "  const x = (i / 4) % canvas.width / canvas.width; if (data[i + 1] < 96 && data[i] > 120)"
        "  found[0] += x > 0.8; else found[1] += 1; } return found; })()"
    )
    assert painted[0] == 0  # purple right of the line and of its release
    assert painted[1] > 1000


def test_an_idle_view_asks_for_no_picture(read: Any) -> None:
    for _ in range(2):
        until(read, "pindrive.read.frame === 0")  # the pins have come to rest
        cross(read, 0.4)
        read.mouse.move(5, 5)
        kept(read)
    read.wait_for_timeout(300)
    assert read.evaluate("pindrive.read.frame") == 0


# ---- replay --------------------------------------------------------------------------------------


def test_a_saved_reading_shows_its_result_at_each_time(read: Any, tmp_path: Path) -> None:
    opened(read, SAVED)
    kept(read)
    until(read, f"pindrive.read.session.time === {HAND}.end")
    reading = load_reading(SAVED)
    evaluation = pd.scan(reading.device, reading.page, reading.hand).evaluate()
    assert read.evaluate(COUNTS)[:2] == [80, 80] == [len(evaluation.lines), len(evaluation.shown)]
    end = read.evaluate(f"{HAND}.end")
    slider = read.get_by_label("time of the reading")
    for part in (0.5, 0.25, 0.8):
        slider.evaluate(f"e => {{ e.value = {1000 * part}; e.dispatchEvent(new Event('input')) }}")
        until(read, f"Math.abs(pindrive.read.session.time - {part * end}) < 1e-9")
        crossed = sum(line.begin.time <= part * end for line in evaluation.lines)
        assert read.evaluate(COUNTS)[0] == crossed
    speed = read.get_by_label("speed of the replay")
    speed.select_option("16")  # so slow that "Pause" is pressed before the end
    read.get_by_role("button", name="Play").click()
    until(read, f"pindrive.read.session.time > {0.801 * end}")
    read.get_by_role("button", name="Pause").click()
    read.wait_for_timeout(150)
    paused = read.evaluate("pindrive.read.session.time")
    read.wait_for_timeout(300)
    assert read.evaluate("pindrive.read.session.time") == paused < end
    speed.select_option("1")
    read.keyboard.press("Escape")
    read.locator("body").press("Space")
    until(read, f"pindrive.read.session.time === {HAND}.end")
    assert read.evaluate(COUNTS)[0] == 80


def test_missed_and_merged_lines_are_marked_and_listed(read: Any) -> None:
    cross(read, 0.5)
    read.mouse.move(5, 5)
    kept(read)
    _, _, merged, missed, false, _ = read.evaluate(COUNTS)
    assert merged + missed + false > 0
    marked = read.evaluate(
        "pindrive.read.evaluated.filter(line => line.outcome !== 'shown')"
        ".map(({pin, time, x, y, outcome}) => ({pin, time, x, y, outcome}))"
    )
    assert len(marked) == merged + missed + false
    summary = read.locator(".outcomes summary")
    assert summary.inner_text().startswith(f"Which {len(marked)} were not felt as printed")
    summary.click()
    entries = read.locator(".outcomes li button")
    until(read, f"document.querySelectorAll('.outcomes li').length === {min(len(marked), 41)}")
    first = min(marked, key=lambda line: line["time"])
    words = entries.first.inner_text()
    assert f"pin {first['pin'] + 1} at {1e3 * first['x']:.1f}, {1e3 * first['y']:.1f} mm" in words
    entries.first.click()
    until(read, f"Math.abs(pindrive.read.session.time - {first['time']}) < 1e-9")
    assert read.get_by_label("pin from the side", exact=True).input_value() == str(first["pin"])
    read.evaluate(f"pindrive.read.playback.goTo({HAND}.end)")
    until(read, f"pindrive.read.session.time === {HAND}.end")
    purple = read.evaluate(
        "(() => { const c = document.querySelector('canvas.sheet');"
        " const { data } = c.getContext('2d').getImageData(0, 0, c.width, c.height); let n = 0;"
        " for (let i = 0; i < data.length; i += 4)"
        "  n += data[i] === 164 && data[i + 1] === 18 && data[i + 2] === 138; return n; })()"
    )
    assert purple > 0


# ---- what is kept --------------------------------------------------------------------------------


def test_nothing_is_lost_between_views_and_by_loading_again(read: Any) -> None:
    cross(read, 0.8)
    read.mouse.move(5, 5)
    kept(read)
    shown = read.evaluate(COUNTS)
    read.get_by_role("link", name="One release").click()
    settled(read)
    read.fill("#drive-mass", "12 g")
    read.keyboard.press("Enter")
    read.get_by_role("link", name="Read").click()
    kept(read)
    read.get_by_role("link", name="One release").click()
    settled(read)
    assert value(read, "drive.mass") == 0.012
    read.fill("#drive-stiffness", "90 N/m")
    read.keyboard.press("Enter")
    read.reload()  # at once
    read.wait_for_selector("html[data-ready]")
    assert (value(read, "drive.mass"), value(read, "drive.stiffness")) == (0.012, 90.0)
    read.get_by_role("link", name="Read").click()
    until(read, f"pindrive.read.session.time === {HAND}.end")
    until(read, f"JSON.stringify({COUNTS}) === '{str(shown).replace(' ', '')}'")
    read.reload()
    until(read, "window.pindrive?.read?.phase === 'kept'")
    until(read, f"JSON.stringify({COUNTS}) === '{str(shown).replace(' ', '')}'")
    read.get_by_role("button", name="Reset", exact=True).click()
    until(read, "pindrive.read.phase === 'waiting'")
    read.get_by_role("button", name="Undo", exact=True).click()
    kept(read)
    read.get_by_role("link", name="One release").click()
    settled(read)
    read.get_by_role("button", name="Reset", exact=True).click()
    settled(read)
    assert value(read, "drive.mass") == 0.01
    read.keyboard.press("Control+z")
    settled(read)
    assert (value(read, "drive.mass"), value(read, "drive.stiffness")) == (0.012, 90.0)


def test_a_whole_device_keeps_its_reading(read: Any, tmp_path: Path) -> None:
    device = tmp_path / "two.toml"
    text = (EXAMPLES / "tactile-reader.toml").read_text("utf-8")
    device.write_text(text.replace("columns = 4", "columns = 2"), "utf-8")
    read.get_by_role("link", name="One release").click()
    settled(read)
    opened(read, device)
    read.get_by_role("link", name="Read").click()
    until(read, "pindrive.read.session.pins === 8 && pindrive.read.phase === 'waiting'")
    cross(read, 0.6)
    read.mouse.move(5, 5)
    kept(read)
    shown = read.evaluate(COUNTS)
    read.reload()
    until(read, "window.pindrive?.read?.phase === 'kept'")
    until(read, f"String({COUNTS}) === '{','.join(map(str, shown))}'")
    assert read.evaluate("pindrive.read.session.pins") == 8


def test_going_back_changes_the_view_alone(read: Any) -> None:
    cross(read, 0.6)
    read.mouse.move(5, 5)
    kept(read)
    shown = read.evaluate(COUNTS)
    read.get_by_role("link", name="One release").click()
    settled(read)
    read.wait_for_timeout(900)  # the address is written
    read.get_by_role("link", name="Read").click()
    read.get_by_role("button", name="Reset", exact=True).click()
    read.get_by_role("button", name="Undo", exact=True).click()
    kept(read)
    read.wait_for_timeout(900)
    read.go_back()
    until(read, "pindrive.studio.view === 'release'")
    read.go_forward()
    until(read, "pindrive.studio.view === 'read'")
    until(read, f"String({COUNTS}) === '{','.join(map(str, shown))}'")


def test_the_last_visit_is_given_back(browser: Any, page_file: Path) -> None:
    context = browser.new_context(reduced_motion="reduce")
    first = context.new_page()
    first.goto(page_file.as_uri())
    first.wait_for_selector("html[data-ready]")
    first.get_by_label("text on the page").fill("visit")
    first.wait_for_timeout(400)
    second = context.new_page()
    second.goto(page_file.as_uri())
    second.wait_for_selector("html[data-ready]")
    assert second.get_by_label("text on the page").input_value() == "visit"
    context.close()


def test_a_drawing_stays_when_the_pen_is_put_away(read: Any) -> None:
    pen = read.get_by_role("button", name="Draw", exact=True)
    pen.click()
    x, y, width, height = sheet(read)
    dark = "pindrive.read.paper.raster.grey.filter(g => g < 128).length"
    for part in (0.3, 0.6):
        read.mouse.move(x + part * width, y + 0.2 * height)
        read.mouse.down()
        read.mouse.move(x + part * width, y + 0.8 * height, steps=8)
        read.mouse.up()
    until(read, f"{dark} > 5000")
    both = read.evaluate(dark)
    pen.click()
    pen.click()
    assert read.evaluate(dark) == both
    read.get_by_role("button", name="Undo", exact=True).click()
    until(read, f"{dark} < {0.6 * both}")
    read.get_by_role("button", name="Undo", exact=True).click()
    read.get_by_role("button", name="Undo", exact=True).click()
    until(read, "pindrive.read.state.print.text === 'Hello'")
    assert read.get_by_label("text on the page").input_value() == "Hello"


def test_a_picture_has_no_text(read: Any, tmp_path: Path) -> None:
    picture = tmp_path / "picture.png"
    Image.new("L", (88, 25), 0).save(picture)
    opened(read, picture)
    until(read, "pindrive.read.paper.title === 'picture.png'")
    assert read.get_by_label("text on the page").input_value() == ""


# ---- links and files -----------------------------------------------------------------------------


def link_with(page: Any, change: str) -> str:
    """A link to the state, changed as an object before it is packed."""
    made: str = page.evaluate(
        "async change => { const part = (await pindrive.studio.link()).split(/#\\w+=/)[1];"
        " const unpacked = new Blob([Uint8Array.from(atob(part.replaceAll('-', '+')"
        ".replaceAll('_', '/')), c => c.charCodeAt(0))]).stream()"
        ".pipeThrough(new DecompressionStream('deflate-raw'));"
        " const state = JSON.parse(await new Response(unpacked).text());"
        " new Function('state', change)(state);"
        " const packed = new Blob([JSON.stringify(state)]).stream()"
        ".pipeThrough(new CompressionStream('deflate-raw'));"
        " const bytes = new Uint8Array(await new Response(packed).arrayBuffer());"
        " return btoa(Array.from(bytes, b => String.fromCharCode(b)).join(''))"
        ".replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, ''); }",
        change,
    )
    return made


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ("state.release.number = 'transient.nonsense'", "the number cannot be read"),
        ("state.release.map.x = 'nonsense'", "the map cannot be read"),
        ("state.release.designs[0].device = '[drive]'", "design 1: "),
        ("state.print = {kind: 'lines', lines: 7}", "the page cannot be read"),
        ("state.device = 'x = 1'", "the device: "),
    ],
)
def test_a_spoiled_link_keeps_what_it_can(
    browser: Any, page_file: Path, change: str, named: str
) -> None:
    context = browser.new_context(reduced_motion="reduce", bypass_csp=True)
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(f"{page_file.as_uri()}#release")
    page.wait_for_selector("html[data-ready]")
    page.fill("#drive-mass", "12 g")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Copy").click()
    settled(page)
    packed = link_with(page, change)
    other = context.new_page()
    other.on("pageerror", lambda error: wrong.append(str(error)))
    other.goto(f"{page_file.as_uri()}#release={packed}")
    other.wait_for_selector("html[data-ready]")
    said = other.locator("#problem").inner_text()
    assert said.startswith("Of the link not everything could be read: ") and named in said
    settled(other)
    designs = other.evaluate("pindrive.release.state.designs.length")
    assert designs == (1 if "designs[0]" in change else 2)
    assert other.evaluate(f"{VALUES}['drive.mass']") == 0.012
    context.close()
    assert wrong == []


def test_a_link_that_is_cut_off_says_so(browser: Any, page_file: Path) -> None:
    context = browser.new_context(reduced_motion="reduce")
    page = context.new_page()
    page.goto(page_file.as_uri())
    page.wait_for_selector("html[data-ready]")
    link = page.evaluate("pindrive.studio.link()")
    other = browser.new_context(reduced_motion="reduce").new_page()
    other.goto(link[: len(link) * 2 // 3])
    other.wait_for_selector("html[data-ready]")
    assert "it is cut off or spoiled" in other.locator("#problem").inner_text()
    assert other.locator("canvas.sheet").is_visible()
    context.close()
    other.context.close()


def test_each_file_is_known_in_either_view(page: Any, tmp_path: Path) -> None:
    def dropped(file: Path) -> None:
        page.evaluate(
            "([name, text]) => { const data = new DataTransfer(); data.items.add(new File([text],"
            " name)); document.body.dispatchEvent("
            "new DragEvent('drop', {dataTransfer: data, bubbles: true})); }",
            [file.name, file.read_text("utf-8")],
        )

    dropped(SAVED)  # on "One release"
    until(page, "pindrive.studio.view === 'read' && pindrive.read.phase === 'kept'")
    dropped(EXAMPLES / "release-recording.csv")  # on "Read"
    until(page, "pindrive.studio.view === 'release'")
    settled(page)
    assert "600 samples of position" in page.locator("#recording-words").inner_text()
    page.get_by_role("link", name="Read").click()
    dropped(EXAMPLES / "tactile-mouse.toml")  # a drive without a device around it
    until(page, "pindrive.studio.view === 'release'")
    settled(page)
    assert page.evaluate("pindrive.release.state.designs.length") == 2
    page.get_by_role("link", name="Read").click()
    unknown = tmp_path / "notes"
    unknown.write_text("a: b\n", "utf-8")
    dropped(unknown)
    until(page, "!document.querySelector('#problem').hidden")
    assert page.locator("#problem").inner_text().startswith("notes: is not valid TOML")


def test_examples_of_pages_and_devices(read: Any) -> None:
    names = read.locator("header .menu").first.locator("li button").all_text_contents()
    assert len(names) == 8
    titles = []
    for name in names[:5]:
        choose_example(read, name)
        read.wait_for_timeout(300)
        titles.append(read.evaluate("pindrive.read.paper.title"))
        assert read.evaluate("pindrive.read.paper.raster.grey.some(g => g < 100)")
    assert titles == [
        *("the text “Hello”", "the text “friction”", "a drawing", "rings in grey", "15 lines"),
    ]
    for name, pins in zip(names[5:], (1, 4, 16), strict=True):
        choose_example(read, name)
        until(read, f"pindrive.read.session.pins === {pins}")
    read.get_by_label("columns of pins").select_option("2")
    until(read, "pindrive.read.session.pins === 8")
    cross(read, 0.8)
    read.mouse.move(5, 5)
    kept(read)
    assert read.evaluate(COUNTS)[0] > 10


def test_both_views_choose_the_colours(read: Any) -> None:
    for view in ("Read", "One release"):
        read.get_by_role("link", name=view).click()
        read.get_by_label("colours").select_option("dark")
        read.wait_for_timeout(100)
        style = "getComputedStyle(document.body).backgroundColor"
        assert re.match(r"rgb\((\d+)", read.evaluate(style))[1] < "3"  # type: ignore[index]
        read.get_by_label("colours").select_option("light")
    read.get_by_role("link", name="Read").click()
    read.get_by_label("colours").select_option("dark")
    read.wait_for_timeout(100)
    white = read.evaluate(
        "(() => { const c = document.querySelector('canvas.sheet');"
        " return c.getContext('2d').getImageData(3, 3, 1, 1).data[0]; })()"
    )
    assert white < 140

"""The page on a telephone of 390 × 844 pixels with touch, and the first screen of a desktop."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from studio_page import settled, until

COUNTS = "[...document.querySelectorAll('.counts dd')].map(e => Number(e.textContent))"
SMALL = (
    "[...document.querySelectorAll('button, select, nav a, summary, label:has(input),"
    " input:not([type=checkbox], [type=radio])')]"
    ".filter(e => e.checkVisibility({visibilityProperty: true}) && !e.closest('.u-legend'))"
    ".filter(e => { const { width, height } = e.getBoundingClientRect();"
    " return height < 43.5 || width < 43.5; }).map(e => e.outerHTML.slice(0, 90))"
)


@pytest.fixture
def phone(browser: Any, page_file: Any) -> Iterator[Any]:
    """The page as it opens on a telephone."""
    context = browser.new_context(
        viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True
    )
    page = context.new_page()
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(page_file.as_uri())
    page.wait_for_selector("html[data-ready]")
    yield page
    context.close()
    assert wrong == []


def swipe(page: Any, begin: float, end: float, seconds: float, slope: float = 0.0) -> None:
    """Drags a finger over the page between two parts of its width."""
    box = page.locator("canvas.sheet").bounding_box()
    touch = page.context.new_cdp_session(page)
    steps = max(3, int(60 * seconds))
    for i, part in enumerate(np.linspace(begin, end, steps)):
        x = box["x"] + part * box["width"]
        y = box["y"] + (0.5 + slope * (part - 0.5)) * box["height"]
        kind = "touchStart" if i == 0 else "touchMove"
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})
        page.wait_for_timeout(1000 * seconds / steps)
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def kept(page: Any) -> None:
    until(page, "pindrive.read.phase === 'kept' && pindrive.read.session.judge.idle")
    page.wait_for_timeout(100)


def test_every_stroke_begins_where_the_finger_touches(phone: Any) -> None:
    for begin in (0.03, 0.03, 0.1):
        swipe(phone, begin, 0.97, 1.0)
        kept(phone)
        start = phone.evaluate("pindrive.read.session.hand.start.x")
        assert start == pytest.approx(begin * 0.036, abs=3e-4)
        assert phone.evaluate(COUNTS)[0] > 45
    shown = phone.evaluate(COUNTS)
    phone.locator("nav").tap()
    phone.wait_for_timeout(500)
    assert phone.evaluate(COUNTS) == shown


def test_a_thumb_solves_the_tasks(phone: Any) -> None:
    verdict = phone.locator(".verdict")
    swipe(phone, 0.03, 0.97, 3.0)
    kept(phone)
    assert "well read!" in verdict.inner_text()
    phone.get_by_role("button", name="2", exact=True).tap()
    for seconds in (3.0, 1.0, 0.5, 0.25, 0.15):
        swipe(phone, 0.2, 0.9, seconds)
        kept(phone)
        if "became one" in verdict.inner_text():
            break
        assert "Still two at" in verdict.inner_text()
    assert "became one. The device's own limit: 250 mm/s" in verdict.inner_text()
    phone.get_by_role("button", name="3", exact=True).tap()
    swipe(phone, 0.2, 0.9, 1.5)
    kept(phone)
    assert "Now slanting." in verdict.inner_text()
    swipe(phone, 0.2, 0.9, 1.5, slope=1.2)
    kept(phone)
    assert "° askew" in verdict.inner_text() and "Straight 0." in verdict.inner_text()


ENDS = (
    "name => { const { top, bottom } = document.querySelector(name).getBoundingClientRect();"
    " return [top, bottom]; }"
)


def test_task_verdict_page_and_fingertip_are_on_the_first_screen(phone: Any) -> None:
    assert phone.evaluate(ENDS, "header")[1] <= 56
    for name in (".verdict", ".sheet", ".felt", ".fingertip", ".read .now"):
        top, bottom = phone.evaluate(ENDS, name)
        assert 0 <= top < bottom <= 844, name
    before = phone.evaluate(ENDS, ".sheet")
    swipe(phone, 0.03, 0.97, 1.0)
    kept(phone)
    assert phone.evaluate(ENDS, ".sheet") == before  # nothing moves under the finger


def test_the_first_screen_of_a_desktop_shows_the_verdict(page: Any, page_file: Any) -> None:
    page.goto("about:blank")
    page.goto(page_file.as_uri() + "#read")
    page.wait_for_selector("html[data-ready]")
    for name in (".verdict", ".sheet", ".felt", ".fingertip", ".counts"):
        top, bottom = page.evaluate(ENDS, name)
        assert 0 <= top < bottom <= 900, name
    assert page.evaluate(ENDS, "header")[1] <= 48


def test_every_target_of_both_views_has_44_pixels(phone: Any) -> None:
    phone.wait_for_timeout(300)
    assert phone.evaluate(SMALL) == []
    phone.get_by_role("button", name="Menu").tap()
    assert phone.evaluate(SMALL) == []
    phone.locator("header .menu summary").first.tap()
    assert phone.evaluate(SMALL) == []
    phone.get_by_role("button", name="A drawing").tap()
    assert phone.locator("#menu").is_hidden()
    phone.get_by_role("link", name="One release").tap()
    until(phone, "window.pindrive?.release?.view.lines.length")
    settled(phone)
    for details in phone.locator("details:not([open]) > summary").all():
        if details.is_visible():
            details.tap()
    assert phone.evaluate(SMALL) == []
    assert phone.evaluate("document.documentElement.scrollWidth") <= 390


def test_the_menu_opens_help_and_colours(phone: Any) -> None:
    phone.get_by_role("button", name="Menu").tap()
    phone.get_by_role("button", name="Help").tap()
    dialog = phone.get_by_role("dialog")
    assert dialog.is_visible() and "Press on the page" in dialog.inner_text()
    dialog.get_by_role("button", name="Close").tap()
    assert phone.get_by_role("dialog").count() == 0

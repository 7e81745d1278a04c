"""Devices with end stops in the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pindrive as pd
from pindrive.motion.simulate import motion_of
from studio_page import VALUES, elastic_stops, opened, saved, settled, value


def test_end_stops_are_given_and_left_out(page: Any, tmp_path: Path) -> None:
    for name in ("stop_stiffness", "stop_damping"):
        assert page.locator(f"#drive-{name}").is_hidden()
    assert page.get_attribute("#drive-travel", "placeholder") == "none"
    for name in ("travel", "stop_stiffness", "stop_damping"):
        page.check(f"#drive-{name}-given")
        settled(page)
    assert page.get_attribute("#drive-travel-slider", "aria-valuetext") == "2.000 mm"
    page.fill("#drive-travel", "1.2")
    page.keyboard.press("Enter")
    settled(page)
    path = saved(page, "toml", tmp_path)
    drive = pd.load_device(path).drive
    assert (drive.travel, drive.stop_stiffness, drive.stop_damping) == (0.0012, 1e4, 4.0)
    opened(page, path)
    link = page.evaluate("pindrive.studio.link()")
    assert value(page, "drive.travel") == 0.0012
    assert "stop" in saved(page, "events", tmp_path).read_text("utf-8")
    page.uncheck("#drive-stop_stiffness-given")  # a release beyond rigid stops
    settled(page)
    said = page.locator("#summary").inner_text()
    assert said == "motion.displacement must be at most travel, 0.0012 m, either way, got 0.002 m"
    page.uncheck("#drive-travel-given")
    settled(page)
    assert "stop_stiffness" not in page.evaluate(f"Object.keys({VALUES}).join()")
    assert page.locator("#summary").inner_text().startswith("Ending")
    page.goto("about:blank")
    page.goto(link)
    page.wait_for_selector("html[data-ready]")
    assert value(page, "drive.stop_damping") == 4.0


def test_derivatives_and_maps_of_end_stops_are_those_of_python(page: Any, tmp_path: Path) -> None:
    path = elastic_stops(tmp_path)
    opened(page, path)

    def number(given: dict[str, float]) -> float:
        return motion_of(pd.load_device(path, given)).transient.settling_time

    for key, at in (("travel", 1e-3), ("stop_stiffness", 1e3), ("stop_damping", 0.5)):
        ends = [number({f"drive.{key}": at * (1 + by)}) for by in (-1e-5, 1e-5)]
        row = page.locator(
            ".bars tbody tr", has=page.get_by_text(key.replace("_", " "), exact=True)
        )
        shown = float(row.locator("td.figure").inner_text().split(" ")[0].replace("−", "-"))
        assert shown == pytest.approx((ends[1] - ends[0]) / 2e-5 * 0.01 * 1e3, rel=5e-3), key
    page.select_option("#map-x", "drive.travel")
    page.select_option("#map-y", "drive.stop_stiffness")
    drawn = (
        "(() => { const {newest, task} = pindrive.release.map;"
        " return !newest.busy && Boolean(task?.varied.travel && task.varied.stop_stiffness); })()"
    )
    for _ in range(1200):  # its policy forbids it to wait by itself
        if page.evaluate(drawn):
            break
        page.wait_for_timeout(50)
    found = page.evaluate(
        "(() => { const r = pindrive.release.map; const {travel, stop_stiffness} = r.task.varied;"
        " return {values: [...r.last.values], x: [...travel.x], y: [...stop_stiffness.y]}; })()"
    )
    for i, j in ((0, 0), (63, 5), (31, 40), (20, 63)):
        given = {"drive.travel": found["x"][i], "drive.stop_stiffness": found["y"][j]}
        assert found["values"][64 * j + i] == pytest.approx(number(given), rel=1e-9)

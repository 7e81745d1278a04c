"""Times the studio in headless Chromium: a slider that moves, the live map, and a hand that reads.

python3 run.py studio bench
"""

from __future__ import annotations

import platform
import shutil
import sys
import time
from math import sin, tau
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import sync_playwright

PAGE = Path(__file__).resolve().parents[1] / "src" / "pindrive" / "studio.html"
MOVES = 200
REDRAW = """async count => {
  const { page } = pindrive, took = [];
  const slider = document.getElementById("drive-mass-slider");
  for (let i = 0; i < count; ++i) {
    slider.value = String(300 + (i % 100) * 4);
    const begin = performance.now();
    slider.dispatchEvent(new Event("input"));
    await page.settled();  // simulated by the thread, and drawn
    took.push(performance.now() - begin);
  }
  return took;
}"""
MAPS = """async count => {
  const { map } = pindrive.page, took = [];
  for (let i = 0; i < count; ++i) {
    const last = map.last;
    const { values } = pindrive.release.state.designs[0];
    pindrive.release.setValues({...values, "drive.mass": 0.008 + 2e-5 * i}, "bench");
    while (map.last === last) await new Promise(done => setTimeout(done, 1));
    took.push(map.last.took);
  }
  return took;
}"""

READ = """() => {
  const { session } = pindrive.read, { listener } = session;
  const seen = window.seen = { latency: [], pictures: [], last: 0 };
  let moved = 0, sent = 0;
  addEventListener("pointermove", event => { moved = event.timeStamp; }, true);
  const advance = session.advance.bind(session);
  session.advance = until => {
    const waiting = session.pending;
    advance(until);
    if (!waiting && session.pending) [sent, moved] = [moved, 0];
  };
  const sampled = listener.sampled.bind(listener);
  listener.sampled = (...given) => {
    sampled(...given);  // drawn
    const now = performance.now();
    if (sent) seen.latency.push(now - sent);
    if (seen.last) seen.pictures.push(now - seen.last);
    [sent, seen.last] = [0, now];
  };
  session.took.length = 0;
}"""
HANDS = (("40", 1, 6), ("10", 1, 6), ("1", 1, 6), ("10", 4, 60))  # slowness, throttling, s


def shown(name: str, times: list[float], limit: float) -> None:
    """A line of the table: milliseconds, and what is promised."""
    ordered = sorted(times)
    early, late = (ordered[int(part * len(ordered))] for part in (0.05, 0.99))
    print(f"{name:42} {median(times):7.2f} {early:7.2f} {late:7.2f}   at most {limit:g}")


def read(page: Any, slowness: str, throttling: int, seconds: float) -> None:
    """Moves the pointer over the page of the view Read, in waves."""
    page.get_by_role("link", name="Read").click()
    page.wait_for_timeout(1500)
    page.locator(f"input[name=slowness][value='{slowness}']").check()
    rate = {"rate": throttling}
    page.context.new_cdp_session(page).send("Emulation.setCPUThrottlingRate", rate)
    box = page.locator("canvas.sheet").bounding_box()
    page.evaluate(READ)
    period = 1.2 if slowness == "1" else 4.0  # s, of one way there and back
    began = time.monotonic()
    while (now := time.monotonic() - began) < seconds:
        x, y = 0.5 + 0.45 * sin(tau * now / period), 0.5 + 0.2 * sin(tau * now / 2.7)
        page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
        time.sleep(0.012)
    seen = page.evaluate("seen")
    print(f"hand {slowness} times slower, {seconds:g} s, processor {throttling} times slower")
    shown("  threads of the pins, a picture", page.evaluate("pindrive.read.session.took"), 4)
    shown("  pointer to picture", seen["latency"], 20)
    shown("  from picture to picture", seen["pictures"], 17)


def main() -> None:
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if browser is None or not PAGE.exists():
        sys.exit("needs Chromium, and the page: apt-get install chromium; python3 run.py studio")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        page = started.new_page(viewport={"width": 1440, "height": 900})
        page.goto(PAGE.as_uri())
        page.wait_for_selector("html[data-ready]")
        page.evaluate(REDRAW, 50)  # compiled, then measured
        page.evaluate(MAPS, 20)
        print(f"Chromium {started.version}, {platform.machine()}; ms: median, 5 %, 99 %")
        metrics = page.context.new_cdp_session(page)
        metrics.send("Performance.enable")

        def busy() -> dict[str, float]:
            found = metrics.send("Performance.getMetrics")["metrics"]
            return {each["name"]: each["value"] for each in found}

        before = busy()
        shown("slider to picture, with its frame", page.evaluate(REDRAW, MOVES), 50)
        spent = {name: 1e3 * (value - before[name]) / MOVES for name, value in busy().items()}
        names = ("ScriptDuration", "LayoutDuration", "RecalcStyleDuration")
        each = sum(spent[name] for name in names)
        print(f"{'main thread: script, style and layout':42} {each:7.2f}   at most 16")
        shown("map of 64 x 64, in its own thread", page.evaluate(MAPS, MOVES), 50)
        for slowness, throttling, seconds in HANDS:
            fresh = started.new_page(viewport={"width": 1440, "height": 900})
            fresh.goto(PAGE.as_uri())
            fresh.wait_for_selector("html[data-ready]")
            read(fresh, slowness, throttling, seconds)
            fresh.close()
        started.close()


if __name__ == "__main__":
    main()

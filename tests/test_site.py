"""The site as built, in a browser: on a telephone, and searched without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import pytest

SITE = Path(__file__).resolve().parents[1] / "build" / "docs"
PAGES = sorted(
    path.relative_to(SITE).as_posix()
    for path in SITE.rglob("*.html")
    if "_static" not in path.parts
)
WIDTH = 390
TOO_WIDE = """() => {
  const reached = (e) => {  // whether the reader can move to the right end of an element
    for (let box = e.parentElement; box.localName !== "article"; box = box.parentElement) {
      const overflow = getComputedStyle(box).overflowX;
      if (overflow === "auto" || overflow === "scroll") return true;
    }
    return false;
  };
  const lost = [...document.querySelectorAll("article *")].filter((e) => {
    const box = e.getBoundingClientRect();
    return box.width > 0 && box.right > innerWidth + 1 && !reached(e) && e.checkVisibility();
  });
  const named = lost.map((e) => `${e.localName}: ${(e.textContent || "").trim().slice(0, 40)}`);
  const width = Math.max(innerWidth, document.documentElement.scrollWidth);
  return {width, lost: named.slice(0, 5)};
}"""
"""Script for the width of a page, and for parts that no reader can scroll to."""


class Quiet(SimpleHTTPRequestHandler):
    """Serves the site."""

    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Address of the site on this machine."""
    if not PAGES:
        pytest.skip("needs the site of `python3 run.py docs`")
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(SITE))) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@pytest.fixture(scope="module")
def telephone(address: str) -> Iterator[Any]:
    """A page of a browser like a telephone; it fails where the site asks another machine."""
    program = shutil.which("chromium")
    sync_api = pytest.importorskip("playwright.sync_api")
    if not program:
        pytest.skip("needs chromium")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        context = browser.new_context(
            viewport={"width": WIDTH, "height": 844}, is_mobile=True, has_touch=True
        )
        page = context.new_page()
        requested: list[str] = []
        page.on("request", lambda request: requested.append(request.url))
        page.on("pageerror", lambda error: requested.append(str(error)))
        yield page
        browser.close()
        own = (address, "data:", f"blob:{address}")
        assert [url for url in requested if not url.startswith(own)] == []


def test_no_page_is_wider_than_a_telephone(address: str, telephone: Any) -> None:
    found = {}
    for name in PAGES:
        telephone.goto(address + name)
        found[name] = telephone.evaluate(TOO_WIDE)
    expected = {"width": WIDTH, "lost": []}
    assert {name: said for name, said in found.items() if said != expected} == {}


@pytest.mark.parametrize("width", [WIDTH, 1280])
def test_no_table_of_the_report_is_wider_than_its_page(
    address: str, telephone: Any, width: int
) -> None:
    telephone.set_viewport_size({"width": width, "height": 844})
    telephone.goto(f"{address}paper.html")
    found = telephone.evaluate(
        "[...document.querySelectorAll('table')]"
        ".map(table => table.scrollWidth - table.parentElement.clientWidth)"
    )
    telephone.set_viewport_size({"width": WIDTH, "height": 844})
    assert len(found) == 7
    assert max(found) <= 0


def test_a_search_without_a_network_finds_the_page(address: str, telephone: Any) -> None:
    telephone.goto(f"{address}search.html?q=settling+time")
    first = telephone.locator("#search-results ul.search li > a").first
    first.wait_for()
    telephone.wait_for_function("document.querySelector('.search-summary')?.textContent")
    assert first.get_attribute("href").startswith("reference/dataset.html")

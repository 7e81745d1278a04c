"""The built page, Node and a browser; a test says what is missing, and the gate lacks nothing."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NoReturn

import pytest

from studio_cases import Ask

ROOT = Path(__file__).resolve().parents[2]
STUDIO = ROOT / "studio"
BUILD = STUDIO / "build"
PAGE = ROOT / "src" / "pindrive" / "studio.html"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def missing(what: str) -> NoReturn:
    """Skips, or fails in the gate."""
    if os.environ.get("PINDRIVE_STUDIO") and os.environ.get("CI"):
        pytest.fail(what)
    pytest.skip(what)


@pytest.fixture(scope="session")
def page_file() -> Path:
    """The built page."""
    if not os.environ.get("PINDRIVE_STUDIO"):
        missing("`python3 run.py studio test` builds the page and runs this")
    if not PAGE.exists():
        missing("the page is not built; `python3 run.py studio` builds it")
    return PAGE


@pytest.fixture(scope="session")
def node_program(page_file: Path) -> str:
    """Node itself."""
    program = shutil.which("node")
    if program is None:
        missing("node is missing; the extra `studio` brings it")
    return program


@pytest.fixture(scope="session")
def node(node_program: str) -> Ask:
    """Asks the page's program in Node many things at once; one answer each."""
    return asking(node_program, BUILD / "node.mjs")


@pytest.fixture
def spoiled(node_program: str, tmp_path: Path) -> Callable[[str, str, str], Ask]:
    """Return a page with one text of one file replaced."""

    def spoil(file: str, text: str, instead: str) -> Ask:
        source, program = tmp_path / "src", tmp_path / "node.mjs"
        shutil.copytree(STUDIO / "src", source)
        (tmp_path / "build").mkdir()
        shutil.copyfile(BUILD / "tables.json", tmp_path / "build" / "tables.json")
        before = (source / file).read_text("utf-8")
        assert before.count(text) == 1, f"{text!r} is {before.count(text)} times in {file}"
        (source / file).write_text(before.replace(text, instead), "utf-8")
        bundler = STUDIO / "node_modules" / "esbuild" / "bin" / "esbuild"
        bundle = ("--bundle", "--format=esm", "--platform=node", f"--outfile={program}")
        subprocess.run(
            [node_program, bundler, source / "node.ts", *bundle],
            check=True,
            capture_output=True,
            env={**os.environ, "NODE_PATH": str(STUDIO / "node_modules")},
        )
        return asking(node_program, program)

    return spoil


def asking(node: str, program: Path) -> Ask:
    """Return the function that runs a program in Node."""

    def ask(questions: list[dict[str, Any]]) -> list[Any]:
        lines = "".join(json.dumps(question, ensure_ascii=False) + "\n" for question in questions)
        done = subprocess.run(
            [node, program, BUILD / "core.wasm"],
            input=lines,
            capture_output=True,
            text=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]

    return ask


@pytest.fixture(scope="session")
def browser(page_file: Path) -> Iterator[Any]:
    """A headless Chromium, one for all tests."""
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        missing("Chromium is missing; Debian has it: apt-get install chromium")
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        missing("playwright is missing; the extra `studio` brings it")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=found, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture
def page(browser: Any, page_file: Path) -> Iterator[Any]:
    """The view "One release", opened from disk; a request or an error that is logged fails."""
    context = browser.new_context(viewport={"width": 1440, "height": 900}, accept_downloads=True)
    opened = context.new_page()
    wrong: list[str] = []
    opened.on("pageerror", lambda error: wrong.append(str(error)))
    opened.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
    opened.on(
        "request",
        lambda request: (
            wrong.append(request.url)
            if not request.url.startswith(("file:", "blob:", "data:"))
            else None
        ),
    )
    opened.goto(f"{page_file.as_uri()}#release")
    opened.wait_for_selector("html[data-ready]")
    yield opened
    context.close()
    assert wrong == []

"""The moving picture of README.md: the view "Read" while its demonstration crosses the page.

python studio/picture.py [FILE.webp]
"""

from __future__ import annotations

import io
import shutil
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "src" / "pindrive" / "studio.html"
SIZE = {"width": 1180, "height": 760}
WIDTH = 760
FRAMES = 64
STEP = 0.11
"""Time between two pictures, s."""
LARGEST = 1_000_000
"""Bytes of the picture."""


def frames(page: Page) -> list[Image.Image]:
    """Pictures of the page over time, each with what has been painted so far."""
    found = []
    for _ in range(FRAMES):
        shot = Image.open(io.BytesIO(page.screenshot(type="jpeg", quality=90)))
        found.append(
            shot.resize((WIDTH, WIDTH * shot.height // shot.width), Image.Resampling.LANCZOS)
        )
        page.wait_for_timeout(1000 * STEP)
    return found


def main(target: Path) -> None:
    """Film the page; the file is written at the end."""
    with sync_playwright() as running:
        browser = running.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"]
        )
        page = browser.new_page(viewport=SIZE, color_scheme="light")
        page.goto(f"{PAGE.as_uri()}#read")
        page.wait_for_selector("html[data-ready]")
        first, *others = frames(page)
        browser.close()
    first.save(
        target,
        save_all=True,
        append_images=others,
        duration=int(1000 * STEP),
        loop=0,
        quality=55,
        method=4,
    )
    size = target.stat().st_size
    print(f"{target}: {FRAMES} pictures, {size} bytes")
    if size > LARGEST:
        raise SystemExit(f"studio/picture.py: {target} must have at most {LARGEST} bytes")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else ROOT / "docs" / "images" / "read.webp")

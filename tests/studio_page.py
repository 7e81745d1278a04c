"""Actions of a person on the page, and devices for the page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pindrive as pd
from command import EXAMPLE

FRAMES = """async () => {
  const frames = () => new Promise(
    done => requestAnimationFrame(() => requestAnimationFrame(done)));
  await frames();
  await window.pindrive.release?.settled();
  await frames();
}"""
VALUES = "pindrive.release.state.designs[pindrive.release.state.current].values"


def settled(page: Any) -> None:
    """After what was asked is drawn."""
    page.evaluate(FRAMES)


def until(page: Any, expression: str, timeout: int = 10_000) -> None:
    """Waits until an expression is true: the page allows no script of its watchers."""
    for _ in range(timeout // 50):
        if page.evaluate(f"Boolean({expression})"):
            return
        page.wait_for_timeout(50)
    pytest.fail(f"not true in {timeout} ms: {expression}")


def choose_example(page: Any, name: str) -> None:
    """Choose an example of the view that is shown."""
    page.locator("header .menu summary").first.click()
    page.locator("header .menu").first.get_by_role("button", name=name, exact=True).click()


def value(page: Any, key: str) -> Any:
    return page.evaluate(f"{VALUES}[{key!r}] ?? null")


def opened(page: Any, *files: Path) -> None:
    """Opens files as a person does, by the button."""
    for file in files:
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="Open …", exact=True).click()
        chooser.value.set_files(file)
        settled(page)
    page.wait_for_timeout(100)
    settled(page)


def saved(page: Any, kind: str, folder: Path) -> Path:
    """Saves by the menu; the file."""
    with page.expect_download() as download:
        page.locator("header .menu summary").last.click()
        page.locator(f"header .menu [data-name={kind}]").click()
    path = folder / str(download.value.suggested_filename)
    download.value.save_as(path)
    return path


def numbers_shown(page: Any) -> dict[str, float | None]:
    found: dict[str, float | None] = page.evaluate(
        "Object.fromEntries(Object.entries(pindrive.release.view.lines[0].result.curves.numbers)"
        ".map(([k, v]) => [k, Number.isFinite(v) ? v : null]))"
    )
    return found


def pushed(folder: Path) -> Path:
    """A pin whose finger pushes, while the hand moves off the axis, by coefficients of friction."""
    path = folder / "pushed.toml"
    path.write_text(
        EXAMPLE.read_text("utf-8")
        .replace('kinetic = "22 mN"', 'coefficient = 0.225\npreload = "10 mN"')
        .replace('static = "26.5 mN"', "static_coefficient = 0.27")
        .replace('kinetic = "5 mN"', 'coefficient = 0.5\ntouch_force = "10 mN"')
        .replace('static = "7.5 mN"', "static_coefficient = 0.75")
        .replace(
            "[motion]",
            '[motion]\nforce = [["0 s", "10 mN"], ["20 ms", "0 N"]]\n'
            'across_velocity = [["0 s", "30 mm/s"], ["40 ms", "0 m/s"]]',
        ),
        "utf-8",
    )
    assert pd.load_device(path).drive.plate.coefficient == 0.225
    assert pd.load_device(path).drive.finger.coefficient == 0.5
    return path


def stopped(folder: Path, *lines: str) -> Path:
    """A pin that strikes its end stops."""
    path = folder / "stopped.toml"
    text = EXAMPLE.read_text("utf-8").replace("[drive]", "\n".join(("[drive]", *lines)))
    path.write_text(text.replace("damping_ratio = 0.16", "damping_ratio = 0.01"), "utf-8")
    return path


def rigid_stops(folder: Path) -> Path:
    path = stopped(folder, 'travel = "2 mm"')
    pushed = 'velocity = "-300 mm/s"\nforce = [["0 s", "-500 mN"], ["60 ms", "0 N"]]\n'
    path.write_text(path.read_text("utf-8") + pushed, "utf-8")
    return path


def elastic_stops(folder: Path) -> Path:
    return stopped(
        folder, 'travel = "1 mm"', 'stop_stiffness = "1000 N/m"', 'stop_damping = "0.5 N*s/m"'
    )

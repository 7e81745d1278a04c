"""`pindrive studio`: a copy of the page with the device in it. The page itself: tests/studio."""

from __future__ import annotations

import json
import re
import webbrowser
from pathlib import Path

import pytest

from command import EXAMPLE, GOOD, refused, run
from pindrive.cli import studio
from pindrive.files.device import load_device


@pytest.fixture
def page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A page of which only the place for the device matters here."""
    path = tmp_path / "studio.html"
    path.write_text(f"<p>before</p>{studio.PLACE}<p>after</p>", "utf-8")
    monkeypatch.setattr(studio, "PAGE", path)
    return path


def given(said: str) -> dict[str, object]:
    """Contents of the copy of the page."""
    text = Path(said.strip()).read_text("utf-8")
    match = re.fullmatch(
        r'<p>before</p><script type="application/json" id="device">(.*)</script><p>after</p>',
        text,
        re.DOTALL,
    )
    assert match
    assert "<" not in match[1]
    found: dict[str, object] = json.loads(match[1])
    return found


def test_without_a_device_it_is_the_page_of_the_package(page: Path) -> None:
    result = run("studio", "--no-browser")
    assert (result.exit_code, result.stdout) == (0, f"{page}\n")


def test_the_copy_holds_the_text_of_the_device(page: Path) -> None:
    found = given(run("studio", EXAMPLE, "--no-browser").stdout)
    assert found == {"file": str(EXAMPLE), "text": EXAMPLE.read_text("utf-8"), "rows": {}}


@pytest.mark.usefixtures("page", "in_empty_folder")
def test_rows_of_csv_files_go_along_and_no_text_ends_the_script() -> None:
    Path("v.csv").write_text("time [ms], mouse_velocity [mm/s]\n0, 60\n100, 0\n", "utf-8")
    text = GOOD.replace('"100 mm/s"', '"v.csv"') + '[device]\nname = "</script>"\n'
    Path("device.toml").write_text(text, "utf-8")
    found = given(run("studio", "device.toml", "--no-browser").stdout)
    assert found["text"] == text
    assert found["rows"] == {"motion.mouse_velocity": [[0.0, 0.06], [0.1, 0.0]]}
    assert load_device("device.toml").release.mouse_velocity


@pytest.mark.usefixtures("page", "in_empty_folder")
def test_a_device_with_a_mistake_is_refused_as_by_check() -> None:
    Path("device.toml").write_text(GOOD.replace("10 g", "10"), "utf-8")
    assert refused("studio", "device.toml") == run("check", "device.toml").stderr.strip()


def test_browser_that_does_not_open_is_reported(
    page: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []

    def fails(url: str) -> bool:
        opened.append(url)
        return False

    monkeypatch.setattr(webbrowser, "open", fails)
    result = run("studio")
    assert opened == [page.as_uri()]
    assert (result.exit_code, result.stdout) == (0, f"{page}\n")
    assert result.stderr == "no browser could be opened; open that file in one\n"


@pytest.mark.usefixtures("in_empty_folder")
def test_package_without_the_page_names_the_build_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(studio, "PAGE", Path("studio.html").absolute())
    assert refused("studio") == "the studio is not built; `python3 run.py studio` builds it"

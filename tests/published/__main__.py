"""Compute the published cases, and write the page on them and its figures."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from pindrive.plot.style import save

from .cases import CASES
from .figure import figure
from .page import PAGE, ROOT, picture, with_cases


def _write(path: Path, content: bytes) -> None:
    """Replace a file whole."""
    beside = path.with_name(f".{path.name}.new")
    beside.write_bytes(content)
    beside.replace(path)
    print(f"Wrote {path.relative_to(ROOT)}")


def main() -> None:
    """Write everything."""
    cases = [case() for case in CASES]
    page = with_cases(PAGE.read_text("utf-8"), cases)
    for case in cases:
        drawn = BytesIO()
        save(figure(case), drawn, "png")
        _write(picture(case), drawn.getvalue())
    _write(PAGE, page.encode())


main()

"""The site works without a network: a page that would ask one for anything ends the build."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_ELSEWHERE = r"(?:https?:)?//"
_ASKED = {
    ".html": re.compile(
        rf"<(?:script|img|iframe|source|video|audio|embed)\b[^>]*\bsrc=[\"']?{_ELSEWHERE}[^>]*>"
        r"|<link\b(?=[^>]*\brel=[\"']?(?:stylesheet|preload|preconnect|icon|prefetch))[^>]*"
        rf"\bhref=[\"']?{_ELSEWHERE}[^>]*>"
        rf"|url\([\"']?{_ELSEWHERE}[^)]*\)|@import\s+[\"']{_ELSEWHERE}[^\"']*"
    ),
    ".css": re.compile(rf"url\([\"']?{_ELSEWHERE}[^)]*\)|@import\s+[\"']{_ELSEWHERE}[^\"']*"),
}


def requests(text: str, suffix: str) -> list[str]:
    """Return the requests of a page (.html) or a style sheet (.css) to other machines.

    Links that a reader may follow are none of it.
    """
    return [match[0] for match in _ASKED[suffix].finditer(text)]


def check(app: Sphinx, error: Exception | None) -> None:
    """End the build where a file asks for something."""
    from sphinx.errors import ExtensionError

    if error or app.builder.format != "html":
        return
    found = [
        f"{path.relative_to(app.outdir)}: {request}"
        for path in sorted(Path(app.outdir).rglob("*"))
        if path.suffix in _ASKED
        for request in requests(path.read_text("utf-8"), path.suffix)
    ]
    if found:
        raise ExtensionError("the site asks the network:\n" + "\n".join(found))


def setup(app: Sphinx) -> dict[str, Any]:
    """Called by Sphinx."""
    app.connect("build-finished", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""Reference pages that are made of pindrive itself: its commands, its tables and its codes.

The directive `{from-pindrive} NAME` stands for the Markdown that one of `PARTS` makes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, ClassVar

import c_header
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.docutils import SphinxDirective
from typer.main import get_command
from typer.testing import CliRunner

from pindrive.cli.app import app
from pindrive.files.keys import NUMBERS
from pindrive.files.keys import template as device_template
from pindrive.quantities.quantity import Quantity
from pindrive.quantities.results import DESIGNED, JUDGED, LINE, OUTPUTS, SCANNED, SERIES
from pindrive.quantities.status import End, Status
from pindrive.study.template import study_template


def table(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown."""
    headings = list(headings)
    lines = [headings, ["---"] * len(headings)]
    lines += [[cell.replace("|", "\\|").replace("*", "\\*") for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def code(text: str, language: str) -> str:
    """A block of code."""
    return f"```{language}\n{text.rstrip()}\n```"


def commands() -> str:
    """The help of each command, as it prints it."""
    parts = []
    program: Any = get_command(app)
    for name in program.list_commands(None):
        said = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "80"})
        if said.exit_code:
            raise ExtensionError(f"pindrive {name} --help ends with {said.exit_code}")
        parts += [f"## {name}", code(said.stdout, "text")]
    return "\n\n".join(parts)


def device_file() -> str:
    """Each key of a device file, by its table."""
    groups: dict[str, list[Quantity]] = {}
    for key, quantity in NUMBERS.items():
        groups.setdefault(key.partition(".")[0], []).append(quantity)
    headings = ("key", "unit", "meaning", "values", "unless given", "source")
    parts = []
    for name, quantities in groups.items():
        rows = (
            (
                f"`{q.key}`",
                q.unit,
                q.meaning,
                "; ".join(filter(None, (q.bounds.words(""), q.remark))),
                "must be given"
                if q.mandatory
                else "-"
                if q.absent is None
                else q.written(q.absent),
                q.source,
            )
            for q in quantities
        )
        parts += [f"## `[{name}]`", table(headings, rows)]
    parts += ["## The file that `pindrive init --device` writes"]
    parts += [code(device_template(whole=True), "toml")]
    return "\n\n".join(parts)


def study_file() -> str:
    """The study file that is written, with its comments."""
    return code(study_template(), "toml")


def dataset() -> str:
    """The variables of datasets: over time, and the numbers of motions and scans."""

    def rows(quantities: Iterable[Quantity]) -> Iterable[tuple[str, ...]]:
        return ((f"`{q.name.replace('.', '_')}`", q.unit, q.meaning, q.source) for q in quantities)

    headings = ("variable", "unit", "meaning", "source")
    groups = {
        "Over time": SERIES.values(),
        "Numbers of a motion": OUTPUTS,
        "Of the pins of a scan": SCANNED,
        "Of the lines that were read": LINE,
        "What a scan is judged by": JUDGED,
        "Of a design": DESIGNED,
    }
    return "\n\n".join(f"## {name}\n\n{table(headings, rows(of))}" for name, of in groups.items())


def status() -> str:
    """The codes of how far a motion was followed, and of how it ends."""
    codes = ((f"`{s.name}`", str(s.value), s.explanation) for s in Status)
    ends = ((f"`{end.name}`", str(end.value)) for end in End)
    first = table(("status", "code", "meaning"), codes)
    return f"## Status\n\n{first}\n\n## Endings\n\n{table(('ending', 'code'), ends)}"


PARTS: dict[str, Callable[[], str]] = {
    "commands": commands,
    "device-file": device_file,
    "study-file": study_file,
    "dataset": dataset,
    "status": status,
    "c-header": c_header.reference,
}


class FromPindrive(SphinxDirective):
    """The directive."""

    required_arguments: ClassVar[int] = 1

    def run(self) -> list[nodes.Node]:
        """The nodes of the Markdown."""
        text = PARTS[self.arguments[0]]()
        if "\n## " in text and not text.startswith("## "):
            raise ExtensionError(
                f"{self.arguments[0]}: what stands before its first heading would come last"
            )
        lines = StringList(text.splitlines(), source="pindrive")
        inside = nodes.section()
        inside.document = self.state.document
        self.state.nested_parse(lines, self.content_offset, inside, match_titles=True)
        return inside.children


def setup(app: Sphinx) -> dict[str, Any]:
    """Make the directive known."""
    app.add_directive("from-pindrive", FromPindrive)
    return {"parallel_read_safe": True, "env_version": 1}

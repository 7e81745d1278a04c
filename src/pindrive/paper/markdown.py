"""The report for the docs: verdicts, equations and figures as Markdown, with pictures beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from pindrive.paper import baseline
from pindrive.paper.notation import markdown
from pindrive.paper.report import TITLE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from pindrive.paper.report import Report

NAME: Final = "paper.md"
IMAGES: Final = "images/paper"
_EQUATIONS: Final = "Its equations, mended"


def text(report: Report) -> str:
    """The document, whose pictures are at `IMAGES` beside it."""
    lines = [
        f"# {TITLE}",
        "<!-- Made by `pindrive paper --docs docs`; do not edit. -->",
        markdown(report.summary),
        "`pindrive paper --out DIR` writes all this as one page, with every figure as SVG and PNG "
        "and its data as NetCDF. `pindrive.paper` has the equations as functions.",
        "## Its sentences, judged",
        _table(
            [
                ("sentence", "verdict", "what was found"),
                *(
                    (
                        f"“{claim.sentence}” *{claim.place}*",
                        f"**{claim.verdict}**",
                        f"{claim.finding} {_link(report, claim.shown_by)}",
                    )
                    for claim in report.claims
                ),
            ]
        ),
        f"## {_EQUATIONS}",
        markdown(report.method),
        _table(report.equation_cells()),
        markdown(report.slips()),
    ]
    for section in report.sections:
        lines += [f"## {section.title}", markdown(section.text)]
        for exhibit in section.exhibits:
            lines += [
                f"### {markdown(exhibit.title)}",
                f"![{exhibit.title}]({IMAGES}/{exhibit.name}.png)",
                markdown(exhibit.caption),
            ]
            lines += ["\n".join(f"- {markdown(sentence)}" for sentence in exhibit.readings)]
            lines += [_table(exhibit.table)] if exhibit.table else []
    lines += [
        "## What was assumed",
        "The paper gives three damping factors and no other value. Unless a figure says otherwise:",
        _table([("", "value", "meaning", "source"), *baseline.SOURCES]),
    ]
    return "\n\n".join(line for line in lines if line) + "\n"


def files(report: Report, step: Callable[[str], None] = lambda _: None) -> dict[str, bytes]:
    """Everything that `pindrive paper --docs` writes, by its path in the folder."""
    found = {NAME: text(report).encode()}
    for exhibit in report.exhibits:
        step(f"drawing {exhibit.name}")
        found[f"{IMAGES}/{exhibit.name}.png"] = exhibit.pictures()["png"]
    return found


def _link(report: Report, name: str) -> str:
    """To an exhibit's heading, where GitHub puts it: lower case, no punctuation, hyphens."""
    titles = {exhibit.name: exhibit.title for exhibit in report.exhibits}
    title = titles.get(name, _EQUATIONS).lower()
    anchor = "".join(c for c in title if c.isalnum() or c in " -_").replace(" ", "-")
    return f"[→ {name.replace('-', ' ')}](#{anchor})"


def _table(rows: Iterable[Iterable[str]]) -> str:
    first, *others = ([markdown(cell) for cell in row] for row in rows)
    lines = [first, ["---"] * len(first), *others]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)

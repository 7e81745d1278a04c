"""The report as one page that needs nothing else: styles, formulas and figures are in it."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Final

from pindrive.paper import baseline
from pindrive.paper.notation import html
from pindrive.paper.report import TITLE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from pindrive.paper.claim import Claim
    from pindrive.paper.exhibit import Exhibit
    from pindrive.paper.report import Report

_STYLE: Final = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1b1f24; --soft: #5b6570; --line: #d9dee3;
  --wash: #f5f7f9; --link: #0062a3; --good: #00795a; --part: #9a5b00; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --paper: #14171a; --ink: #e4e7ea; --soft: #9aa4ae;
  --line: #333a41; --wash: #1c2125; --link: #6db9ec; --good: #3fc79a; --part: #eeb04f;
  --bad: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.55;
  font: 1rem/1.55 system-ui, "Segoe UI", Roboto, "Helvetica Neue", sans-serif; }
main { max-width: 60rem; margin: 0 auto; padding: 2.5rem 1.25rem 5rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .75rem; text-wrap: balance; }
h2 { font-size: 1.35rem; margin: 3rem 0 .75rem; padding-top: .75rem;
  border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 2.25rem 0 .5rem; }
p { margin: .6rem 0; max-width: 46rem; }
a { color: var(--link); }
nav { font-size: .92rem; color: var(--soft); margin: 1.25rem 0; }
nav a { display: inline-block; margin-right: 1.1rem; }
code { font: .9em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
.soft, figcaption { color: var(--soft); font-size: .9rem; }
figure { margin: .75rem 0 1rem; }
figure > div { background: #fff; border: 1px solid var(--line); border-radius: 6px;
  padding: .75rem; overflow-x: auto; }
figure svg { display: block; width: 100%; height: auto; min-width: 34rem; }
figcaption { margin-top: .5rem; max-width: 46rem; }
ul { padding-left: 1.2rem; max-width: 46rem; } li { margin: .3rem 0; }
.wide { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: .9rem; width: 100%; }
th { text-align: left; font-weight: 600; color: var(--soft); }
th, td { padding: .45rem .8rem .45rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
tbody tr:hover { background: var(--wash); }
td math { white-space: nowrap; }
math { font-size: 1.08em; } mover > mo { font-weight: bold; }
.equations td:first-child { white-space: nowrap; color: var(--soft); }
.equations td:nth-child(2) { line-height: 2; }
.equations td:nth-child(n+4) { white-space: nowrap; font-variant-numeric: tabular-nums; }
.equations td:nth-child(3) { min-width: 9rem; }
.verdicts td:first-child { width: 36%; } .verdicts td:nth-child(2) { width: 16%; }
.place { display: block; color: var(--soft); font-size: .82rem; }
.verdict { font-weight: 600; }
.holds { color: var(--good); } .part { color: var(--part); } .not { color: var(--bad); }
@media print { nav { display: none; }
  h2, h3 { break-after: avoid; } figure { break-inside: avoid; } }
"""


def page(report: Report, pictures: Mapping[str, bytes]) -> str:
    """The report as HTML.

    Args:
        report: what it says.
        pictures: the SVG of each exhibit, by its name.
    """
    from pindrive import __version__

    parts = {
        "verdicts": "Its sentences, judged",
        "equations": "Its equations, mended",
        **{_anchor(section.title): section.title for section in report.sections},
        "assumed": "What was assumed",
    }
    links = "".join(f'<a href="#{key}">{escape(title)}</a>' for key, title in parts.items())
    body = [
        f"<h1>{escape(TITLE)}</h1>",
        f"<p>{html(report.summary)}</p>",
        f"<nav>{links}</nav>",
        f'<h2 id="verdicts">{parts["verdicts"]}</h2>',
        _verdicts(report.claims, {e.name for e in report.exhibits}),
        f'<h2 id="equations">{parts["equations"]}</h2>',
        f'<p class="soft">{html(report.method)}</p>',
        _table(report.equation_cells(), "equations"),
        f"<p>{html(report.slips())}</p>",
    ]
    for section in report.sections:
        body.append(f'<h2 id="{_anchor(section.title)}">{escape(section.title)}</h2>')
        body.append(f"<p>{html(section.text)}</p>")
        body += [_exhibit(exhibit, pictures[exhibit.name]) for exhibit in section.exhibits]
    body += [
        f'<h2 id="assumed">{parts["assumed"]}</h2>',
        "<p>The paper gives three damping factors and no other value. Unless a figure says "
        "otherwise:</p>",
        _table([("", "value", "meaning", "source"), *baseline.SOURCES], ""),
        f'<p class="soft">Computed by pindrive {escape(__version__)}, '
        "<code>pindrive paper</code>; the data of each figure are beside this page as NetCDF.</p>",
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(TITLE)}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n<main>\n"
        + "\n".join(body)
        + "\n</main>\n</body>\n</html>\n"
    )


def _anchor(title: str) -> str:
    return re.sub(r"\W+", "-", title.lower())


def _verdicts(claims: Iterable[Claim], exhibits: set[str]) -> str:
    rows = []
    for claim in claims:
        verdict = claim.verdict
        kind = "holds" if verdict == "holds" else "part" if "when" in verdict else "not"
        link = claim.shown_by if claim.shown_by in exhibits else "equations"
        label = link.replace("-", " ")
        rows.append(
            f"<tr><td>“{html(claim.sentence)}” "
            f'<span class="place">{escape(claim.place)}</span></td>'
            f'<td class="verdict {kind}">{html(verdict)}</td>'
            f'<td>{html(claim.finding)} <a href="#{link}">→ {label}</a></td></tr>'
        )
    head = "<tr><th>sentence</th><th>verdict</th><th>what was found</th></tr>"
    return (
        f'<div class="wide"><table class="verdicts"><thead>{head}</thead>'
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _table(rows: Iterable[Iterable[str]], name: str) -> str:
    first, *others = rows
    head = "".join(f"<th>{html(cell)}</th>" for cell in first)
    body = "".join(
        f"<tr>{''.join(f'<td>{html(cell)}</td>' for cell in row)}</tr>" for row in others
    )
    return (
        f'<div class="wide"><table class="{name}"><thead><tr>{head}</tr></thead>'
        f"<tbody>{body}</tbody></table></div>"
    )


def _exhibit(exhibit: Exhibit, picture: bytes) -> str:
    readings = "".join(f"<li>{html(sentence)}</li>" for sentence in exhibit.readings)
    return (
        f'<h3 id="{exhibit.name}">{html(exhibit.title)}</h3>'
        f'<figure><div role="img" aria-label="{escape(exhibit.title)}">'
        f"{_inlined(picture, exhibit.name)}</div>"
        f"<figcaption>{html(exhibit.caption)}</figcaption></figure>"
        + (f"<ul>{readings}</ul>" if readings else "")
        + (_table(exhibit.table, "") if exhibit.table else "")
    )


def _inlined(picture: bytes, name: str) -> str:
    """The SVG element alone, its ids made the figure's own."""
    text = picture.decode()
    text = text[text.index("<svg") :]
    return re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", text)

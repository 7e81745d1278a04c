"""The report as a page of HTML that needs no other file, made from its Markdown."""

from __future__ import annotations

import re
from collections.abc import Mapping
from html import escape
from typing import Final

from latex2mathml.converter import convert
from markdown_it import MarkdownIt

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
figure { margin: .75rem 0 1rem; }
figure > div { background: #fff; border: 1px solid var(--line); border-radius: 6px;
  padding: .75rem; overflow-x: auto; }
figure svg { display: block; width: 100%; height: auto; min-width: 34rem; }
ul { padding-left: 1.2rem; max-width: 46rem; } li { margin: .3rem 0; }
table { margin: 1rem 0; border-collapse: collapse; font-size: .9rem; width: 100%; }
th { text-align: left; font-weight: 600; color: var(--soft); }
th, td { padding: .45rem .8rem .45rem 0; border-bottom: 1px solid var(--line);
  vertical-align: top; }
tbody tr:hover { background: var(--wash); }
td math { white-space: nowrap; line-height: 2; }
math { font-size: 1.08em; } mover > mo { font-weight: bold; }
td:nth-child(n+4) { font-variant-numeric: tabular-nums; }
td em { display: block; color: var(--soft); font-size: .82rem; font-style: normal; }
td strong { font-weight: 600; }
.holds { color: var(--good); } .part { color: var(--part); } .not { color: var(--bad); }
.done { color: var(--link); } .open { color: var(--soft); }
@media screen and (max-width: 52rem) {
  table, tbody, tr, td { display: block; } thead { display: none; }
  tr { border-bottom: 1px solid var(--line); padding: .5rem 0; }
  td { border: 0; padding: .1rem 0; } td math { font-size: .82em; } td:empty { display: none; }
  td[data-of]:not([data-of=""])::before { content: attr(data-of) ": "; color: var(--soft); } }
@page { size: A4; margin: 12mm; }
@media print {
  :root { color-scheme: light; --paper: #fff; --ink: #000; --soft: #444; --line: #bbb;
    --wash: #fff; --link: #0062a3; --good: #00795a; --part: #9a5b00; --bad: #b3261e; }
  body { font-size: 9pt; } nav { display: none; }
  main, p, ul { max-width: none; } main { padding: 0; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; }
  figure > div { overflow: visible; } figure svg { min-width: 0; }
  table { font-size: 7pt; } th, td { padding-right: .5em; overflow-wrap: anywhere; }
  td:first-child { overflow-wrap: normal; }
  td:nth-child(n) { white-space: normal; min-width: 0; } td em { font-size: 1em; } }
"""
_KINDS: Final = {
    **{"holds when": "part", "holds": "holds", "does not hold": "not", "not proved": "part"},
    **{"done here": "done", "not done here": "not", "not evaluated": "open"},
}
"""The class of a verdict by how it begins."""


def page(text: str, pictures: Mapping[str, bytes]) -> str:
    """A document as HTML: formulas as MathML, pictures in it, links to its sections at the head.

    Args:
        text: Markdown as GitHub reads it; a paragraph of a picture alone is a figure.
        pictures: The SVG of each figure, by the name of its file without ending.
    """
    plain = text.replace(r"\mathrm", r"\text")
    written = re.sub(r"\$([^$]+)\$", lambda tex: convert(tex[1], display="inline"), plain)
    body = MarkdownIt("commonmark", {"html": True}).enable("table").render(written)
    body = re.sub(
        r"<h([1-3])>(.*)</h\1>",
        lambda found: f'<h{found[1]} id="{anchor(found[2])}">{found[2]}</h{found[1]}>',
        body,
    )
    body = re.sub(
        r'<p><img src="[^"]*?([^"/]+)\.[a-z]+" alt="([^"]*)" /></p>',
        lambda found: _figure(pictures[found[1]], *found.groups()),
        body,
    )
    body = re.sub(
        rf"<strong>({'|'.join(_KINDS)})",
        lambda found: f'<strong class="{_KINDS[found[1]]}">{found[1]}',
        body,
    )
    body = re.sub(r"<table>.*?</table>", lambda found: _labelled(found[0]), body, flags=re.DOTALL)
    sections = re.findall(r'<h2 id="([^"]*)">(.*)</h2>', body)
    links = "".join(f'<a href="#{name}">{title}</a>' for name, title in sections)
    title = re.sub(r"<[^>]+>", "", re.findall(r"<h1[^>]*>(.*)</h1>", body)[0])
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n<main>\n"
        + body.replace("<h2", f"<nav>{links}</nav>\n<h2", 1)
        + "</main>\n</body>\n</html>\n"
    )


def _labelled(table: str) -> str:
    """A table whose cells know their heading, which stands before each where rows are stacked."""
    head, begin, rows = table.partition("<tbody>")
    names = re.findall(r"<th>(.*?)(?:<br>.*?)?</th>", head, re.DOTALL)

    def row(found: re.Match[str]) -> str:
        of = iter(names)
        return re.sub("<td>", lambda _: f'<td data-of="{next(of)}">', found[0])

    return head + begin + re.sub(r"<tr>.*?</tr>", row, rows, flags=re.DOTALL)


def anchor(title: str) -> str:
    """Return the anchor of a heading on GitHub: lower case, no punctuation, hyphens."""
    plain = re.sub(r"<[^>]+>", "", title).lower()
    return "".join(c for c in plain if c.isalnum() or c in " -_").replace(" ", "-")


def _figure(picture: bytes, name: str, title: str) -> str:
    """The SVG element alone, its ids made the figure's own."""
    svg = picture.decode()
    svg = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", svg[svg.index("<svg") :])
    return f'<figure><div role="img" aria-label="{escape(title)}">{svg}</div></figure>'

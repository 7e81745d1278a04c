"""The whole report: made once, then laid out as a page of HTML or as Markdown for the docs.

Every number in it is computed from stated seeds, so that it comes out the same each time.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING, Final, TypeVar

import numpy as np
import xarray as xr

from pindrive.paper import analysis, baseline, equations, maps, motions, population, sensitivity
from pindrive.paper.claims import claims
from pindrive.paper.exhibit import at_most, html, listed, markdown
from pindrive.paper.population import Claim, Facts

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from pindrive.paper.equations import Row
    from pindrive.paper.exhibit import Exhibit
    from pindrive.paper.population import Claim


T = TypeVar("T")

TITLE: Final = "“Dynamics of tactile device drive”: reproduced, corrected and answered"

PAGE: Final = "paper.html"
"""The name of the page."""

STEPS, FIGURES = 11, 11
"""How often `make` tells its progress, and how many exhibits it makes."""


@dataclass(frozen=True)
class Section:
    """A heading of the report, and what stands under it."""

    title: str
    text: str
    exhibits: tuple[Exhibit, ...]


@dataclass(frozen=True)
class Report:
    """What the report says, not yet how it looks."""

    rows: list[Row]
    claims: list[Claim]
    sections: tuple[Section, ...]

    @cached_property
    def exhibits(self) -> tuple[Exhibit, ...]:
        """All figures, in order."""
        return tuple(e for section in self.sections for e in section.exhibits)

    @property
    def summary(self) -> str:
        """The result in a paragraph."""
        count = Counter(claim.verdict.split(" when ")[0] for claim in self.claims)
        whole = sum(c.verdict == "holds" for c in self.claims)
        wrong = [row.number for row in self.rows if row.right]
        return (
            f"Of {len(self.claims)} sentences of its analysis, results and conclusions, {whole} "
            f"hold, {count['holds'] - whole} hold under a condition that they do not name, and "
            f"{count['does not hold']} do not hold. Of its equations, ({'), ('.join(wrong)}) need "
            "correction; corrected, all agree with the exact simulator to rounding, until friction "
            "first reverses. When that is, which the paper calls impossible to say analytically, "
            "is the exact root of (21)."
        )

    @property
    def method(self) -> str:
        """On what the equations and the sentences were tried."""
        return (
            f"Tried on {population.COUNT} random releases, seed {population.SEED}: "
            f"{population.RANGES}. Undamped ones: {population.UNDAMPED_RANGES}. The finger's "
            "friction, where there is one, is 0–10 mN. Exact means `pindrive.simulate`: closed "
            "forms between events, events by root isolation."
        )

    def equation_cells(self) -> list[tuple[str, ...]]:
        """The table of equations: headings, and a row each; formulas as TeX between dollars."""
        headings = ("", "as printed\nright form", "compared", "printed off by", "right off by")
        table: list[tuple[str, ...]] = [headings]
        for row in self.rows:
            forms = f"${row.printed}$\n" + (f"${row.right}$" if row.right else "as printed")
            off = f"{row.off_printed:.2g}" if row.right else ""
            table.append(
                (f"({row.number})", forms, row.against, off, f"${at_most(row.off_right)}$")
            )
        return table

    def slips(self) -> str:
        """What else is wrong with the text around the equations."""
        return (
            "Beside these: (1) gives F_1 to the plate and F_2 to the finger, the analysis then "
            "says "
            "F_1 = 0 and keeps the plate's friction as F_2; (22) is said to follow from (17) and "
            "follows from (21); v_p is defined twice."
        )

    def trials(self) -> xr.Dataset:
        """The table of equations and the verdicts as data."""
        return xr.Dataset(
            {
                "off_printed": ("equation", [row.off_printed for row in self.rows], {"units": "1"}),
                "off_right": ("equation", [row.off_right for row in self.rows], {"units": "1"}),
                "trials": ("sentence", [claim.true.size for claim in self.claims]),
                "true": ("sentence", [int(np.sum(claim.true)) for claim in self.claims]),
                "verdict": ("sentence", [claim.verdict for claim in self.claims]),
            },
            coords={
                "equation": [row.number for row in self.rows],
                "sentence": [claim.sentence for claim in self.claims],
            },
            attrs={
                "title": "Largest deviation of each equation, and verdicts",
                "comment": self.method,
            },
        )

    def files(self, step: Callable[[str], None] = lambda _: None) -> dict[str, bytes]:
        """Everything that `pindrive paper --out` writes, by its path in the folder.

        Args:
            step: told what comes next, once for each exhibit.
        """
        found: dict[str, bytes] = {}
        pictures: dict[str, bytes] = {}
        for exhibit in self.exhibits:
            step(f"drawing {exhibit.name}")
            drawn = exhibit.pictures()
            pictures[exhibit.name] = drawn["svg"]
            for ending, picture in drawn.items():
                found[f"figures/{exhibit.name}.{ending}"] = picture
            found[f"data/{exhibit.name}.nc"] = exhibit.netcdf()
        file = BytesIO()
        self.trials().to_netcdf(file, engine="h5netcdf")
        found["data/equations-and-verdicts.nc"] = file.getvalue()
        found[PAGE] = page(self, pictures).encode()
        return found


def make(step: Callable[[str], None] = lambda _: None) -> Report:
    """Compute the report.

    Args:
        step: told what comes next, `STEPS` times.
    """

    def doing(what: str, how: Callable[[], T]) -> T:
        step(what)
        return how()

    facts = Facts(population.damped())
    rows = doing("trying the equations", lambda: equations.rows(facts))
    found = doing("trying the sentences", lambda: claims(facts, rows))
    figure_4 = doing("Figure 4", motions.displacement)
    figure_2 = doing("Figure 2", motions.velocity)
    figure_3 = doing("Figure 3", motions.model)
    curves = doing("one parameter at a time", sensitivity.curves)
    of_maps = doing("two parameters at a time", maps.time_and_displacement)
    phase = doing("phase and amplitude", analysis.phase_and_amplitude)
    reversal = doing("the first reversal", analysis.first_reversal)
    steady = doing("steady state and rest", analysis.steady_and_rest)
    slips = doing("printed forms", analysis.printed_forms)
    names = [p.name for p in sensitivity.PARAMETERS]
    return Report(
        rows,
        found,
        (
            Section(
                "The paper's figures",
                "Figure 1 is a sketch of the device and no result.",
                (figure_2, figure_3, figure_4),
            ),
            Section(
                "The question that the paper poses",
                "How do the time of the transitional period and the maximum displacement depend on "
                f"{listed(names)}? The paper sets this as its problem and answers in words.",
                (sensitivity.settling(curves), sensitivity.displacement(curves), *of_maps),
            ),
            Section(
                "The analysis, drawn",
                "What equations (7) to (26) and the last paragraph of the results say.",
                (phase, reversal, steady, slips),
            ),
        ),
    )


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
        "equations": "Its equations, corrected",
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
        _html_table(report.equation_cells(), "equations"),
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
        _html_table([("", "value", "meaning", "source"), *baseline.SOURCES], ""),
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


def _html_table(rows: Iterable[Iterable[str]], name: str) -> str:
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
        + (_html_table(exhibit.table, "") if exhibit.table else "")
    )


def _inlined(picture: bytes, name: str) -> str:
    """The SVG element alone, its ids made the figure's own."""
    text = picture.decode()
    text = text[text.index("<svg") :]
    return re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", text)


NAME: Final = "paper.md"
IMAGES: Final = "images/paper"
_EQUATIONS: Final = "Its equations, corrected"


def text(report: Report) -> str:
    """The document, whose pictures are at `IMAGES` beside it."""
    lines = [
        f"# {TITLE}",
        "<!-- Made by `pindrive paper --docs docs`; do not edit. -->",
        markdown(report.summary),
        "`pindrive paper --out DIR` writes all this as one page, with every figure as SVG and PNG "
        "and its data as NetCDF. `pindrive.paper` has the equations as functions.",
        "## Its sentences, judged",
        _markdown_table(
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
        _markdown_table(report.equation_cells()),
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
            lines += [_markdown_table(exhibit.table)] if exhibit.table else []
    lines += [
        "## What was assumed",
        "The paper gives three damping factors and no other value. Unless a figure says otherwise:",
        _markdown_table([("", "value", "meaning", "source"), *baseline.SOURCES]),
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


def _markdown_table(rows: Iterable[Iterable[str]]) -> str:
    first, *others = ([markdown(cell) for cell in row] for row in rows)
    lines = [first, ["---"] * len(first), *others]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)

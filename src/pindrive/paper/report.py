"""The whole report: made once, then written as Markdown, for the docs and for its page of HTML.

Every number in it is computed from stated seeds, so that it comes out the same each time.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from typing import Final, TypeVar

import numpy as np
import xarray as xr

from pindrive.paper import (
    analysis,
    baseline,
    device,
    equations,
    maps,
    motions,
    population,
    sensitivity,
)
from pindrive.paper.baseline import FACTORS
from pindrive.paper.claims import claims
from pindrive.paper.equations import GOOD, Row
from pindrive.paper.exhibit import Exhibit, at_most, markdown
from pindrive.paper.page import anchor, page
from pindrive.paper.population import Claim, Facts
from pindrive.paper.wording import TEXTS, worded

T = TypeVar("T")

TITLE: Final = "“Dynamics of tactile device drive”: reproduced, corrected and answered"

PAGE: Final = "paper.html"
"""The name of the page."""

STEPS, FIGURES = 12, 12
"""Number of progress reports of `make`, and number of its exhibits."""


@dataclass(frozen=True)
class Section:
    """A heading of the report, and what stands under it."""

    title: str
    text: str
    exhibits: tuple[Exhibit, ...]


@dataclass(frozen=True)
class Report:
    """Content of the report, without its layout."""

    rows: list[Row]
    claims: list[Claim]
    sections: tuple[Section, ...]

    @cached_property
    def exhibits(self) -> dict[str, Exhibit]:
        """All figures by name, in order."""
        return {e.name: e for section in self.sections for e in section.exhibits}

    @property
    def summary(self) -> str:
        """The result in a paragraph."""
        count = Counter(claim.verdict.split(" when ")[0] for claim in self.claims)
        whole = sum(c.verdict == "holds" for c in self.claims)
        return worded(
            TEXTS["report"]["summary"],
            evaluated=count["holds"] + count["does not hold"] + count["not proved"],
            whole=whole,
            conditional=count["holds"] - whole,
            false=count["does not hold"],
            unproved=count["not proved"],
            done=count["done here"],
            outside=count["not evaluated"],
            wrong="), (".join(row.number for row in self.rows if row.right),
        )

    @property
    def method(self) -> str:
        """Trials of the equations and statements."""
        return worded(
            TEXTS["report"]["method"],
            count=population.COUNT,
            seed=population.SEED,
            ranges=population.RANGES,
            undamped=population.UNDAMPED_RANGES,
        )

    def equation_cells(self) -> list[tuple[str, ...]]:
        """The table of equations: headings, and a row each; formulas as TeX between dollars."""
        table: list[tuple[str, ...]] = [("", "as printed\nright form", "compared", "largest error")]
        for row in self.rows:
            forms = f"${row.printed}$\n" + (f"${row.right}$" if row.right else "as printed")
            off = f"${at_most(row.off_right)}$"
            if row.good:
                off = (
                    f"printed: {row.off_printed:.2g}, {row.off_lightly_damped:.2g} for "
                    f"ζ ≤ {max(FACTORS):g}; at most {GOOD:g}: {row.good}\nright: {off}"
                )
            elif row.right:
                off = f"printed: no number\nright: {off}"
            table.append((f"({row.number})", forms, row.against, off))
        return table

    def trials(self) -> xr.Dataset:
        """The table of equations and the verdicts as data."""
        evaluated = [claim for claim in self.claims if claim.true is not None]
        trials = [np.asarray(claim.true) for claim in evaluated]
        return xr.Dataset(
            {
                "off_printed": ("equation", [row.off_printed for row in self.rows], {"units": "1"}),
                "off_lightly_damped": (
                    "equation",
                    [row.off_lightly_damped for row in self.rows],
                    {"units": "1"},
                ),
                "good": ("equation", [row.good for row in self.rows]),
                "off_right": ("equation", [row.off_right for row in self.rows], {"units": "1"}),
                "trials": ("sentence", [true.size for true in trials]),
                "true": ("sentence", [int(true.sum()) for true in trials]),
                "verdict": ("sentence", [claim.verdict for claim in evaluated]),
            },
            coords={
                "equation": [row.number for row in self.rows],
                "sentence": [claim.sentence for claim in evaluated],
            },
            attrs={
                "title": "Largest deviation of each equation, and verdicts",
                "comment": self.method,
            },
        )

    def files(self, step: Callable[[str], None] = lambda _: None) -> dict[str, bytes]:
        """Everything that `pindrive paper -o` writes, by its path in the folder.

        Args:
            step: Function called with the next step, once for each exhibit.
        """
        from pindrive import __version__

        found: dict[str, bytes] = {}
        pictures: dict[str, bytes] = {}
        for exhibit in self.exhibits.values():
            step(f"drawing {exhibit.name}")
            drawn = exhibit.pictures()
            pictures[exhibit.name] = drawn["svg"]
            for ending, picture in drawn.items():
                found[f"figures/{exhibit.name}.{ending}"] = picture
            found[f"data/{exhibit.name}.nc"] = exhibit.netcdf()
        file = BytesIO()
        self.trials().to_netcdf(file, engine="h5netcdf")
        found["data/equations-and-verdicts.nc"] = file.getvalue()
        about = (
            f"Computed by pindrive {__version__}, `pindrive paper`; the data of each figure are "
            "beside this page as NetCDF."
        )
        found[PAGE] = page(text(self, about), pictures).encode()
        return found


def make(step: Callable[[str], None] = lambda _: None) -> Report:
    """Compute the report.

    Args:
        step: Function called with the next step, `STEPS` times.
    """

    def doing(what: str, how: Callable[[], T]) -> T:
        step(what)
        return how()

    facts = Facts(population.damped())
    rows = doing("trying the equations", lambda: equations.rows(facts))
    found = doing("trying the sentences", lambda: claims(facts, rows))
    figure_1 = doing("Figure 1", device.device)
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
    exhibits = {
        "device": (figure_1,),
        "problem": (sensitivity.settling(curves), sensitivity.displacement(curves), *of_maps),
        "figures": (figure_2, figure_3, figure_4),
        "analysis": (phase, reversal, steady, slips),
    }
    return Report(
        rows,
        found,
        tuple(
            Section(of["title"], worded(of["text"], parameters=names), exhibits[name])
            for name, of in TEXTS["sections"].items()
        ),
    )


NAME: Final = "paper.md"
IMAGES: Final = "images/paper"
_EQUATIONS: Final = "Equations, corrected"


def text(report: Report, about: str = TEXTS["report"]["data"]) -> str:
    """The document, whose pictures are at `IMAGES` beside it; `about` says what else there is."""
    lines = [
        f"# {TITLE}",
        "<!-- Made by `pindrive paper --docs docs`; do not edit. -->",
        markdown(report.summary),
        about,
    ]
    *before, analysis = report.sections
    for section in before:
        lines += _section(section)
    lines += [
        "## Statements, evaluated",
        _markdown_table(
            [
                ("statement", "verdict", "evidence"),
                *(
                    (
                        f"“{claim.sentence}” *{claim.place}*",
                        f"**{claim.verdict}**",
                        f"{claim.finding} {_link(report, claim.shown_by)}".strip(),
                    )
                    for claim in report.claims
                ),
            ]
        ),
        f"## {_EQUATIONS}",
        markdown(report.method),
        _markdown_table(report.equation_cells()),
        markdown(TEXTS["report"]["slips"]),
        *_section(analysis),
        "## Assumptions",
        TEXTS["report"]["assumptions"],
        _markdown_table([("", "value", "meaning", "source"), *baseline.SOURCES]),
    ]
    return "\n\n".join(line for line in lines if line) + "\n"


def _section(section: Section) -> list[str]:
    lines = [f"## {section.title}", markdown(section.text)]
    for exhibit in section.exhibits:
        lines += [
            f"### {markdown(exhibit.title)}",
            f"![{exhibit.title}]({IMAGES}/{exhibit.name}.png)",
            markdown(exhibit.caption),
            "\n".join(f"- {markdown(sentence)}" for sentence in exhibit.readings),
        ]
        lines += [_markdown_table(exhibit.table)] if exhibit.table else []
    return lines


def files(report: Report, step: Callable[[str], None] = lambda _: None) -> dict[str, bytes]:
    """Everything that `pindrive paper --docs` writes, by its path in the folder."""
    found = {NAME: text(report).encode()}
    for exhibit in report.exhibits.values():
        step(f"drawing {exhibit.name}")
        found[f"{IMAGES}/{exhibit.name}.png"] = exhibit.pictures()["png"]
    return found


def _link(report: Report, name: str) -> str:
    """To an exhibit's heading, where there is one."""
    if not name:
        return ""
    titles = {exhibit.name: exhibit.title for exhibit in report.exhibits.values()}
    title = markdown(titles.get(name, _EQUATIONS))
    return f"[→ {name.replace('-', ' ')}](#{anchor(title)})"


def _markdown_table(rows: Iterable[Iterable[str]]) -> str:
    first, *others = ([markdown(cell) for cell in row] for row in rows)
    lines = [first, ["---"] * len(first), *others]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)

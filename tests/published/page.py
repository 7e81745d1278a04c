"""The part of docs/validation.md that the cases write."""

from __future__ import annotations

from math import floor, log10
from pathlib import Path
from typing import Final

from .case import Case, Number

ROOT: Final = Path(__file__).resolve().parents[2]
PAGE: Final = ROOT / "docs" / "validation.md"
IMAGES: Final = ROOT / "docs" / "images"
BEGIN: Final = "<!-- python3 run.py validation writes from here -->\n"
END: Final = "<!-- to here -->\n"


def picture(case: Case) -> Path:
    """Return the place of the figure of a case."""
    return IMAGES / f"validation-{case.key}.png"


def section(case: Case) -> str:
    """A case as a section in Markdown."""
    source = case.source
    year = f", {source['year']}" if "year" in source else ""
    where = ", ".join(
        f"<{piece.split()[0]}> {' '.join(piece.split()[1:])}".strip()
        if piece.startswith("https:")
        else piece
        for piece in source["where"].split("; ")
    )
    lines = [
        f"### {case.title}",
        "",
        case.about,
        "",
        f"Source: {source['authors']}{year}: *{source['title']}*; {where}. {source['numbers']}",
        "",
        f"![{case.title}: the motion beside the published values, and the difference of each]"
        f"({picture(case).relative_to(PAGE.parent).as_posix()})",
        "",
        "| | quantity | published | pindrive | difference | allowed |",
        "|---|---|---|---|---|---|",
    ]
    lines += [_row(i, number) for i, number in enumerate(case.numbers, start=1)]
    reasons = dict.fromkeys(number.because for number in case.numbers)
    lines += ["", f"Allowed: {'; '.join(reasons)}."]
    if case.remarks:
        lines += ["", case.remarks]
    if case.missing:
        lines += ["", f"**Not covered.** {case.missing}"]
    return "\n".join(lines) + "\n"


def with_cases(page: str, cases: list[Case]) -> str:
    """The page with its part on the cases written anew."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"{PAGE.name}: lacks the line {(END if begin else BEGIN).strip()}")
    counted = [number for case in cases for number in case.numbers]
    agreeing = sum(number.agrees for number in counted)
    summary = (
        f"{len(counted)} numbers of {len(cases)} cases: {agreeing} agree with pindrive within what "
        f"their source justifies, {len(counted) - agreeing} do not; those are marked †, with the "
        "reason.\n"
    )
    sections = [summary, *map(section, cases)]
    return before + begin + "\n" + "\n".join(sections) + "\n" + end + after


def _row(i: int, number: Number) -> str:
    mark = "" if number.agrees else " †"
    cells = (
        str(i),
        number.what.replace("|", "\\|"),
        number.published,
        computed(number),
        _difference(number) + mark,
        f"{number.allowed:.1g}",
    )
    return f"| {' | '.join(cells)} |"


def computed(number: Number) -> str:
    """Return enough decimals to tell it from the published number, in equal notation."""
    mantissa, marked, exponent = number.published.partition("e")
    scale = int(exponent or 0)
    if number.allowed == 0.0 or number.difference == 0.0:
        return number.published if number.difference == 0.0 else f"{number.computed!r}"
    decimals = max(len(mantissa.partition(".")[2]), 1 - _power(number.difference) + scale)
    value = f"{number.computed / 10.0**scale:.{min(decimals, 17)}f}"
    return f"{value}e{exponent}" if marked else value


def _difference(number: Number) -> str:
    return "0" if number.difference == 0.0 else f"{number.difference:+.1e}"


def _power(value: float) -> int:
    return floor(log10(abs(value)))

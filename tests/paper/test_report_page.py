"""The report on the paper as a reader gets it: its page needs nothing, docs and command agree."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from html import escape
from html.parser import HTMLParser
from io import BytesIO
from pathlib import Path
from urllib.parse import unquote

import pytest
import xarray as xr
from PIL import Image
from typer.testing import CliRunner

from pindrive.cli.app import app
from pindrive.paper import report
from pindrive.paper.exhibit import markdown as as_markdown
from pindrive.paper.exhibit import summary
from pindrive.paper.page import anchor
from pindrive.paper.page import page as as_page
from pindrive.paper.report import Report
from pindrive.paper.sensitivity import PARAMETERS

DOCS = Path(__file__).resolve().parents[2] / "docs"
REMAKE = "make them anew: pindrive paper --docs docs"


# ---- the docs agree with the command -------------------------------------------------------------


def test_docs_equal_the_output_of_the_command(made: Report) -> None:
    assert (DOCS / report.NAME).read_text("utf-8") == report.text(made), REMAKE


def test_the_docs_pictures_show_the_same_data(made: Report) -> None:
    """Each picture carries the summary of the data that it was drawn from; pixels may differ."""
    folder = DOCS / report.IMAGES
    assert {p.name for p in folder.iterdir()} == {f"{name}.png" for name in made.exhibits}, REMAKE
    for e in made.exhibits.values():
        with Image.open(folder / f"{e.name}.png") as picture:
            shown = json.loads(picture.info["Data"])
        now = summary(e.data)
        assert shown.keys() == now.keys(), REMAKE
        for name, numbers in now.items():
            assert shown[name] == pytest.approx(numbers, rel=1e-5, abs=1e-12), (e.name, REMAKE)


def test_a_change_of_data_shows_in_the_summary(made: Report) -> None:
    data = made.exhibits["first-reversal"].data
    assert summary(data) != summary(data.assign(limit=1.001 * data.limit))
    assert summary(data) != summary(data.assign(limit=data.limit.where(data.limit > 0.5)))


def test_the_docs_tables_are_whole() -> None:
    """Each row of a table has the number of cells of its heading."""
    text = (DOCS / report.NAME).read_text("utf-8")
    tables = re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE)
    assert len(tables) == 7
    for table in tables:
        assert len({row.count("|") for row in table.splitlines()}) == 1, table[:200]


def test_links_of_the_docs_exist() -> None:
    text = (DOCS / report.NAME).read_text("utf-8")
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    plain = (re.sub(r"</?sub>", "", heading).lower() for heading in headings)
    anchors = {re.sub(r"[^\w\- ]", "", heading).replace(" ", "-") for heading in plain}
    links = re.findall(r"\]\(([^)]+)\)", text)
    assert len(links) > 20
    for link in links:
        assert link.removeprefix("#") in anchors or (DOCS / link).is_file(), link


# ---- the page ------------------------------------------------------------------------------------


class Reader(HTMLParser):
    """Links and ids of a page, and its requests to other places."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.foreign: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.tags: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            value = value or ""
            if name == "id":
                self.ids.append(value)
            elif name in ("src", "href", "xlink:href", "data", "action"):
                if value.startswith("#"):
                    self.links.append(unquote(value[1:]))
                elif not value.startswith("data:"):
                    self.foreign.append(value)


def test_the_page_needs_nothing_else(page: str) -> None:
    found = Reader(page)
    assert found.foreign == []
    assert not {"script", "link", "iframe", "object"} & set(found.tags)
    assert "@import" not in page
    assert set(re.findall(r"url\((?!#)", page)) == set()


def test_the_page_holds_every_figure_and_its_own_links(page: str, made: Report) -> None:
    found = Reader(page)
    assert found.tags.count("svg") == report.FIGURES
    assert len(found.ids) == len(set(found.ids))
    assert set(found.links) <= set(found.ids)
    assert set(re.findall(r"url\(#([^)]+)\)", page)) <= set(found.ids)
    assert {anchor(as_markdown(e.title)) for e in made.exhibits.values()} <= set(found.ids)
    assert all(f'aria-label="{escape(e.title)}"' in page for e in made.exhibits.values())
    assert found.tags.count("math") > 40


def test_the_page_has_every_equation_and_every_sentence(page: str, made: Report) -> None:
    numbers = {int(n) for row in made.rows for n in re.findall(r"\d+", row.number)}
    assert numbers == set(range(1, 27))
    for claim in made.claims:
        assert f"“{as_html(claim.sentence)}” <em>{claim.place}</em>" in page
        assert as_html(claim.verdict) in page
    assert len(set(re.findall(r'<strong class="(\w+)">', page))) == 5
    for e in made.exhibits.values():
        assert all(as_html(sentence) in page for sentence in (*e.readings, e.caption))


def test_the_velocity_is_labelled_as_computed(files: dict[str, bytes], made: Report) -> None:
    """The measurement of the paper's Figure 2 is not printed in it."""
    assert "computed, not measured" in files["figures/figure-2-velocity.svg"].decode()
    caption = made.exhibits["figure-2-velocity"].caption
    assert caption.startswith("Computed. The paper's Figure 2 is a measurement")


def test_the_diagram_names_its_outputs_and_ties_its_blocks(
    files: dict[str, bytes], made: Report
) -> None:
    drawn = files["figures/figure-3-model.svg"].decode()
    for word in ("displacement", "velocity", "acceleration"):
        assert word in drawn
    blocks = [row[0] for row in made.exhibits["figure-3-model"].table]
    assert blocks == ["block", *"12345678", "output", "output", "output"]


def test_the_page_explains_before_it_judges(page: str) -> None:
    headings = re.findall(r"<h2 [^>]*>(.*)</h2>", page)
    assert headings == [
        "The device, its frame and the symbols",
        "Problem of the paper",
        "Figures of the paper",
        "Statements, evaluated",
        "Equations, corrected",
        "Figures of the analysis",
        "Assumptions",
    ]


def test_every_symbol_stands_once(made: Report) -> None:
    _, *rows = made.exhibits["figure-1-device"].table
    symbols = [symbol for row in rows for symbol in row[0].strip("$").split(r",\ ")]
    assert len(symbols) == len(set(symbols))
    of_the_paper = {row[0]: row[3] for row in rows}
    assert of_the_paper["$F_p$"] == "$F_1$ in (1), $F_2$ from (2) on"
    assert of_the_paper["$F_f$"] == "$F_2$ in (1), $F_1 = 0$ from (2) on"
    for p in PARAMETERS:
        assert p.symbol in symbols


def test_print_lets_nothing_scroll(page: str) -> None:
    """Parts that scroll on the screen are complete on paper."""
    screen, _, print_rules = page.partition("@media print")
    scrolling = re.findall(r"([^{}\n]+) \{[^}]*overflow-x: auto", screen)
    assert scrolling == ["figure > div"], "tables are stacked where they find no room"
    assert "figure > div { overflow: visible }" in print_rules.replace("; }", " }")
    assert "figure svg { min-width: 0" in print_rules
    assert "white-space: normal" in print_rules
    assert "td:first-child { overflow-wrap: normal; }" in print_rules, "numbers of equations"


# ---- files ---------------------------------------------------------------------------------------


def test_each_figure_comes_as_svg_png_and_data(files: dict[str, bytes], made: Report) -> None:
    assert len(made.exhibits) == report.FIGURES
    for e in made.exhibits.values():
        assert files[f"figures/{e.name}.svg"].startswith(b"<?xml")
        with Image.open(BytesIO(files[f"figures/{e.name}.png"])) as picture:
            assert picture.width > 1000
        with xr.open_dataset(BytesIO(files[f"data/{e.name}.nc"]), engine="h5netcdf") as data:
            xr.testing.assert_equal(data.load(), e.data)
            assert data.attrs["title"] == e.title


def test_the_data_have_units(files: dict[str, bytes]) -> None:
    of_their_own = {"value", "factor"}  # in units of each parameter; of unknown unit
    for name, content in files.items():
        if name.endswith(".nc"):
            with xr.open_dataset(BytesIO(content), engine="h5netcdf") as data:
                for key, variable in data.variables.items():
                    if variable.dtype.kind == "f" and key not in of_their_own:
                        assert variable.attrs.get("units"), (name, key)


def test_progress_is_reported_as_often_as_announced(
    made: Report, files: dict[str, bytes], steps: list[str]
) -> None:
    assert len(steps) == report.STEPS + report.FIGURES


def as_html(text: str) -> str:
    """A sentence as the page has it."""
    body = as_page(f"# title\n\n{as_markdown(text)}\n", {}).partition("<p>")[2]
    return body.partition("</p>")[0]


def test_a_page_is_made_from_markdown() -> None:
    text = r"φ′_0 < x_m,a: $\mathrm{sign}\,\dot x$, `first_time` & more"
    assert as_markdown(text) == (
        r"φ′<sub>0</sub> < x<sub>m,a</sub>: $\mathrm{sign} \dot x$, `first_time` & more"
    )
    shown = as_html(text)
    assert shown.startswith("φ′<sub>0</sub> &lt; x<sub>m,a</sub>: <math")
    assert "<mtext>sign</mtext>" in shown
    assert shown.endswith("<code>first_time</code> &amp; more")
    for verdict, kind in (
        ("holds", "holds"),
        ("holds when x", "part"),
        ("does not hold", "not"),
        ("not proved", "part"),
        ("done here", "done"),
        ("not evaluated", "open"),
    ):
        assert as_html(f"**{verdict}**") == f'<strong class="{kind}">{verdict}</strong>'
    table = as_page("# t\n\n| a | b<br>c |\n|---|---|\n| 1 | 2 |\n", {})
    assert re.findall(r'<td data-of="(\w)">(\d)</td>', table) == [("a", "1"), ("b", "2")]
    svg = b'<?xml?><svg id="a"><use href="#a"/></svg>'
    page = as_page("# Title\n\n## A _part_, (1)\n\n![what](folder/name.png)\n", {"name": svg})
    assert '<nav><a href="#a-part-1">A <em>part</em>, (1)</a></nav>\n<h2 id="a-part-1">' in page
    assert 'aria-label="what"><svg id="name-a"><use href="#name-a"/></svg>' in page


# ---- the command ---------------------------------------------------------------------------------


@pytest.fixture
def quick(made: Report, files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The command with what it computes already there."""
    monkeypatch.setattr(report, "make", lambda step: made)
    monkeypatch.setattr(Report, "files", lambda self, step: files)
    pictures = {"images/paper/a.png": b"picture"}
    monkeypatch.setattr(report, "files", lambda *_: {report.NAME: b"text", **pictures})
    yield


@pytest.mark.usefixtures("quick")
def test_the_command_writes_the_report(tmp_path: Path, files: dict[str, bytes]) -> None:
    out, docs = tmp_path / "new" / "report", tmp_path / "docs"
    result = CliRunner().invoke(app, ["paper", "-o", str(out), "--docs", str(docs)])
    assert result.exit_code == 0, result.output
    assert "3 hold, 9 hold under an additional condition" in result.stdout
    written = {str(p.relative_to(out)) for p in out.rglob("*") if p.is_file()}
    assert written == {str(Path(name)) for name in files}
    assert (out / report.PAGE).read_bytes() == files[report.PAGE]
    assert (docs / report.NAME).read_bytes() == b"text"
    assert (docs / "images/paper/a.png").is_file()


def test_the_command_refuses_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(report, "make", lambda step: pytest.fail("computed all the same"))
    (tmp_path / "file").write_text("mine")
    for arguments, words in (
        (["-o", str(tmp_path / "file")], f"{tmp_path / 'file'}: cannot be written"),
        (["--docs", str(tmp_path / "file/deep")], "cannot be written: file is not a folder"),
    ):
        result = CliRunner().invoke(app, ["paper", *arguments])
        assert result.exit_code == 2
        (line,) = result.stderr.splitlines()
        assert words in line
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_an_interrupt_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(step: object) -> Report:
        raise KeyboardInterrupt

    monkeypatch.setattr(report, "make", interrupted)
    result = CliRunner().invoke(app, ["paper", "-o", str(tmp_path / "new")])
    assert result.exit_code == 130
    assert list(tmp_path.iterdir()) == []

"""The site: what its pages run prints what they say, and what it is made of is there."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from itertools import pairwise
from pathlib import Path
from subprocess import check_call
from types import ModuleType

import pytest

from page_run import NOT_RUN, Run, agrees, is_excerpt
from pages import DOCS, FILES, ROOT, blocks, file_of, pages

BLOCKS = {page.relative_to(ROOT).as_posix(): blocks(page) for page in pages()}
EXCEPTIONS = {
    ("docs/cluster.md", "sbatch"),
    ("docs/julia.md", "julia"),
    ("docs/matlab.md", "matlab"),
}
"""Pages with blocks that cannot be run here, and their language; the page says why."""
LONGER = {
    ".venv/bin/pindrive scan examples/tactile-reader.toml --text ": (
        "--set array.columns=2 --set array.rows=2"
    ),
    '.venv/bin/pindrive scan device.toml --text "Hello" --plot ': (
        "--set array.columns=2 --set array.rows=2"
    ),
    ".venv/bin/pindrive sensitivity examples/": "--rows 128",
    ".venv/bin/pindrive speed examples/tactile-reader.toml --plot ": (
        '--pitch "4 mm" --slowest "0.05 m/s" --fastest "0.2 m/s"'
    ),
}
"""First words of slow commands, with additional options."""
COARSER = {
    "examples/tactile-reader-study.toml": (
        ("count = 19", "count = 4"),
        ("count = 13", "count = 3"),
    ),
    "examples/oblique-hand-study.toml": (("count = 46", "count = 7"),),
    "examples/belt-study.toml": (("count = 60", "count = 7"),),
    "examples/forced-study.toml": (("count = 120", "count = 7"),),
}
"""Examples of which the pages have a copy with fewer points, to be quick."""
WARNED = {
    "README.md": "the pins push the hand with up to 0.786 N",
    "docs/studies.md": "the plate's friction coefficient",
    "docs/devices.md": "the pins push the hand with up to ",
}
"""Pages whose commands warn, and of what."""
LIBRARY = BLOCKS["docs/c.md"][0].text.splitlines()
"""The commands that install the C interface, which a fixture runs."""


def test_truncation_is_within_its_bound() -> None:
    assert agrees("a  \nb\nc\n", "a\nb\nc\n")
    assert agrees("a\nb\nc\n", "a\n...\n")
    assert not agrees("a\nb\nc\n", "a\nc\n")
    assert not agrees("a\nb\nc\n", "b\n...\n")
    assert is_excerpt("a\n\nc\n", "a\nb\nc\n")
    assert not is_excerpt("c\na\n", "a\nb\nc\n")


@pytest.mark.parametrize("page", [page for page, found in BLOCKS.items() if found])
def test_page_prints_its_text(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """The blocks of a page run in sequence in one folder, and print the next block of text."""
    text = "".join(block.text for block in BLOCKS[page])
    if sys.platform == "win32" and re.search(r"^(cmake|cc|dask) ", text, re.M):
        pytest.skip("its commands are those of other systems")
    if "~/.local/lib" in text or LIBRARY[0] in text:
        (tmp_path / ".local").symlink_to(request.getfixturevalue("c_library"))
    (tmp_path / "page").mkdir()
    monkeypatch.chdir(tmp_path / "page")
    done = Run(tmp_path, LONGER, COARSER, frozenset(LIBRARY))
    done.page(BLOCKS[page])
    expected = f"warning: {WARNED[page]}" if page in WARNED else None
    assert [line for line in done.warnings if not expected or not line.startswith(expected)] == []
    assert bool(done.warnings) == bool(expected)


def test_every_block_is_run_or_names_a_reason() -> None:
    found = [block for page in BLOCKS.values() for block in page]
    assert {block.language for block in found if not block.reason} <= {
        *FILES,
        "python",
        "sh",
        "text",
    }
    excused = [block for block in found if block.reason]
    assert {(block.page, block.language) for block in excused} == EXCEPTIONS
    assert all(len(block.reason.split()) > 4 for block in excused)


def test_every_text_was_printed_by_the_block_before_it() -> None:
    for page in BLOCKS.values():
        for before, block in pairwise([None, *page]):
            if block and block.language == "text":
                assert before and before.language in ("python", "sh") and not before.reason, block


def test_every_file_that_a_page_writes_is_used_on_it() -> None:
    for page in BLOCKS.values():
        for i, block in enumerate(page):
            if block.language in FILES and not block.reason:
                name = Path(file_of(block).partition("\n")[0])
                if (ROOT / name).is_file():
                    continue  # an excerpt of it
                places = {str(name), name.name, name.parts[0]}
                others = "".join(other.text for other in [*page[:i], *page[i + 1 :]])
                assert any(place in others for place in places), block


def test_commands_that_no_page_runs_are_there() -> None:
    """The help of run.py lists its commands."""
    said = subprocess.run(
        [sys.executable, ROOT / "run.py", "--help"], capture_output=True, text=True, check=True
    ).stdout
    listed = {*re.findall(r"^    python3 run\.py *(\S*)", said, re.M)}
    for page in BLOCKS.values():
        for block in page:
            for line in block.text.splitlines() if block.language == "sh" else ():
                if match := re.match(r"python3 run\.py ?(\S*)", line):
                    assert match[1] in listed or (not match[1] and "simulate" in listed), line
    assert all(len(reason.split()) > 3 for reason in NOT_RUN.values())


def test_pictures_are_small() -> None:
    pictures = {
        (page.parent / name).resolve()
        for page in pages()
        for name in re.findall(r"!\[[^]]*\]\(([^)]+\.png)\)", page.read_text("utf-8"))
    }
    assert len(pictures) > 20
    assert [path.name for path in pictures if path.stat().st_size > 600_000] == []


def test_every_page_is_on_the_site() -> None:
    """Pages of the first page exist; the site adds all further pages of its folder."""
    index = (DOCS / "index.md").read_text("utf-8")
    trees = re.findall(r"^```\{toctree\}\n(?::[^\n]*\n)+\n(.*?)^```$", index, re.M | re.S)
    named = [line for tree in trees for line in tree.split("\n") if line and line[0] != "%"]
    assert [name for name in named if not (DOCS / f"{name}.md").exists()] == []
    assert len(named) == len({*named})
    assert {f"reference/{path.stem}" for path in DOCS.glob("reference/*.md")} <= {*named}
    assert "% other pages" in index


def test_the_source_files_that_the_sections_of_the_theory_name_exist() -> None:
    theory = (DOCS / "theory.md").read_text("utf-8")
    sources = re.findall(r"^Source: .*?\n\n", theory, re.M | re.S)
    named = re.findall(r"`([\w/]+\.(?:hpp|py))`", "\n".join(sources))
    folders = (ROOT / "include" / "pindrive", ROOT / "src" / "pindrive")
    assert len(named) > 20
    assert [n for n in named if not any((folder / n).exists() for folder in folders)] == []


def test_the_sections_of_the_theory_that_sources_cite_exist() -> None:
    theory = (DOCS / "theory.md").read_text("utf-8")
    headings = re.findall(r"^### (\w+)\. ", theory, re.M)
    assert headings == [str(i + 1) for i in range(20)] + [*"ABCDEF"]
    sources = [p for f in ("include", "src", "tests") for p in (ROOT / f).rglob("*.[hcp]*")]
    pages = [page for page in DOCS.glob("*.md") if page.name != "theory.md"]
    cited = [
        (path, number)
        for path in [*sources, *pages]
        if path.suffix in (".hpp", ".cpp", ".py", ".md")
        for number in re.findall(
            r"theory(?:\.md)?\]?(?:\(theory\.md\))?, (?:sections? |appendix )(\w+)",
            path.read_text("utf-8"),
        )
    ]
    assert len(cited) > 15
    assert [(path, number) for path, number in cited if number not in headings] == []
    own = re.findall(r"(?:section|appendix) (\d+|[A-Z])\b", theory)
    assert len(own) > 5 and {*own} <= {*headings}


# ---- notebooks -----------------------------------------------------------------------------------


NOTEBOOKS = sorted(DOCS.glob("notebooks/*.md"))


def test_there_are_five_notebooks_and_code_is_executed_in_no_other_page() -> None:
    """Sphinx runs them when it makes the site; an error in a cell ends the build."""
    assert len(NOTEBOOKS) == 5
    assert "nb_execution_raise_on_error = True" in (DOCS / "conf.py").read_text("utf-8")
    for page in pages():
        has = bool(re.search(r"^```\{code", page.read_text("utf-8"), re.M))
        assert has == (page in NOTEBOOKS), page


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_a_notebook_shows_a_result_and_can_be_downloaded(page: Path) -> None:
    text = page.read_text("utf-8")
    cells = re.findall(r"^```\{code-cell\}\n(.*?)^```$", text, re.M | re.S)
    last = [cell.strip().splitlines()[-1] for cell in cells]
    assert any(re.fullmatch(r"[\w.\[\]\"]+(\(\))?", line) for line in last), "nothing is displayed"
    assert f"{{nb-download}}`{page.stem}.ipynb`" in text


@pytest.mark.parametrize("page", NOTEBOOKS, ids=lambda page: page.stem)
def test_the_cells_of_a_notebook_run(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without Jupyter: a renamed function fails here, in a second or two."""
    monkeypatch.chdir(tmp_path)
    cells = re.findall(r"^```\{code-cell\}\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S)
    names = {"shell": lambda line: check_call([sys.executable, "-m", *line.split()])}
    for number, cell in enumerate(cells):
        code = re.sub(r"^!(.*)$", r"shell('\1')", cell, flags=re.M)
        exec(compile(code, f"{page.name}, cell {number}", "exec"), names)


# ---- reference -----------------------------------------------------------------------------------


def documented() -> dict[str, list[str]]:
    """The names that the reference of Python has of each module."""
    names: dict[str, list[str]] = {}
    module = ""
    page = (DOCS / "reference" / "python.md").read_text("utf-8")
    for kind, name in re.findall(r"^\.\. (currentmodule|auto\w+):: ([\w.]+)$", page, re.M):
        if kind == "currentmodule":
            module = name
        else:
            names.setdefault(module, []).append(name)
    return names


def test_the_public_names_are_in_the_reference() -> None:
    import pindrive

    names = documented()
    public = [name for name in pindrive.__all__ if not name.startswith("__")]
    assert sorted(names["pindrive"]) == sorted(public)


@pytest.mark.parametrize(
    "package", ["fitting", "optimisation", "study", "evaluation", "device", "bodies"]
)
def test_the_names_of_a_package_are_in_the_reference(package: str) -> None:
    module = import_module(f"pindrive.{package}")
    public = {name for name in dir(module) if not name.startswith("_")}
    here = {name for name in public if getattr(module, name).__module__.startswith("pindrive.")}
    assert {*documented()[f"pindrive.{package}"]} <= public  # Sphinx finds each
    assert here - {*documented()["pindrive"]} <= {*documented()[f"pindrive.{package}"]}


def extension(name: str) -> ModuleType:
    """A module of the site's own that needs nothing of Sphinx."""
    spec = spec_from_file_location(name, DOCS / "_ext" / f"{name}.py")
    assert spec and spec.loader
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", sorted(path.name for path in DOCS.glob("reference/*.md")))
def test_generated_files_are_current(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(DOCS / "_ext")
    page = (DOCS / "reference" / name).read_text("utf-8")
    assert page == extension("reference").whole(page), "make it anew: python3 run.py docs"
    if name != "events.md":
        assert "<!-- made of pindrive: " in page


def test_the_reference_of_c_has_all_that_the_header_declares() -> None:
    header = re.sub(r"/\*.*?\*/", "", (ROOT / "capi" / "pindrive.h").read_text("utf-8"), flags=re.S)
    internal = {f"PINDRIVE_{name}" for name in ("API", "BUILDING", "H", "SHARED", "WITHIN")}
    names = {*re.findall(r"\b(?:pindrive|PINDRIVE)_\w+", header)} - internal
    page = extension("c_header").reference()
    code = "\n".join(re.findall(r"^```c\n(.*?)^```$", page, re.M | re.S))
    assert len(names) > 100
    assert names <= {*re.findall(r"\b\w+", code)}
    functions = {*re.findall(r"\b(pindrive_\w+)\([^)]", header)}
    assert functions <= {*re.findall(r"`(\w+)`", "".join(re.findall(r"^### .*", page, re.M)))}
    assert "mass must" not in page and "Sets a number of a drive." in page


def keys(page: str) -> list[str]:
    """The first column of the first table of a reference page."""
    table = (
        (DOCS / "reference" / page).read_text("utf-8").partition("|---|")[2].partition("\n\n")[0]
    )
    return [name.strip("`[]") for name in re.findall(r"^\| (\S+) \|", table, re.M)]


def test_the_keys_of_study_and_problem_files_are_in_the_reference() -> None:
    from pindrive.optimisation.problem import _KEYS
    from pindrive.study.axes import _KINDS
    from pindrive.study.spec import _OWN

    assert sorted(keys("study-file.md")) == sorted(_OWN)
    assert sorted(keys("problem-file.md")) == sorted(_KEYS)
    text = (DOCS / "reference" / "study-file.md").read_text("utf-8")
    assert [way for way in _KINDS if f"{{ {way} = " not in text] == []


def test_calls_of_julia_are_those_of_the_header() -> None:
    """Their names, the types of their arguments and of their results."""
    of_c = {"double": "Cdouble", "size_t": "Csize_t", "char *": "Cstring", "void": "Cvoid"}
    header = (ROOT / "capi" / "pindrive.h").read_text("utf-8")
    whole = {*re.findall(r"^typedef int (\w+);", header, re.M), "int"}

    def julia(declared: str) -> set[str]:
        """Types in Julia for arguments and results."""
        name = re.sub(r"\bconst |\b\w+$", "", declared.strip()) if " " in declared else declared
        name = name.strip()
        if name in of_c:
            return {of_c[name]}
        if name in whole:
            return {"Cint"}
        if name.endswith("**"):
            return {"Ref{Ptr{Cvoid}}"}
        if name in ("double *", "size_t *"):
            inner = of_c[name[:-2]]
            return {f"Ptr{{{inner}}}", f"Ref{{{inner}}}"}
        return {"Ptr{Cvoid}"}

    (block,) = (block for block in BLOCKS["docs/julia.md"] if block.language == "julia")
    calls = re.findall(r"@ccall lib\.(\w+)\((.*?)\)::([\w{}]+)", block.text, re.S)
    assert len(calls) == block.text.count("@ccall") >= 10
    for name, given, result in calls:
        declared = re.search(rf"^PINDRIVE_API ([^;(]*?){name}\(([^)]*)\);", header, re.M)
        assert declared, name
        assert result in julia(f"{declared[1]}x"), name
        expected = [] if declared[2] == "void" else re.split(r",\s*", declared[2])
        types = re.findall(r"::([\w{}]+)", given)
        assert len(types) == len(expected), name
        for type_, parameter in zip(types, expected, strict=True):
            assert type_ in julia(parameter), (name, type_, parameter)


# ---- without a network ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("asks", "text"),
    [
        (True, '<script src="https://cdn.example/a.js"></script>'),
        (True, "<script async src=//cdn.example/a.js></script>"),
        (True, '<link rel="stylesheet" type="text/css" href="http://a.example/a.css">'),
        (True, '<link href="https://fonts.example" rel="preconnect">'),
        (True, "<style>@import 'https://a.example/a.css'; p {src: url(//a.example/f)}</style>"),
        (True, '<img alt="a" src="https://a.example/a.png">'),
        (False, '<script src="_static/a.js"></script><img src="data:image/png;base64,a//b">'),
        (False, '<a href="https://a.example">there</a><link rel="next" href="a.html">'),
    ],
)
def test_network_requests_of_a_page_are_found(asks: bool, text: str) -> None:
    """The build of the site looks for it in every file that it made."""
    assert bool(extension("offline").requests(text, ".html")) == asks
    assert '"offline"' in (DOCS / "conf.py").read_text("utf-8")

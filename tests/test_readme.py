"""The README is short, and the commands of all pages exist; test_docs.py runs them."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import typer.main

from pindrive.cli.app import app

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text("utf-8")
VALIDATION = (ROOT / "docs" / "validation.md").read_text("utf-8")
PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    ROOT / "tests" / "README.md",
    *sorted((ROOT / "docs").glob("*.md")),
]


def blocks(text: str) -> list[tuple[str, str]]:
    """The fenced blocks as (language, content)."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(text: str) -> list[list[str]]:
    """The calls of pindrive in its blocks, as words."""
    lines = [
        line for language, block in blocks(text) if language == "sh" for line in block.split("\n")
    ]
    return [shlex.split(line)[1:] for line in lines if line.startswith(".venv/bin/pindrive ")]


def rows(text: str) -> list[str]:
    """Return the rows of all tables of evidence."""
    tables = text.split("| what | measured | printed by |\n|---|---|---|\n")[1:]
    return [row for table in tables for row in table.partition("\n\n")[0].splitlines()]


def test_readme_is_short() -> None:
    assert len(README.split()) <= 600
    before = README.partition("\n![")[0].splitlines()[1:]
    assert len([line for line in before if line]) <= 10, "who it is for and what it answers"
    assert len(re.findall(r"!\[", README)) == 2
    found = dict(blocks(README))
    assert len([line for line in found["python"].splitlines() if line]) <= 10
    assert len(commands(README)) == 5, "the whole device"


def test_run_and_test_each_start_with_their_one_command() -> None:
    sections = dict(re.findall(r"^## (\w+)\n+(```.*?^```)", README, re.MULTILINE | re.DOTALL))
    assert blocks(sections["Run"])[0][1] == "python3 run.py\n"
    assert blocks(sections["Test"])[0][1] == "python3 run.py test\n"


# ---- evidence ------------------------------------------------------------------------------------


def test_readme_evidence_is_part_of_validation() -> None:
    all_rows = [row.replace("](../", "](") for row in rows(VALIDATION)]
    assert len(rows(README)) == 4
    assert {*rows(README)} <= {*all_rows}
    assert len(all_rows) >= 20


def test_the_row_of_published_cases_counts_as_the_page_does() -> None:
    counted = re.search(
        r"^(\d+) numbers of (\d+) cases: (\d+) agree .*?, (\d+) do not", VALIDATION, re.M
    )
    assert counted
    row = next(row for row in rows(README) if "published cases" in row)
    numbers, cases, agree, differ = counted.groups()
    assert f"| {numbers} numbers of {cases} published cases " in row
    assert f"| {agree} met within what their source justifies; the four others" in row
    assert differ == "4"


def test_each_row_of_evidence_names_the_program_that_prints_it() -> None:
    """The programs exist, and so do the files that they read."""
    for row in rows(VALIDATION):
        said = row.rpartition(" | ")[2].rstrip(" |")
        for command in re.findall(r"`([^`]+)`", said):
            for word in command.split():
                if word.endswith(".toml") or (word.endswith(".py") and "/" in word):
                    assert (ROOT / word).exists(), (row, word)
                if word.startswith("oracle.") or word == "random_scans":
                    script = ROOT / "tests" / f"{word.replace('.', '/')}.py"
                    assert script.exists(), (row, word)
            if match := re.match(r"python3 run\.py bench ?(\w*)$", command):
                assert (ROOT / "benchmarks" / f"{match[1] or 'simulate'}.py").exists(), row
        assert "`" in said or said == "the same" or said.startswith("the same with"), row


# ---- all pages -----------------------------------------------------------------------------------


def test_the_links_of_the_pages_exist() -> None:
    links = [
        (page, link)
        for page in PAGES
        for link, _ in re.findall(r"\]\(([^)#:\s]+)(#[^)]*)?\)", page.read_text("utf-8"))
    ]
    assert len(links) > 100
    assert [(page, link) for page, link in links if not (page.parent / link).exists()] == []


def test_the_readme_ends_with_five_links() -> None:
    links = re.findall(r"^- \[.*\]\(docs/(\w+)\.md\)", README.partition("## Read on")[2], re.M)
    assert links == ["tutorial", "index", "theory", "validation", "paper"]


def test_contributing_and_changelog_are_short() -> None:
    assert len((ROOT / "CONTRIBUTING.md").read_text("utf-8").split()) <= 900
    assert len((ROOT / "CHANGELOG.md").read_text("utf-8").splitlines()) <= 100


def test_the_commands_of_the_pages_take_their_options() -> None:
    """As the command line reads them; what they do is tested where it is done."""
    group = typer.main.get_command(app)
    found = [words for page in PAGES for words in commands(page.read_text("utf-8"))]
    assert len(found) > 30
    for words in found:
        command = group.get_command(typer.Context(group), words[0])  # type: ignore[attr-defined]
        assert command.make_context(words[0], [*words[1:]]).params, words
        for word in words:
            assert not word.startswith("examples/") or (ROOT / word).exists(), words


def test_the_way_of_a_number_leads_through_files_and_names_that_are_there() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    section = text.partition("### From a file to a result")[2].partition("\n## ")[0]
    steps = re.findall(r"^\| (.*) \| (.*) \|$", section, re.MULTILINE)
    assert len(steps) > 10
    for said, places in steps:
        files = re.findall(r"`((?:src|include)/[^`]+)`", places)
        assert files or places == "in", said
        content = "".join((ROOT / file).read_text("utf-8") for file in files)
        for name in re.findall(r"`([a-z_]+)`", places):
            assert re.search(rf"\b{name}\(", content), (said, name)

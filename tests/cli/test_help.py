"""The help of each command: its options in groups, an example that runs, and shell completion."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from math import cos, exp
from pathlib import Path
from typing import Any

import pytest
import typer.main

import pindrive.cli
from command import run
from design_problems import SMALL
from pindrive.cli.app import app
from pindrive.cli.help import COMMAND_GROUPS
from pindrive.cli.studio import PAGE as STUDIO_PAGE
from pindrive.optimisation import effort

PROGRAM: Any = typer.main.get_command(app)
NAMES: list[str] = PROGRAM.list_commands(None)
SHARED = {
    *("__init__", "app", "errors", "help", "interrupts", "options", "outputs", "progress"),
    *("design_tables", "fit_tables", "scan_tables", "study_tables", "system_tables", "tables"),
}
HEADINGS = (
    *("Arguments", "Contents", "Page", "Analysis"),
    *("Computation", "Files", "Help", "Example"),
)
BEFORE_OTHERS = ("init", "sweep")
"""Commands whose files the examples of further commands need."""

SHORTER = {
    "scan": ["--set", "array.columns=1", "--set", "array.rows=1"],
    "sensitivity": ["--rows", "128"],
    "robustness": ["--draws", "100"],
    "studio": ["--no-browser"],
}
"""Additions to the examples that shorten them; the commands take equal arguments."""


def test_each_command_has_a_file_a_group_and_an_example_of_itself() -> None:
    folder = Path(pindrive.cli.__file__).parent
    assert {*NAMES} == {path.stem for path in folder.glob("*.py")} - SHARED
    for name in NAMES:
        command = PROGRAM.commands[name]
        assert command.callback.__module__ == f"pindrive.cli.{name}"
        assert command.rich_help_panel in COMMAND_GROUPS
        assert shlex.split(command.epilog)[:2] == ["pindrive", name]


def test_a_file_added_is_a_command_added(tmp_path: Path) -> None:
    """Its group and that of its option are new, too."""
    folder = Path(pindrive.cli.__file__).parent
    (tmp_path / "weigh.py").write_text(
        "from typing import Annotated\n"
        "import typer\n"
        "from pindrive.cli.help import ASKED, command\n"
        "@command('Balances', 'pindrive weigh --twice')\n"
        "def weigh(\n"
        "    twice: Annotated[bool, typer.Option('--twice', rich_help_panel=ASKED)] = False\n"
        ") -> None:\n"
        "    'Weigh a pin.'\n"
        "    typer.echo('10 g' * (1 + twice))\n",
        encoding="utf-8",
    )
    code = (
        "import sys, pindrive.cli\n"
        f"pindrive.cli.__path__ = [{str(folder)!r}, {str(tmp_path)!r}]\n"
        "from pindrive.cli.app import main\n"
        "main()"
    )

    def said(*arguments: str) -> str:
        command = [sys.executable, "-c", code, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    assert said("--help").endswith("\nBalances:\n  weigh        Weigh a pin.\n")
    assert "Analysis:\n  --twice" in said("weigh", "--help")
    assert said("weigh", "--twice") == "10 g10 g\n"


def test_the_help_lists_the_commands_under_their_groups_with_whole_sentences() -> None:
    said = run("--help").stdout
    assert re.findall(r"^(\S.*):$", said, re.M) == ["Help", *COMMAND_GROUPS]
    assert "..." not in said.partition("\n")[2]
    sections = re.split(r"^(\S.*):$", said, flags=re.M)
    listed = dict(zip(sections[1::2], sections[2::2], strict=True))
    for name in NAMES:
        group = PROGRAM.commands[name].rich_help_panel
        assert re.search(rf"^  {name} ", listed[group], re.M)


def test_every_option_has_a_group() -> None:
    for name in NAMES:
        for parameter in PROGRAM.commands[name].params:
            assert (parameter.rich_help_panel is None) == (
                parameter.param_type_name == "argument"
            ), (name, parameter.name)


@pytest.mark.parametrize("name", NAMES)
def test_the_help_of_a_command_shows_its_options_by_group_and_its_example(name: str) -> None:
    said = run(name, "--help").stdout
    headings = re.findall(r"^(\S.*):$", said, re.M)
    assert headings == [heading for heading in HEADINGS if heading in headings]
    assert said.endswith(f"\nExample:\n  {PROGRAM.commands[name].epilog}\n")
    for parameter in PROGRAM.commands[name].params:
        if parameter.param_type_name != "option":
            continue
        heading = parameter.rich_help_panel
        section = re.split(rf"^{heading}:$", said, flags=re.M)[1].partition("\n\n")[0]
        assert all(option in section for option in parameter.opts)


@pytest.mark.usefixtures("in_empty_folder")
def test_the_examples_run_one_after_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """All but `paper`, which takes long, and a studio that is not built; they have other tests."""
    times = [0.25 * i for i in range(200)]
    rows = "".join(f"{t},{2.0 * exp(-0.02 * t) * cos(0.1 * t):.4f}\n" for t in times)
    Path("pin.csv").write_text(f"time [ms],position [mm]\n{rows}")
    assert run("init", "study.toml", "--study").exit_code == 0
    vary = 'base = "device.toml"\n[axes]\ndrive.stiffness = ["200 N/m", "300 N/m"]\n'
    Path("problem.toml").write_text(f'{vary}[goals]\nminimise = "settling_time"\n')
    monkeypatch.setattr(effort, "BATCHED", SMALL)
    for name in sorted(NAMES, key=lambda name: name not in BEFORE_OTHERS):
        if name == "paper" or (name == "studio" and not STUDIO_PAGE.exists()):
            continue
        words = shlex.split(PROGRAM.commands[name].epilog)[1:]
        result = run(*words, *SHORTER.get(name, []))
        assert (result.exit_code, result.stderr) == (0, ""), result.output
        for option in ("-o", "--plot"):
            if option in words:
                assert Path(words[words.index(option) + 1]).stat().st_size > 0


# ---- shell completion ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shell", "registers"),
    [
        ("bash", "complete -o default -F _pindrive_completion pindrive"),
        ("zsh", "compdef _pindrive_completion pindrive"),
        ("fish", "complete --command pindrive"),
    ],
)
def test_the_script_for_a_shell(
    shell: str, registers: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("typer.completion._get_shell_name", lambda: shell)
    result = run("--show-completion")
    assert result.exit_code == 0
    assert registers in result.stdout
    assert "_PINDRIVE_COMPLETE" in result.stdout


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("pindrive si", ["simulate"]),
        ("pindrive s", ["simulate", "studio", "scan", "speed", "sensitivity", "sweep"]),
        ("pindrive init --", ["--force", "--device", "--study", "--problem", "--help"]),
    ],
)
def test_shell_completion_lists_the_next_words(typed: str, offered: list[str]) -> None:
    words = typed.split()
    environment = {
        **os.environ,
        "_PINDRIVE_COMPLETE": "complete_bash",
        "COMP_WORDS": typed,
        "COMP_CWORD": str(len(words) - 1),
    }
    program = "import sys; sys.argv = ['pindrive']; from pindrive.cli.app import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env=environment, check=True
    )
    assert done.stdout.split() == offered


@pytest.mark.usefixtures("in_empty_folder")
def test_completion_is_installed_for_a_shell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("typer.completion._get_shell_name", lambda: "bash")
    monkeypatch.setattr("typer._completion_shared._get_shell_name", lambda: "bash")
    monkeypatch.setenv("HOME", str(Path.cwd()))
    result = run("--install-completion")
    assert result.exit_code == 0, result.output
    assert "bash completion installed" in result.stdout
    assert "_pindrive_completion" in Path(".bash_completions/pindrive.sh").read_text()
    assert "pindrive.sh" in Path(".bashrc").read_text()

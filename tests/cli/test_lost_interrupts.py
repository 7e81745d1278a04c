"""Ctrl-C in the middle of what would lose it."""

from __future__ import annotations

import shlex
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from command import EXAMPLES, taking_ctrl_c

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
ASKS = "import os, signal; os.kill(os.getpid(), signal.SIGINT); import time; time.sleep(0)\n"
LOSES = {
    "caught": f"try:\n    {ASKS.replace(chr(10), '')}\nexcept BaseException:\n    pass\n",
    "renamed": "class Named:\n    def __set_name__(self, *_):\n        "
    + ASKS
    + "class Owner:\n    one = Named()\n",
}


def run(program: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        preexec_fn=taking_ctrl_c,
    )


@pytest.mark.parametrize("loses", LOSES)
def test_an_import_runs_to_its_end(loses: str, tmp_path: Path) -> None:
    """A module that catches every exception, and one whose exceptions Python renames."""
    (tmp_path / "loses.py").write_text(LOSES[loses])
    program = """
        import time
        from pindrive.cli.interrupts import interruptible
        interruptible()
        try:
            import loses
            time.sleep(30)
        except KeyboardInterrupt:
            print("interrupted")
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "interrupted\n", "")


def test_a_finalizer_cannot_lose_it(tmp_path: Path) -> None:
    program = f"""
        import time
        from pindrive.cli.interrupts import interruptible
        interruptible()
        class Last:
            def __del__(self):
                {ASKS.strip()}
        try:
            Last()
            time.sleep(30)
        except KeyboardInterrupt:
            print("interrupted")
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "interrupted\n", "")


def test_ignored_stays_ignored(tmp_path: Path) -> None:
    """As a shell has it for what runs in the background."""
    program = f"""
        import signal
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        from pindrive.cli.interrupts import interruptible
        interruptible()
        {ASKS.strip()}
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_second_interrupt_prints_nothing(tmp_path: Path) -> None:
    program = f"""
        import time
        import typer
        from pindrive.cli.errors import refusing
        from pindrive.cli.interrupts import interruptible
        def stopped():
            {ASKS.strip()}
            return "stopped"
        interruptible()
        try:
            with refusing(stopped):
                {ASKS.strip()}
                time.sleep(30)
        except typer.Exit as end:
            print(end.exit_code)
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "130\n", "stopped\n")


def test_one_outside_of_a_command_ends_in_a_line_too(tmp_path: Path) -> None:
    program = f"""
        import sys, time
        from pindrive.__main__ import main
        from pindrive.cli.app import app
        @app.command(rich_help_panel="Studies")
        def again():
            {ASKS.strip()}
            time.sleep(30)
        sys.argv = ["pindrive", "again"]
        main()
    """
    ended = run(program, tmp_path)
    said = "stopped; nothing was written\n"
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", said)


MOUSE, READER = (
    shlex.quote(f"{EXAMPLES}/tactile-{name}-study.toml") for name in ("mouse", "reader")
)
DEVICE, RECORDING, PROBLEM = (
    shlex.quote(f"{EXAMPLES}/{name}")
    for name in ("tactile-mouse.toml", "release-recording.csv", "tactile-mouse-problem.toml")
)
MOMENTS = {
    "typer": f"sweep {MOUSE} -o study.nc",
    "pindrive.study.runner": f"sweep {MOUSE} -o study.nc",
    "numpy": f"sensitivity {MOUSE}",
    "pindrive.study.robustness": f"robustness {READER}",
    "pindrive.fitting.recording": f"fit {DEVICE} {RECORDING} --free mass,stiffness",
    "pindrive.optimisation.problem": f"design {PROBLEM} -o design.toml",
}
"""A command that takes long, by a module that it is just importing."""


@pytest.mark.parametrize("module", MOMENTS)
def test_a_command_ends_in_a_line_while_it_is_imported(module: str, tmp_path: Path) -> None:
    program = f"""
        import os, signal, sys
        class Moment:
            def find_spec(self, name, *_):
                if name == {module!r}:
                    sys.meta_path.remove(self)
                    os.kill(os.getpid(), signal.SIGINT)
        sys.meta_path.insert(0, Moment())
        sys.argv = ["pindrive", *{shlex.split(MOMENTS[module])!r}]
        from pindrive.__main__ import main
        main()
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stdout) == (130, ""), ended.stderr
    assert ended.stderr.startswith("stopped; ") and ended.stderr.count("\n") == 1
    # Raised a moment after the import, when a sweep may have finished a chunk: it says which.
    assert any(tmp_path.iterdir()) == ("chunks are kept" in ended.stderr)

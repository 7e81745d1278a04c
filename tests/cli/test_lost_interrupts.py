"""Ctrl-C in the middle of what would lose it."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from command import taking_ctrl_c

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
        from pindrive.cli.errors import interruptible
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
        from pindrive.cli.errors import interruptible
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
        from pindrive.cli.errors import interruptible
        interruptible()
        {ASKS.strip()}
    """
    ended = run(program, tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")

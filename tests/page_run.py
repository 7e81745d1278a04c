"""Page of the site as a program: its blocks run in sequence in one folder."""

from __future__ import annotations

import contextlib
import io
import os
import re
import runpy
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from command import run
from pages import FILES, ROOT, Block, file_of

CHECKOUT = ("CMakeLists.txt", "engine", "examples", "include", "tests/consumer")
"""Files of the checkout that the commands of a page find as copies in their folder."""
NOT_RUN = {
    "python3 run.py": "it makes the environment that the tests run in",
    "python -m pip install": "it installs what the tests run",
    ".venv/bin/pindrive studio": "it opens a browser; tests/studio has the page",
}
"""Commands that no page runs, each with its reason; their existence is tested."""


def agrees(printed: str, shown: str) -> bool:
    """Return True if the text was printed, apart from spaces at line ends; `...` omits a part."""

    def lines(text: str) -> str:
        return "\n".join(line.rstrip() for line in text.strip().splitlines())

    parts = [re.escape(part) for part in re.split(r"^\.\.\.$", lines(shown), flags=re.MULTILINE)]
    return re.fullmatch(".*".join(parts), lines(printed), re.DOTALL) is not None


def is_excerpt(lines: str, file: str) -> bool:
    """Return True if all non-empty lines of a block are lines of the file, in order."""
    left = iter([line.strip() for line in file.splitlines()])
    return all(line.strip() in left for line in lines.splitlines() if line.strip())


@dataclass
class Run:
    """One page that is run in the current folder, in which it finds part of a checkout.

    Args:
        home: the home folder of its commands.
        longer: how some commands begin, and options that they get here, to be quick.
        coarser: what is replaced in copies of files, for the same reason.
        done: commands that a fixture has run.
    """

    home: Path
    longer: Mapping[str, str]
    coarser: Mapping[str, Sequence[tuple[str, str]]]
    done: frozenset[str] = frozenset()
    names: dict[str, Any] = field(default_factory=lambda: {"__name__": "__main__"})
    warnings: list[str] = field(default_factory=list)
    _running: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def page(self, found: list[Block]) -> None:
        """Run all blocks in sequence, each with the block of text after it."""
        for name in CHECKOUT:
            if (ROOT / name).is_dir():
                shutil.copytree(ROOT / name, name)
            else:
                shutil.copy(ROOT / name, name)
        for name, replaced in self.coarser.items():
            file = Path(name)
            for long, short in replaced:
                assert long in file.read_text("utf-8"), f"{name} has no {long!r}"
                file.write_text(file.read_text("utf-8").replace(long, short), "utf-8")
        try:
            for block, after in zip(found, [*found[1:], None], strict=True):
                if block.language == "text" or block.reason:
                    continue
                printed = self._block(block)
                shown = after.text if after and after.language == "text" else None
                if shown is not None or block.language == "python":
                    assert agrees(printed, shown or ""), f"{block}printed:\n{printed}"
        finally:
            for process in self._running:
                os.killpg(process.pid, signal.SIGTERM)
                process.wait()

    def _block(self, block: Block) -> str:
        """Return the output of a block."""
        if block.language in FILES:
            name, _, text = file_of(block).partition("\n")
            there = ROOT / name
            if there.is_file():
                assert is_excerpt(text, there.read_text("utf-8")), f"{block}is not in {name}"
            else:
                Path(name).parent.mkdir(exist_ok=True)
                Path(name).write_text(block.text, "utf-8")
            return ""
        if block.language == "python":
            with printed() as output:
                exec(compile("\n" * block.line + block.text, block.page, "exec"), self.names)
            return output.getvalue()
        assert block.language == "sh", f"{block}is of a language that is not run here"
        lines = block.text.replace("\\\n", " ").splitlines()
        return "".join(map(self._command, filter(None, lines)))

    def _command(self, line: str) -> str:
        """Return the output of a line of a shell; pindrive runs in this process."""
        if line in self.done or any(line.startswith(given) for given in NOT_RUN):
            return ""
        words = shlex.split(line, comments=True)
        if not words:
            return ""
        if words[0] == ".venv/bin/pindrive":
            more = "".join(self.longer[given] for given in self.longer if line.startswith(given))
            result = run(*words[1:], *shlex.split(more))
            assert result.exit_code == 0, f"{line}\n{result.output}"
            self.warnings += result.stderr.splitlines()
            return result.stdout
        if words[0] == ".venv/bin/python":
            with printed() as output, pytest.MonkeyPatch.context() as patch:
                patch.setattr(sys, "argv", words[1:])
                runpy.run_path(words[1], run_name="__main__")
            return output.getvalue()
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
        env = {**os.environ, "PATH": path, "HOME": str(self.home)}
        if words[-1] == "&":
            command = ["sh", "-c", f"exec {line.rstrip(' &')}"]
            begun = subprocess.Popen(
                command,
                env=env,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
            self._running.append(begun)
            return ""
        done = subprocess.run(
            ["sh", "-c", line], env=env, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{line}\n{done.stdout}{done.stderr}"
        return done.stdout


@contextlib.contextmanager
def printed() -> Iterator[io.StringIO]:
    """Collect the output of the enclosed code."""
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        yield output

"""What several test files share."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import settings

from pages import DOCS, ROOT, blocks

# A test run draws the same cases on every machine; `python3 run.py explore` draws new ones. How
# long a case takes depends on the machine, so none has a deadline.
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None, derandomize=False)
settings.load_profile("same")


@pytest.fixture
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test runs in a folder of its own."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="session")
def c_library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the C interface is installed, by the first commands of docs/c.md.

    It is compiled once in a test run, whatever the number of workers.
    """
    if sys.platform == "win32":
        pytest.skip("where the library lies is tested on the others")
    import fcntl

    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "c-library"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            for command in blocks(DOCS / "c.md")[0].text.splitlines():
                _build(command, folder)
            (folder / "done").touch()
    return folder / "prefix"


def _build(command: str, folder: Path) -> None:
    """A command of docs/c.md, in other folders and quicker."""
    places = {".": str(ROOT), "build/c": str(folder / "build"), "~/.local": str(folder / "prefix")}
    words = [places.get(word, word) for word in shlex.split(command)]
    if "-S" in words:  # the bits are the same at -O1, half of the time is not
        words += ["-G", "Ninja", "-DCMAKE_INSTALL_LIBDIR=lib"]
        words += ["-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"]
    words[0] = shutil.which(words[0], path=str(Path(sys.executable).parent)) or words[0]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

"""Fixtures that several test files share."""

from __future__ import annotations

import os
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

from cases import EXPLORES
from pages import DOCS, ROOT, blocks

# A test run draws the same cases on every machine; `python3 run.py explore` draws new ones, and
# more. How long a case takes depends on the machine, so none has a deadline.
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None, derandomize=False)
settings.load_profile("explore" if EXPLORES else "same")


# A shell without a terminal starts background jobs with SIGINT ignored, and children inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The test runs in a folder of its own."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="session")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of what CMake builds and installs, by the first commands of docs/c.md.

    The C++ tests, the engine and the C interface are built at once, so that they share the engine.
    """

    def build(folder: Path) -> None:
        for command in blocks(DOCS / "c.md")[0].text.splitlines():
            _build(command, folder)

    return _built_once(tmp_path_factory, "compiled", build)


@pytest.fixture(scope="session")
def c_library(compiled: Path) -> Path:
    """Folder in which the C interface, the engine and the headers are installed."""
    return compiled / "prefix"


@pytest.fixture(scope="session")
def programs(compiled: Path) -> Path:
    """Folder of the C++ tests, `fuzz` and `endings`."""
    return compiled / "build"


def _built_once(factory: pytest.TempPathFactory, name: str, build: Callable[[Path], None]) -> Path:
    """Return a folder of build/tests, built once per run by a single worker."""
    if sys.platform == "win32":
        pytest.skip("where the library lies is tested on the others")
    import fcntl

    base = factory.getbasetemp()
    done = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / f"{name}-is-built"
    folder = ROOT / "build" / "tests" / name
    folder.parent.mkdir(parents=True, exist_ok=True)
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not done.exists():
            for cache in folder.rglob("CMakeCache.txt"):
                if f"CMAKE_HOME_DIRECTORY:INTERNAL={ROOT.as_posix()}\n" not in cache.read_text():
                    shutil.rmtree(folder)  # the checkout has moved
                    break
            folder.mkdir(exist_ok=True)
            build(folder)
            done.touch()
    return folder


def _build(command: str, folder: Path) -> None:
    """A command of docs/c.md, in other folders, quicker, and with the C++ tests.

    Compiling takes longer than running: -O1 halves the one and hardly adds to the other, and the
    bits are the same.
    """
    places = {".": str(ROOT), "build/c": str(folder / "build"), "~/.local": str(folder / "prefix")}
    words = [places.get(word, word) for word in shlex.split(command)]
    if "-S" in words:
        words += ["-G", "Ninja", "-DCMAKE_INSTALL_LIBDIR=lib"]
        words += ["-DPINDRIVE_TESTS=ON", "-DPINDRIVE_ENGINE=ON"]
        words += ["-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"]
    _run(*words)


def _run(program: str, *words: str | Path) -> None:
    found = shutil.which(program, path=str(Path(sys.executable).parent)) or program
    done = subprocess.run([found, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

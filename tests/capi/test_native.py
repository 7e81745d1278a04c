"""A program in C is compiled with what pip has installed."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

import pindrive
from pindrive import native

MAIN = Path(__file__).parent / "main.c"
COMPILER = shutil.which(os.environ.get("CC", "cc"))


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
def test_a_program_compiles_with_the_installed_headers() -> None:
    assert COMPILER
    command = [COMPILER, "-fsyntax-only", "-I", pindrive.get_include(), str(MAIN)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    include = Path(pindrive.get_include())
    assert (include / "pindrive.hpp").is_file() and (include / "pindrive" / "engine.hpp").is_file()


def test_the_library_is_found_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(native, "_FOLDER", tmp_path)
    with pytest.raises(FileNotFoundError, match=r"lib: this installation has no C library; build"):
        pindrive.get_library()
    (tmp_path / "lib").mkdir()
    library = tmp_path / "lib" / "libpindrive.dylib"
    library.touch()
    assert pindrive.get_library() == str(library)

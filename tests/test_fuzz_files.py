"""A few cases of the fuzz of files; many more: python tests/fuzz/files.py COUNT SEED."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fuzz_cases import KEYS, Case, device
from pindrive.files.template import NUMBERS

FUZZ = Path(__file__).parent / "fuzz" / "files.py"


def test_every_key_has_its_turn() -> None:
    cases = [Case.of(1, number) for number in range(8 * len(KEYS))]
    assert {case.keys[0] for case in cases} == {*NUMBERS}
    assert Case.of(1, 7) == Case.of(1, 7) != Case.of(2, 7)


def test_a_file_holds_what_was_drawn() -> None:
    text = device({"drive.mass": '"1e-300 kg"', "array.columns": "7.0"}, {})
    assert 'mass = "1e-300 kg"' in text and "columns = 7.0" in text


@pytest.mark.skipif(sys.platform == "win32", reason="it forks")
def test_cases_end_well(tmp_path: Path) -> None:
    command = [sys.executable, str(FUZZ), "20", "11"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "20 cases of seed 11 from 0 on" in done.stdout
    assert ", 0 wrong" in done.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="it forks")
def test_what_is_wrong_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A library that warns: the same cases fail, and say so."""
    (tmp_path / "sitecustomize.py").write_text(
        "import sys, os\n"
        "import pindrive.device.page as scene\n"
        "old = scene.Scene.from_text.__func__\n"
        "def new(*args, **named):\n"
        "    sys.stderr.write('RuntimeWarning: so it is\\n')\n"
        "    return old(*args, **named)\n"
        "scene.Scene.from_text = classmethod(new)\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    command = [sys.executable, str(FUZZ), "12", "11"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 1, done.stdout + done.stderr
    assert ": a library warns: pindrive scan" in done.stdout

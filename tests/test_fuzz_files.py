"""A few cases of the fuzz of files; many more: python tests/fuzz/files.py COUNT SEED."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from fuzz_cases import KEYS, Case, device
from pindrive.files.keys import NUMERIC_KEYS

FUZZ = Path(__file__).parent / "fuzz" / "files.py"


def test_every_key_has_its_turn() -> None:
    cases = [Case.of(1, number) for number in range(8 * len(KEYS))]
    assert {case.keys[0] for case in cases} == {*NUMERIC_KEYS}
    assert Case.of(1, 7) == Case.of(1, 7) != Case.of(2, 7)


def test_a_file_holds_what_was_drawn() -> None:
    text = device({"drive.mass": '"1e-300 kg"', "array.columns": "7.0"}, {})
    assert 'mass = "1e-300 kg"' in text and "columns = 7.0" in text


# ---- in one process, which imports everything once ---------------------------------------------

RUNS = f"""
import sys
sys.path.insert(0, {str(FUZZ.parent)!r})
import files
import fuzz_cases
from pindrive.device.page import Scene

def run(count):
    sys.argv = ["files.py", count, "11"]
    print("status", files.main(), flush=True)

run("8")
fuzz_cases.warm_up = lambda: None  # it is warm
old = Scene.from_text.__func__

def new(*args, **named):
    sys.stderr.write("RuntimeWarning: so it is\\n")
    return old(*args, **named)

Scene.from_text = classmethod(new)
run("6")
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """Return the messages of the cases, some with a library that warns."""
    done = subprocess.run(
        [sys.executable, "-c", RUNS],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path_factory.mktemp("fuzz"),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    good, end, bad = done.stdout.partition("status 0\n")
    assert end, done.stdout
    return good, bad


@pytest.mark.skipif(sys.platform == "win32", reason="it forks")
def test_cases_end_well(said: tuple[str, str]) -> None:
    assert "8 cases of seed 11 from 0 on" in said[0]
    assert ", 0 wrong" in said[0]


@pytest.mark.skipif(sys.platform == "win32", reason="it forks")
def test_errors_are_reported(said: tuple[str, str]) -> None:
    """With a library that warns, the cases fail and report the warning."""
    assert said[1].endswith("status 1\n")
    assert ": a library warns: pindrive scan" in said[1]

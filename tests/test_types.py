"""Types of the public names: they resolve as a program runs, and none is Any."""

from __future__ import annotations

import importlib
import inspect
import subprocess
import sys
import typing
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import pindrive as pd
from pages import ROOT

PACKAGES = (
    *("quantities", "motion", "device", "evaluation", "files"),
    *("study", "fitting", "optimisation", "paper"),
)


def callables(module: Any) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Yield the functions and classes of a package, with methods and properties."""
    for name in dir(module):
        public = getattr(module, name)
        if name.startswith("_") or not callable(public):
            continue
        yield name, public
        for own, value in vars(public).items() if inspect.isclass(public) else ():
            inner = value.fget if isinstance(value, property) else getattr(value, "__func__", value)
            if inspect.isfunction(inner) and not own.startswith("__"):
                yield f"{name}.{own}", inner


@pytest.mark.parametrize("package", ["", *PACKAGES])
def test_types_resolve_at_run_time(package: str) -> None:
    module = importlib.import_module(f"pindrive.{package}".rstrip("."))
    found = [name for name, function in callables(module) if typing.get_type_hints(function)]
    assert len(found) > 3


def test_no_public_name_is_any(tmp_path: Path) -> None:
    """A program that uses all public names passes `mypy --strict`, without Any in a type."""
    pytest.importorskip("mypy")
    names = [name for name in dir(pd) if not name.startswith("_")]
    lines = ["import pindrive", *(f"reveal_type(pindrive.{name})" for name in names)]
    program = tmp_path / "program.py"
    program.write_text("\n".join(lines) + "\n", "utf-8")
    cache = ("--cache-dir", str(ROOT / "build" / "mypy"))
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file", "", *cache, str(program)]
    result = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert result.returncode == 0, result.stdout
    revealed = [line for line in result.stdout.splitlines() if "Revealed type" in line]
    assert len(revealed) == len(names)
    assert [line for line in revealed if line.endswith('"Any"')] == []

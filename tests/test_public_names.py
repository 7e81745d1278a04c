"""Names of `import pindrive`: reachable, documented, with examples that run."""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path
from types import FunctionType

import pytest

import pindrive as pd

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
FUNCTIONS = [name for name in pd.__all__ if isinstance(getattr(pd, name), FunctionType)]
WITH_EXAMPLES = ["Study", "load_device", "load_study", "local_sensitivity", "robustness"]
WITH_EXAMPLES += ["optimise", "scan", "sobol"]


def test_completion_offers_the_public_names() -> None:
    assert dir(pd) == sorted(pd.__all__)
    named = {"load_device", "scan", "Study", "sobol", "robustness", "local_sensitivity"}
    assert named < {*dir(pd)}


def test_the_package_is_imported_without_its_modules() -> None:
    script = "import sys, pindrive; print([m for m in sys.modules if m.startswith('pindrive.')])"
    command = [sys.executable, "-c", script]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.stdout == "[]\n", run.stderr


@pytest.mark.parametrize(
    "name",
    [
        *("quantities", "motion", "device", "evaluation", "files", "study", "fitting"),
        "optimisation",
    ],
)
def test_package_lists_its_public_names(name: str) -> None:
    """Its docstring has a line for each name, and each name is what it is said to be."""
    package = importlib.import_module(f"pindrive.{name}")
    said = re.findall(r"^- `(\w+)`: \w.*$", package.__doc__ or "", re.MULTILINE)
    assert {*said} == {*package.__all__} == {*dir(package)}
    assert len(said) == len(package.__all__)
    modules = {file.stem for file in Path(package.__path__[0]).glob("*.py")}
    assert not modules & {*said}, "the import of a module would hide the name of the same spelling"
    for public in package.__all__:
        assert getattr(package, public) is not None
        assert not inspect.ismodule(getattr(package, public)), public
    with pytest.raises(AttributeError, match=f"No pindrive.{name} attribute x"):
        getattr(package, "x")  # noqa: B009


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_document_arguments_results_and_errors(name: str) -> None:
    words = inspect.getdoc(getattr(pd, name)) or ""
    arguments = inspect.signature(getattr(pd, name)).parameters
    for part in ("Args:", "Returns:", "Raises:") if arguments else ("Returns:",):
        assert part in words, part
    for argument in arguments:
        assert argument in words, argument


@pytest.mark.parametrize("name", WITH_EXAMPLES)
def test_the_examples_of_the_documentation_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(EXAMPLES)
    (example,) = doctest.DocTestFinder(recurse=False).find(getattr(pd, name), name, globs={})
    assert example.examples
    said: list[str] = []
    result = doctest.DocTestRunner().run(example, out=said.append)
    assert not result.failed, "".join(said)

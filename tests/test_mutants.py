"""The list of mutants fits the code, and its runner tells detected ones."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

import mutants
from mutants import Mutant, Runner

UNITS = "tests/quantities/test_units.py::test_a_unit_is_what_it_is_defined_as"
POUND = Mutant("pound", "quantities/units.py", "pound = 453.59237", "pound = 500", (UNITS,))


@pytest.fixture(scope="module")
def runner(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Runner]:
    if not hasattr(os, "fork"):
        pytest.skip("mutants are run in forks of a process")
    made = Runner(tmp_path_factory.mktemp("mutants"))
    yield made
    made.close()


def test_every_text_is_once_in_its_file() -> None:
    every = mutants.mutants()
    assert mutants.problems(every) == []
    assert len(every) >= 80


def test_a_mutant_that_is_none_is_an_error() -> None:
    gone = replace(POUND, text="pound = 0.02")
    nowhere = replace(POUND, name="other", tests=("tests/test_none.py", UNITS + "_not"))
    assert mutants.problems([gone, nowhere]) == [
        "pound: its text is 0 times in quantities/units.py, not once",
        "other: there is no tests/test_none.py",
        f"other: there is no {UNITS}_not",
    ]


def test_mutants_fail_and_the_original_passes(runner: Runner) -> None:
    assert runner.control([UNITS]) == ""
    verdict, said = runner.verdict(POUND)
    assert (verdict, "FAILED" in said) == ("dies", True)
    harmless = replace(POUND, text="to the last bit.", instead="to the very last bit.")
    assert runner.verdict(harmless)[0] == "lives"
    broken = replace(POUND, text="def to_si(", instead="def to si(")
    assert runner.verdict(broken)[0] == "error"
    unknown = replace(POUND, tests=(UNITS + "_not",))
    assert runner.verdict(unknown)[0] == "error"
    source = Path(mutants.SOURCE, POUND.file).read_text("utf-8")
    assert POUND.text in source, "the source is left alone"


def test_files_take_turns() -> None:
    found = [replace(POUND, name=name, file=name[0]) for name in ("a1", "a2", "a3", "b1", "c1")]
    names = [mutant.name for mutant in mutants.spread(found)]
    assert names == ["a1", "b1", "c1", "a2", "a3"]


@pytest.fixture(scope="module")
def of_the_core() -> ModuleType:
    """Return the mutants of the core."""
    path = Path(__file__).parent / "fuzz" / "mutants.py"
    spec = spec_from_file_location("fuzz_mutants", path)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[spec.name] = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_text_of_a_mutant_of_the_core_is_once_in_its_header(of_the_core: ModuleType) -> None:
    assert of_the_core.problems(of_the_core.MUTANTS) == []
    assert len(of_the_core.MUTANTS) >= 33


def test_a_mutant_of_the_core_that_is_none_is_an_error(
    of_the_core: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = of_the_core.MUTANTS[0]
    gone = replace(first, what="gone", text="no such text")
    same = replace(first, what="same", instead=first.text)
    errors = [
        f"gone: its text is 0 times in {first.header}, not once",
        "same: it changes nothing",
    ]
    assert of_the_core.problems([first, gone, same]) == errors
    with pytest.raises(SystemExit, match=r"^of no name: no mutant's name has it$"):
        of_the_core.main(["10", "of no name"])
    monkeypatch.setattr(of_the_core, "MUTANTS", (first, gone, same))
    with pytest.raises(SystemExit, match="gone: its text is 0 times"):
        of_the_core.main(["10"])

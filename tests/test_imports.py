"""Imports between the files of the package: no circles, ordered packages, used names.

For circles, what runs as a module is imported counts. The order of the packages also holds for
imports inside of functions and for types: a result reaches its figure by `pindrive.views`.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src"
ORDER = (
    *("quantities", "motion", "bodies", "device", "evaluation", "files"),
    *("study", "fitting", "optimisation", "plot", "paper", "cli"),
)
"""Packages in order: each imports from itself and from earlier packages."""
MOST_LAYERS = 10
"""Longest chain of packages in which every package imports its predecessor."""
MOST_FLOORS = 12
"""Longest chain of files in which every file imports its predecessor."""

USING = {".py", ".pyi", ".md"}
"""Places that may use a name."""

Graph = dict[str, set[str]]


def run_at_import(node: ast.AST) -> Iterator[ast.AST]:
    """The statements that run as a module is imported."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        if isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
            continue
        yield child
        yield from run_at_import(child)


def imports(files: dict[str, str], everywhere: bool = False) -> Graph:
    """Return the imports of each module among the given modules.

    Args:
        files: the text of each module; a package is named as the package.
        everywhere: with those inside of functions and of types.
    """
    packages = {name.rpartition(".")[0] for name in files}
    graph: Graph = {}
    for module, text in files.items():
        package = module if module in packages else module.rpartition(".")[0]
        found = set()
        for node in (ast.walk if everywhere else run_at_import)(ast.parse(text)):
            if isinstance(node, ast.Import):
                found |= {name.name for name in node.names}
            elif isinstance(node, ast.ImportFrom):
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                parts = [*(above if node.level else ()), *(node.module or "").split(".")]
                source = ".".join(filter(None, parts))
                found |= {f"{source}.{name.name}" for name in node.names} | {source}
        graph[module] = (found & files.keys()) - {module}
    return graph


def without_own(graph: Graph) -> Graph:
    """Without what a package's `__init__` gathers from its own modules."""
    return {
        module: {name for name in found if not name.startswith(f"{module}.")}
        for module, found in graph.items()
    }


def circle(graph: Graph) -> list[str]:
    """Return a circle with its first module repeated at the end; empty without one."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def longest_chain(graph: Graph) -> list[str]:
    """Return the longest chain of modules in which every module imports its predecessor."""
    chains: dict[str, list[str]] = {}
    for module in TopologicalSorter(graph).static_order():
        below = max((chains[name] for name in graph[module]), key=len, default=[])
        chains[module] = [*below, module]
    return max(chains.values(), key=len)


def upward(graph: Graph) -> list[tuple[str, str]]:
    """The imports of a module in a later package; the top level's own modules come first."""

    def place(module: str) -> int:
        package = module.removeprefix("pindrive").removeprefix(".").partition(".")[0]
        if package == "__main__":
            return len(ORDER) + 1
        return ORDER.index(package) + 1 if package in ORDER else 0

    pairs = [(module, name) for module, found in graph.items() for name in found]
    return sorted(pair for pair in pairs if place(pair[1]) > place(pair[0]))


@cache
def package(everywhere: bool = False) -> Graph:
    paths = {p: p.relative_to(SOURCE).with_suffix("").parts for p in SOURCE.rglob("*.py")}
    names = {p: ".".join(parts).removesuffix(".__init__") for p, parts in paths.items()}
    files = {name: p.read_text("utf-8") for p, name in names.items()}
    return without_own(imports(files, everywhere))


def test_no_file_imports_a_file_that_imports_it() -> None:
    assert circle(package()) == []


def test_a_package_imports_from_those_before_it_alone() -> None:
    assert upward(package(everywhere=True)) == []


def test_each_view_belongs_to_a_method_and_has_a_function() -> None:
    classes = {
        node.name: {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        for path in SOURCE.rglob("*.py")
        for node in ast.parse(path.read_text("utf-8")).body
        if isinstance(node, ast.ClassDef)
    }
    for package in ("plot", "files", "evaluation"):
        for method, place in import_module(f"pindrive.{package}.views").VIEWS.items():
            owner, _, name = method.partition(".")
            assert name in classes[owner], method
            module, _, function = place.partition(":")
            assert callable(getattr(import_module(f"pindrive.{package}.{module}"), function))


def test_every_package_has_its_place_in_the_order() -> None:
    folders = {p.parent.name for p in SOURCE.glob("pindrive/*/*.py")}
    assert folders == set(ORDER)
    assert " → ".join(ORDER) in (ROOT / "CONTRIBUTING.md").read_text("utf-8")


def test_packages_stand_in_few_layers() -> None:
    """The modules of the top level count as one package."""

    def folder(module: str) -> str:
        name = module.removeprefix("pindrive").removeprefix(".").partition(".")[0]
        return name if name in ORDER else ""

    graph: Graph = {name: set() for name in ("", *ORDER)}
    for module, found in package().items():
        if folder(module):
            graph[folder(module)] |= {folder(name) for name in found} - {folder(module)}
    chain = longest_chain(graph)
    assert len(chain) <= MOST_LAYERS, " → ".join(chain)


def test_files_stand_in_few_floors() -> None:
    """Without the packages, which gather names and have no floor of their own."""
    packages = {name for name in package() if (SOURCE / name.replace(".", "/")).is_dir()}
    graph = {
        module: found - packages for module, found in package().items() if module not in packages
    }
    chain = longest_chain(graph)
    assert len(chain) <= MOST_FLOORS, " → ".join(chain)
    assert longest_chain({"a": set(), "b": {"a"}, "c": {"a", "b"}}) == ["a", "b", "c"]


def test_libraries_that_load_slowly_are_postponed_in_one_place() -> None:
    slow = {"PIL", "h5netcdf", "h5py", "matplotlib", "pint", "rich", "scipy", "xarray"}
    found = []
    for path in SOURCE.rglob("*.py"):
        for function in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, (ast.Import, ast.ImportFrom)):
                        names = [getattr(node, "module", None) or node.names[0].name]
                        found += [(path, n) for n in names if n.partition(".")[0] in slow]
    assert found == []


def defined(text: str) -> Iterator[str]:
    """The functions, classes and constants of a module, without what a decorator takes."""
    for node in ast.parse(text).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and not node.decorator_list:
            yield node.name
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id


def test_every_name_is_used() -> None:
    folders = ("src", "examples", "docs", "benchmarks")
    paths = [p for folder in folders for p in (ROOT / folder).rglob("*") if p.suffix in USING]
    words = Counter(w for p in paths for w in re.findall(r"\w+", p.read_text("utf-8")))
    modules = {p.relative_to(SOURCE): p.read_text("utf-8") for p in SOURCE.rglob("*.py")}
    names = [(path, name) for path, text in modules.items() for name in defined(text)]
    assert len(names) > 1000
    assert [(path, name) for path, name in names if words[name] < 2 and name[:2] != "__"] == []
    assert [*defined("def a(): ...\n@b\ndef c(): ...\nclass D: ...\nE: int = 1")] == ["a", "D", "E"]


@pytest.mark.parametrize(
    "text",
    [
        "from pindrive.motion import b",
        "import pindrive.motion.b",
        "from . import b",
        "from .b import x",
        "try:\n    from pindrive.motion.b import x\nexcept ImportError:\n    x = 0",
    ],
)
def test_a_circle_is_found_however_it_is_written(text: str) -> None:
    files = {
        "pindrive": "from pindrive.motion.a import x",
        "pindrive.motion": "",
        "pindrive.motion.a": text,
        "pindrive.motion.b": "from pindrive.motion.a import y",
    }
    found = circle(without_own(imports(files)))
    assert set(found) == {"pindrive.motion.a", "pindrive.motion.b"}


@pytest.mark.parametrize("line", ["def f():", "if TYPE_CHECKING:"])
def test_lazy_imports_are_no_circle(line: str) -> None:
    files = {
        "pindrive.a": f"{line}\n    from pindrive.b import x",
        "pindrive.b": "from pindrive.a import y",
    }
    assert circle(without_own(imports(files))) == []


def test_an_import_of_a_later_package_is_found() -> None:
    files = {
        "pindrive": "",
        "pindrive.lazy": "",
        "pindrive.motion": "",
        "pindrive.motion.a": "from pindrive import lazy\nfrom pindrive.plot import b",
        "pindrive.plot": "",
        "pindrive.plot.b": "",
        "pindrive.__main__": "from pindrive.motion import a",
    }
    found = upward(without_own(imports(files)))
    assert ("pindrive.motion.a", "pindrive.plot.b") in found
    assert {module for module, _ in found} == {"pindrive.motion.a"}


def test_public_classes_have_names_of_their_own() -> None:
    found = Counter(
        name
        for path in SOURCE.rglob("*.py")
        for name in re.findall(r"^class ([A-Z]\w+)", path.read_text("utf-8"), re.MULTILINE)
    )
    assert [name for name, count in found.items() if count > 1] == []

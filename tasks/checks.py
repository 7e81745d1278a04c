"""Lint, format and the stub of the extension."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sysconfig
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tasks.changes import changed_files
from tasks.environment import BIN, ROOT, VENV, environment, install, run
from tasks.machine import stop

STUB = ROOT / "src" / "pindrive" / "_core.pyi"
ACTIONLINT = "github.com/rhysd/actionlint/cmd/actionlint@v1.7.12"


def cpp_files() -> list[Path]:
    """The C++ of the project."""
    folders = (
        *("include", "engine", "src/pindrive", "bindings", "capi", "fmu"),
        *("tests", "benchmarks"),
    )
    found = (p for folder in folders for p in (ROOT / folder).rglob("*.[ch]pp"))
    return sorted(p.relative_to(ROOT) for p in found)


def checked_by_clang_tidy(files: set[str] | None) -> list[Path]:
    """Return the programs that stand for changed files of C++; None: all programs.

    A header of the core is checked as its test instantiates it, another header as the programs of
    its folder do.
    """
    folders = ("engine", "bindings", "capi", "fmu", "tests")
    programs = [p for p in cpp_files() if p.suffix == ".cpp" and p.parts[0] in folders]
    if files is None:
        return programs
    changed = [Path(name) for name in files]
    tests = {f"{p.stem}_test" for p in changed if p.parts[0] == "include"}
    beside = {p.parent for p in changed if p.suffix == ".hpp" and p.parts[0] != "include"}
    return [p for p in programs if p in changed or p.stem in tests or p.parent in beside]


def clang_tidy(files: set[str] | None) -> int:
    """Check the core's headers as the programs that use them instantiate them, on all cores."""
    programs = checked_by_clang_tidy(files)
    print(f"{len(programs)} programs", flush=True)
    headers = ("-Iinclude", "-Isrc/pindrive", "-Ibindings", "-Icapi", "-Ifmu")

    def check(program: Path) -> int:
        return run("clang-tidy", "--quiet", program, "--", "-std=c++17", *headers)

    # clang-tidy checks one file after the other.
    with ThreadPoolExecutor(os.cpu_count()) as cores:
        return max(cores.map(check, programs), default=0)


def installed_stub() -> Path:
    """The stub that nanobind wrote when the project was last built."""
    packages = sysconfig.get_path("platlib", "venv", {"base": str(VENV), "platbase": str(VENV)})
    return Path(packages, "pindrive", STUB.name)


def check_stub() -> int:
    """Return True if the committed stub declares the built extension, apart from layout."""
    trees = (ast.dump(ast.parse(p.read_text("utf-8"))) for p in (STUB, installed_stub()))
    if len(set(trees)) == 1:
        return 0
    print(f"{STUB.relative_to(ROOT)} is out of date: refresh it with `python3 run.py stubs`")
    return 1


def workflows() -> int:
    """The workflows, by actionlint, which is compiled once and then found in `.venv`."""
    program = BIN / ("actionlint.exe" if os.name == "nt" else "actionlint")
    stamp = VENV / "actionlint.txt"
    if not program.exists() or not stamp.exists() or stamp.read_text("utf-8") != ACTIONLINT:
        install = [str(BIN / "go"), "install", ACTIONLINT]
        try:
            subprocess.run(
                install, env=environment() | {"GOBIN": str(BIN)}, check=True, timeout=300
            )
        except (OSError, subprocess.SubprocessError) as error:
            print(f"the workflows were not checked, for want of actionlint: {error}")
            return 0
        stamp.write_text(ACTIONLINT, "utf-8")
    return run("actionlint")


LINT: dict[str, Callable[[], int]] = {
    "ruff": lambda: run("ruff", "check"),
    "format": lambda: run("ruff", "format", "--check"),
    "mypy": lambda: run("mypy"),
    "clang-format": lambda: run("clang-format", "--dry-run", "-Werror", *cpp_files()),
    "clang-tidy": lambda: clang_tidy(None),
    "workflows": workflows,
    "stubs": check_stub,
    "typescript": lambda: run("python", Path("studio", "build.py"), "lint"),
}


def lint(steps: list[str]) -> int:
    """Run the named steps, or all steps, to the end, and report the failed ones.

    With `--changed` clang-tidy, which takes longest, checks what changed in the last day alone.
    """
    found = dict(LINT)
    if "--changed" in steps:
        found["clang-tidy"] = lambda: clang_tidy(changed_files())
        steps = [step for step in steps if step != "--changed"]
    unknown = [step for step in steps if step not in LINT]
    if unknown:
        stop(f"no lint step {unknown[0]!r}; there are {', '.join(LINT)}")
    steps = steps or list(LINT)
    install({"dev"}, project="stubs" in steps or "typescript" in steps)
    failed = []
    for step in steps:
        print(f"run.py: {step}", flush=True)
        if found[step]():
            failed.append(step)
    print(f"run.py: failed: {', '.join(failed)}" if failed else "run.py: lint passed")
    return 1 if failed else 0


def layout() -> int:
    """Lays the sources out; what lint can only complain about is left to the author."""
    install({"dev"}, project=False)
    run("ruff", "check", "--fix-only", "--quiet")
    python = run("ruff", "format") or run("clang-format", "-i", *cpp_files())
    return python or run("python", Path("studio", "build.py"), "format")


def stubs() -> int:
    """Takes over the stub of the extension as built."""
    install(set())
    shutil.copyfile(installed_stub(), STUB)
    print(f"{STUB.relative_to(ROOT)} is up to date")
    return 0

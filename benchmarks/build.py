"""Processor time and memory of each compilation, by target.

Configures each target afresh, compiles its files one after the other, and prints those that take
longest; a file that several targets share is counted in each. `--against COMMIT` compiles the
targets of an earlier commit after those here. Compilers that run side by side on two threads of one
core take half as long again.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import subprocess
import sys
import tarfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).resolve().parent.parent
BIN = Path(sys.executable).parent
TARGETS = {
    "extension": ["-DPINDRIVE_PYTHON=ON", "-DSKBUILD_SABI_COMPONENT="],
    "C library": ["-DPINDRIVE_C=ON"],
    "C++ tests": ["-DPINDRIVE_TESTS=ON"],
}
"""Settings of CMake for each target."""
SHOWN = 8
"""Files of each target that are listed."""


@dataclass(frozen=True)
class Compiled:
    """One compilation: processor time, s, and largest memory, MB."""

    file: str
    seconds: float
    memory: float


def compiled(source: Path, settings: list[str], folder: Path) -> list[Compiled]:
    """Compile all files of a target of a checkout."""
    nanobind = subprocess.run(
        [sys.executable, "-m", "nanobind", "--cmake_dir"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    configure = [
        *(BIN / "cmake", "-S", source, "-B", folder, "-G", "Ninja", *settings),
        *(f"-DCMAKE_MAKE_PROGRAM={BIN / 'ninja'}", f"-Dnanobind_DIR={nanobind}"),
        *("-DCMAKE_BUILD_TYPE=Release", f"-DPython_EXECUTABLE={sys.executable}"),
    ]
    subprocess.run([*map(str, configure)], check=True, capture_output=True)
    listed = subprocess.run(
        [str(BIN / "ninja"), "-C", str(folder), "-t", "compdb"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    found = []
    for entry in json.loads(listed):
        words = shlex.split(entry["command"])
        if "-c" not in words or not entry["file"].endswith((".cpp", ".cxx", ".c")):
            continue
        place = Path(entry["directory"], entry["output"])
        place.parent.mkdir(parents=True, exist_ok=True)
        process = subprocess.Popen(words, cwd=entry["directory"], stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = status
        if status:
            raise SystemExit(f"build: {entry['file']} does not compile")
        seconds = used.ru_utime + used.ru_stime
        name = Path(entry["output"]).name.removesuffix(".o")
        target = Path(entry["output"]).parts[1].removesuffix(".dir")
        found.append(Compiled(f"{target}/{name}", seconds, used.ru_maxrss / 1024))
    return found


def unpacked(commit: str, folder: Path) -> Path:
    """The files of an earlier commit."""
    archive = subprocess.run(
        ["git", "archive", "--format=tar", commit], cwd=ROOT, check=True, capture_output=True
    ).stdout
    with tarfile.open(fileobj=BytesIO(archive)) as tar:
        tar.extractall(folder, filter="data")
    return folder


def main() -> None:
    """Prints a table for each target."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("targets", nargs="*", help=f"of {', '.join(TARGETS)}; default: all")
    parser.add_argument("--against", metavar="COMMIT", help="an earlier commit, compiled too")
    options = parser.parse_args()
    if unknown := {*options.targets} - {*TARGETS}:
        parser.error(f"there is no target {unknown.pop()!r}; there are {', '.join(TARGETS)}")
    console = Console(width=100)
    with TemporaryDirectory() as name:
        trees = {"here": ROOT}
        if options.against:
            trees[options.against] = unpacked(options.against, Path(name, "before"))
        for target in options.targets or TARGETS:
            for tree, source in trees.items():
                folder = Path(name, f"{target}-{tree}".replace(" ", "-"))
                files = compiled(source, TARGETS[target], folder)
                total = sum(file.seconds for file in files)
                largest = max(file.memory for file in files)
                title = f"{target}, {tree}: {total:.0f} s of processor time, {largest:.0f} MB"
                table = Table("file", "s", "MB", title=title)
                for file in sorted(files, key=lambda file: -file.seconds)[:SHOWN]:
                    table.add_row(file.file, f"{file.seconds:.1f}", f"{file.memory:.0f}")
                console.print(table)


if __name__ == "__main__":
    main()

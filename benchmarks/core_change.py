"""Compares the C++ core of this checkout with that of an earlier commit.

Counts the instructions of one release with callgrind (Linux with valgrind), and compares the bits
of random motions of each family. Fails if a bit differs, or if the instructions grow by more than
is allowed.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import tarfile
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parent.parent
FAMILIES = ("any", "aligned", "oblique", "stops", "skin")
RELEASES = 2000


def compiled(include: Path, program: Path, compiler: str) -> Path:
    """The program of core_change.cpp with the core of one tree."""
    source = ROOT / "benchmarks" / "core_change.cpp"
    folders = [f"-I{include}", f"-I{ROOT / 'tests' / 'fuzz'}"]
    flags = ["-std=c++17", "-O3", "-ffp-contract=off"]
    subprocess.run([compiler, *flags, *folders, str(source), "-o", str(program)], check=True)
    return program


def unpacked(commit: str, folder: Path) -> Path:
    """The headers of a commit."""
    archive = subprocess.run(
        ["git", "archive", "--format=tar", commit, "include"],
        cwd=ROOT,
        check=True,
        capture_output=True,
    ).stdout
    with tarfile.open(fileobj=BytesIO(archive)) as tar:
        tar.extractall(folder, filter="data")
    return folder / "include"


def instructions(program: Path, what: str) -> float:
    """Instructions of one release, by callgrind, without the start of the program."""

    def total(count: int) -> int:
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
        result = subprocess.run(
            [*command, str(program), what, str(count)], check=True, capture_output=True, text=True
        )
        found = re.search(r"Collected : (\d+)", result.stderr)
        if not found:
            raise SystemExit(f"core_change: valgrind did not count:\n{result.stderr}")
        return int(found[1])

    return (total(RELEASES) - total(0)) / RELEASES


def different(programs: list[Path], family: str, count: int, seed: int) -> int:
    """Thousands of motions whose bits differ."""
    started = [
        subprocess.Popen(
            [str(program), family, str(count), str(seed)], stdout=subprocess.PIPE, text=True
        )
        for program in programs
    ]
    before, after = (process.communicate()[0].splitlines() for process in started)
    if any(process.returncode for process in started):
        raise SystemExit(f"core_change: the program ended early, of the family {family!r}")
    return sum(one != other for one, other in zip(before, after, strict=True))


def main() -> int:
    """Prints both tables; 1 if the cores differ."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit", help="the commit to compare with")
    parser.add_argument("--count", type=int, default=10_000, help="motions of each family")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--allow", type=float, default=1.0, help="more instructions, %%")
    parser.add_argument("--compiler", default="c++")
    options = parser.parse_args()

    failed = False
    with TemporaryDirectory() as name:
        folder = Path(name)
        includes = [unpacked(options.commit, folder), ROOT / "include"]
        programs = [
            compiled(include, folder / place, options.compiler)
            for include, place in zip(includes, ("before", "after"), strict=True)
        ]
        if shutil.which("valgrind"):
            print(f"{'instructions':20s} {'before':>10s} {'after':>10s} {'change':>8s}")
            for what in ("release", "summary"):
                before, after = (instructions(program, what) for program in programs)
                change = 100 * (after / before - 1)
                failed |= change > options.allow
                print(
                    f"{'one ' + what:20s} {before:10.0f} {after:10.0f} {change:+7.1f}%", flush=True
                )
        else:
            print("Instructions are not counted: there is no valgrind here.")
        print(f"\n{'motions':20s} {'drawn':>10s} {'different':>10s}")
        for family in FAMILIES:
            blocks = different(programs, family, options.count, options.seed)
            failed |= blocks > 0
            drawn, text = f"{options.count}", f"{blocks} blocks" if blocks else "0"
            print(f"{family:20s} {drawn:>10s} {text:>10s}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

"""Mutation test of the Python package: a change in one place must make a test fail.

    python3 tests/mutants.py [--changed] [NAME...]

A mutant is one text of one file replaced by another (tests/mutations/*.toml). Its tests run on a
copy of the installed package with that text replaced, in a fork of a process that has loaded the
libraries; they must fail. Before that the same tests run on a copy as it is, and must pass. Without
a NAME (a part of a mutant's name or of its file) all run; `--changed` takes those whose file or
tests changed in the last day, 20 at most and for ten minutes at most, and says which it left out:
the nightly run takes all.

Ends with 1 where a mutant lives that is not explained, where fewer than 95 % die, where a text is
not once in its file, or where a mutant cannot be imported.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path
from queue import Queue

import forked

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT))
from tasks.changes import changed_files  # noqa: E402

SOURCE = ROOT / "src" / "pindrive"
LISTS = Path(__file__).with_name("mutations")
LIMIT = 20
"""Mutants of changed files that run at most."""
LONGEST = 600.0
"""Time after which no mutant of a changed file begins, s."""
ENOUGH = 0.95
TIMEOUT = 300.0
FAILED, PASSED = 1, 0
"""Exit codes of pytest with a verdict."""


@dataclass(frozen=True)
class Mutant:
    """One thing made wrong."""

    name: str
    file: str
    text: str
    instead: str
    tests: tuple[str, ...]
    lives: str = ""
    """Reason for which no test can detect the mutant; empty: a test must."""


def mutants() -> list[Mutant]:
    """All that are listed."""
    found = []
    for path in sorted(LISTS.glob("*.toml")):
        listed = tomllib.loads(path.read_text("utf-8"))
        for given in listed["mutant"]:
            tests = given.pop("tests", None) or listed["tests"][given["file"]]
            found.append(Mutant(tests=tuple(tests), **given))
    return found


def problems(chosen: list[Mutant]) -> list[str]:
    """Mutants that are none: of one name, or whose text is not once in its file."""
    names = [mutant.name for mutant in chosen]
    found = [f"{name}: the name is given twice" for name in names if names.count(name) > 1]
    for mutant in chosen:
        times = (SOURCE / mutant.file).read_text("utf-8").count(mutant.text)
        if times != 1:
            found.append(f"{mutant.name}: its text is {times} times in {mutant.file}, not once")
        if mutant.text == mutant.instead:
            found.append(f"{mutant.name}: changes nothing")
        for test in mutant.tests:
            name, _, function = test.partition("::")
            text = (ROOT / name).read_text("utf-8") if (ROOT / name).is_file() else ""
            if not text or (function and f"def {function}(" not in text):
                found.append(f"{mutant.name}: there is no {test}")
    return found


def spread(chosen: list[Mutant]) -> list[Mutant]:
    """Return the mutants in another order: alternating between files."""
    place: dict[str, int] = {}
    keys = []
    for mutant in chosen:
        place[mutant.file] = place.get(mutant.file, -1) + 1
        keys.append(place[mutant.file])
    return [mutant for _, mutant in sorted(zip(keys, chosen, strict=True), key=lambda of: of[0])]


# ---- running -------------------------------------------------------------------------------------


def python() -> str:
    """The interpreter that has the package and pytest."""
    own = ROOT / ".venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
    return str(own) if own.exists() else sys.executable


class Runner:
    """Runner of tests on copies of the package; `close` ends running tests."""

    def __init__(self, folder: Path) -> None:
        """Copies the installed package, with the Python files as they are in the source."""
        if not hasattr(os, "fork"):
            raise SystemExit("mutants are run in forks of a process, which this system lacks")
        self._folder, self._whole = folder, folder / "whole"
        installed = self._place(os.environ, without_editable=False)
        shutil.copytree(installed, self._whole / "pindrive")
        for file in SOURCE.rglob("*.py"):
            target = self._whole / "pindrive" / file.relative_to(SOURCE)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(file, target)
        environment = os.environ | {"PYTHONPATH": str(self._whole)}
        copied = self._place(environment, without_editable=True)
        if copied != self._whole / "pindrive":
            raise SystemExit(f"the copy of the package is not what is imported: {copied}")
        subprocess.run([python(), "-m", "compileall", "-q", str(self._whole)], check=False)
        self._servers = [
            subprocess.Popen(
                [python(), Path(forked.__file__)],
                cwd=ROOT,
                env=os.environ | {"CI": "true", "OPENBLAS_NUM_THREADS": "1"},
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                start_new_session=True,
            )
            for _ in range(os.cpu_count() or 1)
        ]
        self._idle = Queue[subprocess.Popen[str]]()
        for server in self._servers:
            self._idle.put(server)

    def _place(self, environment: Mapping[str, str], *, without_editable: bool) -> Path:
        """Return the place of the imported package, past an editable installation."""
        tests = str(Path(forked.__file__).parent)
        script = f"import sys; sys.path.append({tests!r}); import forked; "
        if without_editable:
            script += "sys.meta_path = forked.without_editable(); "
        script += "import pindrive; print(pindrive.__path__[0])"
        done = subprocess.run(
            [python(), "-c", script],
            env=environment,
            cwd=self._folder,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            raise SystemExit("pindrive is not installed; python3 run.py test sets it up")
        return Path(done.stdout.strip())

    def control(self, tests: list[str]) -> str:
        """Return the failures of the unchanged package; empty if none."""
        status, said = self._test(self._whole, "pindrive", tests)
        return "" if status == PASSED else said

    def verdict(self, mutant: Mutant) -> tuple[str, str]:
        """Return the verdict "dies", "lives" or "error", with the deciding test."""
        module = ".".join(["pindrive", *Path(mutant.file).with_suffix("").parts])
        with self._spoiled(mutant) as path:
            status, said = self._test(path, module, list(mutant.tests))
        if status == forked.NOT_IMPORTED:
            return "error", f"cannot be imported: {said}"
        if status not in (FAILED, PASSED):
            return ("dies", said) if said == "does not end" else ("error", said)
        return ("dies" if status == FAILED else "lives"), said

    @contextmanager
    def _spoiled(self, mutant: Mutant) -> Iterator[Path]:
        """A copy of the package with the text replaced; all other files are links."""
        with tempfile.TemporaryDirectory(dir=self._folder) as name:
            path = Path(name)
            shutil.copytree(self._whole, path, copy_function=os.link, dirs_exist_ok=True)
            file = path / "pindrive" / mutant.file
            text = file.read_text("utf-8")
            file.unlink()
            file.write_text(text.replace(mutant.text, mutant.instead), "utf-8")
            for compiled in (file.parent / "__pycache__").glob(f"{file.stem}.*.pyc"):
                compiled.unlink()
            yield path

    def _test(self, path: Path, module: str, tests: list[str]) -> tuple[int, str]:
        """The exit status of the tests on the package at a path, and the line that says most."""
        server = self._idle.get()
        try:
            assert server.stdin and server.stdout
            job = {"path": str(path), "module": module, "tests": tests, "limit": TIMEOUT}
            print(json.dumps(job), file=server.stdin, flush=True)
            answer = json.loads(server.stdout.readline() or "null")
        finally:
            self._idle.put(server)
        return (answer["status"], answer["said"]) if answer else (-1, "interrupted")

    def close(self) -> None:
        """Ends what still runs."""
        for server in self._servers:
            with server:
                server.terminate()


def run(chosen: list[Mutant], longest: float) -> int:
    """Judges them on all cores, none that would begin after `longest` seconds; the exit status."""
    died, lived, wrong, late = 0, [], [], 0
    end = time.monotonic() + longest
    files: dict[str, set[str]] = {}
    for mutant in chosen:
        for test in mutant.tests:
            files.setdefault(test.partition("::")[0], set()).add(test)
    with (
        tempfile.TemporaryDirectory() as name,
        closing(Runner(Path(name))) as runner,
        ThreadPoolExecutor(os.cpu_count()) as pool,
    ):
        try:
            print(f"The tests of {len(chosen)} mutants on the package as it is:", flush=True)
            said_of = pool.map(runner.control, map(sorted, files.values()))
            for file, said in zip(files, said_of, strict=True):
                if said:
                    print(f"  {file} fails: {said}")
                    wrong.append(file)
            if wrong:
                return 1
            print("they pass.", flush=True)

            def verdict_in_time(mutant: Mutant) -> tuple[str, str]:
                if time.monotonic() > end:
                    return "left out", f"{longest:g} s are over"
                return runner.verdict(mutant)

            verdicts = pool.map(verdict_in_time, chosen)
            for mutant, (verdict, said) in zip(chosen, verdicts, strict=True):
                print(f"{verdict}: {mutant.file}: {mutant.name} ({said})", flush=True)
                died += verdict == "dies"
                late += verdict == "left out"
                if verdict == "lives":
                    lived.append(mutant)
                elif verdict == "error":
                    wrong.append(mutant.name)
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)
            runner.close()
            print("Interrupted.")
            return 130
    counts = f"{died} die, {len(lived)} live, {len(wrong)} are none, {late} are left out"
    print(f"{len(chosen)} mutants: {counts}.")
    for mutant in lived:
        print(f"  lives: {mutant.name}: {mutant.lives or 'NOT EXPLAINED'}")
    if died < ENOUGH * (len(chosen) - late):
        print(f"Fewer than {ENOUGH:.0%} die.")
        return 1
    return 1 if wrong or any(not mutant.lives for mutant in lived) else 0


def main(arguments: list[str]) -> int:
    """The command."""
    every = mutants()
    if bad := problems(every):
        print(*bad, sep="\n")
        return 1
    names = [argument for argument in arguments if argument != "--changed"]
    chosen = [m for m in every if not names or any(n in m.name or n in m.file for n in names)]
    if "--changed" in arguments:
        files = changed_files()
        chosen = [
            mutant
            for mutant in chosen
            if files is None
            or f"src/pindrive/{mutant.file}" in files
            or files.intersection(test.partition("::")[0] for test in mutant.tests)
        ]
        left_out = spread(chosen)[LIMIT:]
        chosen = spread(chosen)[:LIMIT]
        for mutant in left_out:
            print(f"left out: {mutant.file}: {mutant.name}")
    elif not chosen:
        print(f"there is no mutant called {' or '.join(names)}")
        return 2
    if not chosen:
        print("No mutant is of a file that changed.")
        return 0
    return run(chosen, LONGEST if "--changed" in arguments else inf)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

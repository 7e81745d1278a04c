"""The commands of `run.py` that start one program each."""

from __future__ import annotations

import os
import secrets
import shutil
from pathlib import Path

from tasks.environment import ROOT, install, run
from tasks.machine import stop

EXAMPLE = Path("examples", "tactile-mouse.toml")
PICTURE = Path("tactile-mouse.png")


def simulate() -> int:
    """The main job: the example, its table and its picture."""
    install(set())
    status = run("pindrive", "simulate", EXAMPLE, "--plot", PICTURE)
    if status == 0:
        print(f"The picture is {ROOT / PICTURE}")
    return status


def test(arguments: list[str]) -> int:
    """The tests, on all cores; `-n 0` keeps them in one process."""
    install({"test"})
    return run("python", "-m", "pytest", "-n", "auto", "--dist", "worksteal", *arguments)


def explore(arguments: list[str]) -> int:
    """Run all random cases, of which `test` takes a part, then new seeds.

    There are COUNT seeds from SEED on, which is random unless given.
    """
    if len(arguments) > 2 or not all(argument.isdecimal() for argument in arguments):
        stop(f"explore takes a count and a seed, whole numbers, not {' '.join(arguments)!r}")
    count = int(arguments[0]) if arguments else 10
    first = int(arguments[1]) if len(arguments) > 1 else secrets.randbelow(10**9)
    install({"test"})
    files = [
        p
        for p in sorted((ROOT / "tests").rglob("test_*.py"))
        if "hypothesis" in p.read_text("utf-8")
    ]
    os.environ["PINDRIVE_EXPLORE"] = "1"
    if status := run("python", "-m", "pytest", "-q", "-m", "explore"):
        return status
    failed = []
    for seed in range(first, first + count):
        print(f"run.py: seed {seed}", flush=True)
        drawn = ("-m", "not explore", f"--hypothesis-seed={seed}")
        if status := run("python", "-m", "pytest", "-q", *drawn, *files):
            failed.append(seed)
            if status != 1:  # of pytest: a test failed
                return status
    for seed in failed:
        print(f"run.py: failed; again with: python3 run.py explore 1 {seed}")
    if not failed:
        print(f"run.py: no failure; seeds {first} to {first + count - 1}")
    return 1 if failed else 0


def bench(arguments: list[str]) -> int:
    """Run the timings: of `simulate`, or the ones named first in the arguments."""
    named = arguments[:1] if arguments and not arguments[0].startswith("-") else []
    program = Path("benchmarks", f"{named[0] if named else 'simulate'}.py")
    if not (ROOT / program).exists():
        names = sorted(path.stem for path in (ROOT / "benchmarks").glob("*.py"))
        stop(f"no benchmark {program.stem!r}; there are {', '.join(names)}")
    install({"bench"})
    return run("python", program, *arguments[len(named) :])


def wheel(arguments: list[str]) -> int:
    """The sdist and the wheels: built, judged and tried; `--complete`: nothing may be missing."""
    pythons = arguments[1:] if arguments[:1] == ["--complete"] else arguments
    for python in pythons:
        if python.startswith("-") or not shutil.which(python):
            stop(
                "wheel takes --complete, then interpreters of Python by name or path, "
                f"not {' '.join(arguments)!r}"
            )
    install({"wheel"}, project=False)
    return run("python", Path("wheels", "build.py"), *arguments)


def validation() -> int:
    """The published cases: computed, and written to docs/validation.md with their figures."""
    install({"test"})
    return run("python", "-m", "tests.published")


def docs() -> int:
    """The documentation site, its reference made anew; whatever Sphinx warns of is an error."""
    install({"docs"})
    if status := run("python", Path("docs", "_ext", "reference.py")):
        return status
    site = ROOT / "build" / "docs"
    strict = (
        "-W",
        "--keep-going",
        "-q",
        "-j",
        "auto",
        "-b",
        "html",
        "-d",
        site.with_name("docs-cache"),
    )
    status = run("python", "-m", "sphinx", *strict, "docs", site)
    if status == 0:
        print(f"The site is {site / 'index.html'}")
    return status


def studio(arguments: list[str]) -> int:
    """Builds the page and puts it into the package; tests, times or films it in a browser."""
    if arguments[:1] not in ([], ["test"], ["bench"], ["picture"]):
        stop(f"studio takes test, bench, picture or nothing, not {' '.join(arguments)!r}")
    install({"studio"})
    if status := run("python", Path("studio", "build.py")):
        return status
    install({"studio"})  # with the page
    if not arguments:
        return 0
    if arguments[0] == "bench":
        return run("python", Path("benchmarks", "studio.py"))
    if arguments[0] == "picture":
        return run("python", Path("studio", "picture.py"))
    os.environ["PINDRIVE_STUDIO"] = "1"
    beside = ("-n", "auto", "--dist", "loadfile")
    return run("python", "-m", "pytest", *beside, Path("tests", "studio"), *arguments[1:])

#!/usr/bin/env python3
"""Sets pindrive up in `.venv` beside this file and runs it; needs Python alone.

    python3 run.py                    simulate examples/tactile-mouse.toml and draw it
    python3 run.py test [ARG...]      run the tests; arguments go to pytest
    python3 run.py explore [COUNT [SEED]]
                                      run the tests of random cases with COUNT (10) new seeds
    python3 run.py lint [--changed] [STEP...]
                                      check style, types and stubs, or only the steps named;
                                      clang-tidy with --changed only the changes of a day
    python3 run.py format             lay out Python and C++ as lint wants them
    python3 run.py studio [test|bench|picture]
                                      build the studio, a page; test, time or film it in a browser
    python3 run.py stubs              refresh src/pindrive/_core.pyi from the built extension
    python3 run.py docs               make the documentation site in build/docs
    python3 run.py validation         write the published cases and figures of docs/validation.md
    python3 run.py fmu-binaries [PLATFORM...]
                                      compile what FMUs carry for other platforms
    python3 run.py wheel [--complete] [PYTHON...]
                                      build the sdist and the wheel, and a wheel for each other
                                      PYTHON that has none yet; judge them, and try them in each
    python3 run.py bench [NAME [ARG]] time the simulation beside SciPy, or run benchmarks/NAME.py

What is installed is remembered in `.venv/pindrive.json`: requirements are installed again when
they change, the project when its sources do.
"""

from __future__ import annotations

import sys
from collections.abc import Callable

from tasks import checks, commands
from tasks.fmu_binaries import fmu_binaries
from tasks.machine import stop


def main(arguments: list[str]) -> int:
    """Runs the command named first in the arguments; returns the exit status."""
    command, rest = (arguments[0], arguments[1:]) if arguments else ("simulate", [])
    if command in ("-h", "--help"):
        print(__doc__)
        return 0
    taking: dict[str, Callable[[list[str]], int]] = {
        "bench": commands.bench,
        "explore": commands.explore,
        "fmu-binaries": fmu_binaries,
        "lint": checks.lint,
        "studio": commands.studio,
        "test": commands.test,
        "wheel": commands.wheel,
    }
    alone: dict[str, Callable[[], int]] = {
        "docs": commands.docs,
        "format": checks.layout,
        "simulate": commands.simulate,
        "stubs": checks.stubs,
        "validation": commands.validation,
    }
    if command in taking:
        return taking[command](rest)
    if command not in alone or rest:
        stop(f"do not know {' '.join(arguments)!r}; `python3 run.py --help` lists the commands")
    return alone[command]()


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)

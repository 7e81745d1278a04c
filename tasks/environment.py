"""The environment in `.venv`: what is installed there, and running programs in it."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tasks.machine import check_machine

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
STAMP = VENV / "pindrive.json"
WHEELS = ROOT / "build" / "installed"
SOURCES = (
    *("pyproject.toml", "CMakeLists.txt"),
    *("include", "engine", "bindings", "capi", "fmu", "src"),
)


def requirements(extras: set[str], *, runs: bool = True) -> list[str]:
    """Return the requirements of pyproject.toml to build, to run (`runs`), and for extras."""
    import tomllib

    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    project = pyproject["project"]

    def extra(name: str) -> Iterator[str]:
        for line in project["optional-dependencies"][name]:
            if line.startswith("pindrive["):
                yield from extra(line[len("pindrive[") : -1])
            else:
                yield line

    wanted = {*pyproject["build-system"]["requires"], *(project["dependencies"] if runs else ())}
    return sorted(wanted.union(*map(extra, extras)))


def fingerprint() -> str:
    """A hash of everything the installed project is made from."""
    digest = hashlib.sha256()
    for name in SOURCES:
        top = ROOT / name
        for path in sorted(top.rglob("*")) if top.is_dir() else [top]:
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(f"{path.relative_to(ROOT).as_posix()}\0".encode())
                digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def environment() -> dict[str, str]:
    """The caller's environment with `.venv` first, and nothing that reaches past it.

    What Python compiles is kept: compiling the tests each time takes longer than many of them.
    """
    left_out = ("PYTHONHOME", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE")
    env = {k: v for k, v in os.environ.items() if k not in left_out}
    path = os.pathsep.join([str(BIN), env.get("PATH", "")])
    return {**env, "PATH": path, "VIRTUAL_ENV": str(VENV), "PIP_USER": "0"}


def quietly(what: str, command: list[str]) -> None:
    """Runs a step of the set-up: one line, and the step's own output only if it fails."""
    print(f"run.py: {what} ...", file=sys.stderr, flush=True)
    result = subprocess.run(
        command,
        cwd=ROOT,
        env=environment(),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
    )
    if result.returncode:
        sys.stderr.write(result.stdout)
        raise SystemExit(f"run.py: {what} failed, see above")


def pip(what: str, command: str, *arguments: str) -> None:
    """Runs pip in `.venv`; a module is compiled when it is imported, as most never are."""
    python = str(BIN / "python")
    options = ["--no-compile"] if command == "install" else []
    quietly(
        what, [python, "-m", "pip", "--disable-pip-version-check", command, *options, *arguments]
    )


def build_wheel() -> None:
    """Builds the project into `WHEELS`, without isolation; changes nothing in `.venv`."""
    shutil.rmtree(WHEELS, ignore_errors=True)
    place = f"--wheel-dir={WHEELS}"
    build = "--config-settings=build-dir=build/{wheel_tag}"
    pip("building pindrive", "wheel", "--no-deps", "--no-build-isolation", place, build, ".")


def install_wheel() -> None:
    """Installs the wheel that `build_wheel` has built."""
    wheels = map(str, WHEELS.glob("*.whl"))
    pip("installing pindrive", "install", "--no-deps", "--force-reinstall", *wheels)


def write_stamp(stamp: dict[str, object]) -> None:
    """Replaces the stamp whole, so that it is never half-written."""
    beside = STAMP.with_suffix(".new")
    beside.write_text(json.dumps(stamp, indent=1), "utf-8")
    beside.replace(STAMP)


def install(extras: set[str], *, project: bool = True) -> None:
    """Brings `.venv` up to date with the extras wanted, and with the project unless told not to.

    The stamp is taken away before anything changes and written when it is whole again, so an
    interrupted set-up starts anew.
    """
    check_machine()
    try:
        stamp = json.loads(STAMP.read_text("utf-8"))
    except (OSError, ValueError):
        stamp = {}
    if stamp.get("python") != sys.version or stamp.get("place") != str(VENV):
        stamp = {}
    extras = {"build", "paper", *extras, *stamp.get("extras", [])}

    if not stamp:
        STAMP.unlink(missing_ok=True)
        print("run.py: the first run compiles pindrive, for about a minute", file=sys.stderr)
        quietly("making .venv", [sys.executable, "-m", "venv", "--clear", str(VENV)])
    wanted, sources = requirements(extras), fingerprint()
    needs = stamp.get("requirements") != wanted
    builds = project and stamp.get("sources") != sources
    if needs:
        STAMP.unlink(missing_ok=True)
        if builds:
            pip("installing what builds pindrive", "install", *requirements({"build"}, runs=False))
    elif builds:
        write_stamp({**stamp, "sources": None})
    # Compilation takes all cores for most of the time, downloads take one for some of it.
    with ThreadPoolExecutor(1) as beside:
        built = beside.submit(build_wheel) if builds else None
        if needs:
            pip("installing what pindrive needs", "install", *wanted)
            stamp |= {"python": sys.version, "place": str(VENV)}
            stamp |= {"extras": sorted(extras), "requirements": wanted}
            write_stamp({**stamp, "sources": None} if builds else stamp)
        if built:
            built.result()
    if builds:
        install_wheel()
        write_stamp({**stamp, "sources": sources})


def run(*command: str | Path) -> int:
    """Runs a program of `.venv` in the root of the project; its exit status."""
    program = shutil.which(str(command[0]), path=str(BIN)) or str(command[0])
    arguments = [program, *map(str, command[1:])]
    return subprocess.run(arguments, cwd=ROOT, env=environment(), check=False).returncode

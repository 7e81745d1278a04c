"""Builds the sdist and from it wheels, judges them, and tries them where nothing else is.

Called by `python3 run.py wheel [--complete] [PYTHON...]`; all are left in build/dist.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Iterable
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIST = ROOT / "build" / "dist"
EXAMPLE = ROOT / "examples" / "tactile-mouse.toml"
LARGEST = 8.0  # MB, of a wheel with the page and the libraries of FMUs for all platforms
SLOWEST = 20.0  # s, of the installation and the first command after it
C_LIBRARY = "-Ccmake.define.PINDRIVE_C=ON"
PLATFORMS = 6  # those of `python3 run.py fmu-binaries`


def contents(names: Iterable[str]) -> tuple[bool, list[str]]:
    """Return if the studio page is among the files, and the platforms of the FMU library."""
    found = set(names)
    libraries = (re.fullmatch(r"pindrive/fmu/([^/]+)/pindrive\.(?:so|dll|dylib)", n) for n in found)
    return "pindrive/studio.html" in found, sorted(match[1] for match in libraries if match)


def tags(name: str) -> tuple[str, str, str]:
    """The tags in the file name of a wheel: Python, ABI, platform."""
    python, abi, platform = name.removesuffix(".whl").split("-")[-3:]
    return python, abi, platform


def faults(name: str, size: float, names: Iterable[str], *, complete: bool) -> list[str]:
    """Return the errors of a wheel of a size in MB with these files, a line each.

    Args:
        name: Its file name.
        size: Its size in MB (1e6 bytes).
        names: The files in it.
        complete: Whether the studio page and the FMU library for every platform must be there.
    """
    found = set(names)
    page, platforms = contents(found)
    python, abi, platform = tags(name)
    wrong = []
    if size > LARGEST:
        wrong.append(f"{name} has {size:.2f} MB; at most {LARGEST:g} MB are allowed")
    if not platforms:
        wrong.append(f"{name} has no library of FMUs")
    if not any(re.fullmatch(r"pindrive/lib/(lib)?pindrive\.\w+", each) for each in found):
        wrong.append(f"{name} has no C library")
    if complete and not page:
        wrong.append(f"{name} lacks the studio page; build it with `python3 run.py studio`")
    if complete and len(platforms) < PLATFORMS:
        wrong.append(
            f"{name} has libraries of FMUs for {', '.join(platforms)} alone; "
            "compile the others with `python3 run.py fmu-binaries`"
        )
    if platform.startswith("linux_"):
        wrong.append(f"{name} is for this machine's Linux alone, not manylinux")
    if python != "cp311" and (python, abi) != ("cp312", "abi3"):
        wrong.append(f"{name} is for {python}-{abi}, not cp312-abi3, the stable ABI")
    stable = any(name.startswith("pindrive/_core.abi3.") for name in found)
    if abi == "abi3" and not stable and not platform.startswith("win"):  # there it is _core.pyd
        wrong.append(f"{name} says abi3, but its extension was not built so")
    return wrong


def call(what: str, *command: str | Path, **options: object) -> str:
    """Runs a step and returns what it printed; ends with that if it fails."""
    print(f"{what} ...", flush=True)
    result = subprocess.run(
        [*map(str, command)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
        **options,  # type: ignore[call-overload]
    )
    if result.returncode:
        sys.stderr.write(result.stdout)
        raise SystemExit(f"wheel: {what} failed, see above")
    return str(result.stdout)


def build() -> tuple[Path, Path]:
    """The sdist and the wheel made from it by this Python."""
    shutil.rmtree(DIST, ignore_errors=True)
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder)
        module = (sys.executable, "-m", "build", "--no-isolation", C_LIBRARY, "--outdir", made)
        call("building the sdist, and the wheel from it", *module, ROOT)
        (sdist,) = made.glob("*.tar.gz")
        (wheel,) = made.glob("*.whl")
        DIST.mkdir(parents=True)
        return Path(shutil.copy2(sdist, DIST)), kept(wheel)


def build_with(python: str, sdist: Path) -> Path:
    """The wheel that another Python makes of an sdist, with what it fetches to build it."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        programs = environment(python, place / "venv")
        making = (
            programs / "python",
            "-m",
            "pip",
            "wheel",
            "--no-deps",
            C_LIBRARY,
            "--wheel-dir",
            place,
        )
        call(f"building the wheel of {name_of(python)}", *making, sdist)
        (wheel,) = place.glob("*.whl")
        return kept(wheel)


def kept(wheel: Path) -> Path:
    """The wheel in build/dist: on Linux with its manylinux tag, of the stable ABI as it says."""
    with tempfile.TemporaryDirectory() as folder:
        if sys.platform == "linux":
            repair = (sys.executable, "-m", "auditwheel", "repair", "--strip", "-w", folder, wheel)
            call("auditing it", *repair)
            (wheel,) = Path(folder).glob("*.whl")
        if tags(wheel.name)[1] == "abi3":
            call("auditing its ABI", sys.executable, "-m", "abi3audit", "--strict", wheel)
        return Path(shutil.copy2(wheel, DIST))


def environment(python: str | Path, place: Path) -> Path:
    """Makes a new environment of a Python, with pip alone; where its programs are."""
    call("making an environment", python, "-m", "venv", place)
    return place / ("Scripts" if os.name == "nt" else "bin")


@cache
def version_of(python: str | Path) -> tuple[int, int]:
    """Return the version of an interpreter: 3, 12."""
    asked = "import sys; print(*sys.version_info[:2])"
    said = call(f"asking {python} for its version", python, "-c", asked).split()
    return int(said[0]), int(said[1])


def name_of(python: str | Path) -> str:
    """Python 3.12."""
    return "Python {}.{}".format(*version_of(python))


def serves(wheel: Path, version: tuple[int, int]) -> bool:
    """Return True if a wheel fits that version of Python."""
    python, abi, _ = tags(wheel.name)
    own = (3, int(python.removeprefix("cp3")))
    return version >= own if abi == "abi3" else version == own


def try_out(wheel: Path, python: str | Path) -> tuple[float, float, float]:
    """Seconds of the installation of a wheel, of the first command after it, and of the extra.

    It goes into a new environment, where no program is found but that environment's, so neither a
    compiler nor CMake, and it runs in an empty folder. With the extra "complete" it draws.
    """
    with tempfile.TemporaryDirectory() as folder:
        programs = environment(python, Path(folder, "venv"))
        kept = ("SYSTEMROOT", "TEMP", "TMP", "HOME", "USERPROFILE", "PIP_INDEX_URL")
        bare = {name: os.environ[name] for name in kept if name in os.environ}
        bare |= {"PATH": str(programs), "PYTHONUTF8": "1"}
        pip = (programs / "python", "-m", "pip", "install", "--disable-pip-version-check")
        command = (programs / "pindrive", "simulate", EXAMPLE)

        def timed(what: str, *arguments: str | Path) -> tuple[float, str]:
            begin = time.monotonic()
            printed = call(what, *arguments, env=bare, cwd=folder)
            return time.monotonic() - begin, printed

        installing, _ = timed("installing it", *pip, "--only-binary", ":all:", wheel)
        simulating, printed = timed("simulating the example with it", *command)
        if "Laws checked" not in printed:
            raise SystemExit(f"wheel: simulate printed no check of its laws, but:\n{printed}")
        loading = "import ctypes, pindrive; ctypes.CDLL(pindrive.get_library()).pindrive_drive_new"
        timed("loading its C library", programs / "python", "-c", loading)
        extra = f"{wheel}[complete]"
        completing, _ = timed(
            'installing the extra "complete"', *pip, "--only-binary", ":all:", extra
        )
        timed("drawing the example with it", *command, "--plot", "motion.png")
        if not Path(folder, "motion.png").is_file():
            raise SystemExit("wheel: simulate --plot wrote no picture")
    return installing, simulating, completing


def judge(wheel: Path, *, complete: bool) -> list[str]:
    """Return the errors of a wheel; prints its contents."""
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    page, platforms = contents(names)
    size = wheel.stat().st_size / 1e6
    print(f"{wheel.relative_to(ROOT)}: {size:.2f} MB of {LARGEST:g} MB")
    print(f"  studio page: {'yes' if page else 'no, `python3 run.py studio` builds it'}")
    print(f"  FMU libraries: {', '.join(platforms) or 'none'}")
    return faults(wheel.name, size, names, complete=complete)


def main() -> int:
    """Builds, judges and tries; the exit status."""
    parser = argparse.ArgumentParser(prog="run.py wheel", description=__doc__)
    parser.add_argument(
        "--complete",
        action="store_true",
        help="fail where the studio page or the FMU library for a platform is missing",
    )
    parser.add_argument("pythons", nargs="*", metavar="PYTHON", help="other interpreters")
    arguments = parser.parse_args()
    sdist, first = build()
    print(f"{sdist.relative_to(ROOT)}: {sdist.stat().st_size / 1e6:.2f} MB")
    wheels, wrong = [first], judge(first, complete=arguments.complete)
    for python in (sys.executable, *arguments.pythons):
        version = version_of(python)
        wheel = next((each for each in wheels if serves(each, version)), None)
        if wheel is None:
            wheel = build_with(python, sdist)
            wheels.append(wheel)
            wrong += judge(wheel, complete=arguments.complete)
        installing, simulating, completing = try_out(wheel, python)
        if installing + simulating > SLOWEST:
            took = f"{installing:.1f} s and the first command {simulating:.1f} s"
            wrong.append(f"the installation took {took} of {SLOWEST:g} s")
        print(
            f"{name_of(python)}: {wheel.name} installed in {installing:.1f} s, "
            f"first `pindrive simulate` in {simulating:.1f} s, all of [complete] "
            f"in {completing:.1f} s",
            flush=True,
        )
    for line in wrong:
        print(f"wheel: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

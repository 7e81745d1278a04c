#!/usr/bin/env python3
"""Sets pindrive up in `.venv` beside this file and runs it; needs Python alone.

    python3 run.py                    simulate examples/tactile-mouse.toml and draw it
    python3 run.py test [ARG...]      run the tests; arguments go to pytest
    python3 run.py explore [COUNT [SEED]]
                                      run the tests of random cases with COUNT (10) new seeds
    python3 run.py lint [STEP...]     check style, types and stubs, or only the steps named
    python3 run.py format             lay out Python and C++ as lint wants them
    python3 run.py studio [test|bench]
                                      build the studio, a page; test or time it in a browser
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

import ast
import hashlib
import json
import os
import secrets
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
BIN = VENV / ("Scripts" if os.name == "nt" else "bin")
STAMP = VENV / "pindrive.json"
STUB = ROOT / "src" / "pindrive" / "_core.pyi"
EXAMPLE = Path("examples", "tactile-mouse.toml")
PICTURE = Path("tactile-mouse.png")
ACTIONLINT = "github.com/rhysd/actionlint/cmd/actionlint@v1.7.12"
FMU_OF_CAPI = ("drive.cpp", "stepper.cpp")
SOURCES = ("pyproject.toml", "CMakeLists.txt", "include", "capi", "fmu", "src")

# What FMI 3 calls a platform, what the compiler does, and how its libraries end.
FMU_PLATFORMS = {
    "x86_64-linux": ("x86_64-linux-gnu.2.17", "so"),
    "aarch64-linux": ("aarch64-linux-gnu.2.17", "so"),
    "x86_64-windows": ("x86_64-windows-gnu", "dll"),
    "aarch64-windows": ("aarch64-windows-gnu", "dll"),
    "x86_64-darwin": ("x86_64-macos", "dylib"),
    "aarch64-darwin": ("aarch64-macos", "dylib"),
}

# Small, and linked as C: fmu/runtime.cpp takes the place of what a runtime of C++ adds. Nothing
# is thrown, so that no frame needs a table to unwind it: on Windows these are a tenth of the file.
FMU_COMPILE = (
    *("-std=c++17", "-Os", "-Xclang", "-Oz", "-g0", "-DPINDRIVE_WITHIN", "-ffp-contract=off"),
    *("-fno-math-errno", "-fno-exceptions", "-fno-rtti", "-ffunction-sections", "-fdata-sections"),
    *("-fomit-frame-pointer", "-fno-stack-protector"),
    *("-fno-unwind-tables", "-fno-asynchronous-unwind-tables"),
)
FMU_COMPILE_FOR = {
    "so": ("-fPIC", "-fvisibility=hidden"),
    "dll": (),  # there the functions of FMI alone are exported
    "dylib": ("-fPIC", "-fvisibility=hidden"),
}
FMU_LINK_FOR = {
    "so": ("-Wl,--gc-sections", "-Wl,--version-script=fmu/exports.map"),
    "dll": ("-Os", "-Wl,--gc-sections"),
    "dylib": ("-Wl,-dead_strip", "-Wl,-x"),
}

# Zig's own runtime would come whole, a quarter of the library: what is called of it is in
# fmu/runtime.cpp.
FMU_LINK_WINDOWS = (
    *("-OReleaseSmall", "-fstrip", "--gc-sections", "--build-id=none"),
    *("-lc", "-fno-compiler-rt", "-fno-emit-implib"),
)

# A package manager, and what it installs: Python, its venv module, its headers, a C++ compiler.
INSTALLERS = {
    "apt-get": (
        "sudo apt-get install python3.11 python3.11-venv python3.11-dev",
        "sudo apt-get install python{v}-venv",
        "sudo apt-get install python{v}-dev",
        "sudo apt-get install g++",
    ),
    "dnf": (
        "sudo dnf install python3.11 python3.11-devel",
        "sudo dnf install python3-libs",
        "sudo dnf install python3-devel",
        "sudo dnf install gcc-c++",
    ),
    "brew": (
        "brew install python@3.13",
        "brew reinstall python@{v}",
        "brew reinstall python@{v}",
        "xcode-select --install",
    ),
    "xcode-select": (
        "open https://www.python.org/downloads/",
        "open https://www.python.org/downloads/",
        "open https://www.python.org/downloads/",
        "xcode-select --install",
    ),
    "winget": (
        "winget install Python.Python.3.13",
        "winget install Python.Python.{v}",
        "winget install Python.Python.{v}",
        "winget install Microsoft.VisualStudio.2022.BuildTools --override "
        '"--wait --passive --add Microsoft.VisualStudio.Workload.VCTools --includeRecommended"',
    ),
}
PYTHON, VENV_MODULE, HEADERS, COMPILER = range(4)


# ---- what the machine must have ------------------------------------------------------------------


def stop(message: str) -> NoReturn:
    """Ends with one line on stderr and status 2."""
    print(f"run.py: {message}", file=sys.stderr)
    raise SystemExit(2)


def remedy(need: int) -> str:
    """The command that installs what is missing, for the package manager found here."""
    version = "{}.{}".format(*sys.version_info)
    for manager, commands in INSTALLERS.items():
        if shutil.which(manager):
            return f"install it with: {commands[need].format(v=version)}"
    return "install it with your system's package manager"


def has(module: str) -> bool:
    """Whether a module is there; an empty folder of its name is not enough."""
    spec = find_spec(module)
    return spec is not None and spec.origin is not None


def compiler() -> str | None:
    """The C++ compiler that CMake will find, or None."""
    if sys.platform == "darwin":
        tools = subprocess.run(["xcode-select", "-p"], capture_output=True, check=False)
        if tools.returncode:
            return None  # the c++ on PATH is then a stand-in that offers to install one
    for name in (os.environ.get("CXX", "").split(" ")[0], "c++", "g++", "clang++", "cl"):
        if name and shutil.which(name):
            return name
    return visual_studio() if os.name == "nt" else None


def visual_studio() -> str | None:
    """Visual Studio's C++ tools, which are not on PATH: its own locator knows where they are."""
    programs = os.environ.get("PROGRAMFILES(X86)", "C:/Program Files (x86)")
    locator = Path(programs, "Microsoft Visual Studio", "Installer", "vswhere.exe")
    if not locator.exists():
        return None
    tools = "Microsoft.VisualStudio.Component.VC.Tools.x86.x64"
    query = [str(locator), "-products", "*", "-requires", tools, "-property", "installationPath"]
    found = subprocess.run(query, capture_output=True, text=True, check=False).stdout.splitlines()
    return found[0] if found else None


def check_machine() -> None:
    """Stops with the command to type if something needed is missing."""
    if sys.version_info < (3, 11):  # noqa: UP036
        found = "{}.{}".format(*sys.version_info)
        stop(f"Python 3.11 or newer is needed, this is {found}; {remedy(PYTHON)}")
    if not (has("venv") and has("ensurepip")):
        stop(f"Python's venv module is missing; {remedy(VENV_MODULE)}")
    if not Path(sysconfig.get_path("include"), "Python.h").exists():
        stop(f"Python's C headers are missing; {remedy(HEADERS)}")
    if compiler() is None:
        stop(f"no C++ compiler found; {remedy(COMPILER)}")


# ---- the environment -----------------------------------------------------------------------------


def requirements(extras: set[str]) -> list[str]:
    """What pyproject.toml asks for, to build, to run, and in these extras."""
    import tomllib

    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    project = pyproject["project"]

    def extra(name: str) -> Iterator[str]:
        for line in project["optional-dependencies"][name]:
            if line.startswith("pindrive["):
                yield from extra(line[len("pindrive[") : -1])
            else:
                yield line

    wanted = {*pyproject["build-system"]["requires"], *project["dependencies"]}
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


def pip(what: str, *arguments: str) -> None:
    """Installs into `.venv`."""
    python = str(BIN / "python")
    quietly(what, [python, "-m", "pip", "install", "--disable-pip-version-check", *arguments])


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
    extras = {"build", "complete", *extras, *stamp.get("extras", [])}

    if not stamp:
        STAMP.unlink(missing_ok=True)
        quietly("making .venv", [sys.executable, "-m", "venv", "--clear", str(VENV)])
    wanted = requirements(extras)
    if stamp.get("requirements") != wanted:
        STAMP.unlink(missing_ok=True)
        pip("installing what pindrive needs", *wanted)
        stamp |= {"python": sys.version, "place": str(VENV)}
        stamp |= {"extras": sorted(extras), "requirements": wanted}
        write_stamp(stamp)
    sources = fingerprint()
    if project and stamp.get("sources") != sources:
        write_stamp({**stamp, "sources": None})
        build = "--config-settings=build-dir=build/{wheel_tag}"
        pip("building pindrive", "--no-deps", "--no-build-isolation", build, ".")
        write_stamp({**stamp, "sources": sources})


def run(*command: str | Path) -> int:
    """Runs a program of `.venv` in the root of the project; its exit status."""
    program = shutil.which(str(command[0]), path=str(BIN)) or str(command[0])
    arguments = [program, *map(str, command[1:])]
    return subprocess.run(arguments, cwd=ROOT, env=environment(), check=False).returncode


# ---- lint ----------------------------------------------------------------------------------------


def cpp_files() -> list[Path]:
    """The C++ of the project."""
    folders = ("include", "src/pindrive", "capi", "fmu", "tests", "benchmarks")
    found = (p for folder in folders for p in (ROOT / folder).rglob("*.[ch]pp"))
    return sorted(p.relative_to(ROOT) for p in found)


def clang_tidy() -> int:
    """The core's headers, as the programs that use them instantiate them."""
    folders = ("capi", "fmu", "tests")
    programs = [p for p in cpp_files() if p.suffix == ".cpp" and p.parts[0] in folders]
    headers = ("-Iinclude", "-Isrc/pindrive", "-Icapi", "-isystemfmu/fmi2", "-isystemfmu/fmi3")
    return run("clang-tidy", "--quiet", *programs, "--", "-std=c++17", *headers)


def installed_stub() -> Path:
    """The stub that nanobind wrote when the project was last built."""
    packages = sysconfig.get_path("platlib", "venv", {"base": str(VENV), "platbase": str(VENV)})
    return Path(packages, "pindrive", STUB.name)


def check_stub() -> int:
    """Whether the committed stub declares what the built extension does; layout apart."""
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
    "clang-tidy": clang_tidy,
    "workflows": workflows,
    "stubs": check_stub,
    "typescript": lambda: run("python", Path("studio", "build.py"), "lint"),
}


def lint(steps: list[str]) -> int:
    """Runs the steps named, or all of them, to the end, and says which failed."""
    unknown = [step for step in steps if step not in LINT]
    if unknown:
        stop(f"no lint step {unknown[0]!r}; there are {', '.join(LINT)}")
    steps = steps or list(LINT)
    install({"dev"}, project="stubs" in steps or "typescript" in steps)
    failed = []
    for step in steps:
        print(f"run.py: {step}", flush=True)
        if LINT[step]():
            failed.append(step)
    print(f"run.py: failed: {', '.join(failed)}" if failed else "run.py: lint passed")
    return 1 if failed else 0


# ---- the commands --------------------------------------------------------------------------------


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
    """The tests of random cases with seeds that `test` does not draw, from SEED or a new one on."""
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
    failed = []
    for seed in range(first, first + count):
        print(f"run.py: seed {seed}", flush=True)
        profile = ("-m", "hypothesis", "--hypothesis-profile=explore", f"--hypothesis-seed={seed}")
        if status := run("python", "-m", "pytest", "-q", *profile, *files):
            failed.append(seed)
            if status != 1:  # of pytest: a test failed
                return status
    for seed in failed:
        print(f"run.py: failed; again with: python3 run.py explore 1 {seed}")
    if not failed:
        print(f"run.py: no failure; seeds {first} to {first + count - 1}")
    return 1 if failed else 0


def bench(arguments: list[str]) -> int:
    """The timings: those of `simulate`, or those named first in the arguments."""
    named = arguments[:1] if arguments and not arguments[0].startswith("-") else []
    program = Path("benchmarks", f"{named[0] if named else 'simulate'}.py")
    if not (ROOT / program).exists():
        names = sorted(path.stem for path in (ROOT / "benchmarks").glob("*.py"))
        stop(f"no benchmark {program.stem!r}; there are {', '.join(names)}")
    install({"bench"})
    return run("python", program, *arguments[len(named) :])


def fmu_binaries(platforms: list[str]) -> int:
    """The libraries that FMUs carry for the platforms named, or all; then installs them."""
    unknown = [name for name in platforms if name not in FMU_PLATFORMS]
    if unknown:
        stop(f"no platform {unknown[0]!r}; there are {', '.join(FMU_PLATFORMS)}")
    install({"fmu"}, project=False)
    for name in platforms or FMU_PLATFORMS:
        library = fmu_binary(name)
        print(f"{library.relative_to(ROOT)}: {library.stat().st_size / 1e3:.0f} kB", flush=True)
    write_stamp({**json.loads(STAMP.read_text("utf-8")), "sources": None})
    install({"fmu"})
    return 0


def fmu_binary(name: str) -> Path:
    """The library that an FMU carries for a platform, compiled here."""
    target, suffix = FMU_PLATFORMS[name]
    sources = [*sorted((ROOT / "fmu").glob("*.cpp")), *(ROOT / "capi" / n for n in FMU_OF_CAPI)]
    headers = [
        f"-I{ROOT / folder}" for folder in ("include", "capi", "fmu", "fmu/fmi2", "fmu/fmi3")
    ]
    library = ROOT / "build" / "fmu" / name / f"pindrive.{suffix}"
    library.parent.mkdir(parents=True, exist_ok=True)
    zig = [str(BIN / "python"), "-m", "ziglang"]
    with tempfile.TemporaryDirectory() as folder:
        objects = [str(Path(folder, f"{source.stem}.o")) for source in sources]
        for source, compiled in zip(sources, objects, strict=True):
            options = [*FMU_COMPILE, *FMU_COMPILE_FOR[suffix], *headers]
            compiling = [
                *zig,
                "c++",
                "-target",
                target,
                *options,
                "-c",
                str(source),
                "-o",
                compiled,
            ]
            quietly(f"compiling {source.name} for {name}", compiling)
        part = Path(folder, library.name)
        if name == "x86_64-windows":
            linking = [*zig, "build-lib", "-dynamic", "-target", target, *FMU_LINK_WINDOWS]
            quietly(f"linking for {name}", [*linking, *objects, f"-femit-bin={part}"])
        else:
            linking = [*zig, "cc", "-target", target, "-shared", "-s", *FMU_LINK_FOR[suffix]]
            quietly(f"linking for {name}", [*linking, *objects, "-o", str(part)])
        beside = library.with_name("part")
        shutil.copyfile(part, beside)
        beside.replace(library)
    return library


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
    """The documentation site; whatever Sphinx warns of is an error."""
    install({"docs"})
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


def layout() -> int:
    """Lays the sources out; what lint can only complain about is left to the author."""
    install({"dev"}, project=False)
    run("ruff", "check", "--fix-only", "--quiet")
    python = run("ruff", "format") or run("clang-format", "-i", *cpp_files())
    return python or run("python", Path("studio", "build.py"), "format")


def studio(arguments: list[str]) -> int:
    """Builds the page and puts it into the package; tests or times it in a browser."""
    if arguments[:1] not in ([], ["test"], ["bench"]):
        stop(f"studio takes test, bench or nothing, not {' '.join(arguments)!r}")
    install({"studio"})
    if status := run("python", Path("studio", "build.py")):
        return status
    install({"studio"})  # with the page
    if not arguments:
        return 0
    if arguments[0] == "bench":
        return run("python", Path("benchmarks", "studio.py"))
    os.environ["PINDRIVE_STUDIO"] = "1"
    return run("python", "-m", "pytest", Path("tests", "studio"), *arguments[1:])


def stubs() -> int:
    """Takes over the stub of the extension as built."""
    install(set())
    shutil.copyfile(installed_stub(), STUB)
    print(f"{STUB.relative_to(ROOT)} is up to date")
    return 0


def main(arguments: list[str]) -> int:
    """Runs the command named first in the arguments; returns the exit status."""
    command, rest = (arguments[0], arguments[1:]) if arguments else ("simulate", [])
    if command in ("-h", "--help"):
        print(__doc__)
        return 0
    taking = {"test": test, "explore": explore, "lint": lint, "bench": bench, "studio": studio}
    taking |= {"fmu-binaries": fmu_binaries, "wheel": wheel}
    alone = {"simulate": simulate, "format": layout, "stubs": stubs}
    alone |= {"docs": docs, "validation": validation}
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

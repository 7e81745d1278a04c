"""Requirements of a machine: Python, its venv module, its headers and a C++ compiler."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from importlib.util import find_spec
from pathlib import Path
from typing import NoReturn

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
    """Return True if a module exists; an empty folder of its name does not count."""
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

"""The libraries of FMUs for other platforms, run where Wine and QEMU are installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from platform import machine
from zipfile import ZipFile

import fmpy
import numpy as np
import pytest

from pindrive import load_device
from pindrive.files.fmu import inputs_of, write_fmu

ROOT = Path(__file__).resolve().parents[2]
MOUSE = ROOT / "examples" / "tactile-mouse.toml"
OUTPUTS = ("position", "velocity", "acceleration", "plate_force", "finger_force", "next_event_time")
# The x86-64 Wine of Debian and of others.
WINE = shutil.which("wine64", path=os.pathsep.join([os.environ.get("PATH", ""), "/usr/lib/wine"]))
# The user-mode emulator, and the C library of aarch64 as Debian's libc6-arm64-cross has it.
QEMU = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
SYSROOT = Path("/usr/aarch64-linux-gnu")


def driven(folder: Path, target: str, runs: list[str], resources: str, library: Path) -> str:
    """Return the output of the driver, compiled for a target."""
    program = folder / f"driver-{target}.exe"
    compiling = [sys.executable, "-m", "ziglang", "cc", "-target", target, "-O1", "-s"]
    source = Path(__file__).with_name("fmu_driver.c")
    headers = f"-I{ROOT / 'fmu' / 'fmi3'}"
    subprocess.run([*compiling, headers, source, "-o", program], check=True, timeout=300)
    device = load_device(MOUSE)
    description = fmpy.read_model_description(str(folder))
    numbers = {v.name: v.valueReference for v in description.modelVariables}
    requested = [f"i{numbers[name]}" for name in inputs_of(device)]
    requested += [f"o{numbers[name]}" for name in OUTPUTS]
    token = description.instantiationToken
    environment = {**os.environ, "WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    environment["WINEDLLOVERRIDES"] = "mscoree=;mshtml="  # no offer to install Mono and Gecko
    done = subprocess.run(
        [*runs, str(program), str(library), resources, token, *requested],
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture
def unit(tmp_path: Path) -> Path:
    """The folder of an FMU."""
    if not find_spec("ziglang"):
        pytest.skip("needs ziglang, which `python3 run.py fmu-binaries` installs")
    archive = tmp_path / "drive.fmu"
    write_fmu(load_device(MOUSE), archive)
    with ZipFile(archive) as packed:
        packed.extractall(tmp_path)
    return tmp_path


def library(unit: Path, name: str) -> Path:
    found = unit / "binaries" / name
    if not found.exists():
        pytest.skip(f"needs {name} of `python3 run.py fmu-binaries`")
    return found


pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or machine() != "x86_64", reason="emulators on Linux on x86-64"
)


def test_windows_library_equals_that_of_linux(unit: Path) -> None:
    if not WINE:
        pytest.skip("needs wine64")
    windows = library(unit, "x86_64-windows/pindrive.dll")
    linux = library(unit, "x86_64-linux/pindrive.so")
    folder = f"{unit / 'resources'}/"
    here = driven(unit, "x86_64-linux-gnu", [], folder, linux)
    there = driven(unit, "x86_64-windows-gnu", [WINE], f"Z:{folder}", windows)
    expected, found = (
        np.array(
            [[float.fromhex(word) for word in line.split()] for line in said.splitlines()[:-1]]
        )
        for said in (here, there)
    )
    assert expected.shape == (200, len(OUTPUTS))
    assert here.splitlines()[-1].startswith("a step must begin where the last one ended")
    assert there.splitlines()[-1] == here.splitlines()[-1]
    largest = np.where(expected < 1e300, np.abs(expected), 0.0).max(axis=0)
    assert (np.abs(found - expected) <= 1e-12 * largest).all()


def test_the_library_of_aarch64_has_the_bits_of_x86_64(unit: Path) -> None:
    if not QEMU or not SYSROOT.exists():
        pytest.skip("needs qemu-user-static and libc6-arm64-cross")
    here, there = (
        driven(
            unit,
            f"{name}-linux-gnu",
            runs,
            f"{unit / 'resources'}/",
            library(unit, f"{name}-linux/pindrive.so"),
        )
        for name, runs in (("x86_64", []), ("aarch64", [QEMU, "-L", str(SYSROOT)]))
    )
    assert len(here.splitlines()) == 201
    assert there == here

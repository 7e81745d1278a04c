"""The library of FMUs for Windows, run by Wine where it is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
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


def driven(folder: Path, target: str, runs: list[str], resources: str, library: Path) -> str:
    """What the driver, compiled for a target, prints."""
    program = folder / f"driver-{target}.exe"
    compiling = [sys.executable, "-m", "ziglang", "cc", "-target", target, "-O1", "-s"]
    source = Path(__file__).with_name("fmu_driver.c")
    headers = f"-I{ROOT / 'fmu' / 'fmi3'}"
    subprocess.run([*compiling, headers, source, "-o", program], check=True, timeout=300)
    device = load_device(MOUSE)
    description = fmpy.read_model_description(str(folder))
    numbers = {v.name: v.valueReference for v in description.modelVariables}
    asked = [f"i{numbers[name]}" for name in inputs_of(device)]
    asked += [f"o{numbers[name]}" for name in OUTPUTS]
    token = description.instantiationToken
    environment = {**os.environ, "WINEPREFIX": str(folder / "wine"), "WINEDEBUG": "-all"}
    done = subprocess.run(
        [*runs, str(program), str(library), resources, token, *asked],
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="Wine on Linux")
def test_the_windows_library_says_what_that_of_linux_does(tmp_path: Path) -> None:
    if not WINE or not find_spec("ziglang"):
        pytest.skip("needs wine64, and ziglang, which `python3 run.py fmu-binaries` installs")
    archive = tmp_path / "drive.fmu"
    write_fmu(load_device(MOUSE), archive)
    with ZipFile(archive) as unit:
        unit.extractall(tmp_path)
    windows, linux = (
        tmp_path / "binaries" / place
        for place in ("x86_64-windows/pindrive.dll", "x86_64-linux/pindrive.so")
    )
    if not windows.exists() or not linux.exists():
        pytest.skip("needs the libraries for x86-64 of `python3 run.py fmu-binaries`")
    folder = f"{tmp_path / 'resources'}/"
    here = driven(tmp_path, "x86_64-linux-gnu", [], folder, linux)
    there = driven(tmp_path, "x86_64-windows-gnu", [WINE], f"Z:{folder}", windows)
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

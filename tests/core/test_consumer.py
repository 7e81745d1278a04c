"""An outside CMake project uses the core as a subfolder; and the C++ tests pass.

That it can use an installed core is shown by docs/cpp.md.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cases import EXPLORES

ROOT = Path(__file__).resolve().parents[2]
COMPILES = pytest.mark.timeout(1800)
CONSUMER = ROOT / "tests" / "consumer"
HEADERS = sorted(ROOT.glob("include/pindrive/*/*.hpp"))
LAYERS = (
    "numbers",
    "flow",
    "model",
    "law",
    "series",
    "events",
    "motion",
    "certificate",
    "kernel",
    "bodies",
    "device",
)
"""Folders of the core, each built on the folders before."""
PUBLIC = {
    "bodies": {"follow", "step_certificate", "stored_motion", "system"},
    "certificate": {"certificate", "certify"},
    "device": {
        "closest_approach",
        "coil",
        "coil_course",
        "compliant_hand",
        "controller",
        "device_stream",
        "electromagnet",
        "evaluation",
        "hand_path",
        "inputs",
        "live_hand",
        "magnet_construction",
        "monotone_pieces",
        "pin_evaluation",
        "pin_follower",
        "pressing",
        "printed_lines",
        "raster",
        "scan",
        "scan_evaluation",
        "scan_inputs",
        "sign_change",
        "speed_limit",
        "two_lines",
    },
    "events": {"simulate", "stepper", "stepper_state"},
    "flow": {"flow", "oscillator"},
    "model": {"input_curves", "input_function", "input_period", "model", "named_function"},
    "motion": {
        "batch",
        "contact_use",
        "crossings",
        "duration",
        "energy",
        "instant",
        "motion",
        "sampling",
        "steady_numbers",
        "steady_since",
        "trajectory",
        "transient",
        "transient_numbers",
    },
    "numbers": {"callback", "dual", "functions", "limits", "named_number"},
    "series": {"input_range"},
}
"""Headers with names for users of the core; all further headers are in `pindrive::detail`."""
PATH = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])


def attempt(*command: str | Path) -> subprocess.CompletedProcess[str]:
    program = shutil.which(str(command[0]), path=PATH)
    assert program, f"{command[0]} is missing: it comes with the extra `test`"
    return subprocess.run(
        [program, *map(str, command[1:])],
        env={**os.environ, "PATH": PATH},
        capture_output=True,
        text=True,
        check=False,
    )


def run(*command: str | Path) -> str:
    """The program's output; its complaints, if it fails."""
    result = attempt(*command)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def build(source: Path, folder: Path, *settings: str) -> None:
    run("cmake", "-S", source, "-B", folder, "-G", "Ninja", *settings)
    run("cmake", "--build", folder)


def check(consumer: Path) -> None:
    """The program ran the core and got the answer that Python gets."""
    pindrive = pytest.importorskip("pindrive")
    drive = pindrive.Drive(
        mass=0.010,
        stiffness=100.0,
        damping=0.40,
        plate=pindrive.Contact(kinetic=0.020),
        finger=pindrive.Contact(kinetic=0.005),
    )
    motion = pindrive.simulate(drive, pindrive.Release(0.10, 1.5e-3))
    expected = [f"{segment.begin:.9f} s" for segment in motion.segments]
    position = f"x(0.02 s) = {float(motion.position(0.02)):.6e} m"
    assert run(consumer).split("\n") == [*expected, position, motion.ending.kind, ""]


def test_the_umbrella_header_shows_what_the_consumer_does() -> None:
    """The lines of use at the head of pindrive.hpp stand in a program that is built and checked."""
    head = (ROOT / "include" / "pindrive.hpp").read_text("utf-8")
    shown = re.findall(r"^///     (.*)$", head, re.MULTILINE)
    assert 0 < len(shown) <= 10

    def unbroken(text: str) -> str:
        return "".join(text.split())

    assert unbroken("".join(shown[1:])) in unbroken((CONSUMER / "main.cpp").read_text("utf-8"))


def test_the_core_stands_alone() -> None:
    """Headers of the standard library alone; nothing that allocates, throws or prints."""
    headers = {path.name: path.read_text("utf-8") for path in HEADERS}
    bodies = {path.name for path in HEADERS if path.parent.name == "bodies"}
    allowed = {
        "algorithm",
        "array",
        "cmath",
        "cstddef",
        "cstdint",
        "cstring",
        "iterator",
        "limits",
        "optional",
        "type_traits",
        "utility",
    }
    vectors = {"lanes.hpp": {"emmintrin.h", "immintrin.h"}}  # where the compiler has them
    for name, text in headers.items():
        code = re.sub(r"//.*", "", text)
        lists = {"memory", "vector"} if name.removesuffix(".hpp") in PUBLIC["device"] else set()
        lists |= {"set", "vector"} if name in bodies else set()
        assert set(re.findall(r"#include <(.*)>", code)) <= allowed | vectors.get(name, lists), name
        assert not re.search(r"\b(new|(?<!= )delete|malloc|throw|try)\b", code), name


def test_a_header_includes_its_own_layer_and_those_below_it_alone() -> None:
    assert {path.parent.name for path in HEADERS} == {*LAYERS}
    for path in HEADERS:
        own = LAYERS.index(path.parent.name)
        for layer in re.findall(r'#include "pindrive/(\w+)/\w+\.hpp"', path.read_text("utf-8")):
            assert LAYERS.index(layer) <= own, f"{path.relative_to(ROOT)} includes {layer}"


def test_the_certificate_includes_nothing_that_selects_modes_or_finds_events() -> None:
    for path in HEADERS:
        if path.parent.name == "certificate":
            assert not re.search(r'#include "pindrive/(law|events)/', path.read_text("utf-8")), path


def test_each_header_has_a_test_file() -> None:
    headers = {path.stem for path in HEADERS if "namespace" in path.read_text("utf-8")}
    tested = {path.stem.removesuffix("_test") for path in ROOT.glob("tests/cpp/*_test.cpp")}
    assert headers <= tested, sorted(headers - tested)


def test_build_is_optimised_by_default(tmp_path: Path) -> None:
    for settings, kind in ((), "Release"), (("-DCMAKE_BUILD_TYPE=Debug",), "Debug"):
        folder = tmp_path / kind
        run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *settings)
        assert f"CMAKE_BUILD_TYPE:STRING={kind}\n" in (folder / "CMakeCache.txt").read_text()


@COMPILES
def test_add_subdirectory(tmp_path: Path) -> None:
    build(CONSUMER, tmp_path / "build", f"-DPINDRIVE_SOURCE={ROOT.as_posix()}")
    check(tmp_path / "build" / "consumer")


@COMPILES
def test_installed_engine(c_library: Path, tmp_path: Path) -> None:
    prefix = f"-DCMAKE_PREFIX_PATH={c_library.as_posix()}"
    build(CONSUMER, tmp_path / "build", prefix, "-DPINDRIVE_TARGET=engine")
    check(tmp_path / "build" / "consumer")


@COMPILES
@pytest.mark.skipif(not list(ROOT.glob("tests/cpp/*.cpp")), reason="there are no C++ tests")
@pytest.mark.explore
def test_ctest(programs: Path, tmp_path: Path) -> None:
    run("ctest", "--test-dir", programs, "--output-on-failure", "--parallel", "2")
    if EXPLORES:
        for seed in "12":
            assert "failed 0" in run(programs / "fuzz", "50000", seed, "--threads", "2")
    same_however_it_is_run(programs / "fuzz", tmp_path / "fuzz.log")


def same_however_it_is_run(fuzz: Path, log: Path) -> None:
    """Fuzz has equal results on one thread, on three, and in two runs with a log."""

    def found(*options: str | Path) -> str:
        return re.sub(r"seconds .*", "", run(fuzz, *options))

    once = found("3000", "5")
    assert "drives 3000 of 3000" in once
    assert found("3000", "5", "--threads", "3") == once
    found("1000", "5", "--log", log)
    assert found("3000", "5", "--log", log) == once
    other = attempt(fuzz, "3000", "6", "--log", log)
    assert other.returncode == 2
    assert "is not the log of seed 6" in other.stderr


@COMPILES
@pytest.mark.skipif(not list(ROOT.glob("tests/cpp/*.cpp")), reason="there are no C++ tests")
@pytest.mark.sanitizers
def test_no_sanitizer_complains(tmp_path: Path) -> None:
    """The programs run without memory errors and undefined behaviour, with a shorter fuzz.

    Tests with the label `long` run where all random cases do.
    """
    settings = ("-DPINDRIVE_TESTS=ON", "-DPINDRIVE_SANITIZE=ON")
    configured = attempt("cmake", "-S", ROOT, "-B", tmp_path, "-G", "Ninja", *settings)
    if "this compiler has no -fsanitize" in " ".join(configured.stderr.split()):
        pytest.skip("this compiler has no sanitizers")
    assert configured.returncode == 0, configured.stderr
    run("cmake", "--build", tmp_path)
    assert b"__ubsan_handle" in (tmp_path / "fuzz").read_bytes()
    short = () if EXPLORES else ("-LE", "long")
    run("ctest", "--test-dir", tmp_path, "--output-on-failure", "--parallel", "2", *short)


def test_names_that_are_not_public_are_in_detail() -> None:
    for path in HEADERS:
        if path.stem in PUBLIC.get(path.parent.name, ()):
            continue
        text = path.read_text("utf-8")
        opened = re.findall(r"^namespace ([\w:]+) \{", text, re.MULTILINE)
        assert set(opened) <= {"pindrive::detail", "std"}, path.relative_to(ROOT)

"""Types and functions of `fmu/` against the standard's headers, which FMPy carries."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
FMU = ROOT / "fmu"
STANDARD = Path(fmpy.__file__).parent / "c-code"
COMPILER = shutil.which(os.environ.get("CXX", "c++"))
COMPILES = pytest.mark.skipif(COMPILER is None, reason="there is no C++ compiler")
FOLDERS = [FMU, ROOT / "bindings", ROOT / "capi", ROOT / "include"]


def compiled(text: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Check a text as a file of C++ that may include the standard's headers."""
    assert COMPILER
    source = folder / "source.cpp"
    source.write_text(text, "utf-8")
    includes = [f"-I{path}" for path in [*FOLDERS, STANDARD]]
    command = [COMPILER, "-std=c++17", "-fsyntax-only", "-DPINDRIVE_WITHIN", *includes, str(source)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@COMPILES
def test_types_are_those_of_the_standard(tmp_path: Path) -> None:
    text = (FMU / "fmi.hpp").read_text("utf-8")
    simple = re.findall(r"using (fmi\w+) = (?!void \(|void\* \()", text)
    structs = re.findall(r"struct (fmi\w+) \{(.*?)\};", text, re.S)
    enums = re.findall(r"enum (fmi\w+) \{(.*?)\};", text, re.S)
    callbacks = re.findall(r"using (fmi\w+) = void\*? \(", text)
    assert (len(simple), len(structs), len(enums), len(callbacks)) == (28, 1, 6, 9)
    checks = [f"static_assert(std::is_same_v<ours::{name}, ::{name}>);" for name in simple]
    for name, values in enums:
        checks.append(f"static_assert(sizeof(ours::{name}) == sizeof(::{name}));")
        for value in re.findall(r"\w+", values):
            checks.append(f"static_assert(int(ours::{value}) == int(::{value}));")
    for name, fields in structs:
        checks.append(f"static_assert(sizeof(ours::{name}) == sizeof(::{name}));")
        for field in re.findall(r"(\w+);", fields):
            checks.append(
                f"static_assert(offsetof(ours::{name}, {field}) == offsetof(::{name}, {field}));"
            )
    checks += [f"static_assert(sizeof(ours::{n}) == sizeof(::{n}));" for n in callbacks]
    head = (
        "#include <cstddef>\n#include <cstdint>\n#include <type_traits>\n"
        '#include "fmi2Functions.h"\n'
        "static_assert(fmi2True == 1 && fmi2False == 0);\n#undef fmi2True\n#undef fmi2False\n"
        '#include "fmi3Functions.h"\nnamespace ours {\n#include "fmi.hpp"\n}\n'
    )
    done = compiled(head + "\n".join(checks), tmp_path)
    assert done.returncode == 0, done.stderr
    wrong = head + "static_assert(std::is_same_v<ours::fmi2Real, ::fmi2Integer>);"
    assert compiled(wrong, tmp_path).returncode != 0


@COMPILES
@pytest.mark.parametrize("version", [2, 3])
def test_functions_are_those_of_the_standard(version: int, tmp_path: Path) -> None:
    """Each is defined as the standard declares it: C allows no second signature."""
    header = f"fmi{version}Functions.h"
    text = (FMU / f"fmi{version}.cpp").read_text("utf-8")
    macro = '#define PINDRIVE_FMI extern "C"'
    standard = text.replace('#include "fmi.hpp"', f'#include "{header}"\n{macro}')
    done = compiled(standard, tmp_path)
    assert done.returncode == 0, done.stderr
    step = f"fmi{version}DoStep("
    assert compiled(standard.replace(step, step + "int, "), tmp_path).returncode != 0

    declared = {
        *re.findall(r"^\s*FMI\d_Export \w+\s+(\w+);", (STANDARD / header).read_text(), re.M)
    }
    defined = {*re.findall(r"^PINDRIVE_FMI [\w\s]+\*?\s*\b(fmi\w+)\(", text, re.M)}
    defined |= {
        f"fmi3{verb}{kind}"
        for kind in re.findall(r"^PINDRIVE_NO_VARIABLES\((\w+)\)", text, re.M)
        for verb in ("Get", "Set")
    }
    assert defined <= declared
    # The functions of model exchange are optional in FMI 2; an importer of FMI 3 looks them up.
    assert len(declared - defined) == (10 if version == 2 else 0), sorted(declared - defined)

"""Checks of a wheel, and of the workflows: pinned actions and promised platforms."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tasks.commands import wheel
from tasks.environment import ROOT
from tasks.fmu_binaries import FMU_PLATFORMS
from wheels.build import contents, faults, serves

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))

LIBRARIES = [f"pindrive/fmu/{name}/pindrive.{end}" for name, (_, end) in FMU_PLATFORMS.items()]
WHOLE = [
    *("pindrive/_core.abi3.so", "pindrive/studio.html", "pindrive/lib/libpindrive.so"),
    *LIBRARIES,
]
GOOD = "pindrive-0.1.0-cp312-abi3-manylinux_2_28_x86_64.whl"


@pytest.mark.parametrize("name", [GOOD, GOOD.replace("cp312-abi3", "cp311-cp311")])
def test_a_whole_wheel_is_right(name: str) -> None:
    assert faults(name, 7.9, WHOLE, complete=True) == []
    assert contents(WHOLE) == (True, sorted(FMU_PLATFORMS))


@pytest.mark.parametrize(
    ("name", "size", "names", "complaint"),
    [
        (GOOD, 8.01, WHOLE, "has 8.01 MB; at most 8 MB"),
        (GOOD, 1.0, WHOLE[:2], "no library of FMUs"),
        (GOOD, 1.0, [n for n in WHOLE if "/lib/" not in n], "no C library"),
        (GOOD, 1.0, WHOLE[:-1], "for aarch64-linux"),
        (GOOD, 1.0, [n for n in WHOLE if "studio" not in n], "lacks the studio page"),
        (GOOD.replace("manylinux_2_28", "linux"), 1.0, WHOLE, "not manylinux"),
        (GOOD.replace("cp312-abi3", "cp313-cp313"), 1.0, WHOLE, "cp313-cp313, not cp312-abi3"),
        (GOOD, 1.0, ["pindrive/_core.cpython-312.so", *WHOLE[1:]], "was not built so"),
    ],
)
def test_faults_of_a_wheel(name: str, size: float, names: list[str], complaint: str) -> None:
    found = faults(name, size, names, complete=True)
    assert any(complaint in line for line in found), found
    assert all(line.startswith(name) for line in found)


def test_without_complete_the_page_and_other_platforms_may_be_missing() -> None:
    assert faults(GOOD, 1.0, [WHOLE[0], WHOLE[2], LIBRARIES[0]], complete=False) == []


def test_a_wheel_of_the_stable_abi_serves_later_pythons() -> None:
    stable, own = Path(GOOD), Path(GOOD.replace("cp312-abi3", "cp311-cp311"))
    versions = [(3, 11), (3, 12), (3, 13), (3, 14)]
    assert [serves(stable, version) for version in versions] == [False, True, True, True]
    assert [serves(own, version) for version in versions] == [True, False, False, False]


@pytest.mark.parametrize("workflow", WORKFLOWS, ids=lambda path: path.stem)
def test_actions_are_pinned_by_commit(workflow: Path) -> None:
    for line in re.findall(r"uses: *(.*)", workflow.read_text("utf-8")):
        assert re.fullmatch(r"\./.+|[\w./-]+@[0-9a-f]{40} # v\d+\.\d+\.\d+", line), line


def test_an_action_has_one_version() -> None:
    text = "".join(workflow.read_text("utf-8") for workflow in WORKFLOWS)
    pins = set(re.findall(r"uses: *([\w-][\w./-]*)@(.*)", text))
    assert len({name for name, _ in pins}) == len(pins) >= 5


def test_three_systems_and_the_oldest_and_a_newer_python_are_tested() -> None:
    text = (ROOT / ".github" / "workflows" / "tests.yml").read_text("utf-8")
    assert "system: [ubuntu-latest, windows-latest, macos-latest]" in text
    (versions,) = re.findall(r'python: \["([\d.]+)", "([\d.]+)"\]', text)
    assert PROJECT["project"]["requires-python"] == f">={versions[0]}"
    assert f"cp{versions[1].replace('.', '')}-*" in PROJECT["tool"]["cibuildwheel"]["build"]


def test_the_extension_forwards_the_component_of_the_stable_abi() -> None:
    """Without it nanobind drops STABLE_ABI and the wheel's tag is untrue."""
    text = (ROOT / "CMakeLists.txt").read_text("utf-8")
    assert "Development.Module ${SKBUILD_SABI_COMPONENT})" in text
    assert "nanobind_add_module(_core STABLE_ABI" in text


def test_recipe_has_the_dependencies_of_the_project() -> None:
    recipe = (ROOT / "recipe" / "recipe.yaml").read_text("utf-8")
    listed = {line.replace(" ", "") for line in re.findall(r"^    - (.*)", recipe, re.MULTILINE)}
    project = PROJECT["project"]
    needed = {
        *project["dependencies"],
        *project["optional-dependencies"]["build"],
        *PROJECT["build-system"]["requires"],
    }
    on_conda = {"matplotlib>=3.10.8": "matplotlib-base>=3.10.8"}
    assert {on_conda.get(name, name) for name in needed} - listed == set()
    version = re.findall(
        r"^project\(pindrive VERSION ([\d.]+)",
        (ROOT / "CMakeLists.txt").read_text("utf-8"),
        re.MULTILINE,
    )
    assert re.findall(r'^  version: "(.*)"', recipe, re.MULTILINE) == version


def test_wrong_result_form_requests_device_and_certificate() -> None:
    form = (ROOT / ".github" / "ISSUE_TEMPLATE" / "wrong-result.yml").read_text("utf-8")
    requested = re.findall(r"id: (\w+)\n(?:.*\n)*?    validations:\n      required: true", form)
    assert {"device", "certificate", "command", "version"} <= set(requested)


@pytest.mark.parametrize("arguments", [["--whole"], ["--complete", "no-python"]])
def test_arguments_of_wheel(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        wheel(arguments)
    assert stopped.value.code == 2
    assert " ".join(arguments) in capsys.readouterr().err


def test_a_release_names_the_address_that_its_workflow_runs_in(tmp_path: Path) -> None:
    """In the metadata that the build backend makes, and where a citation and the recipe have it."""
    names = ("pyproject.toml", "CMakeLists.txt", "README.md", "LICENSE", "CITATION.cff")
    for name in (*names, "recipe/recipe.yaml", "wheels/address.py"):
        target = tmp_path / name
        target.parent.mkdir(exist_ok=True)
        shutil.copyfile(ROOT / name, target)
    script = [sys.executable, str(tmp_path / "wheels" / "address.py")]
    reported = {
        "GITHUB_SERVER_URL": "https://forge.example",
        "GITHUB_REPOSITORY": "someone/pindrive",
    }
    left = {k: v for k, v in os.environ.items() if k not in reported}
    refused = subprocess.run(script, env=left, capture_output=True, text=True, check=False)
    assert refused.returncode == 2 and len(refused.stderr.splitlines()) == 1
    for _ in range(2):  # once more changes nothing
        subprocess.run(script, env=left | reported, check=True, capture_output=True)
    make = "from scikit_build_core.build import prepare_metadata_for_build_wheel as make; make('.')"
    subprocess.run([sys.executable, "-c", make], cwd=tmp_path, check=True, capture_output=True)
    (metadata,) = tmp_path.glob("*.dist-info/METADATA")
    said = re.findall(r"^Project-URL: (.*)$", metadata.read_text("utf-8"), re.M)
    address = "https://forge.example/someone/pindrive"
    assert said == [
        f"Source, {address}",
        f"Documentation, {address}/tree/HEAD/docs",
        f"Issues, {address}/issues",
        f"Changelog, {address}/blob/HEAD/CHANGELOG.md",
    ]
    assert f"\nrepository-code: {address}\n" in (tmp_path / "CITATION.cff").read_text("utf-8")
    recipe = (tmp_path / "recipe" / "recipe.yaml").read_text("utf-8")
    assert recipe.count(f"  repository: {address}\n") == 1
    (workflow,) = (path for path in WORKFLOWS if path.name == "wheels.yml")
    text = workflow.read_text("utf-8")
    assert text.index("python wheels/address.py") < text.index("python run.py wheel")

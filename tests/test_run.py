"""run.py on machines that lack something, in other folders, interrupted, and in a hurry."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from hypothesis import settings

import run
from tasks import changes, checks, commands, environment, machine

SCRIPT = environment.ROOT / "run.py"


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    """A `.venv` that records what would be installed in it; the list of steps taken."""
    steps: list[str] = []

    def quietly(what: str, command: list[str]) -> None:
        steps.append(what)
        environment.VENV.mkdir(exist_ok=True)

    monkeypatch.setattr(environment, "VENV", tmp_path / ".venv")
    monkeypatch.setattr(environment, "STAMP", tmp_path / ".venv" / "pindrive.json")
    monkeypatch.setattr(environment, "WHEELS", tmp_path / "wheels")
    monkeypatch.setattr(environment, "quietly", quietly)
    monkeypatch.setattr(environment, "fingerprint", lambda: "as it was")
    return steps


def refusal(capsys: pytest.CaptureFixture[str]) -> str:
    """The one line with which the machine is refused."""
    with pytest.raises(SystemExit) as stopped:
        machine.check_machine()
    assert stopped.value.code == 2
    line = capsys.readouterr().err
    assert line.count("\n") == 1
    return line


def only(*programs: str) -> object:
    """A `shutil.which` for a machine with these programs alone."""
    return lambda name, **_: f"/usr/bin/{name}" if name in programs else None


def test_this_machine_has_what_it_takes() -> None:
    machine.check_machine()


@pytest.mark.parametrize(
    ("manager", "command"),
    [
        ("apt-get", "sudo apt-get install g++"),
        ("dnf", "sudo dnf install gcc-c++"),
        ("brew", "xcode-select --install"),
        ("winget", "winget install Microsoft.VisualStudio.2022.BuildTools"),
        ("none", "your system's package manager"),
    ],
)
def test_no_compiler(
    manager: str,
    command: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(shutil, "which", only(manager))
    assert "no C++ compiler found" in (line := refusal(capsys))
    assert command in line


def test_the_compiler_named_by_cxx_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", only("clang++-19"))
    monkeypatch.setenv("CXX", "clang++-19 -stdlib=libc++")
    assert machine.compiler() == "clang++-19"


@pytest.mark.parametrize("module", ["venv", "ensurepip"])
def test_no_venv_module(
    module: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(machine, "has", lambda name: name != module)
    monkeypatch.setattr(shutil, "which", only("apt-get"))
    package = "python{}.{}-venv".format(*sys.version_info)
    assert f"sudo apt-get install {package}" in refusal(capsys)


def test_an_empty_folder_is_no_module(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "hollow").mkdir()
    monkeypatch.syspath_prepend(tmp_path)
    assert machine.has("venv")
    assert not machine.has("hollow")
    assert not machine.has("nowhere")


def test_no_headers(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setattr(sysconfig, "get_path", lambda _: str(tmp_path))
    monkeypatch.setattr(shutil, "which", only("dnf"))
    assert "sudo dnf install python3-devel" in refusal(capsys)


def test_an_old_python(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(sys, "version_info", (3, 9, 2))
    assert "Python 3.11 or newer is needed, this is 3.9" in refusal(capsys)


@pytest.mark.skipif(os.name == "nt", reason="PATH says little about compilers on Windows")
def test_the_script_itself_without_a_compiler(tmp_path: Path) -> None:
    """From another folder, too."""
    env = {k: v for k, v in os.environ.items() if k != "CXX"} | {"PATH": str(tmp_path)}
    result = subprocess.run(
        [sys.executable, str(SCRIPT)],
        cwd=tmp_path,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stdout) == (2, "")
    assert "no C++ compiler found" in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("arguments", [["tset"], ["format", "src"], ["lint", "rough"]])
def test_unknown_command_is_refused(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        run.main(arguments)
    assert stopped.value.code == 2


MADE, FIRST = "making .venv", "installing what builds pindrive"
NEEDS, BUILT, PLACED = "installing what pindrive needs", "building pindrive", "installing pindrive"
ALL = {MADE, FIRST, NEEDS, BUILT, PLACED}


def test_installed_packages_are_not_installed_again(
    installed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def steps() -> set[str]:
        """The steps since the last call, of which two run side by side."""
        taken = set(installed)
        installed.clear()
        return taken

    environment.install(set())
    assert installed[:2] == [MADE, FIRST] and installed[-1] == PLACED
    assert steps() == ALL
    environment.install(set())
    assert steps() == set()
    monkeypatch.setattr(environment, "fingerprint", lambda: "edited")
    environment.install(set())
    assert steps() == {BUILT, PLACED}
    environment.install({"test"})
    assert steps() == {NEEDS}
    environment.install(set())
    assert steps() == set(), "the extra stays"
    environment.install({"docs"}, project=False)
    assert steps() == {NEEDS}


@pytest.mark.parametrize("interrupted", [MADE, FIRST, NEEDS, BUILT, PLACED])
def test_an_interrupted_setup_is_taken_up_again(
    interrupted: str, installed: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    finish = environment.quietly

    def quietly(what: str, command: list[str]) -> None:
        finish(what, command)
        if what == interrupted:
            raise KeyboardInterrupt

    monkeypatch.setattr(environment, "quietly", quietly)
    with pytest.raises(KeyboardInterrupt):
        environment.install(set())
    monkeypatch.setattr(environment, "quietly", finish)
    installed.clear()
    environment.install(set())
    assert {*installed} == ({BUILT, PLACED} if interrupted in (BUILT, PLACED) else ALL)


@pytest.mark.parametrize("key", ["python", "place"])
def test_an_environment_of_another_python_or_place_is_made_anew(
    key: str, installed: list[str]
) -> None:
    environment.install(set())
    stamp = json.loads(environment.STAMP.read_text("utf-8"))
    environment.STAMP.write_text(json.dumps({**stamp, key: "another"}), "utf-8")
    installed.clear()
    environment.install(set())
    assert {*installed} == ALL


def test_clang_tidy_checks_the_programs_of_changed_files() -> None:
    def checked(*files: str) -> set[str]:
        return {path.as_posix() for path in checks.checked_by_clang_tidy({*files})}

    assert checked("README.md", "src/pindrive/_core.cpp") == set()
    assert checked("engine/motion.cpp", "gone.cpp") == {"engine/motion.cpp"}
    assert checked("include/pindrive/law/skin.hpp") == {"tests/cpp/skin_test.cpp"}
    of_fmu = checked("fmu/entry.hpp")
    assert {"fmu/fmi2.cpp", "fmu/fmi3.cpp"} < of_fmu
    assert all(name.startswith("fmu/") for name in of_fmu)
    assert len(checks.checked_by_clang_tidy(None)) > 100


def test_changes_of_a_day_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(changes, "ROOT", tmp_path)
    assert changes.changed_files() is None, "there is no repository"
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", os.devnull)

    def commit(name: str, time: int) -> None:
        (tmp_path / name).write_text(name)
        monkeypatch.setenv("GIT_COMMITTER_DATE", f"{time} +0000")
        changes.git("add", ".")
        changes.git("-c", "user.name=a", "-c", "user.email=a@b", "commit", "-m", name)

    changes.git("init")
    commit("first", 1_700_000_000)
    assert changes.changed_files() is None, "the first commit has none before"
    commit("second", 1_700_000_000 + changes.DAY)
    commit("third", 1_700_000_060 + changes.DAY)
    (tmp_path / "new").touch()
    assert changes.changed_files() == {"second", "third", "new"}


def test_failing_step_prints_its_output(capsys: pytest.CaptureFixture[str]) -> None:
    speak = [sys.executable, "-c", "print('no such header'); raise SystemExit(3)"]
    with pytest.raises(SystemExit, match="building failed"):
        environment.quietly("building", speak)
    assert "no such header" in capsys.readouterr().err


def test_the_extras_hold_the_extras_they_name() -> None:
    build, test, dev = (
        set(environment.requirements({extra})) for extra in ("build", "test", "dev")
    )
    assert build < test < dev
    assert all("pindrive" not in line for line in dev)


def test_explore_draws_each_seed_and_prints_its_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    started: list[tuple[str, ...]] = []

    def fake(*command: str | Path) -> int:
        started.append(tuple(map(str, command)))
        return int("--hypothesis-seed=8" in command)

    monkeypatch.setenv("PINDRIVE_EXPLORE", "")
    monkeypatch.setattr(commands, "install", lambda extras: None)
    monkeypatch.setattr(commands, "run", fake)
    assert run.main(["explore", "3", "7"]) == 1
    assert started[0][-2:] == ("-m", "explore")
    seeds = [next(a for a in command if "seed" in a) for command in started[1:]]
    assert seeds == ["--hypothesis-seed=7", "--hypothesis-seed=8", "--hypothesis-seed=9"]
    assert any(a.endswith("test_laws.py") for a in started[1])
    assert not any(a.endswith("test_readme.py") for a in started[1])
    assert "again with: python3 run.py explore 1 8" in capsys.readouterr().out
    with pytest.raises(SystemExit) as stopped:
        run.main(["explore", "many"])
    assert stopped.value.code == 2


def test_a_test_run_draws_the_same_cases_everywhere() -> None:
    same = settings.get_profile("same")
    assert same.derandomize
    assert same.deadline is None
    assert not settings.get_profile("explore").derandomize

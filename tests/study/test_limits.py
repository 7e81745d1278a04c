"""Sweeps at the limits: a full disk, little memory, a cluster that loses a worker."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from pindrive.files.output import OutputError
from pindrive.study import runner
from studies import SAMPLED, files, plan, run, uninterrupted


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


# ---- a full disk ---------------------------------------------------------------------------------


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 4 MB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    options = ["-t", "tmpfs", "-o", "size=4m", "tmpfs", str(folder)]
    try:
        subprocess.run(["mount", *options], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("a small file system cannot be mounted here; it takes root on Linux")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_a_disk_too_small_is_refused_at_once(small_disk: Path) -> None:
    plan(SAMPLED.replace("2048", "20480"))
    said = run("study.toml", "-o", str(small_disk / "study.nc"))
    assert said.exit_code == 2
    assert "study.nc: needs 14.5 MB, and the disk has 4.19 MB; take fewer points" in said.stderr
    assert not list(small_disk.iterdir())


def test_a_disk_that_fills_up_keeps_finished_chunks(small_disk: Path) -> None:
    study = plan('outputs = ["swing"]\n' + SAMPLED.replace("2048", "16384"))
    runner.sweep(study, Path("whole.nc"))
    ballast, target = small_disk / "ballast", small_disk / "study.nc"

    def fill(done: int, total: int) -> None:
        if done >= 3000 and not ballast.exists():
            with contextlib.suppress(OSError), ballast.open("wb", buffering=0) as file:
                while file.write(bytes(4096)):
                    pass

    words = r"study\.nc\.partial: cannot be written: No space left on device; \d+ finished chunks "
    with pytest.raises(OutputError, match=words + "are kept, `resume=True` continues with them"):
        runner.sweep(study, target, progress=fill)
    ballast.unlink()
    result = runner.sweep(study, target, resume=True)
    assert 0 < result.worked_out < result.points
    assert target.read_bytes() == Path("whole.nc").read_bytes()


# ---- memory --------------------------------------------------------------------------------------

PEAK = """
import resource, sys
from pindrive.cli.app import app
app(sys.argv[1:], standalone_mode=False)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""


def test_memory_is_bounded_by_the_chunk() -> None:
    """A hundred million points need the memory of forty thousand, for equally many chunks."""
    pytest.importorskip("resource")

    def peak(count: int) -> int:
        plan(
            f"""
            outputs = ["settling_time"]
            chunk = 4096
            [axes]
            mass = {{ lin = ["2 g", "20 g"], count = {count} }}
            plate.kinetic = {{ uniform = ["5 mN", "100 mN"] }}
            [sample]
            count = {count}
            """
        )
        arguments = ["sweep", "study.toml", "--stop-after", "20000", "--threads", "2", "--force"]
        command = [sys.executable, "-c", PEAK, *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert "Stopped at 20 480 of" in done.stdout or count == 200
        return int(done.stdout.split()[-1])

    assert peak(10_000) < peak(200) + 16 * 1024, "kB"


# ---- a cluster -----------------------------------------------------------------------------------


def test_a_cluster_that_loses_a_worker_gives_the_same_file() -> None:
    distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    from pindrive.study.runner import on_cluster

    whole = uninterrupted()
    killed: list[int] = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", silence_logs=50
    ) as cluster:

        def kill(done: int, total: int) -> None:
            if done > total // 4 and not killed:
                killed.append(cluster.workers[0].pid)
                os.kill(killed[0], signal.SIGKILL)

        result = runner.sweep(
            plan(), Path("study.nc"), work=on_cluster(cluster.scheduler_address), progress=kill
        )
    assert killed and result.complete
    assert Path("study.nc").read_bytes() == whole


@pytest.mark.parametrize("place", ["tcp://127.0.0.1:9", "nobody.json", "study.toml.json"])
def test_a_cluster_that_is_not_there(place: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed", reason="the extra `cluster` is not installed")
    monkeypatch.setattr("pindrive.study.workers._PATIENCE", 0.2)
    plan()
    Path("study.toml.json").write_text("[]")
    said = run("study.toml", "--cluster", place)
    assert said.exit_code == 2
    required = "the address of a Dask scheduler, like tcp://10.0.0.1:8786, or its .json file"
    assert said.stderr.startswith(f"--cluster must be {required}, got {place}: ")
    assert files() == {"study.toml", "study.toml.json"}


def test_workers_of_another_version_are_refused() -> None:
    from pindrive import __version__
    from pindrive.study.workers import _check_versions

    _check_versions({"tcp://one": __version__, "tcp://two": __version__})
    with pytest.raises(ValueError, match=r"must be version .*, got 0\.0\.1 on tcp://two"):
        _check_versions({"tcp://one": __version__, "tcp://two": "0.0.1"})

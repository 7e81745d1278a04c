"""Sweeps: the file holds what `simulate` says, and whatever stops one, nothing is lost."""

from __future__ import annotations

import errno
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

import h5py
import numpy as np
import pytest
import xarray as xr

from pindrive import Contact, Drive, Release, simulate
from pindrive.files.output import OutputError
from pindrive.study import runner
from pindrive.study.spec import load_study
from pindrive.study.store import Journal, Piece, Store
from pindrive.study.study import Study
from studies import HERE, SAMPLED, files, plan, run, uninterrupted


@pytest.fixture(autouse=True)
def in_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


# ---- what the file holds -------------------------------------------------------------------------


def test_numbers_are_those_of_simulate() -> None:
    """At points all over a product of a sample and grids, every number of the table."""
    plan()
    assert run("study.toml").exit_code == 0
    with xr.open_dataset("study.nc") as data:
        assert data.sizes == {"sample": 2048, "mouse_velocity": 2, "duration": 1}
        assert data.mass.dims == ("sample",)
        for i in (0, 1, 499, 777, 2047):
            for j in (0, 1):
                at = data.isel(sample=i, mouse_velocity=j, duration=0)
                drive = Drive(
                    mass=float(at.mass),
                    stiffness=float(at.stiffness),
                    damping_ratio=float(at.damping_ratio),
                    plate=Contact(float(at.plate_kinetic)),
                    finger=Contact(float(at.finger_kinetic)),
                )
                motion = simulate(drive, Release(float(at.mouse_velocity)), duration=0.2)
                numbers = motion.numbers()
                for name, value in numbers.items():
                    variable = name.replace(".", "_")
                    if variable in data:
                        np.testing.assert_allclose(
                            at[variable], value, rtol=1e-9, atol=1e-15, err_msg=name
                        )
                assert at.events == len(motion.events)


def test_the_ledger_is_kept_where_it_is_named() -> None:
    """Energy terms are only in files that name them, with the values of `simulate`."""
    axes = '[axes]\nmouse_velocity = ["20 mm/s", "90 mm/s"]\n'
    plan(axes)
    run("study.toml", "-o", "without.nc")
    plan('outputs = ["settling_time", "damper_dissipated", "energy.residual"]\n' + axes)
    run("study.toml", "-o", "with.nc")
    with xr.open_dataset("without.nc") as data, xr.open_dataset("with.nc") as named:
        assert not [name for name in data if str(name).startswith("energy")]
        assert set(named) == {
            "transient_settling_time",
            "energy_damper_dissipated",
            "energy_residual",
            "status",
        }
        assert named.energy_damper_dissipated.attrs["units"] == "J"
        device = load_study("study.toml").device
        for i, speed in enumerate(named.mouse_velocity.values):
            motion = simulate(device.drive, Release(speed))
            assert named.energy_damper_dissipated[i] == motion.energy.damper_dissipated
            assert abs(named.energy_residual[i]) < 1e-12 * motion.energy.damper_dissipated


def test_file_has_all_results() -> None:
    """Units, meanings, the whole study, the device and the version."""
    import pindrive

    plan('[axes]\nmass = { log = ["2 g", "20 g"], count = 3 }\nplate.kinetic = ["1 mN", "2 mN"]\n')
    run("study.toml", "-o", "out.nc")
    with xr.open_dataset("out.nc") as data:
        assert data.mass.attrs["units"] == "kg"
        assert data.mass.attrs["spacing"] == "log"
        np.testing.assert_allclose(data.mass, [2e-3, np.sqrt(40e-6), 20e-3])
        assert data.transient_settling_time.attrs["units"] == "s"
        assert data.transient_settled.dtype == bool
        assert data.status.attrs["flag_meanings"].split()[0] == "ok"
        assert data.attrs["source"] == f"pindrive {pindrive.__version__}"
        assert 'mass = { log = ["2 g"' in data.attrs["study"]
        assert 'stiffness = "100 N/m"' in data.attrs["study"], "the device file"
        assert data.stiffness == 100.0
        assert set(data.coords) == {
            *("mass", "stiffness", "damping", "plate_kinetic", "finger_kinetic"),
            *("preload", "mouse_velocity", "displacement", "plate_load", "settling_band"),
            *("force", "across_velocity", "finger_load", "touch_share", "load_exponent"),
        }
        assert data.transient_plate_reversals.notnull().all()
        assert "transient_peak_stretch" not in data, "the finger is rigid"


def test_the_device_may_stand_in_the_study() -> None:
    device = (HERE / "minimal.toml").read_text()
    Path("whole.toml").write_text(f'{device}\n[axes]\ndrive.mass = ["2 g", "3 g"]\n')
    plan('[axes]\nmass = ["2 g", "3 g"]\n')
    assert run("whole.toml").exit_code == run("study.toml").exit_code == 0
    with xr.open_dataset("whole.nc") as one, xr.open_dataset("study.nc") as other:
        xr.testing.assert_identical(one.drop_attrs(), other.drop_attrs())


def test_points_without_numbers_are_marked_and_counted() -> None:
    plan('[axes]\nplate.kinetic = ["1 mN", "20 mN"]\nplate.static = ["2 mN", "30 mN"]\n')
    said = run("study.toml").stdout.splitlines()
    assert said[1:] == [
        "settled: all of those with numbers",
        "without numbers: 25 %, by their status",
        "  25 % bad_plate_static: plate.static must be at least the kinetic friction, 0.02 N, "
        "got 0.002 N",
    ]
    with xr.open_dataset("study.nc") as data:
        bad = data.sel(plate_kinetic=0.020, plate_static=0.002)
        assert np.isnan(bad.transient_swing) and np.isnan(bad.transient_plate_reversals)
        assert data.transient_swing.notnull().sum() == 3


def test_threads_and_chunks_change_nothing() -> None:
    one, other = plan(), plan(SAMPLED.replace("chunk = 500", "chunk = 77"), "other.toml")
    runner.sweep(one, Path("a.nc"), work=runner.on_threads(1))
    runner.sweep(one, Path("b.nc"), work=runner.on_threads(3))
    runner.sweep(other, Path("c.nc"))
    assert Path("a.nc").read_bytes() == Path("b.nc").read_bytes()
    with xr.open_dataset("a.nc") as a, xr.open_dataset("c.nc") as c:
        xr.testing.assert_identical(a.drop_attrs(), c.drop_attrs())


def test_many_listed_values_fit() -> None:
    """The study's own text may be longer than HDF5's 64 kB of an attribute."""
    values = ", ".join(f'"{1000 + i} mg"' for i in range(9000))
    plan(f'outputs = ["swing"]\n[axes]\nmass = [{values}]\n')
    assert run("study.toml").exit_code == 0
    with xr.open_dataset("study.nc") as data:
        assert len(data.attrs["study"]) > 90_000
        np.testing.assert_allclose(data.mass[-1], 9.999e-3)


# ---- stopped and gone on with --------------------------------------------------------------------


@pytest.fixture
def whole() -> bytes:
    return uninterrupted()


def test_stopped_and_resumed_is_the_same_file(whole: bytes) -> None:
    assert "--resume continues" in run("study.toml", "--stop-after", "700").stdout
    assert files() >= {"study.nc.partial", "study.nc.journal"}
    assert "study.nc" not in files()
    again = run("study.toml")
    assert (again.exit_code, again.stdout) == (2, "")
    assert again.stderr == (
        "study.nc.journal: an unfinished run is there; --resume continues it, --force begins anew\n"
    )
    assert run("study.toml", "--resume").exit_code == 0
    assert Path("study.nc").read_bytes() == whole
    assert files() == {"study.toml", "whole.nc", "study.nc"}
    assert "is complete" in run("study.toml", "--resume").stdout


@pytest.mark.skipif(not hasattr(os, "fork"), reason="a process is killed in a fork of this one")
@pytest.mark.parametrize("moment", ["between two chunks", "within one", "before it is noted"])
def test_killed_and_resumed_is_the_same_file(whole: bytes, moment: str) -> None:
    """SIGKILL at the worst moments: what was noted is kept, and half a chunk does no harm."""
    child = os.fork()
    if not child:
        die_in_a_sweep(moment)
    assert os.waitpid(child, 0)[1] == signal.SIGKILL
    kept = Path("study.nc.journal").read_bytes().count(b"\n") - 1
    assert kept == 4
    result = runner.sweep(load_study("study.toml"), Path("study.nc"), resume=True)
    assert 0 < result.worked_out <= result.points - (kept - 1) * 500
    assert Path("study.nc").read_bytes() == whole


def test_one_that_ends_as_it_opens_its_journal_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stop(*_: object) -> NoReturn:
        raise KeyboardInterrupt

    study = plan()
    monkeypatch.setattr(Journal, "_read", stop)
    with pytest.raises(KeyboardInterrupt):
        runner.sweep(study, Path("study.nc"))
    assert files() == {"study.toml"}


def die_in_a_sweep(moment: str) -> NoReturn:
    """After four chunks, in the middle of the file."""
    put, note = Store.put, Journal.note
    chunks = 0

    def die() -> None:
        os.kill(os.getpid(), signal.SIGKILL)

    def put_some(store: Store, pieces: list[Piece]) -> None:
        nonlocal chunks
        chunks += 1
        if moment == "within one" and chunks == 5:
            put(store, [piece._replace(values=piece.values[:100]) for piece in pieces])
            die()
        put(store, pieces)
        if moment == "before it is noted" and chunks == 5:
            die()

    def note_and_die(journal: Journal, *entry: Any) -> None:
        note(journal, *entry)
        if moment == "between two chunks" and chunks == 4:
            die()

    Store.put = put_some  # type: ignore[method-assign, assignment]
    Journal.note = note_and_die  # type: ignore[method-assign, assignment]
    runner.sweep(load_study("study.toml"), Path("study.nc"))
    os._exit(1)


def test_ctrl_c_keeps_what_is_done(whole: bytes) -> None:
    study = plan()

    def interrupt(done: int, total: int) -> None:
        if done > 1500:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        runner.sweep(study, Path("study.nc"), progress=interrupt)
    result = runner.sweep(study, Path("study.nc"), resume=True)
    assert 0 < result.worked_out <= result.points - 1500
    assert Path("study.nc").read_bytes() == whole


def test_damaged_chunks_are_computed_again(whole: bytes) -> None:
    """A line cut off, and bytes that never reached the disk."""
    run("study.toml", "--stop-after", "2000")
    journal, part = Path("study.nc.journal"), Path("study.nc.partial")
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:-1]) + lines[-1][:7])
    with h5py.File(part) as file:
        place = file["transient_swing"].id.get_offset() + 600 * 8
    content = bytearray(part.read_bytes())
    content[place] ^= 1
    part.write_bytes(content)
    assert run("study.toml", "--resume").exit_code == 0
    assert Path("study.nc").read_bytes() == whole


def test_a_ruined_file_is_not_gone_on_with() -> None:
    plan()
    run("study.toml", "--stop-after", "700")
    Path("study.nc.partial").write_bytes(b"rubbish")
    said = run("study.toml", "--resume")
    assert said.exit_code == 2
    assert said.stderr.startswith("study.nc.partial: is damaged: ")
    assert said.stderr.endswith("; --force begins anew\n")
    Path("study.nc.journal").write_bytes(b"rubbish\n")
    said = run("study.toml", "--resume")
    assert said.stderr == "study.nc.journal: is no journal of a study\n"
    assert run("study.toml", "--force").exit_code == 0


def test_a_changed_study_is_not_gone_on_with(whole: bytes) -> None:
    run("study.toml", "--stop-after", "700")
    before = Path("study.nc.partial").read_bytes()
    plan(SAMPLED.replace('"20 g"', '"30 g"'))
    said = run("study.toml", "--resume")
    assert said.exit_code == 2
    assert said.stderr == (
        "study.nc.journal: another study was begun there: dimensions[0] axes drive.mass second was "
        "0.02, is 0.03; --force begins anew\n"
    )
    said = run("study.toml", "-o", "whole.nc", "--resume")
    assert "whole.nc: holds another study: dimensions[0] axes drive.mass second" in said.stderr
    assert Path("study.nc.partial").read_bytes() == before
    assert Path("whole.nc").read_bytes() == whole
    plan()
    assert run("study.toml", "--force").exit_code == 0
    assert Path("study.nc").read_bytes() == whole


def test_one_process_at_a_time() -> None:
    fcntl = pytest.importorskip("fcntl")
    run_of = plan()
    with Path("study.nc.journal").open("w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        for how in ("--resume", "--force"):
            said = run("study.toml", how)
            assert said.stderr == "study.nc.journal: another process is at this study\n"
    assert run_of.chunks == 9


def test_a_failure_before_the_first_chunk_leaves_nothing() -> None:
    def broken(plan: Study, chunks: list[int]) -> Iterator[tuple[int, list[Piece]]]:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(OutputError, match="No space left on device; no chunk was finished yet"):
        runner.sweep(plan(), Path("study.nc"), work=broken)
    assert files() == {"study.toml"}


REFUSED = {
    "none.toml": "none.toml: cannot be read: No such file or directory",
    "study.toml -o study.toml": "study.toml: is read by this command; give another name",
    "study.toml -o no/study.nc": "no/study.nc: cannot be written: there is no folder no",
    "study.toml -o .": ".: cannot be written: not a regular file",
    "study.toml --resume --force": "give --resume or --force, not both",
    "study.toml --threads 2 --cluster x": "give --threads or --cluster, not both: workers have "
    "their own",
    "still.toml": "still.toml: has no axes; write what to vary in [axes]",
}


@pytest.mark.parametrize("arguments", REFUSED)
def test_refusals(arguments: str) -> None:
    plan()
    plan("", "still.toml")
    before = files()
    said = run(*arguments.split())
    assert (said.exit_code, said.stdout) == (2, "")
    assert said.stderr == f"{REFUSED[arguments]}\n"
    assert files() == before

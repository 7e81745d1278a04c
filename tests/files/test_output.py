"""Files that are whole or not there, whatever stood in their place."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from pindrive.files.output import OutputError, atomic_write, check_folder, write_files


def test_who_reads_the_old_file_keeps_it_whole(tmp_path: Path) -> None:
    """The new one takes its place; nothing is written over it."""
    target, reader = tmp_path / "out", tmp_path / "reader"
    target.write_text("old")
    reader.hardlink_to(target)
    with atomic_write(target) as part:
        part.write_text("new")
        assert target.read_text() == "old"
    assert (target.read_text(), reader.read_text()) == ("new", "old")
    assert sorted(tmp_path.iterdir()) == [target, reader]


def test_a_link_stays_and_its_target_is_replaced(tmp_path: Path) -> None:
    target, link = tmp_path / "old", tmp_path / "link"
    target.write_text("old")
    link.symlink_to(target)
    with atomic_write(link) as part:
        part.write_text("new")
    assert link.is_symlink()
    assert target.read_text() == "new"


def test_failure_leaves_the_old_file_alone(tmp_path: Path) -> None:
    target = tmp_path / "out"
    target.write_text("old")
    with pytest.raises(ZeroDivisionError), atomic_write(target) as part:
        part.write_text("half")
        raise ZeroDivisionError
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_a_target_that_is_no_file_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="not a regular file"), atomic_write(tmp_path):
        pytest.fail("entered all the same")


# ---- many files ----------------------------------------------------------------------------------


class Interrupted(Mapping[str, bytes]):
    """Files of which the last is never there: the user lost patience."""

    def __len__(self) -> int:
        return 3

    def __iter__(self) -> Iterator[str]:
        return iter(("a", "deep/er/b", "c"))

    def __getitem__(self, name: str) -> bytes:
        if name == "c":
            raise KeyboardInterrupt
        return b"new"


def test_files_come_in_folders_that_need_not_be_there(tmp_path: Path) -> None:
    write_files(tmp_path / "new", {"a": b"1", "deep/er/b": b"2"})
    assert (tmp_path / "new/a").read_bytes() == b"1"
    assert (tmp_path / "new/deep/er/b").read_bytes() == b"2"
    assert len([p for p in tmp_path.rglob("*") if p.is_file()]) == 2


def test_an_interrupt_leaves_no_file_and_no_folder(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, Interrupted())
    assert [p.name for p in tmp_path.rglob("*")] == ["a"]
    assert (tmp_path / "a").read_text() == "old"
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path / "new" / "deep", Interrupted())
    assert [p.name for p in tmp_path.rglob("*")] == ["a"]


def test_a_folder_that_is_none_is_refused_and_nothing_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine")
    for folder in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(OutputError, match="is not a folder"):
            check_folder(folder)
    check_folder(tmp_path / "new" / "deep")
    assert [p.name for p in tmp_path.iterdir()] == ["file"]
    (tmp_path / "b").mkdir()
    with pytest.raises(OutputError, match="not a regular file"):
        write_files(tmp_path, {"a": b"1", "b": b"2"})
    assert sorted(p.name for p in tmp_path.iterdir()) == ["b", "file"]

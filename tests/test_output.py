"""Files that are whole or not there, whatever stood in their place."""

from pathlib import Path

import pytest

from pindrive.output import OutputError, atomic_write


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


def test_what_goes_wrong_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
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

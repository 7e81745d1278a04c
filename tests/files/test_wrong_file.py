"""A file of another sort than a command takes: one line says what it is and what takes it."""

from __future__ import annotations

from pathlib import Path

import pytest

from command import EXAMPLE, EXAMPLES, GOOD, refused, run

pytestmark = pytest.mark.usefixtures("in_empty_folder")

STUDY = EXAMPLES / "tactile-mouse-study.toml"
PAGED = EXAMPLES / "tactile-reader-study.toml"


@pytest.mark.parametrize("command", ["check", "simulate", "scan", "speed"])
@pytest.mark.parametrize(
    ("study", "has"), [(STUDY, "base and [axes]"), (PAGED, "[page] and [axes]")]
)
def test_a_study_where_a_device_is_wanted(command: str, study: Path, has: str) -> None:
    assert refused(command, study) == (
        f"{study}: is a study file, as it has {has}; `pindrive sweep`, `sensitivity` and "
        "`robustness` take it"
    )


@pytest.mark.parametrize("command", ["sweep", "sensitivity", "robustness"])
def test_a_device_where_a_study_is_wanted(command: str) -> None:
    Path("device.toml").write_text(GOOD)
    for device in (EXAMPLE, Path("device.toml")):
        assert refused(command, device) == (
            f'{device}: is a device file; a study names it, base = "{device.name}", and says what '
            "to vary in [axes] or [tolerances]"
        )


def test_a_study_of_a_study() -> None:
    Path("first.toml").write_text(GOOD + '[axes]\nmass = ["1 g"]\n')
    Path("second.toml").write_text('base = "first.toml"\n[axes]\nmass = ["1 g"]\n')
    assert refused("sweep", "second.toml").startswith(
        "first.toml: is a study file, as it has [axes]; "
    )


def test_a_result_where_a_file_of_text_is_wanted() -> None:
    Path("study.toml").write_text(GOOD + '[axes]\nmass = ["1 g"]\n')
    assert run("sweep", "study.toml").exit_code == 0
    for command in ("check", "simulate", "sweep", "robustness"):
        assert refused(command, "study.nc") == (
            "study.nc: is a NetCDF file; `pindrive map` draws one that a sweep wrote"
        )
    assert refused("map", "study.toml", "--plot", "map.png") == (
        "study.toml: cannot be read: it is no NetCDF file; `pindrive sweep` writes one of a study"
    )


def test_a_device_file_with_a_mistake_is_still_one() -> None:
    """A table that nothing knows does not make it a study."""
    Path("device.toml").write_text(GOOD + "[axis]\n")
    assert refused("check", "device.toml").startswith("device.toml: unknown key axis; ")

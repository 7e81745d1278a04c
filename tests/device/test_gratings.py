"""Groups of lines, by their number or their length, and the report of a page that no pin met."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pindrive as pd
from command import EXAMPLES, run
from pindrive.device.gratings import LineGroup, line_group
from pindrive.device.page import Scene
from pindrive.study.design import read_page

READER = EXAMPLES / "tactile-reader.toml"


@pytest.mark.parametrize(
    ("given", "group"),
    [
        (0.004, (0.004, 4)),
        ("4 mm", (0.004, 4)),
        ("12 x 4 mm", (0.004, 12)),
        ("12 × 4 mm", (0.004, 12)),
        ("4 mm over 60 mm", (0.004, 15)),
        ("0.1 mm over 6 cm", (0.0001, 600)),
        ("70 mm over 60 mm", (0.070, 1)),
        ((0.004, 7), (0.004, 7)),
        (LineGroup(0.002, 3), (0.002, 3)),
    ],
)
def test_a_group_has_a_pitch_and_a_number_of_lines(given: object, group: tuple[float, int]) -> None:
    assert line_group(given, "pitch") == group
    assert line_group(LineGroup(*group).words, "pitch") == pytest.approx(group)


def dark_runs(scene: Scene) -> int:
    row = scene.luminance[scene.luminance.shape[0] // 2] < 0.5
    return int(np.count_nonzero(row[1:] & ~row[:-1]))


def test_pages_are_printed_with_as_many_lines() -> None:
    page = pd.Page(grating=["12 x 4 mm", 0.002, "1 mm over 9 mm"])
    assert page.options == '--grating "12 x 4 mm, 2 mm, 9 x 1 mm"'
    device = pd.load_device(READER, whole=True)
    scene = page.scene(device.reading, device.device.array)
    assert dark_runs(scene) == 12 + 4 + 9
    assert dark_runs(Scene.from_grating([0.004, (0.002, 3)], count=2)) == 5
    printed = scene.printed()
    assert printed is not None
    pages = 11.5 * 0.004 + 3.5 * 0.002 + 8.5 * 0.001
    assert printed[1] - printed[0] > pages
    assert Scene(np.ones((3, 3)), 1e-3).printed() is None


def test_commands_and_study_files_take_groups(tmp_path: Path) -> None:
    small = ("--set", "array.columns=1", "--set", "array.rows=1")
    said = run("scan", READER, *small, "--grating", "9 x 3 mm")
    assert "9 lines passed under the pins" in said.output, said.output
    page = read_page({"grating": ["2 x 4 mm", "2 mm"]}, tmp_path / "study.toml")
    assert page.grating == ((0.004, 2), (0.002, 4))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("0 x 2 mm", '--grating: count must be a whole number of lines, like "12 x 4 mm", got "0"'),
        ("a x 2 mm", '--grating: count must be a whole number of lines, like "12 x 4 mm", got "a"'),
        ("3 x 2 g", '--grating: pitch must be in m or a unit alike, like "4 mm", got "2 g"'),
        ("2 mm over 4 g", '--grating: length must be in m or a unit alike, like "4 mm", got "4 g"'),
    ],
)
def test_malformed_groups_are_refused_in_a_line(given: str, said: str) -> None:
    assert run("scan", READER, "--grating", given).stderr.strip() == said


def test_a_hand_that_met_nothing_is_told_where_the_print_is(tmp_path: Path) -> None:
    hand = tmp_path / "hand.csv"
    hand.write_text("time [s], x [mm], y [mm]\n0,0,15\n0.5,1,15\n1,2,15\n", "utf-8")
    said = run("scan", READER, "--grating", "4 mm", "--path", hand).stderr
    assert "the print is 12.5 to 26.5 mm across, and the spots pass -3.75 to 5.75 mm" in said


def test_init_tells_the_page_that_a_device_fits(tmp_path: Path) -> None:
    said = run("init", tmp_path / "device.toml", "--device").output
    assert "Its 16 pins look at spots 7.5 mm across and 7.5 mm down" in said

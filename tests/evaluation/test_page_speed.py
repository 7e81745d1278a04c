"""Largest hand speed over a text."""

from __future__ import annotations

import pytest

import pindrive as pd
from command import EXAMPLES, refused, run
from pindrive.evaluation.page_speed import all_settled, all_shown, speeds_over_page

READER = EXAMPLES / "tactile-reader.toml"


def test_the_limits_are_the_last_speeds_at_which_all_is_well() -> None:
    file, reported = pd.load_device(READER), list[tuple[int, int]]()
    found = speeds_over_page(
        file.device,
        file.reading,
        pd.Page(text="I"),
        slowest=0.05,
        progress=lambda done, of: reported.append((done, of)),
    )
    for limit, holds in ((found.shown_speed, all_shown), (found.settled_speed, all_settled)):
        at = [*found.counts]
        assert all(holds(found.counts[speed]) for speed in at if speed <= limit)
        after = at[at.index(limit) + 1]
        assert not holds(found.counts[after])
        assert after <= 1.011 * limit
    assert found.settled_speed < found.shown_speed
    assert reported == sorted(reported)
    assert reported[-1][0] == reported[-1][1]
    assert list(found.to_dataset().hand_speed) == list(found.counts)


@pytest.mark.usefixtures("in_empty_folder")
def test_command_reports_the_speed_of_a_text() -> None:
    said = run("speed", READER, "--text", "I", "--slowest", "50 mm/s", "--plot", "a.png")
    assert said.exit_code == 0, said.output
    assert "All lines are shown and none is false: up to " in said.stdout
    assert "Hands in finger studies move at 20.00 to 100.0 mm/s" in said.stdout
    line = refused("speed", READER, "--text", "I", "--pitch", "4 mm")
    assert line == "give --text or --pitch and --width, not both"

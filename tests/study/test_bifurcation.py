"""Bifurcation diagrams: two motions on a belt, between stops, and what is refused."""

from __future__ import annotations

from math import exp, log
from pathlib import Path

import numpy as np
import pytest

import pindrive as pd
from pindrive.files.overrides import ConfigError
from pindrive.study.bifurcation import bifurcation

BELT = """
name = "body on a belt"
[drive]
mass = "1 kg"
stiffness = "100 N/m"
damping = "0.5 N*s/m"
[plate]
law = "stribeck"
kinetic = "1 N"
breakaway = "2 N"
stribeck_velocity = "50 mm/s"
[finger]
kinetic = "0 N"
[motion]
mouse_velocity = "100 mm/s"
[axes]
motion.mouse_velocity = { lin = ["20 mm/s", "600 mm/s"], count = 30 }
"""
FORCED = """
[drive]
mass = "1 kg"
stiffness = "100 N/m"
damping = "0.4 N*s/m"
travel = "30 mm"
stop_stiffness = "2 kN/m"
stop_damping = "1 N*s/m"
[plate]
kinetic = "0.3 N"
[finger]
kinetic = "0 N"
[motion]
mouse_velocity = "0 mm/s"
force = { mean = "0 N", amplitude = "3 N", frequency = "1 Hz" }
[axes]
motion.force.frequency = { lin = ["1 Hz", "4 Hz"], count = 13 }
"""


def study(folder: Path, text: str) -> pd.Study:
    path = folder / "study.toml"
    path.write_text(text, "utf-8")
    return pd.load_study(path)


def test_sliding_sets_in_where_friction_falls_less_than_the_damper_rises(tmp_path: Path) -> None:
    found = bifurcation(study(tmp_path, BELT))
    speeds = np.array([motion.value for motion in found.up])
    # Steady sliding is stable where b > (F_b - F_c)/v_s exp(-v/v_s): above 184 mm/s.
    stable = 1.0 / 0.05 * np.array([exp(-v / 0.05) for v in speeds]) < 0.5
    slides = np.array([motion.end.name == "decaying" for motion in found.down])
    np.testing.assert_array_equal(slides, stable)
    # The body that sticks once in a round does so beyond, until the belt is too fast.
    sticks = np.array([motion.end.name == "stick_slip" for motion in found.up])
    assert sticks[: stable.argmax()].all()
    assert 5 < (sticks & stable).sum() < 20
    assert "two motions" in repr(found)
    # The branches end where a bisection of `simulate` ends stick-slip, and where b = -F'(v).
    (fast,), (slow,) = ([c for c in found.changes if c.direction == d] for d in ("up", "down"))
    assert fast.last < 0.488898102674 < fast.first < fast.last + 1e-5
    assert slow.first < 0.05 * log(40.0) < slow.last < slow.first + 1e-5
    assert [each.end.name for each in (fast.before, fast.after)] == ["stick_slip", "decaying"]
    assert [each.end.name for each in (slow.before, slow.after)] == ["decaying", "stick_slip"]
    for one, other in zip(found.up, found.down, strict=True):
        if one.end == other.end:
            assert one.amplitude == pytest.approx(other.amplitude, rel=1e-8)
            assert one.period == pytest.approx(other.period, rel=1e-8, nan_ok=True)
        if one.end.name == "stick_slip":
            assert one.multiplier == pytest.approx(0.0, abs=1e-9)
            assert len(one.points) == 1


def test_a_forced_body_between_stops_has_two_responses(tmp_path: Path) -> None:
    loaded = study(tmp_path, FORCED)
    progress: list[tuple[int, int]] = []
    found = bifurcation(loaded, progress=lambda done, total: progress.append((done, total)))
    assert progress[-1] == (26, 26)
    two = [
        (one, other)
        for one, other in zip(found.up, found.down, strict=True)
        if one.amplitude > 1.5 * other.amplitude
    ]
    assert 4 < len(two) < 10
    for one, other in two:
        assert one.end.name == other.end.name == "driven"
        assert one.period == pytest.approx(1.0 / one.value, rel=1e-9)
        assert 0.0 < other.multiplier < 1.0 and 0.0 < one.multiplier < 1.0


def test_the_dataset_has_both_directions(tmp_path: Path) -> None:
    found = bifurcation(study(tmp_path, FORCED))
    data = found.to_dataset()
    assert data.sizes["direction"] == 2 and data.sizes["force_frequency"] == 13
    assert data.displacement.attrs["units"] == data.lowest.attrs["units"] == "m"
    np.testing.assert_allclose(data.highest - data.lowest, 2.0 * data.amplitude)
    assert data.change_direction.values.tolist() == ["down"]
    assert float(data.change_first.item()) < float(data.change_last.item())
    assert data.amplitude.sel(direction="up").values.tolist() == [m.amplitude for m in found.up]
    assert data.force_frequency.attrs["units"] == "Hz"
    figure = found.plot()
    (up, down) = (
        next(line for line in figure.axes[0].lines if line.get_gid() == d) for d in ("up", "down")
    )
    assert min(len(np.asarray(line.get_xdata())) for line in (up, down)) >= 13
    assert figure.axes[1].get_xlabel() == "force frequency (Hz)"


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        (
            'motion.mouse_velocity = ["1 mm/s"]\nmass = ["1 kg"]',
            "one axis of values, or the name of one, got 2 axes",
        ),
        (
            'motion.mouse_velocity = { uniform = ["1 mm/s", "2 mm/s"] }\n[sample]\ncount = 8',
            "got 0 axes",
        ),
    ],
)
def test_a_study_of_another_kind_is_refused(tmp_path: Path, axes: str, message: str) -> None:
    text = BELT[: BELT.index("[axes]")] + f"[axes]\n{axes}\n"
    with pytest.raises((ValueError, ConfigError), match=message):
        bifurcation(study(tmp_path, text))


@pytest.mark.parametrize("count", [27, 40])
def test_end_of_a_branch_does_not_depend_on_the_step(tmp_path: Path, count: int) -> None:
    """Stick-slip on another belt ends at 301.258884377 mm/s, by bisection of `simulate`."""
    text = (
        BELT.replace("1 kg", "0.5 kg").replace("100 N/m", "800 N/m").replace("0.5 N*s/m", "2 N*s/m")
    )
    text = text.replace('"1 N"', '"4 N"').replace('"2 N"', '"6 N"')
    text = text.replace(
        '["20 mm/s", "600 mm/s"], count = 30', f'["10 mm/s", "400 mm/s"], count = {count}'
    )
    found = bifurcation(study(tmp_path, text))
    (fast,) = (each for each in found.changes if each.direction == "up")
    assert fast.last < 0.301258884377 < fast.first < fast.last + 2e-6
    (slow,) = (each for each in found.changes if each.direction == "down")
    assert slow.first < 0.05 * log(20.0) < slow.last < slow.first + 2e-6


def test_one_axis_of_several_is_named(tmp_path: Path) -> None:
    loaded = study(tmp_path, BELT.replace("count = 30 }", 'count = 3 }\nmass = ["1 kg", "2 kg"]'))
    found = bifurcation(loaded, "mouse_velocity")
    assert found.key == "motion.mouse_velocity" and len(found.up) == 3
    with pytest.raises(ValueError, match=r"over must be an axis \(.*\), got drive.stiffness"):
        bifurcation(loaded, "stiffness")

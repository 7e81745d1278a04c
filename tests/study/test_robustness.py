"""Robustness: yield and its interval by other means, and worst cases that are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from typer.testing import CliRunner

from pindrive import Contact, Drive, Release, simulate_batch
from pindrive.cli.app import app
from pindrive.study.outputs import Share
from pindrive.study.robustness import robustness
from pindrive.study.spec import load_study
from pindrive.study.study import Study

HERE = Path(__file__).parents[1]
STUDY = HERE.parent / "examples" / "tactile-mouse-study.toml"
TOLERANCES = """
[tolerances]
plate.kinetic = "30 %"
mass = { normal = "4 %" }
mouse_velocity = { uniform = ["80 mm/s", "130 mm/s"] }
"""


def study(folder: Path, text: str) -> Study:
    path = folder / "study.toml"
    path.write_text(f'base = "{(HERE / "minimal.toml").as_posix()}"\n{text}')
    return load_study(path)


def test_the_yield_is_that_of_other_draws(tmp_path: Path) -> None:
    """Equally many designs, drawn by NumPy with another generator."""
    count = 20_000
    plan = study(tmp_path, TOLERANCES + '[specification]\nswing = [">= 0.9 mm", "<= 1.2 mm"]\n')
    found = robustness(plan, count=count)
    rng = np.random.default_rng(298)
    drive = Drive(
        mass=0.010, stiffness=100.0, damping=0.40, plate=Contact(0.02), finger=Contact(0.005)
    )
    other = simulate_batch(
        drive,
        Release(0.1),
        mass=rng.normal(0.010, 0.0004, count),
        plate_kinetic=rng.uniform(0.014, 0.026, count),
        mouse_velocity=rng.uniform(0.080, 0.130, count),
    ).transient_swing
    expected = float(((other >= 0.9e-3) & (other <= 1.2e-3)).mean())
    assert found.all_met is not None
    assert 0.1 < expected < 0.9
    assert found.all_met.met / count == pytest.approx(expected, abs=5.0 * np.sqrt(0.5 / count))
    assert found.all_met.low < found.all_met.met / count < found.all_met.high
    swing = found.values["transient_swing"]
    assert stats.ks_2samp(swing, other).pvalue > 1e-3
    met = [share.met for _, share in found.shares]
    assert met == [int((swing >= 0.9e-3).sum()), int((swing <= 1.2e-3).sum())]


def test_a_share_has_clopper_and_pearsons_interval() -> None:
    for met, of in ((0, 50), (7, 50), (50, 50), (99_990, 100_000)):
        share = Share.of_designs(met, of)
        low = stats.beta.ppf(0.025, met, of - met + 1) if met else 0.0
        high = stats.beta.ppf(0.975, met + 1, of - met) if met < of else 1.0
        assert (share.low, share.high) == pytest.approx((low, high), abs=1e-9)


def test_the_worst_case_of_what_grows_is_a_corner(tmp_path: Path) -> None:
    """The peak grows with speed and mass: (14) of the paper. Three deviations are the end."""
    plan = study(
        tmp_path,
        """
        [tolerances]
        mass = { normal = "4 %" }
        mouse_velocity = { uniform = ["80 mm/s", "130 mm/s"] }
        [specification]
        peak_displacement = ["<= 1 mm", ">= 1 mm"]
        """,
    )
    largest, smallest = robustness(plan, count=200).worst
    assert largest.keys["motion.mouse_velocity"] == pytest.approx(0.130, rel=1e-3)
    assert largest.keys["drive.mass"] == pytest.approx(0.010 * 1.12, rel=1e-3)
    assert smallest.keys["motion.mouse_velocity"] == pytest.approx(0.080, rel=1e-3)
    assert smallest.keys["drive.mass"] == pytest.approx(0.010 * 0.88, rel=1e-3)
    assert largest.value > largest.sampled and smallest.value < smallest.sampled


def test_the_worst_case_is_no_better_than_a_million_draws() -> None:
    """The settling time jumps; the search finds what chance does not."""
    plan = load_study(STUDY)
    found = robustness(plan, count=2000)
    many = robustness(plan, count=100_000, seed=2).values
    slowest, narrowest = found.worst
    assert slowest.value >= np.quantile(many["transient_settling_time"], 0.9999)
    assert narrowest.value <= np.quantile(many["transient_swing"], 0.0001)
    assert slowest.motion is not None
    assert slowest.motion.transient.settling_time == slowest.value
    assert slowest.motion.certificate().worst < 1e-9
    for case in found.worst:
        for key, scatter in plan.tolerances.items():
            low, high = scatter.span
            assert low <= case.keys[key] <= high


def test_unsettled_designs_meet_nothing_and_are_the_worst(tmp_path: Path) -> None:
    plan = study(tmp_path, TOLERANCES + '[specification]\nsettling_time = "<= 1 s"\n')
    plan = load_study(
        _edited(tmp_path, "motion", 'mouse_velocity = "100 mm/s"\nduration = "98 ms"')
    )
    found = robustness(plan, count=3000)
    never = np.isnan(found.values["transient_settling_time"])
    assert 0.02 < never.mean() < 0.98
    assert found.all_met is not None
    assert found.all_met.met == int((~never).sum())
    assert np.isnan(found.worst[0].value)


def _edited(folder: Path, table: str, content: str) -> Path:
    """Return the study with its device written in and one table changed."""
    device = (HERE / "minimal.toml").read_text()
    head, _, _ = device.partition(f"[{table}]")
    text = (folder / "study.toml").read_text().partition("\n")[2]
    path = folder / "edited.toml"
    path.write_text(f"{head}[{table}]\n{content}\n{text}")
    return path


def test_contradictory_draws_are_no_designs(tmp_path: Path) -> None:
    """Kinetic friction above static friction: such draws are counted apart, and none is the worst.

    All others settle: the yield is whole, however many draws cannot exist.
    """
    plan = study(
        tmp_path,
        """
        [tolerances]
        finger.kinetic = "50 %"
        finger.static = { uniform = ["5 mN", "9 mN"] }
        [specification]
        settling_time = "<= 1 s"
        """,
    )
    found = robustness(plan, count=4000)
    assert found.all_met is not None
    assert found.all_met.met == found.all_met.of == found.designs == 4000 - found.refused
    assert all(len(values) == found.designs for values in found.values.values())
    (refusal,) = found.refusals
    assert refusal.count == found.refused
    assert refusal.reason.startswith("finger.static must be at least the kinetic friction, 0.00")
    # finger.kinetic is even from 2.5 to 7.5 mN, static from 5 to 9: k > s in a triangle.
    assert found.refused / 4000 == pytest.approx(0.5 * 2.5**2 / (5.0 * 4.0), abs=0.03)
    assert not np.isnan(found.worst[0].value)


def test_the_command_prints_and_draws(tmp_path: Path) -> None:
    target = tmp_path / "spread.svg"
    arguments = ["robustness", str(STUDY), "--draws", "2000", "--plot", str(target)]
    said = CliRunner().invoke(app, arguments)
    assert said.exit_code == 0, said.output
    found = robustness(load_study(STUDY), count=2000)
    assert found.all_met is not None
    lines = [line.split() for line in said.stdout.splitlines()]
    (total,) = (line for line in lines if line[:1] == ["all"])
    assert total[1] == f"{100 * found.all_met.met / 2000:.3f}"
    (design,) = (line for line in lines if line[:1] == ["swing"] and line[1] != "≥")
    assert design[1] == "2.914", "as pindrive simulate says"
    assert "2 000 independent random draws, seed 1." in said.stdout
    drawn = target.read_text("utf-8")
    assert "worst case found" in drawn and "designs of 2 000" in drawn


def test_without_a_specification_there_is_no_yield(tmp_path: Path) -> None:
    study(tmp_path, TOLERANCES)
    said = CliRunner().invoke(app, ["robustness", str(tmp_path / "study.toml"), "--draws", "50"])
    assert said.exit_code == 0
    assert "Yield" not in said.stdout
    assert "write what is required in [specification]" in said.stdout

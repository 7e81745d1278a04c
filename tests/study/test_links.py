"""Inputs that keep their ratio to varied ones: in sweeps, draws, derivatives and single values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from pindrive import Contact, Drive, Release, simulate
from pindrive.cli.app import app
from pindrive.files.device import load_device
from pindrive.files.overrides import ConfigError
from pindrive.motion.simulate import motion_of
from pindrive.quantities.drive import DRIVE_QUANTITIES
from pindrive.study.distributions import Linked
from pindrive.study.evaluate import evaluate
from pindrive.study.local_sensitivity import elasticities
from pindrive.study.outputs import MEASURED
from pindrive.study.robustness import robustness
from pindrive.study.sensitivity import sobol
from pindrive.study.spec import load_study
from pindrive.study.study import Study

pytestmark = pytest.mark.usefixtures("in_empty_folder")

ROUGH = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping_ratio = 0.16
[plate]
curve = [["0 m/s", "22 mN"], ["50 mm/s", "15 mN"], ["0.2 m/s", "16 mN"]]
static = "26.5 mN"
[finger]
kinetic = "20 mN"
static = "30 mN"
stiffness = "1000 N/m"
[motion]
mouse_velocity = "60 mm/s"
displacement = "2 mm"
skin_stretch = "12 µm"
"""
PLAIN = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping_ratio = 0.16
[plate]
kinetic = "22 mN"
static = "26.5 mN"
[finger]
kinetic = "5 mN"
[motion]
mouse_velocity = "60 mm/s"
displacement = "2 mm"
"""


def study(text: str, device: str = PLAIN) -> Study:
    Path("device.toml").write_text(device, "utf-8")
    Path("study.toml").write_text(f'base = "device.toml"\n{text}', "utf-8")
    return load_study("study.toml")


def run(*arguments: str) -> str:
    said = CliRunner().invoke(app, list(arguments))
    assert said.exit_code == 0, said.output
    return said.stdout


# ---- the mechanism -------------------------------------------------------------------------------


def test_table_lists_linked_keys() -> None:
    follows = {quantity.key: quantity.follows for quantity in DRIVE_QUANTITIES if quantity.follows}
    assert follows == {
        "plate.static": ("plate.kinetic",),
        "plate.curve": ("plate.kinetic",),
        "plate.static_coefficient": ("plate.coefficient",),
        "plate.breakaway": ("plate.kinetic",),
        "plate.breakaway_coefficient": ("plate.coefficient",),
        "plate.coefficient_curve": ("plate.coefficient",),
        "finger.static": ("finger.kinetic",),
        "finger.curve": ("finger.kinetic",),
        "finger.static_coefficient": ("finger.coefficient",),
        "finger.breakaway": ("finger.kinetic",),
        "finger.breakaway_coefficient": ("finger.coefficient",),
        "finger.coefficient_curve": ("finger.coefficient",),
        "motion.skin_stretch": ("finger.static", "finger.stiffness"),
    }


def test_a_swept_point_is_the_device_with_that_value_set() -> None:
    """Kinetic friction takes the curve, the static friction and the stretch of the skin along."""
    axes = '[axes]\nplate.kinetic = ["11 mN", "22 mN", "44 mN"]\nfinger.kinetic = ["4 mN", "40 mN"]'
    plan = study(f'{axes}\nfinger.stiffness = ["800 N/m", "2 kN/m"]\n', ROUGH)
    assert plan.links["plate.static"] == Linked("plate.kinetic", 0.0265 / 0.022)
    assert set(plan.links) == {"plate.static", "finger.static", "motion.skin_stretch"}
    columns = plan.columns(0, plan.size)
    found = evaluate(plan, columns, plan.size, (*MEASURED, "status"))
    assert (found["status"] == 0).all()
    for i in range(plan.size):
        at = {key: float(column[i]) for key, column in columns.items()}
        plate, finger = at["plate.kinetic"], at["finger.kinetic"]
        shape = [(0.0, 22.0 / 22.0), (0.05, 15.0 / 22.0), (0.2, 16.0 / 22.0)]
        by_hand = simulate(
            Drive(
                mass=0.010,
                stiffness=100.0,
                damping_ratio=0.16,
                plate=Contact(plate, plate * 26.5 / 22.0, [(u, part * plate) for u, part in shape]),
                finger=Contact(finger, 1.5 * finger, stiffness=at["finger.stiffness"]),
            ),
            Release(0.060, 0.002, skin_stretch=0.4 * 1.5 * finger / at["finger.stiffness"]),
        )
        set_so = load_device(
            "device.toml",
            [f"{k}={at[k]!r} N" for k in ("plate.kinetic", "finger.kinetic")]
            + [f"finger.stiffness={at['finger.stiffness']!r} N/m"],
        )
        numbers = motion_of(set_so).numbers()
        for name, value in by_hand.numbers().items():
            if name.startswith("transient.") and name != "transient.settled":
                assert numbers[name] == pytest.approx(value, rel=1e-9, abs=1e-12, nan_ok=True), name
                np.testing.assert_array_equal(
                    found[name.replace(".", "_")][i], numbers[name], err_msg=name
                )


def test_given_values_do_not_follow() -> None:
    plan = study('[axes]\nplate.kinetic = ["5 mN"]\nplate.static = ["30 mN", "40 mN"]\n')
    assert plan.links == {}
    plan = study(
        '[axes]\nplate.kinetic = ["5 mN"]\nplate.static = { times = 2, of = "mass" }\n'.replace(
            '"mass"', '"plate.kinetic"'
        )
    )
    assert plan.links == {"plate.static": Linked("plate.kinetic", 2.0)}
    plan = study('[axes]\nplate.static = ["30 mN", "40 mN"]\n')
    assert plan.links == {}, "kinetic friction leads"
    device = load_device("device.toml", ["plate.kinetic=30 mN", "plate.static=31 mN"])
    assert device.drive.plate == Contact(0.030, 0.031)
    with pytest.raises(ConfigError, match=r"`overrides` plate\.static: plate\.static must be at"):
        load_device("device.toml", ["plate.static=10 mN"])


def test_a_ratio_to_zero_is_none() -> None:
    device = PLAIN.replace('kinetic = "22 mN"', 'kinetic = "0 mN"')
    plan = study('[axes]\nplate.kinetic = ["1 mN", "50 mN"]\n', device)
    assert plan.links == {}
    found = evaluate(plan, plan.columns(0, 2), 2, ("status",))
    assert [status != 0 for status in found["status"]] == [False, True]
    assert load_device("device.toml", ["plate.kinetic=1 mN"]).drive.plate == Contact(0.001, 0.0265)


def test_static_friction_equal_to_kinetic_stays_equal_to_the_bit() -> None:
    device = PLAIN.replace('static = "26.5 mN"', 'static = "22 mN"')
    plan = study('[axes]\nplate.kinetic = { lin = ["1 mN", "99 mN"], count = 999 }\n', device)
    columns = plan.columns(0, 999)
    np.testing.assert_array_equal(columns["plate.static"], columns["plate.kinetic"])


def test_damping_given_as_a_ratio_stays_that_ratio() -> None:
    """And damping given in N*s/m stays that: the file says which of the two it means."""
    axes = '[axes]\nmass = ["5 g", "20 g"]\n'
    names = ("transient_settling_time",)
    for given, keep in (("damping_ratio = 0.16", True), ('damping = "0.32 N*s/m"', False)):
        plan = study(axes, PLAIN.replace("damping_ratio = 0.16", given))
        found = evaluate(plan, plan.columns(0, 2), 2, names)["transient_settling_time"]
        for i, mass in enumerate((0.005, 0.020)):
            damping = 2.0 * 0.16 * np.sqrt(mass * 100.0) if keep else 0.32
            contacts: dict[str, Any] = {"plate": Contact(0.022, 0.0265), "finger": Contact(0.005)}
            drive = Drive(mass=mass, stiffness=100.0, damping=damping, **contacts)
            motion = simulate(drive, Release(0.060, 0.002))
            assert found[i] == pytest.approx(motion.transient.settling_time, rel=1e-12)
            one = motion_of(load_device("device.toml", [f"mass={mass} kg"]))
            assert one.transient.settling_time == pytest.approx(found[i], rel=1e-12)


def test_links_may_follow_links_but_not_each_other() -> None:
    plan = study(
        """
        [axes]
        finger.kinetic = ["2 mN", "4 mN"]
        finger.static = { times = 2, of = "finger.kinetic" }
        plate.kinetic = { times = 3, of = "finger.static" }
        plate.static = { times = 1, of = "plate.kinetic" }
        """
    )
    columns = plan.columns(0, 2)
    np.testing.assert_allclose(columns["plate.static"], [0.012, 0.024], rtol=1e-15)
    with pytest.raises(ConfigError) as refused:
        study(
            """
            [axes]
            plate.kinetic = { times = 1, of = "plate.static" }
            plate.static = { times = 1, of = "plate.kinetic" }
            """
        )
    assert refused.value.problems == (
        "study.toml: axes: plate.kinetic follows plate.static, which follows plate.kinetic; give "
        "one of them values",
    )


def test_file_and_map_state_linked_keys() -> None:
    study('[axes]\nplate.kinetic = ["11 mN", "44 mN"]\n')
    run("sweep", "study.toml")
    with xr.open_dataset("study.nc") as data:
        assert "plate_static" not in data.coords
        (link,) = json.loads(data.attrs["identity"])["links"].values()
        assert link["of"] == "plate.kinetic"
        assert data.attrs["links"] == "plate.static = 1.20455 × plate.kinetic"
    run("map", "study.nc", "--plot", "map.svg")
    assert "static plate friction = 1.20455 × plate friction" in Path("map.svg").read_text("utf-8")


# ---- draws ---------------------------------------------------------------------------------------

TOLERANCES = '[tolerances]\nplate.kinetic = "25 %"\n[specification]\nsettling_time = "<= 150 ms"\n'


def test_no_draw_of_kinetic_friction_alone_is_impossible() -> None:
    """With a fixed static friction a sixth of the draws would exceed the static friction."""
    found = robustness(study(TOLERANCES), count=2000)
    assert found.refusals == ()
    assert found.designs == 2000
    largest = found.worst[0].keys
    assert largest["plate.static"] == 0.0265 / 0.022 * largest["plate.kinetic"]


def test_the_yield_is_that_of_the_draws_that_exist() -> None:
    """Static friction with a tolerance of its own: the draws that cannot exist are no failures."""
    plan = study(TOLERANCES.replace("[spec", 'plate.static = "25 %"\n[spec'))
    found = robustness(plan, count=4000)
    rng = np.random.default_rng(298)
    kinetic, static = rng.uniform(0.0165, 0.0275, 10**6), rng.uniform(0.019875, 0.033125, 10**6)
    assert found.refused / 4000 == pytest.approx((static < kinetic).mean(), abs=0.02)
    assert found.all_met is not None
    assert found.all_met.of == found.designs == 4000 - found.refused
    said = run("robustness", "study.toml", "--draws", "4000")
    head = (
        f"{found.refused} of 4 000 draws ({100 * found.refused / 4000:.3g} %) cannot exist and are "
    )
    lines = said.splitlines()
    after = lines[lines.index(f"{head}left out:") + 1]
    assert after.startswith(f"  {found.refused}, the first: plate.static must be at least the kin")
    assert f"Yield: of {found.designs:,} designs".replace(",", " ") in said


def test_unsettled_designs_fail_and_differ_from_impossible_ones() -> None:
    device = PLAIN + 'duration = "132.6 ms"\n'
    plan = study(TOLERANCES.replace("[spec", 'plate.static = "25 %"\n[spec'), device)
    found = robustness(plan, count=1000)
    never = np.isnan(found.values["transient_settling_time"])
    assert 0 < never.sum() < found.designs < 1000
    ((_, share),) = found.shares
    assert (share.without, share.met) == (never.sum(), found.designs - never.sum())
    said = run("robustness", "study.toml", "--draws", "1000")
    assert "A design without such a number (for example not settled) violates its limit." in said
    assert "cannot exist and are left out:" in said


def test_the_picture_counts_designs() -> None:
    study(TOLERANCES.replace("[spec", 'plate.static = "25 %"\n[spec'))
    run("robustness", "study.toml", "--draws", "1000", "--plot", "yield.svg")
    found = robustness(load_study("study.toml"), count=1000)
    drawn = Path("yield.svg").read_text("utf-8")
    assert f"designs of {found.designs}" in drawn
    assert "never" not in drawn
    assert f"left out, as contradictory: {found.refused / 10:.2g} % of 1 000 draws" in drawn


def test_draws_none_of_which_can_exist_are_refused() -> None:
    study(TOLERANCES.replace("25 %", "0.001 mN").replace("[spec", 'plate.static = "9 mN"\n[spec'))
    text = (
        Path("study.toml")
        .read_text()
        .replace('"9 mN"', '{ normal = ["23 mN", "9 mN"], within = ["10 mN", "22 mN"] }')
    )
    Path("study.toml").write_text(text)
    said = CliRunner().invoke(app, ["robustness", "study.toml", "--draws", "50"])
    assert said.exit_code == 2
    (line,) = said.stderr.splitlines()
    assert line.startswith("study.toml: of 50 draws none can exist: plate.static must be at least")


def test_draws_of_scans_are_counted_by_reason() -> None:
    Path("study.toml").write_text(
        PLAIN.partition("[motion]")[0].replace('kinetic = "5 mN"', 'kinetic = "20 mN"')
        + """
        [array]
        pitch = "3 mm"
        [scan]
        hand_speed = "100 mm/s"
        [page]
        grating = ["4 mm"]
        [tolerances]
        plate.static = { uniform = ["15 mN", "60 mN"] }
        control.hysteresis = { uniform = [0.1, 0.99] }
        control.threshold = { uniform = [0.3, 0.7] }
        [specification]
        shown_part = ">= 0"
        """
    )
    found = robustness(load_study("study.toml"), count=40, threads=1)
    assert len(found.refusals) == 2, "numbers apart, there are two reasons"
    assert sum(refusal.count for refusal in found.refusals) == found.refused > 0
    starts = {refusal.reason.partition(" must be ")[0] for refusal in found.refusals}
    assert starts == {"plate.static", "control.hysteresis"}


# ---- sensitivity ---------------------------------------------------------------------------------


def test_sensitivity_omits_impossible_draws_with_a_reason() -> None:
    plan = study(TOLERANCES.replace("[spec", 'plate.static = "25 %"\n[spec'))
    found = sobol(plan, rows=128, near=True)
    (refusal,) = found.refusals
    assert 0 < refusal.count < found.points
    assert refusal.reason.startswith("plate.static must be at least the kinetic friction")
    said = run("sensitivity", "study.toml", "--rows", "128")
    share = f"{100 * refusal.count / 512:.3g} %"
    assert f"{refusal.count} of 512 points ({share}) cannot exist and are left out:" in said
    assert sobol(study(TOLERANCES), rows=128, near=True).refusals == ()


KEYS = ("plate.kinetic", "finger.kinetic", "finger.stiffness", "drive.mass")


def test_elasticities_take_along_what_follows() -> None:
    """Differences of whole devices with a value set a millionth up and down."""
    plan = study(
        '[axes]\nplate.kinetic = ["5 mN"]\nfinger.kinetic = ["5 mN"]\nmass = ["1 g"]\n'
        'finger.stiffness = ["1 N/m"]\n',
        ROUGH,
    )
    found = elasticities(plan, KEYS, plan.links)
    compared = 0
    for key in KEYS:
        own = load_device("device.toml").values()[key]
        unit = {"drive.mass": "kg", "finger.stiffness": "N/m"}.get(key, "N")
        assert isinstance(own, float)
        low, high = (
            motion_of(
                load_device(
                    "device.toml",
                    [f"duration={found.duration!r} s", f"{key}={own * factor!r} {unit}"],
                )
            ).numbers()
            for factor in (1.0 - 1e-6, 1.0 + 1e-6)
        )
        for name in low:
            mine = found.table[name.replace(".", "_")][key]
            if not np.isnan(mine):
                expected = (high[name] - low[name]) / (high[name] + low[name]) * 1e6
                assert mine == pytest.approx(expected, rel=1e-4, abs=1e-6), (key, name)
                compared += 1
    assert compared > 60


def test_static_friction_equal_to_kinetic_counts_once() -> None:
    device = PLAIN.replace('static = "26.5 mN"', 'static = "22 mN"')
    given = study('[axes]\nplate.kinetic = ["5 mN"]\n', device)
    row = elasticities(given, ("plate.kinetic",), given.links).table["transient_plate_peak_force"]
    left_out = study('[axes]\nplate.kinetic = ["5 mN"]\n', PLAIN.replace('static = "26.5 mN"', ""))
    same = elasticities(left_out, ("plate.kinetic",), left_out.links)
    assert row == same.table["transient_plate_peak_force"]

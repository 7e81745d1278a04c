"""Study files: points of valid files, and messages for invalid ones."""

from __future__ import annotations

from itertools import pairwise
from math import log, sqrt
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from pindrive.files.overrides import ConfigError
from pindrive.motion.simulate import motion_of
from pindrive.quantities.status import Status
from pindrive.study.distributions import BLOCK, Distribution, Even, Sample
from pindrive.study.evaluate import evaluate, is_slow, refusals
from pindrive.study.outputs import MEASURED, OUTPUTS
from pindrive.study.spec import load_study
from pindrive.study.study import Study

HERE = Path(__file__).parents[1]
BASE = f'base = "{(HERE / "minimal.toml").as_posix()}"\n'
INLINE = (HERE / "minimal.toml").read_text()


def study(folder: Path, text: str, base: str = BASE) -> Study:
    path = folder / "study.toml"
    path.write_text(base + text)
    return load_study(path)


def refused(folder: Path, text: str, base: str = BASE) -> str:
    """The one line that is said of a study file, without the file's name."""
    with pytest.raises(ConfigError) as error:
        study(folder, text, base)
    (line,) = error.value.problems
    place = f"{folder / 'study.toml'}: "
    assert line.startswith(place)
    return line.removeprefix(place)


# ---- points --------------------------------------------------------------------------------------


def test_products_zips_lists_and_links(tmp_path: Path) -> None:
    plan = study(
        tmp_path,
        """
        zip = [["finger.kinetic", "finger.static"]]
        [axes]
        mass = { lin = ["2 g", "20 g"], count = 4 }
        finger.kinetic = ["1 mN", "3 mN", "5 mN"]
        drive.stiffness = { log = ["20 N/m", "2000 N/m"], count = 3 }
        finger.static = { list = ["2 mN", "3 mN", "9 mN"] }
        plate.static = { times = 1.5, of = "plate.kinetic" }
        """,
    )
    assert plan.shape == (4, 3, 3)
    columns = plan.columns(0, plan.size)
    mass, kinetic, stiffness = np.meshgrid(
        [2e-3, 8e-3, 14e-3, 20e-3], [1e-3, 3e-3, 5e-3], [20.0, 200.0, 2000.0], indexing="ij"
    )
    np.testing.assert_allclose(columns["drive.mass"], mass.ravel(), rtol=1e-15)
    np.testing.assert_allclose(columns["drive.stiffness"], stiffness.ravel(), rtol=1e-15)
    assert columns["finger.kinetic"].tolist() == kinetic.ravel().tolist()
    static = {1e-3: 2e-3, 3e-3: 3e-3, 5e-3: 9e-3}
    assert columns["finger.static"].tolist() == [static[x] for x in kinetic.ravel().tolist()]
    assert columns["plate.static"] == 1.5 * 0.020


def test_the_device_may_stand_in_the_study(tmp_path: Path) -> None:
    text = '[axes]\nplate.kinetic = ["5 mN", "6 mN"]\n'
    inline = study(tmp_path, text, INLINE)
    beside = study(tmp_path, text)
    assert inline.identity() == beside.identity()
    assert "damping" in inline.source.text and "---- " in beside.source.text


def test_ends_of_even_steps_are_met_exactly() -> None:
    for axis in (Even(0.1, 0.7, 11), Even(0.7, 0.1, 11), Even(1e-3, 0.3, 7, log=True)):
        values = axis.at(np.arange(axis.count))
        assert (values[0], values[-1]) == (axis.low, axis.high)
        steps = np.diff(np.log(values) if axis.log else values)
        np.testing.assert_allclose(steps, steps[0], rtol=1e-12)


@given(
    cuts=st.lists(st.integers(0, 3 * 5 * 40), max_size=5),
    method=st.sampled_from(["random", "sobol"]),
)
def test_points_do_not_depend_on_the_cuts(
    tmp_path_factory: pytest.TempPathFactory, cuts: list[int], method: str
) -> None:
    folder = tmp_path_factory.mktemp("cuts")
    plan = study(
        folder,
        f"""
        [axes]
        mass = ["2 g", "3 g", "4 g"]
        plate.kinetic = {{ uniform = ["1 mN", "9 mN"] }}
        drive.stiffness = {{ lin = ["20 N/m", "30 N/m"], count = 5 }}
        displacement = {{ normal = ["1 mm", "0.1 mm"] }}
        [sample]
        method = "{method}"
        count = 40
        """,
    )
    whole = plan.columns(0, plan.size)
    ends = sorted({0, *cuts, plan.size})
    pieces = [plan.columns(a, b) for a, b in pairwise(ends)]
    for key, values in whole.items():
        assert np.concatenate([piece[key] for piece in pieces]).tolist() == values.tolist()


# ---- samples -------------------------------------------------------------------------------------

DRAWN = {
    Distribution("uniform", 1.0, 3.0): stats.uniform(1.0, 2.0),
    Distribution("loguniform", 1.0, 30.0): stats.loguniform(1.0, 30.0),
    Distribution("normal", 2.0, 0.5): stats.norm(2.0, 0.5),
    Distribution("lognormal", 2.0, 1.5): stats.lognorm(log(1.5), scale=2.0),
    Distribution("normal", 2.0, 2.0, 0.0, 5.0): stats.truncnorm(-1.0, 1.5, 2.0, 2.0),
}


@pytest.mark.parametrize("mine", DRAWN)
def test_distributions_are_those_of_scipy(mine: Distribution) -> None:
    parts = np.linspace(1e-9, 1.0 - 1e-9, 1001)
    np.testing.assert_allclose(mine.ppf(parts), DRAWN[mine].ppf(parts), rtol=1e-9)
    low, high = mine.span
    assert low < DRAWN[mine].median() < high


def test_a_random_sample_is_random() -> None:
    """Uniform, unrelated between keys and between blocks, and its own for every seed."""
    sample = Sample(("a", "b"), 3 * BLOCK, seed=298)
    drawn = sample.parts(np.arange(3 * BLOCK))
    for column in drawn:
        assert stats.kstest(column, "uniform").pvalue > 1e-3
    blocks = drawn.reshape(-1, BLOCK)
    mixed = np.corrcoef(blocks) - np.eye(len(blocks))
    assert np.abs(mixed).max() < 5.0 / sqrt(BLOCK)
    other = Sample(("a", "b"), 3 * BLOCK, seed=299)
    assert not (other.parts(np.arange(9)) == drawn[:, :9]).any()
    alone = Sample(("b",), 9, seed=298).parts(np.arange(9))
    assert (alone[0] == drawn[1, :9]).all(), "a key's draws do not depend on the others"


def test_a_sobol_sample_is_scipys_sequence() -> None:
    count = 2 * BLOCK
    drawn = Sample(("a", "b", "c"), count, seed=7, method="sobol").parts(np.arange(count))
    engine = stats.qmc.Sobol(3, scramble=True, rng=np.random.default_rng(7))
    np.testing.assert_array_equal(drawn, engine.random(count).T + 2.0**-31)
    assert drawn.min() > 0.0 and drawn.max() < 1.0


# ---- numbers of the points -----------------------------------------------------------------------


def test_one_by_one_is_the_batch(tmp_path: Path) -> None:
    """A device that takes the slow way gives the numbers that the batch gives of its like."""
    axes = """
        [axes]
        plate.kinetic = { uniform = ["0 mN", "40 mN"] }
        plate.static = { uniform = ["10 mN", "60 mN"] }
        finger.kinetic = { uniform = ["0 mN", "8 mN"] }
        mass = { uniform = ["1 g", "30 g"] }
        [sample]
        count = 300
    """
    static = BASE.replace("minimal", "../examples/tactile-mouse")
    quick = study(tmp_path, axes, static)
    slow = study(
        tmp_path,
        axes,
        (HERE.parent / "examples" / "tactile-mouse.toml").read_text()
        + 'plate_load = [["0 s", 1], ["1 s", 1], ["2 s", 1.0]]\n',
    )
    columns = quick.columns(0, 300)
    assert (columns["plate.kinetic"] > columns["plate.static"]).any(), "some are refused"
    np.testing.assert_array_equal(columns["finger.static"], 1.5 * columns["finger.kinetic"])
    one = evaluate(quick, columns, 300, OUTPUTS)
    two = evaluate(slow, columns, 300, OUTPUTS)
    good = one["status"] == 0
    assert good.any() and not good.all()
    assert (good == (two["status"] == 0)).all()
    for name in ("transient_settled", "ending", "events"):
        np.testing.assert_array_equal(one[name][good], two[name][good], err_msg=name)
    for name in MEASURED:  # the batch rounds in another order
        np.testing.assert_allclose(one[name][good], two[name][good], 1e-11, 1e-15, err_msg=name)
    assert not two["transient_settled"][~good].any()
    assert np.isnan(two["transient_swing"][~good]).all()


def test_end_stops_are_followed_by_the_batch(tmp_path: Path) -> None:
    """The numbers of `simulate` at each point; a stop that cannot be is a point without numbers."""
    plan = study(
        tmp_path,
        """
        [axes]
        travel = ["0.2 mm", "1 mm", "2 mm"]
        stop_stiffness = ["1 N/mm", "100 N/mm"]
        stop_damping = ["0 N*s/m", "4 N*s/m"]
        """,
        BASE,
    )
    columns, count = plan.columns(0, plan.size), plan.size
    assert count == 12
    assert not is_slow(plan.device, columns)
    found = evaluate(plan, columns, count, OUTPUTS)
    for i in range(count):
        motion = motion_of(
            plan.device_at({key: float(values[i]) for key, values in columns.items()})
        )
        numbers = motion.numbers()
        for name in MEASURED:
            quantity = next(n for n in numbers if n.replace(".", "_") == name)
            np.testing.assert_array_equal(found[name][i], numbers[quantity], err_msg=name)
        assert found["events"][i] == len(motion.events)
        assert found["ending"][i] == motion.ending.end
    columns["drive.travel"] = np.where(np.arange(count) < 2, -1e-3, columns["drive.travel"])
    table = evaluate(plan, columns, count, ("status", "reason"))
    assert list(table["status"][:3]) == [Status.bad_travel, Status.bad_travel, Status.ok]
    (reported,) = refusals(plan, columns, table["reason"])
    assert reported.count == 2
    assert "travel must be" in reported.reason


def test_load_stretch_and_curves_are_followed(tmp_path: Path) -> None:
    from pindrive import simulate
    from pindrive.files.device import load_device

    example = HERE.parent / "examples" / "stribeck-skin.toml"
    plan = study(
        tmp_path,
        'outputs = ["settling_time"]\n[axes]\nmass = ["5 g", "10 g"]\n',
        f'base = "{example.as_posix()}"\n',
    )
    found = evaluate(plan, plan.columns(0, 2), 2, plan.outputs)["transient_settling_time"]
    for i, mass in enumerate(("5 g", "10 g")):
        device = load_device(example, [f"mass={mass}"])
        motion = simulate(device.drive, device.release, duration=device.duration)
        assert found[i] == motion.transient.settling_time


def test_a_constant_load_is_a_stronger_plate(tmp_path: Path) -> None:
    loaded = study(tmp_path, "[axes]\nplate_load = [1, 2.5]\n")
    stronger = study(tmp_path, '[axes]\nplate.kinetic = ["20 mN", "50 mN"]\n')
    one, two = (evaluate(p, p.columns(0, 2), 2, p.outputs) for p in (loaded, stronger))
    for name, values in one.items():
        np.testing.assert_array_equal(values, two[name], err_msg=name)


# ---- refusals ------------------------------------------------------------------------------------

REFUSED = {
    "axes = 3": "axes must be a table, [axes], got 3",
    "colour = 1": "unknown key colour; none is like it; docs/reference/study-file.md lists all 11",
    "ax.mass = [1]": "unknown key ax; did you mean axes?",
    "[drive]\nmass = 1": "give base or the table drive, not both",
    "[axes]\nmas = [1]": "axes: unknown key mas; did you mean drive.mass or hand.mass?",
    "[axes]\ndrive.mas = [1]": "axes: unknown key drive.mas; did you mean drive.mass?",
    '[axes]\nkinetic = ["1 mN"]': "axes: kinetic may be plate.kinetic, finger.kinetic or "
    "hand.kinetic; give it in full",
    "[axes]\nplate.curve = [1]": "axes: plate.curve is no single number, it cannot be varied",
    "[axes]\ndevice.name = [1]": "axes: device.name is no single number, it cannot be varied",
    "[axes]\nscan.hand_speed = [1]": "axes: scan.hand_speed acts in a scan; say what is on the "
    'page, as with grating = ["4 mm"] in [page]',
    "[axes]\nmass = []": "axes.drive.mass must be a list of at least one value, got []",
    '[axes]\nmass = ["1 g", "2 mm"]': "axes.drive.mass[1] must be in kg or a unit alike, like "
    '"10 g", got "2 mm"',
    '[axes]\nmass = ["1 g", "-2 g"]': "axes.drive.mass[1] must be finite and greater than 0 kg, "
    'got "-2 g"',
    '[axes]\nmass = { lin = ["1 g", "2 g"] }': "axes.drive.mass.count must be a whole number "
    "from 2 to 524288000000, got none",
    '[axes]\nmass = { lin = ["1 g", "2 g"], count = 1 }': "axes.drive.mass.count must be a whole "
    "number from 2 to 524288000000, got 1",
    '[axes]\nmass = { lin = ["2 g", "2 g"], count = 3 }': "axes.drive.mass.lin must be two "
    'different values, got ["2 g", "2 g"]',
    '[axes]\nmass = { lin = ["2 g"], count = 3 }': "axes.drive.mass.lin must be two values, "
    '[first, last], got ["2 g"]',
    '[axes]\nvelocity = { log = ["-1 mm/s", "1 mm/s"], count = 3 }': "axes.motion.velocity.log "
    'must be two values greater than 0, got ["-1 mm/s", "1 mm/s"]',
    '[axes]\nmass = { lin = ["2 g", "3 g"], count = 3, step = 1 }': "unknown key "
    "axes.drive.mass.step; there is lin and count",
    '[axes]\nmass = "2 g"': "axes.drive.mass must be a list of values, or a table like "
    '{ lin = ["5 g", "20 g"], count = 10 }, got "2 g"',
    '[axes]\nmass = { uniform = ["3 g", "2 g"] }\n[sample]\ncount = 9': "axes.drive.mass.uniform "
    'must be a lowest and a highest value, got ["3 g", "2 g"]',
    '[axes]\nmass = { normal = ["3 g", "0 g"] }\n[sample]\ncount = 9': "axes.drive.mass.normal[1] "
    'must be a deviation greater than 0, got "0 g"',
    '[axes]\nmass = { lognormal = ["3 g", 0.9] }\n[sample]\ncount = 9': "axes.drive.mass."
    "lognormal[1] must be a factor greater than 1, got 0.9",
    '[axes]\nmass = { uniform = ["2 g", "3 g"] }': "sample.count is missing for drive.mass; write "
    "count = 1024 in [sample]",
    '[axes]\nmass = { uniform = ["2 g", "3 g"] }\n[sample]\ncount = 0': "sample.count must be a "
    "whole number from 1 to 524288000000, got 0",
    '[axes]\nmass = ["2 g"]\n[sample]\nsize = 9': "unknown key sample.size; there are method, "
    "count, seed",
    '[axes]\nmass = ["2 g"]\ndrive.mass = ["3 g"]': "axes.drive.mass is given twice, as mass and "
    "drive.mass",
    '[axes]\ndamping = ["0.1 N*s/m"]\ndamping_ratio = [0.1]': "axes: vary drive.damping or "
    "drive.damping_ratio, not both",
    '[axes]\nplate.static = { times = 2, of = "mass" }': "axes.plate.static.of must be another "
    'key in N, got "mass"',
    '[axes]\ndamping_ratio = { times = 2, of = "mass" }': "axes.drive.damping_ratio.of must be "
    'another key without a unit, got "mass"',
    '[axes]\nplate.static = ["1 mN", "2 mN"]': "axes: plate.static is below plate.kinetic at every "
    "point: at most 2 mN, plate.kinetic at least 20 mN",
    'zip = [["plate.static", "plate.kinetic"]]\n[axes]\nplate.static = ["1 mN", "3 mN"]\n'
    'plate.kinetic = ["2 mN", "4 mN"]': "axes: plate.static is below plate.kinetic at every "
    "point: at most 3 mN, plate.kinetic at least 2 mN",
    'zip = [["mass", "drive.stiffness"]]\n[axes]\nmass = ["1 g"]\n'
    'drive.stiffness = ["1 N/m", "2 N/m"]': "zip: "
    "axes that go together must be of one length; drive.mass has 1, drive.stiffness has 2",
    'zip = [["mass", "drive.stiffness"]]\n[axes]\nmass = ["1 g"]': "zip: drive.stiffness is no "
    "axis of a list or of even steps",
    'zip = [["mass", "mass"]]\n[axes]\nmass = ["1 g"]': "zip: drive.mass is named twice",
    'zip = [["mass"]]\n[axes]\nmass = ["1 g"]': "zip: a group must be two keys or more, got "
    '["mass"]',
    'outputs = ["swinge"]': "outputs: unknown number swinge; did you mean swing?",
    'outputs = ["peak_force"]': "outputs: peak_force may be plate_peak_force or finger_peak_force; "
    "give it in full",
    "outputs = []": 'outputs must be a list of numbers, like ["settling_time", "swing"], got []',
    "chunk = 0": "chunk must be a whole number from 1 to 524288, got 0",
    '[axes]\nskin_stretch = ["1 um"]': "axes: motion.skin_stretch cannot be varied for a rigid "
    "finger; give finger.stiffness",
    '[specification]\nswing = "1 mm"': "specification.swing must be a limit with <= or >=, like "
    '"<= 60 mm", got "1 mm"',
    '[specification]\nswing = "<= 1 g"': "specification.swing must be a limit: in m or a unit "
    'alike, like "60 mm", got "<= 1 g"',
    '[tolerances]\nplate.kinetic = "120 %"': "tolerances.plate.kinetic must be finite and at "
    'least 0 N, got "120 %", which reaches -4 mN',
    '[tolerances]\nplate.kinetic = ["1 mN"]': "tolerances.plate.kinetic must be a tolerance like "
    '"20 %" or { uniform = ["10 mN", "40 mN"] }, got ["1 mN"]',
}


@pytest.mark.parametrize("text", REFUSED)
def test_refusals(tmp_path: Path, text: str) -> None:
    assert refused(tmp_path, text) == REFUSED[text]


def test_all_errors_are_reported_together(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as error:
        study(tmp_path, 'outputs = ["swinge"]\n[axes]\nmas = [1]\ndrive.stiffness = []\n')
    assert len(error.value.problems) == 3


def test_a_study_without_a_device(tmp_path: Path) -> None:
    assert refused(tmp_path, '[axes]\nmass = ["1 g"]', "").startswith("has no device; write base")
    with pytest.raises(ConfigError, match=r"none\.toml: cannot be read: No such file"):
        study(tmp_path, "", 'base = "none.toml"\n')
    with pytest.raises(ConfigError, match="is empty; a study names its device"):
        study(tmp_path, "", "")

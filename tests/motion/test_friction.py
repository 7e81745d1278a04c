"""The plate's coefficient of friction: forces are given, so that it changes with the weight."""

from __future__ import annotations

from math import inf
from pathlib import Path

import pytest

from command import GOOD, run
from pindrive import Contact, Drive
from pindrive.device import Device
from pindrive.motion.coefficients import Coefficients
from pindrive.study.spec import load_study
from pindrive.study.validation import coefficient_range

pytestmark = pytest.mark.usefixtures("in_empty_folder")

PLATE = Contact(0.022, 0.0265)


def drive(plate: Contact, mass: float, preload: float = 0.0) -> Drive:
    finger = Contact(0.0)
    return Drive(mass=mass, stiffness=1.0, damping=1.0, plate=plate, finger=finger, preload=preload)


@pytest.mark.parametrize(
    ("mass", "kinetic", "static"), [(0.005, 0.449, 0.540), (0.010, 0.224, 0.270)]
)
def test_coefficient_is_friction_over_weight(mass: float, kinetic: float, static: float) -> None:
    found = Coefficients.of(drive(PLATE, mass))
    assert (round(found.kinetic, 3), round(found.static, 3)) == (kinetic, static)
    words = f"friction coefficient {kinetic:.3f}, static {static:.3f}: its friction over "
    assert found.words.startswith(words)
    assert found.words.endswith(" of weight")


def test_a_preload_presses_beside_the_weight() -> None:
    device = Device(drive=drive(PLATE, 0.005, preload=0.1 - 0.005 * 9.80665))
    assert device.friction.kinetic == pytest.approx(0.22)
    assert device.friction.words.endswith("100.0 mN of weight and preload")
    assert device.friction.doubt is None


@pytest.mark.parametrize(
    ("plate", "mass", "doubt"),
    [
        (Contact(0.15), 1.0 / 9.80665, None),
        (Contact(0.30), 1.0 / 9.80665, None),
        (
            Contact(0.149),
            1.0 / 9.80665,
            "the plate's kinetic friction coefficient is 0.149, outside",
        ),
        (
            Contact(0.301),
            1.0 / 9.80665,
            "the plate's kinetic friction coefficient is 0.301, outside",
        ),
        (Contact(0.25, 0.78), 1.0 / 9.80665, None),
        (
            Contact(0.25, 0.80),
            1.0 / 9.80665,
            "the plate's static friction coefficient is 0.8, outside",
        ),
        (Contact(0.0), 1.0, None),
    ],
)
def test_handbook_values_agree(plate: Contact, mass: float, doubt: str | None) -> None:
    found = Coefficients.of(drive(plate, mass)).doubt
    assert found is None if doubt is None else found and found.startswith(doubt)


@pytest.mark.parametrize(("mass", "value"), [("5 g", "0.408"), ("20 g", "0.102")])
def test_check_and_scan_report_the_effect_of_mass(mass: str, value: str) -> None:
    Path("device.toml").write_text(GOOD.replace('mass = "10 g"', f'mass = "{mass}"'))
    words = (
        f"warning: the plate's kinetic friction coefficient is {value}, outside the 0.15 to 0.30"
    )
    for command in (("check",), ("scan", "--grating", "8 mm")):
        done = run(command[0], "device.toml", *command[1:])
        assert done.exit_code == 0, done.output
        (line,) = done.stderr.splitlines()
        assert line.startswith(words)
        assert f"The plate: friction coefficient {value}, static " in done.stdout
    Path("device.toml").write_text(GOOD)
    assert run("check", "device.toml").stderr == ""


# ---- studies -------------------------------------------------------------------------------------


def study(more: str) -> Path:
    Path("device.toml").write_text(GOOD)
    Path("study.toml").write_text(f'base = "device.toml"\n{more}')
    return Path("study.toml")


def over(more: str, *, tolerances: bool = False) -> tuple[float, float] | None:
    return coefficient_range(load_study(study(more)), tolerances=tolerances)


WEIGHT = 0.010 * 9.80665
CASES = {
    '[axes]\nmass = { lin = ["5 g", "20 g"], count = 4 }': (
        0.02 / WEIGHT / 2.0,
        0.02 / WEIGHT * 2.0,
    ),
    '[axes]\nplate.kinetic = ["10 mN", "15 mN", "12 mN"]': (0.010 / WEIGHT, 0.015 / WEIGHT),
    '[axes]\nmass = ["5 g", "10 g"]\nplate.kinetic = ["10 mN", "20 mN"]': (
        0.010 / WEIGHT,
        0.040 / WEIGHT,
    ),
    'zip = [["drive.mass", "plate.kinetic"]]\n[axes]\nmass = ["5 g", "10 g"]\n'
    'plate.kinetic = ["10 mN", "20 mN"]': None,
    '[axes]\nmass = ["5 g", "10 g"]\nplate.kinetic = { times = 4.0, of = "finger.kinetic" }': (
        0.020 / WEIGHT,
        0.040 / WEIGHT,
    ),
    '[axes]\ndrive.stiffness = ["50 N/m", "100 N/m"]': None,
}


@pytest.mark.parametrize("axes", CASES)
def test_study_has_its_range(axes: str) -> None:
    found, expected = over(axes), CASES[axes]
    if expected is None:
        assert found is None
    else:
        assert found == pytest.approx(expected, rel=1e-12)


def test_a_sampled_study_and_tolerances_go_to_their_ends() -> None:
    sampled = '[sample]\ncount = 8\n[axes]\nmass = { uniform = ["5 g", "10 g"] }'
    sampled += '\nplate.kinetic = { uniform = ["10 mN", "20 mN"] }'
    assert over(sampled) == pytest.approx((0.010 / WEIGHT, 0.040 / WEIGHT))
    limits = '[tolerances]\nmass = { uniform = ["8 g", "10 g"] }'
    assert over(limits, tolerances=True) == pytest.approx((0.020 / WEIGHT, 0.025 / WEIGHT))
    assert over(limits) is None
    wide = '[sample]\ncount = 8\n[axes]\nmass = { normal = ["5 g", "100 g"] }'
    low, high = over(wide) or (0.0, 0.0)
    assert 0.0 < low < 0.1 and high == inf  # some of the masses are as small as you like


def test_commands_of_studies_report_in_one_line() -> None:
    study('[axes]\nmass = ["5 g", "20 g"]\n[tolerances]\nmass = "20 %"\n')
    words = "the plate's friction coefficient, plate.kinetic over what presses, goes from "
    swept = run("sweep", "study.toml")
    assert swept.exit_code == 0, swept.output
    assert swept.stderr.splitlines() == [
        f"warning: {words}0.102 to 0.408 over the study; steel on steel has 0.15 to 0.30 in "
        "handbooks"
    ]
    for command in (
        ("sensitivity", "study.toml", "--tolerances", "--rows", "128"),
        ("robustness", "study.toml", "--draws", "8"),
    ):
        done = run(*command)
        assert done.exit_code == 0, done.output
        assert f"{words}0.17 to 0.255 over the tolerances" in done.stdout
        assert done.stderr == ""
    study('[axes]\ndrive.stiffness = ["50 N/m", "100 N/m"]\n')
    assert "friction coefficient" not in run("sweep", "study.toml", "--force").output


def test_doubtful_coefficient_is_written_with_the_digits_that_tell() -> None:
    drive = Drive(
        mass=0.01,
        stiffness=100.0,
        damping=0.1,
        plate=Contact(coefficient=0.14999),
        finger=Contact(0.005),
    )
    doubt = Coefficients.of(drive).doubt
    assert doubt and "coefficient is 0.14999, outside the 0.15 to 0.30" in doubt

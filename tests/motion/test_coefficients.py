"""Friction as a coefficient: forces follow mass, preload and touch, in every description."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from command import run
from pindrive import Contact, Drive, Profile, Release, load_device, simulate, simulate_batch
from pindrive.device import Device, Electromagnet
from pindrive.motion.coefficients import Coefficients
from pindrive.motion.simulate import motion_of
from pindrive.study.evaluate import evaluate
from pindrive.study.spec import load_study
from pindrive.study.validation import coefficient_range

G = 9.80665
PLATE = Contact(coefficient=0.225, static_coefficient=0.27)
FINGER = Contact(coefficient=0.5, static_coefficient=0.75)
BODY: dict[str, Any] = {"mass": 0.010, "stiffness": 100.0, "damping": 0.32}
DRIVE = Drive(**BODY, plate=PLATE, finger=FINGER, touch_force=0.010)
RELEASE = Release(0.060, 2e-3)
CURVE = ((0.0, 0.225), (0.05, 0.15))
CURVED = replace(DRIVE, plate=Contact(static_coefficient=0.27, coefficient_curve=CURVE))
PRESSED = 0.010 * G + 0.010
"""Weight and touch: the finger presses the pin on the plate."""
LIGHT = replace(DRIVE, load_exponent=2 / 3, reference_touch=0.080, touch_share=0.5)
"""Half of the touch is on the plate, and its friction falls less than the touch."""

FILE = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping = "0.32 N*s/m"
[plate]
coefficient = 0.225
static_coefficient = 0.27
[finger]
coefficient = 0.5
static_coefficient = 0.75
touch_force = "10 mN"
[motion]
mouse_velocity = "60 mm/s"
displacement = "2 mm"
"""
WITH_CURVE = FILE.replace("static_coefficient = 0.27", f"coefficient_curve = {[*map(list, CURVE)]}")
WITH_CURVE = WITH_CURVE.replace("[0.0, 0.2", '["0 mm/s", 0.2').replace("[0.05,", '["50 mm/s",')


def forces(drive: Drive) -> tuple[float, float, float, float]:
    return (
        drive.plate.kinetic,
        drive.plate.static_friction,
        drive.finger.kinetic,
        drive.finger.static_friction,
    )


def by_force(drive: Drive) -> Drive:
    plate, plate_static, finger, finger_static = forces(drive)
    return Drive(**BODY, plate=Contact(plate, plate_static), finger=Contact(finger, finger_static))


# ---- in Python -----------------------------------------------------------------------------------


def test_forces_are_coefficients_times_what_presses() -> None:
    assert forces(DRIVE) == pytest.approx((0.225 * PRESSED, 0.27 * PRESSED, 0.005, 0.0075))
    assert DRIVE.normal_force == pytest.approx(PRESSED)
    pressed = DRIVE.replace(preload="50 mN", touch_force=0.020)
    normal = PRESSED + 0.05 + 0.010
    assert forces(pressed) == pytest.approx((0.225 * normal, 0.27 * normal, 0.010, 0.015))
    assert CURVED.plate.curve == ((0.0, 0.225 * PRESSED), (0.05, 0.15 * PRESSED))
    assert np.isnan(PLATE.kinetic)  # the weight is not known


def test_the_plate_has_a_share_of_the_touch() -> None:
    weight = 0.010 * G
    for share in (0.0, 0.25, 1.0):
        drive = replace(DRIVE, touch_share=share)
        assert drive.normal_force == pytest.approx(weight + share * 0.010)
        assert drive.plate.kinetic == pytest.approx(0.225 * (weight + share * 0.010))
        assert drive.by_forces.normal_force == pytest.approx(drive.normal_force)
    without = Drive(**BODY, plate=PLATE, finger=Contact(0.005))
    assert without.normal_force == pytest.approx(weight)
    assert Coefficients.of(DRIVE).pressing == "weight and touch"
    assert Coefficients.of(DRIVE.replace(preload=0.1)).pressing == "weight, preload and touch"


def test_friction_of_the_finger_over_its_touch() -> None:
    eighth = LIGHT.finger.kinetic  # of the reference, with a quarter of the friction
    assert eighth == pytest.approx(0.5 * 0.080 / 4, rel=1e-14)
    assert LIGHT.finger.static_friction == pytest.approx(1.5 * eighth, rel=1e-14)
    for exponent in (0.1, 1.0, 2.0):
        at_reference = replace(LIGHT, load_exponent=exponent, touch_force=0.080)
        assert at_reference.finger.kinetic == pytest.approx(0.040, rel=1e-14)
    assert replace(LIGHT, load_exponent=1.0).finger.kinetic == 0.5 * 0.010
    assert replace(LIGHT, touch_force=0.0).finger.kinetic == 0.0


def test_friction_follows_mass_where_it_is_a_coefficient_and_not_where_it_is_a_force() -> None:
    fixed = by_force(DRIVE)
    for mass in (0.005, 0.020):
        heavier = replace(DRIVE, mass=mass)
        normal = mass * G + 0.010
        assert forces(heavier)[:2] == pytest.approx((0.225 * normal, 0.27 * normal))
        assert forces(heavier)[2:] == forces(DRIVE)[2:]
        assert forces(replace(fixed, mass=mass)) == forces(DRIVE)
        assert Coefficients.of(heavier).kinetic == pytest.approx(0.225)


def test_the_motion_is_that_of_the_forces() -> None:
    one, other = simulate(DRIVE, RELEASE), simulate(by_force(DRIVE), RELEASE)
    assert one.events == other.events
    np.testing.assert_equal(one.numbers(), other.numbers())
    named = one.inputs()
    assert (named["plate.coefficient"], named["touch_force"]) == (0.225, 0.010)


def test_a_magnet_adds_its_pull_to_weight_and_preload() -> None:
    drive = DRIVE.replace(preload=0.05)
    device = Device(drive=drive, magnet=Electromagnet(hold_force=1.0))
    held = drive.plate.static_friction * device.load(1.0)
    assert held == pytest.approx(0.27 * (PRESSED + 0.05 + 1.0))


# ---- derivatives ---------------------------------------------------------------------------------

CHANGED: dict[str, Callable[[Drive, float], Drive]] = {
    "mass": lambda d, f: replace(d, mass=d.mass * f),
    "preload": lambda d, f: replace(d, preload=d.preload * f),
    "touch_force": lambda d, f: replace(d, touch_force=(d.touch_force or 0.0) * f),
    "touch_share": lambda d, f: replace(d, touch_share=d.touch_share * f),
    "load_exponent": lambda d, f: replace(d, load_exponent=d.load_exponent * f),
    "reference_touch": lambda d, f: replace(d, reference_touch=(d.reference_touch or 0.0) * f),
    "plate_coefficient": lambda d, f: replace(d, plate=scaled(d.plate, "coefficient", f)),
    "plate_static_coefficient": lambda d, f: replace(
        d, plate=scaled(d.plate, "static_coefficient", f)
    ),
    "finger.coefficient": lambda d, f: replace(d, finger=scaled(d.finger, "coefficient", f)),
}


def scaled(contact: Contact, name: str, factor: float) -> Contact:
    parts = {n: getattr(contact, n) for n in ("coefficient", "static_coefficient")}
    rows = contact.coefficient_curve
    if rows and name == "coefficient":  # its first row is that, and nothing else
        rows = ((0.0, rows[0][1] * factor), *rows[1:])
    return Contact(**parts | {name: parts[name] * factor}, coefficient_curve=rows)


@pytest.mark.parametrize("name", CHANGED)
@pytest.mark.parametrize("curved", [False, True])
def test_derivatives_are_the_limits_of_differences(name: str, curved: bool) -> None:
    base = replace(CURVED if curved else DRIVE, preload=0.02)
    if name in ("touch_force", "touch_share", "load_exponent", "reference_touch"):
        light = {n: getattr(LIGHT, n) for n in ("touch_share", "load_exponent", "reference_touch")}
        base = replace(base, **light)
    if curved and name == "plate_static_coefficient":
        base = replace(base, plate=Contact(static_coefficient=0.27, coefficient=0.225))
    size = {"mass": 0.010, "preload": 0.02, "touch_force": 0.010}.get(name)
    if name in ("touch_share", "load_exponent", "reference_touch"):
        size = getattr(base, name)
    if size is None:
        table, part = re.split("[._]", name, maxsplit=1)
        size = getattr(getattr(base, table), part)
    # Beyond the first event at the plate static friction has a part.
    release = Release(Profile([0.0, 0.05, 0.1], [0.06, 0.0, 0.06]), 2e-3)
    sensitivity = simulate(base, release, duration=0.09).sensitivity([name])
    times = np.linspace(0.0, 0.09, 7)
    around = [
        simulate(CHANGED[name](base, 1.0 + h), release, duration=0.09).position(times)
        for h in (1e-6, -1e-6)
    ]
    differences = (around[0] - around[1]) / (2e-6 * size)
    (exact,) = sensitivity.position(times)
    assert sensitivity.gaps == {}
    scale = np.abs(differences).max()
    if name != "plate_static_coefficient":
        assert scale > 0.0
    np.testing.assert_allclose(exact, differences, atol=2e-6 * scale + 1e-15)


def test_a_parameter_that_the_drive_has_not_is_refused() -> None:
    motion = simulate(replace(DRIVE, plate=Contact(0.02)), RELEASE)
    with pytest.raises(ValueError, match="parameter must be one that this motion was given"):
        motion.sensitivity(["plate_coefficient"])
    with pytest.raises(ValueError, match=r"one of mass, .*touch_force, .* or a row"):
        motion.sensitivity(["coefficient"])


# ---- many at once --------------------------------------------------------------------------------


def test_a_batch_of_masses_coefficients_and_touches_is_that_of_single_motions() -> None:
    masses, touches = np.array([0.005, 0.010, 0.020])[:, np.newaxis], np.array([0.0, 0.01, 0.05])
    found = simulate_batch(DRIVE, RELEASE, mass=masses, touch_force=touches)
    for i, j in np.ndindex(3, 3):
        drive = replace(DRIVE, mass=float(masses[i, 0]), touch_force=float(touches[j]))
        single = simulate(drive, RELEASE).transient.settling_time
        assert float(found.transient_settling_time[i, j]) == pytest.approx(single, rel=1e-12)
    over = simulate_batch(DRIVE, RELEASE, plate_coefficient=[0.1, 0.2, -0.1, np.nan], preload=0.1)
    names = dict(zip(over.status.flag_values, over.status.flag_meanings.split(), strict=True))
    assert [names[code] for code in over.status.values] == [
        *("ok", "ok", "bad_plate_kinetic", "bad_plate_kinetic"),
    ]
    assert over.plate_coefficient.attrs["symbol"] == "μ_p"


def test_a_batch_of_shares_and_exponents_is_that_of_single_motions() -> None:
    varied: dict[str, Any] = {
        "touch_share": [0.0, 0.5, 1.0, 1.0],
        "load_exponent": [1.0, 0.5, 2 / 3, 1.5],
        "reference_touch": [0.01, 0.02, 0.08, 0.02],
    }
    found = simulate_batch(DRIVE, RELEASE, **varied)
    for i, each in enumerate(zip(*varied.values(), strict=True)):
        drive = replace(DRIVE, **dict(zip(varied, each, strict=True)))
        single = simulate(drive, RELEASE).transient.settling_time
        assert float(found.transient_settling_time[i]) == pytest.approx(single, rel=1e-12)
    with pytest.raises(ValueError, match="reference_touch must be given where the load exponent"):
        simulate_batch(DRIVE, RELEASE, load_exponent=[1.0, 0.5])


def test_a_batch_refuses_a_coefficient_beside_a_force() -> None:
    words = "plate.coefficient must be left out where plate.kinetic gives the friction as a force"
    for drive, varied in (
        (DRIVE, {"plate_kinetic": 0.02}),
        (replace(DRIVE, plate=Contact(0.02)), {"plate_coefficient": [0.2, 0.3]}),
    ):
        with pytest.raises(ValueError, match=words):
            simulate_batch(drive, RELEASE, **varied)


# ---- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: Contact(0.02, coefficient=0.2),
            "coefficient must be left out where kinetic gives the friction as a force, got both, "
            "coefficient and kinetic",
        ),
        (
            lambda: Contact(coefficient=0.2, static="20 mN"),
            "coefficient must be left out where static gives the friction as a force, got both, "
            "coefficient and static",
        ),
        (
            lambda: Contact(coefficient=-0.2),
            "coefficient must be finite and at least 0, got -0.2",
        ),
        (
            lambda: Contact(coefficient=0.3, static_coefficient=0.2),
            "static_coefficient must be at least the kinetic friction coefficient, 0.3, got 0.2",
        ),
        (
            lambda: Contact(static_coefficient=0.2),
            "coefficient must be a plain number unless a curve is given, got None",
        ),
        (
            lambda: Contact(coefficient_curve=[(0.0, 0.2), (0.1, -0.2)]),
            "coefficient_curve[1] coefficient must be finite and at least 0, got -0.2",
        ),
        (
            lambda: Drive(**BODY, plate=PLATE, finger=FINGER),
            "touch_force must be given where a coefficient gives the finger's friction, got none",
        ),
        (
            lambda: Drive(**BODY, plate=PLATE, finger=Contact(0.005), touch_force=0.01),
            "touch_force must be left out where the finger's friction is given as a force, got "
            "0.01 N",
        ),
        (
            lambda: replace(DRIVE, load_exponent=0.5),
            "reference_touch must be given where the load exponent is not 1, as the touch at which "
            "the coefficients hold, got none",
        ),
        (
            lambda: Drive(**BODY, plate=PLATE, finger=Contact(0.005), reference_touch=0.01),
            "reference_touch must be left out where the finger's friction is given as a force, got "
            "0.01 N",
        ),
        (
            lambda: replace(LIGHT, load_exponent=0.0),
            "load_exponent must be finite and at least 0.1 and at most 2, got 0.0",
        ),
        (
            lambda: replace(DRIVE, touch_share=1.5),
            "touch_share must be finite and at least 0 and at most 1, got 1.5",
        ),
        (
            lambda: replace(DRIVE, touch_force=-0.01),
            "touch_force must be finite and at least 0 N, got -0.01 N",
        ),
        (
            lambda: DRIVE.replace(preload="-1 mN"),
            'preload must be finite and at least 0 N, got "-1 mN"',
        ),
    ],
)
def test_incompatible_arguments_are_refused(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError) as refused:
        make()
    assert str(refused.value) == message


# ---- in device files -----------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("device.toml").write_text(FILE)
    return tmp_path


@pytest.mark.usefixtures("folder")
def test_a_file_has_the_drive_of_its_coefficients() -> None:
    device = load_device("device.toml")
    assert device.drive == DRIVE
    values = device.values()
    assert values["plate.kinetic"] == DRIVE.plate.kinetic
    assert (values["finger.touch_force"], values["plate.preload"]) == (0.010, 0.0)
    heavier = load_device("device.toml", {"mass": "20 g", "touch_force": "20 mN"}).drive
    assert (
        load_device(
            "device.toml",
            {"load_exponent": 2 / 3, "finger.reference_touch": "80 mN", "plate.touch_share": 0.5},
        ).drive
        == LIGHT
    )
    assert forces(heavier) == pytest.approx([2.0 * force for force in forces(DRIVE)])
    # Static friction and the skin's stretch keep their ratio.
    kept = load_device("device.toml", {"plate.coefficient": 0.45})
    assert kept.drive.plate.static_coefficient == 0.54
    Path("device.toml").write_text(WITH_CURVE)
    curved = load_device("device.toml", {"plate.coefficient": 0.45, "mass": 0.02}).drive.plate
    assert curved.coefficient_curve == ((0.0, 0.45), (0.05, 0.3))
    normal = 0.02 * G + 0.010
    assert curved.curve == ((0.0, 0.45 * normal), (0.05, 0.3 * normal))


@pytest.mark.usefixtures("folder")
def test_stretch_keeps_its_ratio_to_what_the_touch_lets_the_skin_hold() -> None:
    text = FILE.replace("[motion]", 'stiffness = "1000 N/m"\n[motion]\nskin_stretch = "3 um"')
    Path("device.toml").write_text(text)
    softer = load_device("device.toml", {"touch_force": "5 mN"})
    assert softer.release.skin_stretch == pytest.approx(1.5e-6)
    smoother = load_device("device.toml", ["finger.coefficient=0.25"])
    assert smoother.release.skin_stretch == pytest.approx(1.5e-6)  # static friction follows


REFUSED: Mapping[str, tuple[str, tuple[str, ...], str]] = {
    "in the file": (
        FILE.replace("coefficient = 0.5", 'coefficient = 0.5\nkinetic = "5 mN"'),
        (),
        "device.toml: finger.coefficient must be left out where finger.kinetic gives the friction "
        "as a force, got both, finger.coefficient and finger.kinetic",
    ),
    "in two places": (
        FILE,
        ("plate.kinetic=20 mN",),
        "--set plate.kinetic: plate.coefficient must be left out where plate.kinetic gives the "
        "friction as a force, got both, plate.coefficient (device.toml) and plate.kinetic "
        "(--set plate.kinetic)",
    ),
    "a touch without a coefficient": (
        FILE.replace("coefficient = 0.5", 'kinetic = "5 mN"').replace("static_co", "#", 2),
        (),
        "device.toml: finger.touch_force must be left out where the finger's friction is given as "
        "a force, got 0.01 N",
    ),
    "a coefficient without a touch": (
        FILE.replace("touch_force", "# touch_force"),
        (),
        "device.toml: finger.touch_force must be given where a coefficient gives the finger's "
        "friction, got none",
    ),
    "a touch that pulls": (
        FILE,
        ("touch_force=-10 mN",),
        '--set touch_force: finger.touch_force must be finite and at least 0 N, got "-10 mN"',
    ),
    "a coefficient with a unit": (
        FILE,
        ("plate.coefficient=0.2 N",),
        "--set plate.coefficient: plate.coefficient must be",
    ),
    "static below kinetic": (
        FILE.replace("0.27", "0.2"),
        (),
        "device.toml: plate.static_coefficient must be at least the kinetic friction coefficient, "
        "0.225, got 0.2",
    ),
}


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("case", REFUSED)
def test_a_file_is_refused_in_one_line(case: str) -> None:
    text, settings, message = REFUSED[case]
    Path("device.toml").write_text(text)
    done = run("simulate", "device.toml", *(f"--set={setting}" for setting in settings))
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.removeprefix("error: ").startswith(message), line


# ---- in studies ----------------------------------------------------------------------------------


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("text", [FILE, WITH_CURVE])
def test_a_study_over_mass_coefficient_or_touch_force_is_physical(text: str) -> None:
    Path("device.toml").write_text(text)
    axes = {
        "drive.mass": [0.005, 0.02],
        "plate.coefficient": [0.15, 0.3],
        "finger.touch_force": [0.005, 0.05],
    }
    for key, values in axes.items():
        lines = f"{key} = {{ list = {[f'{v} {UNITS[key]}'.strip() for v in values]} }}"
        Path("study.toml").write_text(f'base = "device.toml"\n[axes]\n{lines}\n')
        plan = load_study("study.toml")
        columns = plan.columns(0, plan.size)
        table = evaluate(plan, columns, plan.size, ["status", "transient_settling_time", "reason"])
        assert list(table["reason"]) == ["", ""]
        for i, value in enumerate(values):
            own = load_device("device.toml", {key: value})
            motion = simulate(own.drive, own.release)
            settled = motion.transient.settling_time
            assert table["transient_settling_time"][i] == pytest.approx(settled, rel=1e-12)
            at = {name: float(column[i]) for name, column in columns.items()}
            assert forces(motion_of(plan.device_at(at)).drive) == forces(own.drive)
        found = coefficient_range(plan, tolerances=False)
        assert found == ((0.15, 0.3) if key == "plate.coefficient" else None)


UNITS = {"drive.mass": "kg", "plate.coefficient": "", "finger.touch_force": "N"}


@pytest.mark.usefixtures("folder")
def test_a_study_refuses_the_other_of_force_and_coefficient() -> None:
    Path("study.toml").write_text('base = "device.toml"\n[axes]\nplate.kinetic = ["1 mN", "2 mN"]')
    done = run("sweep", "study.toml")
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.endswith(
        "axes: plate.coefficient must be left out where plate.kinetic gives the friction as a "
        "force, got both, plate.coefficient and plate.kinetic"
    )


@pytest.mark.usefixtures("folder")
def test_elasticities_follow_the_weight() -> None:
    Path("study.toml").write_text(
        'base = "device.toml"\n[tolerances]\nmass = "5 %"\nplate.coefficient = "5 %"\n'
        'touch_force = "5 %"\n'
    )
    study = load_study("study.toml")
    found = near(study)
    number = "transient_peak_displacement"
    device = load_device("device.toml")
    value = simulate(device.drive, device.release, duration=found.duration).numbers()

    def changed(**more: float) -> float:
        moved = load_device("device.toml", {k.replace("__", "."): v for k, v in more.items()})
        motion = simulate(moved.drive, moved.release, duration=found.duration)
        return motion.transient.peak_displacement

    h = 1e-6
    for key, size in (("drive__mass", 0.01), ("plate__coefficient", 0.225)):
        difference = (changed(**{key: size * (1 + h)}) - changed(**{key: size * (1 - h)})) / (2 * h)
        exact = found.table[number][key.replace("__", ".")]
        assert exact == pytest.approx(difference / value["transient.peak_displacement"], abs=1e-7)


def near(plan: Any) -> Any:
    from pindrive.study.local_sensitivity import elasticities

    keys = ["drive.mass", "plate.coefficient", "finger.touch_force"]
    return elasticities(plan, keys, plan.tolerance_links)

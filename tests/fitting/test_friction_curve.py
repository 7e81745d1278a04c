"""Friction curves from force against speed, and the curve of a published result."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from notebook_reading import check_faces
from pindrive import (
    Contact,
    Drive,
    HessSoom,
    Recording,
    Release,
    Status,
    Stribeck,
    fit,
    fit_friction,
    simulate,
)
from pindrive.fitting.comparison import LAWS, compare_models
from recordings import recorded

PUBLISHED = Path(__file__).parents[1] / "published" / "data" / "msl-friction-stop2.csv"


def stribeck(u: np.ndarray) -> np.ndarray:
    return 3.0 + u + 5.0 * np.exp(-2.0 * u)


def test_rows_of_a_curve_come_back_with_their_errors() -> None:
    rng = np.random.default_rng(5)
    speed = rng.uniform(-0.3, 0.3, 800)
    true = np.interp(np.abs(speed), [0.0, 0.05, 0.3], [0.022, 0.015, 0.018])
    found = fit_friction(speed, np.sign(speed) * true + 5e-4 * rng.normal(size=800))
    at, force = np.array(found.rows).T
    assert len(found.rows) == 3 == min(found.aicc, key=lambda n: found.aicc[n])
    assert at[1] == pytest.approx(0.05, abs=0.004)
    np.testing.assert_allclose(force, [0.022, 0.015, 0.018], atol=3e-4)
    assert np.abs(found(speed) - true).max() < 5e-4
    assert found.noise == pytest.approx(5e-4, rel=0.1)
    assert found.contact(static=0.03).curve == found.rows
    data = found.to_dataset()
    assert data.curve_force.values.tolist() == force.tolist()
    assert data.aicc.sel(row_count=3) == min(found.aicc.values())


def test_coulomb_friction_needs_one_row_and_a_smooth_law_more() -> None:
    rng = np.random.default_rng(6)
    speed = np.abs(rng.normal(size=300)) * 0.1
    one = fit_friction(speed, 0.02 + 1e-3 * rng.normal(size=300))
    assert len(one.rows) == 1
    smooth = fit_friction(speed * 20.0, stribeck(speed * 20.0) + 0.02 * rng.normal(size=300))
    assert len(smooth.rows) >= 4
    off = smooth(speed * 20.0) - stribeck(speed * 20.0)
    assert np.sqrt(np.mean(off**2)) < 0.02
    assert len(fit_friction(speed, 0.02 + speed, rows=5).rows) == 5


def test_hysteresis_is_no_noise() -> None:
    """Friction that lags behind a swinging speed: another force as it rises than as it falls."""
    t = np.linspace(0.0, 4.0 * np.pi, 400)
    speed = np.sin(t)
    force = np.sign(speed) * (0.02 + 0.01 * np.cos(t) * np.sign(speed))
    with pytest.warns(UserWarning, match="two branches: where the speed rises, the force is"):
        found = fit_friction(speed, force)
    assert found.status is Status.incomplete
    assert found.r_squared < 0.3
    assert found.effective_size < 0.1 * len(speed)
    assert [*found.branches] == ["speed rises", "speed falls"]
    rise, fall = found.branches.values()
    assert rise - fall == pytest.approx(4.0 * 0.01 / np.pi, rel=0.05)  # mean of |cos|, twice
    labels = [line.get_label() for line in found.plot().axes[0].lines]
    assert {"speed rises", "speed falls"} <= {*labels}
    assert "R² " in repr(found)


def test_directions_of_sliding_may_differ() -> None:
    rng = np.random.default_rng(1)
    speed = rng.uniform(-0.2, 0.2, 400)
    force = np.sign(speed) * np.where(speed > 0, 0.024, 0.020) + 3e-4 * rng.normal(size=400)
    with pytest.warns(UserWarning, match="two branches: forward the force is 0.00[34]"):
        found = fit_friction(speed, force)
    assert [*found.branches] == ["forward", "backward"]


def test_samples_that_are_alike_count_for_fewer() -> None:
    rng = np.random.default_rng(1)
    speed = np.linspace(0.01, 0.2, 600)
    slow = 4e-4 * rng.normal(size=600)
    for i in range(1, 600):
        slow[i] = 0.9 * slow[i - 1] + np.sqrt(1.0 - 0.81) * slow[i]
    found = fit_friction(speed, 0.02 + slow, rows=1)
    assert found.effective_size == pytest.approx(600 * 0.1 / 1.9, rel=0.5)
    plain = fit_friction(speed, 0.02 + 4e-4 * rng.normal(size=600), rows=1)
    ratio = found.standard_errors[0] / plain.standard_errors[0]
    assert ratio == pytest.approx(np.sqrt(1.9 / 0.1), rel=0.35)
    assert plain.warnings == ()


def test_the_slope_beyond_the_data_has_its_error() -> None:
    rng = np.random.default_rng(1)
    speed = rng.uniform(0.0, 0.1, 300)
    found = fit_friction(speed, 0.02 - 0.1 * speed + 1e-5 * rng.normal(size=300))
    slope, error = found.slope
    assert slope == pytest.approx(-0.1, abs=4.0 * error)
    assert 0.0 < error < 1e-3
    assert "slope beyond -0.1" in found.plot().axes[0].get_title("left")


@pytest.mark.parametrize(
    ("name", "made"),
    [
        ("coulomb", Contact(0.02, viscous=0.02)),
        ("stribeck", Stribeck(kinetic=0.015, breakaway=0.022, stribeck_velocity=0.03)),
        (
            "stribeck, exponent 2",
            Stribeck(kinetic=0.015, breakaway=0.022, stribeck_velocity=0.05, exponent=2),
        ),
        (
            "hess-soom",
            HessSoom(kinetic=0.015, breakaway=0.022, stribeck_velocity=0.03, viscous=0.01),
        ),
    ],
)
def test_the_law_of_measured_forces_is_the_best(name: str, made: Contact) -> None:
    rng = np.random.default_rng(3)
    speed = rng.uniform(0.0, 0.3, 600)
    drive = Drive(mass=1.0, stiffness=1e-3, damping=0.0, plate=Contact(0.0), finger=made)

    def friction(u: float) -> float:
        """Force at the start of a motion at that speed."""
        motion = simulate(drive, Release(0.0, 0.0, u), duration=1e-5)
        return -float(motion.force("finger", 0.0))

    exact = np.array([friction(float(u)) for u in speed])
    found = fit_friction(speed, exact + 1e-4 * rng.normal(size=600))
    assert found.best == name
    law = found.laws[name]
    np.testing.assert_allclose(law(speed), exact, atol=6e-5)
    assert law.noise == pytest.approx(1e-4, rel=0.1)
    contact = found.contact(law=name)
    assert contact.law in (made.law, "coulomb")
    assert contact.kinetic == pytest.approx(made.kinetic, rel=0.1)
    with pytest.raises(ValueError, match="law must be one of table, coulomb, stribeck, "):
        found.contact(law="none")
    assert {"law"} <= {*found.to_dataset().coords}
    drawn = next(line for line in found.plot().axes[0].lines if line.get_gid() == "law")
    x, y = (np.asarray(data, float) for data in drawn.get_data())
    np.testing.assert_allclose(y, 1e3 * law(1e-3 * x))
    assert drawn.get_label() == name


@pytest.mark.parametrize(
    ("speed", "force", "said"),
    [
        ([0.1] * 9, [1.0] * 8, "force must be finite numbers, as many as speeds, got 8 of them"),
        ([0.1] * 3, [1.0] * 3, "speed must be at least 8 samples, got 3"),
        ([0.0] * 9, [1.0] * 9, "speed must be other than zero somewhere"),
        ([0.1] * 9, [0.0] * 9, "force must be other than zero somewhere"),
    ],
)
def test_bad_data_are_refused(speed: list[float], force: list[float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        fit_friction(speed, force)


def test_the_published_motion_gives_its_friction_curve_back() -> None:
    """Friction 3 + |u| + 5 exp(-2|u|) N, from positions and velocities of the reference result."""
    with PUBLISHED.open(newline="") as file:
        rows = [[float(row[name]) for name in ("time", "s", "v")] for row in csv.DictReader(file)]
    t, s, v = np.array(rows).T
    stop = 0.060596954058015254
    after = (t > stop + 1e-9) & (t < 1.2)
    recordings = [
        Recording(t[t < stop], position=s[t < stop] + 0.25, velocity=v[t < stop]),
        Recording(t[after] - stop, position=s[after] + 0.25, velocity=v[after]),
    ]
    speeds = np.array([0.0, 0.2, 0.45, 0.8, 1.3, 2.0, 3.0, 5.0, 7.5])
    drive = Drive(
        mass=1.0,
        stiffness=500.0,
        damping=0.0,
        plate=Contact(0.0),
        finger=Contact(curve=[(float(u), 6.0) for u in speeds]),
    )
    releases = [Release(0.0, 0.25, -5.0), Release(0.0, -0.15, 0.0)]
    free = [f"finger_curve[{i}].force" for i in range(len(speeds))]
    found = fit(recordings, drive, releases, free=free, profiles=False)
    curve = found.drive.finger.curve
    assert curve
    at = np.linspace(0.05, 6.5, 200)
    force = np.interp(at, *np.array(curve).T)
    np.testing.assert_allclose(force, stribeck(at), rtol=0.03)
    assert any(left.structured for left in found.residuals)  # nine rows are not its smooth law

    law = Stribeck(kinetic=2.0, breakaway=6.0, stribeck_velocity=1.0, viscous=0.5)
    free = [f"finger.{name}" for name in ("kinetic", "breakaway", "stribeck_velocity", "viscous")]
    by_law = fit(recordings, drive.replace(finger=law), releases, free=free, profiles=False)
    values = [by_law[name].value for name in free]
    np.testing.assert_allclose(values, [3.0, 8.0, 0.5, 1.0], rtol=1e-3)
    assert by_law.aicc < found.aicc - 1000.0


def test_the_law_that_made_a_recording_is_the_best_of_five() -> None:
    drive = Drive(
        mass=0.006,
        stiffness=160.0,
        damping=0.19,
        plate=Contact(0.0),
        finger=Contact(0.011, stiffness=700.0),
    )
    release = Release(0.0, 2.2e-3, 0.0)
    start = Drive(
        mass=0.006, stiffness=150.0, damping=0.2, plate=Contact(0.0), finger=Contact(0.01)
    )
    given = recorded(drive, release, rate=2e3)
    found = fit(
        given, start, release, free=["stiffness", "damping", "finger.kinetic"], profiles=False
    )
    assert found.residuals[0].structured
    compared = compare_models(found)
    assert [*compared.fits] == [*LAWS]
    assert compared.best == "compliant skin"
    assert compared.weights["compliant skin"] > 0.999
    assert compared.excess["Coulomb"] > 10.0
    assert compared.to_dataset().parameters.values.tolist() == [3, 4, 5, 6, 4]
    skin = compared.fits["compliant skin"]["finger.stiffness"]
    assert abs(skin.value - 700.0) < 4.0 * skin.standard_error
    assert check_faces(compared) == 1 + len(LAWS)
    panels = compared.plot().axes
    for axes, law in zip(panels, LAWS, strict=True):
        assert axes.get_title("left").startswith(f"{law}: AICc {compared.excess[law]:+.1f}")

"""Fits of recordings that were made of known drives, and what is said of what cannot be told."""

from __future__ import annotations

from math import inf, isfinite
from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares

import pindrive as pd
from benchmarks.fitting import outcome
from cases import cases
from pindrive import Contact, Drive, Profile, Recording, Release, Status, fit
from pindrive.fitting import Fit, Identifiability
from recordings import FREE, RELEASE, START, TRUTH, recorded

TRUE = {
    "stiffness": TRUTH.stiffness,
    "damping": TRUTH.damping,
    "plate.kinetic": TRUTH.plate.kinetic,
    "finger.kinetic": TRUTH.finger.kinetic,
    "displacement": RELEASE.displacement,
}


@pytest.fixture(scope="module")
def found() -> Fit:
    return fit(recorded(rate=5e3), START, RELEASE, free=FREE)


def test_the_truth_is_found_within_its_intervals(found: Fit) -> None:
    for name, true in TRUE.items():
        estimate = found[name]
        low, high = estimate.interval
        assert low < true < high
        assert abs(estimate.value - true) < 4.0 * estimate.standard_error
        assert high - low == pytest.approx(2 * 1.96 * estimate.standard_error, rel=0.15)
        assert estimate.identifiability == "identifiable"
    assert found.status is Status.ok and found.converged and found.warnings == ()
    (left,) = found.residuals
    assert left.noise == pytest.approx(0.01 * 2.3e-3, rel=0.1)
    assert not left.structured
    assert found.drive.stiffness == found["stiffness"].value
    assert found.releases[0].displacement == found["displacement"].value
    assert repr(found) == "<Fit of 5 parameters to 750 samples, ok>"


def test_candidates_of_plain_releases_are_simulated_as_a_batch(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Friction may be free, too."""
    monkeypatch.setattr("pindrive.fitting.search._single_costs", None)
    assert fit(recorded(rate=5e3), START, RELEASE, free=FREE, profiles=False).converged


def test_a_profile_is_the_least_cost_of_the_others(found: Fit) -> None:
    """Held at the end of its interval, a parameter costs what the threshold is."""
    high = found["damping"].interval[1]
    drive = Drive(
        mass=TRUTH.mass, stiffness=150.0, damping=high, plate=TRUTH.plate, finger=TRUTH.finger
    )
    noise = {"position": found.residuals[0].noise}
    (recording,) = found.recordings
    given = Recording(recording.time, position=recording.channels["position"], noise=noise)
    others = [name for name in FREE if name != "damping"]
    held = fit(given, drive, RELEASE, free=others, profiles=False)
    best = fit(given, START, RELEASE, free=FREE, profiles=False)
    n = len(recording.time)
    excess = n * (held.residuals[0].reduced - best.residuals[0].reduced)
    assert excess == pytest.approx(found.threshold, rel=0.02)


def test_one_seed_gives_one_fit(found: Fit) -> None:
    again = fit(recorded(rate=5e3), START, RELEASE, free=FREE)
    assert np.array_equal(again.theta, found.theta)
    assert [e.interval for e in again.estimates] == [e.interval for e in found.estimates]


def test_limits_are_data_shown_in_a_notebook(found: Fit) -> None:
    data = found.to_dataset()
    assert data.value.sel(parameter="damping") == found["damping"].value
    assert data.unit.values.tolist() == ["N/m", "N*s/m", "N", "N", "m"]
    assert data.lower.values.tolist() == [e.interval[0] for e in found.estimates]
    assert data.correlation.sel(parameter="damping", other="damping") == pytest.approx(1.0)
    rest = data.recorded - data.computed
    assert float(rest.std()) == pytest.approx(float(data.noise[0]), rel=0.01)
    assert "<table>" in found._repr_html_()


def test_all_channels_with_offsets_and_an_unknown_time_of_release() -> None:
    names = ("position", "velocity", "acceleration", "force")
    given = recorded(TRUTH, RELEASE, *names, rate=1e3, delay=0.0132, noise=0.02)
    shifted = {**given.channels, "position": given.channels["position"] + 4e-4}
    recording = given.with_changes(channels=shifted)
    free = ["mass", *FREE, "time_offset", "position_offset"]
    done = fit(recording, START, RELEASE, free=free, profiles=False)
    truth = {**TRUE, "mass": TRUTH.mass, "time_offset": 0.0132, "position_offset": 4e-4}
    for estimate in done.estimates:  # a force tells the mass
        assert abs(estimate.value - truth[estimate.name]) < 4.0 * estimate.standard_error
    assert len(done.residuals) == 4
    assert not any(left.structured for left in done.residuals)


def test_a_whole_cycle_of_clamping_carrying_and_release() -> None:
    speed = Profile([0.0, 0.02, 0.1], [0.0, 0.12, 0.12])
    load = Profile([0.0, 0.05, 0.054], [20.0, 20.0, 1.0])
    release = Release(speed, 0.0, None, load)
    given = recorded(TRUTH, release, rate=2e3)
    free = ["stiffness", "damping", "plate.kinetic", "finger.kinetic", "plate_load[1].time"]
    done = fit(given, START, release, free=free, profiles=False)
    truth = {**TRUE, "plate_load[1].time": 0.05}
    for estimate in done.estimates:
        assert abs(estimate.value - truth[estimate.name]) < 4.0 * estimate.standard_error


def test_two_recordings_share_the_drive() -> None:
    slow = recorded(rate=2e3, mouse_velocity=0.12)
    fast_release = Release(0.25, 1.5e-3)
    fast = recorded(TRUTH, fast_release, "velocity", rate=2e3, mouse_velocity=0.25, seed=2)
    done = fit([slow, fast], START, RELEASE, free=FREE, profiles=False)
    truth = {**TRUE, "displacement@0": 2.2e-3, "displacement@1": 1.5e-3}
    assert [e.name for e in done.estimates][-2:] == ["displacement@0", "displacement@1"]
    for estimate in done.estimates:
        assert abs(estimate.value - truth[estimate.name]) < 4.0 * estimate.standard_error
    assert done.releases[1].mouse_velocity == 0.25


# ---- what recordings cannot tell -----------------------------------------------------------------


def test_free_motion_identifies_ratios_alone() -> None:
    """Mass, stiffness, damping and force: found by the rank, reported with the remedy."""
    drive = Drive(
        mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.0), finger=Contact(0.011)
    )
    given = recorded(drive, Release(0.0, 2e-3, 0.0), rate=2e3)
    free = ["mass", "stiffness", "damping", "finger.kinetic", "displacement"]
    done = fit(given, drive, Release(0.0, 2e-3, 0.0), free=free)
    hidden = free[:-1]
    for name in hidden:
        estimate = done[name]
        assert estimate.identifiability is Identifiability.structurally_not
        assert estimate.hidden_with == tuple(hidden)
        assert estimate.explanation == f"fix one of {', '.join(hidden)}"
        assert estimate.standard_error == inf and estimate.interval == (-inf, inf)
    assert done["displacement"].identifiability is Identifiability.identifiable
    assert done.status is Status.incomplete
    ratio = done["stiffness"].value / done["mass"].value
    assert ratio == pytest.approx(drive.stiffness / drive.mass, rel=0.01)
    force = done["finger.kinetic"].value / done["stiffness"].value
    assert force == pytest.approx(0.011 / 160.0, rel=0.1)


def test_static_friction_that_only_lets_the_pin_stick_is_open_on_one_side() -> None:
    """It decides at which turn the pin stays: any larger one keeps it there too, or sooner."""
    drive = Drive(
        mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.0), finger=Contact(0.011)
    )
    release = Release(0.0, 2e-3, 0.0)
    given = recorded(drive, release, rate=2e3)
    done = fit(given, drive, release, free=["stiffness", "finger.kinetic", "finger.static"])
    static = done["finger.static"]
    assert static.identifiability is Identifiability.practically_not
    assert static.interval[0] == -inf and isfinite(static.interval[1])
    assert static.interval[1] > 0.011
    assert static.explanation == "open below, to 0 mN"
    assert any("finger.static is practically not" in line for line in done.warnings)
    assert done["finger.kinetic"].identifiability is Identifiability.identifiable


def test_given_noise_is_kept_and_exceeded_noise_reported() -> None:
    size = 0.01 * 2.3e-3
    given = recorded(rate=2e3)
    x = given.channels["position"]
    good = Recording(given.time, position=x, noise={"position": size})
    done = fit(good, START, RELEASE, free=FREE, profiles=False)
    assert done.residuals[0].noise == size and done.warnings == ()
    tight = Recording(given.time, position=x, noise={"position": size / 3.0})
    doubtful = fit(tight, START, RELEASE, free=FREE, profiles=False)
    assert "times the given noise" in doubtful.warnings[0]
    assert doubtful.status is Status.incomplete


@pytest.mark.explore
def test_intervals_have_their_coverage() -> None:
    """A sample of `python3 run.py bench fitting`, which does it 500 times."""
    done = [outcome(1501, 100, i) for i in range(cases(10))]
    closed = [held for each in done for _, kind, held in each.held if kind == "closed"]
    assert len(closed) > 2 * len(done)
    assert sum(closed) >= 0.75 * len(closed)
    assert all(each.converged and not each.lost for each in done)


# ---- bad input -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("span", "free", "more", "said"),
    [
        (
            0.005,
            FREE,
            {},
            "recording: a recording must be at least 0.0122 s long, a quarter of the",
        ),
        (
            0.1,
            ["damping", "finger.stiffness"],
            {},
            "leave out what changes no sample, got finger.st",
        ),
        (0.1, FREE, {"confidence": 1.0}, "confidence must be between 0 and 1, got 1.0"),
        (0.1, FREE, {"seed": -1}, "seed must be a whole number of at least 0"),
        (
            0.1,
            ["plate.static[2]"],
            {},
            r'free: unknown parameter "plate.static\[2\]"; did you mean plate.static\?',
        ),
    ],
)
def test_bad_input_is_one_line(
    span: float, free: list[str], more: dict[str, Any], said: str
) -> None:
    smooth = Drive(
        mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.03), finger=Contact(0)
    )
    release = Release(1.0, 2e-3, 0.0)
    with pytest.raises(ValueError, match=said) as error:
        fit(
            recorded(smooth, release, span=span),
            START if span < 0.1 else smooth,
            release,
            free=free,
            **more,
        )
    assert "\n" not in str(error.value)


def test_times_before_the_release_need_a_free_offset() -> None:
    given = recorded(rate=2e3)
    early = Recording(given.time - 0.01, position=given.channels["position"])
    with pytest.raises(
        ValueError, match="time must be at least 0 s, the release; free time_offset"
    ):
        fit(early, START, RELEASE, free=["damping"])


def test_name_is_public() -> None:
    assert pd.fit is fit


def test_a_parameter_may_be_shared_or_of_each_recording() -> None:
    """Two recordings with finger friction of their own, and one displacement."""
    other = Drive(
        mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.034), finger=Contact(0.020)
    )
    given = [recorded(TRUTH, rate=2e3), recorded(other, rate=2e3, seed=2)]
    free = ["stiffness", "damping", "plate.kinetic", "finger.kinetic@each", "displacement@all"]
    found = fit(given, START, RELEASE, free=free, profiles=False)
    assert [e.name for e in found.estimates] == [
        *("stiffness", "damping", "plate.kinetic", "finger.kinetic@0", "finger.kinetic@1"),
        "displacement",
    ]
    assert found["finger.kinetic@0"].value == pytest.approx(0.011, rel=0.2)
    assert found["finger.kinetic@1"].value == pytest.approx(0.020, rel=0.2)
    assert found["displacement"].value == pytest.approx(2.2e-3, rel=0.01)
    one, two = found.drives
    assert one.finger.kinetic == found["finger.kinetic@0"].value
    assert two.finger.kinetic == found["finger.kinetic@1"].value
    assert found.motions[1].drive.finger.kinetic == two.finger.kinetic
    with pytest.raises(ValueError, match="each has its own sensor"):
        fit(given, START, RELEASE, free=["time_offset@all"])
    with pytest.raises(ValueError, match="with @each or @all at most"):
        fit(given, START, RELEASE, free=["stiffness@1"])


def test_residuals_and_their_derivatives_are_for_other_programs() -> None:
    found = fit(recorded(rate=2e3), START, RELEASE, free=FREE, profiles=False)
    assert found.names == tuple(FREE)
    residual = found.residual()
    assert residual @ residual == pytest.approx(len(residual) - len(FREE), rel=1e-3)
    again = least_squares(found.residual, 1.02 * found.theta, found.jacobian, x_scale="jac")
    np.testing.assert_allclose(again.x, found.theta, rtol=1e-3)
    with pytest.raises(ValueError, match="theta must be one value for each of stiffness, damping"):
        found.residual([1.0])


def test_a_channel_of_your_own_is_a_function_of_the_motion() -> None:
    clean = recorded(noise=0.0, rate=2e3)
    x = clean.channels["position"]
    noise = 1e-4 * np.random.default_rng(1).normal(size=len(x))
    own = {"gap": 1.0 / (1.0 + 200.0 * x) + noise}
    given = Recording(clean.time + 2e-3, own=own, noise={"gap": 1e-4})
    found = fit(
        given,
        START,
        RELEASE,
        free=[*FREE, "time_offset"],
        bounds={"time_offset": (1e-3, 3e-3)},
        own={"gap": lambda motion, t: 1.0 / (1.0 + 200.0 * motion.position(np.maximum(t, 0.0)))},
        profiles=False,
    )
    assert not found.structured
    for name, value in zip(FREE, (160.0, 0.19, 0.034, 0.011, 2.2e-3), strict=True):
        error = found[name].standard_error
        assert found[name].value == pytest.approx(value, abs=4.0 * error)
        assert error < 0.2 * value
    assert found.plot().axes[0].get_ylabel() == "gap"
    with pytest.raises(ValueError, match="own must be a function for gap, got none"):
        fit(given, START, RELEASE, free=FREE)
    with pytest.raises(ValueError, match="a channel of your own must be named by a word other"):
        Recording(clean.time, own={"position": x})

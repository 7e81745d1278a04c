"""Noise that is not white: chosen by a fit, given, and as numbers of a likelihood."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.stats import multivariate_normal, norm
from scipy.stats import t as student

import pindrive as pd
from pindrive.fitting import Noise
from pindrive.fitting.noise_choice import step_of
from pindrive.fitting.whitening import Whitening, estimated
from recordings import FREE, RELEASE, START, TRUTH, recorded

Array = NDArray[np.float64]
SIZE = 5e-6
CLEAN = recorded(noise=0.0, rate=4e3)
TIMES, PLACES = CLEAN.time, CLEAN.channels["position"]
TRUE = (
    *(160.0, 0.19),
    *(0.034, 0.011, 2.2e-3),
)


def white(seed: int) -> Array:
    return SIZE * np.random.default_rng(seed).normal(size=len(TIMES))


def coloured(seed: int, rho: float = 0.8) -> Array:
    found = white(seed)
    for i in range(1, len(found)):
        found[i] = rho * found[i - 1] + np.sqrt(1.0 - rho**2) * found[i]
    return found


def outlying(seed: int) -> Array:
    rng = np.random.default_rng(seed)
    hit = rng.random(len(TIMES)) < 0.02
    return white(seed) + np.where(hit, 40.0 * SIZE * rng.normal(size=len(TIMES)), 0.0)


DIRT: dict[str, Callable[[int], Array]] = {
    "white": white,
    "linear drift": lambda seed: white(seed) + 4e-5 * TIMES / TIMES[-1] + 3e-5,
    "hum of 50 Hz": lambda seed: white(seed) + 1e-5 * np.sin(314.159 * TIMES + 1.0),
    "correlated": coloured,
    "outliers": outlying,
}


def fitted(x: Array, noise: Noise | str | None = None, **more: object) -> pd.fitting.Fit:
    given = pd.Recording(TIMES, position=x, noise=None if noise is None else {"position": noise})
    return pd.fit(given, START, RELEASE, free=FREE, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", DIRT)
def test_noise_is_chosen_and_intervals_hold(name: str) -> None:
    """At most three of fifteen intervals of 95 % miss the truth."""
    missed = 0
    for seed in (1, 2, 3):
        found = fitted(PLACES + DIRT[name](seed))
        (left,) = found.residuals
        assert name in str(left.model)
        assert name == "white" or left.rejected["white"] > 10.0
        assert not left.structured
        for value, estimate in zip(TRUE, found.estimates, strict=True):
            low, high = estimate.interval
            missed += not low <= value <= high
    assert missed <= 3


def test_numbers_of_the_noise_are_those_that_made_it() -> None:
    (left,) = fitted(PLACES + coloured(4), profiles=False).residuals
    assert left.correlation == pytest.approx(0.8, abs=0.08)
    assert left.noise == pytest.approx(SIZE, rel=0.25)
    x = PLACES + DIRT["hum of 50 Hz"](4) + DIRT["linear drift"](5) - white(5)
    (left,) = fitted(x, profiles=False).residuals
    assert left.added["drift"] == pytest.approx(4e-5, rel=0.1)
    assert np.hypot(left.added["hum_sine"], left.added["hum_cosine"]) == pytest.approx(
        1e-5, rel=0.1
    )
    assert "drift" in left.description
    assert "hum 0.0" in left.description


def test_rounded_samples_tell_their_intervals() -> None:
    """Steps of 20 um, four times the noise: a resting pin reads one value for ever."""
    step, missed = 2e-5, 0
    for seed in (1, 2, 3):
        x = step * np.round((PLACES + white(seed)) / step)
        found = fitted(x)
        (left,) = found.residuals
        assert left.model.step == pytest.approx(step)
        for value, estimate in zip(TRUE, found.estimates, strict=True):
            low, high = estimate.interval
            missed += not low <= value <= high
        assert not left.structured
    assert missed <= 3


def test_given_noise_is_taken() -> None:
    x = PLACES + DIRT["linear drift"](1)
    found = fitted(x, "quadratic drift, outliers", profiles=False)
    (left,) = found.residuals
    assert left.model == Noise(drift="quadratic", outliers=True)
    assert {*left.added} == {"offset", "drift", "bend"}
    assert left.rejected == {}
    assert [e.name for e in found.estimates] == FREE
    (left,) = fitted(x, "choose, white", profiles=False).residuals
    assert left.model.drift == "linear" and not left.model.choose
    assert fitted(x, "white", profiles=False).residuals[0].structured


@pytest.mark.parametrize(("average", "early"), [("before", 0.5), ("centred", 0.0), ("after", -0.5)])
def test_a_sample_may_be_the_mean_over_its_interval(average: str, early: float) -> None:
    motion = pd.simulate(TRUTH, RELEASE, duration=0.2)
    t = np.arange(120) / 1e3 + 2e-3
    parts = 1e-3 * ((np.arange(50) + 0.5) / 50.0 - 0.5 - early)
    x = np.mean(motion.position(t[:, None] + parts), axis=1)
    v = np.mean(motion.velocity(t[:, None] + parts), axis=1)
    noise = {"position": Noise(1e-7, average=average), "velocity": Noise(1e-4, average=average)}
    given = pd.Recording(t, position=x, velocity=v, noise=noise)
    found = pd.fit(given, START, RELEASE, free=FREE, profiles=False)
    for value, estimate in zip(TRUE, found.estimates, strict=True):
        assert estimate.value == pytest.approx(value, rel=1e-3)


def test_missing_samples_change_little() -> None:
    x = PLACES + white(1)
    holes = x.copy()
    holes[::5] = np.nan
    one, other = fitted(x, profiles=False), fitted(holes, profiles=False)
    assert other.residuals[0].count == np.count_nonzero(np.isfinite(holes))
    for a, b in zip(one.estimates, other.estimates, strict=True):
        assert a.value == pytest.approx(b.value, abs=3.0 * b.standard_error)
    assert other.predicted(0, "position")[0].shape == (other.residuals[0].count,)
    assert other.to_dataset().sizes["sample"] == other.residuals[0].count
    assert other.plot().axes


# ---- the likelihoods -----------------------------------------------------------------------------


def test_deviance_of_correlated_noise_is_that_of_its_covariance() -> None:
    times = np.array([0.0, 1.0, 2.0, 5.0, 6.0])
    off = np.array([0.3, -0.2, 0.4, 0.1, -0.5])
    lags = np.abs(times[:, None] - times)
    made = Whitening(0.7, 0.6 ** np.diff(times), 0.6)
    expected = multivariate_normal(cov=0.49 * 0.6**lags).logpdf(off)
    assert made.deviance(off) == pytest.approx(-2.0 * expected)
    assert made.residuals(off) @ made.residuals(off) == pytest.approx(
        off @ np.linalg.solve(0.49 * 0.6**lags, off)
    )


def test_deviance_of_outliers_is_that_of_students_distribution() -> None:
    off = np.array([0.3, -0.2, 4.0])
    made = Whitening(0.5, degrees=3.0, weights=np.ones(3))
    assert made.deviance(off) == pytest.approx(-2.0 * student(3.0, scale=0.5).logpdf(off).sum())


def test_rounded_residuals_are_the_deviance_of_their_intervals() -> None:
    off = np.array([0.0, 1e-6, 0.2, -0.49, 0.51, -1.3, 4.0])
    made = Whitening(0.1, half=0.5)
    level = [np.log(quad(norm(scale=0.1).pdf, o - 0.5, o + 0.5, points=[0.0])[0]) for o in off[:6]]
    assert -0.5 * made.residuals(off)[:6] ** 2 == pytest.approx(
        np.array(level) - level[0], abs=1e-6
    )
    slopes = made.slopes(off, np.ones((len(off), 1)))[:, 0]
    ends = made.residuals(off + 1e-7) - made.residuals(off - 1e-7)
    assert slopes == pytest.approx(ends / 2e-7, rel=1e-4)


def test_correlation_is_not_lost_to_the_parameters_of_a_fit() -> None:
    """Twelve slow columns take up noise; its correlation is found nevertheless."""
    rng, n, rho = np.random.default_rng(3), 400, 0.9
    times = np.arange(n, dtype=np.float64)
    slopes: Array = np.column_stack([np.cos(np.pi * k * (times + 0.5) / n) for k in range(12)])
    found = []
    for _ in range(40):
        e = rng.normal(size=n)
        for i in range(1, n):
            e[i] = rho * e[i - 1] + np.sqrt(1.0 - rho**2) * e[i]
        left = e - slopes @ np.linalg.lstsq(slopes, e, rcond=None)[0]
        found.append(estimated(Noise(correlated=True), left, slopes, times, 1.0, 1.0).correlation)
    assert np.mean(found) == pytest.approx(rho, abs=0.02)


def test_steps_are_read_from_samples() -> None:
    rng = np.random.default_rng(1)
    x = rng.normal(size=500)
    assert step_of(x) is None
    assert step_of(0.1 * np.round(x / 0.1) + 0.03) == pytest.approx(0.1)
    assert step_of(np.round(x, 12)) is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5 um", Noise("5 um")),
        ("5 um, drift", Noise("5 um", drift="linear")),
        ("hum 60 Hz, harmonic, correlated", Noise(hum="60 Hz", harmonics=2, correlated=True)),
        ("step 20 um, average before", Noise(step="20 um", average="before")),
        ("choose", Noise(choose=True)),
    ],
)
def test_noise_is_read_from_text(text: str, expected: Noise) -> None:
    assert Noise.from_text(text) == expected


@pytest.mark.parametrize(
    ("noise", "said"),
    [
        ("slow", "noise must be a size, or like"),
        ("5 parsec", "recording: noise of position: size must be"),
        ("hum 50 mm", "noise of position: hum must be"),
        ("step 0 um", "noise of position: step must be finite and greater than 0"),
        ("step 1 um, outliers", "step must be left out for correlated noise and for outliers"),
    ],
)
def test_bad_noise_is_refused(noise: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        pd.Recording(TIMES, position=PLACES, noise={"position": noise})
    with pytest.raises(ValueError, match="drift must be one of none, offset, linear, quadratic"):
        Noise(drift="cubic")
    with pytest.raises(ValueError, match="average must be one of"):
        Noise(average="sometimes")
    with pytest.raises(ValueError, match="harmonics must be 1 or 2"):
        Noise(hum=50.0, harmonics=3)

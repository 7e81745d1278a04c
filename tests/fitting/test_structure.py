"""Signs of a wrong model: named, with their place in the recording, and absent from a right one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from pindrive import Contact, Drive, Recording, Stribeck
from pindrive.fitting.residuals import places
from pindrive.fitting.search import search
from pindrive.fitting.structure import moved
from recordings import FREE, RELEASE, START, TRUTH, recorded


def with_law(contact: str) -> Drive:
    law = Stribeck(
        kinetic=0.034 if contact == "plate" else 0.011, breakaway=0.05, stribeck_velocity=0.04
    )
    return replace(TRUTH, plate=law) if contact == "plate" else replace(TRUTH, finger=law)


def noisy(drive: Drive, seed: int = 1) -> Recording:
    clean = recorded(drive, RELEASE, noise=0.0, rate=4e3)
    size = 5e-6 * np.random.default_rng(seed).normal(size=len(clean.time))
    return Recording(clean.time, position=clean.channels["position"] + size, name="pin")


@pytest.mark.parametrize("contact", ["plate", "finger"])
def test_the_law_that_is_missing_is_named(contact: str) -> None:
    found = pd.fit(noisy(with_law(contact)), START, RELEASE, free=FREE)
    assert found.structured
    best = next(iter(found.misfit.explanations))
    assert best == f"Stribeck's law at the {contact}"
    assert found.status is pd.Status.incomplete
    drawn = {line.get_gid() for axes in found.plot().axes for line in axes.patches}
    assert {"rest over time", "rest over speed", "rest over position"} <= drawn
    text = "\n".join(found.warnings)
    assert "pin: the residuals of the position keep a structure over the" in text
    assert f"the intervals do not hold; {best} explains more: BIC lower by" in text
    assert "times" not in text


def test_a_right_model_is_not_blamed() -> None:
    for seed in range(1, 6):
        found = pd.fit(noisy(TRUTH, seed), START, RELEASE, free=FREE, profiles=False)
        assert found.warnings == ()
        assert not found.misfit.explanations


def test_a_mass_of_the_mount_is_an_oscillation() -> None:
    clean = noisy(TRUTH)
    t = clean.time
    ring = 3e-5 * np.exp(-t / 0.03) * np.cos(2.0 * np.pi * 210.0 * t)
    given = Recording(t, position=clean.channels["position"] + ring)
    found = pd.fit(given, START, RELEASE, free=FREE, profiles=False)
    best = next(iter(found.misfit.explanations))
    assert best.endswith("Hz (as of a mass of the mount)")
    assert float(best.split()[3]) == pytest.approx(210.0, rel=0.06)


def test_a_parameter_that_moves_between_halves_is_named() -> None:
    rng = np.random.default_rng(1)
    t = np.linspace(0.0, 1.0, 400)
    slopes = np.column_stack([np.ones_like(t), np.sin(9.0 * t)])
    off = rng.normal(size=400)
    p_value, found = moved(off, slopes, t, ["offset", "size"])
    assert p_value > 0.01
    assert found == {}
    off[t > 0.5] -= 1.5 * slopes[t > 0.5, 1]  # recorded less computed: larger by 1.5
    p_value, found = moved(off, slopes, t, ["offset", "size"])
    assert p_value < 1e-6
    change, errors = found["size"]
    assert change == pytest.approx(1.5, abs=0.5)
    assert errors > 4.0


def test_residuals_are_tested_where_the_pin_is() -> None:
    rng = np.random.default_rng(2)
    scores, t = rng.normal(size=600), 1e-3 * np.arange(600, dtype=np.float64)
    assert places(scores, {"time": t})["time"].p_value > 1e-3
    assert places(scores, {"time": np.zeros(600)})["time"].p_value == 1.0
    found = places(scores + 2.0 * (abs(t - 0.32) < 0.02), {"time": t})["time"]
    assert found.p_value < 1e-9
    assert found.begin == pytest.approx(0.3, abs=0.03)


def test_a_release_without_a_finger_has_no_law_to_try() -> None:
    drive = Drive(
        mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.034), finger=Contact(0.0)
    )
    given = noisy(drive)
    found = pd.fit(given, drive, RELEASE, free=["stiffness", "damping"], profiles=False)
    assert not found.structured


def test_searches_go_on_while_residuals_keep_a_structure(monkeypatch: pytest.MonkeyPatch) -> None:
    seeds = list[int]()

    def counted(model: Any, weights: Any, seed: int) -> Any:
        seeds.append(seed)
        return search(model, weights, seed)

    monkeypatch.setattr("pindrive.fitting.estimation.search", counted)
    pd.fit(noisy(TRUTH), START, RELEASE, free=FREE, profiles=False)
    assert seeds == [1]
    pd.fit(noisy(with_law("plate")), START, RELEASE, free=FREE, profiles=False)
    assert seeds == [1, 1, 2]


def test_no_interval_is_narrower_than_its_standard_error() -> None:
    """The skin of this recording makes jumps of the cost near the optimum of a rigid finger."""
    drive = Drive(
        mass=0.006,
        stiffness=160.0,
        damping=0.19,
        plate=Contact(0.034),
        finger=Contact(0.011, stiffness=500.0),
    )
    found = pd.fit(noisy(drive), START, RELEASE, free=FREE)
    assert found.structured
    for estimate in found.estimates:
        low, high = estimate.interval
        error = estimate.standard_error if np.isfinite(estimate.standard_error) else 0.0
        assert low <= estimate.value - error
        assert high >= estimate.value + error

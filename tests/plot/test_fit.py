"""The figures of fits: they draw the data, the fit, its residuals and its profiles."""

from __future__ import annotations

from math import isfinite

import numpy as np
import pytest

from figure_reading import data
from pindrive import fit, fit_friction
from pindrive.fitting import Fit
from recordings import FREE, RELEASE, START, recorded


@pytest.fixture(scope="module")
def found() -> Fit:
    return fit(recorded(rate=2e3, delay=0.008), START, RELEASE, free=[*FREE, "time_offset"])


def test_a_fit_is_drawn_with_what_it_was_made_of(found: Fit) -> None:
    figure = found.plot()
    top, rest, *profiles = figure.axes
    (recording,) = found.recordings
    t, x = data(top, "recorded")
    np.testing.assert_allclose(t, 1e3 * recording.time)
    np.testing.assert_allclose(x, 1e3 * recording.channels["position"])
    values, spread = found.predicted(0, "position")
    np.testing.assert_allclose(data(top, "fit")[1], 1e3 * values)
    _, off = data(rest, "residuals")
    np.testing.assert_allclose(off, x - 1e3 * values, atol=1e-12)
    (band,) = (c for c in top.collections if c.get_gid() == "band")
    edges = np.asarray(band.get_paths()[0].vertices)
    assert edges[:, 1].max() == pytest.approx(1e3 * (values + 1.96 * spread).max())
    assert top.get_ylabel() == "$x$ (mm)" and rest.get_xlabel() == "$t$ (ms)"
    shift = 1e3 * found["time_offset"].value
    first = min(e.time for e in found.motions[0].events)
    drawn = [line for line in top.lines if " " in str(line.get_gid())]
    assert min(float(np.asarray(line.get_xdata())[0]) for line in drawn) == pytest.approx(
        1e3 * first + shift
    )
    assert len(profiles) == len(found.estimates)
    for axes, estimate in zip(profiles, found.estimates, strict=True):
        unit, scale = estimate.parameter.scale
        at, excess = data(axes, "profile")
        assert estimate.profile
        assert set(at) <= set(scale * estimate.profile.values)
        assert excess.min() == 0.0 and at[excess.argmin()] == scale * estimate.value
        assert data(axes, "threshold")[1][0] == found.threshold
        (span,) = (p for p in axes.patches if p.get_gid() == "interval")
        box = span.get_path().get_extents(span.get_patch_transform())
        assert all(isfinite(end) for end in estimate.interval)
        np.testing.assert_allclose([box.x0, box.x1], [scale * e for e in estimate.interval])
        assert axes.get_xlabel().endswith(f"({unit})")


def test_the_curve_of_a_friction_fit_and_its_criterion() -> None:
    speed = np.linspace(0.01, 0.3, 60)
    found = fit_friction(speed, 0.02 - 0.02 * speed + 1e-4 * np.sin(99.0 * speed), rows=2)
    left, right = found.plot().axes
    rows = np.array(found.rows)
    np.testing.assert_allclose(data(left, "curve"), 1e3 * rows.T)
    np.testing.assert_allclose(data(left, "measured")[1], 1e3 * found.force)
    counts, excess = data(right, "aicc")
    assert counts.tolist() == [*found.aicc] and excess.min() == 0.0

"""The figure of a design: what it draws is what was found."""

from __future__ import annotations

import matplotlib
import numpy as np
import pytest
from matplotlib.collections import QuadMesh

import pindrive as pd
from design_problems import EXAMPLES, SMALL
from pindrive.optimisation import Design


@pytest.fixture(scope="module")
def found() -> Design:
    return pd.optimise(None, EXAMPLES / "catalogue-problem.toml", effort=SMALL)


def test_the_front_and_the_maps_are_drawn_with_the_design_on_them(found: Design) -> None:
    with matplotlib.rc_context({"figure.max_open_warning": 0}):
        figure = found.plot()
    assert found.front is not None
    front, *maps = [axes for axes in figure.axes if axes.get_xlabel()]
    assert len(maps) == len(found.maps) == 3
    (dots,) = [line for line in front.lines if line.get_gid() == "front"]
    assert np.asarray(dots.get_xdata()) == pytest.approx(1e3 * found.front.goals[:, 0])
    assert np.asarray(dots.get_ydata()) == pytest.approx(found.front.goals[:, 1])
    (star,) = [line for line in front.lines if line.get_gid() == "design"]
    chosen = found.front.goals[found.front.chosen]
    assert np.ravel(star.get_xydata()) == pytest.approx([1e3 * chosen[0], chosen[1]])
    scales = {"drive.mass": 1e3, "finger.kinetic": 1e3, "drive.stiffness": 1.0}
    for axes, drawn in zip(maps, found.maps, strict=True):
        meshes = {m.get_gid(): m for m in axes.collections if isinstance(m, QuadMesh)}
        goal = np.ma.filled(np.ma.asarray(meshes["goal"].get_array()).astype(float), np.nan)
        assert np.ravel(goal) == pytest.approx(1e3 * drawn.goal.ravel(), nan_ok=True)
        unmet = np.ma.getmaskarray(np.ma.masked_invalid(np.ma.asarray(meshes["unmet"].get_array())))
        assert (np.ravel(unmet) == drawn.met.ravel()).all()
        (star,) = [line for line in axes.lines if line.get_gid() == "design"]
        at = [scales[key] * value for key, value in zip(drawn.keys, drawn.design, strict=True)]
        assert np.ravel(star.get_xydata()) == pytest.approx(at)
        assert axes.get_title(loc="left") == f"constraints met in {100 * drawn.met.mean():.3g} %"
    assert maps[0].get_xlabel() == "mass $m$ (g)" and "mN" in maps[0].get_ylabel()
    title = figure.get_suptitle()
    assert f"minimise settling time: {1e3 * found.goals[0].value:.2f} ms" in title

"""Data of another model: the fit reports the misfit."""

from __future__ import annotations

import numpy as np
from sksundae.cvode import CVODE

from pindrive import Contact, Drive, Recording, Release, Status, fit

MASS, STIFFNESS, DAMPING, FORCE, WIDTH = 0.006, 160.0, 0.15, 0.012, 0.05


def test_misfit_of_a_smooth_friction_law_of_sundials_is_reported() -> None:
    def rhs(t: float, y: np.ndarray, yp: np.ndarray) -> None:
        friction = FORCE * np.tanh(y[1] / WIDTH)
        yp[0], yp[1] = y[1], -(STIFFNESS * y[0] + DAMPING * y[1] + friction) / MASS

    t = np.arange(400) * 5e-4
    solver = CVODE(rhs, method="BDF", rtol=1e-9, atol=1e-12)
    x = solver.solve(t, np.array([2e-3, 0.0])).y[:, 0]
    noisy = x + 2e-6 * np.random.default_rng(1).normal(size=len(t))
    start = Drive(
        mass=MASS, stiffness=120.0, damping=0.3, plate=Contact(0.0), finger=Contact(0.005)
    )
    free = ["stiffness", "damping", "finger.kinetic", "displacement"]
    found = fit(Recording(t, position=noisy), start, Release(0.0, 2e-3, 0.0), free=free)
    (left,) = found.residuals
    assert left.structured and left.ljung_box < 1e-6
    assert left.noise > 5.0 * 2e-6  # it is not taken for noise of the sensor
    warning, cause = found.warnings
    assert "keep a structure" in warning
    assert "the intervals do not hold" in cause
    assert found.status is Status.incomplete
    assert abs(found["stiffness"].value / STIFFNESS - 1.0) < 0.05  # the best that Coulomb can do
    assert "structured" in "".join(axes.get_title("left") for axes in found.plot().axes)

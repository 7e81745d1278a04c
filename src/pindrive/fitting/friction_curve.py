"""Friction curve from measured force against speed, with a supported number of points."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from math import log, pi, sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive import lazy
from pindrive.lazy import mpl_figure, optimize, xr
from pindrive.motion.drive import Contact
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import check_whole, refusal
from pindrive.quantities.status import Status
from pindrive.quantities.value import equal_by_value

Array = NDArray[np.float64]

__all__ = ["FrictionCurve", "fit_friction"]

MOST: Final = 12
"""Rows that are tried."""
GRID: Final = 60
"""Places at which another row is tried, evenly through the data."""
WITHOUT_GAIN: Final = 3
"""Rows added without a lower AICc before the search ends."""
KNOT: Final = 2
"""Parameters that a row placed by the data counts for (Friedman, Ann. Statist. 19:1, 1991)."""
CLOSEST: Final = 1e-3
"""Part of the range of speeds by which rows are at least apart."""


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class FrictionCurve(lazy.NotebookHtml):
    """A friction curve: rows (speed, force), linear between them and beyond the last.

    Attributes:
        rows: (speed in m/s, force in N), from 0 m/s on.
        standard_errors: Standard errors of the forces, N, one for each row.
        noise: Standard deviation of the forces about the curve, N.
        aicc: Akaike's corrected criterion for each number of rows that was tried.
        speed: Measured sliding speeds, m/s, shape (n,).
        force: Measured friction forces at them, N, shape (n,).
    """

    rows: tuple[tuple[float, float], ...]
    standard_errors: tuple[float, ...]
    noise: float
    aicc: dict[int, float]
    speed: Array
    force: Array

    def __repr__(self) -> str:
        """Return the number of points and of samples in a line."""
        count = counted(len(self.speed), "sample")
        rows = counted(len(self.rows), "row")
        return (
            f"<FrictionCurve of {rows} from {count}, noise {self.noise:.3g} N, {self.status.name}>"
        )

    @property
    def status(self) -> Status:
        """Always `ok`: what cannot be fitted is refused."""
        return Status.ok

    def __call__(self, speed: ArrayLike) -> Array:
        """The force (N) at sliding speeds (m/s) of either sign, in their shape."""
        u = np.abs(np.asarray(speed, float))
        x, y = np.array(self.rows).T
        if len(x) == 1:
            return np.full_like(u, y[0])
        beyond = y[-1] + (u - x[-1]) * (y[-1] - y[-2]) / (x[-1] - x[-2])
        found: Array = np.where(u > x[-1], beyond, np.interp(u, x, y))
        return found

    def contact(self, static: float | None = None) -> Contact:
        """A contact with this friction, and static friction (N; None: the force at rest)."""
        return Contact(static=static, curve=self.rows)

    def plot(self) -> mpl_figure.Figure:
        """Measured forces, the curve and its rows over speed, and AICc over their number."""
        from pindrive.plot.fit import plot_friction_curve

        return plot_friction_curve(self)

    def to_dataset(self) -> xr.Dataset:
        """Rows over `row`, AICc over `row_count`, and the data over `sample`, SI."""
        x, y = np.array(self.rows).T
        data: dict[str, Any] = {
            "curve_speed": ("row", x, {"units": "m/s"}),
            "curve_force": ("row", y, {"units": "N"}),
            "standard_error": ("row", np.array(self.standard_errors), {"units": "N"}),
            "noise": ((), self.noise, {"units": "N"}),
            "aicc": ("row_count", [*self.aicc.values()], {"units": "1"}),
            "speed": ("sample", self.speed, {"units": "m/s"}),
            "force": ("sample", self.force, {"units": "N"}),
        }
        coords = {"row_count": [*self.aicc]}
        return xr.Dataset(data, coords=coords, attrs={"status": self.status.name})


def fit_friction(speed: ArrayLike, force: ArrayLike, *, rows: int | None = None) -> FrictionCurve:
    """Fit a friction curve to friction forces that were measured at sliding speeds.

    The curve is continuous and linear between rows; least squares place the rows and their forces.
    Rows are added one by one where they help most, and their number is the one with the least
    corrected Akaike criterion.

    Args:
        speed: Sliding speeds, m/s, shape (n,), of either sign.
        force: Friction force against the sliding, N, shape (n,); where it is given with the sign of
            the speed, or the opposite one, its size is taken.
        rows: Number of rows, at least 1; None: by the criterion.

    Returns:
        The rows with their standard errors, and the criterion for each number of rows.

    Raises:
        ValueError: The arrays are empty, differ in length, hold too few samples, have no speed or
            no force other than zero, or a force that mostly acts in the direction of sliding at
            some speeds only.

    Warns:
        UserWarning: the residuals of neighbouring samples are alike, as of hysteresis: friction
            depends on more than the speed.
    """
    u, f = (
        np.asarray(values, float).ravel() if not isinstance(values, str) else np.empty(0)
        for values in (speed, force)
    )
    if len(u) != len(f) or not (np.isfinite(u).all() and np.isfinite(f).all()):
        required = "finite numbers, as many as speeds"
        raise ValueError(refusal("force", required, f"{len(f)} of them and {len(u)} speeds"))
    if rows is not None:
        check_whole(rows, "rows")
    least = max(FEWEST, 2 * (rows or 0) + 2)
    if len(u) < least:
        raise ValueError(refusal("speed", f"at least {least} samples", len(u)))
    if not u.any():
        raise ValueError(refusal("speed", "other than zero somewhere", "0 throughout"))
    if not f.any():
        raise ValueError(refusal("force", "other than zero somewhere", "0 throughout"))
    f = _against(u, f)
    order = np.argsort(np.abs(u), kind="stable")
    u, f = np.abs(u)[order], f[order]
    most = rows or min(MOST, (len(u) - 3) // 2)
    tried = _grown(u, f, most, stop=rows is None)
    aicc = {len(knots): _aicc(u, f, knots) for knots in tried}
    count = rows or min(aicc, key=lambda n: aicc[n])
    knots = next(k for k in tried if len(k) == count)
    values, errors, noise = _solved(u, f, knots)
    residuals = (f - np.interp(u, knots, values))[np.argsort(order)]  # recorded order
    if noise > SMALL * float(np.mean(f)) and _are_alike(residuals):
        warnings.warn(
            f"the forces differ from the curve by {noise:.3g} N, and neighbouring samples to the "
            "same side: friction depends on more than the speed (hysteresis, wear or a load that "
            "changes), or the curve has too few rows",
            stacklevel=2,
        )
    found = tuple(zip(knots.tolist(), np.maximum(values, 0.0).tolist(), strict=True))
    return FrictionCurve(found, tuple(errors.tolist()), noise, aicc, u, f)


HYSTERESIS: Final = 0.7
"""Correlation of the residuals of neighbouring samples beyond which they are no noise."""
SMALL: Final = 0.1
"""Noise, a part of the mean force, below which what the curve leaves out does not matter."""

FEWEST: Final = 8
"""Samples of a friction curve."""


def _are_alike(residuals: Array) -> bool:
    """Return True if neighbouring residuals correlate more than noise."""
    correlation = float(np.sum(residuals[1:] * residuals[:-1]) / np.sum(residuals**2))
    return len(residuals) >= 20 and correlation > HYSTERESIS


def _against(u: Array, f: Array) -> Array:
    """The size of friction: forces with the sign of the speed, or against it, or of none."""
    both = u.min() < 0.0 < u.max()
    if both:
        product = float(np.sum(np.sign(u) * f))
        if abs(product) > 0.5 * float(np.sum(np.abs(f))):
            turned: Array = f * np.sign(u) * np.sign(product)
            return turned
        return f
    return f if f.sum() > 0.0 else -f


def _grown(u: Array, f: Array, most: int, *, stop: bool) -> list[Array]:
    """Knots for 1, 2, ... rows, each from the ones before and one more where it helps most."""
    found = [np.zeros(1)]
    best, since = _aicc(u, f, found[0]), 0
    for count in range(2, most + 1):
        last = float(u[-1])
        if count == 2:
            knots = np.array([0.0, last])
        else:
            places = np.quantile(u, np.linspace(0.0, 1.0, GRID + 2)[1:-1])
            apart = CLOSEST * last
            tried = [
                np.sort(np.append(found[-1], place))
                for place in places
                if np.abs(found[-1] - place).min() > apart
            ]
            if not tried:
                break
            knots = _moved(u, f, min(tried, key=lambda k: _power(u, f, k)))
        found.append(knots)
        aicc = _aicc(u, f, knots)
        best, since = (aicc, 0) if aicc < best else (best, since + 1)
        if stop and since >= WITHOUT_GAIN:
            break
    return found


def _moved(u: Array, f: Array, knots: Array) -> Array:
    """The inner knots where least squares place them; the forces follow from them."""
    last = float(knots[-1])
    parts = np.diff(knots) / last

    def placed(logs: Array) -> Array:
        shares = np.exp(logs - logs.max())
        shares = CLOSEST + shares / shares.sum() * (1.0 - CLOSEST * len(shares))
        return np.concatenate([[0.0], np.cumsum(shares / shares.sum()) * last])

    def off(logs: Array) -> Array:
        at = placed(logs)
        return _hats(u, at) @ _forces(u, f, at) - f

    found = optimize.least_squares(off, np.log(parts), x_scale=1.0, max_nfev=40, ftol=1e-6)
    better = placed(found.x)
    return better if _power(u, f, better) < _power(u, f, knots) else knots


def _hats(u: Array, knots: Array) -> Array:
    """The hat functions of the rows at speeds, shape (n, rows)."""
    if len(knots) == 1:
        return np.ones((len(u), 1))
    i = np.clip(np.searchsorted(knots, u, side="right") - 1, 0, len(knots) - 2)
    part = (u - knots[i]) / (knots[i + 1] - knots[i])
    found = np.zeros((len(u), len(knots)))
    each = np.arange(len(u))
    found[each, i], found[each, i + 1] = 1.0 - part, part
    return found


def _forces(u: Array, f: Array, knots: Array) -> Array:
    values, *_ = np.linalg.lstsq(_hats(u, knots), f, rcond=None)
    return np.asarray(values)


def _power(u: Array, f: Array, knots: Array) -> float:
    """The sum of squares that rows at these speeds leave."""
    off = _hats(u, knots) @ _forces(u, f, knots) - f
    return float(off @ off)


def _aicc(u: Array, f: Array, knots: Array) -> float:
    """Return the corrected Akaike criterion for forces, inner knots and noise."""
    n, k = len(u), len(knots) + KNOT * max(0, len(knots) - 2) + 1
    square = max(_power(u, f, knots) / n, (1e-12 * float(np.abs(f).max())) ** 2)
    return n * (log(2.0 * pi * square) + 1.0) + 2.0 * k + 2.0 * k * (k + 1) / max(n - k - 1, 1)


def _solved(u: Array, f: Array, knots: Array) -> tuple[Array, Array, float]:
    """Forces of the rows, their standard errors, and the noise."""
    hats, values = _hats(u, knots), _forces(u, f, knots)
    off = hats @ values - f
    noise = sqrt(float(off @ off) / max(1, len(u) - 2 * len(knots) + 1))
    inverse = np.linalg.pinv(hats.T @ hats)
    return values, noise * np.sqrt(np.diag(inverse)), noise

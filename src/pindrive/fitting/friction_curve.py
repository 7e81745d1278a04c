"""Friction curve from measured force against speed, with a supported number of points."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from math import log, nan, pi, sqrt
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.lazy import mpl_figure, optimize, xr
from pindrive.motion.drive import Contact
from pindrive.quantities.quantity import counted
from pindrive.quantities.refusal import check_whole, refusal
from pindrive.quantities.status import Status
from pindrive.quantities.value import equal_by_value
from pindrive.views import NotebookHtml, figure

Array = NDArray[np.float64]

__all__ = ["FittedLaw", "FrictionCurve", "fit_friction"]

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


@dataclass(frozen=True)
class FittedLaw:
    """A friction law fitted to forces over speed.

    Attributes:
        kinetic: N, far above the Stribeck velocity and without the viscous part.
        breakaway: N, at rest.
        stribeck_velocity: m/s; NaN of Coulomb's law.
        viscous: N*s/m.
        noise: Standard deviation of the forces about the law, N.
        aicc: Akaike's corrected criterion.
    """

    name: str
    kinetic: float
    breakaway: float
    stribeck_velocity: float
    viscous: float
    noise: float
    aicc: float

    def __call__(self, speed: ArrayLike) -> Array:
        """The force (N) at sliding speeds (m/s) of either sign, in their shape."""
        u = np.abs(np.asarray(speed, float))
        shape = _SHAPES[self.name]
        falls = 0.0 if shape is None else shape(u / self.stribeck_velocity)
        found: Array = self.kinetic + (self.breakaway - self.kinetic) * falls + self.viscous * u
        return found

    def contact(self, static: float | None = None) -> Contact:
        """A contact under the law, with static friction (N; None: that at rest)."""
        if self.name == "coulomb":
            return Contact(self.kinetic, static, viscous=self.viscous)
        law, _, exponent = self.name.partition(", exponent ")
        return Contact(
            self.kinetic,
            static,
            law=law,
            breakaway=self.breakaway,
            stribeck_velocity=self.stribeck_velocity,
            exponent=exponent or None,
            viscous=self.viscous,
        )


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class FrictionCurve(NotebookHtml):
    """A friction curve: rows (speed, force), linear between them and beyond the last.

    Attributes:
        rows: (speed in m/s, force in N), from 0 m/s on.
        standard_errors: Standard errors of the forces, N, one for each row.
        noise: Standard deviation of the forces about the curve, N.
        r_squared: Part of the variance of the forces that the curve explains; about 0 where
            friction does not depend on the speed.
        correlation: Correlation of residuals of neighbouring samples, in the recorded order.
        effective_size: Number of independent samples that tell as much, by that correlation.
        branches: Mean force above the curve, N, of two branches that differ: "speed rises" and
            "speed falls", or "forward" and "backward"; empty where they agree.
        slope: Slope of the force beyond the last row, N*s/m, with its standard error; zeros of one
            row.
        aicc: Akaike's corrected criterion, by the effective size, for each number of rows that was
            tried.
        laws: Laws fitted to the same data: "coulomb", "stribeck" and "stribeck, exponent 2", and
            "hess-soom", each with a viscous part.
        speed: Measured sliding speeds, m/s, shape (n,).
        force: Measured friction forces at them, N, shape (n,).
    """

    rows: tuple[tuple[float, float], ...]
    standard_errors: tuple[float, ...]
    noise: float
    r_squared: float
    correlation: float
    effective_size: float
    branches: dict[str, float]
    slope: tuple[float, float]
    aicc: dict[int, float]
    laws: dict[str, FittedLaw]
    speed: Array
    force: Array

    def __repr__(self) -> str:
        """Return the number of points and of samples in a line."""
        count = counted(len(self.speed), "sample")
        rows = counted(len(self.rows), "row")
        size = f"R² {self.r_squared:.2f}, noise {self.noise:.3g} N"
        return f"<FrictionCurve of {rows} from {count}, {size}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where `warnings` says so."""
        return Status.incomplete if self.warnings else Status.ok

    @property
    def warnings(self) -> tuple[str, ...]:
        """Doubts about the curve, a line each."""
        found = []
        noise, mean = self.noise, float(np.mean(self.force))
        if self.branches:
            (one, above), (other, below) = self.branches.items()
            gap = f"the force is {above - below:.3g} N above that"
            if one.startswith("speed"):
                found.append(
                    f"two branches: where the {one}, {gap} where the {other}; friction depends on "
                    "more than the speed"
                )
            else:
                found.append(f"two branches: {one} {gap} {other}")
        elif self.correlation > HYSTERESIS and noise > SMALL * mean and len(self.force) >= LEAST:
            found.append(
                f"the forces differ from the curve by {noise:.3g} N, and neighbouring samples to "
                "the same side: friction depends on more than the speed (wear or a load that "
                "changes), or the curve has too few rows"
            )
        return tuple(found)

    def __call__(self, speed: ArrayLike) -> Array:
        """The force (N) at sliding speeds (m/s) of either sign, in their shape."""
        u = np.abs(np.asarray(speed, float))
        x, y = np.array(self.rows).T
        if len(x) == 1:
            return np.full_like(u, y[0])
        beyond = y[-1] + (u - x[-1]) * (y[-1] - y[-2]) / (x[-1] - x[-2])
        found: Array = np.where(u > x[-1], beyond, np.interp(u, x, y))
        return found

    @property
    def best(self) -> str:
        """The law with the least criterion, by its name in `laws`; "table": the rows."""
        name = min(self.laws, key=lambda name: self.laws[name].aicc)
        # A table of two rows is Coulomb's law with a viscous part, within rounding.
        table = self.aicc[len(self.rows)] < self.laws[name].aicc - 1e-6
        return "table" if table else name

    def contact(self, static: float | None = None, *, law: str = "table") -> Contact:
        """Return a contact with this friction.

        Args:
            static: Static friction, N; None: the force at rest.
            law: Name of a law in `laws`, or "table".

        Raises:
            ValueError: There is no such law, or static friction is too low.
        """
        if law == "table":
            return Contact(static=static, curve=self.rows)
        if law not in self.laws:
            raise ValueError(refusal("law", f"one of table, {', '.join(self.laws)}", repr(law)))
        return self.laws[law].contact(static)

    def plot(self) -> mpl_figure.Figure:
        """Measured forces, the curve and its rows over speed, and AICc over their number."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """Rows over `row`, AICc over `row_count`, and the data over `sample`, SI."""
        x, y = np.array(self.rows).T
        data: dict[str, Any] = {
            "curve_speed": ("row", x, {"units": "m/s"}),
            "curve_force": ("row", y, {"units": "N"}),
            "standard_error": ("row", np.array(self.standard_errors), {"units": "N"}),
            "noise": ((), self.noise, {"units": "N"}),
            "r_squared": ((), self.r_squared, {"units": "1"}),
            "effective_size": ((), self.effective_size, {"units": "1"}),
            "law_aicc": ("law", [law.aicc for law in self.laws.values()], {"units": "1"}),
            "aicc": ("row_count", [*self.aicc.values()], {"units": "1"}),
            "speed": ("sample", self.speed, {"units": "m/s"}),
            "force": ("sample", self.force, {"units": "N"}),
        }
        coords = {"row_count": [*self.aicc], "law": [*self.laws]}
        return xr.Dataset(data, coords=coords, attrs={"status": self.status.name})


def fit_friction(speed: ArrayLike, force: ArrayLike, *, rows: int | None = None) -> FrictionCurve:
    """Fit a friction curve to friction forces that were measured at sliding speeds.

    The curve is continuous and linear between rows; least squares place the rows and their forces.
    Rows are added one by one where they help most, and their number is the one with the least
    corrected Akaike criterion. The laws with a name are fitted to the same data, and `best` is the
    one with the least criterion.

    Args:
        speed: Sliding speeds, m/s, shape (n,), of either sign.
        force: Friction force against the sliding, N, shape (n,); where it is given with the sign of
            the speed, or the opposite one, its size is taken.
        rows: Number of rows, at least 1; None: by the criterion.

    Returns:
        The rows with their standard errors, the laws, and the criterion of each.

    Raises:
        ValueError: The arrays are empty, differ in length, hold too few samples, have no speed or
            no force other than zero, or a force that mostly acts in the direction of sliding at
            some speeds only.

    Warns:
        UserWarning: each of `FrictionCurve.warnings`: two branches, as of hysteresis, or
            neighbouring samples that are alike and far from the curve.
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
    signed = u
    order = np.argsort(np.abs(u), kind="stable")
    u, f = np.abs(u)[order], f[order]
    most = rows or min(MOST, (len(u) - 3) // 2)
    tried = _grown(u, f, most, stop=rows is None)
    recorded = np.argsort(order)  # places of the samples in their recorded order
    count, correlation = rows or 0, 0.0
    for _ in range(1 if rows else ROUNDS):  # the best rows, and the correlation that they leave
        size = len(u) * _independent(correlation)
        aicc = {len(knots): _aicc(u, f, knots, size) for knots in tried}
        count = rows or min(aicc, key=lambda n: aicc[n])
        knots = next(k for k in tried if len(k) == count)
        values, errors, noise = _solved(u, f, knots)
        residuals = (f - _hats(u, knots) @ values)[recorded]
        correlation = _of_neighbours(residuals)
    size = len(u) * _independent(correlation)
    aicc = {len(knots): _aicc(u, f, knots, size) for knots in tried}
    errors = errors / np.sqrt(_independent(correlation))
    spread = float(np.sum((f - f.mean()) ** 2))
    made = FrictionCurve(
        rows=tuple(zip(knots.tolist(), np.maximum(values, 0.0).tolist(), strict=True)),
        standard_errors=tuple(errors.tolist()),
        noise=noise,
        r_squared=1.0 - float(residuals @ residuals) / spread if spread else 0.0,
        correlation=correlation,
        effective_size=size,
        branches=_branches(signed, residuals, float(np.mean(f))),
        slope=_last_slope(knots, values, errors),
        aicc=aicc,
        laws={name: _law(name, u, f, size) for name in _SHAPES},
        speed=u,
        force=f,
    )
    for line in made.warnings:
        warnings.warn(line, stacklevel=2)
    return made


def _of_neighbours(residuals: Array) -> float:
    """Return the correlation of neighbouring residuals; 0 of few samples, or below."""
    power = float(residuals @ residuals)
    if len(residuals) < LEAST or power == 0.0:
        return 0.0
    return min(max(float(residuals[1:] @ residuals[:-1]) / power, 0.0), 0.999)


def _independent(correlation: float) -> float:
    """Return the part of samples of a first-order process that are independent ones."""
    return (1.0 - correlation) / (1.0 + correlation)


def _branches(u: Array, residuals: Array, mean: float) -> dict[str, float]:
    """Return the mean residual of branches that differ by more than their scatter."""
    rate = np.gradient(np.abs(u))
    for names, which in (
        (("speed rises", "speed falls"), rate),
        (("forward", "backward"), u),
    ):
        parts = [residuals[which > 0.0], residuals[which < 0.0]]
        if min(len(part) for part in parts) < FEWEST:
            continue
        means = [float(part.mean()) for part in parts]
        inner = residuals - np.where(which > 0.0, *means)
        independent = len(inner) * _independent(_of_neighbours(inner))
        part = independent / len(inner)
        error = float(np.std(inner)) * np.sqrt(sum(1.0 / (part * len(each)) for each in parts))
        gap = abs(means[0] - means[1])
        if gap > APART * error and gap > SMALL * mean:
            found = dict(zip(names, means, strict=True))
            return dict(sorted(found.items(), key=lambda item: -item[1]))
    return {}


def _last_slope(knots: Array, values: Array, errors: Array) -> tuple[float, float]:
    """Return the slope between the last two rows, with its standard error."""
    if len(knots) < 2:
        return 0.0, 0.0
    across = float(knots[-1] - knots[-2])
    return float(values[-1] - values[-2]) / across, float(np.hypot(*errors[-2:])) / across


_SHAPES: Final[dict[str, Callable[[Array], Array] | None]] = {
    "coulomb": None,
    "stribeck": lambda s: np.exp(-s),
    "stribeck, exponent 2": lambda s: np.exp(-s * s),
    "hess-soom": lambda s: 1.0 / (1.0 + s * s),
}
"""The part that falls, over the speed in units of the Stribeck velocity."""


def _law(name: str, u: Array, f: Array, size: float) -> FittedLaw:
    """A law by least squares, no force negative; the Stribeck velocity by a search along it."""
    shape = _SHAPES[name]

    def solved(velocity: float) -> tuple[Array, float]:
        falls = [] if shape is None else [shape(u / velocity)]
        values, off = optimize.nnls(np.column_stack([np.ones_like(u), u, *falls]), f)
        return values, off**2

    velocity = nan
    if shape is not None:
        last = float(u[-1])
        grid = np.log(np.geomspace(CLOSEST * last, 2.0 * last, GRID))
        at = int(np.argmin([solved(v)[1] for v in np.exp(grid)]))
        ends = grid[max(at - 1, 0)], grid[min(at + 1, GRID - 1)]
        found = optimize.minimize_scalar(
            lambda log_v: solved(np.exp(log_v))[1], bounds=ends, method="bounded"
        )
        velocity = float(np.exp(found.x))
    values, power = solved(velocity)
    kinetic, viscous = float(values[0]), float(values[1])
    rest = kinetic + (float(values[2]) if shape is not None else 0.0)
    n, k = len(u), 3 if shape is None else 5
    noise = sqrt(power / max(1, n - k + 1))
    return FittedLaw(name, kinetic, rest, velocity, viscous, noise, _criterion(power, f, k, size))


HYSTERESIS: Final = 0.7
"""Correlation of the residuals of neighbouring samples beyond which they are no noise."""
SMALL: Final = 0.1
"""Noise, a part of the mean force, below which what the curve leaves out does not matter."""

LEAST: Final = 20
"""Samples of which the correlation of neighbours is computed."""
APART: Final = 4.0
"""Standard errors by which branches differ."""
ROUNDS: Final = 4
"""Choices of the number of rows, each with the correlation that the one before leaves."""
FEWEST: Final = 8
"""Samples of a friction curve, and of a branch."""


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
    best, since = _aicc(u, f, found[0], len(u)), 0
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
        aicc = _aicc(u, f, knots, len(u))
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


def _aicc(u: Array, f: Array, knots: Array, size: float) -> float:
    """Return the corrected Akaike criterion for forces, inner knots and noise."""
    count = len(knots) + KNOT * max(0, len(knots) - 2) + 1
    return _criterion(_power(u, f, knots), f, count, size)


def _criterion(power: float, f: Array, k: int, n: float) -> float:
    """Return the corrected Akaike criterion of a sum of squares, k parameters, n free samples."""
    square = max(power / len(f), (1e-12 * float(np.abs(f).max())) ** 2)
    return n * (log(2.0 * pi * square) + 1.0) + 2.0 * k + 2.0 * k * (k + 1) / max(n - k - 1, 1)


def _solved(u: Array, f: Array, knots: Array) -> tuple[Array, Array, float]:
    """Forces of the rows, their standard errors, and the noise."""
    hats, values = _hats(u, knots), _forces(u, f, knots)
    off = hats @ values - f
    noise = sqrt(float(off @ off) / max(1, len(u) - 2 * len(knots) + 1))
    inverse = np.linalg.pinv(hats.T @ hats)
    return values, noise * np.sqrt(np.diag(inverse)), noise

"""Results of a fit: estimates with intervals, residuals, and the fitted drive."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import exp, isfinite, log
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pindrive.fitting.identifiability import Identifiability
from pindrive.fitting.least_squares import Problem
from pindrive.fitting.model import Model
from pindrive.fitting.parameters import Parameter
from pindrive.fitting.profiles import ProfileLikelihood
from pindrive.fitting.recording import Recording, unit_of
from pindrive.fitting.residuals import Residuals, binned
from pindrive.fitting.structure import Misfit
from pindrive.fitting.whitening import UNLIKELY, Whitening
from pindrive.lazy import mpl_figure, xr
from pindrive.motion.drive import Drive
from pindrive.motion.motion import Motion
from pindrive.motion.release import Release
from pindrive.motion.simulate import simulated
from pindrive.quantities.quantity import counted, significant
from pindrive.quantities.refusal import refusal
from pindrive.quantities.status import Status
from pindrive.quantities.value import concise, equal_by_value
from pindrive.views import NotebookHtml, figure

Array = NDArray[np.float64]

__all__ = ["Estimate", "Fit", "ModelComparison"]

PLACE_UNITS: Final = {"time": ("ms", 1e3), "speed": ("mm/s", 1e3), "position": ("mm", 1e3)}
"""Display unit of each quantity over which residuals are tested, and its number in an SI unit."""


@equal_by_value
@concise
@dataclass(frozen=True, slots=True)
class Estimate:
    """One fitted parameter.

    Attributes:
        parameter: Parameter with name, unit (SI) and bounds of the search.
        value: SI.
        standard_error: Standard error from the derivatives at the optimum; infinite for an
            undetermined estimate.
        interval: Ends of the interval by profile likelihood, and at least a standard error to
            either side; infinite on a side on which the profile reaches the bound of the search
            before its end.
        identifiability: Identifiability of the parameter from the recordings.
        hidden_with: Parameters of which the recordings tell combinations with this one alone,
            itself among them.
        profile: The least cost at other values of it; None where it was not computed.
    """

    parameter: Parameter
    value: float
    standard_error: float
    interval: tuple[float, float]
    identifiability: Identifiability
    hidden_with: tuple[str, ...]
    profile: ProfileLikelihood | None

    @property
    def name(self) -> str:
        """Name of the parameter."""
        return self.parameter.name

    @property
    def explanation(self) -> str:
        """Remedy for an undetermined parameter; empty for a determined one."""
        match self.identifiability:
            case Identifiability.identifiable:
                return ""
            case Identifiability.structurally_not if len(self.hidden_with) > 1:
                return f"fix one of {', '.join(self.hidden_with)}"
            case Identifiability.structurally_not:
                return "the recordings do not depend on it; fix it"
        below, above = (not isfinite(end) for end in self.interval)
        unit, scale = self.parameter.scale
        low, high = (
            f"{significant(end * scale, 3)} {unit}".rstrip()
            for end in (self.parameter.lower, self.parameter.upper)
        )
        if below and above:
            return f"open on both sides, to {low} and {high}; fix it, or record another motion"
        return f"open below, to {low}" if below else f"open above, to {high}"


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Fit(NotebookHtml):
    """Result of `fit`.

    Attributes:
        model: The recordings, with their noise, as functions of the parameters.
        given: Recordings as they were given.
        theta: The values of all parameters, SI, shape (k,): of the estimates, and after them of
            what the noise adds.
        estimates: Estimates with interval and identifiability.
        covariance: Covariance of all values, from the derivatives at the optimum, shape (k, k).
        correlation: Correlation of all values; NaN for an undetermined one.
        residuals: Residuals of each channel of each recording.
        whitenings: Map from the residuals of each channel to independent ones.
        misfit: Signs that the drive does what the model does not.
        confidence: Confidence of the intervals.
        threshold: The increase of the cost at the end of an interval.
        converged: True if the last refinement ended at an optimum.
    """

    model: Model = field(compare=False)
    given: tuple[Recording, ...] = field(compare=False)
    theta: Array
    estimates: tuple[Estimate, ...]
    covariance: Array
    correlation: Array
    residuals: tuple[Residuals, ...]
    whitenings: tuple[Whitening, ...] = field(compare=False)
    misfit: Misfit
    confidence: float
    threshold: float
    converged: bool

    def __getitem__(self, name: str) -> Estimate:
        """The estimate of a parameter by its name."""
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        raise KeyError(name)

    def __repr__(self) -> str:
        """Return the counts of parameters and samples, and undetermined parameters, in a line."""
        count = counted(len(self.model.data), "sample")
        unknown = [e.name for e in self.estimates if e.explanation]
        rest = f", not identifiable: {', '.join(unknown)}" if unknown else ""
        line = f"Fit of {counted(len(self.estimates), 'parameter')} to {count}{rest}"
        return f"<{line[:150]}, {self.status.name}>"

    @property
    def status(self) -> Status:
        """`incomplete` where `warnings` says so."""
        return Status.incomplete if self.warnings else Status.ok

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Doubts about the fit, a line each."""
        found = []
        if not self.converged:
            found.append("the search did not converge; give narrower bounds, or fewer parameters")
        found += [
            f"{e.name} is {e.identifiability} identifiable: {e.explanation}"
            for e in self.estimates
            if e.explanation
        ]
        found += [line for left in self.residuals for line in self._structure(left)]
        if self.structured:
            found.append(self._cause())
        return tuple(found)

    @property
    def structured(self) -> bool:
        """True if the drive does what the model does not, so that the intervals do not hold."""
        return self.misfit.found or any(left.structured for left in self.residuals)

    def _structure(self, left: Residuals) -> list[str]:
        """Return where the residuals of a channel keep a structure, a line."""
        if not left.structured:
            return []
        name = self.model.recordings[left.recording].name
        if left.excessive:
            why = f"are {left.reduced**0.5:.3g} times the given noise"
        else:
            over = min(left.places, key=lambda each: left.places[each].p_value)
            place = left.places[over]
            why = f"keep a structure (neighbours correlate by {left.neighbours:.2f})"
            if place.p_value < UNLIKELY:
                unit, scale = PLACE_UNITS[over]
                ends = [significant(end * scale, 3) for end in (place.begin, place.end)]
                why = f"keep a structure over the {over}, most from {ends[0]} to {ends[1]} {unit}"
        noise = "no noise explains" if left.rejected else "the given noise does not explain"
        return [f"{name}: the residuals of the {left.channel} {why}, which {noise}"]

    def _cause(self) -> str:
        """Return what might explain a structure, and what it does to the parameters."""
        parts = ["the drive does what this model does not, and the intervals do not hold"]
        if any(left.structured and not left.rejected for left in self.residuals):
            parts = ["leave out the given noise to have it chosen, or else " + parts[0]]
        laws = [*self.misfit.explanations.items()]
        if laws:
            others = f", {laws[1][0]} by {laws[1][1]:.0f}" if len(laws) > 1 else ""
            words = f"{laws[0][0]} explains more: BIC lower by {laws[0][1]:.0f}{others}"
            parts.append(words)
        for name, (change, errors) in [*self.misfit.moved.items()][:2]:
            unit, scale = self[name].parameter.scale
            size = f"{significant(change * scale, 3)} {unit}".rstrip()
            parts.append(
                f"{name} moves by {size}, {errors:.0f} standard errors, from the first half to the "
                "second"
            )
        return "; ".join(parts)

    # ---- what was fitted -------------------------------------------------------------------------

    @property
    def recordings(self) -> tuple[Recording, ...]:
        """Fitted recordings."""
        return self.model.recordings

    @property
    def drive(self) -> Drive:
        """The drive with the fitted values; of the first recording where each has its own."""
        return self.drives[0]

    @cached_property
    def drives(self) -> tuple[Drive, ...]:
        """The drive of each recording with the fitted values."""
        each = range(len(self.recordings))
        return tuple(self.model.assembly.drive(self.theta, r) for r in each)

    @cached_property
    def releases(self) -> tuple[Release, ...]:
        """The release of each recording with the fitted values."""
        each = range(len(self.recordings))
        return tuple(self.model.assembly.release(self.theta, r) for r in each)

    @cached_property
    def motions(self) -> tuple[Motion, ...]:
        """The fitted motion of each recording, to its last sample."""
        ends = [
            float(recording.time[-1]) - float(self.model.offset(self.theta, r))
            for r, recording in enumerate(self.recordings)
        ]
        return tuple(
            simulated(drive, release, duration=max(end, recording.interval))
            for drive, release, end, recording in zip(
                self.drives, self.releases, ends, self.recordings, strict=True
            )
        )

    def residual(self, theta: ArrayLike | None = None) -> Array:
        """Return computed less recorded as independent residuals of variance one, shape (n,).

        The sum of squares is −2 times the log-likelihood, up to a constant, as `lmfit`, `emcee` and
        `scipy.optimize.least_squares` take it.

        Args:
            theta: Values of all parameters, SI, shape (k,), in the order of `names`; None: the
                fitted ones.
        """
        return self._problem.residuals(self._theta(theta)).copy()

    def jacobian(self, theta: ArrayLike | None = None) -> Array:
        """Return the exact derivatives of `residual`, shape (n, k)."""
        return self._problem.slopes(self._theta(theta)).copy()

    def rest_over(self, block: int) -> dict[str, tuple[Array, Array]]:
        """Return means of a channel's residuals in parts of the time, the speed and the position.

        Args:
            block: Place of the channel in `residuals`.

        Returns:
            For "time", "speed" and "position" of the pin, the edges of the parts, SI, shape
            (m + 1,), and recorded less computed in standard errors, shape (m,).
        """
        one = self.model.blocks[block]
        off = self.model.predict(self.theta)[one.place] - self.model.data[one.place]
        scores = -self.whitenings[block].scores(off)
        over = self.model.over(self.theta, one)
        return {name: binned(scores, values) for name, values in over.items()}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all values in `theta`."""
        return tuple(p.name for p in self.model.parameters)

    @cached_property
    def _problem(self) -> Problem:
        return Problem(self.model, self.whitenings)

    def _theta(self, given: ArrayLike | None) -> Array:
        theta = self.theta if given is None else np.asarray(given, float)
        if theta.shape != self.theta.shape:
            required = f"one value for each of {', '.join(self.names)}"
            raise ValueError(refusal("theta", required, f"shape {theta.shape}"))
        return theta

    def predicted(self, recording: int, channel: str) -> tuple[Array, Array]:
        """The fitted channel at the sample times, SI, and its standard error, shapes (n,)."""
        values, slopes = self.model.linearise(self.theta)
        place = next(
            b.place for b in self.model.blocks if (b.recording, b.channel) == (recording, channel)
        )
        known = np.isfinite(np.diag(self.covariance))
        part = slopes[place][:, known]
        spread = np.einsum("ni,ij,nj->n", part, self.covariance[np.ix_(known, known)], part)
        return values[place], np.sqrt(np.maximum(spread, 0.0))

    # ---- how good it is --------------------------------------------------------------------------

    @property
    def log_likelihood(self) -> float:
        """Log-likelihood of all samples, with normal noise."""
        total = 0.0
        for left in self.residuals:
            spare = 1.0 - len(self.theta) / len(self.model.data)
            total -= 0.5 * left.deviance
            # the noise of greatest likelihood
            if not left.known and not left.model.step and not left.model.outliers:
                total -= 0.5 * left.count * (log(spare) + 1.0 - spare)
        return total

    @property
    def aicc(self) -> float:
        """Akaike's information criterion, corrected for few samples (Hurvich and Tsai, 1989)."""
        n = len(self.model.data)
        k = len(self.theta) + sum(
            (not left.known) + left.model.correlated + left.model.outliers
            for left in self.residuals
        )
        return 2.0 * k - 2.0 * self.log_likelihood + 2.0 * k * (k + 1) / max(n - k - 1, 1)

    # ---- for other programs ----------------------------------------------------------------------

    def plot(self) -> mpl_figure.Figure:
        """Recordings and fit, residuals, and the profiles, as a figure."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """Return the whole result as data.

        Returns:
            Over `parameter`: `value`, `standard_error`, `lower`, `upper` in the SI units of the
            coordinate `unit`, and `identifiability`; `correlation` over two of them; over `block`,
            each a channel of a recording, `noise` and the p-values; and over `sample` what was
            `recorded` and `computed`, with `time` and `block`.
        """
        names = [e.name for e in self.estimates]
        values, _ = self.model.linearise(self.theta)
        numbers = {
            "value": [e.value for e in self.estimates],
            "standard_error": [e.standard_error for e in self.estimates],
            "lower": [e.interval[0] for e in self.estimates],
            "upper": [e.interval[1] for e in self.estimates],
        }
        data: dict[str, Any] = {
            name: ("parameter", np.array(column)) for name, column in numbers.items()
        }
        data["identifiability"] = ("parameter", [str(e.identifiability) for e in self.estimates])
        count = len(names)
        shown = self.correlation[:count, :count]
        data["correlation"] = (("parameter", "other"), shown, {"units": "1"})
        data["noise"] = ("block", [left.noise for left in self.residuals])
        data["ljung_box"] = ("block", [left.ljung_box for left in self.residuals], {"units": "1"})
        data["runs"] = ("block", [left.runs for left in self.residuals], {"units": "1"})
        data["recorded"] = ("sample", self.model.data)
        data["computed"] = ("sample", values)
        data["aicc"] = ((), self.aicc, {"units": "1", "long_name": "corrected Akaike criterion"})
        blocks = self.model.blocks
        times = np.concatenate([b.times for b in blocks])
        data["time"] = ("sample", times, {"units": "s"})
        which = np.concatenate([np.full(b.size, i) for i, b in enumerate(blocks)])
        data["block_of"] = ("sample", which)
        coords = {
            "parameter": names,
            "other": names,
            "unit": ("parameter", [e.parameter.unit for e in self.estimates]),
            "recording": ("block", [self.recordings[b.recording].name for b in blocks]),
            "channel": ("block", [b.channel for b in blocks]),
            "block_unit": ("block", [unit_of(b.channel) for b in blocks]),
        }
        attributes = {"status": self.status.name, "confidence": self.confidence}
        return xr.Dataset(data, coords=coords, attrs=attributes)

    def table(self) -> list[list[str]]:
        """A row for each estimate: name, value, error, interval, unit, whether it is told."""
        rows = []
        for e in self.estimates:
            unit, scale = e.parameter.scale
            ends = [
                "open" if not isfinite(end) else significant(end * scale, 5) for end in e.interval
            ]
            error = (
                "-" if not isfinite(e.standard_error) else significant(e.standard_error * scale, 2)
            )
            verdict = str(e.identifiability) + (f": {e.explanation}" if e.explanation else "")
            rows.append([e.name, significant(e.value * scale, 5), error, *ends, unit, verdict])
        return rows


@equal_by_value
@dataclass(frozen=True, eq=False, repr=False)
class ModelComparison(NotebookHtml):
    """Fits of several friction laws to equal recordings.

    Attributes:
        fits: Fits by the law: "Coulomb", "static friction", "friction curve", "compliant skin".
        refused: Reason for each law that this drive or release cannot have.
    """

    fits: Mapping[str, Fit]
    refused: Mapping[str, str]

    def __repr__(self) -> str:
        """The best law, and how far behind the next one is, in a line."""
        order = sorted(self.excess.items(), key=lambda item: item[1])
        rest = ", ".join(f"{name} +{value:.1f}" for name, value in order[1:])
        return f"<ModelComparison by AICc: {order[0][0]} is best; {rest}, {self.status.name}>"

    @property
    def best(self) -> str:
        """The law with the least AICc."""
        return min(self.fits, key=lambda name: self.fits[name].aicc)

    @property
    def excess(self) -> dict[str, float]:
        """The AICc of each law less that of the best; above 10 it has next to no support."""
        least = self.fits[self.best].aicc
        return {name: found.aicc - least for name, found in self.fits.items()}

    @property
    def weights(self) -> dict[str, float]:
        """Akaike weights: probability of each law to be the best among the compared laws."""
        parts = {name: exp(-0.5 * value) for name, value in self.excess.items()}
        total = sum(parts.values())
        return {name: part / total for name, part in parts.items()}

    @property
    def status(self) -> Status:
        """`incomplete` where a law could not be fitted."""
        complete = not self.refused and all(found.converged for found in self.fits.values())
        return Status.ok if complete else Status.incomplete

    def plot(self) -> mpl_figure.Figure:
        """The residuals of each law over time, as a figure."""
        return figure(self, "plot")

    def to_dataset(self) -> xr.Dataset:
        """AICc, its excess over the best, weights and the count of parameters over `law`."""
        data: dict[str, Any] = {
            "aicc": ("law", [found.aicc for found in self.fits.values()], {"units": "1"}),
            "excess": ("law", [*self.excess.values()], {"units": "1"}),
            "weight": ("law", [*self.weights.values()], {"units": "1"}),
            "parameters": ("law", [len(found.theta) for found in self.fits.values()]),
        }
        attributes = {"status": self.status.name, "best": self.best}
        return xr.Dataset(data, coords={"law": [*self.fits]}, attrs=attributes)

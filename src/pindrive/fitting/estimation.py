"""Estimation of the parameters of a drive from recordings, with their identifiability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.identifiability import Identifiability, rank, untouched
from pindrive.fitting.least_squares import Optimum, Problem
from pindrive.fitting.model import Model
from pindrive.fitting.parameters import parameters
from pindrive.fitting.profiles import BetterOptimum, ProfileLikelihood, profile
from pindrive.fitting.recording import Recording
from pindrive.fitting.residuals import first_noise, tested
from pindrive.fitting.results import Estimate, Fit
from pindrive.fitting.search import polished, search
from pindrive.lazy import stats
from pindrive.motion.drive import Drive
from pindrive.motion.release import Release, check_fits
from pindrive.quantities.refusal import check_whole, refusal
from pindrive.study.workers import Cluster, Here, crew

Array = NDArray[np.float64]

__all__ = ["fit"]

ROUNDS: Final = 12
"""Largest number of refinements, each with the noise estimated by the one before."""
RESTARTS: Final = 20
"""Largest number of restarts from a better optimum found by a profile."""
SWING: Final = 0.25
"""The least part of a period that a recording must last."""
LEAST_NOISE: Final = 1e-9
"""Part of a channel's extent below which rounding is its noise."""


def fit(
    recordings: Recording | Sequence[Recording],
    drive: Drive,
    release: Release | Sequence[Release],
    *,
    free: Sequence[str],
    bounds: Mapping[str, tuple[float | str, float | str]] | None = None,
    seed: int = 1,
    confidence: float = 0.95,
    profiles: bool = True,
    cluster: str | None = None,
) -> Fit:
    """Fit parameters of a drive and its releases to recordings.

    The sum of squares over the noise is minimised: `simulate_batch` compares thousands of
    candidates over the bounds, trust regions with exact derivatives refine the best of them, and
    profiles that meet a better fit start it again. The same seed gives the same result.

    Args:
        recordings: Measurements; each may have its own mouse velocity and plate load.
        drive: Drive with the known values and the start of the search.
        release: The initial state and the inputs, one for all recordings or one for each.
        free: Fitted parameters: of the drive `mass`, `stiffness`, `damping` or `damping_ratio`,
            `plate.kinetic`, `plate.static`, `finger.kinetic`, `finger.static`, `finger.stiffness`,
            `finger.damping`, rows such as `finger_curve[1].force`; of each release `displacement`,
            `velocity`, `skin_stretch`, `mouse_velocity`, `plate_load`, rows such as
            `plate_load[1].time`; of each recording `time_offset`, its time of the release, and
            `position_offset` or that of another channel. Keys of device files are names too. With
            several recordings, what each has of its own is named with its place, such as
            `displacement@0`.
        bounds: (least, largest) by name, SI or text with a unit. Default: a tenth to ten times the
            value of the drive; from 0 for damping and friction.
        seed: Seed of the candidates, from 0 on.
        confidence: Confidence of the intervals, between 0 and 1.
        profiles: True to compute profile likelihoods; otherwise intervals follow from the
            derivatives alone.
        cluster: The address of a Dask scheduler, whose workers compute the profiles, which take
            most of the time.

    Returns:
        Values with standard errors, intervals, correlations and identifiability; the noise; the
        fitted drive and releases.

    Raises:
        ValueError: A recording that is shorter than a quarter of a period, a name or bounds that
            `free` cannot have, a parameter that changes no sample.
    """
    given = [recordings] if isinstance(recordings, Recording) else [*recordings]
    releases = _releases(given, release)
    seed = check_whole(seed, "seed", least=0)
    if not 0.0 < confidence < 1.0:
        raise ValueError(refusal("confidence", "between 0 and 1", repr(confidence)))
    for each, recording in zip(releases, given, strict=True):
        check_fits(drive, each, float(recording.time[-1]))
    drive = drive.by_forces
    found = parameters(free, bounds or {}, drive, releases, given)
    _check_lengths(given, drive, [p.key for p in found])
    model = Model(found, drive, releases, given)
    if len(model.data) <= len(found):
        required = f"more samples than free parameters ({len(found)})"
        raise ValueError(refusal("recordings", required, len(model.data)))
    noise = np.array(
        [
            given[block.recording].noise.get(block.channel) or first_noise(model.data[block.place])
            for block in model.blocks
        ]
    )
    weights = _weights(model, noise)
    best, tried = search(model, weights, seed)
    _check_touched(model, weights, tried)
    solved = _Solved(model, noise, best, tried, confidence)
    solved.settle_noise()
    solved.polish(seed)
    if not profiles:
        return solved.result([None] * len(found))
    with crew(cluster) as workers:
        return solved.result(solved.profiled(seed, workers))


def _profiled(shared: tuple[Problem, Optimum, Array, float], i: int) -> ProfileLikelihood | Optimum:
    """The profile of one parameter, or the better optimum that it meets."""
    problem, best, covariance, threshold = shared
    try:
        return profile(problem, best, i, covariance, threshold)
    except BetterOptimum as better:
        return better.end


class _Solved:
    """A fit while its noise and its profiles are found."""

    def __init__(
        self, model: Model, noise: Array, best: Optimum, tried: Array, confidence: float
    ) -> None:
        self._model, self._noise, self._best, self._tried = model, noise, best, tried
        self._confidence = confidence
        self._known = [
            block.channel in model.recordings[block.recording].noise for block in model.blocks
        ]
        self._problem = Problem(model, _weights(model, noise))

    def settle_noise(self) -> None:
        """Refine with the noise that is left, until both agree."""
        for _ in range(ROUNDS):
            off = self._problem.residuals(self._best.theta) / self._problem.weights
            left = self._noise.copy()
            spare = 1.0 - len(self._best.theta) / len(off)
            for i, block in enumerate(self._model.blocks):
                if not self._known[i]:
                    size = float(np.sqrt(np.mean(off[block.place] ** 2) / spare))
                    left[i] = max(size, LEAST_NOISE * self._model.range[i])
            changed = np.abs(left / self._noise - 1.0).max()
            alike = np.ptp(left / self._noise) < 1e-3 * changed or len(left) == 1
            self._noise = left
            self._problem = Problem(self._model, _weights(self._model, left))
            again = self._problem.refined(self._best.theta)
            self._best = again
            if changed < 1e-3 or alike:
                break
        cost = self._problem.cost(self._best.theta)
        self._best = replace(self._best, cost=cost)

    @property
    def _threshold(self) -> float:
        """The excess of the cost at the end of an interval."""
        spare = len(self._model.data) - len(self._best.theta)
        if all(self._known):
            return float(stats.chi2.ppf(self._confidence, 1))
        return float(stats.f.ppf(self._confidence, 1, spare))

    def _rank(self) -> None:
        coarse = _coarse(self._model, self._problem.weights)
        self.rank = rank(self._problem, self._best.theta, self._tried, coarse)

    def polish(self, seed: int) -> None:
        """Look for a better optimum nearby, and say what the derivatives tell there."""
        self._rank()
        better = polished(self._problem, self._best, self.rank.covariance, seed)
        if better is not self._best:
            self._best = better
            self.settle_noise()
            self._rank()

    def profiled(self, seed: int, workers: Here | Cluster) -> list[ProfileLikelihood | None]:
        """The profile of each parameter; a better fit that one meets is taken instead."""
        for turn in range(RESTARTS):
            hidden = {i for group in self.rank.groups for i in group}
            shown = [i for i in range(len(self._best.theta)) if i not in hidden]
            shared = (self._problem, self._best, self.rank.covariance, self._threshold)
            traced: list[ProfileLikelihood | None] = [None] * len(self._best.theta)
            for i, found in zip(shown, workers.spread(_profiled, shared, shown), strict=True):
                if isinstance(found, Optimum):
                    break
                traced[i] = found
            else:
                return traced
            again = self._problem.refined(found.theta)
            self._best = again if again.cost <= found.cost else found
            self.settle_noise()
            self.polish(seed + turn + 1)
        self._best = replace(self._best, converged=False)
        return [None] * len(self._best.theta)

    def result(self, traced: Sequence[ProfileLikelihood | None]) -> Fit:
        """Return the whole result."""
        theta, model = self._best.theta, self._model
        covariance = self.rank.covariance
        errors = np.sqrt(np.diag(covariance))
        groups = {i: group for group in self.rank.groups for i in group}
        estimates = []
        for i, p in enumerate(model.parameters):
            half = np.sqrt(self._threshold) * errors[i]
            found = traced[i]
            interval = found.interval if found else (theta[i] - half, theta[i] + half)
            if i in groups:
                verdict = Identifiability.structurally_not
            elif np.isfinite(interval).all():
                verdict = Identifiability.identifiable
            else:
                verdict = Identifiability.practically_not
            others = [model.parameters[j].name for j in groups.get(i, ())]
            estimates.append(
                Estimate(
                    parameter=p,
                    value=float(theta[i]),
                    standard_error=float(errors[i]),
                    interval=(float(interval[0]), float(interval[1])),
                    identifiability=verdict,
                    hidden_with=tuple(others),
                    profile=found,
                )
            )
        with np.errstate(invalid="ignore", divide="ignore"):
            correlation = covariance / np.outer(errors, errors)
        off = -self._problem.residuals(theta) / self._problem.weights
        residuals = tuple(
            tested(off[b.place], b.recording, b.channel, float(s), known, len(theta))
            for b, s, known in zip(model.blocks, self._noise, self._known, strict=True)
        )
        return Fit(
            model=model,
            theta=theta,
            estimates=tuple(estimates),
            covariance=covariance,
            correlation=correlation,
            residuals=residuals,
            confidence=self._confidence,
            threshold=self._threshold,
            converged=self._best.converged,
        )


def _weights(model: Model, noise: Array) -> Array:
    return np.concatenate(
        [np.full(block.size, 1.0 / size) for block, size in zip(model.blocks, noise, strict=True)]
    )


def _coarse(model: Model, weights: Array) -> Problem:
    """Return the recordings reduced to some forty samples each."""
    strides = [max(1, len(recording.time) // 40) for recording in model.recordings]
    thin = Model(model.parameters, model.drive, model.releases, model.recordings, strides)
    found = [
        np.full(few.size, weights[block.place.start])
        for block, few in zip(model.blocks, thin.blocks, strict=True)
    ]
    return Problem(thin, np.concatenate(found))


def _releases(given: Sequence[Recording], release: Release | Sequence[Release]) -> list[Release]:
    """One for each recording, with the inputs that it has of its own."""
    if not given or not all(isinstance(each, Recording) for each in given):
        raise ValueError(refusal("recordings", "a Recording or several", repr(given)))
    listed = [release] * len(given) if isinstance(release, Release) else [*release]
    if len(listed) != len(given):
        raise ValueError(
            refusal("release", f"one, or {len(given)} for as many recordings", len(listed))
        )
    return [
        each.replace(
            mouse_velocity=each.mouse_velocity
            if recording.mouse_velocity is None
            else recording.mouse_velocity,
            plate_load=each.plate_load if recording.plate_load is None else recording.plate_load,
        )
        for recording, each in zip(given, listed, strict=True)
    ]


def _check_lengths(given: Sequence[Recording], drive: Drive, keys: Sequence[str]) -> None:
    """Refuse recordings that end before the pin could have moved."""
    for recording in given:
        if "time_offset" not in keys and recording.time[0] < 0.0:
            required = "at least 0 s, the release; free time_offset where that is not known"
            raise ValueError(refusal("time", required, f"{recording.time[0]:g} s", recording.name))
    least = SWING * 2.0 * np.pi / drive.natural_frequency
    longest = max(given, key=lambda recording: float(np.ptp(recording.time)))
    span = float(np.ptp(longest.time))
    if span < least:
        required = (
            f"at least {least:.3g} s long, a quarter of the drive's period; record longer, or "
            "correct mass and stiffness"
        )
        raise ValueError(refusal("a recording", required, f"{span:.3g} s", longest.name))


def _check_touched(model: Model, weights: Array, tried: Array) -> None:
    """Refuse parameters that change nothing."""
    if not len(tried):
        raise ValueError(refusal("bounds", "such that drives within them can be simulated", "none"))
    places = untouched(_coarse(model, weights), tried)
    if places:
        names = " and ".join(model.parameters[i].name for i in places)
        required = "parameters that the recordings depend on; leave out what changes no sample"
        raise ValueError(refusal("free", required, names))

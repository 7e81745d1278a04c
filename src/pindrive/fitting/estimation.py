"""Estimation of the parameters of a drive from recordings, with their identifiability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.identifiability import Identifiability, rank, untouched
from pindrive.fitting.least_squares import BETTER, Optimum, Problem
from pindrive.fitting.model import Block, Model, OwnChannel
from pindrive.fitting.noise import Noise
from pindrive.fitting.noise_choice import Linearised, chosen
from pindrive.fitting.parameters import of_noise, parameters
from pindrive.fitting.profiles import BetterOptimum, ProfileLikelihood, profile
from pindrive.fitting.recording import Recording
from pindrive.fitting.residuals import Residuals, first_noise, tested
from pindrive.fitting.results import Estimate, Fit
from pindrive.fitting.search import polished, search
from pindrive.fitting.structure import Misfit, misfit
from pindrive.fitting.whitening import Whitening, estimated
from pindrive.lazy import stats
from pindrive.motion.drive import Drive
from pindrive.motion.release import Release, check_fits
from pindrive.quantities.refusal import check_whole, refusal
from pindrive.quantities.results import CHANNELS
from pindrive.study.workers import Cluster, Here, crew

Array = NDArray[np.float64]

__all__ = ["fit"]

ROUNDS: Final = 12
"""Largest number of refinements, each with the noise estimated by the one before."""
RESTARTS: Final = 20
"""Largest number of restarts from a better optimum found by a profile."""
SWING: Final = 0.25
"""The least part of a period that a recording must last."""
SEARCHES: Final = 2
"""Number of searches, each with other candidates, while residuals keep a structure."""
CHOICES: Final = 4
"""Largest number of choices of the noise, each at the optimum with the one before."""
ALIKE: Final = 1e-3
"""Change of the noise, a part of it, with which a refinement is the last."""
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
    own: Mapping[str, OwnChannel] | None = None,
) -> Fit:
    """Fit parameters of a drive and its releases to recordings.

    The sum of squares over the noise is minimised: `simulate_batch` compares thousands of
    candidates over the bounds, trust regions with exact derivatives refine the best of them, and
    profiles that meet a better fit start it again. The same seed gives the same result.

    Noise is part of the model. A channel of a recording without a given `noise` gets the one with
    the least Bayesian information criterion: white noise, and where they help an offset or a drift,
    hum of the mains, a correlation of neighbours, outliers, and the steps of a converter.

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
            several recordings, the drive is shared, and a release is not: `plate.kinetic@each` is
            fitted for each recording, `displacement@all` for all together. Results name what each
            has of its own with its place, such as `displacement@0`.
        bounds: (least, largest) by name, SI or text with a unit. Default: a tenth to ten times the
            value of the drive; from 0 for damping and friction.
        seed: Seed of the candidates, from 0 on.
        confidence: Confidence of the intervals, between 0 and 1.
        profiles: True to compute profile likelihoods; otherwise intervals follow from the
            derivatives alone.
        cluster: The address of a Dask scheduler, whose workers compute the profiles, which take
            most of the time.
        own: Channels of your own by name: functions of the `Motion` and of the sample times since
            the release, s, shape (n,), negative before it; their derivatives are differences.

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
    own = own or {}
    for recording in given:
        for channel in recording.channels:
            if channel not in CHANNELS and channel not in own:
                raise ValueError(
                    refusal("own", f"a function for {channel}", "none", recording.name)
                )
    model = Model(found, drive, releases, given, own=own)
    if len(model.data) <= len(found):
        required = f"more samples than free parameters ({len(found)})"
        raise ValueError(refusal("recordings", required, len(model.data)))
    first = np.array([_first_noise(model, block) for block in model.blocks])
    weights = _weights(model, first)
    best, tried = search(model, weights, seed)
    _check_touched(model, weights, tried)
    solved = _Solved(model, first, best, tried, confidence)
    solved.settle_noise()
    solved.choose_noise()
    solved.polish(seed)
    for again in range(1, SEARCHES):
        if not solved.structured:
            break
        solved.search_again(seed + again)
    if not profiles:
        return solved.result([None] * len(solved.theta))
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
        self, model: Model, first: Array, best: Optimum, tried: Array, confidence: float
    ) -> None:
        self._model, self._best, self._tried = model, best, tried
        self._given = model.recordings
        self._confidence = confidence
        self._noise = [Whitening(float(size)) for size in first]
        self._problem = Problem(model, self._noise)
        self._rejected: list[dict[str, float]] = [{} for _ in model.blocks]

    @property
    def theta(self) -> Array:
        """Values of all parameters, SI, shape (k,)."""
        return self._best.theta

    def settle_noise(self) -> None:
        """Refine with the noise that is left, until both agree."""
        for turn in range(ROUNDS):
            before, self._noise = self._noise, self._left()
            changes = [_change(*pair) for pair in zip(before, self._noise, strict=True)]
            self._problem = Problem(self._model, self._noise)
            alone = len(changes) == 1 and self._noise[0].is_white
            if max(changes) < ALIKE or (alone and turn > 0):
                break  # the size alone moves no optimum
            self._best = self._problem.refined(self._best.theta)
        self._best = replace(self._best, cost=self._problem.cost(self._best.theta))

    def _left(self) -> list[Whitening]:
        """Return the noise of the residuals."""
        off, slopes = self._problem.linearised(self._best.theta)
        spare = 1.0 - len(self._best.theta) / len(off)
        found = []
        for i, block in enumerate(self._model.blocks):
            made = estimated(
                _noise_of(self._model, block),
                *(off[block.place], slopes[block.place], block.times),
                *(self._model.recordings[block.recording].interval, spare),
            )
            least = LEAST_NOISE * self._model.range[i]
            found.append(made if made.size > least else replace(made, size=least))
        return found

    def choose_noise(self) -> None:
        """Choose the noise of each channel that has none given, and refine with it."""
        free = [self._is_to_be_chosen(block) for block in self._model.blocks]
        if not any(free):
            return
        for _ in range(CHOICES):
            before = [_noise_of(self._model, block) for block in self._model.blocks]
            found = [self._chosen(i) if free[i] else noise for i, noise in enumerate(before)]
            if found == before:
                return
            self._take(found)
            self.settle_noise()

    def _chosen(self, i: int) -> Noise:
        """Return the noise that a channel has by the criterion."""
        block = self._model.blocks[i]
        start, data = self._asked(block), self._model.data[block.place]
        found, self._rejected[i] = chosen(self._linearised(i), start, data)
        return found

    def _is_to_be_chosen(self, block: Block) -> bool:
        """Return True of a channel without a given noise, or whose noise says so."""
        given = self._given[block.recording].noise.get(block.channel)
        return given is None or given.choose

    def _asked(self, block: Block) -> Noise:
        return self._given[block.recording].noise.get(block.channel, Noise())

    def _linearised(self, i: int) -> Linearised:
        """Return the residuals of a channel without what its noise adds."""
        model, block = self._model, self._model.blocks[i]
        asked = self._given[block.recording]
        off, slopes = self._problem.linearised(self._best.theta)
        own = [j for j, p in enumerate(model.parameters) if not p.of_noise]
        added = [j for j, p in enumerate(model.parameters) if p.of_noise]
        here = np.zeros(len(off), bool)
        here[block.place] = True
        apart = self._problem.residuals(self._best.theta)[~here]
        mine = [j for j in added if slopes[block.place, j].any()]
        return Linearised(
            # without what the noise has added so far
            off[block.place] - slopes[block.place][:, mine] @ self._best.theta[mine],
            slopes[block.place][:, own],
            block.times,
            (float(asked.time[0]), float(asked.time[-1])),
            asked.interval,
            apart,
            self._problem.slopes(self._best.theta)[~here][:, own],
        )

    def _residuals(self) -> tuple[Residuals, ...]:
        """Return the residuals of each channel, tested."""
        model, theta = self._model, self.theta
        off, _ = self._problem.linearised(theta)
        return tuple(
            tested(
                -off[b.place],
                -self._noise[i].scores(off[b.place]),
                self._noise[i],
                block=b,
                noise=_noise_of(model, b),
                rejected=self._rejected[i],
                over=model.over(theta, b),
                parameters=len(theta),
                added={
                    model.parameters[j].key.removeprefix(f"{b.channel}_"): float(theta[j])
                    for j in model.added(i)[0]
                },
            )
            for i, b in enumerate(model.blocks)
        )

    def _misfit(self) -> Misfit:
        """Look for laws that explain what the noise does not, and for parameters that move."""
        steps = (_noise_of(self._model, block).step for block in self._model.blocks)
        least = [
            replace(self._asked(b), step=s) for b, s in zip(self._model.blocks, steps, strict=True)
        ]
        channels = [self._linearised(i) for i in range(len(self._model.blocks))]
        return misfit(self._model, self.theta, self._problem, self._noise, channels, least)

    def _take(self, noises: Sequence[Noise]) -> None:
        """Take noises for the channels: with other parameters of the sensors."""
        before = self._model
        listed = [dict(recording.noise) for recording in before.recordings]
        for block, noise in zip(before.blocks, noises, strict=True):
            listed[block.recording][block.channel] = noise
        recordings = [
            recording.with_changes(noise=noise)
            for recording, noise in zip(before.recordings, listed, strict=True)
        ]
        free = [p for p in before.parameters if not p.of_noise]
        found = (*free, *of_noise(free, recordings))
        self._model = Model(found, before.drive, before.releases, recordings, own=before.own)
        known = {p.name: float(x) for p, x in zip(before.parameters, self.theta, strict=True)}
        theta = np.array([known.get(p.name, p.start) for p in found])
        columns = {p.name: i for i, p in enumerate(before.parameters)}
        self._tried = np.column_stack(
            [
                self._tried[:, columns[p.name]] if p.name in columns else np.zeros(len(self._tried))
                for p in found
            ]
        )
        self._problem = Problem(self._model, self._noise)
        self._best = Optimum(theta, self._problem.cost(theta), self._best.converged)

    @property
    def structured(self) -> bool:
        """True if residuals keep a structure, as at a false optimum."""
        return any(left.structured for left in self._residuals())

    def search_again(self, seed: int) -> None:
        """Search with other candidates, and take what fits better."""
        best, _ = search(self._model, _weights(self._model, [n.size for n in self._noise]), seed)
        end = self._problem.refined(best.theta)
        if end.cost < self._best.cost - BETTER:
            self._best = end
            self.settle_noise()
            self.choose_noise()
            self.polish(seed)

    @property
    def _threshold(self) -> float:
        """The excess of the cost at the end of an interval."""
        spare = len(self._model.data) - len(self._best.theta)
        if all(_noise_of(self._model, block).size is not None for block in self._model.blocks):
            return float(stats.chi2.ppf(self._confidence, 1))
        return float(stats.f.ppf(self._confidence, 1, spare))

    def _rank(self) -> None:
        coarse = _coarse(self._model, _weights(self._model, [n.size for n in self._noise]))
        self.rank = rank(self._problem, self._best.theta, self._tried, coarse)

    def polish(self, seed: int) -> None:
        """Look for a better optimum nearby, and say what the derivatives tell there."""
        self._rank()
        better = polished(self._problem, self._best, self.rank.covariance, seed)
        if better is not self._best:
            self._best = better
            self.settle_noise()
            self.choose_noise()
            self._rank()

    def profiled(self, seed: int, workers: Here | Cluster) -> list[ProfileLikelihood | None]:
        """The profile of each parameter; a better fit that one meets is taken instead."""
        for turn in range(RESTARTS):
            hidden = {i for group in self.rank.groups for i in group}
            shown = [
                i
                for i, p in enumerate(self._model.parameters)
                if i not in hidden and not p.of_noise
            ]
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
            self.choose_noise()
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
        for i, p in enumerate(p for p in model.parameters if not p.of_noise):
            half = np.sqrt(self._threshold) * errors[i]
            found = traced[i]
            interval = found.interval if found else (theta[i] - half, theta[i] + half)
            if np.isfinite(errors[i]):  # a jump of the cost may be nearer than the noise reaches
                interval = (
                    min(interval[0], theta[i] - errors[i]),
                    max(interval[1], theta[i] + errors[i]),
                )
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
        return Fit(
            whitenings=tuple(self._noise),
            misfit=self._misfit(),
            model=model,
            given=self._given,
            theta=theta,
            estimates=tuple(estimates),
            covariance=covariance,
            correlation=correlation,
            residuals=self._residuals(),
            confidence=self._confidence,
            threshold=self._threshold,
            converged=self._best.converged,
        )


def _noise_of(model: Model, block: Block) -> Noise:
    return model.recordings[block.recording].noise.get(block.channel, Noise())


def _first_noise(model: Model, block: Block) -> float:
    """Return the noise of a channel before it is fitted, SI."""
    noise = _noise_of(model, block)
    size = first_noise(model.data[block.place]) if noise.size is None else float(noise.size)
    return max(size, 0.3 * float(noise.step or 0.0))  # a rounded sample is off by its step / √12


def _change(before: Whitening, after: Whitening) -> float:
    """Return the change of a noise, a part of it."""
    changed = abs(after.size / before.size - 1.0) + abs(after.correlation - before.correlation)
    if before.weights is not None and after.weights is not None:
        return changed + float(np.abs(after.weights / before.weights - 1.0).mean())
    return changed + (0.0 if before.weights is after.weights else 1.0)


def _weights(model: Model, noise: Sequence[float] | Array) -> Array:
    return np.concatenate(
        [np.full(block.size, 1.0 / size) for block, size in zip(model.blocks, noise, strict=True)]
    )


def _coarse(model: Model, weights: Array) -> Problem:
    """Return the recordings reduced to some forty samples each."""
    strides = [max(1, len(recording.time) // 40) for recording in model.recordings]
    thin = Model(
        model.parameters, model.drive, model.releases, model.recordings, strides, model.own
    )
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

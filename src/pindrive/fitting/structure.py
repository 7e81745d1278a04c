"""Signs that a drive does more than its model, and laws that explain them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pindrive.fitting.least_squares import Problem
from pindrive.fitting.model import Model
from pindrive.fitting.noise import Noise
from pindrive.fitting.noise_choice import Linearised, Solved
from pindrive.fitting.parameters import parameters
from pindrive.fitting.whitening import UNLIKELY, Whitening
from pindrive.lazy import stats
from pindrive.motion.drive import Contact, Drive, Stribeck

Array = NDArray[np.float64]

STRONG: Final = 10.0
"""Gain of the criterion from which a law explains what noise does not (Kass and Raftery, 1995)."""
APART: Final = 4.0
"""Standard errors by which a parameter moves that is named."""
STRIBECK: Final = (0.05, 0.2, 0.6)
"""Stribeck velocities that are tried, parts of the largest sliding speed."""
ROWS: Final = (0.0, 0.25, 0.6, 1.0)
"""Rows of a friction curve, parts of the largest sliding speed."""
SKIN: Final = 30.0
"""Stiffness of skin that is tried, over that of the drive."""
PITCHES: Final = 48
"""Frequencies of an oscillation that are tried."""
DECAYS: Final = (1.0, 0.2, 0.05)
"""Times in which it decays, parts of the recording."""
SEEN: Final = 1e-7
"""A singular value so much smaller than the largest is zero."""


@dataclass(frozen=True, slots=True)
class Misfit:
    """What a drive does that its model does not.

    Attributes:
        explanations: Gain of the information criterion with other laws, by their words, the
            largest first; only what noise does not explain as well.
        halves: P-value of equal parameters in both halves of the recordings.
        moved: Change of parameters from the first half to the second, SI, and its standard errors,
            by name.
    """

    explanations: Mapping[str, float]
    halves: float
    moved: Mapping[str, tuple[float, float]]

    @property
    def found(self) -> bool:
        """True if a law explains what noise does not, or if parameters move."""
        return bool(self.explanations) or self.halves < UNLIKELY


def misfit(
    model: Model,
    theta: Array,
    problem: Problem,
    noise: Sequence[Whitening],
    channels: Sequence[Linearised],
    least: Sequence[Noise],
) -> Misfit:
    """Look for laws that explain what the noise does not, and for parameters that move.

    Args:
        model: Fitted model.
        theta: Values of its parameters, SI, shape (k,).
        problem: Problem of the fit, with its noise.
        noise: Noise of each channel.
        channels: Residuals of each channel.
        least: Noise of each channel that is known, with nothing chosen.
    """
    off, _ = problem.linearised(theta)
    tried, found = [*laws(model, theta)], dict[str, float]()
    for i, block in enumerate(model.blocks):
        others = [(n, b) for n, b in zip(noise, model.blocks, strict=True) if b != block]
        rows = [
            (
                words,
                columns[block.place],
                np.concatenate(
                    [np.empty((0, columns.shape[1]))]
                    + [n.slopes(off[b.place], columns[b.place]) for n, b in others]
                ),
                count,
            )
            for words, columns, count in tried
        ]
        recording = model.recordings[block.recording]
        times = block.times - float(model.offset(theta, block.recording))
        unseen = sum(b.size for _, b in others)  # one channel alone has the oscillation
        rows += [
            (words, columns, np.zeros((unseen, columns.shape[1])), count)
            for words, columns, count in oscillations(times, recording.interval)
        ]
        chosen = recording.noise.get(block.channel, Noise())
        gains = explained(channels[i], least[i], chosen, rows)
        found = {key: max(found.get(key, 0.0), gains.get(key, 0.0)) for key in found | gains}
    times = np.concatenate([block.times for block in model.blocks])
    names = [p.name for p in model.parameters if not p.of_noise]
    halves, changes = moved(problem.residuals(theta), problem.slopes(theta), times, names)
    return Misfit(dict(sorted(found.items(), key=lambda item: -item[1])), halves, changes)


def moved(
    off: Array, slopes: Array, times: Array, names: Sequence[str]
) -> tuple[float, dict[str, tuple[float, float]]]:
    """Return the p-value of equal parameters in both halves, and those that move (Chow, 1960).

    The halves determine the parameters alike: each has half of the leverage.

    Args:
        off: Independent residuals, computed less recorded, shape (n,).
        slopes: Derivatives of these, shape (n, k).
        times: Times within each recording, s, shape (n,).
        names: Names of the first parameters.
    """
    known = np.flatnonzero(slopes.any(axis=0))
    size = np.linalg.norm(slopes[:, known], axis=0)
    x = slopes[:, known] / size
    across, values, _ = np.linalg.svd(x, full_matrices=False)
    across = across[:, values > SEEN * values[0]]
    leverage = np.sum(across**2, axis=1)
    order = np.argsort(times, kind="stable")
    middle = int(np.searchsorted(np.cumsum(leverage[order]), 0.5 * leverage.sum()))
    later = np.zeros(len(off))
    later[order[middle:]] = 1.0
    both = np.hstack([x, later[:, None] * x])
    u, values, v = np.linalg.svd(both, full_matrices=False)
    seen = values > SEEN * values[0]
    joint = off - across @ (across.T @ off)
    apart = off - u[:, seen] @ (u[:, seen].T @ off)
    more = int(np.count_nonzero(seen)) - across.shape[1]
    spare = len(off) - int(np.count_nonzero(seen))
    if more < 1 or spare < 1 or not apart.any():
        return 1.0, {}
    variance = max(float(apart @ apart) / spare, 1.0)  # rounded samples have less
    ratio = (float(joint @ joint) - float(apart @ apart)) / more / variance
    theta = -(v[seen].T / values[seen]) @ (u[:, seen].T @ off)
    spread = np.sqrt(variance * np.sum((v[seen].T / values[seen]) ** 2, axis=1))
    found = {}
    for j, i in enumerate(known):
        change, error = theta[len(known) + j], spread[len(known) + j]
        if i < len(names) and error > 0.0 and abs(change) > APART * error:
            found[names[int(i)]] = (float(change / size[j]), float(abs(change) / error))
    order_of = sorted(found.items(), key=lambda item: -item[1][1])
    return float(stats.f.sf(ratio, more, spare)), dict(order_of)


def explained(
    at: Linearised, start: Noise, chosen: Noise, laws: Iterable[tuple[str, Array, Array, int]]
) -> dict[str, float]:
    """Return the gain of the criterion with other laws, where it is strong, the largest first.

    Args:
        at: Residuals of a channel.
        start: Noise with what is known of it, and nothing chosen.
        chosen: Noise that was chosen or given.
        laws: Words; derivatives by a law of the residuals of the channel, SI, shape (n, m), and of
            the independent ones of all others; and the number of parameters of the law.
    """
    frames = [at.solved(noise) for noise in {start, chosen}]
    best = at.solved(chosen).criterion
    parts = [_Frame(each) for each in frames]
    found: dict[str, float] = {}
    for name, columns, others, count in laws:
        price = count * log(len(at.off))
        gain = best + max(frame.gain(columns, others) for frame in parts) - price
        if gain > max(STRONG, found.get(name, 0.0)):
            found[name] = gain
    return dict(sorted(found.items(), key=lambda item: -item[1]))


class _Frame:
    """Residuals under a noise, without what the parameters explain."""

    def __init__(self, at: Solved) -> None:
        self._at = at
        x, self._size = at.slopes, len(at.off)
        lengths = np.linalg.norm(x, axis=0)
        known = lengths > 0.0
        across, values, _ = np.linalg.svd(x[:, known] / lengths[known], full_matrices=False)
        self._across = across[:, values > SEEN * values.max(initial=0.0)]
        self._rest = self._without(at.residuals)

    def _without(self, values: Array) -> Array:
        rest: Array = values - self._across @ (self._across.T @ values)
        return rest

    def gain(self, columns: Array, others: Array) -> float:
        """Return the gain of the likelihood with columns, less the criterion of the noise."""
        x = np.vstack([self._at.whitening.slopes(self._at.off, columns), others])
        x = self._without(x)
        across, values, _ = np.linalg.svd(x, full_matrices=False)
        across = across[:, values > SEEN * values.max(initial=0.0)]
        before = float(self._rest @ self._rest)
        after = before - float(np.sum((across.T @ self._rest) ** 2))
        if self._at.whitening.half:  # many rounded samples tell nothing of the size of the noise
            gained = before - after
        else:  # the size is estimated anew with each law
            gained = self._size * log(before / max(after, 1e-300)) if before else 0.0
        return gained - self._at.criterion


# ---- laws ----------------------------------------------------------------------------------------


def laws(model: Model, theta: Array) -> Iterator[tuple[str, Array, int]]:
    """Yield laws that a drive does not have: words, derivatives of all samples, parameters."""
    drive = model.assembly.drive(theta)
    releases = [model.assembly.release(theta, r) for r in range(len(model.releases))]
    fastest = _fastest(model, theta)
    for words, changed, free, count in _variants(drive, fastest):
        try:
            found = parameters(free, {}, changed, releases, model.recordings)
            other = Model(found, changed, releases, model.recordings, own=model.own)
            _, slopes = other.linearise(np.array([p.start for p in found]))
        except ValueError:  # a law that this drive or its inputs cannot have
            continue
        own = [i for i, p in enumerate(found) if not p.of_noise]
        columns = np.where(np.isfinite(slopes[:, own]), slopes[:, own], 0.0)
        if columns.any():
            yield words, columns, count


def _variants(drive: Drive, fastest: float) -> Iterator[tuple[str, Drive, list[str], int]]:
    for name in ("plate", "finger"):
        contact = getattr(drive, name)
        if contact.frictionless or contact.law or contact.curve or not contact.rigid:
            continue
        kinetic = contact.kinetic
        for part in STRIBECK:
            law = Stribeck(
                kinetic=kinetic, breakaway=1.001 * kinetic, stribeck_velocity=part * fastest
            )
            words = f"Stribeck's law at the {name}"
            yield words, _with(drive, name, law), [f"{name}.breakaway"], 2
        curve = Contact(curve=[(part * fastest, kinetic) for part in ROWS])
        free = [f"{name}_curve[{i}].force" for i in range(len(ROWS))]
        words = f"friction over speed at the {name}"
        if name == "finger":
            words += " (or damping that is not linear)"
        yield words, _with(drive, name, curve), free, len(ROWS) - 1
    finger = drive.finger
    if finger.rigid and not finger.frictionless and not finger.curve:
        stiffness = SKIN * drive.stiffness
        damping = 0.3 * stiffness / drive.natural_frequency
        skin = Contact(finger.kinetic, finger.static, stiffness=stiffness, damping=damping)
        free = ["finger.stiffness", "finger.damping"]
        yield "skin that stretches", replace(drive, finger=skin), free, 2


def _with(drive: Drive, name: str, contact: Contact) -> Drive:
    return replace(drive, plate=contact) if name == "plate" else replace(drive, finger=contact)


def oscillations(times: Array, interval: float) -> Iterator[tuple[str, Array, int]]:
    """Yield oscillations that decay from the release on, as of a mass of the mount."""
    span = float(times[-1])
    late = np.maximum(times, 0.0)
    for pitch in np.geomspace(2.0 / span, 0.2 / interval, PITCHES):
        angle = 2.0 * np.pi * pitch * late
        for decay in DECAYS:
            size = np.where(times >= 0.0, np.exp(-late / (decay * span)), 0.0)
            columns = np.column_stack([size * np.cos(angle), size * np.sin(angle)])
            words = f"an oscillation of {pitch:.0f} Hz (as of a mass of the mount)"
            yield words, columns, 4


def _fastest(model: Model, theta: Array) -> float:
    """The largest speed at which the pin slides, m/s."""
    fastest = 0.0
    for block in model.blocks:
        v = model.over(theta, block)["speed"]
        fastest = max(fastest, float(np.abs(v).max()))
    return fastest

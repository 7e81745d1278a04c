"""Noise of a recorded channel: what a sensor adds to the motion of the pin."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import pi
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pindrive.quantities.quantity import brief
from pindrive.quantities.refusal import refusal
from pindrive.quantities.units import to_si

Array = NDArray[np.float64]

__all__ = ["Noise"]

DRIFTS: Final = ("none", "offset", "linear", "quadratic")
"""Drifts, each with those before it."""
AVERAGES: Final = ("instant", "centred", "before", "after")
"""Part of the sample interval over which a sample is the mean, about its time."""
DRIFT_KEYS: Final = ("offset", "drift", "bend")
HUM_KEYS: Final = (("hum_cosine", "hum_sine"), ("hum2_cosine", "hum2_sine"))
"""Parameters of hum, and of its first harmonic."""
EXAMPLE: Final = "linear drift, hum 50 Hz, correlated, outliers, step 20 um"


@dataclass(frozen=True, slots=True)
class Noise:
    """Noise of one channel of a recording.

    Attributes:
        size: Standard deviation, SI or text with a unit; None: estimated.
        drift: "none", "offset", "linear" or "quadratic": a polynomial in time, whose coefficients
            are fitted.
        hum: Frequency of a sinusoid, Hz or text with a unit; its amplitude and phase are fitted.
            None: no hum.
        harmonics: 1, or 2 for hum of twice the frequency besides.
        correlated: True for noise that is a first-order autoregressive process, AR(1), whose
            correlation is estimated.
        outliers: True for noise of Student's t distribution, whose degrees of freedom are
            estimated.
        step: Distance of the values of a converter, SI or text with a unit: a sample tells the
            interval of half a step to either side. None: samples are not rounded.
        average: "instant", or "centred", "before" or "after": the mean over the sample interval
            about the time of a sample, before it, or after it. Acceleration and force are "centred"
            in any case but "before" and "after".
        choose: True to add what else the criterion of a fit finds in the noise, as for a channel
            without a given noise.

    Raises:
        ValueError: A value is out of range, or a step is combined with correlated noise or
            outliers.
    """

    size: float | str | None = None
    drift: str = "none"
    hum: float | str | None = None
    harmonics: int = 1
    correlated: bool = False
    outliers: bool = False
    step: float | str | None = None
    average: str = "instant"
    choose: bool = False

    def __post_init__(self) -> None:
        """Check what is given; sizes with a unit are read by `in_si`."""
        if self.drift not in DRIFTS:
            raise ValueError(refusal("drift", f"one of {', '.join(DRIFTS)}", repr(self.drift)))
        if self.average not in AVERAGES:
            required = f"one of {', '.join(AVERAGES)}"
            raise ValueError(refusal("average", required, repr(self.average)))
        if self.harmonics not in (1, 2):
            raise ValueError(refusal("harmonics", "1 or 2", repr(self.harmonics)))
        if self.step is not None and (self.correlated or self.outliers):
            required = "left out for correlated noise and for outliers"
            raise ValueError(refusal("step", required, repr(self.step)))

    def in_si(self, unit: str, where: str) -> Noise:
        """Return the noise with numbers in SI units.

        Args:
            unit: Unit of the channel.
            where: Name in messages.

        Raises:
            ValueError: A size is no positive number with a fitting unit.
        """
        return replace(
            self,
            size=_positive(self.size, unit, f"{where}: size"),
            step=_positive(self.step, unit, f"{where}: step"),
            hum=_positive(self.hum, "Hz", f"{where}: hum"),
        )

    @property
    def keys(self) -> tuple[str, ...]:
        """Parameters of what the sensor adds, without their channel."""
        hum = sum(HUM_KEYS[: self.harmonics], ()) if self.hum is not None else ()
        return (*DRIFT_KEYS[: DRIFTS.index(self.drift)], *hum)

    @property
    def count(self) -> int:
        """Number of parameters but for the size."""
        return len(self.keys) + self.correlated + self.outliers

    def __str__(self) -> str:
        """Parts of the noise in words."""
        parts = []
        if self.drift != "none":
            parts.append({"offset": "offset"}.get(self.drift, f"{self.drift} drift"))
        if self.hum is not None:
            also = " and its harmonic" if self.harmonics == 2 else ""
            of = self.hum if isinstance(self.hum, str) else f"{brief(self.hum)} Hz"
            parts.append(f"hum of {of}{also}")
        if self.correlated:
            parts.append("correlated")
        if self.outliers:
            parts.append("outliers")
        if self.step is not None:
            parts.append("steps")
        return ", ".join(parts) or "white"

    @classmethod
    def from_text(cls, text: str) -> Noise:
        """Return the noise that a text lists.

        Args:
            text: Parts apart by commas: a size with its unit; "white"; "offset", "drift" or
                "linear drift", "quadratic drift"; "hum 50 Hz", "harmonic"; "correlated";
                "outliers"; "step 20 um"; "average before"; "choose".

        Raises:
            ValueError: A part is none of these.
        """
        found: dict[str, Any] = {}
        for part in (piece.strip() for piece in text.split(",")):
            word, _, rest = part.partition(" ")
            match word:
                case "white":
                    continue
                case "choose":
                    found["choose"] = True
                case "offset":
                    found["drift"] = "offset"
                case "drift":
                    found["drift"] = "linear"
                case "linear" | "quadratic" if rest == "drift":
                    found["drift"] = word
                case "hum" | "step" if rest:
                    found[word] = rest
                case "harmonic":
                    found["harmonics"] = 2
                case "correlated" | "outliers":
                    found[word] = True
                case "average" if rest:
                    found["average"] = rest
                case _ if word[:1].isdigit() or word[:1] == ".":
                    found["size"] = part
                case _:
                    raise ValueError(refusal("noise", f"a size, or like '{EXAMPLE}'", repr(part)))
        return cls(**found)


def noise_of(given: float | str | Noise, unit: str, where: str) -> Noise:
    """Return the noise of a channel from a size, a text or a `Noise`, with numbers in SI units."""
    if isinstance(given, str):
        given = Noise.from_text(given)
    elif not isinstance(given, Noise):
        given = Noise(given)
    return given.in_si(unit, where)


def column(key: str, times: Array, span: tuple[float, float], frequency: float) -> Array:
    """Return the samples that a parameter of size 1 adds, shape (n,).

    Args:
        key: Parameter without its channel: "offset"; "drift", the change from the first time of a
            recording to the last; "bend", the middle less the ends; a part of hum.
        times: Sample times, s, shape (n,).
        span: First and last time of the recording, s.
        frequency: Frequency of the hum, Hz.
    """
    middle, half = 0.5 * (span[0] + span[1]), 0.5 * (span[1] - span[0])
    part = (times - middle) / half
    match key:
        case "offset":
            return np.ones_like(times)
        case "drift":
            return 0.5 * part
        case "bend":
            return 1.0 / 3.0 - part**2
    angle = 2.0 * pi * frequency * (2 if key.startswith("hum2") else 1) * times
    return np.cos(angle) if key.endswith("cosine") else np.sin(angle)


def _positive(given: float | str | None, unit: str, label: str) -> float | None:
    if given is None:
        return None
    try:
        size = to_si(given, unit, f"1 {unit}") if isinstance(given, str) else float(given)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{label} must be {error}, got {given!r}") from None
    if not 0.0 < size < np.inf:
        raise ValueError(refusal(label, "finite and greater than 0", given))
    return size

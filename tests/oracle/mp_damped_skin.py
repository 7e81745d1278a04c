"""The motion under damped skin in thirty digits, along the modes that the integrator found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from mpmath import expm, matrix, mp, mpf

from oracle.damped_skin import Array, Pin, Segment

DIGITS = 34


def refined(
    pin: Pin, start: Sequence[float], segments: Sequence[Segment], times: Array
) -> tuple[list[list[float]], list[float]]:
    """Position, velocity and stretch at times, and the times of the events.

    The inputs are linear. Each event is the zero of its guard, found by Newton's method.
    """
    with mp.workdps(DIGITS):
        exact = replace(
            pin,
            **{
                name: mpf(getattr(pin, name))
                for name in ("mass", "stiffness", "damping", "skin_stiffness", "skin_damping")
            },
            plate=(mpf(pin.plate[0]), mpf(pin.plate[1])),
            finger=(mpf(pin.finger[0]), mpf(pin.finger[1])),
            kind=object,
        )
        y: list[Any] = [mpf(number) for number in start]
        piece, since, t = -1, mpf(0), mpf(0)
        rows: list[list[float]] = []
        events: list[float] = []
        for j, mode, lasts, fired in segments:
            if j != piece:
                piece, since = j, mpf(pin.pieces[j].begin)
                t = since
            inputs = [mpf(1), t - since]
            a, guards, plate_velocity = exact.system(pin.pieces[j], mode)
            z = np.array([*y, *inputs], object)
            if mode[0] == 0:
                z[1] = plate_velocity @ z
            rates = matrix(a.tolist())

            def after(tau: Any, rates: Any = rates, z: Any = z) -> Any:
                return np.array(list(expm(rates * tau) * matrix(z.tolist())), object)

            end = mpf(lasts)
            if fired:
                guard = guards[fired[0]]
                for _ in range(4):
                    state = after(end)
                    end -= (guard @ state) / (guard @ (a @ state))
            elif j + 1 < len(pin.pieces):
                end = mpf(pin.pieces[j + 1].begin) - t
            while len(rows) < len(times) and times[len(rows)] <= t + end + mpf("1e-12"):
                rows.append([float(each) for each in after(mpf(times[len(rows)]) - t)[:3]])
            y, t = list(after(end)[:3]), t + end
            events += [float(t)] * bool(fired)
        return rows, events

"""Print how far the core is, at the worst, from the stored answers of the thirty-digit oracles.

cd tests && ../.venv/bin/python -m oracle.worst
"""

from __future__ import annotations

import warnings

import numpy as np

from core import test_oracle, test_series_motion
from core import test_oracle_piecewise as piecewise
from oracle.answers import Case, told_events
from pindrive import ImplausibleValueWarning

warnings.simplefilter("ignore", ImplausibleValueWarning)  # the cases are no devices


def constant() -> str:
    count, late, displaced = 0, [], []
    for case in test_oracle.CASES:
        motion, stored = test_oracle.release(case), case["events"]
        reported = told_events(motion)
        assert [event[1:3] for event in reported] == [tuple(event[1:3]) for event in stored]
        count += len(stored)
        late += [abs(ours[0] - true[0]) for ours, true in zip(reported, stored, strict=True)]
        off = np.abs(motion.position(np.array(case["times"])) - case["x"])
        displaced.append(float(off.max()) / test_oracle.scales(case)["x"])
    return (
        f"{len(test_oracle.CASES)} cases, {count} events, the same in the same order: times within "
        f"{max(late):.1e} s, positions within {max(displaced):.1e} of the release displacement"
    )


def changing(cases: list[Case], what: str) -> str:
    count, late, displaced = 0, [], []
    for case in cases:
        motion = piecewise.release(case)
        reported = piecewise.instants(told_events(motion))
        stored = piecewise.instants(case["events"])
        assert all(piecewise.alike(*pair) for pair in zip(reported, stored, strict=True))
        count += len(stored)
        late += [abs(ours[0][0] - true[0][0]) for ours, true in zip(reported, stored, strict=True)]
        off = np.abs(motion.position(np.array(case["times"])) - case["x"])
        displaced.append(float(off.max()) / piecewise.scales(case)["x"])
    return (
        f"{len(cases)} cases with {what}, {count} instants with events, the same: times within "
        f"{max(late):.1e} s, positions within {max(displaced):.1e} of the largest"
    )


if __name__ == "__main__":
    print(
        constant(),
        changing(piecewise.CASES, "inputs that change, friction curves and skin"),
        changing(test_series_motion.CASES, "a curve at the plate under a load that changes"),
        sep="\n",
    )

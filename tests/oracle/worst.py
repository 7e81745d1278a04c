"""Print how far the core is, at the worst, from the stored answers of the thirty-digit oracle.

cd tests && ../.venv/bin/python -m oracle.worst
"""

from __future__ import annotations

import numpy as np

from test_oracle import CASES, release, scales, told_events


def main() -> None:
    count, late, displaced = 0, [], []
    for case in CASES:
        motion, stored = release(case), case["events"]
        told = told_events(motion)
        assert [event[1:3] for event in told] == [tuple(event[1:3]) for event in stored]
        count += len(stored)
        late += [abs(ours[0] - true[0]) for ours, true in zip(told, stored, strict=True)]
        off = np.abs(motion.position(np.array(case["times"])) - case["x"])
        displaced.append(float(off.max()) / scales(case)[0])
    print(
        f"{len(CASES)} cases, {count} events, the same in the same order: times within "
        f"{max(late):.1e} s, positions within {max(displaced):.1e} of the release displacement"
    )


if __name__ == "__main__":
    main()

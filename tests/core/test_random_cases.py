"""Random motions without a closed form, in the event loop, beside forty digits."""

from __future__ import annotations

from collections import Counter

import pytest

from oracle import mp_oblique, random_cases

# Cheap ones of `python -m oracle.random_cases KIND 200 1`, with what happens at the contacts.
CASES: dict[tuple[str, int], dict[str, int]] = {
    ("skin", 5): {"finger slip": 4, "finger stick": 4, "plate slip": 2, "plate stick": 2,
                  "plate reverse": 1},
    ("skin", 12): {"finger slip": 3, "finger stick": 2, "plate reverse": 1},
    ("skin", 15): {"finger slip": 1, "finger stick": 1, "plate slip": 1, "plate stick": 1},
    ("skin", 20): {"finger slip": 5, "finger stick": 4, "plate slip": 1, "plate stick": 1,
                   "plate reverse": 1},
    ("load", 70): {"finger reverse": 1, "plate stick": 1, "plate slip": 1},
    # Its plate is never loaded: the core tells no event of it.
    ("load", 77): {"finger slip": 6, "finger stick": 6, "plate reverse": 4},
    ("skin_load", 2): {"finger slip": 3, "finger stick": 1, "plate slip": 1, "plate stick": 1,
                       "plate reverse": 1},
    ("skin_load", 5): {"finger slip": 4, "finger stick": 4, "plate slip": 3, "plate stick": 3},
    ("skin_load", 8): {"finger slip": 3, "finger stick": 3, "plate reverse": 2},
    ("skin_load", 15): {"finger slip": 1, "finger stick": 1, "plate slip": 1, "plate stick": 1},
    ("oblique", 3): {"finger slip": 1, "finger stick": 1},
    ("oblique", 7): {"finger reverse": 1},
    ("oblique", 8): {"finger reverse": 1, "finger stick": 1},
}  # fmt: skip
AT_ONCE = {20}  # skin that becomes shorter at once as it slides
CREEPS = {7}  # through w = 0


@pytest.mark.parametrize(("kind", "seed"), CASES)
def test_core_gives_the_oracle_answers(kind: str, seed: int) -> None:
    case, path = random_cases.KINDS[kind](seed)
    assert Counter(f"{e.contact} {e.kind}" for e in path.events) == CASES[kind, seed]
    assert random_cases.deviation(case, path) < random_cases.CLOSE
    if kind == "skin":
        kinds = [e.kind for e in path.events if e.contact == "finger"]
        assert (["slip", "slip"] in [kinds[i : i + 2] for i in range(len(kinds))]) == (
            seed in AT_ONCE
        )
    if isinstance(path, mp_oblique.Path):
        assert (path.met > 0) == (seed in CREEPS)

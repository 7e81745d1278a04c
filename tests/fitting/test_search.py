"""The search compares candidates at few samples and refines them at more."""

from __future__ import annotations

import pytest

from pindrive import fit
from pindrive.fitting import search
from pindrive.fitting.least_squares import Problem
from recordings import FREE, RELEASE, START, recorded


def test_candidates_are_refined_at_more_samples_than_they_are_compared_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A recording of 1500 samples: every sixth is used, then every one."""
    refined, compared = list[int](), list[int]()
    candidates = search._candidates

    class Counted(Problem):
        def __init__(self, model, *args, **kwargs) -> None:  # type: ignore[no-untyped-def]
            refined.append(model.data.size)
            super().__init__(model, *args, **kwargs)

    def counted(model, *args):  # type: ignore[no-untyped-def]
        compared.append(model.data.size)
        return candidates(model, *args)

    monkeypatch.setattr(search, "Problem", Counted)
    monkeypatch.setattr(search, "_candidates", counted)
    fit(recorded(rate=10e3), START, RELEASE, free=FREE, profiles=False)
    assert refined == [250, 250, 1500]
    assert compared == [41, 41]

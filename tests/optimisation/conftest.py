"""Designs that several tests look at, each computed once."""

from __future__ import annotations

import pytest

import pindrive as pd
from design_problems import EXAMPLES, MOUSE, PAPER, SMALL
from pindrive.optimisation import Design


@pytest.fixture(scope="session")
def paper() -> Design:
    return pd.optimise(pd.load_device(MOUSE), PAPER, effort=SMALL)


@pytest.fixture(scope="session")
def bought() -> Design:
    return pd.optimise(None, EXAMPLES / "catalogue-problem.toml", effort=SMALL)

"""The report on the paper, made once for all of its tests."""

from __future__ import annotations

import pytest

from pindrive.paper import report
from pindrive.paper.report import Report


@pytest.fixture(scope="session")
def steps() -> list[str]:
    return []


@pytest.fixture(scope="session")
def made(steps: list[str]) -> Report:
    return report.make(steps.append)


@pytest.fixture(scope="session")
def files(made: Report, steps: list[str]) -> dict[str, bytes]:
    """Return the files of `pindrive paper -o`."""
    return made.files(steps.append)


@pytest.fixture(scope="session")
def page(files: dict[str, bytes]) -> str:
    return files[report.PAGE].decode()

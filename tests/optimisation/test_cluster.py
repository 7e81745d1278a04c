"""Designs and fits on a Dask cluster equal the local ones."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pindrive as pd
from design_problems import EXAMPLES, MOUSE, PAPER, SMALL
from pindrive.optimisation import Design, read_problem
from pindrive.optimisation.goals import SpeedRequest
from pindrive.optimisation.line_speed import speeds
from pindrive.study.workers import crew
from recordings import recorded

distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Return the address of workers that are threads of this process."""
    with distributed.LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=False,
        protocol="tcp://",
        dashboard_address=":0",
        silence_logs=50,
    ) as cluster:
        yield cluster.scheduler_address


def test_a_design_found_on_a_cluster_is_that_found_here(address: str, paper: Design) -> None:
    found = pd.optimise(pd.load_device(MOUSE), PAPER, effort=SMALL, cluster=address)
    assert found.values == paper.values
    assert found.goals == paper.goals and found.constraints == paper.constraints
    assert found.built == paper.built


def test_a_fit_with_profiles_from_a_cluster_is_that_found_here(address: str) -> None:
    drive = pd.load_device(MOUSE).drive
    release = pd.Release(0.1, 2e-3)
    given = recorded(drive, release, rate=2e3, span=0.1)
    free = ["stiffness", "damping"]
    here = pd.fit(given, drive, release, free=free)
    there = pd.fit(given, drive, release, free=free, cluster=address)
    assert [e.interval for e in there.estimates] == [e.interval for e in here.estimates]
    assert there.theta.tolist() == here.theta.tolist()


def test_whole_devices_go_to_workers_and_come_back_in_order(address: str) -> None:
    plan = read_problem(
        EXAMPLES / "tactile-reader-problem.toml", ["control.sample_rate=250 Hz"]
    ).study
    requested = [SpeedRequest({"drive.stiffness": k}, 0.2, 1.0) for k in (150.0, 600.0)]
    with crew(address) as workers:
        found = [*workers.spread(speeds, plan, [requested[:1], requested[1:]])]
    assert found == [speeds(plan, requested[:1]), speeds(plan, requested[1:])]
    assert found[0] != found[1]


def test_threads_and_a_cluster_are_refused_together() -> None:
    with pytest.raises(ValueError, match="give threads or cluster, not both"):
        pd.optimise(pd.load_device(MOUSE), PAPER, threads=1, cluster="tcp://127.0.0.1:9")

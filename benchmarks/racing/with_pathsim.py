"""PathSim: one ODE block whose modes are switched by zero-crossing events.

The way of PathSim's own stick-slip example (sliding and sticking, switched by `ZeroCrossing`) with
both contacts, and with one block instead of nine, which is faster. The solver of that example is
RKBS32; others of its adaptive ones are tried. The tolerance of the events follows the solver's.
It has no positions between its steps: a `Scope` with a period makes steps end at the times asked,
which is a third of its time here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks.racing.modes import MOST_SLIDES, Contacts, Pin
from benchmarks.racing.race import TIMES, FailureError, Racer, Watch, one_by_one
from benchmarks.racing.releases import DURATION, Floats

TOLERANCES = (1e-3, 1e-5, 1e-7, 1e-9)


def racers(everything: bool) -> Iterator[Racer]:
    """The best solver, or all that were tried."""
    solvers = ["RKCK54"]
    if everything:
        solvers += ["RKBS32", "RKDP54", "RKV65", "RKDP87", "ESDIRK43"]
    for name in solvers:
        for rtol in TOLERANCES:
            lap = one_by_one(simulation(name, rtol))
            yield Racer("PathSim", f"events, {name}", f"rtol {rtol:g}", lap)


def simulation(solver: str, rtol: float) -> Callable[[Floats], Floats]:
    """Positions of one drive."""

    def solve(drive: Floats) -> Floats:
        from pathsim import Connection, Simulation, solvers
        from pathsim.blocks import ODE, Scope
        from pathsim.events import ZeroCrossing

        pin, watch = Pin.of(drive), Watch()
        contacts, m = Contacts(pin), pin.mass
        stuck, friction = contacts.stuck, contacts.friction

        def rate(y: Floats, _u: Floats, _t: float) -> Floats:
            watch.tick()
            x, v = y.tolist()
            if stuck is not None:
                return np.array([v, 0.0])
            return np.array([v, (friction - pin.damping * v - pin.stiffness * x) / m])

        block = ODE(rate, np.array([pin.displacement, pin.levels[0]]))
        events: list[Any] = []

        def switch() -> None:
            nonlocal stuck, friction
            stuck, friction = contacts.stuck, contacts.friction
            slides = stuck is None
            for event, watched in zip(events, (slides, slides, stuck == 0), strict=True):
                (event.on if watched else event.off)()
            if sum(len(event) for event in events) > MOST_SLIDES:
                raise FailureError("chattering")

        def reaching(at: int) -> ZeroCrossing:
            level = pin.levels[at]

            def gap(_t: float) -> float:
                return float(block.engine.state[1]) - level

            def arrive(_t: float) -> None:
                x = float(block.engine.state[0])
                block.engine.set(np.array([x, level]))
                contacts.settle(at, x)
                switch()

            return ZeroCrossing(gap, arrive, tolerance=rtol * pin.levels[0])

        def reserve(_t: float) -> float:
            return pin.static[0] - abs(contacts.need(0, float(block.engine.state[0])))

        def break_loose(_t: float) -> None:
            contacts.let_go(0)
            switch()

        loose = ZeroCrossing(reserve, break_loose, tolerance=rtol * pin.static[0])
        events = [reaching(0), reaching(1), loose]
        switch()
        scope = Scope(sampling_period=float(TIMES[1]))
        longest = pin.longest_step(12)
        simulation = Simulation(
            [block, scope],
            [Connection(block[0], scope)],
            events,
            dt=0.1 * longest,
            dt_max=longest,
            log=False,
            Solver=getattr(solvers, solver),
            tolerance_lte_rel=rtol,
            tolerance_lte_abs=rtol * pin.displacement,
        )
        simulation.run(DURATION + 0.5 * float(TIMES[1]))  # the last sample for certain
        positions = np.asarray(scope.read()[1]).ravel()
        if len(positions) < len(TIMES):
            raise FailureError("did not finish")
        return positions[: len(TIMES)]

    return solve

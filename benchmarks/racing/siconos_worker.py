"""Follows drives with Siconos, in a Python that has it: `python siconos_worker.py IN OUT`.

IN is an .npz file with `drives` (one column a drive), `step`, `every` and `count` (positions are
wanted after every so many steps), `way` and `solver`; OUT gets `positions` and the `seconds` of
processor time. Knows numpy and siconos alone: Debian's Siconos belongs to Debian's Python.
"""

from __future__ import annotations

import sys
from time import process_time
from typing import Any

import numpy as np
import siconos.kernel as sk
import siconos.numerics as sn

HEAVY = 1e9  # kg


def first_order(
    m: float, k: float, b: float, plate: float, finger: float, level: float, x: float, _step: float
) -> Any:
    """X' = A X + B lambda, a relay on each contact's velocity: Siconos' friction oscillator."""
    system = sk.FirstOrderLinearTIDS([x, level], [[0.0, 1.0], [-k / m, -b / m]])
    forces = [[0.0, 0.0], [plate / m, finger / m]]
    relation = sk.FirstOrderLinearTIR([[0.0, 1.0], [0.0, 1.0]], forces)
    relation.setePtr([-level, 0.0])
    law = sk.RelayNSL(2, -1.0, 1.0)
    return system, relation, law, sk.EulerMoreauOSI(0.5), lambda: system.x()[0]


def lagrangian(
    m: float, k: float, b: float, plate: float, finger: float, level: float, x: float, step: float
) -> Any:
    """M q'' + C q' + K q = H' lambda by Moreau-Jean, lambda an impulse.

    The plate is too heavy to be slowed. The relation has a gap below 0: without, the relays are
    taken for open contacts.
    """
    system = sk.LagrangianLinearTIDS([x, 0.0], [level, level], np.diag([m, HEAVY]))
    system.setKPtr(np.diag([k, 0.0]))
    system.setCPtr(np.diag([b, 0.0]))
    relation = sk.LagrangianLinearTIR([[plate, -plate], [finger, 0.0]], [-1.0, -1.0])
    law = sk.RelayNSL(2, -step, step)
    return system, relation, law, sk.MoreauJeanOSI(0.5), lambda: system.q()[0]


def follow(drive: list[float], step: float, every: int, count: int, way: Any, solver: int) -> Any:
    """Positions of one drive, at its release and at even steps."""
    system, relation, law, integrator, position = way(*drive, step)
    nsds = sk.NonSmoothDynamicalSystem(0.0, step * every * count)
    nsds.insertDynamicalSystem(system)
    interaction = sk.Interaction(law, relation)
    nsds.link(interaction, system)
    grid = sk.TimeDiscretisation(0.0, step)
    simulation = sk.TimeStepping(nsds, grid, integrator, sk.Relay(solver))
    positions = np.empty(count)
    positions[0] = position()
    for n in range(1, count):
        for _ in range(every):
            simulation.computeOneStep()
            simulation.nextStep()
        positions[n] = position()
    return positions


def main() -> None:
    """The drives of IN to the positions of OUT."""
    given = np.load(sys.argv[1])
    way = {"first order": first_order, "lagrangian": lagrangian}[str(given["way"])]
    solver = getattr(sn, f"SICONOS_RELAY_{given['solver']}")
    rest = (float(given["step"]), int(given["every"]), int(given["count"]), way, solver)
    begin = process_time()
    positions = [follow(drive.tolist(), *rest) for drive in given["drives"].T]
    np.savez(sys.argv[2], positions=positions, seconds=process_time() - begin)


if __name__ == "__main__":
    main()

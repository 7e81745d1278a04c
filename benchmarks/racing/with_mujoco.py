"""MuJoCo: `frictionloss` of a joint and of a tendon, at several time steps.

Two slides in a row of bodies without gravity or collisions. The plate is too heavy to be slowed and
moves at the mouse's velocity. Either the pin slides in the housing (its joint has the finger's
friction, a fixed tendon to the plate the plate's), or on the plate (its joint has the plate's, a
tendon over both joints the spring, the damper and the finger's).

MuJoCo's friction is soft: a stuck contact creeps, by its impedance (`solimpfriction`, 0.9 unless
given) and by the time in which it stops what slides (`solreffriction`, 0.02 s unless given). The
documentation advises an impedance near 1 and a time of twice the step for hard constraints, and the
integrator `implicitfast`. With both the error falls with the step; with MuJoCo's own values it does
not, for then the creep is the model's.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from benchmarks.racing.race import TIMES, FailureError, Racer, one_by_one
from benchmarks.racing.releases import Floats

STEPS = (2e-3, 1e-3, 2e-4, 5e-5, 1e-5)  # s
HARD = 0.9999  # impedance, the largest that MuJoCo takes
HEAVY = 1e9  # kg

IN_HOUSING = """
<mujoco>
  <option gravity="0 0 0" tolerance="0">
    <flag contact="disable" limit="disable" equality="disable" actuation="disable"
      sensor="disable" gravity="disable"/></option>
  <worldbody>
    <body><joint name="pin" type="slide" axis="1 0 0" stiffness="1" damping="1" frictionloss="1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
    <body><joint name="plate" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
  </worldbody>
  <tendon><fixed frictionloss="1">
    <joint joint="pin" coef="1"/><joint joint="plate" coef="-1"/></fixed></tendon>
</mujoco>
"""
ON_PLATE = """
<mujoco>
  <option gravity="0 0 0" tolerance="0">
    <flag contact="disable" limit="disable" equality="disable" actuation="disable"
      sensor="disable" gravity="disable"/></option>
  <worldbody>
    <body><joint name="plate" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
      <body><joint name="pin" type="slide" axis="1 0 0" frictionloss="1"/>
        <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></body>
  </worldbody>
  <tendon><fixed stiffness="1" damping="1" frictionloss="1" springlength="0">
    <joint joint="pin" coef="1"/><joint joint="plate" coef="1"/></fixed></tendon>
</mujoco>
"""


def racers(everything: bool) -> Iterator[Racer]:
    """Hard friction with the recommended integrator and MuJoCo's own values, or all tried."""
    hard = Way()
    paths = {"hard friction": hard, "soft, as it comes": Way(hard=False, integrator="EULER")}
    if everything:
        paths |= {
            "hard, pin on the plate": replace(hard, on_plate=True),
            "hard, Euler": replace(hard, integrator="EULER"),
            "hard, RK4": replace(hard, integrator="RK4"),
            "hard, PGS": replace(hard, solver="PGS"),
            "hard, CG": replace(hard, solver="CG"),
            "hard, tolerance 1e-8": replace(hard, tolerance=1e-8),
            "hard, no slip": replace(hard, noslip=10),
        }
    for name, way in paths.items():
        for step in STEPS if way.hard else STEPS[:3]:
            yield Racer("MuJoCo", name, f"step {step:g} s", one_by_one(Stepping(way, step)))


@dataclass(frozen=True)
class Way:
    """A way of using MuJoCo.

    The solver's tolerance is relative to the mean inertia, which is set to the pin's (the plate
    would make it huge). Even so the default, 1e-8, keeps the solver from its first iteration: it
    takes forces of millinewtons for nothing. So the tolerance is 0.
    """

    on_plate: bool = False
    hard: bool = True
    integrator: str = "IMPLICITFAST"
    solver: str = "NEWTON"
    tolerance: float = 0.0
    noslip: int = 0


class Stepping:
    """Positions of one drive, whose numbers are written into a model compiled once."""

    def __init__(self, way: Way, step: float) -> None:
        self.way, self.step = way, step

    @cached_property
    def model(self) -> Any:
        """The compiled model."""
        import mujoco

        way = self.way
        model = mujoco.MjModel.from_xml_string(ON_PLATE if way.on_plate else IN_HOUSING)
        model.opt.timestep = self.step
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{way.integrator}")
        model.opt.solver = getattr(mujoco.mjtSolver, f"mjSOL_{way.solver}")
        model.opt.tolerance, model.opt.noslip_iterations = way.tolerance, way.noslip
        if way.hard:
            for solref in (model.dof_solref, model.tendon_solref_fri):
                solref[:, 0] = 2.0 * self.step
            for solimp in (model.dof_solimp, model.tendon_solimp_fri):
                solimp[:, :2] = HARD
        return model

    @cached_property
    def data(self) -> Any:
        """The state of the model."""
        import mujoco

        return mujoco.MjData(self.model)

    def __call__(self, drive: Floats) -> Floats:
        import mujoco

        m, k, b, plate, finger, level, x = drive.tolist()
        model, data, on_plate = self.model, self.data, self.way.on_plate
        pin, moving = (1, 0) if on_plate else (0, 1)  # joints; their bodies are numbered from 1
        model.body_mass[1 + pin], model.body_mass[1 + moving] = m, HEAVY
        if on_plate:
            model.tendon_stiffness[0], model.tendon_damping[0] = k, b
            model.tendon_frictionloss[0], model.dof_frictionloss[pin] = finger, plate
        else:
            model.jnt_stiffness[pin], model.dof_damping[pin] = k, b
            model.tendon_frictionloss[0], model.dof_frictionloss[pin] = plate, finger
        mujoco.mj_resetData(model, data)
        mujoco.mj_setConst(model, data)
        model.stat.meaninertia = m
        data.qpos[pin], data.qpos[moving] = x, 0.0
        data.qvel[pin], data.qvel[moving] = 0.0 if on_plate else level, level
        every = round(TIMES[1] / self.step)
        positions = np.empty(len(TIMES))
        positions[0] = x
        for n in range(1, len(TIMES)):
            mujoco.mj_step(model, data, every)
            positions[n] = data.qpos.sum() if on_plate else data.qpos[pin]
        if data.warning.number.any():
            raise FailureError("unstable")
        return positions

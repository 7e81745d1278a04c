"""Draw random modes without a closed form and answer them with forty digits: COUNT SEED OUT.

    cd tests && python -m oracle.make_series 200 14 oracle/series_cases.txt

COUNT of each of three kinds: a friction curve under a changing load, a friction curve on a
compliant finger, an oblique hand; and a quarter as many of a hand that is oblique by little, where
the pin creeps, which take the oracle some thousand steps each. A draw whose answer is
ill-conditioned is discarded. One case a line: the numbers of `Case` in order, the number of the
guard that ends it, and time, position, velocity and force of the skin there, with twenty digits.
"""

from __future__ import annotations

import math
import multiprocessing
import random
import sys
from dataclasses import astuple
from pathlib import Path

from mpmath import nstr

from oracle.mp_modes import Answer, Case, DoubtError, solve

NEVER = 1e300  # where a branch ends that has no end
KINDS = ("curve under a changing load", "curve on a compliant finger", "oblique hand", "creep")
CREEP = 3


def short(value: float) -> float:
    return float(f"{value:.4g}")


def branch(rng: random.Random, size: float, speed: float) -> tuple[float, float, float, float]:
    """A branch (force, from, to, slope) that holds a speed."""
    start = rng.choice([0.0, short(speed * rng.uniform(0.1, 0.9))])
    end = rng.choice([NEVER, *(short(speed * rng.uniform(1.03, 1.6)) for _ in range(3))])
    force = short(size * rng.uniform(0.3, 1.5))
    steepest = force / ((end if end < NEVER else 4 * speed) - start)
    return force, start, end, short(steepest * rng.uniform(-0.9, 2.0))


def flat(size: float) -> tuple[float, float, float, float]:
    return short(size), 0.0, NEVER, 0.0


def draw(kind: int, rng: random.Random) -> Case:
    mass = short(10 ** rng.uniform(-3, -1.5))
    omega = 10 ** rng.uniform(1.5, 2.7)
    stiffness = short(mass * omega**2)
    damping = short(2 * mass * omega * rng.choice([0.0, 10 ** rng.uniform(-3, 0)]))
    speed = 10 ** rng.uniform(-2, -0.5)
    size = stiffness * speed / omega * 10 ** rng.uniform(-1, 0.7)
    duration = short(rng.uniform(0.2, 2.0) * 2 * math.pi / omega)
    plate_velocity = (short(speed), short(rng.choice([0.0, speed / duration * rng.uniform(-1, 1)])))
    load, across = (1.0, 0.0), (0.0, 0.0)
    plate, plate_branch, plate_static = 2, flat(0.0), 0.0
    finger, finger_stiffness, finger_branch, finger_static = 2, 0.0, flat(0.0), 0.0
    x = short(rng.uniform(-2, 2) * speed / omega)
    v = short(rng.uniform(-2, 2) * speed)
    skin = 0.0
    if kind != 1:
        load = (short(rng.uniform(0.3, 2)), short(rng.uniform(-0.3, 2) / duration))
        if rng.random() < 0.6:
            finger = rng.choice([-1, 1, 3])
            finger_static = short(size * rng.uniform(0.1, 1.0))
            if finger == 3:
                finger_stiffness = short(stiffness * 10 ** rng.uniform(-0.5, 1.5))
                skin = short(finger_static * rng.uniform(-0.9, 0.9))
            else:
                finger_branch = flat(finger_static * rng.uniform(0.5, 1.0))
                v = short(finger * abs(v))
    if kind == 0:
        held = finger in {-1, 1} and rng.random() < 0.3
        if held:
            finger, v, finger_static = 0, 0.0, short(size * rng.uniform(1.0, 3.0))
            finger_branch = flat(finger_static)
        u = v - plate_velocity[0]
        plate = 1 if u > 0 else -1
        plate_branch = branch(rng, size, abs(u))
        if rng.random() < 0.3 and not held:  # it begins at an end of its branch
            end = plate_branch[1] if plate_branch[2] == NEVER else plate_branch[2]
            v = plate_velocity[0] + plate * end
    elif kind == 1:
        finger = rng.choice([-1, 1])
        slides = short(speed * rng.uniform(0.1, 2.0))
        finger_branch = branch(rng, size, slides)
        finger_stiffness = short(abs(finger_branch[3]) * omega * 10 ** rng.uniform(-0.3, 1.3))
        finger_static = short(2 * finger_branch[0])
        skin = finger * slides
        state = rng.random()
        if state < 0.3:
            plate, plate_static, v = 0, short(size * rng.uniform(1.0, 4.0)), plate_velocity[0]
            load = (1.0, short(rng.uniform(-0.5, 0.5) / duration))
        elif state < 0.7:
            plate = 1 if v > plate_velocity[0] else -1
            plate_branch = flat(size * rng.uniform(0.1, 1.0))
            load = (1.0, short(rng.uniform(-0.5, 0.5) / duration))
    else:
        angle = math.radians(rng.choice([rng.uniform(3, 20), rng.uniform(20, 80)]))
        w = short(speed * math.tan(angle) * rng.choice([-1, 1]))
        across = (w, short(rng.choice([0.0, w / duration * rng.uniform(-0.6, 2)])))
        plate = 5
        total = math.hypot(v - plate_velocity[0], w)
        plate_branch = branch(rng, size, total) if rng.random() < 0.5 else flat(size)
    if kind == CREEP:
        angle = math.radians(10 ** rng.uniform(-0.5, 0.6))
        w = short(speed * math.tan(angle) * rng.choice([-1, 1]))
        across = (w, short(rng.choice([0.0, w / duration * rng.uniform(-0.8, 2)])))
        x = short(x * rng.uniform(0, 0.5))
        force = stiffness * (abs(x) + speed * duration) * rng.uniform(0.4, 2)
        plate_branch = flat(force / load[0])
        if finger in {-1, 1}:
            finger, finger_branch = 1, flat(finger_static)
            v = plate_velocity[0]
    return Case(
        mass, damping, stiffness, plate_velocity, load, across, plate, plate_branch, plate_static,
        finger, finger_stiffness, finger_branch, finger_static, x, v, skin, duration,
    )  # fmt: skip


def grows(case: Case) -> float:
    """Return the growth of a small error in powers of e."""
    most_load = max(case.load[0], case.load[0] + case.load[1] * case.duration)
    found = max(0.0, -case.plate_branch[3] * most_load - case.damping) / case.mass
    if case.finger_stiffness and case.finger_branch[3] < 0:
        found = max(found, case.finger_stiffness / -case.finger_branch[3])
    return found * case.duration


def make(job: tuple[int, int]) -> tuple[Case, Answer]:
    """A case of a kind, and its answer: the first well-conditioned draw of a seed."""
    kind, seed = job
    rng = random.Random(seed * len(KINDS) + kind)
    while True:
        case = draw(kind, rng)
        if grows(case) > 5 or (case.finger_stiffness and kind == 1 and case.finger_branch[3] == 0):
            continue
        try:
            answer = solve(case)
        except DoubtError:
            continue
        if answer.time > case.duration / 1000:
            return case, answer


def written(case: Case, answer: Answer) -> str:
    numbers: list[object] = []
    for value in astuple(case):
        numbers += value if isinstance(value, tuple) else [value]
    results = (answer.time, answer.x, answer.v, answer.skin_force)
    return " ".join([*map(repr, numbers), str(answer.guard), *(nstr(r, 20) for r in results)])


def main(count: int, seed: int, out: Path) -> None:
    counts = [count] * CREEP + [count // 4]
    jobs = [(kind, seed + number) for kind, n in enumerate(counts) for number in range(n)]
    with multiprocessing.Pool(2) as pool:
        answers = pool.starmap(written, pool.map(make, jobs, chunksize=2))
    out.write_text("\n".join(answers) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]))

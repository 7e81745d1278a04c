"""What the paper says last: of the steady state, of rest, and its conclusions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from pindrive.paper import as_printed, formulas, population
from pindrive.paper.claim import TINY, Claim, batch, finger_friction
from pindrive.paper.exhibit import share

if TYPE_CHECKING:
    from collections.abc import Iterator

    from pindrive.paper.population import Facts

# ---- Simulation: the last paragraph --------------------------------------------------------------


def steady_state() -> Iterator[Claim]:
    """Of vibrations without damping, the last paragraph of the results."""
    place = "Simulation"
    r = population.undamped()
    count, period = len(r.mass), 2 * np.pi / formulas.natural_frequency(r)
    draw = np.random.default_rng(population.SEED + 3)
    start = r.mouse_velocity * draw.choice([0.0, 0.5, 1.0], count)
    found = batch(r, velocity=start)
    part = found["ending_amplitude"].to_numpy() / formulas.steady_amplitude(r)
    kept = start == r.mouse_velocity
    yield Claim(
        place,
        "For the case when the pin is not sliding along the fingertip and damping is neglected, "
        "the "
        "steady state vibrations would be possible with amplitude x_m ≤ v_p / ω_0,",
        part <= 1 + TINY,
        "steady-and-rest",
        f"Of {count} undamped motions, released at v_p, half of it or none, "
        f"{share(part <= 1 + TINY)} "
        f"keep the bound; released at v_p, {share(np.abs(part[kept] - 1) < TINY)} reach it, by "
        "grazing the plate's velocity.",
    )
    taken = formulas.time_to_steady(r) / period
    simulated = batch(r)
    agree = np.abs(simulated["ending_steady_since"].to_numpy() / period - taken) < TINY
    of_paper = as_printed.periods_to_steady(r)
    beyond = r.displacement > formulas.friction_offset(r)
    reversals = simulated["transient_plate_reversals"].to_numpy()
    counts = (np.floor(of_paper) == reversals)[beyond]
    off = (taken / of_paper)[beyond]
    yield Claim(
        place,
        "which would be stabilized after 0.5(x_0/x_d + 1) periods.",
        np.abs(taken - of_paper) < 0.25,
        "steady-and-rest",
        f"It takes {off.min():.2g} to {off.max():.2g} times as many (closed form and simulation "
        f"agree in {share(agree)}). The whole part of the number is that of the reversals of "
        f"friction in {share(counts)} with x_0 > x_d: two make about a period.",
    )
    finger = draw.uniform(0.0005, 0.01, count)
    found = batch(r, finger)
    rest = formulas.periods_to_rest(r, finger)
    of_paper = as_printed.periods_to_rest(r, finger)
    from_release = found["transient_rest_time"].to_numpy() / period
    let_go = np.full(count, np.nan)
    for i in range(count):
        slips = [
            e.time
            for e in r.motion(i, finger=float(finger[i])).events
            if e.contact == "plate" and e.kind == "slip"
        ]
        if slips:
            let_go[i] = slips[-1]
    again = np.isfinite(let_go)
    since = from_release - let_go / period
    agree = np.abs(since - rest)[again] < 1e-6
    near = np.abs(since - of_paper)[again] <= 0.25 + TINY
    whole = np.abs(from_release - of_paper) <= 0.25 + TINY
    yield Claim(
        place,
        "If the friction between the fingertip and pin take place, the vibrations would be damped "
        "due to it after v_p / (4 · x_d · ω_0) periods.",
        np.concatenate([near, whole]),
        "steady-and-rest",
        "From the plate's last letting go to rest it is right to a quarter period in "
        f"{share(near)} motions, where the exact number is ceil(v_p / 2 x_f ω_0) / 2 − 1/4 "
        f"({share(agree)} simulations agree); from the release in {share(whole)}.",
        "x_d is F_f / k, the time runs from the end of the last carried stretch, and a quarter "
        "period does not matter",
        np.arange(near.size + whole.size) < near.size,
    )


# ---- Conclusions ---------------------------------------------------------------------------------


def conclusions(facts: Facts) -> Iterator[Claim]:
    """The three conclusions."""
    place = "Conclusions"
    count = len(facts.r.mass)
    draw = np.random.default_rng(population.SEED + 4)
    r = facts.r.replace(displacement=draw.uniform(0.0, 3e-3, count))
    finger = finger_friction(count)
    held = r.stiffness * r.displacement + r.damping * r.mouse_velocity + finger <= r.friction
    leaves = np.array(
        [r.motion(i, finger=float(finger[i])).segments[0].mode == "slip" for i in range(count)]
    )
    yield Claim(
        place,
        "The dynamics of tactile device pin drive has been investigated in the transient process, "
        "which takes place when information signal disappears and the pin moves along the "
        "fingertip "
        "due to the spring elastic forces.",
        leaves,
        "figure-2-velocity",
        f"The pin leaves the plate as the magnet lets go in {share(leaves)} releases from anywhere "
        f"in 0–3 mm, in {share(leaves[~held])} that meet the condition, in {share(leaves[held])} "
        "of the others: there the plate alone carries it on.",
        "k x_0 + b v_p + F_f > F_p",
        ~held,
    )
    yield Claim(
        place,
        "It was defined that the law of motion of the pin can not be obtained analytically in "
        "general case when damping is taken into account.",
        np.array([False]),
        "first-reversal",
        "Between two reversals it is (4) to (11), in every damping regime; each reversal is a root "
        "that is found with certainty. `simulate` does just that, without steps or tolerances.",
    )
    solved = batch(r, finger)["status"].to_numpy() == 0
    yield Claim(
        place,
        "The model for the pin drive simulation […] has been developed which allow us to "
        "investigate the influence of the dynamic parameters of the drive and working regime "
        "parameters on the motion of the pin of tactile device.",
        solved,
        "maps-of-time",
        f"Done here with an exact one: {share(solved)} random drives simulated to their end, and "
        "the curves and maps of this report.",
    )

"""The sentences of the paper that the simulator decides, word for word, each tried."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pindrive.paper import as_printed, formulas, population
from pindrive.paper.claims_of_analysis import no_closed_form, of_the_analysis, statements
from pindrive.paper.equations import Row
from pindrive.paper.exhibit import at_most, share
from pindrive.paper.population import TINY, Claim, Facts, finger_friction, motion_of, swing

# ---- Simulation: the last paragraph --------------------------------------------------------------


def steady_state() -> Iterator[Claim]:
    """Claims on vibrations without damping, the last paragraph of the results."""
    place = "Simulation"
    r = population.undamped()
    count, period = len(r.mass), 2 * np.pi / formulas.natural_frequency(r)
    draw = np.random.default_rng(population.SEED + 3)
    start = r.mouse_velocity * draw.choice([0.0, 0.5, 1.0], count)
    found = r.batch(velocity=start)
    part = found["ending_amplitude"].to_numpy() / formulas.steady_amplitude(r)
    kept = start == r.mouse_velocity
    yield Claim(
        place,
        "For the case when the pin is not sliding along the fingertip and damping is neglected, "
        "the steady state vibrations would be possible with amplitude x_m ≤ v_p / ω_0,",
        part <= 1 + TINY,
        "steady-and-rest",
        f"The bound holds in {share(part <= 1 + TINY)} undamped motions, released at v_p, at half "
        f"of v_p or at rest; released at v_p, {share(np.abs(part[kept] - 1) < TINY)} attain the "
        "bound, as they graze the plate's velocity.",
    )
    taken = formulas.time_to_steady(r) / period
    simulated = r.batch()
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
        f"The number of periods is {off.min():.2g} to {off.max():.2g} times the printed one "
        f"(closed form and simulation agree in {share(agree)}). The whole part of the printed "
        f"number counts the reversals of friction in {share(counts)} with x_0 > x_d; two reversals "
        "take about a period.",
    )
    finger = draw.uniform(0.0005, 0.01, count)
    found = r.batch(finger_kinetic=finger)
    rest = formulas.periods_to_rest(r, finger)
    of_paper = as_printed.periods_to_rest(r, finger)
    from_release = found["transient_rest_time"].to_numpy() / period
    breakaway = np.full(count, np.nan)
    for i in range(count):
        slips = [
            e.time
            for e in motion_of(r, i, finger=float(finger[i])).events
            if e.contact == "plate" and e.kind == "slip"
        ]
        if slips:
            breakaway[i] = slips[-1]
    again = np.isfinite(breakaway)
    since = from_release - breakaway / period
    agree = np.abs(since - rest)[again] < 1e-6
    near = np.abs(since - of_paper)[again] <= 0.25 + TINY
    whole = np.abs(from_release - of_paper) <= 0.25 + TINY
    yield Claim(
        place,
        "If the friction between the fingertip and pin take place, the vibrations would be damped "
        "due to it after v_p / (4 · x_d · ω_0) periods.",
        np.concatenate([near, whole]),
        "steady-and-rest",
        "Counted from the last start of slip on the plate, the number is right to a quarter period "
        f"in {share(near)} motions; the exact number is ceil(v_p / 2 x_f ω_0) / 2 − 1/4 "
        f"({share(agree)} simulations agree). Counted from the release, in {share(whole)}.",
        "x_d is F_f / k, the time runs from the end of the last stick on the plate, and a quarter "
        "period is neglected",
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
        [motion_of(r, i, finger=float(finger[i])).segments[0].mode == "slip" for i in range(count)]
    )
    yield Claim(
        place,
        "The dynamics of tactile device pin drive has been investigated in the transient process, "
        "which takes place when information signal disappears and the pin moves along the "
        "fingertip due to the spring elastic forces.",
        None,
        "figure-2-velocity",
        "Subject of the paper. The pin slips as the magnet releases it if k x_0 + b v_p + F_f > "
        f"F_p: in {share(leaves[~held])} such releases from 0–3 mm, and in {share(leaves[held])} "
        "other releases, in which the plate still carries the pin.",
    )
    yield from no_closed_form(facts)
    solved = r.batch(finger_kinetic=finger)["status"].to_numpy() == 0
    yield Claim(
        place,
        "The model for the pin drive simulation […] has been developed which allow us to "
        "investigate the influence of the dynamic parameters of the drive and working regime "
        "parameters on the motion of the pin of tactile device.",
        solved,
        "maps-of-time",
        f"Done with an exact model: {share(solved)} random drives are simulated to their end, and "
        "this report has curves and maps.",
        done=True,
    )


def claims(facts: Facts, equations: list[Row]) -> list[Claim]:
    """Every sentence in the order of the paper."""
    return [
        *statements(),
        *of_the_analysis(facts),
        *_of_the_simulation(facts, equations),
        *steady_state(),
        *conclusions(facts),
    ]


# ---- Simulation ----------------------------------------------------------------------------------


def _of_the_simulation(facts: Facts, equations: list[Row]) -> Iterator[Claim]:
    place = "Simulation"
    r, count = facts.r, len(facts.r.mass)
    xd, d = formulas.friction_offset(r), r.displacement - formulas.friction_offset(r)
    finger = finger_friction(count)

    residuals = [
        motion_of(r, i, finger=float(finger[i])).certificate() for i in range(0, count, 20)
    ]
    worst = max(c.kinematics for c in residuals)
    yield Claim(
        place,
        "Model of tactile device pin interaction with finger was created […] and can output "
        "displacement, velocity and acceleration of the pin during the information transmission "
        "process.",
        np.array([c.kinematics < TINY and c.motion_law < TINY for c in residuals]),
        "figure-3-model",
        f"The diagram is drawn and its equation simulated. In {len(residuals)} motions with "
        "a finger, velocity and acceleration are the derivatives of the displacement to "
        f"${at_most(worst)}$, checked without the solver.",
        done=True,
    )

    more_damped = facts.r.replace(damping=1.5 * r.damping)
    depth, deeper = (swing(of.batch(finger_kinetic=finger)) for of in (more_damped, facts.r))
    yield Claim(
        place,
        "The law of damped pin motion and the impact of drive dynamical parameters on it were "
        "investigated. Some pin displacement curves at different damping factor values are shown "
        "in Figure 4.",
        depth <= deeper * (1 + TINY),
        "figure-4-displacement",
        "Recomputed for both readings of the damping factor; no other parameter is given. 50 % "
        f"more damping reduces the swing in {share(depth <= deeper * (1 + TINY))} releases.",
        done=True,
    )

    faster = r.replace(mouse_velocity=1.01 * r.mouse_velocity)
    grows = formulas.initial_phase(faster) >= formulas.initial_phase(r)
    yield Claim(
        place,
        "It was defined what initial phase angle φ_0 increases when the mouse velocity is "
        "increasing,",
        grows,
        "phase-and-amplitude",
        f"With 1 % more v_p the phase grows in {share(grows)} releases: in {share(grows[d > 0])} "
        f"with x_0 > x_d, and in {share(grows[d < 0])} with x_0 < x_d.",
        "x_0 > x_d",
        d > 0.0,
    )
    still = r.replace(mouse_velocity=0.0, damping=np.where(np.arange(count) % 2, r.damping, 0.0))
    beyond = still.take(formulas.applies(still) & (d > 0.0))
    phase = formulas.initial_phase(beyond)
    lag = formulas.velocity_phase(beyond)
    yield Claim(
        place,
        "and φ_0 = 0, when v_p = 0.",
        phase <= TINY,
        "phase-and-amplitude",
        f"φ_0 = φ′_0 in {share(np.abs(phase - lag) < TINY)} releases with v_p = 0, so t_a = 0; "
        f"with their damping φ′_0 is up to {np.degrees(phase.max()):.0f}°.",
        "the damping is zero",
        beyond.damping == 0.0,
    )

    faster = r.replace(mouse_velocity=1.1 * r.mouse_velocity)
    slow, fast = r.batch(finger_kinetic=finger), faster.batch(finger_kinetic=finger)
    higher = (
        fast["transient_peak_displacement"].to_numpy()
        >= (1 - TINY) * slow["transient_peak_displacement"].to_numpy()
    )
    swings = swing(fast) >= (1 - TINY) * swing(slow)
    yield Claim(
        place,
        "Higher mouse velocity causes greater pin displacements.",
        higher,
        "influence-on-displacement",
        f"With 10 % more v_p the first maximum is greater in {share(higher)} exact motions with "
        f"finger friction, and the following swing in {share(swings)}.",
    )

    rubbed = r.replace(friction=1.01 * r.friction)
    rubbed = rubbed.take(formulas.applies(rubbed))
    smooth = r.take(formulas.applies(r.replace(friction=1.01 * r.friction)))
    names = {
        "damped_frequency": "ω",
        "decay_rate": "α",
        "velocity_phase": "φ′_0",
        "initial_phase": "φ_0",
        "amplitude": "X_m,0",
        "friction_offset": "x_d",
        "peak_time": "t_a",
        "peak_displacement": "x_m,a",
        "return_velocity_time": "t_b",
        "return_velocity": "v_m,b",
        "trough_time": "t_c",
        "trough_displacement": "x_m,c",
        "swing": "the swing",
    }
    moved = np.array(
        [np.any(getattr(formulas, n)(rubbed) != getattr(formulas, n)(smooth)) for n in names]
    )
    untouched = [symbol for symbol, moves in zip(names.values(), moved, strict=True) if not moves]
    yield Claim(
        place,
        "Friction forces are influencing all the parameters of vibrations.",
        moved,
        "phase-and-amplitude",
        f"1 % more friction changes {share(moved)} parameters, but not {', '.join(untouched)}, "
        "which belong to the oscillator.",
    )
    turned = formulas.initial_phase(rubbed) >= formulas.initial_phase(smooth)
    yield Claim(
        place,
        "The greater displacement x_d due to friction displacements of the pin is enlarging "
        "initial phase angle",
        turned,
        "phase-and-amplitude",
        f"With 1 % more friction φ_0 is greater in {share(turned)} releases.",
    )
    shrinks = formulas.amplitude(rubbed) <= formulas.amplitude(smooth)
    w0 = formulas.natural_frequency(smooth)
    edge = formulas.decay_rate(smooth) * smooth.mouse_velocity / w0**2
    past = smooth.displacement - 1.01 * formulas.friction_offset(smooth) > edge
    yield Claim(
        place,
        "and reducing the amplitude of vibrations.",
        shrinks,
        "phase-and-amplitude",
        f"With 1 % more friction X_m,0 falls in {share(shrinks)} releases: in "
        f"{share(shrinks[past])} with x_0 − x_d > −ζ v_p / ω_0, and in {share(shrinks[~past])} "
        "other releases.",
        "x_0 − x_d > −ζ v_p / ω_0, hence for every x_0 > x_d",
        past,
    )

    wider = r.replace(displacement=1.01 * r.displacement)
    elastic = np.log(formulas.amplitude(wider) / formulas.amplitude(r)) / np.log(1.01)
    fast_share = r.mouse_velocity / (formulas.natural_frequency(r) * np.maximum(d, 1e-12))
    most = elastic > 0.5
    slow_mouse = (fast_share < 0.5) & (d > 0.0)
    yield Claim(
        place,
        "The initial pin displacement x_0 influences very much the amplitude of vibrations",
        most,
        "phase-and-amplitude",
        "With “very much” read as an elasticity above 0.5: true in "
        f"{share(most)} releases, and in {share(most[slow_mouse])} with v_p < 0.5 ω_0 (x_0 − x_d). "
        "Under a fast mouse v_p determines the amplitude.",
        "v_p < 0.5 ω_0 (x_0 − x_d)",
        slow_mouse,
    )
    far = r.replace(displacement=2 * r.displacement)
    shrink = [
        np.abs(formulas.trough_displacement(of) - xd) / (formulas.peak_displacement(of) - xd)
        for of in (r, far)
    ]
    rate_changes = np.abs(shrink[1] / shrink[0] - 1) > TINY
    near_rest, far_rest = (
        of.batch(finger_kinetic=finger + 1e-4)["transient_rest_time"].to_numpy() for of in (r, far)
    )
    longer = np.abs(far_rest / near_rest - 1) > TINY
    yield Claim(
        place,
        "and their damping.",
        np.concatenate([rate_changes, longer]),
        "influence-on-time",
        "Twice the x_0 changes the ratio of successive extremes about x_d, "
        rf"$e^{{\alpha\pi/\omega}}$, in {share(rate_changes)} releases, and the duration of the "
        f"vibration in {share(longer)}.",
        "damping means the duration of the vibration",
        np.arange(2 * count) >= count,
    )

    wrong = [row for row in equations if row.right]
    right = max(row.off_right for row in equations)
    yield Claim(
        place,
        "The results of investigation allow us to evaluate quantitatively the influence of x_0 and "
        "x_d, mouse velocity v_p, damping b and natural frequency ω_0 of the system on the law of "
        "pin motion in the transient process.",
        np.array([not row.right for row in equations] + [right < TINY]),
        "equations",
        f"As printed, {len(wrong)} of {len(equations)} rows of the table of equations are wrong, "
        f"with an error of up to {np.nanmax([row.off_printed for row in wrong]):.2g}; corrected, "
        f"all are right to ${at_most(right)}$.",
        "the equations are corrected, and until the pin first reaches the plate's velocity",
        np.array([False] * len(equations) + [True]),
    )

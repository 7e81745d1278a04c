"""The sentences of the paper that the simulator decides, word for word, each tried."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pindrive.paper import as_printed, formulas, population
from pindrive.paper.claims_of_analysis import no_closed_form, of_the_analysis, statements
from pindrive.paper.equations import Row
from pindrive.paper.exhibit import at_most
from pindrive.paper.population import TINY, Claim, Facts, claim, finger_friction, motion_of, swing

# ---- Simulation: the last paragraph --------------------------------------------------------------


def steady_state() -> Iterator[Claim]:
    """Claims on vibrations without damping, the last paragraph of the results."""
    r = population.undamped()
    count, period = len(r.mass), 2 * np.pi / formulas.natural_frequency(r)
    draw = np.random.default_rng(population.SEED + 3)
    start = r.mouse_velocity * draw.choice([0.0, 0.5, 1.0], count)
    found = r.batch(velocity=start)
    part = found["ending_amplitude"].to_numpy() / formulas.steady_amplitude(r)
    kept = start == r.mouse_velocity
    yield claim("steady-amplitude", part <= 1 + TINY, grazing=np.abs(part[kept] - 1) < TINY)
    taken = formulas.time_to_steady(r) / period
    simulated = r.batch()
    agree = np.abs(simulated["ending_steady_since"].to_numpy() / period - taken) < TINY
    of_paper = as_printed.periods_to_steady(r)
    beyond = r.displacement > formulas.friction_offset(r)
    reversals = simulated["transient_plate_reversals"].to_numpy()
    counts = (np.floor(of_paper) == reversals)[beyond]
    off = (taken / of_paper)[beyond]
    yield claim(
        "periods-to-steady",
        np.abs(taken - of_paper) < 0.25,
        least=off.min(),
        most=off.max(),
        agree=agree,
        counted=counts,
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
    yield claim(
        "periods-to-rest",
        np.concatenate([near, whole]),
        meets=np.arange(near.size + whole.size) < near.size,
        near=near,
        agree=agree,
        from_release=whole,
    )


# ---- Conclusions ---------------------------------------------------------------------------------


def conclusions(facts: Facts) -> Iterator[Claim]:
    """The three conclusions."""
    count = len(facts.r.mass)
    draw = np.random.default_rng(population.SEED + 4)
    r = facts.r.replace(displacement=draw.uniform(0.0, 3e-3, count))
    finger = finger_friction(count)
    held = r.stiffness * r.displacement + r.damping * r.mouse_velocity + finger <= r.friction
    leaves = np.array(
        [motion_of(r, i, finger=float(finger[i])).segments[0].mode == "slip" for i in range(count)]
    )
    yield claim("release", None, slip=leaves[~held], carried=leaves[held])
    yield from no_closed_form(facts)
    solved = r.batch(finger_kinetic=finger)["status"].to_numpy() == 0
    yield claim("drive-model", solved, done=True)


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
    r, count = facts.r, len(facts.r.mass)
    xd, d = formulas.friction_offset(r), r.displacement - formulas.friction_offset(r)
    finger = finger_friction(count)

    residuals = [
        motion_of(r, i, finger=float(finger[i])).certificate() for i in range(0, count, 20)
    ]
    worst = max(c.kinematics for c in residuals)
    yield claim(
        "finger-model",
        np.array([c.kinematics < TINY and c.motion_law < TINY for c in residuals]),
        done=True,
        count=len(residuals),
        worst=at_most(worst),
    )

    more_damped = facts.r.replace(damping=1.5 * r.damping)
    depth, deeper = (swing(of.batch(finger_kinetic=finger)) for of in (more_damped, facts.r))
    yield claim("damping-factors", depth <= deeper * (1 + TINY), done=True)

    faster = r.replace(mouse_velocity=1.01 * r.mouse_velocity)
    grows = formulas.initial_phase(faster) >= formulas.initial_phase(r)
    yield claim("phase-by-speed", grows, meets=d > 0.0, slower=grows[d < 0])
    still = r.replace(mouse_velocity=0.0, damping=np.where(np.arange(count) % 2, r.damping, 0.0))
    beyond = still.take(formulas.applies(still) & (d > 0.0))
    phase = formulas.initial_phase(beyond)
    lag = formulas.velocity_phase(beyond)
    yield claim(
        "phase-at-rest",
        phase <= TINY,
        meets=beyond.damping == 0.0,
        lagging=np.abs(phase - lag) < TINY,
        largest=np.degrees(phase.max()),
    )

    faster = r.replace(mouse_velocity=1.1 * r.mouse_velocity)
    slow, fast = r.batch(finger_kinetic=finger), faster.batch(finger_kinetic=finger)
    higher = (
        fast["transient_peak_displacement"].to_numpy()
        >= (1 - TINY) * slow["transient_peak_displacement"].to_numpy()
    )
    swings = swing(fast) >= (1 - TINY) * swing(slow)
    yield claim("displacement-by-speed", higher, swings=swings)

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
    yield claim("friction-on-all", moved, untouched=", ".join(untouched))
    turned = formulas.initial_phase(rubbed) >= formulas.initial_phase(smooth)
    yield claim("phase-by-friction", turned)
    shrinks = formulas.amplitude(rubbed) <= formulas.amplitude(smooth)
    w0 = formulas.natural_frequency(smooth)
    edge = formulas.decay_rate(smooth) * smooth.mouse_velocity / w0**2
    past = smooth.displacement - 1.01 * formulas.friction_offset(smooth) > edge
    yield claim("amplitude-by-friction", shrinks, meets=past)

    wider = r.replace(displacement=1.01 * r.displacement)
    elastic = np.log(formulas.amplitude(wider) / formulas.amplitude(r)) / np.log(1.01)
    fast_share = r.mouse_velocity / (formulas.natural_frequency(r) * np.maximum(d, 1e-12))
    most = elastic > 0.5
    slow_mouse = (fast_share < 0.5) & (d > 0.0)
    yield claim("amplitude-by-displacement", most, meets=slow_mouse)
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
    yield claim(
        "damping-by-displacement",
        np.concatenate([rate_changes, longer]),
        meets=np.arange(2 * count) >= count,
        ratios=rate_changes,
        longer=longer,
    )

    wrong = [row for row in equations if row.right]
    right = max(row.off_right for row in equations)
    yield claim(
        "equations-evaluate",
        np.array([not row.right for row in equations] + [right < TINY]),
        meets=np.array([False] * len(equations) + [True]),
        wrong=len(wrong),
        count=len(equations),
        largest=np.nanmax([row.off_printed for row in wrong]),
        right=at_most(right),
    )

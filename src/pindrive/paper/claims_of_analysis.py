"""Claims beyond simulation, and claims of the mathematical analysis."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from pindrive.paper import formulas, population
from pindrive.paper.exhibit import at_most
from pindrive.paper.formulas import Array, Releases
from pindrive.paper.population import TINY, Claim, Facts, Truth, claim
from pindrive.paper.wording import TEXTS, worded


def has_closed_form(r: Releases) -> Truth:
    """Return True for releases with a t_1 that an elementary expression of (21) solves.

    The expressions are π + 2φ_0 for ωt_1, which is exact without damping, and (26) of the limit
    case.
    """
    scale = formulas.natural_frequency(r) * formulas.amplitude(r)
    turned = (np.pi + 2 * formulas.initial_phase(r)) / formulas.damped_frequency(r)
    solved = np.zeros(r.shape, dtype=bool)
    for t in (turned, formulas.limit_reversal_time(r)):
        solved |= np.abs(formulas.velocity(t, r) - r.mouse_velocity) < TINY * scale
    return solved


def of_the_analysis(facts: Facts) -> Iterator[Claim]:
    """The five sentences of this section that say more than an equation."""
    r = facts.r
    back, start = np.abs(facts.number("return_velocity")), r.mouse_velocity
    t_1 = facts.number("first_reversal_time")
    reaches = np.isfinite(t_1)
    yield claim("largest-velocity", back >= start, meets=reaches)
    yield _change_of_direction(r.take(reaches), t_1[reaches])
    angle = (formulas.damped_frequency(r) * t_1)[reaches]
    phase, lag = formulas.initial_phase(r)[reaches], formulas.velocity_phase(r)[reaches]
    above, right = angle > np.pi + 2 * phase, angle >= np.pi + 2 * (phase - lag) - TINY
    yield claim("first-change", above, right=right)
    yield from _first_reversal(r.take(reaches), t_1[reaches])
    whole = whole_motion(facts)
    solved = r.batch()["status"].to_numpy() == 0
    yield claim(
        "computer-methods",
        ~whole,
        meets=reaches,
        excludes=True,
        never=whole[~reaches],
        known=whole[reaches],
        solved=solved[reaches],
    )


def _change_of_direction(r: Releases, t_1: Array) -> Claim:
    """Return the claims on t_1; `r` are the releases that reach v_p then."""
    passes, keeps = np.zeros(t_1.size, dtype=bool), np.zeros(t_1.size, dtype=bool)
    for i in range(t_1.size):
        motion = population.motion_of(r, i)
        time, kind = next((e.time, e.kind) for e in motion.events if e.contact == "plate")
        passes[i] = kind == "reverse"
        pull = r.stiffness[i] * motion.position(time) + r.damping[i] * r.mouse_velocity[i]
        keeps[i] = not passes[i] and pull > 0.0
    caught = ~passes
    return claim(
        "change-of-direction",
        ~keeps,
        meets=passes,
        passing=passes,
        caught=caught,
        kept=keeps[caught],
    )


def _first_reversal(damped: Releases, t_1: Array) -> Iterator[Claim]:
    """Return the claims on t_1; `damped` are the releases that reach v_p again, at `t_1`."""
    undamped = damped.replace(damping=0.0)
    beyond = undamped.displacement > formulas.friction_offset(undamped)
    undamped = undamped.take(beyond & (undamped.mouse_velocity > 0.0))
    limit = population.limit_cases()
    with_form, without, at_limit = (has_closed_form(r) for r in (undamped, damped, limit))
    scale = formulas.natural_frequency(damped) * formulas.amplitude(damped)
    residual = np.abs(formulas.velocity(t_1, damped) - damped.mouse_velocity) / scale
    yield claim(
        "no-analytical-solution",
        ~np.concatenate([without, with_form, at_limit]),
        meets=np.arange(without.size + with_form.size + at_limit.size) < without.size,
        excludes=True,
        undamped=with_form,
        at_limit=at_limit,
        others=without,
        count=t_1.size,
        residual=at_most(float(residual.max())),
    )
    own = formulas.first_reversal_time(damped)
    unknown = np.abs(own - t_1) * formulas.natural_frequency(damped) > TINY
    yield claim("unknown-at-first-reversal", unknown, agree=~unknown)
    stops = {}
    for name in ("damping", "mouse_velocity"):
        more, less = (limit.replace(**{name: getattr(limit, name) * x}) for x in (1.001, 0.999))
        never = np.isnan(formulas.first_reversal_time(more))
        stops[name] = never & np.isfinite(formulas.first_reversal_time(less))
    both = stops["damping"] & stops["mouse_velocity"]
    yield claim(
        "limit-case",
        np.concatenate([at_limit & both, ~without, ~with_form]),
        meets=np.arange(both.size + without.size + with_form.size) < both.size + without.size,
        excludes=True,
        at_limit=at_limit,
        damping=stops["damping"],
        speed=stops["mouse_velocity"],
        others=without,
        undamped=with_form,
    )


def whole_motion(facts: Facts) -> Truth:
    """Return True for releases whose whole motion has elementary expressions."""
    r = facts.r
    reaches = np.isfinite(facts.number("first_reversal_time"))
    one_piece = r.take(~reaches)
    end = 3 * formulas.limit_reversal_time(one_piece)
    position = one_piece.batch(duration=end, outputs=["final_position"])["final_position"]
    off = np.abs(position.to_numpy() - formulas.position(end, one_piece))
    whole = np.zeros(r.shape, dtype=bool)
    whole[~reaches] = off < TINY * formulas.amplitude(one_piece)
    whole[reaches] = has_closed_form(r.take(reaches))
    return whole


def no_closed_form(facts: Facts) -> Iterator[Claim]:
    """The conclusion on the law of motion."""
    reaches, whole = np.isfinite(facts.number("first_reversal_time")), whole_motion(facts)
    yield claim(
        "no-closed-form",
        ~whole,
        meets=reaches,
        excludes=True,
        never=whole[~reaches],
        others=int(reaches.sum()),
        known=whole[reaches],
    )


# ---- what the paper sets out ---------------------------------------------------------------------


def statements() -> list[Claim]:
    """The sentences of introduction and experiment, which are no claims on the drive."""
    return [
        Claim(
            of["place"], worded(of["sentence"]), None, of.get("shown_by", ""), worded(of["finding"])
        )
        for of in TEXTS["statements"]
    ]

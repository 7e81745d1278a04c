"""Claims beyond simulation, and claims of the mathematical analysis."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from pindrive.paper import formulas, population
from pindrive.paper.exhibit import at_most, share
from pindrive.paper.formulas import Array, Releases
from pindrive.paper.population import TINY, Claim, Facts, Truth

_PLACE = "Mathematical analysis"


def has_closed_form(r: Releases) -> Truth:
    """Return True for releases with a t_1 that an elementary expression of (21) solves.

    They are π + 2φ_0 for ωt_1, which is exact without damping, and (26) of the limit case.
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
    yield Claim(
        _PLACE,
        "The absolutely largest pin velocity value (negative, v_m,b) will be obtained at the "
        "acceleration being equal to zero.",
        back >= start,
        "printed-forms",
        f"v_m,b is in size at least v_p, the velocity at the release, in {share(back >= start)} "
        f"releases; of those that reach it again, in {share((back >= start)[reaches])}. "
        "Heavily damped, or from x_0 near x_d, the pin is never again as fast as at its release.",
        "the pin reaches the plate's velocity afterwards",
        reaches,
    )
    yield _change_of_direction(r.take(reaches), t_1[reaches])
    angle = (formulas.damped_frequency(r) * t_1)[reaches]
    phase, lag = formulas.initial_phase(r)[reaches], formulas.velocity_phase(r)[reaches]
    above, right = angle > np.pi + 2 * phase, angle >= np.pi + 2 * (phase - lag) - TINY
    yield Claim(
        _PLACE,
        "The first friction force direction change will be at oscillation phase angle ωt value "
        "which is larger, than π + 2φ_0.",
        above,
        "first-reversal",
        f"True of {share(above)} releases that reach v_p again: not of slow mice. "
        f"ωt_1 ≥ π + 2(φ_0 − φ′_0) is true of {share(right)}.",
    )
    yield from _first_reversal(r.take(reaches), t_1[reaches])
    whole = whole_motion(facts)
    solved = r.batch()["status"].to_numpy() == 0
    yield Claim(
        _PLACE,
        "For the general case equation (1) is to be solved by computer methods.",
        ~whole,
        "first-reversal",
        f"(6) is the whole motion in {share(whole[~reaches])} releases that never reach v_p again. "
        f"Of the others, the general case, the elementary forms that are known give "
        f"{share(whole[reaches])}; that there is no other is not proved. By computer, with closed "
        f"forms from event to event, {share(solved[reaches])} of these are solved.",
        meets=reaches,
        excludes=True,
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
    return Claim(
        _PLACE,
        "The pin will stop and dry friction force will change the direction at t_1, when pin "
        "velocity in respect of the mouse will reach value v_p",
        ~keeps,
        "first-reversal",
        f"t_1 is when the pin first reaches the plate's velocity. {share(passes)} releases pass "
        f"it, and friction turns; {share(caught)} are caught by the plate and carried, and in "
        f"{share(keeps[caught])} of these friction keeps its direction as it holds the pin.",
        "the plate does not catch the pin",
        passes,
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
    yield Claim(
        _PLACE,
        "Becomes clear that the analytical solution is impossible",
        ~np.concatenate([without, with_form, at_limit]),
        "first-reversal",
        "(22) holds t_1 in an exponential and in a sine: no elementary closed form is known, and "
        "that there is none is not proved, neither in the paper nor here. The two that are known, "
        f"ωt_1 = π + 2φ_0 and (26), solve it in {share(with_form)} releases "
        f"without damping and {share(at_limit)} limit cases, and in {share(without)} others. It is "
        f"computable all the same: t_1 is a root that can be isolated and found to rounding, and "
        f"{t_1.size} of them satisfy (21) to ${at_most(float(residual.max()))}$ of ω_0 X_m,0.",
        meets=np.arange(without.size + with_form.size + at_limit.size) < without.size,
        excludes=True,
    )
    own = formulas.first_reversal_time(damped)
    unknown = np.abs(own - t_1) * formulas.natural_frequency(damped) > TINY
    yield Claim(
        _PLACE,
        "because nor pin acceleration neither its displacement at t_1 or at phase angle ωt_1 are "
        "known.",
        unknown,
        "first-reversal",
        "(22) holds neither of them. From (22) alone t_1 is that of the simulator in "
        f"{share(~unknown)} releases; displacement and acceleration follow by (6) and (11).",
    )
    stops = {}
    for name in ("damping", "mouse_velocity"):
        more, less = (limit.replace(**{name: getattr(limit, name) * x}) for x in (1.001, 0.999))
        never = np.isnan(formulas.first_reversal_time(more))
        stops[name] = never & np.isfinite(formulas.first_reversal_time(less))
    both = stops["damping"] & stops["mouse_velocity"]
    yield Claim(
        _PLACE,
        "It is available only in the limit case when the system damping or the mouse velocity v_p "
        "are large and the second largest value of the pin velocity at t_1 do not exceed v_p, and "
        "thus dry friction force do not change its direction.",
        np.concatenate([at_limit & both, ~without, ~with_form]),
        "first-reversal",
        f"Available it is there, by (26), corrected, in {share(at_limit)} limit cases; there 0.1 % "
        f"more damping keeps the pin below v_p and 0.1 % less does not in "
        f"{share(stops['damping'])}, the same of mouse velocity in "
        f"{share(stops['mouse_velocity'])}. “Only” is not proved: with damping no other form is "
        f"known, and (26) and ωt_1 = π + 2φ_0 solve {share(without)} others; without damping "
        f"{share(with_form)} outside the limit case.",
        meets=np.arange(both.size + without.size + with_form.size) < both.size + without.size,
        excludes=True,
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
    yield Claim(
        "Conclusions",
        "It was defined that the law of motion of the pin can not be obtained analytically in "
        "general case when damping is taken into account.",
        ~whole,
        "first-reversal",
        f"(6) is the whole motion in {share(whole[~reaches])} releases that never reach v_p again. "
        f"Where one does, in {int(reaches.sum())}, (6) and its like hold from event to event. No "
        "elementary closed form of the times of the events is known, and that there is none is not "
        f"proved; those that are known give {share(whole[reaches])}. Each is a root, found to "
        "rounding with certainty, which is how `simulate` follows the pin without steps or "
        "tolerances.",
        meets=reaches,
        excludes=True,
    )


# ---- what the paper sets out ---------------------------------------------------------------------


_SENTENCES: Final = (
    (
        "Introduction",
        "The great variety of tactile systems in use testifies that the disadvantages, such as "
        "system complexity, great cost, low reliability and functional possibilities are not "
        "overcome yet and the search of more promising solution remains the problem of today.",
        "",
        "Says why the device was made; the report asks how it moves.",
    ),
    (
        "Introduction",
        "The method, where information transmitting pin stimulates operator fingertip skin moving "
        "tangentially to it and the patented tactile device were proposed",
        "figure-1-device",
        "Describes the device.",
    ),
    (
        "Introduction",
        "Electromagnet 1 with wrapped winding is held by spring 2 in the mouse 3 which must be "
        "placed on the metallic surface 4. A pin 5 on the electromagnet is protruding from the "
        "housing.",
        "figure-1-device",
        "Describes the device. The damper, which its equation (1) has, is not named here.",
    ),
    (
        "Introduction",
        "When the cursor is in the information area (black lines, letters) the control block sends "
        "signals and electromagnet of the drive is magnetized to the metallic surface.",
        "figure-1-device",
        "Describes how it works. `pindrive.Device` has scene, control block and coil; here the "
        "pull is a factor on the plate's friction.",
    ),
    (
        "Introduction",
        "The pin slides along the fingertip and produces the strains in the skin at the contact "
        "area and thus transmits the information.",
        "figure-2-velocity",
        "Describes how it works. A finger with a tangential stiffness, which the paper's equation "
        "leaves out, has a skin that stretches.",
    ),
    (
        "Experiment",
        "The interaction between finger skin and pin is there the key process because during it "
        "the information is transmitted to user.",
        "",
        "Says what matters to its authors.",
    ),
    (
        "Experiment",
        "The experiments have shown that the tactile device is functioning properly when the "
        "surface on which it is laid is clean and dry and the directions of the drive and movement "
        "of the device are kept parallel enough.",
        "",
        "A condition of operation, from measurements that are not printed. This report keeps it: "
        "one friction coefficient at the plate, and a hand that moves along the drive. "
        "`pindrive.Device` follows an oblique hand: at 10° the pin of examples/tactile-reader.toml "
        "goes 84 % as far as under an aligned hand, at 30° 69 %, at 60° 26 %, and from 84° on it "
        "shows no line (docs/studies.md).",
    ),
    (
        "Experiment",
        "In that case law of motion of the pin was measured (Figure 2).",
        "figure-2-velocity",
        "Says what was measured; the data are not printed.",
    ),
    (
        "Experiment",
        "During the investigation a significant parameters of the transitional process were framed "
        "– the time of the transitional period and the maximum displacement of the transitional "
        "process.",
        "influence-on-time",
        "Says what is asked; both are computed for every parameter.",
    ),
    (
        "Experiment",
        "The relationship of transitional process parameters and dynamic parameters of the pin "
        "drive and working regime (surface friction, damping, rigidity, system load, speed of the "
        "mouse, initial deflection of pin,) was settled as a problem for the following "
        "investigation.",
        "influence-on-displacement",
        "Says what is asked. System load is taken for the touch force, rigidity for the stiffness.",
    ),
)


def statements() -> list[Claim]:
    """The sentences of introduction and experiment."""
    return [
        Claim(place, sentence, None, shown_by, finding)
        for place, sentence, shown_by, finding in _SENTENCES
    ]

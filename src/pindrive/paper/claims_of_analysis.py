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
    yield Claim(
        _PLACE,
        "The absolutely largest pin velocity value (negative, v_m,b) will be obtained at the "
        "acceleration being equal to zero.",
        back >= start,
        "printed-forms",
        "The size of v_m,b is at least v_p, the velocity at the release, in "
        f"{share(back >= start)} releases, and in {share((back >= start)[reaches])} releases that "
        "reach v_p again. With large damping, or x_0 near x_d, the velocity at the release is "
        "the largest.",
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
        f"True in {share(above)} releases that reach v_p again; false for slow mice. "
        f"ωt_1 ≥ π + 2(φ_0 − φ′_0) is true in {share(right)}.",
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
        f"In the general case, where they do, the known elementary forms give "
        f"{share(whole[reaches])}; that no other form exists is not proved. The computer solves "
        f"{share(solved[reaches])} of them, with closed forms from event to event.",
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
        f"t_1 is the time at which the pin first reaches the plate's velocity. {share(passes)} "
        f"releases exceed that velocity, and friction reverses; {share(caught)} stick to the "
        f"plate, and in {share(keeps[caught])} of these friction keeps its direction.",
        "the pin does not stick to the plate",
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
        "(22) has t_1 in an exponential and in a sine. No elementary closed form is known; that "
        "none exists is proved neither in the paper nor here. The two known forms, "
        f"ωt_1 = π + 2φ_0 and (26), solve {share(with_form)} releases "
        f"without damping, {share(at_limit)} limit cases, and {share(without)} other releases. "
        f"t_1 is computable as an isolated root, to rounding: "
        f"{t_1.size} roots satisfy (21) to ${at_most(float(residual.max()))}$ of ω_0 X_m,0.",
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
        "(22) contains neither of them. Its solution t_1 is that of the simulator in "
        f"{share(~unknown)} releases; displacement and acceleration then follow from (6) and (11).",
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
        f"The corrected (26) gives t_1 in {share(at_limit)} limit cases. There 0.1 % more damping "
        f"keeps the pin below v_p, and 0.1 % less does not, in {share(stops['damping'])}; 0.1 % of "
        f"the mouse velocity does likewise in {share(stops['mouse_velocity'])}. “Only” is not "
        f"proved: with damping no other form is known, and (26) and ωt_1 = π + 2φ_0 solve "
        f"{share(without)} other releases; without damping they solve {share(with_form)} outside "
        "of the limit case.",
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
        f"In the other {int(reaches.sum())}, such expressions hold from event to event. No "
        "elementary closed form of the times of the events is known; that none exists is not "
        f"proved; the known forms give {share(whole[reaches])}. Each time is an isolated root, "
        "computed to rounding: `simulate` needs neither steps nor tolerances.",
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
        "Motivation of the device; this report covers its motion.",
    ),
    (
        "Introduction",
        "The method, where information transmitting pin stimulates operator fingertip skin moving "
        "tangentially to it and the patented tactile device were proposed",
        "figure-1-device",
        "Description of the device.",
    ),
    (
        "Introduction",
        "Electromagnet 1 with wrapped winding is held by spring 2 in the mouse 3 which must be "
        "placed on the metallic surface 4. A pin 5 on the electromagnet is protruding from the "
        "housing.",
        "figure-1-device",
        "Description of the device, without the damper of equation (1).",
    ),
    (
        "Introduction",
        "When the cursor is in the information area (black lines, letters) the control block sends "
        "signals and electromagnet of the drive is magnetized to the metallic surface.",
        "figure-1-device",
        "Description of the operation. `pindrive.Device` has scene, control block and coil; in "
        "this report the pull is a factor on the friction of the plate.",
    ),
    (
        "Introduction",
        "The pin slides along the fingertip and produces the strains in the skin at the contact "
        "area and thus transmits the information.",
        "figure-2-velocity",
        "Description of the operation. Skin stretches in a finger with a tangential stiffness, "
        "which the paper's equation omits.",
    ),
    (
        "Experiment",
        "The interaction between finger skin and pin is there the key process because during it "
        "the information is transmitted to user.",
        "",
        "Statement of importance.",
    ),
    (
        "Experiment",
        "The experiments have shown that the tactile device is functioning properly when the "
        "surface on which it is laid is clean and dry and the directions of the drive and movement "
        "of the device are kept parallel enough.",
        "",
        "Condition of operation, from measurements that are not printed. This report keeps the "
        "condition: one friction coefficient of the plate, and a hand that moves along the drive. "
        "`pindrive.Device` also simulates an oblique hand: the deflection of the pin of "
        "examples/tactile-reader.toml is 83 % of that under an aligned hand at 10°, 68 % at 30° "
        "and 25 % at 60°; from 84° on no line is shown (docs/studies.md).",
    ),
    (
        "Experiment",
        "In that case law of motion of the pin was measured (Figure 2).",
        "figure-2-velocity",
        "Description of a measurement; the data are not printed.",
    ),
    (
        "Experiment",
        "During the investigation a significant parameters of the transitional process were framed "
        "– the time of the transitional period and the maximum displacement of the transitional "
        "process.",
        "influence-on-time",
        "Statement of the problem; both numbers are computed for every parameter.",
    ),
    (
        "Experiment",
        "The relationship of transitional process parameters and dynamic parameters of the pin "
        "drive and working regime (surface friction, damping, rigidity, system load, speed of the "
        "mouse, initial deflection of pin,) was settled as a problem for the following "
        "investigation.",
        "influence-on-displacement",
        "Statement of the problem. System load is read as touch force, which presses on finger and "
        "plate, rigidity as stiffness.",
    ),
    (
        "Mathematical analysis",
        "The mathematical model of the drive of tactile device was created taking into "
        "consideration that the pin is loaded by finger, and thus affected by friction forces, "
        "which occur in the contact of pin and finger and supporting surface.",
        "influence-on-time",
        "Statement of the model. (1) has both frictions as constants and does not say how they "
        "follow the load. Here the touch presses the pin on the plate, too (plate.touch_share 1). "
        "Without that, the settling time over touch forces of 1 to 40 mN differs by up to 9 % "
        "from the one drawn, and the largest displacement by 0.1 %.",
    ),
)


def statements() -> list[Claim]:
    """The sentences of introduction and experiment."""
    return [
        Claim(place, sentence, None, shown_by, finding)
        for place, sentence, shown_by, finding in _SENTENCES
    ]

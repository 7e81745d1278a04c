"""Systems of several bodies: against formulas, an independent integrator, and written otherwise."""

from __future__ import annotations

import pickle
from math import inf, pi, sqrt

import numpy as np
import pytest

import pindrive as pd
from cases import cases
from oracle.bodies_by_dop853 import follow
from pindrive.bodies import SystemMotion
from random_systems import random_system

DURATION = 0.1


def hand_and_pins(pins: int = 4) -> pd.System:
    """The example of the documentation."""
    system = pd.System()
    hand = system.body("hand", mass=0.55)
    system.spring(hand, pd.minimum_jerk("60 mm", "0.8 s"), stiffness=135, damping=6.5)
    for i in range(pins):
        pin = system.body(f"pin {i}", mass="1 g")
        system.spring(pin, hand, stiffness=250, damping=0.5)
        pull = pd.Profile([0.2 + 0.01 * i, 0.2 + 0.01 * i, 0.4, 0.4], [1, 90, 90, 1])
        system.contact(pin, "ground", kinetic="2.2 mN", static="2.6 mN", load=pull)
        system.contact(pin, hand, kinetic="30 mN", static="45 mN", stiffness=300, damping=0.3)
    system.force("pin 0", pd.harmonic(0, "1 mN", "5 Hz"))
    system.initial("pin 0", position="2 mm", velocity=0.0)
    return system


def test_random_systems_move_as_an_integrator_has_them() -> None:
    """1 to 6 bodies, half of the systems in round numbers, against DOP853 with located events."""
    apart, worst = [], 0.0
    for seed in range(cases(200)):
        system = random_system(seed)
        motion = system.simulate(DURATION)
        assert motion.status == pd.Status.ok
        assert motion.certificate().worst < 1e-12, seed
        expected, _ = follow(system, DURATION, [])
        moving, *_ = motion.state_at(np.array([DURATION]))
        size = max(np.abs(motion.state_at(motion.sample_times())[0][0]).max(), 1e-6)
        off = float(np.abs(moving[0, :, 0] - expected).max() / size)
        worst = max(worst, off)
        if off > 1e-7:
            apart.append((seed, off))
    assert apart == []
    assert worst > 0.0


def test_a_damped_oscillator_follows_its_formula() -> None:
    system = pd.System()
    system.body("mass", 2.0, position=0.1)
    system.spring("mass", stiffness=200.0, damping=4.0)
    motion = system.simulate(3.0)
    t = np.linspace(0.0, 3.0, 50)
    w = sqrt(100.0 - 1.0)
    expected = 0.1 * np.exp(-t) * (np.cos(w * t) + np.sin(w * t) / w)
    assert np.abs(motion["mass"].position(t) - expected).max() < 1e-15
    assert motion["mass"].velocity(0.0) == 0.0
    assert motion.events == ()


def test_a_free_body_slides_to_rest() -> None:
    system = pd.System()
    box = system.body("box", "2 kg", velocity="3 m/s")
    system.contact(box, kinetic="4 N", static="5 N")
    motion = system.simulate()
    assert motion.rests
    assert motion.events[0].time == pytest.approx(1.5, rel=1e-15)
    assert motion[box].position(motion.duration) == pytest.approx(2.25, rel=1e-15)
    assert motion.energy.contacts == pytest.approx(9.0, rel=1e-14)
    assert repr(motion) == "<SystemMotion of 1 body over 1.875 s, 1 event, at rest, ok>"


def test_a_support_that_moves_carries_a_body() -> None:
    """A belt takes a box along once friction has made their velocities equal."""
    system = pd.System()
    system.body("box", 1.0)
    system.contact("box", kinetic=2.0, velocity=pd.Profile([0.0, 1.0], [0.5, 1.0]))
    motion = system.simulate(2.0)
    stick = motion.contact("box", "ground").events[0]
    assert (stick.kind, stick.before) == ("stick", -1)
    assert stick.time == pytest.approx(1.0 / 3.0, rel=1e-14)
    assert motion["box"].velocity(2.0) == pytest.approx(1.0, rel=1e-14)


def test_a_prescribed_motion_is_positions_or_velocities() -> None:
    """A stroke given as velocity is integrated; a swing in mm is a position."""
    found = []
    for given in (pd.Profile([0.0, 1.0], ["0 mm", "40 mm"]), pd.Profile([0.0], ["40 mm/s"])):
        system = pd.System()
        system.body("a", 0.1)
        system.spring("a", given, stiffness=50.0, damping=1.0)
        found.append(system.simulate(0.9)["a"].position(0.9))
    assert found[0] == pytest.approx(found[1], rel=1e-14)
    system = pd.System()
    system.body("a", 0.1)
    system.spring("a", pd.harmonic(0, "1 mm", "2 Hz"), stiffness=4e6, damping=200.0)
    motion = system.simulate(0.2)
    assert motion["a"].position(0.125) == pytest.approx(1e-3, rel=1e-3)
    assert motion.spring("a-ground").elongation(0.125) == pytest.approx(0.0, abs=1e-6)


def test_the_integral_of_every_function_is_a_motion() -> None:
    """Exponentials, sinusoids, strokes and rows, against the sum of trapezes."""
    from pindrive.bodies.inputs import integrated

    given = (
        pd.exponential("20 mm/s", "60 mm/s", "50 ms", "0.1 s"),
        pd.harmonic("10 mm/s", "30 mm/s", "3 Hz", 0.4),
        pd.minimum_jerk("60 mm", "0.3 s", "0.1 s"),
        pd.Profile([0.05, 0.2, 0.3], ["0 mm/s", "60 mm/s", "10 mm/s"]),
        pd.harmonic("0 mm/s", "1 mm/s", "2 Hz").then(0.2, "3 mm/s"),
    )
    t = np.linspace(0.0, 0.5, 20001)
    for velocity in given:
        position = integrated(velocity)
        values = np.asarray(velocity(t))
        trapezes = np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2 * np.diff(t))])
        assert np.abs(np.asarray(position(t)) - trapezes).max() < 5e-8
        assert position(0.0) == pytest.approx(0.0, abs=1e-18)


def test_permuted_mirrored_and_rescaled_systems_move_alike() -> None:
    def built(order: list[int], sign: float, scale: float) -> SystemMotion:
        system = pd.System()
        masses = (0.5, 0.01, 0.02)
        for i in order:
            system.body(f"b{i}", masses[i] * scale, velocity=sign * 0.1 * i)
        for i in sorted(order, key=lambda j: -j):
            system.spring(f"b{i}", f"b{i - 1}" if i else "ground", stiffness=80 * scale)
        for i in order:
            stiffness = inf if i == 0 else 300 * scale
            damping = 0.0 if i == 0 else 0.2 * scale
            system.contact(
                f"b{i}",
                f"b{i - 1}" if i else "ground",
                kinetic=0.02 * scale,
                static=0.03 * scale,
                stiffness=stiffness,
                damping=damping,
            )
        return system.simulate(0.4)

    t = np.linspace(0.0, 0.4, 41)
    usual = built([0, 1, 2], 1.0, 1.0)
    assert len(usual.events) > 5
    for other, sign in (
        (built([2, 0, 1], 1.0, 1.0), 1.0),
        (built([0, 1, 2], -1.0, 1.0), -1.0),
        (built([0, 1, 2], 1.0, 1024.0), 1.0),
    ):
        for name in ("b0", "b1", "b2"):
            off = other[name].position(t) * sign - usual[name].position(t)
            assert np.abs(off).max() < 1e-14


def test_a_motion_cut_in_two_goes_on_as_the_whole() -> None:
    def built() -> pd.System:
        system = pd.System()
        for i in range(3):
            name, other = f"b{i}", f"b{i - 1}" if i else "ground"
            system.body(name, 0.01 * (i + 1), velocity=0.1 * i)
            system.spring(name, other, stiffness=80)
            system.contact(name, other, kinetic=0.02, stiffness=300, damping=0.2)
        return system

    whole, first, system = built().simulate(0.4), built().simulate(0.15), built()
    for name in system.bodies:
        system.initial(name, first[name].position(0.15), first[name].velocity(0.15))
    stretches = {
        f"contact.{name}.stretch": first.contact(name).stretch(0.15) for name in system.contacts
    }
    second = system.with_values(stretches).simulate(0.25)
    assert len(first.events) > 3
    assert len(whole.events) == len(first.events) + len(second.events)
    for name in system.bodies:
        assert second[name].position(0.25) == pytest.approx(whole[name].position(0.4), rel=1e-12)


def test_a_hand_gives_way_to_its_pins() -> None:
    """Figures of docs/bodies.md."""
    motion = hand_and_pins().simulate(duration=2)
    t = np.linspace(0.0, 2.0, 2001)
    alone = hand_and_pins(1).simulate(duration=2)
    assert motion["hand"].velocity(0.38) < alone["hand"].velocity(0.38) < 0.16
    assert motion.certificate().worst < 1e-12
    assert abs(motion.energy.residual) < 1e-15
    assert np.abs(motion["pin 2"].position(t) - motion["hand"].position(t)).max() < 5e-3
    assert len(motion.contact("pin 0", "hand").events) == 6


def test_derivatives_are_those_of_neighbours() -> None:
    motion = hand_and_pins(2).simulate(0.5)
    keys = ["hand.mass", "spring.hand-ground.motion.distance", "pin 0.force.amplitude"]
    keys += ["contact.pin 0-hand.kinetic", "contact.pin 1-hand.damping", "pin 0.position"]
    found = motion.sensitivity(keys)
    assert found.status == pd.Status.ok, found.gaps
    t = np.linspace(0.0, 0.5, 26)
    for i, key in enumerate(found.parameters):
        value = motion.system.inputs()[key]
        step = 1e-5 * value
        ends = [
            motion.system.with_values({key: value + h}).simulate(0.5)["pin 0"].position(t)
            for h in (step, -step)
        ]
        difference = (ends[0] - ends[1]) / (2.0 * step)
        size = np.abs(difference).max()
        assert np.abs(found.position("pin 0", t)[i] - difference).max() < 1e-4 * size
    assert np.isfinite(found.event_times).all()
    assert found.event_times.shape == (len(keys), len(motion.events))


def test_a_derivative_ends_where_a_neighbour_has_other_events() -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.force("a", 1.0)
    system.contact("a", kinetic=0.5, static=1.0)  # at the limit: a little more, and it slips
    found = system.simulate(1.0).sensitivity(["a.force"])
    assert found.status == pd.Status.incomplete
    assert "greater" in found.gaps["body.a.force"]
    assert np.isnan(found.position("a", 0.5))


def test_two_contacts_in_line_share_friction_by_their_static_friction() -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.force("a", 3.0)
    system.contact("a", kinetic=2.0, name="strong")
    system.contact("a", kinetic=4.0, name="stronger")
    motion = system.simulate(1.0)
    assert motion.rests
    assert motion.contact("strong").force(0.5) == pytest.approx(-1.0)
    assert motion.contact("stronger").force(0.5) == pytest.approx(-2.0)


def test_a_motion_is_pickled_and_printed() -> None:
    motion = hand_and_pins(1).simulate(0.3)
    again = pickle.loads(pickle.dumps(motion))
    assert again.system == motion.system
    assert again["hand"].position(0.3) == motion["hand"].position(0.3)
    assert repr(motion["hand"]) == "<BodyMotion 'hand'>"
    assert repr(motion.system) == "<System of 2 bodies, 2 springs and 2 contacts>"


def test_numbers_extremes_and_dataset() -> None:
    system = pd.System()
    system.body("a", 1.0, position=0.2)
    system.spring("a", stiffness=4.0 * pi**2)
    motion = system.simulate(0.75)
    numbers = motion.numbers()
    assert numbers["body.a.largest"] == pytest.approx(0.2)
    assert numbers["body.a.least"] == pytest.approx(-0.2, rel=1e-14)
    data = hand_and_pins(2).simulate(0.5).to_dataset(np.linspace(0.0, 0.5, 11))
    assert dict(data.sizes) == {
        **{"body": 3, "time": 11, "contact": 4, "spring": 3},
        "event": data.sizes["event"],
    }
    assert data.position.sel(body="hand").attrs["units"] == "m"
    assert data.attrs["body.pin 1.mass"] == 0.001


def test_to_csv_writes_samples_and_events(tmp_path: object) -> None:
    from pathlib import Path

    folder = Path(str(tmp_path))
    events = hand_and_pins(1).simulate(0.3).to_csv(folder / "m.csv", rate="1 kHz")
    head, *rows = (folder / "m.csv").read_text("utf-8").splitlines()
    assert head.startswith("time [s],body.hand.position [m]")
    assert len(rows) == 301
    assert events.read_text("utf-8").splitlines()[0] == "time [s],contact,kind,before,after"


def test_a_figure_shows_bodies_and_contacts() -> None:
    figure = hand_and_pins(8).simulate(0.5).plot()
    labels = [axes.get_label() for axes in figure.axes]
    assert labels == ["position", "velocity", "contacts"]
    drawn = {line.get_gid() for line in figure.axes[0].lines}
    assert {"body hand", "body pin 7"} <= drawn


def test_a_ball_bounces_and_comes_to_rest() -> None:
    """Each flight is shorter by the restitution; their sum is known."""
    fall = (2.0 / 9.81) ** 0.5
    system = pd.System()
    ball = system.body("ball", "10 g", position="1 m")
    system.force(ball, -0.0981)
    system.stop(ball, lower=0, restitution=0.6)
    motion = system.simulate(3)
    times = [event.time for event in motion.stop("ball-ground").events]
    flights = np.diff(times)
    assert times[0] == pytest.approx(fall, rel=1e-15)
    assert np.allclose(flights[1:12] / flights[:11], 0.6, rtol=1e-9)
    assert times[-1] == pytest.approx(fall * (1 + 2 * 0.6 / 0.4), rel=1e-11)
    assert motion.rests
    assert motion.stop(ball, "ground").force(2.9) == pytest.approx(0.0981, rel=1e-12)
    assert motion.energy.stops == pytest.approx(0.0981, rel=1e-12)
    assert motion.certificate().worst < 1e-14
    key = "stop.ball-ground.restitution"
    found = motion.sensitivity([key]).position(ball, 1.2)
    ends = [
        system.with_values({key: 0.6 + h}).simulate(3)[ball].position(1.2) for h in (1e-6, -1e-6)
    ]
    assert found[0] == pytest.approx((ends[0] - ends[1]) / 2e-6, rel=1e-7)


def test_balls_in_a_row_hand_on_their_momentum() -> None:
    system = pd.System()
    for i in range(4):
        system.body(f"ball {i}", 1.0, position=0.0 if i else -1.0, velocity=0.0 if i else 1.0)
    for i in range(3):
        system.stop(f"ball {i + 1}", f"ball {i}", lower=0, restitution=1)
    motion = system.simulate(3)
    ends = [motion[f"ball {i}"].velocity(3.0) for i in range(4)]
    assert ends == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-15)


def test_an_elastic_stop_pushes_and_never_pulls() -> None:
    system = pd.System()
    cart, wall = system.body("cart", 1.0, velocity=1.0), "ground"
    system.stop(cart, wall, upper=0.5, stiffness="10 kN/m", damping="30 N*s/m")
    motion = system.simulate(2)
    met, left = motion.stop(cart, wall).events
    assert (met.kind, left.kind) == ("stop", "leave")
    t = np.linspace(met.time, left.time, 200)
    force = np.asarray(motion.stop(cart, wall).force(t, "left"))[1:]
    assert (force <= 1e-9).all()
    assert motion[cart].position(left.time) > 0.5  # the damper lets the wall come back later
    assert -1.0 < motion[cart].velocity(2.0) < -0.6
    assert motion.energy.stops == pytest.approx(0.5 - 0.5 * motion[cart].velocity(2.0) ** 2)


def test_a_system_is_pushed_against_a_rigid_stop() -> None:
    """Friction holds no impulse; a stop and a contact share what presses the body."""
    system = pd.System()
    box = system.body("box", 1.0)
    system.force(box, 5.0)
    system.contact(box, kinetic=2.0, static=3.0)
    system.stop(box, upper="0.5 m", restitution=0.3)
    motion = system.simulate()
    assert motion.rests
    assert motion[box].position(motion.duration) == pytest.approx(0.5)
    force = motion.contact(box, "ground").force(motion.duration)
    assert force + motion.stop(box, "ground").force(motion.duration) == pytest.approx(-5.0)
    data = motion.to_dataset([0.1])
    assert data.stop_force.dims == ("stop", "time")
    assert motion.numbers()["stop.box-ground.events"] > 3


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda s: s.body("a", 1), "the name of a body must be none of a, got"),
        (lambda s: s.body("b.c", 1), 'text without a dot, and not "ground"'),
        (lambda s: s.body("b", 0), "body.b.mass must be finite and greater than 0 kg, got 0.0 kg"),
        (lambda s: s.body("b", "3 mN"), "body.b.mass must be in kg or a unit alike"),
        (lambda s: s.spring("c"), "unknown body c; there are a"),
        (lambda s: s.spring("a", "a"), "the second body must be another one"),
        (lambda s: s.spring("a", stiffness=-1), "spring.a-ground 2.stiffness must be"),
        (lambda s: s.contact("a", kinetic=2, static=1), "must be at least kinetic (2.0 N)"),
        (lambda s: s.contact("a", kinetic=2, damping=1), "must be 0 of a rigid contact"),
        (
            lambda s: s.contact("a", kinetic=2, stiffness=10, stretch=1),
            "at most what the skin holds, 0.2 m",
        ),
        (
            lambda s: s.contact("a", kinetic=2, velocity=pd.Profile([0, 1, 1], [0, 0, 1])),
            "without a step",
        ),
        (
            lambda s: s.spring("a", damping=1, length=pd.Profile([0, 1, 1], [0, 0, 1])),
            "without a step",
        ),
        (lambda s: s.force("a", pd.harmonic(0, "1 mm/s", 2)), "numbers in N, got values in m/s"),
        (
            lambda s: s.with_values({"a.mas": 2}),
            "unknown parameter a.mas; did you mean body.a.mass",
        ),
        (lambda s: s.stop("a"), "stop.a-ground must be given with lower, upper or both"),
        (lambda s: s.stop("a", lower=1, upper=0), "upper must be greater than lower (1.0 m)"),
        (lambda s: s.stop("a", lower=0, restitution=2), "restitution must be"),
        (lambda s: s.stop("a", lower=0, damping=1), "damping must be 0 of a rigid stop"),
        (
            lambda s: (s.stop("a", lower=1), s.simulate(1)),
            "the position of a must be within 1.0 m at t = 0",
        ),
        (lambda s: s.simulate(0), "duration must be"),
        (lambda s: s.simulate(), "duration must be given, as the motion neither rests nor repeats"),
    ],
)
def test_a_value_is_refused_in_a_line(build: object, words: str) -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.spring("a", stiffness=10.0)
    system.force("a", 1.0)
    with pytest.raises(ValueError) as error:
        build(system)  # type: ignore[operator]
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_load_that_becomes_negative_is_refused() -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.contact("a", kinetic=1.0, load=pd.harmonic(1.0, 2.0, 1.0))
    with pytest.raises(ValueError, match=r"contact\.a-ground\.load must be >= 0"):
        system.simulate(2.0)


def test_a_motion_names_contacts_whose_friction_is_not_unique() -> None:
    """Two surfaces hold a body; a third contact holds another one alone."""
    system = pd.System()
    for body in ("a", "b"):
        system.body(body, 1.0)
    system.spring("a", "b", stiffness=10)
    system.contact("a", kinetic=1.0, static=1.5, name="one")
    system.contact("a", kinetic=0.5, name="other")
    system.contact("b", kinetic=1.0, name="alone")
    motion = system.simulate(1.0)
    assert motion.shared == ("one", "other")
    assert motion.contact("one").force(0.5) == 0.0
    pushed = system.with_values({"a.force": 1.2}).simulate(1.0)
    parts = [pushed.contact(name).force(0.5) for name in ("one", "other")]
    assert parts == pytest.approx([-0.9, -0.3], rel=1e-14)
    single = pd.System()
    single.body("a", 1.0)
    single.contact("a", kinetic=1.0)
    assert single.simulate(1.0).shared == ()
    between_stops = pd.System()
    between_stops.body("a", 1.0)
    between_stops.force("a", 5.0)
    between_stops.stop("a", upper=0.0)
    between_stops.contact("a", kinetic=1.0)
    assert between_stops.simulate(1.0).shared == ("a-ground",)

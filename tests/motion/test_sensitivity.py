"""Exact derivatives against closed forms, against differences of two motions, and their limits."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import inf, isfinite, isnan, nan
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings

from core import test_oracle
from drives import Case, cases
from oracle import make_cases, mp_oracle
from pindrive import Contact, Drive, Motion, Profile, Release, simulate
from pindrive.quantities.table import QUANTITIES

PIN = {"mass": 0.01, "stiffness": 100.0, "damping": 0.4}


PLATE, FINGER = Contact(0.02), Contact(0.005)


def pin(plate: Contact = PLATE, finger: Contact = FINGER, **changed: float) -> Drive:
    return Drive(**(PIN | changed), plate=plate, finger=finger)


# ---- against closed forms that share no code -----------------------------------------------------


def sliding(t: Any, m: Any, k: Any, b: Any, force: Any, v0: Any, x0: Any) -> Any:
    """x(t) of a pin that the plate's friction pushes all the time, by eq. (3)."""
    alpha, rest = -b / (2 * m), force / k
    omega = mp.sqrt(k / m - alpha**2)
    sine = (v0 - alpha * (x0 - rest)) / omega
    wave = (x0 - rest) * mp.cos(omega * t) + sine * mp.sin(omega * t)
    return rest + mp.exp(alpha * t) * wave


def peak_time(m: Any, k: Any, b: Any, force: Any, v0: Any, x0: Any) -> Any:
    """Return the time of the first zero of the velocity, by eq. (13)."""
    alpha = -b / (2 * m)
    omega = mp.sqrt(k / m - alpha**2)
    return mp.atan2(v0 * omega, k / m * (x0 - force / k) - alpha * v0) / omega


def test_a_free_flight_against_its_closed_form() -> None:
    names = ["mass", "stiffness", "damping", "plate_kinetic", "mouse_velocity", "displacement"]
    motion = simulate(pin(finger=Contact(0.0)), Release(0.1, 1.5e-3))
    sensitivity = motion.sensitivity(names)
    assert not sensitivity.gaps
    with mp.workdps(40):
        at = [mp.mpf(p) for p in (0.01, 100.0, 0.4, 0.02, 0.1, 1.5e-3)]

        for i, name in enumerate(names):
            along = tuple(int(j == i) for j in range(len(at)))
            for t in (0.003, 0.02):
                expected = mp.diff(lambda *p, t=t: sliding(t, *p), tuple(at), along)
                assert sensitivity.position(t)[i] == pytest.approx(float(expected), rel=1e-12)
            expected = mp.diff(peak_time, tuple(at), along)
            found = sensitivity.numbers["transient.peak_time"][name]
            assert found == pytest.approx(float(expected), rel=1e-10, abs=1e-14)


def test_a_pin_that_is_carried_moves_with_the_plate() -> None:
    drive = pin(plate=Contact(0.1, 0.3))
    motion = simulate(drive, Release(0.1, 0.0))
    slope = motion.sensitivity(["mouse_velocity", "plate_static", "plate_kinetic"])
    assert slope.position([0.0, 0.01]) == pytest.approx(np.array([[0, 0.01], [0, 0], [0, 0]]))
    # It breaks loose where k v t + b v + F_finger = F_static.
    (release, *_) = motion.events
    assert slope.event_times[0, 0] == pytest.approx(-release.time / 0.1 - 0.4 / (100 * 0.1))
    assert slope.event_times[1, 0] == pytest.approx(1 / (100 * 0.1))
    assert slope.event_times[2, 0] == 0.0


PARAMETERS = ("mass", "stiffness", "damping", "plate_kinetic", "finger_kinetic", "displacement")
CASES = make_cases.load(Path(make_cases.__file__).parent / "cases.json.gz")["cases"]


@pytest.mark.parametrize("number", [i for i, c in enumerate(CASES) if len(c["events"]) > 1][::19])
def test_against_the_forty_digit_oracle(number: int) -> None:
    """Differences of two answers of forty digits, close enough for twelve digits of the slope."""
    case = CASES[number]
    at = case["inputs"]
    name = [p for p in PARAMETERS if at[p]][number % sum(1 for p in PARAMETERS if at[p])]
    pin_at, step = make_cases.pin_of(case), mp.mpf("1e-15") * abs(at[name])
    tied = {name}
    if name.endswith("kinetic") and at[name] == at[name.replace("kinetic", "static")]:
        tied.add(name.replace("kinetic", "static"))

    def solved(sign: int) -> mp_oracle.Path:
        moved: dict[str, Any] = {p: mp.mpf(getattr(pin_at, p)) + sign * step for p in tied}
        return mp_oracle.solve(replace(pin_at, **moved), case["duration"])

    motion = test_oracle.release(case)
    sensitivity = motion.sensitivity([name])
    up, down = solved(1), solved(-1)
    times = np.array(case["times"])
    expected = [float((up.state(t)[0] - down.state(t)[0]) / (2 * step)) for t in times]
    largest = max(*map(abs, expected), *np.abs(case["x"]) / abs(at[name]))
    found = sensitivity.position(times)[0]
    away = [min([abs(t - e.time) for e in up.events], default=1.0) > 1e-9 for t in times]
    assert not np.isnan(found).any()
    assert found[away] == pytest.approx(np.array(expected)[away], rel=1e-9, abs=1e-11 * largest)
    assert len(up.events) == len(down.events) > 1
    if motion.ending.cycle is None:  # of a cycle, the motion tells one round
        assert sensitivity.event_times[0] == pytest.approx(
            [
                float((a.time - b.time) / (2 * step))
                for a, b in zip(up.events, down.events, strict=True)
            ],
            rel=1e-9,
            abs=1e-11 * case["duration"] / abs(at[name]),
        )


# ---- against differences of two motions ----------------------------------------------------------


def changed(case: Case, name: str, by: float) -> Motion:
    """The motion with one parameter changed."""
    drive = case.drive
    if name in PIN:
        other: dict[str, Any] = {name: getattr(drive, name) + by}
        return Case(replace(drive, **other), case.release).run(0.5)
    if name in ("mouse_velocity", "displacement"):
        moved: dict[str, Any] = {name: getattr(case.release, name) + by}
        return Case(drive, replace(case.release, **moved)).run(0.5)
    side, which = name.split("_")
    contact = getattr(drive, side)
    tied = contact.static_friction == contact.kinetic
    new = Contact(contact.kinetic + by, contact.static_friction + (by if tied else 0.0))
    assert which == "kinetic"
    rubbed: dict[str, Any] = {side: new}
    return Case(replace(drive, **rubbed), case.release).run(0.5)


def quantities(motion: Motion, times: np.ndarray) -> np.ndarray:
    """Positions, then all numbers that have a derivative."""
    numbers = motion.numbers()
    del numbers["energy.residual"], numbers["transient.settled"]
    # A band this narrow has few digits, and its derivative none.
    if not abs(motion.release.displacement - motion.ending.position) > 1e-5 * abs(
        motion.release.displacement
    ):
        numbers["transient.settling_time"] = nan
    # Of a turn where next to nothing is left of the wave, the time has few digits too.
    if abs(motion.transient.trough_displacement) < 1e-9 * abs(motion.release.displacement):
        numbers["transient.trough_time"] = nan
    all_of_them = np.array([*motion.position(times), *numbers.values()])
    return np.where(np.isfinite(all_of_them), all_of_them, np.nan)


def course_of(motion: Motion) -> list[object]:
    return [(s.mode, s.plate, s.finger) for s in motion.segments] + [
        (e.contact, e.kind) for e in motion.events
    ]


@given(cases())
@settings(max_examples=40)
def test_random_motions_against_differences(case: Case) -> None:
    values = {
        "mass": case.drive.mass,
        "stiffness": case.drive.stiffness,
        "damping": case.drive.damping,
        "plate_kinetic": case.drive.plate.kinetic,
        "finger_kinetic": case.drive.finger.kinetic,
        "mouse_velocity": case.mouse_velocity,
        "displacement": case.release.displacement,
    }
    for side, contact in (("plate", case.drive.plate), ("finger", case.drive.finger)):
        if contact.kinetic < contact.static_friction < contact.kinetic * (1 + 1e-5):
            del values[f"{side}_kinetic"]  # the differences would lift it above static friction
    names = [name for name, value in values.items() if abs(value) > 1e-6]
    motion = case.run(0.5)
    sensitivity = motion.sensitivity(names)
    times = np.linspace(0.0, min(0.5, motion.duration), 9)
    positions = sensitivity.position(times)
    at = quantities(motion, times)
    units = [QUANTITIES[name].unit for name in sensitivity.numbers]
    timed = np.array([False] * len(times) + [unit == "s" for unit in units])
    events = np.array([e.time for e in motion.events])
    fastest = float(np.abs(motion.velocity(motion.sample_times())).max())
    left = np.abs(motion.acceleration(events, "left"))
    faintest = float(left[left > 0.0].min()) if left.any() else 1.0  # a plate sets it free at 0
    for i, name in enumerate(names):
        found = np.array([*positions[i], *(n[name] for n in sensitivity.numbers.values())])
        step = 1e-6 * abs(values[name])
        around = [changed(case, name, by) for by in (step, -step, step / 4, -step / 4)]
        if any(course_of(m) != course_of(motion) for m in around):
            continue
        up, down, near_up, near_down = (quantities(m, times) for m in around)
        wide, narrow = (up - down) / (2 * step), (near_up - near_down) / (step / 2)
        size = np.maximum(np.abs(at), 1e-15)  # less is what has died away
        size[: len(times)] = max(1e-15, np.abs(at[: len(times)]).max())
        rounding = 1e-15 * np.abs(at[: len(times)]).max() / step  # of two positions
        near = rounding + 1e-4 * np.maximum(np.abs(narrow), size / abs(values[name]))
        bent = near_up + near_down - 2 * at
        # A root moves by -dG / G', where G is as much as fastest / value, with its rounding, and G'
        # is the acceleration that is left: so a time near which the motion has died away moves.
        near[timed] += 64 * np.finfo(float).eps * fastest / abs(values[name]) / faintest
        # Where two differences agree, and both sides do, the derivative is theirs.
        tells = (np.abs(wide - narrow) <= near / 4) & (np.abs(bent) <= step * near)
        tells &= np.isfinite(found)
        assert np.all(np.abs(found - narrow)[tells] <= near[tells])


CURVED = pin(
    plate=Contact(curve=[(0.0, 0.022), (0.05, 0.015), (0.1, 0.016)], static=0.0265),
    finger=Contact(0.02, 0.03, stiffness=1000.0),
)
BRAKING = Profile([0.0, 0.05, 0.1], [0.06, 0.05, 0.0])


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("plate_curve[0].force", (CURVED, 0.022)),
        ("plate_curve[1].force", (CURVED, 0.015)),
        ("plate_curve[1].speed", (CURVED, 0.05)),
        ("plate_curve[2].speed", (CURVED, 0.1)),
        ("finger_stiffness", (CURVED, 1000.0)),
        ("finger.static", (CURVED, 0.03)),
        ("mouse_velocity[0].value", (CURVED, 0.06)),
        ("mouse_velocity[1].value", (CURVED, 0.05)),
        ("mouse_velocity[1].time", (CURVED, 0.05)),
        ("mouse_velocity[2].value", (CURVED, 0.06)),
        ("mouse_velocity[2].time", (CURVED, 0.1)),
        ("mouse_velocity", (CURVED, 0.06)),
    ],
)
def test_rows_and_skin_against_differences(name: str, given: tuple[Drive, float]) -> None:
    def run(by: float) -> Motion:
        rows = [list(row) for row in CURVED.plate.curve or ()]
        times, values = list(BRAKING.times), list(BRAKING.values)
        stiffness, static = 1000.0, 0.03
        table, _, rest = name.partition("[")
        if table == "plate_curve":
            rows[int(rest[0])][rest.endswith("force")] += by
        elif rest:
            (values if rest.endswith("value") else times)[int(rest[0])] += by
        elif name == "mouse_velocity":
            values = [v + by for v in values]
        elif name == "finger_stiffness":
            stiffness += by
        else:
            static += by
        drive = replace(
            CURVED,
            plate=Contact(curve=[(u, f) for u, f in rows], static=0.0265),
            finger=Contact(0.02, static, stiffness=stiffness),
        )
        return simulate(drive, Release(Profile(times, values), 2e-3))

    step = 1e-6 * given[1]
    motion, up, down = run(0.0), run(step), run(-step)
    sensitivity = motion.sensitivity([name])
    # A hand that comes to rest, or not quite, ends the motion in another way.
    assert ["ending" in gap for gap in sensitivity.gaps.values()] == [True] * (
        name in ("mouse_velocity", "mouse_velocity[2].value")
    )
    t = np.linspace(0.001, 0.15, 12)
    for found, one, other in (
        (sensitivity.position(t)[0], up.position(t), down.position(t)),
        (sensitivity.velocity(t)[0], up.velocity(t), down.velocity(t)),
        (sensitivity.stretch(t)[0], up.stretch(t), down.stretch(t)),
    ):
        central = (one - other) / (2 * step)
        np.testing.assert_allclose(found, central, rtol=1e-6, atol=1e-6 * np.abs(central).max())
    if sensitivity.gaps:
        return
    late, early = (np.array([e.time for e in m.events]) for m in (up, down))
    central = (late - early) / (2 * step)
    np.testing.assert_allclose(sensitivity.event_times[0], central, rtol=1e-5, atol=1e-9)
    settling = (up.transient.settling_time - down.transient.settling_time) / (2 * step)
    found = sensitivity.numbers["transient.settling_time"][name]
    assert found == pytest.approx(settling, rel=1e-4, abs=1e-9)


def test_a_row_at_the_end_of_a_plateau_against_differences() -> None:
    """The slope is zero there, its derivative is not."""

    def run(by: float) -> Motion:
        plate = Contact(curve=[(0.0, 0.02), (0.2, 0.02 + by), (0.4, 0.03)])
        drive = Drive(mass=0.01, stiffness=100.0, damping=0.1, plate=plate, finger=Contact(0.005))
        return simulate(drive, Release(0.05, 3e-3), duration=0.1)

    motion, up, down = run(0.0), run(1e-7), run(-1e-7)
    sensitivity = motion.sensitivity(["plate_curve[1].force"])
    assert sensitivity.gaps == {}
    t = np.linspace(0.01, 0.09, 9)
    central = (up.position(t) - down.position(t)) / 2e-7
    np.testing.assert_allclose(sensitivity.position(t)[0], central, rtol=1e-5)


# ---- where a derivative does not exist -----------------------------------------------------------


def test_a_start_at_the_plates_velocity_has_no_derivative_by_velocity_alone() -> None:
    motion = simulate(pin(), Release(0.1, 1.5e-3))
    sensitivity = motion.sensitivity(["velocity", "mouse_velocity"])
    assert list(sensitivity.gaps) == ["velocity"]
    assert "other events" in sensitivity.gaps["velocity"]
    assert np.isnan(sensitivity.position(0.01)[0])
    assert isfinite(sensitivity.position(0.01)[1])


def test_change_in_the_number_of_events_is_reported() -> None:
    """Bisected to where one more swing begins; before that swing the derivatives exist."""

    def run(displacement: float) -> Motion:
        return simulate(pin(), Release(0.1, displacement))

    low, high = 1.5e-3, 3e-3
    few = len(run(low).events)
    assert len(run(high).events) > few
    while (middle := (low + high) / 2) not in (low, high):
        low, high = (middle, high) if len(run(middle).events) == few else (low, middle)
    motion = run(low)
    last = motion.events[-1].time
    sensitivity = motion.sensitivity(["displacement"])
    assert "other events" in sensitivity.gaps["displacement"]
    assert np.isnan(sensitivity.position(last + 1e-6)).all()
    assert np.isfinite(sensitivity.position([0.0, last - 1e-3])).all()
    assert isnan(sensitivity.numbers["ending.position"]["displacement"])
    assert isfinite(sensitivity.numbers["transient.swing"]["displacement"])
    assert run(low * (1 - 1e-6)).sensitivity(["displacement"]).gaps == {}


def test_grazing_event_is_reported() -> None:
    """The plate moves exactly as fast as the pin ever comes: it touches that velocity."""

    def run(mouse_velocity: float) -> Motion:
        drive = pin(plate=Contact(0.02, 0.05), damping=0.2)
        return simulate(drive, Release(mouse_velocity, -2e-3, velocity=0.0))

    low, high = 0.01, 1.0
    while (middle := (low + high) / 2) not in (low, high):
        touches = any(e.contact == "plate" for e in run(middle).events)
        low, high = (middle, high) if touches else (low, middle)
    for mouse_velocity in (low, high):
        sensitivity = run(mouse_velocity).sensitivity(["mouse_velocity"])
        assert "other events" in sensitivity.gaps["mouse_velocity"]
        assert isfinite(sensitivity.position(0.001)[0])
        assert np.isnan(sensitivity.position(0.1)[0])


def test_a_settling_time_that_jumps_has_no_derivative() -> None:
    """At the jump an extremum touches the band; everything else has its derivative."""

    def settling(displacement: float) -> float:
        motion = simulate(pin(), Release(0.1, displacement))
        return motion.transient.settling_time

    low, high = 1.30e-3, 1.5e-3
    start = settling(low)
    assert abs(settling(high) - start) > 5e-3
    while (middle := (low + high) / 2) not in (low, high):
        near = abs(settling(middle) - settling(low)) < abs(settling(middle) - settling(high))
        low, high = (middle, high) if near else (low, middle)
    motion = simulate(pin(), Release(0.1, low))
    sensitivity = motion.sensitivity(["displacement"])
    assert sensitivity.gaps == {}
    assert isnan(sensitivity.numbers["transient.settling_time"]["displacement"])
    assert isfinite(sensitivity.numbers["ending.position"]["displacement"])


def test_without_damping_the_ending_changes_but_not_the_motion() -> None:
    drive = pin(plate=Contact(0.0), finger=Contact(0.0), damping=0.0)
    motion = simulate(drive, Release(0.1, 1e-3, velocity=0.0), duration=1.0)
    sensitivity = motion.sensitivity(["damping"])
    assert "ending" in sensitivity.gaps["damping"]
    # x = x0 cos ωt: by b it changes as x0 (sin ωt / ω - t cos ωt) / 2m.
    t, omega = 0.37, 100.0
    expected = 1e-3 * (np.sin(omega * t) / omega - t * np.cos(omega * t)) / 0.02
    assert sensitivity.position(t)[0] == pytest.approx(expected, rel=1e-12)
    assert isnan(sensitivity.numbers["ending.amplitude"]["damping"])


# ---- its face ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ("mass", "a list of names"),
        ([], "a list of names"),
        (["masss"], "one of mass, stiffness"),
        (["finger_stiffness"], "this motion was given"),
        (["skin_stretch"], "this motion was given"),
        (["plate_curve[0].force"], "one of 0 rows of plate_curve"),
        (["mouse_velocity[1].value"], "one of 1 row of mouse_velocity"),
    ],
)
def test_unknown_parameters_are_refused(parameters: Any, words: str) -> None:
    motion = simulate(pin(), Release(0.1, 1.5e-3))
    with pytest.raises(ValueError, match=words):
        motion.sensitivity(parameters)


def test_times_are_refused_as_by_the_motion() -> None:
    motion = simulate(pin(), Release(0.1, 1.5e-3))
    sensitivity = motion.sensitivity(["mass", "stiffness"])
    with pytest.raises(ValueError, match="t must be"):
        sensitivity.position(-1.0)
    assert sensitivity.position(np.zeros((3, 4))).shape == (2, 3, 4)
    assert sensitivity.position(1.0).shape == (2,)
    assert repr(sensitivity) == "<Sensitivity to mass, stiffness, ok>"
    assert sensitivity.gaps == {}
    assert set(sensitivity.numbers) < set(motion.numbers())


def test_a_motion_survives_pickling() -> None:
    motion = simulate(CURVED, Release(BRAKING, 2e-3))
    again = pickle.loads(pickle.dumps(motion))
    assert again.events == motion.events
    assert again.numbers() == pytest.approx(motion.numbers(), rel=0, nan_ok=True)
    assert again.release.velocity is None
    assert inf > again.duration == motion.duration

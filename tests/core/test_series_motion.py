"""Motions with a friction curve at a plate whose load changes, which has no closed form.

`oracle/series_motions.json.gz` holds random cases answered with thirty digits by
`oracle/mp_piecewise.py`; `oracle/explicit_piecewise.py` integrates the same physics with SciPy. The
laws need no oracle.
"""

from __future__ import annotations

from dataclasses import astuple
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from core import test_oracle_piecewise as piecewise
from oracle import explicit_piecewise, make_piecewise
from oracle.answers import STATE_TOLERANCE, TIME_TOLERANCE, Case, told_events
from pindrive import Contact, Drive, Motion, Profile, Release, simulate

DATA = make_piecewise.load(Path(__file__).parents[1] / "oracle" / "series_motions.json.gz")
CASES: list[Case] = DATA["cases"]
Rows = list[list[float]]

# Falls, rises and ends under a load that comes and goes, and over skin.
CURVE = [(0.0, 0.3), (0.05, 0.15), (0.3, 0.25)]
DRIVE = Drive(
    mass=0.01,
    stiffness=100.0,
    damping=0.4,
    plate=Contact(curve=CURVE, static=0.4),
    finger=Contact(0.02, 0.03, stiffness=500.0),
)
LOAD = Profile([0.0, 0.02, 0.05, 0.1], [1.0, 1.0, 0.1, 0.4])
RELEASE = Release(0.1, plate_load=LOAD)


@pytest.mark.parametrize("family", DATA["families"])
def test_core_gives_the_oracle_answers(family: str) -> None:
    found = []
    for case in (case for case in CASES if case["family"] == family):
        motion, times = piecewise.release(case), np.array(case["times"])
        states = {
            "x": motion.position(times),
            "v": motion.velocity(times),
            "a": motion.acceleration(times),
            "finger_force": motion.force("finger", times),
        }
        if "stretch" in case:
            states["stretch"] = motion.stretch(times)
        reported = told_events(motion)
        found += piecewise.deviations(case, reported, states, TIME_TOLERANCE, STATE_TOLERANCE)
    assert not found, "\n".join(found)


def test_enough_cases() -> None:
    """Most with a plate's curve that is sloped while its load changes."""
    assert len(CASES) == 90
    assert len(DATA["families"]) == 3

    def changes(rows: Rows) -> bool:
        return any(y != z for (_, y), (_, z) in pairwise(rows))

    pins = [case["inputs"] for case in CASES]
    assert sum(changes(pin["plate"]["curve"]) and changes(pin["load"]) for pin in pins) > 75
    assert sum(len(case["events"]) for case in CASES) > 700


@pytest.mark.parametrize("family", DATA["families"])
def test_explicit_modes_give_the_oracle_answers(family: str) -> None:
    cases = [case for case in CASES if case["family"] == family]
    case = min(cases, key=lambda case: case["inputs"]["finger"]["stiffness"] or 0.0)
    piecewise.check_live(case, explicit_piecewise, explicit_piecewise)


def test_laws() -> None:
    """The certificate, the ledger, dissipation, and the peaks against a fine grid."""
    for case in CASES:
        motion = piecewise.release(case)
        assert motion.certificate().worst < 1e-11
        ledger = motion.energy
        terms = [abs(term) for term in astuple(ledger)]
        assert abs(ledger.residual) < 1e-12 * max(terms)
        assert min(ledger.plate_dissipated, ledger.finger_dissipated) >= 0.0
        t = np.linspace(0.0, motion.duration, 2001)
        most = np.abs(motion.force("plate", t)).max()
        assert motion.transient.plate.peak_force >= most * (1 - 1e-12)
        for found, values in (
            (motion.extrema("position"), motion.position(t)),
            (motion.extrema("velocity"), motion.velocity(t)),
        ):
            size = np.abs(values).max()
            assert abs(found.value.max() - values.max()) < 1e-3 * size
            assert found.value.max() >= values.max() - 1e-13 * size
            assert found.value.min() <= values.min() + 1e-13 * size


def mirrored(case: Case) -> Case:
    pin = dict(case["inputs"])
    pin["mouse_velocity"] = [[t, -v] for t, v in pin["mouse_velocity"]]
    for name in ("displacement", "velocity", "skin_stretch"):
        pin[name] = None if pin[name] is None else -pin[name]
    return {**case, "inputs": pin}


def test_mirrored_release_gives_the_mirrored_motion() -> None:
    for case in CASES[::3]:
        one, other = piecewise.release(case), piecewise.release(mirrored(case))
        t = np.linspace(0.0, case["duration"], 101)
        assert np.array_equal(one.position(t), -other.position(t))
        assert np.array_equal(one.force("plate", t), -other.force("plate", t))
        assert [e.time for e in one.events] == [e.time for e in other.events]


def later(rows: Rows, cut: float) -> Rows:
    """Return the input from a time on, without a step there."""
    times, values = np.array(rows).T
    rest = [[t - cut, y] for t, y in rows if t > cut]
    return [[0.0, float(np.interp(cut, times, values))], *rest]


def test_cut_in_two_it_is_the_same_motion() -> None:
    for case in CASES[::3]:
        whole, pin = piecewise.release(case), case["inputs"]
        starts = [0.0, *(e.time for e in whole.events), case["duration"]]
        begin, end = max(pairwise(starts), key=lambda two: two[1] - two[0])
        cut = begin + 0.37 * (end - begin)
        segment = next((s for s in whole.segments if s.end > cut), None)
        if segment is None or segment.plate == 0:  # in a cycle; or it would have to stick at once
            continue
        if segment.finger in {-1, 1} and "stretch" in case:  # a given stretch is one that sticks
            continue
        at = np.array([cut])
        rest: Case = {name: later(pin[name], cut) for name in ("mouse_velocity", "load")}
        rest["displacement"] = float(whole.position(at)[0])
        rest["velocity"] = float(whole.velocity(at)[0])
        rest["skin_stretch"] = float(whole.stretch(at)[0]) if "stretch" in case else None
        second = piecewise.release(
            {"inputs": pin | rest, "duration": case["duration"] - cut, "family": "cut"}
        )
        t = np.linspace(cut, case["duration"], 51)
        scale = piecewise.scales(case)["x"]
        off = np.abs(second.position(t - cut) - whole.position(t)).max()
        assert off < 1e-9 * scale


@pytest.mark.parametrize(
    "name",
    ["mass", "plate_curve[1].force", "plate_load[2].value", "plate_load[2].time", "displacement"],
)
def test_derivatives_against_differences(name: str) -> None:
    def run(by: float) -> Motion:
        rows, mass, x = [list(row) for row in CURVE], 0.01, 1e-3
        times, values = list(LOAD.times), list(LOAD.values)
        if name == "mass":
            mass += by
        elif name == "displacement":
            x += by
        elif name.startswith("plate_curve"):
            rows[1][1] += by
        else:
            (times if name.endswith("time") else values)[2] += by
        drive = Drive(
            mass=mass,
            stiffness=100.0,
            damping=0.4,
            plate=Contact(curve=[(u, f) for u, f in rows], static=0.4),
            finger=DRIVE.finger,
        )
        return simulate(drive, Release(0.1, x, plate_load=Profile(times, values)), duration=0.12)

    given = {"mass": 0.01, "displacement": 1e-3, "plate_load[2].value": 0.1}.get(name, 0.1)
    step = 1e-6 * given
    motion, up, down = run(0.0), run(step), run(-step)
    sensitivity = motion.sensitivity([name])
    assert not sensitivity.gaps
    t = np.linspace(0.003, 0.119, 12)
    for found, one, other in (
        (sensitivity.position(t)[0], up.position(t), down.position(t)),
        (sensitivity.velocity(t)[0], up.velocity(t), down.velocity(t)),
    ):
        central = (one - other) / (2 * step)
        np.testing.assert_allclose(found, central, rtol=1e-5, atol=1e-6 * np.abs(central).max())
    late, early = (np.array([e.time for e in m.events]) for m in (up, down))
    central = (late - early) / (2 * step)
    np.testing.assert_allclose(sensitivity.event_times[0], central, rtol=1e-5, atol=1e-9)

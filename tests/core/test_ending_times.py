"""Settled, at rest, last event, steady: four times that a motion may end by, told apart."""

from __future__ import annotations

import json
from collections.abc import Callable
from math import inf, isinf, nan
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

from command import run
from drives import Case, cases
from pindrive import Contact, Drive, Motion, Profile, Release, simulate, simulate_batch

MASS, STIFFNESS = 0.01, 100.0
FREE = Contact(0.0)


def motion(
    damping: float,
    plate: Contact = FREE,
    finger: Contact = FREE,
    mouse_velocity: float = 0.1,
    duration: float | None = None,
) -> Motion:
    drive = Drive(mass=MASS, stiffness=STIFFNESS, damping=damping, plate=plate, finger=finger)
    return simulate(drive, Release(mouse_velocity, 1.5e-3), duration=duration)


# What a motion does, and its rest_time, last_event_time and steady_since: "event" for the time of
# its last one, "a time" for any that is finite and greater than 0.
CASES: dict[str, tuple[Callable[[], Motion], float | str, float | str, float | str]] = {
    "decays without an event": (lambda: motion(0.4), inf, 0.0, nan),
    "decays after events at the plate": (
        lambda: motion(0.1, Contact(0.02, 0.05)),
        inf,
        "event",
        nan,
    ),
    "rests": (lambda: motion(0.4, Contact(0.02), Contact(0.005)), "event", "event", nan),
    "free": (lambda: motion(0.0), inf, 0.0, 0.0),
    "grazing": (lambda: motion(0.0, Contact(0.02)), inf, "event", "event"),
    "stick-slip": (lambda: motion(0.1, Contact(0.02, 0.05), FREE, 0.02), inf, inf, "a time"),
    "not followed to its end": (
        lambda: motion(0.4, Contact(0.02), Contact(0.005), 0.1, 0.05),
        nan,
        nan,
        nan,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_three_times_of_each_ending(name: str) -> None:
    simulated, *expected = CASES[name]
    found = simulated()
    times = (
        found.transient.rest_time,
        found.transient.last_event_time,
        found.ending.steady_since,
    )
    for time, value in zip(times, expected, strict=True):
        if value == "event":
            assert time == found.events[-1].time > 0.0
        elif value == "a time":
            assert 0.0 < time < inf
        else:
            assert time == pytest.approx(value, nan_ok=True)


def test_a_pin_that_only_decays_is_never_at_rest() -> None:
    """Within 5 % after 607 ms; its last event was at 57 ms, and tells nothing of either."""
    found = motion(0.1, Contact(0.02, 0.05))
    assert found.transient.last_event_time < 0.5 * found.transient.settling_time
    assert isinf(found.transient.rest_time)
    assert found.velocity(found.duration) != 0.0


def test_rest_begins_before_the_rows_of_inputs_that_no_longer_matter() -> None:
    """A pin at rest on the finger stays so while the load of the plate changes by a little."""
    drive = Drive(
        mass=MASS, stiffness=STIFFNESS, damping=0.4, plate=Contact(0.001), finger=Contact(0.02)
    )
    alone = simulate(drive, Release(0.1, 1.5e-3))
    load = Profile([0.2, 0.3, 0.4], [1.0, 1.1, 1.0])
    found = simulate(drive, Release(0.1, 1.5e-3, plate_load=load))
    assert alone.ending.kind == found.ending.kind == "resting"
    assert found.segments[-1].begin == 0.4
    assert found.transient.rest_time == alone.transient.rest_time < 0.2
    assert np.ptp(found.position(np.linspace(found.transient.rest_time, 1.0, 99))) == 0.0


@given(cases())
def test_each_time_has_its_meaning(case: Case) -> None:
    found = case.run()
    rest, last = found.transient.rest_time, found.transient.last_event_time
    if isinf(last):
        assert found.ending.cycle in ("stick-slip", "limit cycle")
    else:
        assert last == (found.events[-1].time if found.events else 0.0)
    if found.ending.kind == "resting":
        assert (found.velocity(rest + np.linspace(0.0, 1.0, 33)) == 0.0).all()
        before = [segment.mode for segment in found.segments if segment.end <= rest]
        assert "resting" not in before[-1:]
    else:
        assert isinf(rest)


@given(cases())
def test_batch_has_the_times_of_single_motions(case: Case) -> None:
    drive, found = case.drive, case.run()
    velocity = found.release.initial_velocity
    table = simulate_batch(drive, case.release, velocity=velocity, threads=1)
    numbers = found.numbers()
    for name in ("transient.rest_time", "transient.last_event_time", "ending.steady_since"):
        value = float(table[name.replace(".", "_")])
        assert value == pytest.approx(numbers[name], rel=1e-11, nan_ok=True)
    assert "ending_since" not in table


DEVICE = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping = "{damping} N s/m"
[plate]
kinetic = "20 mN"
static = "{static} mN"
[finger]
kinetic = "{finger} mN"
[motion]
mouse_velocity = "100 mm/s"
displacement = "1.5 mm"
"""


@pytest.mark.usefixtures("in_empty_folder")
def test_command_line_separates_the_endings() -> None:
    Path("decays.toml").write_text(
        DEVICE.format(damping=0.1, static=50, finger=0), encoding="utf-8"
    )
    shown = run("simulate", "decays.toml", "-o", "d.json", "-o", "d.nc")
    last = CASES["decays after events at the plate"][0]().transient.last_event_time
    assert (
        "Decays towards x = 0.2000 mm and never comes to rest; "
        f"last event at {1e3 * last:.4g} ms." in shown.stdout
    )
    numbers = json.loads(Path("d.json").read_text("utf-8"))["numbers"]
    assert numbers["transient.rest_time"] == "Infinity"
    assert numbers["transient.last_event_time"] == last
    assert numbers["ending.steady_since"] is None
    Path("rests.toml").write_text(DEVICE.format(damping=0.4, static=20, finger=5), encoding="utf-8")
    shown = run("simulate", "rests.toml")
    assert f"since {1e3 * CASES['rests'][0]().transient.rest_time:.4g} ms." in shown.stdout


@pytest.mark.usefixtures("in_empty_folder")
def test_a_specification_of_rest_is_not_met_by_a_pin_that_only_decays() -> None:
    """The last event of all these motions is before 70 ms, and none comes to rest."""
    Path("device.toml").write_text(
        DEVICE.format(damping=0.1, static=50, finger=0), encoding="utf-8"
    )
    Path("study.toml").write_text(
        'base = "device.toml"\n[tolerances]\ndrive.mass = "10 %"\n'
        "[specification]\n"
        'rest_time = "<= 70 ms"\n'
        'last_event_time = "<= 70 ms"\n'
        'settling_time = "<= 70 ms"\n',
        encoding="utf-8",
    )
    shown = run("robustness", "study.toml", "--draws", "64").stdout
    met = {
        name: next(line for line in shown.splitlines() if f"{name} ≤ 70 ms" in line).split()[4]
        for name in ("rest_time", "last_event_time", "settling_time")
    }
    assert met == {"rest_time": "0.000", "last_event_time": "100.000", "settling_time": "0.000"}

"""Many drives at once: each point as `simulate` answers it alone, in any shape, by any threads."""

from __future__ import annotations

import signal
import sys
import threading
import time
from dataclasses import replace
from math import inf, nan
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from numpy.typing import NDArray

from drives import Case, cases
from pindrive import Contact, Drive, Motion, Release, Status, _core, simulate, simulate_batch
from pindrive.quantities.results import ENDING, ENERGY, TRANSIENT

ENDINGS = ("moving", "resting", "decaying", "free", "grazing", "stick_slip", "limit_cycle")
NUMBERS = {q.name: q.name.replace(".", "_") for q in (*TRANSIENT, *ENDING)}

# One drive that does a little of everything, for the tests of shapes and marks.
PIN: dict[str, Any] = {
    "mass": 0.010,
    "stiffness": 100.0,
    "damping": 0.40,
    "plate_kinetic": 0.020,
    "finger_kinetic": 0.005,
    "mouse_velocity": 0.10,
    "displacement": 1.5e-3,
}
DRIVE = Drive(
    mass=0.010, stiffness=100.0, damping=0.40, plate=Contact(0.020), finger=Contact(0.005)
)
RELEASE = Release(0.10, 1.5e-3)


def batch_of(**changes: Any) -> xr.Dataset:
    """That drive with some arguments changed."""
    return simulate_batch(DRIVE, RELEASE, **changes)


def drawn(count: int, seed: int) -> dict[str, Any]:
    """Ordinary drives, static friction and skin among them, some undamped or without friction."""
    rng = np.random.default_rng(seed)

    def or_zero(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(rng.random(count) < 0.25, 0.0, values)

    mass, stiffness = rng.uniform(2e-3, 20e-3, count), rng.uniform(20.0, 400.0, count)
    ratio = or_zero(rng.uniform(0.01, 1.5, count))
    plate, finger = or_zero(rng.uniform(5e-3, 0.1, count)), or_zero(rng.uniform(1e-3, 0.05, count))
    mouse = or_zero(rng.uniform(-0.3, 0.3, count) * rng.choice([1.0, 0.1], count))
    return {
        "mass": mass,
        "stiffness": stiffness,
        "damping": 2.0 * ratio * np.sqrt(mass * stiffness),
        "plate_kinetic": plate,
        "plate_static": plate * rng.choice([1.0, 1.3], count),
        "finger_kinetic": finger,
        "finger_static": finger * rng.choice([1.0, 1.5], count),
        "finger_stiffness": rng.choice([inf, inf, 1000.0], count),
        "mouse_velocity": mouse,
        "displacement": or_zero(rng.uniform(-3e-3, 3e-3, count)),
        "velocity": np.where(rng.random(count) < 0.5, mouse, rng.uniform(-0.3, 0.3, count)),
        "duration": rng.choice([0.05, 0.3, inf], count),
    }


def alone(point: dict[str, float]) -> Motion:
    """Return the point simulated alone."""
    duration = point.get("duration", inf)
    return simulate(
        Drive(
            mass=point["mass"],
            stiffness=point["stiffness"],
            damping=point["damping"],
            plate=Contact(point["plate_kinetic"], point.get("plate_static")),
            finger=Contact(
                point["finger_kinetic"],
                point.get("finger_static"),
                stiffness=point.get("finger_stiffness", inf),
            ),
        ),
        Release(point["mouse_velocity"], point["displacement"], velocity=point.get("velocity")),
        duration=None if duration == inf else duration,
    )


def meaning(flag: xr.DataArray) -> str:
    """Return the meaning of a flag's value, from its attributes."""
    meanings = flag.attrs["flag_meanings"].split()
    return str(dict(zip(flag.attrs["flag_values"].tolist(), meanings, strict=True))[flag.item()])


def assert_same(point: xr.Dataset, motion: Motion) -> None:
    # Plain releases go through the kernel, which rounds in another order than the core: an event
    # that comes about almost tangentially keeps half of its digits (kernel_test.cpp is stricter).
    numbers = motion.numbers()
    assert {k: point[v].item() for k, v in NUMBERS.items()} == pytest.approx(
        {k: numbers[k] for k in NUMBERS}, rel=1e-9, abs=1e-12, nan_ok=True
    )
    assert point.status == motion.status == Status.ok
    reported = meaning(point.ending)
    if motion.ending.kind == "steady":
        assert reported == str(motion.ending.cycle).replace("-", "_").replace(" ", "_")
    else:
        assert reported == motion.ending.kind
    assert point.events.item() == len(motion.events)
    assert point.duration.item() == pytest.approx(motion.duration, rel=1e-13)


# ---- the same as one at a time -------------------------------------------------------------------


def test_every_number_is_that_of_simulate() -> None:
    points = drawn(400, seed=6)
    batch = simulate_batch(DRIVE, RELEASE, **points)
    endings = set()
    for i in range(400):
        motion = alone({name: float(values[i]) for name, values in points.items()})
        if motion.status == Status.ok:
            one = batch.isel(dim_0=i)
            endings.add(meaning(one.ending))
            if "duration" in one.coords and one.duration == inf:
                one = one.drop_vars("duration").assign(duration=motion.duration)
            assert_same(one, motion)
    assert endings >= {"moving", "resting", "decaying", "free", "grazing", "stick_slip"}


def test_requested_energy_ledger_closes() -> None:
    points = drawn(200, seed=11)
    assert not any(
        str(name).startswith("energy") for name in simulate_batch(DRIVE, RELEASE, **points)
    )
    batch = simulate_batch(DRIVE, RELEASE, **points, energy=True)
    names = {q.name: q.name.replace(".", "_") for q in ENERGY}
    for i in range(200):
        motion = alone({name: float(values[i]) for name, values in points.items()})
        if motion.status == Status.ok:
            numbers, one = motion.numbers(), batch.isel(dim_0=i)
            assert {k: one[v].item() for k, v in names.items()} == {k: numbers[k] for k in names}
    terms = [batch[v] for v in names.values() if v != "energy_residual"]
    largest = np.max([np.abs(term) for term in terms], axis=0)
    assert float(abs(batch.energy_residual / largest).max()) < 1e-12
    bad = batch_of(mass=[-1.0, 0.01], energy=True)
    assert np.isnan(bad.energy_spring_start.values).tolist() == [True, False]


@given(cases())
def test_every_release_that_simulate_takes(case: Case) -> None:
    batch = simulate_batch(case.drive, case.release)
    assert_same(batch, case.run())


def test_the_results_do_not_depend_on_the_number_of_threads() -> None:
    points = drawn(1000, seed=7)
    one, *others = (simulate_batch(DRIVE, RELEASE, **points, threads=n) for n in (1, 2, 4))
    for other in others:
        assert one.identical(other)
        for name in one.data_vars:
            assert one[name].values.tobytes() == other[name].values.tobytes()


# ---- shapes --------------------------------------------------------------------------------------


def test_numbers_give_numbers() -> None:
    batch = batch_of()
    assert batch.sizes == {}
    assert_same(batch, alone(PIN))


def test_arrays_broadcast_as_in_numpy() -> None:
    friction = np.array([[0.0], [0.01], [0.02]])
    speed = np.array([0.05, 0.10])
    batch = batch_of(plate_kinetic=friction, mouse_velocity=speed)
    assert batch.sizes == {"plate_kinetic": 3, "mouse_velocity": 2}
    assert batch.plate_kinetic.dims == ("plate_kinetic",)
    assert batch.mouse_velocity.dims == ("mouse_velocity",)
    assert batch.mass.dims == ()
    for i in range(3):
        for j in range(2):
            point = {**PIN, "plate_kinetic": friction[i, 0], "mouse_velocity": speed[j]}
            assert_same(batch.isel(plate_kinetic=i, mouse_velocity=j), alone(point))


def test_arrays_of_any_layout_and_number_type() -> None:
    mass = np.linspace(2e-3, 20e-3, 24).reshape(4, 6)
    plain = batch_of(mass=np.ascontiguousarray(mass[::2, ::-3]))
    assert plain.identical(batch_of(mass=mass[::2, ::-3]))
    turned = batch_of(mass=np.asfortranarray(mass))
    assert turned.identical(batch_of(mass=mass))
    whole = batch_of(stiffness=[100, 200])
    assert whole.identical(batch_of(stiffness=[100.0, 200.0]))


def test_an_axis_of_one_is_kept() -> None:
    assert batch_of(mass=[0.01]).sizes == {"mass": 1}
    both = batch_of(mass=[[0.01]], damping=[0.1, 0.2])
    assert both.sizes == {"mass": 1, "damping": 2}


@pytest.mark.parametrize("shape", [(0,), (3, 0), (0, 1)])
def test_no_points_at_all(shape: tuple[int, ...]) -> None:
    batch = batch_of(mass=np.empty(shape))
    assert tuple(batch.sizes.values()) == shape
    assert batch.transient_settling_time.shape == shape


def test_dimensions_go_by_their_names() -> None:
    mass = xr.DataArray([0.005, 0.010, 0.020], dims="mass", coords={"mass": [0.005, 0.010, 0.020]})
    case = xr.DataArray([[0.05, 0.1], [0.2, 0.3]], dims=("hand", "pin"), coords={"pin": ["a", "b"]})
    friction = xr.DataArray([0.01, 0.03], dims="pin", coords={"pin": ["a", "b"]})
    batch = batch_of(mass=mass, mouse_velocity=case, plate_kinetic=friction)
    assert batch.sizes == {"mass": 3, "hand": 2, "pin": 2}
    one = batch.sel(mass=0.005, pin="b").isel(hand=1)
    point = {**PIN, "mass": 0.005, "mouse_velocity": 0.3, "plate_kinetic": 0.03}
    assert_same(one, alone(point))


# ---- bad points ----------------------------------------------------------------------------------

BAD = [
    ("mass", -0.01, "bad_mass"),
    ("mass", 0.0, "bad_mass"),
    ("mass", nan, "bad_mass"),
    ("stiffness", inf, "bad_stiffness"),
    ("damping", -1e-9, "bad_damping"),
    ("plate_kinetic", nan, "bad_plate_kinetic"),
    ("plate_static", 0.019, "bad_plate_static"),
    ("finger_kinetic", -0.1, "bad_finger_kinetic"),
    ("finger_static", 0.0, "bad_finger_static"),
    ("finger_stiffness", 0.0, "bad_finger_stiffness"),
    ("mouse_velocity", inf, "bad_mouse_velocity"),
    ("displacement", nan, "bad_displacement"),
    ("velocity", -inf, "bad_velocity"),
    ("duration", 0.0, "bad_duration"),
    ("mass", 1e-310, "bad_mass"),
    ("damping", 1e308, "bad_damping"),
    ("damping", 1e11, "bad_damping_ratio"),
    ("damping", 1e-15, "bad_damping_ratio"),
    ("duration", 1e11, "bad_phase"),
]


@pytest.mark.filterwarnings("ignore::pindrive.ImplausibleValueWarning")
@pytest.mark.parametrize(("name", "value", "reported"), BAD)
def test_a_bad_point_is_marked_and_the_others_go_on(name: str, value: float, reported: str) -> None:
    good = {**PIN, "plate_static": 0.03, "finger_static": 0.03, "finger_stiffness": 1e3}
    good |= {"velocity": 0.0, "duration": 0.2}
    point = good | {name: value}
    columns: dict[str, Any] = {k: [good[k], point[k], good[k]] for k in good}
    batch = simulate_batch(DRIVE, RELEASE, **columns)
    marked = batch.isel(dim_0=1)
    assert meaning(marked.status) == reported
    assert meaning(marked.ending) == "unknown"
    assert marked.events == 0
    for variable in NUMBERS.values():
        if variable != "transient_settled":
            assert np.isnan(marked[variable])
    assert not marked.transient_settled
    for i in (0, 2):
        assert_same(batch.isel(dim_0=i), alone(good))
    with pytest.raises(ValueError, match="must be"):
        alone(point)


def test_first_bad_argument_is_reported() -> None:
    batch = batch_of(displacement=[nan, 0.0], mass=[-1.0, 0.01])
    assert [meaning(status) for status in batch.status] == ["bad_mass", "ok"]


def test_every_variable_has_its_meaning_and_unit() -> None:
    batch = batch_of(energy=True)
    for column in batch.variables.values():
        assert column.attrs["long_name"]
    for quantity in (*TRANSIENT, *ENDING, *ENERGY):
        variable = batch[quantity.name.replace(".", "_")]
        assert variable.attrs.get("units", "") == quantity.unit
        assert variable.attrs.get("symbol", "") == quantity.symbol
    assert batch.mass.attrs["units"] == "kg"
    for name in ("status", "ending"):
        flags = batch[name].attrs
        assert flags["flag_values"].dtype == batch[name].dtype
        assert len(flags["flag_values"]) == len(flags["flag_meanings"].split())


# ---- refusals ------------------------------------------------------------------------------------


def test_damping_ratio_is_taken_in_place_of_damping() -> None:
    ratios, masses = np.array([0.1, 0.3]), np.array([0.01, 0.02])
    found = simulate_batch(DRIVE, RELEASE, damping_ratio=ratios, mass=masses)
    for i, (ratio, mass) in enumerate(zip(ratios, masses, strict=True)):
        drive = DRIVE.replace(damping_ratio=ratio, mass=mass)
        assert drive.damping_ratio == pytest.approx(ratio, rel=1e-15)
        expected = simulate(drive, RELEASE).transient.settling_time
        assert found.transient_settling_time[i] == pytest.approx(expected, rel=1e-12)
    refused = simulate_batch(DRIVE, RELEASE, damping_ratio=[-1.0])
    assert refused.status == [Status.bad_damping]
    with pytest.raises(ValueError, match="damping must be given as damping or as damping_ratio"):
        simulate_batch(DRIVE, RELEASE, damping_ratio=0.1, damping=0.1)


def test_masked_entries_are_points_that_are_refused() -> None:
    masses = np.ma.masked_array([0.01, 0.02, 0.03], mask=[False, True, False])
    found = simulate_batch(DRIVE, RELEASE, mass=masses)
    assert found.status.values.tolist() == [Status.ok, Status.bad_mass, Status.ok]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": b"10 g"}, "mass must be numbers in kg, got b'10 g'"),
        ({"mass": [True]}, "mass must be numbers in kg"),
        ({"mass": [1.0j]}, "mass must be numbers in kg"),
        ({"mass": [[1.0], [1.0, 2.0]]}, "mass must be numbers in kg"),
        (
            {"mass": [1.0, 2.0], "damping": [1.0, 2.0, 3.0]},
            r"arguments must be of shapes that broadcast, got mass \(2,\), damping \(3,\)",
        ),
        ({"threads": 0}, "threads must be a whole number from 1 to 4096, got 0"),
        ({"threads": 10**30}, f"threads must be a whole number from 1 to 4096, got {10**30}"),
        ({"threads": 1.5}, "threads must be a whole number from 1 to 4096, got 1.5"),
        (
            {"mass": xr.DataArray([1.0, 2.0], dims="m"), "damping": [1.0, 2.0]},
            r"damping must be a number or a DataArray .* got an array of shape \(2,\)",
        ),
    ],
)
def test_invalid_batches_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        batch_of(**change)


def test_end_stops_are_varied_as_all_else_is() -> None:
    columns: dict[str, Any] = {"travel": [[2e-4], [1e-3], [1.5e-3]], "stop_stiffness": [1e3, 1e5]}
    elastic = simulate_batch(DRIVE, replace(RELEASE, displacement=1.5e-3), **columns)
    assert elastic.travel.attrs["units"] == "m"
    for i, travel in enumerate((2e-4, 1e-3, 1.5e-3)):
        for j, stiffness in enumerate((1e3, 1e5)):
            drive = replace(DRIVE, travel=travel, stop_stiffness=stiffness)
            motion = simulate(drive, replace(RELEASE, displacement=1.5e-3))
            found = elastic.isel(travel=i, stop_stiffness=j)
            assert found.transient_settling_time == motion.transient.settling_time
            assert found.transient_peak_displacement == motion.transient.peak_displacement
            assert found.ending_position == motion.ending.position
            assert found.events == len(motion.events)
            assert any(event.contact == "stop" for event in motion.events)
    rigid = simulate_batch(DRIVE, replace(RELEASE, displacement=1e-3), travel=[5e-4, 1e-3, 0.1])
    assert [meaning(status) for status in rigid.status] == ["bad_displacement", "ok", "ok"]
    free = simulate_batch(DRIVE, replace(RELEASE, displacement=1e-3))
    bad = simulate_batch(
        DRIVE,
        RELEASE,
        travel=[1e-3, 0.0, inf, 1e-3, 1e-3, 1e-3],
        stop_stiffness=[1e4, 1e4, 1e4, -1.0, 1e4, 1e13],
        stop_damping=[0.0, 0.0, 0.0, 0.0, nan, 0.0],
    )
    assert [meaning(status) for status in bad.status] == [
        "ok",
        *["bad_travel"] * 2,
        "bad_stop_stiffness",
        "bad_stop_damping",
        "bad_stop_stiffness",
    ]
    assert np.isnan(bad.transient_peak_displacement[1:]).all()
    far, ended = float(rigid.isel(travel=2).ending_position), float(free.ending_position)
    assert far == pytest.approx(ended, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stop_stiffness": [1e3]}, "stop_stiffness must be left out without travel"),
        (
            {"travel": 1e-3, "stop_damping": 1.0},
            "stop_damping must be left out for rigid",
        ),
    ],
)
def test_end_stops_that_cannot_be_are_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        simulate_batch(DRIVE, replace(RELEASE, displacement=0.0), **change)


def test_arrays_whose_coordinates_differ_are_refused() -> None:
    mass = xr.DataArray([1.0, 2.0], dims="pin", coords={"pin": [0, 1]})
    damping = xr.DataArray([1.0, 2.0], dims="pin", coords={"pin": [1, 2]})
    with pytest.raises(ValueError, match="pin"):
        batch_of(mass=mass, damping=damping)


# ---- while it runs -------------------------------------------------------------------------------


def test_python_runs_on_meanwhile(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another thread gets a turn inside the core, though none is ever taken from this one."""
    turns, done = [0], threading.Event()

    def count() -> None:
        while not done.is_set():
            turns[0] += 1
            time.sleep(0)

    inside: list[int] = []
    core = _core.simulate_batch

    def watched(*arguments: Any) -> dict[str, Any]:
        before = turns[0]
        table = core(*arguments)
        inside.append(turns[0] - before)
        return table

    monkeypatch.setattr(_core, "simulate_batch", watched)
    interval = sys.getswitchinterval()
    other = threading.Thread(target=count)
    other.start()
    try:
        sys.setswitchinterval(1000.0)
        simulate_batch(DRIVE, RELEASE, **drawn(20_000, seed=8), threads=1)
    finally:
        sys.setswitchinterval(interval)
        done.set()
        other.join()
    assert inside[0] > 0


def test_ctrl_c_ends_a_batch() -> None:
    """Far more work than anyone waits for ends soon after the signal."""
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        batch_of(
            damping=0.0,
            finger_kinetic=1e-6,
            plate_kinetic=0.0,
            displacement=np.full(50_000, 1e-3),
            threads=2,
        )
    timer.join()


def test_a_dimension_has_the_name_of_its_one_argument() -> None:
    batch = batch_of(damping=[0.1, 0.2], outputs=["settling_time", "ending.position"])
    assert {*batch.data_vars} == {"settling_time", "ending_position", "status"}
    alone_at = alone({**PIN, "damping": 0.2})
    settled = float(batch.settling_time.sel(damping=0.2))
    assert settled == pytest.approx(alone_at.transient.settling_time, rel=1e-12)
    together = batch_of(damping=[0.1, 0.2], mass=[0.01, 0.02])
    assert together.sizes == {"dim_0": 2}
    lasting = batch_of(duration=[0.05, 0.1])
    assert lasting.sizes == {"dim_0": 2}

"""Kernel alone: equal bits in every width, and only the requested outputs.

And the elementary functions against thirty digits. How the kernel stands beside the general core is
shown by tests/cpp/kernel_test.cpp.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray

from pindrive import Contact, Drive, Release, simulate, simulate_batch
from pindrive._core import elementary, kernel_widths
from pindrive._core import simulate_batch as by_core
from pindrive.motion import batch

Floats = NDArray[np.float64]
ALL = [*batch._NUMBERS.values()]
# What the points of this file do not vary.
ANY = (
    Drive(mass=0.01, stiffness=100.0, damping=0.4, plate=Contact(0.02), finger=Contact(0.005)),
    Release(0.1, 1.5e-3),
)


def plain(count: int, seed: int) -> dict[str, Any]:
    """Plain releases of many kinds, most of which the kernel follows."""
    rng = np.random.default_rng(seed)
    mass, stiffness = rng.uniform(2e-3, 20e-3, count), rng.uniform(20.0, 400.0, count)
    plate, finger = rng.uniform(5e-3, 0.1, count), rng.uniform(1e-3, 0.05, count)
    mouse = rng.uniform(0.02, 0.3, count) * rng.choice([-1.0, 1.0], count)
    return {
        "mass": mass,
        "stiffness": stiffness,
        "damping": 2.0 * rng.uniform(0.0, 0.9, count) * np.sqrt(mass * stiffness),
        "plate_kinetic": plate,
        "plate_static": plate * rng.choice([1.0, 1.3], count),
        "finger_kinetic": finger,
        "finger_static": finger * rng.choice([1.0, 1.5], count),
        "mouse_velocity": mouse,
        "displacement": rng.uniform(-3e-3, 3e-3, count),
        "velocity": np.where(rng.random(count) < 0.5, mouse, rng.uniform(-0.3, 0.3, count)),
        "duration": rng.choice([0.02, 0.3, inf], count),
        "settling_band": rng.choice([0.01, 0.05, 1.0], count),
    }


def columns(points: dict[str, Any]) -> list[Floats]:
    """Return the columns in the order of the core."""
    given = points | {"finger_stiffness": inf, "plate_load": 1.0}
    return [np.broadcast_to(given[name], points["mass"].shape) for name in batch._ARGUMENTS]


# ---- widths --------------------------------------------------------------------------------------


@pytest.mark.parametrize("width", kernel_widths())
@pytest.mark.parametrize("count", [1, 7, 255, 257, 3000])
def test_every_width_gives_the_same_bits(width: int, count: int) -> None:
    points = columns(plain(count, seed=5))
    one = by_core(points, batch._BOUNDS, 1, ALL, True, 2)
    other = by_core(points, batch._BOUNDS, 2, ALL, True, width)
    assert one.keys() == other.keys()
    for name in one:
        if name not in ("general", "extremes"):
            assert one[name].tobytes() == other[name].tobytes(), name
    assert one["general"] == other["general"]


def test_a_width_that_there_is_not_is_refused() -> None:
    assert 2 in kernel_widths()
    with pytest.raises(ValueError, match="no kernel of that width"):
        by_core(columns(plain(1, seed=5)), batch._BOUNDS, 1, [], False, 3)


def test_hardly_a_plain_release_needs_the_general_core() -> None:
    points = plain(20_000, seed=6) | {"duration": np.full(20_000, 0.3)}
    equal = points | {"plate_static": points["plate_kinetic"]}  # without cycles of carrying
    assert by_core(columns(equal), batch._BOUNDS, 1, ALL, True)["general"] <= 2
    assert by_core(columns(points), batch._BOUNDS, 1, ALL, True)["general"] <= 400


# ---- what is asked for ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    "outputs",
    [
        ["final_position", "final_velocity"],
        ["ending", "transient_rest_time", "ending_steady_since"],
        ["events"],
        ["transient_peak_force_unknown"],
        ["transient_swing", "transient_plate_dissipated"],
        ["transient_settled"],
        ["energy_residual", "transient_settling_time"],
        ["duration"],
        [],
    ],
)
def test_outputs_are_computed_alone_and_the_same(outputs: list[str]) -> None:
    points = plain(2000, seed=9)
    if outputs == ["transient_peak_force_unknown"]:
        with pytest.raises(ValueError, match="outputs: unknown number transient_peak_force_u"):
            simulate_batch(*ANY, **points, outputs=outputs)
        return
    everything = [*batch._NUMBERS, *batch._BESIDE]
    whole = simulate_batch(*ANY, **points, outputs=everything)
    part = simulate_batch(*ANY, **points, outputs=outputs)
    assert {str(name) for name in part.data_vars} == {*outputs, "status"}
    for name in part.data_vars:
        assert part[name].values.tobytes() == whole[name].values.tobytes()
        assert part[name].attrs["long_name"]


def test_a_name_alone_is_no_list_of_outputs() -> None:
    with pytest.raises(ValueError, match="outputs must be a list of names, got 'events'"):
        simulate_batch(*ANY, **plain(1, seed=1), outputs="events")
    with pytest.raises(ValueError, match="did you mean final_position"):
        simulate_batch(*ANY, **plain(1, seed=1), outputs=["final_positon"])


def test_the_last_state_is_that_of_the_motion() -> None:
    points = plain(200, seed=10)
    found = simulate_batch(*ANY, **points, outputs=["final_position", "final_velocity"])
    for i in range(200):
        p = {name: float(values[i]) for name, values in points.items()}
        motion = simulate(
            Drive(
                mass=p["mass"],
                stiffness=p["stiffness"],
                damping=p["damping"],
                plate=Contact(p["plate_kinetic"], p["plate_static"]),
                finger=Contact(p["finger_kinetic"], p["finger_static"]),
            ),
            Release(p["mouse_velocity"], p["displacement"], p["velocity"]),
            duration=None if p["duration"] == inf else p["duration"],
        )
        end = motion.duration
        assert found.final_position[i] == pytest.approx(motion.position(end), rel=0, abs=1e-15)
        assert found.final_velocity[i] == pytest.approx(motion.velocity(end), rel=0, abs=1e-13)


# ---- the elementary functions --------------------------------------------------------------------

Exact = Callable[[Any, Any], Any]
FUNCTIONS: list[tuple[str, Exact]] = [
    ("sine", lambda a, b: mpmath.sin(a)),
    ("cosine", lambda a, b: mpmath.cos(a)),
    ("exp", lambda a, b: mpmath.exp(a)),
    ("expm1", lambda a, b: mpmath.expm1(a)),
    ("log", lambda a, b: mpmath.log(a)),
    ("log1p", lambda a, b: mpmath.log1p(a)),
    ("angle", lambda a, b: mpmath.atan2(a, b)),
]


def arguments(which: int, count: int) -> tuple[Floats, Floats]:
    """Over the whole range of a function, and where it is hard."""
    rng = np.random.default_rng(which)
    sign = rng.choice([-1.0, 1.0], count)
    if which < 2:
        near = np.round(rng.uniform(-2.6e8, 2.6e8, count)) * (np.pi / 2)
        a = np.where(rng.random(count) < 0.3, near, sign * 2.0 ** rng.uniform(-60, 28, count))
    elif which < 4:
        small = sign * 2.0 ** rng.uniform(-60, 3, count)
        a = np.where(rng.random(count) < 0.5, small, rng.uniform(-745, 709, count))
    elif which == 4:
        near = 1.0 + sign * 2.0 ** rng.uniform(-52, -1, count)
        a = np.where(rng.random(count) < 0.5, near, 2.0 ** rng.uniform(-1022, 1023, count))
    elif which == 5:
        a = np.where(rng.random(count) < 0.8, sign, 1.0) * 2.0 ** rng.uniform(-1000, -0.01, count)
        a = np.where(rng.random(count) < 0.2, 2.0 ** rng.uniform(0, 1000, count), a)
    else:
        a = sign * 2.0 ** rng.uniform(-500, 500, count)
    b = a * sign[::-1] * 2.0 ** rng.uniform(-3, 3, count)
    return a, b


@pytest.mark.parametrize("which", range(7), ids=[name for name, _ in FUNCTIONS])
def test_elementary_functions_are_within_two_units_in_the_last_place(which: int) -> None:
    a, b = arguments(which, 14_000)
    found = elementary(which, a, b, 2)
    for width in kernel_widths():
        assert elementary(which, a, b, width).tobytes() == found.tobytes()
    exact = FUNCTIONS[which][1]
    with mpmath.workdps(30):
        right = [exact(mpmath.mpf(x), mpmath.mpf(y)) for x, y in zip(a, b, strict=True)]
        worst = max(
            abs(mpmath.mpf(float(f)) - r) / float(np.spacing(abs(float(r))))
            for f, r in zip(found, right, strict=True)
        )
    assert worst <= 2


def test_elementary_functions_at_the_edges() -> None:
    edges = np.array([0.0, -0.0, 1.0, -1.0, inf, -inf, np.nan, 5e-324, 1e9])
    ones = np.ones_like(edges)
    with np.errstate(all="ignore"):
        for which, numpys in [(2, np.exp), (3, np.expm1), (4, np.log), (5, np.log1p)]:
            found = elementary(which, edges, ones, 2)
            np.testing.assert_allclose(found, numpys(edges), rtol=4.5e-16)
    beyond = elementary(0, edges, ones, 2)
    assert np.isnan(beyond[[4, 5, 6, 8]]).all()  # no phase is left of an angle as large
    np.testing.assert_array_equal(beyond[[0, 1, 7]], edges[[0, 1, 7]])
    zero, one = np.array([0.0, 0.0, -0.0, 1.0]), np.array([0.0, -1.0, 1.0, 0.0])
    np.testing.assert_array_equal(elementary(6, zero, one, 2), [0.0, np.pi, -0.0, np.pi / 2])

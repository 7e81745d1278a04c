"""Random releases of the studio tests, and the page's answers beside Python's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from pindrive import Contact, Drive, Profile, Release
from pindrive.motion.drive import law_values
from pindrive.motion.motion import Motion
from pindrive.motion.release import INPUTS
from pindrive.quantities.results import ENDING, TRANSIENT

Ask = Callable[[list[dict[str, Any]]], list[Any]]
"""Many questions to the page's program in Node; one answer each."""

NAMES = [number.name for number in (*TRANSIENT, *ENDING) if number.name != "transient.settled"]


def questions(count: int, seed: int) -> tuple[list[Any], list[dict[str, Any]]]:
    """Random cases (drive, release, duration), with the questions to the page."""
    random = np.random.default_rng(seed)
    cases = [drawn(random) for _ in range(count)]
    requested = []
    for drive, release, duration in cases:
        given = as_input(drive, release)
        if duration is not None:
            given["release"]["duration"] = duration
        requested.append({"simulate": given, "duration": duration})
    return cases, requested


def drawn(random: np.random.Generator) -> tuple[Drive, Release, float | None]:
    """A drive and a release of any kind that a device file can describe."""

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    kind = random.integers(4)
    contacts: dict[str, Contact] = {}
    for name, largest in (("plate", 0.1), ("finger", 0.05)):
        kinetic = between(1e-3, largest) * bool(random.integers(5))
        curve = ((0.0, kinetic), (0.05, kinetic * between(0.3, 1.1)), (0.3, kinetic))
        more: dict[str, Any] = {"curve": curve} if kind == 2 else {}
        if kind == 1 and name == "finger":
            more["stiffness"] = between(500, 5000)
            more["damping"] = (None, between(0.05, 3))[random.integers(2)]
        rest = kinetic
        if kind == 0 and random.integers(2):
            more = {"viscous": (0.0, between(0, 0.1))[random.integers(2)]}
            if law := (None, "stribeck", "hess-soom")[random.integers(3)]:
                rest = kinetic * between(1, 2)
                more |= {"law": law, "breakaway": rest, "stribeck_velocity": between(5e-3, 0.1)}
            if law == "stribeck":
                more["exponent"] = (None, 1.0, 2.0)[random.integers(3)]
        static = rest * (1.0 if random.integers(2) else between(1, 2))
        contacts[name] = Contact(kinetic=kinetic, static=static, **more)
    mass, stiffness = between(2e-3, 2e-2), between(20, 400)
    ratio = (0.0, between(0, 0.3), between(0, 2), 1.0)[random.integers(4)]
    stops: dict[str, float] = {}
    if random.integers(4) == 0:
        stops["travel"] = between(3e-4, 4e-3)
        if random.integers(2):
            stops["stop_stiffness"] = between(1e3, 1e5)
            stops["stop_damping"] = between(0, 10)
    drive = Drive(
        mass=mass,
        stiffness=stiffness,
        damping_ratio=ratio,
        plate=contacts["plate"],
        finger=contacts["finger"],
        **stops,
    )
    times = (0.0, between(0.01, 0.1), between(0.11, 0.3))
    velocity = between(-0.3, 0.3)
    inputs: dict[str, Any] = {"mouse_velocity": velocity}
    if kind in (0, 3) and random.integers(4) == 0:
        inputs["finger_load"] = Profile(times, [between(0, 2) for _ in times])
    if random.integers(4) == 0:
        inputs["force"] = Profile((*times, times[-1]), [between(-0.1, 0.1) for _ in range(4)])
    if random.integers(5) == 0:
        inputs["across_velocity"] = Profile(times, [between(-0.1, 0.1), between(-0.1, 0.1), 0.0])
    if kind == 3:
        inputs["mouse_velocity"] = Profile(times, [between(-0.3, 0.3) for _ in times])
        inputs["plate_load"] = Profile(times, [between(0, 2) for _ in times])
    farthest = 3e-3 if "stop_stiffness" in stops else min(3e-3, stops.get("travel", 3e-3))
    release = Release(
        displacement=between(-farthest, farthest),
        velocity=None if random.integers(2) else velocity,
        **inputs,
    )
    return drive, release, between(0.01, 1) if random.integers(3) == 0 else None


def as_input(drive: Drive, release: Release) -> dict[str, Any]:
    """In the names of pindrive.h; infinity as text, since JSON has none."""

    def rows(given: float | Profile) -> Any:
        return given.rows if isinstance(given, Profile) else [(0.0, given)]

    numbers = {"mass": drive.mass, "stiffness": drive.stiffness, "damping": drive.damping}
    for name, contact in (("plate", drive.plate), ("finger", drive.finger)):
        numbers |= {f"{name}.kinetic": contact.kinetic, f"{name}.static": contact.static_friction}
        law = law_values(contact) | {n: getattr(contact, n) for n in ("breakaway", "viscous")}
        numbers |= {f"{name}.{n}": value for n, value in law.items() if value is not None}
    own = {name: getattr(drive, name) for name in ("travel", "stop_stiffness", "stop_damping")}
    numbers |= {name: value for name, value in own.items() if value is not None}
    stiffness = drive.finger.stiffness
    skin: dict[str, Any] = {} if drive.finger.rigid else {"finger.stiffness": stiffness}
    if drive.finger.damping:
        skin["finger.damping"] = drive.finger.damping
    if drive.load_exponent != 1.0:
        skin["finger.load_exponent"] = drive.load_exponent
    curves = {"plate": drive.plate.curve, "finger": drive.finger.curve}
    velocity: Any = {} if release.velocity is None else {"velocity": release.velocity}
    return {
        "drive": numbers | skin,
        "curves": {name: curve for name, curve in curves.items() if curve},
        "release": {"displacement": release.displacement} | velocity,
        "profiles": {name: rows(getattr(release, name)) for name in INPUTS},
        "functions": {},
    }


def doubles(bits: str) -> np.ndarray[Any, Any]:
    return np.frombuffer(bytes.fromhex(bits))


def compare(found: dict[str, Any], motion: Motion) -> None:
    """A motion from the page has the bits of Python: its events, its numbers, values at times.

    Damped skin that slips is there a series, here a closed form: equal to rounding, but for the
    time at which a decay is known to be one.
    """
    assert found["status"] == int(motion.status)
    ends = {found["end"], motion.ending.end.name}
    # Within a duration a decay may be known to be one on the page alone.
    assert len(ends) == 1 or (motion.drive.finger.damping and ends == {"decaying", "moving"})
    if motion.drive.finger.damping:
        t = doubles(found["times"])
        for page, true in zip(
            np.split(doubles(found["values"]), 5),
            (motion.position(t), motion.velocity(t)),
            strict=False,
        ):
            np.testing.assert_allclose(page, true, rtol=0.0, atol=1e-9 * np.abs(true).max())
        return
    bounds = [end for segment in motion.segments for end in (segment.begin, segment.end)]
    np.testing.assert_array_equal(doubles(found["segments"]), bounds)
    numbers = motion.numbers()
    expected = [float(numbers[name]) for name in NAMES]
    np.testing.assert_array_equal(doubles(found["numbers"]), expected)
    t = doubles(found["times"])
    along = [motion.position(t), motion.velocity(t), motion.acceleration(t)]
    along += [motion.force("plate", t), motion.force("stop", t)]
    np.testing.assert_array_equal(doubles(found["values"]), np.concatenate(along))

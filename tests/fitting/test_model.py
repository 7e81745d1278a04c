"""The derivatives of what would be recorded, against differences, for every kind of parameter."""

from __future__ import annotations

import numpy as np
import pytest

from pindrive import Contact, Drive, Profile, Recording, Release, simulate
from pindrive.fitting.model import Model
from pindrive.fitting.parameters import parameters
from recordings import RELEASE, recorded, sampled

CHANNELS = ("position", "velocity", "acceleration", "force")
CURVED = Drive(
    mass=0.006,
    stiffness=160.0,
    damping=0.19,
    plate=Contact(0.034, 0.05),
    finger=Contact(curve=[(0.0, 0.011), (0.1, 0.008), (0.4, 0.009)]),
)
SKIN = Drive(
    mass=0.006,
    stiffness=160.0,
    damping=0.19,
    plate=Contact(0.034, 0.05),
    finger=Contact(0.011, 0.014, stiffness=900.0),
)
CYCLE = Release(  # clamped and carried, then released while the hand slows down
    Profile([0.0, 0.03, 0.2], [0.0, 0.12, 0.05]),
    0.0,
    None,
    Profile([0.0, 0.05, 0.053], [9.0, 9.0, 1.0]),
)
CASES = {
    "curve": (
        CURVED,
        RELEASE,
        [
            *("mass", "stiffness", "damping", "plate.kinetic", "finger.kinetic"),
            *("finger_curve[1].force", "displacement", "mouse_velocity", "time_offset"),
        ],
    ),
    "skin": (SKIN, RELEASE, ["mass", "finger.stiffness", "finger.kinetic", "plate_load"]),
    "cycle": (
        SKIN,
        CYCLE,
        [
            *("mass", "stiffness", "damping", "plate_load[1].time", "mouse_velocity[1].value"),
            *("plate.static", "time_offset", "force_offset"),
        ],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_derivatives_are_those_of_the_samples(name: str) -> None:
    drive, release, free = CASES[name]
    recording = recorded(drive, release, *CHANNELS, rate=2e3)
    found = parameters(free, {}, drive, [release], [recording])
    model = Model(found, drive, [release], [recording])
    theta = np.array([p.start for p in found])
    at = [p.key for p in found]
    if "time_offset" in at:
        theta[at.index("time_offset")] = 0.00313
    values, slopes = model.linearise(theta)
    assert np.array_equal(values, model.predict(theta))
    for i, p in enumerate(found):
        step = 3e-7 * max(abs(theta[i]), 1e-3 * (p.upper - p.lower))
        ends = np.tile(theta, (2, 1))
        ends[:, i] += step, -step
        difference = (model.predict(ends[0]) - model.predict(ends[1])) / (2.0 * step)
        for block, size in zip(model.blocks, model.range, strict=True):
            off = np.abs(difference - slopes[:, i])[block.place]
            scale = max(
                np.abs(slopes[block.place, i]).max(), 1e-3 * size / max(abs(theta[i]), step)
            )
            # A sample whose interval an event enters between the two has a difference of its own.
            assert np.mean(off > 1e-5 * scale) < 0.01, (p.name, block.channel)


@pytest.mark.parametrize("channel", CHANNELS)
def test_samples_are_those_of_the_motion(channel: str) -> None:
    recording = recorded(SKIN, CYCLE, channel, noise=0.0, rate=5e3)
    found = parameters(["mass"], {}, SKIN, [CYCLE], [recording])
    values = Model(found, SKIN, [CYCLE], [recording]).predict(np.array([SKIN.mass]))
    motion = simulate(SKIN, CYCLE, duration=0.2)
    expected = sampled(motion, channel, recording.time, 2e-4)
    size = float(np.ptp(expected))
    off = np.abs(values - expected)[1:] / size
    assert np.mean(off > 1e-3) < 0.02  # where an event jumps, the mean of 20 parts is off itself
    assert off.max() < 0.05


def test_several_recordings_share_the_drive_and_have_starts_of_their_own() -> None:
    slow = recorded(SKIN, RELEASE, rate=1e3)
    fast = Recording(slow.time, velocity=slow.channels["position"], mouse_velocity=0.2)
    found = parameters(
        ["mass", "displacement", "velocity_offset"], {}, SKIN, [RELEASE, RELEASE], [slow, fast]
    )
    assert [p.name for p in found] == [
        "mass",
        "displacement@0",
        "displacement@1",
        "velocity_offset@1",
    ]


def test_fixed_friction_keeps_its_ratio_to_kinetic_friction() -> None:
    finger = Contact(0.010, 0.015, [(0.0, 0.010), (0.1, 0.008)])
    drive = Drive(mass=0.006, stiffness=160.0, damping=0.19, plate=Contact(0.03), finger=finger)
    recording = recorded(drive, RELEASE, rate=1e3)
    found = parameters(["finger.kinetic"], {}, drive, [RELEASE], [recording])
    made = Model(found, drive, [RELEASE], [recording]).assembly.drive(np.array([0.020]))
    assert made.finger == Contact(0.020, 0.030, [(0.0, 0.020), (0.1, 0.016)])
    assert made.plate == drive.plate and made.mass == drive.mass
    free = ["finger.kinetic", "finger.static"]
    found = parameters(free, {}, drive, [RELEASE], [recording])
    both = Model(found, drive, [RELEASE], [recording]).assembly
    assert both.drive(np.array([0.020, 0.026])).finger.static == 0.026
    assert both.drive(np.array([0.020, 0.011])).finger.static == 0.020  # never below the kinetic


@pytest.mark.parametrize(
    ("free", "bounds", "said"),
    [
        ([], {}, "free must be a list of parameters"),
        (["mas"], {}, "free: unknown parameter mas; did you mean mass\\?"),
        (["mass", "drive.mass"], {}, "free must be names that differ, got mass twice"),
        (["finger_curve[0].force"], {}, "free must be one of 0 rows of finger_curve"),
        (["force_offset"], {}, "free must be an offset of a recorded channel, got force_offset"),
        (
            ["mass"],
            {"damping": (0, 1)},
            r"bounds must be for a free parameter \(mass\), got damping",
        ),
        (["mass"], {"mass": ("2 g", "1 g")}, "bounds of mass must be increasing"),
        (["mass"], {"mass": ("2 N", "1 g")}, "bounds of mass must be"),
        (["skin_stretch"], {}, "free must be one that the release was given"),
    ],
)
def test_fixed_parameters_are_refused(
    free: list[str], bounds: dict[str, object], said: str
) -> None:
    recording = recorded(rate=1e3)
    with pytest.raises(ValueError, match=said):
        parameters(free, bounds, SKIN, [RELEASE], [recording])  # type: ignore[arg-type]

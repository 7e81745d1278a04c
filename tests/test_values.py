"""Parts and results as values: a short representation, and equality of all that they hold."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from command import EXAMPLES
from pindrive.evaluation import evaluate, largest_speeds
from pindrive.quantities.value import LONGEST, concise, equal_by_value


def hand(rows: int) -> pd.Profile:
    return pd.Profile(np.linspace(0.0, 0.1, rows), np.linspace(0.06, 0.0, rows))


def drive() -> pd.Drive:
    plate = pd.Contact(static=0.0265, curve=[(0, 0.022), (0.05, 0.015), (0.1, 0.015)])
    finger = pd.Contact(0.020, 0.030, stiffness=1000.0)
    return pd.Drive(mass=0.01, stiffness=100.0, damping_ratio=0.16, plate=plate, finger=finger)


def motion() -> pd.Motion:
    return pd.simulate(drive(), pd.Release(hand(2), 2e-3))


def reader() -> pd.DeviceFile:
    return pd.load_device(EXAMPLES / "tactile-reader.toml")


def scanned() -> pd.Scan:
    device = reader().device
    page = pd.Page(text="I")
    scene = page.scene(reader().reading, device.array)
    return pd.scan(device, scene, page.hand(reader().reading, scene, device.array))


def study() -> pd.Study:
    return pd.load_study(EXAMPLES / "tactile-mouse-study.toml")


def recording() -> pd.Recording:
    return pd.read_recording(EXAMPLES / "release-recording.csv")


def device() -> pd.DeviceFile:
    return pd.load_device(EXAMPLES / "tactile-mouse.toml")


VALUES: dict[str, Callable[[], Any]] = {
    "drive": drive,
    "contact": lambda: drive().plate,
    "profile": lambda: hand(1000),
    "release": lambda: pd.Release(hand(1000), 2e-3),
    "motion": motion,
    "ending": lambda: motion().ending,
    "ending that swings": lambda: pd.simulate(drive(), pd.Release(0.01, 2e-3)).ending,
    "transient": lambda: motion().transient,
    "certificate": lambda: motion().certificate(),
    "energy": lambda: motion().energy,
    "event": lambda: motion().events[0],
    "segment": lambda: motion().segments[0],
    "device": lambda: reader().device,
    "device file": reader,
    "reading": lambda: reader().reading,
    "criteria": lambda: reader().criteria,
    "magnet": lambda: reader().device.magnet,
    "array": lambda: reader().device.array,
    "page": lambda: pd.Page(text="abc"),
    "scene": lambda: scanned().scene,
    "hand": lambda: scanned().path,
    "scan": scanned,
    "pin": lambda: scanned().pins[0],
    "evaluation": lambda: evaluate(scanned()),
    "line": lambda: evaluate(scanned()).lines[0],
    "speeds": lambda: largest_speeds(reader().device, [0.004], fastest=0.04),
    "study": study,
    "indices": lambda: pd.sobol(study(), rows=128),
    "robustness": lambda: pd.robustness(study(), count=50),
    "elasticities": lambda: pd.local_sensitivity(study()),
    "recording": recording,
    "fit": lambda: pd.fit([recording()], device().drive, device().release, free=["damping"]),
    "friction": lambda: pd.fit_friction(0.01 * np.arange(1, 9), 0.02 + 0.01 * 0.5 ** np.arange(8)),
}
made = cache(lambda name: VALUES[name]())


@pytest.mark.parametrize("name", VALUES)
def test_a_representation_is_short(name: str) -> None:
    text = repr(made(name))
    assert len(text) <= LONGEST
    assert "\n" not in text
    assert type(made(name)).__name__ in text or text[0] == "<"


@pytest.mark.parametrize("name", VALUES)
def test_equal_after_pickling(name: str) -> None:
    value = made(name)
    again = pickle.loads(pickle.dumps(value))
    assert again == value
    assert hash(again) == hash(value)


@pytest.mark.parametrize("name", ["drive", "release", "motion", "ending", "scan", "robustness"])
def test_equal_when_made_again(name: str) -> None:
    assert VALUES[name]() == made(name)


def test_different_motions_differ() -> None:
    one, other = motion(), pd.simulate(drive(), pd.Release(hand(2), 2.1e-3))
    assert one != other
    assert one.ending != other.ending
    assert one != one.transient


def test_representation_has_the_given_values() -> None:
    assert repr(pd.Contact(0.02, 0.03)) == "Contact(kinetic=0.02, static=0.03, stiffness=inf)"
    assert repr(drive()) == (
        "Drive(mass=0.01, stiffness=100, damping=0.32, "
        "plate=Contact(kinetic=0.022, static=0.0265, curve=<3 values>, stiffness=inf), "
        "finger=Contact(kinetic=0.02, static=0.03, stiffness=1000), preload=0, …)"
    )
    assert "mouse_velocity=Profile(times=<1000 values>" in repr(made("release"))


@equal_by_value
@concise
@dataclass(frozen=True)
class Mixed:
    array: Any
    number: float = 1.0
    words: tuple[str, ...] = ()


@pytest.mark.parametrize(
    ("one", "other", "equal"),
    [
        (Mixed(np.array([1.0, np.nan])), Mixed(np.array([1.0, np.nan])), True),
        (Mixed(np.array([0.0])), Mixed(np.array([-0.0])), True),
        (Mixed(np.array([1.0])), Mixed(np.array([1])), False),
        (Mixed(np.array([1.0, 2.0])), Mixed(np.array([[1.0, 2.0]])), False),
        (Mixed({"a": float("nan")}), Mixed({"a": float("nan")}), True),
        (Mixed(None, float("nan")), Mixed(None, 2.0), False),
        (Mixed(None, words=("a",)), Mixed(None, words=("b",)), False),
    ],
)
def test_arrays_and_missing_numbers_are_compared(one: Mixed, other: Mixed, equal: bool) -> None:
    assert (one == other) is equal
    assert not equal or hash(one) == hash(other)


def test_default_and_missing_values_are_left_out() -> None:
    assert repr(Mixed(np.zeros((3, 2)), float("nan"))) == "Mixed(array=<3 x 2 values>)"
    many = repr(Mixed("a" * 300, 2.5, ("b" * 60, "c" * 60)))
    assert len(many) <= LONGEST
    assert many.endswith(")")
    assert "…" in many

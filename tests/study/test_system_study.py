"""Studies of systems against single motions, and axes that are refused."""

from __future__ import annotations

import numpy as np
import pytest

import pindrive as pd


def box() -> pd.System:
    system = pd.System()
    system.body("box", "1 kg", velocity="2 m/s")
    system.contact("box", kinetic="4 N", name="floor")
    return system


def test_a_study_has_the_numbers_of_single_motions() -> None:
    system = box()
    system.body("rider", 0.1)
    system.spring("rider", "box", stiffness=50, damping=0.1)
    system.force("rider", pd.harmonic(0, 0.1, "3 Hz"))
    axes = {"floor.kinetic": ["2 N", "4 N"], "rider.force.frequency": {"lin": [1, 3], "count": 3}}
    seen: list[tuple[int, int]] = []
    study = pd.SystemStudy(system, axes, ["box.end", "energy.contacts"], duration=0.5)
    assert repr(study) == (
        "<SystemStudy of 6 points: contact.floor.kinetic 2, body.rider.force.frequency 3>"
    )
    found = study.run(threads=2, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (6, 6)
    assert found.sizes == {"contact.floor.kinetic": 2, "body.rider.force.frequency": 3}
    assert found["contact.floor.kinetic"].attrs["units"] == "N"
    assert found["body.rider.force.frequency"].attrs["units"] == "Hz"
    assert found["body.box.end"].attrs["units"] == "m"
    assert not found.status.any()
    for i, kinetic in enumerate((2.0, 4.0)):
        for j, frequency in enumerate((1.0, 2.0, 3.0)):
            at = {"floor.kinetic": kinetic, "rider.force.frequency": frequency}
            numbers = system.with_values(at).simulate(0.5).numbers()
            assert found["body.box.end"].values[i, j] == numbers["body.box.end"]
            assert found["energy.contacts"].values[i, j] == numbers["energy.contacts"]


def test_a_point_that_cannot_exist_has_a_reason() -> None:
    system = pd.System()
    system.body("a", 1.0)
    system.contact("a", kinetic=1.0, static=2.0)
    axes = {"contact.a-ground.static": [0.5, 2.0]}
    with pytest.raises(ValueError, match="static"):
        pd.SystemStudy(system, axes)
    ratio = pd.SystemStudy(system, {"kinetic": [0.5, 1.0], "static": [1.0, 1.5]}, duration=1).run()
    assert not ratio.status.any()
    falls = pd.System()
    falls.body("a", 1.0)
    falls.force("a", 1.0)
    falls.spring("a", stiffness=1.0, damping=1.0)
    found = pd.SystemStudy(falls, {"damping": [0.0, 1.0]}, ["a.end"]).run()
    assert found.status.values.tolist() == [pd.Status.refused, pd.Status.ok]
    assert "neither rests nor repeats" in str(found.reason.values[0])
    assert np.isnan(found["body.a.end"].values[0])
    assert found["body.a.end"].values[1] == pytest.approx(1.0, rel=1e-9)


def test_without_a_duration_each_motion_goes_on_to_its_ending() -> None:
    found = pd.SystemStudy(box(), {"kinetic": {"log": [1.0, 4.0], "count": 3}}, ["box.end"]).run()
    assert found["contact.floor.kinetic"].values == pytest.approx([1.0, 2.0, 4.0])
    assert found["body.box.end"].values == pytest.approx([2.0, 1.0, 0.5], rel=1e-14)


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ({}, "a mapping with a parameter"),
        ({"floor.kinetic": []}, "a list of values"),
        ({"floor.kinetic": {"lin": [1, 2]}}, "a list of values"),
        ({"floor.kinetic": {"log": [0, 2], "count": 3}}, "two values greater than 0"),
        ({"floor.kinetic": ["2 kg"]}, "N"),
        ({"floor.mass": [1]}, "unknown parameter"),
    ],
)
def test_axes_that_are_refused(axes: dict[str, object], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        pd.SystemStudy(box(), axes)


def test_outputs_that_are_refused() -> None:
    with pytest.raises(ValueError, match="unknown output"):
        pd.SystemStudy(box(), {"kinetic": [1.0]}, ["box.temperature"]).run()

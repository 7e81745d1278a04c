"""The evaluation equals the one in Python that it replaced, on random scans."""

from __future__ import annotations

from dataclasses import astuple, replace
from math import isnan
from typing import Any

import numpy as np
import pytest

from oracle.scan_evaluation import evaluated, printed
from pindrive import Contact, Drive, Profile
from pindrive.device import Criteria, Scan, scan
from pindrive.evaluation.line_crossings import printed_lines
from pindrive.quantities.results import LINE
from random_scans import RandomScan


def flat(value: Any) -> list[Any]:
    """The numbers and words of a nested tuple, in order."""
    if isinstance(value, tuple):
        return [item for each in value for item in flat(each)]
    return ["nan" if isinstance(value, float) and isnan(value) else value]


def check(done: Scan) -> int:
    """Compare both evaluations; returns the number of lines."""
    lines, false_lines = evaluated(done, Criteria())
    found = done.evaluate(Criteria())
    pairs: list[tuple[Any, Any]] = [
        *zip(lines, found.lines, strict=True),
        *zip(false_lines, found.false_lines, strict=True),
    ]
    for one, other in pairs:
        expected = [
            value if isinstance(value, str) else pytest.approx(value, rel=1e-11, abs=1e-15)
            for value in flat(astuple(one))
        ]
        assert flat(astuple(other)) == expected
    shown = found.columns()
    for quantity in LINE:
        each = [line.numbers[quantity.name] for line in found.lines]
        np.testing.assert_array_equal(shown[quantity.variable], each, quantity.name)
    for those, columns in zip(
        printed(done.device, done.path, done.scene),
        printed_lines(done.device, done.path, done.scene),
        strict=True,
    ):
        assert columns.begin.tolist() == pytest.approx([line.begin for line in those], rel=1e-15)
        assert columns.end.tolist() == pytest.approx([line.end for line in those], rel=1e-15)
        assert columns.whole.tolist() == [line.whole for line in those]
    return len(lines)


@pytest.mark.parametrize("kind", ["plain", "curved", "oblique"])
def test_lines_of_random_scans(kind: str) -> None:
    kinds = {} if kind == "plain" else {kind: True}
    cases = (RandomScan.of(seed, **kinds).linear() for seed in range(25))
    assert sum(check(scan(case.device, case.scene, case.path)) for case in cases) > 60


def test_lines_under_a_finger_that_is_lifted_and_from_a_state() -> None:
    """End stops and a compliant finger, too; the second scan begins as the first ends."""
    draw = np.random.default_rng(7)
    lines = 0
    for seed in range(25):
        case = RandomScan.of(seed).linear()
        given = case.device.drive
        finger = Contact(coefficient=0.5, stiffness=float(draw.choice([np.inf, 400.0])))
        drive = Drive(
            mass=given.mass,
            stiffness=given.stiffness,
            damping=given.damping,
            plate=given.plate,
            finger=finger,
            touch_force=0.02,
            travel=float(draw.choice([0.5e-3, 2e-3])),
            stop_stiffness=50.0 * given.stiffness if draw.random() < 0.5 else None,
        )
        lasts = case.path.end
        touch = Profile(
            [0.0, 0.3 * lasts, 0.31 * lasts, 0.5 * lasts, 0.51 * lasts],
            [0.02, 0.03, 0.0, 0.0, 0.01],
        )
        device = replace(case.device, drive=drive)
        first = scan(device, case.scene, case.path, touch=touch)
        lines += check(first)
        lines += check(scan(device, case.scene, case.path, touch=touch, start=first.state))
    assert lines > 60

"""A drive and a release in the core's numbers, for Python, the C interface and FMUs alike."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import inf, isinf, nan
from typing import Any

from pindrive import Contact, Drive, Profile, Release, _core

Rows = list[tuple[float, float]]


@dataclass
class Case:
    """A drive and a release in the core's numbers; the default is that of the README."""

    numbers: dict[str, float] = field(
        default_factory=lambda: {
            "mass": 0.010,
            "stiffness": 100.0,
            "damping": 0.40,
            "plate.kinetic": 0.020,
            "plate.static": 0.020,
            "finger.kinetic": 0.005,
            "finger.static": 0.005,
            "finger.stiffness": inf,
            "travel": inf,
            "stop_stiffness": inf,
            "stop_damping": 0.0,
            "displacement": 1.5e-3,
            "velocity": 0.10,
            "skin_stretch": nan,
            "duration": inf,
        }
    )
    curves: dict[str, Rows] = field(default_factory=lambda: {"plate": [], "finger": []})
    inputs: dict[str, Rows] = field(
        default_factory=lambda: {
            "mouse_velocity": [(0.0, 0.10)],
            "plate_load": [(0.0, 1.0)],
            "force": [(0.0, 0.0)],
            "across_velocity": [(0.0, 0.0)],
            "finger_load": [(0.0, 1.0)],
        }
    )

    def as_core(self) -> tuple[Any, ...]:
        """In the order of the extension."""
        n = self.numbers

        def contact(name: str, stiffness: float) -> tuple[float, float, float, Rows]:
            kinetic, at_rest = n[f"{name}.kinetic"], n[f"{name}.static"]
            return kinetic, at_rest, stiffness, self.curves[name]

        return (
            *(n["mass"], n["stiffness"], n["damping"]),
            *(contact("plate", inf), contact("finger", n["finger.stiffness"])),
            *(self.inputs["mouse_velocity"], self.inputs["plate_load"]),
            *(n["displacement"], n["velocity"], n["skin_stretch"], self.inputs["force"]),
            self.inputs["across_velocity"],
            self.inputs["finger_load"],
            (n["travel"], n["stop_stiffness"], n["stop_damping"]),
            n["duration"],
        )

    def core(self) -> _core.Motion:
        return _core.simulate(*self.as_core())

    def plain(self) -> Case:
        """Return the case without curves and varying inputs, which `simulate_batch` rejects."""
        first = {name: rows[0][1] for name, rows in self.inputs.items()}
        constant = first | {"force": 0.0, "across_velocity": 0.0, "finger_load": 1.0}
        return replace(
            self,
            curves={"plate": [], "finger": []},
            inputs={name: [(0.0, value)] for name, value in constant.items()},
        )

    def python(self) -> tuple[Drive, Release]:
        """Return the case as objects of the package, without the duration."""
        n = self.numbers

        def contact(name: str, stiffness: float) -> Contact:
            at_rest, curve = n[f"{name}.static"], self.curves[name]
            if curve:
                return Contact(curve=tuple(curve), static=at_rest, stiffness=stiffness)
            return Contact(n[f"{name}.kinetic"], at_rest, stiffness=stiffness)

        def given(rows: Rows) -> float | Profile:
            return rows[0][1] if len(rows) == 1 else Profile(*zip(*rows, strict=True))

        names = [name for name in ("travel", "stop_stiffness") if not isinf(n[name])]
        names += ["stop_damping"] * (len(names) == 2)
        drive = Drive(
            **{name: n[name] for name in ("mass", "stiffness", "damping", *names)},
            plate=contact("plate", inf),
            finger=contact("finger", n["finger.stiffness"]),
        )
        inputs: dict[str, Any] = {name: given(rows) for name, rows in self.inputs.items()}
        start = {name: n[name] for name in ("displacement", "velocity")}
        return drive, Release(**inputs, **start)


def line(rows: Rows, time: float) -> tuple[float, float]:
    """The value and the rate of an input from a time on."""
    for (t0, y0), (t1, y1) in pairwise(rows):
        if t0 <= time < t1:
            rate = (y1 - y0) / (t1 - t0)
            return y0 + rate * (time - t0), rate
    return rows[-1][1], 0.0


def read(lines: Iterable[str]) -> Iterator[Case]:
    """The drives of a text in the format of tests/fuzz/case.hpp."""
    found: dict[str, list[float]] = {}
    for text in lines:
        name, *words = text.split()
        if name == "drive" and found:
            yield _made(found)
            found = {}
        found[name] = [float(word) for word in words]
    yield _made(found)


def _made(found: dict[str, list[float]]) -> Case:
    def rows(name: str, default: float) -> Rows:
        flat = found.get(name, [1.0, 0.0, default])[1:]
        return list(zip(flat[::2], flat[1::2], strict=True))

    curves = {name: rows(name, 0.0) for name in ("plate", "finger")}
    travel, stop_stiffness, stop_damping = found.get("stops", [inf, inf, 0.0])
    numbers = dict(zip(("mass", "stiffness", "damping"), found["drive"], strict=True))
    numbers |= {f"{name}.kinetic": curve[0][1] for name, curve in curves.items()}
    numbers |= dict(zip(("plate.static", "finger.static"), found["static"], strict=True))
    numbers |= dict(zip(("displacement", "velocity", "duration"), found["start"], strict=True))
    return Case(
        numbers
        | {"finger.stiffness": found["skin"][0] or inf, "skin_stretch": nan}
        | {"travel": travel, "stop_stiffness": stop_stiffness or inf, "stop_damping": stop_damping},
        {name: curve if len(curve) > 1 else [] for name, curve in curves.items()},
        {
            "mouse_velocity": rows("mouse_velocity", 0.0),
            "plate_load": rows("plate_load", 1.0),
            "force": rows("force", 0.0),
            "across_velocity": rows("across", 0.0),
            "finger_load": rows("finger_load", 1.0),
        },
    )

"""A drive and a release in the core's numbers, for Python, the C interface and FMUs alike."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import inf, isinf, nan
from typing import Any, Final

from pindrive import Contact, Drive, Profile, Release, _core

Rows = list[tuple[float, float]]


NO_LAW: Final = {
    "law": 0.0,
    "breakaway": 0.0,
    "stribeck_velocity": 1.0,
    "exponent": 1.0,
    "viscous": 0.0,
}
"""Numbers of a Coulomb contact beside its friction, in the order of the extension."""


@dataclass
class Case:
    """A drive and a release in the core's numbers; the default is that of the README."""

    numbers: dict[str, float] = field(
        default_factory=lambda: {
            "mass": 0.010,
            "stiffness": 100.0,
            "damping": 0.40,
            "plate.kinetic": 0.020,
            **{f"plate.{name}": value for name, value in NO_LAW.items()},
            "plate.static": 0.020,
            "finger.kinetic": 0.005,
            **{f"finger.{name}": value for name, value in NO_LAW.items()},
            "finger.static": 0.005,
            "finger.stiffness": inf,
            "finger.damping": 0.0,
            "finger.load_exponent": 1.0,
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

        def contact(name: str, stiffness: float, *others: float) -> tuple[Any, ...]:
            kinetic, at_rest = n[f"{name}.kinetic"], n[f"{name}.static"]
            law = tuple(n.get(f"{name}.{part}", absent) for part, absent in NO_LAW.items())
            return kinetic, at_rest, stiffness, self.curves[name], law, *others

        return (
            *(n["mass"], n["stiffness"], n["damping"]),
            contact("plate", inf, 0.0, 1.0),
            contact(
                "finger",
                *(n[f"finger.{name}"] for name in ("stiffness", "damping", "load_exponent")),
            ),
            *(self.inputs["mouse_velocity"], self.inputs["plate_load"]),
            *(n["displacement"], n["velocity"], n["skin_stretch"], self.inputs["force"]),
            self.inputs["across_velocity"],
            self.inputs["finger_load"],
            (n["travel"], n["stop_stiffness"], n["stop_damping"]),
            n["duration"],
            0.0,
        )

    def law_of(self, name: str) -> dict[str, Any]:
        """The law of a contact as its arguments in Python."""
        law = {part: self.numbers.get(f"{name}.{part}", absent) for part, absent in NO_LAW.items()}
        number = int(law["law"])
        kept = {"viscous": law["viscous"]}
        if number:
            kept |= {part: law[part] for part in ("breakaway", "stribeck_velocity")}
        if number == 1:
            kept["exponent"] = law["exponent"]
        return {"law": _core.friction_laws[number], **kept}

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

        def contact(name: str, stiffness: float, damping: float = 0.0) -> Contact:
            at_rest, curve = n[f"{name}.static"], self.curves[name]
            if curve:
                return Contact(None, at_rest, tuple(curve), stiffness, damping)
            kinetic = n[f"{name}.kinetic"]
            return Contact(kinetic, at_rest, None, stiffness, damping, **self.law_of(name))

        def given(rows: Rows) -> float | Profile:
            return rows[0][1] if len(rows) == 1 else Profile(*zip(*rows, strict=True))

        names = [name for name in ("travel", "stop_stiffness") if not isinf(n[name])]
        names += ["stop_damping"] * (len(names) == 2)
        drive = Drive(
            **{name: n[name] for name in ("mass", "stiffness", "damping", *names)},
            plate=contact("plate", inf),
            finger=contact("finger", n["finger.stiffness"], n["finger.damping"]),
            load_exponent=n["finger.load_exponent"],
        )
        inputs: dict[str, Any] = {name: given(rows) for name, rows in self.inputs.items()}
        start: dict[str, Any] = {name: n[name] for name in ("displacement", "velocity")}
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
        | {"finger.damping": found.get("skin_damping", [0.0])[0], "finger.load_exponent": 1.0}
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

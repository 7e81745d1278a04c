"""Names that users type: each spelling works everywhere, and an unknown one gets its neighbours."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import pindrive as pd
from pindrive.files.keys import NAMES, NUMERIC_KEYS
from pindrive.optimisation import Effort
from pindrive.quantities.names import Names

MOUSE = pd.load_device("examples/tactile-mouse.toml")
BATCH: Callable[..., Any] = pd.simulate_batch
QUICK = Effort(16, 8, 2, 4, 0, 20)
TIMES = np.linspace(0.0, 0.1, 200)
SOME = Names("key", {"plate.kinetic": ("mu",), "finger.kinetic": (), "drive.mass": ("mass",)})


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        ("plate.kinetic", ("plate.kinetic",)),
        ("plate_kinetic", ("plate.kinetic",)),
        (" mu ", ("plate.kinetic",)),
        ("mass", ("drive.mass",)),
        ("kinetic", ("plate.kinetic", "finger.kinetic")),
        ("Mass", ()),
        ("", ()),
        ("drive.", ()),
    ],
)
def test_matches(given: str, meant: tuple[str, ...]) -> None:
    assert SOME.matches(given) == meant


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("kinetic", "here: kinetic may be plate.kinetic or finger.kinetic; give it in full"),
        ("mas", "here: unknown key mas; did you mean drive.mass?"),
        ("weight", "here: unknown key weight; did you mean drive.mass?"),
        ("plate", "here: unknown key plate; did you mean plate.kinetic?"),
        ("x y", 'here: unknown key "x y"; there are plate.kinetic, finger.kinetic, drive.mass'),
        (3, "here: unknown key 3; there are plate.kinetic, finger.kinetic, drive.mass"),
    ],
)
def test_an_unknown_name_gets_the_nearest(given: object, said: str) -> None:
    with pytest.raises(ValueError) as refused:
        SOME.find(given, "here")
    assert str(refused.value) == said


def test_first_of_two_names_has_a_shared_spelling() -> None:
    two = Names("number", {"median_smear": ("smear",), "worst_smear": ("smear",)})
    assert two.matches("smear") == ("median_smear",)


@pytest.mark.parametrize(
    ("written", "meant"),
    [("speed", "motion.velocity"), ("friction", "plate.kinetic"), ("spring", "drive.stiffness")],
)
def test_the_words_of_others_find_a_name(written: str, meant: str) -> None:
    assert NAMES.nearest(written)[0] == meant


def test_every_python_name_is_a_name_of_its_key() -> None:
    for key, quantity in NUMERIC_KEYS.items():
        assert NAMES.matches(key) == NAMES.matches(key.replace(".", "_")) == (key,)
        assert NAMES.matches(quantity.variable) == (key,), "no other key has it"


def test_no_message_lists_all_keys() -> None:
    for given in ("mouse_speed", "foo", "qqqq.zzzz", "friction", "x"):
        assert len(NAMES.unknown(given)) < 160
    assert "motion.mouse_velocity" in NAMES.unknown("mouse_speed")


def release() -> tuple[pd.Drive, pd.Release]:
    return MOUSE.drive, MOUSE.release


def recording() -> pd.Recording:
    motion = pd.simulate(*release())
    return pd.Recording(time=TIMES, position=motion.position(TIMES))


INPUTS: dict[str, Callable[[str], Any]] = {
    "simulate_batch": lambda name: BATCH(*release(), **{name: [0.02, 0.03]}),
    "Study": lambda name: pd.Study(MOUSE, axes={name: [0.02, 0.03]}),
    "tolerances": lambda name: pd.Study(MOUSE, tolerances={name: "5 %"}),
    "load_device": lambda name: pd.load_device(MOUSE.path, {name: 0.02}),
    "fit": lambda name: pd.fit(recording(), *release(), free=[name], profiles=False),
    "optimise": lambda name: pd.optimise(
        MOUSE,
        {"axes": {name: {"uniform": [0.01, 0.03]}}, "goals": {"minimise": "settling_time"}},
        effort=QUICK,
    ),
}
"""Whatever takes the key of an input."""
OUTPUTS: dict[str, Callable[[str], Any]] = {
    "simulate_batch": lambda name: pd.simulate_batch(*release(), mass=[0.01], outputs=[name]),
    "Study": lambda name: pd.Study(MOUSE, axes={"mass": [0.01]}, outputs=[name]),
    "specification": lambda name: pd.Study(
        MOUSE, axes={"mass": [0.01]}, specification={name: "<= 60 ms"}
    ),
    "sobol": lambda name: pd.sobol(
        pd.Study(MOUSE, tolerances={"mass": "5 %"}), numbers=[name], rows=128
    ),
    "optimise": lambda name: pd.optimise(
        MOUSE,
        {"axes": {"mass": {"uniform": [0.01, 0.03]}}, "goals": {"minimise": name}},
        effort=QUICK,
    ),
}
"""Whatever takes the name of a number."""


@pytest.mark.parametrize("place", INPUTS)
def test_an_input_has_the_same_names_everywhere(place: str) -> None:
    for name in ("plate.kinetic", "plate_kinetic"):
        INPUTS[place](name)
    with pytest.raises(ValueError, match=r"did you mean .*plate[._]kinetic"):
        INPUTS[place]("plate.kinetik")


@pytest.mark.parametrize("place", OUTPUTS)
def test_a_number_has_the_same_names_everywhere(place: str) -> None:
    for name in ("settling_time", "transient.settling_time", "transient_settling_time"):
        OUTPUTS[place](name)
    with pytest.raises(ValueError, match="did you mean settling_time"):
        OUTPUTS[place]("setling_time")


def test_stroke_is_a_word_for_the_swing() -> None:
    from pindrive.motion.batch import _OUTPUT_NAMES

    with pytest.raises(ValueError, match=r"unknown number stroke; did you mean swing"):
        _OUTPUT_NAMES.find("stroke", "")

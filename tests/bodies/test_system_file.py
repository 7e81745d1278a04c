"""System files: what they describe, in the words of a mistake, and by the command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import pindrive as pd
from command import run
from pindrive.files import ConfigError

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "two-pins-system.toml"
SMALL = """
[system]
duration = "1 s"
[body.a]
mass = "1 kg"
velocity = "2 m/s"
[contact.floor]
between = "a"
kinetic = "4 N"
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "system.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_file_says_what_python_says() -> None:
    file = pd.load_system(EXAMPLE)
    system = pd.System()
    hand = system.body("hand", "550 g")
    for side in ("left", "right"):
        system.body(f"{side} pin", "1 g")
    stroke = pd.minimum_jerk("60 mm", "0.8 s")
    system.spring(hand, stroke, stiffness=135, damping=6.5, name="arm")
    for side in ("left", "right"):
        system.spring(f"{side} pin", hand, stiffness=250, damping=0.5, name=side)
    for side, begin in (("left", 0.2), ("right", 0.25)):
        times = [f"{begin + later:g} s" for later in (0.0, 0.005, 0.1, 0.105)]
        load = pd.Profile(times, [1, 90, 90, 1])
        name = f"{side} plate"
        system.contact(f"{side} pin", kinetic="2.2 mN", static="2.6 mN", load=load, name=name)
    for side in ("left", "right"):
        system.contact(
            f"{side} pin",
            hand,
            kinetic="30 mN",
            static="45 mN",
            stiffness=300,
            damping=0.3,
            name=f"{side} skin",
        )
    assert file.system == system
    assert file.duration == 1.0
    assert str(file).startswith("<SystemFile ")


def test_values_are_set_otherwise(tmp_path: Path) -> None:
    path = written(tmp_path, SMALL)
    file = pd.load_system(path, ["a.mass=2 kg", "contact.floor.kinetic=1 N", "duration=3 s"])
    assert file.system.bodies["a"].mass == 2.0
    assert file.system.contacts["floor"].static == 1.0
    assert file.duration == 3.0
    assert pd.load_system(path, {"a.velocity": 0.5}).system.bodies["a"].velocity == 0.5
    with pytest.raises(ConfigError, match=r"`overrides` a.mas: unknown parameter a.mas; did you"):
        pd.load_system(path, ["a.mas=2 kg"])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("1 kg", "1 s"), "body.a.mass must be in kg or a unit alike"),
        (('"1 kg"', "1"), 'body.a.mass must be text with a unit, like "1 g", got 1'),
        (('mass = "1 kg"', ""), 'body.a.mass is missing; write mass = "1 g"'),
        (("mass", "mas"), "unknown key of body.a mas; did you mean mass?"),
        (("[body.a]", "[bodies.a]"), "unknown table bodies; did you mean body?"),
        (('between = "a"', 'between = "b"'), "contact.floor.between: unknown body b"),
        (
            ('between = "a"', ""),
            'contact.floor.between is missing; write between = ["pin", "ground"]',
        ),
        (('"4 N"', '"4 N"\nload = [["0 s", 1], ["1 s"]]'), "contact.floor.load[1] must be a time"),
        (('"4 N"', '"4 N"\nload = { mean = 1, amplitud = 2 }'), "did you mean amplitude?"),
        (('"4 N"', '"4 N"\nload = { mean = 1, amplitude = 2 }'), "load.frequency is missing"),
        (('"4 N"', '"4 N"\nstiffness = { mean = 1 }'), "stiffness must be a number in N/m"),
        (('duration = "1 s"', 'length = "1 s"'), "unknown key of system length"),
    ],
)
def test_a_mistake_is_said_with_its_place(
    change: tuple[str, str], words: str, tmp_path: Path
) -> None:
    path = written(tmp_path, SMALL.replace(*change))
    with pytest.raises(ConfigError) as error:
        pd.load_system(path)
    assert any(words in problem for problem in error.value.problems), error.value.problems
    assert all(problem.startswith(str(path)) for problem in error.value.problems)


def test_a_system_file_is_no_device_file() -> None:
    with pytest.raises(ConfigError, match=r"is a system file, as it has \[body\]"):
        pd.load_device(EXAMPLE)


def test_a_function_in_a_file_is_that_of_python(tmp_path: Path) -> None:
    text = SMALL.replace(
        '"2 m/s"',
        '"2 m/s"\nforce = { mean = "0 N", amplitude = "3 N", frequency = "2 Hz" }',
    )
    file = pd.load_system(written(tmp_path, text))
    assert file.system.bodies["a"].force == pd.harmonic("0 N", "3 N", "2 Hz")
    assert "body.a.force.amplitude" in file.system.parameters


def test_the_command_simulates_a_system(tmp_path: Path) -> None:
    path = written(tmp_path, SMALL)
    outputs = [tmp_path / f"m.{suffix}" for suffix in ("csv", "nc", "json")]
    options = [word for output in outputs for word in ("--output", str(output))]
    found = run("simulate", str(path), *options, "--plot", str(tmp_path / "m.png"))
    assert found.exit_code == 0, found.output
    assert "1 event in 1 s, at rest." in found.output
    assert "floor" in found.output
    report = json.loads(outputs[2].read_text("utf-8"))
    assert report["numbers"]["body.a.end"] == pytest.approx(0.5)
    assert (tmp_path / "m-events.csv").exists()
    found = run("simulate", str(path), "--set", "a.velocity=fast")
    assert found.exit_code == 2
    assert "a.velocity" in found.output


def test_a_file_may_have_feedback_and_contacts_that_others_press(tmp_path: Path) -> None:
    text = """
[body.a]
mass = "1 kg"
[body.b]
mass = "1 kg"
[contact.skin]
between = ["a", "b"]
kinetic = "1 N"
load = 2
[contact.plate]
between = "a"
kinetic = "1 N"
pressed_by = "end"
share = 0.5
[stop.end]
between = "a"
upper = "5 mm"
stiffness = "100 N/m"
[feedback.drive]
between = "a"
measured = ["b", "a"]
proportional = "20 N/m"
integral = "3 N/(m*s)"
reference = { distance = "10 mm", duration = "0.5 s" }
period = "10 ms"
"""
    system = pd.load_system(written(tmp_path, text)).system
    expected = pd.System()
    for body in ("a", "b"):
        expected.body(body, 1.0)
    end = expected.stop("a", upper=5e-3, stiffness=100, name="end")
    expected.contact("a", "b", kinetic=1, load=2, name="skin")
    expected.contact("a", kinetic=1, pressed_by=end, share=0.5, name="plate")
    stroke = pd.minimum_jerk("10 mm", "0.5 s")
    gains: dict[str, Any] = {"proportional": 20, "integral": 3}
    expected.feedback(
        "a", measured=("b", "a"), reference=stroke, period=0.01, name="drive", **gains
    )
    assert system == expected
    assert system.with_values({"drive.period": "20 ms"}).feedbacks["drive"].period == 0.02
    for wrong, words in (
        ('pressed_by = "end"', "pressed_by"),
        ('measured = ["b", "a"]', "measured"),
    ):
        key = wrong.split(" ")[0]
        path = written(tmp_path, text.replace(wrong, f'{key} = "nothing"'))
        with pytest.raises(ConfigError, match=words):
            pd.load_system(path)


def test_an_input_may_be_the_rows_of_a_csv_beside_the_file(tmp_path: Path) -> None:
    rows = tmp_path / "force.csv"
    rows.write_text("time [ms]; force [mN]\n0; 0\n100; 500\n", "utf-8")
    text = SMALL.replace('velocity = "2 m/s"', 'force = "force.csv"')
    file = pd.load_system(written(tmp_path, text))
    assert file.system.bodies["a"].force == pd.Profile([0.0, 0.1], [0.0, 0.5])
    assert file.inputs == (file.path, rows)
    rows.write_text("time [ms]; pull [mN]\n0; 0\n", "utf-8")
    with pytest.raises(ConfigError, match=r"force\.csv.*force \[N\]"):
        pd.load_system(file.path)
    rows.unlink()
    with pytest.raises(ConfigError, match=r"force\.csv: cannot be read"):
        pd.load_system(file.path)

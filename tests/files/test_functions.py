"""Inputs of device files that are functions of time, and their parameters as keys."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import pindrive as pd
from pindrive.cli.tables import device_report, show
from pindrive.files.export import write_json
from pindrive.files.fmu import variables_of
from pindrive.files.keys import PARAMETERS, template, usual_function
from pindrive.files.overrides import ConfigError
from pindrive.fitting.device_file import fitted_file
from pindrive.quantities.functions import FUNCTIONS_OF
from pindrive.quantities.table import QUANTITIES

FILE = """
[drive]
mass = "10 g"
stiffness = "100 N/m"
damping_ratio = 0.2
[plate]
kinetic = "20 mN"
[finger]
kinetic = "5 mN"
[motion]
mouse_velocity = {}
"""
SHAKEN = '{ mean = "60 mm/s", amplitude = "10 mm/s", frequency = "8 Hz" }'


def device(folder: Path, value: str = SHAKEN, more: str = "") -> Path:
    path = folder / "device.toml"
    path.write_text(FILE.replace("{}", value) + more, "utf-8")
    return path


@pytest.mark.parametrize(
    ("value", "function"),
    [
        (SHAKEN, pd.harmonic(0.06, 0.01, 8.0)),
        (SHAKEN.replace("}", ', phase = "90 deg" }'), pd.harmonic(0.06, 0.01, 8.0, np.pi / 2)),
        ('{ distance = "20 mm", duration = "0.4 s" }', pd.minimum_jerk(0.02, 0.4)),
        (
            '{ start = "60 mm/s", end = "0 mm/s", time_constant = "20 ms", begin = "10 ms" }',
            pd.exponential(0.06, 0.0, 0.02, 0.01),
        ),
        (
            f'[{SHAKEN}, {{ distance = "20 mm", duration = "0.4 s" }}]',
            pd.harmonic(0.06, 0.01, 8.0) + pd.minimum_jerk(0.02, 0.4),
        ),
        (
            '{ pieces = [{ begin = "0 ms", polynomial = [0.06, 0.1], terms = [[0, 1, 2, 3]] }] }',
            pd.Function([pd.InputPiece(0.0, (0.06, 0.1), (pd.InputTerm(0, 1, 2, 3),))]),
        ),
    ],
)
def test_a_table_is_the_function_that_python_makes(
    tmp_path: Path, value: str, function: pd.Function
) -> None:
    assert pd.load_device(device(tmp_path, value)).release.mouse_velocity == function


@pytest.mark.parametrize("name", [name for name, kinds in FUNCTIONS_OF.items() for _ in kinds])
def test_the_examples_of_the_template_can_be_read(tmp_path: Path, name: str) -> None:
    quantity = QUANTITIES[name]
    for kind in FUNCTIONS_OF[name]:
        value = usual_function(quantity, kind)
        assert f"# {name} = {value}\n" in template()
        path = tmp_path / "template.toml"
        lines = [line for line in template().splitlines() if not line.startswith(f"{name} =")]
        path.write_text("\n".join(lines).replace(f"# {name} = {value}", f"{name} = {value}"))
        function = getattr(pd.load_device(path).release, name)
        assert function.kind == kind


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ('{ mean = "60 mm/s" }', "amplitude is missing; write amplitude ="),
        (SHAKEN.replace("8 Hz", "0 Hz"), "frequency must be finite and greater than 0 Hz"),
        (SHAKEN.replace("8 Hz", "8"), "frequency must be a number with its unit"),
        (SHAKEN.replace("mean", "man"), "unknown parameter of motion.mouse_velocity man; did you"),
        (SHAKEN.replace("}", ', distance = "1 mm" }'), "motion.mouse_velocity must be a function"),
        ("{ }", "motion.mouse_velocity must be a function, like { mean ="),
        ("{ pieces = [{ polynomial = [1] }] }", "must be like { pieces ="),
        ('{ pieces = [{ begin = "0 s" }], mean = 1 }', "must be like { pieces ="),
        ('{ pieces = [{ begin = "0 s", polynom = [1] }] }', "must be like { pieces ="),
        (
            '{ pieces = [{ begin = "0 s" }, { begin = "0 s" }] }',
            "pieces[1].begin must be greater than 0.0: pieces overlap",
        ),
        (
            '{ pieces = [{ begin = "0 s" }, { begin = "1 s", polynomial = [1] }] }',
            "motion.mouse_velocity must be without a step",
        ),
        (f"[{SHAKEN}, {{ mean = 1 }}]", "motion.mouse_velocity[1].mean must be"),
    ],
)
def test_what_is_no_function_is_refused_in_a_line(tmp_path: Path, value: str, message: str) -> None:
    path = device(tmp_path, value)
    with pytest.raises(ConfigError) as refused:
        pd.load_device(path)
    (line,) = refused.value.problems
    assert line.startswith(f"{path}: ")
    assert message in line


def test_only_inputs_of_a_release_are_functions(tmp_path: Path) -> None:
    path = device(tmp_path, '"60 mm/s"', f"[scan]\ntouch = {SHAKEN}")
    with pytest.raises(ConfigError, match=r"scan.touch must be a number, rows or a CSV"):
        pd.load_device(path)


def test_a_load_that_gets_negative_is_refused(tmp_path: Path) -> None:
    more = "plate_load = { mean = 1, amplitude = 2, frequency = '3 Hz' }"
    with pytest.raises(ConfigError, match=r"motion.plate_load must be >= 0 at all times"):
        pd.load_device(device(tmp_path, more=more))


# ---- parameters as keys --------------------------------------------------------------------------


@pytest.mark.parametrize("key", ["mouse_velocity.amplitude", "motion.mouse_velocity.amplitude"])
def test_a_parameter_is_set_like_any_other_value(tmp_path: Path, key: str) -> None:
    path = device(tmp_path)
    for overrides in ([f"{key}=20 mm/s"], {key: 0.02}, {key: "20 mm/s"}):
        found = pd.load_device(path, overrides).release.mouse_velocity
        assert found == pd.harmonic(0.06, 0.02, 8.0)
    set_later = pd.load_device(path).with_values({"motion.mouse_velocity.amplitude": 0.02})
    assert set_later.release.mouse_velocity == pd.harmonic(0.06, 0.02, 8.0)


def test_a_function_is_set_like_any_other_value(tmp_path: Path) -> None:
    path = device(tmp_path)
    stroke = pd.minimum_jerk(0.02, 0.4)
    for value in ('{ distance = "20 mm", duration = "0.4 s" }',):
        assert pd.load_device(path, [f"mouse_velocity={value}"]).release.mouse_velocity == stroke
    assert pd.load_device(path, {"mouse_velocity": stroke}).release.mouse_velocity == stroke
    part = pd.load_device(path, ['mouse_velocity={ mean = "50 mm/s" }']).release.mouse_velocity
    assert part == pd.harmonic(0.05, 0.01, 8.0)
    constant = pd.load_device(path, ["mouse_velocity=50 mm/s"])
    assert constant.release.mouse_velocity == 0.05
    assert "motion.mouse_velocity.mean" not in constant.values()


def test_a_parameter_that_the_file_does_not_have_is_refused(tmp_path: Path) -> None:
    path = device(tmp_path)
    with pytest.raises(ConfigError, match=r"motion.force is no function"):
        pd.load_device(path, ["force.amplitude=1 mN"])
    with pytest.raises(ConfigError, match=r"distance cannot be set: .* is a function of mean,"):
        pd.load_device(path).with_values({"motion.mouse_velocity.distance": 0.02})
    with pytest.raises(ConfigError, match=r"must be in m/s or a unit alike"):
        pd.load_device(path, ["mouse_velocity.amplitude=1 mN"])
    with pytest.raises(ConfigError, match=r"amplitude may be .*; give it in full"):
        pd.load_device(path, ["amplitude=1 mN"])


def test_values_have_the_function_and_its_parameters(tmp_path: Path) -> None:
    values = pd.load_device(device(tmp_path)).values()
    assert values["motion.mouse_velocity"] == pd.harmonic(0.06, 0.01, 8.0)
    own = {key: value for key, value in values.items() if key in PARAMETERS}
    assert own == {
        f"motion.mouse_velocity.{name}": value
        for name, value in (("mean", 0.06), ("amplitude", 0.01), ("frequency", 8.0), ("phase", 0.0))
    }


@pytest.mark.parametrize(
    "function",
    [pd.harmonic(0.06, 0.01, 8.0, 0.1), pd.harmonic(0.0, 0.01, 8.0) + pd.minimum_jerk(0.02, 0.4)],
)
def test_a_device_of_a_release_keeps_its_functions(tmp_path: Path, function: pd.Function) -> None:
    drive = pd.load_device(device(tmp_path)).drive
    made = pd.DeviceFile.of(drive, pd.Release(function))
    assert made.release.mouse_velocity == function
    assert made.with_values({"drive.mass": 0.02}).release.mouse_velocity == function


def test_json_has_the_parameters(tmp_path: Path) -> None:
    file = pd.load_device(device(tmp_path))
    write_json(pd.simulate(file.drive, file.release), file, tmp_path / "motion.json")
    document = json.loads((tmp_path / "motion.json").read_text("utf-8"))
    assert document["config"]["motion.mouse_velocity"]["frequency"] == 8.0
    assert document["units"]["mouse_velocity.frequency"] == "Hz"


def test_check_lists_the_parameters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    show(device_report(pd.load_device(device(tmp_path))))
    printed = capsys.readouterr().out
    assert "a sinusoid" in printed
    assert "motion.mouse_velocity.frequency" in printed


def test_a_unit_has_the_parameters_of_a_function(tmp_path: Path) -> None:
    value = SHAKEN.replace("}", ', phase = "90 deg" }')
    variables = {v.name: v for v in variables_of(pd.load_device(device(tmp_path, value)))}
    assert "mouse_velocity" not in variables
    assert variables["motion.mouse_velocity.phase"].start == pytest.approx(np.pi / 2)
    assert variables["motion.mouse_velocity.amplitude"].unit == "m/s"


def test_a_unit_begins_with_the_value_of_a_sum_of_functions(tmp_path: Path) -> None:
    turned = SHAKEN.replace("}", ', phase = "90 deg" }')
    value = f"[{SHAKEN}, {turned}]"
    variables = {v.name: v for v in variables_of(pd.load_device(device(tmp_path, value)))}
    assert variables["mouse_velocity"].start == pytest.approx(0.13)
    assert not any("amplitude" in name for name in variables)


# ---- studies and fits ----------------------------------------------------------------------------


def test_a_study_varies_parameters(tmp_path: Path) -> None:
    device(tmp_path)
    path = tmp_path / "study.toml"
    path.write_text(
        """
base = "device.toml"
outputs = ["amplitude"]
[set]
mouse_velocity.amplitude = "15 mm/s"
[axes]
mouse_velocity.frequency = { lin = ["4 Hz", "12 Hz"], count = 3 }
motion.mouse_velocity.mean = ["0 mm/s", "60 mm/s"]
""",
        "utf-8",
    )
    study = pd.load_study(path)
    found = study.run()
    assert dict(found.sizes) == {"mouse_velocity_frequency": 3, "mouse_velocity_mean": 2}
    for i, frequency in enumerate((4.0, 8.0, 12.0)):
        for j, mean in enumerate((0.0, 0.06)):
            motion = pd.simulate(
                study.device.drive, pd.Release(pd.harmonic(mean, 0.015, frequency))
            )
            assert found.ending_amplitude.values[i, j] == motion.ending.amplitude


@pytest.mark.parametrize(
    ("axis", "message"),
    [
        ('force.amplitude = ["1 mN"]', "motion.force is no function with parameters"),
        (
            'mouse_velocity.distance = ["1 mm"]',
            "is a function of mean, amplitude, frequency",
        ),
        ('mouse_velocity.frequency = ["0 Hz"]', "greater than 0 Hz"),
        ('mouse_velocity.frequency = ["1 mm"]', "must be in Hz or a unit alike"),
    ],
)
def test_a_study_refuses_parameters_that_the_device_lacks(
    tmp_path: Path, axis: str, message: str
) -> None:
    device(tmp_path)
    path = tmp_path / "study.toml"
    path.write_text(f'base = "device.toml"\n[axes]\n{axis}\n', "utf-8")
    with pytest.raises(ConfigError) as refused:
        pd.load_study(path)
    (line,) = refused.value.problems
    assert line.startswith(f"{path}: ")
    assert message in line


def test_a_fit_estimates_parameters_and_writes_them(tmp_path: Path) -> None:
    file = pd.load_device(device(tmp_path))
    true = file.with_values({"motion.mouse_velocity.amplitude": 0.03})
    t = np.linspace(0.0, 0.5, 400)
    noise = 1e-7 * np.random.default_rng(1).standard_normal(t.size)
    position = pd.simulate(true.drive, true.release).position(t) + noise
    free = ["mouse_velocity.amplitude", "motion.mouse_velocity.frequency", "plate.kinetic"]
    found = pd.fit([pd.Recording(t, position=position)], file.drive, file.release, free=free)
    amplitude, frequency, friction = (estimate.value for estimate in found.estimates)
    assert amplitude == pytest.approx(0.03, rel=1e-4)
    assert frequency == pytest.approx(8.0, rel=1e-4)
    assert friction == pytest.approx(0.02, rel=1e-3)
    assert found.releases[0].mouse_velocity == pd.harmonic(0.06, amplitude, frequency)
    target = tmp_path / "fitted.toml"
    target.write_text(fitted_file(file, found, target), "utf-8")
    assert pd.load_device(target).release.mouse_velocity == found.releases[0].mouse_velocity
    assert "# mouse_velocity.amplitude fitted: 30.000" in target.read_text("utf-8")


def test_a_fit_refuses_what_is_not_free(tmp_path: Path) -> None:
    file = pd.load_device(device(tmp_path))
    t = np.linspace(0.0, 0.5, 100)
    recording = pd.Recording(t, position=pd.simulate(file.drive, file.release).position(t))
    for name, message in (
        ("mouse_velocity", "must be mouse_velocity.mean, mouse_velocity.amplitude"),
        ("mouse_velocity[0].value", "must be mouse_velocity.mean, mouse_velocity.amplitude"),
        ("plate_load.mean", "must be a parameter of a function that the release has"),
    ):
        with pytest.raises(ValueError, match=message):
            pd.fit([recording], file.drive, file.release, free=[name])


def test_a_load_may_become_negative_after_the_duration(tmp_path: Path) -> None:
    more = "duration = '10 s'\nplate_load = { mean = 1, amplitude = 2, frequency = '0.01 Hz' }"
    assert pd.load_device(device(tmp_path, more=more)).duration == 10.0
    longer = more.replace("10", "70", 1)
    with pytest.raises(ConfigError, match=r"plate_load must be >= 0 until the end of the motion"):
        pd.load_device(device(tmp_path, more=longer))

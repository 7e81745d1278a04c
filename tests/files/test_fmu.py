"""Drives as functional mock-up units, as an importer sees them."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from command import refused, run
from fmu_unit import Unit, unpacked
from pindrive import Profile, Release, load_device, simulate
from pindrive.files.fmu import variables_of

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
MOUSE = EXAMPLES / "tactile-mouse.toml"
SKIN = EXAMPLES / "stribeck-skin.toml"
TIMES = (0.0, 0.013, 0.05, 0.11, 0.2)
VELOCITIES = (0.06, 0.09, -0.04, -0.04, 0.02)
LOADS = (1.0, 0.2, 1.5, 1.0, 0.0)
FORCES = (0.0, 0.004, -0.01, -0.01, 0.002)  # N
FINGER_LOADS = (1.0, 0.5, 1.5, 1.0, 0.3)
END = 0.3


class Archive:
    """An FMU of an example, unpacked."""

    def __init__(self, path: Path, device: Path, version: int) -> None:
        self.path, self.version = path, version
        self.device = load_device(device)
        self.folder, self.description = unpacked(self.device, path, version)

    def unit(self, **events: bool) -> Unit:
        return Unit(self.folder, self.description, **events)

    def motion(self) -> Any:
        """Return the simulation with the inputs of the unit."""
        release = Release(
            Profile(TIMES, VELOCITIES),
            displacement=self.device.release.displacement,
            plate_load=Profile(TIMES, LOADS),
            force=Profile(TIMES, FORCES),
            finger_load=Profile(TIMES, FINGER_LOADS),
        )
        return simulate(self.device.drive, release, duration=END)


@pytest.fixture(scope="module", params=[(MOUSE, 2), (MOUSE, 3), (SKIN, 2), (SKIN, 3)], ids=str)
def archive(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Archive:
    device, version = request.param
    return Archive(tmp_path_factory.mktemp("fmu") / f"{device.stem}.fmu", device, version)


def test_a_strict_importer_finds_nothing_wrong(archive: Archive) -> None:
    assert validate_fmu(str(archive.path)) == []
    variables = archive.description.modelVariables
    assert all(v.description for v in variables if v.causality != "independent")
    named = {v.name: v for v in variables}
    assert {v.name for v in variables_of(archive.device)} == named.keys() - {"time"}
    assert float(named["drive.mass"].start) == archive.device.drive.mass
    assert named["drive.mass"].unit == "kg" and float(named["drive.mass"].min) > 0
    assert len(named) == len(variables)
    inputs = {v.name: v for v in variables if v.causality == "input"}
    expected = {"mouse_velocity", "plate_load", "force", "across_velocity", "finger_load"}
    assert inputs.keys() == expected | {f"{name}_rate" for name in expected}
    assert inputs["force"].unit == "N" and inputs["force_rate"].unit == "N/s"
    assert "motion.finger_load" not in named
    outputs = {v.name: v for v in variables if v.causality == "output"}
    assert {name: v.unit for name, v in outputs.items()} == {
        **{"position": "m", "velocity": "m/s", "acceleration": "m/s^2"},
        **{"plate_force": "N", "finger_force": "N", "stretch": "m", "stretch_rate": "m/s"},
        "housing_force": "N",
        **{"next_event_time": "s", "plate_state": None, "finger_state": None},
    }


def test_the_libraries_are_small_and_need_no_other(archive: Archive) -> None:
    """No runtime of C++ is in them, and none is asked of the machine."""
    with ZipFile(archive.path) as unit:
        libraries = [n for n in unit.namelist() if n.startswith("binaries/")]
        for name in libraries:
            content = unit.read(name)
            assert len(content) <= 282_000, name
            for runtime in (b"libstdc++", b"libc++", b"__cxa_throw", b"__gxx_personality"):
                assert runtime not in content or name.endswith(".dylib"), (name, runtime)
    assert libraries


def rates(rows: tuple[float, ...], i: int) -> float:
    """The rate of an input after row i."""
    return (rows[i + 1] - rows[i]) / (TIMES[i + 1] - TIMES[i]) if i + 1 < len(rows) else 0.0


def driven(unit: Unit, random: np.random.Generator, largest: float) -> Iterator[Unit]:
    """Return the states after steps of random length under varying inputs."""
    for i, (begin, end) in enumerate(pairwise((*TIMES, END))):
        assert unit.time == begin
        rows = {"mouse_velocity": VELOCITIES, "plate_load": LOADS, "force": FORCES}
        rows["finger_load"] = FINGER_LOADS
        unit.set(**{name: values[i] for name, values in rows.items()})
        slopes = {name: rates(values, i) for name, values in rows.items()}
        if unit.version == 2 and i % 2:  # FMI 2 sets a rate in either way
            numbers = [unit.numbers[name] for name in slopes]
            unit.slave.setRealInputDerivatives(numbers, [1] * len(slopes), [*slopes.values()])
        else:
            unit.set(**{f"{name}_rate": slope for name, slope in slopes.items()})
        while unit.time < end:
            until = min(end, unit.time + random.uniform(0, largest))
            before = unit.time
            unit.step(until)
            assert before < unit.time <= until
            yield unit


def test_random_steps_lead_to_what_one_simulation_has(archive: Archive) -> None:
    motion, random = archive.motion(), np.random.default_rng(2)
    unit = archive.unit().begin(mouse_velocity=VELOCITIES[0])
    size = np.abs(motion.position(motion.sample_times(300))).max()
    fastest = np.abs(motion.velocity(motion.sample_times(300))).max()
    worst, astray = 0.0, 0
    for _ in driven(unit, random, 0.004):
        if random.integers(4) == 0:  # back to a state after going astray, also as bytes
            with unit.astray(random, "position", "velocity", "plate_force", "plate_state"):
                unit.set(mouse_velocity=0.3)
                unit.step(unit.time + 0.01)
            astray += 1
        x, v = unit.get("position", "velocity")
        worst = max(
            worst,
            abs(x - motion.position(unit.time)) / size,
            abs(v - motion.velocity(unit.time)) / fastest,
        )
    print(f"FMI {archive.version}: within {worst:.1e}, {astray} states gone back to")
    assert worst < 1e-12 and astray > 5


def end_of(unit: Unit, seed: int) -> list[float]:
    """Return the final state of a unit."""
    *_, last = driven(unit, np.random.default_rng(seed), 0.01)
    return last.get("position", "velocity", "acceleration", "plate_state", "finger_state")


def test_instances_and_threads_do_not_meet(archive: Archive) -> None:
    def ended(seed: int) -> list[float]:
        return end_of(archive.unit().begin(mouse_velocity=VELOCITIES[0]), seed)

    one = ended(0)
    with ThreadPoolExecutor(4) as threads:
        for other in threads.map(ended, range(8)):
            assert other == pytest.approx(one, rel=1e-12, abs=1e-15)
    unit, second = (archive.unit() for _ in range(2))
    unit.begin(mouse_velocity=VELOCITIES[0])
    second.begin(drive__mass=2 * archive.device.drive.mass)
    second.step(0.02)
    first = end_of(unit, 0)
    assert first == one
    unit.slave.reset()
    assert end_of(unit.begin(mouse_velocity=VELOCITIES[0]), 0) == one
    assert second.get("drive.mass") == [2 * archive.device.drive.mass]
    for each in (unit, second):
        each.slave.terminate()
        each.slave.freeInstance()


def test_an_importer_of_its_own_drives_it(archive: Archive) -> None:
    result = fmpy.simulate_fmu(
        str(archive.path),
        stop_time=0.05,
        output_interval=0.001,
        start_values={"mouse_velocity": 0.06},
        output=["position", "plate_state", "next_event_time"],
    )
    release = Release(0.06, displacement=archive.device.release.displacement)
    motion = simulate(archive.device.drive, release, duration=0.06)
    time, position = (np.asarray(result[name]) for name in ("time", "position"))
    assert np.abs(position - motion.position(time)).max() < 1e-12 * np.abs(position).max()
    assert (np.asarray(result["next_event_time"]) > time).all() and len(time) == 51


@pytest.mark.parametrize("archive", [(MOUSE, 3), (SKIN, 2)], indirect=True, ids=str)
def test_outputs_are_those_of_a_simulation(archive: Archive) -> None:
    """Also under a velocity across, by which the plate does not stick."""
    release = Release(0.06, displacement=0.002, across_velocity=0.01, force=0.003)
    motion = simulate(archive.device.drive, release, duration=0.1)
    unit = archive.unit().begin(
        mouse_velocity=0.06, motion__displacement=0.002, across_velocity=0.01, force=0.003
    )
    times = np.linspace(0.0013, 0.097, 40)
    known = {
        **{name: getattr(motion, name)(times) for name in ("position", "velocity", "acceleration")},
        **{f"{contact}_force": motion.force(contact, times) for contact in ("plate", "finger")},
    }
    known["housing_force"] = motion.housing_force(times)
    if not archive.device.drive.finger.rigid:
        known |= {"stretch": motion.stretch(times), "stretch_rate": motion.stretch_rate(times)}
    found = []
    for time in times:
        unit.step(float(time))
        found.append(unit.get(*known))
    for (name, expected), values in zip(known.items(), np.transpose(found), strict=True):
        assert np.abs(values - expected).max() <= 1e-11 * np.abs(expected).max(), name


STOPS = ["", 'stop_stiffness = "5 N/mm"\nstop_damping = "0.5 N s/m"\n']


@pytest.mark.parametrize("stops", STOPS)
def test_a_pin_meets_its_stops(stops: str, tmp_path: Path) -> None:
    device = tmp_path / "stops.toml"
    text = MOUSE.read_text(encoding="utf-8")
    device.write_text(text.replace("[drive]\n", f'[drive]\ntravel = "2.03 mm"\n{stops}'))
    archive = Archive(tmp_path / "stops.fmu", device, 3)
    motion = simulate(archive.device.drive, archive.device.release, duration=0.3)
    assert any(event.contact == "stop" for event in motion.events)
    unit, random, worst = archive.unit().begin(), np.random.default_rng(4), 0.0
    while unit.time < 0.29:
        unit.step(unit.time + random.uniform(1e-4, 4e-3))
        worst = max(worst, abs(unit.get("position")[0] - motion.position(unit.time)))
    assert worst < 1e-12 * 2e-3


@pytest.mark.parametrize("archive", [(MOUSE, 3)], indirect=True, ids=str)
def test_one_step_under_a_constant_transverse_velocity(archive: Archive) -> None:
    unit = archive.unit().begin()
    unit.set(across_velocity=0.05)
    unit.step(1e6)
    device = archive.device
    release = replace(device.release, across_velocity=0.05)
    expected = simulate(device.drive, release, duration=1e6).position(1e6)
    assert unit.get("position") == [pytest.approx(expected, rel=1e-12)]


def test_derivatives_are_exact(archive: Archive) -> None:
    unit = archive.unit()
    if unit.version == 2:
        unit.slave.setupExperiment(startTime=0.0)
    unit.slave.enterInitializationMode()
    unit.set(plate_load=0.1)
    mass = archive.device.drive.mass
    by_mass = unit.derivative("acceleration", drive__mass=1.0)  # what the coefficients do included
    ends = []
    for factor in (1.0 - 1e-4, 1.0 + 1e-4):
        unit.set(drive__mass=factor * mass)
        ends += unit.get("acceleration")
    unit.set(drive__mass=mass)
    assert by_mass == pytest.approx((ends[1] - ends[0]) / (2e-4 * mass), rel=1e-6)
    x0 = unit.derivative("acceleration", motion__displacement=1.0)
    assert x0 == pytest.approx(-archive.device.drive.stiffness / mass)
    unit.slave.exitInitializationMode()
    unit.time = 0.0
    unit.step(0.004)
    assert unit.get("plate_state") != [0]
    assert unit.derivative("acceleration", mouse_velocity_rate=2.0) == 2.0
    of_load = unit.derivative("plate_force", plate_load=1.0)
    assert of_load == pytest.approx(unit.get("plate_force")[0] / 0.1)
    with pytest.raises(FMICallException):
        unit.derivative("acceleration", drive__mass=1.0)


FUNCTIONS = """
mouse_velocity = { mean = "60 mm/s", amplitude = "80 mm/s", frequency = "8 Hz" }
plate_load = { start = "3", end = "1", time_constant = "5 ms", begin = "20 ms" }
across_velocity = { distance = "8 mm", duration = "100 ms", begin = "50 ms" }
"""


@pytest.mark.parametrize("version", [2, 3])
def test_functions_are_followed_by_their_parameters(version: int, tmp_path: Path) -> None:
    device = tmp_path / "functions.toml"
    text = MOUSE.read_text(encoding="utf-8")
    kept = [line for line in text.splitlines() if not line.startswith("mouse_velocity")]
    device.write_text("\n".join(kept).replace("[motion]", f"[motion]{FUNCTIONS}"))
    archive = Archive(tmp_path / "functions.fmu", device, version)
    assert validate_fmu(str(archive.path)) == []
    named = {v.name: v for v in archive.description.modelVariables}
    assert {n for n, v in named.items() if v.causality == "input"} == {
        *("force", "force_rate", "finger_load", "finger_load_rate")
    }
    assert named["motion.mouse_velocity.frequency"].unit == "Hz"
    assert float(named["motion.plate_load.time_constant"].start) == 0.005
    changed = {"motion.mouse_velocity.amplitude": 0.1, "motion.across_velocity.begin": 0.04}
    motion = simulate(*_drive_of(archive.device.with_values(changed)), duration=END)
    size = np.abs(motion.position(motion.sample_times(300))).max()
    unit, random = archive.unit(), np.random.default_rng(7)
    unit.begin(**{key.replace(".", "__"): value for key, value in changed.items()})
    worst = 0.0
    while unit.time < END:
        if random.integers(4) == 0:
            with unit.astray(random, "position", "velocity", "plate_force", "plate_state"):
                unit.set(force=0.1)
                unit.step(unit.time + 0.01)
        unit.step(min(END, unit.time + random.uniform(0, 0.008)))
        (x,) = unit.get("position")
        worst = max(worst, abs(x - motion.position(unit.time)) / size)
    assert worst < 1e-12
    fresh = archive.unit()
    if version == 2:
        fresh.slave.setupExperiment(startTime=0.0)
    fresh.slave.enterInitializationMode()
    by_mean = fresh.derivative("acceleration", motion__mouse_velocity__mean=1.0)
    damping = archive.device.drive.damping / archive.device.drive.mass  # it begins with the hand
    assert by_mean == pytest.approx(-damping)


def _drive_of(device: Any) -> tuple[Any, Any]:
    return device.drive, device.release


@pytest.mark.parametrize("archive", [(MOUSE, 3)], indirect=True, ids=str)
def test_steps_end_early_at_events(archive: Archive) -> None:
    """As the description announces: without, an importer may take each step as done."""
    assert archive.description.coSimulation.mightReturnEarlyFromDoStep
    motion = simulate(archive.device.drive, archive.device.release)
    events = sorted({event.time for event in motion.events})
    found = early_returns(archive)
    assert found == pytest.approx(events, rel=1e-13) and len(found) > 3


@pytest.mark.parametrize("stops", STOPS)
def test_steps_end_early_at_stops(stops: str, tmp_path: Path) -> None:
    """Where a pin meets an end stop, and where an elastic one lets it go."""
    device = tmp_path / "stops.toml"
    text = MOUSE.read_text(encoding="utf-8")
    device.write_text(text.replace("[drive]\n", f'[drive]\ntravel = "2.03 mm"\n{stops}'))
    archive = Archive(tmp_path / "stops.fmu", device, 3)
    motion = simulate(archive.device.drive, archive.device.release, duration=1.0)
    events = sorted({event.time for event in motion.events if 0.0 < event.time < 1.0})
    assert sum(event.contact == "stop" for event in motion.events) >= 1 + bool(stops)
    assert early_returns(archive) == pytest.approx(events, rel=1e-12)


def early_returns(archive: Archive) -> list[float]:
    """Times within 1 s at which a step ends early; the interface is checked on the way."""
    unit = archive.unit(eventModeUsed=True, earlyReturnAllowed=True).begin()
    found = []
    unit.slave.enterStepMode()
    while unit.time < 1.0:
        (known,) = unit.get("next_event_time")
        happens, terminate, early, time = unit.step(1.0)
        assert not terminate and unit.time == time <= 1.0
        assert early == (time < 1.0) == happens
        if happens:
            assert known <= time  # an elastic stop that follows a pin changes without an event
            found.append(time)
            unit.slave.enterEventMode()
            update = unit.slave.updateDiscreteStates()
            assert update[:4] == (False, False, False, False)
            assert not update[4] or update[5] > time
            unit.slave.enterStepMode()
    return found


@pytest.mark.parametrize("archive", [(MOUSE, 2)], indirect=True, ids=str)
def test_libcosim_drives_sixteen(archive: Archive) -> None:
    """Sixteen drives in one system, each released from another place."""
    cosim = pytest.importorskip("libcosimpy")
    for name in ("CosimExecution", "CosimLogging", "CosimObserver", "CosimSlave"):
        import_module(f"libcosimpy.{name}")
    cosim.CosimLogging.log_output_level(cosim.CosimLogging.CosimLogLevel.ERROR)
    execution = cosim.CosimExecution.CosimExecution.from_step_size(1_000_000)  # ns
    observer = cosim.CosimObserver.CosimObserver.create_last_value()
    numbers = {v.name: v.valueReference for v in archive.description.modelVariables}
    places = [1e-3 + 1e-4 * i for i in range(16)]
    slaves = []
    for i, place in enumerate(places):
        slave = cosim.CosimSlave.CosimLocalSlave(str(archive.path), f"pin{i}")
        slaves.append(execution.add_local_slave(slave))
        execution.real_initial_value(slaves[-1], numbers["motion.displacement"], place)
    execution.add_observer(observer)
    velocity = archive.device.release.mouse_velocity
    motions = [simulate(archive.device.drive, Release(velocity, place)) for place in places]
    for step in range(1, 61):
        execution.step()
        for slave, motion in zip(slaves, motions, strict=True):
            (x,) = observer.last_real_values(slave, [numbers["position"]])
            assert x == pytest.approx(motion.position(step * 1e-3), rel=1e-12, abs=1e-15)


def test_refusal_names_the_value(archive: Archive, capsys: pytest.CaptureFixture[str]) -> None:
    unit, bad = archive.unit().begin(), archive.unit()
    for call, words in (
        (lambda: unit.set(drive__mass=1.0), "drive.mass is a fixed parameter"),
        (lambda: unit.set(position=1.0), "position is an output"),
        (lambda: unit.set(plate_load=-1.0), "plate_load must be from 0 to 1e12, not -1"),
        (
            lambda: unit.slave.doStep(5.0, 1.0),
            "a step must begin where the last one ended, at 0 s, not at 5 s",
        ),
        (
            lambda: bad.begin(drive__mass=-1.0),
            "drive.mass must be finite and greater than 0 kg, got -1.0 kg",
        ),
    ):
        with pytest.raises(FMICallException):
            call()
        assert words in capsys.readouterr().out
    description = fmpy.read_model_description(str(archive.path))
    setattr(description, "guid" if archive.version == 2 else "instantiationToken", "{other}")
    with pytest.raises(Exception, match="instantiate"):
        Unit(archive.folder, description)
    assert "the token must be" in capsys.readouterr().out


def test_the_command_writes_both_versions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "drive.fmu"
    done = run("fmu", str(MOUSE), "-o", str(target), "--fmi", "2", "--set", "mass=12 g")
    assert done.exit_code == 0 and "FMI 2.0" in done.stdout, done.output
    description = fmpy.read_model_description(str(target))
    (mass,) = [v.start for v in description.modelVariables if v.name == "drive.mass"]
    assert float(mass) == 0.012
    again = run("fmu", str(SKIN), "-o", str(target))
    assert again.exit_code == 0 and "mouse_velocity is an input" in again.stderr
    assert fmpy.read_model_description(str(target)).fmiVersion == "3.0"
    first = target.read_bytes()
    run("fmu", str(SKIN), "-o", str(target))
    assert target.read_bytes() == first
    monkeypatch.chdir(tmp_path)
    assert "--fmi must be" in refused("fmu", MOUSE, "-o", target, "--fmi", "1")
    assert "mass must be" in refused("fmu", MOUSE, "-o", target, "--set", "mass=0 g")
    copy = tmp_path / "device.toml"
    copy.write_text(MOUSE.read_text("utf-8"), "utf-8")
    assert "is read by this command" in refused("fmu", copy, "-o", copy)
